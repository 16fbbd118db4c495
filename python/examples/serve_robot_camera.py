#!/usr/bin/env python3
"""Renders for Drake: serves its glTF Render Client-Server API on 127.0.0.1, and so is the camera of a simulated robot.

The line that it prints has the arguments of pydrake's RenderEngineGltfClientParams. The endpoint begins with a secret, since all users of
the machine reach the port. Pictures are rendered one after another.

color   sRGB, with --spp samples for each pixel. Drake sends no lights, so glim's studio or --environment lights the scene
depth   metres along the camera's axis, at the centre of each pixel: 0 below min_depth, infinite above max_depth
label   the colour that Drake has given to what is at the centre of each pixel; white is nothing
"""

import argparse
import email
import email.policy
import hashlib
import hmac
import http.server
import json
import math
import os
import secrets
import signal
import socket
import struct
import sys
import tempfile
import zlib

import glim
import numpy

MOST_BYTES, MOST_PIXELS = 64 << 20, 4096  # of a request, and of each side of a picture


class Refused(Exception):
    """A request that is answered by a code of HTTP and one sentence."""

    def __init__(self, code, sentence):
        super().__init__(sentence)
        self.code = code


class Form:
    """What a client has sent."""

    def __init__(self, kind, body):
        message = email.message_from_bytes(b"Content-Type: %s\r\n\r\n%s" % (kind.encode("latin-1"), body), policy=email.policy.HTTP)
        if message.get_content_type() != "multipart/form-data":
            raise Refused(415, 'Content-Type: cannot use "%s", expected multipart/form-data' % message.get_content_type())
        self._fields = {part.get_param("name", header="content-disposition"): part.get_payload(decode=True)
                        for part in message.iter_parts()}

    def field(self, name):
        if self._fields.get(name) is None:
            raise Refused(400, "%s: is missing" % name)
        return self._fields[name]

    def text(self, name):
        return self.field(name).decode("utf-8", "replace")

    def number(self, name, least, most):
        try:
            value = float(self.text(name))
        except ValueError:
            value = math.nan
        if not least <= value <= most:
            raise Refused(400, '%s: cannot use "%.40s", expected a number from %g to %g' % (name, self.text(name), least, most))
        return value

    def scene(self):
        """The glTF file as a document."""
        content = self.field("scene")
        if hashlib.sha256(content).hexdigest() != self.text("scene_sha256"):
            raise Refused(400, "scene: its SHA-256 is not scene_sha256")
        try:
            return json.loads(content)
        except (ValueError, RecursionError):
            raise Refused(400, "scene: is not JSON, expected a glTF file") from None


class RobotCamera:
    """Renders what forms ask for, in a folder that has nothing else. distortion: of all pictures, as of glim.Camera."""

    def __init__(self, folder, distortion, spp, environment, exposure):
        self._folder, self._path = folder, os.path.join(folder, "scene.gltf")
        self._distortion, self._exposure = distortion, exposure
        self._lit = {"spp": spp, "environment": environment}
        self._scene = glim.load(self._path, confine=True)

    def answer(self, form):
        """A type of media and bytes. Raises Refused."""
        answers = {"color": self._color, "depth": self._depth, "label": self._label}
        if form.text("image_type") not in answers:
            raise Refused(400, 'image_type: cannot use "%.40s", expected color, depth or label' % form.text("image_type"))
        camera, document = self._camera(form), with_y_up(form.scene())
        try:
            with open(self._path, "w", encoding="utf-8") as file:
                json.dump(document, file)
            return answers[form.text("image_type")](form, document, camera)
        except glim.InputError as error:
            raise Refused(400, str(error).replace(self._path, "scene")) from None
        finally:
            for name in os.listdir(self._folder):
                os.unlink(os.path.join(self._folder, name))

    def _camera(self, form):
        """With the form's intrinsics, where the file's camera stands. Drake's pixels have their centres at whole numbers."""
        size = tuple(int(form.number(name, 1, MOST_PIXELS)) for name in ("width", "height"))
        fx, fy = (form.number(name, 1e-3, 1e6) for name in ("focal_x", "focal_y"))
        cx, cy = (form.number(name, -1e6, 1e6) for name in ("center_x", "center_y"))
        return glim.Camera(((fx, 0, cx), (0, fy, cy), (0, 0, 1)), origin="center", distortion=self._distortion, size=size)

    def _color(self, form, document, camera):
        path = os.path.join(self._folder, "color.png")
        self._scene.render(camera=camera, **self._lit).save(path, exposure=self._exposure, tone="neutral")
        with open(path, "rb") as file:
            return "image/png", file.read()

    def _depth(self, form, document, camera):
        least, most = (form.number(name, 0, 1e9) for name in ("min_depth", "max_depth"))
        film = self._surfaces(camera)
        pose = numpy.array(film.camera.pose("opencv"))
        depth = (film.surfaces["position"] - pose[:3, 3]) @ pose[:3, 2]  # NaN where nothing is
        return "image/tiff", tiff_of(numpy.where(depth < least, 0, numpy.where(depth <= most, depth, numpy.inf)))

    def _label(self, form, document, camera):
        film = self._surfaces(camera, objects=True)
        meshes = [instance["mesh"] for instance in film.objects["instances"]]
        colors = numpy.array([label_of(document, mesh) for mesh in meshes] + [(255, 255, 255)])
        return "image/png", png_of(colors[numpy.minimum(film.surfaces["instance"], len(meshes))])

    def _surfaces(self, camera, **wanted):
        """What is at the centres of pixels takes no light and one sample."""
        return self._scene.render(camera=camera, spp=1, bounces=0, environment=(1, 1, 1), surfaces=True, **wanted)


def with_y_up(document):
    """In Drake z is up. In glTF, and so in glim's studio, y is."""
    try:
        scene = document["scenes"][document.get("scene", 0)]
        document["nodes"].append({"rotation": [-math.sqrt(.5), 0, 0, math.sqrt(.5)], "children": scene["nodes"]})
        scene["nodes"] = [len(document["nodes"]) - 1]
    except (AttributeError, LookupError, TypeError):
        raise Refused(400, "scene: has no scenes with nodes, expected a glTF file") from None
    return document


def label_of(document, mesh):
    """The colour of 8 bits that stands for a label."""
    try:
        material = document["materials"][document["meshes"][mesh]["primitives"][0]["material"]]
        return [round(255 * number) for number in material["pbrMetallicRoughness"]["baseColorFactor"][:3]]
    except (LookupError, TypeError):
        raise Refused(400, "scene: meshes[%s] has no baseColorFactor, expected the colour of a label" % mesh) from None


def tiff_of(values):
    """Of (height, width) numbers, as float32."""
    height, width = values.shape
    content = values.astype("<f4").tobytes()
    entries = [(256, 4, width), (257, 4, height), (258, 3, 32), (259, 3, 1), (262, 3, 1), (273, 4, 8 + 2 + 10 * 12 + 4), (277, 3, 1),
               (278, 4, height), (279, 4, len(content)), (339, 3, 3)]  # tag, 3: 16 bits or 4: 32 bits, value; the last are: IEEE numbers
    return b"".join([b"II*\0", struct.pack("<IH", 8, len(entries)),
                     *(struct.pack("<HHII", tag, kind, 1, value) for tag, kind, value in entries), bytes(4), content])


def png_of(values):
    """Of (height, width, 3) numbers from 0 to 255."""
    height, width, _ = values.shape
    rows = b"".join(b"\0" + row.tobytes() for row in values.astype(numpy.uint8))

    def chunk(name, content):
        return struct.pack(">I", len(content)) + name + content + struct.pack(">I", zlib.crc32(name + content))
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) + \
        chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


class Handler(http.server.BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"  # curl asks before it sends a large scene
    timeout = 10  # seconds in which a client sends nothing

    def do_POST(self):
        try:
            self.check()
        except Refused as refused:
            self.refuse_unread(refused)
            return
        try:
            body = self.rfile.read(int(self.headers["Content-Length"]))
            self.send(200, *self.server.camera.answer(Form(self.headers.get("Content-Type", ""), body)))
        except Refused as refused:
            self.send_error(refused.code, str(refused))
        except glim.DeviceError as error:
            self.send_error(500, str(error))

    def handle_expect_100(self):
        try:
            self.check()
            return super().handle_expect_100()
        except Refused as refused:
            self.refuse_unread(refused)
            return False

    def check(self):
        """Refuses a request before its body is read."""
        length = self.headers.get("Content-Length", "")
        if not hmac.compare_digest(self.path.encode("latin-1"), b"/" + self.server.endpoint.encode()):
            raise Refused(404, "there is no such endpoint, expected the one that the server has printed")
        if not length.isdecimal():
            raise Refused(411, "Content-Length: is missing")
        if int(length) > MOST_BYTES:
            raise Refused(413, "Content-Length: cannot use %s, expected at most %d bytes" % (length, MOST_BYTES))

    def refuse_unread(self, refused):
        """Answers, and then takes what the client still sends: a connection that is closed with a body unread is reset, and the client may
        not hear the answer."""
        self.send_error(refused.code, str(refused))
        self.connection.shutdown(socket.SHUT_WR)
        rest = MOST_BYTES
        try:
            while rest > 0 and (part := self.rfile.read1(1 << 16)):
                rest -= len(part)
        except OSError:
            pass  # it has sent nothing for `timeout`, or is gone

    def send_error(self, code, message=None, explain=None):
        self.send(code, "text/plain; charset=utf-8", ("%s\n" % (message or self.responses[code][0])).encode())

    def send(self, code, kind, content):
        self.send_response(code)
        for name, value in (("Content-Type", kind), ("Content-Length", str(len(content))), ("Connection", "close")):
            self.send_header(name, value)
        self.end_headers()
        self.wfile.write(content)

    def log_message(self, *_):
        """Nothing: the path is a secret."""


def numbers(text):
    return tuple(map(float, text.split(",")))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--port", type=int, default=8000, help="0: any that is free")
    parser.add_argument("--distortion", type=numbers, metavar="K1,K2,P1,P2[,K3[,K4,K5,K6]]",
                        help="of the robot's lens, as OpenCV has it, for all pictures: --distortion=-.2,.05,0,0")
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--environment", help="as of glim render, as in sky.hdr")
    parser.add_argument("--exposure", type=float, default=0.0, help="stops")
    given = parser.parse_args()
    glim.Camera(distortion=given.distortion)  # refuses what is none
    signal.signal(signal.SIGTERM, lambda *_: sys.exit())
    with tempfile.TemporaryDirectory(prefix="glim-") as folder, http.server.HTTPServer(("127.0.0.1", given.port), Handler) as server:
        server.camera = RobotCamera(folder, given.distortion, given.spp, given.environment, given.exposure)
        server.endpoint = secrets.token_urlsafe() + "/render"
        print('base_url="http://127.0.0.1:%d", render_endpoint="%s"' % (server.server_port, server.endpoint), flush=True)
        server.serve_forever()


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        pass
    except (glim.InputError, OSError) as error:
        sys.exit("serve_robot_camera.py: %s" % error)
