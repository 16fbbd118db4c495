"""Section 4, first part: direct and indirect light, and the number of bounces."""

from ..lab import FIRST_SEED
from ..markup import gallery, heading, number, paragraph, percent, relmse, table

SCENE = "spheres"
BOUNCES = (0, 1, 2, 3, 4, 100)
LONGEST = ("--bounces", BOUNCES[-1])
PARTS = {"direct only": (*LONGEST, "--paths", "direct"), "indirect only": (*LONGEST, "--paths", "indirect")}


def cases():
    return {**PARTS, **{"%d bounces" % n: ("--bounces", n) for n in BOUNCES}}


def measure(lab):
    profile, parts = lab.profile, {}
    whole = lab.reference(SCENE, profile.light_size, profile.light_reference, *LONGEST)
    for name, options in cases().items():
        reference = whole
        if options != LONGEST:
            reference = lab.reference(SCENE, profile.light_size, profile.part_reference, *options)
        run = lab.measure(name, SCENE, profile.light_size, *options, "--spp", profile.light_spp, seed=FIRST_SEED,
                          reference=reference, png=True)
        share = lab.glim.compare(reference.exr, whole.exr)["mean_ratio"]["all"]["value"]
        parts[name] = {**run, "shareOfLight": share}
    return {"spp": profile.light_spp, "referenceSpp": profile.part_reference,
            "wholeSpp": profile.light_reference, "parts": parts}


def show(results, pictures):
    parts = results["parts"]
    everything = "%d bounces" % BOUNCES[-1]
    shown = {**{name: parts[name] for name in PARTS}, "all": parts[everything]}
    text = heading("Direct and indirect") + gallery(pictures.figure(name, run) for name, run in shown.items())
    text += heading("Bounces") + gallery(pictures.figure(name, run) for name, run in parts.items() if name not in PARTS)
    text += paragraph("%d samples a pixel; each relMSE against a long render of the same paths (%d samples, with all "
                      "bounces %d), the share of light from those long renders." %
                      (results["spp"], results["referenceSpp"], results["wholeSpp"]))
    return text + table(("paths", "seconds", "rays a path", "Mrays/s", "relMSE", "share of the picture's light"), [
        (name, number(run["seconds"]), number(run["rays"] / run["samples"]), number(run["mrays"]), relmse(run),
         percent(run["shareOfLight"], 4)) for name, run in parts.items()])


def headlines(results):
    parts = results["parts"]
    direct, two, whole = (parts["%d bounces" % n] for n in (1, 2, BOUNCES[-1]))
    return [("Indirect light, %d bounces instead of 1" % BOUNCES[-1],
             "%s times the seconds a sample" % number(whole["seconds"] / direct["seconds"]),
             "%s of the picture's light" % percent(1 - direct["shareOfLight"])),
            ("of it beyond 2 bounces", "%s times the seconds a sample" % number(whole["seconds"] / two["seconds"]),
             percent(1 - two["shareOfLight"]))]
