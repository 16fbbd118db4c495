"""Section 4, first part: direct and indirect light, and the number of bounces."""

from ..estimates import complement, interval
from ..lab import FIRST_SEED, summarize, time_ratio
from ..markup import bracket, gallery, heading, number, paragraph, percent, relmse, table

SCENE = "spheres"
BOUNCES = (0, 1, 2, 3, 4, 100)


def bounce_label(count):
    return "1 bounce" if count == 1 else "%d bounces" % count


EVERYTHING = bounce_label(BOUNCES[-1])
LONGEST = ("--bounces", BOUNCES[-1])
PARTS = {"direct only": (*LONGEST, "--paths", "direct"), "indirect only": (*LONGEST, "--paths", "indirect")}


def cases():
    return {**PARTS, **{bounce_label(n): ("--bounces", n) for n in BOUNCES}}


def measure_share(lab, part, whole):
    """Of the light of all paths, from the long renders. Their own variances give the interval, as if the two, which are of
    one seed, had nothing in common and the channels everything: so it is too wide rather than too narrow."""
    ratio = lab.glim.compare(part.exr, whole.exr)["mean_ratio"]["all"]
    return interval(ratio["value"], ratio["low"], ratio["high"], 1)


def measure(lab):
    profile = lab.profile
    whole = lab.reference(SCENE, profile.light_size, profile.light_reference, *LONGEST)
    references = {name: whole if name == EVERYTHING else
                  lab.reference(SCENE, profile.light_size, profile.part_reference, *options)
                  for name, options in cases().items()}
    runs = {name: [] for name in references}
    for seed in lab.few_seeds():
        for name, options in cases().items():
            runs[name].append(lab.measure(name, SCENE, profile.light_size, *options, "--spp", profile.light_spp, seed=seed,
                                          reference=references[name], png=seed == FIRST_SEED))
    parts = {name: {**summarize(found), "secondsOfWhole": time_ratio(runs[EVERYTHING], found)} for name, found in runs.items()}
    for name, reference in references.items():
        if name != EVERYTHING:
            parts[name]["shareOfLight"] = measure_share(lab, reference, whole)
    return {"spp": profile.light_spp, "referenceSpp": profile.part_reference,
            "wholeSpp": profile.light_reference, "parts": parts}


def share_text(share):
    return bracket(share, lambda value: percent(value, 4))


def show(results, pictures):
    parts = results["parts"]
    shown = {**{name: parts[name] for name in PARTS}, "all": parts[EVERYTHING]}
    text = heading("Direct and indirect") + gallery(pictures.figure(name, run) for name, run in shown.items())
    text += heading("Bounces") + gallery(pictures.figure(name, run) for name, run in parts.items() if name not in PARTS)
    text += paragraph("%d seeds of %d samples a pixel; each relMSE against a long render of the same paths (%d samples, with "
                      "all bounces %d). The share of light is the ratio of those long renders' means, its interval from their "
                      "pixels' variances: of two independent pictures, so too wide for these two of one seed." %
                      (parts[EVERYTHING]["relmse"]["n"], results["spp"], results["referenceSpp"], results["wholeSpp"]))
    return text + table(("paths", "seconds", "%s take as long x" % EVERYTHING, "rays a path", "Mrays/s", "relMSE",
                         "share of the picture's light"), [
        (name, number(run["seconds"]), "" if name == EVERYTHING else bracket(run["secondsOfWhole"]),
         number(run["rays"] / run["samples"]), number(run["mrays"]), relmse(run),
         "all" if name == EVERYTHING else share_text(run["shareOfLight"])) for name, run in parts.items()])


def headlines(results):
    direct, two = (results["parts"][bounce_label(n)] for n in (1, 2))
    return [("Indirect light, %s instead of 1" % EVERYTHING,
             "%s times the seconds a sample" % bracket(direct["secondsOfWhole"]),
             "%s of the picture's light" % share_text(complement(direct["shareOfLight"]))),
            ("of it beyond 2 bounces", "%s times the seconds a sample" % bracket(two["secondsOfWhole"]),
             share_text(complement(two["shareOfLight"])))]
