"""Geometries of Collada, read by pycollada, as attributes and indices of glTF."""

import collada
import numpy

from conversion.triangulate import triangulate


def triangles_of(primitive):
    """Rows of three corners; a corner has an index for each offset."""
    if isinstance(primitive, collada.triangleset.TriangleSet):
        return primitive.index
    width = primitive.index.shape[-1] if primitive.index.ndim > 1 else primitive.nindices
    corners, counts = primitive.index.reshape(-1, width), primitive.vcounts
    if len(counts) == 0 or counts.max() == 3:
        return corners.reshape(-1, 3, width)
    source = primitive.sources["VERTEX"][0]
    points = source[4].data.astype(float)[corners[:, source[0]]].tolist()
    rows, first = [], 0
    for count in counts.tolist():
        rows += [[first + i for i in triangle] for triangle in triangulate(points[first:first + count])]
        first += count
    return corners[numpy.array(rows)]


def unit(vectors):
    lengths = numpy.linalg.norm(vectors, axis=1, keepdims=True)
    return numpy.where(lengths > 0.0, vectors / numpy.where(lengths > 0.0, lengths, 1.0), [0.0, 0.0, 1.0])


def smooth_normals(points, triangles):
    """At each point the sum of the normals of the triangles there, by their areas."""
    a, b, c = (points[triangles[:, k]] for k in range(3))
    sums = numpy.zeros_like(points)
    for k in range(3):
        numpy.add.at(sums, triangles[:, k], numpy.cross(b - a, c - a))
    return unit(sums)


class Part:
    """What of a geometry has one material's symbol."""

    def __init__(self, symbol, points, indices, attributes):
        self.symbol, self.points, self.indices, self.attributes = symbol, points, indices, attributes


def make_part(primitive, smooth):
    """`smooth`: without the file's normals, as the course's programs read it."""
    triangles = triangles_of(primitive)
    if len(triangles) == 0:
        return None
    semantics = ["VERTEX"] + [semantic for semantic in ("NORMAL", "TEXCOORD") if semantic in primitive.sources]
    if smooth and "NORMAL" in semantics:
        semantics.remove("NORMAL")
    sources = {semantic: primitive.sources[semantic][0] for semantic in semantics}
    keys = triangles[:, :, [source[0] for source in sources.values()]].reshape(-1, len(sources))
    _, firsts, inverse = numpy.unique(keys, axis=0, return_index=True, return_inverse=True)
    order = numpy.argsort(firsts)  # vertices as the file first names them
    rank = numpy.empty_like(order)
    rank[order] = numpy.arange(len(order))
    vertices, indices = keys[firsts[order]], rank[inverse.reshape(-1)]
    values = {semantic: source[4].data.astype(float)[vertices[:, k]] for k, (semantic, source) in enumerate(sources.items())}
    attributes = {}
    if smooth:
        attributes["NORMAL"] = smooth_normals(values["VERTEX"], indices.reshape(-1, 3))
    elif "NORMAL" in values:
        attributes["NORMAL"] = unit(values["NORMAL"])
    if "TEXCOORD" in values:
        attributes["TEXCOORD_0"] = values["TEXCOORD"][:, :2] * [1.0, -1.0] + [0.0, 1.0]  # Collada counts from the bottom
    return Part(primitive.material, values["VERTEX"], indices, {name: rows.tolist() for name, rows in attributes.items()})


def parts_of(geometry, smooth, say):
    parts = []
    for primitive in geometry.primitives:
        if isinstance(primitive, collada.lineset.LineSet):
            say("the lines of \"%s\" are left out" % geometry.id)
            continue
        if "COLOR" in primitive.sources:
            say("the colours of the vertices of \"%s\" are left out" % geometry.id)
        parts.append(make_part(primitive, smooth))
    return [part for part in parts if part is not None]
