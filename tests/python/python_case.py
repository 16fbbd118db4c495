"""What the tests of the module share. The arguments of each are glim's program and the folder of the built package."""

import json
import os
import subprocess
import sys
import tempfile
import unittest

HERE = os.path.dirname(os.path.realpath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
sys.dont_write_bytecode = True
sys.path.insert(0, sys.argv[2])
import glim  # noqa: E402

GLIM = os.path.abspath(sys.argv[1])


def scene(name):
    return os.path.join(ROOT, "scenes", name + ".gltf")


GEMS = scene("cornell_gems")  # has caustics, and so light paths


def run_python(code, **environment):
    """What a new process prints, which runs this code."""
    return subprocess.run([sys.executable, "-c", code], env={**os.environ, "PYTHONPATH": sys.argv[2], **environment}, stdout=subprocess.PIPE, text=True, check=True).stdout


class PythonCase(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="glim-python-")
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, name):
        return os.path.join(self.folder, name)

    def command_line(self, *words):
        """The film and the statistics of `glim render`."""
        subprocess.run([GLIM, "render", *words, "-o", self.path("one.exr"), "--stats", self.path("one.json"), "--progress", "none"],
                       check=True, stdout=subprocess.DEVNULL)
        with open(self.path("one.json"), encoding="utf-8") as stats:
            return glim.read(self.path("one.exr")), json.load(stats)
