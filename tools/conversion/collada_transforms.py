"""The transforms of Collada's nodes as matrices, for columns. pycollada's are of float32, and its <lookat> is no camera's place."""

import math

import numpy

from conversion.collada_xml import described, some_numbers, tag_of
from conversion.errors import ConversionError
from scene_makers.gltf_document import look_at


def from_rows(rows, translation=(0.0, 0.0, 0.0)):
    matrix = numpy.identity(4)
    matrix[:3, :3], matrix[:3, 3] = rows, translation
    return matrix


def to_gltf(matrix):
    """Column by column."""
    return matrix.T.reshape(-1).tolist()


def apply(matrix, points):
    return points @ matrix[:3, :3].T + matrix[:3, 3]


def unit(v):
    length = numpy.linalg.norm(v)
    return v / length if length > 0.0 else numpy.array([0.0, 0.0, 1.0])


def without_scale(matrix):
    """Of a camera or a light, which it does not change."""
    z = unit(matrix[:3, 2])
    x = unit(numpy.cross(matrix[:3, 1], z))
    return from_rows(numpy.array([x, numpy.cross(z, x), z]).T, matrix[:3, 3])


def rotate(x, y, z, degrees):
    """Rodrigues' formula."""
    axis, angle = unit(numpy.array([x, y, z])), math.radians(degrees)
    across = numpy.array([[0.0, -axis[2], axis[1]], [axis[2], 0.0, -axis[0]], [-axis[1], axis[0], 0.0]])
    return from_rows(numpy.identity(3) + math.sin(angle) * across + (1.0 - math.cos(angle)) * across @ across)


def look(*v):
    return numpy.array(look_at(v[:3], v[3:6], v[6:])).reshape(4, 4).T


def skew(degrees, *v):
    """What lies along the first axis leans towards the second one by the angle (RenderMan's RiSkew, which Collada names)."""
    return from_rows(numpy.identity(3) + math.tan(math.radians(degrees)) * numpy.outer(unit(numpy.array(v[3:])), unit(numpy.array(v[:3]))))


# By tags: how many numbers, and their matrix.
TRANSFORMS = {"matrix": (16, lambda *v: numpy.array(v).reshape(4, 4)), "translate": (3, lambda *v: from_rows(numpy.identity(3), v)),
              "scale": (3, lambda *v: from_rows(numpy.diag(v))), "rotate": (4, rotate), "lookat": (9, look), "skew": (7, skew)}


def matrix_of(path, node):
    """All of a node's, in their order."""
    matrix = numpy.identity(4)
    for element in node:
        count, make = TRANSFORMS.get(tag_of(element), (0, None))
        if make is not None:
            place = "<%s> of %s" % (tag_of(element), described(node))
            try:
                matrix = matrix @ make(*some_numbers(path, place, element, count).tolist())
            except ZeroDivisionError:
                raise ConversionError("%s: %s has no direction; expected two points, and an up across them" % (path, place))
    if not numpy.allclose(matrix[3], [0.0, 0.0, 0.0, 1.0]):
        raise ConversionError("%s: the matrix of %s has another last row than 0 0 0 1" % (path, described(node)))
    return matrix
