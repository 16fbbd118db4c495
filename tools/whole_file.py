"""Files that are there whole or not at all."""

import contextlib
import os
import shutil


def sync_folder(path):
    descriptor = os.open(path or ".", os.O_RDONLY | os.O_DIRECTORY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def publish(new, path):
    """Gives the file `new` the name `path`, or that of the file to which `path` is a link. It keeps the mode of a file that was there."""
    path = os.path.realpath(path)
    with contextlib.suppress(FileNotFoundError):
        shutil.copymode(path, new)
    os.replace(new, path)
    sync_folder(os.path.dirname(path))


def write_whole(path, content):
    """Writes the whole file or, with OSError that names it, nothing."""
    folder, name = os.path.split(os.path.realpath(path))
    partial = os.path.join(folder, ".glim-%s.partial" % name)
    try:
        with contextlib.suppress(FileNotFoundError):
            os.unlink(partial)  # of a killed process
        with open(partial, "xb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        publish(partial, path)
    except OSError as error:
        with contextlib.suppress(OSError):
            os.unlink(partial)
        raise OSError(error.errno, error.strerror, path) from error
