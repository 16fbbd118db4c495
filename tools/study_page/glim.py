"""Running glim: one call, one process, its answer as plain values."""

import json
import os
import subprocess

from .arguments import ROOT
from .errors import StudyError


def trace_seconds(stats):
    kernels = stats["kernels"]
    kernel = kernels.get("trace_closest", kernels.get("course_trace_closest"))  # the latter without a BVH
    if kernel is None:
        raise StudyError("%s tells no time of the kernel trace_closest, which the study compares: it needs a device with "
                         "timestamps ('glim devices' lists them)" % stats["device"]["name"])
    return kernel["seconds"]


class Shot:
    """One `glim render`: where its files are, and its statistics."""

    def __init__(self, exr, png, rates, stats):
        self.exr, self.png, self.rates, self.stats = exr, png, rates, stats
        self.seconds = stats["seconds"]["render"]
        self.build_seconds = stats["seconds"]["build"]
        self.trace_seconds = trace_seconds(stats)
        self.samples = stats["samples"]
        self.rays = stats["rays"]["total"]
        self.pixels = stats["size"][0] * stats["size"][1]

    @property
    def mrays(self):
        return 1e-6 * self.rays / self.seconds if self.seconds > 0 else 0.0

    @property
    def spp(self):
        return self.samples / self.pixels


class Glim:
    def __init__(self):
        """Builds glim if need be: tools/glim does that before it answers."""
        other = os.environ.get("GLIM_BINARY")
        launcher = other or os.path.join(ROOT, "tools", "glim")
        self.version = self.run(launcher, "--version", show_errors=True).strip()
        self.binary = other or os.path.join(ROOT, "build", "glim")
        usable = [d for d in json.loads(self.run(self.binary, "devices", "--json")) if d["usable"]]
        if not usable:
            raise StudyError("glim devices lists no usable Vulkan device")
        self.device = usable[0]

    def run(self, *command, show_errors=False):
        try:
            done = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                  stderr=None if show_errors else subprocess.PIPE, text=True, check=False)
        except OSError as error:
            raise StudyError("cannot run %s: %s" % (command[0], error.strerror)) from error
        if done.returncode != 0:
            lines = (done.stderr or "").strip().splitlines() or ["see above" if show_errors else "it said nothing"]
            shown = " ".join(["glim", *map(os.path.basename, command[1:])])
            raise StudyError("'%s' ended with exit code %d: %s" % (shown, done.returncode, lines[-1]))
        return done.stdout

    def inspect(self, scene):
        return json.loads(self.run(self.binary, "inspect", scene, "--json"))

    def render(self, stem, scene, size, options, png=False, rates=False):
        """Writes stem.exr and, if asked, stem.png and stem.rates.png."""
        exr, stats = stem + ".exr", stem + ".json"
        command = [self.binary, "render", scene, "-o", exr, "--stats", stats, "--schedule", "wavefront", "--size", "%dx%d" % size,
                   "--progress", "none", *options]
        if png:
            command += ["--image", stem + ".png"]
        if rates:
            command += ["--rates", stem + ".rates.png"]
        self.run(*command)
        with open(stats, encoding="utf-8") as file:
            content = json.load(file)
        os.remove(stats)
        return Shot(exr, stem + ".png" if png else None, stem + ".rates.png" if rates else None, content)

    def compare(self, picture, reference):
        return json.loads(self.run(self.binary, "compare", picture, reference, "--json"))
