"""Which connections may carry commands: Dask runs whatever it is sent."""

import ipaddress
import socket
import urllib.parse

from render_farm.errors import FarmError


def is_loopback(host):
    try:
        return all(ipaddress.ip_address(found[4][0]).is_loopback for found in socket.getaddrinfo(host, None))
    except OSError:
        return False


def is_private(address):
    """Whether nobody on a network can listen or send commands there."""
    parts = urllib.parse.urlsplit(address)
    return parts.scheme == "tls" or is_loopback(parts.hostname)


def check_network(options):
    """Whether nobody else can send commands. Refuses (FarmError, usage) connections to other machines without TLS, unless they are allowed."""
    if options.slurm:
        name, is_safe = "--slurm", bool(options.tls_ca)
    elif options.scheduler is not None:
        name, is_safe = "--scheduler %s" % options.scheduler, check_address(options)
    else:
        return True
    if not is_safe and not options.insecure:
        raise FarmError("%s: anyone on the network could run programs on this machine and on the workers; expected %s or --insecure"
                        % (name, "tls://" if options.scheduler else "--tls-ca, --tls-cert and --tls-key"), 2)
    return is_safe


def check_address(options):
    """Whether the scheduler's address is private. Refuses (FarmError, usage) one that does not go with the other options."""
    address = options.scheduler
    parts = urllib.parse.urlsplit(address)
    if parts.scheme not in ("tcp", "tls") or not parts.hostname:
        raise FarmError("--scheduler %s: expected an address such as tls://head:8786" % address, 2)
    if parts.scheme == "tls" and not options.tls_ca:
        raise FarmError("--scheduler %s: expected --tls-ca, --tls-cert and --tls-key" % address, 2)
    if parts.scheme == "tcp" and options.tls_ca:
        raise FarmError("--scheduler %s: expected tls://, since there are certificates" % address, 2)
    return is_private(address)
