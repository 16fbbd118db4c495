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

    def show(self, name, done, count, usable, workers, samples_left):
        """name: of the parts. samples_left: of the whole picture."""
        now = time.monotonic()
        self.begin = self.begin or now
        rate = self.samples / max(now - self.begin, 1e-3)
        number = "%d" % usable if usable == workers else "%d of %d" % (usable, workers)
        line = "%d of %d %s, %s worker%s" % (done, count, name, number, "s" * (number != "1"))
        if rate > 0:
            line += ", %.3g Msamples/s, %s left" % (rate / 1e6, duration(samples_left / rate))
        if sys.stderr.isatty():
            if line != self.line:
                print("\r\033[K" + line, end="", file=sys.stderr, flush=True)
            self.line = line
        elif now - self.shown >= LINE_SECONDS:
            print(line, file=sys.stderr, flush=True)
            self.shown = now
