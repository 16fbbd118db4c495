"""What glim raises."""


class InputError(ValueError):
    """A file or an option that cannot be used, in one sentence: which one, what it is, and what was expected."""


class DeviceError(RuntimeError):
    """Vulkan or its device failed or is missing, in one sentence."""
