"""Keyword arguments as words of the command line, which `glim render --help-all` lists."""

import os
import re

from glim._errors import InputError


SWITCHES = {"caustics", "environment_background"}  # on or off


def words_of(options):
    """{"spp": 16, "size": (640, 480), "confine": True} -> ["--spp", "16", "--size", "640x480", "--confine"]. None is left out."""
    words = []
    for name, value in options.items():
        if name in ("help", "help_all", "output") or not re.fullmatch("[a-z][a-z_]*", name):
            raise TypeError("glim: there is no option %s" % name)
        if name in SWITCHES and isinstance(value, bool):
            value = "on" if value else "off"
        if value is None or value is False:
            continue
        words.append("--" + name.replace("_", "-"))
        if value is not True:
            words.append(text_of(name, value))
    return words


def text_of(name, value):
    if hasattr(value, "tolist"):  # of numpy
        value = value.tolist()
    if name == "target_rmse" and isinstance(value, (int, float)):
        return "%r%%" % (100 * value)
    if isinstance(value, (str, os.PathLike)):
        return os.fspath(value)
    if isinstance(value, (list, tuple)):
        between = {"size": "x", "samples": ":", "rows": ":"}.get(name, ",")
        return between.join(text_of(None, item) for item in value)
    if not isinstance(value, (int, float)):
        raise InputError("%s: cannot use %r, expected a number, a text or a sequence of numbers" % (name, value))
    return repr(value)


def in_python(sentence):
    """A sentence about --target-rmse is about target_rmse here."""
    return re.sub("--([a-z]+(?:-[a-z]+)*)", lambda match: match[1].replace("-", "_"), sentence)
