# SPDX-License-Identifier: Apache-2.0
# Animations: frames of one load, their names, their bytes; turntables that close; videos; going on after a stop.
cat >scene.yaml <<'Y'
tsuya: 1
film: { size: [41, 25] }
render: { samples: 16, seed: 3 }
timeline: { start: 1, end: 4, fps: 24 }
camera: { position: { keys: { 1: [0, 0.05, 0.12], 5: [0.05, 0.05, 0.12] }, interpolate: smooth, after: mirror },
          look_at: [0, 0.01, 0], vfov: 40, shutter: 0.5, f_stop: 2, blades: 6 }
assets:
  ball: { shape: sphere, radius: 0.01, divisions: 32 }
  floor: { shape: plane, size: [0.1, 0, 0.1] }
materials:
  skin: { model: cdrf, color: [0.8, 0.7, 0.6], mean_free_path: 1.5 }
  grey: { model: surface, base_color: { keys: { 1: 0.5, 3: 0.7 } } }
objects:
  - { mesh: ball, material: skin, translate: { keys: { 1: [-0.012, 0.01, 0], 3: [0.02, 0.01, 0], 5: [-0.012, 0.01, 0] }, after: loop } }
  - { mesh: floor, material: grey }
lights:
  - { type: environment, radiance: 0.3 }
  - { type: rectangle, center: [-0.1, 0.1, 0], target: [0, 0, 0], size: [0.05, 0.05], radiance: 10 }
Y
# pixels FILE FILE: the same channels, bit by bit (recipes and frame numbers differ)
pixels() {
    "$tsuya" compare "$1" "$2" --layer all --metric max --fail 'max>0' >out.txt 2>err.txt || fail "pixels of $1 and $2 differ"
}

expect 0 "$tsuya" render scene.yaml --frames all -o f.%04d.exr --develop --stats stats.json --progress none
says "frame 4 (4 of 4)"
prints f.0004.png
for frame in 1 2 3 4; do [ -s f.000$frame.png ] || fail "f.000$frame.png is missing"; done
grep -q '"worlds": 3' stats.json || fail "the world was not rebuilt once a frame"
grep -q '"cameras": 3' stats.json || fail "the camera was not read once a frame"
grep -q '"materials": 2' stats.json || fail "the material was not made for each of its values"
grep -q '"assets_made": 0' stats.json || fail "assets were made"

# A frame is the same by itself, by its recipe, with other threads, in another order, and from its parts.
expect 0 "$tsuya" render scene.yaml --frames 3 -o one.exr --progress none --threads 1
same one.exr f.0003.exr
expect 0 "$tsuya" info f.0003.exr --recipe
cp out.txt again.yaml
grep -q '^frame: 3$' again.yaml || fail "the recipe does not tell its frame"
expect 0 "$tsuya" render again.yaml -o again.exr --progress none --threads 3
same again.exr f.0003.exr
expect 0 "$tsuya" render scene.yaml --frames 4,1-3:2 -o o.#.exr --progress none
same o.3.exr f.0003.exr
absent o.2.exr
expect 0 "$tsuya" render scene.yaml --frames 2-3 -o a.#.exr --samples 0-7 --progress none
expect 0 "$tsuya" render scene.yaml --frames 2-3 -o b.#.exr --samples 8-15 --progress none
expect 0 "$tsuya" merge a.3.exr b.3.exr -o merged.exr
same merged.exr f.0003.exr
expect 4 "$tsuya" merge a.2.exr b.3.exr -o merged.exr
expect 0 "$tsuya" render scene.yaml --frames 3 -o crop.exr --crop 10,5,30,20 --progress none
expect 0 "$tsuya" render scene.yaml --frames 3 -o crop1.exr --crop 10,5,30,20 --progress none --threads 1
same crop.exr crop1.exr

# Existing frames stay if they are of this very scene.
rm f.0002.exr f.0003.png
touch -d '2001-01-01' f.0001.exr f.0003.exr
expect 0 "$tsuya" render scene.yaml --frames 1-3 -o f.####.exr --develop --skip-existing --progress none
[ -s f.0002.exr ] && [ -s f.0003.png ] || fail "what was missing was not made"
[ -z "$(find f.0001.exr f.0003.exr -newermt '2002-01-01')" ] || fail "an existing frame was rendered again"
expect 0 "$tsuya" render scene.yaml --frames 1-3 -o f.####.exr --skip-existing --progress none --seed 4
[ -n "$(find f.0001.exr -newermt '2002-01-01')" ] || fail "a frame of another scene was taken for this one's"

# So do those with the channels asked for, no fewer and no more; what is developed from them is as asked for.
key=(render scene.yaml --frames 1 -o k.#.exr --skip-existing --progress none --size 16x16 --spp 2)
expect 0 "$tsuya" "${key[@]}" --aov Z,albedo
for channels in Z,albedo Z,N Z all all none Z,albedo light light 'Z,albedo'; do
    touch -d '2001-01-01' k.1.exr
    expect 0 "$tsuya" "${key[@]}" --aov "$channels" --set lights.1.group=window
    [ -n "$(find k.1.exr -newermt '2002-01-01')" ] && made=1 || made=0
    [ "$channels" = "${before:-}" ] && again=0 || again=1
    [ $made -eq $again ] || fail "--skip-existing: $channels after ${before:-another scene}: made $made, expected $again"
    before=$channels
done
expect 0 "$tsuya" "${key[@]}" --aov Z,albedo --samples 0-0
touch -d '2001-01-01' k.1.exr
expect 0 "$tsuya" "${key[@]}" --aov Z,albedo --samples 0-0
[ -z "$(find k.1.exr -newermt '2002-01-01')" ] || fail "a part that is there was rendered again"
expect 0 "$tsuya" "${key[@]}" --aov none --develop
cp k.1.png dark.png
expect 0 "$tsuya" "${key[@]}" --aov none --develop --exposure 2
cmp -s dark.png k.1.png && fail "the picture was not developed as asked for"

# Mistakes, before anything is rendered.
expect 2 "$tsuya" render scene.yaml --frames 1-3 -o plain.exr
says "####"
for list in 3-1 1-4:0 1,,2 x 1- 1-3: 99999999 1-9999999 '' 1.5; do
    expect 2 "$tsuya" render scene.yaml --frames "$list" -o g.#.exr
    says "--frames"
done
expect 2 "$tsuya" render scene.yaml -o g.exr --video g.mp4
says "--video needs frames"
expect 2 "$tsuya" render scene.yaml --frames 1-2 -o g.#.exr --video g.avi
says ".mp4"
for how in 'render --dry-run -o g.#.exr' 'render -o g.#.exr' check; do
    expect 3 "$tsuya" $how scene.yaml --frames 1,3-7:2,8,9 --set 'camera.vfov={ keys: { 1: 20, 4: 20 }, after: error }'
    says "4 of the 6 frames are outside of the keys, which go from 1 to 4: 5, 7-9"
    absent g.1.exr
done
expect 3 "$tsuya" render scene.yaml --frames all -o g.#.exr --set timeline.start=9
says "'end' is 4"

# Sequences that end before the frames asked for: with all of them, before the first is rendered.
mkdir -p fill
for i in 1 2 3; do cp f.0001.png fill/$i.png; done
sequence=(--set 'assets.fill={ frames: "fill/#.png", fps: 24 }' --set 'materials.grey.base_color={ texture: fill }' --set film.size=[16,16] --set render.samples=1)
for how in 'render --dry-run -o g.#.exr' 'render -o g.#.exr' check; do
    expect 3 "$tsuya" $how scene.yaml --frames 0,2-6:2,7 "${sequence[@]}"
    says "4 of the 5 frames are outside of the sequence's 0 to 0.125 s: 0, 4, 6-7; say loop, hold or mirror"
    absent g.2.exr
    expect 0 "$tsuya" $how scene.yaml --frames 2-3 "${sequence[@]}"
    rm -f g.2.exr g.3.exr
done
expect 3 "$tsuya" render scene.yaml --frames all -o g.#.exr "${sequence[@]}"
says "1 of the 4 frames are outside of the sequence's 0 to 0.125 s: 4;"
expect 3 "$tsuya" check scene.yaml "${sequence[@]}"
says "frame 4 of the timeline"
expect 2 "$tsuya" check scene.yaml --frames 3-1
says "--frames"

# What only a later frame shows leaves those before it.
echo 'no picture' >fill/3.png
expect 4 "$tsuya" render scene.yaml --frames 2-3 -o g.#.exr --progress none "${sequence[@]}"
[ -s g.2.exr ] || fail "the frame before the mistake is gone"
absent g.3.exr
rm g.2.exr
expect 0 "$tsuya" render scene.yaml --frames all --dry-run
prints "4 frames: 1 to 4"

# A turn closes: one frame more is the first again, bit for bit; the middle is not.
turned=(--size 40x24 --spp 16 --progress none --set 'camera.position=[0, 0.05, 0.12]' --set 'objects.0.translate=[0, 0.01, 0]')
for what in camera objects; do
    expect 0 "$tsuya" turntable scene.yaml --frames 4 --turn $what -o t.#.exr "${turned[@]}" --set 'materials.grey.base_color=0.5'
    expect 0 "$tsuya" info t.1.exr --recipe
    cp out.txt turn.yaml
    expect 0 "$tsuya" render turn.yaml --frames 1,5 -o u.#.exr --progress none
    same u.1.exr t.1.exr
    pixels u.5.exr t.1.exr
    cmp -s t.3.exr t.1.exr && fail "nothing turned"
    absent t.5.exr
done
# Its frames are the timeline's, whatever number that begins with, and the same pictures.
for start in 1001 -2; do
    expect 0 "$tsuya" turntable scene.yaml --frames 4 --turn objects -o n.#.exr "${turned[@]}" --set 'materials.grey.base_color=0.5' \
        --set timeline.start=$start --set timeline.end=1100
    pixels n.$start.exr t.1.exr
    pixels n.$((start + 3)).exr t.4.exr
    absent n.$((start - 1)).exr
    absent n.$((start + 4)).exr
done
expect 2 "$tsuya" turntable scene.yaml --frames 4 -o n.#.exr --set timeline.start=9999998 --set timeline.end=9999999
says "beyond 10000000"
expect 3 "$tsuya" turntable scene.yaml --frames 4 -o n.#.exr --set timeline.start=9 --set film.size=no
says "'end' is 4"
says "'size'"
expect 2 "$tsuya" turntable scene.yaml --about 1,2
says "x,y,z"
expect 2 "$tsuya" turntable scene.yaml --turn lights
expect 3 "$tsuya" turntable scene.yaml --axis 0,0,0 --dry-run
says "'axis' has no direction"

# The loop of the scene closes, too: frame 5 is frame 1.
expect 0 "$tsuya" render scene.yaml --frames 1,9 -o l.#.exr --progress none --set 'materials.grey.base_color=0.5'
pixels l.1.exr l.9.exr
expect 0 "$tsuya" render scene.yaml --frames 1,9 -o l.#.exr --progress none --set 'materials.grey.base_color=0.5' --set render.animate_seed=true
"$tsuya" compare l.1.exr l.9.exr --layer all --metric max --fail 'max>0' >out.txt 2>err.txt && fail "the noise does not move"

# A video gets every picture once, in order, and is there only when ffmpeg was content.
mkdir -p bin empty
cat >bin/ffmpeg <<'F'
#!/bin/sh
for last; do :; done
echo "$@" >arguments.txt
cat >"${last#file:}"
exit "${FFMPEG_STATUS:-0}"
F
chmod +x bin/ffmpeg
small=(--size 16x16 --spp 4 --progress none)
expect 0 env PATH="$PWD/bin:$PATH" "$tsuya" render scene.yaml --frames 1-3 -o v.#.exr --video v.mp4 "${small[@]}" --set timeline.fps=23.976
cat v.1.png v.2.png v.3.png | cmp -s - v.mp4 || fail "the video is not of its three frames"
grep -q -- '-framerate 23.976' arguments.txt || fail "the frame rate is not the timeline's"
expect 4 env PATH="$PWD/bin:$PATH" FFMPEG_STATUS=1 "$tsuya" render scene.yaml --frames 1-2 -o v.#.exr --video w.mp4 "${small[@]}"
says "ffmpeg could not make 'w.mp4' (status 1)"
absent w.mp4
expect 0 env PATH="$PWD/empty" "$tsuya" render scene.yaml --frames 1-2 -o v.#.exr --video w.mp4 "${small[@]}"
says "no ffmpeg in PATH"
absent w.mp4
if command -v ffmpeg >/dev/null; then
    expect 0 "$tsuya" turntable scene.yaml --frames 6 -o v.#.exr --video turn.mp4 --size 33x17 --spp 4 --progress none
    [ "$(head -c 8 turn.mp4 | tail -c 4)" = ftyp ] || fail "turn.mp4 is no video"
fi

# A stop leaves complete frames, and the one in work marked as partial; going on makes the same bytes.
expect 0 "$tsuya" render scene.yaml --frames 1-3 -o s.#.exr --spp 64 --progress none
"$tsuya" render scene.yaml --frames 1-3 -o r.#.exr --spp 64 --progress none --threads 1 >out.txt 2>err.txt &
job=$!
for _ in $(seq 200); do [ -e r.1.exr ] && break; sleep 0.02; done
kill -TERM $job
wait $job
[ $? -eq 143 ] || fail "the stop was not told by the status"
expect 0 "$tsuya" render scene.yaml --frames 1-3 -o r.#.exr --spp 64 --skip-existing --progress none
for frame in 1 2 3; do same r.$frame.exr s.$frame.exr; done
