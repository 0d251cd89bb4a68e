#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# The slice of tuna: writes tuna.ply, cut on the slant and draped over the rice, and tuna.png with the lines of its grain.
import math
import struct
import zlib

HALF = (30.5, 2.7, 13.6)  # mm
EDGE = 0.9                # mm, radius of the cut edges
FLAT = (13.0, 3.0)        # mm, from the middle: along and across it bends beyond
BEND = (40.0, 21.0)       # mm, radii of these bends


def stations(half, count):
    """Coordinates along an edge: even between the rounded ends, close in these."""
    inner = half - EDGE
    ends = [half - EDGE * (1 - math.sin(math.pi / 2 * (k / 3))) for k in (3, 2, 1)]
    even = [inner * (1 - 2 * k / count) for k in range(count + 1)]
    return ends + even + [-e for e in reversed(ends)]


def rounded(p):
    inner = [max(-h + EDGE, min(h - EDGE, x)) for x, h in zip(p, HALF)]
    away = [x - i for x, i in zip(p, inner)]
    length = math.sqrt(sum(a * a for a in away))
    return [i + EDGE * a / length for i, a in zip(inner, away)]


def bent(x, y, flat, radius):
    """What lies beyond flat follows an arc about a centre below; y counts from the underside."""
    beyond = abs(x) - flat
    if beyond <= 0:
        return x, y
    angle = beyond / radius
    return math.copysign(flat + (radius + y) * math.sin(angle), x), (radius + y) * math.cos(angle) - radius


def draped(p):
    x, y, z = p
    y = (y + HALF[1]) * (1 - 0.12 * (z / HALF[2]) ** 2)
    x += 0.13 * z - 0.4 * (y - HALF[1])  # cut on the slant, in plan and through
    z *= 1 - 0.1 * x / HALF[0] + 0.025 * math.sin(0.19 * x + 1)
    y += 0.12 * math.sin(0.31 * x + 0.4 * z)
    z, y = bent(z, y, FLAT[1], BEND[1])
    x, y = bent(x, y, FLAT[0], BEND[0])
    return x, y, z


def mesh():
    axes = (stations(HALF[0], 40), stations(HALF[1], 3), stations(HALF[2], 18))
    index, points, faces = {}, [], []

    def vertex(p):
        key = tuple(round(c, 5) for c in p)
        if key not in index:
            index[key] = len(points)
            points.append(p)
        return index[key]

    for axis in range(3):
        a, b = (axis + 1) % 3, (axis + 2) % 3
        for side in (1, -1):
            for i in range(len(axes[a]) - 1):
                for k in range(len(axes[b]) - 1):
                    corner = []
                    for s, t in ((0, 0), (1, 0), (1, 1), (0, 1)):
                        p = [0.0] * 3
                        p[axis], p[a], p[b] = side * HALF[axis], axes[a][i + s], axes[b][k + t]
                        corner.append(vertex(p))
                    faces.append(corner if side > 0 else corner[::-1])
    return points, faces


def write_mesh(path):
    points, faces = mesh()
    with open(path, "wb") as out:
        out.write(b"ply\nformat binary_little_endian 1.0\nelement vertex %d\n" % len(points))
        out.write(b"".join(b"property float %s\n" % n for n in (b"x", b"y", b"z", b"s", b"t")))
        out.write(b"element face %d\nproperty list uchar ushort vertex_indices\nend_header\n" % len(faces))
        for p in points:
            at = rounded(p)
            uv = (0.5 + at[0] / 80, 0.5 + at[2] / 40)
            out.write(struct.pack("<5f", *(1e-3 * c for c in draped(at)), *uv))
        for f in faces:
            out.write(struct.pack("<B4H", 4, *f))


def noise(x, y, seed):
    def value(i, k):
        h = (i * 374761393 + k * 668265263 + seed * 2246822519) & 0xFFFFFFFF
        h = ((h ^ (h >> 13)) * 1274126177) & 0xFFFFFFFF
        return (h ^ (h >> 16)) / 0xFFFFFFFF

    i, k = math.floor(x), math.floor(y)
    s, t = x - i, y - k
    s, t = s * s * (3 - 2 * s), t * t * (3 - 2 * t)
    low = value(i, k) * (1 - s) + value(i + 1, k) * s
    high = value(i, k + 1) * (1 - s) + value(i + 1, k + 1) * s
    return low * (1 - t) + high * t


def color(x, z):
    """Flakes of muscle lie across the slice, a pale sheet of tissue between each two, and fibres along them."""
    across = x + 0.75 * z + 0.035 * z * z + 5.5 * (noise(x / 15, z / 15, 1) - 0.5)
    flake = across / 4.8
    off = abs(flake - round(flake)) * 4.8
    sheet = math.exp(-((off / (0.25 + 0.2 * noise(x / 5, z / 5, 2))) ** 2)) * (0.35 + 0.65 * noise(x / 7, z / 7, 3))
    fibre = noise(across / 0.9, (z - 0.6 * x) / 0.16, 4) - 0.5
    deep = 1 + 0.22 * fibre + 0.3 * (noise(x / 9, z / 9, 5) - 0.5)
    meat, pale = (0.8, 0.2, 0.18), (0.95, 0.66, 0.58)
    return [min(1, max(0, deep * m + (p - m) * 0.75 * sheet)) for m, p in zip(meat, pale)]


def write_picture(path, width=420, height=210):
    rows = bytearray()
    for j in range(height):
        rows.append(0)
        for i in range(width):
            x, z = 80 * ((i + 0.5) / width - 0.5), 40 * (0.5 - (j + 0.5) / height)
            rows += bytes(round(255 * c) for c in color(x, z))

    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    with open(path, "wb") as out:
        out.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">2I5B", width, height, 8, 2, 0, 0, 0)))
        out.write(chunk(b"IDAT", zlib.compress(bytes(rows), 9)) + chunk(b"IEND", b""))


write_mesh("tuna.ply")
write_picture("tuna.png")
