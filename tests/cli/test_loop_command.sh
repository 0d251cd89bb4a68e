# SPDX-License-Identifier: Apache-2.0
# tsuya loop as a user types it: what it refuses and where, frames, films, the report, a loop in a scene.
mark=$TSUYA_SOURCE/scenes/loop_logo/mark.png
cp "$mark" mark.png
cat >loop.yaml <<'Y'
tsuya: 1
kind: loop
volume:
  - source: reaction
    reaction: { logo: mark.png, cells: [48, 48], depth: 25, every: 20 }
    colors: 2
    twist: 30
plane: { size: [1.8, 1.8] }
axis: { direction: [0, 1, 0] }
frames: 6
size: [48, 48]
Y

expect 2 "$tsuya" loop loop.yaml
says "-o OUT.####.exr"
expect 2 "$tsuya" loop loop.yaml -o out.exr
says "####"
expect 2 "$tsuya" loop loop.yaml -o 'out.#.gif'
says "it has no #"
expect 2 "$tsuya" loop loop.yaml -o 'out.#.jpg'
says "must end in .exr, .png, .gif, .mp4, .mov or .mkv"
expect 2 "$tsuya" loop loop.yaml -o 'out.#.png' --fps 0
expect 4 "$tsuya" loop loop.yaml -o 'nowhere/x.#.exr'
expect 2 env PATH=/nowhere "$tsuya" loop loop.yaml -o out.gif
says "no ffmpeg in PATH"

# Every mistake with its place, its range, and nothing written.
refuses() { # TEXT PLACE change...
    local text=$1 place=$2
    shift 2
    expect 3 "$tsuya" loop loop.yaml -o 'x.#.exr' "$@"
    says "$text"
    says "$place"
    absent x.1.exr
}
refuses "'colors' is 17: out of range, expected a number 0..16" '--set:1:17' --set volume.0.colors=17
refuses "axis.direction: [0, 0, 0]; any length but zero" loop.yaml:9: --set axis.direction=[0,0,0]
refuses "plane: at frame 1 it lies outside the volume" loop.yaml:8: --set plane.center=[0,0,4]
refuses "depth: 24; with a logo an odd number" loop.yaml:5: --set volume.0.reaction.depth=24
refuses "volume[0].files: missing" loop.yaml:4: --set volume.0.source=stack
refuses "volume[0].reaction.time_step: 9" --set:1: --set volume.0.reaction.time_step=9
refuses "did you mean 'volume'?" --set:1:1 --set valume=1
refuses "no file 'mork.png'" --set:1:24 --set volume.0.reaction.logo=mork.png
sed 's/logo: mark.png, //; s/colors: 2/range: [2, 3]/' loop.yaml >empty.yaml
expect 3 "$tsuya" loop empty.yaml -o 'x.#.exr'
says "volume: it is empty; its largest number is 0.0000 of its range"
says "empty.yaml:3:"
absent x.1.exr

# Slices by number: the one that is missing is named.
for i in 1 2 4; do cp mark.png s.$i.png; done
printf 'tsuya: 1\nkind: loop\nvolume:\n  - source: stack\n    files: s.#.png\nframes: 2\nsize: [16, 16]\n' >stack.yaml
expect 3 "$tsuya" loop stack.yaml -o 'x.#.exr'
says "lacks 1 of the frames 1..4: 3"
says "stack.yaml:5:"
cp mark.png s.3.png
expect 0 "$tsuya" loop stack.yaml -o 'x.#.exr'
expect 3 "$tsuya" loop loop.yaml -o 'y.#.exr' --sandbox --set volume.0.reaction.logo="$mark"
says "sandbox"

# Frames, the same for any number of threads; the summary, its figures, and a film.
for threads in 1 3; do
    expect 0 "$tsuya" loop loop.yaml -o "t$threads.#.png" --threads $threads
    prints "t$threads.#.png"
    prints "6 frames of 48 x 48 x 25 voxels, 2 colours"
    prints "at the seam"
done
for i in 1 4 6; do same t1.$i.png t3.$i.png; done
absent t1.7.png
expect 0 "$tsuya" loop loop.yaml -o 'j.#.exr' --json --report report.json
cp out.txt printed.json
python3 - <<'P' || fail "the report"
import json
for name in ("printed.json", "report.json"):
    r = json.load(open(name))
    assert r["output"] == "j.#.exr" and r["frames"] == 6 and r["volume"] == [48, 48, 25], r
    assert len(r["steps"]) == 6 and abs(r["steps"][5]["changed"] - r["changed_at_seam"]) < 1e-9
    for step in r["steps"]:
        both = step["overlap"] * step["density"]
        other = step["changed"] - step["density"] + 2 * both  # density of the second
        assert abs(step["jaccard"] - both / (step["density"] + other - both)) < 1e-4, step
    assert r["frames_needed"] > 6
P
says "it will seem to jump;"
if command -v ffmpeg >/dev/null; then
    for film in film.gif film.mp4; do
        expect 0 "$tsuya" loop loop.yaml -o $film --fps 12
        frames=$(ffmpeg -v error -i $film -f framemd5 - | grep -vc '^#')
        [ "$frames" -eq 6 ] || fail "$film has $frames frames"
    done
    [ -z "$(find . -name 'film*frames*')" ] || fail "frames of the film are left"
fi

# What was made tells how; a scene makes it by itself, once.
expect 0 "$tsuya" info j.3.exr --recipe
cp out.txt again.yaml
expect 0 "$tsuya" loop again.yaml -o 'again.#.exr'
same j.3.exr again.3.exr
cat >scene.yaml <<'Y'
tsuya: 1
film: { size: [24, 24] }
camera: { position: [0, 0, 0.5], look_at: [0, 0, 0], vfov: 20 }
timeline: { start: 1, end: 12, fps: 24 }
render: { samples: 4, max_depth: 2 }
assets:
  skin: { frames: loop.yaml, loop: true }
  ball: { shape: sphere, radius: 0.07 }
materials: { m: { model: surface, base_color: { texture: skin } } }
objects: [{ mesh: ball, material: m }]
lights: [{ type: environment, radiance: 1 }]
Y
expect 0 "$tsuya" render scene.yaml -o 'r.##.exr' --frames 1,4,7 --develop
same r.01.png r.07.png
cmp -s r.01.png r.04.png && fail "the texture of frame 4 is that of frame 1"

# Mistakes come before any work: a million steps a slice would take hours.
rm x.*.exr
refuses "axis.direction: [0, 0, 0]; any length but zero" loop.yaml:9: --set axis.direction=[0,0,0] \
    --set volume.0.reaction.every=1000000
head -c 26 /dev/zero >small.raw
printf 'tsuya: 1\nkind: loop\nvolume:\n  - source: raw\n    raw: { file: small.raw, width: 3, height: 3, depth: 3 }\n' >raw.yaml
expect 3 "$tsuya" loop raw.yaml -o 'x.#.exr'
says "has 26 bytes; 3 x 3 x 3 numbers of 1 and a header of 0 are 27"
says "raw.yaml:5:"
absent x.1.exr
cat >fill.yaml <<'Y'
tsuya: 1
kind: loop
volume:
  - source: fill
    fill:
      cells: [32, 32]
      steps: 100
      loop: { frames: 5, span: 200 }
Y
expect 3 "$tsuya" loop fill.yaml -o 'x.#.exr'
says "fill.yaml:8:"
says "volume[0].fill.loop.span: 200; before step 0 there is nothing: at most 100"
absent x.1.exr

# Where frame 1 is: by a share of the path, or after the step of least change.
expect 0 "$tsuya" loop loop.yaml -o 's.#.png' --set start=0.5
prints "frame 1 is at 0.5000 of the path"
same s.1.png t1.4.png
same s.4.png t1.1.png
expect 0 "$tsuya" loop loop.yaml -o 'q.#.png' --set quiet_start=true --json
python3 - <<'P' || fail "the quiet start"
import json
r = json.load(open("out.txt"))
assert r["changed_at_seam"] <= min(s["changed"] for s in r["steps"]), r
P

# Transparency: straight in PNG, kept by GIF.
expect 0 "$tsuya" loop loop.yaml -o 'c.#.png' --set clear=true
if command -v ffmpeg >/dev/null; then
    expect 0 "$tsuya" loop loop.yaml -o clear.gif --set clear=true
    for file in c.2.png clear.gif; do
        ffmpeg -v error -i $file -frames:v 1 -f rawvideo -pix_fmt rgba rgba.raw -y </dev/null
        python3 - $file <<'P' || fail "$file is not transparent"
import sys
d = open("rgba.raw", "rb").read()
alphas = d[3::4]
assert len(alphas) == 48 * 48 and 200 < sum(a == 0 for a in alphas) < 48 * 48 - 200, len(alphas)
if sys.argv[1].endswith("png"):
    edges = [d[i:i + 3] for i in range(0, len(d), 4) if 0 < d[i + 3] < 128]
    assert len(edges) > 20 and max(max(e) for e in edges) > 100, edges
P
    done
fi
