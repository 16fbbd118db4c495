"""Section 3: direct light by uniform directions and by sampling the lights."""

from .. import plots
from ..lab import FIRST_SEED, cost_ratio, summarize
from ..markup import bracket, gallery, heading, number, paragraph, plot, relmse, table

KEY, TITLE = "direct", "3. Direct light"
SCENE = "spheres"
DIRECT = ("--bounces", 1, "--paths", "direct")
METHODS = ("hemisphere", "lights")
RAYS = (1, 4, 16, 64)
PICTURES = ((1, 1), (64, 1), (1, 16), (1, 64))  # light rays, samples per pixel


def combinations(profile):
    """(method, light rays, samples per pixel), each once."""
    spp = sorted({16, 64, *profile.direct_spp})
    return [(method, *pair) for method in METHODS
            for pair in [(rays, 1) for rays in RAYS] + [(1, n) for n in spp if n > 1]]


def measure_samples(lab, reference):
    chosen = combinations(lab.profile)
    runs = {key: [] for key in chosen}
    for seed in lab.seeds(lab.profile.direct_seeds, until=0.7):
        for key in chosen:
            method, rays, spp = key
            runs[key].append(lab.measure(
                "%s %d rays %d spp" % key, SCENE, lab.profile.direct_size, *DIRECT, "--direct", method,
                "--light-samples", rays, "--spp", spp, "--sampler", "independent", seed=seed, reference=reference,
                png=seed == FIRST_SEED and (rays, spp) in PICTURES))
    return [{"method": method, "lightRays": rays, **summarize(runs[method, rays, spp]), "spp": spp}
            for method, rays, spp in chosen]


def measure_time(lab, reference):
    """Rows of equal time, but for the pass under way when it is up: so ratios are of relMSE times the seconds it took."""
    cases = {"hemisphere": ("--direct", "hemisphere", "--sampler", "independent"),
             "lights": ("--direct", "lights", "--sampler", "independent"), "mis": ("--direct", "mis")}
    rows, last = [], len(lab.profile.equal_time) - 1
    for i, seconds in enumerate(lab.profile.equal_time):
        runs = {name: [] for name in cases}
        for seed in lab.seeds(lab.profile.direct_seeds, until=1.0 if i == last else 0.8):
            for name, options in cases.items():
                runs[name].append(lab.measure("%s %g s" % (name, seconds), SCENE, lab.profile.direct_size, *DIRECT, *options,
                                              "--time", seconds, seed=seed, reference=reference,
                                              png=seed == FIRST_SEED and i == last))
        rows.append({"limit": seconds, "runs": {name: summarize(found) for name, found in runs.items()},
                     "hemisphereOverLights": cost_ratio(runs["hemisphere"], runs["lights"]),
                     "lightsOverMis": cost_ratio(runs["lights"], runs["mis"])})
    return rows


def measure(lab):
    reference = lab.reference(SCENE, lab.profile.direct_size, lab.profile.direct_reference, *DIRECT)
    return {"size": lab.profile.direct_size, "scene": lab.scenes.names[SCENE],
            "equalSamples": measure_samples(lab, reference), "equalTime": measure_time(lab, reference)}


def label(row):
    return "%s, %d light ray%s, %d spp" % (row["method"], row["lightRays"], "s" * (row["lightRays"] > 1), row["spp"])


def show_plot(rows):
    panels = []
    for axis, value in (("light rays a pixel", lambda r: r["lightRays"] * r["spp"]), ("seconds", lambda r: r["seconds"])):
        series = []
        for method in METHODS:
            for name, chosen in (("1 ray a hit", [r for r in rows if r["method"] == method and r["lightRays"] == 1]),
                                 ("1 spp", [r for r in rows if r["method"] == method and r["spp"] == 1])):
                series.append(("%s, %s" % (method, name), [(value(r), r["relmse"]) for r in chosen]))
        panels.append((axis, series))
    return plot(plots.plot_errors("direct", panels), "Error against samples and against seconds. Fewer samples a pixel with "
                "more light rays save camera rays, but leave the edges' staircase.")


def show(results, pictures):
    rows, timed = results["equalSamples"], results["equalTime"]
    text = paragraph("%s, direct light alone, %d x %d, %d seeds with independent points; relMSE with 95 %% intervals. "
                     "Hemisphere: uniform directions, pdf 1 / (2 pi); lights: points on the light." %
                     (results["scene"].capitalize(), *results["size"], rows[0]["relmse"]["n"]))
    text += heading("At equal samples") + gallery(pictures.figure(label(row), row) for row in rows if row["picture"])
    text += table(("estimator", "seconds", "Mrays/s", "relMSE"),
                  [(label(row), number(row["seconds"]), number(row["mrays"]), relmse(row)) for row in rows])
    text += show_plot(rows) + heading("At equal time")
    text += paragraph("%s to %s seeds. A render goes on to the end of the pass in which its time is up. The ratios therefore "
                      "are of relMSE times the seconds that each really took, which for independent points is one over the "
                      "efficiency, however long they took." %
                      tuple(f(row["runs"]["lights"]["relmse"]["n"] for row in timed) for f in (min, max)))
    text += gallery(pictures.figure("%s, %g s" % (name, timed[-1]["limit"]), run) for name, run in timed[-1]["runs"].items())
    cells = []
    for row in timed:
        for name, run in row["runs"].items():
            cells.append(("%g s, %s" % (row["limit"], name), number(run["seconds"]), number(run["spp"]), relmse(run)))
        cells.append(("hemisphere / lights, relMSE x seconds", "", "", bracket(row["hemisphereOverLights"])))
        cells.append(("lights / glim's default (mis, Sobol'), relMSE x seconds", "", "", bracket(row["lightsOverMis"])))
    return text + table(("limit and estimator", "seconds", "spp", "relMSE, or the ratio"), cells)


def headlines(results):
    last = results["equalTime"][-1]
    return [("Light sampling instead of hemisphere, about %g s each" % last["limit"], "no time",
             "relMSE x seconds %s times lower" % bracket(last["hemisphereOverLights"])),
            ("MIS and Sobol' points instead of light sampling, about %g s each" % last["limit"],
             "no time", "relMSE x seconds %s times lower" % bracket(last["lightsOverMis"]))]
