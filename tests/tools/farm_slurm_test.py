#!/usr/bin/env python3
"""tools/farm --slurm, with programs in place of sbatch and scancel that run the jobs on this machine: no Slurm is at hand. It needs Dask and
dask-jobqueue from PyPI: where they cannot be had, ctest lists this test as skipped (exit code 77). The argument is glim's program."""

import os
import signal

from farm_fixture import GLIM, LONG, FarmCase, main, wait_until
from render_farm.arguments import walltime
from render_farm.environment import JOBQUEUE

SBATCH = """#!/bin/sh
script=$(cat "$1")
setsid sh -c "$script" >/dev/null 2>&1 &
cp "$1" "%(folder)s/job-$!"
echo "Submitted batch job $!"
"""
SCANCEL = """#!/bin/sh
kill -KILL -- "-$1"
"""


class SlurmTest(FarmCase):
    def setUp(self):
        super().setUp()
        for name, text in (("sbatch", SBATCH), ("scancel", SCANCEL)):
            self.write_program(name, text % {"folder": self.folder} if name == "sbatch" else text)
        self.addCleanup(self.end_jobs)

    def end_jobs(self):
        for job in self.jobs():
            try:
                os.killpg(job, signal.SIGKILL)
            except ProcessLookupError:
                pass

    def jobs(self):
        return [int(name[4:]) for name in os.listdir(self.folder) if name.startswith("job-")]

    def start_slurm(self, words, *more, glim=GLIM):
        return self.start_farm("--slurm", words, *more, glim=glim, PATH=self.folder + ":" + os.environ["PATH"])

    def test_job(self):
        from farm_strangers import listening, open_to_strangers
        farm = self.start_slurm("partition=gpu gres=gpu:1 time=1:00:00", "--workers", "0:2", glim=self.program(
            'claim(FOLDER, "worker-%d" % page.worker)\nwait_for(FOLDER, "done")'))
        wait_until(lambda: sum(name.startswith("claim-worker-") for name in os.listdir(self.folder)) == 2, "both workers render")
        self.assertEqual(len(self.jobs()), 2)
        keys = [name for name in os.listdir(self.out + ".farm") if name.startswith(".dask-jobqueue.worker.key")]
        self.assertEqual(len(keys), 1)
        for name, mode in (("", 0o700), (keys[0], 0o600)):
            self.assertEqual(os.stat(os.path.join(self.out + ".farm", name)).st_mode & 0o777, mode)
        places = set().union(*(listening(pid)[0] for pid in (farm.pid, *self.jobs())))
        self.assertGreaterEqual(len(places), 5, "a scheduler, two workers and two nannies")
        self.assertEqual({place: why for place in places if (why := open_to_strangers(place))}, {})
        self.open("done")
        self.finish(farm)
        self.expect_whole()
        with open(self.path("job-%d" % self.jobs()[0]), encoding="utf-8") as file:
            script = file.read()
        for line in ("#SBATCH --partition=gpu\n", "#SBATCH --gres=gpu:1\n", "#SBATCH --time=1:00:00\n"):
            self.assertIn(line, script)
        for words in ("--mem=", "--cpus-per-task", "#SBATCH -t"):
            self.assertNotIn(words, script)
        self.assertIn("--lifetime 3300s --lifetime-stagger 240s", script)
        self.assertIn("--nthreads 1 ", script)
        wait_until(lambda: not any(os.path.exists("/proc/%d" % job) for job in self.jobs()), "the jobs have ended")

    @LONG
    def test_workers_whose_time_is_over(self):
        """Others take their place."""
        self.finish(self.start_slurm("time=0:30", "--workers", "1:2", glim=self.program("time.sleep(8)")))
        self.assertGreater(len(self.jobs()), 2)
        self.expect_whole()

    def test_times(self):
        for text, seconds in (("30", 1800), ("1:30", 90), ("1:00:00", 3600), ("1-0", 86400), ("1-2:30", 95400), ("2-01:00:01", 176401),
                              ("", 0), ("x", 0), ("-5", 0), ("1:2:3:4", 0)):
            self.assertEqual(walltime(text), seconds, text)


if __name__ == "__main__":
    main(JOBQUEUE)
