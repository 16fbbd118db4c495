#!/usr/bin/env python3
"""tools/farm without its accidents, which are those of farm_failures_test.py. It needs Dask from PyPI: where that cannot be had, ctest
lists this test as skipped (exit code 77). The argument is glim's program."""

import asyncio
import base64
import contextlib
import glob
import json
import os
import random
import re
import shutil
import signal
import struct
import subprocess
import time
import unittest
from unittest import mock

from farm_fixture import FARM, GLIM, LONG, ROOT, SCENE, SIZE, FarmCase, main, wait_until
from render_farm.arguments import PAGE, parse_arguments
from render_farm.errors import FarmError
from render_farm.exr_header import read_film_header, read_header
from render_farm.film_error import FilmError, is_rung, next_rung, read_film_error
from render_farm.glim import Glim
from render_farm.ledger import Ledger


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

    def test_worker_that_sends_damage(self):
        ledger = Ledger({0, 1, 2, 3})
        for part in range(3):
            self.lend(ledger, "a"), ledger.receive(part, "a", "a", "x", 1.0)
        self.assertEqual([ledger.spoil(part) for part in range(3)], [("a", False), ("a", False), ("a", True)])
        self.assertEqual((ledger.done, ledger.waiting, ledger.failures.total()), ({}, {0, 1, 2, 3}, 0))
        self.assertEqual(self.lend(ledger, "a"), 3)
        self.assertIsNone(self.lend(ledger, "a"))
        self.assertEqual(self.lend(ledger, "b"), 0)
        self.assertEqual(self.lend(ledger, "a", workers="a"), 1)
        self.assertEqual(Ledger(set(), {0: "x"}).spoil(0), (None, False))

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

    def test_parts_wait_in_order_again(self):
        """As with a set of which the least is taken, over many lendings, returns and failures."""
        chance, ledger, waiting, out = random.Random(1), Ledger(range(50)), set(range(50)), []
        for _ in range(2000):
            if out and chance.random() < .5:
                part = out.pop(chance.randrange(len(out)))
                ledger.give_back(part, "a")
                waiting.add(part)
            elif waiting:
                self.assertEqual(self.lend(ledger, "a"), min(waiting))
                out.append(min(waiting))
                waiting.remove(min(waiting))
            self.assertEqual(ledger.waiting, waiting)
        self.assertLess(len(ledger.order), 200)

    def test_costs_of_many_parts(self):
        """A lending looks at few of the parts: 20,000 of them would take ten seconds otherwise."""
        compared = 0

        class Part(int):
            def __lt__(self, other):
                nonlocal compared
                compared += 1
                return int(self) < int(other)
        ledger = Ledger(map(Part, range(20000)))
        compared = 0
        for _ in range(1000):
            part = self.lend(ledger, "a")
            ledger.receive(part, "a", "a", "x", 1.0)
        self.assertLess(compared, 1000 * 64)
        self.assertEqual((len(ledger.loans), len(ledger.avoided)), (0, 0))


class DriverTest(unittest.TestCase):
    """The driver with a stand-in for Dask's client: 40 workers hand in two films each, all at the same time."""

    WORKERS = 40

    def drive(self, seconds):
        from farm_driver_stand_in import StandInClient, StandInPicture, make_driver, without_dask
        from render_farm.driver import Driver

        class AtOnce(Driver):
            async def take_films(self):
                self.client.finish(len(self.client.addresses))
                await super().take_films()

            async def take(self, *about):
                await super().take(*about)
                self.client.sending -= 1
        client = StandInClient(self.WORKERS)
        picture = StandInPicture(client, 2 * self.WORKERS, seconds=seconds)
        with without_dask():
            asyncio.run(make_driver(AtOnce, picture).run(client))
        return client, picture

    def test_few_films_are_in_memory(self):
        from render_farm.driver import MOST_FILMS
        client, picture = self.drive(0)
        self.assertEqual(picture.kept, set(picture.parts))
        self.assertLessEqual(client.most_sending, MOST_FILMS)

    def test_free_workers_do_not_wait_for_all_films(self):
        """The first 40 films take .8 s to keep; the workers get their second parts before."""
        _, picture = self.drive(.02)
        self.assertGreaterEqual(picture.submitted[self.WORKERS // 2], 2 * self.WORKERS)

    def test_picture_is_published_after_its_last_fold(self):
        from farm_driver_stand_in import StandInClient, StandInPicture, make_driver, without_dask
        from render_farm.driver import TICK_SECONDS, Driver
        test = self

        class Folded(StandInPicture):
            begun = ended = False
            whole = property(lambda self: self.begun)

            def foldable(self):
                return self.parts if len(self.kept) == self.count and not self.begun else range(0)

            def fold(self, _pages):
                self.begun = True
                time.sleep(2 * TICK_SECONDS)
                self.ended = True
                return set(), set()

            def publish(self):
                test.assertTrue(self.ended)
                self.finished = True

        class AtOnce(Driver):
            async def take_films(self):
                self.client.finish(1)
                await super().take_films()
        client = StandInClient(1)
        with without_dask():
            asyncio.run(make_driver(AtOnce, Folded(client, 2)).run(client))

    def test_signal_that_comes_together_with_an_event(self):
        """The cancellation may be lost then (asyncio.wait_for before Python 3.12). The driver ends all the same."""
        from farm_driver_stand_in import StandInClient, StandInPicture, make_driver, without_dask
        from render_farm.driver import Driver, until_signal
        turns = []

        class Deaf(Driver):
            async def take_films(self):
                turns.append(len(turns))
                if turns[-1] == 9:
                    raise FarmError("it did not end")
                if not self.stopped:
                    os.kill(os.getpid(), signal.SIGTERM)
                with contextlib.suppress(asyncio.CancelledError):
                    await super().take_films()
        client = StandInClient(1)
        with without_dask(), mock.patch("render_farm.driver.keep_interrupts_from_children"):
            stopped = asyncio.run(until_signal(lambda stopped: make_driver(Deaf, StandInPicture(client, 2), (), stopped).run(client)))
        self.assertEqual(stopped, signal.SIGTERM)
        self.assertLess(len(turns), 3)


class CommandTest(unittest.TestCase):
    def test_refusals(self):
        good = ["a.glb", "-o", "a.exr", "--spp", "4"]
        for more, words in ((["--time", "1"], "whole pages of samples"), (["--target-rmse", "1"], "as in 1%"),
                            (["--target-relmse", "0"], "a number above 0"), 
                            (["--frames", "1:2", "--target-rmse", "1%", "-o", "a.#.exr"], "one picture"), (["--rows=0:4"], "--bands"),
                            (["--any-device", "--lens-radius", ".1", "--focus", "3,4"], "--focal-distance"),
                            (["--bands", "1001"], "from 1 to 1000"), (["--bands", "4", "--target-rmse", "1%"], "neither --frames nor"),
                            (["--slurm", "gres=gpu:1"], "the time among them"), (["--workers", "0:4"], "--slurm as well"),
                            (["--slurm", "time=1:00", "--workers", "4:2"], "the fewest and the most"),
                            (["--samples=0:4"], "hands out samples itself"), (["--movie", "m.mp4"], "writes films"),
                            (["--denoise"], "two halves"), (["--oidn", "."], "two halves"),
                            (["--seed=1", "--seed", "2"], "given twice"),
                            (["stray"], "expected an option"),
                            (["--resume"], "goes on"), (["--camera", "all"], "one picture"), (["--spp", "0"], "whole number"),
                            (["--frames", "1:2"], "####"), (["--fps", "3"], "--frames"), (["--frames", "2:1"], "A:B"),
                            (["--local", "2", "--scheduler", "tcp://h:1"], "not allowed"), (["--tls-ca", "a"], "together"),
                            (["--png", "a.jpg"], ".png"), (["--exposure", "bright"], "stops from -100"),
                            (["--local", "9999"], "at most 1000"),
                            (["--devices", "0,"], "as in 0,1"), (["--devices", "llvmpipe"], "as in 0,1"),
                            (["--devices", "all", "--local", "2"], "not allowed"),
                            (["--devices", "all", "--device", "1"], "each worker has its own"),
                            (["--insecure"], "always have TLS"), (["--dashboard", "--scheduler", "tls://h:1"], "a dashboard of its own"),
                            (["--slurm", "time=1:00", "-o", "a b.exr"], "cannot name")):
            with self.assertRaises(SystemExit) as caught, mock.patch("sys.stderr") as stderr:
                parse_arguments(good + more)
            self.assertEqual(caught.exception.code, 2, more)
            self.assertIn(words, "".join(call.args[0] for call in stderr.write.call_args_list))
        options = parse_arguments(good + ["--size", "8x8", "--look-from", "-1,2,3", "--confine", "--set=/a/b=1", "--add", "b.glb@1,2,3",
                                           "--set", "/c=d", "--edits", "e.json"])
        self.assertEqual((options.job, options.spp), ({"file": options.scene, "size": "8x8", "look-from": "-1,2,3", "confine": True,
                                                       "set": ["/a/b=1", "/c=d"], "add": ["b.glb@1,2,3"], "edits": "e.json"}, 4))

    def test_no_commands_from_a_network_without_tls(self):
        for value, words in (("tcp://10.0.0.1:8786", "--insecure"), ("tcp://127.0.0.1:8786", "--insecure"),
                             ("tls://10.0.0.1:8786", "--tls-ca"), ("head:8786", "such as tls://"), ("tls://head", "such as tls://"),
                             ("tls://[::1", "such as tls://"), ("tls://head:99999", "such as tls://")):
            done = subprocess.run([FARM, SCENE, "-o", "a.exr", "--spp", "4", "--scheduler", value],
                                  stderr=subprocess.PIPE, text=True, check=False)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(words, done.stderr)


class DevicesTest(FarmCase):
    def choose(self, wanted, *kinds):
        """Which are chosen of devices of these kinds; of those in capitals glim can use nothing."""
        found = [{"kind": kind.lower(), "usable": kind.islower(), "name": kind} for kind in kinds]
        with mock.patch.object(Glim, "run", return_value=json.dumps(found)):
            return [device["index"] for device in Glim("glim", "/").devices(wanted)]

    def test_which_devices(self):
        self.assertEqual(self.choose("all", "software", "discrete", "DISCRETE", "integrated"), [1, 3])
        self.assertEqual(self.choose("all", "software", "DISCRETE", "software"), [0, 2])
        self.assertEqual(self.choose([2, 0, 2], "software", "discrete", "discrete"), [2, 0, 2])
        for wanted, words in (([0, 2], "device 2 is not there"), ([1], "device 1 lacks what glim needs")):
            with self.assertRaisesRegex(FarmError, words) as caught:
                self.choose(wanted, "discrete", "DISCRETE")
            self.assertEqual(caught.exception.code, 3)
        with self.assertRaisesRegex(FarmError, "no device that glim can use"):
            self.choose("all", "DISCRETE")

    OWN_DRIVER = os.environ.get("VK_DRIVER_FILES") or glob.glob("/usr/share/vulkan/icd.d/lvp_icd*.json")[0]
    SECOND_DRIVER = os.environ.get("GLIM_SECOND_DRIVER", "none")  # tools/test --ci

    @staticmethod
    def drivers(*files):
        return dict.fromkeys(("VK_DRIVER_FILES", "VK_ICD_FILENAMES"), ":".join(files))

    def two_devices(self):
        """The driver of the tests twice, which makes two devices of one, as the loader has them."""
        with open(self.OWN_DRIVER, encoding="utf-8") as file:
            driver = json.load(file)
        library = os.path.join(os.path.dirname(self.OWN_DRIVER), driver["ICD"]["library_path"])
        if os.path.exists(library):  # else a name, which the system looks up
            driver["ICD"]["library_path"] = library
        paths = [self.path(name) for name in ("one.json", "two.json")]
        for path in paths:
            with open(path, "w", encoding="utf-8") as file:
                json.dump(driver, file)
        return self.drivers(*paths)

    ON_BOTH = """
            claim(FOLDER, "rendering-on-" + page.job["device"])
            wait_for(FOLDER, "rendering-on-0")
            wait_for(FOLDER, "rendering-on-1")
    """

    def test_each_device_has_a_worker(self):
        """Also after a worker has died."""
        drivers = self.two_devices()
        glim = self.program("""
            if page.job["device"] == "1" and claim(FOLDER, "death"):
                os.kill(page.worker, signal.SIGKILL)
                time.sleep(600)
        """ + self.ON_BOTH)
        said = self.finish(self.start_farm("--devices", "all", glim=glim, **drivers))
        self.assertRegex(said, "a worker on device 0, .*\n.*a worker on device 1, ")
        self.assertEqual(said.count("is gone"), 1, said)
        self.expect_whole()
        self.assertIn("--devices: device 2 is not there", self.finish(self.start_farm("--devices", "2", **drivers), 3))

    @unittest.skipUnless(os.path.exists(SECOND_DRIVER), "no second driver")
    def test_two_drivers_have_the_bits_of_one(self):
        said = self.finish(self.start_farm("--devices", "all", glim=self.program(self.ON_BOTH),
                                           **self.drivers(self.OWN_DRIVER, self.SECOND_DRIVER)))
        self.assertRegex(said, "(?s)a worker on device 0, .*a worker on device 1, ")
        self.assertEqual(said.count("SwiftShader"), 1, said)
        self.assertNotIn("is not used", said)
        self.expect_whole()

    def test_devices_that_differ(self):
        """A third one decides, as of hosts: they are one host, but it does not contradict itself."""
        glim = self.program("""
            if page.job["device"] == "0":
                if not claim(FOLDER, "forged", page.samples):
                    wait_for(FOLDER, "never")
                wait_for(FOLDER, "both")
                return page.forge()
            if owner_of(FOLDER, "forged") == page.samples:
                claim(FOLDER, "both")
                wait_for(FOLDER, "other")
            elif page.number == 7:
                wait_for(FOLDER, "last")
        """)
        farm = self.start_farm("--devices", "0,1,1", glim=glim, **self.two_devices())
        wait_until(lambda: os.path.lexists(self.path("claim-forged")), "the forger has a page")
        forged = int(os.readlink(self.path("claim-forged")).partition(":")[0]) // PAGE
        wait_until(lambda: any("/%05d." % forged in page for page in self.pages()), "the forged page is there")
        self.open("other")
        wait_until(lambda: "a third decides" in farm.stderr.readline(), "two devices differ")
        self.open("last")
        self.assertEqual(self.finish(farm).count("is not trusted any more"), 1)
        self.expect_whole()


class FilesTest(FarmCase):
    def test_bad_scene_leaves_nothing(self):
        with open(self.path("bad.gltf"), "w", encoding="utf-8") as file:
            file.write("{}")
        farm = self.start([FARM, self.path("bad.gltf"), "-o", self.out, "--spp", "4"], GLIM)
        self.assertIn("bad.gltf", self.finish(farm, 1))
        self.assertEqual(os.listdir(self.folder), ["bad.gltf"])

    def test_output_in_a_folder_that_is_not_there(self):
        out = self.path("missing/out.exr")
        said = self.finish(self.start([FARM, SCENE, "-o", out, "--spp", "4", "--size", "8x8"], GLIM), 1)
        self.assertIn("the folder %s does not exist" % self.path("missing"), said)
        self.assertEqual(os.listdir(self.folder), [])

    def test_damaged_job(self):
        """One sentence each, and no folder that is kept is touched."""
        os.makedirs(self.out + ".farm")
        for content in (b'{"job": []}', b"[]", b"{}", b"", b"\xff", b"[" * 100000, b'{"job": {"samples": {}}}'):
            with open(self.out + ".farm/job.json", "wb") as file:
                file.write(content)
            said = self.finish(self.start_farm(spp=4), 1)
            self.assertRegex(said, r"^farm: .*(job.json: is damaged|holds another job).*\n$")

    def test_files_that_could_not_be_written_at_the_end(self):
        for more, words in ((["--png", self.path("missing/a.png")], "the folder %s does not exist" % self.path("missing")),
                            (["--png", self.path("folder.png")], "it is a folder")):
            os.makedirs(self.path("folder.png"), exist_ok=True)
            self.assertIn(words, self.finish(self.start_farm(*more, spp=4), 1))
        self.assertEqual(os.listdir(self.folder), ["folder.png"])

    def test_files_of_other_folders(self):
        with open(SCENE, encoding="utf-8") as file:
            scene = json.load(file)
        scene["buffers"][0]["uri"] = "../secret.bin"
        with open(self.path("spy.gltf"), "w", encoding="utf-8") as file:
            json.dump(scene, file)
        self.assertIn("secret.bin", self.finish(self.start([FARM, self.path("spy.gltf"), "-o", self.out, "--spp", "4"], GLIM), 1))

    def test_headers(self):
        with self.assertRaisesRegex(FarmError, "a.exr: is damaged"):
            read_header(b"no picture", "a.exr")
        film = self.path("a.exr")
        subprocess.run([GLIM, "render", SCENE, "-o", film, "--spp", "1", "--size", "8x4"], check=True, stdout=subprocess.DEVNULL)
        self.assertEqual(read_film_header(film).size, "8x4")
        with open(film, "rb") as file:
            content = file.read()
        with self.assertRaisesRegex(FarmError, "a.exr: is damaged"):
            read_header(content[:500], "a.exr")
        for old, new in ((b"glim:samples\0string\0\x03\0\0\x000:1", b"glim:samples\0string\0\x03\0\0\0x:1"),
                         (b"displayWindow\0box2i\0", b"displayWindow\0string\0"), (b"glim:samples\0string\0", b"glim:samples\0int\0")):
            self.assertEqual(content.count(old), 1, old)
            damaged = self.path("damaged.exr")
            with open(damaged, "wb") as file:
                file.write(content.replace(old, new))
            with self.assertRaisesRegex(FarmError, "damaged"):
                read_film_header(damaged)


class StrangersTest(FarmCase):
    """Another user of this machine gets a refusal at every port, and finds no file that is not the farm's alone."""

    def start_waiting(self, *more):
        os.mkdir(self.path("tmp"))
        farm = self.start_farm("--local", "2", *more, glim=self.program(
            'claim(FOLDER, "worker-%d" % page.worker)\nwait_for(FOLDER, "done")'), TMPDIR=self.path("tmp"))
        wait_until(lambda: sum(name.startswith("claim-worker-") for name in os.listdir(self.folder)) == 2, "both workers render")
        return farm

    def end(self, farm):
        self.open("done")
        said = self.finish(farm)
        self.expect_whole()
        self.assertEqual(os.listdir(self.path("tmp")), [])
        return said

    def test_every_port_refuses(self):
        from farm_strangers import listening, open_to_strangers
        farm = self.start_waiting()
        places, unix = listening(farm.pid)
        self.assertGreaterEqual(len(places), 5, "a scheduler, two workers and two nannies")
        self.assertEqual({place: why for place in places if (why := open_to_strangers(place))}, {})
        self.assertEqual(unix, set())
        for path in (self.out + ".farm", *(os.path.join(self.path("tmp"), name) for name in os.listdir(self.path("tmp")))):
            self.assertEqual(oct(os.stat(path).st_mode & 0o777), "0o700", path)
        self.assertNotIn("dashboard", self.end(farm))

    def test_stop_is_silent(self):
        """Ctrl-C in a terminal, which is sent to all processes, while workers start and while they render; and SIGTERM to all."""
        from farm_strangers import family_of
        os.mkdir(self.path("tmp"))
        glim = self.program('claim(FOLDER, "rendering")\nwait_for(FOLDER, "never")')
        for number, begun in ((signal.SIGINT, lambda pid: len(family_of(pid)) > 2),
                              (signal.SIGINT, lambda pid: os.path.lexists(self.path("claim-rendering"))),
                              (signal.SIGTERM, lambda pid: os.path.lexists(self.path("claim-rendering")))):
            farm = self.start_farm("--local", "2", glim=glim, TMPDIR=self.path("tmp"))
            wait_until(lambda: os.path.exists(self.out + ".farm/job.json") and begun(farm.pid), "the farm is under way")
            os.killpg(farm.pid, number)
            said = self.finish(farm, 128 + number)
            expected = "farm: stopped|farm: worker .* is gone|farm: page .* failed|[0-9]+ of [0-9]+ pages"
            self.assertEqual([line for line in said.splitlines() if not re.match(expected, line)], [])
            self.assertEqual(os.listdir(self.path("tmp")), [])
            if os.path.lexists(self.path("claim-rendering")):
                os.unlink(self.path("claim-rendering"))

    @LONG
    def test_dashboard_is_asked_for(self):
        """It is the one port that answers, and the farm says so."""
        from farm_strangers import listening, open_to_strangers
        farm = self.start_waiting("--dashboard")
        places, _ = listening(farm.pid)
        answers = [place for place in places if open_to_strangers(place)]
        said = self.end(farm)
        self.assertEqual([place[0] for place in answers], ["127.0.0.1"])
        self.assertIn("dashboard asks for no password", said)
        self.assertIn("http://127.0.0.1:%d/" % answers[0][1], said)

    def test_folder_of_someone_else(self):
        """A stranger made the job's folder first, or a link of that name."""
        os.symlink(self.folder, self.out + ".farm")
        self.assertIn("is no folder of a farm", self.finish(self.start_farm(spp=4), 1))
        os.unlink(self.out + ".farm")
        os.mkdir(self.out + ".farm")
        if os.geteuid() == 0:
            os.chown(self.out + ".farm", 65534, 65534)
            self.assertIn("belongs to another user", self.finish(self.start_farm(spp=4), 1))


class TargetTest(FarmCase):
    TARGET = .035

    def error_of(self, spp):
        film = self.path("%d.exr" % spp)
        subprocess.run([GLIM, "render", SCENE, "-o", film, "--samples", "0:%d" % spp, "--size", SIZE, "--stats", self.path("stats.json")],
                       check=True, stdout=subprocess.DEVNULL)
        with open(self.path("stats.json"), encoding="utf-8") as file:
            estimate = json.load(file)["estimate"]
        error = read_film_error(Glim(GLIM, self.folder), film)
        self.assertEqual((error.relmse, error.rmse), (estimate["relmse"], estimate["rmseOfMean"]))
        return error.rmse

    def test_stops_at_the_same_sample(self):
        """With one worker, or with three after a run that was killed. It is the first rung at which the target is reached."""
        target = ["--target-rmse", "%g%%" % (100 * self.TARGET)]
        said = self.finish(self.start_farm(*target, spp=100000))
        self.assertIn("the target is reached", said)
        spp = int(read_film_header(self.out).samples.partition(":")[2])
        self.assertGreater(spp, PAGE)
        self.expect_whole(spp)
        rungs = [pages * PAGE for pages in range(1, spp // PAGE + 1) if is_rung(pages)]
        self.assertEqual([self.error_of(rung) <= self.TARGET for rung in rungs], [False] * (len(rungs) - 1) + [True])
        os.unlink(self.out)
        farm = self.start_farm(*target, glim=self.program('if page.number > 1:\n    wait_for(FOLDER, "never")'), spp=100000)
        wait_until(lambda: os.path.exists(self.out + ".farm/film.exr"), "a page is folded")
        os.kill(farm.pid, signal.SIGKILL)
        farm.wait()
        self.assertIn("its target is", self.finish(self.start_farm("--target-rmse", "9%", spp=100000), 1))
        self.finish(self.start_farm(*target, "--local", "3", spp=100000))
        self.expect_whole(spp)

    @LONG
    def test_spp_is_the_bound(self):
        said = self.finish(self.start_farm("--target-relmse", "1e-9", spp=300))
        self.assertIn("the target is not reached", said)
        self.expect_whole(300)

    def test_black_picture_ends(self):
        """Its error stays unknown, which meets no target."""
        with open(os.path.join(ROOT, "scenes", "light_point.gltf"), encoding="utf-8") as file:
            scene = json.load(file)
        for light in scene["extensions"]["KHR_lights_punctual"]["lights"]:
            light["intensity"] = 0
        with open(self.path("black.gltf"), "w", encoding="utf-8") as file:
            json.dump(scene, file)
        farm = self.start([FARM, self.path("black.gltf"), "-o", self.out, "--spp", "100000", "--size", "8x8", "--target-rmse", "9%",
                           "--environment", "none"], GLIM)
        self.assertIn("the target is not reached, for the error is unknown", self.finish(farm))
        self.assertEqual(read_film_header(self.out).samples, "0:1024")
        self.assertIsNone(read_film_error(Glim(GLIM, self.folder), self.out))

    def test_rungs(self):
        self.assertEqual([pages for pages in range(30) if is_rung(pages)], [*range(1, 12), 13, 15, 17, 19, 21, 24, 27])
        self.assertEqual([next_rung(pages) for pages in (0, 1, 10, 11, 12, 13)], [1, 2, 11, 13, 13, 15])
        error = FilmError(.01, .2)
        self.assertEqual(error.times_to(FilmError(.02, None)), .5)
        self.assertAlmostEqual(error.times_to(FilmError(.02, .1)), 4)


class BandsTest(FarmCase):
    def test_driver_is_killed_and_bands_are_damaged_or_of_other_rows(self):
        glim = self.program("""
            if page.job["rows"] == "9:12":
                wait_for(FOLDER, "never")
        """)
        farm = self.start_farm("--bands", "5", "--local", "2", glim=glim)
        self.wait_for_pages(4)
        os.kill(farm.pid, signal.SIGKILL)
        farm.wait()
        first, _, _, last = self.pages()
        shutil.copy(last, last.replace("/00004.", "/00000."))
        os.unlink(first)
        with open(last, "r+b") as file:
            file.seek(-20, os.SEEK_END)
            file.write(b"damage")
        self.assertIn("its bands is 5, expected 4", self.finish(self.start_farm("--bands", "4"), 1))
        said = self.finish(self.start_farm("--bands", "5"))
        self.assertRegex(said, "00000.*its rows are 12:16, expected 0:3; it is rendered again")
        self.assertRegex(said, "00004.*is damaged; it is rendered again")
        self.expect_whole()

    def test_more_bands_than_rows(self):
        self.assertIn("--bands 17: the picture has 16 rows", self.finish(self.start_farm("--bands", "17"), 1))
        self.assertEqual(os.listdir(self.folder), [])


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
        farm = [FARM, *command, self.path("out.##.exr"), "--png", self.path("out.##.png")]
        self.finish(self.start(farm, GLIM))
        os.replace(self.path("out.01.exr"), self.path("out.02.exr"))  # of another time
        before = os.stat(self.path("out.03.exr")).st_mtime_ns
        self.assertIn("1 of 3 frames are whole", self.finish(self.start(farm, GLIM)))
        self.assertEqual([read_film_header(self.path("out.%02d.exr" % frame)).digest for frame in (1, 2, 3)], expected)
        self.assertEqual(os.stat(self.path("out.03.exr")).st_mtime_ns, before)
        self.assertTrue(os.path.exists(self.path("out.02.png")))
        self.assertFalse(os.path.exists(self.path("out.##.exr.farm")))


if __name__ == "__main__":
    main()
