"""Reads Wavefront MTL, and says what glTF makes of it. trimesh loses emission and opacity, rounds colours to eight bits and drops missing
files without a word."""

import os

from conversion.embed_images import ImageEmbedder
from conversion.errors import ConversionError
from conversion.read_obj import without_comment

# What a map's file name may follow: options with so many words each.
MAP_OPTIONS = {"-blendu": 1, "-blendv": 1, "-bm": 1, "-boost": 1, "-cc": 1, "-clamp": 1, "-imfchan": 1, "-mm": 2, "-o": 3, "-s": 3,
               "-t": 3, "-texres": 1, "-type": 1}


def read_mtl(path):
    """Materials by name: dictionaries of lower-case keywords and the words after them."""
    materials = {}
    with open(path, encoding="utf-8", errors="replace") as file:
        for line in file:
            words = without_comment(line).split()
            if not words:
                continue
            if words[0].lower() == "newmtl":
                materials[" ".join(words[1:])] = current = {"folder": os.path.dirname(path), "path": path}
            elif materials:
                current[words[0].lower()] = words[1:]
    return materials


def numbers(mtl, key, default):
    """As many as `default` has; one number alone stands for all."""
    words = mtl.get(key)
    if words is None:
        return default
    try:
        values = [float(word) for word in words]
    except ValueError:
        values = []
    if len(values) not in (1, len(default)):
        raise ConversionError("%s: %s is \"%s\"; expected %d numbers" % (mtl["path"], key, " ".join(words), len(default)))
    return values * len(default) if len(values) < len(default) else values


def file_of(words):
    words = list(words)
    while words and words[0] in MAP_OPTIONS:
        words = words[1 + MAP_OPTIONS[words[0]]:]
    return " ".join(words).replace("\\", "/")


def clamp(value):
    return min(1.0, max(0.0, value))


def roughness_of(mtl):
    """Pr, else the roughness whose GGX lobe is as wide as Phong's with the exponent Ns: alpha = sqrt(2 / (Ns + 2)) (Walter et al. 2007,
    section 5.4), which is the roughness squared in glTF."""
    if "pr" in mtl:
        return clamp(numbers(mtl, "pr", [1.0])[0])
    return (2.0 / (max(0.0, numbers(mtl, "ns", [0.0])[0]) + 2.0)) ** 0.25


class MaterialWriter:
    def __init__(self, document, say):
        self.document, self.say, self.images = document, say, ImageEmbedder(document, say)

    def texture(self, mtl, key):
        """The index of a map's texture; None without one."""
        return self.images.texture(os.path.join(mtl["folder"], file_of(mtl[key])), key) if key in mtl else None

    def write(self, name, mtl):
        for key in sorted(mtl):
            if key in ("map_bump", "bump", "norm", "disp", "map_ks", "map_ns", "map_d", "map_pr", "map_pm"):
                self.say("%s of the material \"%s\" is left out" % (key, name))
        alpha = clamp(numbers(mtl, "d", [1.0 - numbers(mtl, "tr", [0.0])[0]])[0])
        base, glow = self.texture(mtl, "map_kd"), self.texture(mtl, "map_ke")
        # Many writers leave Kd black beside a map, which replaces it in their own viewers.
        color = [clamp(c) for c in numbers(mtl, "kd", [0.8] * 3)]
        more = {"doubleSided": True}
        emission = [max(0.0, e) for e in numbers(mtl, "ke", [1.0] * 3 if glow is not None else [0.0] * 3)]
        strength = max(1.0, *emission)
        if any(emission):
            more["emissiveFactor"] = [e / strength for e in emission]
        if glow is not None:
            more["emissiveTexture"] = {"index": glow}
        if alpha < 1.0:
            more["alphaMode"] = "BLEND"
        extensions = {"emissive_strength": {"emissiveStrength": strength}} if strength > 1.0 else None
        return self.document.surface_material(name, color if base is None or any(color) else [1.0] * 3,
                                              clamp(numbers(mtl, "pm", [0.0])[0]), roughness_of(mtl), alpha, base,
                                              extensions=extensions, **more)
