"""Section 4: light that met more than one surface."""

from ..markup import paragraph
from . import convergence, light_paths, roulette

KEY, TITLE = "global", "4. Global illumination"


def measure(lab):
    return {"size": lab.profile.light_size, "names": lab.scenes.names, "paths": light_paths.measure(lab),
            "roulette": roulette.measure(lab, until=0.5), "convergence": convergence.measure(lab, until=1.0)}


def show(results, pictures):
    text = paragraph("%s at %d x %d, direct light by multiple importance sampling." %
                     (results["names"]["spheres"].capitalize(), *results["size"]))
    return (text + light_paths.show(results["paths"], pictures) + roulette.show(results["roulette"], results["names"]) +
            convergence.show(results["convergence"], pictures))


def headlines(results):
    return (light_paths.headlines(results["paths"]) + roulette.headlines(results["roulette"]) +
            convergence.headlines(results["convergence"]))
