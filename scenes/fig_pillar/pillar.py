#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# The ruin that the fig grows on: writes pillar.ply, one closed surface (drums, a broken capital, a base, a chipped shaft)
# as a height of radius over angle and height.
import math
import struct

AROUND, UP = 160, 180
HEIGHT = 0.62
PLINTH = 0.045


def noise(x, y, z, seed=0):
    """Value noise of period none, smooth."""
    def lattice(i, j, k):
        h = (i * 73856093 ^ j * 19349663 ^ k * 83492791 ^ seed * 2654435761) & 0xFFFFFFFF
        h = ((h ^ h >> 15) * 0x2C1B3C6D) & 0xFFFFFFFF
        h = ((h ^ h >> 12) * 0x297A2D39) & 0xFFFFFFFF
        return ((h ^ h >> 15) & 0xFFFF) / 32767.5 - 1
    i, j, k = math.floor(x), math.floor(y), math.floor(z)
    f = [t * t * (3 - 2 * t) for t in (x - i, y - j, z - k)]
    s = 0.0
    for a in (0, 1):
        for b in (0, 1):
            for c in (0, 1):
                w = (f[0] if a else 1 - f[0]) * (f[1] if b else 1 - f[1]) * (f[2] if c else 1 - f[2])
                s += w * lattice(i + a, j + b, k + c)
    return s


def profile(y):
    """Half width against height: square below and above (returned as how square), round between."""
    if y < PLINTH:
        return 0.125, 1.0
    if y < 0.085:
        return 0.108 + 0.010 * math.sin((y - PLINTH) / 0.04 * math.pi), 0.0
    if y < 0.50:
        t = (y - 0.085) / 0.415
        joint = min(abs(y - c) for c in (0.215, 0.36))
        return 0.094 - 0.014 * t - 0.006 * math.exp(-(joint / 0.004) ** 2), 0.0
    if y < 0.545:
        t = (y - 0.50) / 0.045
        return 0.08 + 0.033 * t * t, 0.0
    return 0.122, 1.0


def radius(angle, y):
    half, square = profile(y)
    c, s = abs(math.cos(angle)), abs(math.sin(angle))
    p = 9.0 if square else 2.0
    r = half / (c ** p + s ** p) ** (1 / p)
    x, z = math.cos(angle), math.sin(angle)
    r += 0.004 * noise(9 * x, 22 * y, 9 * z) + 0.0018 * noise(23 * x, 55 * y, 23 * z, 1)
    # A corner of the capital has broken off, and the shaft is chipped below it.
    d = math.hypot(angle - 0.9, (y - 0.60) / 0.14)
    r -= 0.075 * math.exp(-(d / 0.55) ** 4) * (1 + 0.3 * noise(14 * x, 40 * y, 14 * z, 2))
    d = math.hypot(0.8 * (angle - 4.1), (y - 0.30) / 0.12)
    r -= 0.022 * math.exp(-(d / 0.4) ** 4) * (1 + 0.4 * noise(18 * x, 50 * y, 18 * z, 3))
    return r


def main():
    points = [(0.0, 0.0, 0.0)]
    for j in range(UP + 1):
        y = HEIGHT * j / UP
        for i in range(AROUND):
            a = 2 * math.pi * i / AROUND
            r = radius(a, y)
            top = 0.012 * noise(11 * math.cos(a), 0, 11 * math.sin(a), 4) * max(0.0, y / HEIGHT - 0.9) * 10
            points.append((r * math.cos(a), y + top, -r * math.sin(a)))
    points.append((0.0, HEIGHT + 0.004, 0.0))
    faces = []
    for i in range(AROUND):
        n = (i + 1) % AROUND
        faces.append((0, 1 + n, 1 + i))
        last = 1 + UP * AROUND
        faces.append((len(points) - 1, last + i, last + n))
        for j in range(UP):
            a, b = 1 + j * AROUND, 1 + (j + 1) * AROUND
            faces += [(a + i, a + n, b + n), (a + i, b + n, b + i)]
    with open("pillar.ply", "wb") as out:
        out.write((f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\nproperty float x\n"
                   f"property float y\nproperty float z\nelement face {len(faces)}\n"
                   "property list uchar int vertex_indices\nend_header\n").encode())
        for p in points:
            out.write(struct.pack("<3f", *p))
        for f in faces:
            out.write(struct.pack("<B3i", 3, *f))


main()
