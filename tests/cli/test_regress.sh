# SPDX-License-Identifier: Apache-2.0
# regress: references made, kept, missed and broken; reports for people and machines; mistakes with their place.
mkdir -p list/scene
cat >list/scene/scene.yaml <<'Y'
tsuya: 1
film: { size: [32, 18] }
render: { samples: 16 }
camera: { position: [0, 0, 0.1], look_at: [0, 0, 0] }
vars: { albedo: 0.5 }
assets: { ball: { shape: sphere, radius: 0.02, divisions: 16 } }
materials: { grey: { model: surface, base_color: $albedo } }
objects: [ { mesh: ball, material: grey } ]
lights: [ { type: environment, radiance: 0.5 } ]
Y
cat >list/regress.yaml <<'Y'
tsuya: 1
limits: { rmse: 0.02, flip: 0.03 }
cases:
  - { name: plain, scene: scene }
  - { name: "small", scene: scene/scene.yaml, reference: shown.png, set: 'film.size=[16, 9]', define: [albedo=0.7] }
  - { name: layers, scene: scene, layers: [beauty, N], limits: { rmse: 9, max: 0 } }
Y
# Nothing to compare with yet.
expect 1 "$tsuya" regress list
says "plain: there is no reference 'list/plain.exr' (--update makes it)"
says "0 of 3 passed"
absent list/plain.exr
expect 0 "$tsuya" regress list --update
prints "list/plain.exr is new"
prints "list/shown.png is new"
says "3 of 3 are up to date now"
cp list/plain.exr kept.exr
expect 0 "$tsuya" regress list --update
prints "list/layers.exr is as rendered"
prints "unchanged"
same list/plain.exr kept.exr
expect 0 "$tsuya" regress list/regress.yaml --junit r.xml --html r.html --threads 1
prints " N: rmse 0 (9) max 0 (0)"
says "3 of 3 passed"
grep -q 'tests="3" failures="0" errors="0"' r.xml || fail "JUnit does not count three"
[ "$(grep -c '<testcase .*/>' r.xml)" -eq 3 ] || fail "three test cases expected"
[ "$(grep -o 'data:image/png;base64' r.html | wc -l)" -eq 12 ] || fail "three views of a layer each, and a fourth"

# Another material: two differ, and say by how much; the third was told to be bright anyway.
sed -i 's/albedo: 0.5/albedo: 0.2/' list/scene/scene.yaml
expect 1 "$tsuya" regress list --junit r.xml --html r.html -o rendered
says "plain: rmse of beauty is"
says "above the limit 0.02"
says "layers: max of beauty is"
says "1 of 3 passed"
prints "small"
[ -f rendered/plain.exr ] || fail "no rendered picture kept"
grep -q 'tests="3" failures="2" errors="0"' r.xml || fail "JUnit does not count the failures"
[ "$(grep -c '<failure message="' r.xml)" -eq 2 ] || fail "two failures expected"
[ "$(grep -c '</testcase>' r.xml)" -eq 2 ] || fail "failures that do not end"
grep -q '2 differ' r.html || fail "the page does not count"
expect 0 "$tsuya" regress list --only small
says "1 of 1 passed"
expect 1 "$tsuya" regress list --only plain --only small --json
prints '"result": "differs"'
prints '"name": "small"'
expect 0 "$tsuya" regress list --update --only plain
prints "is replaced: rmse"
cmp -s list/plain.exr kept.exr && fail "the reference is the old one"
expect 1 "$tsuya" regress list
says "2 of 3 passed"

# Another size is a difference, a broken scene or reference a fault of its own; the others are still judged.
sed -i 's/size: \[32, 18\]/size: [30, 18]/' list/scene/scene.yaml
expect 1 "$tsuya" regress list --only plain
says "the display windows differ"
sed -i 's/base_color: .albedo/base_colour: $albedo/' list/scene/scene.yaml
expect 3 "$tsuya" regress list --junit r.xml
says "did you mean 'base_color'"
grep -q 'errors="3"' r.xml || fail "JUnit does not count the faults"
grep -q 'message="list/scene/scene.yaml:7:' r.xml || fail "the fault has no place"
sed -i 's/base_colour/base_color/; s/\[30, 18\]/[32, 18]/' list/scene/scene.yaml
head -c 200 kept.exr >list/plain.exr
expect 4 "$tsuya" regress list
says "plain.exr"
prints "small            passed"

# Mistakes in the list.
mistake() { # SED TEXT
    sed -E "$1" list/regress.yaml >list/bad.yaml
    expect 3 "$tsuya" regress list/bad.yaml
    says "$2"
}
mistake 's/name: plain/nmae: plain/' "list/bad.yaml:4:7: unknown key 'nmae' in regress.case; did you mean 'name'?"
mistake 's/name: plain/name: small/' "there are two cases 'small'"
mistake 's/name: plain/name: a\/b/' "list/bad.yaml:4:13: 'name': 'a/b' is not made of"
mistake 's/scene: scene,/scene: nowhere,/' "list/bad.yaml:6:28: 'scene': there is no 'list/nowhere'"
mistake 's/shown.png/shown.gif/' "ends neither in .exr nor in .png"
mistake 's/flip: 0.03/flap: 0.03/' "did you mean 'flip'"
mistake '2d; 6d' "list/bad.yaml:3:5: nothing is judged"
mistake 's/flip: 0.03/flip: -1/' "list/bad.yaml:2:29: 'flip' is -1: out of range"
mistake '4,6d' "cases"
mistake '1d' "tsuya"
expect 4 "$tsuya" regress nowhere
expect 2 "$tsuya" regress list --only nobody
says "has no case 'nobody'"
expect 4 "$tsuya" regress list --junit nowhere/r.xml
expect 2 "$tsuya" regress

# The project's own scenes.
expect 0 "$tsuya" regress "$TSUYA_SOURCE/tests/regress" --html own.html
