"""Elements of a Collada file: their names without the namespace, and the numbers that they hold."""

import numpy

from conversion.errors import ConversionError


def tag_of(element):
    return element.tag.rpartition("}")[2]


def children(element, *tags):
    return [child for child in element if tag_of(child) in tags]


def find(element, path):
    """The first element at a path of tags such as "technique_common/point"; None without one."""
    for tag in path.split("/"):
        element = next(iter(children(element, tag)), None)
        if element is None:
            return None
    return element


def described(element):
    """As messages name it."""
    name = element.get("id") or element.get("name") or element.get("sid")
    return "<%s>%s" % (tag_of(element), " \"%s\"" % name if name else "")


def as_numbers(words, kind):
    """None if a word is no number of numpy's type `kind`, or not finite."""
    try:
        values = numpy.array(words, dtype=kind)
    except (ValueError, OverflowError):
        return None
    with numpy.errstate(over="ignore"):  # beyond float32 is infinite in glTF
        return values if numpy.all(numpy.isfinite(values.astype(numpy.float32))) else None


def numbers_of(path, place, element, kind=numpy.float64):
    """All numbers in an element's text."""
    words = (element.text or "").split()
    values = as_numbers(words, kind)
    if values is None:
        expected = "a finite number" if kind is numpy.float64 else "a whole number"
        bad = next(word for word in words if as_numbers([word], kind) is None)
        raise ConversionError("%s: %s holds \"%s\"; expected %s" % (path, place, bad[:40], expected))
    return values


def some_numbers(path, place, element, count):
    values = numbers_of(path, place, element)
    if len(values) != count:
        raise ConversionError("%s: %s holds %d numbers; expected %d" % (path, place, len(values), count))
    return values


def whole_number(path, element, name, default=None):
    """Of an attribute, from 0."""
    text = element.get(name, default)
    if text is None or not text.strip().isdecimal():
        value = "has none" if text is None else "is \"%s\"" % text[:40]
        raise ConversionError("%s: the %s of %s %s; expected a whole number from 0" % (path, name, described(element), value))
    return int(text)
