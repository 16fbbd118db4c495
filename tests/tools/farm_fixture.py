"""What the tests of tools/farm share: farms, workers, programs in glim's place, and what one render gives."""

import contextlib
import json
import os
import signal
import subprocess
import sys
import tempfile
import textwrap
import time
import unittest

HERE = os.path.dirname(os.path.realpath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(ROOT, "tools"))
from farm_stand_in import claim  # noqa: E402
from conversion.errors import ConversionError  # noqa: E402
from render_farm.environment import ENVIRONMENT  # noqa: E402
from render_farm.exr_header import read_film_header  # noqa: E402

GLIM = os.path.abspath(sys.argv[1])
SCENE = os.path.join(ROOT, "scenes", "cornell.gltf")
FARM = os.path.join(ROOT, "tools", "farm")
NO_HTTP = os.path.join(ROOT, "tools", "render_farm", "no_http.py")
SIZE = "16x16"
SPP = 2000  # 8 pages, of which the last is not a whole one
WAIT_SECONDS = 300  # of a machine that is busy with other things
LONG = unittest.skipUnless(os.environ.get("GLIM_LONG"), "takes longer; GLIM_LONG=1 runs it")

PROGRAM = """#!%(python)s -B
import os, signal, subprocess, sys, time
sys.path.insert(0, %(here)r)
from farm_stand_in import claim, owner_of, stand_in, wait_for
FOLDER = %(folder)r

def mishap(page):
%(mishap)s
    return page.render()

stand_in(%(glim)r, mishap)
"""


def say(text):
    print(text, file=sys.stderr, flush=True)


def main(*more):
    """more: what the test needs from PyPI besides Dask."""
    try:
        ENVIRONMENT.enter(say)
        for requirement in more:
            ENVIRONMENT.add(requirement, say)
    except ConversionError as error:
        say("skipped: %s" % error)
        sys.exit(77)
    unittest.main(module="__main__", argv=[sys.argv[0], *sys.argv[2:]])


def wait_until(condition, what):
    end = time.monotonic() + WAIT_SECONDS
    while not condition():
        if time.monotonic() > end:
            raise AssertionError("waited in vain until " + what)
        time.sleep(0.05)


def digest_of_one_render(spp, *more, cache={}):
    if (spp, more) not in cache:
        with tempfile.TemporaryDirectory() as folder:
            film = os.path.join(folder, "one.exr")
            subprocess.run([GLIM, "render", SCENE, "-o", film, "--samples", "0:%d" % spp, "--size", SIZE, *more],
                           check=True, stdout=subprocess.DEVNULL)
            cache[spp, more] = read_film_header(film).digest
    return cache[spp, more]


class FarmCase(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="glim-farm-test-")
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.out = self.path("out.exr")
        self.processes = []
        self.addCleanup(self.end_processes)

    def end_processes(self):
        for process in self.processes:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)
            process.wait()
            process.stderr.close()

    def path(self, name):
        return os.path.join(self.folder, name)

    def program(self, mishap):
        """A program in glim's place. mishap: what it does when it is to render `page` (farm_stand_in.py), as lines of Python."""
        name = "glim-%d" % len([name for name in os.listdir(self.folder) if name.startswith("glim-")])
        return self.write_program(name, PROGRAM % {"python": os.path.realpath(sys.executable), "here": HERE, "folder": self.folder,
                                                   "glim": GLIM, "mishap": textwrap.indent(textwrap.dedent(mishap), "    ")})

    def write_program(self, name, text):
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(text)
        os.chmod(self.path(name), 0o755)
        return self.path(name)

    def start(self, command, glim, **more):
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                                   cwd=self.folder, env={**os.environ, "GLIM_BINARY": glim, **more}, start_new_session=True)
        self.processes.append(process)
        return process

    def start_farm(self, *more, glim=GLIM, spp=SPP, **environment):
        return self.start([FARM, SCENE, "-o", self.out, "--spp", str(spp), "--size", SIZE, *more], glim, **environment)

    def finish(self, farm, code=0):
        """What a farm says, which ends with this exit code."""
        said = farm.communicate(timeout=WAIT_SECONDS)[1]
        self.assertEqual(farm.returncode, code, said)
        return said

    def pages(self):
        folder = self.out + ".farm/pages"
        return sorted(os.path.join(folder, name) for name in os.listdir(folder) if name.endswith(".exr")) if os.path.exists(folder) else []

    def open(self, gate):
        """Lets programs go on that wait for it."""
        claim(self.folder, gate)

    def wait_for_pages(self, count):
        wait_until(lambda: len(self.pages()) >= count, "%d pages are there" % count)

    def make_certificate(self, name):
        """NAME.pem, an authority of its own, and NAME.key. Returns the options with which the farm takes them."""
        subprocess.run(["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-keyout", self.path(name + ".key"), "-out",
                        self.path(name + ".pem"), "-days", "2", "-subj", "/CN=" + name, "-addext", "subjectAltName=IP:127.0.0.1"],
                       check=True, stderr=subprocess.DEVNULL)
        return ["--tls-ca", self.path(name + ".pem"), "--tls-cert", self.path(name + ".pem"), "--tls-key", self.path(name + ".key")]

    def expect_whole(self, spp=SPP, *more):
        """The bits of one render, of each sample once, and nothing left over."""
        header = read_film_header(self.out)
        self.assertEqual(header.samples, "0:%d" % spp)
        self.assertEqual(header.digest, digest_of_one_render(spp, *more))
        self.assertFalse(os.path.exists(self.out + ".farm"))


class SchedulerCase(FarmCase):
    """With a scheduler and workers of the test's own, as farm.md starts them."""

    def setUp(self):
        super().setUp()
        self.tls = self.make_certificate("ours")
        self.dask = ["--no-dashboard", "--preload", NO_HTTP, "--tls-ca-file", *self.tls[1:]]

    def start_scheduler(self, *more, **environment):
        file = self.path("scheduler.json")
        process = self.start([sys.executable, "-m", "distributed.cli.dask_scheduler", "--protocol", "tls", "--host", "127.0.0.1",
                              "--port", "0", *self.dask, "--scheduler-file", file, *more], GLIM, **environment)
        wait_until(lambda: os.path.exists(file) and os.path.getsize(file), "the scheduler runs")
        with open(file, encoding="utf-8") as content:
            self.address = json.load(content)["address"]
        os.unlink(file)
        return process

    def start_worker(self, glim=GLIM, host="127.0.0.1", *more):
        return self.start([sys.executable, "-m", "distributed.cli.dask_worker", self.address, "--host", host, "--nthreads", "1",
                           "--no-nanny", *self.dask, "--local-directory", self.folder, *more], glim)

    def farm(self, *more, **options):
        return self.start_farm("--scheduler", self.address, *self.tls, *more, **options)
