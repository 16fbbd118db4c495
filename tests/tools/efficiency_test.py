#!/usr/bin/env python3
"""tools/efficiency without Mitsuba: figures of renders whose answer is known, references, the table and the command line."""

import os
import resource
import sys
import tempfile
import unittest
from types import SimpleNamespace
from unittest import mock

import numpy as np

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "tools"))

from mitsuba_check.errors import CheckError  # noqa: E402
from peer_efficiency import estimates, measure, references, report  # noqa: E402
from peer_efficiency.arguments import parse_arguments  # noqa: E402

HEIGHT, WIDTH, SEEDS = 40, 52, 6


def noisy(source, deviation):
    return 1 + deviation * source.standard_normal((SEEDS, HEIGHT, WIDTH, 3))


def compare(source, deviations, costs):
    weights = estimates.weights_of(np.ones((HEIGHT, WIDTH, 3)))
    errors = [estimates.tile_errors(noisy(source, d), weights) for d in deviations]
    return estimates.compare(errors, estimates.pixels_of_tiles(HEIGHT, WIDTH), costs)


class EstimatesTest(unittest.TestCase):
    def test_tiles_hold_all_pixels(self):
        pixels = estimates.pixels_of_tiles(HEIGHT, WIDTH)
        self.assertEqual((len(pixels), pixels.sum(), pixels.min()), (3 * 4, HEIGHT * WIDTH, 8 * 4))
        errors = estimates.tile_errors(noisy(np.random.default_rng(1), 1), np.ones((HEIGHT, WIDTH, 3)))
        self.assertEqual(errors.shape, (SEEDS, 12))

    def test_a_known_efficiency(self):
        speed = np.array([1, 1, 5, 1, 2, 1])  # of the machine, the same for both
        found = compare(np.random.default_rng(1), (0.1, 0.2), (2e-6 * speed, 1e-6 * speed))
        # 31,200 squares per renderer: .8 % each, 1.1 % in their ratio.
        self.assertAlmostEqual(found["relmse"][0]["value"], 0.01 / 1.01, delta=0.04 * 0.01)
        self.assertAlmostEqual(found["samples"]["value"], 4, delta=0.22)
        self.assertEqual(found["time"], {"median": 2, "least": 2, "most": 2})
        self.assertAlmostEqual(found["efficiency"]["value"], found["samples"]["value"] / 2)
        self.assertTrue(1.8 < found["efficiency"]["low"] < 2 < found["efficiency"]["high"] < 2.2, found)

    def test_intervals_cover(self):
        source, inside, trials = np.random.default_rng(2), 0, 100
        cost = np.ones(SEEDS)
        with mock.patch.object(estimates, "RESAMPLES", 400):
            for _ in range(trials):
                ratio = compare(source, (0.1, 0.2), (cost, cost))["samples"]
                inside += ratio["low"] <= 4 <= ratio["high"]
        self.assertGreaterEqual(inside, 88)  # of 95 % or more: fewer with probability 1.3e-3 at most

    def test_without_noise_or_time_there_is_no_ratio(self):
        cost = np.ones(SEEDS)
        found = compare(np.random.default_rng(1), (0, 0.1), (cost, cost))
        self.assertEqual((found["samples"], found["efficiency"]), (estimates.UNKNOWN, estimates.UNKNOWN))
        found = compare(np.random.default_rng(1), (0.1, 0.1), (cost - 1, cost))
        self.assertEqual((found["time"], found["efficiency"]), (None, estimates.UNKNOWN))
        self.assertIsNotNone(found["samples"]["value"])


class RelativeErrorTest(unittest.TestCase):
    def test_weights_are_of_the_square_around(self):
        picture = np.random.default_rng(1).random((9, 7, 3))
        weights = estimates.weights_around(picture)
        np.testing.assert_allclose(weights[4, 3], picture[2:7, 1:6].mean(axis=(0, 1)) ** -2)
        rows, columns = np.ix_([2, 1, 0, 1, 2], [2, 1, 0, 1, 2])
        np.testing.assert_allclose(weights[0, 0], picture[rows, columns].mean(axis=(0, 1)) ** -2)
        picture[:6, :6] = 0
        self.assertEqual(estimates.weights_around(picture)[2, 2].tolist(), [0, 0, 0])

    def test_two_renders_differ_by_twice_the_variance(self):
        renders, weights = 2 * noisy(np.random.default_rng(1), .1)[:2], np.full((HEIGHT, WIDTH, 3), .25)
        found = estimates.relmse_of(renders, weights)
        self.assertAlmostEqual(found["value"], np.mean((renders[0] - renders[1]) ** 2 / 2 / 4))
        # 6,240 squares of one degree of freedom: 1.8 %.
        self.assertAlmostEqual(found["value"], .01, delta=.08 * .01)
        self.assertTrue(found["low"] < found["value"] < found["high"] < 1.3 * found["low"], found)


class TurnsTest(unittest.TestCase):
    def test_what_does_not_grow_with_samples_cancels(self):
        clock = np.zeros(2)

        def render(_seed, spp):
            nonlocal clock
            clock = clock + [3 + 0.5 * spp, 2 + 0.25 * spp]
            return np.zeros((2, 5, 3))
        turns = measure.Turns("glim", SimpleNamespace(render=render), resource.RUSAGE_SELF)
        with mock.patch.object(measure, "seconds_used", lambda _who: clock):
            turns.add_round(1, 32, 10, np.asarray)
        np.testing.assert_allclose(turns.costs, [[0.05, 0.025]])
        np.testing.assert_allclose(turns.fixed, [[3, 2]])
        self.assertFalse(turns.mostly_starts(32, 10))
        self.assertTrue(turns.mostly_starts(4, 10))

    def test_a_picture_that_is_not_finite(self):
        renderer = SimpleNamespace(render=lambda _seed, _spp: np.full((2, 2, 3), np.nan))
        with self.assertRaisesRegex(CheckError, "by Mitsuba with seed 7 has values that are not finite"):
            measure.Turns("Mitsuba", renderer, resource.RUSAGE_SELF).add_round(7, 2, 4, np.asarray)


class ReferencesTest(unittest.TestCase):
    def test_which_file(self):
        with tempfile.TemporaryDirectory() as folder:
            for name in ("box_256_d12.exr", "box_256_d12.var.exr", "box_red_256_d12.exr", "ball.exr"):
                open(os.path.join(folder, name), "w", encoding="utf-8").close()
            self.assertEqual(references.find_reference(folder, "a/box.gltf"), os.path.join(folder, "box_256_d12.exr"))
            self.assertEqual(references.find_reference(folder, "ball.glb"), os.path.join(folder, "ball.exr"))
            self.assertIsNone(references.find_reference(folder, "red.gltf"))
            open(os.path.join(folder, "box.exr"), "w", encoding="utf-8").close()
            with self.assertRaisesRegex(CheckError, "has 2 references"):
                references.find_reference(folder, "a/box.gltf")

    def test_smaller_pictures(self):
        picture = np.arange(4 * 6 * 3, dtype=float).reshape(4, 6, 3)
        np.testing.assert_array_equal(references.shrink(picture, (6, 4), ""), picture)
        small = references.shrink(picture, (3, 2), "")
        self.assertEqual(small.shape, (2, 3, 3))
        np.testing.assert_allclose(small[1, 2], picture[2:, 4:].mean(axis=(0, 1)))
        for size in ((3, 4), (4, 4), (12, 8)):
            with self.assertRaisesRegex(CheckError, "x.exr: has 6x4 pixels, expected a whole multiple"):
                references.shrink(picture, size, "x.exr")


def row(driver, program, ratio):
    interval, spread = {"value": 2, "low": 1, "high": 3}, {"median": 2, "least": 1, "most": 3}
    side = {"relmse_spp": interval, "cpu_us": spread, "wall_us": spread}
    return {"scene": "scenes/box.gltf", "size": [8, 6], "driver": driver, "device": "d", "program": program, "peer": "Mitsuba 3",
            "glim": side, "mitsuba": side, "ratios": {"samples": ratio, "time": None, "efficiency": ratio}}


class ReportTest(unittest.TestCase):
    def lines(self, *rows):
        return report.to_tables(SimpleNamespace(seeds=8, spp=64, bounces=11), list(rows)).splitlines()

    def test_a_table_for_each_driver(self):
        known = {"value": 1.5, "low": 1.25, "high": 1.75}
        lines = self.lines(row("A", "glim", known), row("B", "glim", estimates.UNKNOWN))
        self.assertEqual([line for line in lines if line.startswith("##")], ["## A", "## B"])
        self.assertIn("d, Mitsuba 3: 8 renders of 64 samples a pixel by each, 11 bounces.", lines)
        self.assertIn("| `box` | 8x6 " + 6 * "| 2 [1, 3] " + "| 1.5 [1.25, 1.75] | unknown | 1.5 [1.25, 1.75] |", lines)
        self.assertIn("| `box` | 8x6 " + 6 * "| 2 [1, 3] " + "| unknown | unknown | unknown |", lines)
        self.assertEqual(len({line.count("|") for line in lines if line.startswith("|")}), 1)

    def test_programs_are_named_where_there_are_several(self):
        lines = self.lines(row("A", "glim", estimates.UNKNOWN), row("A", "other/glim", estimates.UNKNOWN))
        self.assertEqual([line.split(" | ")[0] for line in lines if "`box`" in line], ["| `box`, glim", "| `box`, other/glim"])


class CommandTest(unittest.TestCase):
    def test_usage(self):
        for arguments in ([], ["a.gltf", "--seeds", "2"], ["a.gltf", "--spp", "1"], ["a.gltf", "--driver", "nowhere.json"],
                          ["a.gltf", "--program", __file__ + ".none"], ["a.gltf", "--references", __file__],
                          ["a.gltf", "--json", "no/where.json"], ["a.gltf", "--unknown"]):
            with self.assertRaises(SystemExit) as caught, mock.patch("sys.stderr"):
                parse_arguments(arguments)
            self.assertEqual(caught.exception.code, 2, arguments)
        options = parse_arguments(["a.gltf", "b.glb", "--driver", __file__, "--driver", __file__, "--size", "64x48"])
        self.assertEqual((options.scenes, options.size, options.drivers), (["a.gltf", "b.glb"], (64, 48), 2 * [os.path.abspath(__file__)]))
        self.assertEqual(parse_arguments(["a.gltf"]).drivers, [None])


if __name__ == "__main__":
    unittest.main()
