"""Who renders what: parts that wait, are lent to workers, or are done, and whom to trust."""

import collections
import heapq
import statistics

MOST_FAILURES = 3  # of one part
MOST_DEATHS = 10  # of workers that had one part; workers also die by preemption, which is no fault of the part
MOST_DAMAGED = 3  # films of one worker
EARLIER = "an earlier run"  # the host of parts that were done before


class Receipt:
    """What came of a film. kind: "first", "again", "disputed" or "settled". distrusted: hosts that lost trust by it. dropped: parts that
    were done by these, and wait again."""

    def __init__(self, kind, distrusted=(), dropped=()):
        self.kind, self.distrusted, self.dropped = kind, set(distrusted), set(dropped)


class Ledger:
    """Parts are numbers, workers and hosts are names, times are seconds. The first valid digest of a part wins. Two hosts that give two
    digests get nothing more to do until a digest has two hosts; then the others lose trust, and with it all that they have rendered."""

    def __init__(self, waiting, done=None):
        """waiting: parts. done: digests by part, of an earlier run."""
        self.waiting = set(waiting)
        self.order = sorted(waiting)  # a heap that has all that wait, and more: what waits no longer is left in it until it comes up
        self.done = dict(done or {})
        self.hosts = {part: EARLIER for part in self.done}
        self.makers = {}  # workers, of parts that are done
        self.loans = {}  # of a part that is lent: since when, by worker
        self.failures = collections.Counter()  # of a part
        self.damaged = collections.Counter()  # films of a worker
        self.avoided = collections.defaultdict(set)  # of a part: workers that failed at it
        self.deaths = collections.Counter()
        self.votes = {}  # of a disputed part: hosts by digest
        self.distrusted = set()
        self.seconds = collections.deque(maxlen=64)  # that parts took lately

    def is_trusted(self, host):
        return host not in self.distrusted

    def may_work(self, host):
        """Whether it is trusted, and no party to a dispute."""
        return self.is_trusted(host) and not any(host in hosts for votes in self.votes.values() for hosts in votes.values())

    def lend(self, worker, host, workers, now):
        """The part that an idle worker is to render, or None. workers: all that could render one."""
        if not self.may_work(host):
            return None
        part = self.first_fit(worker, workers)
        if part is None and not self.waiting:
            part = self.straggler(worker, now)
        if part is not None:
            self.waiting.discard(part)
            self.loans.setdefault(part, {})[worker] = now
        return part

    def first_fit(self, worker, workers):
        """The first part that waits and that the worker may have: it has not failed at it, or all others have too."""
        unfit = []
        while self.order:
            part = self.order[0]
            if part in self.waiting:
                avoided = self.avoided.get(part, ())
                if worker not in avoided or avoided >= workers:
                    break
                unfit.append(part)
            heapq.heappop(self.order)
        first = self.order[0] if self.order else None
        for part in unfit:
            heapq.heappush(self.order, part)
        return first

    def let_wait(self, part):
        if part not in self.waiting and part not in self.loans:
            self.waiting.add(part)
            heapq.heappush(self.order, part)

    def straggler(self, worker, now):
        """The part that is out longest, at one other worker, and for twice the time that parts take."""
        patience = 2 * statistics.fmean(self.seconds) if self.seconds else 0
        out = [(min(loans.values()), part) for part, loans in self.loans.items()
               if part not in self.done and len(loans) == 1 and worker not in loans]
        since, part = min(out, default=(now, None))
        return part if now - since >= patience else None

    def give_back(self, part, worker):
        """Ends a loan. A part that is neither done nor lent waits again. Returns since when it was out, or None if it was not."""
        loans = self.loans.get(part, {})
        since = loans.pop(worker, None)
        if not loans:
            self.loans.pop(part, None)
            if part not in self.done:
                self.let_wait(part)
        return since

    def lose(self, worker):
        """Takes back what a dead worker had. Returns the parts for which too many have died."""
        parts = [part for part, loans in self.loans.items() if worker in loans]
        for part in parts:
            self.give_back(part, worker)
            self.deaths[part] += part not in self.done
        return [part for part in parts if self.deaths[part] >= MOST_DEATHS]

    def fail(self, part, worker):
        """Counts a failure. Returns whether the part has failed too often."""
        self.give_back(part, worker)
        self.failures[part] += 1
        self.avoided[part].add(worker)
        return part not in self.done and self.failures[part] >= MOST_FAILURES

    def spoil(self, part):
        """Lets a part wait again whose film turned out damaged, which is no failure of the part. Returns the worker that made the film, if it
        was one of this run, and whether that worker has made too many of the kind."""
        worker = self.makers.get(part)
        self.forget({part})
        if worker is None:
            return None, False
        self.avoided[part].add(worker)
        self.damaged[worker] += 1
        return worker, self.damaged[worker] >= MOST_DAMAGED

    def receive(self, part, worker, host, digest, now):
        """Takes a valid film of this digest. Returns its Receipt."""
        since = self.give_back(part, worker)
        if since is not None:
            self.seconds.append(now - since)
        if part in self.votes:
            return self.vote(part, worker, host, digest)
        if part not in self.done:
            self.finish(part, worker, host, digest)
            return Receipt("first")
        if self.done[part] == digest:
            return Receipt("again")
        if self.hosts[part] == host:
            return Receipt("disputed", {host}, self.distrust({host}))
        self.votes[part] = {self.done[part]: {self.hosts[part]}, digest: {host}}
        self.forget({part})
        return Receipt("disputed")

    def vote(self, part, worker, host, digest):
        votes = self.votes[part]
        votes.setdefault(digest, set()).add(host)
        if len(votes[digest]) < 2:
            return Receipt("disputed")
        del self.votes[part]
        losers = set().union(*(hosts for other, hosts in votes.items() if other != digest)) - votes[digest]
        dropped = self.distrust(losers)
        self.finish(part, worker, host, digest)
        return Receipt("settled", losers, dropped)

    def finish(self, part, worker, host, digest):
        self.waiting.discard(part)
        self.done[part], self.hosts[part], self.makers[part] = digest, host, worker

    def distrust(self, hosts):
        self.distrusted |= hosts
        dropped = {part for part, host in self.hosts.items() if host in hosts}
        self.forget(dropped)
        return dropped

    def forget(self, parts):
        """Lets parts that were done wait again."""
        for part in parts:
            self.done.pop(part, None)
            self.hosts.pop(part, None)
            self.makers.pop(part, None)
            self.let_wait(part)
