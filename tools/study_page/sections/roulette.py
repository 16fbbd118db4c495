"""Section 4, second part: three ways to end a path, with their mean and their variance."""

from ..estimates import mean_interval, positive_interval, ratio_of_means
from ..lab import summarize, time_ratio
from ..markup import bracket, heading, number, paragraph, table
from .light_paths import LONGEST

MODES = ("none", "throughput", "fixed:0.7")
# Light found by scattering alone: then every path of the furnace gives the same, and all variance is the roulette's.
SCENES = {"spheres": LONGEST, "furnace": (*LONGEST, "--direct", "bsdf")}
UNBOUNDED = ("furnace", "fixed:0.7")  # its variance grows with every bounce more: no interval of it means anything
ROUNDING = 1e-9  # a variance below this is what float32 leaves


def reference_of(lab, scene, size):
    if scene == "furnace":
        return lab.reference(scene, size, 1, *SCENES[scene], "--roulette", "none")
    return lab.reference(scene, size, lab.profile.light_reference, *SCENES[scene])


def variances(runs):
    """Of one sample, averaged over pixels and channels: MSE times samples."""
    return [run["mse"] * run["spp"] for run in runs]


def summarize_mode(runs, none, baseline):
    """Pairs by seed with no roulette, which no mean can be truer than; efficiency is 1 / (variance x seconds)."""
    found = variances(runs)
    noisy, noisy_none = max(found) > ROUNDING, max(variances(none)) > ROUNDING
    costs, others = ([run["mse"] * run["seconds"] for run in side] for side in (runs, baseline))
    return {**summarize(runs), "variance": positive_interval(found), "largestVariance": max(found),
            "meanLessNone": mean_interval([run["meanRatio"] - other["meanRatio"] for run, other in zip(runs, none)]),
            "varianceOverNone": ratio_of_means(found, variances(none)) if noisy_none else None,
            "secondsOverNone": time_ratio(runs, none), "efficiency": ratio_of_means(others, costs) if noisy else None}


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
    return {mode: summarize_mode(found, runs["none"], baseline) for mode, found in runs.items()}


def measure(lab, until):
    return {"spp": lab.profile.roulette_spp, "scenes": {scene: measure_scene(lab, scene, until) for scene in SCENES}}


def table_row(scene, mode, entry):
    form = (lambda value: "%s, no interval" % number(value["mean"])) if (scene, mode) == UNBOUNDED else bracket
    less = entry["meanLessNone"] if mode != "none" else None
    fine = "{:+.3%}".format
    return (mode, "" if less is None else fine(less["mean"]) + ", no interval" if form is not bracket else bracket(less, fine),
            form(entry["variance"]), number(entry["largestVariance"]), number(entry["rays"] / entry["samples"]),
            number(entry["seconds"]), form(entry["efficiency"]) if entry["efficiency"] else "no variance")


def show(results, names):
    captions = {"spheres": "%s; efficiency relative to none" % names["spheres"].capitalize(),
                "furnace": "Closed room of albedo .9 in which every path carries the same light, so that the roulette is the "
                           "only noise; efficiency relative to throughput"}
    text = heading("Russian roulette")
    text += paragraph("%d samples a pixel with independent points, at most 100 bounces. Variance is that of one sample, mean "
                      "over pixels and channels. Means are compared with those without roulette of the same seed, as a share "
                      "of the long render's mean, whose own error so only scales them. Without roulette the room's mean is "
                      "exact." % results["spp"])
    for scene, modes in results["scenes"].items():
        seeds = "%s, %d seeds" % (captions[scene], modes["none"]["relmse"]["n"])
        text += table(("roulette", "mean less none's, same seed", "variance", "largest of a seed", "rays a path", "seconds",
                       "efficiency"), [table_row(scene, mode, entry) for mode, entry in modes.items()], seeds)
    return text + paragraph(
        "With the fixed probability .7 a path's weight grows by albedo / .7 a bounce, so its second moment is the sum of "
        "(albedo^2 / .7)^k, which without a limit on bounces is infinite from albedo .837 on. In the room of albedo .9 the "
        "measured variance is therefore that of the samples at hand and would grow with more of them, and seeds that all "
        "lack the rare heavy paths agree more than they should: so no intervals there.")


def headlines(results):
    return [("Roulette %s instead of none" % mode, "%s times the variance" % bracket(entry["varianceOverNone"]),
             "%s times the seconds, efficiency x %s" % (bracket(entry["secondsOverNone"]), bracket(entry["efficiency"])))
            for mode, entry in results["scenes"]["spheres"].items() if mode != "none"]
