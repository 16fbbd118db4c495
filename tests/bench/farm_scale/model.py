"""Simulates the farm with GPUs from what was measured: an event for each film, the driver's turns as in driver.py."""

import heapq
import random

from farm_scale import HEIGHT, PARTS, WIDTH

RATE = 5e8  # samples/s of a worker: assumed
CORES = 16  # of each machine: assumed
SPREAD = .1  # parts take up to so much more or less than their mean: assumed
PAGE = 256
TAKING_SECONDS = .1  # as in driver.py
BATCH = 16  # pages of a fold
NETWORKS = {"1 Gbit/s": 1.25e8, "10 Gbit/s": 1.25e9}
WORKERS = (1, 2, 3, 4, 8, 16, 32, 64, 128, 256, 512, 1000)
SAMPLES = (16384, 131072, 10000 * PAGE)  # a pixel
MANY = SAMPLES[-1]
BANDS = (1, 8, 32, 128, 256, 360, 540, 720, 1000)  # those to choose from; 1000 is the most that the farm allows


def line_through(merges, tiny):
    """Seconds of each film, and of the rest."""
    few, many = merges
    each = (seconds_of(many, tiny) - seconds_of(few, tiny)) / (many["films"] - few["films"])
    return each, seconds_of(few, tiny) - few["films"] * each


def seconds_of(merge, tiny):
    """Of a merge at 4K, on idle cores."""
    def median(name):
        return PARTS * (merge[name]["median"] - tiny[name]["median"])
    return median("main") + median("others") / CORES


class Costs:
    """Seconds and bytes of parts at the driver's machine; workers encode their films as fast."""

    def __init__(self, figures):
        machine = figures["machine"]
        self.bytes_per_pixel = machine["bytesPerPixel"]
        self.fold, self.encode = line_through(machine["merges"], machine["tiny"])
        per_band, rest = line_through(machine["bands"], machine["tiny"])
        self.per_band = max(0.0, per_band / PARTS)  # of each film, whatever its size
        self.merge_bands = rest if per_band > 0 else seconds_of(machine["bands"][0], machine["tiny"])
        self.write = machine["writeSeconds"]["median"]
        self.transfer = machine["daskSeconds"]["scheduler"]["median"] / 2  # the scheduler's share: it receives and sends
        self.turns = sorted((turn["workers"], turn["turn"]) for turn in figures["turns"] if (turn["parts"], turn["phase"]) == (10000, "begin"))

    def turn(self, workers):
        """Of the driver, with at least so many workers."""
        return next((seconds for measured, seconds in self.turns if measured >= workers), self.turns[-1][1])

    def page_seconds(self, bandwidth):
        """What each resource needs for a page."""
        pixels = WIDTH * HEIGHT
        return {"a GPU": PAGE * pixels / RATE + self.encode, "network": self.bytes_per_pixel * pixels / bandwidth, "Dask": self.transfer,
                "disk": self.write, "fold": self.fold + self.encode / BATCH}


class Job:
    """Films of parts go over one link, one after the other, then to the driver's turns, then to folds."""

    def __init__(self, costs, workers, bandwidth):
        self.costs, self.workers, self.bandwidth = costs, workers, bandwidth
        self.busy = dict.fromkeys(("link", "driver", "fold"), 0.0)

    def run(self, parts, batch, fold_seconds):
        """parts: pixels and seconds of rendering. Returns the figures."""
        events, idle, lent, taken, folded = [], self.workers, 0, set(), 0
        now = link_free = fold_free = 0.0
        waiting = most_waiting = most_taken = 0  # films at workers, and on the driver's disk
        turn = self.costs.turn(self.workers)
        while folded < len(parts) or now < fold_free:
            for part in range(lent, min(len(parts), lent + idle)):
                pixels, seconds = parts[part]
                heapq.heappush(events, (now + seconds + self.costs.encode * pixels / (WIDTH * HEIGHT), "rendered", part))
            lent, idle = min(len(parts), lent + idle), max(0, lent + idle - len(parts))
            now = max(now, events[0][0]) + turn
            self.busy["driver"] += turn
            end_of_turn = now + TAKING_SECONDS
            while events and events[0][0] <= now < end_of_turn:
                then, kind, part = heapq.heappop(events)
                pixels = parts[part][0]
                share = pixels / (WIDTH * HEIGHT)
                if kind == "rendered":
                    idle, waiting = idle + 1, waiting + 1
                    seconds = max(pixels * self.costs.bytes_per_pixel / self.bandwidth, self.costs.transfer * share)
                    link_free = max(link_free, then) + seconds
                    self.busy["link"] += seconds
                    heapq.heappush(events, (link_free, "sent", part))
                elif kind == "sent":
                    now += self.costs.write * share
                    self.busy["driver"] += self.costs.write * share
                    taken.add(part)
                    most_waiting, waiting = max(most_waiting, waiting), waiting - 1
            most_taken = max(most_taken, len(taken) - folded)
            end = min(folded + batch, len(parts))
            if now >= fold_free and folded < end and all(part in taken for part in range(folded, end)):
                fold_free = now + fold_seconds(end - folded)
                self.busy["fold"] += fold_seconds(end - folded)
                heapq.heappush(events, (fold_free, "folded", end - 1))
                folded = end
        used = sum(seconds for _, seconds in parts)
        return {"workers": self.workers, "parts": len(parts), "seconds": now, "efficiency": used / now / self.workers,
                "samplesPerSecond": used * RATE / now, "busy": {name: seconds / now for name, seconds in self.busy.items()},
                "limit": self.limit(now, parts), "filmsAtWorkers": most_waiting, "filmsOnDisk": most_taken}

    def limit(self, now, parts):
        """What is busy for the longest time."""
        work = sum(seconds + self.costs.encode * pixels / (WIDTH * HEIGHT) for pixels, seconds in parts)
        shares = {"workers": work / now / self.workers, **{name: busy / now for name, busy in self.busy.items()}}
        return max(shares, key=shares.get)


def parts_of(bounds, samples):
    chance = random.Random(1)
    return [(WIDTH * rows, WIDTH * rows * samples / RATE * chance.uniform(1 - SPREAD, 1 + SPREAD)) for rows in bounds]


def run_pages(costs, workers, bandwidth, samples):
    return Job(costs, workers, bandwidth).run(parts_of([HEIGHT] * (samples // PAGE), PAGE), BATCH,
                                              lambda pages: costs.encode + pages * costs.fold)


def run_bands(costs, workers, bandwidth, samples):
    """With the best number of bands."""
    found = []
    for bands in BANDS:
        bounds = [HEIGHT * (band + 1) // bands - HEIGHT * band // bands for band in range(bands)]
        found.append(Job(costs, workers, bandwidth).run(parts_of(bounds, samples), bands,
                                                        lambda count: costs.merge_bands + count * costs.per_band))
    return min(found, key=lambda job: job["seconds"])


def simulate(figures):
    costs = Costs(figures)
    found = {"assumed": {"samplesPerSecond": RATE, "spread": SPREAD, "cores": CORES}, "jobs": [],
             "pageMB": costs.bytes_per_pixel * WIDTH * HEIGHT / 1e6,
             "seconds": {"fold": costs.fold, "encode": costs.encode, "mergeOfBands": costs.merge_bands, "ofEachBand": costs.per_band}}
    found["pageSeconds"] = {name: costs.page_seconds(bandwidth) for name, bandwidth in NETWORKS.items()}
    for name, bandwidth in NETWORKS.items():
        for workers in WORKERS:
            for samples in SAMPLES:
                for kind, run in (("pages", run_pages), ("bands", run_bands)):
                    if kind == "bands" or samples == MANY:
                        found["jobs"].append({"kind": kind, "network": name, "samples": samples, **run(costs, workers, bandwidth, samples)})
    return found
