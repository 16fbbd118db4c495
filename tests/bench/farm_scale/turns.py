"""The driver's own CPU time: the real Driver and Ledger with stand-ins for Dask's client and the picture, and films of no size."""

import asyncio
import os
import statistics
import sys
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.realpath(__file__)), *[os.pardir] * 2, "tools"))
from farm_driver_stand_in import StandInClient, StandInPicture, make_driver, without_dask  # noqa: E402
from render_farm.driver import Driver  # noqa: E402

CASES = [(workers, parts, "begin") for workers in (10, 100, 1000) for parts in (2500, 10000)] + [(100, 10000, "end"), (1000, 10000, "end")]
BURST = 8  # films a turn: as with 235 parts a second and some 30 turns
TURNS = 40  # of the begin
LEFT = 1.2  # parts for each worker at the end


class MeasuredDriver(Driver):
    """Notes the CPU time of each turn."""

    turns, most_turns, begin = (), None, 0.0

    async def take_films(self):
        self.client.finish(BURST)
        await asyncio.sleep(0)
        await super().take_films()
        now = time.process_time()
        self.turns.append(now - self.begin)
        self.begin = now
        if len(self.turns) == self.most_turns:
            self.picture.finished = True


def drive(workers, parts, phase):
    """CPU seconds of each turn, at the begin of a job or from few parts left until all are there."""
    done = range(0) if phase == "begin" else range(parts - int(LEFT * workers))
    client = StandInClient(workers)
    driver = make_driver(MeasuredDriver, StandInPicture(client, parts, done), done)
    driver.turns, driver.most_turns = [], TURNS if phase == "begin" else None
    with without_dask():
        driver.begin = time.process_time()
        asyncio.run(driver.run(client))
    return driver.turns


def measure(say):
    found = []
    for workers, parts, phase in CASES:
        first, *turns = drive(workers, parts, phase)
        found.append({"workers": workers, "parts": parts, "phase": phase, "firstTurn": first, "turns": len(turns),
                      "turn": statistics.median(turns), "turnMost": max(turns), "seconds": sum(turns)})
        say("%(phase)s, %(workers)d workers, %(parts)d parts: %(firstTurn).3f s, then %(turns)d turns of %(turn).4f, at most %(turnMost).4f"
            % found[-1])
    return found
