"""Renders what the live page asks for, with one glim that stays."""

import concurrent.futures
import json
import os
import queue
import shlex
import threading

from render_farm.glim_child import Servers

from ..errors import StudyError
from ..markup import bracket, number, percent, signed_percent

BAD_OPTIONS = (1, 2)  # exit codes of glim that are about what it was asked


class BusyError(Exception):
    """Another picture is being rendered."""


class NotRenderedError(Exception):
    """By glim, with its sentence. `is_request`: because of what it was asked."""

    def __init__(self, sentence, is_request):
        super().__init__(sentence)
        self.is_request = is_request


def state_error(stats):
    """What glim says of the error: an estimate from 33 samples on, a bound with fewer, or nothing."""
    estimate = stats["estimate"]
    if estimate:
        low, high = estimate["relmse95"]
        return "relMSE " + bracket({"mean": estimate["relmse"], "low": low, "high": high})
    bound = stats["rmseOfMeanBound"]
    return "RMSE at most %s of the mean" % percent(bound) if bound is not None else "not stated"


def list_facts(stats):
    """(what, value) of a picture, as the page shows them."""
    seconds, estimate, steps = stats["seconds"]["render"], stats["estimate"], stats["steps"]
    facts = [("seconds", number(seconds)), ("error", state_error(stats))]
    if estimate:
        facts.append(("relMSE x seconds", number(estimate["relmse"] * seconds)))
    facts += [("samples a pixel", number(stats["samples"] / (stats["size"][0] * stats["size"][1]))),
              ("Mrays/s", number(1e-6 * stats["raysPerSecond"]))]
    bias = (stats["adaptive"] or {}).get("bias")
    if bias:
        low, high = bias["ofMean95"]
        facts.append(("bias of the mean", bracket({"mean": bias["ofMean"], "low": low, "high": high}, signed_percent)))
    if steps:
        facts.append(("node visits a ray", number(steps["nodesPerRay"])))
    return facts


def to_command(options):
    """The same picture by hand."""
    words = ["glim", "render", os.path.basename(options["file"]), "-o", "film.exr"]
    for name, value in options.items():
        if name == "size":
            value = "x".join(map(str, value))
        if name == "rates":
            value = "rates.png"
        if name != "file":
            words += ["--" + name, str(value)]
    return shlex.join(words)


class Renderer:
    """Other threads ask; the main thread, which glim is to die with, renders (run)."""

    def __init__(self, program, scenes, folder):
        self.program, self.scenes, self.folder = program, scenes, folder
        self.jobs, self.busy = queue.SimpleQueue(), threading.Lock()

    def ask(self, options):
        """The picture as PNG, and what the page tells of it. BusyError or NotRenderedError if there is none."""
        if not self.busy.acquire(blocking=False):
            raise BusyError
        try:
            done = concurrent.futures.Future()
            self.jobs.put((options, done))
            return done.result()
        finally:
            self.busy.release()

    def run(self):
        """Renders until a signal ends it, and then ends glim."""
        glim = Servers()
        try:
            while True:
                options, done = self.jobs.get()
                try:
                    done.set_result(self.render(glim, options))
                except (NotRenderedError, OSError, StudyError) as error:
                    done.set_exception(error)
        finally:
            glim.end()

    def render(self, glim, options):
        options = {**options, "file": self.scenes.path(options["file"]), "schedule": "wavefront"}  # as in the study
        film, picture, stats = (os.path.join(self.folder, name) for name in ("film.exr", "picture.png", "stats.json"))
        files = {"output": film, "stats": stats, "rates" if options.get("rates") else "image": picture}
        answer = glim.ask(self.program, self.folder, {"render": {**options, **files, "progress": "none"}})
        if answer["code"] != 0:
            raise NotRenderedError(answer["error"], answer["code"] in BAD_OPTIONS)
        with open(picture, "rb") as file:
            png = file.read()
        with open(stats, encoding="utf-8") as file:
            told = json.load(file)
        for path in (film, picture, stats):
            os.remove(path)
        return png, {"facts": list_facts(told), "digest": told["pixelsDigest"], "command": to_command(options)}
