#!/usr/bin/env python3
"""A small picture of a scene, by light groups, has the same bits by the driver of the tests and by a second one. Arguments: glim's
program, the second driver's file, and the scene."""

import os
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.realpath(__file__))))
sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(ROOT, "tools"))
from device_check.places import group_words  # noqa: E402
from render_farm.exr_header import read_header_of  # noqa: E402


def render(glim, scene, film, **environment):
    """What its pixels are told by."""
    words = group_words(os.path.splitext(os.path.basename(scene))[0])
    subprocess.run([glim, "render", scene, "-o", film, "--size", "32x32", "--spp", "64", "--progress", "none", *words], check=True,
                   env={**os.environ, **environment})
    return read_header_of(film)["glim:pixels"]


def main(glim, driver, scene):
    with tempfile.TemporaryDirectory() as folder:
        films = [os.path.join(folder, name) for name in ("first.exr", "second.exr")]
        prints = render(glim, scene, films[0]), render(glim, scene, films[1], VK_DRIVER_FILES=driver, VK_ICD_FILENAMES=driver)
        if prints[0] == prints[1]:
            return 0
        subprocess.run([glim, "compare", *films], check=True)
        return "%s: the second driver gives other bits" % scene


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
