#!/usr/bin/env python3
"""figure.py JSON SVG: draws what farm_at_scale.py has found."""

import json
import os
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.realpath(__file__)), *[os.pardir] * 3, "tools"))
from study_page.plots import pyplot  # noqa: E402  its colours

MANY = 2560000


def draw(jobs, output):
    figure, (left, right) = pyplot.subplots(1, 2, figsize=(9.6, 3.8))

    def line(axes, label, value, **wanted):
        chosen = [job for job in jobs if all(job[name] == content for name, content in wanted.items())]
        axes.plot([job["workers"] for job in chosen], [value(job) for job in chosen], label=label, linewidth=1.2, markersize=3)

    def speed(job):
        return job["samplesPerSecond"] / 1e9
    for kind in ("pages", "bands"):
        for network in ("1 Gbit/s", "10 Gbit/s"):
            line(left, "%s, %s" % (kind, network), speed, kind=kind, network=network, samples=MANY)
    workers = sorted({job["workers"] for job in jobs})
    left.plot(workers, [.5 * count for count in workers], label="all workers render", color="#777777", linestyle=":", marker="")
    left.set(xscale="log", yscale="log", xlabel="workers", ylabel="speed, Gsamples/s", title="4K, 2,560,000 samples a pixel")
    for samples in sorted({job["samples"] for job in jobs}):
        line(right, "bands, {:,} samples".format(samples), lambda job: 100 * job["efficiency"], kind="bands", network="10 Gbit/s",
             samples=samples)
    line(right, "pages, {:,} samples".format(MANY), lambda job: 100 * job["efficiency"], kind="pages", network="10 Gbit/s", samples=MANY)
    right.set(xscale="log", ylim=(0, 145), yticks=range(0, 101, 20), xlabel="workers", ylabel="time in which workers render, %", title="4K, 10 Gbit/s")
    for axes in (left, right):
        axes.minorticks_off()
        axes.set_xticks((1, 10, 100, 1000), ("1", "10", "100", "1,000"))
        axes.legend(fontsize=8, loc="upper left")
        axes.title.set_fontsize(10)
    figure.tight_layout()
    figure.savefig(output, format="svg", metadata={"Date": None, "Creator": None})


if __name__ == "__main__":
    with open(sys.argv[1], encoding="utf-8") as file:
        draw(json.load(file)["simulated"]["jobs"], sys.argv[2])
