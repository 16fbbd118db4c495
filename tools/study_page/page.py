"""The whole page: summary, sections, how it was made."""

from .markup import Pictures, escape, paragraph, table
from .sections import SECTIONS

STYLE = """
body { font: 15px/1.45 system-ui, sans-serif; max-width: 75em; margin: 2em auto; padding: 0 1em; color: #222; }
h1, h2, h3 { line-height: 1.2; } h2 { border-top: 2px solid #ccc; padding-top: .6em; margin-top: 2em; }
table { border-collapse: collapse; margin: 1em 0; font-size: 13px; } caption { font-weight: bold; }
th, td { border-bottom: 1px solid #ddd; padding: .25em .7em; text-align: right; }
th[scope=row], caption { text-align: left; }
.gallery { display: flex; flex-wrap: wrap; gap: 1em; } figure { margin: 0 0 1em; } .gallery figure { width: 320px; }
.gallery img { width: 100%; image-rendering: pixelated; } figcaption { font-size: 13px; color: #444; }
.plot svg { max-width: 100%; height: auto; } code { background: #f2f2f2; padding: 0 .2em; }
"""


def collect_headlines(measured):
    """(idea, cost, gain) of every section."""
    return [row for section in SECTIONS for row in section.headlines(measured[section.KEY])]


def to_markdown(rows):
    lines = ["| idea | costs | buys |", "|---|---|---|"]
    return "\n".join(lines + ["| %s |" % " | ".join(cell.replace("|", "/") for cell in row) for row in rows]) + "\n"


def machine_table(about):
    return table(("what", "value"), [(key, value) for key, value in about.items()], "How this page was made")


def budget_table(budgets, taken):
    rows = [(s.TITLE, "%d" % budgets[s.KEY], "%.0f" % taken[s.KEY]) for s in SECTIONS]
    rows.append(("all", "%d" % sum(budgets.values()), "%.0f" % sum(taken.values())))
    return table(("section", "planned seconds", "taken"), rows, "Time")


def build_page(study, folder):
    """HTML from what study.json holds and from the pictures in the folder."""
    pictures, measured = Pictures(folder), study["sections"]
    parts = ['<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">',
             "<title>glim: what each idea costs and buys</title><style>%s</style></head><body>\n" % STYLE,
             "<h1>What each idea of a path tracer costs and what it buys</h1>\n"]
    parts.append(paragraph(
        "Every number that is not said to be the course's or another's was measured in one run, on %s, with %s. relMSE is "
        "the mean of (x - r)^2 / (r^2 + .01 mean(r)^2) against a long render r, whose own noise is subtracted and told where "
        "it exceeds 1 %%. Square brackets hold 95 %% intervals, Student's over seeds, one by one: of twenty such one may well "
        "miss. Those of ratios pair the renders of a seed; what was rendered once has none. Seconds are medians over seeds; "
        "intervals of ratios of seconds hold how this one run scattered, not other machines or days. tools/to_gltf --course "
        "converts the course's .dae files, and tools/study --scenes takes their folder." %
        (study["scenes"]["set"], study["about"]["device"])))
    parts.append('<section id="summary"><h2>Summary</h2>\n' +
                 table(("idea", "costs", "buys"), study["headlines"]) + "</section>\n")
    for section in SECTIONS:
        parts.append('<section id="%s"><h2>%s</h2>\n%s</section>\n' %
                     (section.KEY, escape(section.TITLE), section.show(measured[section.KEY], pictures)))
    parts.append('<section id="about"><h2>About</h2>\n%s%s</section>\n</body></html>\n' % (
        machine_table(study["about"]), budget_table(study["budgets"], study["taken"])))
    return "".join(parts)
