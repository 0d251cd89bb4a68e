# SPDX-License-Identifier: Apache-2.0
# Aggregates for other programs: each file against its specification, one mesh as Blender counts it, what is refused.
cat >heap.yaml <<'Y'
tsuya: 1
kind: aggregate
element: { variants: 3 }
fill: { count: 14 }
Y
cat >eggs.yaml <<'Y'
tsuya: 1
kind: aggregate
element: { kind: roe, roe: { preset: ikura } }
fill: { count: 6 }
Y
for name in heap eggs; do
    expect 0 "$tsuya" pack $name.yaml -o $name.glb
    expect 0 "$tsuya" export $name.glb -o $name.usda
    python3 "$TSUYA_SOURCE/tests/cli/export_files.py" $name.glb $name.usda || fail "$name: not as the specifications say"
    for ending in ply obj glb; do expect 0 "$tsuya" export $name.glb --realise -o $name.mesh.$ending; done
    expect 0 "$tsuya" export $name.glb --facets -o $name.facets.glb
    says "facets: "
    says "the volume changes by"
done

# The recipe gives the same files by itself.
expect 0 "$tsuya" pack heap.yaml -o again.usda
same again.usda heap.usda
expect 0 "$tsuya" pack heap.yaml -o points.ply
expect 0 "$tsuya" export heap.glb -o again.ply
same again.ply points.ply
expect 0 "$tsuya" export points.ply --prototype heap.mesh.ply -o many.glb
expect 0 "$tsuya" info many.glb
prints 'instances: 14'
expect 0 "$tsuya" info heap.mesh.glb --recipe
prints 'variants: 3'

# A film: one file a frame.
expect 0 "$tsuya" pack heap.yaml -o 'film.##.glb' --set animate.frames=3
absent film.04.glb
expect 0 "$tsuya" info film.03.glb
prints 'instances: 14'
prints 'elements: 14'
prints 'at rest: false'
prints '"velocity", "spin"'
grep -Eq '^  overlap, greatest: [0-9.e-]+ % of the width$' out.txt || fail "no overlap with its unit"
grep -Eq '^  speed, root mean square: [0-9.e-]+ mm/s$' out.txt || fail "no speed with its unit"
grep -q '_' out.txt && fail "a metric without words"
expect 0 "$tsuya" info film.03.glb --json
prints '"speed_rms_mm_s": '
python3 - film.03.glb <<'P' || fail "a film without velocities"
import json, struct, sys
data = open(sys.argv[1], "rb").read()
root = json.loads(data[20:20 + struct.unpack_from("<I", data, 12)[0]])
for node in root["nodes"]:
    names = node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]
    assert root["accessors"][names["_VELOCITY"]]["type"] == root["accessors"][names["_SPIN"]]["type"] == "VEC3"
P
expect 0 "$tsuya" export film.03.glb -o film.usda
python3 "$TSUYA_SOURCE/tests/cli/export_files.py" film.03.glb film.usda || fail "velocities: not as the schema says"
cmp -s film.01.glb film.03.glb && fail "nothing moves"
expect 3 "$tsuya" pack heap.yaml -o 'none.##.glb'
says "animate.frames"
absent none.01.glb

# Contact facets: another mesh, the same for any number of threads; with gaps closed another one again.
for threads in 1 2 3; do
    expect 0 "$tsuya" export heap.glb --facets --threads $threads -o heap.facets.ply
    cp heap.facets.ply $threads.facets.ply
    same $threads.facets.ply 1.facets.ply
done
cmp -s heap.facets.ply heap.mesh.ply && fail "facets move nothing"
expect 0 "$tsuya" export heap.glb --facets --close 0.2 -o heap.closed.ply
cmp -s heap.facets.ply heap.closed.ply && fail "--close moves nothing"
expect 2 "$tsuya" export heap.glb --close 0.2 -o heap.closed.ply
says "--facets"
expect 3 "$tsuya" export heap.glb --facets -o heap.facets.usda
absent heap.facets.usda

expect 2 "$tsuya" export heap.glb
says "give -o"
expect 2 "$tsuya" export heap.glb -o heap.abc
says ".glb, .usda, .ply or .obj"
expect 2 "$tsuya" export points.ply -o x.glb
says "--prototype"
expect 3 "$tsuya" export heap.glb --realise -o x.usda
absent x.usda
expect 4 "$tsuya" export nothing.glb -o x.usda
absent x.usda

command -v blender >/dev/null || skip "no Blender"
count() { "$tsuya" info "$1" --json | python3 -c 'import json, sys; print(json.load(sys.stdin)["vertices"])'; }
list=
for ending in glb ply obj; do list="$list heap.mesh.$ending=$(count heap.mesh.ply)"; done
list="$list heap.facets.glb=$(count heap.mesh.ply)"
expect 0 blender -b --factory-startup --python "$TSUYA_SOURCE/tests/cli/blender_import.py" -- $list
for file in $list; do prints "imported ${file%=*}"; done
