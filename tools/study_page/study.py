"""The study from beginning to end: measure every section, then write the numbers and the page."""

import datetime
import json
import os
import platform
import shlex
import shutil
import sys
import tempfile

from whole_file import write_whole

from .glim import Glim
from .lab import Lab
from .page import build_page, collect_headlines, to_markdown
from .scenes import Scenes
from .sections import SECTIONS


def processor():
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            names = [line.split(":", 1)[1].strip() for line in file if line.startswith("model name")]
    except OSError:
        names = []
    return "%s, %d threads" % (names[0] if names else platform.machine(), len(os.sched_getaffinity(0)))


def describe(glim, arguments):
    return {"command": shlex.join(["tools/study", *arguments]),
            "date": datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%d %H:%M UTC"),
            "glim": glim.version, "device": glim.device["name"], "driver": glim.device["driver"],
            "kind": glim.device["kind"],
            "processor": processor(), "system": platform.platform()}


def measure_sections(lab):
    measured = {}
    for section in SECTIONS:
        lab.begin(section.KEY)
        measured[section.KEY] = section.measure(lab)
        lab.finish()
    return measured


def run_study(options, arguments):
    """Returns the headline table. The page and the numbers appear whole, at the end."""
    os.makedirs(options.out, exist_ok=True)
    glim = Glim()
    about = describe(glim, arguments)
    scratch = tempfile.mkdtemp(prefix=".scratch-", dir=options.out)
    try:
        scenes = Scenes(options.scenes, os.path.join(options.out, "scenes"))
        lab = Lab(glim, scenes, options.profile, options.out, scratch)
        measured = measure_sections(lab)
    finally:
        shutil.rmtree(scratch, ignore_errors=True)
    headlines = collect_headlines(measured)
    study = {"about": about, "profile": options.profile.name,
             "scenes": {"set": "the course's own scenes" if scenes.is_course else "scenes of ours of the same make",
                        "files": scenes.files()},
             "budgets": options.profile.budgets, "taken": lab.finished, "headlines": headlines,
             "markdown": to_markdown(headlines), "sections": measured}
    text = json.dumps(study, indent=1, allow_nan=False) + "\n"
    # Through JSON, so that the page shows only what the file holds.
    page = build_page(json.loads(text), options.out)
    write_whole(os.path.join(options.out, "study.json"), text.encode())
    write_whole(os.path.join(options.out, "index.html"), page.encode())
    lab.close()
    return study["markdown"]
