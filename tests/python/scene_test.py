#!/usr/bin/env python3
"""Scenes from Python: nodes, materials, lights and cameras by name, additions, arrays as maps, several pictures, types of options."""

import base64
import gc
import inspect
import json
import math
import os
import re
import shutil
import subprocess
import sys
import typing
import unittest

import numpy as np
from python_case import GLIM, ROOT, PythonCase, glim, run_python, scene

LAMP = scene("light_point")  # cameras front and above, floor, ball, and a bulb
SMALL = {"size": (16, 12), "spp": 4}


def written_anew(test, change):
    """The picture of the lamp's file after `change` of its document."""
    with open(LAMP, encoding="utf-8") as file:
        document = json.load(file)
    change(document)
    for buffer in document["buffers"]:
        if not buffer["uri"].startswith("data:"):
            shutil.copy(os.path.join(os.path.dirname(LAMP), buffer["uri"]), test.folder)
    with open(test.path("changed.gltf"), "w", encoding="utf-8") as file:
        json.dump(document, file)
    return glim.render(test.path("changed.gltf"), **SMALL)


class ElementsTest(PythonCase):
    def setUp(self):
        super().setUp()
        self.lamp = glim.load(LAMP, **SMALL)

    def expect_same(self, edit, change):
        """The edit's picture is that of a file with the value, and another than before."""
        before = self.lamp.render()
        edit(self.lamp)
        after = self.lamp.render()
        self.assertNotEqual(after.pixels_digest, before.pixels_digest)
        self.assertEqual(after.pixels_digest, written_anew(self, change).pixels_digest)
        self.lamp.reset()
        self.assertEqual(self.lamp.render().digest, before.digest)

    def test_are_found_by_name_and_index(self):
        nodes = self.lamp.nodes
        self.assertEqual(nodes.names, ["front", "above", "floor", "ball", "bulb"])
        self.assertEqual([node.name for node in nodes], nodes.names)
        self.assertEqual((len(nodes), nodes["ball"].index, nodes[3].name, nodes[-1].name), (5, 3, "ball", "bulb"))
        self.assertEqual(nodes["ball"], nodes[np.int64(3)])
        self.assertTrue("ball" in nodes and "cube" not in nodes)
        self.assertEqual(self.lamp.materials.names, ["grey", "white"])
        self.assertEqual([light.kind for light in self.lamp.lights], ["point"])
        self.assertEqual([camera.kind for camera in self.lamp.cameras], ["perspective", "orthographic"])
        self.assertEqual(self.lamp.lights[0].nodes, [nodes["bulb"]])
        self.assertEqual(self.lamp.cameras["above"].nodes, [nodes["above"]])
        self.assertEqual(nodes["ball"].pointer, "/nodes/3")

    def test_unknown_ones_are_refused(self):
        for key, words in (("bal", "^nodes: cannot use 'bal', expected one of \"ball\"$"),
                           ("cube", "^nodes: cannot use 'cube', expected one of \"front\", \"above\", \"floor\", \"ball\", \"bulb\"$"),
                           (5, "^nodes: cannot use 5, expected an index from 0 to 4, or a name$"), (-6, "index from 0 to 4"),
                           (1.5, "expected an index or a name"), (None, "expected an index or a name")):
            with self.assertRaisesRegex(glim.InputError, words):
                self.lamp.nodes[key]
        with self.assertRaisesRegex(glim.InputError, "missing.gltf: cannot be"):
            glim.load(self.path("missing.gltf")).nodes[0]
        written_anew(self, lambda document: document["nodes"][3].update(name="floor"))
        with self.assertRaisesRegex(glim.InputError, "^nodes: cannot use 'floor', expected an index, as 2 elements have this name: 2, 3$"):
            glim.load(self.path("changed.gltf")).nodes["floor"]

    def test_nodes_are_hidden_and_moved(self):
        def hide(document):
            document["nodes"][3]["extensions"] = {"KHR_node_visibility": {"visible": False}}
        self.expect_same(lambda lamp: setattr(lamp.nodes["ball"], "visible", False), hide)
        self.expect_same(lambda lamp: setattr(lamp.nodes["ball"], "translation", (0, 1, 0)),
                         lambda document: document["nodes"][3].update(translation=[0, 1, 0]))
        self.expect_same(lambda lamp: setattr(lamp.nodes["floor"], "scale", np.array([.5, 1, 1])),
                         lambda document: document["nodes"][2].update(scale=[.5, 1, 1]))
        self.expect_same(lambda lamp: setattr(lamp.nodes["floor"], "rotation", (0, 0, 2, 14)),
                         lambda document: document["nodes"][2].update(rotation=[0, 0, 2 / math.sqrt(200), 14 / math.sqrt(200)]))

    def test_matrices_and_parts_replace_each_other(self):
        """In files that have the one and in those that have the other."""
        turn = np.array([[0, 0, -2, .5], [0, 2, 0, .75], [2, 0, 0, .25], [0, 0, 0, 1]], float)
        for name in ("ball", "front"):  # with a translation, and with a matrix
            node = self.lamp.nodes[name]
            before = node.matrix
            node.matrix = turn
            np.testing.assert_array_equal(node.matrix, turn)
            np.testing.assert_allclose(node.translation, (.5, .75, .25))
            np.testing.assert_allclose(node.scale, (2, 2, 2))
            np.testing.assert_allclose(np.abs(node.rotation), (0, math.sqrt(.5), 0, math.sqrt(.5)), atol=1e-12)
            node.translation = (1, 2, 3)
            turned = turn.copy()
            turned[:3, 3] = 1, 2, 3
            np.testing.assert_allclose(node.matrix, turned, atol=1e-12)
            node.matrix = before.tolist()
            np.testing.assert_array_equal(node.matrix, before)
            self.lamp.reset()
            np.testing.assert_array_equal(node.matrix, before)
        self.expect_same(lambda lamp: setattr(lamp.nodes["ball"], "matrix", turn),
                         lambda document: (document["nodes"][3].pop("translation"),
                                           document["nodes"][3].update(matrix=turn.T.ravel().tolist())))
        ball = self.lamp.nodes["ball"]
        ball.rotation = 0, 0, 3, 3
        self.assertEqual(ball.rotation, (0, 0, 3, 3))
        np.testing.assert_allclose(ball.matrix[:3, :3], [[0, -1, 0], [1, 0, 0], [0, 0, 1]], atol=1e-15)
        shear = np.eye(4)
        shear[0, 1] = 1
        self.lamp.nodes["floor"].matrix = shear
        with self.assertRaisesRegex(glim.InputError, "^scale: /nodes/2 has a matrix that shears"):
            self.lamp.nodes["floor"].scale
        with self.assertRaisesRegex(glim.InputError, "shears, flattens or projects"):
            self.lamp.nodes["floor"].scale = (1, 1, 1)
        np.testing.assert_array_equal(self.lamp.nodes["floor"].matrix, shear)

    def test_materials_lights_and_cameras_have_other_values(self):
        def factors(**values):
            return lambda document: document["materials"][0]["pbrMetallicRoughness"].update(values)
        self.expect_same(lambda lamp: setattr(lamp.materials["grey"], "base_color", (.9, .1, .2)),
                         factors(baseColorFactor=[.9, .1, .2, 1]))
        self.expect_same(lambda lamp: setattr(lamp.materials["grey"], "metallic", 1), factors(metallicFactor=1))
        self.expect_same(lambda lamp: setattr(lamp.materials["grey"], "emission", (3, 2, 1)),
                         lambda document: document["materials"][0].update(
                             emissiveFactor=[1, 2 / 3, 1 / 3],
                             extensions={**document["materials"][0]["extensions"],
                                         "KHR_materials_emissive_strength": {"emissiveStrength": 3}}))

        def light(**values):
            return lambda document: document["extensions"]["KHR_lights_punctual"]["lights"][0].update(values)
        self.expect_same(lambda lamp: setattr(lamp.lights[0], "color", [1, 0, 0]), light(color=[1, 0, 0]))
        self.expect_same(lambda lamp: setattr(lamp.lights[0], "range", 1.5), light(range=1.5))
        self.expect_same(lambda lamp: setattr(lamp.cameras["front"], "yfov", .9),
                         lambda document: document["cameras"][0]["perspective"].update(yfov=.9))

    def test_every_property_is_one_of_glTF(self):
        """What is set is read back, by pointers that the edits know, and reset undoes it."""
        values = {"alpha_mode": "MASK", "double_sided": True, "visible": False}
        for element in (self.lamp.materials[0], self.lamp.lights[0], self.lamp.cameras[0], self.lamp.cameras[1]):
            names = [name for name, value in vars(type(element)).items() if hasattr(value, "__set__") and not name.startswith("_")]
            self.assertGreater(len(names), 3)
            for name in names:
                before = getattr(element, name)
                if before is None:  # of the other kind of camera
                    continue
                value = values.get(name) or (tuple(np.linspace(.1, .4, len(before))) if isinstance(before, tuple) else .25)
                self.assertNotEqual(value, before, name)
                try:
                    setattr(element, name, value)
                    self.assertEqual(getattr(element, name), value, name)
                except (glim.InputError, AttributeError) as error:
                    self.assertTrue(isinstance(error, AttributeError) and name in ("kind", "nodes", "images"), error)
                    continue
                self.assertTrue(all(pointer.startswith(element.pointer) for pointer in self.lamp.edits))
                self.assertEqual(len(self.lamp.edits), 2 if name == "emission" else 1)
                self.lamp.reset()
                self.assertEqual(getattr(element, name), before)

    def test_edits_of_a_light_with_a_texture(self):
        """How lights are sampled is that of a scene that is loaded so."""
        film = glim.render(LAMP, size=(16, 16), spp=1)
        film.save(self.path("glow.png"))

        def glow(document):
            corners = np.float32([[-1, 1, 0], [1, 1, 0], [-1, 2, 0], [1, 2, .5]]).tobytes()
            numbers = corners + np.float32([[0, 0], [1, 0], [0, 1], [1, 1]]).tobytes() + np.uint16([0, 1, 2, 2, 1, 3]).tobytes()
            document["buffers"].append({"byteLength": len(numbers), "uri": "data:;base64," + base64.b64encode(numbers).decode()})
            buffer, view, accessor = len(document["buffers"]) - 1, len(document["bufferViews"]), len(document["accessors"])
            document["bufferViews"] += [{"buffer": buffer, "byteOffset": at, "byteLength": length}
                                        for at, length in ((0, 48), (48, 32), (80, 12))]
            document["accessors"] += [
                {"bufferView": view, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-1, 1, 0], "max": [1, 2, .5]},
                {"bufferView": view + 1, "componentType": 5126, "count": 4, "type": "VEC2"},
                {"bufferView": view + 2, "componentType": 5123, "count": 6, "type": "SCALAR"}]
            document["images"], document["textures"] = [{"uri": "glow.png"}], [{"source": 0}]
            document["materials"].append({"name": "glow", "emissiveFactor": [1, 1, 1], "emissiveTexture": {
                "index": 0, "extensions": {"KHR_texture_transform": {"offset": [0, 0]}}}})
            document["meshes"].append({"primitives": [{"attributes": {"POSITION": accessor, "TEXCOORD_0": accessor + 1},
                                                       "indices": accessor + 2, "material": len(document["materials"]) - 1}]})
            document["nodes"].append({"name": "glow", "mesh": len(document["meshes"]) - 1})
            document["scenes"][0]["nodes"].append(len(document["nodes"]) - 1)
        written_anew(self, glow)
        kept, digests = glim.load(self.path("changed.gltf"), **SMALL), set()
        for pointer, value in (("/materials/glow/pbrMetallicRoughness/roughnessFactor", .5), ("/nodes/glow/translation", (0, .1, 0)),
                               ("/materials/glow/emissiveTexture/extensions/KHR_texture_transform/offset", (.3, .4)),
                               ("/materials/glow/emissiveTexture/extensions/KHR_texture_transform/scale", (.2, .3)),
                               ("/nodes/glow/scale", (1, 2, 1))):
            kept.set(pointer, value)
            digests.add(kept.render().digest)
            self.assertEqual(kept.render().digest, glim.render(self.path("changed.gltf"), set=kept.edits, **SMALL).digest, pointer)
        self.assertEqual(len(digests), 5)

    def test_edits_are_those_of_set(self):
        ball = self.lamp.materials["white"]
        self.lamp.set("/materials/white/pbrMetallicRoughness/baseColorFactor", (1, 0, 0, .5))
        self.assertEqual(ball.base_color, (1, 0, 0, .5))
        ball.base_color = .1, .2, .3
        self.assertEqual(ball.base_color, (.1, .2, .3, .5))
        self.assertEqual(list(self.lamp.edits), ["/materials/white/pbrMetallicRoughness/baseColorFactor",
                                                 "/materials/1/pbrMetallicRoughness/baseColorFactor"])
        self.lamp.edits.clear()
        self.assertEqual(len(self.lamp.edits), 2)
        self.assertEqual(self.lamp.render(seed=1).digest, glim.render(LAMP, seed=1, set=self.lamp.edits, **SMALL).digest)
        self.lamp.set("/materials/white/pbrMetallicRoughness/baseColorFactor", None)
        self.assertEqual(list(self.lamp.edits), ["/materials/1/pbrMetallicRoughness/baseColorFactor"])

    def test_names_with_the_signs_of_pointers(self):
        written_anew(self, lambda document: document["materials"][1].update(name="a/b~c"))
        kept = glim.load(self.path("changed.gltf"), **SMALL)
        kept.set("/materials/a~1b~0c/alphaCutoff", .25)
        self.assertEqual(kept.materials["a/b~c"].alpha_cutoff, .25)
        kept.render()

    def test_what_the_scene_was_loaded_with_stays(self):
        blue = glim.load(LAMP, set={"/materials/1/pbrMetallicRoughness/baseColorFactor": (0, 0, 1, 1)}, **SMALL)
        blue.materials[1].base_color = 1, 0, 0
        blue.reset()
        self.assertEqual(blue.materials[1].base_color, (0, 0, 1, 1))

    def test_refused_values_change_nothing(self):
        grey, ball = self.lamp.materials["grey"], self.lamp.nodes["ball"]
        for words, element, name, value in (
                ("baseColorFactor", grey, "base_color", (2, 0, 0)), ("^base_color: .* 3 or 4 numbers", grey, "base_color", (1, 2)),
                ("^base_color: .*finite", grey, "base_color", (0, math.nan, 0)), ("roughnessFactor", grey, "roughness", -1),
                ("^metallic: .*a number", grey, "metallic", "much"), ("^metallic: .*a number", grey, "metallic", True),
                ("alphaMode", grey, "alpha_mode", "SOLID"), ("^visible: .*True or False", ball, "visible", 1),
                ("(?s)^matrix: .*4x4", ball, "matrix", np.eye(3)), ("(?s)^matrix: .*last row", ball, "matrix", 2 * np.eye(4)),
                ("^rotation: .*other than 0", ball, "rotation", (0, 0, 0, 0)), ("^scale: .*3 numbers", ball, "scale", 2)):
            with self.assertRaisesRegex(glim.InputError, words):
                setattr(element, name, value)
            self.assertEqual(self.lamp.edits, {}, words)

    def test_a_changed_file_is_read_again(self):
        written_anew(self, lambda document: None)
        kept = glim.load(self.path("changed.gltf"))
        self.assertEqual(kept.nodes[3].name, "ball")
        written_anew(self, lambda document: document["nodes"][3].update(name="sphere"))
        self.assertEqual(kept.nodes[3].name, "sphere")

    def test_need_no_device(self):
        code = "import glim; print(glim.load(%r).nodes.names, glim.__version__)" % LAMP
        self.assertIn("'ball'", run_python(code, VK_DRIVER_FILES=self.path("none"), VK_ICD_FILENAMES=self.path("none")))


class AddedTest(PythonCase):
    def setUp(self):
        super().setUp()
        self.lamp = glim.load(LAMP, **SMALL)
        self.before = self.lamp.render()

    def test_files(self):
        place = np.array([[1, 0, 0, .3], [0, 0, -1, .2], [0, 1, 0, .1], [0, 0, 0, 1]], float)
        gems = scene("materials")
        self.lamp.add(gems, matrix=place)
        self.assertEqual(self.lamp.render().digest, glim.render(LAMP, add={gems: place.T.ravel()}, **SMALL).digest)
        self.lamp.reset()
        self.assertEqual(self.lamp.render().digest, self.before.digest)
        with self.assertRaisesRegex(glim.InputError, "none.glb: cannot be"):
            self.lamp.add(self.path("none.glb"))
        with self.assertRaisesRegex(glim.InputError, "^matrix: .*4x4"):
            self.lamp.add(gems, matrix=(1, 2, 3))
        self.assertEqual(self.lamp.render().digest, self.before.digest)

    def test_files_beside_those_of_the_option(self):
        kept = glim.load(LAMP, add={scene("materials"): (0, 1, 0)}, **SMALL)
        kept.add(scene("alpha"))
        expected = glim.render(LAMP, add=[scene("materials") + "@0,1,0", scene("alpha")], **SMALL)
        self.assertEqual(kept.render().digest, expected.digest)

    def test_one_file_twice(self):
        """Each is edited alone."""
        with open(self.path("ball.gltf"), "w", encoding="utf-8") as file:
            json.dump({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "materials": [{"name": "paint"}],
                       "nodes": [{"name": "ball", "extras": {"sphere": {"radius": .2, "material": 0}}}]}, file)
        first, second = (self.lamp.add(self.path("ball.gltf")) for _ in range(2))
        first.nodes["ball"].translation = -.5, .2, 0
        second.nodes["ball"].translation = .2, .2, .8
        second.materials["paint"].base_color = 1, 0, 0
        self.assertEqual((first.materials[0].base_color, second.materials[0].base_color), ((1, 1, 1, 1), (1, 0, 0, 1)))
        shutil.copy(self.path("ball.gltf"), self.path("other.gltf"))
        expected = glim.render(LAMP, add={self.path("ball.gltf"): (-.5, .2, 0), self.path("other.gltf"): (.2, .2, .8)},
                               set={"other.gltf#/materials/0/pbrMetallicRoughness/baseColorFactor": (1, 0, 0, 1)}, **SMALL)
        self.assertEqual(self.lamp.render().pixels_digest, expected.pixels_digest)

    def test_lights(self):
        """A light has the picture of one in the file."""
        def with_lights(document):
            document["extensions"]["KHR_lights_punctual"]["lights"] += [
                {"type": "spot", "intensity": 8, "color": [1, .5, .25], "range": 9, "spot": {"innerConeAngle": .1, "outerConeAngle": .5}}]
            document["nodes"].append({"translation": [.5, 2, 0], "rotation": [-math.sqrt(.5), 0, 0, math.sqrt(.5)],
                                      "extensions": {"KHR_lights_punctual": {"light": 1}}})
            document["scenes"][0]["nodes"].append(5)
        added = self.lamp.add(glim.Light("spot", intensity=8, color=(1, .5, .25), range=9, cone=(.1, .5), position=(.5, 2, 0)))
        film, expected = self.lamp.render(spp=64), written_anew(self, with_lights)
        expected = glim.render(self.path("changed.gltf"), **{**SMALL, "spp": 64})
        np.testing.assert_allclose(film.rgb, expected.rgb, rtol=1e-3)
        self.assertEqual((added.lights["light"].kind, added.nodes[0].translation), ("spot", (.5, 2, 0)))
        added.lights[0].intensity = 0
        np.testing.assert_allclose(self.lamp.render(spp=64).rgb.mean(), glim.render(LAMP, **{**SMALL, "spp": 64}).rgb.mean(), rtol=1e-3)
        dark = self.lamp.render()
        self.assertLess(dark.rgb.mean(), film.rgb.mean())
        added.nodes[0].matrix = np.eye(4)
        for direction in ((0, 0, 1), (0, 0, -1), (1, 2, 3), (0, 1, 0)):
            node = self.lamp.add(glim.Light("directional", direction=direction)).nodes[0]
            np.testing.assert_allclose(node.matrix[:3, 2], -np.array(direction) / np.linalg.norm(direction), atol=1e-12)

    def test_floors(self):
        floor = self.lamp.add(glim.Plane((3, 2), position=(0, .9, 0), color=(.9, 0, 0)))
        red = self.lamp.render(camera="above")
        self.assertEqual([round(float(value), 3) for value in red.albedo[6, 8]], [.9, 0, 0])
        self.assertEqual(list(red.normal[6, 8].round(4)), [0, 1, 0])
        floor.materials["plane"].base_color = 0, .9, 0
        self.assertEqual([round(float(value), 3) for value in self.lamp.render(camera="above").albedo[6, 8]], [0, .9, 0])
        floor.nodes["plane"].visible = False
        self.assertEqual(self.lamp.render(camera="above").pixels_digest, glim.render(LAMP, camera="above", **SMALL).pixels_digest)

    def test_are_never_guessed(self):
        for words, make in (("^kind: ", lambda: glim.Light("area")), ("^intensity: ", lambda: glim.Light(intensity="much")),
                            ("^direction: .*other than 0", lambda: glim.Light("spot", direction=(0, 0, 0))),
                            ("^size: .*above 0", lambda: glim.Plane((1, 0))), ("^color: ", lambda: glim.Plane(color=(1, 2)))):
            with self.assertRaisesRegex(glim.InputError, words):
                make()
        with self.assertRaisesRegex(glim.InputError, "intensity.*-1"):
            self.lamp.add(glim.Light(intensity=-1))
        self.assertEqual(self.lamp.render().digest, self.before.digest)

    def test_their_files_go_with_the_scene(self):
        path = self.lamp.add(glim.Light()).path
        self.assertTrue(os.path.exists(path))
        self.lamp.render()
        film = self.lamp.last_film
        self.lamp = self.before = None
        gc.collect()
        self.assertTrue(os.path.exists(path))
        film.resume(spp=8)
        del film
        gc.collect()
        self.assertFalse(os.path.exists(os.path.dirname(path)))


class MapsTest(PythonCase):
    def setUp(self):
        super().setUp()
        rows = np.random.default_rng(1)
        self.sky = rows.uniform(0, 2, (8, 16, 3)).astype(np.float32)
        glim._native().write_map(self.path("sky.exr"), self.sky)
        self.expected = glim.render(LAMP, environment=self.path("sky.exr"), **SMALL).digest

    def digest(self, environment, **options):
        return glim.render(LAMP, environment=environment, **SMALL, **options).digest

    def test_of_arrays_are_those_of_files(self):
        class Exporter:  # as torch's tensors
            def __init__(self, array):
                self._array = array

            def __dlpack__(self, **options):
                return self._array.__dlpack__(**options)

            def __dlpack_device__(self):
                return self._array.__dlpack_device__()
        for environment in (self.sky, self.sky.astype(float), memoryview(self.sky), Exporter(self.sky), np.asfortranarray(self.sky)):
            self.assertEqual(self.digest(environment), self.expected, type(environment))
        self.assertNotEqual(self.digest(self.sky[::-1]), self.expected)
        self.assertEqual(self.digest((self.sky * 0 + 1)[:2, :2].astype("uint8")), self.digest((self.sky * 0 + 1)[:2, :2]))

    def test_of_the_scene_and_of_a_picture(self):
        kept = glim.load(LAMP, environment=self.sky, **SMALL)
        film = kept.render()
        self.assertEqual(film.digest, self.expected)
        self.sky[:] = 0  # the scene has its own
        self.assertEqual(kept.render().digest, self.expected)
        self.assertNotEqual(kept.render(environment=self.sky).digest, self.expected)
        self.assertEqual(kept.render(environment=np.array((1, 2, 3))).digest, self.digest((1, 2, 3)))
        self.assertEqual(film.resume(spp=8).digest, glim.render(LAMP, environment=self.path("sky.exr"), **{**SMALL, "spp": 8}).digest)

    def test_is_refused(self):
        for value, words in ((self.sky[..., :2], r"cannot use '\(8, 16, 2\) float32', expected an array of \(height, width, 3\)"),
                             (self.sky[0], "expected an array of"), (self.sky.astype(complex), "complex128"),
                             (self.sky[:0], "expected an array of")):
            with self.assertRaisesRegex(glim.InputError, words):
                self.digest(value)
        for bad in (-1, math.nan, math.inf):
            self.sky[2, 3, 1] = bad
            with self.assertRaisesRegex(glim.InputError, r"^environment\[2, 3, 1\]: cannot use .*, expected a finite radiance of 0 or"):
                self.digest(self.sky)
        with self.assertRaisesRegex(glim.InputError, "a finite radiance"):
            self.digest(np.full((2, 2, 3), 1e39))

    def test_files_of_arrays_go(self):
        kept = glim.load(LAMP, environment=self.sky, **SMALL)
        first = os.fspath(kept._options["environment"])
        film = kept.render(environment=self.sky + 1)
        second = os.fspath(film._again[1]["environment"])
        self.assertTrue(os.path.exists(first) and os.path.exists(second))
        del film, kept
        gc.collect()
        self.assertFalse(os.path.exists(first) or os.path.exists(second))


class ManyTest(PythonCase):
    def command_line_films(self, file, *words):
        subprocess.run([GLIM, "render", file, "--size", "16x12", "--spp", "4", *words, "-o", self.path("####.exr"), "--progress", "none"],
                       check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        return [glim.read(self.path(name)).digest for name in sorted(os.listdir(self.folder)) if name.endswith(".exr")]

    def test_turntables(self):
        lamp = glim.load(LAMP, **SMALL)
        for words, options in (([], {}), (["--fov", "30", "--zoom", "1.5"], {"fov": 30, "zoom": 1.5})):
            films = list(lamp.render_many(turntable=3, **options))
            self.assertEqual([film.digest for film in films], self.command_line_films(LAMP, "--turntable", "3", *words))
        self.assertEqual(films[1].resume(spp=8).digest, list(lamp.render_many(turntable=3, **options, spp=8))[1].digest)

    def animated(self, find_node):
        """The lamp's file with a node that moves for a second."""
        def animate(document):
            node = find_node(document["nodes"])
            numbers = np.float32([0, 1, 0, .4, 0, 0, 1.4, 0]).tobytes()
            document["buffers"].append({"byteLength": 32, "uri": "data:;base64," + base64.b64encode(numbers).decode()})
            buffer, view, accessor = len(document["buffers"]) - 1, len(document["bufferViews"]), len(document["accessors"])
            document["bufferViews"] += [{"buffer": buffer, "byteLength": 8}, {"buffer": buffer, "byteOffset": 8, "byteLength": 24}]
            document["accessors"] += [{"bufferView": view, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [1]},
                                      {"bufferView": view + 1, "componentType": 5126, "count": 2, "type": "VEC3"}]
            document["animations"] = [{"samplers": [{"input": accessor, "output": accessor + 1}],
                                       "channels": [{"sampler": 0, "target": {"node": node, "path": "translation"}}]}]
        written_anew(self, animate)
        return self.path("changed.gltf")

    def test_times(self):
        path = self.animated(lambda nodes: 3)
        films = list(glim.load(path, **SMALL).render_many(at=np.linspace(0, 1, 3)))
        self.assertEqual([film.time for film in films], [0, .5, 1])
        for film in films:
            self.assertEqual(film.digest, glim.render(path, at=film.time, **SMALL).digest)
        self.assertEqual(len({film.digest for film in films}), 3)

    def test_shutters(self):
        path = self.animated(lambda nodes: next(i for i, node in enumerate(nodes) if "camera" in node))
        moving = glim.load(path, **SMALL)
        digests = {moving.render(at=.5, shutter=shutter).digest for shutter in ((-.1, .1), (0, .1))} | {moving.render(at=.5).digest}
        self.assertEqual(len(digests), 3)
        self.assertIn(self.command_line_films(path, "--frames", "1:1", "--fps", "2", "--shutter", "-0.1,0.1")[0], digests)
        with self.assertRaisesRegex(glim.InputError, "shutter: .*needs a time of an animation"):
            moving.render(shutter=(0, .1))

    def test_cameras(self):
        lamp = glim.load(LAMP, **SMALL)
        robot = glim.Camera(pose=np.eye(4) + [[0, 0, 0, 0], [0, 0, 0, 1], [0, 0, 0, 3], [0, 0, 0, 0]], axes="gltf")
        cameras = ["above", 0, lamp.cameras["above"], robot, glim.look_at((1, 1, 3), (0, 0, 0)), {"camera": "above", "spp": 2}]
        films = list(lamp.render_many(cameras=cameras, seed=3))
        expected = [lamp.render(seed=3, **options) for options in (
            {"camera": "above"}, {"camera": 0}, {"camera": "above"}, {"camera": robot}, glim.look_at((1, 1, 3), (0, 0, 0)),
            {"camera": "above", "spp": 2})]
        self.assertEqual([film.digest for film in films], [film.digest for film in expected])

    def test_edits_hold_for_what_follows(self):
        lamp = glim.load(LAMP, **SMALL)
        digests = []
        for film in lamp.render_many(cameras=[0, 0, 0]):
            digests.append(film.digest)
            lamp.materials["grey"].base_color = 1, 0, 0
        self.assertEqual(len(set(digests)), 2)
        self.assertEqual(digests[1], digests[2])

    def test_progress(self):
        calls = []
        films = list(glim.load(LAMP, size=(64, 48), spp=64).render_many(cameras=[0, 1], progress=lambda *call: calls.append(call)))
        self.assertEqual(len(films), 2)
        self.assertEqual(calls, sorted(calls))
        self.assertEqual({call[1] for call in calls}, {2})
        self.assertEqual((calls[-1][0], any(call[0] == 1 for call in calls)), (2, True))

        def stop(done, total, seconds):
            if done > 1:
                raise KeyError("enough")
        rest = glim.load(LAMP, size=(64, 48), spp=64).render_many(cameras=[0, 1], progress=stop)
        next(rest)
        with self.assertRaises(KeyError):
            next(rest)

    def test_is_refused_before_the_first_picture(self):
        lamp = glim.load(LAMP, **SMALL)
        for words, options in (("expected one of at, turntable and cameras", {}), ("at and cameras", {"at": [0], "cameras": [0]}),
                               ("^cameras: .*a sequence", {"cameras": "above"}), ("^at: .*a sequence", {"at": 1}),
                               ("^turntable: .*0", {"turntable": 0}), ("^at: .*object", {"at": [0, object()]}),
                               ("^progress: ", {"at": [0], "progress": 5})):
            with self.assertRaisesRegex(glim.InputError, words):
                lamp.render_many(**options)
        for option in ({"turntable": 3}, {"movie": "m.mp4"}):
            with self.assertRaisesRegex(glim.InputError, "^%s: .*command line" % next(iter(option))):
                lamp.render(**option)


class OptionsTest(PythonCase):
    def test_types_are_those_of_the_option_table(self):
        sys.path.insert(0, os.path.join(ROOT, "python"))
        import write_options
        with open(os.path.join(ROOT, "python", "src", "glim", "_render_options.py"), encoding="utf-8") as file:
            self.assertEqual(file.read(), write_options.text_of(glim._native().options()), "python/write_options.py build/package")

    def test_are_in_the_signatures(self):
        for function in (glim.load, glim.render, glim.Scene, glim.Scene.render, glim.Scene.render_many, glim.Film.resume):
            parameters = inspect.signature(function).parameters
            self.assertEqual(parameters["options"].annotation, "Unpack[RenderOptions]", function)
        from glim._render_options import RenderOptions
        hints = typing.get_type_hints(RenderOptions)
        self.assertEqual((hints["spp"], hints["denoise"], hints["clamp_indirect"]), (int, bool, float))
        self.assertEqual(hints["view"], typing.Literal["shaded", "normal", "depth", "albedo", "bvh-steps", "guide"])
        self.assertNotIn("output", hints)
        self.assertNotIn("turntable", hints)

    def test_options_of_a_file(self):
        edits = {"set": {"/nodes/ball/translation": [0, .5, 0]}, "sun": [30, 45, 2], "camera": "above"}
        with open(self.path("edits.json"), "w", encoding="utf-8") as file:
            json.dump(edits, file)
        expected = glim.render(LAMP, **edits, **SMALL)
        self.assertEqual(glim.render(LAMP, edits=self.path("edits.json"), **SMALL).digest, expected.digest)
        color = {"/materials/1/pbrMetallicRoughness/baseColorFactor": (0, 0, 1, 1)}
        expected = glim.render(LAMP, **{**edits, "set": {**edits["set"], **color}, "sun": (0, 90, 1)}, **SMALL)
        self.assertEqual(glim.render(LAMP, set=color, sun=(0, 90, 1), edits=self.path("edits.json"), **SMALL).digest, expected.digest)
        with open(self.path("edits.json"), "w", encoding="utf-8") as file:
            json.dump({"spp": 4}, file)
        with self.assertRaisesRegex(glim.InputError, "edits.json: spp: is not of what is shown; expected an option of scene, camera"):
            glim.render(LAMP, edits=self.path("edits.json"), **SMALL)

    def test_version(self):
        with open(os.path.join(ROOT, "CMakeLists.txt"), encoding="utf-8") as file:
            self.assertEqual(glim.__version__, re.search(r"project\(glim VERSION ([0-9.]+)", file.read())[1])
        said = subprocess.run([GLIM, "--version"], stdout=subprocess.PIPE, text=True, check=True).stdout
        self.assertIn("glim %s " % glim.__version__, said)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
