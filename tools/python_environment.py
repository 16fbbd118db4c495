#!/usr/bin/env python3
"""Makes build/python, where the build finds what the module for Python needs from PyPI. Run by tools/setup.sh."""

import sys

sys.dont_write_bytecode = True  # beside the sources it would look like a change to build

from conversion.environment import Environment  # noqa: E402
from conversion.errors import ConversionError  # noqa: E402

ENVIRONMENT = Environment("python", ["nanobind==3.1.0", "nanobind-backend==1.0.0", "numpy==2.2.6"])

if __name__ == "__main__":
    try:
        ENVIRONMENT.ensure(print)
    except ConversionError as error:
        sys.exit("no module for Python: %s" % error)
