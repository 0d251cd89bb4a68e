# SPDX-License-Identifier: Apache-2.0
# Sweeps: cells and their names, what is up to date, cells that fail, mistakes before the first picture, commands that
# repeat a cell bit for bit.
cat >scene.yaml <<'Y'
tsuya: 1
film: { size: [32, 24] }
render: { samples: 8, seed: 3 }
vars: { moisture: 0.5, angle: 30 }
camera: { position: [0, 0.05, 0.12], look_at: [0, 0.01, 0], vfov: $angle }
assets:
  ball: { shape: sphere, radius: 0.01, divisions: 16 }
  unused: { shape: plane, size: [0.1, 0, 0.1] }
materials:
  skin: { model: cdrf, color: [0.8, 0.7, 0.6], moisture: $moisture }
objects:
  - { mesh: ball, material: skin, translate: [0, 0.01, 0] }
lights:
  - { type: environment, radiance: 0.3 }
  - { type: rectangle, center: [-0.1, 0.1, 0], target: [0, 0, 0], size: [0.05, 0.05], radiance: 10 }
Y

# Three by four, and each cell again by the command that it comes with.
grid=(sweep scene.yaml --vary moisture=0.1:0.9:3 --vary lights.1.radiance=1:8:4:log -o grid --progress none --threads 2)
expect 0 "$tsuya" "${grid[@]}"
says "12 of 12 cells are complete"
[ "$(ls grid/*.exr | grep -c 'moisture=')" -eq 12 ] || fail "twelve cells expected"
[ -s 'grid/moisture=0.5,lights.1.radiance=4.exr' ] || fail "a cell's name is not its values"
expect 0 "$tsuya" "${grid[@]}" --dry-run
cp out.txt commands.txt
[ "$(wc -l <commands.txt)" -eq 12 ] || fail "twelve commands expected"
says "12 of them up to date"
tsuya() { "$tsuya" "$@"; }
while IFS= read -r command; do
    cell=${command##* -o }
    eval "$command -o again.exr --progress none --threads 1" >out.txt 2>err.txt || fail "$command"
    same again.exr "$cell"
done <commands.txt
grep -q '"command": "tsuya render scene.yaml -D moisture=0.1 --set lights.1.radiance=1 -o grid/' grid/sweep.json ||
    fail "the record does not tell the command"

# What is up to date stays; what is missing, damaged or of another scene is made, and nothing else.
old() { touch -d '2001-01-01' "$1"/*.exr; }
made() { find "$1" -name '*=*.exr' -newermt '2002-01-01' | wc -l; }
old grid
expect 0 "$tsuya" "${grid[@]}"
[ "$(made grid)" -eq 0 ] || fail "cells were rendered again"
says "up to date"
rm 'grid/moisture=0.1,lights.1.radiance=1.exr'
head -c 500 'grid/moisture=0.9,lights.1.radiance=8.exr' >cut && mv cut 'grid/moisture=0.9,lights.1.radiance=8.exr'
old grid
expect 0 "$tsuya" "${grid[@]}"
[ "$(made grid)" -eq 2 ] || fail "$(made grid) cells were made, expected 2"
old grid
expect 0 "$tsuya" sweep scene.yaml --vary moisture=0.1,0.5,0.7 --vary lights.1.radiance=2,4,8 -o grid --progress none
[ "$(made grid)" -eq 3 ] || fail "a larger grid makes what it has not: $(made grid), expected 3"
old grid
expect 0 "$tsuya" "${grid[@]}" --aov Z
[ "$(made grid)" -eq 12 ] || fail "other channels are other pictures"
grep -q '"seconds": [0-9]' grid/sweep.json || fail "times are not recorded"

# Options of render, brackets, colours, quotes, PNGs; together instead of every combination.
expect 0 "$tsuya" sweep scene.yaml --zip --vary 'materials.skin.color=[0.5, 0.4, 0.3],[0.8, 0.8, 0.8]' --vary angle=20:40:2 \
    -D moisture=0.3 --set "render.max_depth='4'" --spp 4 --size 20x16 --crop 2,2,11,9 --seed 5 --aov none -o zip --progress none --develop
[ "$(ls zip/*=*.exr | wc -l)" -eq 2 ] || fail "two cells expected"
[ "$(ls zip/*=*.png | wc -l)" -eq 2 ] || fail "two pictures expected"
ls zip | grep -q '[^]a-zA-Z0-9._+=,~-]' && fail "a name that a shell would look into"
expect 0 "$tsuya" sweep scene.yaml --zip --vary 'materials.skin.color=[0.5, 0.4, 0.3],[0.8, 0.8, 0.8]' --vary angle=20:40:2 \
    -D moisture=0.3 --set "render.max_depth='4'" --spp 4 --size 20x16 --crop 2,2,11,9 --seed 5 --aov none -o zip --dry-run
cp out.txt commands.txt
while IFS= read -r command; do
    eval "$command -o again.exr --progress none" >out.txt 2>err.txt || fail "$command"
    same again.exr "$(eval "echo ${command##* -o }")"
done <commands.txt
expect 0 "$tsuya" info again.exr
prints "display_window: [0, 0, 19, 15]"
expect 0 "$tsuya" sweep scene.yaml --vary frame=1,9 -o frames --spp 1 --progress none

# The sheet has a slot a cell and its words, and the same bytes every time.
expect 0 "$tsuya" sweep scene.yaml --vary moisture=0.1,0.5 -o row --progress none
prints row/sheet.png
cp row/sheet.exr first.exr && cp row/sheet.png first.png
expect 0 "$tsuya" sweep scene.yaml --vary moisture=0.1,0.5 -o row --progress none
same row/sheet.exr first.exr
same row/sheet.png first.png
expect 0 "$tsuya" info row/sheet.exr
prints "data_window: [0, 0, 123, 123]"
expect 0 "$tsuya" sweep scene.yaml --vary moisture=0.1,0.5 -o row --progress none --exposure 1
same row/sheet.exr first.exr
cmp -s row/sheet.png first.png && fail "the sheet was not developed as asked for"

# A cell that fails is told and the others are made; the status is its own.
printf 'tsuya: 1\nkind: roots\ncount: 2\nsecond: { spacing: 0 }\nradius: 3\ntip: 2\ndetail: 2\n' >roots.yaml
sed -e 's/unused: .*/roots: { mesh: roots.yaml }/' -e 's/mesh: ball/mesh: roots/' scene.yaml >rooted.yaml
expect 3 "$tsuya" sweep rooted.yaml --vary assets.roots.mesh.tip=2,4,2.5 -o failing --progress none --spp 1
says "tip: 4 mm; it is at most the radius"
says "2 of 3 cells are complete"
[ "$(ls failing/*=*.exr | wc -l)" -eq 2 ] || fail "the cells beside a failing one are missing"
[ -s failing/sheet.png ] || fail "a sheet of the others is missing"
grep -q 'at most the radius' failing/sweep.json || fail "the record does not tell the failure"

# Mistakes, all before the first picture.
bad() {
    local status=$1 text=$2
    shift 2
    expect "$status" "$tsuya" sweep scene.yaml "$@" -o bad --progress none
    says "$text"
    absent bad
}
bad 2 "what varies?"
bad 2 "--vary:1:12: expected a number" --vary moisture=0:x:3
bad 2 "the range is empty" --vary moisture=1:1:4
bad 2 "here are 3, and 2 of" --zip --vary moisture=0.1,0.2 --vary angle=1:3:3
bad 2 "more than 5 cells" --vary moisture=0.1:0.9:6 --most-cells 5
bad 2 "more than 400 cells" --vary moisture=0.1:0.9:21 --vary angle=10:50:20
bad 3 "--vary:1:14: 'moisture' is 7: out of range" --vary moisture=0.1,7
bad 3 "--vary:1:10: 'moisture' is 2: out of range" --vary moisture=0.5:2:2
bad 3 "did you mean 'vfov'" --vary camera.vfow=20,30
bad 3 "no variable 'moistur'" --vary moistur=0.1,0.2
bad 3 "no 'skim' in materials" --vary materials.skim.moisture=0.1,0.2
bad 2 "--spp sets render.samples, which varies" --vary render.samples=1,2 --spp 4
bad 2 "--crop" --vary moisture=0.1,0.2 --crop 0,0,99,99
bad 2 "no cell is called" --vary moisture=0.1,0.2 --reference moisture=0.3
bad 3 "unknown display 'sRGBB'" --vary moisture=0.1,0.2 --display sRGBB
bad 3 "unknown view 'ACES'" --vary moisture=0.1,0.2 --view ACES
bad 2 "varies already" --vary moisture=0.1,0.2 --vary moisture=0.3
expect 2 "$tsuya" sweep scene.yaml --vary moisture=0.1,0.2
says "-o FOLDER"
# A mistake of the scene is told once, not once a cell.
expect 3 "$tsuya" sweep scene.yaml --vary moisture=0.1:0.9:5 --set film.size=no -o bad
[ "$(grep -c "'size'" err.txt)" -eq 1 ] || fail "a mistake is told for every cell"
mkdir taken && mkdir 'taken/moisture=0.2.exr'
expect 4 "$tsuya" sweep scene.yaml --vary moisture=0.1,0.2 -o taken --progress none
absent 'taken/moisture=0.1.exr'

# A stop leaves complete cells; going on makes the others.
"$tsuya" "${grid[@]}" -o stopped --spp 256 --threads 1 >out.txt 2>err.txt &
job=$!
for _ in $(seq 400); do [ -n "$(ls stopped/*.exr 2>/dev/null)" ] && break; sleep 0.02; done
kill -TERM $job
wait $job
[ $? -eq 143 ] || fail "the stop was not told by the status"
says "goes on from there"
# Cells behind the one in work that were complete before are still known to be.
expect 0 "$tsuya" sweep scene.yaml --vary render.samples=2 -o later --progress none
"$tsuya" sweep scene.yaml --vary render.samples=50000,2 -o later --threads 1 --progress lines >out.txt 2>err.txt &
job=$!
for _ in $(seq 400); do grep -q 'render .*%' err.txt && break; sleep 0.02; done
kill -TERM $job
wait $job
says "1 of 2 cells are complete"
grep -q '"picture": "later/render.samples=2.exr"' later/sweep.json || fail "a stop loses a complete cell"
grep -A5 '"picture": "later/render.samples=2.exr"' later/sweep.json | grep -q '"seconds": [0-9]' || fail "a stop loses a cell's time"
