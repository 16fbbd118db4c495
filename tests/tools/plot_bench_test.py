"""tools/plot_bench.py on made-up benches: what its figures say, and what it refuses."""

import json
import os
import subprocess
import sys
import tempfile
import unittest

PROGRAM = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tools", "plot_bench.py")


def interval(value):
    return {"value": value, "low": 0.9 * value, "high": 1.1 * value}


def fake_bench(scene="scenes/room.gltf", holds=True):
    points = [{"samples": n, "summary": {"seconds": 0.01 * n, "kernelSeconds": 0.009 * n, "mse": interval(0.5 / n),
                                         "relMse": interval(1.0 / n)}} for n in (1, 2, 4, 8, 16, 32, 64)]
    points[-1]["summary"]["relMse"] = {"value": -1e-3, "low": None, "high": None}  # below the reference's noise
    return {"scene": scene, "size": [8, 6], "device": "a device", "seeds": list(range(16)), "points": points,
            "reference": {"mse": 1e-4, "relMse": 2e-4},
            "summary": {"slope": interval(-1.0), "slopeTest": {"holds": holds}, "efficiency": interval(123.0)}}


class PlotBenchTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def write(self, name, benches):
        with open(os.path.join(self.folder.name, name), "w", encoding="utf-8") as file:
            json.dump({"glim:bench": 2, "scenes": benches}, file)

    def run_program(self, *arguments):
        return subprocess.run([sys.executable, PROGRAM, *arguments], cwd=self.folder.name, text=True, capture_output=True, check=False)

    def test_benches_of_one_scene_share_a_figure(self):
        self.write("good.json", [fake_bench()])
        self.write("bad.json", [fake_bench(holds=False)])
        run = self.run_program("good.json", "bad.json", "-o", "out.svg")
        self.assertEqual((run.returncode, run.stdout, run.stderr), (0, "out.svg\n", ""))
        with open(os.path.join(self.folder.name, "out.svg"), encoding="utf-8") as file:
            text = file.read()
        for part in ("room, 8x6, on a device", "over 16 seeds", "good: slope -1 [-0.9, -1.1], efficiency 123 [111, 135] /s",
                     "bad: slope -1 [-0.9, -1.1], slope test fails", "relMSE", "RMSE"):
            self.assertIn(part, text)

    def test_scenes_have_figures_of_their_own(self):
        self.write("two.json", [fake_bench(), fake_bench("scenes/hall.gltf")])
        run = self.run_program("two.json", "-o", "out.png")
        self.assertEqual(run.stdout, "out.room-8x6.png\nout.hall-8x6.png\n")
        self.assertEqual(sorted(os.listdir(self.folder.name)), ["out.hall-8x6.png", "out.room-8x6.png", "two.json"])

    def test_what_cannot_be_drawn_is_refused(self):
        self.write("good.json", [fake_bench()])
        with open(os.path.join(self.folder.name, "other.json"), "w", encoding="utf-8") as file:
            file.write("[]")
        for arguments, code, part in ((["none.json"], 1, "none.json: No such file"), (["other.json"], 1, "other.json: expected a JSON file"),
                                      (["good.json", "-o", "x.gif"], 2, "--output x.gif: expected a name"),
                                      (["good.json", "-o", "none/x.png"], 1, "none/x.png: No such file")):
            run = self.run_program(*arguments)
            self.assertEqual(run.returncode, code, run.stderr)
            self.assertIn(part, run.stderr)


if __name__ == "__main__":
    unittest.main()
