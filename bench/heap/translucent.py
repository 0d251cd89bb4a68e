# SPDX-License-Identifier: Apache-2.0
"""Translucent grains by this renderer and by Cycles at equal mean free paths: translucent.py FOLDER ROUNDS SAMPLES
THREADS WIDTHxHEIGHT MILLIMETRES...; called by bench/cycles. Prints a table for each length, and adds a line of it to
cycles.jsonl beside the folder.

What Cycles 3.4 makes of its inputs (bssrdf.h, subsurface_random_walk.h): light enters by the cosine and leaves as from
a Lambert surface, indices matched; single-scattering albedo from the colour by a fit; the mean free path is
Radius / (4 pi) for RANDOM_WALK_FIXED_RADIUS, Radius sqrt(3 (1 - alpha')) for RANDOM_WALK, alpha' being that of a dipole
of the same colour under the index; d = Radius / (4 pi) in the profile of Christensen and Burley, d = l / s(colour).
Beyond a diffuse reflection translucent bodies are Lambert of their colour: `indirect_subsurface: false` here."""
import json
import math
import os
import re
import statistics
import subprocess
import sys

COLOR = 0.8  # of the nodes of Cycles
INDEX = 1.4  # their default
TSUYA = "build/release/tsuya"


def albedo(c):
    """Of one scattering, isotropic: subsurface_random_walk_remap at anisotropy 0."""
    blend = c**0.25
    thin = 1.8260523782 * math.atan(5.11247090343 * c) ** 1.09686102424
    dense = 0.496310210422 * math.atan(4.2350090695 * c) ** 2.40602999408
    return min((1 - blend) * thin + blend * dense, 0.999999)


def shrink(c, index):
    """Mean free path over Radius of RANDOM_WALK: bssrdf_setup_radius, by as many halvings."""
    f = (0.710 - 1.440 / index) / index + 0.668 + 0.0636 * index
    edge, low, high, middle = 4 / 3 * (1 + f) / (1 - f), 0.0, 1.0, 0.5
    for _ in range(12):
        middle = 0.5 * (low + high)
        s = math.sqrt(3 * (1 - middle))
        if 0.5 * middle * (1 + math.exp(-edge * s)) * math.exp(-s) < c:
            low = middle
        else:
            high = middle
    return math.sqrt(3 * (1 - middle))


def radius(kind, length):
    burley = 1.9 - COLOR + 3.5 * (COLOR - 0.8) ** 2  # s of Christensen and Burley 2015, eq. 6
    return {
        "random_walk": length / shrink(COLOR, INDEX),
        "fixed_radius": 4 * math.pi * length,
        "burley": 4 * math.pi * length / burley,
        "diffuse": 1.0,
    }[kind]


def run(command, log):
    with open(log, "w") as file:
        if subprocess.run(command, stdout=file, stderr=file).returncode != 0:
            sys.exit("bench: %s\n%s" % (" ".join(command), open(log).read()[-2000:]))


class Bench:
    def __init__(self, folder, rounds, samples, threads, size):
        self.folder, self.rounds, self.samples, self.threads, self.size = folder, rounds, samples, threads, size

    def picture(self, name, seed):
        return "%s/%s.%d.exr" % (self.folder, name, seed)

    def render_theirs(self, name, kind, length, seed):
        out, log = self.picture(name, seed), self.folder + "/cycles.log"
        script = ["blender", "-b", "--factory-startup", "--python-exit-code", "1", "--python", "bench/heap/cycles.py"]
        run(script + ["--", self.folder, str(self.samples), str(seed), str(self.threads)] + self.size.split("x")
            + [os.path.abspath(out), kind, "%.9g" % radius(kind, length)], log)
        info = subprocess.run([TSUYA, "info", out], capture_output=True, text=True, check=True).stdout
        parts = re.search(r'ViewLayer.render_time: "([0-9:.]+)"', info).group(1).split(":")
        return sum(float(p) * 60**i for i, p in enumerate(reversed(parts)))

    def render_ours(self, name, material, indirect, seed, samples):
        stats = self.folder + "/stats.json"
        run([TSUYA, "render", self.folder, "--set", "materials.rice=" + material, "--set",
             "render.indirect_subsurface=" + indirect, "--spp", str(samples), "--seed", str(seed), "--threads",
             str(self.threads), "--size", self.size, "--progress", "none", "-o", self.picture(name, seed), "--stats",
             stats], self.folder + "/tsuya.log")
        return json.load(open(stats))["render_seconds"]

    def between(self, a, b):
        """Over the grains, instances 1 to 2000: mean of both, and the squared difference."""
        mask = self.picture("mask", 1) + ":instance<2001"
        out = subprocess.run([TSUYA, "compare", a, b, "--channels", "R", "--metric", "rmse", "--mask", mask, "--json"],
                             capture_output=True, text=True).stdout
        number = lambda key: float(re.search('"%s": ([-0-9.e+]+)' % key, out).group(1))
        return number("reference_mean"), number("test_mean"), number("rmse") ** 2

    def mean(self, name, seed):
        picture = self.picture(name, seed)
        return self.between(picture, picture)[0]

    def color_like(self, length, indirect, wanted):
        """The colour with which `depth` has a mean: two renders of few samples, and a power law between them."""
        tries, few = [], max(2, self.samples // 8)
        for c in (0.8, 0.88):
            self.render_ours("pilot", cdrf(c, length), indirect, 1, few)
            tries.append((c, self.mean("pilot", 1)))
        (c0, m0), (c1, m1) = tries
        return min(c0 * (c1 / c0) ** (math.log(wanted / m0) / math.log(m1 / m0)), 1.0)

    def measure(self, name, seconds):
        """Of all rounds: half the mean squared difference of two seeds is the error."""
        pairs = [self.between(self.picture(name, i), self.picture(name, i + 1)) for i in range(1, self.rounds)]
        error = statistics.mean(p[2] / 2 for p in pairs)
        mean = statistics.mean([p[0] for p in pairs] + [pairs[-1][1]])
        time = statistics.median(seconds)
        return {"seconds": time, "mse": error, "k": error * time, "mean": mean}


def cdrf(color, length):
    return "{ model: cdrf, color: %.6g, mean_free_path: %.9g, specular_weight: 0 }" % (color, length)


def walk(length):
    a = albedo(COLOR)
    coefficients = (a / length, (1 - a) / length)
    return "{ model: walk, scattering: %.9g, absorption: %.9g, specular_weight: 0 }" % coefficients


def measure_all(bench, kinds, jobs):
    """kinds: of Cycles; jobs: name -> (material, indirect). In turn, round by round."""
    seconds = {name: [] for name in list(kinds) + list(jobs)}
    for seed in range(1, bench.rounds + 1):
        for name, (kind, length) in kinds.items():
            seconds[name].append(bench.render_theirs(name, kind, length, seed))
        for name, (material, indirect) in jobs.items():
            seconds[name].append(bench.render_ours(name, material, indirect, seed, bench.samples))
    return {name: bench.measure(name, s) for name, s in seconds.items()}


def compare(bench, length):
    matter = walk(length)
    jobs = {"walk": (matter, "true"), "walk, once": (matter, "false")}
    colors = {}
    for suffix, indirect in (("", "true"), (", once", "false")):
        bench.render_ours("pilot walk", matter, indirect, 1, max(2, bench.samples // 8))
        colors["depth" + suffix] = bench.color_like(length, indirect, bench.mean("pilot walk", 1))
        jobs["depth" + suffix] = (cdrf(colors["depth" + suffix], length), indirect)
    kinds = {"Cycles random walk": ("random_walk", length), "Cycles Burley": ("burley", length)}
    return measure_all(bench, kinds, jobs), colors


def show(rows, log, length):
    print("\nmean free path %g mm: Radius %.3g mm of RANDOM_WALK, %.3g of RANDOM_WALK_FIXED_RADIUS, %.3g of BURLEY" %
          (length, radius("random_walk", length), radius("fixed_radius", length), radius("burley", length)))
    print("%-20s %8s %10s %9s %8s %14s %10s" % ("", "seconds", "grain MSE", "K", "mean", "K / rnd. walk", "K / Burley"))
    walks, burley = rows["Cycles random walk"]["k"], rows["Cycles Burley"]["k"]
    for name, r in rows.items():
        theirs = name.startswith("Cycles")
        ratios = "" if theirs else "%14.3f %10.3f" % (r["k"] / walks, r["k"] / burley)
        print("%-20s %8.2f %10.6f %9.5f %8.4f %s" % (name, r["seconds"], r["mse"], r["k"], r["mean"], ratios))
    log.write(json.dumps({"mean_free_path_mm": length, "rows": rows}) + "\n")
    log.flush()


def main():
    folder, rounds, samples, threads, size = sys.argv[1], *map(int, sys.argv[2:5]), sys.argv[5]
    bench = Bench(folder, rounds, samples, threads, size)
    matte = "{ model: surface, base_color: %g, specular_weight: 0 }" % COLOR
    bench.render_ours("mask", matte, "true", 1, 16)
    rows = measure_all(bench, {"Cycles diffuse": ("diffuse", 1.0)}, {"diffuse": (matte, "true")})
    for name, r in rows.items():
        print("%-20s %8.2f s, grain MSE %.6f, K %.5f, mean %.4f" % (name, r["seconds"], r["mse"], r["k"], r["mean"]))
    with open(os.path.dirname(folder) + "/cycles.jsonl", "a") as log:
        for length in map(float, sys.argv[6:]):
            rows, colors = compare(bench, length)
            show(rows, log, length)
            print("(colour %.3f of depth, %.3f once; wanted: depth 1/18 = .056 and 1/10, walk 1/2)" %
                  (colors["depth"], colors["depth, once"]))
            sys.stdout.flush()


main()
