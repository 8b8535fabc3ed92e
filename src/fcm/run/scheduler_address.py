"""Check quickly whether an address can be that of a scheduler, and whether anything listens there.

The host name is looked up and the connection made in a separate thread, because signals interrupt neither.
The main thread waits for that thread; a signal ends the wait at once.
"""

from __future__ import annotations

import ipaddress
import re
import socket
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from typing import Any

from fcm.run.options import RUN

SCHEMES = ("tcp", "tls", "ucx", "ws", "wss")
LATE = TimeoutError("no answer in time")
_FORM = re.compile(r"(?:(?P<scheme>[a-z]+)://)?(?:\[(?P<six>[^\]]+)\]|(?P<host>[^:/@\s]+)):(?P<port>\d{1,9})")


def answering(address: str, until: float) -> str:
    """Why no scheduler can answer at an address; empty if something listens there.

    Parameters
    ----------
    until : float
        The end of the wait, a time of `time.monotonic`.
    """
    found = _FORM.fullmatch(address.strip().rstrip("/"))
    if found is None or (found["scheme"] or "tcp") not in SCHEMES:
        return "an address is such as tcp://127.0.0.1:8786"
    host, port = found["six"] or found["host"], int(found["port"])
    if not 0 < port < 65536:
        return f"a port is from 1 to 65535, is {port}"
    if fault := unfit_host(host):
        return fault
    _, error = within(lambda: _listens(host, port, until), until)
    if error is LATE:
        return f"{host} was not reached in time"
    if isinstance(error, socket.gaierror):
        return f"there is no host {host}"
    if isinstance(error, ConnectionRefusedError):
        return "nothing listens there"
    return "" if error is None else (getattr(error, "strerror", None) or str(error))


def unfit_host(host: str) -> str:
    """Why no program can listen at a host, from its number only; empty for names and all other hosts.

    >>> unfit_host("255.255.255.255"), unfit_host("127.0.0.1"), unfit_host("node7")
    ('255.255.255.255 is the address of no single host', '', '')
    >>> unfit_host("::1"), unfit_host("::ffff:127.0.0.1"), unfit_host("ff02::1")
    ('', '', 'ff02::1 is the address of no single host')
    >>> unfit_host("127.0.0.300")
    '127.0.0.300 is no address: each of its four numbers is 255 at most'
    """
    if re.fullmatch(r"\d+(\.\d+){3}", host) and any(int(part) > 255 for part in host.split(".")):
        return f"{host} is no address: each of its four numbers is 255 at most"
    with suppress(ValueError):
        number = ipaddress.ip_address(host)
        number = getattr(number, "ipv4_mapped", None) or number
        reserved = number.is_reserved and not number.is_loopback  # as the standard library has ::1
        if number.is_multicast or reserved or number == ipaddress.IPv4Address("255.255.255.255"):
            return f"{host} is the address of no single host"
    return ""


def _listens(host: str, port: int, until: float) -> None:
    with socket.create_connection((host, port), max(until - time.monotonic(), RUN.answer_interval)):
        pass


def within(call: Callable[[], Any], until: float) -> tuple[Any, BaseException | None]:
    """Result and exception of a call run in a thread; LATE if it has not ended by the time `until`.

    The thread then goes on as a daemon, which does not keep the process alive.
    """
    found: list[Any] = [None, LATE]

    def run() -> None:
        try:
            found[:] = call(), None
        except BaseException as error:
            found[:] = None, error

    thread = threading.Thread(target=run, daemon=True)
    thread.start()
    while thread.is_alive() and time.monotonic() < until:
        thread.join(RUN.answer_interval)
    return found[0], found[1]
