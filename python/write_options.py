#!/usr/bin/env python3
"""Writes src/glim/_render_options.py by the options of `glim render`: python/write_options.py build/package

The option table knows numbers, flags, words and names. TYPES has the others."""

import os
import sys
import textwrap

PLACE = "Sequence[float]"
TYPES = {
    "add": "Union[Dict[str, Sequence[float]], Sequence[str], str]",
    "camera": "Union[str, int, Camera, FileCamera]",
    "animation": "Union[str, int]",
    "catcher": "Union[str, Sequence[str]]",
    "crop": "Tuple[int, int, int, int]",
    "device": "Union[str, int]",
    "distortion": PLACE,
    "environment": "Union[str, \"os.PathLike[str]\", Sequence[float], Any]",
    "exposure": "Union[float, str]",
    "fisheye": PLACE,
    "floor": "Union[str, float]",
    "floor_color": PLACE,
    "focus": "Tuple[int, int]",
    "intrinsics": PLACE,
    "intrinsics_opencv": PLACE,
    "look_at": PLACE,
    "look_from": PLACE,
    "look_up": PLACE,
    "pose_gltf": PLACE,
    "pose_opencv": PLACE,
    "roulette": "str",
    "light_group": "Union[str, Sequence[str], Dict[str, Union[str, Sequence[str]]]]",
    "rows": "Tuple[int, int]",
    "samples": "Tuple[int, int]",
    "set": "Dict[str, Any]",
    "shift": "Tuple[float, float]",
    "shutter": "Tuple[float, float]",
    "size": "Tuple[int, int]",
    "sun": "Tuple[float, float, float]",
    "target_rmse": "float",
    "time": "Union[float, str]",
}
KINDS = {"flag": "bool", "text": "str", "path": "Union[str, \"os.PathLike[str]\"]", "whole": "int", "number": "float"}
HEAD = '''"""The options of a render, for editors and type checkers. Written by python/write_options.py, which a test compares."""

import os
from typing import Any, Dict, Literal, Sequence, Tuple, TypedDict, Union

from glim._camera import Camera
from glim._elements import FileCamera


class RenderOptions(TypedDict, total=False):
    """Keyword arguments of glim.load, glim.render and Scene.render; `glim render --help-all` lists them."""
'''


def type_of(name, option):
    if name in TYPES:
        return TYPES[name]
    if option["kind"] == "choice":
        words = option["choices"]
        switch = ["bool"] if {"off", "on"} <= set(words) else []
        literal = "Literal[%s]" % ", ".join('"%s"' % word for word in words)
        return "Union[%s]" % ", ".join([*switch, literal]) if switch else literal
    return KINDS[option["kind"]]  # a KeyError: TYPES lacks the option


def text_of(options):
    from glim._options import in_python
    text = HEAD
    for option in options:
        name = option["name"].lstrip("-").replace("-", "_")
        help_lines = textwrap.wrap(in_python(option["help"]), 132)
        text += "\n    %s: %s\n" % (name, type_of(name, option))
        text += '    """%s"""\n' % "\n    ".join(help_lines)
    return text


def main():
    sys.dont_write_bytecode = True
    sys.path.insert(0, sys.argv[1])
    from glim import _glim
    text = text_of(_glim.options())
    with open(os.path.join(os.path.dirname(os.path.realpath(__file__)), "src", "glim", "_render_options.py"), "w", encoding="utf-8") as file:
        file.write(text)


if __name__ == "__main__":
    main()
