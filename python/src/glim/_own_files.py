"""Files of what is not in a file: environment maps and images as arrays, lights and floors."""

import os
import shutil
import struct
import tempfile
import weakref
import zlib

import numpy

from glim._errors import unusable


class OwnFile:
    """A path in a folder of its own, both of which go with this object."""

    def __init__(self, name):
        folder = tempfile.mkdtemp(prefix="glim-")
        self._path = os.path.join(folder, name)
        weakref.finalize(self, _remove, folder, os.getpid())

    def __fspath__(self):
        return self._path


def _remove(folder, process):
    if os.getpid() == process:  # and not one that was forked from it
        shutil.rmtree(folder, ignore_errors=True)


def array_of(value, what):
    """An array of anything with the buffer protocol or __dlpack__; None of what has neither. `what`: names it in messages."""
    if hasattr(value, "__dlpack__") and not isinstance(value, numpy.ndarray):
        try:
            return numpy.from_dlpack(value)
        except (BufferError, RuntimeError, TypeError):
            raise unusable(what, value, "an array that numpy.from_dlpack takes") from None
    try:
        return numpy.asarray(memoryview(value))
    except TypeError:
        return None


def texels_of(value):
    """A (height, width, 3) float32 copy of an array of radiance; None of what is no such array, as a name or three numbers."""
    array = None if isinstance(value, (str, bytes)) else array_of(value, "environment")
    if array is None or array.ndim == 1:
        return None
    if array.ndim != 3 or array.shape[2] != 3 or 0 in array.shape or array.dtype.kind not in "fiu":
        raise unusable("environment", "%s %s" % (array.shape, array.dtype), "an array of (height, width, 3) numbers")
    with numpy.errstate(over="ignore"):
        texels = numpy.array(array, numpy.float32, order="C")
    if not (numpy.isfinite(texels) & (texels >= 0)).all():
        row, column, channel = numpy.argwhere(~(numpy.isfinite(texels) & (texels >= 0)))[0]
        raise unusable("environment[%d, %d, %d]" % (row, column, channel), array[row, column, channel].item(),
                       "a finite radiance of 0 or more", "out-of-range")
    return texels


def png_of(value):
    """A PNG file of pixels, as Image.replace takes them."""
    array = None if isinstance(value, (str, bytes)) else array_of(value, "pixels")
    if array is None:
        raise unusable("pixels", value, "an array")
    channels = 1 if array.ndim == 2 else array.shape[2] if array.ndim == 3 else 0
    if channels not in _PNG_KINDS or 0 in array.shape or array.dtype.kind != "u" or array.dtype.itemsize > 2:
        raise unusable("pixels", "%s %s" % (array.shape, array.dtype),
                       "uint8 or uint16 of (height, width), (height, width, 3) or (height, width, 4)")
    height, width = array.shape[:2]
    rows = numpy.ascontiguousarray(array, array.dtype.newbyteorder(">")).reshape(height, -1).view(numpy.uint8)
    filtered = numpy.zeros((height, 1 + rows.shape[1]), numpy.uint8)  # each row begins with its filter: 0 is none
    filtered[:, 1:] = rows
    header = struct.pack(">2I5B", width, height, 8 * array.dtype.itemsize, _PNG_KINDS[channels], 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + _chunk(b"IHDR", header) + _chunk(b"IDAT", zlib.compress(filtered, 1)) + _chunk(b"IEND", b"")


_PNG_KINDS = {1: 0, 3: 2, 4: 6}  # colour types of grey, RGB and RGBA by channels (PNG, third edition, 11.2.1)


def _chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
