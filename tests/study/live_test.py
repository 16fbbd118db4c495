#!/usr/bin/env python3
"""tools/study --serve over HTTP: who is refused, what is beyond its limits, how it ends, and the bits of a picture."""

import base64
import contextlib
import http.client
import json
import os
import re
import shlex
import signal
import socket
import stat
import subprocess
import sys
import tempfile
import threading
import unittest

from live_fixture import PNG, ROOT, Live, wait_for

sys.path.insert(0, os.path.join(ROOT, "tools"))
from study_page.live.experiments import EXPERIMENTS, Choice, RefusedError, read_request  # noqa: E402

GLIM = os.path.abspath(sys.argv[1])
SMALL = {"experiment": "direct", "spp": 4, "size": "64x48"}


def is_running(pid):
    try:
        with open("/proc/%d/stat" % pid, encoding="utf-8") as file:
            return file.read().rsplit(")", 1)[1].split()[0] not in "ZX"
    except FileNotFoundError:
        return False


class LiveServerTest(unittest.TestCase):
    """With a program in glim's place."""

    @classmethod
    def setUpClass(cls):
        cls.live = Live()
        cls.addClassCleanup(cls.live.close)

    def setUp(self):
        with contextlib.suppress(FileNotFoundError):
            os.remove(self.live.path("asked"))

    def expect(self, code, answer, said=None):
        self.assertEqual(answer[0], code, answer[2])
        if said:
            self.assertIn(said, answer[2].decode())
        self.assertNotIn(self.live.token.encode(), answer[2])

    def test_page_and_its_files(self):
        for name, kind in (("", "text/html"), ("page.css", "text/css"), ("page.js", "text/javascript"),
                           ("experiments.json", "application/json")):
            for headers in ((), (("Origin", "http://" + self.live.authority),)):
                answer = self.live.get(name, *headers)
                self.expect(200, answer)
                self.assertEqual(answer[1]["Content-Type"], kind + "; charset=utf-8")
                self.assertIn("default-src 'none'", answer[1]["Content-Security-Policy"])
                self.assertEqual((answer[1]["Cache-Control"], answer[1]["Referrer-Policy"]), ("no-store", "no-referrer"))
                self.assertNotRegex(answer[2].decode(), "(?i)https?:|[\"'(]//")  # nothing from elsewhere
        told = json.loads(answer[2])
        self.assertEqual((told["glim"], told["device"]), ("glim stand-in", "a <device>"))
        self.assertEqual([e["key"] for e in told["experiments"]], [e.key for e in EXPERIMENTS])

    def test_others_addresses_are_refused(self):
        token = self.live.token
        self.assertGreaterEqual(len(token), 32)
        other = "A" if token[-1] != "A" else "B"
        for path in ("/", "/page.js", "/%s/" % token[:-1], "/%sx/" % token, "/%s/" % (token[:-1] + other), "/x/%s/" % token, "*", "/../",
                     "http://%s/%s/" % (self.live.authority, token), "/%s/" % token.swapcase(), "/?" + token):
            self.expect(403, self.live.request("GET", path), "not the one that tools/study --serve has printed")
        with socket.create_connection(("127.0.0.1", self.live.port)) as raw, raw.makefile("rb") as answer:
            raw.sendall(b"GET /\xe4/ HTTP/1.0\r\nHost: %s\r\n\r\n" % self.live.authority.encode())
            self.assertIn(b" 403 ", answer.readline())
        self.expect(403, self.live.request("POST", "/%sx/render" % token, body=json.dumps(SMALL).encode()), "address")
        self.assertEqual(self.live.asked(), [])

    def test_other_hosts_are_refused(self):
        own = self.live.authority
        for hosts in (["localhost:%d" % self.live.port], ["evil.example:%d" % self.live.port], ["evil.example"], ["127.0.0.1"], [None],
                      [""], [own, own], [own + "."], ["127.0.0.1:%d" % (self.live.port + 1)]):
            headers = [("Host", host) for host in hosts]
            self.expect(403, self.live.get("", *headers), "this host is not known here")
            self.expect(403, self.live.post(SMALL, *headers), "this host is not known here")
        self.assertEqual(self.live.asked(), [])

    def test_other_pages_are_refused(self):
        own = "http://" + self.live.authority
        for origins in (["http://evil.example"], ["null"], ["http://127.0.0.1:%d" % (self.live.port + 1)], ["http://127.0.0.1"], [""],
                        ["https://" + self.live.authority], [own, "http://evil.example"], ["http://localhost:%d" % self.live.port]):
            headers = [("Origin", origin) for origin in origins]
            self.expect(403, self.live.get("experiments.json", *headers), "other pages may not ask")
            self.expect(403, self.live.post(SMALL, *headers), "other pages may not ask")
        self.expect(403, self.live.post(SMALL, ("Origin", None)), "other pages may not ask")
        self.assertEqual(self.live.asked(), [])

    def test_other_paths_and_methods(self):
        for name in ("x", "page.html", "server.py", "../server.py", "%2e%2e/server.py", "/", "page.js?x", "render/x"):
            self.expect(404, self.live.get(name))
            self.expect(404, self.live.post(SMALL, name=name))
        self.expect(405, self.live.get("render"))
        self.expect(405, self.live.post(SMALL, name="experiments.json"))
        for method in ("HEAD", "PUT", "DELETE", "OPTIONS", "PATCH", "TRACE", "CONNECT", "BREW"):
            answer = self.live.request(method, "/%s/" % self.live.token)
            self.expect(501, answer)
            self.assertNotIn("Access-Control-Allow-Origin", answer[1])
        self.assertEqual(self.live.asked(), [])

    def test_what_is_beyond_the_limits(self):
        for request, sentence in (
                *((text, "an object of JSON") for text in (b"", b"{", b"[" * 4000, b"\xff")),
                ([], "an object"), ({}, "experiment: expected views, "), ({**SMALL, "experiment": "x"}, "experiment: expected"),
                ({**SMALL, "experiment": ["direct"]}, "experiment: expected"),
                ({**SMALL, "output": "/tmp/x.exr"}, "direct has no such control: expected direct, light-samples, spp, sampler, size"),
                ({**SMALL, "file": "/etc/passwd"}, "no such control"), ({**SMALL, "bounces": 2}, "no such control"),
                *(({**SMALL, "spp": spp}, "spp: expected a number from 1 to 1024")
                  for spp in (0, 1025, -1, 4.5, "4", True, None, [4], 1e9)),
                *(({**SMALL, "size": size}, "size: expected 64x48, ") for size in ("1024x768", "", [64, 48], {}, None, "64X48")),
                ({**SMALL, "direct": "lights,mis"}, "direct: expected hemisphere, lights, bsdf, mis"),
                ({**SMALL, "experiment": "global", "bounces": 101}, "bounces: expected a number from 0 to 100"),
                ({**SMALL, "spp": 1024, "size": "512x384"}, "spp: expected at most 85 with these settings"),
                ({"experiment": "adaptive", "max-spp": 1024, "size": "256x192"}, "max-spp: expected at most 341"),
                ({"experiment": "acceleration", "tree": "none", "spp": 64, "size": "256x192"}, "spp: expected at most 5 ")):
            answer = self.live.post(request)
            self.expect(400, answer)
            told = json.loads(answer[2])
            self.assertEqual(list(told), ["error"])
            self.assertIn(sentence, told["error"])
            self.assertNotIn("\n", told["error"])
        for length in ("4097", "-1", "x", "", "1000000000000", "\xb2", None):
            self.expect(400, self.live.request("POST", "/%s/render" % self.live.token, [("Content-Length", length)]),
                        "Content-Length: expected")
        self.assertEqual(self.live.asked(), [])

    def test_every_experiment_is_within_its_limits_as_it_starts(self):
        for experiment in EXPERIMENTS:
            self.assertIn("size", read_request({"experiment": experiment.key}))
            for control in experiment.controls:
                if isinstance(control, Choice):
                    for value in control.options:
                        if (control.name, value) not in (("size", "512x384"), ("tree", "none")):
                            read_request({"experiment": experiment.key, control.name: value})
        with self.assertRaises(RefusedError):
            read_request({"experiment": "direct", "light-samples": 65})

    def test_settings_without_effect_are_left_out(self):
        self.assertEqual(read_request({**SMALL, "direct": "lights", "light-samples": 4})["light-samples"], 4)
        self.assertNotIn("light-samples", read_request({**SMALL, "direct": "mis", "light-samples": 4}))

    def test_pictures(self):
        answer = self.live.post({**SMALL, "direct": "lights"})
        self.expect(200, answer)
        told = json.loads(answer[2])
        self.assertEqual(base64.b64decode(told["image"].removeprefix("data:image/png;base64,")), PNG)
        self.assertEqual(dict(told["facts"]), {"seconds": "0.5", "error": "relMSE 0.02 [0.01, 0.04]", "relMSE x seconds": "0.01",
                                               "samples a pixel": "4", "Mrays/s": "2"})
        asked, = self.live.asked()
        private = os.path.join(self.live.path("temporary"), os.listdir(self.live.path("temporary"))[0])
        self.assertEqual(stat.S_IMODE(os.stat(private).st_mode), 0o700)
        for name in ("output", "image", "stats"):
            self.assertEqual(os.path.dirname(asked.pop(name)), private)
        self.assertEqual(os.listdir(private), ["scenes"])
        self.assertEqual(asked, {"file": os.path.join(ROOT, "scenes", "cornell_spheres.gltf"), "bounces": 1, "paths": "direct",
                                 "direct": "lights", "light-samples": 1, "spp": 4, "sampler": "sobol", "size": [64, 48],
                                 "schedule": "wavefront", "progress": "none"})

    def test_one_at_a_time(self):
        open(self.live.path("hold"), "w", encoding="utf-8").close()
        answers = []
        first = threading.Thread(target=lambda: answers.append(self.live.post(SMALL)))
        first.start()
        wait_for(lambda: len(self.live.asked()) == 1)
        self.expect(409, self.live.post(SMALL), "one is rendered at a time")
        self.expect(200, self.live.get(""))
        os.remove(self.live.path("hold"))
        first.join()
        self.expect(200, answers[0])
        self.expect(200, self.live.post(SMALL))
        self.assertEqual(len(self.live.asked()), 2)

    def test_what_glim_refuses_and_that_it_died(self):
        self.expect(400, self.live.post({**SMALL, "spp": 3}), "--spp: three is refused")
        first = int(self.live.read("pid"))
        self.expect(200, self.live.post(SMALL))
        self.assertEqual(int(self.live.read("pid")), first)
        self.expect(500, self.live.post({**SMALL, "spp": 5}), "glim was killed by signal 9")
        self.expect(200, self.live.post(SMALL))
        self.assertNotEqual(int(self.live.read("pid")), first)

    def test_listens_to_this_machine_alone(self):
        listening = []
        for table in ("/proc/net/tcp", "/proc/net/tcp6"):
            if os.path.exists(table):
                with open(table, encoding="utf-8") as file:
                    rows = [line.split() for line in file][1:]
                listening += [row[1].split(":")[0] for row in rows if row[3] == "0A" and int(row[1].split(":")[1], 16) == self.live.port]
        self.assertEqual(listening, ["0100007F" if sys.byteorder == "little" else "7F000001"])

    def test_says_its_address_once(self):
        with Live() as other:
            self.assertNotEqual(other.token, self.live.token)
            self.assertRegex(other.url, r"^http://127\.0\.0\.1:[0-9]+/[\w-]+/$")
            for answer in (other.get(""), other.post(SMALL)):
                self.assertEqual(answer[0], 200)
            other.process.send_signal(signal.SIGTERM)
            self.assertEqual(other.process.stdout.read(), "")
            self.assertNotIn(other.token, other.read("said"))

    def test_a_connection_that_says_nothing_keeps_nobody_out(self):
        with socket.create_connection(("127.0.0.1", self.live.port)):
            self.expect(200, self.live.get(""))

    def test_ports(self):
        with socket.create_server(("127.0.0.1", 0)) as taken:
            with Live("--port", str(taken.getsockname()[1])) as refused:
                self.assertEqual((refused.url, refused.process.wait(60)), ("", 1))
                self.assertRegex(refused.read("said"), r"^tools/study: --port [0-9]+: cannot listen there: Address already in use\n$")
                self.assertEqual(os.listdir(refused.path("temporary")), [])
            free = taken.getsockname()[1]
        with Live("--port", str(free)) as chosen:
            self.assertEqual(chosen.port, free)


class EndTest(unittest.TestCase):
    def test_signals_end_it_and_its_glim(self):
        for number, code, is_rendering in ((signal.SIGINT, 130, False), (signal.SIGINT, 130, True), (signal.SIGTERM, 143, True),
                                           (signal.SIGHUP, 129, False), (signal.SIGKILL, -9, True)):
            with self.subTest(number=number, is_rendering=is_rendering), Live() as live:
                self.assertEqual(live.post(SMALL)[0], 200)
                glim = int(live.read("pid"))
                self.assertTrue(is_running(glim))
                if is_rendering:
                    open(live.path("hold"), "w", encoding="utf-8").close()
                    threading.Thread(target=self.ask_in_vain, args=(live,)).start()
                    wait_for(lambda: len(live.asked()) == 2)
                self.assertEqual(live.end(number), code)
                wait_for(lambda: not is_running(glim))
                if number != signal.SIGKILL:
                    self.assertEqual(os.listdir(live.path("temporary")), [])
                    self.assertEqual(live.read("said").count("\n"), 1)

    def ask_in_vain(self, live):
        with contextlib.suppress(OSError, http.client.HTTPException):
            live.post(SMALL)


class PictureTest(unittest.TestCase):
    """With glim itself."""

    def test_has_the_bits_of_a_render(self):
        live = Live(glim=GLIM)
        self.addCleanup(live.close)
        for request in (SMALL, {**SMALL, "direct": "mis", "spp": 33, "sampler": "independent"},
                        {"experiment": "global", "spp": 2, "size": "64x48", "bounces": 3, "roulette": "fixed:0.7", "direct": "lights"}):
            code, _, content = live.post(request)
            self.assertEqual(code, 200, content)
            told = json.loads(content)
            words = shlex.split(told["command"])
            self.assertEqual(words[:5], ["glim", "render", "cornell_spheres.gltf", "-o", "film.exr"])
            with tempfile.TemporaryDirectory() as folder:
                subprocess.run([GLIM, "render", os.path.join(ROOT, "scenes", words[2]), *words[3:], "--image", "picture.png", "--stats",
                                "stats.json", "--progress", "none"], cwd=folder, check=True, stderr=subprocess.DEVNULL)
                with open(os.path.join(folder, "stats.json"), encoding="utf-8") as file:
                    self.assertEqual(told["digest"], json.load(file)["pixelsDigest"])
                with open(os.path.join(folder, "picture.png"), "rb") as file:
                    self.assertEqual(base64.b64decode(told["image"].removeprefix("data:image/png;base64,")), file.read())
            self.assertRegex(dict(told["facts"])["error"], "^relMSE [0-9]" if request["spp"] == 33 else "^RMSE at most [0-9]")

    def test_every_experiment_is_rendered(self):
        live = Live(glim=GLIM)
        self.addCleanup(live.close)
        digests = set()
        for request in ({"experiment": "views", "view": "bvh-steps"}, {"experiment": "acceleration"},
                        {"experiment": "acceleration", "tree": "none"}, {"experiment": "global", "scene": "furnace", "spp": 1},
                        {"experiment": "adaptive", "max-spp": 32}, {"experiment": "adaptive", "max-spp": 32, "show": "samples taken"}):
            code, _, content = live.post({**request, "size": "64x48"})
            self.assertEqual(code, 200, content)
            told = json.loads(content)
            digests.add(told["digest"])
            self.assertTrue(re.match(r"data:image/png;base64,iVBORw0KGgo", told["image"]))
        self.assertEqual(len(digests), 4)  # of trees and of what is drawn no pixel depends


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
