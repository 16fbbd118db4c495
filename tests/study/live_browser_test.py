#!/usr/bin/env python3
"""The page of tools/study --serve in a browser: its controls, its pictures, and what pages of other servers can do to it."""

import functools
import http.server
import json
import os
import shutil
import subprocess
import sys
import tempfile
import threading
import time
import unittest

from live_fixture import Live

GLIM = os.path.abspath(sys.argv[1])
WAIT_SECONDS = 120
KEYS = {"ArrowLeft": 37, "ArrowRight": 39, "Enter": 13}
CHROMIUM = ("chromium", "--headless", "--no-sandbox", "--disable-gpu", "--no-first-run", "--disable-background-networking",
            "--host-resolver-rules=MAP evil.example 127.0.0.1", "--remote-debugging-pipe")


class Browser:
    """Chromium, which gets commands on descriptor 3 and answers on 4, as JSON that ends with a zero byte (DevTools protocol)."""

    def __init__(self, folder):
        if not shutil.which(CHROMIUM[0]):
            raise AssertionError("no chromium was found, which this test needs; please install what Debian calls chromium")
        commands, answers = os.pipe(), os.pipe()
        with open(os.path.join(folder, "said"), "wb") as said:
            self.process = subprocess.Popen(
                ["bash", "-c", 'exec "$@" 3<&%d 4>&%d' % (commands[0], answers[1]), "bash", *CHROMIUM, "--user-data-dir=" + folder],
                pass_fds=(commands[0], answers[1]), stdin=subprocess.DEVNULL, stdout=said, stderr=said)
        os.close(commands[0])
        os.close(answers[1])
        self.commands, self.answers = os.fdopen(commands[1], "wb", 0), os.fdopen(answers[0], "rb")
        self.number, self.events, self.session = 0, [], None
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Log", "Runtime", "Network", "Page"):
            self.call(domain + ".enable")

    def call(self, method, **parameters):
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters}
        if self.session:
            message["sessionId"] = self.session
        self.commands.write(json.dumps(message).encode() + b"\0")
        while True:
            answer = self.read()
            if answer.get("id") == self.number:
                assert "result" in answer, answer
                return answer["result"]
            self.events.append(answer)

    def read(self):
        message = bytearray()
        while (byte := self.answers.read(1)) != b"\0":
            assert byte, "chromium has ended"
            message += byte
        return json.loads(message)

    def evaluate(self, expression):
        """The value, once it is there."""
        answer = self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        assert "exceptionDetails" not in answer, answer
        return answer["result"].get("value")

    def wait(self, expression):
        end = time.monotonic() + WAIT_SECONDS
        while not self.evaluate(expression):
            assert time.monotonic() < end, "waited in vain for " + expression
            time.sleep(0.02)

    def open(self, url, until):
        self.call("Page.navigate", url=url)
        self.wait("location.href == %s && (%s)" % (json.dumps(url), until))

    def click(self, element):
        """With the mouse."""
        self.evaluate("document.getElementById('%s').scrollIntoView({block: 'center'})" % element)
        x, y = self.evaluate("(box => [box.x + box.width / 2, box.y + box.height / 2])"
                             "(document.getElementById('%s').getBoundingClientRect())" % element)
        for kind in ("mousePressed", "mouseReleased"):
            self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)

    def press(self, element, key):
        self.evaluate("document.getElementById('%s').focus()" % element)
        for kind in ("rawKeyDown", "keyUp"):
            self.call("Input.dispatchKeyEvent", type=kind, key=key, code=key, windowsVirtualKeyCode=KEYS[key])

    def choose(self, element, value):
        self.evaluate("""(select => {
            select.value = '%s';
            for (const kind of ['input', 'change']) { select.dispatchEvent(new Event(kind, {bubbles: true})); }
        })(document.getElementById('%s'))""" % (value, element))

    def faults(self):
        """What the browser complains of."""
        return [event for event in self.events if event["method"] == "Runtime.exceptionThrown" or
                event["method"] == "Log.entryAdded" and event["params"]["entry"]["level"] in ("warning", "error")]

    def requested(self):
        return [event["params"]["request"]["url"] for event in self.events if event["method"] == "Network.requestWillBeSent"]

    def close(self):
        self.session = None
        self.call("Browser.close")
        self.process.wait(60)
        self.commands.close()
        self.answers.close()


class PageTest(unittest.TestCase):
    def start(self, glim=None):
        folder = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        self.addCleanup(folder.cleanup)
        self.live, self.browser = Live(glim=glim), None
        self.addCleanup(self.live.close)
        self.browser = Browser(folder.name)
        self.addCleanup(self.browser.close)

    def open_page(self):
        self.browser.open(self.live.url, "document.getElementById('render') && !document.getElementById('render').disabled")

    def render(self):
        self.browser.click("render")
        self.browser.wait("document.getElementById('status').textContent.match(/^(Rendered|Not|Nobody)/) && !find('render').disabled")
        return self.browser.evaluate("find('status').textContent")

    def shown(self, section):
        """Name, facts and source of a picture that is drawn."""
        return self.browser.evaluate("""(section => ({
            name: section.querySelector('img').alt, source: section.querySelector('img').src,
            width: section.querySelector('img').naturalWidth,
            facts: Object.fromEntries([...section.querySelectorAll('dt')].map(dt => [dt.textContent, dt.nextSibling.textContent]))
        }))(find('%s'))""" % section)

    def test_renders_and_keeps_the_picture_before(self):
        self.start(GLIM)
        self.open_page()
        self.browser.choose("control-size", "64x48")
        self.browser.press("control-spp", "ArrowLeft")
        self.assertEqual(self.browser.evaluate("find('control-spp-value').value"), "32")
        self.assertEqual(self.browser.evaluate("find('control-spp').getAttribute('aria-valuetext')"), "32")
        self.browser.press("control-spp", "ArrowRight")
        self.assertEqual(self.render(), "Rendered")
        first = self.shown("now")
        self.assertEqual(first["name"], "3. Direct light: estimator hemisphere, light rays a hit 1, samples a pixel 64, points sobol, "
                         "pixels 64x48")
        self.assertEqual((first["width"], first["facts"]["samples a pixel"]), (64, "64"))
        self.assertRegex(first["facts"]["error"], r"^relMSE [0-9.e-]+ \[")
        self.assertGreater(float(first["facts"]["seconds"]), 0)
        self.assertIsNone(self.browser.evaluate("find('before').querySelector('img')"))
        self.browser.choose("control-direct", "mis")
        self.assertTrue(self.browser.evaluate("find('control-light-samples').disabled"))
        self.assertEqual(self.render(), "Rendered")
        self.assertEqual(self.shown("before"), first)
        self.assertEqual(self.shown("now")["name"], "3. Direct light: estimator mis, samples a pixel 64, points sobol, pixels 64x48")
        self.assertNotEqual(self.shown("now")["source"], first["source"])
        self.assertEqual(self.render(), "Rendered: bit for bit the picture before")
        self.assertEqual(self.browser.faults(), [])
        self.assertEqual([url for url in self.browser.requested() if not url.startswith((self.live.url, "data:"))], [])

    def test_every_control_has_a_label(self):
        self.start()
        self.open_page()
        for experiment in self.browser.evaluate("experiments.map(e => e.key)"):
            self.browser.choose("experiment", experiment)
            controls = self.browser.evaluate("[...document.querySelectorAll('select, input')].map(e => [e.id, e.labels.length])")
            self.assertGreater(len(controls), 3)
            self.assertEqual([name for name, labels in controls if labels != 1], [])
        self.assertEqual(self.browser.faults(), [])

    def test_says_why_there_is_no_picture(self):
        self.start()
        self.open_page()
        self.browser.choose("control-size", "512x384")
        for _ in range(4):
            self.browser.press("control-spp", "ArrowRight")
        self.assertEqual(self.render(), "Not rendered: spp: expected at most 85 with these settings, or a smaller picture")
        self.live.end()
        self.assertEqual(self.render(), "Nobody answers: start tools/study --serve again, and open the address that it prints")

    def test_pages_of_other_servers_get_nothing(self):
        """Even if they know the address."""
        self.start()
        with tempfile.TemporaryDirectory() as folder:
            quiet = type("Quiet", (http.server.SimpleHTTPRequestHandler,), {"log_message": lambda *_: None})
            with http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(quiet, directory=folder)) as other:
                threading.Thread(target=other.serve_forever, daemon=True).start()
                self.browser.open("http://127.0.0.1:%d/" % other.server_address[1], "document.readyState == 'complete'")
                ask = "fetch('%srender', {method: 'POST', %s body: '{\"experiment\": \"direct\"}'}).then(a => a.type, () => 'refused')"
                self.assertEqual(self.browser.evaluate(ask % (self.live.url, "")), "refused")
                self.browser.evaluate(ask % (self.live.url, "mode: 'no-cors',"))
                read = "fetch('%sexperiments.json').then(a => a.text(), () => 'refused')" % self.live.url
                self.assertEqual(self.browser.evaluate(read), "refused")
                load = "new Promise(end => document.body.append(Object.assign(document.createElement('script'), " \
                       "{src: '%spage.js', onload: () => end('loaded'), onerror: () => end('refused')})))" % self.live.url
                self.assertEqual(self.browser.evaluate(load), "refused")
                other.shutdown()
        self.assertEqual(self.live.asked(), [])
        rebound = "http://evil.example:%d/%s/" % (self.live.port, self.live.token)
        self.browser.open(rebound, "document.readyState == 'complete'")
        self.assertEqual(self.browser.evaluate("document.body.innerText"), "this host is not known here")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
