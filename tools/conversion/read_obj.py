"""Reads Wavefront OBJ: what its faces name, with line numbers in every complaint. Of the format's statements v, vt, vn, f, s, o, usemtl and
mtllib are read; curves, free-form surfaces, points and lines are not."""

from dataclasses import dataclass, field

from conversion.errors import ConversionError


@dataclass
class Face:
    corners: list  # (vertex, texture coordinate or None, normal or None), indices from 0
    object: str
    material: str  # or None
    smoothing: str  # group, or None: flat


@dataclass
class Obj:
    vertices: list = field(default_factory=list)
    colors: list = field(default_factory=list)  # of each vertex (r, g, b) or None
    uvs: list = field(default_factory=list)
    normals: list = field(default_factory=list)
    faces: list = field(default_factory=list)
    libraries: list = field(default_factory=list)  # names of .mtl files


class Reader:
    def __init__(self, path):
        self.path, self.line, self.obj = path, 0, Obj()
        self.object, self.material, self.smoothing = "", None, None

    def refuse(self, sentence):
        raise ConversionError("%s, line %d: %s" % (self.path, self.line, sentence))

    def numbers(self, words, least):
        try:
            values = [float(word) for word in words]
        except ValueError:
            values = []
        if len(values) < least:
            self.refuse("it holds \"%s\"; expected %d numbers" % (" ".join(words), least))
        return values

    def index(self, word, list_, what):
        """From 1, or from -1 backwards."""
        if word == "":
            return None
        try:
            number = int(word)
        except ValueError:
            number = 0
        index = number - 1 if number > 0 else len(list_) + number
        if number == 0 or not 0 <= index < len(list_):
            self.refuse("a face names the %s \"%s\"; expected one of the %d before it" % (what, word, len(list_)))
        return index

    def corner(self, word):
        parts = (word.split("/") + ["", ""])[:3]
        vertex = self.index(parts[0], self.obj.vertices, "vertex")
        if vertex is None:
            self.refuse("a face has the corner \"%s\"; expected a vertex in it" % word)
        return vertex, self.index(parts[1], self.obj.uvs, "texture coordinate"), self.index(parts[2], self.obj.normals, "normal")

    def read_line(self, keyword, words):
        if keyword == "v":
            values = self.numbers(words, 3)
            self.obj.vertices.append(values[:3])
            self.obj.colors.append(values[3:6] if len(values) >= 6 else None)
        elif keyword == "vt":
            self.obj.uvs.append((self.numbers(words, 1) + [0.0])[:2])
        elif keyword == "vn":
            self.obj.normals.append(self.numbers(words, 3)[:3])
        elif keyword == "f":
            if len(words) < 3:
                self.refuse("a face has %d corners; expected 3 or more" % len(words))
            self.obj.faces.append(Face([self.corner(word) for word in words], self.object, self.material, self.smoothing))
        elif keyword == "s":
            self.smoothing = None if words[:1] in ([], ["off"], ["0"]) else words[0]
        elif keyword == "o":
            self.object = " ".join(words)
        elif keyword == "usemtl":
            self.material = " ".join(words)
        elif keyword == "mtllib":
            self.obj.libraries.append(" ".join(words))


def without_comment(line):
    """A # within a word belongs to a name."""
    return "" if line.startswith("#") else line.split(" #")[0].rstrip()


def read_obj(path):
    reader = Reader(path)
    pending = ""
    with open(path, encoding="utf-8", errors="replace") as file:
        for reader.line, line in enumerate(file, 1):
            line = pending + without_comment(line)
            if line.endswith("\\"):
                pending = line[:-1] + " "
                continue
            pending = ""
            words = line.split()
            if words:
                reader.read_line(words[0], words[1:])
    if not reader.obj.faces:
        raise ConversionError("%s: it has no faces; expected at least one line that begins with f" % path)
    return reader.obj
