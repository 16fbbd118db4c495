#!/usr/bin/env python3
"""How long an edit takes until its first sample: CPU and wall time of a picture of 64x64 with one sample, by one `glim serve`.

usage: tests/bench/edits.py [--program build/glim] SCENE POINTER=VALUE ...

Each value is asked for ROUNDS times, scaled by another factor each time. A line for the first picture, one for a picture without any
change, and one for each pointer: the medians."""
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time

ROUNDS = 7


def cpu_seconds(process):
    fields = open(f"/proc/{process.pid}/stat").read().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def main(arguments):
    program = "build/glim"
    if arguments[:1] == ["--program"]:
        program, arguments = arguments[1], arguments[2:]
    scene, *edits = arguments
    with tempfile.TemporaryDirectory() as folder:
        serve = subprocess.Popen([program, "serve"], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)

        def measure(name, requests):
            times = []
            for edit in requests:
                before = time.monotonic(), cpu_seconds(serve)
                picture = {"file": scene, "output": os.path.join(folder, "a.exr"), "spp": 1, "size": [64, 64], "set": edit}
                serve.stdin.write(json.dumps({"id": 1, "render": picture}) + "\n")
                serve.stdin.flush()
                answer = json.loads(serve.stdout.readline())
                if answer["code"] != 0:
                    sys.exit(answer["error"])
                times.append((time.monotonic() - before[0], cpu_seconds(serve) - before[1]))
            wall, cpu = (statistics.median(column) for column in zip(*times))
            print("%-60s %6.0f ms of CPU time, %6.0f ms" % (name, 1e3 * cpu, 1e3 * wall))

        measure("first picture", [{}])
        measure("the same again", [{}] * ROUNDS)
        for edit in edits:
            pointer, value = edit.rsplit("=", 1)
            numbers = [float(number) for number in value.split(",")]
            scaled = [[number * (1 - 0.01 * i) for number in numbers] for i in range(ROUNDS + 1)]
            values = scaled if len(numbers) > 1 else [one[0] for one in scaled]
            measure(pointer, [{pointer: value} for value in values][1:])
        serve.stdin.close()
        serve.wait()


if __name__ == "__main__":
    main(sys.argv[1:])
