# SPDX-License-Identifier: Apache-2.0
# Recipes of meshes and frames: their commands, what they refuse, what they leave, and a loop that closes in the picture.
cat >fill.yaml <<'Y'
tsuya: 1
kind: fill
cells: [64, 48]
scale: 1
tile: around
steps: 600
drops: { count: 4 }
loop: { frames: 6, span: 300, drift: 3 }
Y
printf 'tsuya: 1\nkind: roots\ncount: 3\nsecond: { spacing: 0 }\ntip: 2\ndetail: 2\n' >roots.yaml

expect 2 "$tsuya" fill fill.yaml
says "-o OUT.####.exr"
expect 2 "$tsuya" fill fill.yaml -o out.exr
says "####"
expect 2 "$tsuya" fill fill.yaml -o 'out.####.jpg'
says ".exr"
expect 2 "$tsuya" roots roots.yaml -o roots.stl
expect 2 "$tsuya" roots roots.yaml -o 'roots.##.exr'
expect 3 "$tsuya" roots fill.yaml -o x.ply
says "fill.yaml:2:7"
says "expected a recipe of kind 'roots', got 'fill'"
expect 3 "$tsuya" fill fill.yaml -o 'x.##.exr' --set loop.span=601
says "loop.span"
expect 3 "$tsuya" roots roots.yaml -o x.ply --set secund.spacing=1
says "did you mean 'second'?"
absent x.ply
absent x.01.exr
expect 4 "$tsuya" fill fill.yaml -o 'nowhere/x.##.exr'
says "nowhere"

# Eggs of fish: what they are not is said with place and range.
cat >roe.yaml <<'Y'
tsuya: 1
kind: aggregate
element: { kind: roe, roe: { preset: ikra, diameter: 60, yolk: 0.9, lien: 3 } }
Y
expect 3 "$tsuya" pack roe.yaml -o roe.glb
says "roe.yaml:3:38: 'preset': 'ikra' is not one of"
says "did you mean 'ikura'?"
says "roe.yaml:3:54: 'diameter' is 60: out of range, expected a number 0..50 mm"
says "'yolk' is 0.9: out of range, expected a number 0..0.5"
says "unknown key 'lien' in aggregate.element.roe"
printf 'tsuya: 1\nkind: aggregate\nelement: { kind: roe, roe: { membrane: 3 } }\n' >roe.yaml
expect 3 "$tsuya" pack roe.yaml -o roe.glb
says "element.roe.membrane: 3 mm; with a diameter of 6.2 mm it lies in 0.0062..0.62"
absent roe.glb

for threads in 1 3; do
    expect 0 "$tsuya" fill fill.yaml -o "t$threads.##.exr" --threads $threads
    expect 0 "$tsuya" roots roots.yaml -o "t$threads.ply" --threads $threads
done
same t1.01.exr t3.01.exr
same t1.06.exr t3.06.exr
absent t1.07.exr
same t1.ply t3.ply

# What was made tells how, and that makes it again.
expect 0 "$tsuya" info t1.ply --recipe
cp out.txt again.yaml
expect 0 "$tsuya" roots again.yaml -o again.ply
same t1.ply again.ply
expect 0 "$tsuya" info t1.03.exr --recipe
cp out.txt again.yaml
expect 0 "$tsuya" fill again.yaml -o 'again.##.exr'
same t1.03.exr again.03.exr
expect 0 "$tsuya" info t1.ply
prints "closed: true"

# The loop closes in the picture: frame 7 is frame 1, and the frames between are others.
cat >scene.yaml <<'Y'
tsuya: 1
film: { size: [32, 24] }
render: { samples: 4 }
camera: { position: [0, 0.05, 0.2], look_at: [0, 0, 0], vfov: 30 }
assets:
  roots: { mesh: roots.yaml }
  living: { frames: fill.yaml, fps: 24, loop: true }
  pot: { shape: cylinder, radius: 0.02, height: 0.05 }
materials:
  glaze: { model: surface, base_color: { texture: living } }
  bark: { model: surface, base_color: 0.4 }
objects:
  - { mesh: pot, material: glaze, translate: [-0.03, 0, 0] }
  - { mesh: roots, material: bark, translate: [0.04, 0, 0] }
lights:
  - { type: environment, radiance: 1 }
Y
expect 0 "$tsuya" render scene.yaml -o 'f.##.exr' --frames 1,4,7
expect 0 "$tsuya" compare f.01.exr f.07.exr --fail 'rmse>0'
expect 1 "$tsuya" compare f.01.exr f.04.exr --fail 'rmse>0'
ls -d cache/*.frames >list.txt
[ "$(wc -l <list.txt)" -eq 1 ] || fail "one folder of frames is kept"

# Stopped in the middle, frames leave neither a folder nor a part of one.
expect 130 timeout --preserve-status -s INT 1 "$tsuya" render scene.yaml -o stopped.exr --set assets.living.frames.cells=[2048,2048] \
    --set assets.living.frames.steps=100000
absent stopped.exr
ls -d cache/*.frames >again.txt
same list.txt again.txt

# One element alone, as a mesh.
printf 'tsuya: 1\nkind: aggregate\nelement: { kind: bean, variants: 3 }\n' >bean.yaml
expect 0 "$tsuya" pack bean.yaml --element 3 -o bean.ply
expect 0 "$tsuya" info bean.ply
expect 2 "$tsuya" pack bean.yaml --element 3 -o bean.glb
says ".ply"
expect 2 "$tsuya" pack bean.yaml --element 0 -o none.ply
expect 3 "$tsuya" pack bean.yaml --element 4 -o none.ply
says "the recipe has 1..3"
absent none.ply
