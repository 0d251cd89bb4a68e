# SPDX-License-Identifier: Apache-2.0
# compare: equal pictures, limits, everything that makes pictures incomparable, and a report that stands alone.
cat >scene.yaml <<'Y'
tsuya: 1
film: { size: [48, 27] }
render: { samples: 16 }
camera: { position: [0, 0, 0.1], look_at: [0, 0, 0] }
assets: { ball: { shape: sphere, radius: 0.02, divisions: 16 } }
materials: { grey: { model: surface, base_color: 0.5 } }
objects: [ { mesh: ball, material: grey } ]
lights:
  - { type: environment, radiance: 0.3 }
  - { type: rectangle, center: [-0.1, 0.1, 0.1], target: [0, 0, 0], size: [0.05, 0.05], radiance: 10 }
Y
expect 0 "$tsuya" render scene.yaml -o a.exr --seed 1 --develop
expect 0 "$tsuya" render scene.yaml -o b.exr --seed 2 --develop
expect 0 "$tsuya" render scene.yaml -o dark.exr --seed 1 --set materials.grey.base_color=0.2 --develop
expect 0 "$tsuya" render scene.yaml -o small.exr --size 32x18
expect 0 "$tsuya" render scene.yaml -o cropped.exr --seed 1 --crop 10,5,30,20
expect 0 "$tsuya" render scene.yaml -o plain.exr --aov none

# Nothing but the truth about equal pictures.
expect 0 "$tsuya" compare a.exr a.exr --layer all --fail 'max>0'
prints "beauty: means"
prints "equal"
expect 0 "$tsuya" compare a.exr a.exr --json
prints '"equal": true'
prints '"passed": true'
prints '"psnr": null'
prints '"flip": 0.0'

# Noise within a limit, another material beyond it.
expect 0 "$tsuya" compare a.exr b.exr --fail 'flip>0.05,psnr<15'
[ "$(wc -l <out.txt)" -eq 3 ] || fail "more than a table of one layer"
expect 1 "$tsuya" compare a.exr dark.exr --fail 'flip>0.05' --fail 'rmse>10'
says "flip of beauty is"
says "above 0.05"
expect 1 "$tsuya" compare a.exr dark.exr --fail 'psnr<90' --json
prints '"passed": false'
says "below 90"
expect 0 "$tsuya" compare a.exr dark.exr
expect 0 "$tsuya" compare a.exr dark.exr --layer N,Z --fail 'max>0.5'
expect 0 "$tsuya" compare a.exr b.exr --channels R,B --metric rmse,mae
grep -q psnr out.txt && fail "a metric that nobody asked for"

# Display pictures, and linear ones against them.
expect 0 "$tsuya" compare a.png b.png --fail 'flip>0.05'
expect 1 "$tsuya" compare a.png dark.png --fail 'flip>0.05'
expect 0 "$tsuya" compare a.png a.exr --fail 'max>0.003'
expect 0 "$tsuya" compare a.exr a.png --fail 'max>0.003'

# A part of the picture, and where the mask says so.
expect 0 "$tsuya" compare a.exr cropped.exr --crop 10,5,30,20 --fail 'max>0'
expect 0 "$tsuya" compare a.exr dark.exr --mask 'A=0' --fail 'max>0'
expect 1 "$tsuya" compare a.exr dark.exr --mask 'A>0' --fail 'max>0'

# What cannot be compared differs, and says where.
expect 1 "$tsuya" compare a.exr small.exr
says "the display windows differ: 0,0 to 47,26 in the reference, 0,0 to 31,17 in the test"
[ ! -s out.txt ] || fail "numbers of pictures that cannot be compared"
expect 1 "$tsuya" compare a.exr cropped.exr
says "the data windows differ"
expect 1 "$tsuya" compare cropped.exr a.exr --crop 0,0,20,20
says "not within the data window 10,5 to 30,20"
expect 1 "$tsuya" compare a.exr plain.exr
says "is in the reference but not in the test"
expect 1 "$tsuya" compare plain.exr a.exr --json
prints '"difference": "channel '
expect 0 "$tsuya" compare a.exr plain.exr --layer beauty
expect 1 "$tsuya" compare plain.exr a.exr --channels R,Z
says "the reference has no channel 'Z'"

# NaN: a file that holds one.
expect 1 "$tsuya" compare "$TSUYA_SOURCE/tests/image/data/nan.exr" "$TSUYA_SOURCE/tests/image/data/nan.exr"
says "the first is nan in channel 'G' at pixel 2,1"

# The report needs nothing beside it; the heat map has the picture's size.
expect 1 "$tsuya" compare a.exr dark.exr --fail 'flip>0.05' --html report.html --heat heat.png
[ "$(grep -c 'id="picture-' report.html)" -eq 3 ] || fail "three pictures expected"
grep -Eq '(src|href)="[^d]|url\(|https?:' report.html && fail "the report points outside"
grep -q '"verdict":"differs"' report.html || fail "the report does not judge"
grep -q '"broken":\["flip"\]' report.html || fail "the broken limit is not marked"
expect 0 "$tsuya" info heat.png
prints "width: 48"
expect 1 "$tsuya" compare a.exr small.exr --html report.html
grep -q 'the display windows differ' report.html || fail "the report does not say why"
expect 0 "$tsuya" compare a.exr b.exr --layer all --html report.html
[ "$(grep -c 'id="picture-' report.html)" -gt 20 ] || fail "a view for every layer expected"

# Mistakes.
expect 2 "$tsuya" compare a.exr
expect 2 "$tsuya" compare a.exr b.exr --metric ssim
says "none of rmse"
expect 2 "$tsuya" compare a.exr b.exr --fail 'flip=3'
says "METRIC>NUMBER"
expect 2 "$tsuya" compare a.exr b.exr --fail 'flip>nan'
expect 2 "$tsuya" compare a.exr b.exr --layer beuty
says "it has beauty, A"
expect 2 "$tsuya" compare a.exr b.exr --layer Z --fail 'flip>0.1'
says "have no flip"
expect 2 "$tsuya" compare a.png b.png --fail 'hdrflip>0.1'
says "linear colours"
expect 2 "$tsuya" compare a.exr b.exr --mask nonsense
expect 2 "$tsuya" compare a.exr b.exr --mask 'instance>1e9'
expect 2 "$tsuya" compare a.exr b.exr --crop 5,5,1,1
expect 2 "$tsuya" compare a.exr b.exr --ppd 0
expect 4 "$tsuya" compare a.exr missing.exr
says "missing.exr"
expect 4 "$tsuya" compare a.exr b.exr --html nowhere/report.html
head -c 300 a.exr >cut.exr
expect 4 "$tsuya" compare a.exr cut.exr
says "cut.exr"

# Without its module the program says what is missing, where that is needed; elsewhere it works.
mkdir -p far/away/alone
cp "$tsuya" far/away/alone/
expect 4 far/away/alone/tsuya compare a.png b.png
says "the program's module for image files cannot be loaded: libtsuya_oiio.so"
expect 0 far/away/alone/tsuya compare a.exr b.exr
