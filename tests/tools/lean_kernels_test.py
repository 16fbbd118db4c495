"""What a scene does not need is compiled away: kernels with features switched off, after SPIR-V's own optimizer.

Usage: lean_kernels_test.py FOLDER_OF_SPIRV
"""
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

BINDINGS = Path(__file__).resolve().parents[2] / "shaders/shared/bindings.h"
# Of a scene: what features.glsl has on unless told otherwise. Triangle lights stay on: without any light nothing is left to see.
FEATURES = ["Spheres", "Slivers", "Smooth", "Mirrors", "Glasses", "SphereLights", "PunctualLights", "Environment"]
# Which kernels have code of its own for each, once the others are off.
USERS = {
    "Spheres": ["trace_closest", "trace_shadow", "bounce", "sample_lights"],
    "Slivers": ["trace_closest", "trace_shadow"],
    "Smooth": ["bounce", "sample_lights"],
    "Mirrors": ["bounce"],
    "Glasses": ["bounce"],
    "SphereLights": ["sample_lights"],
    "PunctualLights": ["sample_lights"],
    "Environment": ["sample_lights"],
}
KERNELS = USERS["Spheres"]


def spec_id(name):
    return re.search(rf"kSpec{name} = (\d+)u", BINDINGS.read_text()).group(1)


class LeanKernels(unittest.TestCase):
    folder = Path()

    def size(self, kernel, features):
        """Bytes of the optimized kernel with these features and nothing that a render asks for."""
        values = {name: name in features for name in FEATURES}
        values |= {name: False for name in ["BruteForce", "MollerTrumbore", "Notes"]}
        defaults = " ".join(f"{spec_id(name)}:{str(on).lower()}" for name, on in values.items())
        with tempfile.TemporaryDirectory() as scratch:
            out = Path(scratch) / "optimized.spv"
            subprocess.run(
                ["spirv-opt", "--target-env=vulkan1.2", "--scalar-block-layout", f"--set-spec-const-default-value={defaults}",
                 "--freeze-spec-const", "-O", str(self.folder / f"{kernel}.spv"), "-o", str(out)], check=True)
            return out.stat().st_size

    def test_a_diffuse_scene_has_smaller_kernels(self):
        for kernel in KERNELS:
            full, lean = self.size(kernel, FEATURES), self.size(kernel, [])
            print(f"{kernel}: {lean} bytes for triangles and their light, {full} for any scene")
            self.assertLess(lean, 0.9 * full, kernel)

    def test_a_feature_costs_only_the_kernels_that_use_it(self):
        for kernel in KERNELS:
            lean = self.size(kernel, [])
            for feature, users in USERS.items():
                with_it = self.size(kernel, [feature])
                if kernel in users:
                    self.assertGreater(with_it, lean + 200, f"{feature} in {kernel}")
                else:
                    self.assertEqual(with_it, lean, f"{feature} in {kernel}")


if __name__ == "__main__":
    LeanKernels.folder = Path(sys.argv.pop())
    unittest.main()
