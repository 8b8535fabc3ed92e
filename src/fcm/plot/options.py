"""Plot: tolerances and limits."""

from __future__ import annotations

from fcm.frozen import Frozen


class ReadOptions(Frozen):
    """Limits of files that are read, and of messages about them."""

    dofs_named: int = 12  # degrees of freedom in a message
    contacts_named: int = 10  # contacts that a message lists
    same_level: float = 1e-9  # relative: levels, and places along a curve, that are one
    # times the damping at both ends: where the greatest is between them, it is more
    higher_fraction: float = 1.0 + 1e-6
    max_bytes: float = 1e100  # no result is as large, in whatever units: such a number was not written as one
    # [s] of processor time for a file; a damaged one may lead the library round in a circle
    seconds: float = 20.0
    seconds_of_megabyte: float = 1.0  # [s] more for each megabyte of the file


READ = ReadOptions()
