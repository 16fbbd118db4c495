"""A PLY file, read by trimesh, as a glTF document of one node: its faces, or the points of one that has none."""

import os

import numpy
import trimesh

from conversion.errors import ConversionError
from conversion.ply_points import linear, points_primitive
from conversion.triangulate import triangulate
from scene_makers.gltf_document import Document


def colors_of(rows):
    """Of bytes. Alpha is linear already."""
    return numpy.column_stack([linear(rows[:, :3] / 255.0), rows[:, 3] / 255.0]).tolist()


def polygons_of(mesh):
    """The faces as the file has them, which trimesh keeps beside its own, cut into fans."""
    data = mesh.metadata["_ply_raw"]["face"]["data"]
    names = data if isinstance(data, dict) else data.dtype.names or ()
    for name in ("vertex_index", "vertex_indices"):
        if name in names:
            return data[name] if isinstance(data, dict) else data[name]["f1"]
    return mesh.faces


def corners_of(mesh):
    """Indices of vertices, three for each triangle."""
    polygons = polygons_of(mesh)
    if all(len(polygon) == 3 for polygon in polygons):
        return mesh.faces.reshape(-1).tolist()
    points, corners = mesh.vertices.tolist(), []
    for polygon in polygons:
        for triangle in triangulate([points[v] for v in polygon]):
            corners += [int(polygon[i]) for i in triangle]
    return corners


def faces_primitive(path, mesh, document, say):
    normals = mesh.vertex_normals if "vertex_normals" in mesh._cache.cache else None  # else trimesh would make smooth ones
    attributes, vertices, faces = {}, mesh.vertices, mesh.faces
    kind = mesh.visual.kind
    if kind == "texture":
        say("the texture of %s is left out" % path)
    if kind == "face":  # colours of faces: each gets vertices of its own
        attributes["COLOR_0"] = colors_of(mesh.visual.face_colors.repeat(3, axis=0))
        vertices, normals = vertices[faces.reshape(-1)], None if normals is None else normals[faces.reshape(-1)]
        faces = range(len(vertices))
    else:
        faces = corners_of(mesh)
        if kind == "vertex":
            attributes["COLOR_0"] = colors_of(mesh.visual.vertex_colors)
    if normals is not None:
        attributes["NORMAL"] = normals.tolist()
    grey = 1.0 if "COLOR_0" in attributes else 0.8
    material = document.surface_material("default", [grey] * 3, roughness=1.0, doubleSided=True)
    return document.primitive(vertices.tolist(), list(faces), material, **attributes)


def ply_to_gltf(path, say):
    try:
        mesh = trimesh.load(path, file_type="ply", process=False, fix_texture=False)
    except Exception as error:  # trimesh raises what its parsers happen to meet
        raise ConversionError("%s: trimesh cannot read it (%s); expected PLY" % (path, error))
    document = Document("glim tools/to_gltf")
    if isinstance(mesh, trimesh.Trimesh) and len(mesh.faces) > 0:
        primitive = faces_primitive(path, mesh, document, say)
    else:
        primitive = points_primitive(path, mesh.metadata.get("_ply_raw", {}).get("vertex", {}), document, say)
    document.node(os.path.splitext(os.path.basename(path))[0], mesh=document.mesh(primitive))
    return document
