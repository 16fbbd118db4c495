#!/usr/bin/env python3
"""tools/gallery makes ten pictures and a page that says how; the committed page is the one of today's commands."""

import importlib.machinery
import importlib.util
import os
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.realpath(__file__))))
GLIM = os.path.abspath(sys.argv[1])
TOOL = os.path.join(ROOT, "tools", "gallery")
COMMITTED = os.path.join(ROOT, "scenes", "gallery")


def pictures():
    loader = importlib.machinery.SourceFileLoader("gallery", TOOL)
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("gallery", loader))
    loader.exec_module(module)
    return module.PICTURES


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def is_webp(path):
    with open(path, "rb") as file:
        start = file.read(12)
    return start[:4] == b"RIFF" and start[8:] == b"WEBP"


class GalleryTest(unittest.TestCase):
    def test_pictures_and_their_page(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([TOOL, "--small", "--glim", GLIM, folder], check=True, stdout=subprocess.DEVNULL)
            names = [name for name, _, _ in pictures()]
            self.assertEqual(sorted(os.listdir(folder)), sorted(["README.md", *(name + ".webp" for name in names)]))
            self.assertTrue(all(is_webp(os.path.join(folder, name + ".webp")) for name in names))
            page = read(os.path.join(folder, "README.md"))
        self.assertEqual(len(re.findall(r"^64 samples per pixel in \d+ s.* \([1-9]\d* s of CPU time in all\); ", page, re.MULTILINE)), 10)
        self.assertEqual(len(re.findall(r"; RMSE [\d.e+]+ % \[", page)), 10)
        self.assertEqual(len(re.findall(r"after \d+ s of learning", page)), 1)

    def test_the_committed_page_has_todays_commands(self):
        page = read(os.path.join(COMMITTED, "README.md"))
        self.assertEqual(re.findall(r"^    tools/glim render (.*)$", page, re.MULTILINE),
                         ["%s -o %s.webp" % (line, name) for name, _, line in pictures()])
        for name, caption, _ in pictures():
            self.assertIn("![%s](%s.webp)" % (caption, name), page)
            self.assertTrue(is_webp(os.path.join(COMMITTED, name + ".webp")), name)

    def test_a_picture_that_fails_ends_it(self):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([TOOL, "--small", "--glim", "false", folder], text=True, capture_output=True, check=False)
            self.assertEqual((done.returncode, done.stderr), (1, "gallery: glim could not render %s/studio.webp\n" % folder))
            self.assertEqual(os.listdir(folder), [])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
