"""Hands parts to workers and takes back films. To be imported within the environment that has Dask."""

import asyncio
import contextlib
import functools
import signal
import threading
import time
from multiprocessing import resource_tracker

import cloudpickle
import distributed
from distributed.comm import addressing

from render_farm import glim_child
from render_farm.errors import FarmError, stop_signals
from render_farm.ledger import Ledger
from render_farm.picture import OtherClass
from render_farm.security import is_private

TICK_SECONDS = 0.5
TAKING_SECONDS = 0.1  # of films, before workers that are free get parts; a film of 4K takes a second to write
MOST_FILMS = 8  # in the driver's memory; the others stay with their workers
ENDING_SECONDS = 5
PATIENCE_SECONDS = 60  # with workers of which none can be used, until another comes
cloudpickle.register_pickle_by_value(glim_child)  # workers need not have this code
host_of = functools.lru_cache(maxsize=None)(addressing.get_address_host)  # asked for each worker in each turn


def make_task(program, job, folder, devices):
    """A function without arguments, which goes to a worker by value. devices: by the names of workers, which a cluster of this machine
    counts from 0; or None."""
    def task():
        worker = distributed.get_worker()
        placed = {**job, "device": devices[worker.name]} if devices else job
        if not hasattr(worker, "glim_servers"):
            worker.glim_servers = glim_child.Servers()
        film, _, error = glim_child.serve_film(worker.glim_servers, program, placed, folder, worker.local_directory)
        return film, error
    return task


class Driver:
    """Each part goes to a worker that the driver chooses: Dask carries films, and tells which workers live. A film comes back as the bytes
    that the task returns, so that workers need no folder in common with the driver, and the driver alone writes into the job's."""

    def __init__(self, picture, done, options, progress, stopped):
        """stopped: holds the signal once one has come (until_signal)."""
        self.picture, self.options, self.progress, self.stopped = picture, options, progress, stopped
        self.ledger = Ledger(set(picture.parts) - done.keys(), done)
        self.workers = set()
        self.barred = set()
        self.others = set()  # of those that are barred: of another class
        self.busy = set()
        self.tasks = {}  # that follow a loan, by part and worker
        self.room = asyncio.Semaphore(MOST_FILMS)
        self.folding = None
        self.useless_since = None
        self.shown = None  # when

    async def run(self, client):
        """Returns when the picture is whole. Refuses (FarmError) what keeps it from that. client: Dask's."""
        self.client, self.events = client, asyncio.Queue()
        try:
            while not self.picture.finished:
                if self.stopped:  # asyncio.wait_for before Python 3.12 loses a cancellation that comes together with what it waits for
                    raise asyncio.CancelledError
                await self.look_at_workers()
                self.hand_out()
                self.show()
                await self.take_films()
                await self.fold()
                if self.picture.whole and not self.folding and not self.ledger.votes:  # a fold ends by judging the film
                    self.picture.publish()
        finally:
            for task in self.tasks.values():
                task.cancel()
            if self.folding:
                await asyncio.wait([self.folding])
            # The workers of a scheduler live on, and others end faster without a page to wait for.
            with contextlib.suppress(asyncio.TimeoutError, OSError):
                await asyncio.wait_for(self.client.run(glim_child.end_server_of, on_error="ignore"), ENDING_SECONDS)

    async def look_at_workers(self):
        try:
            now = set(await self.client.scheduler.ncores())
        except (OSError, AttributeError) as error:
            raise self.lost() from error
        for worker in self.workers - now:
            self.progress.say("worker %s is gone" % worker)
            self.busy.discard(worker)
            for part in self.ledger.lose(worker):
                raise FarmError("%s: too many workers died while they had it" % self.name(part))
            for key in [key for key in self.tasks if key[1] == worker]:
                self.tasks.pop(key).cancel()
        for worker in now - self.workers:
            if not self.options.insecure and not is_private(worker):
                self.bar(worker, "%s: it is reached without TLS" % worker)
        self.workers = now
        self.refuse_if_useless()

    def lost(self):
        return FarmError("the scheduler is gone; the same command goes on from %s" % self.picture.folder.path)

    def refuse_if_useless(self):
        """Refuses (FarmError) to wait for ever while workers are there and none can be used. Others may still come, but for local ones."""
        if self.usable() or not self.workers:
            self.useless_since = None
            return
        now = time.monotonic()
        if self.useless_since is None:
            self.useless_since = now
        is_all = not self.options.scheduler and not self.options.slurm and len(self.workers) >= self.options.local
        if is_all or now - self.useless_since >= PATIENCE_SECONDS:
            raise FarmError("no worker is left that can be used; the same command goes on from %s" % self.picture.folder.path)

    def source_of(self, worker):
        """Whose bits a worker has: those of its host or, where each has a device of its own, its own."""
        return worker if self.options.devices else host_of(worker)

    def usable(self):
        return {worker for worker in self.workers - self.barred if self.ledger.may_work(self.source_of(worker))}

    def bar(self, worker, why):
        if worker not in self.barred:
            self.progress.say("%s; the worker is not used" % why)
        self.barred.add(worker)

    def reconsider_class(self):
        """What decided the class was false, so that the workers of other classes may be of the right one."""
        if not self.picture.has_class:
            self.barred -= self.others
            self.others = set()

    def hand_out(self):
        usable = self.usable()
        for worker in sorted(usable - self.busy):
            part = self.ledger.lend(worker, self.source_of(worker), usable, time.monotonic())
            if part is None:
                continue
            task = make_task(self.picture.glim.program, self.picture.job(part), self.picture.glim.folder, self.options.devices)
            future = self.client.submit(task, workers=[worker], allow_other_workers=False, pure=False)
            self.busy.add(worker)
            self.tasks[part, worker] = asyncio.create_task(self.follow(part, worker, future))

    async def follow(self, part, worker, future):
        """Frees the worker as soon as it has rendered, before the film is here."""
        try:
            await distributed.wait(future)
            self.busy.discard(worker)
            self.events.put_nowait(None)
            async with self.room:
                taken = asyncio.Event()
                self.events.put_nowait((part, worker, *await future, taken))
                await taken.wait()
        except Exception as caught:  # whatever Dask throws is a failure of this loan
            self.busy.discard(worker)
            self.events.put_nowait((part, worker, None, "%s: %s" % (type(caught).__name__, caught), asyncio.Event()))

    async def take_films(self):
        try:
            event = await asyncio.wait_for(self.events.get(), TICK_SECONDS)
        except asyncio.TimeoutError:
            return
        end = time.monotonic() + TAKING_SECONDS
        while True:
            if event is not None:
                *about, taken = event
                await self.take(*about)
                taken.set()
            if self.events.empty() or time.monotonic() >= end:
                return
            event = self.events.get_nowait()

    async def take(self, part, worker, film, error):
        if self.tasks.pop((part, worker), None) is None:
            return  # of a worker that is gone
        if film is None:
            if self.client.status != "running":
                raise self.lost()
            return self.fail(part, worker, error)
        try:
            header = self.picture.check(part, film, "worker %s" % worker)
        except OtherClass as other:
            self.ledger.give_back(part, worker)
            if worker not in self.barred:
                self.others.add(worker)
            return self.bar(worker, other)
        except FarmError as wrong:
            return self.fail(part, worker, wrong)
        host = self.source_of(worker)
        if not self.ledger.is_trusted(host):
            self.ledger.give_back(part, worker)
            return None
        receipt = self.ledger.receive(part, worker, host, header.digest, time.monotonic())
        if receipt.kind in ("disputed", "settled"):
            await self.resolve(part, host, receipt)
        if receipt.kind in ("first", "settled") and not self.picture.holds(part):
            try:
                await asyncio.to_thread(self.picture.take, part, header, film)  # Dask's connections go on meanwhile
            except FarmError:
                return self.spoil(part)
            self.progress.add(self.picture.samples(part) * self.picture.pixels)
        return None

    async def resolve(self, part, host, receipt):
        if self.folding:
            await asyncio.wait([self.folding])
        if receipt.kind == "disputed" and not receipt.distrusted:
            self.progress.say("%s: host %s renders other bits than another host; a third decides" % (self.name(part), host))
            self.picture.suspend(part)
        for loser in sorted(receipt.distrusted):
            self.progress.say("host %s is not trusted any more: what it rendered of %s has wrong bits" % (loser, self.name(part)))
        self.ledger.forget(self.picture.drop(receipt.dropped) - ({part} if receipt.kind == "settled" else set()))
        self.reconsider_class()
        if not self.ledger.votes:
            self.picture.settle()

    def fail(self, part, worker, why):
        if self.ledger.fail(part, worker):
            raise FarmError("%s failed too often, at last on worker %s: %s" % (self.name(part), worker, why))
        self.progress.say("%s failed on worker %s: %s" % (self.name(part), worker, why))

    def spoil(self, part):
        worker, too_many = self.ledger.spoil(part)
        if worker is not None:
            self.progress.say("%s came damaged from worker %s" % (self.name(part), worker))
        if too_many:
            self.bar(worker, "worker %s: too much of what it sends is damaged" % worker)

    async def fold(self):
        if self.folding and self.folding.done():
            damaged, again = self.folding.result()
            self.ledger.forget(again)
            for part in sorted(damaged):
                self.spoil(part)
            self.reconsider_class()
            self.folding = None
        pages = self.picture.foldable() if self.folding is None else None
        if pages:
            self.folding = asyncio.create_task(asyncio.to_thread(self.picture.fold, pages))
            self.folding.add_done_callback(lambda _: self.events.put_nowait(None))

    def left(self):
        """The parts that are not done, as far as is known which are needed."""
        return [part for part in self.picture.parts[:self.picture.expected] if part not in self.ledger.done]

    def count_left(self):
        return len(self.left())

    def name(self, part):
        return "%s %d" % (self.picture.part, part)

    def show(self):
        now = time.monotonic()
        if self.shown is not None and now - self.shown < TICK_SECONDS:
            return
        self.shown = now
        left, all_parts = self.left(), self.picture.expected
        self.progress.show("%d of %d %ss" % (all_parts - len(left), all_parts, self.picture.part), (len(self.usable()), len(self.workers)),
                           sum(map(self.picture.samples, left)) * self.picture.pixels, self.picture.error,
                           self.client.dashboard_link if self.options.dashboard else None)


def keep_interrupts_from_children():
    """Ctrl-C in a terminal is sent to every process of the farm, and is for the driver alone. A child has the mask of the thread that
    starts it. So one thread takes the signal, and it starts none. multiprocessing's resource tracker lets the signal through again in the
    thread that starts it, so it is started before."""
    resource_tracker.ensure_running()
    threading.Thread(target=threading.Event().wait, daemon=True).start()
    signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})


async def until_signal(work):
    """Runs `work`, which takes a list. A signal that stops a farm is put into that list and cancels the work. Returns the signal, or
    None."""
    keep_interrupts_from_children()
    stopped = []
    task = asyncio.ensure_future(work(stopped))

    def stop(number):
        stopped.append(number)
        task.cancel()
    for number in stop_signals():
        asyncio.get_running_loop().add_signal_handler(number, stop, number)
    try:
        await task
    except asyncio.CancelledError:
        if not stopped:
            raise
    return stopped[0] if stopped else None
