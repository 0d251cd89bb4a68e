# SPDX-License-Identifier: Apache-2.0
"""Exported aggregates against their specifications: export_files.py HEAP.glb HEAP.usda.

The USD text is parsed and held against UsdGeomPointInstancer and UsdGeomMesh, the GLB against glTF 2.0 and
EXT_mesh_gpu_instancing, and the two against one another."""
import json
import math
import re
import struct
import sys

failures = 0


def check(good, text):
    global failures
    if not good:
        failures += 1
        print("FAIL:", text, file=sys.stderr)
    return good


# --- USD text ---

TOKEN = re.compile(r'\s+|#[^\n]*|("""(?:\\.|[^\\])*?"""|"(?:\\.|[^"\\])*"|<[^>]*>|[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?'
                   r'|[A-Za-z_][\w:]*|\[\]|[][(){}=,])')


class Reader:
    def __init__(self, text):
        self.tokens = []
        at = 0
        while at < len(text):
            found = TOKEN.match(text, at)
            if not found:
                raise SystemExit("FAIL: no USD text at: " + text[at:at + 40])
            if found.group(1):
                self.tokens.append(found.group(1))
            at = found.end()
        self.at = 0

    def peek(self):
        return self.tokens[self.at] if self.at < len(self.tokens) else None

    def take(self, expected=None):
        token = self.peek()
        if token is None or (expected is not None and token != expected):
            raise SystemExit(f"FAIL: USD text: expected {expected}, got {token}")
        self.at += 1
        return token

    def value(self):
        token = self.take()
        if token in "[(" and token:
            close, items = {"[": "]", "(": ")"}[token], []
            while self.peek() != close:
                items.append(self.value())
                if self.peek() != close:
                    self.take(",")
            self.take(close)
            return items if token == "[" else tuple(items)
        if token == "[]":
            return []
        if token == "{":
            items = {}
            while self.peek() != "}":
                self.take()  # the type
                key = self.take()
                self.take("=")
                items[key] = self.value()
            self.take("}")
            return items
        if token[0] in '"<':
            return token
        if re.match(r"[-+.\d]", token):
            return float(token)
        return token

    def metadata(self):
        items = {}
        if self.peek() == "(":
            self.take()
            while self.peek() != ")":
                key = self.take()
                if key == "prepend":
                    key = self.take()
                self.take("=")
                items[key] = self.value()
            self.take()
        return items

    def prim(self, path):
        self.take("def")
        prim = {"type": self.take(), "attributes": {}, "children": {}}
        prim["path"] = path + "/" + self.take().strip('"')
        prim["metadata"] = self.metadata()
        self.take("{")
        while self.peek() != "}":
            if self.peek() == "def":
                child = self.prim(prim["path"])
                prim["children"][child["path"]] = child
                continue
            words = []
            while self.peek() != "=":
                words.append(self.take())
            self.take("=")
            kind = "".join(w for w in words[:-1] if w != "uniform")
            value = self.value()
            check(words[-1] not in prim["attributes"], f"{prim['path']}: {words[-1]} twice")
            prim["attributes"][words[-1]] = (kind, value, self.metadata())
        self.take("}")
        return prim


INSTANCER = {"protoIndices": "int[]", "ids": "int64[]", "positions": "point3f[]", "orientations": "quath[]",
             "orientationsf": "quatf[]", "velocities": "vector3f[]", "angularVelocities": "vector3f[]",
             "scales": "float3[]", "extent": "float3[]", "prototypes": "rel"}
MESH = {"points": "point3f[]", "normals": "normal3f[]", "faceVertexCounts": "int[]", "faceVertexIndices": "int[]",
        "subdivisionScheme": "token", "extent": "float3[]", "material:binding": "rel"}
WIDTHS = {"point3f[]": 3, "normal3f[]": 3, "float3[]": 3, "vector3f[]": 3, "quath[]": 4, "quatf[]": 4, "texCoord2f[]": 2}


def check_attributes(prim, schema, count):
    for name, (kind, value, metadata) in prim["attributes"].items():
        where = f"{prim['path']}.{name}"
        if name.startswith("primvars:"):
            check(kind in ("float[]", "texCoord2f[]"), f"{where}: a primvar of type {kind}")
            check(metadata.get("interpolation") == '"vertex"', f"{where}: interpolation {metadata}")
            check(len(value) == count, f"{where}: {len(value)} values for {count}")
        elif check(name in schema, f"{where}: not in the schema"):
            check(schema[name] == kind, f"{where}: {kind}, the schema says {schema[name]}")
        if kind in WIDTHS:
            check(all(isinstance(v, tuple) and len(v) == WIDTHS[kind] for v in value), f"{where}: its tuples")


def check_mesh(prim):
    a = {name: value for name, (_, value, _) in prim["attributes"].items()}
    for name in ("points", "faceVertexCounts", "faceVertexIndices", "extent"):
        check(name in a, f"{prim['path']} lacks {name}")
    check_attributes(prim, MESH, len(a["points"]))
    check(set(a["faceVertexCounts"]) == {3.0}, f"{prim['path']}: faces of other than three corners")
    check(len(a["faceVertexIndices"]) == sum(a["faceVertexCounts"]), f"{prim['path']}: corners")
    check(all(0 <= i < len(a["points"]) and i == int(i) for i in a["faceVertexIndices"]), f"{prim['path']}: indices")
    check(len(a["normals"]) == len(a["points"]), f"{prim['path']}: normals")
    for k in range(3):
        column = [p[k] for p in a["points"]]
        check(a["extent"][0][k] == min(column) and a["extent"][1][k] == max(column), f"{prim['path']}: extent")


def find(prim, path):
    for child in prim["children"].values():
        if child["path"] == path:
            return child
        if path.startswith(child["path"] + "/"):
            return find(child, path)
    return None


def read_usd(path):
    with open(path, encoding="utf-8") as file:
        text = file.read()
    check(text.startswith("#usda 1.0\n"), "USD: its first line")
    reader = Reader(text)
    layer = reader.metadata()
    root = reader.prim("")
    check(reader.peek() is None, "USD: something after the root prim")
    check(layer.get("metersPerUnit") == 1.0 and layer.get("upAxis") == '"Y"', "USD: units")
    check(layer.get("defaultPrim") == f'"{root["path"][1:]}"', "USD: defaultPrim")
    check(root["type"] == "PointInstancer", "USD: a PointInstancer")
    a = {name: value for name, (_, value, _) in root["attributes"].items()}
    for name in ("protoIndices", "positions", "prototypes"):  # what the schema requires
        check(name in a, f"USD: no {name}")
    n = len(a["protoIndices"])
    check_attributes(root, INSTANCER, n)
    for name in ("positions", "orientations", "orientationsf", "scales", "ids"):
        check(len(a[name]) == n, f"USD: {len(a[name])} {name} for {n} instances")
    for name in ("velocities", "angularVelocities"):
        check(len(a.get(name, a["ids"])) == n, f"USD: {name} for {n} instances")
    check(len(set(a["ids"])) == n, "USD: ids differ")
    check(all(0 <= i < len(a["prototypes"]) for i in a["protoIndices"]), "USD: protoIndices")
    check(all(abs(sum(c * c for c in q) - 1) < 1e-5 for q in a["orientationsf"]), "USD: unit quaternions")
    for target in a["prototypes"]:
        prim = find(root, target.strip("<>"))
        if check(prim is not None and prim["type"] == "Mesh", f"USD: {target} is no Mesh"):
            check_mesh(prim)
            binding = prim["attributes"].get("material:binding")
            if binding:
                material = find(root, binding[1].strip("<>"))
                check(material and material["type"] == "Material", f"USD: {binding[1]} is no Material")
                check(prim["metadata"].get("apiSchemas") == ['"MaterialBindingAPI"'], "USD: MaterialBindingAPI")
    return a


# --- GLB ---

def read_glb(path):
    with open(path, "rb") as file:
        data = file.read()
    magic, version, length, size, kind = struct.unpack_from("<4sIII4s", data)
    check(magic == b"glTF" and version == 2 and length == len(data) and kind == b"JSON", "GLB: header")
    root = json.loads(data[20:20 + size])
    binary_size, binary_kind = struct.unpack_from("<I4s", data, 20 + size)
    check(binary_kind == b"BIN\0" and 28 + size + binary_size == len(data), "GLB: chunks")
    return root, data[28 + size:]


FORMATS = {5120: "b", 5121: "B", 5122: "h", 5123: "H", 5125: "I", 5126: "f"}
COUNTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


def column(root, binary, index):
    accessor = root["accessors"][index]
    view = root["bufferViews"][accessor["bufferView"]]
    width, form = COUNTS[accessor["type"]], FORMATS[accessor["componentType"]]
    size = struct.calcsize(form)
    start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
    check(start % size == 0, "GLB: an accessor off its alignment")
    check(accessor.get("byteOffset", 0) + accessor["count"] * width * size <= view["byteLength"], "GLB: accessor's end")
    check(view.get("byteOffset", 0) + view["byteLength"] <= root["buffers"][0]["byteLength"] <= len(binary), "GLB: view")
    flat = struct.unpack_from(f"<{accessor['count'] * width}{form}", binary, start)
    return [flat[i:i + width] for i in range(0, len(flat), width)]


# What the extension allows: type, and component types.
ALLOWED = {"TRANSLATION": ("VEC3", (5126,)), "ROTATION": ("VEC4", (5120, 5122, 5126)), "SCALE": ("VEC3", (5126,))}


def check_glb(path):
    root, binary = read_glb(path)
    check(root["asset"]["version"] == "2.0", "GLB: version")
    check("EXT_mesh_gpu_instancing" in root["extensionsUsed"], "GLB: extensionsUsed")
    check(set(root.get("extensionsRequired", [])) <= set(root["extensionsUsed"]), "GLB: extensionsRequired")
    for mesh in root["meshes"]:
        for primitive in mesh["primitives"]:
            position = root["accessors"][primitive["attributes"]["POSITION"]]
            check("min" in position and "max" in position and position["type"] == "VEC3", "GLB: POSITION")
            indices = column(root, binary, primitive["indices"])
            check(max(i[0] for i in indices) < position["count"], "GLB: indices")
            check({root["accessors"][i]["count"] for i in primitive["attributes"].values()} == {position["count"]},
                  "GLB: attributes of one length")
    places = {}
    for node in root["nodes"]:
        check("mesh" in node, "GLB: an instanced node without mesh")
        attributes = node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]
        check(set(attributes) & set(ALLOWED), "GLB: neither TRANSLATION nor ROTATION nor SCALE")
        check(len({root["accessors"][i]["count"] for i in attributes.values()}) == 1, "GLB: instances of one count")
        for name, index in attributes.items():
            accessor = root["accessors"][index]
            if name in ALLOWED:
                kind, components = ALLOWED[name]
                check(accessor["type"] == kind and accessor["componentType"] in components, f"GLB: type of {name}")
                check(accessor["componentType"] == 5126 or accessor.get("normalized"), f"GLB: {name} normalized")
            else:
                check(re.fullmatch(r"_[A-Z0-9_]+", name), f"GLB: an attribute named {name}")
        columns = {name: column(root, binary, index) for name, index in attributes.items()}
        check(all(abs(sum(c * c for c in q) - 1) < 1e-5 for q in columns["ROTATION"]), "GLB: unit quaternions")
        for i, identity in enumerate(columns["_ID"]):
            places[int(identity[0])] = {name: values[i] for name, values in columns.items()} | {"mesh": node["mesh"]}
    return places


glb = check_glb(sys.argv[1])
usd = read_usd(sys.argv[2])
check(len(glb) == len(usd["ids"]) > 0, "as many instances in both")
for i, identity in enumerate(usd["ids"]):
    one = glb[int(identity)]
    x, y, z, w = one["ROTATION"]
    same = lambda a, b: len(a) == len(b) and all(struct.pack("<f", p) == struct.pack("<f", q) for p, q in zip(a, b))
    check(same(one["TRANSLATION"], usd["positions"][i]), f"id {identity}: position")
    check(same((w, x, y, z), usd["orientationsf"][i]), f"id {identity}: orientation")
    check(same(one["SCALE"], usd["scales"][i]), f"id {identity}: scale")
    check(same(one["_MOISTURE"], (usd["primvars:moisture"][i],)), f"id {identity}: moisture")
    check(("_VELOCITY" in one, "_SPIN" in one) == ("velocities" in usd, "angularVelocities" in usd), "velocities in both")
    if "_VELOCITY" in one:
        check(same(one["_VELOCITY"], usd["velocities"][i]), f"id {identity}: velocity")
        degrees = [math.degrees(c) for c in one["_SPIN"]]
        check(all(abs(p - q) <= 1e-6 * max(1, abs(p)) for p, q in zip(degrees, usd["angularVelocities"][i])),
              f"id {identity}: spin in degrees")
    check(one["mesh"] == usd["protoIndices"][i], f"id {identity}: prototype")
sys.exit(1 if failures else 0)
