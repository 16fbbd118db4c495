#!/usr/bin/env python3
"""tools/farm: whatever dies, the film has the digest of one render. It needs Dask from PyPI: where that cannot be had, ctest lists this test
as skipped (exit code 77). The argument is glim's program. GLIM_LONG=1 adds the tests of schedulers, other hosts and slow workers."""

import base64
import contextlib
import json
import os
import signal
import struct
import subprocess
import sys
import tempfile
import time
import unittest
from unittest import mock

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.realpath(__file__))))
sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(ROOT, "tools"))
from conversion.errors import ConversionError  # noqa: E402
from render_farm.arguments import parse_arguments  # noqa: E402
from render_farm.environment import ENVIRONMENT  # noqa: E402
from render_farm.errors import FarmError  # noqa: E402
from render_farm.exr_header import read_film_header, read_header  # noqa: E402
from render_farm.ledger import Ledger  # noqa: E402

GLIM = os.path.abspath(sys.argv[1])
SCENE = os.path.join(ROOT, "scenes", "cornell.gltf")
SPP, PAGES = 2000, 8  # the last page is not a whole one
WAIT_SECONDS = 120
LONG = unittest.skipUnless(os.environ.get("GLIM_LONG"), "takes longer; GLIM_LONG=1 runs it")

# Programs in glim's place. "page" tells pages from the driver's first sample.
SHELL = '#!/bin/sh\ncase "$*" in *"--samples 0:1 "*|merge*|--version) exec %(glim)s "$@";; esac\n%(page)s\nexec %(glim)s "$@"\n'
FORGER = """#!/usr/bin/env python3
import re, subprocess, sys
code = subprocess.run(["%s", *sys.argv[1:]]).returncode
film = sys.argv[sys.argv.index("-o") + 1]
content = open(film, "rb").read()
head, attribute, tail = content.partition(b"glim:%s\\0string\\0")
open(film, "wb").write(head + attribute + tail[:4] + b"0123456789abcdef" + tail[20:])
sys.exit(code)
"""


def say(text):
    print(text, file=sys.stderr, flush=True)


def wait_until(condition, what):
    end = time.monotonic() + WAIT_SECONDS
    while not condition():
        if time.monotonic() > end:
            raise AssertionError("waited in vain until " + what)
        time.sleep(0.05)


class LedgerTest(unittest.TestCase):
    def lend(self, ledger, worker, now=0.0, workers=("a", "b", "c")):
        return ledger.lend(worker, worker, set(workers), now)

    def test_in_order_and_only_once(self):
        ledger = Ledger({2, 0, 1})
        self.assertEqual([self.lend(ledger, worker) for worker in "abc"], [0, 1, 2])
        self.assertEqual(ledger.receive(0, "a", "a", "x", 1.0).kind, "first")
        self.assertEqual(ledger.done, {0: "x"})
        self.assertIsNone(self.lend(ledger, "a", 1.9))

    def test_straggler_goes_to_one_more_worker(self):
        ledger = Ledger({0, 1})
        self.lend(ledger, "a"), self.lend(ledger, "b")
        ledger.receive(1, "b", "b", "x", 1.0)
        self.assertIsNone(self.lend(ledger, "b", 1.9))
        self.assertEqual(self.lend(ledger, "b", 2.0), 0)
        self.assertIsNone(self.lend(ledger, "c", 9.0))
        self.assertEqual(ledger.receive(0, "b", "b", "y", 3.0).kind, "first")
        self.assertEqual(ledger.receive(0, "a", "a", "y", 4.0).kind, "again")
        self.assertEqual((ledger.done, ledger.waiting), ({0: "y", 1: "x"}, set()))

    def test_worker_that_dies(self):
        ledger = Ledger({0})
        for death in range(9):
            self.assertEqual(self.lend(ledger, "a"), 0)
            self.assertEqual(ledger.lose("a"), [], death)
        self.lend(ledger, "a")
        self.assertEqual(ledger.lose("a"), [0])

    def test_failures_go_to_other_workers_first(self):
        ledger = Ledger({0, 1})
        self.assertEqual(self.lend(ledger, "a"), 0)
        self.assertFalse(ledger.fail(0, "a"))
        self.assertEqual(self.lend(ledger, "a"), 1)
        self.assertEqual(self.lend(ledger, "b"), 0)
        self.assertFalse(ledger.fail(0, "b"))
        self.assertIsNone(self.lend(ledger, "b", workers="abc"))
        self.assertEqual(self.lend(ledger, "b", workers="ab"), 0)
        self.assertTrue(ledger.fail(0, "b"))

    def test_third_host_decides(self):
        for first, second, third, loser in (("x", "y", "x", "b"), ("x", "y", "y", "a")):
            ledger = Ledger({0, 1})
            self.lend(ledger, "a"), ledger.receive(0, "a", "a", first, 1.0)
            self.assertEqual(ledger.receive(0, "b", "b", second, 1.0).kind, "disputed")
            self.assertNotIn(0, ledger.done)
            self.assertIsNone(self.lend(ledger, "a"))
            self.assertIsNone(self.lend(ledger, "b"))
            self.assertEqual(self.lend(ledger, "c"), 0)
            receipt = ledger.receive(0, "c", "c", third, 2.0)
            self.assertEqual((receipt.kind, receipt.distrusted), ("settled", {loser}))
            self.assertEqual((ledger.done, ledger.waiting), ({0: third}, {1}))
            self.assertIsNone(self.lend(ledger, loser))
            self.assertEqual(self.lend(ledger, "b" if loser == "a" else "a"), 1)

    def test_what_a_distrusted_host_rendered_waits_again(self):
        ledger = Ledger(set(), {0: "x", 1: "x"})
        ledger.receive(1, "a", "a", "y", 1.0)
        receipt = ledger.receive(1, "b", "b", "y", 1.0)
        self.assertEqual((receipt.distrusted, receipt.dropped), ({"an earlier run"}, {0}))
        self.assertEqual((ledger.done, ledger.waiting), ({1: "y"}, {0}))

    def test_host_that_contradicts_itself(self):
        ledger = Ledger({0})
        self.lend(ledger, "a"), ledger.receive(0, "a", "a", "x", 1.0)
        receipt = ledger.receive(0, "a2", "a", "y", 2.0)
        self.assertEqual((receipt.distrusted, receipt.dropped, ledger.waiting), ({"a"}, {0}, {0}))


class CommandTest(unittest.TestCase):
    def test_refusals(self):
        good = ["a.glb", "-o", "a.exr", "--spp", "4"]
        for more, words in ((["--target-rmse", "1%"], "number of samples that is known"), (["--samples=0:4"], "hands out samples itself"),
                            (["--resume"], "goes on"), (["--camera", "all"], "one picture"), (["--spp", "0"], "whole number"),
                            (["--frames", "1:2"], "####"), (["--fps", "3"], "--frames"), (["--frames", "2:1"], "A:B"),
                            (["--local", "2", "--scheduler", "tcp://h:1"], "not allowed"), (["--tls-ca", "a"], "together"),
                            (["--png", "a.jpg"], ".png")):
            with self.assertRaises(SystemExit) as caught, mock.patch("sys.stderr") as stderr:
                parse_arguments(good + more)
            self.assertEqual(caught.exception.code, 2, more)
            self.assertIn(words, "".join(call.args[0] for call in stderr.write.call_args_list))
        options = parse_arguments(good + ["--size", "8x8", "--look-from", "-1,2,3"])
        self.assertEqual((options.others, options.spp), (["--size", "8x8", "--look-from", "-1,2,3"], 4))

    def test_no_commands_from_a_network_without_tls(self):
        for address, words in (("tcp://10.0.0.1:8786", "--insecure"), ("tls://10.0.0.1:8786", "--tls-ca"), ("head:8786", "tls://")):
            done = subprocess.run([os.path.join(ROOT, "tools", "farm"), SCENE, "-o", "a.exr", "--spp", "4", "--scheduler", address],
                                  stderr=subprocess.PIPE, text=True, check=False)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(words, done.stderr)


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

    def program(self, name, page):
        """A program that does `page` before it renders a page."""
        return self.script(name, SHELL % {"glim": GLIM, "page": page})

    def script(self, name, text):
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(text)
        os.chmod(self.path(name), 0o755)
        return self.path(name)

    def start(self, command, glim):
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                                   cwd=self.folder, env={**os.environ, "GLIM_BINARY": glim}, start_new_session=True)
        self.processes.append(process)
        return process

    def start_farm(self, *more, glim=GLIM, spp=SPP, limit=None):
        command = [os.path.join(ROOT, "tools", "farm"), SCENE, "-o", self.out, "--spp", str(spp), "--size", "32x32", *more]
        return self.start(["prlimit", "--fsize=%d" % limit, *command] if limit else command, glim)

    def finish(self, farm, code=0):
        said = farm.communicate(timeout=WAIT_SECONDS)[1]
        self.assertEqual(farm.returncode, code, said)
        return said

    def pages(self):
        folder = self.out + ".farm/pages"
        return sorted(os.path.join(folder, name) for name in os.listdir(folder) if name.endswith(".exr")) if os.path.exists(folder) else []

    def wait_for_pages(self, count):
        wait_until(lambda: len(self.pages()) >= count, "%d pages are there" % count)

    def expect_whole(self):
        """The bits of one render, of each sample once, and nothing left over."""
        header = read_film_header(self.out)
        self.assertEqual(header.samples, "0:%d" % SPP)
        self.assertEqual(header.digest, digest_of_one_render())
        self.assertFalse(os.path.exists(self.out + ".farm"))


def digest_of_one_render(cache=[]):
    if not cache:
        with tempfile.TemporaryDirectory() as folder:
            film = os.path.join(folder, "one.exr")
            subprocess.run([GLIM, "render", SCENE, "-o", film, "--spp", str(SPP), "--size", "32x32"], check=True, stdout=subprocess.DEVNULL)
            cache.append(read_film_header(film).digest)
    return cache[0]


def change(path, position, content):
    with open(path, "r+b") as file:
        file.seek(position)
        file.write(content)


def spoil_attribute(path, name):
    """Another fingerprint of 16 letters in a film's header."""
    with open(path, "rb") as file:
        change(path, file.read().index(b"glim:%s\0string\0" % name) + len(name) + 17, b"0123456789abcdef")


class LocalTest(FarmCase):
    def workers(self, farm):
        """The processes that render pages, and their children."""
        import psutil
        found = []
        for process in psutil.Process(farm.pid).children(recursive=True):
            with contextlib.suppress(psutil.Error):
                if "sleep" in process.name() and process.parent() is not None:
                    found.append((process.parent().parent(), process.parent()))
        return found

    def test_driver_dies_and_the_folder_is_damaged(self):
        slow = self.program("slow", "sleep .3")
        farm = self.start_farm(glim=slow)
        self.wait_for_pages(4)
        other = self.start_farm(glim=slow)
        self.assertIn("another farm works on it now", self.finish(other, 1))
        os.kill(farm.pid, signal.SIGKILL)
        farm.wait()
        self.assertIn("its samples is %d, expected 512" % SPP, self.finish(self.start_farm(spp=512), 1))
        first, second, third = self.pages()[:3]
        change(first, os.path.getsize(first) - 2000, bytes(4))
        spoil_attribute(second, b"kernels")
        spoil_attribute(third, b"arithmetic")
        with open(self.out + ".farm/pages/00007.exr.partial", "wb") as file:
            file.write(b"half")
        said = self.finish(self.start_farm())
        for words in ("%s: is damaged" % first, "%s: its kernels is 0123456789abcdef" % second, "%s: its device rounds" % third):
            self.assertIn(words, said)
        self.expect_whole()
        said = self.finish(self.start_farm("--png", self.path("out.png")))
        self.assertIn("is whole and was kept", said)
        self.assertTrue(os.path.exists(self.path("out.png")))
        self.expect_whole()

    def test_workers_and_their_children_die(self):
        farm = self.start_farm("--local", "2", glim=self.program("slow", "sleep .5"))
        wait_until(lambda: self.workers(farm), "a worker renders")
        worker, child = self.workers(farm)[0]
        worker.kill()
        wait_until(lambda: not child.is_running() or child.status() == "zombie", "the child of a dead worker dies")
        self.wait_for_pages(2)
        wait_until(lambda: self.workers(farm), "a worker renders")
        self.workers(farm)[0][1].kill()
        said = self.finish(farm)
        self.assertIn("is gone", said)
        self.assertIn("failed on worker", said)
        self.assertIn("glim was killed by signal 9", said)
        self.expect_whole()

    def test_child_fails_and_is_interrupted(self):
        said = self.finish(self.start_farm(glim=self.program("failing", 'echo "glim: no more light." >&2; exit 1')), 1)
        self.assertRegex(said, "farm: page 0 failed too often, at last on worker .*: glim: no more light.\n$")
        farm = self.start_farm(glim=self.program("slow", "sleep .3"))
        self.wait_for_pages(2)
        farm.send_signal(signal.SIGINT)
        self.assertIn("the same command goes on", self.finish(farm, 130))
        self.assertGreaterEqual(len(self.pages()), 2)
        self.finish(self.start_farm())
        self.expect_whole()

    def test_bad_scene_leaves_nothing(self):
        with open(self.path("bad.gltf"), "w", encoding="utf-8") as file:
            file.write("{}")
        farm = self.start([os.path.join(ROOT, "tools", "farm"), self.path("bad.gltf"), "-o", self.out, "--spp", "4"], GLIM)
        self.assertIn("bad.gltf", self.finish(farm, 1))
        self.assertEqual(os.listdir(self.folder), ["bad.gltf"])

    def test_headers(self):
        with self.assertRaisesRegex(FarmError, "a.exr: is damaged"):
            read_header(b"no picture", "a.exr")
        film = self.path("a.exr")
        subprocess.run([GLIM, "render", SCENE, "-o", film, "--spp", "1", "--size", "8x4"], check=True, stdout=subprocess.DEVNULL)
        self.assertEqual(read_film_header(film).size, "8x4")
        with open(film, "rb") as file, self.assertRaisesRegex(FarmError, "a.exr: is damaged"):
            read_header(file.read(500), "a.exr")


class FramesTest(FarmCase):
    def animated(self):
        with open(SCENE, encoding="utf-8") as file:
            scene = json.load(file)
        content = struct.pack("<2f6f", 0, 1, 0, 0, 0, 0, .1, 0)
        buffer, view, accessor = (len(scene[name]) for name in ("buffers", "bufferViews", "accessors"))
        scene["buffers"].append({"byteLength": len(content), "uri": "data:application/octet-stream;base64," +
                                 base64.b64encode(content).decode()})
        scene["bufferViews"] += [{"buffer": buffer, "byteOffset": 0, "byteLength": 8}, {"buffer": buffer, "byteOffset": 8, "byteLength": 24}]
        scene["accessors"] += [{"bufferView": view, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [1]},
                               {"bufferView": view + 1, "componentType": 5126, "count": 2, "type": "VEC3"}]
        node = next(index for index, node in enumerate(scene["nodes"]) if "mesh" in node)
        scene["animations"] = [{"channels": [{"sampler": 0, "target": {"node": node, "path": "translation"}}],
                                "samplers": [{"input": accessor, "output": accessor + 1}]}]
        with open(self.path("moving.gltf"), "w", encoding="utf-8") as file:
            json.dump(scene, file)
        return self.path("moving.gltf")

    def test_frames(self):
        command = [self.animated(), "--frames", "1:3", "--fps", "4", "--size", "16x16", "--spp", "8", "-o"]
        subprocess.run([GLIM, "render", *command, self.path("one.##.exr")], check=True, stdout=subprocess.DEVNULL)
        expected = [read_film_header(self.path("one.%02d.exr" % frame)).digest for frame in (1, 2, 3)]
        farm = [os.path.join(ROOT, "tools", "farm"), *command, self.path("out.##.exr"), "--png", self.path("out.##.png")]
        self.finish(self.start(farm, GLIM))
        os.replace(self.path("out.01.exr"), self.path("out.02.exr"))  # of another time
        before = os.stat(self.path("out.03.exr")).st_mtime_ns
        self.assertIn("1 of 3 frames are whole", self.finish(self.start(farm, GLIM)))
        self.assertEqual([read_film_header(self.path("out.%02d.exr" % frame)).digest for frame in (1, 2, 3)], expected)
        self.assertEqual(os.stat(self.path("out.03.exr")).st_mtime_ns, before)
        self.assertTrue(os.path.exists(self.path("out.02.png")))
        self.assertFalse(os.path.exists(self.path("out.##.exr.farm")))


@LONG
class SchedulerTest(FarmCase):
    def start_scheduler(self, *more):
        file = self.path("scheduler.json")
        process = self.start([sys.executable, "-m", "distributed.cli.dask_scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard",
                              "--scheduler-file", file, *more], GLIM)
        wait_until(lambda: os.path.exists(file) and os.path.getsize(file), "the scheduler runs")
        with open(file, encoding="utf-8") as content:
            self.address = json.load(content)["address"]
        return process

    def start_worker(self, glim=GLIM, host="127.0.0.1", *more):
        return self.start([sys.executable, "-m", "distributed.cli.dask_worker", self.address, "--host", host, "--nthreads", "1",
                           "--no-nanny", "--no-dashboard", "--local-directory", self.folder, *more], glim)

    def farm(self, *more, **options):
        return self.start_farm("--scheduler", self.address, *more, **options)

    def test_scheduler_dies(self):
        scheduler = self.start_scheduler()
        self.start_worker(self.program("slow", "sleep .3"))
        farm = self.farm()
        self.wait_for_pages(3)
        scheduler.kill()
        self.assertIn("the scheduler is gone; the same command goes on", self.finish(farm, 1))
        os.unlink(self.path("scheduler.json"))
        self.start_scheduler()
        farm = self.farm()
        time.sleep(3)  # without a worker
        self.start_worker()
        self.finish(farm)
        self.expect_whole()

    def test_slow_worker(self):
        self.start_scheduler()
        self.start_worker(self.program("slow", "sleep 20"))
        self.start_worker(self.program("fast", "sleep .2"))
        begin = time.monotonic()
        self.finish(self.farm())
        self.assertLess(time.monotonic() - begin, 20)
        self.expect_whole()

    def test_stopped_worker(self):
        self.start_scheduler()
        worker = self.start_worker(self.program("slow", "sleep .5"))
        self.start_worker(self.program("fast", "sleep .2"))
        farm = self.farm()
        self.wait_for_pages(3)
        worker.send_signal(signal.SIGSTOP)
        self.finish(farm)
        self.expect_whole()

    def test_worker_of_another_commit(self):
        self.start_scheduler()
        for attribute in ("kernels", "arithmetic"):
            self.start_worker(self.script("forger-" + attribute, FORGER % (GLIM, attribute)), "127.0.0.2")
        self.start_worker()
        farm = self.farm("--insecure")
        said = self.finish(farm)
        self.assertIn("its kernels is 0123456789abcdef", said)
        self.assertIn("the worker is not used", said)
        self.expect_whole()

    def test_hosts_that_differ(self):
        self.start_scheduler()
        forger = self.script("forger.py", FORGER % (GLIM, "digest"))
        self.start_worker(self.script("forger", '#!/bin/sh\nsleep 2\nexec %s "$@"\n' % forger), "127.0.0.2")
        self.start_worker(self.program("fast", "sleep .1"), "127.0.0.3")
        farm = self.farm()
        wait_until(lambda: "decides" in farm.stderr.readline(), "two hosts differ")
        self.start_worker(GLIM, "127.0.0.4")
        self.assertIn("host 127.0.0.2 is not trusted any more", self.finish(farm))
        self.expect_whole()

    def test_disk_full(self):
        self.start_scheduler()
        self.start_worker()
        said = self.finish(self.farm(limit=40000), 1)  # of one file: more than the first sample's, less than a page's
        self.assertIn("File too large", said)
        self.assertEqual(self.pages(), [])
        self.finish(self.farm())
        self.expect_whole()

    def test_tls(self):
        ca, cert, key = (self.path(name) for name in ("cert.pem", "cert.pem", "key.pem"))
        subprocess.run(["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-keyout", key, "-out", cert, "-days", "2", "-subj",
                        "/CN=farm", "-addext", "subjectAltName=IP:127.0.0.1"], check=True, stderr=subprocess.DEVNULL)
        dask = ["--tls-ca-file", ca, "--tls-cert", cert, "--tls-key", key]
        self.start_scheduler("--protocol", "tls", *dask)
        self.start_worker(GLIM, "127.0.0.1", *dask)
        self.assertTrue(self.address.startswith("tls://"))
        self.finish(self.farm("--tls-ca", ca, "--tls-cert", cert, "--tls-key", key))
        self.expect_whole()
        self.address = self.address.replace("tls://", "tcp://")
        self.assertIn("no scheduler answers", self.finish(self.farm(spp=4), 1))


if __name__ == "__main__":
    try:
        ENVIRONMENT.enter(say)
    except ConversionError as error:
        say("skipped: %s" % error)
        sys.exit(77)
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
