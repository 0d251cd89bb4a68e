# SPDX-License-Identifier: Apache-2.0
# A signal ends a render cleanly: what there is gets written and marked, the status tells, no temporary stays.
cat >scene.yaml <<'Y'
tsuya: 1
film: { size: [320, 180] }
render: { samples: 60000 }
camera: { position: [0, 0, 0.1], look_at: [0, 0, 0] }
assets: { ball: { shape: sphere, radius: 0.01, divisions: 16 } }
materials: { grey: { model: surface, base_color: 0.5 } }
objects: [ { mesh: ball, material: grey } ]
lights: [ { type: environment, radiance: 1 } ]
Y
interrupted() { # SIGNAL STATUS
    rm -f out.exr
    env --default-signal=HUP "$tsuya" render scene.yaml -o out.exr --progress none >out.txt 2>err.txt &
    local child=$!
    sleep 2
    kill -"$1" $child
    wait $child
    local got=$?
    [ $got -eq "$2" ] || fail "status $got after $1, expected $2"
    expect 0 "$tsuya" info out.exr --json
    prints '"tsuya/partial"'
}
interrupted TERM 143
interrupted INT 130
interrupted HUP 129

# The same while packing, where nothing is to be written.
printf 'tsuya: 1\nkind: aggregate\nfill: { count: 20000 }\ncontainer: { radius: 0.1, height: 0.1 }\n' >heap.yaml
"$tsuya" pack heap.yaml -o heap.glb >out.txt 2>err.txt &
child=$!
sleep 2
kill -TERM $child
wait $child
got=$?
[ $got -eq 143 ] || fail "status $got after TERM, expected 143"
absent heap.glb

expect 0 "$tsuya" render scene.yaml -o limited.exr --time-limit 1 --stats s.json
says "marked partial"
expect 0 "$tsuya" info limited.exr --json
prints '"tsuya/partial"'
grep -q '"rays_per_second"' s.json || fail "no rays_per_second in the statistics"
