"""Reads a Collada file: checks it, then has pycollada read geometries and effects. pycollada takes NaN for 0, leaves counts unread, follows
every entity of XML, and gives up a whole file for a camera that has no <znear>."""

import io
import warnings
import xml.etree.ElementTree as ElementTree
from xml.parsers import expat

import collada
import numpy

from conversion.collada_xml import children, described, find, numbers_of, tag_of, whole_number
from conversion.errors import ConversionError

MOST_LEVELS = 200  # of elements: readers of trees recurse
# Which attribute of an element names another one, and of which kinds.
REFERENCES = {"instance_geometry": ("url", "geometry"), "instance_light": ("url", "light"), "instance_camera": ("url", "camera"),
              "instance_node": ("url", "node"), "instance_controller": ("url", "controller"), "instance_effect": ("url", "effect"),
              "instance_visual_scene": ("url", "visual_scene"), "instance_material": ("target", "material"),
              "input": ("source", "source", "vertices"), "accessor": ("source", "float_array", "Name_array", "IDREF_array")}
PYCOLLADA = ("asset", "library_images", "library_effects", "library_materials", "library_geometries")
PRIMITIVES = ("triangles", "tristrips", "trifans", "polylist", "polygons")


def parse(path, content):
    """The root. Documents with a DTD are refused: Collada has none, and entities of a few lines may expand to gigabytes or read files."""
    parser, levels = expat.ParserCreate(), [0]

    def refuse(*_):
        raise ConversionError("%s, line %d: it has a document type declaration; expected none" % (path, parser.CurrentLineNumber))

    def descend(*_):
        levels[0] += 1
        if levels[0] > MOST_LEVELS:
            raise ConversionError("%s, line %d: its elements are nested more than %d deep" % (path, parser.CurrentLineNumber, MOST_LEVELS))

    def ascend(*_):
        levels[0] -= 1

    parser.StartDoctypeDeclHandler, parser.StartElementHandler, parser.EndElementHandler = refuse, descend, ascend
    try:
        parser.Parse(content, True)
        root = ElementTree.fromstring(content)
    except expat.ExpatError as error:
        raise ConversionError("%s, line %d: it is not XML (%s); expected Collada" % (path, error.lineno, expat.ErrorString(error.code)))
    except (ValueError, LookupError) as error:
        raise ConversionError("%s: it is in an encoding that cannot be read (%s)" % (path, error))
    if tag_of(root) != "COLLADA":
        raise ConversionError("%s: its root is %s; expected <COLLADA>" % (path, described(root)))
    return root


class Checker:
    def __init__(self, path, root):
        self.path, self.root = path, root
        self.ids = {}
        for element in root.iter():
            if element.get("id") is not None:
                self.ids.setdefault(element.get("id"), element)

    def refuse(self, sentence):
        raise ConversionError("%s: %s" % (self.path, sentence))

    def check(self):
        for library in self.root:
            unread = tag_of(library) in ("library_animations", "library_controllers", "library_physics_scenes", "library_physics_models")
            for element in library.iter():
                tag = tag_of(element)
                if tag in REFERENCES and (tag.startswith("instance_") or not unread):  # a scene may instance nodes anywhere
                    self.check_reference(element, *REFERENCES[tag])
        if find(self.root, "scene/instance_visual_scene") is None:
            self.refuse("it has no <scene> with an <instance_visual_scene>; expected one")
        for library in children(self.root, "library_geometries"):
            for geometry in children(library, "geometry"):
                for mesh in children(geometry, "mesh"):
                    self.check_mesh(geometry, mesh)

    def check_reference(self, element, attribute, *kinds):
        value = element.get(attribute, "")
        target = self.ids.get(value[1:]) if value.startswith("#") else None
        if target is None or tag_of(target) not in kinds:
            expected = "# and the id of a <%s> in this file" % kinds[0]
            self.refuse("the %s of %s is \"%s\"; expected %s" % (attribute, described(element), value[:80], expected))

    def check_mesh(self, geometry, mesh):
        sizes = {}
        for source in children(mesh, "source"):
            sizes[source.get("id")] = self.check_source(source)
        for vertices in children(mesh, "vertices"):
            sources = [element.get("source", "#")[1:] for element in children(vertices, "input")]
            sizes[vertices.get("id")] = min((sizes.get(source, 0) for source in sources), default=0)
        for primitive in children(mesh, *PRIMITIVES):
            self.check_primitive("<%s> of %s" % (tag_of(primitive), described(geometry)), primitive, sizes)

    def check_source(self, source):
        """How many elements it has."""
        array, accessor = find(source, "float_array"), find(source, "technique_common/accessor")
        if array is None or accessor is None:
            self.refuse("%s has no <float_array> with an <accessor>; expected both" % described(source))
        length = len(numbers_of(self.path, "<float_array> of %s" % described(source), array))
        if whole_number(self.path, array, "count") != length:
            self.refuse("<float_array> of %s holds %d numbers; expected %s, its count" % (described(source), length, array.get("count")))
        count, stride = whole_number(self.path, accessor, "count"), whole_number(self.path, accessor, "stride", "1")
        if whole_number(self.path, accessor, "offset", "0") != 0 or stride != len(children(accessor, "param")):
            self.refuse("<accessor> of %s skips numbers; expected an offset of 0 and a <param> for each of its stride" % described(source))
        if count * stride != length:
            self.refuse("<accessor> of %s reads %d times %d numbers; expected %d in all" % (described(source), count, stride, length))
        return count

    def check_primitive(self, place, primitive, sizes):
        inputs = [(whole_number(self.path, element, "offset"), element.get("source", "#")[1:]) for element in children(primitive, "input")]
        if not inputs:
            self.refuse("%s has no <input>; expected one of the semantic VERTEX" % place)
        width, tag = 1 + max(offset for offset, _ in inputs), tag_of(primitive)
        lists = [numbers_of(self.path, "<p> of %s" % place, p, numpy.int64) for p in children(primitive, "p")]
        for indices in lists:
            if len(indices) % width != 0:
                self.refuse("<p> of %s holds %d indices; expected a multiple of %d, one for each offset" % (place, len(indices), width))
            for offset, source in inputs:
                part = indices[offset::width]
                bad = part[(part < 0) | (part >= sizes.get(source, 0))]
                if len(bad) > 0:
                    size = sizes.get(source, 0)
                    self.refuse("<p> of %s names element %d of \"%s\"; expected one below %d" % (place, bad[0], source, size))
        corners = [len(indices) // width for indices in lists]
        if tag == "polylist":
            vcounts = find(primitive, "vcount")
            corners = numbers_of(self.path, "<vcount> of %s" % place, vcounts, numpy.int64).tolist() if vcounts is not None else []
            if len(lists) != 1 or min(corners, default=0) < 0 or sum(corners) * width != len(lists[0]):
                self.refuse("<p> of %s holds %d indices; expected %d, those of its <vcount>"
                            % (place, sum(map(len, lists)), sum(corners) * width))
        elif tag == "triangles":
            if len(lists) != 1 or corners[0] % 3 != 0:
                self.refuse("%s has %d corners in %d <p>; expected a multiple of 3 in one" % (place, sum(corners), len(lists)))
            corners = [3] * (corners[0] // 3)
        if min(corners, default=3) < 3:
            self.refuse("%s has a polygon of %d corners; expected 3 or more" % (place, min(corners)))
        if whole_number(self.path, primitive, "count", str(len(corners))) != len(corners):
            self.refuse("%s has %d polygons; expected %s, its count" % (place, len(corners), primitive.get("count")))


def read_collada(path, say):
    """Its root, and pycollada's document."""
    with open(path, "rb") as file:
        root = parse(path, file.read())
    Checker(path, root).check()
    part = ElementTree.Element(root.tag, root.attrib)
    part.extend(children(root, *PYCOLLADA))
    content = io.BytesIO(ElementTree.tostring(part))
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of numpy, about how pycollada reads numbers
            document = collada.Collada(content, ignore=[collada.common.DaeUnsupportedError, collada.common.DaeBrokenRefError])
    except Exception as error:  # pycollada raises what its parsers happen to meet
        raise ConversionError("%s: pycollada cannot read it (%s)" % (path, " ".join(str(error).split()) or type(error).__name__))
    for error in document.errors:
        say("%s: a part is left out (%s)" % (path, " ".join(error.msg.split())))
    for library in children(root, "library_animations"):
        for animation in children(library, "animation"):
            say("%s: %s is left out" % (path, described(animation)))
    return root, document
