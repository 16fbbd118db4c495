#!/usr/bin/env python3
"""Textures of a scene as arrays."""

import base64
import json
import sys
import unittest

import numpy as np
from python_case import PythonCase, glim, scene

from glim._own_files import png_of

LAMP = scene("light_point")
SMALL = {"size": (16, 12), "spp": 4}
DARK = {**SMALL, "environment": "none"}


class ImagesTest(PythonCase):
    """A rectangle whose image is white."""

    def setUp(self):
        super().setUp()
        self.scene = glim.load(self.write(np.full((2, 2, 3), 255, np.uint8)), **DARK)
        self.white = self.scene.render()

    def write(self, pixels, **texture):
        corners = np.float32([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]).tobytes()
        corners += np.float32([[0, 1], [1, 1], [1, 0], [0, 0]]).tobytes() + np.uint16([0, 1, 2, 0, 2, 3]).tobytes()
        document = {
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
            "buffers": [{"byteLength": len(corners), "uri": "data:;base64," + base64.b64encode(corners).decode()}],
            "bufferViews": [{"buffer": 0, "byteOffset": at, "byteLength": length} for at, length in ((0, 48), (48, 32), (80, 12))],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-1, -1, 0], "max": [1, 1, 0]},
                          {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2"},
                          {"bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR"}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2, "material": 0}]}],
            "materials": [{"name": "card", "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1]}, "emissiveFactor": [1, 1, 1],
                           "emissiveTexture": {"index": 0}}],
            "textures": [{"source": 1, **texture}], "images": [{"uri": "none.png"}, {"name": "paint", "uri": "paint.png"}]}
        with open(self.path("paint.png"), "wb") as file:
            file.write(png_of(pixels))
        with open(self.path("card.gltf"), "w", encoding="utf-8") as file:
            json.dump(document, file)
        return self.path("card.gltf")

    def test_pixels_are_those_of_a_file(self):
        random = np.random.default_rng(3)
        image = self.scene.images["paint"]
        for shape in ((5, 3), (5, 3, 3), (4, 7, 4)):
            for kind in (np.uint8, np.uint16):
                pixels = random.integers(0, np.iinfo(kind).max, shape, kind, endpoint=True)
                image.replace(pixels)
                mine = self.scene.render()
                self.assertEqual(mine.pixels_digest, glim.render(self.write(pixels), **DARK).pixels_digest, (shape, kind))
                self.assertNotEqual(mine.pixels_digest, self.white.pixels_digest)
                self.write(np.full((2, 2, 3), 255, np.uint8))
        image.undo()
        self.assertEqual(self.scene.render().pixels_digest, self.white.pixels_digest)
        image.replace(pixels)
        self.scene.reset()
        self.assertEqual(self.scene.render().pixels_digest, self.white.pixels_digest)

    def test_a_radiance_is_that_of_the_pixels(self):
        """sRGB's, of the left half and the right one, of the upper half and the lower one."""
        pixels = np.zeros((2, 2, 3), np.uint8)
        pixels[0, 0], pixels[1, 1] = (255, 0, 0), (0, 188, 0)
        self.scene.images[1].replace(np.repeat(np.repeat(pixels, 8, 0), 8, 1))
        film = self.scene.render(size=(16, 16), spp=16)
        rows, columns = np.nonzero(film.alpha == 1)
        top, bottom = (int(np.percentile(rows, share)) for share in (25, 75))  # in the middle of each half
        left, right = (int(np.percentile(columns, share)) for share in (25, 75))
        np.testing.assert_array_equal(film.rgb[top, left], (1, 0, 0))
        np.testing.assert_allclose(film.rgb[bottom, right], (0, .5029, 0), atol=1e-4)  # ((188 / 255 + .055) / 1.055)^2.4
        np.testing.assert_array_equal(film.rgb[top, right], (0, 0, 0))

    def test_arrays_of_other_libraries(self):
        pixels = np.arange(48, dtype=np.uint8).reshape(4, 4, 3)

        class Tensor:
            def __dlpack__(self, **keywords):
                return pixels.__dlpack__(**keywords)

            def __dlpack_device__(self):
                return pixels.__dlpack_device__()
        digests = set()
        for same in (pixels, Tensor(), memoryview(pixels), np.asfortranarray(pixels), pixels[::-1][::-1], pixels.astype(">u2").astype("u1")):
            self.scene.images["paint"].replace(same)
            digests.add(self.scene.render().pixels_digest)
        self.assertEqual(len(digests), 1)
        digests.clear()
        big, native = ((pixels.astype("u2") * 257).astype(kind) for kind in (">u2", "=u2"))
        for same in big, native:
            self.scene.images["paint"].replace(same)
            digests.add(self.scene.render().pixels_digest)
        self.assertEqual(len(digests), 1)

    def test_materials_name_theirs(self):
        paint = self.scene.images["paint"]
        self.assertEqual(self.scene.images.names, [None, "paint"])
        self.assertEqual(self.scene.materials["card"].images, {"emissiveTexture": paint})
        self.write(np.zeros((1, 1), np.uint8), extensions={"EXT_texture_webp": {"source": 0}})
        self.assertEqual([image.index for image in self.scene.materials["card"].images.values()], [0])

    def test_images_of_added_files(self):
        lamp = glim.load(LAMP, **SMALL)
        added = lamp.add(self.path("card.gltf"))
        before = lamp.render()
        added.materials["card"].images["emissiveTexture"].replace(np.zeros((1, 1), np.uint8))
        self.assertNotEqual(lamp.render().pixels_digest, before.pixels_digest)
        lamp.set(added.images[1].pointer + "/uri", None)
        self.assertEqual(lamp.render().pixels_digest, before.pixels_digest)

    def test_other_arrays_are_refused(self):
        for pixels in (np.zeros((2, 2)), np.zeros((2, 2, 2), np.uint8), np.zeros((0, 2), np.uint8), np.zeros(3, np.uint8), np.uint8(1),
                       np.zeros((2, 2), np.int16), np.zeros((2, 2), np.uint32), "paint.png", b"\0\0", None, 3):
            with self.assertRaisesRegex(glim.InputError, "^pixels: cannot use"):
                self.scene.images["paint"].replace(pixels)
            self.assertEqual(self.scene.edits, {})
        with self.assertRaisesRegex(glim.InputError, "^images: cannot use 'wood', expected one of \"paint\"$"):
            self.scene.images["wood"]


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
