# SPDX-License-Identifier: Apache-2.0
# A volume of one's own: 128^3 floats, 1 on a gyroid and less beside it, x fastest, then y, then z. Written beside this.
from array import array
from math import cos, pi, sin
from pathlib import Path

n, periods = 128, 4
turn = [2 * pi * periods * i / n for i in range(n)]
s, c, r = [sin(t) for t in turn], [cos(t) for t in turn], range(n)
values = array("f", (1 - abs(s[x] * c[y] + s[y] * c[z] + s[z] * c[x]) for z in r for y in r for x in r))
Path(__file__).with_name("gyroid.raw").write_bytes(values.tobytes())
