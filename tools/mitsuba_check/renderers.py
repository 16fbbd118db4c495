"""The same pictures by both renderers: seed by seed, with seconds."""

import json
import os
import subprocess
import sys
import time
from functools import lru_cache

import numpy as np

from .errors import CheckError

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
MISSING = ("Mitsuba is not installed for %s: run 'pip install mitsuba numpy' in a virtual environment and start this with its "
           "python; the fast variant also needs Debian's libllvm19 (14, 15 and 16 fail)" % sys.executable)
TRY_LLVM = """
import mitsuba as mi
mi.set_variant("llvm_ad_rgb")
scene = mi.cornell_box()
scene["sensor"]["film"].update(width=8, height=8)
mi.render(mi.load_dict(scene), spp=1).numpy()
"""
EXPLANATIONS = {
    "llvm_ad_rgb": "Mitsuba's variant is llvm_ad_rgb",
    "scalar_rgb": "Mitsuba's variant is scalar_rgb, which is slow, since llvm_ad_rgb did not run: install Debian's libllvm19, or "
                  "name the library of LLVM 19 in DRJIT_LIBLLVM_PATH",
}


@lru_cache(maxsize=None)
def choose_variant():
    """An LLVM of the wrong version ends the process, so another process tries it."""
    tried = subprocess.run([sys.executable, "-B", "-c", TRY_LLVM], capture_output=True, check=False)
    return "llvm_ad_rgb" if tried.returncode == 0 else "scalar_rgb"


class Renders:
    def __init__(self):
        self.pictures, self.seconds, self.start = [], [], []

    def add(self, picture, seconds, start):
        self.pictures.append(picture)
        self.seconds.append(seconds)
        self.start.append(start)

    def arrays(self):
        return np.array(self.pictures, float), np.array(self.seconds)


def import_mitsuba():
    try:
        import mitsuba
    except ImportError as error:
        raise CheckError(MISSING) from error
    return mitsuba


def read_picture(path):
    """R, G and B of an EXR, whatever other layers it has."""
    mi = import_mitsuba()
    mi.set_variant(choose_variant())
    return np.array(dict(mi.Bitmap(path).split())["<root>"], float)[..., :3]


class Mitsuba:
    def __init__(self, scene, options):
        mi = self.mi = import_mitsuba()
        self.variant = choose_variant()
        began = time.perf_counter()
        mi.set_variant(self.variant)
        mi.set_log_level(mi.LogLevel.Error)
        from .build_scene import build_scene
        from .plugins import register_plugins
        register_plugins()
        self.scene = build_scene(scene, options.size, options.bounces, options.environment)
        self.explanation = EXPLANATIONS[self.variant]
        self.name = "Mitsuba %s, %s" % (mi.__version__, self.variant)
        self.spp = options.spp
        self.render(0, 1 if self.variant.startswith("scalar") else self.spp)  # compiles
        self.start = time.perf_counter() - began

    def render(self, seed, spp):
        return np.array(self.mi.render(self.scene, seed=seed, spp=spp))[..., :3]

    def add_render(self, seed, renders):
        began = time.perf_counter()
        picture = self.render(seed, self.spp)
        renders.add(picture, time.perf_counter() - began, self.start)


def text_of(environment):
    return environment if isinstance(environment, str) else ",".join("%r" % c for c in environment)


def build_glim():
    """The program to run, which tools/glim builds if need be."""
    named = os.environ.get("GLIM_BINARY")
    if not named:
        run_glim(os.path.join(ROOT, "tools", "glim"), "--version", show_errors=True)  # minutes the first time
    return named or os.path.join(ROOT, "build", "glim")


def run_glim(program, *arguments, show_errors=False, driver=None):
    """driver: the ICD file of the Vulkan driver to run on."""
    environment = {**os.environ, "VK_DRIVER_FILES": driver, "VK_ICD_FILENAMES": driver} if driver else None
    done = subprocess.run([program, *arguments], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, env=environment,
                          stderr=None if show_errors else subprocess.PIPE, text=True, check=False)
    if done.returncode != 0:
        lines = (done.stderr or "").strip().splitlines() or ["see above" if show_errors else "it said nothing"]
        raise CheckError("glim %s ended with exit code %d: %s" % (arguments[0], done.returncode, lines[-1]))
    return done.stdout


def two_sided(program):
    """The option that shows back faces, as Mitsuba does; builds without it always do."""
    return ["--back-faces", "shown"] if "--back-faces" in run_glim(program, "render", "--help-all") else []


class Glim:
    def __init__(self, options, folder, program, driver=None):
        self.options, self.folder, self.program, self.driver = options, folder, program, driver
        self.device, self.stats = None, None
        self.two_sided, self.more = two_sided(program), []

    def render(self, seed, spp):
        """The path of the picture."""
        exr, stats = os.path.join(self.folder, "glim.exr"), os.path.join(self.folder, "glim.json")
        for path in (exr, stats):
            if os.path.exists(path):
                os.remove(path)
        options = self.options
        more = self.two_sided + self.more + ([] if options.environment is None else ["--environment", text_of(options.environment)])
        run_glim(self.program, "render", options.scene, "-o", exr, "--stats", stats, "--size", "%dx%d" % options.size, "--progress",
                 "none", "--spp", str(spp), "--seed", str(seed), "--bounces", str(options.bounces), *more, driver=self.driver)
        if not (os.path.exists(exr) and os.path.exists(stats)):
            raise CheckError("%s wrote no picture: it is not glim" % self.program)
        with open(stats, encoding="utf-8") as file:
            self.stats = json.load(file)
        self.device = self.stats["device"]["name"]
        return exr

    def add_render(self, seed, renders):
        began = time.perf_counter()
        exr = self.render(seed, self.options.spp)
        whole, rendering = time.perf_counter() - began, self.stats["seconds"]["render"]
        renders.add(read_picture(exr), rendering, whole - rendering)
