"""A glTF document that is built up and written deterministically: one buffer, as data URI (.gltf) or chunk (.glb)."""

import base64
import json
import math
import os
import struct

from whole_file import write_whole

FLOAT, SHORT, UNSIGNED_SHORT, UNSIGNED_INT = 5126, 5122, 5123, 5125
WRAPS = {"repeat": 10497, "mirror": 33648, "clamp": 33071}


def to_float32(value):
    return struct.unpack("<f", struct.pack("<f", value))[0]


def pack(code, values):
    return struct.pack("<%d%s" % (len(values), code), *values)


def subtract(a, b):
    return [x - y for x, y in zip(a, b)]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def normalize(v):
    length = math.sqrt(sum(x * x for x in v))
    return [x / length for x in v]


def look_at(eye, target, up=(0.0, 1.0, 0.0)):
    """Column-major node matrix of a camera or light at `eye` whose -Z points at `target`."""
    z = normalize(subtract(eye, target))
    x = normalize(cross(up, z))
    y = cross(z, x)
    return [*x, 0.0, *y, 0.0, *z, 0.0, *map(float, eye), 1.0]


class Document:
    def __init__(self, generator="glim tools/make_scenes.py"):
        self.json = {
            "asset": {"version": "2.0", "generator": generator},
            "scene": 0,
            "scenes": [{"nodes": []}],
            "nodes": [],
        }
        self.extensions = set()
        self.data = bytearray()
        self.files = {}  # what else to write beside the document: names and bytes

    def append(self, collection, entry):
        self.json.setdefault(collection, []).append(entry)
        return len(self.json[collection]) - 1

    def view(self, data, **more):
        self.data.extend(b"\0" * (-len(self.data) % 4))
        entry = {"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data), **more}
        self.data.extend(data)
        return self.append("bufferViews", entry)

    def positions(self, points):
        columns = list(zip(*points))
        return self.append("accessors", {
            "bufferView": self.view(pack("f", [c for p in points for c in p]), target=34962),
            "componentType": FLOAT, "count": len(points), "type": "VEC3",
            "min": [to_float32(min(c)) for c in columns], "max": [to_float32(max(c)) for c in columns]})

    def vectors(self, values):
        """Two to four floats per vertex."""
        return self.append("accessors", {
            "bufferView": self.view(pack("f", [c for v in values for c in v]), target=34962), "componentType": FLOAT,
            "count": len(values), "type": "VEC%d" % len(values[0])})

    def seconds(self, times):
        """Of keyframes, ascending."""
        return self.append("accessors", {
            "bufferView": self.view(pack("f", times)), "componentType": FLOAT, "count": len(times), "type": "SCALAR",
            "min": [times[0]], "max": [times[-1]]})

    def indices(self, indices):
        small = max(indices) < 65535
        return self.append("accessors", {
            "bufferView": self.view(pack("H" if small else "I", indices), target=34963),
            "componentType": UNSIGNED_SHORT if small else UNSIGNED_INT, "count": len(indices), "type": "SCALAR"})

    def material(self, name, color=(0.0, 0.0, 0.0), emission=None, metallic=0.0, roughness=1.0, specular=0.0, ior=None,
                 double_sided=False):
        """Pure Lambert unless told otherwise; `ior` makes it solid, smooth glass of that index."""
        glass = ior is not None
        entry = {"name": name, "pbrMetallicRoughness": {
            "baseColorFactor": [*color, 1.0], "metallicFactor": metallic, "roughnessFactor": 0.0 if glass else roughness}}
        extensions = {}
        if glass:
            extensions["KHR_materials_transmission"] = {"transmissionFactor": 1.0}
            extensions["KHR_materials_volume"] = {"thicknessFactor": 1.0}
            extensions["KHR_materials_ior"] = {"ior": ior}
        elif metallic == 0.0:
            extensions["KHR_materials_specular"] = {"specularFactor": specular}
        if emission is not None:
            strength = max(emission)
            entry["emissiveFactor"] = [e / strength for e in emission]
            extensions["KHR_materials_emissive_strength"] = {"emissiveStrength": strength}  # without it the emission is no light
        if double_sided:
            entry["doubleSided"] = True
        if extensions:
            entry["extensions"] = extensions
            self.extensions.update(extensions)
        return self.append("materials", entry)

    def texture(self, image, wrap=("repeat", "repeat"), nearest=False):
        """Of a PNG file's bytes, or of another texture's image."""
        if isinstance(image, bytes):
            source = self.append("images", {"mimeType": "image/png", "bufferView": self.view(image)})
        else:
            source = self.json["textures"][image]["source"]
        sampler = {"magFilter": 9728 if nearest else 9729, "wrapS": WRAPS[wrap[0]], "wrapT": WRAPS[wrap[1]]}
        if sampler not in self.json.setdefault("samplers", []):
            self.json["samplers"].append(sampler)
        return self.append("textures", {"source": source, "sampler": self.json["samplers"].index(sampler)})

    def use(self, texture, uv_set=0, transform=None, **more):
        """A material's use of a texture; `transform` as in KHR_texture_transform."""
        entry = {"index": texture, **more}
        if uv_set:
            entry["texCoord"] = uv_set
        if transform:
            entry["extensions"] = {"KHR_texture_transform": transform}
            self.extensions.add("KHR_texture_transform")
        return entry

    def surface_material(self, name, color=(1.0, 1.0, 1.0), metallic=0.0, roughness=0.5, alpha=1.0, base=None,
                         metal_rough=None, normal=None, extensions=None, **more):
        """glTF's whole material: `base`, `metal_rough` and `normal` are textures or uses of them, `extensions` lack KHR_materials_."""
        def as_use(texture):
            return {"index": texture} if isinstance(texture, int) else texture
        core = {"baseColorFactor": [*color, alpha], "metallicFactor": metallic, "roughnessFactor": roughness}
        if base is not None:
            core["baseColorTexture"] = as_use(base)
        if metal_rough is not None:
            core["metallicRoughnessTexture"] = as_use(metal_rough)
        entry = {"name": name, "pbrMetallicRoughness": core, **more}
        if normal is not None:
            entry["normalTexture"] = as_use(normal)
        if extensions:
            entry["extensions"] = {"KHR_materials_" + key: value for key, value in extensions.items()}
            self.extensions.update(entry["extensions"])
        return self.append("materials", entry)

    def primitive(self, points, indices, material, **attributes):
        """`attributes`: lists of vectors by their glTF names."""
        names = {"POSITION": self.positions(points)}
        for name, values in attributes.items():
            names[name] = self.vectors(values)
        return {"attributes": names, "indices": self.indices(indices), "material": material}

    def surface(self, name, surface, material, uv=True, **properties):
        """A node with a mesh from surfaces.py."""
        attributes = {"NORMAL": surface.normals, **({"TEXCOORD_0": surface.uvs} if uv else {}), **surface.more}
        primitive = self.primitive(surface.points, surface.indices, material, **attributes)
        return self.node(name, mesh=self.mesh(primitive), **properties)

    def quantized(self, values, code, limit):
        """Vectors of 16 bits, in steps of four bytes."""
        width = len(values[0])
        rows = [[int(math.floor(c * limit + 0.5)) for c in v] + [0] * (width % 2) for v in values]
        view = self.view(pack(code, [c for row in rows for c in row]), target=34962, byteStride=2 * len(rows[0]))
        entry = {"bufferView": view, "componentType": UNSIGNED_SHORT if code == "H" else SHORT, "normalized": True,
                 "count": len(values), "type": "VEC%d" % width}
        return entry, rows

    def small_surface(self, name, surface, material, uv=True):
        """The same with half the bytes (KHR_mesh_quantization). Texture coordinates lie from 0 to 1."""
        self.extensions.add("KHR_mesh_quantization")
        self.json["extensionsRequired"] = ["KHR_mesh_quantization"]
        columns = list(zip(*surface.points))
        middle = [(min(c) + max(c)) / 2.0 for c in columns]
        half = max(max(c) - min(c) for c in columns) / 2.0
        entry, rows = self.quantized([[(c - m) / half for c, m in zip(p, middle)] for p in surface.points], "h", 32767)
        columns = list(zip(*rows))[:3]
        entry.update(min=[min(c) for c in columns], max=[max(c) for c in columns])
        names = {"POSITION": self.append("accessors", entry),
                 "NORMAL": self.append("accessors", self.quantized(surface.normals, "h", 32767)[0])}
        if uv:
            names["TEXCOORD_0"] = self.append("accessors", self.quantized(surface.uvs, "H", 65535)[0])
        for key, values in surface.more.items():
            names[key] = self.append("accessors", self.quantized(values, "H", 65535)[0])
        primitive = {"attributes": names, "indices": self.indices(surface.indices), "material": material}
        return self.node(name, mesh=self.mesh(primitive), translation=middle, scale=[half] * 3)

    def environment(self, file, content, strength=1.0):
        """A map beside the document that lights its scene."""
        self.files[file] = content
        self.json["scenes"][0]["extras"] = {"environment": {"file": file, "strength": strength}}

    def mesh(self, *primitives):
        return self.append("meshes", {"primitives": list(primitives)})

    def node(self, name, **properties):
        index = self.append("nodes", {"name": name, **properties})
        self.json["scenes"][0]["nodes"].append(index)
        return index

    def shape(self, name, points, indices, material, **properties):
        return self.node(name, mesh=self.mesh(self.primitive(points, indices, material)), **properties)

    def quad(self, name, corners, material):
        """Corners counter-clockwise seen from the front."""
        return self.shape(name, corners, [0, 1, 2, 0, 2, 3], material)

    def sphere(self, name, center, radius, material):
        return self.node(name, translation=list(center), extras={"sphere": {"radius": radius, "material": material}})

    def camera(self, name, eye, target, yfov_degrees, aspect):
        camera = self.append("cameras", {"name": name, "type": "perspective", "perspective": {
            "yfov": math.radians(yfov_degrees), "aspectRatio": aspect, "znear": 0.01}})
        return self.node(name, camera=camera, matrix=look_at(eye, target))

    def light(self, name, light, **properties):
        self.extensions.add("KHR_lights_punctual")
        lights = self.json.setdefault("extensions", {}).setdefault("KHR_lights_punctual", {"lights": []})["lights"]
        lights.append({"name": name, **light})
        return self.node(name, extensions={"KHR_lights_punctual": {"light": len(lights) - 1}}, **properties)

    def copy(self, name, node, material, place):
        """The mesh of a node again, with another material and its centre elsewhere."""
        source = self.json["nodes"][node]
        primitive = {**self.json["meshes"][source["mesh"]]["primitives"][0], "material": material}
        return self.node(name, mesh=self.mesh(primitive), translation=list(place), scale=source["scale"])

    def finish(self, embed):
        document = dict(self.json)
        if self.extensions:
            document["extensionsUsed"] = sorted(self.extensions)
        if self.data:
            document["buffers"] = [{"byteLength": len(self.data)}]
            if embed:
                document["buffers"][0]["uri"] = ("data:application/octet-stream;base64," +
                                                 base64.b64encode(bytes(self.data)).decode())
        return document

    def write(self, path):
        if str(path).endswith(".glb"):
            content = to_glb(self.finish(embed=False), bytes(self.data))
        else:
            content = to_text(self.finish(embed=True)).encode()
        for name, file in self.files.items():
            write_whole(os.path.join(os.path.dirname(path), name), file)
        write_whole(path, content)  # last: it names the others


def to_text(document):
    """One line per element of the top level's arrays, so that a change shows as one line in a diff."""
    lines = []
    for key, value in document.items():
        if isinstance(value, list) and value and isinstance(value[0], dict):
            elements = ",\n".join("  " + json.dumps(element) for element in value)
            lines.append('%s: [\n%s\n]' % (json.dumps(key), elements))
        else:
            lines.append("%s: %s" % (json.dumps(key), json.dumps(value)))
    return "{\n" + ",\n".join(lines) + "\n}\n"


def to_glb(document, data):
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    data += b"\0" * (-len(data) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text
    if data:
        chunks += struct.pack("<II", len(data), 0x004E4942) + data
    return struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks
