"""Keyword arguments as words of the command line, which `glim render --help-all` lists."""

import os
import re

from glim._errors import InputError


SWITCHES = {"caustics", "environment_background"}  # on or off


def path_of(value, what):
    """A file's name as text. `what`: the argument."""
    try:
        text = os.fsdecode(value)
    except TypeError:
        raise InputError("%s: cannot use %r, expected the name of a file" % (what, value)) from None
    if "\0" in text:
        raise InputError("%s: %r has a null character, expected the name of a file" % (what, text))
    return text


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
        option = "--" + name.replace("_", "-")
        if value is True:
            words.append(option + "=true")  # which no option takes but a flag
        else:
            text = text_of(name, value)
            words += [option + "=" + text] if text.startswith("--") else [option, text]
    return words


def text_of(name, value):
    if hasattr(value, "tolist"):  # of numpy
        value = value.tolist()
    if name == "target_rmse" and isinstance(value, (int, float)):
        return "%r%%" % (100 * value)
    if isinstance(value, (str, bytes, os.PathLike)):
        return path_of(value, name)
    if isinstance(value, (list, tuple)):
        between = {"size": "x", "samples": ":", "rows": ":"}.get(name, ",")
        return between.join(text_of(name, item) for item in value)
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise InputError("%s: cannot use %r, expected a number, a text or a sequence of numbers" % (name, value))
    return repr(value)


def in_python(sentence):
    """A sentence about --target-rmse is about target_rmse here."""
    return re.sub("--([a-z]+(?:-[a-z]+)*)", lambda match: match[1].replace("-", "_"), sentence)
