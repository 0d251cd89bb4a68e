# SPDX-License-Identifier: Apache-2.0
# Filtered pictures as a user makes them: what is refused with its place, stops and resumes, sequences, textures.
scenes=$TSUYA_SOURCE/scenes/filter_seed
cp "$scenes"/photo.jpg "$scenes"/disc.png .
cat >filter.yaml <<'Y'
tsuya: 1
kind: filter
image: photo.jpg
time: 100
Y

# What is wrong with a command or a recipe, where, and what would be right; nothing is written.
expect 2 "$tsuya" filter filter.yaml
says "-o OUT.png"
expect 2 "$tsuya" filter filter.yaml -o x.jpg
says "must end in .exr, .png, .gif, .mp4, .mov or .mkv"
expect 2 "$tsuya" filter filter.yaml -o 'x.#.mp4'
says "the film 'x.#.mp4' is one file: it has no #"
expect 2 env PATH=/nowhere "$tsuya" filter filter.yaml -o x.mp4
says "there is no ffmpeg in PATH"
expect 2 "$tsuya" filter filter.yaml -o x.mp4 --resume state.exr
says "a film begins at its beginning"
expect 2 "$tsuya" filter filter.yaml photo.jpg photo.jpg -o x.png
expect 2 "$tsuya" filter filter.yaml -o x.png --set frames=3
says "3 frames do not go into 'x.png'"
expect 2 "$tsuya" filter filter.yaml -o x.png --state state.png
expect 4 "$tsuya" filter filter.yaml -o nowhere/x.png
expect 3 "$tsuya" filter filter.yaml nothing.jpg -o x.png
says "nothing.jpg"
expect 3 "$tsuya" filter filter.yaml -o x.png --set 'image=in.####.png'
says "no frame of 'in.####.png'"
printf 'tsuya: 1\nkind: filter\nimage: photo.jpg\npreset: sports\ntime_step: 0.6\nalong: { strength: 0.8 }\n' >bad.yaml
expect 3 "$tsuya" filter bad.yaml -o x.png
says "bad.yaml:4:9: 'preset': 'sports' is not one of"
says "did you mean 'spots'?"
says "bad.yaml:6:20: 'strength' is 0.8: out of range, expected a number 0..0.7"
printf 'tsuya: 1\nkind: filter\nimage: photo.jpg\ntime_step: 0.6\n' >bad.yaml
expect 3 "$tsuya" filter bad.yaml -o x.png
says "bad.yaml:4:1: time_step: 0.6; with these diffusions it lies above 0 and up to 0.4926"
printf 'tsuya: 1\nkind: filter\nimage: photo.jpg\nregions:\n  - { boundary: free, mask: disc.png }\n' >bad.yaml
expect 3 "$tsuya" filter bad.yaml -o x.png
says "bad.yaml:5:23: regions[0].mask: './disc.png' has 200 x 200 pixels; the field has 300 x 300 cells"
printf 'no picture' >photo.png
expect 4 "$tsuya" filter filter.yaml photo.png -o x.png
absent x.png

# One picture: the same from either end, for any number of threads, with its recipe inside.
expect 0 "$tsuya" filter filter.yaml -o one.exr --threads 1
expect 0 "$tsuya" filter filter.yaml -o three.exr --threads 3
same one.exr three.exr
mkdir -p away
(cd away && expect 0 "$tsuya" filter ../filter.yaml ../photo.jpg -o ../away.png)
expect 0 "$tsuya" filter filter.yaml -o here.png
same away.png here.png
expect 0 "$tsuya" info one.exr --recipe
cp out.txt again.yaml
expect 0 "$tsuya" filter again.yaml -o again.exr
same one.exr again.exr

# Frames in, frames out; one that is missing is told.
for i in 1 2 4; do cp photo.jpg in.$i.jpg; done
expect 3 "$tsuya" filter filter.yaml 'in.#.jpg' -o 'out.#.png'
says "lacks 1 of the frames 1..4: 3"
cp photo.jpg in.3.jpg
expect 0 "$tsuya" filter filter.yaml 'in.#.jpg' -o 'out.#.png' --set time_per_frame=20
for i in 1 2 3 4; do [ -s out.$i.png ] || fail "no out.$i.png"; done
absent out.5.png
same out.1.png here.png
if command -v ffmpeg >/dev/null; then
    expect 0 "$tsuya" filter filter.yaml 'in.#.jpg' -o film.mp4 --set time_per_frame=20 --fps 12
    frames=$(ffmpeg -v error -i film.mp4 -f framemd5 - | grep -vc '^#')
    [ "$frames" -eq 4 ] || fail "film.mp4 has $frames frames"
    [ -z "$(find . -name 'film*frames*')" ] || fail "frames of the film are left"
fi

# From a state that was kept the picture is the same. Stopped by a signal, nothing is written but that.
expect 0 "$tsuya" filter filter.yaml -o early.exr --state state.exr
expect 0 "$tsuya" filter filter.yaml -o late.exr --set time=150
expect 0 "$tsuya" filter filter.yaml -o resumed.exr --set time=150 --resume state.exr
same late.exr resumed.exr
expect 130 timeout --preserve-status -s INT 3 "$tsuya" filter filter.yaml -o stopped.exr --set time=1000000 \
    --set 'cells=[600,600]' --state state.exr
says "interrupted at step"
absent stopped.exr
expect 0 "$tsuya" info state.exr --json
prints '"tsuya/step"'
expect 3 "$tsuya" filter filter.yaml -o no.exr --resume state.exr
says "cells: [300, 300]; the state to go on from has 600 x 600"
expect 3 "$tsuya" filter filter.yaml -o no.exr --set seed=3 --set u.decay=0.04 --resume state.exr --set 'cells=[600,600]'
says "u.decay: differs from that of the state to go on from; so do seed"
expect 4 "$tsuya" filter filter.yaml -o no.exr --resume one.exr
says "not one of a filter"
absent no.exr

# A texture of a scene, of a file and in place, by the scene's time.
cat >scene.yaml <<'Y'
tsuya: 1
film: { size: [32, 24] }
render: { samples: 4 }
camera: { position: [0, 0.05, 0.2], look_at: [0, 0, 0], vfov: 30 }
assets:
  skin: { frames: { kind: filter, cells: [48, 48], mode: plain, edges: wrap, time: 400, frames: 3 }, loop: true }
  picture: { frames: filter.yaml, hold: true }
  ball: { shape: sphere, radius: 0.03, divisions: 16 }
materials:
  skin: { model: surface, base_color: { texture: skin }, specular_roughness: { texture: picture, scale: 0.5 } }
objects: [ { mesh: ball, material: skin } ]
lights: [ { type: environment, radiance: 1 } ]
Y
expect 0 "$tsuya" render scene.yaml -o 'f.#.exr' --frames 1,2,4
expect 0 "$tsuya" compare f.1.exr f.4.exr --fail 'rmse>0'
expect 1 "$tsuya" compare f.1.exr f.2.exr --fail 'rmse>0'
