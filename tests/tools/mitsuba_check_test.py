#!/usr/bin/env python3
"""tools/against_mitsuba.py and tools/flip.py without Mitsuba and FLIP: how a scene is read, what Mitsuba would be given, and the
figures of data whose answer is known."""

import math
import os
import struct
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

import numpy as np

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "tools"))

from mitsuba_check import figures, images, report, tables  # noqa: E402
from mitsuba_check.arguments import parse_arguments  # noqa: E402
from mitsuba_check.errors import CheckError  # noqa: E402
from mitsuba_check.meshes import SHEET_GAP, join, two_sheets  # noqa: E402
from mitsuba_check.materials import CLAMP, MIRRORED, REPEAT, Texture, read_material  # noqa: E402
from mitsuba_check.scene import Mesh, read_scene, solids_meet  # noqa: E402
from mitsuba_check.tangents import corner_tangents  # noqa: E402
from scene_makers.gltf_document import Document  # noqa: E402


def committed(name):
    return read_scene(os.path.join(ROOT, "scenes", name + ".gltf"))


def area_vectors(mesh):
    corners = mesh.positions[mesh.triangles]
    return 0.5 * np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])


class SceneTest(unittest.TestCase):
    def read(self, document):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "scene.glb")
            document.write(path)
            return read_scene(path)

    def test_the_cornell_box(self):
        scene = committed("cornell")
        self.assertEqual(sum(len(mesh.triangles) for mesh in scene.meshes), 5 * 2 + 2 + 2 * 12)
        lamp = [mesh for mesh in scene.meshes if scene.materials[mesh.material].emits]
        self.assertEqual(len(lamp), 1)
        np.testing.assert_allclose(area_vectors(lamp[0]).sum(axis=0), (0, -0.25, 0), atol=1e-7)
        np.testing.assert_allclose(scene.materials[lamp[0].material].emission, (22, 19, 14), rtol=1e-6)
        np.testing.assert_allclose(scene.materials[scene.meshes[3].material].base_color, (0.63, 0.065, 0.05))
        np.testing.assert_allclose(scene.camera.position, (0, 1, 3.95))
        np.testing.assert_allclose(scene.camera.forward, (0, 0, -1), atol=1e-12)
        self.assertAlmostEqual(math.degrees(scene.camera.yfov), 37.4)
        np.testing.assert_allclose(scene.bounds()[0], (0, 1, 0), atol=1e-6)
        self.assertAlmostEqual(scene.bounds()[1], math.sqrt(3), places=5)

    def test_spheres_mirror_and_glass(self):
        scene = committed("cornell_mirror_glass")
        mirror, glass = scene.spheres
        np.testing.assert_allclose(glass.center, (0.45, 0.36, 0.35))
        self.assertAlmostEqual(glass.radius, 0.35)
        self.assertEqual([scene.materials[s.material].kind() for s in (mirror, glass)], ["mirror", "glass"])
        self.assertEqual(scene.materials[glass.material].ior, 1.5)
        kinds = {m.kind() for m in committed("veach_mis").materials if m.base_color[0] == 0.35}
        self.assertEqual(kinds, {"principled"})

    def test_lights(self):
        point, spot, sun = (committed("light_" + kind).lights[0] for kind in ("point", "spot", "directional"))
        np.testing.assert_allclose(point.intensity, (8, 6.8, 5.2))
        np.testing.assert_allclose(point.position, (-0.5, 2, 0))
        np.testing.assert_allclose(spot.direction, (0, -1, 0), atol=1e-12)
        np.testing.assert_allclose(spot.cosines, np.cos(np.radians((18, 28))))
        np.testing.assert_allclose(sun.direction, (0.6, -0.8, 0), atol=1e-12)
        np.testing.assert_allclose(sun.intensity, (3, 2.85, 2.7))

    def test_nodes_turn_scale_and_mirror(self):
        document = Document()
        document.camera("front", (0, 0, 5), (0, 0, 0), 40, 1)
        mesh = document.mesh(document.primitive([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [0, 1, 2], document.material("grey")))
        child = document.append("nodes", {"mesh": mesh, "scale": [-2, 3, 1], "extras": {}})
        ball = document.append("nodes", {"translation": [1, 0, 0], "extras": {"sphere": {"radius": 0.5, "material": 0}}})
        half = math.sqrt(0.5)  # a quarter turn about z
        document.node("parent", children=[child, ball], translation=[5, 0, 0], rotation=[0, 0, half, half], scale=[2, 2, 2])
        scene = self.read(document)
        np.testing.assert_allclose(scene.meshes[0].positions, [[5, 0, 0], [5, -4, 0], [-1, 0, 0]], atol=1e-6)
        # Mirrored, so turned over again: the front still faces +z.
        np.testing.assert_allclose(area_vectors(scene.meshes[0]), [[0, 0, 12]], atol=1e-5)
        np.testing.assert_allclose(scene.spheres[0].center, (5, 2, 0), atol=1e-9)
        self.assertAlmostEqual(scene.spheres[0].radius, 1)

    def test_smooth_normals_go_with_the_inverse_transpose(self):
        document = Document()
        document.camera("front", (0, 0, 5), (0, 0, 0), 40, 1)
        slanted = document.primitive([[0, 0, 0], [1, 0, -1], [0, 1, 0]], [0, 1, 2], document.material("grey"))
        slanted["attributes"]["NORMAL"] = document.positions([[half := math.sqrt(0.5), 0, half]] * 3)
        document.node("wide", mesh=document.mesh(slanted), scale=[2, 1, 1])
        mesh = self.read(document).meshes[0]
        geometric = area_vectors(mesh)[0] / np.linalg.norm(area_vectors(mesh)[0])
        np.testing.assert_allclose(mesh.normals, [geometric] * 3, atol=1e-6)

    def test_what_is_refused(self):
        for name, part in (("stretched_sphere.gltf", "expected a uniform scale"),
                           ("required_extension.gltf", "requires KHR_gaussian_splatting_compression_spz"),
                           ("environment_map.gltf", "sky.exr, which cannot be read"), ("not_json.gltf", "is not glTF 2.0"),
                           ("missing_buffer.gltf", "cannot be read"), ("odd_component.gltf", "which is not exported"),
                           ("no_such_accessor.gltf", "is not glTF 2.0"),
                           ("nowhere.gltf", "cannot be read (No such file")):
            with self.assertRaises(CheckError, msg=name) as caught:
                read_scene(os.path.join(ROOT, "scenes", "refused", name))
            self.assertIn(part, str(caught.exception))
            self.assertIn(name, str(caught.exception))

    def test_materials_that_are_refused(self):
        document = Document()
        document.camera("front", (0, 0, 5), (0, 0, 0), 40, 1)
        prism = document.material("prism", ior=1.5)
        document.json["materials"][prism]["extensions"]["KHR_materials_dispersion"] = {"dispersion": 1}
        document.sphere("ball", (0, 0, 0), 1, prism)
        with self.assertRaisesRegex(CheckError, "uses KHR_materials_dispersion, which is not exported"):
            self.read(document)

    def test_texture_coordinates_colours_and_normalised_numbers(self):
        document = Document()
        document.camera("front", (0, 0, 5), (0, 0, 0), 40, 1)
        flat = document.primitive([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [0, 1, 2], document.material("grey"))

        def rows(code, kind, values, component, **more):
            return document.append("accessors", {"bufferView": document.view(struct.pack("<%d%s" % (len(values), code), *values)),
                                                 "componentType": component, "count": 3, "type": kind, **more})
        flat["attributes"]["TEXCOORD_1"] = rows("H", "VEC2", [0, 0, 65535, 0, 0, 13107], 5123, normalized=True)
        flat["attributes"]["COLOR_0"] = rows("f", "VEC3", [0, 1, 2, 1, 1, 1, 0.5, 0.5, 0.5], 5126)
        document.node("flat", mesh=document.mesh(flat))
        mesh = self.read(document).meshes[0]
        self.assertIsNone(mesh.uvs[0])
        np.testing.assert_allclose(mesh.uvs[1], [[0, 0], [1, 0], [0, 0.2]])
        np.testing.assert_allclose(mesh.colors, [[0, 1, 1, 1], [1, 1, 1, 1], [0.5, 0.5, 0.5, 1]])
        self.assertIsNone(mesh.tangents)

    def test_solids_that_meet(self):
        scene = committed("cornell_gems")
        self.assertFalse(solids_meet(scene))
        document = Document()
        document.camera("front", (0, 0, 5), (0, 0, 0), 40, 1)
        document.sphere("glass", (0, 0, 0), 1, document.material("glass", ior=1.5))
        document.sphere("drop", (0, 0, 0), 0.5, document.material("water", ior=1.33))
        self.assertTrue(solids_meet(self.read(document)))
        self.assertTrue(solids_meet(committed("sun_water")))  # a floor and a camera in water that absorbs

    def test_lamps_that_mitsuba_has_not(self):
        def lamp(**more):
            document = Document()
            document.camera("within", (0, 0, 0.5), (0, 0, 0), 40, 1)
            document.sphere("lamp", (0, 0, 0), 1, document.material("lamp", emission=[1, 1, 1], **more))
            return document
        self.assertEqual(len(self.read(lamp()).spheres), 1)
        with self.assertRaisesRegex(CheckError, "within a sphere that emits inwards"):
            self.read(lamp(double_sided=True))
        with self.assertRaisesRegex(CheckError, "glass that emits"):
            self.read(lamp(ior=1.5))
        coated = lamp()
        coated.json["materials"][0].setdefault("extensions", {})["KHR_materials_clearcoat"] = {"clearcoatFactor": 1}
        with self.assertRaisesRegex(CheckError, "under a clearcoat"):
            self.read(coated)
        self.assertEqual(len(committed("many_lights").spheres), 256)


class MeshesTest(unittest.TestCase):
    def test_two_sheets_face_away_from_each_other(self):
        points = np.array([[0, 0, 0], [2, 0, 0], [0, 2, 0]], float)
        uv = np.array([[0, 0], [1, 0], [0, 1]], float)
        sheets = two_sheets(Mesh(0, points, np.array([[0, 1, 2]]), uvs=[uv, None]))
        np.testing.assert_array_equal(sheets.uvs[0], np.concatenate([uv, uv[::-1]]))
        np.testing.assert_allclose(area_vectors(sheets), [[0, 0, 2], [0, 0, -2]])
        heights = sheets.positions[sheets.triangles][:, :, 2]
        np.testing.assert_allclose(heights, [[SHEET_GAP] * 3, [-SHEET_GAP] * 3])  # half of a gap of .001 sqrt(4)

    def test_joined_meshes_keep_their_triangles(self):
        one = Mesh(0, np.zeros((3, 3)), np.array([[0, 1, 2]], np.uint32))
        two = Mesh(0, np.ones((4, 3)), np.array([[0, 1, 2], [0, 2, 3]], np.uint32))
        both = join([one, two])
        self.assertEqual(len(both.positions), 7)
        np.testing.assert_array_equal(both.triangles, [[0, 1, 2], [3, 4, 5], [3, 5, 6]])


class MaterialTest(unittest.TestCase):
    JSON = {"textures": [{"source": 3, "sampler": 0}, {"source": 4}, {}],
            "samplers": [{"wrapS": 33648, "wrapT": 33071, "minFilter": 9984}]}

    def read(self, **entry):
        return read_material(self.JSON, entry)

    def extended(self, name, **properties):
        return self.read(extensions={"KHR_materials_" + name: properties})

    def test_defaults_are_those_of_the_specification(self):
        m = self.read()
        self.assertEqual((m.base_color, m.alpha, m.metallic, m.roughness, m.ior, m.specular), ([1, 1, 1], 1, 1, 1, 1.5, 1))
        self.assertEqual((m.alpha_mode, m.alpha_cutoff, m.double_sided, m.normal_scale), ("OPAQUE", 0.5, False, 1))
        self.assertEqual((m.clearcoat_roughness, m.sheen_roughness, m.iridescence_ior), (0, 0, 1.3))
        self.assertEqual(m.iridescence_thickness, (100, 400))
        self.assertFalse(m.emits or m.layered or m.solid or m.glossy or m.textures or m.unlit)

    def test_kinds(self):
        metal = {"baseColorFactor": [1, 0.5, 0.5, 1], "roughnessFactor": 0.03}
        self.assertEqual(self.read(pbrMetallicRoughness=metal).kind(), "mirror")
        self.assertEqual(self.read(pbrMetallicRoughness={**metal, "roughnessFactor": 0.04}).kind(), "principled")
        self.assertEqual(self.read(pbrMetallicRoughness=metal).kind(colored=True), "principled")
        self.assertEqual(self.read(pbrMetallicRoughness={"metallicFactor": 0}).kind(), "principled")
        black = {"KHR_materials_specular": {"specularFactor": 0}}
        self.assertEqual(self.read(pbrMetallicRoughness={"metallicFactor": 0}, extensions=black).kind(), "lambert")
        glass = {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_volume": {"thicknessFactor": 1}}
        smooth = {"metallicFactor": 0, "roughnessFactor": 0}
        self.assertEqual(self.read(pbrMetallicRoughness=smooth, extensions=glass).kind(), "glass")
        del glass["KHR_materials_volume"]
        thin = self.read(pbrMetallicRoughness=smooth, extensions=glass)
        self.assertEqual((thin.kind(), thin.passes_straight, thin.lets_through), ("principled", True, True))
        self.assertTrue(self.read(alphaMode="MASK").lets_through)
        self.assertFalse(self.read().lets_through)
        self.assertFalse(self.read(pbrMetallicRoughness={**smooth, "roughnessFactor": 0.5}, extensions=glass).passes_straight)

    def test_textures(self):
        moved = {"index": 0, "texCoord": 0, "extensions": {"KHR_texture_transform": {
            "offset": [0.1, 0.2], "scale": [2, 3], "rotation": math.pi / 2, "texCoord": 1}}}
        texture = self.read(normalTexture=moved).textures["normalTexture"]
        self.assertEqual((texture.image, texture.uv_set, texture.wraps, texture.nearest), (3, 1, (MIRRORED, CLAMP), True))
        np.testing.assert_allclose(texture.transform, [[0, 3, 0.1], [-2, 0, 0.2]], atol=1e-15)
        plain = self.read(normalTexture={"index": 1, "scale": 0.5})
        self.assertEqual((plain.normal_scale, plain.textures["normalTexture"]), (0.5, Texture(4)))
        self.assertEqual(self.read(normalTexture={"index": 2}).textures, {})
        # Of a layer that is not there, no texture is read either.
        self.assertEqual(self.extended("sheen", sheenRoughnessTexture={"index": 1}).textures, {})
        self.assertEqual(set(self.extended("clearcoat", clearcoatFactor=1, clearcoatNormalTexture={"index": 1, "scale": 2}).textures),
                         {"clearcoatNormalTexture"})

    def test_volumes_need_transmission(self):
        volume = {"KHR_materials_volume": {"thicknessFactor": 1, "attenuationDistance": 0.5, "attenuationColor": [1, 0.5, 0]}}
        self.assertFalse(self.read(extensions=volume).solid)
        found = self.read(extensions={**volume, "KHR_materials_transmission": {"transmissionFactor": 1}})
        self.assertTrue(found.solid)
        np.testing.assert_allclose(found.absorption, [0, 2 * math.log(2), 2 * math.log(1e6)])

    def test_glossiness_replaces_metal_and_roughness(self):
        entry = {"diffuseFactor": [0.1, 0.2, 0.3, 0.4], "glossinessFactor": 0.7, "specularFactor": [0.5, 0.6, 0.7],
                 "specularGlossinessTexture": {"index": 1}}
        m = self.read(pbrMetallicRoughness={"metallicRoughnessTexture": {"index": 0}},
                      extensions={"KHR_materials_pbrSpecularGlossiness": entry})
        self.assertTrue(m.glossy)
        self.assertEqual((m.base_color, m.alpha, m.metallic, m.roughness, m.ior), ([0.1, 0.2, 0.3], 0.4, 0, 0.7, 0))
        self.assertEqual(m.textures, {"specularColorTexture": Texture(4)})

    def test_tangents_follow_the_normal_map(self):
        self.assertIsNone(self.read().tangent_set())
        self.assertEqual(self.read(normalTexture={"index": 1, "texCoord": 1}).tangent_set(), 1)
        self.assertEqual(self.extended("anisotropy", anisotropyStrength=0.5).tangent_set(), 0)


class ImagesTest(unittest.TestCase):
    def test_pixels_become_linear_rgba(self):
        grey = np.array([[[0], [128], [255]]], np.uint8)
        np.testing.assert_allclose(images.to_linear(grey, "normalTexture")[0, 1], [128 / 255] * 3 + [1])
        np.testing.assert_allclose(images.to_linear(grey, "baseColorTexture")[0, 1], [0.2158605] * 3 + [1], rtol=1e-6)
        deep = np.array([[[65535, 0, 32768, 13107]]], np.uint16)
        np.testing.assert_allclose(images.to_linear(deep, "sheenRoughnessTexture")[0, 0], [1, 0, 32768 / 65535, 0.2])

    def look_up(self, pixels, wrap, t):
        """As a lookup that clamps does it, along a row."""
        row = images.padded(pixels[None, :, None], (wrap, CLAMP))[0, :, 0]
        place = np.clip(images.wrapped(t, len(pixels), wrap, math.floor) * len(row) - 0.5, 0, len(row) - 1)
        low = min(int(place), len(row) - 2)
        return row[low] + (row[low + 1] - row[low]) * (place - low)

    def test_wrapping(self):
        pixels = np.array([1.0, 2.0, 4.0, 8.0])
        for wrap, at_rim, beyond in ((REPEAT, 4.5, 1.0), (CLAMP, 1.0, 8.0), (MIRRORED, 1.0, 8.0)):
            self.assertAlmostEqual(self.look_up(pixels, wrap, 0.0), at_rim)
            self.assertAlmostEqual(self.look_up(pixels, wrap, 1.125), beyond)
            self.assertAlmostEqual(self.look_up(pixels, wrap, 0.5), 3.0)
        self.assertAlmostEqual(self.look_up(pixels, MIRRORED, -0.375), 2.0)
        self.assertAlmostEqual(self.look_up(pixels, REPEAT, -3.625), 2.0)

    def test_rows_for_mitsuba_are_the_same_lines(self):
        """At the angle pi t, a map of texel-centred rows and one whose outermost rows lie at the poles."""
        rows = np.random.default_rng(1).random(5)

        def at(values, place):
            place = np.clip(place, 0, len(values) - 1)
            low = np.minimum(place.astype(int), len(values) - 2)
            return values[low] + (values[low + 1] - values[low]) * (place - low)
        made, t = images.rows_for_mitsuba(rows[:, None, None])[:, 0, 0], np.linspace(0, 1, 401)
        np.testing.assert_allclose(at(made, t * (len(made) - 1)), at(rows, t * 5 - 0.5), atol=1e-12)
        self.assertEqual(images.rows_for_mitsuba(np.ones((1, 1, 3))).shape, (3, 1, 3))


class TangentsTest(unittest.TestCase):
    def test_along_rising_u(self):
        positions = np.array([[[0, 0, 0], [2, 0, 0], [2, 1, 0]]], float)
        up = np.broadcast_to([0.0, 0.0, 1.0], (1, 3, 3))
        for uv, tangent, sign in (([[0, 1], [1, 1], [1, 0]], (1, 0, 0), 1), ([[1, 1], [0, 1], [0, 0]], (-1, 0, 0), -1),
                                  ([[0, 0], [0, 1], [1, 1]], (0, 1, 0), 1)):
            found = corner_tangents(positions, up, np.array([uv], float))
            np.testing.assert_allclose(found, [[(*tangent, sign)] * 3], atol=1e-12)
            # glTF's bitangent runs along falling v.
            step = np.linalg.lstsq(np.array(uv[1:], float) - uv[0], (positions[0, 1:] - positions[0, 0])[:, :2], rcond=None)[0]
            bitangent = np.cross(up[0, 0], found[0, 0, :3]) * found[0, 0, 3]
            self.assertLess(bitangent[:2] @ step[1], 0)

    def test_common_corners_share_a_tangent(self):
        positions = np.array([[[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 0, 0], [0, 1, 0], [-1, 0, -1]]], float)
        normals = np.broadcast_to(np.array([-1, 0, 2]) / math.sqrt(5), (2, 3, 3))
        uv = np.array([[[0, 0], [1, 0], [0, 1]], [[0, 0], [0, 1], [-1, 0]]], float)
        found = corner_tangents(positions, normals, uv)
        np.testing.assert_allclose(found[0, 0], found[1, 0])
        np.testing.assert_allclose(np.sum(found[..., :3] * normals, axis=-1), 0, atol=1e-12)
        mirrored = corner_tangents(positions, normals, uv * [[[1, 1]], [[-1, 1]]])
        self.assertEqual([mirrored[0, 0, 3], mirrored[1, 0, 3]], [-1, 1])


class TablesTest(unittest.TestCase):
    def test_albedos_of_the_oracle(self):
        rows, means = tables.ggx_table(0.5, 0.5)
        self.assertEqual((rows.shape, means.shape), ((1, tables.COSINES, 2), (1, 2)))
        mu = tables.cosines()
        of_cells = 0.5 * np.diff(mu ** 2)[:, None] * (rows[0, 1:] + rows[0, :-1])
        np.testing.assert_allclose(of_cells.sum(axis=0), means[0], rtol=2e-3)
        smooth = tables.ggx_row(0.0)[0]
        np.testing.assert_allclose(smooth[:, 1], (1 - mu) ** 5, atol=1e-3)
        self.assertEqual(len(tables.rows_between(0.2, 0.6)), tables.ROUGHNESSES)


class StackTest(unittest.TestCase):
    """The numbers that the integrator works with, as whole numbers instead of Dr.Jit's."""

    def setUp(self):
        module = mock.MagicMock()
        with mock.patch.dict(sys.modules, {"mitsuba": module, "drjit": module}):
            sys.modules.pop("mitsuba_check.integrator", None)
            from mitsuba_check import integrator
        self.integrator = integrator

    def test_media_are_left_in_any_order(self):
        enter, innermost = self.integrator.entered, self.integrator.innermost

        def leave(stack, medium):
            return self.integrator.left(stack, medium, lambda condition, a, b: a if condition else b)
        stack = enter(enter(enter(0, 1), 2), 3)
        self.assertEqual(innermost(stack), 3)
        self.assertEqual(leave(stack, 2), enter(enter(0, 1), 3))
        self.assertEqual(leave(leave(stack, 3), 1), enter(0, 2))
        self.assertEqual(leave(stack, 4), stack)
        twice = enter(enter(0, 5), 5)
        self.assertEqual(leave(twice, 5), enter(0, 5))
        full = enter(enter(stack, 4), 5)
        self.assertEqual(leave(leave(leave(leave(full, 5), 4), 3), 2), 0)


class BuildSceneTest(unittest.TestCase):
    def build(self, name, **more):
        module = mock.MagicMock()
        module.load_dict, module.traverse = lambda entry: entry, lambda _mesh: {}
        with mock.patch.dict(sys.modules, {"mitsuba": module}):
            sys.modules.pop("mitsuba_check.build_scene", None)
            from mitsuba_check.build_scene import build_scene
            return build_scene(committed(name), (64, 32), 5, **more)

    def test_the_camera_and_the_bounces(self):
        entries = self.build("cornell")
        self.assertEqual(entries["integrator"], {"type": "path", "max_depth": 6})
        self.assertAlmostEqual(entries["sensor"]["fov"], 37.4)
        self.assertEqual(entries["sensor"]["fov_axis"], "y")
        self.assertEqual((entries["sensor"]["film"]["width"], entries["sensor"]["film"]["height"]), (64, 32))
        self.assertEqual(sum(key.startswith("mesh") for key in entries), 4)  # white, red, green, lamp
        lamps = self.build("many_lights")
        self.assertEqual(sum(key.startswith("mesh") for key in lamps), 2 + 768)
        self.assertEqual(sum(key.startswith("sphere") for key in lamps), 256)

    def test_materials_and_lights(self):
        entries = self.build("cornell_mirror_glass", environment=[1, 2, 3])
        self.assertEqual(entries["sphere_0"]["bsdf"]["type"], "schlick_mirror")
        self.assertEqual(entries["sphere_1"]["bsdf"]["int_ior"], 1.5)
        self.assertEqual(entries["environment"]["radiance"]["value"], [1, 2, 3])
        self.assertEqual(self.build("light_point")["light_0"]["intensity"]["value"], [8, 6.8, 5.2])
        self.assertEqual(self.build("light_directional")["light_0"]["type"], "directional")
        self.assertAlmostEqual(self.build("light_spot")["light_0"]["cos_inner"], math.cos(math.radians(18)))


def two_sided_tail(t, freedom):
    """Of Student's t, by the midpoint rule on u = atan(x / sqrt(freedom)): the density is then a power of its cosine."""
    def integral(low, high, steps=20000):
        return sum(math.cos(low + (i + 0.5) * (high - low) / steps) ** (freedom - 1) for i in range(steps)) * (high - low) / steps
    place = math.atan(t / math.sqrt(freedom))
    return integral(place, math.pi / 2) / integral(0, math.pi / 2)


class FiguresTest(unittest.TestCase):
    def renders(self, seed, scale=1.0, noise=0.2, seeds=8, height=40, width=52):
        source = np.random.default_rng(seed)
        truth = 1 + 0.5 * np.sin(np.arange(height * width * 3)).reshape(height, width, 3)
        return scale * truth + noise * source.standard_normal((seeds, height, width, 3))

    def test_students_t_as_a_normal_deviate(self):
        for freedom in (7, 10, 14):
            for t in (0.5, 2.0, 4.0, 6.0):
                expected = -figures.NormalDist().inv_cdf(0.5 * two_sided_tail(t, freedom))
                self.assertAlmostEqual(float(figures.normal_of_student(t, freedom)), expected, delta=0.005 * expected)

    def test_blocks_hold_all_pixels(self):
        renders = self.renders(1, height=9, width=17)
        sums = figures.block_sums(renders)
        self.assertEqual(sums.shape, (8, 2 * 3, 3))
        np.testing.assert_allclose(sums.sum(axis=1), renders.sum(axis=(1, 2)))
        np.testing.assert_allclose(sums[:, 1], renders[:, :8, 8:16].sum(axis=(1, 2)))

    def test_the_verdict_on_noise_alone(self):
        wrong, squares = 0, []
        for seed in range(100):
            test = figures.test_bias(self.renders(2 * seed), self.renders(2 * seed + 1), 1)["z_test"]
            wrong += not test["agree"]
            squares.append(test["mean_square"])
        self.assertLessEqual(wrong, 8)  # two families of 1 %: more than 8 of 100 with probability 2e-4
        self.assertAlmostEqual(np.mean(squares), 1, delta=0.05)  # 10,500 squares: standard deviation .014, and Wallace's error

    def test_the_verdict_on_a_bias(self):
        biased, other = self.renders(1, scale=1.01), self.renders(2)
        found = figures.test_bias(biased, other, 1)
        self.assertFalse(found["z_test"]["agree"])
        self.assertLess(found["ratio"]["all"]["low"], 1.01)
        self.assertGreater(found["ratio"]["all"]["low"], 1)
        # Noise .2 over 2,080 pixels and 8 seeds, twice, around 1: (2.93 + 1.64) .2 sqrt(2 / 16,640), and
        # some 15 % more as the largest of three estimates with 14 degrees of freedom.
        self.assertAlmostEqual(found["z_test"]["detectable_bias"], 0.0100, delta=0.005)
        corner = self.renders(3)
        corner[:, 8:16, 16:24, 1] *= 1.2
        found = figures.test_bias(corner, other, 1)["z_test"]
        self.assertFalse(found["agree"])
        self.assertEqual([found["worst_block"][key] for key in ("x", "y", "channel")], [16, 8, "G"])

    def test_rounding_is_no_bias_and_without_noise_the_rest_is(self):
        same = self.renders(1, noise=0)
        self.assertTrue(figures.test_bias(same * (1 + 2e-7), same, 1)["z_test"]["agree"])
        self.assertFalse(figures.test_bias(same * (1 + 2e-6), same, 1)["z_test"]["agree"])
        # What Mitsuba's film makes of samples of .7, whose sum is taken in float32.
        added = np.cumsum(np.full(1024, 0.7, np.float32), dtype=np.float32)[-1] / 1024.0 / np.float32(0.7)
        self.assertGreater(abs(added - 1), figures.ROUNDING)
        self.assertFalse(figures.test_bias(same * added, same, 1)["z_test"]["agree"])
        self.assertTrue(figures.test_bias(same * added, same, 1024)["z_test"]["agree"])
        flat = np.ones((8, 16, 16, 3))
        found = figures.test_bias(1.5 * flat, flat, 1)["z_test"]
        self.assertGreater(min(found["mean_z"]), 10)
        self.assertFalse(found["agree"])

    def test_ratio_intervals_cover(self):
        source, inside = np.random.default_rng(4), 0
        for _ in range(2000):
            found = figures.ratio_of(source.normal(3, 0.3, 8), source.normal(2, 0.1, 8))
            inside += found["low"] <= 1.5 <= found["high"]
        self.assertAlmostEqual(inside / 2000, 0.95, delta=0.02)  # standard error .5 %

    def test_errors_and_time_to_equal_error(self):
        quiet, loud = self.renders(1, noise=0.1), self.renders(2, noise=0.2)
        flat = np.full(quiet.shape[1:], 2.0)
        errors = figures.relative_errors(quiet, flat)
        # 49,920 squares: .6 %. eps is .01 mean^2.
        self.assertAlmostEqual(errors.mean(), 0.01 / (4 + 0.04), delta=0.03 * 0.01 / 4.04)
        seconds = np.linspace(0.9, 1.1, 8)
        seconds[3] = 50  # an interruption
        found = figures.compare_renders(quiet, seconds, loud, 3 * seconds, 1)["time_to_equal_error"]
        self.assertAlmostEqual(found["value"], 12, delta=0.5)
        self.assertTrue(10 < found["low"] < 12 < found["high"] < 14, found)

    def test_a_perfect_picture_has_no_ratio_of_times(self):
        same = np.ones((8, 16, 16, 3))
        found = figures.compare_renders(same, np.ones(8), same, np.ones(8), 1)
        self.assertEqual(found["time_to_equal_error"], {"value": None, "low": None, "high": None})
        self.assertEqual(report.with_interval(found["time_to_equal_error"], "value", "%g"), "unknown")
        self.assertTrue(found["z_test"]["agree"])


class CommandTest(unittest.TestCase):
    def run_without(self, module, script, *arguments):
        code = ("import runpy, sys; sys.modules[%r] = None; sys.argv = sys.argv[1:]; sys.path.insert(0, %r); "
                "runpy.run_path(sys.argv[0], run_name='__main__')" % (module, os.path.join(ROOT, "tools")))
        path = os.path.join(ROOT, "tools", script)
        return subprocess.run([sys.executable, "-B", "-c", code, path, *arguments], capture_output=True, text=True, check=False)

    def test_missing_packages_are_one_sentence(self):
        exr = os.path.join(ROOT, "scenes", "nowhere.exr")
        for module, script, arguments, part in (
                ("mitsuba", "against_mitsuba.py", ["scenes/cornell.gltf"], "pip install mitsuba numpy"),
                ("mitsuba", "efficiency", ["scenes/cornell.gltf"], "pip install mitsuba numpy"),
                ("flip_evaluator", "flip.py", [exr, exr], "pip install flip-evaluator")):
            done = self.run_without(module, script, *arguments)
            self.assertEqual(done.returncode, 1)
            self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)
            self.assertIn(part, done.stderr)

    def test_usage(self):
        for arguments in ([], ["a.gltf", "--seeds", "7"], ["a.gltf", "--size", "0x4"], ["a.gltf", "--spp", "1.5"],
                          ["a.gltf", "--environment", "1,2"], ["a.gltf", "--unknown"]):
            with self.assertRaises(SystemExit) as caught, mock.patch("sys.stderr"):
                parse_arguments(arguments)
            self.assertEqual(caught.exception.code, 2, arguments)
        options = parse_arguments(["a.gltf", "--size", "64x48", "--environment", ".5,1,2.5"])
        self.assertEqual((options.size, options.environment, options.spp, options.seeds), ((64, 48), [0.5, 1, 2.5], 64, 8))

    def test_small_and_distant_scenes_are_warned_of(self):
        self.assertIsNone(report.warn_of_size(np.zeros(3), 1.0))
        self.assertIn("scale it to about one metre", report.warn_of_size(np.zeros(3), 0.01))
        self.assertIn("scale it to about one metre", report.warn_of_size(np.array([0, 1000, 0]), 1.0))


if __name__ == "__main__":
    unittest.main()
