"""Files of what is not in a file: environment maps as arrays, lights and floors."""

import os
import shutil
import tempfile
import weakref

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


def texels_of(value):
    """A (height, width, 3) float32 copy of an array of radiance, of anything with the buffer protocol or __dlpack__; None of what is no
    such array, as a name or three numbers."""
    if isinstance(value, (str, bytes)):
        return None
    if hasattr(value, "__dlpack__") and not isinstance(value, numpy.ndarray):
        try:
            array = numpy.from_dlpack(value)
        except (BufferError, RuntimeError, TypeError):
            raise unusable("environment", value, "an array that numpy.from_dlpack takes") from None
    else:
        try:
            array = numpy.asarray(memoryview(value))
        except TypeError:
            return None
    if array.ndim == 1:
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
