"""The vertices of a PLY file without faces as points of glTF. There may be millions: they stay arrays."""

import numpy

from conversion.colors import to_linear
from conversion.errors import ConversionError
from scene_makers.gltf_document import FLOAT

COLORS = (("red", "green", "blue"), ("diffuse_red", "diffuse_green", "diffuse_blue"), ("r", "g", "b"))
ALPHAS = ("alpha", "diffuse_alpha", "a")


def columns(data, names):
    """Of properties with these names; None unless all are there."""
    known = data if isinstance(data, dict) else data.dtype.names or ()
    return numpy.column_stack([data[name] for name in names]) if all(name in known for name in names) else None


def shares(values, kind):
    """Of the greatest value that a property of PLY may have; a float is a share already."""
    kind = numpy.dtype(kind)
    values = values.astype(float) / (numpy.iinfo(kind).max if kind.kind in "iu" else 1.0)
    return numpy.clip(numpy.nan_to_num(values), 0.0, 1.0)


def linear(values):
    steps, places = numpy.unique(values, return_inverse=True)  # of bytes there are few
    return numpy.array([to_linear(step) for step in steps.tolist()])[places].reshape(values.shape)


def colors_of(element):
    """Linear ones, with alpha where the file has it; None without colours."""
    for names, alpha in zip(COLORS, ALPHAS):
        rows = columns(element["data"], names)
        if rows is not None:
            kinds = element["properties"]
            opacity = columns(element["data"], [alpha])
            return numpy.column_stack([linear(shares(rows, kinds[names[0]]))] +
                                      ([shares(opacity, kinds[alpha])] if opacity is not None else []))
    return None


def accessor(document, rows, **more):
    view = document.view(rows.astype("<f4").tobytes(), target=34962)
    entry = {"bufferView": view, "componentType": FLOAT, "count": len(rows), "type": "VEC%d" % rows.shape[1]}
    return document.append("accessors", {**entry, **more})


def points_primitive(path, element, document, say):
    """`element`: the vertices as trimesh reads them."""
    if element.get("data") is None:
        raise ConversionError("%s: it holds neither faces nor vertices; expected one of both" % path)
    points = columns(element["data"], "xyz")
    if points is None:
        raise ConversionError("%s: its vertices have no x, y and z; expected all three" % path)
    if len(points) != element["length"]:
        raise ConversionError("%s: it holds %d vertices; expected %d, as its header says" % (path, len(points), element["length"]))
    points = points.astype(float).astype(numpy.float32)
    kept = numpy.isfinite(points).all(axis=1)
    if not kept.any():
        raise ConversionError("%s: it holds no finite point; expected at least one" % path)
    if not kept.all():
        say("%d points of %s are left out: they are not finite" % (len(kept) - kept.sum(), path))
    points, colors, normals = points[kept], colors_of(element), columns(element["data"], ("nx", "ny", "nz"))
    attributes = {"POSITION": accessor(document, points, min=points.min(axis=0).tolist(), max=points.max(axis=0).tolist())}
    if normals is not None:
        normals = normals.astype(float)[kept]
        lengths = numpy.linalg.norm(normals, axis=1, keepdims=True)
        if numpy.all(lengths > 0.0) and numpy.isfinite(lengths).all():
            attributes["NORMAL"] = accessor(document, normals / lengths)
        else:
            say("the normals of %s are left out: some have no direction" % path)
    if colors is not None:
        attributes["COLOR_0"] = accessor(document, colors[kept])
    grey = 0.8 if colors is None else 1.0
    material = document.surface_material("default", [grey] * 3, roughness=1.0, doubleSided=True)
    return {"attributes": attributes, "mode": 0, "material": material}
