#!/usr/bin/env python3
"""Draws what `glim bench` has written: errors against seconds and against samples, a figure for each scene."""

import argparse
import io
import json
import os
import sys

sys.dont_write_bytecode = True  # beside the sources it would look like a change to build
from whole_file import write_whole  # noqa: E402


def text_of(interval):
    if interval["low"] is None or interval["high"] is None:
        return "%.3g" % interval["value"]
    return "%.3g [%.3g, %.3g]" % (interval["value"], interval["low"], interval["high"])


def label_of(name, bench):
    summary = bench["summary"]
    if not summary["slopeTest"]["holds"]:
        return "%s: slope %s, slope test fails" % (name, text_of(summary["slope"]))
    return "%s: slope %s, efficiency %s /s" % (name, text_of(summary["slope"]), text_of(summary["efficiency"]))


def root(value):
    return None if value is None or value < 0 else value ** 0.5


def points_of(bench, axis, error):
    """(x, value, low, high) of the points that logarithmic axes can show."""
    points = []
    for point in bench["points"]:
        summary = point["summary"]
        interval = summary["relMse" if error == "relMSE" else "mse"]
        ends = [interval[key] for key in ("value", "low", "high")]
        value, low, high = ends if error == "relMSE" else map(root, ends)
        x = point["samples"] if axis == "samples" else summary[axis]
        if value and x > 0:
            points.append((x, value, low or value, high or value))
    return points


def draw_bench(axes, name, bench, axis, error):
    points = points_of(bench, axis, error)
    if not points:
        return
    xs, values, lows, highs = zip(*points)
    line = axes.plot(xs, values, label=label_of(name, bench) if (axis, error) == ("samples", "relMSE") else None,
                     linewidth=1.2, markersize=4)[0]
    axes.fill_between(xs, lows, highs, color=line.get_color(), alpha=0.25, linewidth=0)
    if axis == "seconds":
        device = points_of(bench, "kernelSeconds", error)
        axes.plot([x for x, *_ in device], [value for _, value, *_ in device], color=line.get_color(), linestyle=":",
                  marker="", linewidth=1.2)
    floor = bench["reference"]["relMse"] if error == "relMSE" else bench["reference"]["mse"] ** 0.5
    if floor > 0:
        axes.axhline(floor, color=line.get_color(), linestyle="--", linewidth=0.8)


def draw_slope(axes, benches, error):
    """The line that independent samples would follow from the first point on."""
    points = points_of(benches[0], "samples", error)
    if points:
        (x, value, *_), (end, *_) = points[0], points[-1]
        power = -1.0 if error == "relMSE" else -0.5
        axes.plot([x, end], [value, value * (end / x) ** power], color="#888888", marker="", linewidth=0.8, zorder=0)


def import_pyplot():
    # Only now: --help and a refusal need no matplotlib.
    try:
        from study_page.plots import pyplot
    except ImportError:
        sys.exit("tools/plot_bench.py: this python3 cannot import matplotlib; tools/plot_bench finds or installs one that can")
    return pyplot


def draw_scene(pyplot, scene, named):
    """named: (name, bench) of the same scene."""
    figure, grid = pyplot.subplots(2, 2, figsize=(9.6, 7.6), sharex="col", sharey="row")
    for row, error in zip(grid, ("relMSE", "RMSE")):
        for axes, axis in zip(row, ("seconds", "samples")):
            for name, bench in named:
                draw_bench(axes, name, bench, axis, error)
            if axis == "samples":
                draw_slope(axes, [bench for _, bench in named], error)
            axes.set(xscale="log", yscale="log")
        row[0].set_ylabel(error)
    grid[1][0].set_xlabel("seconds a picture (dotted: in kernels)")
    grid[1][1].set_xlabel("samples per pixel (grey: 1 / n)")
    handles, labels = grid[0][1].get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", fontsize=8)
    size = named[0][1]["size"]
    figure.suptitle("%s, %dx%d, on %s\n95 %% bands over %s seeds; the reference's noise (dashed) is subtracted"
                    % (scene, *size, named[0][1]["device"], ", ".join(sorted({str(len(b["seeds"])) for _, b in named}))), fontsize=10)
    figure.tight_layout(rect=(0, 0.02 + 0.025 * len(named), 1, 1))
    return figure


def read(path):
    try:
        with open(path, encoding="utf-8") as file:
            content = json.load(file)
        if content["glim:bench"] != 2:
            raise KeyError
        return content["scenes"]
    except OSError as error:
        sys.exit("tools/plot_bench: %s: %s" % (path, error.strerror))
    except (ValueError, KeyError, TypeError):
        sys.exit("tools/plot_bench: %s: expected a JSON file that `glim bench` wrote" % path)


def parse_arguments():
    parser = argparse.ArgumentParser(prog="tools/plot_bench", description=__doc__, allow_abbrev=False)
    parser.add_argument("benches", nargs="+", metavar="BENCH.json", help="written by glim bench -o; several are lines of one figure")
    parser.add_argument("-o", "--output", metavar="OUT", default="bench.png",
                        help=".png or .svg; with more scenes than one OUT.SCENE.png [bench.png]")
    options = parser.parse_args()
    if os.path.splitext(options.output)[1] not in (".png", ".svg"):
        parser.error("--output %s: expected a name that ends in .png or .svg" % options.output)
    return options


def main():
    options = parse_arguments()
    scenes = {}
    for path in options.benches:
        name = os.path.splitext(os.path.basename(path))[0]
        for bench in read(path):
            stem = os.path.splitext(os.path.basename(bench["scene"]))[0]
            scenes.setdefault((stem, tuple(bench["size"])), []).append((name, bench))
    pyplot = import_pyplot()
    stem, extension = os.path.splitext(options.output)
    for (scene, size), named in scenes.items():
        path = options.output if len(scenes) == 1 else "%s.%s-%dx%d%s" % (stem, scene, *size, extension)
        try:
            figure = io.BytesIO()
            draw_scene(pyplot, scene, named).savefig(figure, format=extension[1:], dpi=120)
            write_whole(path, figure.getvalue())
        except OSError as error:
            sys.exit("tools/plot_bench: %s: %s" % (path, error.strerror))
        print(path)


if __name__ == "__main__":
    main()
