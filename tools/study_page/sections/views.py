"""Section 1: ray generation and intersection."""

from ..lab import FIRST_SEED, summarize
from ..markup import gallery, heading, number, paragraph

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


def title(name, view, run):
    visits = ", %s node visits a ray" % number(run["steps"]["nodesPerRay"]) if run["steps"] else ""
    return "%s, %s%s" % (name, view, visits)


def show(results, pictures):
    text = paragraph("Camera rays alone, %d a pixel, at %d x %d: nothing is lit. The colour of a normal view is (n + 1) / 2; "
                     "depth goes from white, the nearest, to grey, and black is nothing; bvh-steps, the visits of inner nodes, "
                     "from blue to red, which each picture has where it has most. relMSE, against %d rays a pixel, is what is "
                     "left of the edges' staircase. %d seeds." %
                     (SPP, *results["size"], LONG_SPP, results["views"]["spheres"]["normal"]["relmse"]["n"]))
    for scene, views in results["views"].items():
        name = results["names"][scene]
        text += heading(name.capitalize())
        text += gallery(pictures.figure(title(name, view, run), run) for view, run in views.items())
    return text


def headlines(results):
    run = results["views"]["spheres"]["normal"]
    return [("Camera rays, %s" % results["names"]["spheres"],
             "%s s for %d a pixel at %d x %d" % (number(run["seconds"]), SPP, *results["size"]),
             "%s Mrays/s" % number(run["mrays"]))]
