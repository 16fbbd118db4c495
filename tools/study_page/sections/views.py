"""Section 1: ray generation and intersection."""

from ..lab import FIRST_SEED, summarize
from ..markup import gallery, heading, paragraph

KEY, TITLE = "views", "1. Ray generation and intersection"
VIEWS = {"spheres": ("normal", "depth", "bvh-steps"), "gems": ("normal", "bvh-steps")}
SPP, LONG_SPP = 4, 64


def measure(lab):
    size, shown = lab.profile.view_size, {}
    for scene, views in VIEWS.items():
        shown[scene] = {}
        for view in views:
            reference = lab.reference(scene, size, LONG_SPP, "--view", view)
            shown[scene][view] = summarize([
                lab.measure("%s %s" % (view, scene), scene, size, "--view", view, "--spp", SPP, seed=seed,
                            reference=reference, png=seed == FIRST_SEED) for seed in lab.few_seeds()])
    return {"size": size, "names": lab.scenes.names, "views": shown}


def show(results, pictures):
    text = paragraph("Camera rays alone, %d a pixel, at %d x %d: nothing is lit. The colour of a normal view is (n + 1) / 2, "
                     "its relMSE against %d rays a pixel what is left of the edges' staircase." %
                     (SPP, *results["size"], LONG_SPP))
    for scene, views in results["views"].items():
        name = results["names"][scene]
        text += heading(name.capitalize())
        text += gallery(pictures.figure("%s, %s" % (name, view), run) for view, run in views.items())
    return text


def headlines(results):
    run = results["views"]["spheres"]["normal"]
    return [("Camera rays, two spheres", "%.3g s at %d x %d" % (run["seconds"], *results["size"]),
             "%.3g Mrays/s" % run["mrays"])]
