"""Frames between a process and its workers: a letter, a length and that many bytes."""

from __future__ import annotations

import struct
from typing import BinaryIO

WORK, BATCH, STOP = b"w", b"b", b"s"  # to a worker
PROGRESS, STATE, RESULT = b"p", b"t", b"r"  # from it
SHARE = struct.Struct("<d")
_HEAD = struct.Struct("<cq")


def send(stream: BinaryIO, kind: bytes, data: bytes = b"") -> None:
    """Write a frame; BrokenPipeError if nobody reads any more."""
    stream.write(_HEAD.pack(kind, len(data)) + data)
    stream.flush()


def receive(stream: BinaryIO) -> tuple[bytes, bytes] | None:
    """The next frame; None if the other side has ended."""
    head = stream.read(_HEAD.size)
    if len(head) < _HEAD.size:
        return None
    kind, length = _HEAD.unpack(head)
    data = stream.read(length)
    return (kind, data) if len(data) == length else None
