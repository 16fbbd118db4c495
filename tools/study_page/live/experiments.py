"""The experiments of the live page, as data, and which requests for them are within its limits."""

from dataclasses import dataclass, field

MOST_RAYS = 1 << 26  # of a picture, about; under half a minute on 2 cores without a GPU
RAYS_A_SAMPLE = 3    # besides those to the lights


class RefusedError(Exception):
    """A request beyond the limits, in one sentence."""


@dataclass(frozen=True)
class Choice:
    name: str
    label: str
    options: dict                                # by value: what it adds to the options of `glim render`
    start: str
    weights: dict = field(default_factory=dict)  # by value: how much longer a ray takes than in a BVH
    only_with: dict = field(default_factory=dict)

    def read(self, value):
        if not isinstance(value, str) or value not in self.options:
            raise RefusedError("%s: expected %s" % (self.name, ", ".join(self.options)))
        return self.options[value]

    def describe(self, scenes):
        """`scenes`: names by role."""
        return {"values": [[value, scenes.get(added.get("file"), value)] for value, added in self.options.items()]}


@dataclass(frozen=True)
class Count:
    name: str      # of the option, too
    label: str
    stops: tuple   # of the slider; between the first and the last, every number is allowed
    start: int
    only_with: dict = field(default_factory=dict)  # by name of another control: the values with which this one has an effect

    def read(self, value):
        if type(value) is not int or not self.stops[0] <= value <= self.stops[-1]:
            raise RefusedError("%s: expected a number from %d to %d" % (self.name, self.stops[0], self.stops[-1]))
        return {self.name: value}

    def describe(self, _):
        return {"stops": self.stops}


@dataclass(frozen=True)
class Experiment:
    key: str       # of the study's section
    title: str
    about: str
    options: dict  # of every picture
    controls: tuple


def powers(last):
    return tuple(2 ** i for i in range(last + 1))


def by_option(option, *values):
    return {value: {option: value} for value in values}


def size(*values, start):
    return Choice("size", "Pixels", {value: {"size": [int(side) for side in value.split("x")]} for value in values}, start)


SIZE = size("64x48", "128x96", "256x192", "512x384", start="256x192")
SAMPLES = Count("spp", "Samples a pixel", powers(10), 64)
SAMPLER = Choice("sampler", "Points", by_option("sampler", "sobol", "independent"), "sobol")
PARTS = by_option("paths", "all", "direct", "indirect")

EXPERIMENTS = (
    Experiment(
        "views", "1. Ray generation and intersection",
        "Camera rays alone: nothing is lit. More samples smooth the edges. The picture of node visits shows where rays take longest.",
        {}, (Choice("scene", "Scene", by_option("file", "spheres", "gems", "cow"), "spheres"),
             Choice("view", "Picture of", by_option("view", "normal", "depth", "bvh-steps"), "normal"),
             Count("spp", "Samples a pixel", powers(6), 4), SIZE)),
    Experiment(
        "acceleration", "2. The bounding volume hierarchy",
        "5,856 triangles with a tree of boxes and without one, and three rules that split its nodes. The picture stays the same, bit for "
        "bit; compare the seconds.",
        {"file": "cow", "view": "normal"},
        (Choice("tree", "Tree", {"sah": {"split": "sah"}, "mean": {"split": "mean"}, "median": {"split": "median"},
                                 "none": {"accelerator": "none"}}, "sah", weights={"none": 64}),
         Count("spp", "Samples a pixel", powers(6), 1), size("64x48", "128x96", "256x192", "512x384", start="128x96"))),
    Experiment(
        "direct", "3. Direct light",
        "One bounce. Uniform directions seldom meet the lamp; points on the lamp always aim at it; bsdf leaves it to the reflected ray; "
        "mis weights two ways. Compare relMSE x seconds: how long each takes to the same error.",
        {"file": "spheres", "bounces": 1, "paths": "direct"},
        (Choice("direct", "Estimator", by_option("direct", "hemisphere", "lights", "bsdf", "mis"), "hemisphere"),
         Count("light-samples", "Light rays a hit", powers(6), 1, only_with={"direct": ["hemisphere", "lights"]}),
         SAMPLES, SAMPLER, SIZE)),
    Experiment(
        "global", "4. Global illumination",
        "Light that meets more than one surface, how many bounces it takes, and ways to end a path. In the furnace, a closed room, "
        "roulette is most of the noise.",
        {}, (Choice("scene", "Scene", by_option("file", "spheres", "furnace"), "spheres"),
             Count("bounces", "Bounces at most", (0, 1, 2, 3, 4, 5, 8, 16, 32, 64, 100), 5),
             Choice("paths", "Light", PARTS, "all"),
             Choice("roulette", "Roulette", by_option("roulette", "none", "throughput", "fixed:0.7"), "throughput"),
             Choice("direct", "Direct light by", by_option("direct", "mis", "lights", "hemisphere", "bsdf"), "mis"),
             SAMPLES, SAMPLER, SIZE)),
    Experiment(
        "adaptive", "5. Adaptive sampling",
        "The course's rule: a pixel ends once the interval of its mean is within the tolerance. Blue pixels took the fewest samples, red "
        "ones the most.",
        {"file": "spheres", "adaptive": "course"},
        (Choice("tolerance", "Tolerance", {text: {"tolerance": float(text)} for text in ("0.05", "0.1", "0.2", "0.4")}, "0.2"),
         Count("max-spp", "Samples a pixel at most", powers(10)[5:], 256),
         Choice("show", "Picture of", {"light": {}, "samples taken": {"rates": True}}, "light"),
         size("64x48", "128x96", "256x192", start="128x96"))))
BY_KEY = {experiment.key: experiment for experiment in EXPERIMENTS}


def describe(scenes):
    """What the page makes its controls from. `scenes`: their names by role."""
    return [{"key": e.key, "title": e.title, "about": e.about,
             "controls": [{"name": c.name, "label": c.label, "start": c.start, "onlyWith": c.only_with, **c.describe(scenes)}
                          for c in e.controls]} for e in EXPERIMENTS]


def read_request(request):
    """The options of `glim render` that a request stands for: the scene (`file`) by its role, `rates` if it is the picture."""
    if not isinstance(request, dict):
        raise RefusedError("a request is an object")
    asked = dict(request)
    experiment = asked.pop("experiment", None)
    if not isinstance(experiment, str) or experiment not in BY_KEY:
        raise RefusedError("experiment: expected %s" % ", ".join(BY_KEY))
    experiment = BY_KEY[experiment]
    values = {control.name: asked.pop(control.name, control.start) for control in experiment.controls}
    if asked:
        raise RefusedError("%s has no such control: expected %s" % (experiment.key, ", ".join(values)))
    options, weight = dict(experiment.options), 1
    for control in experiment.controls:
        added = control.read(values[control.name])
        if all(values[name] in with_it for name, with_it in control.only_with.items()):
            options.update(added)
        if isinstance(control, Choice):
            weight *= control.weights.get(values[control.name], 1)
    limit_rays(options, weight)
    return options


def limit_rays(options, weight):
    width, height = options["size"]
    most = MOST_RAYS // (width * height * (RAYS_A_SAMPLE + options.get("light-samples", 1)) * weight)
    name = "max-spp" if "max-spp" in options else "spp"
    if options[name] > most:
        raise RefusedError("%s: expected at most %d with these settings, or a smaller picture" % (name, most))
