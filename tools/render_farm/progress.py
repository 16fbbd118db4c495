"""What the farm says on stderr."""

import sys
import time

LINE_SECONDS = 10  # between lines where no terminal shows them


def duration(seconds):
    if seconds < 100:
        return "%d s" % seconds
    if seconds < 6000:
        return "%d min" % (seconds / 60)
    return "%.1f h" % (seconds / 3600)


class Progress:
    def __init__(self):
        self.line = ""
        self.shown = 0.0
        self.begin = None
        self.samples = 0

    def say(self, text):
        print("\r\033[K" * bool(self.line) + "farm: " + text, file=sys.stderr, flush=True)
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
        if sys.stderr.isatty():
            if line != self.line:
                print("\r\033[K" + line, end="", file=sys.stderr, flush=True)
            self.line = line
        elif now - self.shown >= LINE_SECONDS:
            print(line, file=sys.stderr, flush=True)
            self.shown = now
