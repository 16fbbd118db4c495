"""What the sections measure with: it renders, compares with long renders, keeps to time budgets, and reports progress."""

import os
import shutil
import statistics
import sys
import time

from .estimates import mean_interval, positive_interval, ratio_of_means

REFERENCE_SEED = 1000003  # no experiment's seed comes near
FIRST_SEED = 1


def clock(seconds):
    return "%d:%02d" % divmod(int(seconds), 60)


class Lab:
    def __init__(self, glim, scenes, profile, folder, scratch, out=sys.stderr):
        self.glim, self.scenes, self.profile, self.out = glim, scenes, profile, out
        self.folder, self.scratch = folder, scratch
        self.references = {}
        self.began = self.section_began = time.monotonic()
        self.section, self.finished, self.shown = None, {}, 0.0
        os.makedirs(os.path.join(folder, "pictures"), exist_ok=True)

    # Budgets and progress

    def begin(self, section):
        self.section, self.section_began = section, time.monotonic()
        self.say("%s, %s planned" % (section, clock(self.profile.budgets[section])), always=True)

    def finish(self):
        self.finished[self.section] = time.monotonic() - self.section_began
        self.references.clear()
        shutil.rmtree(self.scratch)
        os.makedirs(self.scratch)

    def remaining(self):
        """Seconds left by the plan, corrected by how well the finished sections kept to it. A tenth of the plan counts as kept from
        the start."""
        budgets = self.profile.budgets
        head = 1.0 + 0.1 * sum(budgets.values())
        pace = (head + sum(self.finished.values())) / (head + sum(budgets[s] for s in self.finished))
        ahead = sum(seconds for s, seconds in budgets.items() if s not in self.finished and s != self.section)
        here = max(0.0, budgets[self.section] * pace - (time.monotonic() - self.section_began))
        return here + ahead * pace

    def say(self, text, always=False):
        """On a terminal one line that changes, elsewhere a line at most every ten seconds."""
        now = time.monotonic()
        line = "study: %s elapsed, about %s left: %s" % (clock(now - self.began), clock(self.remaining()), text)
        if self.out.isatty():
            self.out.write("\r\033[K" + line[:shutil.get_terminal_size().columns - 1])
        elif always or now - self.shown > 10:
            self.out.write(line + "\n")
            self.shown = now
        self.out.flush()

    def close(self):
        """Ends the line that changes."""
        if self.out.isatty():
            self.out.write("\n")

    def seeds(self, least_most, until):
        """Seeds from FIRST_SEED on. After the least number, goes on only while the next one would end before that share of the budget."""
        least, most = least_most
        start = time.monotonic()
        for i in range(most):
            now = time.monotonic()
            each = (now - start) / i if i else 0.0
            if i >= least and now - self.section_began + each > until * self.profile.budgets[self.section]:
                return
            yield FIRST_SEED + i

    def few_seeds(self):
        """The seeds of experiments that are mostly shown as pictures."""
        return range(FIRST_SEED, FIRST_SEED + self.profile.few_seeds)

    # Measurements

    def render(self, name, scene, size, *options, png=False, rates=False, keep=True):
        """Without `keep`, only the statistics are kept."""
        self.say("%s: %s" % (self.section, name))
        stem = os.path.join(self.scratch, name.replace(" ", "-"))
        shot = self.glim.render(stem, self.scenes.path(scene), size, [str(o) for o in options], png, rates)
        if not keep:
            os.remove(shot.exr)
        return shot

    def reference(self, scene, size, spp, *options):
        """The long render of the same light, with MIS and Sobol' points whatever the experiments use. glim estimates its noise without
        bias, from blocks of Sobol' points with a scramble each, so the noise can be taken off."""
        key = (scene, size, spp, options)
        if key not in self.references:
            name = "reference %d %s" % (len(self.references), scene)
            self.references[key] = self.render(name, scene, size, "--spp", spp, "--seed", REFERENCE_SEED, *options)
        return self.references[key]

    def triangles(self, scene):
        return self.glim.inspect(self.scenes.path(scene))["counts"]["triangles"]

    def measure(self, name, scene, size, *options, seed, reference, png=False, rates=False):
        """One render and how far it is from the long one."""
        shot = self.render("%s seed %d" % (name, seed), scene, size, "--seed", seed, *options, png=png, rates=rates)
        judged = self.judge(shot, reference)
        os.remove(shot.exr)
        return judged

    def judge(self, shot, reference):
        """A render's cost and its error, from which the reference's own noise is subtracted."""
        errors = self.glim.compare(shot.exr, reference.exr)
        noise = errors["reference_noise"] or {"mse": 0.0, "relmse": 0.0}
        return {"seconds": shot.seconds, "mrays": shot.mrays, "samples": shot.samples, "spp": shot.spp, "rays": shot.rays,
                "relmse": errors["relmse"] - noise["relmse"], "referenceNoise": noise["relmse"],
                "mse": errors["mse"] - noise["mse"], "meanRatio": errors["mean_ratio"]["all"]["value"],
                "steps": shot.stats.get("steps"), "picture": self.keep(shot.png), "rates": self.keep(shot.rates)}

    def keep(self, png):
        """Moves a picture to where the page finds it; returns its name there."""
        if png is None:
            return None
        name = os.path.basename(png)
        os.replace(png, os.path.join(self.folder, "pictures", name))
        return name


def time_ratio(runs, others):
    """The ratio of the seconds a sample, over pairs by seed."""
    return ratio_of_means(*([r["seconds"] / r["samples"] for r in side] for side in (runs, others)))


def cost_ratio(runs, others):
    """The ratio of relMSE times seconds, over pairs by seed: how much longer `runs` would take to reach the error of `others`, if the
        error falls as 1 / n."""
    return ratio_of_means(*([r["relmse"] * r["seconds"] for r in side] for side in (runs, others)))


def summarize(runs):
    """Several seeds of one experiment; seconds are the median."""
    return {"seconds": statistics.median(r["seconds"] for r in runs), "mrays": statistics.median(r["mrays"] for r in runs),
            "samples": statistics.fmean(r["samples"] for r in runs), "spp": statistics.fmean(r["spp"] for r in runs),
            "rays": statistics.fmean(r["rays"] for r in runs),
            "relmse": positive_interval([r["relmse"] for r in runs]), "referenceNoise": runs[0]["referenceNoise"],
            "mse": positive_interval([r["mse"] for r in runs]), "meanRatio": mean_interval([r["meanRatio"] for r in runs]),
            "steps": runs[0]["steps"], "picture": runs[0]["picture"], "rates": runs[0]["rates"]}
