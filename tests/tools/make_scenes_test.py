#!/usr/bin/env python3
"""The committed scenes are what tools/make_scenes.py writes, byte by byte; its PNG and .hdr files are what they say."""

import os
import struct
import sys
import tempfile
import unittest
import zlib

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "tools"))
from scene_makers import made_images as images  # noqa: E402
from scene_makers.small_scenes import SMALL_SCENES  # noqa: E402


class MakeScenesTest(unittest.TestCase):
    def test_committed_scenes_are_made_ones(self):
        for name, make in SMALL_SCENES.items():
            with tempfile.TemporaryDirectory() as folder:
                make().write(os.path.join(folder, name + ".gltf"))
                for file in os.listdir(folder):
                    with open(os.path.join(folder, file), "rb") as made, open(os.path.join(ROOT, "scenes", file), "rb") as kept:
                        self.assertTrue(made.read() == kept.read(), file)

    def test_no_file_is_compressed(self):
        data = bytes(range(256)) * 600  # three blocks
        stream = images.stored(data)
        self.assertEqual(zlib.decompress(stream), data)
        self.assertEqual(len(stream), len(data) + 3 * 5 + 6)

    def test_pixels_of_every_depth(self):
        for depth, row in ((1, [1, 0, 1]), (2, [3, 0, 2, 1, 1]), (4, [15, 7, 1]), (8, [200, 3]), (16, [65535, 258])):
            file = images.png([row, row], images.GREY, depth)
            self.assertEqual(struct.unpack(">II", file[16:24]), (len(row), 2))
            at = file.index(b"IDAT")
            scanlines = zlib.decompress(file[at + 4:at + 4 + struct.unpack(">I", file[at - 4:at])[0]])
            bits = "".join("{:08b}".format(b) for b in scanlines[1:len(scanlines) // 2])
            self.assertEqual([int(bits[i * depth:(i + 1) * depth], 2) for i in range(len(row))], row)

    def test_radiance_is_kept(self):
        file = images.radiance_map(4, 2, lambda azimuth, elevation: (azimuth / 200.0 + 1.0, 0.25, 3.0))
        first = file[-32:-28]  # azimuth -45
        for byte, truth in zip(first, (0.775, 0.25, 3.0)):
            value = (byte + 0.5) * 2.0 ** (first[3] - 136)
            self.assertLess(abs(value - truth), 3.0 / 256.0)

    def test_noise_repeats(self):
        self.assertEqual(images.turbulence(0.0, 0.3, 3, 5, 4), images.turbulence(1.0, 0.3, 3, 5, 4))


if __name__ == "__main__":
    unittest.main()
