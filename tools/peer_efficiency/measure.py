"""Renders a scene with glim and with Mitsuba by turns, and compares them."""

import copy
import resource
import time

import numpy as np

from mitsuba_check.arguments import MIN_SEEDS
from mitsuba_check.errors import CheckError
from mitsuba_check.figures import test_bias
from mitsuba_check.renderers import Glim, Mitsuba, read_picture
from mitsuba_check.report import warn_of_size
from mitsuba_check.scene import read_scene, require_light, size_of

from .estimates import compare, pixels_of_tiles, spread, tile_errors, weights_of
from .references import find_reference, shrink

FEWER = 16  # times fewer samples in the renders that are subtracted


class Task:
    """A scene that Mitsuba can take, with the options of rendering it."""

    def __init__(self, path, options):
        self.scene = read_scene(path)
        require_light(self.scene)
        self.options = copy.copy(options)
        self.options.scene, self.options.environment = path, None
        self.options.size = options.size or size_of(self.scene, 256)
        self.reference = find_reference(options.references, path) if options.references else None
        self.long_render = shrink(read_picture(self.reference), self.options.size, self.reference) if self.reference else None


def read_tasks(options):
    """All of them, before any is rendered: what is refused is refused at once."""
    return [Task(path, options) for path in options.scenes]


def seconds_used(who):
    used = resource.getrusage(who)
    return np.array([used.ru_utime + used.ru_stime, time.perf_counter()])


class Turns:
    """One renderer's pictures, and its seconds of a sample in each round: CPU, wall."""

    def __init__(self, name, renderer, who):
        """who: whose seconds those are, this process's or its children's."""
        self.name, self.renderer, self.who = name, renderer, who
        self.forget()

    def timed(self, seed, spp):
        began = seconds_used(self.who)
        result = self.renderer.render(seed, spp)
        return result, seconds_used(self.who) - began

    def add_round(self, seed, spp, pixels, read):
        few = max(1, spp // FEWER)
        self.renderer.render(seed, few)  # the first after the other renderer is slower
        start = self.timed(seed, few)[1]
        result, whole = self.timed(seed, spp)
        picture = np.array(read(result), float)
        if not np.isfinite(picture).all():
            raise CheckError("the picture by %s with seed %d has values that are not finite" % (self.name, seed))
        self.pictures.append(picture)
        self.costs.append((whole - start) / ((spp - few) * pixels))
        self.fixed.append(whole - self.costs[-1] * spp * pixels)

    def forget(self):
        self.pictures, self.costs, self.fixed = [], [], []

    def mostly_starts(self, spp, pixels):
        return np.median(self.fixed, axis=0)[0] > np.median(self.costs, axis=0)[0] * spp * pixels


def render_by_turns(task, glims, mitsuba, say):
    options, pixels = task.options, task.options.size[0] * task.options.size[1]
    turns = [(Turns("glim", glim, resource.RUSAGE_CHILDREN), read_picture) for glim in glims]
    turns.append((Turns("Mitsuba", mitsuba, resource.RUSAGE_SELF), np.asarray))
    for counted in range(options.seeds + 1):  # the first fills caches of kernels, and may measure glim's schedules
        for renderer, read in turns:
            renderer.add_round(counted, options.spp, pixels, read)
            if counted == 0:
                renderer.forget()
        if counted == 0:
            refuse_gpus(glims)
        say("%s: %s" % (options.scene, "%d of %d rounds" % (counted, options.seeds) if counted else "warm"))
    return [renderer for renderer, _ in turns]


def refuse_gpus(glims):
    for glim in glims:
        if glim.stats["device"].get("kind") != "software":
            raise CheckError("glim runs on %s, whose work is not in CPU seconds: name a software --driver" % glim.device)


def figures_of(turns, relmse, spp, pixels):
    cpu, wall = np.array(turns.costs).T
    error, cost = relmse["value"], float(np.median(cpu))
    return {"relmse_spp": {key: value * spp for key, value in relmse.items()},
            "cpu_us": spread(1e6 * cpu), "wall_us": spread(1e6 * wall),
            "efficiency": 1 / (error * cost * spp * pixels) if error > 0 and cost > 0 else None}


def row_of(task, program, glim, mitsuba, say):
    """program: its name; glim, mitsuba: the turns of each."""
    options, (width, height) = task.options, task.options.size
    a, b = np.array(glim.pictures), np.array(mitsuba.pictures)
    weights = weights_of(0.5 * (a.mean(axis=0) + b.mean(axis=0)) if task.long_render is None else task.long_render)
    costs = [np.array(turns.costs)[:, 0] for turns in (glim, mitsuba)]
    found = compare([tile_errors(renders, weights) for renders in (a, b)], pixels_of_tiles(height, width), costs)
    test = test_bias(a, b, options.spp)
    if options.seeds >= MIN_SEEDS and max(map(abs, test["z_test"]["mean_z"])) > test["z_test"]["mean_limit"]:
        say("%s: the means differ by more than noise, glim's is %.4f of Mitsuba's: see tools/against_mitsuba.py" % (
            options.scene, test["ratio"]["all"]["value"]))
    sides = [figures_of(turns, relmse, options.spp, width * height) for turns, relmse in zip((glim, mitsuba), found["relmse"])]
    device = glim.renderer.stats["device"]
    return {"scene": options.scene, "size": [width, height], "reference": task.reference, "driver": device["driver"],
            "device": device["name"], "program": program, "peer": mitsuba.renderer.name, "glim": sides[0],
            "mitsuba": sides[1], "mean_ratio": test["ratio"]["all"],
            "ratios": {key: found[key] for key in ("samples", "time", "efficiency")}}


def warn_of_time(options, turns, say):
    for name in dict.fromkeys(t.name for t in turns if t.mostly_starts(options.spp, options.size[0] * options.size[1])):
        say("%s: %s spent more on starting than on samples, so its time is uncertain: raise --spp or --size" % (options.scene, name))


def measure_scene(task, programs, folder, say):
    """A row for each driver and program; programs: paths by name."""
    warning = warn_of_size(*task.scene.bounds())
    if warning:
        say("%s: %s" % (task.options.scene, warning))
    mitsuba = Mitsuba(task.scene, task.options)
    if mitsuba.variant.startswith("scalar"):
        say(mitsuba.explanation)
    glims = [Glim(task.options, folder, program, driver) for driver in task.options.drivers for program in programs.values()]
    turns = render_by_turns(task, glims, mitsuba, say)
    warn_of_time(task.options, turns, say)
    names = [name for _ in task.options.drivers for name in programs]
    return [row_of(task, name, glim, turns[-1], say) for name, glim in zip(names, turns)]
