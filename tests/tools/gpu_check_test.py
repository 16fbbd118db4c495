"""tools/gpu_check: what its bundle holds, and what a run says of a right and of a wrong picture, and of a step that does not end.

Usage: gpu_check_test.py GLIM"""

import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
import unittest
import unittest.mock
import zipfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
CHECK = os.path.join(ROOT, "tools", "device_check")
sys.path.insert(0, CHECK)
import machine  # noqa: E402
from films import FilmError, digest_of, equal_pixels, mean_ratio, read_layers  # noqa: E402

GLIM = sys.argv.pop()
SLEEPER = """#!/bin/sh
if [ "$1" = devices ]; then
    echo '[{"name": "sleeper", "driver": "none", "kind": "other", "usable": true, "subgroupSize": 1, "memory": 0}]'
else
    sleep 1000.125
fi
"""


def files_in(folder):
    return [os.path.join(root, name) for root, _, names in os.walk(folder) for name in names]


class GpuCheck(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(scratch.cleanup)
        cls.scratch, cls.bundle = scratch.name, os.path.join(scratch.name, "bundle")
        subprocess.run([sys.executable, "-B", CHECK, "bundle", cls.bundle, "--build", os.path.dirname(GLIM)], check=True)
        # The whole check of a software device takes minutes: one picture and two suites stand for all.
        cls.change(cls.bundle, golden=[{"scene": "light_directional", "blocks": True, "samples": 256}],
                   kernelSuites=["DriverPrecisionTest", "CameraTest"])

    @staticmethod
    def change(bundle, **entries):
        path = os.path.join(bundle, "manifest.json")
        with open(path, encoding="utf-8") as file:
            manifest = json.load(file)
        with open(path, "w", encoding="utf-8") as file:
            json.dump({**manifest, **entries}, file)

    def check(self, bundle, *options):
        """The exit code, the results and the table. It runs as on a machine without the sources: by the bundle's own copy."""
        out = tempfile.mkdtemp(dir=self.scratch)
        done = subprocess.run([sys.executable, "-B", os.path.join(bundle, "gpu_check"), "run", "-o", out, *options],
                              stdout=subprocess.PIPE, text=True)
        with open(os.path.join(out, "result.json"), encoding="utf-8") as file:
            results = json.load(file)
        with open(os.path.join(out, "table.md"), encoding="utf-8") as file:
            table = file.read()
        self.assertEqual(done.stdout.strip(), table.strip())
        return done.returncode, results, table

    def copy_of_bundle(self):
        copy = os.path.join(tempfile.mkdtemp(dir=self.scratch), "bundle")
        shutil.copytree(self.bundle, copy)
        return copy

    def test_no_device_is_a_failure(self):
        code, results, _ = self.check(self.bundle, "--device", "no such GPU")
        self.assertEqual((code, list(results["steps"])), (3, ["device"]))
        self.assertIn("has the name that was given", results["steps"]["device"]["state"])

    def test_a_bundle_that_fails_leaves_nothing(self):
        build = tempfile.mkdtemp(dir=self.scratch)
        os.mkdir(os.path.join(build, "tests"))
        for glim, sentence in ((None, "glim: No such file or directory"), (b"no program", "strip: exit code 1: .*")):
            if glim:
                with open(os.path.join(build, "glim"), "wb") as file:
                    file.write(glim)
            folder = os.path.join(self.scratch, "failed")
            done = subprocess.run([sys.executable, "-B", CHECK, "bundle", folder, "--build", build], stderr=subprocess.PIPE, text=True)
            self.assertEqual(done.returncode, 2)
            self.assertRegex(done.stderr, "\\Agpu_check: copying programs and libraries\ngpu_check: .*%s\n\\Z" % sentence)
            self.assertFalse(os.path.exists(folder))

    def test_the_bundle_is_small_and_leaves_out_what_the_machine_has(self):
        self.assertLessEqual(sum(map(os.path.getsize, files_in(self.bundle))), 64 << 20)
        with zipfile.ZipFile(os.path.join(self.bundle, "programs.zip")) as archive:
            names = archive.namelist()
        for name in ("bin/glim", "bin/glim_tests", "lib/libvulkan.so.1", "lib/libEGL.so.1", "lib/libGLdispatch.so.0"):
            self.assertIn(name, names)
        self.assertFalse([name for name in names if name.startswith(("lib/libc.", "lib/libm.", "lib/ld-", "lib/libstdc++"))])
        self.assertTrue([name for name in names if name.startswith("fallback/libstdc++.so.6.0")])

    def test_a_right_picture_is_said_to_agree(self):
        code, results, table = self.check(self.bundle, "--steps", "kernels,golden", "--patience", "5")
        steps = results["steps"]
        self.assertEqual((code, results["wrong"]), (0, []), table)
        self.assertEqual([step["state"] for step in steps.values()], ["done"] * 3, table)
        self.assertEqual(sorted(steps["kernels"]["passed"]), ["CameraTest", "DriverPrecisionTest"], table)
        self.assertIn("sin, cos within", steps["kernels"]["precision"])
        self.assertTrue(steps["golden"]["pictures"]["light_directional"]["agree"])
        self.assertIn("| light_directional | agrees |", table)
        self.assertIn("2 of 2 suites pass", table)

    def test_a_wrong_picture_is_the_exit_code(self):
        bundle = self.copy_of_bundle()
        golden = os.path.join(bundle, "golden")
        shutil.copy(os.path.join(golden, "light_point.exr"), os.path.join(golden, "light_directional.exr"))
        code, results, table = self.check(bundle, "--steps", "golden", "--patience", "5")
        self.assertEqual(code, 1)
        self.assertEqual(results["wrong"], ["light_directional differs from its golden picture by more than noise"])
        self.assertIn("| light_directional | differs |", table)

    def test_other_bits_are_the_exit_code(self):
        bundle = self.copy_of_bundle()
        films = os.path.join(bundle, "films")
        for name in os.listdir(films):
            if name not in ("light_point.exr", "furnace.exr"):
                os.remove(os.path.join(films, name))
        code, results, table = self.check(bundle, "--steps", "bits", "--patience", "5")
        self.assertEqual((code, results["wrong"]), (0, []), table)
        self.assertIn("2 of 2 films have the bundle's bits", table)
        shutil.copy(os.path.join(films, "light_point.exr"), os.path.join(films, "furnace.exr"))
        code, results, table = self.check(bundle, "--steps", "bits", "--patience", "5")
        self.assertEqual((code, results["wrong"]), (1, ["furnace has other bits than the bundle's film"]), table)

    def test_what_does_not_end_is_ended_and_the_next_step_runs(self):
        bundle = self.copy_of_bundle()
        self.change(bundle, kernelSuites=["Test%d" % i for i in range(50)])
        with zipfile.ZipFile(os.path.join(bundle, "programs.zip"), "w") as archive:
            archive.writestr("bin/glim", SLEEPER)
            archive.writestr("bin/glim_tests", SLEEPER)
            archive.writestr("fallback/libstdc++.so.6.0.1", "older than any")
        begin = time.monotonic()
        code, results, table = self.check(bundle, "--steps", "kernels,golden", "--patience", "0.08")
        self.assertLess(time.monotonic() - begin, 60.0)
        self.assertEqual((code, results["wrong"]), (0, []))  # nothing was drawn, so nothing is wrong
        states = {name: step["state"] for name, step in results["steps"].items()}
        # A program gets a third of its step's time: one leaves time for others, fifty do not.
        self.assertEqual(states, {"device": "done", "kernels": "out of time", "golden": "done"})
        self.assertRegex(table, r"kernel suites \| [45][\d.]* \| out of time \| 0 of 50 suites pass")
        self.assertRegex(table, r"light_directional \| ended after \d s \|")
        running = subprocess.run(["ps", "-eo", "args"], stdout=subprocess.PIPE, text=True, check=True).stdout
        self.assertNotIn("sleep 1000.125", running)

    def test_a_machine_without_a_device_ends_at_once(self):
        empty = os.path.join(self.scratch, "no_driver.json")
        with open(empty, "w", encoding="utf-8") as file:
            json.dump({"file_format_version": "1.0.0", "ICD": {"library_path": "/nowhere/lib.so", "api_version": "1.2.0"}}, file)
        code, results, table = self.check(self.bundle, "--driver", empty)
        self.assertEqual(code, 3)
        self.assertEqual(list(results["steps"]), ["device"])
        self.assertIn("failed: CheckError: glim devices: exit code 3", table)

    def test_nvidia_is_found_without_a_description(self):
        folder = tempfile.mkdtemp(dir=self.scratch)
        library = os.path.join(folder, "libEGL_nvidia.so.0")
        with open(library, "w", encoding="utf-8"):
            pass
        with unittest.mock.patch.dict(os.environ, {"LD_LIBRARY_PATH": folder, "VK_DRIVER_FILES": "", "VK_ICD_FILENAMES": ""}), \
                unittest.mock.patch("machine.find_icds", lambda: ["/etc/vulkan/icd.d/lvp_icd.json"]):
            drivers, how = machine.choose_drivers(None, folder)
            self.assertEqual(how, "written, for " + library)
            written, others = drivers.split(":")
            self.assertEqual(others, "/etc/vulkan/icd.d/lvp_icd.json")
            with open(written, encoding="utf-8") as file:
                self.assertEqual(json.load(file)["ICD"]["library_path"], library)
            os.remove(library)
            self.assertEqual(machine.choose_drivers(None, folder)[0], None)
            self.assertEqual(machine.choose_drivers("a.json", folder), (os.path.abspath("a.json"), "given"))

    def test_the_newer_library_is_taken(self):
        folder = tempfile.mkdtemp(dir=self.scratch)
        with open(os.path.join(folder, "libstdc++.so.6.0.33"), "w", encoding="utf-8"):
            pass
        os.symlink("libstdc++.so.6.0.33", os.path.join(folder, "libstdc++.so.6"))
        with unittest.mock.patch.dict(os.environ, {"LD_LIBRARY_PATH": folder}):
            self.assertTrue(machine.machine_has("libstdc++.so.6", "fallback/libstdc++.so.6.0.30"))
            self.assertTrue(machine.machine_has("libstdc++.so.6", "fallback/libstdc++.so.6.0.33"))
            self.assertFalse(machine.machine_has("libstdc++.so.6", "fallback/libstdc++.so.6.0.100"))
        self.assertFalse(machine.machine_has("libnowhere.so.6", "fallback/libnowhere.so.6.0.1"))

    def test_films_are_compared_bit_by_bit(self):
        film = os.path.join(self.bundle, "films", "cornell.exr")
        layers = read_layers(film)
        self.assertEqual(set(layers["count.X"]), {64, 0})  # 64 samples, as uint32
        other = {**layers, "R": layers["R"][:400] + bytes([layers["R"][400] ^ 1]) + layers["R"][401:]}
        self.assertEqual(equal_pixels(layers, layers, ("R", "G")), (48 * 48, 48 * 48))
        self.assertEqual(equal_pixels(layers, other, ("R", "G")), (48 * 48 - 1, 48 * 48))
        self.assertNotEqual(digest_of(layers), digest_of(other))
        self.assertAlmostEqual(mean_ratio(layers, other), 1.0, places=3)
        with open(film, "rb") as file:
            content = file.read()
        cut = os.path.join(self.scratch, "cut.exr")
        with open(cut, "wb") as file:
            file.write(content[:len(content) // 2])
        self.assertRaises(FilmError, read_layers, cut)


if __name__ == "__main__":
    unittest.main()
