# SPDX-License-Identifier: Apache-2.0
# Reports of sweeps and comparisons: one file that asks for nothing, and what a browser makes of it.
cat >scene.yaml <<'Y'
tsuya: 1
film: { size: [96, 64] }
render: { samples: 8, seed: 3 }
vars: { moisture: 0.5 }
camera: { position: [0, 0.05, 0.12], look_at: [0, 0.01, 0], vfov: 30 }
assets:
  ball: { shape: sphere, radius: 0.02, divisions: 16 }
  floor: { shape: plane, size: [0.2, 0, 0.2] }
materials:
  skin: { model: cdrf, color: [0.8, 0.6, 0.4], moisture: $moisture }
  grey: { model: surface, base_color: 0.3 }
objects:
  - { mesh: ball, material: skin, translate: [0, 0.02, 0] }
  - { mesh: floor, material: grey }
lights:
  - { type: environment, radiance: 0.2 }
  - { type: rectangle, center: [-0.1, 0.1, 0], target: [0, 0, 0], size: [0.05, 0.05], radiance: 4 }
Y
expect 0 "$tsuya" sweep scene.yaml --vary moisture=0.1:0.9:3 --vary lights.1.radiance=1:8:4:log -o grid --progress none
prints grid/index.html
grep -Eq '(src|href)="[^d]|url\(|https?:' grid/index.html && fail "the report points outside"
[ "$(grep -c 'id="picture-' grid/index.html)" -eq 12 ] || fail "twelve pictures expected"
cp grid/index.html first.html
expect 0 "$tsuya" sweep scene.yaml --vary moisture=0.1:0.9:3 --vary lights.1.radiance=1:8:4:log -o grid --progress none
same grid/index.html first.html

# Nothing that a scene says becomes part of the page's own text.
expect 0 "$tsuya" sweep scene.yaml --zip --vary 'objects.0.name=</script><b>,"<!--<script>"' -o hostile --progress none --spp 1
grep -q '</script><b>' hostile/index.html && fail "a value is not escaped"
[ "$(grep -c '<script' hostile/index.html)" -eq "$(grep -c '</script>' hostile/index.html)" ] || fail "scripts do not match"

# Words that are cut within a character are still words.
long=$(printf '米%.0s' $(seq 100))
expect 0 "$tsuya" sweep scene.yaml --vary "objects.0.name=x$long,xy$long,xyz$long" --vary moisture=0.1,0.9 --spp 1 -o cut --progress none
python3 - <<'P' || fail "the page lacks the labels of rows"
import json, re
data = json.loads(re.search(r'id="data">(.*?)</script>', open("cut/index.html", encoding="utf-8").read(), re.S)[1])
labels = data["layout"]["rowLabels"]
assert [label[:4] for label in labels] == ["x米米米", "xy米米", "xyz米"], labels
P

# A large picture is made smaller, and the page says so; a cell that failed has its reason.
expect 0 "$tsuya" sweep scene.yaml --vary moisture=0.1,0.9 --size 1400x40 --spp 1 --aov none -o wide --progress none
grep -q '"width":700,"height":20,"full":\[1400,40\]' wide/index.html || fail "a large picture is not made smaller"
grep -q 'here at 1/2 of their width' wide/index.html || fail "the page does not tell its factor"
printf 'tsuya: 1\nkind: roots\ncount: 2\nsecond: { spacing: 0 }\nradius: 3\ntip: 2\ndetail: 2\n' >roots.yaml
sed -e 's/floor: .*/floor: { mesh: roots.yaml }/' scene.yaml >rooted.yaml
expect 3 "$tsuya" sweep rooted.yaml --vary assets.floor.mesh.tip=2,4,2.5 --reference assets.floor.mesh.tip=4 -o failing --progress none --spp 1

# The page of `compare`: layers, display pictures, pictures that cannot be compared.
cp 'grid/moisture=0.1,lights.1.radiance=4.exr' a.exr
cp 'grid/moisture=0.9,lights.1.radiance=4.exr' b.exr
expect 0 "$tsuya" develop a.exr -o a.png
expect 0 "$tsuya" develop b.exr -o b.png
expect 1 "$tsuya" compare a.exr b.exr --fail 'rmse>1e-4,psnr<1' --html compare.html
expect 0 "$tsuya" compare a.png b.png --html display.html
expect 0 "$tsuya" compare a.exr b.exr --layer all --html layers.html
expect 0 "$tsuya" render scene.yaml -o size.exr --size 20x10 --spp 1 --progress none
expect 1 "$tsuya" compare a.exr size.exr --html size.html

python3 "$TSUYA_SOURCE/tests/cli/report_pages.py" "$tsuya"
case $? in
0) ;;
77) skip "no chromium and chromedriver" ;;
*) fail "the report in the browser" ;;
esac
