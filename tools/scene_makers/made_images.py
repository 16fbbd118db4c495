"""Images made by code, and PNG files of them: the same bytes from every zlib, because nothing is compressed."""

import itertools
import math
import struct
import zlib

GREY, RGB, PALETTE, RGBA = 0, 2, 3, 6  # PNG's colour types


def stored(data):
    """A zlib stream of stored blocks (RFC 1951, section 3.2.4)."""
    blocks = [data[i:i + 65535] for i in range(0, len(data), 65535)]
    stream = b"\x78\x01"
    for i, block in enumerate(blocks):
        stream += struct.pack("<BHH", i == len(blocks) - 1, len(block), len(block) ^ 0xFFFF) + block
    return stream + struct.pack(">I", zlib.adler32(data))


def png(rows, color_type=RGB, depth=8, palette=(), alphas=()):
    """A PNG file of `rows` of pixels: numbers (grey, palette) or tuples of them, below 2^depth. `palette` has RGB triples."""
    packed = bytearray()
    for row in rows:
        numbers = [c for pixel in row for c in (pixel if isinstance(pixel, tuple) else (pixel,))]
        packed.append(0)  # no filter
        if depth == 16:
            packed += struct.pack(">%dH" % len(numbers), *numbers)
        else:
            per = 8 // depth
            numbers += [0] * (-len(numbers) % per)
            packed += bytes(sum(n << (8 - depth * (k + 1)) for k, n in enumerate(numbers[i:i + per]))
                            for i in range(0, len(numbers), per))
    chunks = [(b"IHDR", struct.pack(">IIBBBBB", len(rows[0]), len(rows), depth, color_type, 0, 0, 0))]
    if palette:
        chunks.append((b"PLTE", bytes(c for color in palette for c in color)))
    if alphas:
        chunks.append((b"tRNS", bytes(alphas)))
    chunks += [(b"IDAT", stored(bytes(packed))), (b"IEND", b"")]
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data)) for name, data in chunks)


def run_lengths(values):
    """A channel of a row of a Radiance .hdr file, by runs alone."""
    packed = bytearray()
    for value, run in itertools.groupby(values):
        length = len(list(run))
        while length > 0:
            packed += bytes([128 + min(length, 127), value])
            length -= 127
    return bytes(packed)


def radiance_map(width, height, radiance, packed=False):
    """A Radiance .hdr file, packed if rows have long runs. radiance(azimuth, elevation) gives RGB; degrees, azimuth 0 is +z and 90 is +x."""
    rows = bytearray()
    for y in range(height):
        pixels = bytearray()
        for x in range(width):
            azimuth = 180.0 - (360.0 * (x + 0.5) / width + 180.0) % 360.0
            color = radiance(azimuth, 90.0 - 180.0 * (y + 0.5) / height)
            exponent = math.frexp(max(color))[1]
            pixels += bytes(int(math.ldexp(c, 8 - exponent)) for c in color) + bytes([exponent + 128])
        rows += struct.pack(">BBH", 2, 2, width) + b"".join(run_lengths(pixels[k::4]) for k in range(4)) if packed else pixels
    return b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % (height, width) + bytes(rows)


def softboxes(boxes, ambient):
    """A sky for radiance_map: boxes of (azimuth, elevation, half width, half height, RGB), with soft edges, over an ambient sky."""
    def radiance(azimuth, elevation):
        color = ambient(azimuth, elevation)
        for middle, height, half_width, half_height, added in boxes:
            across = ((azimuth - middle + 180.0) % 360.0 - 180.0) * math.cos(math.radians(elevation))
            inside = smooth_step(half_width + 3.0, half_width - 3.0, abs(across))
            inside *= smooth_step(half_height + 3.0, half_height - 3.0, abs(elevation - height))
            color = tuple(c + inside * r for c, r in zip(color, added))
        return color
    return radiance


def smooth_step(low, high, x):
    t = min(max((x - low) / (high - low), 0.0), 1.0)
    return t * t * (3.0 - 2.0 * t)


def mix(a, b, t):
    return tuple(x + (y - x) * t for x, y in zip(a, b))


def hash01(x, y, seed=0):
    """A number from 0 to 1 for a point of the integer grid."""
    h = (x * 374761393 + y * 668265263 + seed * 2246822519) & 0xFFFFFFFF
    h = ((h ^ h >> 13) * 1274126177) & 0xFFFFFFFF
    return ((h ^ h >> 16) & 0xFFFF) / 65535.0


def noise(x, y, period_x, period_y, seed=0):
    """Value noise from 0 to 1 that repeats after whole periods."""
    i, j = math.floor(x), math.floor(y)
    u, v = smooth_step(0.0, 1.0, x - i), smooth_step(0.0, 1.0, y - j)
    corner = [[hash01((i + a) % period_x, (j + b) % period_y, seed) for a in (0, 1)] for b in (0, 1)]
    low, high = (c[0] + (c[1] - c[0]) * u for c in corner)
    return low + (high - low) * v


def turbulence(u, v, periods_u, periods_v, octaves, seed=0):
    """Octaves of noise, from 0 to 1, that repeat when u or v grows by 1."""
    total = weight = 0.0
    for k in range(octaves):
        nu, nv = periods_u << k, periods_v << k
        total += noise(u * nu, v * nv, nu, nv, seed + k) / (1 << k)
        weight += 1.0 / (1 << k)
    return total / weight


def sample(width, height, function):
    """Rows of function(u, v) at the centres of the pixels; v grows downwards."""
    return [[function((x + 0.5) / width, (y + 0.5) / height) for x in range(width)] for y in range(height)]


def to_byte(x):
    return min(max(int(255.0 * x + 0.5), 0), 255)


def shades(width, height, function, palette):
    """A palette image: function(u, v) from 0 to 1 chooses among the colours."""
    last = len(palette) - 1
    rows = sample(width, height, lambda u, v: min(max(int(function(u, v) * last + 0.5), 0), last))
    return png(rows, PALETTE, 4 if last < 16 else 8, palette)


def ramp(stops, count):
    """`count` byte colours between (position, colour) stops; colours from 0 to 1, as in sRGB."""
    colors = []
    for i in range(count):
        t = i / (count - 1)
        (a, low), (b, high) = next(((s, e) for s, e in zip(stops, stops[1:]) if t <= e[0]), stops[-2:])
        colors.append(tuple(to_byte(c) for c in mix(low, high, (t - a) / (b - a))))
    return colors


def normal_map(width, height, relief, strength, depth=8):
    """The normals of a height field that repeats: relief(u, v), and its slope is `strength` times the difference per texture width."""
    half = (1 << depth) - 1
    def pixel(u, v):
        du, dv = 0.5 / width, 0.5 / height
        n = (strength * (relief(u - du, v) - relief(u + du, v)) / (2.0 * du),
             strength * (relief(u, v + dv) - relief(u, v - dv)) / (2.0 * dv), 1.0)  # green points up, v down
        length = math.sqrt(sum(c * c for c in n))
        return tuple(int((c / length * 0.5 + 0.5) * half + 0.5) for c in n)
    return png(sample(width, height, pixel), RGB, depth)
