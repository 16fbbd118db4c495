#!/usr/bin/env python3
"""farm_at_scale.py GLIM [--json J] [--svg S] [--from J]: what limits a farm of 1,000 workers. By hand: two minutes on a
machine that does nothing else. It needs Debian's python3-matplotlib.

It measures what the driver's machine does for a page of a 4K picture and the driver's own time, and simulates from these figures 1 to 1,000
GPUs over pages and over bands. tools/farm_at_scale.md has the result. --from simulates and draws from figures that are there already."""

import argparse
import json
import os
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.realpath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(ROOT, "tools"))
from render_farm.environment import ENVIRONMENT  # noqa: E402


def say(text):
    print(text, file=sys.stderr, flush=True)


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("glim", metavar="GLIM")
    parser.add_argument("--json", default="farm_at_scale.json")
    parser.add_argument("--svg", default="farm_at_scale.svg")
    parser.add_argument("--from", dest="figures", metavar="J", help="figures of an earlier call: simulate and draw only")
    return parser.parse_args()


def measure(glim):
    from farm_scale import machine, turns
    with tempfile.TemporaryDirectory(prefix="glim-farm-scale-", dir=os.environ.get("TMPDIR", ".")) as folder:
        return {"turns": turns.measure(say),
                "machine": machine.Machine(glim, os.path.join(ROOT, "scenes", "cornell.gltf"), folder, say).measure()}


def main():
    options = parse_arguments()
    if options.figures:
        with open(options.figures, encoding="utf-8") as file:
            figures = json.load(file)
    else:
        ENVIRONMENT.enter(say)
        figures = measure(os.path.abspath(options.glim))
    from farm_scale import model
    figures["simulated"] = model.simulate(figures)
    with open(options.json, "w", encoding="utf-8") as file:
        json.dump(figures, file, indent=1)
    # The farm's environment has no matplotlib.
    subprocess.run(["/usr/bin/python3", os.path.join(HERE, "farm_scale", "figure.py"), options.json, options.svg], check=True)


if __name__ == "__main__":
    main()
