"""The comparison as a table or as JSON."""

import json
import statistics

from .figures import compare_renders

# Mitsuba moves rays off surfaces by (1 + largest coordinate) * 8.9e-5 (its interaction.h and math.h, 3.9): below unit size
# that is no small part of the scene.
LEAST_RADIUS = 0.5
FARTHEST = 10.0


def warn_of_size(center, radius):
    if radius < LEAST_RADIUS or max(abs(center)) > FARTHEST * max(radius, LEAST_RADIUS):
        return ("the scene has a radius of %.3g m and lies %.3g m from the origin, but Mitsuba moves rays off surfaces by 1e-4 m "
                "and more: scale it to about one metre before believing a difference" % (radius, max(abs(center))))
    return None


def collect(options, glim, mitsuba, renders):
    pairs = {"glim": renders[0], "mitsuba": renders[1]}
    found = compare_renders(*renders[0].arrays(), *renders[1].arrays(), options.spp)
    return {"scene": options.scene, "size": list(options.size), "spp": options.spp, "seeds": options.seeds,
            "bounces": options.bounces, "glim": glim.device, "mitsuba": mitsuba.name,
            "seconds": {name: {"render": {"median": statistics.median(r.seconds), "least": min(r.seconds),
                                          "most": max(r.seconds)}, "start": statistics.median(r.start)}
                        for name, r in pairs.items()}, **found}


def row(label, text):
    return "%-24s%s" % (label, text)


def with_interval(entry, key, form):
    if entry[key] is None:
        return "unknown"
    reach = "" if entry["low"] is None else (" [" + form + ", " + form + "]") % (entry["low"], entry["high"])
    return form % entry[key] + reach


def to_table(found):
    test, ratio = found["z_test"], found["ratio"]
    lines = ["%s at %dx%d: %d renders of %d samples a pixel, %d bounces" % (
        found["scene"], *found["size"], found["seeds"], found["spp"], found["bounces"]),
        "glim on %s against %s" % (found["glim"], found["mitsuba"])]
    for name in ("all", "R", "G", "B"):
        lines.append(row("mean ratio" if name == "all" else "mean ratio " + name, with_interval(ratio[name], "value", "%.5f")))
    lines.append(row("z of means", "%.2f %.2f %.2f   limit %.2f; would see a bias of %.2g %%" % (
        *test["mean_z"], test["mean_limit"], 100 * test["detectable_bias"])))
    worst = test["worst_block"]
    lines.append(row("z of 8x8 blocks", "largest %.2f at (%d, %d) in %s   limit %.2f" % (
        worst["z"], worst["x"], worst["y"], worst["channel"], test["block_limit"])))
    lines.append(row("mean z^2 of blocks", "%.2f   expected 1, at most %.2f" % (
        test["mean_square"], 1 + test["mean_square_margin"])))
    lines.append(row("verdict", "agree up to noise" if test["agree"] else "differ by more than noise"))
    for name in ("glim", "mitsuba"):
        seconds = found["seconds"][name]
        lines.append(row(name, "relMSE %s, %.3g s (%.3g to %.3g) a render, %.3g s to start" % (
            with_interval(found["relmse"][name], "mean", "%.3g"), seconds["render"]["median"], seconds["render"]["least"],
            seconds["render"]["most"], seconds["start"])))
    lines.append(row("time to equal error", "Mitsuba's over glim's: " +
                     with_interval(found["time_to_equal_error"], "value", "%.3g")))
    return "\n".join(lines)


def to_json(found):
    return json.dumps(found, indent=2)
