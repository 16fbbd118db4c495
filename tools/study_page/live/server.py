"""The live page over HTTP, for one user of this machine: whoever does not know the random part of its address is refused, and so are other
pages of the user's browser."""

import base64
import hmac
import http.server
import json
import os
import re
import secrets
import signal
import sys
import tempfile
import threading

from ..errors import StudyError
from ..glim import Glim
from ..scenes import Scenes
from .experiments import RefusedError, describe, read_request
from .renderer import BusyError, NotRenderedError, Renderer

ADDRESS = "127.0.0.1"
MOST_BYTES = 4096  # of a request's body
FILES = {"": ("page.html", "text/html"), "page.css": ("page.css", "text/css"), "page.js": ("page.js", "text/javascript")}
HEADERS = {
    "Content-Security-Policy": "default-src 'none'; style-src 'self'; script-src 'self'; connect-src 'self'; img-src data:; "
                               "base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
    "Cache-Control": "no-store",
}


class Handler(http.server.BaseHTTPRequestHandler):
    timeout = 10  # seconds without a byte of a request
    server_version, sys_version = "glim", ""

    def do_GET(self):
        if self.is_admitted():
            self.show(self.name())

    def do_POST(self):
        body = self.read_body()  # first: a connection with bytes unread is reset, and the answer lost
        if body is not None and self.is_admitted():
            if self.name() == "render":
                self.render(body)
            else:
                self.send_error(405 if self.is_page(self.name()) else 404)

    def is_admitted(self):
        """Answers with 403 if not. Another host's name leads here by DNS rebinding, another origin is another page of the browser."""
        own = "http://" + self.server.authority
        origins = self.headers.get_all("Origin", [])
        token = self.path.split("/")[1] if "/" in self.path else ""
        if self.headers.get_all("Host") != [self.server.authority]:
            self.send_error(403, "this host is not known here")
        elif origins != [own] and (origins or self.command == "POST"):
            self.send_error(403, "other pages may not ask")
        elif not hmac.compare_digest(token.encode("latin-1"), self.server.token.encode()):
            self.send_error(403, "the address is not the one that tools/study --serve has printed")
        else:
            return True
        return False

    def name(self):
        """What is asked for within the page's address."""
        return self.path.split("/", 2)[2] if self.path.count("/") > 1 else None

    def is_page(self, name):
        return name in FILES or name == "experiments.json"

    def show(self, name):
        if name in FILES:
            file, kind = FILES[name]
            with open(os.path.join(os.path.dirname(__file__), file), "rb") as content:
                self.answer(200, kind, content.read())
        elif name == "experiments.json":
            self.answer_json(200, {**self.server.about, "experiments": describe(self.server.renderer.scenes.names)})
        else:
            self.send_error(405 if name == "render" else 404)

    def read_body(self):
        """None once it is refused."""
        length = self.headers.get("Content-Length", "")
        if not re.fullmatch("[0-9]{1,9}", length) or int(length) > MOST_BYTES:
            self.send_error(400, "Content-Length: expected a number up to %d" % MOST_BYTES)
            return None
        return self.rfile.read(int(length))

    def render(self, body):
        try:
            request = json.loads(body)
        except (ValueError, RecursionError):
            self.answer_json(400, {"error": "a request is an object of JSON"})
            return
        try:
            png, told = self.server.renderer.ask(read_request(request))
        except RefusedError as error:
            self.answer_json(400, {"error": str(error)})
        except BusyError:
            self.answer_json(409, {"error": "another picture is being rendered; one is rendered at a time"})
        except NotRenderedError as error:
            self.answer_json(400 if error.is_request else 500, {"error": str(error)})
        except (OSError, StudyError) as error:
            self.answer_json(500, {"error": "glim cannot be run: %s" % error})
        else:
            self.answer_json(200, {**told, "image": "data:image/png;base64," + base64.b64encode(png).decode()})

    def answer_json(self, code, value):
        self.answer(code, "application/json", json.dumps(value, allow_nan=False).encode())

    def send_error(self, code, message=None, explain=None):
        """For what http.server itself refuses, too."""
        self.answer(code, "text/plain", (message or self.responses[code][0]).encode())

    def answer(self, code, kind, content):
        self.send_response(code)
        for name, value in {**HEADERS, "Content-Type": kind + "; charset=utf-8", "Content-Length": str(len(content))}.items():
            self.send_header(name, value)
        self.end_headers()
        if self.command != "HEAD":
            self.wfile.write(content)

    def log_message(self, *_):
        """Nothing: the paths have the token."""


class LiveServer(http.server.ThreadingHTTPServer):
    daemon_threads, block_on_close = True, False  # a picture under way does not keep it from ending

    def __init__(self, port, renderer, glim):
        try:
            super().__init__((ADDRESS, port), Handler)
        except OSError as error:
            raise StudyError("--port %d: cannot listen there: %s" % (port, error.strerror)) from error
        self.authority = "%s:%d" % (ADDRESS, self.server_address[1])
        self.token = secrets.token_urlsafe(32)
        self.renderer, self.about = renderer, {"glim": glim.version, "device": glim.device["name"]}

    @property
    def url(self):
        return "http://%s/%s/" % (self.authority, self.token)

    def handle_error(self, request, client_address):
        """Nothing of readers that are gone."""
        if not isinstance(sys.exc_info()[1], ConnectionError):
            super().handle_error(request, client_address)


def see_signals_soon():
    """One that comes just before the main thread waits would else not be seen until the wait ends. SIGALRM ends a wait each second."""
    signal.signal(signal.SIGALRM, lambda *_: None)
    signal.setitimer(signal.ITIMER_REAL, 1, 1)


def serve_study(options):
    """Until a signal ends it."""
    glim = Glim()
    with tempfile.TemporaryDirectory(prefix="glim-study-") as folder:
        scenes = Scenes(options.scenes, os.path.join(folder, "scenes"))
        renderer = Renderer(os.path.abspath(glim.binary), scenes, folder)
        with LiveServer(options.port, renderer, glim) as server:
            print(server.url, flush=True)
            print("tools/study: open this address in a browser on this machine; Ctrl-C ends it", file=sys.stderr)
            see_signals_soon()
            threading.Thread(target=server.serve_forever, daemon=True).start()
            renderer.run()
