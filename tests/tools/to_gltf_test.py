#!/usr/bin/env python3
"""tools/to_gltf on OBJ: what its documents hold, what it refuses, and that glim draws them. The argument is glim's program."""

import json
import math
import os
import struct
import subprocess
import sys
import tempfile
import time
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "tools"))
from conversion.smooth import dot  # noqa: E402
from conversion.triangulate import triangulate  # noqa: E402
from scene_makers import made_images as images  # noqa: E402
from scene_makers.gltf_document import cross, subtract  # noqa: E402

GLIM = sys.argv.pop() if len(sys.argv) > 1 else None

# [-1, 1]^3, faces outwards.
CUBE = """v -1 -1 -1
v 1 -1 -1
v 1 1 -1
v -1 1 -1
v -1 -1 1
v 1 -1 1
v 1 1 1
v -1 1 1
%s
f 4 3 2 1
f 5 6 7 8
f 1 2 6 5
f 2 3 7 6
f 3 4 8 7
f 4 1 5 8
"""


class Glb:
    def __init__(self, path):
        with open(path, "rb") as file:
            content = file.read()
        length = struct.unpack("<I", content[12:16])[0]
        self.json, self.data = json.loads(content[20:20 + length]), content[28 + length:]

    def view(self, index):
        view = self.json["bufferViews"][index]
        return self.data[view["byteOffset"]:view["byteOffset"] + view["byteLength"]]

    def values(self, index):
        accessor = self.json["accessors"][index]
        code = {5126: "f", 5125: "I", 5123: "H"}[accessor["componentType"]]
        width = 1 if accessor["type"] == "SCALAR" else int(accessor["type"][-1])
        numbers = struct.unpack("<%d%s" % (accessor["count"] * width, code), self.view(accessor["bufferView"]))
        return [numbers[i:i + width] for i in range(0, len(numbers), width)]

    def attribute(self, name, mesh=0, primitive=0):
        return self.values(self.json["meshes"][mesh]["primitives"][primitive]["attributes"][name])

    def corners(self, name, mesh=0, primitive=0):
        """An attribute at each corner of the triangles."""
        values = self.attribute(name, mesh, primitive)
        return [values[i] for (i,) in self.values(self.json["meshes"][mesh]["primitives"][primitive]["indices"])]


class ToGltfTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def write(self, name, content):
        with open(self.path(name), "wb") as file:
            file.write(content if isinstance(content, bytes) else content.encode())

    def run_tool(self, text):
        self.write("model.obj", text)
        return subprocess.run([os.path.join(ROOT, "tools", "to_gltf"), self.path("model.obj"), "-o", self.path("model.glb")],
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def convert(self, text, notices=()):
        result = self.run_tool(text)
        self.assertEqual(result.returncode, 0, result.stderr)
        lines = result.stderr.splitlines()
        self.assertEqual(len(lines), len(notices), result.stderr)
        for line, notice in zip(lines, notices):
            self.assertIn(notice, line)
        return Glb(self.path("model.glb"))

    def refusal(self, text):
        result = self.run_tool(text)
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertFalse(os.path.exists(self.path("model.glb")))
        self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
        return result.stderr

    def assert_near(self, a, b, error=1e-6):
        self.assertEqual(len(a), len(b))
        for x, y in zip(a, b):
            self.assertLessEqual(abs(x - y), error, "%s, expected %s" % (a, b))

    def test_smoothing_groups_become_normals(self):
        for statement, vertices in (("", 24), ("s off", 24), ("s 0", 24), ("s 1", 8)):
            glb = self.convert(CUBE % statement)
            self.assertEqual(len(glb.attribute("POSITION")), vertices, statement)
            corners = list(zip(glb.corners("POSITION"), glb.corners("NORMAL")))
            self.assertEqual(len(corners), 36)
            for i, (p, n) in enumerate(corners):
                if vertices == 8:
                    self.assert_near(n, [c / math.sqrt(3.0) for c in p])
                else:
                    face = [q for q, _ in corners[i // 3 * 3:i // 3 * 3 + 3]]
                    axis = next(a for a in range(3) if len({q[a] for q in face}) == 1)
                    self.assert_near(n, [face[0][a] if a == axis else 0.0 for a in range(3)])

    def test_groups_meet_in_an_edge(self):
        bend = "v 0 0 0\nv 0 1 0\nv 1 0 0\nv 0 0 1\ns 1\nf 1 3 2\ns 2\nf 1 2 4\n"
        normals = self.convert(bend).corners("NORMAL")
        for n in normals[:3]:
            self.assert_near(n, [0, 0, 1])
        for n in normals[3:]:
            self.assert_near(n, [1, 0, 0])

    def test_normals_and_texture_coordinates_of_the_file(self):
        glb = self.convert("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0.25\nvt 1 0.25\nvt 0 1\nvn 0 0.6 0.8\ns 1\nf 1/1/1 2/2/-1 -1/3/1\n")
        for n in glb.corners("NORMAL"):
            self.assert_near(n, [0, 0.6, 0.8])
        self.assertEqual(glb.corners("TEXCOORD_0"), [(0.0, 0.75), (1.0, 0.75), (0.0, 0.0)])

    def expect_area(self, points, area, place=lambda x, y: (x, y, 0.0), error=1e-5):
        """Of the polygon, from whichever corner its face begins: no triangle lies outside it or on another one."""
        vertices = sorted(set(points))
        text = "".join("v %.9g %.9g %.9g\n" % place(*p) for p in vertices)
        for first in range(len(points)):
            text += "o %d\nf %s\n" % (first, " ".join(str(vertices.index(p) + 1) for p in points[first:] + points[:first]))
        glb = self.convert(text)
        for first in range(len(points)):
            p, normal, areas = glb.corners("POSITION", first), None, []
            for a, b, c in zip(p[0::3], p[1::3], p[2::3]):
                n = cross(subtract(b, a), subtract(c, a))
                normal = normal or n
                areas.append(math.copysign(0.5 * math.sqrt(dot(n, n)), dot(n, normal)))
            self.assertTrue(min(areas) > 0.0, "%s from corner %d is cut outside itself: %s" % (points, first, areas))
            self.assertLessEqual(abs(sum(areas) - area), error)

    def test_polygons_keep_their_area(self):
        self.expect_area([(0, 0), (2, -1), (0, 2), (-2, -1)], 4.0)
        bent = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)]
        self.expect_area(bent, 3.0)
        self.expect_area(bent, math.sqrt(3.0) * 3.0, lambda x, y: (x, y, x - y))
        self.expect_area(bent, 3.0, lambda x, y: (y, x, 0.01 * ((x * y) % 2)), 0.05)
        comb = [(x, 0) for x in range(9)] + [(8 - x, 1 + x % 2 * 5) for x in range(9)]
        self.expect_area(comb, 28.0)
        points = [(k * math.cos(0.1 * k), k * math.sin(0.1 * k)) for k in range(20, 520)]
        spiral = points + [(1.0005 * x, 1.0005 * y) for x, y in reversed(points)]
        begin = time.process_time()
        self.assertEqual(len(triangulate([(x, y, 0.0) for x, y in spiral])), len(spiral) - 2)
        self.assertLess(time.process_time() - begin, 2.0)  # seconds; it was 11 when each cut looked at all corners again
        # A square hole that a bridge reaches, which the face passes twice; a corner in the middle of an edge.
        self.expect_area([(0, 0), (4, 0), (4, 4), (0, 4), (0, 0), (1, 1), (1, 3), (3, 3), (3, 1), (1, 1)], 12.0)
        self.expect_area([(0, 0), (1, 0), (2, 0), (2, 2), (0, 2)], 4.0)
        self.assertEqual(len(self.convert("".join("v %g %g 0\n" % (math.cos(a), math.sin(a)) for a in range(6)) +
                                          "f 1 2 3 4 5 6").corners("POSITION")), 12)

    def test_materials(self):
        picture = images.png([[255, 128], [0, 64]], images.GREY, 8)
        self.write("a b.png", picture)
        self.write("model.mtl", "newmtl paint\nKd 0.0101 0.5 0.25 # a comment\nNs 98\nd 0.75\nmap_Kd -s 1 1 1 a b.png\n"
                                "newmtl lamp\nKd 0 0 0\nKe 5 2.5 0\nPr 0.5\nPm 1\nnewmtl hash#1\nmap_Kd gone.png\nmap_Bump b.png\n")
        triangle = "f 1 2 3\n"
        glb = self.convert("mtllib model.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\no board\nusemtl paint\n" + triangle + "usemtl lamp\n" + triangle +
                           "o other\nusemtl hash#1\n" + triangle + "usemtl nothing\n" + triangle,
                           ["map_bump of the material \"hash#1\" is left out", "gone.png cannot be read", "\"nothing\" is drawn grey"])
        self.assertEqual([node["name"] for node in glb.json["nodes"]], ["board", "other"])
        paint, lamp, gone, grey = glb.json["materials"]
        self.assertTrue(all(material["doubleSided"] for material in glb.json["materials"]))
        self.assertEqual(paint["pbrMetallicRoughness"]["baseColorFactor"], [0.0101, 0.5, 0.25, 0.75])
        self.assertAlmostEqual(paint["pbrMetallicRoughness"]["roughnessFactor"], 0.02 ** 0.25)
        self.assertEqual((paint["pbrMetallicRoughness"]["metallicFactor"], paint["alphaMode"]), (0.0, "BLEND"))
        texture = glb.json["textures"][paint["pbrMetallicRoughness"]["baseColorTexture"]["index"]]
        self.assertEqual(glb.view(glb.json["images"][texture["source"]]["bufferView"]), picture)
        self.assertEqual((lamp["emissiveFactor"], lamp["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"]),
                         ([1.0, 0.5, 0.0], 5.0))
        self.assertEqual((lamp["pbrMetallicRoughness"]["metallicFactor"], lamp["pbrMetallicRoughness"]["roughnessFactor"]), (1.0, 0.5))
        self.assertNotIn("baseColorTexture", gone["pbrMetallicRoughness"])
        self.assertEqual(grey["pbrMetallicRoughness"]["baseColorFactor"], [0.8, 0.8, 0.8, 1.0])

    def test_colours_of_vertices_are_srgb(self):
        colors = self.convert("v 0 0 0 1 0.5 0\nv 1 0 0 0.02 0 0\nv 0 1 0 0 0 1\nf 1 2 3\n").corners("COLOR_0")
        self.assert_near(colors[0], [1.0, 0.2140411, 0.0])
        self.assert_near(colors[1], [0.02 / 12.92, 0.0, 0.0])

    def test_what_is_refused(self):
        for text, sentence in (
                ("v 0 0\n", "model.obj, line 1: it holds \"0 0\"; expected 3 numbers"),
                ("v 0 0 0\nf 1 2 3\n", "model.obj, line 2: a face names the vertex \"2\"; expected one of the 1 before it"),
                ("v 0 0 0\nf 1 1\n", "model.obj, line 2: a face has 2 corners; expected 3 or more"),
                ("v 0 0 0\nf 1/1 1 1\n", "model.obj, line 2: a face names the texture coordinate \"1\"; expected one of the 0"),
                ("v 0 0 0\nf 0 1 1\n", "model.obj, line 2: a face names the vertex \"0\""),
                ("# nothing\n", "model.obj: it has no faces"),
                ("mtllib model.mtl\nv 0 0 0\nusemtl a\nf 1 1 1\n", "model.mtl: kd is \"red\"; expected 3 numbers")):
            self.write("model.mtl", "newmtl a\nKd red\n")
            self.assertIn(sentence, self.refusal(text))

    @unittest.skipIf(GLIM is None, "no program of glim was named")
    def test_glim_draws_it(self):
        self.convert(CUBE % "s 1")
        result = subprocess.run([GLIM, "inspect", self.path("model.glb"), "--json"], stdout=subprocess.PIPE, text=True, check=True)
        inspected = json.loads(result.stdout)
        self.assertEqual(inspected["counts"]["triangles"], 12)
        self.assertEqual(inspected["singleSided"], 0)
        self.assertEqual(inspected["bounds"], {"low": [-1, -1, -1], "high": [1, 1, 1]})


if __name__ == "__main__":
    unittest.main()
