#!/usr/bin/env python3
"""tools/study without rendering: estimates on data whose answer is known, the page from made-up numbers."""

import contextlib
import io
import json
import math
import os
import random
import shutil
import sys
import tempfile
import unittest
from unittest import mock

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "tools"))

from study_page import estimates, markup, profiles  # noqa: E402
from study_page.arguments import parse_arguments  # noqa: E402
from study_page.errors import StudyError  # noqa: E402
from study_page.glim import trace_seconds  # noqa: E402
from study_page.lab import Lab, cost_ratio, time_ratio  # noqa: E402
from study_page.page import build_page  # noqa: E402
from study_page.scenes import Scenes  # noqa: E402
from study_page.sections import adaptive, convergence, roulette  # noqa: E402
from scene_makers.gltf_document import cross, subtract  # noqa: E402
from scene_makers.study_scenes import globe, resolution  # noqa: E402

from check_page import check_numbers, check_page  # noqa: E402
from fake_study import fake_run, fake_study  # noqa: E402


class EstimatesTest(unittest.TestCase):
    def test_student_matches_tables(self):
        for degrees, point in ((1, 12.706), (2, 4.303), (10, 2.228), (30, 2.042), (31, 2.0395), (60, 2.0003), (120, 1.9799)):
            self.assertAlmostEqual(estimates.student(degrees), point, delta=6e-4)

    def test_mean_interval_on_known_data(self):
        found = estimates.mean_interval([1, 2, 3, 4, 5])  # s = sqrt(2.5), t = 2.7764
        self.assertAlmostEqual(found["mean"], 3)
        self.assertAlmostEqual(found["high"] - 3, 2.7764 * math.sqrt(2.5 / 5), places=4)
        self.assertAlmostEqual(3 - found["low"], found["high"] - 3)
        self.assertIsNone(estimates.mean_interval([7])["low"])

    def coverage(self, make, truth, trials=2000):
        inside = 0
        for _ in range(trials):
            found = make()
            inside += found["low"] <= truth <= found["high"]
        return inside / trials

    def test_intervals_cover_the_truth(self):
        source = random.Random(5)  # 2,000 trials: standard error .5 %
        mean = self.coverage(lambda: estimates.mean_interval([source.gauss(2, 3) for _ in range(4)]), 2)
        self.assertAlmostEqual(mean, 0.95, delta=0.02)
        positive = self.coverage(lambda: estimates.positive_interval([source.gammavariate(20, 0.1) for _ in range(4)]), 2)
        self.assertAlmostEqual(positive, 0.95, delta=0.02)

        def pair():
            shared = [source.gauss(0, 0.1) for _ in range(6)]
            return estimates.ratio_of_means([3 + s + source.gauss(0, 0.1) for s in shared],
                                            [2 + s + source.gauss(0, 0.1) for s in shared])
        self.assertAlmostEqual(self.coverage(pair, 1.5), 0.95, delta=0.02)

    def test_slope_of_a_power_law(self):
        counts, source = [1, 2, 4, 8, 16, 32, 64], random.Random(2)
        exact = estimates.fit_slope(counts, [[3 * n ** -1.5 for n in counts]] * 3)
        self.assertAlmostEqual(exact["mean"], -1.5)
        noisy = estimates.fit_slope(counts, [[0.2 / n * math.exp(source.gauss(0, 0.1)) for n in counts] for _ in range(8)])
        self.assertLess(noisy["low"], -1)
        self.assertGreater(noisy["high"], -1)
        self.assertLess(noisy["high"] - noisy["low"], 0.1)

    def test_logarithm_is_found(self):
        counts = [100, 1000, 10000, 100000]
        found = estimates.fit_logarithm(counts, [5 + 2 * math.log2(n) for n in counts])
        self.assertAlmostEqual(found["a"], 5)
        self.assertAlmostEqual(found["b"], 2)
        self.assertAlmostEqual(found["r2"], 1)
        self.assertLess(estimates.fit_logarithm(counts, counts)["r2"], 0.8)


    def test_ratios_pair_seeds(self):
        slow = [{"seconds": 3.0 * s, "samples": 10, "relmse": 0.2 * s} for s in (1, 2, 4)]
        fast = [{"seconds": 1.0 * s, "samples": 10, "relmse": 0.1 * s} for s in (1, 2, 4)]
        for found, ratio in ((time_ratio(slow, fast), 3), (cost_ratio(slow, fast), 6)):
            for key in ("mean", "low", "high"):  # what varies alike from seed to seed cancels
                self.assertAlmostEqual(found[key], ratio)

    def test_no_ratio_of_what_noise_hides(self):
        lost = estimates.ratio_of_means([1, 2, 3], [0.1, -0.2, 0.05])
        self.assertIsNone(lost["mean"])
        self.assertIn("noise", markup.bracket(lost))
        self.assertIn("one run", markup.bracket(estimates.ratio_of_means([1], [2])))

    def test_spread_of_a_ratio_goes_to_the_extremes(self):
        found = estimates.spread_of_ratio(estimates.spread([10, 12, 20]), estimates.spread([2, 4, 5]))
        self.assertEqual((found["median"], found["least"], found["most"]), (3, 2, 10))

    def test_complement_turns_the_interval(self):
        found = estimates.complement(estimates.interval(0.7, 0.6, 0.9, 4))
        self.assertAlmostEqual(found["mean"], 0.3)
        self.assertAlmostEqual(found["low"], 0.1)
        self.assertAlmostEqual(found["high"], 0.4)
        self.assertIsNone(estimates.complement(estimates.interval(0.7, None, None, 1))["low"])

    def test_slope_leaves_out_what_is_below_the_noise(self):
        runs = {n: [{"relmse": 1 / n, "referenceNoise": 0.005} for _ in range(2)] for n in (1, 4, 16, 64)}
        runs[256] = [{"relmse": 0.0001, "referenceNoise": 0.005}, {"relmse": 0.004, "referenceNoise": 0.005}]
        self.assertAlmostEqual(convergence.slope_of(list(runs), runs)["mean"], -1)
        self.assertIsNone(convergence.slope_of([256], runs)["mean"])
        slopes = convergence.slopes_of("sobol", runs)
        self.assertAlmostEqual(slopes["to 32"]["mean"], -1)
        self.assertIsNone(slopes["from 32 on"]["mean"])  # 64 and 256, of which the noise leaves one


class BiasTest(unittest.TestCase):
    def runs(self, ratios):
        return [{**fake_run(16, seed, False, False), "meanRatio": ratio} for seed, ratio in enumerate(ratios)]

    def test_pairs_take_out_what_seeds_share(self):
        biased, uniform = self.runs([0.98, 1.08, 1.02]), self.runs([1.0, 1.1, 1.03])
        found = adaptive.summarize_runs(biased, uniform, 64)["bias"]
        self.assertAlmostEqual(found["mean"], -0.05 / 3)
        reach = 4.3027 * math.sqrt((2 * (0.02 - 0.05 / 3) ** 2 + (0.01 - 0.05 / 3) ** 2) / 2 / 3)
        self.assertAlmostEqual(found["high"] - found["mean"], reach, places=6)
        self.assertAlmostEqual(roulette.summarize_mode(biased, uniform, uniform)["meanLessNone"]["high"], found["high"])


class GlimTest(unittest.TestCase):
    def test_device_without_timestamps(self):
        stats = {"kernels": {"trace_closest": {"seconds": 2.5}}, "device": {"name": "a device"}}
        self.assertEqual(trace_seconds(stats), 2.5)
        self.assertEqual(trace_seconds({**stats, "kernels": {"course_trace_closest": {"seconds": 1.5}}}), 1.5)
        with self.assertRaisesRegex(StudyError, "a device .* timestamps"):
            trace_seconds({**stats, "kernels": {}})


class PageTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.study, cls.lab = fake_study(cls.folder.name)
        cls.text = build_page(json.loads(json.dumps(cls.study)), cls.folder.name)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_page_and_numbers_are_sound(self):
        self.assertEqual(check_page(self.text), [])
        self.assertEqual(check_numbers(self.study), [])

    def test_every_experiment_is_rendered(self):
        asked = {(scene, " ".join(map(str, options))) for scene, options in self.lab.asked}
        for scene, wanted in (
                *(("spheres", "--view %s" % view) for view in ("normal", "depth", "bvh-steps")), ("gems", "--view normal"),
                *((mesh, "--split %s" % rule) for mesh in ("cow", "beast") for rule in ("sah", "mean", "median")),
                ("cow", "--accelerator none"), ("beast", "--accelerator none"), ("blob1000000", "--split sah"),
                *(("spheres", "--direct %s --light-samples %d --spp 1 " % (method, n))
                  for method in ("lights", "hemisphere") for n in (1, 4, 16, 64)),
                *(("spheres", "--direct hemisphere --light-samples 1 --spp %d " % n) for n in (16, 64)),
                *(("spheres", "--bounces %d --spp" % n) for n in (0, 1, 2, 3, 4, 100)),
                ("spheres", "--paths direct"), ("spheres", "--paths indirect"),
                *((scene, "--roulette %s" % mode) for scene in ("spheres", "furnace")
                  for mode in ("none", "throughput", "fixed:0.7")),
                *(("spheres", "--sampler %s --spp %d" % (s, n)) for s in ("sobol", "independent") for n in profiles.QUICK.spp),
                *((scene, "--adaptive course --tolerance") for scene in ("bunny", "spheres")),
                ("spheres", "--adaptive course:literal")):
            self.assertTrue(any(s == scene and wanted in options + " " for s, options in asked), (scene, wanted))

    def test_every_experiment_appears(self):
        for wanted in ("cow &lt;&amp;&gt;", "hemisphere, 64 light rays, 1 spp", "lights, 1 light ray, 64 spp", "indirect only",
                       "100 bounces", ">1 bounce<", "fixed:0.7", "throughput", "64 spp", "course:literal", "equal time",
                       "samples taken",
                       "22 s to 0.05 s: about 440", "bias: mean less uniform", ", no interval", "335 s to 0.05 s: about 6,700",
                       "log2 n", "after subtracting"):
            self.assertTrue(wanted in self.text, wanted)

    def test_faults_are_noticed(self):
        for before, after in (("<h2>", "<h3>"), ('alt="', 'title="'), ("data:image/png", "https://x.org/"),
                              (" Mrays/s, relMSE", ""),
                              ('id="views"', 'id="adaptive"'), ("<svg", "<em"), ("<style>", "<style>a{background:url(x)}"),
                              ("<p>", "<p>nan "), ("</tbody></table>", "")):
            self.assertTrue(before in self.text, before)
            self.assertNotEqual(check_page(self.text.replace(before, after, 1)), [], before)
        self.assertNotEqual(check_numbers({**self.study, "sections": {"x": float("nan")}}), [])
        self.assertNotEqual(check_numbers({**self.study, "markdown": "| a |\n" * 30}), [])

    def test_headline_table_is_what_the_page_shows(self):
        for row in self.study["headlines"]:
            self.assertTrue(markup.escape(row[0]) in self.text, row[0])
            self.assertIn(row[0], self.study["markdown"])

    def test_constant_of_the_kernels(self):
        with open(os.path.join(ROOT, "shaders", "shared", "limits.h"), encoding="utf-8") as file:
            text = file.read()
        self.assertIn("kConstantSamples = %du;" % adaptive.CONSTANT_SAMPLES, text)
        self.assertIn("kFirstBlockSamples = %du;" % convergence.BLOCK, text)


class NumbersTest(unittest.TestCase):
    def test_forms(self):
        for value, text in ((0.012345, "0.0123"), (64618, "64,600"), (1.5e-7, "1.50e-07"), (0, "0"), (None, "unknown"),
                            (440.0, "440")):
            self.assertEqual(markup.number(value), text)
        self.assertEqual(markup.number(64618, 5), "64,618")


class LabTest(unittest.TestCase):
    def lab(self, budget):
        profile = mock.Mock(budgets={"views": budget})
        lab = Lab(None, None, profile, tempfile.mkdtemp(), None, out=io.StringIO())
        self.addCleanup(shutil.rmtree, lab.folder)
        lab.begin("views")
        return lab

    def test_seeds_keep_to_the_budget(self):
        self.assertEqual(len(list(self.lab(1000).seeds((2, 5), until=1.0))), 5)
        self.assertEqual(len(list(self.lab(0).seeds((2, 5), until=1.0))), 2)


    def test_references_are_made_once(self):
        lab = self.lab(0)
        lab.glim, lab.scenes, lab.scratch = mock.Mock(), mock.Mock(), lab.folder
        self.assertIs(lab.reference("spheres", (4, 3), 64), lab.reference("spheres", (4, 3), 64))
        lab.glim.render.assert_called_once()


class ScenesTest(unittest.TestCase):
    def test_globes_are_closed_and_of_the_size_asked(self):
        for asked in (100, 316, 5856, 28576):
            columns, rows = resolution(asked)
            self.assertLess(abs(2 * columns * rows - asked), 0.02 * asked)
        points, indices = globe(316)
        self.assertEqual(len(indices), 3 * 2 * resolution(316)[0] * resolution(316)[1])
        edges = {(indices[i + k], indices[i + (k + 1) % 3]) for i in range(0, len(indices), 3) for k in range(3)}
        self.assertEqual(len(edges), len(indices))
        self.assertTrue(all((b, a) in edges for a, b in edges))
        volume = 0.0
        for i in range(0, len(indices), 3):
            a, b, c = (points[k] for k in indices[i:i + 3])
            volume += sum(x * y for x, y in zip(a, cross(subtract(b, a), subtract(c, a)))) / 6
        self.assertGreater(volume, 0.5)

    def test_ours_without_the_course(self):
        with tempfile.TemporaryDirectory() as folder:
            scenes = Scenes(os.path.join(folder, "nothing"), os.path.join(folder, "made"))
            self.assertFalse(scenes.is_course)
            self.assertTrue(all(os.path.isfile(path) for path in scenes.paths.values()))
            with open(os.path.join(folder, "cow.glb"), "wb"):
                pass
            with self.assertRaisesRegex(StudyError, "missing: .*CBbunny.glb"):
                Scenes(folder, os.path.join(folder, "made"))


class ArgumentsTest(unittest.TestCase):
    def test_bad_arguments_get_one_sentence(self):
        for arguments in (["--scenes", "/nonexistent"], ["--out", __file__], ["--quik"], ["scene"], ["--out"],
                          ["--serve", "--quick"], ["--serve", "--out", "x"], ["--port", "8000"], ["--serve", "--port", "80"],
                          ["--serve", "--port", "65536"], ["--serve", "--port", "x"]):
            errors = io.StringIO()
            with contextlib.redirect_stderr(errors), self.assertRaises(SystemExit) as stopped:
                parse_arguments(arguments)
            self.assertEqual(stopped.exception.code, 2)
            self.assertEqual(errors.getvalue().count("\n"), 1)

    def test_choices(self):
        self.assertIs(parse_arguments(["--quick"]).profile, profiles.QUICK)
        self.assertIs(parse_arguments([]).profile, profiles.FULL)
        self.assertEqual(parse_arguments([]).out, "study")


if __name__ == "__main__":
    unittest.main()
