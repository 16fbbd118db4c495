"""A Python environment of its own for what PyPI brings, made once, in the folder of the build."""

import fcntl
import os
import shutil
import subprocess
import sys

from conversion.errors import ConversionError

REQUIREMENTS = ["trimesh==5.2.0", "numpy"]
FOLDER = os.path.join(os.path.dirname(os.path.dirname(os.path.dirname(os.path.realpath(__file__)))), "build", "to_gltf")
STAMP = os.path.join(FOLDER, "requirements")
PYTHON = os.path.join(FOLDER, "bin", "python")


def is_made():
    if not os.path.exists(STAMP):
        return False
    with open(STAMP) as stamp:
        return stamp.read() == "\n".join(REQUIREMENTS)


def run(command, sentence):
    result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if result.returncode != 0:
        lines = [line for line in result.stdout.splitlines() if line.strip()] or ["no message"]
        raise ConversionError("%s (%s)" % (sentence, lines[-1].strip()))


def make(say):
    say("installing %s from PyPI into build/to_gltf" % " and ".join(REQUIREMENTS))
    shutil.rmtree(FOLDER, ignore_errors=True)
    run([sys.executable, "-m", "venv", FOLDER],
        "cannot make a Python environment in build/to_gltf; expected Python's venv, which Debian calls python3-venv")
    run([PYTHON, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", *REQUIREMENTS],
        "cannot install %s; expected a connection to PyPI" % " and ".join(REQUIREMENTS))
    with open(STAMP, "w") as stamp:
        stamp.write("\n".join(REQUIREMENTS))


def enter_environment(say):
    """Returns within the environment: elsewhere it makes one if there is none, and starts the program again in it."""
    if os.path.realpath(sys.prefix) == FOLDER:
        return
    os.makedirs(os.path.dirname(FOLDER), exist_ok=True)
    with open(FOLDER + ".lock", "w") as lock:  # one makes it, the others wait
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not is_made():
            make(say)
    os.execv(PYTHON, [PYTHON, *sys.argv])
