"""What a scene does not need is compiled away: looks at kernels with features switched off, after SPIR-V's own optimizer.

Usage: lean_kernels_test.py FOLDER_OF_SPIRV
"""
import functools
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SHARED = Path(__file__).resolve().parents[2] / "shaders/shared"
BITS = {name: 1 << int(bit) for name, bit in re.findall(r"FEATURE\((\w+), (\d+), ", (SHARED / "features.h").read_text())}
# Triangle lights stay on: without any light nothing is left to see.
FEATURES = [name for name in BITS if name != "TriangleLights"]
# The kernels that have code for each feature, once the others are off.
USERS = {
    "Spheres": ["trace_closest", "trace_shadow", "shade_surface"],
    "Slivers": ["trace_closest", "trace_shadow"],
    "Smooth": ["shade_surface"],
    "Mirror": ["shade_surface"],
    "Dielectric": ["shade_surface"],
    "SphereLights": ["shade_surface"],
    "PunctualLights": ["shade_surface"],
    "Environment": ["shade_surface"],
    "Principled": ["shade_surface"],
    "Textures": ["shade_surface"],
    "NormalMaps": ["shade_surface"],
    "VertexColors": ["shade_surface"],
    "PointColors": ["shade_surface"],
    "Lines": ["trace_closest", "trace_shadow", "shade_surface"],
    "Alpha": ["trace_closest", "trace_shadow", "shade_surface"],
    "EnvironmentMap": ["shade_surface"],
    "TextureTransforms": ["shade_surface"],
    "WideTextures": ["shade_surface"],
    "Clearcoat": ["shade_surface"],
    "Sheen": ["shade_surface"],
    "Anisotropy": ["shade_surface"],
    "Iridescence": ["shade_surface"],
    "Transmission": ["shade_surface"],
    "DiffuseTransmission": ["shade_surface"],
    "Media": ["trace_closest", "shade_surface"],
    "Dispersion": ["shade_surface"],
    "Scattering": ["trace_closest", "trace_shadow", "shade_surface"],
    "ThinWalls": ["trace_closest", "trace_shadow"],
    "Unlit": ["trace_closest", "trace_shadow", "shade_surface"],
    "Glossiness": ["shade_surface"],
    "Caustics": ["shade_surface"],
    "RectangleLights": ["shade_surface"],
    "LightTree": ["shade_surface"],
    "LightClusters": ["shade_surface"],
    "LightGroups": ["trace_shadow", "shade_surface"],
    "RoughTransmission": ["shade_surface"],
    "BrightEnvironment": ["shade_surface"],
    "Instances": ["trace_closest", "trace_shadow", "shade_surface"],
    "Motion": ["trace_closest", "trace_shadow", "shade_surface"],
    "LightsInMedia": [],  # trace_light_paths
    "LargeTriangles": ["trace_closest", "trace_shadow", "shade_surface"],
    "SingleSided": ["trace_closest", "trace_shadow"],
    "Catcher": ["trace_closest", "trace_shadow", "shade_surface"],
}
# What a feature needs before it has any code.
NEEDS = {
    "LightClusters": ["LightTree"],
    "RoughTransmission": ["Principled", "Transmission"],
    "BrightEnvironment": ["Environment", "EnvironmentMap", "Caustics"],
    "Textures": ["Principled"],
    "NormalMaps": ["Principled", "Textures"],
    "VertexColors": ["Principled"],
    "PointColors": ["Principled", "Spheres"],
    "Motion": ["Instances"],
    "Lines": ["Spheres"],
    "EnvironmentMap": ["Environment"],
    "TextureTransforms": ["Principled", "Textures"],
    "WideTextures": ["Principled", "Textures"],
    "Clearcoat": ["Principled"],
    "Sheen": ["Principled"],
    "Anisotropy": ["Principled"],
    "Iridescence": ["Principled"],
    "Transmission": ["Principled"],
    "DiffuseTransmission": ["Principled"],
    "Media": ["Principled"],
    "Dispersion": ["Principled", "Media"],
    "Scattering": ["Principled", "Media"],
    "ThinWalls": ["Principled", "Alpha"],
    "Unlit": ["Alpha"],
    "Glossiness": ["Principled", "Textures"],
}
KERNELS = USERS["Spheres"]
# As in host/gpu/specialize.cpp.
REMOVE_UNREACHABLE = ["--ccp", "--eliminate-dead-branches", "--eliminate-dead-functions"]
# What drivers do next. The first is enough for most features; the second inlines every call, which takes thirty times as long.
MORE = ["--eliminate-dead-code-aggressive", "-O"]


def spec_id(name):
    return re.search(rf"kSpec{name} = (\d+)u", (SHARED / "bindings.h").read_text()).group(1)


class LeanKernels(unittest.TestCase):
    folder = Path()

    def test_every_feature_is_here(self):
        self.assertEqual(set(USERS), set(FEATURES))

    @functools.cache
    def size(self, kernel, features, more):
        """Bytes of the optimized kernel with these features and nothing that a render asks for. `more`: one of MORE."""
        mask = sum(BITS[name] for name in [*features, "TriangleLights"])
        off = " ".join(f"{spec_id(name)}:false" for name in ["Notes"])
        defaults = f"{spec_id('Features')}:{mask & 0xffffffff} {spec_id('UpperFeatures')}:{mask >> 32} {off}"
        with tempfile.TemporaryDirectory() as scratch:
            out = Path(scratch) / "optimized.spv"
            subprocess.run(
                ["spirv-opt", "--target-env=vulkan1.2", "--scalar-block-layout", f"--set-spec-const-default-value={defaults}",
                 "--strip-debug", "--freeze-spec-const", "--fold-spec-const-op-composite", *REMOVE_UNREACHABLE, more,
                 str(self.folder / f"{kernel}.spv"), "-o", str(out)], check=True)
            return out.stat().st_size

    def test_a_diffuse_scene_has_smaller_kernels(self):
        for kernel in KERNELS:
            full, lean = self.size(kernel, tuple(FEATURES), "-O"), self.size(kernel, (), "-O")
            print(f"{kernel}: {lean} bytes for triangles and their light, {full} for any scene")
            self.assertLess(lean, 0.9 * full, kernel)

    def test_a_feature_costs_only_the_kernels_that_use_it(self):
        for kernel in KERNELS:
            for feature, users in USERS.items():
                needs = tuple(NEEDS.get(feature, ()))
                sizes = []
                for more in MORE:
                    sizes = [self.size(kernel, features, more) for features in (needs, (*needs, feature))]
                    cost = sizes[1] - sizes[0]
                    if cost > 100 if kernel in users else cost == 0:
                        break
                else:
                    self.fail(f"{feature} in {kernel}: {sizes[0]} bytes without it, {sizes[1]} with it")


if __name__ == "__main__":
    LeanKernels.folder = Path(sys.argv.pop())
    unittest.main()
