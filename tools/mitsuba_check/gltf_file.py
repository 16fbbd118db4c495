"""A glTF file as JSON, arrays and placed nodes. Refuses what our scenes do not use of glTF."""

import base64
import json
import os
import struct
import urllib.parse

import numpy as np

from .errors import CheckError

KINDS = {5120: np.dtype("i1"), 5121: np.dtype("u1"), 5122: np.dtype("<i2"), 5123: np.dtype("<u2"), 5125: np.dtype("<u4"),
         5126: np.dtype("<f4")}
COLUMNS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
EXTENSIONS = {"KHR_lights_punctual", "KHR_materials_anisotropy", "KHR_materials_clearcoat", "KHR_materials_diffuse_transmission",
              "KHR_materials_emissive_strength", "KHR_materials_ior", "KHR_materials_iridescence",
              "KHR_materials_pbrSpecularGlossiness", "KHR_materials_sheen", "KHR_materials_specular", "KHR_materials_transmission",
              "KHR_materials_unlit", "KHR_materials_variants", "KHR_materials_volume", "KHR_mesh_quantization", "KHR_texture_transform"}
# The errors that a file raises if it does not follow glTF; `glim inspect` says more.
BROKEN = (AttributeError, IndexError, KeyError, TypeError, ValueError, struct.error)
GLB_MAGIC, JSON_CHUNK = b"glTF", 0x4E4F534A


def rotation(x, y, z, w):
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def local_matrix(node):
    if "matrix" in node:
        return np.array(node["matrix"], float).reshape(4, 4).T
    matrix = np.eye(4)
    turn = np.array(node.get("rotation", (0, 0, 0, 1)), float)
    matrix[:3, :3] = rotation(*(turn / np.linalg.norm(turn))) * np.array(node.get("scale", (1, 1, 1)), float)
    matrix[:3, 3] = node.get("translation", (0, 0, 0))
    return matrix


class GltfFile:
    def __init__(self, path):
        self.path = path
        try:
            with open(path, "rb") as file:
                content = file.read()
            self.json, chunk = self.split(content)
            required = set(self.json.get("extensionsRequired", ())) - EXTENSIONS
            if required:
                self.refuse("requires %s, which is not exported" % ", ".join(sorted(required)))
            self.buffers = [self.read_buffer(b, chunk) for b in self.json.get("buffers", ())]
        except BROKEN as error:
            self.refuse("is not glTF 2.0 (%s: %s)" % (type(error).__name__, error))
        except OSError as error:
            self.refuse("cannot be read (%s)" % error.strerror)

    def refuse(self, why):
        raise CheckError("%s: %s" % (self.path, why))

    def split(self, content):
        if content[:4] != GLB_MAGIC:
            return json.loads(content), None
        length, kind = struct.unpack_from("<II", content, 12)
        if kind != JSON_CHUNK:
            raise ValueError("its first chunk is not JSON")
        return json.loads(content[20:20 + length]), content[28 + length:]

    def read_buffer(self, entry, chunk):
        uri = entry.get("uri")
        return chunk if uri is None else self.read_uri(uri)

    def path_of(self, uri):
        return os.path.join(os.path.dirname(self.path), urllib.parse.unquote(uri))

    def read_uri(self, uri):
        if uri.startswith("data:"):
            return base64.b64decode(uri.partition(",")[2])
        with open(self.path_of(uri), "rb") as file:
            return file.read()

    def image(self, index):
        """The bytes of an image's file."""
        entry = self.json["images"][index]
        if "uri" in entry:
            return self.read_uri(entry["uri"])
        view = self.json["bufferViews"][entry["bufferView"]]
        first = view.get("byteOffset", 0)
        return bytes(self.buffers[view["buffer"]][first:first + view["byteLength"]])

    def array(self, index, what):
        """An accessor as rows: floats as they are, normalised whole numbers as floats, others only for indices and positions."""
        accessor = self.json["accessors"][index]
        kind = KINDS.get(accessor["componentType"])
        plain = kind is not None and "sparse" not in accessor and "bufferView" in accessor
        if not plain or what == "indices" and kind.kind != "u":
            self.refuse("accessors[%d] (%s) is sparse or of another type, which is not exported" % (index, what))
        view = self.json["bufferViews"][accessor["bufferView"]]
        columns = COLUMNS[accessor["type"]]
        stride = view.get("byteStride") or columns * kind.itemsize
        rows = np.ndarray((accessor["count"], columns), kind, self.buffers[view["buffer"]],
                          view.get("byteOffset", 0) + accessor.get("byteOffset", 0), (stride, kind.itemsize))
        return np.maximum(rows / float(np.iinfo(kind).max), -1) if accessor.get("normalized", False) else rows

    def scene(self):
        return self.json["scenes"][self.json.get("scene", 0)]

    def placed_nodes(self):
        """Each node of the scene with the matrix to the world from it."""
        waiting = [(index, np.eye(4)) for index in reversed(self.scene().get("nodes", ()))]
        while waiting:
            index, parent = waiting.pop()
            node = self.json["nodes"][index]
            matrix = parent @ local_matrix(node)
            yield node, matrix
            waiting.extend((child, matrix) for child in reversed(node.get("children", ())))
