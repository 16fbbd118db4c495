"""Section 4, second part: three ways to end a path, with their mean and their variance."""

from ..estimates import positive_interval, ratio_of_means, standard_error
from ..lab import summarize
from ..markup import bracket, heading, number, paragraph, table
from .light_paths import LONGEST

MODES = ("none", "throughput", "fixed:0.7")
# Light found by scattering alone: then every path of the furnace gives the same, and all variance is the roulette's.
SCENES = {"spheres": LONGEST, "furnace": (*LONGEST, "--direct", "bsdf")}
ROUNDING = 1e-9  # a variance below this is what float32 leaves


def reference_of(lab, scene, size):
    if scene == "furnace":
        return lab.reference(scene, size, 1, *SCENES[scene], "--roulette", "none")
    return lab.reference(scene, size, lab.profile.light_reference, *SCENES[scene])


def summarize_mode(runs, baseline):
    """Variance of one sample, averaged over pixels and channels, is MSE times samples; efficiency 1 / (variance x seconds)."""
    variances = [run["mse"] * run["spp"] for run in runs]
    costs = [run["mse"] * run["seconds"] for run in runs]
    ratios = [run["meanRatio"] for run in runs]
    return {**summarize(runs), "variance": positive_interval(variances), "largestVariance": max(variances),
            "standardError": standard_error(ratios),
            "efficiency": ratio_of_means([run["mse"] * run["seconds"] for run in baseline], costs)
                          if max(variances) > ROUNDING else None}


def measure_scene(lab, scene, until):
    size = lab.profile.roulette_sizes[scene]
    reference = reference_of(lab, scene, size)
    runs = {mode: [] for mode in MODES}
    for seed in lab.seeds(lab.profile.roulette_seeds, until=until):
        for mode in MODES:
            name = "roulette %s %s" % (mode.replace(":", " "), scene)
            runs[mode].append(lab.measure(name, scene, size, *SCENES[scene], "--roulette", mode, "--sampler", "independent",
                                          "--spp", lab.profile.roulette_spp, seed=seed, reference=reference))
    # In the furnace no roulette is free of variance, so it cannot be what efficiencies are measured by.
    baseline = runs["throughput" if scene == "furnace" else "none"]
    return {mode: summarize_mode(found, baseline) for mode, found in runs.items()}


def measure(lab, until):
    return {"spp": lab.profile.roulette_spp, "scenes": {scene: measure_scene(lab, scene, until) for scene in SCENES}}


def mean_text(entry):
    ratio, error = entry["meanRatio"]["mean"], entry["standardError"]
    return "%.5f" % ratio if error is None else "%.5f +- %.5f" % (ratio, 2 * error)


def show(results, names):
    captions = {"spheres": "%s, against the long render; efficiency relative to none" % names["spheres"].capitalize(),
                "furnace": "Closed room of albedo .9 in which every path carries the same light, so that the roulette is the "
                           "only noise; efficiency relative to throughput"}
    text = heading("Russian roulette")
    text += paragraph("%d samples a pixel with independent points, at most 100 bounces. Variance is that of one sample, mean "
                      "over pixels and channels." % results["spp"])
    for scene, modes in results["scenes"].items():
        rows = [(mode, mean_text(entry), bracket(entry["variance"]), number(entry["largestVariance"]),
                 number(entry["rays"] / entry["samples"]), number(entry["seconds"]),
                 bracket(entry["efficiency"]) if entry["efficiency"] else "no variance")
                for mode, entry in modes.items()]
        text += table(("roulette", "mean / truth +- 2 s.e.", "variance", "largest of a seed", "rays a path", "seconds",
                       "efficiency"), rows, captions[scene])
    return text + paragraph(
        "With the fixed probability .7 a path's weight grows by albedo / .7 a bounce, so its second moment is the sum of "
        "(albedo^2 / .7)^k: it is infinite from albedo .837 on. In the room of albedo .9 the measured variance is therefore "
        "that of the samples at hand and would grow with more of them; the mean stays right.")


def headlines(results):
    spheres = results["scenes"]["spheres"]
    rows = []
    for mode in MODES[1:]:
        entry = spheres[mode]
        rows.append(("Roulette %s instead of none" % mode,
                     "%s times the variance" % number(entry["variance"]["mean"] / spheres["none"]["variance"]["mean"]),
                     "%s times the seconds, efficiency x %s" % (number(entry["seconds"] / spheres["none"]["seconds"]),
                                                                bracket(entry["efficiency"]))))
    return rows
