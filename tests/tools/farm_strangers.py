"""What another user of the machine meets: sockets of a farm that listen, and what they answer to who has no certificate of the farm."""

import asyncio
import contextlib
import os
import socket
import ssl
import struct

import distributed
from distributed.comm import connect

LISTENS = "0A"  # a state in /proc/net/tcp
ACCEPTS = 0x10000  # a flag in /proc/net/unix
TIMEOUT = 10
TLS_ALERT = 0x15


def family_of(pid):
    """A process and its descendants."""
    found = [pid]
    with contextlib.suppress(FileNotFoundError, ProcessLookupError):  # of one that ends now
        for task in os.listdir("/proc/%d/task" % pid):
            with open("/proc/%d/task/%s/children" % (pid, task), encoding="ascii") as children:
                for child in map(int, children.read().split()):
                    found += family_of(child)
    return found


def sockets_of(pids):
    """The inodes of their sockets."""
    inodes = set()
    for pid in pids:
        for name in os.listdir("/proc/%d/fd" % pid):
            try:
                target = os.readlink("/proc/%d/fd/%s" % (pid, name))
            except FileNotFoundError:
                continue
            if target.startswith("socket:["):
                inodes.add(target[8:-1])
    return inodes


def read_table(name):
    with open("/proc/net/" + name, encoding="utf-8") as table:
        return [line.split() for line in table][1:]


def listening(pid):
    """The addresses (host, port) at which a process or its descendants listen, and the names of unix sockets at which they do."""
    inodes, found, unix = sockets_of(family_of(pid)), set(), set()
    for table, family in (("tcp", socket.AF_INET), ("tcp6", socket.AF_INET6)):
        for row in read_table(table):
            if row[3] == LISTENS and row[9] in inodes:
                host, _, port = row[1].partition(":")
                words = struct.unpack(">%dI" % (len(host) // 8), bytes.fromhex(host))
                found.add((socket.inet_ntop(family, struct.pack("=%dI" % len(words), *words)), int(port, 16)))
    for row in read_table("unix"):
        if int(row[3], 16) & ACCEPTS and row[6] in inodes:
            unix.add(row[7] if len(row) > 7 else "unnamed")
    return found, unix


def answer_to(place, request):
    """What a socket says to these bytes, until it closes the connection."""
    with socket.create_connection(place, TIMEOUT) as connection:
        try:
            connection.sendall(request)
            return connection.recv(1 << 16)
        except ConnectionError:
            return b""


def answer_over_tls(place, request):
    """The same over TLS, for a client that has no certificate and believes everyone."""
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
    with socket.create_connection(place, TIMEOUT) as connection:
        try:
            with context.wrap_socket(connection) as wrapped:
                wrapped.sendall(request)
                return wrapped.recv(1 << 16)
        except (ConnectionError, ssl.SSLError):
            return b""


async def speaks_dask(address, security):
    try:
        comm = await connect(address, timeout=TIMEOUT, **security.get_connection_args("client"))
    except OSError:
        return False
    await comm.close()
    return True


def open_to_strangers(place):
    """Why a stranger gets more than a refusal there, or None."""
    request = b"GET /info/main/workers.html HTTP/1.0\r\n\r\n"
    plain = answer_to(place, request)
    if plain and plain[0] != TLS_ALERT:
        return "it answers %r" % plain[:80]
    if said := answer_over_tls(place, request):
        return "it answers %r over TLS to who has no certificate" % said[:80]
    where = "%s:%d" % (place[0] if "." in place[0] else "[%s]" % place[0], place[1])
    for scheme, security in (("tcp://", distributed.Security()), ("tls://", distributed.Security.temporary())):
        if asyncio.run(speaks_dask(scheme + where, security)):
            return "it takes commands from %s" % ("anyone" if scheme == "tcp://" else "who has another certificate")
    return None
