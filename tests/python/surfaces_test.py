#!/usr/bin/env python3
"""Surfaces, objects and crops from Python, against the command line's files and against K and pose."""

import base64
import json
import os
import shutil
import struct
import subprocess
import sys
import unittest

import numpy as np
from python_case import GEMS, GLIM, PythonCase, glim, scene

LAMP = scene("light_point")
SMALL = {"size": (32, 24), "spp": 2}
NOTHING = 4294967295


class SurfacesTest(PythonCase):
    def moving(self):
        """A file in which the ball of LAMP moves .3 m along x in a second."""
        with open(LAMP, encoding="utf-8") as file:
            document = json.load(file)
        for buffer in document["buffers"]:
            if not buffer["uri"].startswith("data:"):
                shutil.copy(os.path.join(os.path.dirname(LAMP), buffer["uri"]), self.folder)
        self.node = next(i for i, node in enumerate(document["nodes"]) if node.get("name") == "ball")
        x, y, z = document["nodes"][self.node].get("translation", (0, 0, 0))
        data = struct.pack("<8f", 0, 1, x, y, z, x + .3, y, z)
        document["buffers"].append({"byteLength": len(data), "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()})
        views, accessors = len(document["bufferViews"]), len(document["accessors"])
        for offset, length in ((0, 8), (8, 24)):
            document["bufferViews"].append({"buffer": len(document["buffers"]) - 1, "byteOffset": offset, "byteLength": length})
        document["accessors"] += [
            {"bufferView": views, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [1]},
            {"bufferView": views + 1, "componentType": 5126, "count": 2, "type": "VEC3"}]
        document["animations"] = [{"samplers": [{"input": accessors, "output": accessors + 1}],
                                   "channels": [{"sampler": 0, "target": {"node": self.node, "path": "translation"}}]}]
        with open(self.path("moving.gltf"), "w", encoding="utf-8") as file:
            json.dump(document, file)
        return self.path("moving.gltf")

    def test_are_those_of_the_command_line(self):
        film = glim.render(GEMS, surfaces=True, objects=True, **SMALL)
        subprocess.run([GLIM, "render", GEMS, "-o", self.path("x.exr"), "--size", "32x24", "--spp", "2", "--progress", "none",
                        "--objects", self.path("o.json")], check=True, stdout=subprocess.DEVNULL)
        with open(self.path("o.json"), encoding="utf-8") as file:
            told = json.load(file)
        self.assertEqual(film.objects["instances"], told["instances"])
        self.assertEqual(film.objects["annotations"], told["annotations"])
        self.assertEqual(film.names, [instance["name"] for instance in told["instances"]])
        self.assertEqual(film.boxes, {i["name"]: tuple(i["bbox"]) for i in told["instances"] if i["bbox"]})
        self.assertEqual(sorted(film.surfaces), ["distance", "instance", "position", "uv"])
        self.assertEqual(film.surfaces["position"].shape, (24, 32, 3))
        for instance in told["instances"]:
            self.assertEqual((film.surfaces["instance"] == instance["id"]).sum(), instance["pixels"])
        self.assertIn("position", film.arrays())

    def test_places_project_to_their_pixels(self):
        film = glim.render(GEMS, surfaces=True, **SMALL)
        pose, K = np.array(film.camera.pose("opencv")), np.array(film.camera.K("corner"))
        seen = film.surfaces["instance"] != NOTHING
        local = (film.surfaces["position"][seen] - pose[:3, 3]) @ pose[:3, :3]
        pixels = local @ K.T
        rows, columns = np.nonzero(seen)
        np.testing.assert_allclose(pixels[:, :2] / pixels[:, 2:], np.stack([columns + .5, rows + .5], 1), atol=1e-3)

    def test_flow_is_how_a_ball_moves(self):
        film = glim.render(self.moving(), at=.5, surfaces=True, flow=.25, objects=True, **SMALL)
        ball = film.names.index("ball")
        pose, K = np.array(film.camera.pose("opencv")), np.array(film.camera.K("corner"))
        is_ball = film.surfaces["instance"] == ball
        self.assertGreater(is_ball.sum(), 10)
        rows, columns = np.nonzero(is_ball)
        for layer, step in (("forward_flow", .075), ("backward_flow", -.075)):
            moved = film.surfaces["position"][is_ball] + (step, 0, 0)
            pixels = (moved - pose[:3, 3]) @ pose[:3, :3] @ K.T
            expected = pixels[:, :2] / pixels[:, 2:] - np.stack([columns + .5, rows + .5], 1)
            np.testing.assert_allclose(film.surfaces[layer][is_ball], expected, atol=1e-3)
            others = film.surfaces[layer][(film.surfaces["instance"] != ball)]
            self.assertLess(np.abs(others).max(), 1e-3)

    def test_are_none_unless_asked_for(self):
        film = glim.render(GEMS, **SMALL)
        self.assertEqual((film.surfaces, film.objects, film.names, film.boxes, film.crop), (None,) * 5)

    def test_refuse_flow_without_a_time(self):
        for options in ({"flow": 1}, {"flow": 1, "surfaces": True}, {"flow": -1, "surfaces": True, "at": 1}, {"flow": True, "surfaces": True, "at": 1}):
            with self.assertRaises(glim.InputError) as refused:
                glim.render(GEMS, **SMALL, **options)
            self.assertEqual(refused.exception.place, "flow")

    def test_focus_is_the_depth_of_a_pixel(self):
        gems = glim.load(GEMS, lens_radius=.1, **SMALL)
        focused = gems.render(focus=(10, 6))
        shown = glim.render(GEMS, surfaces=True, **SMALL)
        pose = np.array(shown.camera.pose(axes="gltf"))
        distance = float((pose[:3, 3] - shown.surfaces["position"][6, 10]) @ pose[:3, 2])
        self.assertRegex(focused.settings, "focal-distance=")
        said = float(focused.settings.rpartition("focal-distance=")[2].split()[0])
        self.assertAlmostEqual(said, distance, delta=1e-6 * distance)
        self.assertEqual(gems.render(focal_distance=said).digest, focused.digest)

    def test_a_crop_has_its_own_K(self):
        whole = glim.render(GEMS, surfaces=True, **SMALL)
        part = glim.render(GEMS, surfaces=True, crop=(10, 6, 12, 8), **SMALL)
        self.assertEqual((part.width, part.height, part.crop), (12, 8, (10, 6, 12, 8)))
        np.testing.assert_allclose(part.surfaces["position"], whole.surfaces["position"][6:14, 10:22], atol=1e-5)
        np.testing.assert_allclose(np.array(whole.camera.K("corner")) - part.camera.K("corner"), [[0, 0, 10], [0, 0, 6], [0, 0, 0]], atol=1e-9)
        again = glim.render(GEMS, surfaces=True, camera=part.camera, size=(12, 8), spp=2)
        np.testing.assert_allclose(part.surfaces["distance"], again.surfaces["distance"], rtol=1e-5)
        part.save(self.path("a.exr"))
        self.assertEqual(glim.read(self.path("a.exr")).crop, part.crop)

    def test_layers_are_saved_as_halves(self):
        film = glim.render(GEMS, **SMALL)
        film.save(self.path("film.exr"))
        film.save(self.path("half.exr"), half=True)
        self.assertLess(os.path.getsize(self.path("half.exr")), .4 * os.path.getsize(self.path("film.exr")))
        with self.assertRaisesRegex(glim.InputError, "glim:film"):
            glim.read(self.path("half.exr"))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
