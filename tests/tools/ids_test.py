#!/usr/bin/env python3
"""glim render --ids, read by others: OpenEXR, a decoder of Cryptomatte and a hash from PyPI. Where these cannot be had, ctest lists this test
as skipped (exit code 77)."""

import json
import os
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.realpath(__file__))))
sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(ROOT, "tools"))
from conversion.environment import Environment  # noqa: E402
from conversion.errors import ConversionError  # noqa: E402

ENVIRONMENT = Environment("ids_test", ["cryptomatte-api==1.0.0", "OpenEXR==3.5.3", "mmh3==5.3.1", "numpy"])
GLIM = sys.argv[1]
NOTHING = 0xffffffff
LAYERS = {"CryptoObject": ("node.X", "nodes"), "CryptoAsset": ("mesh.X", "meshes"), "CryptoMaterial": ("material.X", "materials")}


def say(text):
    print(text, file=sys.stderr, flush=True)


def add_names(scene):
    """Names that a careless writer of JSON would spoil, two nodes of one name, and two materials that neither glim nor the file names."""
    names = ['quote " \\ / end', "gr\u00fcn \u82b1", "tab\tnew\nline", "same", "same"]
    for node, name in zip([node for node in scene["nodes"] if "mesh" in node], names):
        node["name"] = name
    del scene["materials"][0]["name"]
    del scene["meshes"][0]["primitives"][0]["material"]
    return scene


class IdsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        with open(os.path.join(ROOT, "scenes", "cornell_spheres.gltf")) as file:
            cls.scene = add_names(json.load(file))
        path = os.path.join(cls.folder.name, "ids.exr")
        scene = os.path.join(cls.folder.name, "scene.gltf")
        with open(scene, "w") as file:
            json.dump(cls.scene, file)
        # Seen from farther away, so that there is nothing beside the box.
        subprocess.run([GLIM, "render", scene, "-o", os.path.join(cls.folder.name, "x.exr"), "--ids", path, "--size", "64x48", "--spp", "32",
                        "--look-from", "0.3,1,4.4", "--look-at", "0,1,0", "--bounces", "0"], check=True, stdout=subprocess.DEVNULL)
        cls.mattes = {matte.metadata().name(): matte for matte in cryptomatte_api.Cryptomatte.load(path)}
        with OpenEXR.File(path, separate_channels=True) as file:
            cls.header = dict(file.header())
            cls.channels = {name: channel.pixels.copy() for name, channel in file.channels().items()}
        with OpenEXR.File(os.path.join(cls.folder.name, "x.exr"), separate_channels=True) as file:
            cls.alpha = file.channels()["A"].pixels.copy()

    def manifest(self, layer):
        key = "cryptomatte/%08x" % mmh3.hash(layer, 0, signed=False)
        return json.loads(self.header[key[:-1] + "/manifest"])

    def name(self, layer, index):
        collection = LAYERS[layer][1]
        if index == NOTHING:
            return {"CryptoAsset": "mesh.sphere", "CryptoMaterial": "material.default"}[layer]
        return self.scene[collection][index].get("name", "%s.%d" % (LAYERS[layer][0][:-2], index))

    def test_the_file_is_as_the_convention_asks(self):
        for layer in LAYERS:
            key = "cryptomatte/" + ("%08x" % mmh3.hash(layer, 0, signed=False))[:7]
            self.assertEqual([self.header[key + "/" + name] for name in ("name", "hash", "conversion")],
                             [layer, "MurmurHash3_32", "uint32_to_float32"])
            matte = self.mattes[layer]
            self.assertEqual((matte.metadata().key(), matte.num_levels(), matte.width(), matte.height()), (key[-7:], 6, 64, 48))
            for rank in range(3):
                for letter in "RGBA":
                    self.assertEqual(self.channels["%s%02d.%s" % (layer, rank, letter)].dtype, numpy.float32)
        for name, _ in LAYERS.values():
            self.assertEqual(self.channels[name].dtype, numpy.uint32)

    def test_names_give_the_ids_that_the_picture_has(self):
        for layer in LAYERS:
            manifest = self.manifest(layer)
            ids = [self.channels["%s%02d.%s" % (layer, rank, letter)] for rank in range(3) for letter in "RB"]
            found = set(numpy.unique(numpy.array(ids)).view(numpy.uint32).tolist()) - {0}
            self.assertTrue(found)
            expected = {}
            for name, text in manifest.items():
                bits = mmh3.hash(name.encode(), 0, signed=False)
                exponent = min(max(bits >> 23 & 255, 1), 254)
                expected[bits & ~(255 << 23) | exponent << 23] = name
                self.assertEqual(int(text, 16), bits & ~(255 << 23) | exponent << 23, name)
            self.assertEqual(found, set(expected), "all of the scene is in sight, and nothing else")

    def test_manifests_list_what_the_file_draws(self):
        drawn = [i for i, node in enumerate(self.scene["nodes"]) if "mesh" in node or "sphere" in node.get("extras", {})]
        self.assertEqual(set(self.manifest("CryptoObject")), {self.name("CryptoObject", i) for i in drawn})
        self.assertIn('quote " \\ / end', self.manifest("CryptoObject"))
        self.assertIn("material.default", self.manifest("CryptoMaterial"))

    def test_coverage_is_what_the_picture_is_covered_by(self):
        self.assertTrue((self.alpha == 0).any() and (self.alpha == 1).any() and ((self.alpha > 0) & (self.alpha < 1)).any())
        for layer in LAYERS:
            masks = self.mattes[layer].masks()
            self.assertEqual(set(masks), set(self.manifest(layer)))
            # 32 samples of a pixel: shares and their sums are exact in float32. No pixel shows more than six names.
            numpy.testing.assert_array_equal(sum(masks.values()).reshape(self.alpha.shape), self.alpha)

    def test_mattes_are_of_the_same_pixels_as_indices(self):
        for layer, (channel, collection) in LAYERS.items():
            indices = self.channels[channel]
            masks = {name: mask.reshape(indices.shape) for name, mask in self.mattes[layer].masks().items()}
            full = numpy.max(list(masks.values()), axis=0) == 1
            self.assertGreater(full.sum(), indices.size / 4)
            for index in numpy.unique(indices[full]).tolist():
                mask = masks[self.name(layer, index)]
                self.assertTrue((mask[full & (indices == index)] == 1).all(), (layer, index))
            self.assertTrue((indices[self.alpha == 0] == NOTHING).all())

    def test_nodes_of_one_name_share_a_matte(self):
        same = [i for i, node in enumerate(self.scene["nodes"]) if node.get("name") == "same"]
        self.assertEqual(len(same), 2)
        mask = self.mattes["CryptoObject"].mask("same").reshape(self.alpha.shape)
        for index in same:
            shown = (self.channels["node.X"] == index) & (self.alpha == 1)
            self.assertTrue(shown.any())
            self.assertTrue((mask[shown] > 0).all())


if __name__ == "__main__":
    try:
        ENVIRONMENT.enter(say)
    except ConversionError as error:
        print("skipped: %s" % error)
        sys.exit(77)
    import cryptomatte_api
    import mmh3
    import numpy
    import OpenEXR
    unittest.main(argv=sys.argv[:1])
