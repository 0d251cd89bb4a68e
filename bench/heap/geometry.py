#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Geometry that two renderers share: geometry.py PACKED.glb FOLDER writes PLY files of one grain, its places, the
bowl and the ground. Needs nothing but Python."""
import json
import math
import os
import struct
import sys

SEGMENTS, RINGS = 64, 33  # 2 * 64 * 32 = 4,096 triangles
SEMI_AXES = (0.003, 0.0015, 0.00125)
BOWL = dict(radius=0.036, height=0.034, thickness=0.002, foot_radius=0.014, foot_height=0.002, curve=3.0)


def write_ply(path, columns, rows, faces=None):
    with open(path, "wb") as out:
        out.write(b"ply\nformat binary_little_endian 1.0\nelement vertex %d\n" % len(rows))
        out.write("".join("property float %s\n" % name for name in columns).encode())
        if faces is not None:
            out.write(b"element face %d\nproperty list uchar int vertex_indices\n" % len(faces))
        out.write(b"end_header\n")
        for row in rows:
            out.write(struct.pack("<%df" % len(columns), *row))
        for face in faces or []:
            out.write(struct.pack("<B3i", 3, *face))


def grain():
    """|x/a|^3 + (y/b)^2 + (z/c)^2 = 1, turned about x: every quad is flat, so the mesh is convex."""
    a, b, c = SEMI_AXES
    rows, faces = [(a, 0.0, 0.0)], []
    for ring in range(1, RINGS):
        x = math.cos(math.pi * ring / RINGS)
        radius = math.sqrt(1.0 - abs(x) ** 3)
        for k in range(SEGMENTS):
            angle = 2.0 * math.pi * k / SEGMENTS
            rows.append((a * x, b * radius * math.cos(angle), c * radius * math.sin(angle)))
    rows.append((-a, 0.0, 0.0))
    last = len(rows) - 1
    at = lambda ring, k: 1 + (ring - 1) * SEGMENTS + k % SEGMENTS
    for k in range(SEGMENTS):
        faces.append((0, at(1, k), at(1, k + 1)))
        faces.append((last, at(RINGS - 1, k + 1), at(RINGS - 1, k)))
        for ring in range(1, RINGS - 1):
            faces.append((at(ring, k), at(ring + 1, k), at(ring + 1, k + 1)))
            faces.append((at(ring, k), at(ring + 1, k + 1), at(ring, k + 1)))
    return rows, faces


def bowl():
    """Both sides of the wall of the recipe's bowl, without its foot."""
    half, curve = 0.5 * BOWL["thickness"], BOWL["curve"]
    lip_r, lip_y = BOWL["radius"] - half, BOWL["height"] - half
    soft, foot_r, foot_h = 0.35 * BOWL["foot_radius"], BOWL["foot_radius"], BOWL["foot_height"]
    bottom = half + 0.5 * foot_h
    rise = lip_y - bottom

    def run(r, flat):
        x = r - flat
        return x * x / (math.sqrt(x * x + soft * soft) + soft) if x > 0.0 else 0.0

    low, high, wanted = 0.0, foot_r, 0.5 * foot_h / rise
    flat = 0.0
    for _ in range(60):
        flat = 0.5 * (low + high)
        if (run(foot_r, flat) / run(lip_r, flat)) ** curve > wanted:
            low = flat
        else:
            high = flat
    middle = lambda r: bottom + rise * (run(r, flat) / run(lip_r, flat)) ** curve

    def offset(r, distance):
        step = 1e-6
        slope = (middle(r + step) - middle(max(r - step, 0.0))) / (step + min(r, step))
        scale = distance / math.sqrt(1.0 + slope * slope)
        return r + scale * slope, middle(r) - scale

    steps = 96
    profile = [offset(lip_r * k / steps, half) for k in range(1, steps + 1)]
    start = math.atan2(profile[-1][1] - lip_y, profile[-1][0] - lip_r)
    for k in range(1, 12):  # the lip is a half circle
        angle = start + math.pi * k / 12
        profile.append((lip_r + half * math.cos(angle), lip_y + half * math.sin(angle)))
    profile += [offset(lip_r * k / steps, -half) for k in range(steps, 0, -1)]
    around, rows, faces = 256, [(0.0, bottom - half, 0.0)], []
    for r, y in profile:
        for k in range(around):
            angle = 2.0 * math.pi * k / around
            rows.append((r * math.cos(angle), y, r * math.sin(angle)))
    rows.append((0.0, bottom + half, 0.0))
    last, count = len(rows) - 1, len(profile)
    at = lambda ring, k: 1 + ring * around + k % around
    for k in range(around):
        faces.append((0, at(0, k), at(0, k + 1)))
        faces.append((last, at(count - 1, k + 1), at(count - 1, k)))
        for ring in range(count - 1):
            faces.append((at(ring, k), at(ring + 1, k), at(ring + 1, k + 1)))
            faces.append((at(ring, k), at(ring + 1, k + 1), at(ring, k + 1)))
    return rows, faces


def places(path):
    """Position, rotation (x y z w) and scale of every instance of an aggregate file."""
    with open(path, "rb") as file:
        data = file.read()
    length = struct.unpack("<I", data[12:16])[0]
    document, binary = json.loads(data[20 : 20 + length]), data[28 + length :]

    def floats(index):
        accessor = document["accessors"][index]
        view = document["bufferViews"][accessor["bufferView"]]
        width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[accessor["type"]]
        begin = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        stride = view.get("byteStride", 4 * width)
        return [struct.unpack_from("<%df" % width, binary, begin + i * stride) for i in range(accessor["count"])]

    rows = []
    for node in document["nodes"]:
        attributes = node.get("extensions", {}).get("EXT_mesh_gpu_instancing", {}).get("attributes")
        if attributes:
            columns = [floats(attributes[name]) for name in ("TRANSLATION", "ROTATION", "SCALE")]
            rows += [t + r + (s[0],) for t, r, s in zip(*columns)]
    return rows


def main():
    packed, folder = sys.argv[1:]
    write_ply(os.path.join(folder, "grain.ply"), "x y z".split(), *grain())
    write_ply(os.path.join(folder, "bowl.ply"), "x y z".split(), *bowl())
    half = 2.0
    corners = [(-half, 0.0, -half), (-half, 0.0, half), (half, 0.0, half), (half, 0.0, -half)]
    write_ply(os.path.join(folder, "ground.ply"), "x y z".split(), corners, [(0, 1, 2), (0, 2, 3)])
    columns = "x y z orient_0 orient_1 orient_2 orient_3 pscale".split()
    write_ply(os.path.join(folder, "grains.ply"), columns, places(packed))


main()
