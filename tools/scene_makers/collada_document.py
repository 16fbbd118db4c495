"""A Collada file that is built up and written deterministically, with the elements of the course's profile; and the same scene as a glTF
document has it."""

import math
import struct
from xml.sax.saxutils import escape, quoteattr

IDENTITY = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]]
# From y up to the course's axes.
FROM_Y = {"Y_UP": IDENTITY, "Z_UP": [[-1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]]}


def spaced(values):
    return " ".join("%.9g" % value for value in values)


def product(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(4)) for j in range(4)] for i in range(4)]


def element(tag, content="", **attributes):
    """`content` is XML already."""
    return "<%s%s>%s</%s>" % (tag, "".join(" %s=%s" % (key, quoteattr(str(value))) for key, value in attributes.items()), content, tag)


def source(name, components, rows):
    """Rows of as many numbers as `components` has letters."""
    array = element("float_array", spaced(c for row in rows for c in row), id=name + "-array", count=len(rows) * len(components))
    params = "".join(element("param", name=c, type="float") for c in components)
    accessor = element("accessor", params, source="#%s-array" % name, count=len(rows), stride=len(components))
    return element("source", array + element("technique_common", accessor), id=name)


class ColladaDocument:
    def __init__(self, up="Z_UP", profile="CGL"):
        self.up, self.profile = up, profile
        self.libraries = {name: [] for name in ("cameras", "lights", "images", "effects", "materials", "geometries", "nodes")}
        self.nodes = []

    def extra(self, content):
        return element("extra", element("technique", content, profile=self.profile))

    def material(self, name, bsdf="", common=None):
        """`bsdf`: an element of the profile; `common`: one of profile_COMMON."""
        common = common or element("lambert", element("diffuse", element("color", "0.5 0.5 0.5 1")))
        profile = element("profile_COMMON", element("technique", common, sid="common"))
        self.libraries["effects"].append(element("effect", profile + (self.extra(bsdf) if bsdf else ""), id=name + "-effect"))
        self.libraries["materials"].append(element("material", element("instance_effect", url="#%s-effect" % name), id=name, name=name))

    def diffuse(self, name, color):
        self.material(name, common=element("lambert", element("diffuse", element("color", spaced([*color, 1.0])))))

    def mesh(self, name, points, polygons, normals=None):
        """`polygons`: lists of vertices; `normals`: one for each vertex."""
        sources = source(name + "-positions", "XYZ", points)
        inputs = element("input", semantic="VERTEX", source="#%s-vertices" % name, offset=0)
        if normals is not None:
            sources += source(name + "-normals", "XYZ", normals)
            inputs += element("input", semantic="NORMAL", source="#%s-normals" % name, offset=1)
        vertices = element("vertices", element("input", semantic="POSITION", source="#%s-positions" % name), id=name + "-vertices")
        indices = [i for polygon in polygons for i in polygon for _ in range(1 if normals is None else 2)]
        faces = inputs + element("vcount", spaced(map(len, polygons))) + element("p", spaced(indices))
        self.geometry(name, element("mesh", sources + vertices + element("polylist", faces, material="surface", count=len(polygons))))

    def sphere(self, name, radius):
        self.geometry(name, self.extra(element("sphere", element("radius", "%.9g" % radius))))

    def geometry(self, name, content):
        self.libraries["geometries"].append(element("geometry", content, id=name, name=name))

    def camera(self, name, **numbers):
        """Of xfov, yfov (degrees), aspect_ratio, znear, zfar."""
        numbers = {"znear": 0.01, "zfar": 100.0, **numbers}
        perspective = element("perspective", "".join(element(key, "%.9g" % value) for key, value in numbers.items()))
        self.libraries["cameras"].append(element("camera", element("optics", element("technique_common", perspective)), id=name, name=name))

    def light(self, name, kind, color, more="", extra=""):
        common = element("technique_common", element(kind, element("color", spaced(color)) + more))
        self.libraries["lights"].append(element("light", common + (self.extra(extra) if extra else ""), id=name, name=name))

    def area_light(self, name, radiance):
        """The course's, with the point light that other programs see."""
        more = element("constant_attenuation", "1") + element("linear_attenuation", "0") + element("quadratic_attenuation", "0")
        self.light(name, "point", radiance, more, element("area", element("color", spaced(radiance))))

    def node(self, name, kind, target, matrix=None, material=None, transforms=None):
        """`kind`: geometry, camera, light or node. `matrix`: rows, y up; else `transforms`: XML, as the file has them."""
        content = transforms or element("matrix", spaced(c for row in product(FROM_Y[self.up], matrix or IDENTITY) for c in row))
        bound = ""
        if material is not None:
            instance = element("instance_material", symbol="surface", target="#" + material)
            bound = element("bind_material", element("technique_common", instance))
        self.nodes.append(element("node", content + element("instance_" + kind, bound, url="#" + target), id=name + "-node", name=name))

    def text(self):
        asset = element("asset", element("unit", name="meter", meter="1") + element("up_axis", self.up))
        lines = [asset]
        for name, entries in self.libraries.items():
            if entries:
                lines += ["<library_%s>" % name, *entries, "</library_%s>" % name]
        lines += ["<library_visual_scenes>", "<visual_scene id=\"scene\">", *self.nodes, "</visual_scene>", "</library_visual_scenes>",
                  element("scene", element("instance_visual_scene", url="#scene"))]
        root = "<COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" version=\"1.4.1\">"
        return "\n".join(["<?xml version=\"1.0\" encoding=\"utf-8\"?>", root, *lines, "</COLLADA>", ""])


def read_accessor(document, index):
    accessor = document.json["accessors"][index]
    width = 1 if accessor["type"] == "SCALAR" else int(accessor["type"][-1])
    code = {5126: "f", 5125: "I", 5123: "H"}[accessor["componentType"]]
    start = document.json["bufferViews"][accessor["bufferView"]]["byteOffset"]
    numbers = struct.unpack_from("<%d%s" % (accessor["count"] * width, code), document.data, start)
    return [list(numbers[i:i + width]) for i in range(0, len(numbers), width)]


def add_material(collada, name, entry):
    core, extensions = entry["pbrMetallicRoughness"], entry.get("extensions", {})
    color = core["baseColorFactor"][:3]
    if "emissiveFactor" in entry:
        strength = extensions["KHR_materials_emissive_strength"]["emissiveStrength"]
        collada.material(name, element("emission", element("radiance", spaced(strength * e for e in entry["emissiveFactor"]))))
    elif "KHR_materials_ior" in extensions:
        collada.material(name, element("glass", element("reflectance", "1 1 1") + element("transmittance", spaced(color)) +
                                       element("roughness", "0") + element("ior", "%.9g" % extensions["KHR_materials_ior"]["ior"])))
    elif core["metallicFactor"] == 1.0 and core["roughnessFactor"] == 0.0:
        collada.material(name, element("mirror", element("reflectance", spaced(color))))
    elif core["metallicFactor"] == 1.0:
        eta = [(1.0 + math.sqrt(c)) / (1.0 - math.sqrt(c)) for c in color]  # with k = 0, of that reflectance at normal incidence
        collada.material(name, element("microfacet", element("alpha", "%.9g" % core["roughnessFactor"] ** 2) + element("eta", spaced(eta)) +
                                       element("k", "0 0 0")))
    else:
        collada.diffuse(name, color)


def to_rows(node):
    columns = node.get("matrix")
    if columns is None:
        columns = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, *node.get("translation", [0.0] * 3), 1.0]
    return [columns[i::4] for i in range(4)]


def to_collada(document, up="Z_UP", profile="CGL"):
    """The scene of small_scenes.py: meshes of one primitive, spheres and cameras. Of its materials the course's."""
    collada = ColladaDocument(up, profile)
    materials = ["material-%d" % i for i in range(len(document.json["materials"]))]
    for name, entry in zip(materials, document.json["materials"]):
        add_material(collada, name, entry)
    for i, node in enumerate(document.json["nodes"]):
        name, target = escape(node["name"]), "object-%d" % i
        if "camera" in node:
            perspective = document.json["cameras"][node["camera"]]["perspective"]
            x = math.atan(math.tan(0.5 * perspective["yfov"]) * perspective["aspectRatio"])
            collada.camera(target, xfov=math.degrees(2.0 * x), aspect_ratio=perspective["aspectRatio"])
            collada.node(name, "camera", target, to_rows(node))
        elif "mesh" in node:
            primitive, = document.json["meshes"][node["mesh"]]["primitives"]
            indices = [i for (i,) in read_accessor(document, primitive["indices"])]
            collada.mesh(target, read_accessor(document, primitive["attributes"]["POSITION"]),
                         [indices[i:i + 3] for i in range(0, len(indices), 3)])
            collada.node(name, "geometry", target, to_rows(node), materials[primitive["material"]])
        else:
            sphere = node["extras"]["sphere"]
            collada.sphere(target, sphere["radius"])
            collada.node(name, "geometry", target, to_rows(node), materials[sphere["material"]])
    return collada
