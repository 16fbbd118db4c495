"""An OBJ file with its materials as a glTF document: a node for each object, a primitive for each of its materials."""

import os

from conversion.colors import to_linear
from conversion.read_mtl import MaterialWriter, read_mtl
from conversion.read_obj import read_obj
from conversion.smooth import give_normals
from conversion.triangulate import triangulate
from scene_makers.gltf_document import Document


def add_primitive(document, obj, faces, material):
    vertices, indices = {}, []
    for face in faces:
        for triangle in triangulate([obj.vertices[v] for v, _, _ in face.corners]):
            indices += [vertices.setdefault(face.corners[i], len(vertices)) for i in triangle]
    attributes = {"NORMAL": [obj.normals[n] for _, _, n in vertices]}
    if any(uv is not None for _, uv, _ in vertices):
        uvs = [obj.uvs[uv] if uv is not None else [0.0, 0.0] for _, uv, _ in vertices]
        attributes["TEXCOORD_0"] = [[u, 1.0 - v] for u, v in uvs]  # OBJ counts from the bottom
    if any(obj.colors[v] for v, _, _ in vertices):
        attributes["COLOR_0"] = [[to_linear(c) for c in obj.colors[v] or [1.0] * 3] for v, _, _ in vertices]
    return document.primitive([obj.vertices[v] for v, _, _ in vertices], indices, material, **attributes)


def read_materials(path, obj, say):
    materials = {}
    for name in obj.libraries:
        library = os.path.join(os.path.dirname(path), name.replace("\\", "/"))
        try:
            materials.update(read_mtl(library))
        except OSError as error:
            say("the materials of %s are left out: it cannot be read (%s)" % (library, error.strerror))
    return materials


def obj_to_gltf(path, say):
    obj = read_obj(path)
    give_normals(obj)
    known = read_materials(path, obj, say)
    document = Document("glim tools/to_gltf")
    writer = MaterialWriter(document, say)
    groups, materials = {}, {}
    for face in obj.faces:
        groups.setdefault(face.object, {}).setdefault(face.material, []).append(face)
    for name, parts in groups.items():
        primitives = []
        for material, faces in parts.items():
            if material not in materials:
                if material is not None and material not in known:
                    say("the material \"%s\" is drawn grey: no library that was read has it" % material)
                materials[material] = writer.write(material or "default", known.get(material, {"path": path, "folder": ""}))
            primitives.append(add_primitive(document, obj, faces, materials[material]))
        document.node(name or os.path.splitext(os.path.basename(path))[0], mesh=document.mesh(*primitives))
    return document
