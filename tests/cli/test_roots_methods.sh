# SPDX-License-Identifier: Apache-2.0
# Roots by the thesis' method beside ours, as tubes, and in levels of detail: what is written, printed and refused.
cat >roots.yaml <<'Y'
tsuya: 1
kind: roots
host: { shape: box, size: [.02, .05, .02], rounding: 0, resolution: 64 }
method: seed
thesis: { fall: 100 }
count: 6
radius: 2
tip: 2
detail: 2
length: 0.3
Y
expect 0 "$tsuya" roots roots.yaml -o seed.ply --report seed.json
prints "seed     "
prints "wrap     0 of"
prints "no angle"
grep -q '"no_angle": [0-9]' seed.json || fail "no counts in the report"
grep -q '"wrap": {' seed.json || fail "ours is not beside it"
expect 0 "$tsuya" roots roots.yaml -o ours.ply --set method=wrap --report ours.json
grep -q '"seed": {' ours.json && fail "the thesis' method without being asked for"

for method in seed wrap; do
    expect 0 "$tsuya" roots roots.yaml -o "$method.ply" --set method=$method --set mesh=tubes --set levels=3 --threads 1
    expect 0 "$tsuya" roots roots.yaml -o "${method}_3.ply" --set method=$method --set mesh=tubes --set levels=3 --threads 3
    for level in "" .lod1 .lod2; do
        same "$method$level.ply" "${method}_3$level.ply"
    done
    absent "$method.lod3.ply"
    [ "$(stat -c %s "$method.ply")" -gt "$((2 * $(stat -c %s "$method.lod1.ply")))" ] || fail "$method: level 1 is no smaller"
done
expect 0 "$tsuya" roots roots.yaml -o tubes.glb --set mesh=tubes --set levels=2
[ -s tubes.lod1.glb ] || fail "no level 1 of a .glb"
expect 0 "$tsuya" roots roots.yaml -o tubes.obj --set mesh=tubes
absent tubes.lod1.obj

expect 3 "$tsuya" roots roots.yaml -o x.ply --set tubes.divisions=7
says "tubes.divisions: 7; an even number 4..128"
expect 3 "$tsuya" roots roots.yaml -o x.ply --set mesh=tube
says "did you mean 'tubes'?"
expect 3 "$tsuya" roots roots.yaml -o x.ply --set method=thesis
says "'thesis' is not one of"
expect 3 "$tsuya" roots roots.yaml -o x.ply --set levels=7
says "'levels' is 7: out of range"
expect 3 "$tsuya" roots roots.yaml -o 'x.##.ply' --set levels=2 --set grow.frames=3
says "levels: 2; frames of growth have one"
absent x.ply
