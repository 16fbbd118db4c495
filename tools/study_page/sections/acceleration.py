"""Section 2: what a bounding volume hierarchy buys, and how it is split."""

import math

from .. import plots
from ..estimates import fit_line, fit_logarithm, spread, spread_of_ratio
from ..markup import gallery, heading, number, paragraph, plot, table, timing

KEY, TITLE = "acceleration", "2. The bounding volume hierarchy"
MESHES, RULES = ("cow", "beast"), ("sah", "mean", "median")
COURSE_PIXELS = 800 * 600
COURSE_SECONDS = {"cow": (22.0, 0.05), "beast": (335.0, 0.05)}
CAMERA_RAYS = ("--view", "normal", "--spp", 1)


def render_often(lab, name, scene, size, *options, times=None, png=False, keep=True):
    """`png` and `keep` are about the first picture; no other is kept."""
    times = times or lab.profile.timings
    return [lab.render("%s %s %d of %d" % (scene, name, i + 1, times), scene, size, *CAMERA_RAYS, *options, png=png and i == 0,
                       keep=keep and i == 0) for i in range(times)]


def summarize_times(shots):
    """Seconds of the whole render; nanoseconds a ray of it and of the kernel that finds the nearest surface."""
    first = shots[0]
    return {"size": first.stats["size"], "seconds": spread([s.seconds for s in shots]),
            "nanosecondsPerRay": spread([1e9 * s.seconds / s.pixels for s in shots]),
            "traceNanosecondsPerRay": spread([1e9 * s.trace_seconds / s.pixels for s in shots]),
            "buildSeconds": spread([s.build_seconds for s in shots]), "bvh": first.stats["bvh"]}


def count_steps(lab, scene, size, rule):
    """Apart, so that counting is in no time."""
    return lab.render("%s %s visits" % (scene, rule), scene, size, "--view", "bvh-steps", "--spp", 1, "--split",
                      rule, keep=False).stats["steps"]


def is_same(lab, shots):
    """Whether pictures are the same bits."""
    return all(lab.glim.compare(shot.exr, shots[0].exr)["relation"] == "identical" for shot in shots[1:])


def measure_mesh(lab, scene):
    profile = lab.profile
    size, small = profile.bvh_size, profile.brute_sizes[scene]
    shots = {rule: render_often(lab, rule, scene, size, "--split", rule, png=rule == "sah") for rule in RULES}
    without = render_often(lab, "without", scene, small, "--accelerator", "none", times=3)
    as_small = lab.render("%s small" % scene, scene, small, *CAMERA_RAYS)
    return {"triangles": lab.triangles(scene),
            "rules": {rule: {**summarize_times(found), "steps": count_steps(lab, scene, size, rule)}
                      for rule, found in shots.items()},
            "none": summarize_times(without),
            "sameBits": is_same(lab, [found[0] for found in shots.values()]) and is_same(lab, [without[0], as_small]),
            "picture": lab.judge(shots["sah"][0], lab.reference(scene, size, 64, "--view", "normal"))}


def measure_growth(lab):
    """Without a BVH only a few triangles, and once: such a time is long and grows as it must."""
    profile, points = lab.profile, {rule: [] for rule in (*lab.profile.growth_rules, "none")}
    for triangles in profile.growth:
        scene = lab.scenes.blob(triangles)
        count = {"triangles": lab.triangles(scene)}
        for rule in profile.growth_rules:
            times = summarize_times(render_often(lab, rule, scene, profile.bvh_size, "--split", rule, keep=False))
            points[rule].append({**count, **times, "steps": count_steps(lab, scene, profile.bvh_size, rule)})
        if triangles <= profile.brute_growth:
            shots = render_often(lab, "without", scene, profile.brute_sizes["beast"], "--accelerator", "none", times=1,
                                 keep=False)
            points["none"].append({**count, **summarize_times(shots)})
    return points


def ray_time(entry):
    return entry["nanosecondsPerRay"]["median"]


def trace_time(entry):
    return entry["traceNanosecondsPerRay"]["median"]


def fit(points):
    counts = [p["triangles"] for p in points]
    return {"nanoseconds": fit_logarithm(counts, [trace_time(p) for p in points]),
            "visits": fit_logarithm(counts, [p["steps"]["nodesPerRay"] for p in points])}


def exponent(points):
    """Of n, by least squares of logarithms; None of one point."""
    if len(points) < 2:
        return None
    return fit_line([math.log(p["triangles"]) for p in points], [math.log(trace_time(p)) for p in points])[1]


def measure(lab):
    meshes = {scene: measure_mesh(lab, scene) for scene in MESHES}
    for mesh in meshes.values():
        none, sah, mean = mesh["none"], mesh["rules"]["sah"], mesh["rules"]["mean"]
        mesh["speedup"] = {"render": spread_of_ratio(none["nanosecondsPerRay"], sah["nanosecondsPerRay"]),
                           "tracing": spread_of_ratio(none["traceNanosecondsPerRay"], sah["traceNanosecondsPerRay"])}
        mesh["buildOverMean"] = spread_of_ratio(sah["buildSeconds"], mean["buildSeconds"])
    growth = measure_growth(lab)
    return {"names": lab.scenes.names, "meshes": meshes, "growth": growth,
            "fits": {rule: fit(points) for rule, points in growth.items() if rule != "none"},
            "exponentWithout": exponent(growth["none"])}


def speedup_row(name, scene, mesh):
    none, bvh = mesh["none"], mesh["rules"]["sah"]
    brute, quick = COURSE_SECONDS[scene]
    whole = [1e-9 * COURSE_PIXELS * ray_time(entry) for entry in (none, bvh)]
    return ("%s, %s triangles" % (name, number(mesh["triangles"], 5)), "%d x %d" % tuple(none["size"]),
            timing(none["seconds"]), "%d x %d" % tuple(bvh["size"]), timing(bvh["seconds"]),
            timing(mesh["speedup"]["render"]), timing(mesh["speedup"]["tracing"]), "%s to %s" % tuple(map(number, whole)),
            "%g s to %g s: about %s" % (brute, quick, number(brute / quick)), "yes" if mesh["sameBits"] else "NO")


def rule_row(rule, entry, best):
    steps = entry["steps"]
    return (rule, timing(entry["seconds"]), timing(entry["traceNanosecondsPerRay"]), timing(entry["buildSeconds"]),
            number(steps["nodesPerRay"], 4), number(steps["primitivesPerRay"], 4), number(steps["mostNodes"], 4),
            number(entry["bvh"]["depth"]), number(trace_time(entry) / best))


def line_text(fitted):
    return "%s %s %s log2 n" % (number(fitted["a"]), "-" if fitted["b"] < 0 else "+", number(abs(fitted["b"])))


def show_growth(results):
    growth, fits = results["growth"], results["fits"]
    rules = [rule for rule in growth if rule != "none"]
    times = {rule: [(p["triangles"], trace_time(p)) for p in growth[rule]] for rule in rules}
    visits = {rule: [(p["triangles"], p["steps"]["nodesPerRay"]) for p in growth[rule]] for rule in rules}
    both = {**times, "no BVH": [(p["triangles"], trace_time(p)) for p in growth["none"]]}
    svg = plots.plot_growth("growth", [
        ("nanoseconds a ray of tracing", times, {rule: fits[rule]["nanoseconds"] for rule in rules}, False),
        ("node visits a ray", visits, {rule: fits[rule]["visits"] for rule in rules}, False),
        ("nanoseconds a ray of tracing", both, {}, True)])
    rows = [(rule, line_text(f["nanoseconds"]),
             number(f["nanoseconds"]["r2"]), line_text(f["visits"]),
             number(f["visits"]["r2"])) for rule, f in fits.items()]
    return (plot(svg, "Bumpy globes of n triangles from one camera, tracing alone. On a logarithmic axis a logarithm "
                 "is straight. Without a BVH, each rendered once, the time grows as n to the power %s up to %s triangles." %
                 (number(results["exponentWithout"]), number(growth["none"][-1]["triangles"]))) +
            table(("split", "nanoseconds a ray of tracing", "R2", "visits a ray", "R2"), rows, "Least squares of a + b log2 n"))


def show(results, pictures):
    names, meshes = results["names"], results["meshes"]
    text = paragraph("One camera ray a pixel, one chain of dispatches, median of at least three runs (least to most). "
                     "Without a BVH a smaller picture where the course's 800 x 600 would take too long; ratios are of the time "
                     "a ray, of the whole render and of tracing alone: the rest is the same with and without. The course's "
                     "figures, rounded as its write-up has them, are of another program on another machine.")
    text += gallery(pictures.figure(names[scene], mesh["picture"]) for scene, mesh in meshes.items())
    text += table(("mesh", "without: size", "seconds", "with: size", "seconds", "ratio", "of tracing alone",
                   "as many seconds a ray at 800 x 600", "course, with its own mesh", "same bits"),
                  [speedup_row(names[scene], scene, mesh) for scene, mesh in meshes.items()], "With and without a BVH")
    for scene, mesh in meshes.items():
        best = trace_time(mesh["rules"]["sah"])
        text += table(("split", "seconds", "nanoseconds a ray of tracing", "build seconds", "node visits a ray",
                       "primitives a ray", "most visits", "depth", "tracing / sah's"),
                      [rule_row(rule, entry, best) for rule, entry in mesh["rules"].items()],
                      "Split rules, %s" % names[scene])
    return text + heading("Growth with the number of triangles") + show_growth(results)


def headlines(results):
    rows = []
    for scene, mesh in results["meshes"].items():
        sah, mean = mesh["rules"]["sah"], mesh["rules"]["mean"]
        rows.append(("BVH, %s (%s triangles)" % (results["names"][scene], number(mesh["triangles"], 5)),
                     "%s s to build" % number(sah["buildSeconds"]["median"]),
                     "render %s times as fast, tracing %s times (course: about %s)" % (
                         timing(mesh["speedup"]["render"]), timing(mesh["speedup"]["tracing"]),
                         number(COURSE_SECONDS[scene][0] / COURSE_SECONDS[scene][1]))))
    rows.append(("SAH against the course's split, %s" % results["names"]["beast"],
                 "%s times the build" % timing(mesh["buildOverMean"]),
                 "%s times the visits" % number(sah["steps"]["nodesPerRay"] / mean["steps"]["nodesPerRay"])))
    visits = results["fits"]["sah"]["visits"]
    rows.append(("Visits a ray, 10^2 to 10^6 triangles", "", "%s (R2 %s)" % (line_text(visits), number(visits["r2"]))))
    return rows
