"""Python environments of their own for what PyPI brings, each made once, in a folder of the build."""

import contextlib
import fcntl
import importlib.metadata
import os
import shutil
import subprocess
import sys

from conversion.errors import ConversionError

BUILD = os.path.join(os.path.dirname(os.path.dirname(os.path.dirname(os.path.realpath(__file__)))), "build")


def run(command, sentence):
    result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if result.returncode != 0:
        lines = [line for line in result.stdout.splitlines() if line.strip()] or ["no message"]
        raise ConversionError("%s (%s)" % (sentence, lines[-1].strip()))


class Environment:
    def __init__(self, name, requirements):
        self.name = name
        self.requirements = requirements
        self.folder = os.path.join(BUILD, name)
        self.stamp = os.path.join(self.folder, "requirements")
        self.python = os.path.join(self.folder, "bin", "python")

    def is_made(self):
        if not os.path.exists(self.stamp):
            return False
        with open(self.stamp) as stamp:
            return stamp.read() == "\n".join(self.requirements)

    def make(self, say):
        packages = " and ".join(self.requirements)
        say("installing %s from PyPI into build/%s" % (packages, self.name))
        shutil.rmtree(self.folder, ignore_errors=True)
        run([sys.executable, "-m", "venv", self.folder],
            "cannot make a Python environment in build/%s; expected Python's venv, which Debian calls python3-venv" % self.name)
        run([self.python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", *self.requirements],
            "cannot install %s; expected a connection to PyPI" % packages)
        with open(self.stamp, "w") as stamp:
            stamp.write("\n".join(self.requirements))

    def add(self, requirement, say):
        """Within the environment: installs what few runs need, unless it is there."""
        name, version = requirement.split("==")
        with contextlib.suppress(importlib.metadata.PackageNotFoundError):
            if importlib.metadata.version(name) == version:
                return
        say("installing %s from PyPI into build/%s" % (requirement, self.name))
        run([self.python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", requirement],
            "cannot install %s; expected a connection to PyPI" % requirement)

    def ensure(self, say):
        """Makes it if there is none."""
        os.makedirs(BUILD, exist_ok=True)
        with open(self.folder + ".lock", "w") as lock:  # one makes it, the others wait
            fcntl.flock(lock, fcntl.LOCK_EX)
            if not self.is_made():
                self.make(say)

    def enter(self, say):
        """Returns within the environment: elsewhere it makes one if there is none, and starts the program again in it."""
        if os.path.realpath(sys.prefix) == self.folder:
            return
        self.ensure(say)
        os.execv(self.python, [self.python, *sys.argv])
