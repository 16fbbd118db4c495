"""The rows as Markdown tables, one for each driver, or as JSON."""

import json

from mitsuba_check.report import with_interval
from whole_file import write_whole

from .references import name_of

COLUMNS = ("scene", "size", "relMSE x spp: glim", "Mitsuba", "CPU us a sample: glim", "Mitsuba", "wall us a sample: glim", "Mitsuba",
           "samples", "time", "efficiency")

LEGEND = """\
samples: those that Mitsuba needs for the same relMSE, over glim's; time: CPU seconds of a sample, glim's over Mitsuba's; efficiency
1 / (relMSE x CPU seconds): glim's over Mitsuba's.
"""


def with_extremes(entry):
    return "unknown" if entry is None else "%.3g [%.3g, %.3g]" % (entry["median"], entry["least"], entry["most"])


def cells_of(row, several_programs):
    sides, ratios = (row["glim"], row["mitsuba"]), row["ratios"]
    name = "`%s`" % name_of(row["scene"])
    return [name + (", " + row["program"] if several_programs else ""), "%dx%d" % tuple(row["size"]),
            *(with_interval(side["relmse_spp"], "value", "%.3g") for side in sides),
            *(with_extremes(side[key]) for key in ("cpu_us", "wall_us") for side in sides),
            with_interval(ratios["samples"], "value", "%.3g"), with_extremes(ratios["time"]),
            with_interval(ratios["efficiency"], "value", "%.3g")]


def line_of(cells):
    return "| %s |" % " | ".join(cells)


def to_tables(options, rows):
    parts, several = [LEGEND], len({row["program"] for row in rows}) > 1
    for driver in dict.fromkeys(row["driver"] for row in rows):
        of_driver = [row for row in rows if row["driver"] == driver]
        parts.append("## %s\n\n%s, %s: %d renders of %d samples a pixel by each, %d bounces.\n" % (
            driver, of_driver[0]["device"], of_driver[0]["peer"], options.seeds, options.spp, options.bounces))
        parts.append("\n".join([line_of(COLUMNS), "|" + "---|" * len(COLUMNS),
                                *(line_of(cells_of(row, several)) for row in of_driver)]) + "\n")
    return "\n".join(parts)


def write_json(options, rows):
    content = {"spp": options.spp, "seeds": options.seeds, "bounces": options.bounces, "rows": rows}
    write_whole(options.json, (json.dumps(content, indent=2) + "\n").encode())
