"""What the driver's machine does with a page of a 4K picture: glim merge, the disk, and Dask's transfer. The films that are measured have a
sixteenth of the pixels and two samples a pixel; all figures are for 4K. CPU seconds, since others may use the machine."""

import asyncio
import contextlib
import os
import shutil
import statistics
import subprocess
import time

import distributed

from farm_scale import HEIGHT, PARTS, WIDTH
from render_farm import no_http  # noqa: F401
from whole_file import write_whole

SIZE = "960x540"
ROWS = 540
REPEATS = 3
PAGES = (1, 4)  # films of a merge
BANDS = (2, 10)
SAMPLED_ROWS = "1072:1076"
VIEW = ["--look-from", "0,1,3.95", "--look-at", "0,1,0", "--zoom", "2", "--progress", "none"]  # the box fills the frame


def samples_of(page):
    """Two samples in two blocks (shaders/shared/limits.h): a film of one block is far smaller than that of a whole page."""
    edge = 128 * (page + 1)
    return "%d:%d" % (edge - 1, edge + 1)


def spread(values):
    return {"median": statistics.median(values), "least": min(values), "most": max(values), "n": len(values)}


def read_threads(pid):
    """CPU seconds of each thread."""
    found = {}
    with contextlib.suppress(OSError):  # it ends meanwhile
        for thread in os.listdir("/proc/%d/task" % pid):
            with open("/proc/%d/task/%s/schedstat" % (pid, thread), encoding="ascii") as file:
                found[int(thread)] = int(file.read().split()[0]) / 1e9
    return found


def run(command):
    """CPU seconds of a program's main thread, and those of the others, which share the cores; and the peak of memory in MB."""
    process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    threads, ended = {}, 0
    while not ended:
        threads.update(read_threads(process.pid))
        time.sleep(.02)
        ended, status, used = os.wait4(process.pid, os.WNOHANG)
    if status != 0:
        raise SystemExit("farm_at_scale.py: failed: %s" % " ".join(command))
    main = threads.pop(process.pid)
    return {"main": main, "others": sum(threads.values()), "cpu": used.ru_utime + used.ru_stime, "peakMB": used.ru_maxrss / 1024}


class Machine:
    def __init__(self, glim, scene, folder, say):
        self.glim, self.scene, self.folder, self.say = glim, scene, folder, say

    def path(self, name):
        return os.path.join(self.folder, name)

    def render(self, name, *more):
        run([self.glim, "render", self.scene, *VIEW, *more, "-o", self.path(name)])
        return self.path(name)

    def merge(self, films):
        runs = [run([self.glim, "merge", *films, "-o", self.path("merged.exr")]) for _ in range(REPEATS)]
        found = {"films": len(films), **{name: spread([one[name] for one in runs]) for name in runs[0]}}
        self.say("merge of %d films: %.2f and %.2f CPU s, %.0f MB" % (len(films), *(found[name]["median"] for name in ("main", "others", "peakMB"))))
        return found

    def measure(self):
        self.say("bytes of a page")
        rows = self.render("rows.exr", "--size", "%dx%d" % (WIDTH, HEIGHT), "--samples", "0:256", "--rows", SAMPLED_ROWS)
        begin, end = map(int, SAMPLED_ROWS.split(":"))
        found = {"bytesPerPixel": os.path.getsize(rows) / (WIDTH * (end - begin)), **self.measure_pages()}
        return {**found, "bands": [self.merge_bands(count) for count in BANDS]}

    def measure_pages(self):
        tiny = self.merge([self.render("tiny.exr", "--size", "8x8", "--samples", "0:2")])
        pages = [self.render("page%d.exr" % page, "--size", SIZE, "--samples", samples_of(page)) for page in range(max(PAGES))]
        merges = [self.merge(pages[:count]) for count in PAGES]
        with open(pages[0], "rb") as file:
            film = file.read() * PARTS
        disk = [self.write(film) for _ in range(REPEATS)]
        dask = asyncio.run(measure_transfers(len(film)))
        return {"tiny": tiny, "merges": merges, "filmBytesPerPixel": len(film) / (WIDTH * HEIGHT), "writeSeconds": spread(disk),
                "daskSeconds": dask}

    def write(self, film):
        begin = time.process_time()
        write_whole(self.path("written.exr"), film)
        return time.process_time() - begin

    def merge_bands(self, count):
        os.mkdir(self.path("bands"))
        bounds = [ROWS * band // count for band in range(count + 1)]
        films = [self.render("bands/%d.exr" % band, "--size", SIZE, "--samples", samples_of(0), "--rows", "%d:%d" % (begin, end))
                 for band, (begin, end) in enumerate(zip(bounds, bounds[1:]))]
        found = {**self.merge(films), "bytesPerPixel": PARTS * sum(map(os.path.getsize, films)) / (WIDTH * HEIGHT)}
        shutil.rmtree(self.path("bands"))
        return found


async def measure_transfers(size):
    """CPU seconds from the end of a task until its bytes are here, over the loopback: through the scheduler, which is Dask's choice, and
    directly from the worker. Driver, scheduler and worker are one process here, which sends a quarter of the size."""
    found = {}
    async with distributed.LocalCluster(n_workers=1, threads_per_worker=1, processes=False, protocol="tls://", host="127.0.0.1",
                                        security=distributed.Security.temporary(),
                                        dashboard_address=None, memory_limit=0, asynchronous=True) as cluster:
        async with distributed.Client(cluster, asynchronous=True) as client:
            for name, direct in (("scheduler", False), ("direct", True)):
                seconds = []
                for _ in range(REPEATS):
                    future = client.submit(bytes, size // 4, pure=False)
                    await distributed.wait(future)
                    begin = time.process_time()
                    film = await client.gather(future, direct=direct)
                    seconds.append(4 * (time.process_time() - begin))
                    del film, future
                found[name] = spread(seconds)
    return found
