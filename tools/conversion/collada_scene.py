"""What the parts of a conversion from Collada share."""

import math

import numpy

from conversion.collada_materials import ColladaMaterials, course_technique
from conversion.collada_xml import described, find, some_numbers
from conversion.errors import ConversionError
from scene_makers.gltf_document import Document


class Instance:
    """Of a geometry, light or camera, in world space. `materials`: <material> by the symbols of a geometry."""

    def __init__(self, name, element, matrix, materials=None):
        self.name, self.element, self.matrix, self.materials = name, element, matrix, materials


class Shape:
    """Of a mesh or a sphere: its box in world space, and what its parts emit by the course's profile."""

    def __init__(self, box, radiances):
        self.box, self.radiances = box, [radiance for radiance in radiances if radiance is not None]


def box_of(points):
    return numpy.array([points.min(axis=0), points.max(axis=0)])


class ColladaScene:
    def __init__(self, path, root, dae, course, say):
        self.path, self.root, self.dae, self.say = path, root, dae, say
        self.is_course = course or any(course_technique(element) is not None for element in self.root.iter())
        self.document = Document("glim tools/to_gltf")
        self.materials = ColladaMaterials(path, root, dae, self.document, say)
        self.unit = self.read_unit()
        self.shapes = []

    def refuse(self, sentence):
        raise ConversionError("%s: %s" % (self.path, sentence))

    def warn(self, sentence):
        self.say("%s: %s" % (self.path, sentence))

    def read_unit(self):
        """In metres."""
        element = find(self.root, "asset/unit")
        text = element.get("meter", "1") if element is not None else "1"
        try:
            metres = float(text)
        except ValueError:
            metres = 0.0
        if not 0.0 < metres < math.inf:
            self.refuse("the meter of <unit> is \"%s\"; expected a number above 0" % text[:40])
        return metres

    def number(self, parent, tag, owner, low=-math.inf, high=math.inf):
        """None if it is missing."""
        child, place = find(parent, tag), "<%s> of %s" % (tag, described(owner))
        if child is None:
            return None
        value, = some_numbers(self.path, place, child, 1).tolist()
        if not low < value < high:
            limits = "above %g%s" % (low, "" if high == math.inf else " and below %g" % high)
            self.refuse("%s is %g; expected a number %s" % (place, value, limits))
        return value

    def box(self):
        """Of all shapes."""
        return box_of(numpy.concatenate([shape.box for shape in self.shapes])) if self.shapes else numpy.zeros((2, 3))
