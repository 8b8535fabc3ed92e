"""Plot: tolerances and limits."""

from __future__ import annotations

from fcm.frozen import Frozen


class ReadOptions(Frozen):
    """Limits of files that are read, and of messages about them."""

    dofs_named: int = 12  # most degrees of freedom that a message names
    contacts_named: int = 10  # most contacts that a message lists
    values_named: int = 6  # most values of a swept quantity that a message lists
    # relative difference of levels, and of places along a curve, up to which they are the same
    same_level: float = 1e-9
    # ratio of the greatest damping to that at the ends of a mode, above which it lies between them
    higher_fraction: float = 1.0 + 1e-6
    # size of a number above which it was not written as one: no result is as large, in whatever units
    max_number: float = 1e100
    # [s] processor time for reading a file; a damaged one may lead the library round in a circle
    seconds: float = 20.0
    seconds_of_megabyte: float = 1.0  # [s] further time for each megabyte of the file


READ = ReadOptions()
