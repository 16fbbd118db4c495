"""Headers of EXR files: what a film says of itself, without its pixels."""

import re
import struct

from render_farm.errors import FarmError

MAGIC = 20000630
DECODERS = {
    b"string": lambda value: value.decode(),
    b"double": lambda value: struct.unpack("<d", value)[0],
    b"int": lambda value: struct.unpack("<i", value)[0],
    b"box2i": lambda value: struct.unpack("<4i", value),
}


def read_header(content, name):
    """The attributes that are a string, double, int or box2i, by their names. content: the file's bytes, or enough of its beginning.
    Refuses (FarmError, which uses `name`) what is no EXR file of one part."""
    attributes, position = {}, 8
    try:
        magic, version = struct.unpack_from("<ii", content)
        if magic != MAGIC or version & 0x1000:
            raise ValueError
        while content[position] != 0:
            end_of_name = content.index(b"\0", position)
            end_of_type = content.index(b"\0", end_of_name + 1)
            kind = content[end_of_name + 1:end_of_type]
            size, = struct.unpack_from("<i", content, end_of_type + 1)
            begin, end = end_of_type + 5, end_of_type + 5 + size
            if size < 0 or end > len(content):
                raise ValueError
            if kind in DECODERS:
                attributes[content[position:end_of_name].decode()] = DECODERS[kind](content[begin:end])
            position = end
    except (ValueError, IndexError, struct.error) as error:
        raise FarmError("%s: is damaged, or not an EXR picture" % name) from error
    return attributes


def read_header_of(path):
    """The attributes of the file at `path`. Refuses what read_header refuses, and (OSError) what cannot be read."""
    with open(path, "rb") as file:
        return read_header(file.read(1 << 20), path)  # far more than a film's header has


class FilmHeader:
    """What a film of glim says of itself. Refuses (FarmError, which uses `name`) other pictures."""

    def __init__(self, attributes, name):
        self.name = name
        try:
            _, _, right, bottom = attributes["displayWindow"]
            self.width, self.height = right + 1, bottom + 1  # of the picture; the film may have some of its rows only
            _, top, _, bottom = attributes["dataWindow"]
            self.rows = "%d:%d" % (top, bottom + 1)
            self.scene = attributes["glim:scene"]
            self.settings = attributes["glim:settings"]
            self.seed = attributes["glim:seed"]
            self.samples = attributes["glim:samples"]
            if not re.fullmatch("[0-9]{1,10}:[0-9]{1,10}( [0-9]{1,10}:[0-9]{1,10})*", self.samples):
                raise ValueError
            self.complete = attributes["glim:complete"] == 1 and "glim:progress" not in attributes
            self.kernels = attributes["glim:kernels"]
            self.arithmetic = attributes["glim:arithmetic"]
            self.digest = attributes["glim:digest"]
        except KeyError as error:
            raise FarmError("%s: is no film of this glim: it lacks %s" % (name, error)) from error
        except (TypeError, ValueError) as error:  # attributes of other types
            raise FarmError("%s: is damaged: its header has values that no film has" % name) from error
        self.size = "%dx%d" % (self.width, self.height)
        self.pixels = self.width * self.height

    def identity(self):
        """What decides the bits, besides the samples and the device."""
        return {"size": self.size, "scene": self.scene, "settings": self.settings, "seed": self.seed, "kernels": self.kernels}


def read_film_header(path):
    return FilmHeader(read_header_of(path), path)
