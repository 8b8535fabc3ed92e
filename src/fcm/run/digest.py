"""SHA-256, loaded when it is first needed: it brings a library of its own, for checkpoints only."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from hashlib import _Hash


def sha256(data: bytes) -> _Hash:
    """The digest of some bytes, to be updated or read, see `hashlib`."""
    import hashlib

    return hashlib.sha256(data)
