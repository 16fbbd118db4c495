"""Cameras of Collada."""

import math

import numpy

from conversion.collada_transforms import to_gltf, unit, without_scale
from conversion.collada_xml import described, find
from scene_makers.gltf_document import look_at

COURSE_ASPECT = 4.0 / 3.0  # of its program's window


def add_camera(scene, name, kind, parameters, matrix):
    scene.document.node(name, camera=scene.document.append("cameras", {"name": name, "type": kind, kind: parameters}), matrix=matrix)


def both_halves(scene, element, x, y, aspect, tags):
    """Half the width and the height that a camera sees. Of all three numbers, writers get the aspect ratio wrong."""
    if x is None and y is None:
        scene.refuse("%s has neither <%s> nor <%s>; expected one" % (described(element), *tags))
    aspect = aspect or COURSE_ASPECT
    return x if x is not None else y * aspect, y if y is not None else x / aspect


def write_opening_view(scene, instance, x, y):
    """The course's program looks at the middle of the scene's box, along the camera's place and direction, from 1.5 of its diagonals."""
    box = scene.box()
    size, middle = numpy.linalg.norm(box[1] - box[0]), box.mean(axis=0)
    direction = unit(instance.matrix[:3, 3] - instance.matrix[:3, 2])
    if size == 0.0:
        return
    up = (0.0, 1.0, 0.0) if abs(direction[1]) < 1.0 - 1e-9 else (0.0, 0.0, -1.0)
    y = y if x / y < COURSE_ASPECT else x / COURSE_ASPECT  # it widens the narrower side
    add_camera(scene, "opening view", "perspective", {"yfov": 2.0 * math.atan(y), "aspectRatio": COURSE_ASPECT, "znear": 0.001 * size},
               look_at((middle + 1.5 * size * direction).tolist(), middle.tolist(), up))


def write_camera(scene, instance):
    element = instance.element
    kinds = [(kind, find(element, "optics/technique_common/" + kind)) for kind in ("perspective", "orthographic")]
    kind, optics = next(((kind, optics) for kind, optics in kinds if optics is not None), (None, None))
    if optics is None:
        scene.refuse("%s is neither perspective nor orthographic; expected one of both" % described(element))
    aspect = scene.number(optics, "aspect_ratio", element, 0.0)
    near, far = (scene.number(optics, tag, element) or 0.0 for tag in ("znear", "zfar"))
    near = near * scene.unit if near > 0.0 else 0.01
    far = {"zfar": far * scene.unit} if far * scene.unit > near else {}
    matrix = to_gltf(without_scale(instance.matrix))
    if kind == "orthographic":
        tags = ("xmag", "ymag")
        x, y = both_halves(scene, element, *(scene.number(optics, tag, element, 0.0) for tag in tags), aspect, tags)
        size = {"xmag": x * scene.unit, "ymag": y * scene.unit}
        add_camera(scene, instance.name, kind, {**size, "znear": near, "zfar": 1e6 * near, **far}, matrix)
        return
    tags = ("xfov", "yfov")
    angles = [scene.number(optics, tag, element, 0.0, 180.0) for tag in tags]
    x, y = both_halves(scene, element, *(math.tan(math.radians(angle) / 2.0) if angle else None for angle in angles), aspect, tags)
    if scene.is_course:
        write_opening_view(scene, instance, x, y)
    add_camera(scene, instance.name, kind, {"yfov": 2.0 * math.atan(y), "aspectRatio": x / y, "znear": near, **far}, matrix)
