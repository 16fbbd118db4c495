"""A glTF document that is built up and written deterministically: one buffer, as data URI (.gltf) or chunk (.glb)."""

import base64
import json
import math
import os
import struct

FLOAT, UNSIGNED_SHORT, UNSIGNED_INT = 5126, 5123, 5125


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
    def __init__(self):
        self.json = {
            "asset": {"version": "2.0", "generator": "glim tools/make_scenes.py"},
            "scene": 0,
            "scenes": [{"nodes": []}],
            "nodes": [],
        }
        self.extensions = set()
        self.data = bytearray()

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
            if strength != 1.0:
                extensions["KHR_materials_emissive_strength"] = {"emissiveStrength": strength}
        if double_sided:
            entry["doubleSided"] = True
        if extensions:
            entry["extensions"] = extensions
            self.extensions.update(extensions)
        return self.append("materials", entry)

    def primitive(self, points, indices, material):
        return {"attributes": {"POSITION": self.positions(points)}, "indices": self.indices(indices),
                "material": material}

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
        write_whole(path, content)


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


def write_whole(path, content):
    temporary = "%s.part" % path
    with open(temporary, "wb") as file:
        file.write(content)
    os.replace(temporary, path)
