"""Section 4, third part: error against samples."""

from .. import plots
from ..estimates import fit_slope
from ..lab import FIRST_SEED, summarize
from ..markup import bracket, gallery, heading, number, paragraph, plot, relmse, table
from .light_paths import LONGEST, SCENE

SAMPLERS = ("sobol", "independent")
BLOCK = 32  # kFirstBlockSamples of shaders/shared/limits.h: Sobol' points of one scramble


def measure(lab, until):
    profile = lab.profile
    reference = lab.reference(SCENE, profile.light_size, profile.light_reference, *LONGEST)
    runs = {sampler: {spp: [] for spp in profile.spp} for sampler in SAMPLERS}
    for seed in lab.seeds(profile.spp_seeds, until=until):
        for sampler, found in runs.items():
            for spp in profile.spp:
                picture = seed == FIRST_SEED and sampler == "sobol" and spp in profile.spp_pictures
                found[spp].append(lab.measure("%s %d spp" % (sampler, spp), SCENE, profile.light_size, *LONGEST, "--sampler",
                                              sampler, "--spp", spp, seed=seed, reference=reference, png=picture))
    return {"referenceSpp": profile.light_reference, "samplers": {
        sampler: {"points": [{"spp": spp, **summarize(of_spp)} for spp, of_spp in found.items()],
                  "slopes": slopes_of(sampler, found)} for sampler, found in runs.items()}}


def slope_of(counts, runs):
    """From the counts at which every seed's error is above the long render's noise, which is known but roughly."""
    kept = [spp for spp in counts if all(run["relmse"] > run["referenceNoise"] for run in runs[spp])]
    return fit_slope(kept, list(zip(*[[run["relmse"] for run in runs[spp]] for spp in kept])))


def slopes_of(sampler, runs):
    """Blocks of Sobol' points are independent of each other, so that there are two slopes, and independent points have one."""
    counts = list(runs)
    if sampler == "independent":
        return {"of all": slope_of(counts, runs)}
    return {"to %d" % BLOCK: slope_of([n for n in counts if n <= BLOCK], runs),
            "from %d on" % BLOCK: slope_of([n for n in counts if n >= BLOCK], runs)}


def slopes_text(slopes):
    return ", ".join("%s %s" % (bracket(slope), where) for where, slope in slopes.items() if slope["mean"] is not None)


def show_errors(results):
    samplers = results["samplers"]
    panels = []
    for axis, key in (("samples per pixel", "spp"), ("seconds", "seconds")):
        panels.append((axis, [(name,
                               [(p[key], p["relmse"]) for p in found["points"]])
                              for name, found in samplers.items()]))
    rows = [("%d" % a["spp"], number(a["seconds"]), relmse(a), number(b["seconds"]), relmse(b))
            for a, b in zip(*(samplers[name]["points"] for name in SAMPLERS))]
    text = plot(plots.plot_errors("convergence", panels), "Independent points: the expected variance falls as 1 / n, "
                "slope -1. Owen-scrambled Sobol' points do better within blocks of %d; the blocks are independent." % BLOCK)
    text += paragraph("Slopes over samples per pixel: " + "; ".join(
        "%s %s" % (name, slopes_text(found["slopes"])) for name, found in samplers.items()) + ".")
    return text + table(("spp", "Sobol': seconds", "relMSE", "independent: seconds", "relMSE"), rows)


def show(results, pictures):
    points = results["samplers"]["sobol"]["points"]
    text = heading("Samples per pixel")
    text += paragraph("%d seeds; the long render has %d samples." % (points[0]["relmse"]["n"], results["referenceSpp"]))
    return text + gallery(pictures.figure("%d spp" % p["spp"], p) for p in points if p["picture"]) + show_errors(results)


def headlines(results):
    last = {name: found["points"][-1] for name, found in results["samplers"].items()}
    slopes = {name: slopes_text(found["slopes"]) for name, found in results["samplers"].items()}
    rows = [("%d samples instead of 1, %s points" % (point["spp"], name), "%s s" % number(point["seconds"]),
             "relMSE %s; slope %s" % (relmse(point), slopes[name])) for name, point in last.items()]
    return rows
