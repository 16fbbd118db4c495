"""What a Driver needs, without Dask, workers and glim: a client and a picture. For tests, and for tests/bench/farm_at_scale.py."""

import asyncio
import contextlib
import time
from types import SimpleNamespace
from unittest import mock


class StandInFuture:
    """A part that a worker renders, and whose film is then sent."""

    def __init__(self, client):
        self.client, self.rendered = client, asyncio.Event()

    def __await__(self):
        self.client.sending += 1
        self.client.most_sending = max(self.client.most_sending, self.client.sending)
        yield from asyncio.sleep(0).__await__()
        return b"film", ""


class StandInClient:
    """Parts are rendered in the order in which they were handed out, when `finish` is called."""

    status = "running"

    def __init__(self, workers):
        self.addresses = ["tls://10.0.%d.%d:40000" % divmod(worker, 250) for worker in range(workers)]
        self.scheduler, self.out, self.submitted = self, [], 0
        self.sending = self.most_sending = 0  # films that came and were not taken; who takes them counts down

    async def ncores(self):
        return dict.fromkeys(self.addresses, 1)

    def submit(self, _task, **_options):
        self.submitted += 1
        self.out.append(StandInFuture(self))
        return self.out[-1]

    def finish(self, count):
        for future in self.out[:count]:
            future.rendered.set()
        del self.out[:count]

    async def run(self, *_arguments, **_options):
        return {}


class StandInPicture:
    """Keeps films in no time, or in `seconds`."""

    part, error, has_class, pixels = "page", None, True, 1
    glim = SimpleNamespace(program="glim", folder="/")

    def __init__(self, client, count, done=(), seconds=0):
        self.client, self.count, self.seconds = client, count, seconds
        self.parts, self.kept, self.finished = range(count), set(done), False
        self.submitted = []  # how many parts were handed out when a film was kept

    @property
    def expected(self):
        return self.count

    @property
    def whole(self):
        return len(self.kept) == self.count

    def publish(self):
        self.finished = True

    def job(self, part):
        return {"samples": "%d:%d" % (part, part + 1)}

    def samples(self, _part):
        return 256

    def check(self, _part, _film, _name):
        return SimpleNamespace(digest="digest")

    def take(self, part, _header, _film):
        time.sleep(self.seconds)
        self.submitted.append(self.client.submitted)
        self.kept.add(part)

    def holds(self, part):
        return part in self.kept

    def foldable(self):
        return range(0)


async def wait(future):
    await future.rendered.wait()


@contextlib.contextmanager
def without_dask():
    with mock.patch("distributed.wait", wait), mock.patch("render_farm.driver.make_task", lambda *about: None):
        yield


def make_driver(kind, picture, done=(), stopped=()):
    """kind: Driver, or a class made from it. stopped: see Driver."""
    options = SimpleNamespace(insecure=False, scheduler="tls://10.0.9.9:8786", slurm=None, devices=None, dashboard=False)
    progress = SimpleNamespace(say=print, add=lambda samples: None, show=lambda *about: None)
    return kind(picture, dict.fromkeys(done, "digest"), options, progress, stopped)
