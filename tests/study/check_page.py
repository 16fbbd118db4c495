#!/usr/bin/env python3
"""Checks the structure of a page that tools/study wrote: check_page.py FOLDER. The last line is the total."""

import base64
import binascii
import json
import math
import os
import re
import sys
from html.parser import HTMLParser

VOID = {"meta", "img", "br", "hr", "link", "input", "use", "path", "rect", "line", "circle"}
SECTIONS = ("summary", "views", "acceleration", "direct", "global", "adaptive", "about")
# What each section must have at least: tables, plots and pictures.
LEAST = {"summary": (1, 0, 0), "views": (0, 0, 4), "acceleration": (4, 1, 2), "direct": (2, 1, 6),
         "global": (4, 1, 13), "adaptive": (2, 0, 6), "about": (2, 0, 0)}
MOST_HEADLINES = 20
CAPTION = re.compile(r"[\d.e+-]+ s, [\d.,e+-]+ Mrays/s, relMSE (below the long render's noise )?[\d.e+-]+")


class Page(HTMLParser):
    """Collects what is in each section, and what is wrong."""

    def __init__(self):
        super().__init__()
        self.open, self.wrong, self.ids = [], [], set()
        self.section, self.found, self.captions, self.caption = None, {}, [], None

    def handle_starttag(self, tag, attributes):
        values = dict(attributes)
        self.check_references(tag, values)
        if "id" in values:
            if values["id"] in self.ids:
                self.wrong.append("the id %s stands twice" % values["id"])
            self.ids.add(values["id"])
        if tag == "section":
            self.section = values.get("id")
            self.found[self.section] = {"table": 0, "svg": 0, "img": 0}
        if self.section and tag in ("table", "svg", "img"):
            self.found[self.section][tag] += 1
        if tag == "img":
            self.check_image(values)
        if tag == "figcaption":
            self.caption = ""
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attributes):
        self.handle_starttag(tag, attributes)
        if tag not in VOID:
            self.open.pop()

    def handle_endtag(self, tag):
        if tag in VOID:
            return
        if not self.open or self.open.pop() != tag:
            self.wrong.append("</%s> does not close what is open" % tag)
        if tag == "section":
            self.section = None
        if tag == "figcaption":
            self.captions.append(self.caption)
            self.caption = None

    def handle_data(self, data):
        if self.caption is not None:
            self.caption += data
        if re.search(r"\b(nan|NaN|None|inf)\b", data):
            self.wrong.append("the text %r" % data[:60])

    def check_references(self, tag, values):
        for name in ("src", "href", "xlink:href", "action", "data", "poster", "srcset"):
            target = values.get(name) or "#"
            if not target.startswith(("#", "data:")):
                self.wrong.append("<%s> refers to %s" % (tag, target[:60]))
        if tag in ("script", "link", "iframe", "object", "embed"):
            self.wrong.append("<%s>" % tag)

    def check_image(self, values):
        if not values.get("alt"):
            self.wrong.append("an img without alt")
        kind, _, data = values.get("src", "").partition(",")
        try:
            good = kind == "data:image/png;base64" and base64.b64decode(data, validate=True)[:8] == b"\x89PNG\r\n\x1a\n"
        except binascii.Error:
            good = False
        if not good:
            self.wrong.append("an img that is no PNG")


def check_page(text):
    """Sentences, one per fault."""
    page = Page()
    page.feed(text)
    page.close()
    wrong = page.wrong + ["<%s> is never closed" % tag for tag in page.open]
    if re.search(r"url\((?!#)|@import", text):
        wrong.append("the style refers to something outside")
    if tuple(page.found) != SECTIONS:
        wrong.append("the sections are %s" % ", ".join(map(str, page.found)))
    for section, least in LEAST.items():
        have = page.found.get(section, {})
        for kind, count in zip(("table", "svg", "img"), least):
            if have.get(kind, 0) < count:
                wrong.append("section %s has %d %s, expected at least %d" % (section, have.get(kind, 0), kind, count))
    pictures = sum(found["img"] for found in page.found.values())
    rates = sum("blue few, red many" in caption for caption in page.captions)
    told = sum(CAPTION.search(caption) is not None for caption in page.captions)
    if told + rates != pictures:
        wrong.append("%d of %d pictures tell seconds, Mrays/s and relMSE" % (told, pictures - rates))
    return wrong


def check_numbers(study):
    wrong = []

    def walk(value, place):
        if isinstance(value, dict):
            for key, inner in value.items():
                walk(inner, "%s.%s" % (place, key))
        elif isinstance(value, list):
            for i, inner in enumerate(value):
                walk(inner, "%s[%d]" % (place, i))
        elif isinstance(value, float) and not math.isfinite(value):
            wrong.append("%s is %s" % (place, value))
        elif place.endswith((".seconds", ".mrays", ".median")) and not value >= 0:
            wrong.append("%s is %s" % (place, value))

    walk(study, "study")
    lines = study["markdown"].strip().splitlines()
    if not 5 <= len(lines) <= MOST_HEADLINES or any(line.count("|") != 4 for line in lines):
        wrong.append("the headline table has %d lines, expected 5 to %d of 3 cells" % (len(lines), MOST_HEADLINES))
    for key in ("command", "date", "glim", "device", "driver", "processor"):
        if not study["about"].get(key):
            wrong.append("about.%s is missing" % key)
    return wrong


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: check_page.py FOLDER")
    with open(os.path.join(sys.argv[1], "index.html"), encoding="utf-8") as file:
        checks = {"page": check_page(file.read())}
    with open(os.path.join(sys.argv[1], "study.json"), encoding="utf-8") as file:
        checks["numbers"] = check_numbers(json.load(file))
    for name, wrong in checks.items():
        for sentence in wrong:
            print("%s: %s" % (name, sentence))
    failed = sum(bool(wrong) for wrong in checks.values())
    print("%d passed, %d failed" % (len(checks) - failed, failed))
    sys.exit(failed > 0)


if __name__ == "__main__":
    main()
