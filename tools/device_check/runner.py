"""Runs steps one after the other, each within its time, and writes what is known after each."""

import concurrent.futures
import json
import os
import signal
import subprocess
import time

from table import table_of


class OutOfTime(Exception):
    pass


class Outcome:
    """Of a program. code: None if it was ended."""

    def __init__(self, code, out, err, seconds):
        self.code, self.out, self.err, self.seconds = code, out, err, seconds

    def reason(self):
        if self.code is None:
            return "ended after %.0f s" % self.seconds
        lines = [*reversed(self.err.splitlines()), *reversed(self.out.splitlines())]
        said = next((line.strip()[:300] for line in lines if line.strip() and not line.startswith("Run with --help")), "it said nothing")
        return "exit code %d: %s" % (self.code, said) if self.code >= 0 else "signal %d: %s" % (-self.code, said)


class Runner:
    """What steps work with: programs with the bundle's libraries, a clock, and the record that they fill."""

    def __init__(self, folder, environment, patience):
        self.folder, self.environment, self.patience = folder, environment, patience
        self.results = {"steps": {}, "wrong": []}
        self.deadline = self.longest = None
        self.at_once = max(1, min(8, os.cpu_count() or 1))

    def path(self, *names):
        path = os.path.join(self.folder, *names)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        return path

    def left(self):
        return self.deadline - time.monotonic()

    def run(self, words, **environment):
        """Ends the program and what it has started once it has had its share of the step's time. OutOfTime: all of it is over."""
        if self.left() <= 0:
            raise OutOfTime
        begin = time.monotonic()
        process = subprocess.Popen(words, env={**self.environment, **environment}, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True, errors="replace", start_new_session=True)
        try:
            out, err = process.communicate(timeout=max(0.0, min(self.left(), self.longest)))
            code = process.returncode
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            out, err = process.communicate()
            code = None
            if self.left() <= 0:
                raise OutOfTime from None
        return Outcome(code, out, err, time.monotonic() - begin)

    def each(self, function, tasks):
        """Several at a time. Tasks that the time does not suffice for are left out; true if it sufficed for all."""
        def guarded(task):
            try:
                function(task)
            except OutOfTime:
                return False
            return True
        with concurrent.futures.ThreadPoolExecutor(self.at_once) as pool:
            return all(list(pool.map(guarded, tasks)))

    def wrong(self, sentence):
        self.results["wrong"].append(sentence)

    def write(self):
        for name, text in (("result.json", json.dumps(self.results, indent=1)), ("table.md", table_of(self.results))):
            path = self.path(name)
            with open(path + ".part", "w", encoding="utf-8") as file:
                file.write(text)
            os.replace(path + ".part", path)

    def step(self, name, seconds, share, function):
        """share: of the time, the most that one program gets. A kernel that compiles for minutes leaves time for the others."""
        record = self.results["steps"][name] = {"state": "under way"}
        self.write()
        begin = time.monotonic()
        self.deadline, self.longest = begin + seconds * self.patience, share * seconds * self.patience
        try:
            record["state"] = "done" if function(self, record) is not False else "out of time"
        except OutOfTime:
            record["state"] = "out of time"
        except Exception as error:  # a step that fails must not keep the others from running
            record["state"] = "failed: %s: %s" % (type(error).__name__, error)
        record["seconds"] = round(time.monotonic() - begin, 1)
        self.write()
