# SPDX-License-Identifier: Apache-2.0
# A pile that time or a signal stopped goes on from its file, and ends as if nothing had happened; other states are
# refused.
cat >heap.yaml <<'Y'
tsuya: 1
kind: aggregate
element: { variants: 2, divisions: 6 }
container: { shape: box, size: [0.03, 0.02, 0.03], rounding: 0 }
fill: { count: 120 }
settle: { rolling: 0.05, state: true }
Y
expect 0 "$tsuya" pack heap.yaml -o whole.glb --threads 2
expect 7 "$tsuya" pack heap.yaml -o part.glb --set settle.max_seconds=0.1
says "not at rest"
expect 0 "$tsuya" info part.glb
prints 'at rest: false'
grep -Eq '^state: [1-9][0-9]+$' out.txt || fail "no state in part.glb"
for threads in 1 2 3; do
    expect 0 "$tsuya" pack heap.yaml -o on.glb --resume part.glb --threads $threads
    same on.glb whole.glb
done
expect 0 "$tsuya" pack heap.yaml -o on.glb --resume whole.glb
same on.glb whole.glb
expect 0 "$tsuya" export part.glb -o copy.glb
same copy.glb part.glb

# By a signal: what there is gets written, and the status tells.
cat heap.yaml >slow.yaml
sed -i 's/count: 120/count: 1500/; s/0.03, 0.02, 0.03/0.06, 0.06, 0.06/' slow.yaml
"$tsuya" pack slow.yaml -o slow.part.glb >out.txt 2>err.txt &
child=$!
for _ in $(seq 200); do
    grep -q "grains placed" err.txt && break
    sleep 0.1
done
sleep 0.3
kill -TERM $child
wait $child
got=$?
[ $got -eq 143 ] || fail "status $got after TERM, expected 143"
says "resume"
expect 7 "$tsuya" pack slow.yaml -o slow.glb --resume slow.part.glb --set settle.max_seconds=0.2
expect 7 "$tsuya" pack slow.yaml -o slow.whole.glb --set settle.max_seconds=0.2
same slow.glb slow.whole.glb

# What cannot be gone on from.
expect 0 "$tsuya" pack heap.yaml -o none.glb --set settle.state=false
expect 4 "$tsuya" pack heap.yaml -o x.glb --resume none.glb
says "settle.state"
expect 3 "$tsuya" pack heap.yaml -o x.glb --resume part.glb --set seed=2
says "another recipe"
expect 4 "$tsuya" pack heap.yaml -o x.glb --resume nothing.glb
head -c 20000 part.glb >cut.glb
expect 4 "$tsuya" pack heap.yaml -o x.glb --resume cut.glb
says "truncated"
python3 - part.glb <<'P'
import sys
data = bytearray(open(sys.argv[1], "rb").read())
data[-200] ^= 1
open("bent.glb", "wb").write(data)
P
expect 4 "$tsuya" pack heap.yaml -o x.glb --resume bent.glb
says "damaged"
expect 2 "$tsuya" pack heap.yaml -o 'x.##.glb' --resume part.glb --set animate.frames=2
absent x.glb
absent x.01.glb
