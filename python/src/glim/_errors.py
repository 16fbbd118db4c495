"""What glim raises."""


class _Message:
    """One sentence. `id` says what kind of sentence it is, as in "file-missing" or "out-of-range", and stays when the sentence is written
    better. `file`, `place` (in it, or an option), `value` and `expected` are what it names, or None."""

    def __init__(self, sentence, id="wrong-type", file=None, place=None, value=None, expected=None):
        super().__init__(sentence)
        self.id, self.file, self.place, self.value, self.expected = id, file, place, value, expected


class InputError(_Message, ValueError):
    """A file or an option that cannot be used, in one sentence: which one, what it is, and what was expected."""


def unusable(name, value, expected, id="wrong-type"):
    """The InputError for an argument with this value."""
    return InputError("%s: cannot use %r, expected %s" % (name, value, expected), id, place=name,
                      value=value if isinstance(value, str) else repr(value), expected=expected)


class DeviceError(_Message, RuntimeError):
    """Vulkan or its device failed or is missing, in one sentence."""


def library_missing(error):
    """The DeviceError for what the dynamic linker says of Vulkan's loader, or of a library that comes with its drivers."""
    return DeviceError("A library of the system is missing (%s); Debian has Vulkan's loader, a software device and what both need: "
                       "apt-get install libvulkan1 mesa-vulkan-drivers" % error, id="library-missing")


class GlimWarning(_Message, UserWarning):
    """Something may make a picture other than its user expects."""
