#!/usr/bin/env python3
"""python/examples: a COCO set, random domains, and a robot's camera for Drake, whose client is played by http.client."""

import base64
import filecmp
import hashlib
import http.client
import json
import os
import re
import subprocess
import sys
import unittest
import zlib

import numpy as np
from python_case import ROOT, PythonCase, glim

EXAMPLES = os.path.join(ROOT, "python", "examples")


def example(name, *words):
    """Its command line and environment, for subprocess."""
    return {"args": [sys.executable, "-B", os.path.join(EXAMPLES, name + ".py"), *words], "env": {**os.environ, "PYTHONPATH": sys.argv[2]}}


def read_bytes(path):
    with open(path, "rb") as file:
        return file.read()


def pixels_of(png):
    """(height, width, 3) uint8 of a PNG without alpha."""
    width, height = (int.from_bytes(png[at:at + 4], "big") for at in (16, 20))
    assert png[24:29] == bytes((8, 2, 0, 0, 0)), "8 bits, RGB, not interlaced"
    packed, at = b"", 8
    while at < len(png):
        length = int.from_bytes(png[at:at + 4], "big")
        packed += png[at + 8:at + 8 + length] if png[at + 4:at + 8] == b"IDAT" else b""
        at += 12 + length
    stream, rows, above = zlib.decompress(packed), [], [0] * (3 * width)
    for row in range(height):
        kind, *line = stream[row * (3 * width + 1):(row + 1) * (3 * width + 1)]
        for i in range(3 * width):
            left, up, corner = (line[i - 3] if i > 2 else 0), above[i], (above[i - 3] if i > 2 else 0)
            paeth = min((left, up, corner), key=lambda near: abs(left + up - corner - near))
            line[i] = (line[i] + (0, left, up, (left + up) // 2, paeth)[kind]) % 256
        rows.append(line)
        above = line
    return np.array(rows, np.uint8).reshape(height, width, 3)


def numbers_of(tiff):
    """(height, width) float32 of a TIFF in one piece."""
    assert tiff[:8] == b"II*\0\x08\0\0\0"
    tags = {}
    for at in range(10, 10 + 12 * int.from_bytes(tiff[8:10], "little"), 12):
        tag, kind, count, value = (int.from_bytes(tiff[at + begin:at + end], "little") for begin, end in ((0, 2), (2, 4), (4, 8), (8, 12)))
        assert (kind in (3, 4), count) == (True, 1)
        tags[tag] = value
    assert list(tags) == sorted(tags)
    assert {258: 32, 259: 1, 262: 1, 277: 1, 339: 3, 278: tags[257], 279: 4 * tags[256] * tags[257]}.items() <= tags.items()
    assert tags[273] + tags[279] == len(tiff)
    return np.frombuffer(tiff, "<f4", offset=tags[273]).reshape(tags[257], tags[256])


class CocoSetTest(PythonCase):
    def setUp(self):
        super().setUp()
        self.make(self.folder)
        self.coco = json.loads(read_bytes(self.path("annotations.json")))

    def make(self, folder, *words):
        subprocess.run(**example("make_coco_set", folder, "--pictures", "5", "--size", "64x48", "--spp", "1", *words), check=True)

    def arrays(self, number):
        with np.load(self.path("%04d.npz" % number)) as arrays:
            return dict(arrays)

    def test_has_the_keys_and_the_masks_of_COCO(self):
        images, categories, annotations = (self.coco[name] for name in ("images", "categories", "annotations"))
        self.assertEqual([(image["id"], image["file_name"]) for image in images], [(number, "%04d.png" % number) for number in range(1, 6)])
        self.assertEqual([category["name"] for category in categories],
                         ["floor", "ceiling", "back", "left", "right", "lamp", "tall box", "short box"])
        self.assertEqual([one["id"] for one in annotations], list(range(1, len(annotations) + 1)))
        self.assertEqual({one["category_id"] for one in annotations} - {one["id"] for one in categories}, set())
        shown = {image["id"]: set() for image in images}
        for one in annotations:
            instance = self.arrays(one["image_id"])["instance"]
            counts = one["segmentation"]["counts"]
            mask = np.repeat(np.arange(len(counts)) % 2, counts).reshape(one["segmentation"]["size"][::-1]).T == 1
            self.assertEqual(mask.shape, (48, 64))
            rows, columns = np.nonzero(mask)
            self.assertEqual(one["bbox"], [columns.min(), rows.min(), np.ptp(columns) + 1, np.ptp(rows) + 1])
            self.assertEqual((one["area"], one["iscrowd"]), (mask.sum(), 0))
            number = instance[mask][0]
            np.testing.assert_array_equal(instance == number, mask)
            shown[one["image_id"]].add(number)
        for number, instances in shown.items():
            self.assertEqual(instances, set(np.unique(self.arrays(number)["instance"])) - {2**32 - 1})
            self.assertTrue(np.any(pixels_of(read_bytes(self.path("%04d.png" % number)))))

    def test_depth_and_flow_say_where_walls_are_in_the_next_picture(self):
        rows, columns = np.mgrid[:48, :64]
        pixels = np.stack([columns, rows, np.ones_like(rows)], axis=-1)
        for number in range(1, 5):
            here, there = self.arrays(number), self.arrays(number + 1)

            def moved(shown):
                """Where the next picture shows these places if they stand still, less where this one does."""
                ways = pixels[shown] @ np.linalg.inv(here["K"]).T * here["depth"][shown][:, None]
                places = ways @ here["pose"][:3, :3].T + here["pose"][:3, 3]
                seen = (places - there["pose"][:3, 3]) @ there["pose"][:3, :3] @ there["K"].T
                return seen[:, :2] / seen[:, 2:] - pixels[shown][:, :2]
            walls, box = np.isin(here["instance"], range(6)), here["instance"] == 6
            self.assertGreater(walls.sum(), 1000)
            np.testing.assert_allclose(here["forward_flow"][walls], moved(walls), rtol=0, atol=1e-3)
            self.assertGreater(np.abs(moved(walls)).max(), .1)
            self.assertGreater(np.abs(here["forward_flow"][box] - moved(box)).max(), .02)  # it moves by itself, too

    def test_has_the_bytes_of_its_seed(self):
        for seed, same in (("0", 12), ("1", 0)):
            self.make(self.path("again"), "--seed", seed)
            equal = filecmp.cmpfiles(self.folder, self.path("again"), os.listdir(self.path("again")), shallow=False)[0]
            self.assertEqual(len(equal), same)


class RandomDomainTest(PythonCase):
    def drawn(self, name, *words):
        subprocess.run(**example("randomise_domain", self.path(name), "--pictures", "2", "--size", "32x24", "--spp", "2", *words),
                       check=True)
        return {one: read_bytes(self.path(os.path.join(name, one))) for one in sorted(os.listdir(self.path(name)))}

    def test_has_the_bytes_of_its_seed_and_says_what_was_set(self):
        first = self.drawn("first")
        self.assertEqual(list(first), ["0001.png", "0002.png", "settings.jsonl"])
        self.assertEqual(len(set(first.values())), 3)
        self.assertEqual(self.drawn("again"), first)
        self.assertFalse(set(self.drawn("other", "--seed", "1").values()) & set(first.values()))
        lines = [json.loads(line) for line in first["settings.jsonl"].splitlines()]
        self.assertEqual([(line["file_name"], line["options"]["seed"]) for line in lines], [("0001.png", 1), ("0002.png", 2)])
        again = glim.load(os.path.join(ROOT, "scenes", "cornell_mirror_glass.gltf"))
        for line in lines:
            again.render(**line["options"]).save(self.path("again.png"))
            self.assertEqual(read_bytes(self.path("again.png")), first[line["file_name"]])
        first, second = (line["options"]["set"] for line in lines)
        self.assertEqual({"/".join(pointer.split("/")[1:3]) for pointer in first},
                         {"nodes/7", "nodes/8", *("materials/%d" % number for number in range(6))})
        self.assertEqual({pointer for pointer in first if first[pointer] == second[pointer]},
                         {"/materials/3/extensions/KHR_materials_emissive_strength/emissiveStrength"})


CARD, WALL = (.5, .4), (3, 1.8)  # half of their sides, metres
RED_BEFORE_BLUE = ((.8, .1, .1), (.1, .1, .8))
LABELS = ((13, 1, 0), (44, 0, 0))  # of the card, of the wall
FORM = {"width": "64", "height": "48", "near": "0.010000", "far": "10.000000", "focal_x": "50.000000", "focal_y": "55.000000",
        "fov_x": "1.138795", "fov_y": "0.821750", "center_x": "30.300000", "center_y": "24.600000", "submit": "Render"}


def drakes_scene(colors):
    """A card at x = 0 before a wall at x = -3, seen from x = 2, as Drake writes them: z is up, and of each mesh a material."""
    buffers, views, accessors, meshes, nodes = [], [], [], [], []

    def number_of(values, kind):
        content = values.tobytes()
        buffers.append({"byteLength": len(content), "uri": "data:application/octet-stream;base64," + base64.b64encode(content).decode()})
        views.append({"buffer": len(buffers) - 1, "byteOffset": 0, "byteLength": len(content)})
        accessors.append({"bufferView": len(views) - 1, "byteOffset": 0, "componentType": kind, "count": len(values),
                          "type": "VEC3" if values.ndim == 2 else "SCALAR", "min": np.ravel(values.min(0)).tolist(),
                          "max": np.ravel(values.max(0)).tolist()})
        return len(accessors) - 1

    for number, ((y, z), x) in enumerate(((CARD, 0), (WALL, -3))):
        corners = np.array([(0, -y, -z), (0, y, -z), (0, y, z), (0, -y, z)], "<f4")
        meshes.append({"name": "mesh%d" % number, "primitives": [{
            "attributes": {"POSITION": number_of(corners, 5126)}, "indices": number_of(np.array((0, 1, 2, 0, 2, 3), "<u4"), 5125),
            "material": number, "mode": 4}]})
        nodes.append({"mesh": number, "name": "mesh%d" % number, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, 0, 0, 1]})
    nodes += [{"camera": 0, "name": "Camera Node", "matrix": [0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 2, .1, .05, 1]},
              {"children": [0, 1, 2], "name": "Renderer Node"}]
    materials = [{"pbrMetallicRoughness": {"baseColorFactor": [*color, 1.0], "metallicFactor": 0.0, "roughnessFactor": 1.0}}
                 for color in colors]
    return {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"name": "Layer 0", "nodes": [3]}], "nodes": nodes, "meshes": meshes,
            "materials": materials, "accessors": accessors, "bufferViews": views, "buffers": buffers,
            "cameras": [{"type": "perspective", "perspective": {"aspectRatio": 4 / 3, "yfov": .82175, "znear": .01, "zfar": 10.0}}]}


def expected_depth(distortion):
    """(48, 64) metres along the axis, by OpenCV's formulas alone, and how far from the next edge each ray is."""
    rows, columns = np.mgrid[:48, :64]
    seen_x, seen_y = (columns - float(FORM["center_x"])) / float(FORM["focal_x"]), (rows - float(FORM["center_y"])) / float(FORM["focal_y"])
    x, y = seen_x, seen_y
    k1, k2, p1, p2 = distortion
    for _ in range(100):
        square = x * x + y * y
        scale = 1 + k1 * square + k2 * square**2
        x, y = ((seen_x - 2 * p1 * x * y - p2 * (square + 2 * x * x)) / scale,
                (seen_y - p1 * (square + 2 * y * y) - 2 * p2 * x * y) / scale)
    depth, nearest = np.full(rows.shape, np.inf), np.full(rows.shape, np.inf)
    for half, distance in ((WALL, 5), (CARD, 2)):
        inside = np.minimum(half[0] - np.abs(.1 + distance * x), half[1] - np.abs(.05 - distance * y))
        depth[inside > 0] = distance
        nearest = np.minimum(nearest, np.abs(inside))
    return depth, nearest


class RobotCameraTest(PythonCase):
    def serve(self, *words):
        os.makedirs(self.path("tmp"), exist_ok=True)
        command = example("serve_robot_camera", "--port", "0", "--spp", "4", *words)
        self.errors = open(self.path("errors"), "w+", encoding="utf-8")
        self.addCleanup(self.errors.close)
        self.server = subprocess.Popen(command["args"], env={**command["env"], "TMPDIR": self.path("tmp")}, stdout=subprocess.PIPE,
                                       stderr=self.errors, text=True)
        self.addCleanup(self.server.stdout.close)
        self.addCleanup(self.stop)
        line = self.server.stdout.readline()
        found = re.fullmatch(r'base_url="http://127\.0\.0\.1:(\d+)", render_endpoint="(\S{40,}/render)"\n', line)
        self.port, self.endpoint = found.groups()

    def stop(self):
        self.server.terminate()
        self.server.wait()

    def ask(self, scene, image_type, endpoint=None, headers=(), **fields):
        """The code, type and content of the answer. scene: a document, or what is sent in its place."""
        content = scene if isinstance(scene, bytes) else json.dumps(scene).encode()
        fields = {**FORM, "image_type": image_type, "scene_sha256": hashlib.sha256(content).hexdigest(),
                  **({"min_depth": "0.100000", "max_depth": "9.000000"} if image_type == "depth" else {}), **fields}
        parts = [b'Content-Disposition: form-data; name="%s"\r\n\r\n%s' % (name.encode(), value.encode())
                 for name, value in sorted(fields.items()) if value is not None]
        parts.append(b'Content-Disposition: form-data; name="scene"; filename="../../0001-color.gltf"\r\n'
                     b"Content-Type: model/gltf+json\r\n\r\n" + content)
        body = b"".join(b"--of-parts\r\n%s\r\n" % part for part in parts) + b"--of-parts--\r\n"
        connection = http.client.HTTPConnection("127.0.0.1", int(self.port), timeout=60)
        self.addCleanup(connection.close)
        connection.request("POST", "/" + (endpoint or self.endpoint), body,
                           {"Content-Type": "multipart/form-data; boundary=of-parts", **dict(headers)})
        answer = connection.getresponse()
        return answer.status, answer.headers["Content-Type"], answer.read()

    def picture(self, scene, image_type, expected, **fields):
        status, kind, content = self.ask(scene, image_type, **fields)
        self.assertEqual((status, kind), (200, expected), content[:1000])
        return content

    def check_pictures(self, distortion):
        """Colour, depth and labels against what each pixel's ray meets."""
        depth, margin = expected_depth(distortion)
        self.assertGreater(margin.min(), 5e-6)  # ten times what float32 resolves there
        for meters in (2, 5, np.inf):
            self.assertGreater((depth == meters).sum(), 100)
        content = self.picture(drakes_scene(RED_BEFORE_BLUE), "depth", "image/tiff")
        np.testing.assert_allclose(numbers_of(content), depth, rtol=1e-6)
        cut = self.picture(drakes_scene(RED_BEFORE_BLUE), "depth", "image/tiff", min_depth="2.500000", max_depth="4.000000")
        np.testing.assert_array_equal(numbers_of(cut), np.where(depth == 2, 0, np.inf))
        content = self.picture(drakes_scene((np.array(LABELS) / 255).round(6).tolist()), "label", "image/png")
        labels = np.select([(depth == 2)[..., None], (depth == 5)[..., None]], LABELS, 255)
        np.testing.assert_array_equal(pixels_of(content), labels)
        color = pixels_of(self.picture(drakes_scene(RED_BEFORE_BLUE), "color", "image/png")).astype(int)
        whole = np.zeros(depth.shape, bool)  # pixels that see one thing only
        whole[1:-1, 1:-1] = np.all([depth[1:-1, 1:-1] == depth[1 + y:47 + y, 1 + x:63 + x] for y in (-1, 0, 1) for x in (-1, 0, 1)], axis=0)
        self.assertTrue((color[whole & (depth == 2), 0] > color[whole & (depth == 2), 2] + 20).all())
        self.assertTrue((color[whole & (depth == 5), 2] > color[whole & (depth == 5), 0] + 20).all())
        return color, depth

    def test_draws_color_depth_and_labels(self):
        with open(self.path("sky.hdr"), "wb") as file:  # white above, black below
            file.write(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 8 +X 4\n" + bytes((128, 128, 128, 129)) * 16 + bytes(4) * 16)
        self.serve("--environment", self.path("sky.hdr"))
        color, depth = self.check_pictures((0, 0, 0, 0))
        self.assertTrue(np.isinf(depth[[0, -1]]).all())
        self.assertGreater(color[0].min(), color[-1].max() + 100)

    def test_distorts_all_of_them(self):
        distortion = (-.2, .05, .01, -.02)
        self.serve("--distortion=" + ",".join(map(str, distortion)))
        self.assertGreater((expected_depth(distortion)[0] != expected_depth((0, 0, 0, 0))[0]).sum(), 50)
        self.check_pictures(distortion)

    def test_refuses_in_one_sentence(self):
        self.serve()
        scene = drakes_scene(RED_BEFORE_BLUE)
        with open(self.path("secret.bin"), "wb") as file:
            file.write(bytes(1000))
        strangers = [{**scene, "buffers": [{**scene["buffers"][0], "uri": uri}, *scene["buffers"][1:]]}
                     for uri in ("../../secret.bin", self.path("secret.bin"), "file://" + self.path("secret.bin"))]
        without_color = {**scene, "materials": [{}, {}]}
        for code, words, document, image_type, options in (
                (404, "there is no such endpoint", scene, "color", {"endpoint": "render"}),
                (404, "there is no such endpoint", scene, "color", {"endpoint": "x" + self.endpoint[1:]}),
                (404, "there is no such endpoint", scene, "color", {"endpoint": self.endpoint + "/"}),
                (411, "Content-Length: is missing", scene, "color", {"headers": {"Content-Length": "many"}}),
                (413, "Content-Length: cannot use 67108865, expected at most 67108864 bytes", scene, "color",
                 {"headers": {"Content-Length": "67108865", "Expect": "100-continue"}}),
                (415, 'Content-Type: cannot use "text/plain", expected multipart/form-data', scene, "color",
                 {"headers": {"Content-Type": "text/plain"}}),
                (400, "image_type: is missing", scene, "color", {"headers": {"Content-Type": "multipart/form-data"}}),
                (400, "scene: its SHA-256 is not scene_sha256", scene, "color", {"scene_sha256": "0" * 64}),
                (400, 'image_type: cannot use "flow", expected color, depth or label', scene, "flow", {}),
                (400, "center_x: is missing", scene, "color", {"center_x": None}),
                (400, "min_depth: is missing", scene, "depth", {"min_depth": None}),
                (400, 'focal_x: cannot use "nan", expected a number from', scene, "color", {"focal_x": "nan"}),
                (400, 'width: cannot use "4097", expected a number from 1 to 4096', scene, "color", {"width": "4097"}),
                (400, "scene: is not JSON, expected a glTF file", b"glTF\2\0\0\0", "color", {}),
                (400, "scene: is not JSON, expected a glTF file", b"[" * 100000, "color", {}),
                (400, "scene: has no scenes with nodes, expected a glTF file", [], "color", {}),
                (400, "scene: has no scenes with nodes, expected a glTF file", {**scene, "scene": 5}, "color", {}),
                (400, "scene: meshes[0] has no baseColorFactor", without_color, "label", {}),
                (400, "scene: nodes[", {**scene, "meshes": scene["meshes"][:1]}, "color", {}),
                *((400, "scene: buffers[0]", document, "color", {}) for document in strangers)):
            with self.subTest(words, options=options):
                status, kind, content = self.ask(document, image_type, **options)
                self.assertEqual((status, kind), (code, "text/plain; charset=utf-8"), content)
                self.assertTrue(content.decode().startswith(words), content)
                self.assertRegex(content.decode(), r"\A[^\n]+\n\Z")
                self.assertNotIn(self.folder, content.decode().replace(self.path("secret.bin"), ""))
        self.picture(scene, "color", "image/png")

    def test_keeps_to_itself(self):
        self.serve()
        scene = drakes_scene(RED_BEFORE_BLUE)
        self.picture(scene, "color", "image/png")
        folder, = os.listdir(self.path("tmp"))
        self.assertEqual(os.stat(self.path(os.path.join("tmp", folder))).st_mode & 0o777, 0o700)
        self.assertEqual(os.listdir(self.path(os.path.join("tmp", folder))), [])
        with open("/proc/net/tcp", encoding="ascii") as table:
            self.assertEqual({line.split()[1][:8] for line in table if line.split()[1].endswith(":%04X" % int(self.port))}, {"0100007F"})
        self.stop()
        self.assertEqual(os.listdir(self.path("tmp")), [])
        self.errors.seek(0)
        self.assertNotIn(self.endpoint, self.errors.read())


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
