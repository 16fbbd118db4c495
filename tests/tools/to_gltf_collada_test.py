#!/usr/bin/env python3
"""tools/to_gltf on Collada: what its documents hold, what it refuses, and that glim draws the same pictures. It needs pycollada from PyPI:
where that cannot be had, ctest lists this test as skipped (exit code 77). The argument is glim's program."""

import math
import os
import subprocess
import sys
import tempfile
import time
import unittest
import urllib.parse

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [HERE, os.path.join(os.path.dirname(os.path.dirname(HERE)), "tools")]
from conversion.main import ENVIRONMENT  # noqa: E402
from conversion.errors import ConversionError  # noqa: E402

if __name__ == "__main__":
    try:
        ENVIRONMENT.enter(print)
    except ConversionError as error:
        print("skipped: %s" % error)
        sys.exit(77)

import collada_mutants  # noqa: E402
from to_gltf_test import GLIM, ROOT, Glb  # noqa: E402
from conversion.collada_to_gltf import collada_to_gltf  # noqa: E402
from conversion.embed_images import ImageEmbedder  # noqa: E402
from conversion.smooth import dot  # noqa: E402
from scene_makers import made_images as images  # noqa: E402
from scene_makers.collada_document import ColladaDocument, element, source, to_collada  # noqa: E402
from scene_makers.gltf_document import normalize  # noqa: E402
from scene_makers.small_scenes import cornell_mirror_glass  # noqa: E402

TRIANGLE = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
TETRAHEDRON = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
SIDES = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]


def one_triangle(up="Y_UP", **more):
    dae = ColladaDocument(up)
    dae.mesh("triangle", TRIANGLE, [[0, 1, 2]])
    dae.node("triangle", "geometry", "triangle", **more)
    return dae


def transform(node, p):
    m = node["matrix"]
    return [sum(m[4 * k + i] * p[k] for k in range(3)) + m[12 + i] for i in range(3)]


class ToGltfColladaTest(unittest.TestCase):
    def setUp(self):
        self.notices = []
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def write(self, text):
        with open(self.path("model.dae"), "w", encoding="utf-8") as file:
            file.write(text)

    def convert(self, dae, course=False, notices=()):
        """A ColladaDocument or its text, as tools/to_gltf does, but without a process."""
        self.write(dae if isinstance(dae, str) else dae.text())
        lines = []
        collada_to_gltf(self.path("model.dae"), course, lines.append).write(self.path("model.glb"))
        self.assertEqual(len(lines), len(notices), lines)
        for line, notice in zip(lines, notices):
            self.assertIn(notice, line)
        return Glb(self.path("model.glb"))

    def refusal(self, text):
        self.write(text)
        with self.assertRaises(ConversionError) as caught:
            collada_to_gltf(self.path("model.dae"), False, lambda notice: None)
        return str(caught.exception)

    def run_tool(self, dae, *options):
        self.write(dae)
        return subprocess.run([os.path.join(ROOT, "tools", "to_gltf"), self.path("model.dae"), "-o", self.path("model.glb"), *options],
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def test_the_command(self):
        text = one_triangle().text()
        for old, new, options, sentence in ((">3</vcount>", ">4</vcount>", (), "expected 4, those of its <vcount>"),
                                            ("<COLLADA", "<!DOCTYPE a><COLLADA", (), "it has a document type declaration; expected none")):
            result = self.run_tool(text.replace(old, new), *options)
            self.assertEqual(result.returncode, 1)
            self.assertRegex(result.stderr, "^to_gltf: %s.*%s\n$" % (self.path("model.dae"), sentence))
            self.assertEqual(os.listdir(self.folder.name), ["model.dae"])
        for options, z in (((), -1.0), (("--course",), 1.0)):
            result = self.run_tool(one_triangle("Z_UP", transforms=element("translate", "0 0 0")).text(), *options)
            self.assertEqual((result.returncode, result.stderr), (0, ""))
            self.assert_near(transform(Glb(self.path("model.glb")).json["nodes"][-1], [0, 1, 0]), [0, 0, z])

    def assert_near(self, a, b, error=1e-6):
        self.assertEqual(len(a), len(b), "%s, expected %s" % (a, b))
        for x, y in zip(a, b):
            self.assertLessEqual(abs(x - y), error, "%s, expected %s" % (a, b))

    def node(self, glb, name):
        return next(node for node in glb.json["nodes"] if node["name"] == name)

    def expect_corners(self, transforms, corners, up="Y_UP", course=False, text=lambda text: text):
        glb = self.convert(text(one_triangle(up, transforms=transforms).text()), course)
        for p, expected in zip(glb.corners("POSITION"), corners):
            self.assert_near(transform(glb.json["nodes"][-1], p), expected)

    def test_transforms_in_their_order(self):
        self.expect_corners(element("translate", "1 2 3") + element("rotate", "0 0 1 90") + element("scale", "2 3 4"),
                            [[1, 2, 3], [1, 4, 3], [-2, 2, 3]])
        self.expect_corners(element("scale", "2 3 4") + element("translate", "1 2 3"), [[2, 6, 12], [4, 6, 12], [2, 9, 12]])
        self.expect_corners(element("matrix", "0 -1 0 5 1 0 0 6 0 0 1 7 0 0 0 1"), [[5, 6, 7], [5, 7, 7], [4, 6, 7]])
        self.expect_corners(element("lookat", "1 0 0 3 0 0 0 1 0"), [[1, 0, 0], [1, 0, 1], [1, 1, 0]])
        self.expect_corners(element("skew", "45 1 0 0 0 0 1"), [[0, 0, 0], [1, 0, 1], [0, 1, 0]])

    def test_axes_and_units(self):
        moved = element("translate", "0 0 0")
        self.expect_corners(moved, [[0, 0, 0], [1, 0, 0], [0, 0, -1]], "Z_UP")
        self.expect_corners(moved, [[0, 0, 0], [-1, 0, 0], [0, 0, 1]], "Z_UP", True)
        self.expect_corners(moved, [[0, 0, 0], [0, 1, 0], [-1, 0, 0]], "X_UP")
        self.expect_corners(moved, [[0, 0, 0], [0, 1, 0], [1, 0, 0]], "X_UP", True)
        inches = {"text": lambda text: text.replace('meter="1"', 'meter="0.0254"')}
        self.expect_corners(element("translate", "0 0 1"), [[0, 0, 0.0254], [0.0254, 0, 0.0254], [0, 0.0254, 0.0254]], **inches)

    def test_instances_share_meshes(self):
        dae = ColladaDocument("Y_UP")
        dae.diffuse("red", [1, 0, 0])
        dae.mesh("triangle", TRIANGLE, [[0, 1, 2]])
        inner = element("node", element("translate", "0 0 1") + element("instance_geometry", url="#triangle"), id="inner", name="inner")
        dae.libraries["nodes"].append(element("node", element("translate", "0 1 0") + inner, id="group"))
        dae.node("a", "node", "group", transforms=element("translate", "1 0 0"))
        dae.node("b", "node", "group", transforms=element("scale", "2 2 2"))
        dae.node("red", "geometry", "triangle", material="red")
        glb = self.convert(dae)
        first, second, red = glb.json["nodes"]
        self.assert_near(first["matrix"][12:15], [1, 1, 1])
        self.assert_near(second["matrix"][12:15], [0, 2, 2])
        self.assertEqual((first["mesh"], second["mesh"], len(glb.json["meshes"])), (0, 0, 2))
        colors = [glb.json["materials"][glb.json["meshes"][node["mesh"]]["primitives"][0]["material"]]["pbrMetallicRoughness"]
                  ["baseColorFactor"][:3] for node in (first, red)]
        self.assertEqual(colors, [[0.5] * 3, [1.0, 0.0, 0.0]])

    def test_normals_of_the_file_but_in_the_course(self):
        own = [[0, 0, 2], [3, 0, 0], [0, 1, 0], [0, 0, 1]]
        dae = ColladaDocument("Y_UP")
        dae.mesh("solid", TETRAHEDRON, SIDES, own)
        dae.node("solid", "geometry", "solid")
        glb = self.convert(dae)
        for p, n in zip(glb.attribute("POSITION"), glb.attribute("NORMAL")):
            self.assert_near(n, normalize(own[TETRAHEDRON.index(list(p))]))
        glb = self.convert(dae, True)
        self.assertEqual(len(glb.attribute("POSITION")), 4)
        # Doubled areas as vectors: three sides of length 1, and (1, 1, 1).
        truth = {(0, 0, 0): [-1, -1, -1], (1, 0, 0): [1, 0, 0], (0, 1, 0): [0, 1, 0], (0, 0, 1): [0, 0, 1]}
        for p, n in zip(glb.attribute("POSITION"), glb.attribute("NORMAL")):
            self.assert_near(n, normalize(truth[p]))
        dae = one_triangle()
        self.assertEqual(list(self.convert(dae).json["meshes"][0]["primitives"][0]["attributes"]), ["POSITION"])

    def test_polygons_of_every_kind(self):
        bent = [[0, 0, 0], [2, 0, 0], [2, 1, 0], [1, 1, 0], [1, 2, 0], [0, 2, 0]]
        vertex = element("input", semantic="VERTEX", source="#shape-vertices", offset=0)
        for faces, area in ((element("polylist", vertex + element("vcount", "6") + element("p", "0 1 2 3 4 5"), count=1), 3.0),
                            (element("polygons", vertex + element("p", "0 1 2 3 4 5"), count=1), 3.0),
                            (element("polylist", vertex + element("vcount", "3 4") + element("p", "0 1 2 0 3 4 5"), count=2), 2.5),
                            (element("triangles", vertex + element("p", "0 1 2 0 4 5"), count=2), 2.0),
                            (element("trifans", vertex + element("p", "0 1 2 3 4 5"), count=1), 3.0),
                            (element("tristrips", vertex + element("p", "0 1 3 2"), count=1), 1.5)):
            dae = ColladaDocument("Y_UP")
            points = source("shape-positions", "XYZ", bent)
            vertices = element("vertices", element("input", semantic="POSITION", source="#shape-positions"), id="shape-vertices")
            dae.geometry("shape", element("mesh", points + vertices + faces))
            dae.node("shape", "geometry", "shape")
            p = self.convert(dae).corners("POSITION")
            areas = [0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) for a, b, c in zip(p[0::3], p[1::3], p[2::3])]
            self.assertAlmostEqual(sum(map(abs, areas)), area, 6, faces)

    def test_textures(self):
        picture = images.png([[255, 128], [0, 64]], images.GREY, 8)
        with open(self.path("a b.png"), "wb") as file:
            file.write(picture)
        for name, notices in (("a%20b.png", ()), ("gone.png", ["gone.png cannot be read"])):
            dae = ColladaDocument("Y_UP")
            dae.libraries["images"].append(element("image", element("init_from", name), id="picture"))
            surface = element("newparam", element("surface", element("init_from", "picture"), type="2D"), sid="surface")
            sampler = element("newparam", element("sampler2D", element("source", "surface")), sid="sampler")
            dae.material("paint", common=element("lambert", element("diffuse", element("texture", texture="sampler", texcoord="UV"))))
            dae.libraries["effects"][0] = dae.libraries["effects"][0].replace("<profile_COMMON>", "<profile_COMMON>" + surface + sampler)
            uvs = source("shape-uvs", "ST", [[0, 0.25], [1, 0.25], [0, 1]])
            vertices = element("vertices", element("input", semantic="POSITION", source="#shape-positions"), id="shape-vertices")
            faces = (element("input", semantic="VERTEX", source="#shape-vertices", offset=0) +
                     element("input", semantic="TEXCOORD", source="#shape-uvs", offset=1, set=0) + element("p", "0 0 1 1 2 2"))
            dae.geometry("shape", element("mesh", source("shape-positions", "XYZ", TRIANGLE) + uvs + vertices +
                                          element("triangles", faces, count=1, material="surface")))
            dae.node("shape", "geometry", "shape", material="paint")
            glb = self.convert(dae, notices=notices)
            self.assertEqual(glb.corners("TEXCOORD_0"), [(0.0, 0.75), (1.0, 0.75), (0.0, 0.0)])
            core = glb.json["materials"][0]["pbrMetallicRoughness"]
            if notices:
                self.assertNotIn("baseColorTexture", core)
            else:
                self.assertEqual(glb.view(glb.json["images"][0]["bufferView"]), picture)
                self.assertEqual(core["baseColorFactor"], [1.0] * 4)

    def test_cameras(self):
        dae = one_triangle("Z_UP")
        dae.camera("wide", xfov=60, aspect_ratio=1.6)
        dae.camera("tall", yfov=40, aspect_ratio=0.5)
        dae.camera("both", xfov=60, yfov=40)
        for name in ("wide", "tall", "both"):
            dae.node(name, "camera", name, transforms=element("scale", "3 3 3") + element("matrix", "1 0 0 4 0 1 0 5 0 0 1 6 0 0 0 1"))
        glb = self.convert(dae)
        half = math.tan(math.radians(30.0))
        for camera, yfov, aspect in zip(glb.json["cameras"], (2.0 * math.atan(half / 1.6), math.radians(40), math.radians(40)),
                                        (1.6, 0.5, half / math.tan(math.radians(20.0)))):
            self.assertAlmostEqual(camera["perspective"]["yfov"], yfov)
            self.assertAlmostEqual(camera["perspective"]["aspectRatio"], aspect)
        # It looks down, north is up.
        self.assert_near(self.node(glb, "wide")["matrix"], [1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 12, 18, -15, 1])

    def test_opening_view_of_the_course(self):
        dae = ColladaDocument("Z_UP")
        dae.sphere("ball", 0.5)
        dae.node("ball", "geometry", "ball", transforms=element("translate", "1 2 3"))
        dae.camera("front", xfov=60, aspect_ratio=16.0 / 9.0)
        # At (0, 1, 3) in the document's axes, looking along -z: the place less the direction is (0, 1, 4) - (0, 0, 2).
        dae.node("front", "camera", "front", transforms=element("matrix", "-1 0 0 0 0 0 1 3 0 1 0 1 0 0 0 1"))
        glb = self.convert(dae)
        opening, own = glb.json["nodes"][:2]
        self.assertEqual((opening["name"], own["name"]), ("opening view", "front"))
        self.assert_near(own["matrix"], [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 1, 3, 1])
        towards, middle, distance = normalize([0, 1, 2]), [-1, 3, 2], 1.5 * math.sqrt(3.0)
        self.assert_near(opening["matrix"][12:15], [m + distance * t for m, t in zip(middle, towards)])
        self.assert_near(opening["matrix"][8:11], towards)
        perspective = glb.json["cameras"][0]["perspective"]
        self.assertAlmostEqual(math.tan(0.5 * perspective["yfov"]), math.tan(math.radians(30.0)) / (4.0 / 3.0))
        dae.node("above", "camera", "front", transforms=element("translate", "0 0 5"))
        self.assert_near(self.convert(dae).json["nodes"][2]["matrix"][8:11], [0, 1, 0])

    def punctual(self, glb):
        return glb.json["extensions"]["KHR_lights_punctual"]["lights"]

    def attenuations(self, constant, linear, quadratic):
        return "".join(element(tag + "_attenuation", str(value)) for tag, value in
                       (("constant", constant), ("linear", linear), ("quadratic", quadratic)))

    def test_point_lights(self):
        # The box of the triangle is about (.5, .5, 0): 2 from the light.
        for attenuations, course, intensity, notices in (
                (self.attenuations(0, 0, 0.25), False, 6.0 / 0.25, ()),
                (self.attenuations(1, 0.5, 0.25), False, 6.0 * 4.0 / 3.0, ["does not fall with the square"]),
                (self.attenuations(0, 0, 0.25), True, 6.0 * 4.0, ["does not fall with the square"])):
            dae = one_triangle()
            dae.light("bulb", "point", [3, 6, 1.5], attenuations)
            dae.node("bulb", "light", "bulb", transforms=element("translate", "0.5 0.5 2"))
            glb = self.convert(dae, course, notices)
            light, = self.punctual(glb)
            self.assertEqual((light["type"], light["color"]), ("point", [0.5, 1.0, 0.25]))
            self.assertAlmostEqual(light["intensity"], intensity)
            self.assert_near(self.node(glb, "bulb")["matrix"][12:15], [0.5, 0.5, 2])

    def test_spot_and_directional_lights(self):
        dae = one_triangle("Z_UP")
        cone = element("falloff_angle", "60") + element("falloff_exponent", "0.5")
        dae.light("spot", "spot", [1, 1, 1], self.attenuations(0, 0, 1) + cone)
        dae.light("sun", "directional", [2, 2, 1])
        dae.node("spot", "light", "spot", transforms=element("translate", "0 0 3"))
        dae.node("sun", "light", "sun", transforms=element("translate", "3 0 4") + element("rotate", "1 0 0 90"))  # along +y, which is -z
        glb = self.convert(dae)
        spot, sun = self.punctual(glb)
        self.assert_near([spot["spot"]["outerConeAngle"], spot["spot"]["innerConeAngle"]], [math.radians(30), math.radians(15)])
        self.assert_near([-c for c in self.node(glb, "spot")["matrix"][8:11]], [0, -1, 0])
        self.assertEqual((sun["intensity"], sun["color"]), (2.0, [1.0, 1.0, 0.5]))
        self.assert_near([-c for c in self.node(glb, "sun")["matrix"][8:11]], [0, 0, -1])
        dae.sphere("ball", 1)  # of the course's profile
        dae.node("ball", "geometry", "ball")
        glb = self.convert(dae, notices=["does not fall"])
        # In its axes the place is (-3, 4, 0), and -z of the node (0, 0, 1).
        self.assert_near([-c for c in self.node(glb, "sun")["matrix"][8:11]], normalize([3, -4, -1]))

    def read_map(self):
        """Radiance at the top and the bottom."""
        with open(self.path("model_ambient.hdr"), "rb") as file:
            pixels = file.read()[-4 * 4 * 256:]
        return [[c * 2.0 ** (p[3] - 136) for c in p[:3]] for p in (pixels[:4], pixels[-4:])]

    def test_ambient_light(self):
        for course, lower in ((False, 1.0), (True, 0.0)):
            dae = one_triangle()
            dae.light("sky", "ambient", [0.3, 0.6, 1.5])
            dae.light("more", "ambient", [0, 0, 0.5])
            dae.node("sky", "light", "sky")
            dae.node("more", "light", "more")
            environment = self.convert(dae, course).json["scenes"][0]["extras"]["environment"]
            self.assertEqual(environment["file"], "model_ambient.hdr")
            top, bottom = ([environment["strength"] * c for c in row] for row in self.read_map())
            self.assert_near(top, [0.3, 0.6, 2.0], 2.0 / 510.0)
            self.assert_near(top[2:], [2.0])
            self.assert_near(bottom, [lower * c for c in top])

    def test_materials_of_the_course(self):
        three = "0.2 0.4 0.8"
        reflectance, transmittance = element("reflectance", three), element("transmittance", three)
        rest = element("roughness", "0") + element("ior", "1.45")
        bsdfs = {"lamp": element("emission", element("radiance", "4 2 1")), "one": element("emission", element("radiance", "1 1 1")),
                 "mirror": element("mirror", reflectance),
                 "glass": element("glass", element("reflectance", "1 1 1") + transmittance + rest),
                 "refraction": element("refraction", transmittance + rest),
                 "copper": element("microfacet", element("alpha", "0.09") + element("eta", "0.33228 1.0162 1.2474") +
                                   element("k", "3.1646 2.5785 2.4603")),
                 "soap": element("thinfilm", "")}
        for profile in ("CGL", "CMU462"):
            dae = ColladaDocument("Y_UP", profile)
            for name, bsdf in bsdfs.items():
                dae.material(name, bsdf)
            dae.diffuse("wall", [0.6, 0.2, 0.1])
            dae.sphere("ball", 0.25)
            for i, name in enumerate([*bsdfs, "wall", None]):
                place = element("translate", "%d 0 0" % i) + element("scale", "2 2 2")
                dae.node("ball %d" % i, "geometry", "ball", transforms=place, material=name)
            glb = self.convert(dae, notices=["\"soap\" is drawn by its diffuse colour"])
            found = {material["name"]: material for material in glb.json["materials"]}
            for i, (node, name) in enumerate(zip(glb.json["nodes"], [*bsdfs, "wall", "default"])):
                self.assertEqual(node["translation"], [i, 0, 0])
                self.assertEqual(node["extras"]["sphere"], {"radius": 0.5, "material": list(found).index(name)})
            core = {name: material["pbrMetallicRoughness"] for name, material in found.items()}
            extensions = {name: {key.removeprefix("KHR_materials_"): value for key, value in material.get("extensions", {}).items()}
                          for name, material in found.items()}
            self.assertEqual((found["lamp"]["emissiveFactor"], extensions["lamp"]["emissive_strength"]),
                             ([1.0, 0.5, 0.25], {"emissiveStrength": 4.0}))
            self.assertEqual(extensions["one"]["emissive_strength"], {"emissiveStrength": 1.0})
            self.assertEqual(core["lamp"]["baseColorFactor"][:3], [0.0] * 3)
            self.assertNotIn("doubleSided", found["lamp"])
            self.assertEqual(core["mirror"], {"baseColorFactor": [0.2, 0.4, 0.8, 1.0], "metallicFactor": 1.0, "roughnessFactor": 0.0})
            for name in ("glass", "refraction"):
                self.assertEqual(core[name], {"baseColorFactor": [0.2, 0.4, 0.8, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.0})
                self.assertEqual(extensions[name]["ior"], {"ior": 1.45})
                self.assertEqual(extensions[name]["transmission"], {"transmissionFactor": 1.0})
                self.assertGreater(extensions[name]["volume"]["thicknessFactor"], 0.0)
            self.assertNotIn("specular", extensions["glass"])
            self.assertEqual(extensions["refraction"]["specular"], {"specularFactor": 0.0})
            self.assert_near(core["copper"]["baseColorFactor"][:3], [0.88726395, 0.6205988, 0.55064367])
            self.assert_near([core["copper"]["roughnessFactor"], core["copper"]["metallicFactor"]], [0.3, 1.0])
            self.assertEqual(core["wall"]["baseColorFactor"][:3], [0.6, 0.2, 0.1])
            self.assertEqual(extensions["wall"], {"specular": {"specularFactor": 0.0}})
            self.assertEqual(core["default"]["baseColorFactor"][:3], [0.5] * 3)

    def test_common_materials(self):
        dae = one_triangle()
        color = element("diffuse", element("color", "0.2 0.4 0.6 1")) + element("emission", element("color", "1 2 4 1"))
        clear = element("transparent", element("color", "1 1 1 0.5"), opaque="A_ONE") + element("transparency", element("float", "0.5"))
        dae.material("paint", common=element("phong", color + clear))
        dae.node("painted", "geometry", "triangle", material="paint")
        paint = self.convert(dae).json["materials"][1]
        self.assertEqual(paint["pbrMetallicRoughness"]["baseColorFactor"], [0.2, 0.4, 0.6, 0.25])
        self.assertEqual((paint["alphaMode"], paint["doubleSided"], paint["emissiveFactor"]), ("BLEND", True, [0.25, 0.5, 1.0]))
        self.assertEqual(paint["extensions"]["KHR_materials_emissive_strength"], {"emissiveStrength": 4.0})

    def test_opacity_that_is_no_number(self):
        number, color = element("float", "0.5"), element("color", "1 1 1 0.5")
        for clear, share, alpha in ((color, number, 0.25), (color, color, 0.5), (number, number, 1.0)):
            dae = one_triangle()
            dae.material("paint", common=element("phong", element("transparent", clear, opaque="A_ONE") + element("transparency", share)))
            dae.node("painted", "geometry", "triangle", material="paint")
            self.assertEqual(self.convert(dae).json["materials"][1]["pbrMetallicRoughness"]["baseColorFactor"][3], alpha)

    def test_area_lights(self):
        dae = one_triangle("Z_UP")
        dae.area_light("lamp", [4, 2, 1])
        dae.node("lamp", "light", "lamp", transforms=element("matrix", "0.6 0 0 1 0 0.8 0 2 0 0 1 3 0 0 0 1"))
        glb = self.convert(dae)
        lamp = self.node(glb, "lamp")
        corners = [transform(lamp, p) for p in glb.corners("POSITION", lamp["mesh"])]
        low, high = ([f(c) for c in zip(*corners)] for f in (min, max))
        self.assert_near([*low, *high], [-1.3, 3, 1.6, -0.7, 3, 2.4])
        a, b, c = corners[:3]
        # Towards -z of the file, which is down: the normal of each triangle's order.
        self.assertLess(dot([0, 1, 0], [(b[1] - a[1]) * (c[2] - a[2]) - (b[2] - a[2]) * (c[1] - a[1]),
                                        (b[2] - a[2]) * (c[0] - a[0]) - (b[0] - a[0]) * (c[2] - a[2]),
                                        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])]), 0.0)
        material = glb.json["materials"][glb.json["meshes"][lamp["mesh"]]["primitives"][0]["material"]]
        self.assertEqual((material["emissiveFactor"], material["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"]),
                         ([1.0, 0.5, 0.25], 4.0))
        self.assertNotIn("doubleSided", material)

    def test_a_mesh_takes_the_place_of_an_area_light(self):
        for size, radiance, kept, notices in ((0.5, [22, 19, 14], False, ()), (0.5, [1, 1, 1], False, ["emits 22 19 14 instead of 1 1 1"]),
                                              (0.25, [22, 19, 14], True, ())):
            dae = self.room_with_area_light(True, size, radiance)
            glb = self.convert(dae, notices=notices)
            self.assertEqual([node["name"] for node in glb.json["nodes"]].count("area"), int(kept))

    def room_with_area_light(self, with_mesh, size=0.5, radiance=(22, 19, 14)):
        document = cornell_mirror_glass()
        if not with_mesh:
            document.json["nodes"] = [node for node in document.json["nodes"] if node["name"] != "lamp"]
        dae = to_collada(document)
        dae.area_light("area", radiance)
        # Its x and y are the document's x and z; it shines down.
        dae.node("area", "light", "area", transforms=element("matrix", spaced_rows(size)))
        return dae

    def test_what_is_left_out(self):
        def with_library(text, name, content):
            return text.replace("<library_visual_scenes>", "<library_%s>%s</library_%s><library_visual_scenes>" % (name, content, name))
        text = one_triangle().text()
        self.convert(with_library(text, "animations", element("animation", id="wave")), notices=["<animation> \"wave\" is left out"])
        skin = element("skin", element("bind_shape_matrix", "1 0 0 5 0 1 0 0 0 0 1 0 0 0 0 1"), source="#triangle")
        text = with_library(text, "controllers", element("controller", skin, id="arm"))
        text = text.replace("instance_geometry url=\"#triangle\"", "instance_controller url=\"#arm\"")
        glb = self.convert(text.replace("</instance_geometry>", "</instance_controller>"),
                           notices=["<controller> \"arm\" of the node \"triangle\" is left out: the mesh keeps its shape"])
        self.assert_near(glb.json["nodes"][0]["matrix"][12:15], [5, 0, 0])
        lines = element("lines", element("input", semantic="VERTEX", source="#triangle-vertices", offset=0) + element("p", "0 1"), count=1)
        self.convert(one_triangle().text().replace("</mesh>", lines + "</mesh>"), notices=["the lines of \"triangle\" are left out"])

    def test_what_is_refused(self):
        good = one_triangle("Z_UP")
        good.camera("front", xfov=60, aspect_ratio=1.5)
        good.node("front", "camera", "front")
        good.material("glass", element("glass", element("transmittance", "1 1 1") + element("ior", "1.5")))
        good.sphere("ball", 0.5)
        good.node("ball", "geometry", "ball", material="glass")
        good = good.text()
        self.convert(good)
        bomb = "<!DOCTYPE COLLADA [<!ENTITY a \"aaaaaaaaaa\">%s]>" % "".join(
            "<!ENTITY %s \"%s\">" % (name, "&%s;" % before * 10) for before, name in zip("abcdefghi", "bcdefghij"))
        for old, new, sentence in (
                (good, "no XML at all", "model.dae, line 1: it is not XML (syntax error); expected Collada"),
                (good, "<svg/>", "model.dae: its root is <svg>; expected <COLLADA>"),
                (good, "", "it is not XML (no element found)"),
                ("</COLLADA>", "", "it is not XML (no element found)"),
                ("<COLLADA", bomb + "<COLLADA", "model.dae, line 2: it has a document type declaration; expected none"),
                ("<COLLADA", "<!DOCTYPE COLLADA SYSTEM \"file:///etc/passwd\"><COLLADA", "it has a document type declaration"),
                ("<library_cameras>", "<a>" * 300 + "</a>" * 300 + "<library_cameras>", "its elements are nested more than 200 deep"),
                ("<scene>", "<nothing>", "mismatched tag"),
                ("Z_UP", "UP", "<up_axis> is \"UP\"; expected X_UP, Y_UP or Z_UP"),
                ("meter=\"1\"", "meter=\"nan\"", "the meter of <unit> is \"nan\"; expected a number above 0"),
                ("0 1 2</p>", "0 1 3</p>", "of <geometry> \"triangle\" names element 3 of \"triangle-vertices\"; expected one below 3"),
                ("0 1 2</p>", "0 1 -1</p>", "names element -1"),
                ("0 1 2</p>", "0 1</p>", "holds 2 indices; expected 3, those of its <vcount>"),
                ("0 1 2</p>", "0 1 x</p>", "holds \"x\"; expected a whole number"),
                ("0 1 2</p>", "0 1 99999999999999999999</p>", "holds \"99999999999999999999\"; expected a whole number"),
                (">3</vcount>", ">4000000000</vcount>", "holds 3 indices; expected 4000000000"),
                (">3</vcount>", ">2 1</vcount>", "has a polygon of 1 corners; expected 3 or more"),
                (" count=\"1\">", " count=\"4000000000\">", "has 1 polygons; expected 4000000000, its count"),
                ("offset=\"0\"", "offset=\"4000000000\"", "holds 3 indices; expected a multiple of 4000000001"),
                ("count=\"9\"", "count=\"4000000000\"", "holds 9 numbers; expected 4000000000, its count"),
                ("count=\"3\" stride", "count=\"4\" stride", "reads 4 times 3 numbers; expected 9 in all"),
                ("stride=\"3\"", "stride=\"1\"", "skips numbers"),
                ("0 0 0 1 0 0 0 1 0", "0 0 0 1 0 0 0 1 nan", "holds \"nan\"; expected a finite number"),
                ("0 0 0 1 0 0 0 1 0", "0 0 0 1 0 0 0 1 1e39", "holds \"1e39\"; expected a finite number"),
                ("url=\"#triangle\"", "url=\"#square\"", "the url of <instance_geometry> is \"#square\"; expected # and the id of a <geo"),
                ("url=\"#triangle\"", "url=\"#front\"", "the url of <instance_geometry> is \"#front\""),
                ("url=\"#triangle\"", "url=\"other.dae#triangle\"", "is \"other.dae#triangle\"; expected # and the id"),
                ("url=\"#triangle\"", "", "the url of <instance_geometry> is \"\""),
                ("target=\"#glass\"", "target=\"#gone\"", "the target of <instance_material> is \"#gone\""),
                ("url=\"#glass-effect\"", "url=\"#gone\"", "the url of <instance_effect> is \"#gone\""),
                ("url=\"#scene\"", "url=\"#gone\"", "the url of <instance_visual_scene> is \"#gone\""),
                ("source=\"#triangle-positions\"", "source=\"#gone\"", "the source of <input> is \"#gone\""),
                ("<xfov>60", "<xfov>180", "<xfov> of <camera> \"front\" is 180; expected a number above 0 and below 180"),
                ("<xfov>60</xfov>", "", "<camera> \"front\" has neither <xfov> nor <yfov>"),
                ("<ior>1.5", "<ior>0.5", "<ior> of <material> \"glass\" is \"0.5\"; expected numbers from 1"),
                ("<ior>1.5</ior>", "", "<ior> of <material> \"glass\" is missing"),
                ("1 1 1</transmittance>", "1 1</transmittance>", "<transmittance> of <material> \"glass\" holds 2 numbers; expected 3"),
                ("<radius>0.5", "<radius>-1", "<radius> of <geometry> \"ball\" is -1; expected a number above 0"),
                ("<radius>0.5</radius>", "", "has no <radius>"),
                ("<matrix>-1", "<matrix>-2", "the node \"ball\" stretches a sphere"),
                ("<matrix>-1", "<matrix>inf", "<matrix> of <node> \"triangle-node\" holds \"inf\"; expected a finite number"),
                ("<instance_geometry url=\"#triangle\">", "<instance_node url=\"#triangle-node\"/><instance_geometry url=\"#triangle\">",
                 "and no node that instances itself")):
            self.assertIn(old, good)
            refusal = self.refusal(good.replace(old, new))
            self.assertTrue(refusal.startswith(self.path("model.dae")), refusal)
            self.assertIn(sentence, refusal)
            self.assertEqual(len(refusal.splitlines()), 1, refusal)

    def test_nodes_in_libraries_that_are_not_read(self):
        text = one_triangle().text()
        for url, sentence in (("#triangle", None), ("#gone", "the url of <instance_geometry> is \"#gone\"")):
            node = element("library_controllers", element("node", element("instance_geometry", url=url), id="hidden"))
            found = text.replace("<library_visual_scenes>", node + "<library_visual_scenes>").replace(
                "<instance_geometry url=\"#triangle\"></instance_geometry></node>\n", "<instance_node url=\"#hidden\"/></node>\n")
            self.assertIn("instance_node", found)
            if sentence is None:
                self.assertEqual(len(self.convert(found).json["nodes"]), 1)
            else:
                self.assertIn(sentence, self.refusal(found))

    def test_nodes_that_multiply(self):
        dae = one_triangle()
        dae.libraries["nodes"] = [element("node", element("instance_node", url="#n%d" % (i + 1)) * 10, id="n%d" % i) for i in range(9)]
        dae.libraries["nodes"].append(element("node", element("instance_geometry", url="#triangle"), id="n9"))
        dae.node("many", "node", "n0")
        text, begin = dae.text(), time.process_time()
        self.assertIn("more than %d nodes" % (10000 + len(text) // 4), self.refusal(text))
        self.assertLess(time.process_time() - begin, 2.0)

    def test_matrices_that_are_large_together(self):
        text = one_triangle(transforms=element("scale", "1e30 1e30 1e30") * 12).text()
        result = self.run_tool(text)
        self.assertEqual((result.returncode, result.stderr), (1, "to_gltf: %s: the matrix of <node> \"triangle-node\" and of those above it "
                                                              "is not finite in float32\n" % self.path("model.dae")))

    def test_one_line_whatever_the_file_holds(self):
        text = one_triangle().text().replace("triangle", "a\u009b31m" + "x" * 3000)
        for old, new, code in (("<COLLADA", "<COLLADA", 0), ("0 1 2</p>", "0 1 3</p>", 1)):
            lines = element("library_animations", element("animation", id="a&#10;b\u009b31m" + "x" * 3000)).replace("&amp;", "&")
            result = self.run_tool(text.replace(old, new).replace("<library_visual_scenes>", lines + "<library_visual_scenes>"))
            self.assertEqual(result.returncode, code)
            self.assertRegex(result.stderr, "^to_gltf: [ -~]{100,2100}\n$")

    def test_a_mesh_of_many_materials_is_written_once(self):
        dae = one_triangle()
        for name in ("red", "green", "blue"):
            dae.diffuse(name, [0.5, 0, 0])
            dae.node(name, "geometry", "triangle", material=name)
        glb = self.convert(dae)
        self.assertEqual((len(glb.json["meshes"]), len(glb.json["accessors"])), (4, 2))
        self.assertEqual(len({mesh["primitives"][0]["material"] for mesh in glb.json["meshes"]}), 4)

    def test_pictures_that_are_no_files(self):
        for name in ("/dev/zero", "a%00b", "/dev"):
            dae = ColladaDocument("Y_UP")
            image = ImageEmbedder(dae, self.notices.append).texture(os.path.join(self.folder.name, urllib.parse.unquote(name)), "a texture")
            self.assertIsNone(image)
            self.assertIn("a texture of a material is left out", self.notices.pop())

    def test_mutants(self):
        """By hand collada_mutants.py makes any number of them."""
        defects = []
        converted = collada_mutants.run(self.folder.name, 1000, 1, lambda text, defect: defects.append(defect))
        self.assertEqual(defects, [])
        self.assertGreater(converted, 100)

    @unittest.skipIf(GLIM is None, "no program of glim was named")
    def test_glim_draws_the_same_pictures(self):
        """The Cornell box with mirror and glass as glTF, as Collada, and with an area light instead of the mesh of its lamp."""
        def draw(model, camera, seed):
            film = self.path("%s.exr" % model)
            command = [GLIM, "render", self.path(model), "-o", film, "--camera", camera, "--size", "32x32", "--spp", "256", "--seed", seed]
            subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=True)
            return film
        cornell_mirror_glass().write(self.path("cornell.gltf"))
        reference = draw("cornell.gltf", "0", "1")
        for with_mesh in (True, False):
            self.convert(self.room_with_area_light(with_mesh))
            result = subprocess.run([GLIM, "compare", draw("model.glb", "1", "2"), reference, "--fail"], stdout=subprocess.PIPE,
                                    stderr=subprocess.STDOUT, text=True)
            self.assertEqual(result.returncode, 0, result.stdout)


def spaced_rows(size):
    return "%g 0 0 0 0 %g 0 0 0 0 1 1.99 0 0 0 1" % (size, size)


if __name__ == "__main__":
    unittest.main()
