"""The results as Markdown, as tests/bench/GPU.md has them."""

STEPS = (("device", "driver and device"), ("kernels", "kernel suites"), ("bits", "bits"), ("golden", "golden pictures"),
         ("speed", "speed"), ("copies", "copies, light paths"), ("validation", "validation layer"))


def rows_of(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    lines += ["| " + " | ".join(str(cell).replace("|", "/").replace("\n", " ") for cell in row) + " |" for row in rows]
    return "\n".join(lines) + "\n"


def number(value):
    return "" if value is None else "%.3g" % value if isinstance(value, (int, float)) else value


def millions(row, name):
    return row["failed"] if "failed" in row else "%.3g" % (1e-6 * row[name])


def kernels_text(step):
    return "%d of %d suites pass, %d fail, %d took too long" % (len(step["passed"]), step["suites"], len(step["failed"]),
                                                                len(step["ended"]))


def bits_text(step):
    drawn = [entry for entry in step["scenes"].values() if "equal" in entry]
    return "%d of %d films have the bundle's bits, %d were not drawn" % (sum(entry["equal"] for entry in drawn), len(step["scenes"]),
                                                                         len(step["scenes"]) - len(drawn))


def golden_text(step):
    drawn = [entry for entry in step["pictures"].values() if "agree" in entry]
    return "%d of %d agree up to noise, %d differ" % (sum(entry["agree"] for entry in drawn), len(step["pictures"]),
                                                      sum(not entry["agree"] for entry in drawn))


def speed_text(step):
    rates = [row["samplesPerSecond"] for row in step["renders"] if "samplesPerSecond" in row]
    return "%d of %d renders; up to %s Msamples/s" % (len(rates), len(step["renders"]), number(1e-6 * max(rates)) if rates else "none")


def copies_text(step):
    return ", ".join("%s %s%s" % (name, number(value), "" if name == "failed" else " GB/s") for name, value in step["copies"].items())


def validation_text(step):
    return "%d messages in %d renders" % (sum(map(len, step["messages"].values())), len(step["messages"]))


TEXTS = {"kernels": ("suites", kernels_text), "bits": ("scenes", bits_text), "golden": ("pictures", golden_text),
         "speed": ("renders", speed_text), "copies": ("copies", copies_text), "validation": ("messages", validation_text)}


def summary(results):
    rows = []
    for name, title in STEPS:
        step = results["steps"].get(name)
        if step:
            needs, text = TEXTS.get(name, (None, None))
            rows.append((title, number(step.get("seconds")), step["state"], text(step) if text and step.get(needs) else ""))
    return rows_of(("step", "s", "state", "result"), rows)


def device_lines(results):
    machine, device = results.get("machine", {}), results["steps"].get("device", {}).get("device")
    lines = []
    if device:
        lines.append("%s, %s; %s, subgroups of %d, %d MiB." % (device["name"], device["driver"], device["kind"], device["subgroupSize"],
                                                              device["memory"] >> 20))
    if machine:
        lines.append("%s, Linux %s, %s, %d processors (%s)%s." % (
            machine["system"], machine["kernel"], machine["libc"], machine["processors"], machine["processor"],
            ", " + machine["nvidia"] if machine["nvidia"] else ""))
    if "bundle" in results:
        lines.append("%s; films to compare with by %s." % (results["bundle"]["glim"], results["bundle"]["films"]))
    return "\n".join(lines) + "\n"


def bits_table(step):
    rows = []
    for scene, entry in step["scenes"].items():
        failed = "; ".join("%s: %s" % item for item in entry.get("failed", {}).items())
        if "equal" in entry:
            rows.append((scene, "yes" if entry["equal"] else "no", "%d of %d" % (entry["equalPixels"], entry["pixels"]),
                         "%.7g" % entry["meanRatio"], len(entry["hashes"]), failed))
        else:
            rows.append((scene, "", "", "", "", failed or "not drawn"))
    return rows_of(("scene", "all layers equal", "equal pixels", "ratio of means", "runs", "failed"), rows)


def golden_table(step):
    return rows_of(("scene", "verdict", "z of means", "limit"), [
        (scene, ("agrees" if entry["agree"] else "differs") if "agree" in entry else entry.get("failed", "not drawn"),
         " ".join("%.2f" % z for z in entry.get("meanZ", [])), number(entry.get("meanLimit")))
        for scene, entry in step["pictures"].items()])


def speed_tables(step):
    renders = rows_of(("scene", "size", "schedule", "arithmetic", "Msamples/s", "Mrays/s", "device idle"), [
        (row["scene"], row["size"], row["schedule"], row["arithmetic"], millions(row, "samplesPerSecond"),
         "" if "failed" in row else millions(row, "raysPerSecond"),
         "" if "failed" in row else "%.1f %%" % (100 * (1 - row["deviceSeconds"] / row["wallSeconds"]))) for row in step["renders"]])
    compiled = rows_of(("showcase", "compiling, s", "to the first picture, s"), [
        (name, seconds.get("failed") or number(seconds["compile"]), number(seconds.get("firstPass")))
        for name, seconds in step["compile"].items()])
    kinds = sorted({kind for rates in step["rays"].values() for kind in rates})

    def cell(rates, kind):
        return "" if kind not in rates else rates[kind] if kind == "failed" else number(1e-6 * rates[kind])
    rays = rows_of(("Mrays/s", *kinds), [(scene, *(cell(rates, kind) for kind in kinds)) for scene, rates in step["rays"].items()])
    return "\n".join([renders, compiled] + ([rays] if kinds else []))


def caustics_table(step):
    return rows_of(("cornell_gems", "light paths", "Msamples/s"), [(row["schedule"], row["caustics"], millions(row, "samplesPerSecond"))
                                                                   for row in step["caustics"]])


def table_of(results):
    steps = results["steps"]
    parts = [device_lines(results), summary(results)]
    parts += ["Wrong: %s.\n" % sentence for sentence in results["wrong"]]
    kernels = steps.get("kernels", {})
    if kernels.get("precision"):
        parts.append("Precision: %s.\n" % kernels["precision"])
    if kernels.get("failed"):
        parts.append(rows_of(("suite", "fails"), sorted(kernels["failed"].items())))
    for name, needs, table in (("bits", "scenes", bits_table), ("golden", "pictures", golden_table), ("speed", "renders", speed_tables),
                               ("copies", "caustics", caustics_table)):
        if steps.get(name, {}).get(needs):
            parts.append(table(steps[name]))
    return "\n".join(parts)
