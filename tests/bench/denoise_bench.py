#!/usr/bin/env python3
"""denoise_bench.py PACKAGE [OIDN]: CPU time to an error, noisy and denoised. By hand: ten minutes.

PACKAGE is the folder of the built Python package, OIDN a library of Open Image Denoise or its folder. The error is relMSE against a long
render, less what that is wrong by. The time is this process's, of sampling and denoising, so that other work on the machine counts little;
a second render of each kind is measured, after the first has compiled its kernels."""

import math
import os
import sys
import time

sys.path.insert(0, sys.argv[1])
import glim  # noqa: E402
import numpy as np  # noqa: E402

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.realpath(__file__))))
SCENES = ["cornell", "cornell_gems", "cornell_mirror_glass", "many_lights", "showcase", "textures"]
SIZE, COUNTS, REFERENCE = (96, 96), (64, 256, 1024), 4096


def rel_mse(picture, reference):
    truth = reference.rgb.astype(np.float64)
    square = (picture - truth) ** 2 - reference.variance
    return (square / (truth**2 + .01 * truth.mean() ** 2)).mean()


def measure(scene, reference, **options):
    """[(CPU seconds, relMSE)] by count of samples."""
    curve = []
    for count in COUNTS:
        scene.render(spp=64, seed=2, **options)
        begin = time.process_time()
        film = scene.render(spp=count, seed=1, **options)
        curve.append((time.process_time() - begin, rel_mse(film.rgb if film.denoised is None else film.denoised, reference)))
    return curve


def time_to(curve, error):
    """Between the measured counts by straight lines on logarithms, beyond them by the nearest line."""
    points = [(math.log(max(e, 1e-12)), math.log(t)) for t, e in curve]
    pair = next(((a, b) for a, b in zip(points, points[1:]) if b[0] <= math.log(error)), points[-2:])
    (e0, t0), (e1, t1) = pair
    return math.exp(t0 + (t1 - t0) * (math.log(error) - e0) / (e1 - e0))


def main():
    engines = {"noisy": {}, "own": {"denoise": True}}
    if len(sys.argv) > 2:
        engines["OIDN"] = {"denoise": True, "oidn": sys.argv[2]}
    for name in SCENES:
        scene = glim.load(os.path.join(ROOT, "scenes", name + ".gltf"), size=SIZE)
        reference = scene.render(samples=(1 << 20, (1 << 20) + REFERENCE))
        curves = {engine: measure(scene, reference, **options) for engine, options in engines.items()}
        goal = curves["noisy"][1][1]
        cells = ["%.2g, %.2g, %.2g" % tuple(error for _, error in curve) for curve in curves.values()]
        gains = ["%.2f" % (curves["noisy"][1][0] / time_to(curve, goal)) for engine, curve in curves.items() if engine != "noisy"]
        print("| %s | %s |" % (name, " | ".join([*cells, *gains])), flush=True)


if __name__ == "__main__":
    main()
