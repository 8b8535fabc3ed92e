"""SHA-256, imported on first use: only checkpoints need it, and it loads a library of its own."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from hashlib import _Hash


def sha256(data: bytes) -> _Hash:
    """The SHA-256 object of some bytes, see `hashlib`."""
    import hashlib

    return hashlib.sha256(data)
