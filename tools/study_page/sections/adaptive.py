"""Section 5: the course's adaptive sampling, against uniform sampling of the same cost and against the truth."""

from ..estimates import mean_interval, ratio_of_means, standard_error
from ..lab import FIRST_SEED, summarize
from ..markup import bracket, gallery, heading, number, paragraph, percent, relmse, signed_percent, table

KEY, TITLE = "adaptive", "5. Adaptive sampling"
SCENES = ("bunny", "spheres")
BATCH = 32
CONSTANT_SAMPLES = 1024  # kConstantSamples of shaders/shared/limits.h
RULES = ("course", "course:literal")
# Of an experiment with oracle variances in another renderer: one room, 5,638 and 2,723 samples a pixel.
EARLIER_BIAS = "-1.4 % with light sampling, -3.7 % with caustics"


def adaptive_options(profile, rule):
    return ("--adaptive", rule, "--tolerance", profile.tolerance, "--batch", BATCH, "--max-spp", profile.max_spp)


def uniform_options(spp):
    return ("--sampler", "independent", "--spp", max(1, round(spp)))


def equal_time_spp(adaptive, uniform):
    """Samples a pixel that uniform sampling takes in the seconds of the adaptive render."""
    return uniform["spp"] * adaptive["seconds"] / uniform["seconds"]


def measure_pictures(lab, scene):
    profile, size = lab.profile, lab.profile.adaptive_size
    reference = lab.reference(scene, size, profile.adaptive_reference)
    course = lab.measure("adaptive %s" % scene, scene, size, *adaptive_options(profile, "course"), seed=FIRST_SEED,
                         reference=reference, png=True, rates=True)
    uniform = lab.measure("uniform %s" % scene, scene, size, *uniform_options(course["spp"]), seed=FIRST_SEED,
                          reference=reference, png=True)
    spp = equal_time_spp(course, uniform)
    timed = lab.measure("equal time %s" % scene, scene, size, *uniform_options(spp), seed=FIRST_SEED, reference=reference)
    return {"course": course, "uniform": uniform, "equal time": timed, "saved": 1 - course["spp"] / profile.max_spp}


def measure_seeds(lab, scene, until):
    """Per seed both rules, and uniform sampling with as many samples as `course` took and for as long."""
    profile, size = lab.profile, lab.profile.bias_size
    reference = lab.reference(scene, size, profile.bias_reference)
    runs = {name: [] for name in (*RULES, "uniform", "equal time")}
    for seed in lab.seeds(profile.bias_seeds, until=until):
        def run(name, *options):
            runs[name].append(lab.measure("%s %s" % (name.replace(":", " "), scene), scene, size, *options, seed=seed,
                                          reference=reference))
            return runs[name][-1]
        course, _ = (run(rule, *adaptive_options(profile, rule)) for rule in RULES)
        uniform = run("uniform", *uniform_options(course["spp"]))
        run("equal time", *uniform_options(equal_time_spp(course, uniform)))
    return {name: summarize_bias(found, runs["uniform"]) for name, found in runs.items()}


def summarize_bias(runs, uniform):
    """Bias of the mean against the long render; paired with uniform sampling of the same seed, which shares samples."""
    ratios = [run["meanRatio"] for run in runs]
    pairs = [run["meanRatio"] - other["meanRatio"] for run, other in zip(runs, uniform)]
    return {**summarize(runs), "bias": mean_interval([r - 1 for r in ratios]), "standardError": standard_error(ratios),
            "pairedBias": mean_interval(pairs), "pairedStandardError": standard_error(pairs),
            "errorOverUniform": ratio_of_means([r["relmse"] for r in runs], [r["relmse"] for r in uniform]),
            "secondsPerMillionSamples": mean_interval([1e6 * r["seconds"] / r["samples"] for r in runs])}


def measure(lab):
    profile = lab.profile
    pictures = {scene: measure_pictures(lab, scene) for scene in SCENES}
    count = len(profile.bias_scenes)
    biases = {}
    for i, scene in enumerate(profile.bias_scenes):
        biases[scene] = measure_seeds(lab, scene, until=0.4 + 0.6 * (i + 1) / count)
    return {"names": lab.scenes.names, "size": profile.adaptive_size, "biasSize": profile.bias_size,
            "tolerance": profile.tolerance, "maxSpp": profile.max_spp, "pictures": pictures, "biases": biases}


def show_pictures(results, pictures):
    text = ""
    for scene, shots in results["pictures"].items():
        name = results["names"][scene]
        text += heading(name.capitalize())
        text += gallery([pictures.figure("%s, adaptive" % name, shots["course"]),
                         pictures.rates("%s, samples taken" % name, shots["course"]),
                         pictures.figure("%s, uniform, equal samples" % name, shots["uniform"])])
        text += table(("sampling", "mean spp", "seconds", "seconds a million samples", "relMSE"), [
            (row, number(run["spp"], 4), number(run["seconds"]), number(1e6 * run["seconds"] / run["samples"]), relmse(run))
            for row, run in shots.items() if isinstance(run, dict)],
            "%s: %s of the samples saved against %d everywhere" %
            (name.capitalize(), percent(shots["saved"]), results["maxSpp"]))
    return text


def with_two_errors(value, error):
    return signed_percent(value) if error is None else "%s +- %.2f %%" % (signed_percent(value), 200 * error)


def show_biases(results):
    text = heading("Error and bias over seeds")
    for scene, modes in results["biases"].items():
        rows = [(name, number(m["spp"], 4), bracket(m["secondsPerMillionSamples"]), relmse(m),
                 "" if name == "uniform" else bracket(m["errorOverUniform"]),
                 with_two_errors(m["bias"]["mean"], m["standardError"]),
                 "" if name == "uniform" else with_two_errors(m["pairedBias"]["mean"], m["pairedStandardError"]))
                for name, m in modes.items()]
        count, size = modes["uniform"]["relmse"]["n"], results["biasSize"]
        text += table(("sampling", "mean spp", "seconds a million samples", "relMSE", "over uniform's", "bias +- 2 s.e.",
                       "bias less uniform's, same seed"), rows,
                      "%s, %d x %d, %d seeds" % (results["names"][scene].capitalize(), *size, count))
    return text + paragraph(
        "A pixel stops when its samples happen to look certain, which is more often when they lack a bright one: the mean "
        "comes out low. An earlier experiment elsewhere measured %s. Uniform and adaptive samples of a seed are the same as "
        "far as both go, so the last column has the noise of the rest only." % EARLIER_BIAS)


def show(results, pictures):
    text = paragraph("Batches of %d independent samples; a pixel stops when 1.96 s / sqrt(n) <= %g mean, or at %d samples. "
                     "course:literal also stops where a first batch has no variance; course lets pixels whose samples are all "
                     "equal, the background among them, go on for up to %d. Pictures at %d x %d." %
                     (BATCH, results["tolerance"], results["maxSpp"], min(CONSTANT_SAMPLES, results["maxSpp"]),
                      *results["size"]))
    return text + show_pictures(results, pictures) + show_biases(results)


def headlines(results):
    rows = []
    for scene, shots in results["pictures"].items():
        rows.append(("Adaptive sampling (course, tolerance %g), %s" % (results["tolerance"], results["names"][scene]),
                     "mean %s of %d samples" % (number(shots["course"]["spp"]), results["maxSpp"]),
                     "%s saved; seconds a sample x %s" % (percent(shots["saved"]), number(
                         shots["course"]["seconds"] / shots["course"]["samples"] /
                         (shots["uniform"]["seconds"] / shots["uniform"]["samples"])))))
    for scene, modes in results["biases"].items():
        course = modes["course"]
        rows.append(("its error and bias, %s" % results["names"][scene],
                     "bias %s" % with_two_errors(course["pairedBias"]["mean"], course["pairedStandardError"]),
                     "relMSE x %s of uniform's at equal samples" % bracket(course["errorOverUniform"])))
    return rows
