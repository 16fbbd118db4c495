"""Mutants of Collada for tools/to_gltf: each converts or is refused with one sentence, within a second and a gibibyte. By hand, within the
environment that tools/to_gltf makes: build/to_gltf/bin/python tests/tools/collada_mutants.py [RUNS [SEED]]"""

import copy
import json
import os
import random
import resource
import sys
import tempfile
import time
import xml.etree.ElementTree as ElementTree

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [os.path.join(os.path.dirname(os.path.dirname(HERE)), "tools")]
from conversion.collada_to_gltf import collada_to_gltf  # noqa: E402
from conversion.errors import ConversionError  # noqa: E402
from scene_makers import made_images as images  # noqa: E402
from scene_makers.collada_document import ColladaDocument, element, source  # noqa: E402

MOST_BYTES, MOST_SECONDS = 16384, 1.0
NUMBERS = ["0", "-1", "1", "2", "3", "0.5", "90", "180", "1e-30", "-1e30", "1e38", "1e39", "1e308", "1e309", "nan", "inf", "-inf",
           "4000000000", "99999999999999999999", "0x10", "1_0", "", "x", "\u0663", "1 2", "0 0 0", "1 1 1 1",
           "0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15"]
TEXTS = ["Z_UP", "X_UP", "CGL", "CMU462", "VERTEX", "NORMAL", "TEXCOORD", "COLOR", "POSITION", "A_ONE", "RGB_ZERO", "common", "1.5.0", "#",
         "picture.png", "%00", "/dev", "file:///picture.png", "a\nb", "\u009b31m", "x" * 3000]


def shape(name, faces, more=""):
    points = source(name + "-positions", "XYZ", [[0, 0, 0], [2, 0, 0], [2, 1, 0], [1, 1, 0], [1, 2, 1], [0, 2, 0]])
    normals = source(name + "-normals", "XYZ", [[0, 0, 1], [0, 1, 1]])
    uvs = source(name + "-uvs", "ST", [[0, 0.25], [1, 0.25], [0, 1]])
    vertices = element("vertices", element("input", semantic="POSITION", source="#%s-positions" % name), id=name + "-vertices")
    return element("geometry", element("mesh", points + normals + uvs + vertices + faces) + more, id=name, name=name)


def make_seeds():
    """Of what the converter knows: every kind of polygon, material, light, camera, transform and instance."""
    dae = ColladaDocument("Z_UP")
    vertex = element("input", semantic="VERTEX", source="#shape-vertices", offset=0)
    normal = element("input", semantic="NORMAL", source="#shape-normals", offset=1)
    uv = element("input", semantic="TEXCOORD", source="#shape-uvs", offset=2, set=0)
    dae.libraries["geometries"].append(shape("shape", "".join((
        element("polylist", vertex + element("vcount", "3 4") + element("p", "0 1 2 0 3 4 5"), count=2, material="surface"),
        element("polygons", vertex + element("p", "0 1 2 3 4 5"), count=1),
        element("triangles", vertex + normal + uv + element("p", "0 0 0 1 0 1 2 1 2"), count=1, material="other"),
        element("trifans", vertex + element("p", "0 1 2 3"), count=1), element("tristrips", vertex + element("p", "0 1 3 2"), count=1),
        element("lines", vertex + element("p", "0 1"), count=1)))))
    dae.libraries["images"].append(element("image", element("init_from", "picture.png"), id="picture"))
    surface = element("newparam", element("surface", element("init_from", "picture"), type="2D"), sid="surface")
    sampler = element("newparam", element("sampler2D", element("source", "surface")), sid="sampler")
    color = element("emission", element("color", "1 2 4 1")) + element("transparent", element("color", "1 1 1 0.5"), opaque="A_ONE")
    clear = element("transparency", element("float", "0.5"))
    dae.material("paint", common=element("phong", element("diffuse", element("texture", texture="sampler", texcoord="UV")) + color + clear))
    dae.libraries["effects"][0] = dae.libraries["effects"][0].replace("<profile_COMMON>", "<profile_COMMON>" + surface + sampler)
    dae.diffuse("red", [1, 0, 0])
    places = element("lookat", "1 0 0 3 0 0 0 1 0") + element("skew", "45 1 0 0 0 0 1") + element("scale", "2 3 4")
    dae.node("painted", "geometry", "shape", material="paint", transforms=places)
    dae.node("red", "geometry", "shape", material="red", transforms=element("rotate", "0 0 1 90") + element("translate", "1 2 3"))
    inner = element("node", element("translate", "0 0 1") + element("instance_geometry", url="#shape"), id="inner", name="inner")
    dae.libraries["nodes"].append(element("node", element("translate", "0 1 0") + inner, id="group"))
    dae.node("group", "node", "group")
    plain = dae.text()
    skin = element("skin", element("bind_shape_matrix", "1 0 0 5 0 1 0 0 0 0 1 0 0 0 0 1"), source="#shape")
    skinned = plain.replace("<library_nodes>", element("library_controllers", element("controller", skin, id="arm")) + "<library_nodes>")
    skinned = skinned.replace("instance_geometry url=\"#shape\"", "instance_controller url=\"#arm\"", 1)
    skinned = skinned.replace("</instance_geometry>", "</instance_controller>", 1)

    def lit(up, profile):
        dae = ColladaDocument(up, profile)
        dae.mesh("triangle", [[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], [[0, 0, 1]] * 3)
        dae.sphere("ball", 0.5)
        three = "0.2 0.4 0.8"
        glass = element("transmittance", three) + element("roughness", "0") + element("ior", "1.45")
        for name, bsdf in (("lamp", element("emission", element("radiance", "4 2 1"))), ("glass", element("glass", glass)),
                           ("mirror", element("mirror", element("reflectance", three))),
                           ("metal", element("microfacet", element("alpha", "0.1") + element("eta", three) + element("k", "3 2 1")))):
            dae.material(name, bsdf)
            dae.node(name, "geometry", "ball" if name != "lamp" else "triangle", material=name, transforms=element("translate", "0 0 2"))
        dae.camera("wide", xfov=60, aspect_ratio=1.6)
        magnified = element("orthographic", element("xmag", "2") + element("ymag", "1") + element("znear", "0.1") + element("zfar", "9"))
        dae.libraries["cameras"].append(element("camera", element("optics", element("technique_common", magnified)), id="flat"))
        falls = "".join(element(tag + "_attenuation", "0.5") for tag in ("constant", "linear", "quadratic"))
        dae.light("bulb", "point", [3, 6, 1], falls)
        dae.light("spot", "spot", [1, 1, 1], falls + element("falloff_angle", "60") + element("falloff_exponent", "0.5"))
        dae.light("sun", "directional", [2, 2, 1])
        dae.light("sky", "ambient", [0.3, 0.6, 1.5])
        dae.area_light("area", [4, 2, 1])
        for kind, name in (("camera", "wide"), ("camera", "flat"), *(("light", name) for name in ("bulb", "spot", "sun", "sky", "area"))):
            dae.node(name, kind, name, transforms=element("matrix", "0.6 0 0 1 0 0.8 0 2 0 0 1 3 0 0 0 1"))
        return dae.text()
    return [plain, skinned, lit("Z_UP", "CGL"), lit("Y_UP", "none")]


class Mutator:
    def __init__(self, seeds, seed):
        self.seeds, self.random = seeds, random.Random(seed)
        self.trees = [ElementTree.fromstring(text) for text in seeds]
        every = [e for tree in self.trees for e in tree.iter()]
        self.tags = sorted({e.tag for e in every})
        self.attributes = sorted({name for e in every for name in e.keys()})
        self.values = sorted({value for e in every for value in e.attrib.values()} | {"#" + e.get("id") for e in every if e.get("id")})

    def below(self, count):
        return self.random.randrange(count)

    def text(self):
        """A mutant."""
        if self.below(20) == 0:
            return self.spoil(self.random.choice(self.seeds))
        root = copy.deepcopy(self.random.choice(self.trees))
        for _ in range(1 + self.below(3)):
            self.edit(root)
        text = ElementTree.tostring(root, encoding="unicode")
        return self.spoil(text) if self.below(40) == 0 else text

    def spoil(self, text):
        for _ in range(1 + self.below(3)):
            at, length = self.below(len(text)), self.below(20)
            put = self.random.choice(["", "<", "&", ">", "\"", "\ufffe", "<!DOCTYPE a>", text[at:at + 3] * 3])
            text = text[:at] + put + text[at + length:]
        return text

    def edit(self, root):
        parent = self.random.choice([e for e in root.iter() if len(e) > 0])
        at = self.below(len(parent))
        child = parent[at]
        every = list(root.iter())
        self.random.choice((self.remove, self.repeat, self.move, self.graft, self.rename, self.set_attribute, self.set_attribute,
                            self.set_attribute, self.set_text, self.set_text, self.set_number, self.set_number, self.set_number))(
                                root, parent, at, child, every)

    def remove(self, root, parent, at, child, every):
        del parent[at]

    def repeat(self, root, parent, at, child, every):
        for _ in range(self.random.choice((1, 1, 2, 20))):
            parent.insert(at, copy.deepcopy(child))

    def move(self, root, parent, at, child, every):
        del parent[at]
        inside = set(child.iter())
        self.random.choice([e for e in every if e not in inside]).append(child)

    def graft(self, root, parent, at, child, every):
        """An element of another seed, or a copy of one within itself."""
        other = self.random.choice([root, *self.trees])
        parent[at] = copy.deepcopy(self.random.choice(list(other.iter())))

    def rename(self, root, parent, at, child, every):
        child.tag = self.random.choice(self.tags)

    def set_attribute(self, root, parent, at, child, every):
        target = self.random.choice([e for e in every if e.keys()])
        name = self.random.choice(list(target.keys()) if self.below(8) else self.attributes)
        if self.below(8) == 0:
            target.attrib.pop(name, None)
        else:
            target.set(name, self.random.choice(self.random.choice((self.values, self.values, NUMBERS, TEXTS))))

    def set_text(self, root, parent, at, child, every):
        target = self.random.choice([e for e in every if (e.text or "").strip()] or every)
        target.text = self.random.choice(self.random.choice((NUMBERS, TEXTS)))

    def set_number(self, root, parent, at, child, every):
        target = self.random.choice([e for e in every if (e.text or "").strip()] or every)
        words = (target.text or "").split() or ["0"]
        where = self.below(len(words))
        words[where:where + self.below(2) + 1] = [self.random.choice(NUMBERS)] * self.random.choice((0, 1, 1, 1, 2))
        target.text = " ".join(words)


def find_defect(path, text, course):
    """How the conversion breaks the contract; None if it does not."""
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    sentence, begin = "", time.process_time()
    try:
        document = collada_to_gltf(path, course, lambda notice: None)
        json.dumps(document.json, allow_nan=False)
        document.write(os.path.splitext(path)[0] + ".glb")
    except ConversionError as error:
        sentence = str(error)
        if not sentence.startswith(path):
            return "the sentence does not begin with the file: %s" % error
    except Exception as error:
        return "%s: %s" % (type(error).__name__, error)
    seconds = time.process_time() - begin
    if seconds > MOST_SECONDS:
        return "it takes %.1f s" % seconds
    return None if sentence.isprintable() and len(sentence) <= 2000 else "no line for a terminal: %r" % sentence[:300]


def run(folder, runs, seed, found):
    """Calls `found` with each mutant that breaks the contract, and how. Returns how many converted."""
    with open(os.path.join(folder, "picture.png"), "wb") as file:
        file.write(images.png([[255, 128], [0, 64]], images.GREY, 8))
    mutator, path, converted = Mutator(make_seeds(), seed), os.path.join(folder, "mutant.dae"), 0
    result = os.path.splitext(path)[0] + ".glb"
    for _ in range(runs):
        text = mutator.text()
        if len(text) > 2 * MOST_BYTES:
            continue
        defect = find_defect(path, text, mutator.below(8) == 0)
        if defect is not None:
            found(text, defect)
        if os.path.exists(result):
            converted += 1
            os.remove(result)
    return converted


def main():
    runs, seed = (int(word) for word in (sys.argv[1:] + ["10000", "1"][len(sys.argv) - 1:]))
    used = int(open("/proc/self/statm").read().split()[0]) * os.sysconf("SC_PAGE_SIZE")
    resource.setrlimit(resource.RLIMIT_AS, (used + (1 << 30), resource.RLIM_INFINITY))
    kinds = {}

    def found(text, defect):
        kinds.setdefault(defect[:60], []).append(defect)
        if len(kinds[defect[:60]]) == 1:
            with open("build/collada_mutant_%d.dae" % len(kinds), "w", encoding="utf-8") as file:
                file.write(text)
            print("build/collada_mutant_%d.dae: %s" % (len(kinds), defect), flush=True)
    begin = time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        converted = run(folder, runs, seed, found)
    broken, seconds = sum(map(len, kinds.values())), time.monotonic() - begin
    print("%d mutants, %d converted, %d broke the contract, %.0f s" % (runs, converted, broken, seconds))
    sys.exit(1 if kinds else 0)


if __name__ == "__main__":
    main()
