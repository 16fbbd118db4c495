"""Plots as SVG text that stands inside the page. The colours also differ in lightness (Okabe and Ito 2008)."""

import io
import math
import re

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as pyplot  # noqa: E402  after the choice of the backend

matplotlib.rcParams.update({
    "svg.fonttype": "none", "font.family": "sans-serif", "font.size": 10, "axes.grid": True, "grid.color": "#dddddd",
    "axes.spines.top": False, "axes.spines.right": False, "legend.frameon": False,
    "axes.prop_cycle": matplotlib.cycler(color=["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"],
                                         marker=["o", "s", "^", "D", "v", "P"])})


def to_svg(figure, name, label):
    """Without prologue and metadata; `name` makes the ids differ from those of the page's other plots."""
    text = io.StringIO()
    figure.savefig(text, format="svg", bbox_inches="tight", metadata={"Date": None, "Creator": None, "Title": label})
    pyplot.close(figure)
    svg = text.getvalue()
    svg = re.sub(r"<metadata>.*?</metadata>", "", svg[svg.index("<svg"):], flags=re.DOTALL)
    svg = re.sub(r'\bid="', 'id="%s-' % name, svg)
    svg = re.sub(r'href="#', 'href="#%s-' % name, svg)
    svg = re.sub(r"url\(#", "url(#%s-" % name, svg)
    return svg.replace("<svg ", '<svg role="img" aria-label="%s" ' % label.replace('"', "'"), 1)


def draw_points(axes, label, points):
    """points: (x, interval). Bars end at a tenth and at ten times the mean: those of two seeds would fill the axis."""
    xs = [x for x, _ in points]
    means = [i["mean"] for _, i in points]
    low = [i["mean"] - max(i["low"], i["mean"] / 10) if i["low"] is not None else 0.0 for _, i in points]
    high = [min(i["high"], i["mean"] * 10) - i["mean"] if i["high"] is not None else 0.0 for _, i in points]
    axes.errorbar(xs, means, yerr=(low, high), label=label, capsize=2, linewidth=1.2, markersize=4)


def plot_errors(name, panels):
    """panels: (x label, [(series, [(x, interval of relMSE)])]), side by side, logarithmic both ways."""
    figure, all_axes = pyplot.subplots(1, len(panels), figsize=(4.6 * len(panels), 3.4), squeeze=False)
    for axes, (x_label, series) in zip(all_axes[0], panels):
        for label, points in series:
            draw_points(axes, label, [(x, i) for x, i in points if i["mean"] > 0])
        axes.set(xscale="log", yscale="log", xlabel=x_label, ylabel="relMSE")
        axes.legend(fontsize=8)
    return to_svg(figure, name, "relMSE against " + " and against ".join(x for x, _ in panels))


def draw_growth(axes, series, unit, fits):
    """series: {label: [(triangles, value)]}; a label with a fit also gets its line, which is straight here."""
    for label, points in series.items():
        axes.plot(*zip(*points), label=label, linestyle="none" if label in fits else "-", linewidth=1.2, markersize=4)
        if label in fits:
            fit, ends = fits[label], (points[0][0], points[-1][0])
            axes.plot(ends, [fit["a"] + fit["b"] * math.log2(n) for n in ends], marker="", color=axes.lines[-1].get_color(),
                      label="%.3g %+.3g log2 n" % (fit["a"], fit["b"]))
    axes.set(xscale="log", xlabel="triangles n", ylabel=unit)
    axes.legend(fontsize=8)


def plot_growth(name, panels):
    """panels: (unit, series, fits, whether the value's axis is logarithmic too)."""
    figure, all_axes = pyplot.subplots(1, len(panels), figsize=(4.2 * len(panels), 3.4), squeeze=False)
    for axes, (unit, series, fits, logarithmic) in zip(all_axes[0], panels):
        draw_growth(axes, series, unit, fits)
        if logarithmic:
            axes.set_yscale("log")
        else:
            axes.set_ylim(0, 1.35 * axes.get_ylim()[1])  # room for the legend
    figure.tight_layout()
    return to_svg(figure, name, "; ".join("%s against the number of triangles" % unit for unit, *_ in panels))
