# SPDX-License-Identifier: Apache-2.0
# Fills: what they refuse and where, pictures and channels beside the frames, runs that stop and go on.
cat >heal.yaml <<'Y'
tsuya: 1
kind: fill
cells: [64, 48]
scale: 2
tile: none
start: plain
marks:
  - { name: skin, preset: plain, color: [0.6, 0.3, 0.2], ground: [0.2, 0.02, 0.02] }
  - { name: wound, preset: dying, color: [0.5, 0.1, 0.1], ground: [0.2, 0.02, 0.02] }
run: { frames: 6, steps: 40 }
events:
  - { at: 2, op: hole, center: [30, 24], radius: 12 }
  - { at: 3, op: mark, mark: wound, shape: rectangle, center: [30, 24], size: [6, 6] }
Y
cat >mask.yaml <<'Y'
tsuya: 1
kind: fill
cells: [32, 24]
scale: 2
run: { frames: 4, steps: 5 }
start: plain
preset: plain
Y

# The command line.
expect 2 "$tsuya" fill heal.yaml -o out.exr
says "####"
expect 2 "$tsuya" fill heal.yaml -o 'out.##.jpg'
says ".exr or .png"
expect 2 "$tsuya" fill heal.yaml -o 'out.##.exr' --png out.png
expect 2 "$tsuya" fill heal.yaml -o 'out.##.exr' --state 'state.##.exr'
says "it has no #"
expect 4 "$tsuya" fill heal.yaml -o 'out.##.exr' --resume nowhere.exr

# What is wrong in a recipe is told at its line, with what would do, before anything is made.
refuse()
{
    local at=$1 text=$2
    shift 2
    expect 3 "$tsuya" fill "$@"
    says "$at"
    says "$text"
    absent out.01.exr
}
sed 's/at: 3, op: mark, mark: wound/at: 3, op: mark, mark: wuond/' heal.yaml >bad.yaml
refuse "bad.yaml:13:24" "no mark 'wuond' in the table; it has 0 skin, 1 wound" bad.yaml -o 'out.##.exr'
sed 's/at: 3, op/at: 7, op/' heal.yaml >bad.yaml
refuse "bad.yaml:13:7" "7 lies after the run: it has frames 1..6" bad.yaml -o 'out.##.exr'
sed 's/op: hole,/op: whole,/' heal.yaml >bad.yaml
refuse "bad.yaml:12:18" "did you mean 'hole'" bad.yaml -o 'out.##.exr'
sed 's/preset: dying/preset: dieing/' heal.yaml >bad.yaml
refuse "bad.yaml:9:28" "'dieing' is not one of" bad.yaml -o 'out.##.exr'
sed 's/radius: 12/radius: -1/' heal.yaml >bad.yaml
refuse "bad.yaml:12:50" "out of range" bad.yaml -o 'out.##.exr'
sed 's/radius: 12/radius: 12, close: 4, mark: wound/' heal.yaml >bad.yaml
refuse "bad.yaml:12" "no front moves into it" bad.yaml -o 'out.##.exr'
refuse "time_step" "above 0 and below" heal.yaml -o 'out.##.exr' --set time_step=1.4
refuse "outputs" "'w' is none of u, v" heal.yaml -o 'out.##.exr' --also v,w
refuse "events" "they need run.frames" heal.yaml -o 'out.##.exr' --set run.frames=0

# A rate without a plain state is a warning.
expect 0 "$tsuya" fill mask.yaml -o 'plain.#.png' --set preset=stripes --set kill=0.064
says "there is a plain state up to kill"

# Masks: of the cells' size or of a frame's, with all their frames.
expect 0 "$tsuya" fill mask.yaml -o 'small.#.png' --set scale=1
expect 0 "$tsuya" fill mask.yaml -o 'large.#.png'
expect 0 "$tsuya" fill mask.yaml -o 'm.#.exr' --set region.mask=small.1.png --also mark,mattes
expect 0 "$tsuya" fill mask.yaml -o 'm.#.exr' --set region.mask=large.1.png
expect 0 "$tsuya" fill mask.yaml -o 'm.#.exr' --set 'region.mask=large.#.png'
rm large.3.png
refuse "region.mask" "lacks 1 of the frames 1..4: 3" mask.yaml -o 'out.##.exr' --set 'region.mask=large.#.png'
refuse "region.mask" "those of the cells, 30 x 24, or of a frame, 60 x 48" mask.yaml -o 'out.##.exr' --set cells='[30,24]' --set region.mask=small.1.png
says "--set region.mask=small.1.png"
refuse "over" "32 x 24 pixels; here it has 64 x 48" mask.yaml -o 'out.##.exr' --set over=small.1.png
cp small.1.png large.3.png
refuse "region.mask" "has 32 x 24 pixels, the first has 64 x 48" mask.yaml -o 'out.##.exr' --set 'region.mask=large.#.png'

# Pictures beside frames, more channels, and a run that goes on to the bit where it was stopped.
expect 0 "$tsuya" fill heal.yaml -o 'whole.##.exr' --png 'whole.##.png' --also u,v,mark,trail,distance,mattes
expect 0 "$tsuya" info whole.06.exr
prints "matte.wound"
prints "distance"
expect 0 "$tsuya" fill heal.yaml -o 'part.##.exr' --set run.frames=4 --also u,v,mark,trail,distance,mattes --state part.state.exr -t 1
expect 0 "$tsuya" fill heal.yaml -o 'rest.##.exr' --also u,v,mark,trail,distance,mattes --resume part.state.exr --state rest.state.exr
absent rest.04.exr
expect 0 "$tsuya" compare whole.06.exr rest.06.exr --fail 'rmse>0'
same whole.06.exr rest.06.exr
refuse "run.frames" "there is nothing to go on to" heal.yaml -o 'out.##.exr' --resume rest.state.exr
refuse "cells" "the state to go on from has 64 x 48" heal.yaml -o 'out.##.exr' --set cells='[64,64]' --resume part.state.exr
expect 4 "$tsuya" fill heal.yaml -o 'out.##.exr' --resume whole.01.exr
says "is not one of a fill"

# A state knows its recipe: what differs is named; more frames, other looks and later events go on.
sed 's/preset: dying/preset: slow/' heal.yaml >bad.yaml
refuse "bad.yaml:9" "marks[1]: differs from that of the state" bad.yaml -o 'out.##.exr' --resume part.state.exr
refuse "region.threshold" "region.threshold: differs from that of the state to go on from; so do seed" heal.yaml -o 'out.##.exr' --set region.threshold=0.2 --set seed=2 --resume part.state.exr
refuse "tile" "so do stencil" heal.yaml -o 'out.##.exr' --set tile=both --set stencil=9 --resume part.state.exr
refuse "run.steps" "run.steps: differs" heal.yaml -o 'out.##.exr' --set run.steps=41 --resume part.state.exr
sed 's/radius: 12/radius: 11/' heal.yaml >bad.yaml
refuse "bad.yaml:12" "events[0]: differs" bad.yaml -o 'out.##.exr' --resume part.state.exr
sed '/op: hole/d' heal.yaml >bad.yaml
refuse "bad.yaml:12" "events[0]: differs from that of the state to go on from; so do events[1]" bad.yaml -o 'out.##.exr' --resume part.state.exr
expect 0 "$tsuya" fill heal.yaml -o 'plain.##.exr' --set run.frames=2 --set 'events=[]' --state plain.state.exr
refuse "outputs" "does not know the past" heal.yaml -o 'out.##.exr' --set 'events=[]' --also trail --resume plain.state.exr
sed 's/color: \[0.6/color: [0.7/; s/steps: 40/steps: 40.0/; s/preset: plain/feed: 0.072, kill: 0.059/' heal.yaml >later.yaml
echo '  - { at: 5, op: hole, center: [10, 10], radius: 4 }' >>later.yaml
expect 0 "$tsuya" fill later.yaml -o 'later.##.exr' --set run.frames=7 --also u,v
expect 0 "$tsuya" fill later.yaml -o 'latest.##.exr' --set run.frames=7 --also u,v --resume part.state.exr
same later.07.exr latest.07.exr

# Interrupted: what it leaves goes on.
"$tsuya" fill heal.yaml -o 'stop.####.exr' --set run.frames=9000 --state stop.state.exr >out.txt 2>err.txt &
child=$!
for _ in $(seq 600); do [ -e stop.0005.exr ] && break; sleep 0.1; done
kill -INT $child
wait $child
[ $? -eq 130 ] || fail "an interrupted run ends with 130"
says "interrupted"
ls stop.*.exr >list.txt
grep -q stop.state.exr list.txt || fail "no state is left"
last=$(grep -v state list.txt | tail -1 | cut -d. -f2)
expect 0 "$tsuya" fill heal.yaml -o 'on.####.exr' --set run.frames=$((10#$last + 1)) --resume stop.state.exr
[ "$(ls on.*.exr | wc -l)" -eq 1 ] || fail "one frame is left to make"

# Over footage: what is closed or not opaque shows it, by frame; images go through the mattes.
cat >over.yaml <<'Y'
tsuya: 1
kind: fill
cells: [64, 48]
scale: 2
tile: none
start: plain
marks: [{ preset: plain, image: whole.01.png, ground_opacity: 0 }]
over: whole.##.png
run: { frames: 3, steps: 0 }
events: [{ at: 1, op: hole, shape: rectangle, center: [30, 24], size: [40, 30] }, { at: 3, op: hole, shape: all }]
Y
expect 0 "$tsuya" fill over.yaml -o 'over.##.png'
expect 0 "$tsuya" compare over.01.png whole.01.png --fail 'max>0.005'
expect 1 "$tsuya" compare over.02.png whole.01.png --fail 'max>0.1' # the hole of frame 2 is seen through ours
expect 0 "$tsuya" compare over.03.png whole.03.png --fail 'max>0.005'
sed 's/{ at: 1, op: hole.*/{ at: 1, op: barrier, shape: all }]/' over.yaml >closed.yaml
expect 0 "$tsuya" fill closed.yaml -o 'closed.##.png'
expect 0 "$tsuya" compare closed.03.png whole.03.png --fail 'max>0.005'
expect 1 "$tsuya" compare closed.03.png whole.01.png --fail 'max>0.1'

# A run as a volume: the numbers of the frames in one file, which a loop reads as it reads the fill itself.
expect 2 "$tsuya" fill heal.yaml -o 'out.##.exr' --volume volume.vdb
expect 2 "$tsuya" fill heal.yaml -o 'out.##.exr' --volume volume.raw --resume part.state.exr
says "there are only the last"
expect 0 "$tsuya" fill heal.yaml -o 'whole.##.exr' --also v --volume volume.nrrd
expect 0 "$tsuya" fill heal.yaml -o 'whole.##.exr' --also v --volume volume.raw
[ "$(wc -c <volume.raw)" -eq $((128 * 96 * 6 * 4)) ] || fail "a volume of 128 x 96 x 6 numbers"
head -6 volume.nrrd | grep -qx "sizes: 128 96 6" || fail "sizes in the head"
tail -c +129 volume.nrrd >rest.raw
same rest.raw volume.raw
{
    printf 'tsuya: 1\nkind: loop\nframes: 5\nsize: [48, 40]\nvolume:\n  - source: fill\n    range: [0, 0.4]\n    fill:\n'
    sed '1,2d; s/^/      /' heal.yaml
    printf '      outputs: [v]\n'
} >of_fill.yaml
printf 'tsuya: 1\nkind: loop\nframes: 5\nsize: [48, 40]\nvolume:\n  - source: raw\n    range: [0, 0.4]\n    raw: { file: volume.nrrd, header: 128, type: f32, width: 128, height: 96, depth: 6 }\n' >of_raw.yaml
expect 0 "$tsuya" loop of_fill.yaml -o 'of_fill.#.png'
expect 0 "$tsuya" loop of_raw.yaml -o 'of_raw.#.png'
for i in 1 2 3 4 5; do same of_fill.$i.png of_raw.$i.png; done
expect 1 cmp -s of_raw.1.png of_raw.2.png
sed 's/frames: 6/frames: 600/' heal.yaml >long.yaml
expect 130 timeout --preserve-status -s INT 2 "$tsuya" fill long.yaml -o 'long.####.exr' --set run.steps=2000 --volume long.raw
absent long.raw

# A contact sheet, and a page on which rates are picked.
expect 0 "$tsuya" fill heal.yaml -o 'sheet.##.exr' --sheet sheet.png --every 2
expect 0 "$tsuya" info sheet.png
prints "height: 136" # three of 128 x 96 with gaps of 8 and a caption of 24
expect 2 "$tsuya" fill heal.yaml -o 'sheet.##.exr' --sheet sheet.exr
expect 2 "$tsuya" fill heal.yaml -o 'sheet.##.exr' --sheet sheet.png --every 0
expect 2 "$tsuya" fill heal.yaml -o 'sheet.##.png' --page page.html
says "they must end in .exr"
expect 3 "$tsuya" fill heal.yaml -o 'sheet.##.exr' --page page.html
says "the recipe has none"
absent page.html
cat >map.yaml <<'Y'
tsuya: 1
kind: fill
cells: [200, 120]
scale: 1
tile: none
map: { feed: [0.01, 0.1], kill: [0.03, 0.07] }
drops: { count: 80, radius: 5 }
run: { frames: 1, before: 1500 }
Y
refuse "map" "from lower to higher" map.yaml -o 'out.##.exr' --set map.kill='[0.07,0.03]'
expect 0 "$tsuya" fill map.yaml -o 'map.#.exr' --page page.html
grep -Eq '(src|href)="[^d]|url\(|https?:' page.html && grep -Ev 'w3.org/2000/svg' page.html | grep -Eq '(src|href)="[^d]|url\(|https?:' && fail "the page points outside"
PYTHONPATH=$TSUYA_SOURCE/tests/cli python3 - <<'P'
import os, re, sys
import browser
wanted = os.environ.get("TSUYA_BROWSER", "if there")
if wanted == "none" or (wanted != "required" and not browser.available()):
    sys.exit(77)
chromium = browser.Browser(1300, 900)
try:
    chromium.open(os.path.abspath("page.html"))
    chromium.wait("document.querySelectorAll('#map circle').length > 10")
    failed = []
    def check(good, text):
        if not good:
            failed.append(text)
    def rates():
        return [float(x) for x in re.findall(r"[\d.]+", chromium.text("#yaml"))]
    check(rates() == [0.067, 0.062], "begins with the first preset")
    chromium.pointer("#map", [(0.25, 0.75)])
    feed, kill = rates()
    check(abs(feed - 0.0325) < 3e-4 and abs(kill - 0.04) < 3e-4, f"a click gives {feed}, {kill}")
    check(re.fullmatch(r"feed: 0\.\d{4}\nkill: 0\.\d{4}\n", chromium.text("#yaml")), "these are lines of a recipe")
    chromium.script("document.getElementById('map').focus()")
    chromium.press("\ue014")
    check(rates()[0] == feed and rates()[1] > kill, "the arrow goes to the right")
    chromium.script("document.querySelectorAll('#presets button')[4].click()")
    check(rates() == [0.0265, 0.0605], "a preset by its name")
    check(not chromium.console_errors(), "the console is quiet")
    check(all(a.startswith(("file:", "data:")) for a in chromium.requests()), "nothing is asked of the network")
    print("\n".join(failed))
finally:
    chromium.close()
sys.exit(1 if failed else 0)
P
case $? in
0) ;;
77) skip "no chromium: the page is not clicked" ;;
*) fail "the page of the map" ;;
esac
