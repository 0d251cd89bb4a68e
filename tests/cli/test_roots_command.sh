# SPDX-License-Identifier: Apache-2.0
# tsuya roots as a user types it: what it refuses and where, what lies beside the mesh, frames, the field that is kept,
# a full disk and interruptions.
cat >roots.yaml <<'Y'
tsuya: 1
kind: roots
count: 3
second: { spacing: 0 }
tip: 2
detail: 2
host:
  resolution: 32
Y

# --- the command line ---

expect 0 "$tsuya" roots --help
prints "example: tsuya roots"
[ "$(wc -l <out.txt)" -le 40 ] || fail "the help does not fit a screen"
expect 0 "$tsuya" params roots.mask
prints "luminance"
expect 2 "$tsuya" roots roots.yaml
says "-o OUT.ply"
expect 2 "$tsuya" roots -o x.ply
expect 2 "$tsuya" roots roots.yaml other.yaml -o x.ply
expect 2 "$tsuya" roots roots.yaml -o x.ply --curve c.ply
says "did you mean '--curves'?"
expect 2 "$tsuya" roots roots.yaml -o x.stl
says "the output 'x.stl' must end in .ply, .obj or .glb"
expect 2 "$tsuya" roots roots.yaml -o x.ply --curves c.obj
says "the curves 'c.obj' must end in .ply"
expect 2 "$tsuya" roots roots.yaml -o x.ply --host h.stl
expect 2 "$tsuya" roots roots.yaml -o x.ply --report r.txt
says ".json"
expect 2 "$tsuya" roots roots.yaml -o x.ply --preview p.jpg
says ".png"
expect 2 "$tsuya" roots roots.yaml -o x.ply --host 'h.##.ply'
says "it has no #"
expect 2 "$tsuya" roots roots.yaml -o x.ply --curves ./x.ply
says "the output and the curves are one file"
ln -s "$PWD" here
expect 2 "$tsuya" roots roots.yaml -o x.ply --curves c.ply --host here/c.ply
says "the curves and the host are one file"
expect 4 "$tsuya" roots roots.yaml -o nowhere/x.ply
expect 4 "$tsuya" roots roots.yaml -o x.ply --report nowhere/r.json
expect 4 "$tsuya" roots roots.yaml -o x.ply --preview nowhere/p.png
expect 4 "$tsuya" roots /dev/null/none.yaml -o x.ply
mkdir folder.ply
expect 4 "$tsuya" roots roots.yaml -o folder.ply
says "it is a folder"
if [ "$(id -u)" -ne 0 ]; then
    mkdir -m 555 closed
    expect 4 "$tsuya" roots roots.yaml -o closed/x.ply
fi
absent x.ply
absent c.ply
absent r.json

# --- what is wrong, and where ---

ply() { # NAME VERTEX...: one triangle of each three
    local name=$1
    shift
    {
        printf 'ply\nformat ascii 1.0\nelement vertex %d\nproperty float x\nproperty float y\nproperty float z\n' $#
        printf 'element face %d\nproperty list uchar int vertex_indices\nend_header\n' $(($# / 3))
        printf '%s\n' "$@"
        for ((i = 0; i + 2 < $#; i += 3)); do echo "3 $i $((i + 1)) $((i + 2))"; done
    } >"$name"
}
ply none.ply "0 0 0" "1 0 0"
ply nan.ply "0 0 0" "1 nan 0" "0 1 0"
ply flat.ply "0 0 0" "1 0 0" "2 0 0"
ply bare.ply "0 0 0" ".1 0 0" "0 .1 0"
ply huge.ply "0 0 0" "1e30 0 0" "0 1e30 0"
ply large.ply "0 0 0" "1e6 0 0" "0 1e6 0"
ply tiny.ply "0 0 0" "1e-4 0 0" "0 1e-4 0"
echo "no picture" >text.png
cp "$TSUYA_SOURCE/scenes/loop_logo/mark.png" mark.png
echo "old" >kept.ply
cp kept.ply old.ply
# refuses STATUS PLACE TEXT LINES...: the recipe with those lines after the seventh; the place is theirs.
refuses() {
    local status=$1 place=$2 text=$3
    shift 3
    { sed '/^host:/,$d' roots.yaml && printf '%s\n' "$@"; } >bad.yaml
    expect "$status" "$tsuya" roots bad.yaml -o kept.ply --curves kept_curves.ply --report kept.json --preview kept.png
    says "bad.yaml:$place: $text"
    same kept.ply old.ply
    absent kept_curves.ply
    absent kept.json
    absent kept.png
}
mesh() { printf '%s\n' "host:" "  shape: mesh" "  mesh: $1"; }
wrong_mesh() { # STATUS PLACE TEXT FILE
    mapfile -t lines < <(mesh "$4")
    refuses "$1" "$2" "$3" "${lines[@]}"
}
wrong_mesh 4 9:3 "host.mesh: ./none.ply:" none.ply
says "there are no faces"
wrong_mesh 4 9:3 "host.mesh: ./nan.ply:11: vertex 1: y is not finite" nan.ply
wrong_mesh 4 9:3 "host.mesh: ./flat.ply: mesh has no area" flat.ply
wrong_mesh 3 9:9 "mesh: no file 'nothing.ply'" nothing.ply
wrong_mesh 3 7:1 "host: it reaches 1e+30 m from the origin; at most 1e+06 m" huge.ply
wrong_mesh 3 6:1 "detail: 2 mm; at least 477 mm where the host reaches 1e+06 m from the origin" large.ply
wrong_mesh 3 1:1 "radius: 4.2 mm; at most 0.1 mm, the host's longest side" tiny.ply
refuses 3 7:1 "host.mesh: the file is missing" "host: { shape: mesh }"
refuses 3 7:1 "radius: 200 mm; at most 80 mm, the host's longest side" "radius: 200"
refuses 4 10:22 "host.objects[1].mesh: ./flat.ply: mesh has no area" "host:" "  objects:" "    - { shape: sphere }" \
    "    - { shape: mesh, mesh: flat.ply }"
refuses 3 9:21 "host.objects[0].scale: [1, 0, 1]; no component is 0" "host:" "  objects:" \
    "    - { shape: box, scale: [1, 0, 1] }"
refuses 3 8:3 "host.objects: it reaches 10000 m from the origin; at most 800.781 m, 10000 times" \
    "host:" "  objects: [ { shape: sphere, radius: .04, translate: [1e4, 0, 0] } ]"
refuses 4 8:20 "obstacles[0].mesh: ./none.ply:" "obstacles:" "  - { shape: mesh, mesh: none.ply }"
refuses 3 8:23 "start.points[1]: [1, 0, 0] is 0.04 m from the host; at most 0.008" "start:" \
    "  points: [[0,.04,0], [1, 0, 0]]"
refuses 3 8:23 "start.points[1]: [0, 0, 0] is inside of the host, 0.0" "start:" "  points: [[0,.04,0], [0, 0, 0]]"
refuses 3 7:10 "start.attribute: 'moss'; the host's vertices have no attributes" "start: { attribute: moss }"
refuses 3 8:3 "host.avoid: 'moss'; the host's vertices have no attributes" "host:" "  avoid: moss"
refuses 3 8:12 "host.avoid.channel: g; of which texture?" "host:" "  avoid: { channel: g }"
refuses 3 8:21 "texture: no file 'nothing.png'" "host:" "  avoid: { texture: nothing.png }"
refuses 4 8:12 "host.avoid.texture: ./text.png: not an image" "host:" "  avoid: { texture: text.png }"
refuses 3 8:31 "host.avoid.channel: ./mark.png: no channel 'v'; the file has " "host:" \
    "  avoid: { texture: mark.png, channel: v }"
refuses 3 8:12 "unknown key 'textur' in roots.mask; did you mean 'texture'?" "host:" "  avoid: { textur: mark.png }"
refuses 3 8:10 "'avoid': expected a text, got a list of 2" "host:" "  avoid: [1, 2]"
refuses 3 8:3 "host.avoid: an attribute or a texture, not both" "host:" "  avoid: { attribute: a, texture: mark.png }"
refuses 3 10:14 "host.attract.texture: the host has no texture coordinates (uv)" "host:" "  shape: mesh" \
    "  mesh: bare.ply" "  attract: { texture: mark.png }"
refuses 3 9:47 "host.objects[0].avoid.texture: the host has no texture coordinates (uv)" "host:" "  objects:" \
    "    - { shape: mesh, mesh: bare.ply, avoid: { texture: mark.png } }"
grep -q "field of" err.txt && fail "a mistake comes after work"
expect 3 "$tsuya" roots roots.yaml -o kept.ply --set count=0
says "'count' is 0: out of range, expected a number 1..500"
same kept.ply old.ply

# In a scene the recipe's own place is told, too.
cat >scene.yaml <<'Y'
tsuya: 1
film: { size: [16, 16] }
camera: { position: [0, 0, 0.5], look_at: [0, 0, 0], vfov: 20 }
render: { samples: 1 }
assets:
  fig: { mesh: bad.yaml }
materials: { m: { model: surface } }
objects: [{ mesh: fig, material: m }]
lights: [{ type: environment, radiance: 1 }]
Y
mapfile -t lines < <(mesh nan.ply)
refuses 4 9:3 "host.mesh: ./nan.ply:11: vertex 1: y is not finite" "${lines[@]}"
expect 4 "$tsuya" render scene.yaml -o x.exr
says "bad.yaml:9:3: host.mesh: ./nan.ply:11: vertex 1: y is not finite"
absent x.exr

# Hosts that can hardly be held: what could be grown is there, and said.
for host in "sphere, radius: .0022" "box, size: [.00001, .05, .00001]" "box, size: [.05, .00001, .05]"; do
    expect 0 "$tsuya" roots roots.yaml -o hard.ply --report hard.json --set "host={ shape: $host, resolution: 32 }"
    prints "main 3 of 3"
    prints "1 shell, closed"
done
expect 0 "$tsuya" roots roots.yaml -o hard.ply --json --set "host={ shape: mesh, mesh: $PWD/bare.ply, resolution: 32 }"
prints '"parts": 1'

# --- what is beside the mesh ---

expect 0 "$tsuya" roots roots.yaml -o a.ply
expect 0 "$tsuya" roots roots.yaml -o b.ply --curves c.ply --host h.obj --report r.json --preview p.png --json
same a.ply b.ply
cp out.txt printed.json
python3 - <<'P' || fail "report and picture"
import json, struct
printed, written = json.load(open("printed.json")), json.load(open("r.json"))
assert printed["output"] == "b.ply" and printed == written, printed
assert printed["roots"]["main"] == {"requested": 3, "grown": 3} and printed["parts"] == 1
head = open("p.png", "rb").read(24)
assert head[:8] == b"\x89PNG\r\n\x1a\n" and struct.unpack(">II", head[16:]) == (480, 480), head
P
[ "$(find . -name '*p.png*' | wc -l)" -eq 1 ] || fail "the host of the picture is left"
expect 0 "$tsuya" info h.obj
prints "closed: true"
expect 0 "$tsuya" roots roots.yaml -o d.ply --set curves=c.ply
python3 - <<'P' || fail "centre lines give the mesh again"
a, d = (open(n, "rb").read() for n in ("a.ply", "d.ply"))
assert a[a.index(b"end_header"):] == d[d.index(b"end_header"):]
P
sed 's/^1 0 -1 /1 99 -1 /' c.ply >missing.ply
expect 3 "$tsuya" roots roots.yaml -o kept.ply --set curves=missing.ply
says "missing.ply:"
awk '/^1 0 -1 /{sub(/^1 0/, "1 " n + 1)} {print} /^[0-5] -?[0-9]+ -?[0-9]+ [0-9]+ [0-9]+$/{n++}' c.ply >cycle.ply
cmp -s c.ply cycle.ply && fail "no parent was changed"
expect 3 "$tsuya" roots roots.yaml -o kept.ply --set curves=cycle.ply
says "cycle.ply:"
same kept.ply old.ply

# --- frames ---

expect 0 "$tsuya" roots roots.yaml -o 'g.##.ply' --set grow.frames=3 --report g.json
prints "g.##.ply"
python3 - <<'P' || fail "the last frame is the still mesh"
a, g = (open(n, "rb").read() for n in ("a.ply", "g.03.ply"))
assert a[a.index(b"end_header"):] == g[g.index(b"end_header"):]
assert open("g.01.ply", "rb").read() != g
P
absent g.00.ply
absent g.04.ply

# --- the field that is kept ---

kept() { find "$1" -name '*.field' | wc -l; }
expect 0 "$tsuya" roots roots.yaml -o f1.ply --cache fields --set host.resolution=40
says "field of"
says " made in"
[ "$(kept fields)" -eq 1 ] || fail "one field is kept"
expect 0 "$tsuya" roots roots.yaml -o f2.ply --cache fields --set host.resolution=40
says "from the cache"
same f1.ply f2.ply
expect 0 "$tsuya" roots roots.yaml -o f3.ply --cache fields --set host.resolution=40 --set seed=9
says "from the cache"
expect 0 "$tsuya" roots roots.yaml -o f4.ply --cache none --set host.resolution=40 --set seed=9
same f3.ply f4.ply
[ "$(kept .)" -le 40 ] && [ ! -e none ] || fail "--cache none made a folder"
truncate -s 5000 fields/*.field
expect 0 "$tsuya" roots roots.yaml -o f5.ply --cache fields --set host.resolution=40 --set seed=9
says "the host's field is damaged and is made again"
same f3.ply f5.ply
rm -r fields
"$tsuya" roots roots.yaml -o p1.ply --cache fields 2>/dev/null >/dev/null &
first=$!
"$tsuya" roots roots.yaml -o p2.ply --cache fields 2>/dev/null >/dev/null
wait $first || fail "one of two at once"
same p1.ply p2.ply
[ "$(kept fields)" -eq 1 ] || fail "two at once leave one field"

# Scenes find it, too; without a cache they leave nothing.
cp roots.yaml bad.yaml
expect 0 "$tsuya" render scene.yaml -o s1.exr --cache fields --set assets.fig.mesh.seed=5
says "from the cache"
expect 0 "$tsuya" render scene.yaml -o s2.exr --cache none --set assets.fig.mesh.seed=5
grep -q "cannot be kept" err.txt && fail "--cache none warns"
expect 0 "$tsuya" compare s1.exr s2.exr --fail 'rmse>0'
absent none

# --- a full disk, and interruptions ---

expect 4 bash -c 'ulimit -f 64; exec "$0" roots roots.yaml -o kept.ply --cache none' "$tsuya"
says "kept.ply: cannot write"
same kept.ply old.ply
expect 0 bash -c 'ulimit -f 700; exec "$0" roots roots.yaml -o small.ply --cache full --set detail=2 --set host.resolution=64' "$tsuya"
says "the host's field cannot be kept"
[ "$(kept full)" -eq 0 ] || fail "a part of a field is kept"
for at in 0.3 1; do
    expect 130 timeout --preserve-status -s INT $at "$tsuya" roots roots.yaml -o kept.ply --curves kept_curves.ply \
        --preview kept.png --set detail=0.07 --set tip=0.5 --cache none
    same kept.ply old.ply
    absent kept_curves.ply
    absent kept.png
done
