"""The steps of a run, in the order in which they tell most. Limits in seconds are for a GPU."""

import json
import os
import re

from films import digest_of, equal_pixels, mean_ratio, read_layers
from machine import caches_in
from places import BITS_SIZE, BITS_SPP, PERSISTENT_SCENES, CheckError, group_words, render_words

SCHEDULES = ("wavefront", "persistent")
PICTURE = ("R", "G", "B")
SPEED_SCENES = ("cornell.gltf", "showcase.gltf", "hills.glb")
SPEED_SIZES = ((512, 512), (1920, 1080))
SPEED_SECONDS = 1.5


class Check:
    """The bundle on one device."""

    def __init__(self, bundle, programs, manifest, device, capacity):
        self.bundle, self.programs, self.manifest, self.device, self.capacity = bundle, programs, manifest, device, capacity

    def path(self, *names):
        return os.path.join(self.bundle, *names)

    def scene(self, name):
        return self.path("scenes", name if "." in name else name + ".gltf")

    def program(self, name):
        return os.path.join(self.programs, "bin", name)

    def device_words(self):
        words = ["--device", self.device] if self.device else []
        return words + (["--path-capacity", str(self.capacity)] if self.capacity else [])

    # --- what the machine is ---

    def find_device(self, runner, record):
        outcome = runner.run([self.program("glim"), "devices", "--json"])
        if outcome.code != 0:
            raise CheckError("glim devices: " + outcome.reason())
        record["devices"] = json.loads(outcome.out)
        for index, device in enumerate(record["devices"]):
            named = self.device is None and device["usable"] or self.device is not None and (
                self.device == str(index) if self.device.isdigit() else self.device.lower() in device["name"].lower())
            if named:
                record["device"] = device
                self.device = str(index)
                return
        raise CheckError("no device is usable, or has the name that was given")

    # --- kernels ---

    def test_kernels(self, runner, record):
        record.update(suites=len(self.manifest["kernelSuites"]), passed=[], ended=[], failed={})
        first, others = self.manifest["kernelSuites"][:2], self.manifest["kernelSuites"][2:]

        def test(suite):
            outcome = runner.run([self.program("glim_tests"), "--gtest_color=no", "--gtest_filter=%s.*:*/%s.*" % (suite, suite)])
            precision = re.search(r"^H41 \|[^|]*\|[^|]*\|(.*)\|", outcome.out, re.MULTILINE)
            if precision:
                record["precision"] = precision.group(1).strip()
            if outcome.code == 0:
                record["passed"].append(suite)
            elif outcome.code is None:
                record["ended"].append(suite)
            else:
                found = re.search(r"([^/\s]+:\d+): Failure\n(.*)", outcome.out)
                record["failed"][suite] = "%s: %s" % (found.group(1), found.group(2).strip()[:200]) if found else outcome.reason()
        return all([runner.each(test, first), runner.each(test, others)])

    # --- pictures ---

    def render(self, runner, scene, film, size, *more, **environment):
        """The statistics of a render. CheckError says why there are none."""
        path, stats = runner.path("films", film + ".exr"), runner.path("films", film + ".json")
        width, height = size if isinstance(size, tuple) else (size, size)
        words = render_words(self.program("glim"), self.scene(scene), path, width, height, "--stats", stats, *more)
        outcome = runner.run(words, **environment)
        if outcome.code != 0:
            raise CheckError(outcome.reason())
        with open(stats, encoding="utf-8") as file:
            statistics = json.load(file)
        for what, count in (("not finite", statistics["nonFinite"]["count"]), ("cut short by the driver", statistics["loopCapHits"]),
                            ("beyond their queue", statistics["overflows"])):
            if count > 0:
                runner.wrong("%s: %d samples %s" % (film, count, what))
        return path, statistics

    def compare_bits(self, runner, record):
        """The wavefront twice, and the persistent schedule where it compiles soon. Bits other than the bundle's are wrong."""
        scenes = sorted(name[:-4] for name in os.listdir(self.path("films")))
        record["scenes"] = {scene: {"hashes": {}} for scene in scenes}
        layers = {}

        def draw(task):
            scene, schedule, turn = task
            film = "bits.%s.%s.%d" % (scene, schedule, turn)
            try:
                path, _ = self.render(runner, scene, film, BITS_SIZE, "--spp", str(BITS_SPP), *group_words(scene), "--schedule", schedule,
                                      *self.device_words())
                layers[task] = read_layers(path)
                record["scenes"][scene]["hashes"]["%s %d" % (schedule, turn)] = digest_of(layers[task])
            except CheckError as error:
                record["scenes"][scene].setdefault("failed", {})[schedule] = str(error)

        tasks = [(scene, "wavefront", turn) for turn in (1, 2) for scene in scenes]
        tasks += [(scene, "persistent", 1) for scene in PERSISTENT_SCENES if scene in scenes]
        in_time = runner.each(draw, tasks)
        for scene in scenes:
            entry, expected = record["scenes"][scene], read_layers(self.path("films", scene + ".exr"))
            drawn = next((layers[task] for task in tasks if task in layers and task[0] == scene), None)
            if drawn is not None:
                entry["equal"] = set(entry["hashes"].values()) == {digest_of(expected)}
                entry["equalPixels"], entry["pixels"] = equal_pixels(drawn, expected, PICTURE)
                entry["meanRatio"] = mean_ratio(drawn, expected)
                if not entry["equal"]:
                    runner.wrong("%s has other bits than the bundle's film" % scene)
        return in_time

    def compare_golden(self, runner, record):
        record["pictures"] = {}
        size = self.manifest["goldenSize"]

        def draw(golden):
            scene = golden["scene"]
            entry = record["pictures"][scene] = {}
            try:
                path, _ = self.render(runner, scene, "golden." + scene, size, "--spp", str(golden["samples"]), "--seed", "2",
                                      "--schedule", "wavefront", *self.device_words())  # the faster one to compile
            except CheckError as error:
                entry["failed"] = str(error)
                return
            outcome = runner.run([self.program("glim"), "compare", path, self.path("golden", scene + ".exr"), "--json"])
            if outcome.code != 0:
                entry["failed"] = outcome.reason()
                return
            test = json.loads(outcome.out)["z_test"]
            means = all(abs(z) <= test["mean_limit"] for z in test["mean_z"])
            entry.update(meanZ=test["mean_z"], meanLimit=test["mean_limit"], agree=test["agree"] if golden["blocks"] else means)
            if not entry["agree"]:
                runner.wrong("%s differs from its golden picture by more than noise" % scene)
        return runner.each(draw, self.manifest["golden"])

    # --- speed ---

    def measure_speed(self, runner, record):
        record.update(compile={}, renders=[], rays={})
        for schedule in SCHEDULES:  # in a folder of its own, which is empty the first time
            cache = caches_in(runner.path("cold-" + schedule, ""))
            for which in ("cold", "warm"):
                try:
                    _, statistics = self.render(runner, "showcase", "compile", 64, "--spp", "4", "--schedule", schedule,
                                                *self.device_words(), **cache)
                    seconds = {key: statistics["seconds"][key] for key in ("compile", "firstPass")}
                except CheckError as error:
                    seconds = {"failed": str(error)}
                record["compile"]["%s %s" % (schedule, which)] = seconds
        small, large = SPEED_SIZES
        for size, schedule, arithmetic in ((small, "wavefront", "exact"), (small, "wavefront", "native"), (large, "wavefront", "exact"),
                                           (small, "persistent", "exact")):
            for scene in SPEED_SCENES:
                record["renders"].append(self.rate_of(runner, scene, size, schedule, arithmetic))
                runner.write()
        for scene in SPEED_SCENES:
            record["rays"][scene] = self.rays_of(runner, scene)

    def rate_of(self, runner, scene, size, schedule, arithmetic, *more):
        row = {"scene": scene, "size": "%dx%d" % size, "schedule": schedule, "arithmetic": arithmetic}
        try:
            _, statistics = self.render(runner, scene, "speed", size, "--time", str(SPEED_SECONDS), "--schedule", schedule, *more,
                                        *self.device_words(), GLIM_ARITHMETIC=arithmetic)
            device = sum(kernel["seconds"] for kernel in statistics["kernels"].values())
            row.update(samplesPerSecond=statistics["samplesPerSecond"], raysPerSecond=statistics["raysPerSecond"],
                       deviceSeconds=device, wallSeconds=statistics["seconds"]["render"], compileSeconds=statistics["seconds"]["compile"])
        except CheckError as error:
            row["failed"] = str(error)
        return row

    def rays_of(self, runner, scene):
        path = runner.path("films", "rays.json")
        outcome = runner.run([self.program("glim"), "bench", self.scene(scene), "--kernels", "--size", "1024x1024", "-o", path,
                              "--progress", "none", *self.device_words()])
        if outcome.code != 0:
            return {"failed": outcome.reason()}
        with open(path, encoding="utf-8") as file:
            rates = json.load(file)
        return {rate["rays"]: rate["raysPerSecond"]["median"] for rate in rates[0]["rates"] if rate["variant"] == "as rendered"}

    # --- copies, light paths ---

    def measure_copies(self, runner, record):
        outcome = runner.run([self.program("glim_tests"), "--gtest_filter=StagingTest.CopiesInGigabytesPerSecond"])
        rates = re.findall(r"(upload|download) ([\d.e+-]+) GB/s", outcome.out)
        record["copies"] = {name: float(rate) for name, rate in rates} or {"failed": outcome.reason()}
        record["caustics"] = [self.rate_of(runner, "cornell_gems", (512, 512), schedule, "exact", "--caustics", caustics) |
                              {"caustics": caustics} for schedule in SCHEDULES for caustics in ("on", "off")]

    # --- validation ---

    def validate(self, runner, record):
        record["messages"] = {}
        for scene in ("cornell", "cornell_gems", "materials"):
            for schedule in SCHEDULES:
                film = runner.path("films", "validated.exr")
                words = render_words(self.program("glim"), self.scene(scene), film, 32, 32, "--spp", "4", "--schedule", schedule,
                                     *self.device_words())
                outcome = runner.run(words, GLIM_VALIDATION="1")
                messages = re.findall(r"^validation: .*", outcome.err, re.MULTILINE)
                record["messages"]["%s %s" % (scene, schedule)] = messages if outcome.code == 0 or messages else [outcome.reason()]
