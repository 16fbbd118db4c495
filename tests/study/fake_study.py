"""A study of made-up numbers in the form that the sections measure. It tests the page without rendering."""

import os
import struct
import zlib

from study_page import profiles
from study_page.page import collect_headlines, to_markdown
from study_page.sections import SECTIONS

NAMES = {"spheres": "two spheres", "gems": "three gems", "cow": "cow <&>", "beast": "beast", "bunny": "bunny"}


def write_png(path):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 1, 1, 8, 0, 0, 0, 0)) +
                   chunk(b"IDAT", zlib.compress(b"\0\0")) + chunk(b"IEND", b""))


class FakeGlim:
    def compare(self, _picture, _reference):
        return {"mean_ratio": {"all": {"value": 0.7, "low": 0.69, "high": 0.71}}, "relation": "identical"}


class FakeScenes:
    names, is_course = NAMES, True

    def path(self, role):
        return role

    def blob(self, triangles):
        return "blob%d" % triangles


class FakeShot:
    def __init__(self, folder, name):
        self.exr = os.path.join(folder, "scratch.exr")
        self.seconds, self.trace_seconds = 0.01 * (len(name) + 1), 0.001 * len(name)
        self.build_seconds, self.pixels = 0.001, 12
        self.stats = {"size": [4, 3], "bvh": {"split": "sah", "nodes": 9, "depth": 4, "cost": 2.0},
                      "steps": {"nodesPerRay": 7.5, "primitivesPerRay": 2.5, "mostNodes": 31}}


class FakeLab:
    """Answers like Lab, without rendering; `asked` holds the renders that were asked for."""

    def __init__(self, folder):
        self.folder, self.profile, self.glim, self.scenes = folder, profiles.QUICK, FakeGlim(), FakeScenes()
        self.asked, self.finished = [], {}
        os.makedirs(os.path.join(folder, "pictures"))
        write_png(os.path.join(folder, "pictures", "one.png"))

    def few_seeds(self):
        return range(1, self.profile.few_seeds + 1)

    def seeds(self, least_most, until):
        assert 0 < until <= 1
        return range(1, least_most[0] + 1)

    def render(self, name, scene, _size, *options, **_more):
        self.asked.append((scene, options))
        return FakeShot(self.folder, name)

    def triangles(self, scene):
        return int(scene[4:]) if scene.startswith("blob") else 5856

    def reference(self, scene, size, spp, *options):
        return self.render("reference", scene, size, "--spp", spp, *options)

    def measure(self, name, scene, _size, *options, seed, reference, png=False, rates=False):
        assert reference is not None
        self.asked.append((scene, options))
        spp = options[options.index("--spp") + 1] if "--spp" in options else 24
        return fake_run(spp, seed, png, rates)

    def judge(self, _shot, reference):
        assert reference is not None
        return fake_run(1, 1, True, False)


def fake_run(spp, seed, png, rates):
    error = 0.1 / spp * (1 + 0.01 * seed)
    return {"seconds": 0.001 * spp, "mrays": 1.5, "samples": 12 * spp, "spp": float(spp), "rays": 40 * spp, "relmse": error,
            "referenceNoise": 0.0005, "mse": 2 * error, "meanRatio": 1 - 0.001 * seed, "steps": None,
            "picture": "one.png" if png else None, "rates": "one.png" if rates else None}


def fake_study(folder):
    """The study and the lab that was asked for it."""
    lab = FakeLab(folder)
    measured = {section.KEY: section.measure(lab) for section in SECTIONS}
    headlines = collect_headlines(measured)
    about = {key: "made up" for key in ("command", "date", "glim", "device", "driver", "kind", "processor", "system")}
    return {"about": about, "profile": "quick", "scenes": {"set": "no scenes", "files": {}}, "budgets": lab.profile.budgets,
            "taken": {section.KEY: 1.0 for section in SECTIONS}, "headlines": headlines, "markdown": to_markdown(headlines),
            "sections": measured}, lab
