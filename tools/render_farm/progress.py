"""What the farm says on stderr."""

import contextlib
import os
import select
import time

LINE_SECONDS = 10  # between lines where no terminal shows them
STDERR = 2


def duration(seconds):
    if seconds < 100:
        return "%d s" % seconds
    if seconds < 6000:
        return "%d min" % (seconds / 60)
    return "%.1f h" % (seconds / 3600)


def write(text, patience=0):
    """A terminal that has hung up and a reader that is gone end no render. One that takes nothing for so many seconds is not waited for."""
    with contextlib.suppress(OSError):
        if select.select([], [STDERR], [], patience)[1]:
            os.write(STDERR, text.encode(errors="replace"))


def fit(line):
    """As much of it as a terminal shows without a second line."""
    columns = 0
    with contextlib.suppress(OSError):
        columns = os.get_terminal_size(STDERR).columns
    return line[:columns - 1] if columns else line


class Progress:
    def __init__(self):
        self.line = ""
        self.shown = 0.0
        self.begin = None
        self.samples = 0

    def say(self, text):
        write("\r\033[K" * bool(self.line) + "farm: " + text + "\n", patience=1)
        self.line = ""

    def add(self, samples):
        """Counts samples of the whole picture that were rendered."""
        self.samples += samples

    def show(self, done, workers, samples_left, error, dashboard):
        """done: in words. workers: that can be used, and all. samples_left: of the whole picture. error: of the picture so far, or None.
        dashboard: its address, or None."""
        now = time.monotonic()
        self.begin = self.begin or now
        rate = self.samples / max(now - self.begin, 1e-3)
        number = "%d" % workers[0] if workers[0] == workers[1] else "%d of %d" % workers
        line = "%s, %s worker%s" % (done, number, "s" * (number != "1"))
        if rate > 0:
            line += ", %.3g Msamples/s, %s left" % (rate / 1e6, duration(samples_left / rate))
        line += ", %s" % error if error else ""
        line += ", %s" % dashboard if dashboard else ""
        if os.isatty(STDERR):
            line = fit(line)
            if line != self.line:
                write("\r\033[K" + line)
            self.line = line
        elif now - self.shown >= LINE_SECONDS:
            write(line + "\n")
            self.shown = now
