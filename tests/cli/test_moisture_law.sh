# SPDX-License-Identifier: Apache-2.0
# moisture and calibrate: the law as tables, fitted again, named by a material; moisture by instance is that of a material.
expect 0 "$tsuya" moisture
prints "120 min at 10 C    0.3104"
prints "cooked             0.6200  1.2500  1.000  0.7000    1.0957"
# Soaking at 10 degrees: 69, 97 and 99.9 % of .24. Ten degrees warmer is 1.45 times as fast.
expect 0 "$tsuya" moisture --soak 20@10,60,120@10,20@20,29@10 --csv
awk -F, 'NR > 1 { print $3 / .24 }' out.txt >uptakes.txt
awk 'NR == 1 && ($1 < .685 || $1 > .695) || NR == 2 && ($1 < .968 || $1 > .972) || NR == 3 && ($1 < .998 || $1 > .9995) { exit 1 }' \
    uptakes.txt || fail "soaking at 10 degrees: $(tr '\n' ' ' <uptakes.txt)"
[ "$(sed -n 4p uptakes.txt)" = "$(sed -n 5p uptakes.txt)" ] || fail "20 minutes at 20 degrees are 29 at 10"
# sigma_0 = exp(.34 + .52 ln w) mm, and l = exp(.0736 + .9 ln w) mm of cooked grains; t grows with the uptake.
expect 0 "$tsuya" moisture --uptake 0:0.24:7 --cooked 1 --radius 1,2.5 --csv
[ "$(wc -l <out.txt)" -eq 8 ] || fail "seven states expected"
awk -F, 'NR > 1 { l = exp(.0736 + .9 * log($2)); s = exp(.34 + .52 * log($2))
    if (($5 - l) ^ 2 > 1e-9 || ($6 - s) ^ 2 > 1e-9 || $13 <= before || $15 >= $13) exit 1
    before = $13 }' out.txt || fail "the law: $(cat out.txt)"
expect 0 "$tsuya" moisture --wet-basis 0,1 --json
prints '"wet_basis": 0.05'
expect 0 "$tsuya" moisture --help
prints "example: tsuya moisture"
for bad in "--wet-basis 1.2" "--wet-basis 0.1,,0.2" "--uptake 0:0.24" "--soak 20@80" "--soak 20@" "--soak -1@10" "--cooked 2" "--radius 0" "--color 1,1"; do
    expect 2 "$tsuya" moisture $bad
done
says "--color: three numbers"
expect 2 "$tsuya" moisture --soak 20@10,60@70
says "no list of MINUTES@CELSIUS, 0..1000000 and 0..60"
expect 2 "$tsuya" moisture --json --csv

# A fit: the same bytes whatever the threads, the law again, and read back as a law.
expect 0 "$tsuya" calibrate --walks 4000 --radius 0.5,2 -o one.yaml --threads 1
prints "published sigma0 = exp("
expect 0 "$tsuya" calibrate --walks 4000 --radius 0.5,2 -o two.yaml --threads 3 --json
prints '"cooked_exponent": 0.'
same one.yaml two.yaml
expect 0 "$tsuya" moisture --calibration one.yaml --csv
awk -F, '$1 == "cooked" && ($5 - .7) ^ 2 > .001 { exit 1 }' out.txt || fail "the fitted law: $(cat out.txt)"
cat >measured.yaml <<'Y'
tsuya: 1
states:
  - { wet_basis: 0.145, cooked: 0, mean_free_path: 0.3, albedo: 0.999 }
  - { wet_basis: 0.62, mean_free_path: 1.5, anisotropy: 0.6, ior: 1.38 }
Y
expect 0 "$tsuya" calibrate measured.yaml --walks 4000 --radius 1 -o measured_law.yaml
grep -q '^raw_length: 0\.[23]' measured_law.yaml || fail "raw length of $(grep raw_length: measured_law.yaml)"
grep -q '^soaked_length: 0.1$' measured_law.yaml || fail "what was not measured stays"
printf 'tsuya: 1\nstates:\n  - { wet_basis: 1.4, mean_free_path: 1 }\n  - { wet_basis: .2 }\n  - { wet_bassis: .2, mean_free_path: 1 }\n' >bad.yaml
expect 3 "$tsuya" calibrate bad.yaml
says "bad.yaml:3:18: 'wet_basis' is 1.4: out of range, expected a number 0.05..1"
says "bad.yaml:4:5: missing key 'mean_free_path'"
says "did you mean 'wet_basis'"
printf 'tsuya: 1\nstates: []\n' >none.yaml
expect 3 "$tsuya" calibrate none.yaml
says "none.yaml:2:9: 'states': expected 1..64 of them, got 0"
expect 2 "$tsuya" calibrate -o law.json
says "must end in .yaml"
expect 2 "$tsuya" calibrate --albedo 0.2
expect 4 "$tsuya" calibrate missing.yaml

# A material that names it; the picture's recipe tells the law, and the file is not needed any more.
cat >scene.yaml <<'Y'
tsuya: 1
film: { size: [48, 24] }
render: { samples: 16 }
camera: { position: [0.0045, 0, 0.08], look_at: [0.0045, 0, 0], vfov: 6 }
vars: { w: 0.4 }
assets:
  grain: { shape: ellipsoid, size: [0.003, 0.002, 0.002], divisions: 16 }
  four: { aggregate: four.ply, prototype: grain }
materials: { rice: { model: cdrf, moisture: $w } }
objects: [ { aggregate: four, material: rice } ]
lights: [ { type: directional, center: [1, 1, 0.3], target: [0, 0, 0], irradiance: 2 } ]
Y
printf 'ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty float w\nend_header\n0 0 0 .4\n.003 0 0 .4\n.006 0 0 .4\n.009 0 0 .4\n' >four.ply
expect 0 "$tsuya" render scene.yaml -o plain.exr
expect 0 "$tsuya" render scene.yaml -o instance.exr --set 'materials.rice.moisture={attribute: w}'
expect 0 "$tsuya" compare plain.exr instance.exr --fail 'max>0'
expect 0 "$tsuya" render scene.yaml -o uptake.exr --set 'materials.rice.moisture={uptake: 0.3}'
expect 1 "$tsuya" compare plain.exr uptake.exr --fail 'max>0'
printf 'tsuya: 1\ncooked_constant: 1.2\nraw_length: 0.05\n' >law.yaml
expect 0 "$tsuya" render scene.yaml -o law.exr --set materials.rice.calibration=law.yaml
expect 1 "$tsuya" compare plain.exr law.exr --fail 'max>0'
printf 'tsuya: 1\ncooked_constant: 1.1\nraw_length: 0.05\n' >other.yaml
expect 0 "$tsuya" render scene.yaml -o other.exr --set materials.rice.calibration=other.yaml \
    --set materials.rice.calibration.cooked_constant=1.2
expect 0 "$tsuya" compare law.exr other.exr --fail 'max>0'
expect 0 "$tsuya" info law.exr --recipe
prints "cooked_constant: 1.2"
cp out.txt again.yaml
rm law.yaml
expect 0 "$tsuya" render again.yaml -o again.exr
same law.exr again.exr
expect 3 "$tsuya" check scene.yaml --set materials.rice.calibration=law.yaml
says "calibration: no file 'law.yaml'"
printf 'tsuya: 1\ncooked_konstant: 1.2\nraw_length: 0\n' >law.yaml
expect 3 "$tsuya" check scene.yaml --set materials.rice.calibration=law.yaml
says "law.yaml:2:1: unknown key 'cooked_konstant' in calibration; did you mean 'cooked_constant'"
says "law.yaml:3:13: 'raw_length' is 0: out of range"
