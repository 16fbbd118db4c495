"""The layers of films, from the files that glim writes: scan lines of float32 and uint32, ZIP compression."""

import hashlib
import struct
import zlib

MAGIC = 20000630
ZIP, ROWS_OF_A_BLOCK = 3, 16


class FilmError(Exception):
    pass


def text_at(content, position):
    end = content.index(b"\0", position)
    return content[position:end].decode(), end + 1


def read_header(content):
    """The attributes' bytes by name, and where the header ends."""
    attributes, position = {}, 8
    while content[position] != 0:
        name, position = text_at(content, position)
        _, position = text_at(content, position)
        size, = struct.unpack_from("<i", content, position)
        attributes[name] = content[position + 4:position + 4 + size]
        position += 4 + size
    return attributes, position + 1


def channel_names(channels):
    names, position = [], 0
    while channels[position] != 0:
        name, position = text_at(channels, position)
        kind, _, across, down = struct.unpack_from("<4i", channels, position)
        if kind not in (0, 2) or (across, down) != (1, 1):
            raise FilmError("channel %s is neither float32 nor uint32 of every pixel" % name)
        names.append(name)
        position += 16
    return names


def unpack_block(data, size):
    """OpenEXR's ZIP: differences of bytes, the even bytes before the odd ones. A block that would grow is stored as it is."""
    if len(data) == size:
        return data
    data = bytearray(zlib.decompress(data))
    for i in range(1, len(data)):
        data[i] = (data[i - 1] + data[i] - 128) & 255
    whole = bytearray(len(data))
    half = (len(data) + 1) // 2
    whole[0::2], whole[1::2] = data[:half], data[half:]
    return bytes(whole)


def read_layers(path):
    """The bytes of each channel, four a pixel, by name. FilmError says what is wrong with the file."""
    with open(path, "rb") as file:
        content = file.read()
    try:
        if struct.unpack_from("<i", content)[0] != MAGIC:
            raise FilmError("no EXR file")
        attributes, position = read_header(content)
        names = channel_names(attributes["channels"])
        if attributes["compression"][0] != ZIP:
            raise FilmError("not compressed by ZIP")
        left, top, right, bottom = struct.unpack("<4i", attributes["dataWindow"])
        row, rows = 4 * (right + 1 - left), bottom + 1 - top
        blocks = (rows + ROWS_OF_A_BLOCK - 1) // ROWS_OF_A_BLOCK
        layers = {name: bytearray() for name in names}
        for offset in sorted(struct.unpack_from("<%dQ" % blocks, content, position)):
            first, size = struct.unpack_from("<2i", content, offset)
            lines = min(ROWS_OF_A_BLOCK, bottom + 1 - first)
            block = unpack_block(content[offset + 8:offset + 8 + size], lines * len(names) * row)
            for i in range(lines * len(names)):
                layers[names[i % len(names)]] += block[i * row:(i + 1) * row]
    except (KeyError, IndexError, ValueError, struct.error, zlib.error) as error:
        raise FilmError("%s: is damaged, or no film of glim (%s)" % (path, error)) from error
    except FilmError as error:
        raise FilmError("%s: %s" % (path, error)) from error
    return {name: bytes(data) for name, data in layers.items()}


def digest_of(layers):
    """SHA-256 of names and bytes, and of nothing else that the file says."""
    digest = hashlib.sha256()
    for name in sorted(layers):
        digest.update(b"%s\0%d\0" % (name.encode(), len(layers[name])))
        digest.update(layers[name])
    return digest.hexdigest()


def equal_pixels(a, b, names):
    """How many pixels have equal bits in all the layers `names`, and how many there are."""
    pixels = len(a[names[0]]) // 4
    same = [all(a[name][i:i + 4] == b[name][i:i + 4] for name in names) for i in range(0, 4 * pixels, 4)]
    return sum(same), pixels


def mean_ratio(a, b, names=("R", "G", "B")):
    """The mean of the picture `a` over that of `b`."""
    def total(layers):
        return sum(sum(struct.unpack("<%df" % (len(layers[name]) // 4), layers[name])) for name in names)
    return total(a) / total(b)
