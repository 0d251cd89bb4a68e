# SPDX-License-Identifier: Apache-2.0
# Wrong input: one clear message with its place, the right status, nothing written.
base() {
    cat <<'Y'
tsuya: 1
film: { size: [32, 18] }
render: { samples: 4 }
camera: { position: [0, 0, 0.1], look_at: [0, 0, 0] }
assets:
  ball: { shape: sphere, radius: 0.01, divisions: 16 }
materials:
  grey: { model: surface, base_color: 0.5 }
objects:
  - { mesh: ball, material: grey }
lights:
  - { type: environment, radiance: 1 }
Y
}
# refused STATUS TEXT: renders scene.yaml, which must fail, say TEXT and write nothing.
refused() {
    expect "$1" "$tsuya" render scene.yaml -o out.exr --develop
    says "$2"
    absent out.exr
    absent out.png
}
# edited SED: the good scene with one change.
edited() { base | sed -E "$1" >scene.yaml; }

base >scene.yaml
expect 0 "$tsuya" render scene.yaml -o good.exr

: >scene.yaml
refused 3 "scene.yaml"
printf 'tsuya: 1\nfilm: { size: [32, 18\n' >scene.yaml
refused 3 "scene.yaml:"
edited 's/samples: 4/sampels: 4/'
refused 3 "scene.yaml:3:11:"
says "did you mean 'samples'"
edited 's/samples: 4/samples: many/'
refused 3 "scene.yaml:3:20:"
edited 's/samples: 4/samples: 0/'
refused 3 "1"
edited 's/samples: 4/samples: 4, samples: 5/'
refused 3 "scene.yaml:3:"
edited 's/base_color: 0.5/base_color: nan/'
refused 3 "scene.yaml:8:"
edited 's/material: grey/material: gray/'
refused 3 "did you mean 'grey'"
edited 's/base_color: 0.5/base_color: { texture: nowhere.png }/'
refused 3 "nowhere.png"
edited 's/^tsuya: 1/tsuya: 1\ninclude: [scene.yaml]/'
refused 3 "scene.yaml"
edited 's/shape: sphere, radius: 0.01, divisions: 16/mesh: missing.ply/'
refused 3 "missing.ply"
edited 's/look_at: \[0, 0, 0\]/look_at: [0, 0, 0.1]/'
refused 3 "scene.yaml:4"
edited 's/radius: 0.01/radius: -0.01/'
refused 3 "scene.yaml:6"

# Six mistakes, all told at once.
cat >scene.yaml <<'Y'
tsuya: 1
film: { size: [32, 18], filtre: box }
render: { samples: 99999999 }
camera: { position: [0, 0], look_at: [0, 0, 0] }
assets:
  ball: { shape: spheer, radius: 0.01 }
materials:
  grey: { model: surface, base_color: { texture: missing.png } }
objects:
  - { mesh: ball, material: gery }
lights:
  - { type: environment, radiance: 1 }
Y
expect 3 "$tsuya" check scene.yaml
for place in 2:25 3:20 4:21 6:18 8:50 10:29; do
    says "scene.yaml:$place:"
done
expect 3 "$tsuya" check scene.yaml --json
prints '"ok": false'
# A message that is cut within a character is told as well.
for name in '' x xy; do
    expect 3 "$tsuya" check scene.yaml --json --set "objects.0.material=$name$(printf '米%.0s' $(seq 150))"
    [ "$(grep -c '"text": "no material' out.txt)" -eq 1 ] || fail "a mistake is missing in the JSON"
done

# Meshes.
mesh() { edited 's/shape: sphere, radius: 0.01, divisions: 16/mesh: bad.ply/'; }
ply() { # VERTEX_COUNT FACE
    printf 'ply\nformat ascii 1.0\nelement vertex %s\nproperty float x\nproperty float y\nproperty float z\n' "$1"
    printf 'element face 1\nproperty list uchar int vertex_indices\nend_header\n%s\n' "$2"
}
mesh
: >bad.ply
refused 4 "bad.ply"
ply 3 $'0 0 0\n1 0 0\n0 1 0\n3 0 1 2' >bad.ply
expect 0 "$tsuya" info bad.ply
ply 3 $'0 0 0\n1 0 nan\n0 1 0\n3 0 1 2' >bad.ply
refused 4 "bad.ply"
ply 3 $'0 0 0\n1 0 0\n0 1 0\n3 0 1 7' >bad.ply
refused 4 "7"
ply 3 $'0 0 0\n1 0 0\n2 0 0\n3 0 1 2' >bad.ply
refused 4 "area"
ply 180000000 $'0 0 0' >bad.ply
refused 4 "bad.ply"
ply 3 $'0 0 0\n1 0 0' >bad.ply
refused 4 "bad.ply"
edited 's/shape: sphere, radius: 0.01, divisions: 16/mesh: bad.obj/'
printf 'v 0 0 0\nf 1 2 3\n' >bad.obj
refused 4 "bad.obj"

# Aggregates, pictures and textures that are cut short or lie.
edited 's/ball: \{.*/heap: { aggregate: bad.glb }/; s/mesh: ball/aggregate: heap/'
printf 'glTF\2\0\0\0\377\377\377\177' >bad.glb
refused 4 "bad.glb"
: >bad.glb
refused 4 "bad.glb"
head -c 300 good.exr >cut.exr
expect 4 "$tsuya" develop cut.exr -o cut.png
says "cut.exr"
absent cut.png
expect 4 "$tsuya" info cut.exr
expect 0 "$tsuya" develop good.exr -o good.png
head -c 60 good.png >bad.png
edited 's/base_color: 0.5/base_color: { texture: bad.png }/'
refused 4 "bad.png"

# Outputs.
base >scene.yaml
expect 4 "$tsuya" render scene.yaml -o nowhere/out.exr
says "nowhere"
expect 4 "$tsuya" render scene.yaml -o /proc/out.exr
expect 4 "$tsuya" render scene.yaml -o out.exr --stats nowhere/s.json
expect 3 "$tsuya" render scene.yaml -o out.exr --develop --view nope
says "unknown view 'nope'; known: ACES 1.0 SDR"
expect 3 "$tsuya" render scene.yaml -o out.####.exr --frames 1-2 --video v.mp4 --display nope
absent out.0001.exr
absent out.exr
printf 'tsuya: 1\nkind: aggregate\nfill: { count: 20 }\n' >recipe.yaml
expect 4 timeout 20 "$tsuya" pack recipe.yaml -o nowhere/heap.glb
grep -q aggregate err.txt && fail "packed before the output was looked at"
mkdir folder.exr
expect 4 "$tsuya" render scene.yaml -o folder.exr
cp good.exr kept.exr
expect 4 bash -c 'ulimit -f 1; exec "$0" render scene.yaml -o kept.exr --size 256x144 --spp 1' "$tsuya"
same good.exr kept.exr

# A disk that is full while a texture is converted ends the program, and leaves nothing in the cache.
{ printf 'P6 300 200 255\n'; head -c 180000 "$tsuya"; } >noise.ppm
edited 's/base_color: 0.5/base_color: { texture: noise.ppm, mapping: triplanar }/'
mkdir full
expect 4 timeout -k 1 60 bash -c 'ulimit -f 64; exec "$0" render scene.yaml -o noisy.exr --cache full --spp 1' "$tsuya"
says "converted texture"
[ -z "$(ls -A full)" ] || fail "left in the cache: $(ls -A full)"
expect 0 "$tsuya" render scene.yaml -o noisy.exr --cache full --spp 1

# Nothing to see is no mistake, but is said.
edited 's/^lights:/lights: []/; s/^  - \{ type.*//'
expect 0 "$tsuya" check scene.yaml
says "no lights"
edited 's/^objects:/objects: []/; s/^  - \{ mesh.*//'
expect 0 "$tsuya" check scene.yaml
says "no objects"
base >scene.yaml

# A reader that leaves early needs no message.
"$tsuya" params 2>err.txt | true
[ ! -s err.txt ] || fail "a message about a closed pipe"

# A cache that cannot be written costs time, not the picture.
printf 'tsuya: 1\nkind: aggregate\nfill: { count: 20 }\n' >heap.yaml
edited 's/ball: \{.*/heap: { aggregate: heap.yaml }/; s/mesh: ball/aggregate: heap/'
expect 0 "$tsuya" render scene.yaml -o uncached.exr --cache /proc/nowhere
says "cannot be kept"
base >scene.yaml

# The command line.
expect 2 "$tsuya"
expect 2 "$tsuya" rendr scene.yaml
says "did you mean 'render'"
expect 2 "$tsuya" render
expect 2 "$tsuya" render scene.yaml --samplse 1-2
says "did you mean '--samples'"
expect 2 "$tsuya" render scene.yaml --spp nine
expect 2 "$tsuya" render scene.yaml --spp 9x
expect 2 "$tsuya" render scene.yaml --size 10
expect 2 "$tsuya" render scene.yaml --crop 0,0,32,17
says "--crop: '0,0,32,17'"
expect 2 "$tsuya" render scene.yaml --crop 0,0,31,18
says "--crop: '0,0,31,18'"
expect 0 "$tsuya" render scene.yaml --crop 31,17,31,17 --dry-run
expect 2 "$tsuya" render scene.yaml --samples 3-9
expect 2 "$tsuya" render scene.yaml -o out.png
for wrapped in "--size 4294967297x2" "--crop 4294967296,0,4294967297,2" "--samples 4294967296-4294967297" "--isa mmx"; do
    # shellcheck disable=SC2086
    expect 2 "$tsuya" render scene.yaml -o out.exr $wrapped
done
expect 2 "$tsuya" pack recipe.yaml -o out.exr
says "must end in .glb"
expect 0 "$tsuya" render scene.yaml -o precise.exr --quick --spp 3
says "3 samples"
expect 3 "$tsuya" render scene.yaml --set render.sampels=3
says "did you mean"
expect 3 "$tsuya" render scene.yaml -D wetness=3
expect 4 "$tsuya" render missing.yaml
says "missing.yaml"
expect 0 "$tsuya" --help
expect 0 "$tsuya" render --help
expect 0 "$tsuya" render scene.yaml --dry-run
prints "would render"
expect 2 "$tsuya" params camrea
says "did you mean 'camera'"
expect 0 "$tsuya" params camera
prints "vfov"
expect 0 "$tsuya" params --schema
expect 0 "$tsuya" doctor
absent out.exr
