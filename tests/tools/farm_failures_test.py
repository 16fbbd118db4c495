#!/usr/bin/env python3
"""tools/farm with accidents: whatever dies, lies or stops, the film has the digest of one render. It needs Dask from PyPI: where that cannot
be had, ctest lists this test as skipped (exit code 77). The argument is glim's program. GLIM_LONG=1 adds the tests with schedulers and other
hosts."""

import os
import resource
import signal
import subprocess
import time

from farm_fixture import GLIM, LONG, SCENE, SIZE, SPP, WAIT_SECONDS, FarmCase, SchedulerCase, main, wait_until
from render_farm.exr_header import read_film_header

SLOW = "time.sleep(.3)"


def change(path, position, content):
    with open(path, "r+b") as file:
        file.seek(position)
        file.write(content)


def flip_bit(path):
    """Of the film's samples."""
    with open(path, "rb") as file:
        position = os.path.getsize(path) - 2000
        change(path, position, bytes([file.read()[position] ^ 1]))


def spoil_attribute(path, name):
    """Another fingerprint of 16 letters in a film's header."""
    with open(path, "rb") as file:
        change(path, file.read().index(b"glim:%s\0string\0" % name) + len(name) + 17, b"0123456789abcdef")


class LocalTest(FarmCase):
    def test_workers_and_a_child_die(self):
        """As it loads, as it renders, as it sends; and a child alone."""
        mishap = """
            if claim(FOLDER, "load", os.getpid()):
                os.kill(page.worker, signal.SIGKILL)
                time.sleep(600)
            if claim(FOLDER, "render"):
                page.start()
                time.sleep(.2)
                os.kill(page.worker, signal.SIGKILL)
                time.sleep(600)
            if claim(FOLDER, "send"):
                subprocess.Popen(["sh", "-c", "sleep .05; kill -9 %d" % page.worker], start_new_session=True)
                return page.render()
            if claim(FOLDER, "child"):
                os.kill(os.getpid(), signal.SIGKILL)"""
        said = self.finish(self.start_farm("--local", "2", glim=self.program(mishap)))
        self.assertEqual(said.count("is gone"), 3, said)
        self.assertEqual(said.count("failed on worker"), 1, said)
        self.assertIn("glim was killed by signal 9", said)
        child = int(os.readlink(self.path("claim-load")))
        self.assertFalse(os.path.exists("/proc/%d" % child), "the child of a dead worker lives")
        self.expect_whole()

    def test_workers_that_learn_a_guide_die(self):
        """Each worker learns the guide that one render learns: one dies with it, and another learns it again."""
        guiding, spp = ("--guiding", "on"), 4 * 256
        mishap = """
            if claim(FOLDER, "first"):
                page.start()
                time.sleep(.2)
                os.kill(page.worker, signal.SIGKILL)
                time.sleep(600)"""
        said = self.finish(self.start_farm("--local", "2", *guiding, glim=self.program(mishap), spp=spp))
        self.assertEqual(said.count("is gone"), 1, said)
        self.expect_whole(spp, *guiding)
        self.assertIn("guide=", read_film_header(self.out).settings)

    def test_driver_ends_in_many_ways(self):
        """A task that fails everywhere, a full disk, SIGINT, SIGHUP, SIGKILL and a damaged folder: the same command goes on."""
        said = self.finish(self.start_farm(glim=self.program('return 1, "no more light."')), 1)
        self.assertEqual(said.count("page 0 failed on worker"), 2, said)
        self.assertRegex(said, "farm: page 0 failed too often, at last on worker .*: no more light.\n$")
        farm = self.start_farm(glim=self.program('if page.number > 0:\n    wait_for(FOLDER, "limit")'))
        self.wait_for_pages(1)
        resource.prlimit(farm.pid, resource.RLIMIT_FSIZE, (8000, 8000))  # less than a page
        self.open("limit")
        self.assertIn("File too large", self.finish(farm, 1))
        stuck = self.program('if page.number > 3:\n    wait_for(FOLDER, "never")')
        for number in (signal.SIGINT, signal.SIGHUP):
            farm = self.start_farm(glim=stuck)
            wait_until(lambda: " of 8 pages" in farm.stderr.readline(), "it hands out pages")
            self.wait_for_pages(2)
            farm.send_signal(number)
            self.assertIn("the same command goes on", self.finish(farm, 128 + number))
        self.assertGreaterEqual(len(self.pages()), 2)
        farm = self.start_farm(glim=stuck)
        self.wait_for_pages(4)
        self.assertIn("another farm works on it now", self.finish(self.start_farm(), 1))
        os.kill(farm.pid, signal.SIGKILL)
        farm.wait()
        self.assertIn("its samples is 2000, expected 512", self.finish(self.start_farm(spp=512), 1))
        first, second, third = self.pages()[:3]
        flip_bit(first)
        spoil_attribute(second, b"kernels")
        spoil_attribute(third, b"arithmetic")
        with open(self.out + ".farm/pages/00007.exr.partial", "wb") as file:
            file.write(b"half")
        said = self.finish(self.start_farm())
        for words in ("%s: is damaged" % first, "%s: its kernels is 0123456789abcdef" % second, "%s: its device rounds" % third):
            self.assertIn(words, said)
        self.assertNotIn("came damaged from", said)
        self.expect_whole()

    def test_whole_picture_of_a_farm_that_died_last(self):
        subprocess.run([GLIM, "render", SCENE, "-o", self.out, "--spp", "256", "--size", SIZE], check=True, stdout=subprocess.DEVNULL)
        os.makedirs(self.out + ".farm/pages")
        said = self.finish(self.start_farm("--target-rmse", "1000%", "--png", self.path("out.png"), spp=512))
        self.assertIn("is whole and was kept", said)
        self.assertTrue(os.path.exists(self.path("out.png")))
        self.expect_whole(256)

    def test_damaged_pages(self):
        said = self.finish(self.start_farm("--local", "2", glim=self.program(
            'if claim(FOLDER, "bad", page.worker):\n    time.sleep(.1)\n    return page.flip()\ntime.sleep(.2)')))
        self.assertGreaterEqual(said.count("came damaged from worker"), 3, said)
        self.assertEqual(said.count("too much of what it sends is damaged; the worker is not used"), 1, said)
        self.expect_whole()

    def test_damaged_pages_of_all_workers(self):
        said = self.finish(self.start_farm("--local", "2", glim=self.program("return page.flip()")), 1)
        self.assertEqual(said.count("too much of what it sends is damaged"), 2, said)
        self.assertIn("no worker is left that can be used; the same command goes on", said)
        self.finish(self.start_farm())
        self.expect_whole()


@LONG
class SchedulerTest(SchedulerCase):
    def test_scheduler_dies(self):
        scheduler = self.start_scheduler()
        self.start_worker(self.program(SLOW))
        farm = self.farm()
        self.wait_for_pages(3)
        scheduler.kill()
        self.assertIn("the scheduler is gone; the same command goes on", self.finish(farm, 1))
        self.start_scheduler()
        farm = self.farm()
        time.sleep(3)  # without a worker
        self.start_worker()
        self.finish(farm)
        self.expect_whole()

    def test_slow_worker(self):
        self.start_scheduler()
        self.start_worker(self.program("time.sleep(20)"))
        self.start_worker(self.program("time.sleep(.2)"))
        begin = time.monotonic()
        self.finish(self.farm())
        self.assertLess(time.monotonic() - begin, 20)
        self.expect_whole()

    def test_stopped_worker(self):
        """For longer than the scheduler waits for its heartbeat. When it goes on, the page is done, and its result is dropped."""
        self.start_scheduler(DASK_DISTRIBUTED__SCHEDULER__WORKER_TTL="2s")
        worker = self.start_worker(self.program('claim(FOLDER, "slow")\ntime.sleep(.5)'))
        farm = self.farm()
        wait_until(lambda: os.path.lexists(self.path("claim-slow")), "the first worker renders")
        worker.send_signal(signal.SIGSTOP)
        self.start_worker(self.program('if page.number == 7:\n    wait_for(FOLDER, "continued")\n    time.sleep(2)'))
        wait_until(lambda: "is gone" in farm.stderr.readline(), "the worker is given up")
        worker.send_signal(signal.SIGCONT)
        self.open("continued")
        self.finish(farm)
        self.expect_whole()

    def test_worker_lets_go_of_the_scene(self):
        """glim ends with the farm, though the worker lives on, and though it renders."""
        self.start_scheduler()
        worker = self.start_worker(self.program('claim(FOLDER, "child", os.getpid())\nwait_for(FOLDER, "never")'))
        farm = self.farm()
        wait_until(lambda: os.path.lexists(self.path("claim-child")), "a page is rendered")
        farm.send_signal(signal.SIGINT)
        self.finish(farm, 130)
        wait_until(lambda: not os.path.exists("/proc/" + os.readlink(self.path("claim-child"))), "glim has ended")
        self.assertIsNone(worker.poll())

    def test_workers_that_come_and_go(self):
        self.start_scheduler()
        workers = [self.start_worker(self.program("time.sleep(.7)"), "127.0.0.1", "--lifetime", "%ds" % seconds) for seconds in (3, 5, 7)]
        farm = self.farm()
        for worker in workers:
            worker.wait(WAIT_SECONDS)
        self.start_worker()
        self.assertIn("is gone", self.finish(farm))
        self.expect_whole()

    def test_workers_of_another_class(self):
        """Another commit's kernels, and a device that rounds differently; pages that they claim have digests that are right."""
        self.start_scheduler()
        self.start_worker(self.program(SLOW))
        farm = self.farm()
        self.wait_for_pages(1)
        for attribute in ("kernels", "arithmetic"):
            self.start_worker(self.program("return page.relabel(%r)" % attribute), "127.0.0.2")
        said = self.finish(farm)
        self.assertIn("its kernels is 0123456789abcdef", said)
        self.assertIn("its device rounds differently: its arithmetic is 0123456789abcdef", said)
        self.assertEqual(said.count("the worker is not used"), 2, said)
        self.expect_whole()

    def start_hosts_that_differ(self, spp=SPP):
        """Two hosts render whole films of one page, with digests that are right. The honest one, which has two workers, sends its film of that
        page once "other" is open, and the picture's last page once "last" is."""
        self.start_scheduler()
        self.start_worker(self.program("""
            if not claim(FOLDER, "forged", page.samples):
                wait_for(FOLDER, "never")
            wait_for(FOLDER, "both")
            return page.forge()"""), "127.0.0.2")
        farm = self.farm(spp=spp)
        wait_until(lambda: os.path.lexists(self.path("claim-forged")), "the forger has a page")
        honest = self.program("""
            if owner_of(FOLDER, "forged") == page.samples:
                claim(FOLDER, "both")
                wait_for(FOLDER, "other")
            if page.number == %d:
                wait_for(FOLDER, "last")""" % ((spp - 1) // 256))
        self.start_worker(honest, "127.0.0.3")
        self.start_worker(honest, "127.0.0.3")
        return farm

    def test_hosts_that_differ(self):
        farm = self.start_hosts_that_differ()
        wait_until(lambda: any("/00000." in page for page in self.pages()), "the forged page is there")
        self.open("other")
        wait_until(lambda: "a third decides" in farm.stderr.readline(), "two hosts differ")
        self.open("last")
        self.start_worker(GLIM, "127.0.0.4")
        said = self.finish(farm)
        self.assertIn("host 127.0.0.2 is not trusted any more", said)
        self.assertNotIn("came damaged", said)
        self.expect_whole()

    def test_hosts_that_differ_without_a_third(self):
        """On a page that is folded already."""
        spp = 20 * 256
        farm = self.start_hosts_that_differ(spp)
        wait_until(lambda: os.path.exists(self.out + ".farm/film.exr"), "the forged page is folded")
        self.open("other")
        wait_until(lambda: "a third decides" in farm.stderr.readline(), "two hosts differ")
        self.open("last")
        self.assertIn("no worker is left that can be used; the same command goes on", self.finish(farm, 1))
        self.assertIn("hosts differed on a page of it; it is rendered again", self.finish(self.start_farm(spp=spp)))
        self.expect_whole(spp)

    def test_first_page_of_another_class_is_damaged(self):
        """It decides the class, until it turns out damaged."""
        self.start_scheduler()
        self.start_worker(self.program("""
            if page.number > 0:
                wait_for(FOLDER, "refused")
            page.relabel("arithmetic")
            return page.flip_film()"""), "127.0.0.2")
        farm = self.farm()
        self.wait_for_pages(1)
        self.start_worker()
        wait_until(lambda: "expected 0123456789abcdef; the worker is not used" in farm.stderr.readline(), "the good worker is refused")
        self.open("refused")
        said = self.finish(farm)
        self.assertIn("too much of what it sends is damaged", said)
        self.expect_whole()

    def test_tls(self):
        """Who has no certificate, or one of another authority, gets nothing."""
        from farm_strangers import listening, open_to_strangers
        ours, other = self.tls, self.make_certificate("other")
        scheduler = self.start_scheduler()
        worker = self.start_worker()
        self.assertTrue(self.address.startswith("tls://"))
        wait_until(lambda: listening(worker.pid)[0], "the worker listens")
        places = listening(scheduler.pid)[0] | listening(worker.pid)[0]
        self.assertEqual({place: why for place in places if (why := open_to_strangers(place))}, {})
        for tls, words in ((other, "no scheduler answers"), ([*ours[:3], other[3], *ours[4:]], "do not go together"),
                           (["--tls-ca", self.path("no.pem"), *ours[2:]], "no.pem")):
            self.assertIn(words, self.finish(self.start_farm("--scheduler", self.address, *tls), 1))
        self.finish(self.farm())
        self.expect_whole()
        self.address = self.address.replace("tls://", "tcp://")
        self.assertIn("no scheduler answers", self.finish(self.start_farm("--scheduler", self.address, "--insecure", spp=4), 1))


if __name__ == "__main__":
    main()
