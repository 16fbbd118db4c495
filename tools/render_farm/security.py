"""Which connections may carry commands: Dask runs whatever it is sent."""

import urllib.parse

from render_farm.errors import FarmError


def is_private(address):
    """Whether nobody else can send commands there. On loopback that is every user of the machine."""
    return address.startswith("tls://")


def check_network(options):
    """Whether nobody else can send commands. Refuses (FarmError, usage) a scheduler without TLS, unless it is allowed."""
    is_safe = options.scheduler is None or check_address(options)
    if not is_safe and not options.insecure:
        raise FarmError("--scheduler %s: anyone who reaches it could run programs on this machine and on the workers; expected tls:// "
                        "or --insecure" % options.scheduler, 2)
    return is_safe


def check_address(options):
    """Whether the scheduler's address is private. Refuses (FarmError, usage) one that does not go with the other options."""
    address = options.scheduler
    try:
        parts = urllib.parse.urlsplit(address)
        is_address = parts.scheme in ("tcp", "tls") and parts.hostname and parts.port
    except ValueError:  # of a port or a bracket
        is_address = False
    if not is_address:
        raise FarmError("--scheduler %s: expected an address such as tls://head:8786" % address, 2)
    if parts.scheme == "tls" and not options.tls_ca:
        raise FarmError("--scheduler %s: expected --tls-ca, --tls-cert and --tls-key" % address, 2)
    if parts.scheme == "tcp" and options.tls_ca:
        raise FarmError("--scheduler %s: expected tls://, since there are certificates" % address, 2)
    return is_private(address)
