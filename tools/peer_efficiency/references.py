"""Long renders that errors are relative to."""

import os
import re

from mitsuba_check.errors import CheckError


def name_of(scene):
    return os.path.splitext(os.path.basename(scene))[0]


def find_reference(folder, scene):
    """The file of that scene's long render, or None."""
    pattern = re.escape(name_of(scene)) + r"(_\d+_d\d+)?\.exr"
    found = sorted(name for name in os.listdir(folder) if re.fullmatch(pattern, name))
    if len(found) > 1:
        raise CheckError("%s: has %d references, %s and %s among them, expected one" % (scene, len(found), *found[:2]))
    return os.path.join(folder, found[0]) if found else None


def shrink(picture, size, path):
    """The means over squares of pixels: what a box filter of the smaller picture's pixels gives."""
    height, width = picture.shape[:2]
    times = width // size[0]
    if (width, height) != (size[0] * times, size[1] * times) or times == 0:
        raise CheckError("%s: has %dx%d pixels, expected a whole multiple of %dx%d" % (path, width, height, *size))
    return picture.reshape(size[1], times, size[0], times, -1).mean(axis=(1, 3))
