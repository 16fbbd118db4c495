#!/usr/bin/env python3
"""How often the intervals of denoised pictures contain their true errors. By hand: ten minutes.

Each of six scenes is rendered with many seeds and denoised; a long render stands for the truth, and what it is known to be wrong by is
taken into account. 95 % of the intervals should hold. tests/denoising.md has the last result."""

import argparse
import math
import os
import sys

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("package", help="the folder of the built Python package")
parser.add_argument("--oidn", help="a library of Open Image Denoise or its folder, to be tried as well")
parser.add_argument("--adaptive", action="store_true", help="by adaptive sampling, 256 samples on average, instead of 128 of each pixel")
OPTIONS = parser.parse_args()
sys.path.insert(0, OPTIONS.package)
import glim  # noqa: E402
import numpy as np  # noqa: E402

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.realpath(__file__))))
SCENES = ["cornell", "cornell_gems", "cornell_mirror_glass", "many_lights", "showcase", "textures"]
SIZE, REFERENCE, SEEDS = (48, 48), 4096, 60
SAMPLING = {"adaptive": "neighbours", "spp": 256} if OPTIONS.adaptive else {"spp": 128}


def true_errors(picture, reference):
    """MSE and relMSE of a picture, less what the reference is wrong by."""
    truth = reference.rgb.astype(np.float64)
    square = (picture - truth) ** 2 - reference.variance
    return square.mean(), (square / (truth**2 + .01 * truth.mean() ** 2)).mean()


class Calibration:
    def __init__(self):
        self.inside, self.films, self.ratios = 0, 0, [[], []]

    def add(self, film, truth):
        error = film.denoised_error
        scale = error.mean**2
        self.inside += error.rmse_low**2 * scale <= truth[0] <= error.rmse_high**2 * scale
        self.films += 1
        self.ratios[0].append(error.mse / truth[0])
        self.ratios[1].append(error.rel_mse / truth[1])

    def __str__(self):
        return " | ".join(["%d %%" % round(100 * self.inside / self.films), *(
            "%.3f +- %.3f" % (np.mean(ratios), np.std(ratios) / math.sqrt(self.films)) for ratios in self.ratios)])


def main():
    engines = {"own": {}}
    if OPTIONS.oidn:
        engines["OIDN"] = {"oidn": OPTIONS.oidn}
    held = dict.fromkeys(engines, 0)
    for name in SCENES:
        scene = glim.load(os.path.join(ROOT, "scenes", name + ".gltf"), size=SIZE)
        reference = scene.render(samples=(1 << 20, (1 << 20) + REFERENCE))
        for engine, options in engines.items():
            calibration = Calibration()
            for seed in range(1, SEEDS + 1):
                film = scene.render(**SAMPLING, seed=seed, denoise=True, **options)
                calibration.add(film, true_errors(film.denoised, reference))
            held[engine] += calibration.inside
            print("| %s | %s | %s |" % (name, engine, calibration), flush=True)
    for engine, inside in held.items():
        print("%s: %.1f %% of %d films" % (engine, 100 * inside / (SEEDS * len(SCENES)), SEEDS * len(SCENES)))


if __name__ == "__main__":
    main()
