"""Records in a file that grows at its end; truncated or changed records are skipped."""

from __future__ import annotations

import io
import mmap
import pickle
import struct
from collections.abc import Iterable, Iterator
from typing import Any, NamedTuple

from fcm.run.digest import sha256

START = b"\nfcm rec"
_HEAD = struct.Struct("<8s32sqq32s")  # start, fingerprint, number, length, seal
_NUMPY = {
    ("numpy", "ndarray"),
    ("numpy", "dtype"),
    ("numpy._core.multiarray", "_reconstruct"),
    ("numpy.core.multiarray", "_reconstruct"),
    ("numpy._core.numeric", "_frombuffer"),
    ("numpy.core.numeric", "_frombuffer"),
    ("numpy._core.multiarray", "scalar"),
    ("numpy.core.multiarray", "scalar"),
}


class Record(NamedTuple):
    """A number, the bytes of its results, and the fingerprint of what they depend on, sealed together."""

    fingerprint: bytes
    number: int
    payload: bytes


def packed(record: Record) -> bytes:
    """The bytes that a record takes in a file."""
    mark, number, payload = record
    return _HEAD.pack(START, mark, number, len(payload), _seal(record)) + payload


def _seal(record: Record) -> bytes:
    return sha256(record.fingerprint + struct.pack("<q", record.number) + record.payload).digest()


def whole(descriptor: int, size: int, begin: int) -> Iterator[Record]:
    """Yield the intact records of a file of a size, from the offset `begin` on."""
    if size <= begin:
        return
    with mmap.mmap(descriptor, size, access=mmap.ACCESS_READ) as data:
        at = data.find(START, begin)
        while 0 <= at <= size - _HEAD.size:
            _, mark, number, length, seal = _HEAD.unpack_from(data, at)
            end = at + _HEAD.size + length
            if 0 <= length and end <= size:
                record = Record(mark, number, data[at + _HEAD.size : end])
                if _seal(record) == seal:
                    yield record
                    at = data.find(START, end)
                    continue
            at = data.find(START, at + 1)


def unpacked(payload: bytes, kinds: Iterable[type]) -> Any:
    """The results of a record; None if it holds anything but arrays, plain values and these kinds."""
    try:
        return _Reader(payload, kinds).load()
    except Exception:  # a damaged or forged pickle may raise anything
        return None


class _Reader(pickle.Unpickler):
    """Unpickler that loads only the allowed types, so that a forged file cannot run code."""

    def __init__(self, payload: bytes, kinds: Iterable[type]) -> None:
        super().__init__(io.BytesIO(payload))
        self.allowed = _NUMPY | {(kind.__module__, kind.__qualname__) for kind in kinds}

    def find_class(self, module: str, name: str) -> Any:
        if (module, name) in self.allowed:
            return super().find_class(module, name)
        raise pickle.UnpicklingError(f"{module}.{name} does not belong in a result")
