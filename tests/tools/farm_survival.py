#!/usr/bin/env python3
"""farm_survival.py GLIM [MINUTES]: a long render that is killed again and again. By hand: two hours by default, and as long again for the
render without an interruption, beside it.

A farm of two workers renders a picture, while a random one of its processes is killed about every three minutes: a worker, its glim, or, each
third time until it were ten, the driver itself, which the same command then starts again. At the end the film must have the SHA-256 of one `glim render`
that nobody has disturbed. tests/README.md has the last result."""

import json
import os
import random
import signal
import subprocess
import sys
import tempfile
import time

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.realpath(__file__))))
DRIVER_KILLS = 10
PAGE = 256
PICTURE = [os.path.join(ROOT, "scenes", "cornell_gems.gltf"), "--size", "96x96"]


def family_of(pid):
    """Its descendants."""
    found = []
    for task in os.listdir("/proc/%d/task" % pid):
        with open("/proc/%d/task/%s/children" % (pid, task), encoding="ascii") as children:
            for child in map(int, children.read().split()):
                found += [child, *family_of(child)]
    return found


def digest(glim, film):
    with tempfile.TemporaryDirectory() as folder:
        copy = os.path.join(folder, "copy.exr")  # whose digest is of its own samples
        subprocess.run([glim, "merge", film, "-o", copy], check=True, stderr=subprocess.DEVNULL)
        with open(copy, "rb") as file:
            header = file.read(65536)
    at = header.index(b"glim:digest\0string\0") + len(b"glim:digest\0string\0") + 4
    return header[at:at + 64].decode()


def measure_rate(glim, folder):
    """Pages per minute of one render."""
    begin = time.monotonic()
    subprocess.run([glim, "render", *PICTURE, "--samples", "0:%d" % (4 * PAGE), "-o", os.path.join(folder, "rate.exr"), "--progress", "none"],
                   check=True, stdout=subprocess.DEVNULL)
    return 4 * 60 / (time.monotonic() - begin)


def main():
    glim, minutes = sys.argv[1], float(sys.argv[2]) if len(sys.argv) > 2 else 120.0
    chance = random.Random(1)
    kills = {"driver": 0, "others": 0}
    with tempfile.TemporaryDirectory(prefix="glim-survival-") as folder:
        # Both share the cores, so each gets half of the rate.
        samples = max(1, round(minutes * measure_rate(glim, folder) / 2)) * PAGE
        film = os.path.join(folder, "farm.exr")
        alone = subprocess.Popen([glim, "render", *PICTURE, "--spp", str(samples), "-o", os.path.join(folder, "alone.exr"), "--progress", "none"],
                                 stdout=subprocess.DEVNULL)
        begin, code, starts = time.monotonic(), None, 0
        interval = minutes * 60 / 40
        while code != 0:
            said = open(os.path.join(folder, "said"), "w+", encoding="utf-8")
            driver = subprocess.Popen([os.path.join(ROOT, "tools", "farm"), *PICTURE, "--spp", str(samples), "--local", "2", "-o", film],
                                      stdout=subprocess.DEVNULL, stderr=said, env={**os.environ, "GLIM_BINARY": glim})
            starts += 1
            while driver.poll() is None:
                try:
                    driver.wait(chance.uniform(0.5, 1.5) * interval)
                except subprocess.TimeoutExpired:
                    if kills["driver"] < DRIVER_KILLS and sum(kills.values()) % 3 == 2:
                        driver.kill()
                        kills["driver"] += 1
                    elif others := family_of(driver.pid):
                        os.kill(chance.choice(others), signal.SIGKILL)
                        kills["others"] += 1
            code = driver.wait()
            said.seek(0)
            words = said.read()
            # A farm whose own glim is killed, the one that folds, or a worker that starts, ends with a sentence.
            if code not in (0, -signal.SIGKILL) and not any(why in words for why in ("glim was killed by signal 9", "did not start")):
                sys.exit("farm_survival.py: the farm ended with exit code %d:\n%s" % (code, words))
        took = time.monotonic() - begin
        if alone.wait() != 0:
            sys.exit("farm_survival.py: the render ended with exit code %d" % alone.returncode)
        digests = digest(glim, film), digest(glim, os.path.join(folder, "alone.exr"))
        print(json.dumps({"samplesPerPixel": samples, "minutes": round(took / 60, 1), "starts": starts, "kills": kills, "digests": digests,
                          "same": digests[0] == digests[1], "leftOver": sorted(os.listdir(folder))}, indent=1))
        sys.exit(0 if digests[0] == digests[1] else 1)


if __name__ == "__main__":
    main()
