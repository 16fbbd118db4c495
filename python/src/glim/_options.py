"""Keyword arguments as values of the options that `glim render --help-all` lists."""

import os
import re

from glim._errors import InputError, unusable


def path_of(value, what):
    """A file's name as text. `what`: the argument."""
    try:
        text = os.fsdecode(value)
    except TypeError:
        raise unusable(what, value, "the name of a file") from None
    if "\0" in text:
        raise InputError("%s: %r has a null character, expected the name of a file" % (what, text), "malformed", place=what, value=text,
                         expected="the name of a file")
    return text


def values_of(options):
    """{"spp": 16, "size": (640, 480), "scene": None} -> {"spp": 16, "size": [640, 480]}. Texts become bytes, as names of files are."""
    camera = options.get("camera")
    if hasattr(camera, "options"):  # glim.Camera, or one of scene.cameras
        given = {name: value for name, value in options.items() if name != "camera" and value is not None}
        options = {**camera.options(), **given}
    values = {}
    for name, value in options.items():
        if name in ("help", "help_all", "output", "file") or not re.fullmatch("[a-z][a-z_]*", name):
            raise TypeError("glim: there is no option %s" % name)
        if value is not None:
            values[name] = value_of(name, value)
    return values


def additions_of(value):
    """A value of the option `add`, as a list of texts."""
    if value is None:
        return []
    if isinstance(value, dict):
        return ["%s@%s" % (os.fsdecode(path), ",".join(map(repr, value_of("add", place)))) for path, place in value.items()]
    return [os.fsdecode(value)] if isinstance(value, (str, bytes, os.PathLike)) else [os.fsdecode(one) for one in value]


def value_of(name, value):
    if isinstance(value, dict) and all(isinstance(key, str) for key in value):
        return {key: value_of("%s[%r]" % (name, key), member) for key, member in value.items()}
    if hasattr(value, "tolist"):  # of numpy
        value = value.tolist()
    if isinstance(value, (str, bytes, os.PathLike)):
        return os.fsencode(path_of(value, name))
    if isinstance(value, bool):
        return value
    if isinstance(value, (list, tuple)) and not any(isinstance(item, (bool, list, tuple)) for item in value):
        return [value_of(name, item) for item in value]
    if isinstance(value, (list, tuple)):
        value = next(item for item in value if isinstance(item, (bool, list, tuple)))
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise unusable(name, value, "a number, a text or a sequence of numbers")
    try:
        return float(value) if abs(value) >= 2**63 else value
    except OverflowError:
        raise unusable(name, value, "a smaller number", "out-of-range") from None


def in_python(sentence):
    """A sentence about --target-rmse is about target_rmse here."""
    return re.sub("--([a-z]+(?:-[a-z]+)*)", lambda match: match[1].replace("-", "_"), sentence)
