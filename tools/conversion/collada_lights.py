"""Lights of Collada. Written last: they depend on where the shapes are."""

import math
import os

import numpy

from conversion.collada_materials import course_technique
from conversion.collada_scene import box_of
from conversion.collada_transforms import apply, to_gltf, unit, without_scale
from conversion.collada_xml import described, find, numbers_of, tag_of
from scene_makers import made_images as images
from scene_makers.gltf_document import look_at

SKY_HEIGHT = 256  # rows of a map: they are interpolated, which blurs the horizon by one of them
# Of an area light: a square of side 1 in the node's x and y, which shines along -z.
SQUARE = numpy.array([[-0.5, -0.5, 0.0], [-0.5, 0.5, 0.0], [0.5, 0.5, 0.0], [0.5, -0.5, 0.0]])


def is_alike(a, b):
    """Two boxes of about the same middle and size. Some of the course's area lights are turned by a right angle against the mesh."""
    size = numpy.linalg.norm(b[1] - b[0])
    return numpy.linalg.norm((a - b).mean(axis=0)) < 0.1 * size and abs(numpy.linalg.norm(a[1] - a[0]) - size) < 0.1 * size


class ColladaLights:
    def __init__(self, scene):
        self.scene, self.document = scene, scene.document
        self.ambient, self.squares = numpy.zeros(3), {}

    def write(self, instances):
        for instance in instances:
            self.write_light(instance)
        if self.ambient.any():
            self.write_ambient()

    def write_light(self, instance):
        scene, element = self.scene, instance.element
        technique = course_technique(element)
        technique = technique if technique is not None else find(element, "technique_common")
        light = technique[0] if technique is not None and len(technique) > 0 else None
        color = find(light, "color") if light is not None else None
        if color is None:
            scene.refuse("%s has no <color>; expected one in its technique" % described(element))
        color = numbers_of(scene.path, "<color> of %s" % described(element), color)[:3]
        if len(color) != 3 or min(color) < 0.0:
            scene.refuse("<color> of %s is \"%s\"; expected three numbers from 0" % (described(element), " ".join("%g" % c for c in color)))
        kind = tag_of(light)
        if kind == "ambient":
            self.ambient += color
        elif kind == "area":
            self.write_area_light(instance, color.tolist())
        elif kind == "directional":
            direction = self.direction(instance.matrix)
            up = (0.0, 0.0, 1.0) if abs(direction[1]) > 0.9 else (0.0, 1.0, 0.0)
            self.add(instance.name, kind, color, look_at([0.0] * 3, direction.tolist(), up))
        elif kind in ("point", "spot"):
            more = self.cone(instance, light) if kind == "spot" else {}
            self.add(instance.name, kind, color * self.falloff(instance, light), to_gltf(without_scale(instance.matrix)), **more)
        else:
            scene.warn("%s is left out: it is a <%s>" % (described(element), kind))

    def add(self, name, kind, color, matrix, **more):
        """A light's colour is at most 1 in glTF."""
        strength = float(max(color))
        color = [float(c) / strength for c in color] if strength > 0.0 else [1.0] * 3
        self.document.light(name, {"type": kind, "color": color, "intensity": strength, **more}, matrix=matrix)

    def direction(self, matrix):
        """Where a sun shines: along -z. The course's program adds the node's place to that."""
        return unit(matrix[:3, 2] - matrix[:3, 3]) if self.scene.is_course else unit(-matrix[:3, 2])

    def cone(self, instance, light):
        """The exponent of the cosine has no counterpart: the higher it is, the softer the cone."""
        angle = self.scene.number(light, "falloff_angle", instance.element, 0.0, 180.0 + 1e-9)
        outer = math.radians(180.0 if angle is None else angle) / 2.0
        exponent = self.scene.number(light, "falloff_exponent", instance.element) or 0.0
        return {"spot": {"outerConeAngle": outer, "innerConeAngle": outer * min(0.99, max(0.0, 1.0 - exponent))}}

    def falloff(self, instance, light):
        """The intensity of a light of colour 1. glTF's lights fall with the square of the distance, these by c + l d + q d^2, or in the
        course not at all. Where that differs they agree in the middle of the scene's box."""
        scene, element = self.scene, instance.element
        distance = max(numpy.linalg.norm(scene.box().mean(axis=0) - instance.matrix[:3, 3]), 1e-6 * scene.unit)
        tags = ("constant_attenuation", "linear_attenuation", "quadratic_attenuation")
        constant, linear, quadratic = (scene.number(light, tag, element, -1e-9) for tag in tags)
        constant, linear, quadratic = 1.0 if constant is None else constant, linear or 0.0, quadratic or 0.0
        if scene.is_course:
            constant, linear, quadratic = 1.0, 0.0, 0.0
        if max(constant, linear, quadratic) <= 0.0:
            scene.refuse("the attenuations of %s are 0; expected one above 0" % described(element))
        if constant > 0.0 or linear > 0.0:
            scene.warn("%s does not fall with the square of the distance; it does so in glTF, and is as bright in the middle of the scene"
                       % described(element))
        away = distance / scene.unit
        return distance * distance / (constant + linear * away + quadratic * away * away)

    def write_area_light(self, instance, radiance):
        """In the course it lights, and a mesh in its place is seen. Where light is traced one of them does both."""
        box = box_of(apply(instance.matrix, SQUARE))
        mesh = next((shape for shape in self.scene.shapes if shape.radiances and is_alike(shape.box, box)), None)
        if mesh is not None:
            if mesh.radiances[0] != radiance:
                emitted, own = (" ".join("%g" % c for c in values) for values in (mesh.radiances[0], radiance))
                self.scene.warn("%s is left out: a mesh in its place emits %s instead of %s" % (described(instance.element), emitted, own))
            return
        if not any(radiance):
            return
        key = tuple(radiance)
        if key not in self.squares:
            material = self.document.material(instance.name, emission=radiance)
            self.squares[key] = self.document.mesh(self.document.primitive(SQUARE.tolist(), [0, 1, 2, 0, 2, 3], material))
        self.document.node(instance.name, mesh=self.squares[key], matrix=to_gltf(instance.matrix))

    def write_ambient(self):
        """A map beside the document. Of the .hdr format's eight bits for the brightest channel all are used."""
        most = float(max(self.ambient))
        upper = tuple(int(255.0 * c / most + 0.5) / 128.0 for c in self.ambient)
        lower = (0.0, 0.0, 0.0) if self.scene.is_course else upper
        name = os.path.splitext(os.path.basename(self.scene.path))[0] + "_ambient.hdr"
        sky = images.radiance_map(4, SKY_HEIGHT, lambda azimuth, elevation: upper if elevation > 0.0 else lower)
        self.document.environment(name, sky, most * 128.0 / 255.0)
