"""Tolerances and limits of nonlinear modes.

`NonlinearModeOptions` has them all. It is an argument of `nonlinear_mode`; what is computed from a mode later
takes those with which it was followed.
"""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass(frozen=True)
class LinearModeOptions:
    """Where a mode begins.

    Attributes
    ----------
    rigid : float
        Part of the greatest square of a frequency: rigid-body modes are below.
    halves : tuple of float
        Shares of its springs that a contact which just touches may have in the mean: one guess for each.
    near : float
        Ratio of frequencies: modes this near to what the motion may come to are unknowns.
    """

    rigid: float = 1e-12
    halves: tuple[float, ...] = (0.5, 0.0, 1.0)
    near: float = 1.25


@dataclass(frozen=True)
class ModeUnitOptions:
    """Units of the unknowns, in which lengths along a mode are measured.

    Attributes
    ----------
    own, greatest : float
        Parts of its own greatest size so far, and of the greatest of all, that the unit of a displacement is
        at least.
    damping : float
        Unit of the damping ratio.
    little : float
        Added to the damping ratio where its change is judged: that of nearly nothing is rounding.
    far : float
        ln a, beyond which nothing is calculated.
    """

    own: float = 0.1
    greatest: float = 1e-3
    damping: float = 0.1
    little: float = 0.05
    far: float = 300.0


@dataclass(frozen=True)
class ManyContactsOptions:
    """How a mode of many contacts is followed: by steps of nearly ln a, past the corners of single contacts.

    Each contact that begins to slip turns its mean displacement like a root. Most of them turn frequency and
    damping by nothing that matters.

    Attributes
    ----------
    min_contacts : int
        Contacts from which on no corner is looked for,
    unit_factor : float
        and the units of all unknowns but ln a are so many times as large.
    """

    min_contacts: int = 16
    unit_factor: float = 100.0


@dataclass(frozen=True)
class RestartOptions:
    """How a mode is taken up again beyond a corner where its steps lead nowhere.

    Attributes
    ----------
    most : int
        Restarts of a mode.
    calls, moved : int, float
        Reports of progress, of 16 steps each, within which ln a has to move by that part of its span.
    short : float
        Part of the way to where steps lead nowhere, by which the part before ends short of that.
    further : tuple of float
        Of the unit of ln a, by which the mode is taken up further on: the first that leads to a solution,
    near : float
        which is no further away than so many times as much: another is none of this mode.
    """

    most: int = 12
    calls: int = 12
    moved: float = 1e-9
    short: float = 1e-6
    further: tuple[float, ...] = (1e-6, 1e-5, 1e-4, 1e-3, 3e-3)
    near: float = 30.0


@dataclass(frozen=True)
class RoundingOptions:
    """What of the damping is rounding.

    Attributes
    ----------
    last_digits : float
        Units of the last digit of float64 that a sum of forces may be off.
    """

    last_digits: float = 100.0


@dataclass(frozen=True)
class TruncationOptions:
    """At which points of a mode the error by the harmonics left out is told.

    Attributes
    ----------
    many_unknowns : int
        Unknowns with twice as many harmonics, from which on it is not told at all of them but at some, evenly
        spread, of which the last is one:
    min_points : int
        at so many of them or more,
    time_fraction : float
        as many as take this part of the time of the mode, which grows as the cube of the unknowns.
    damping_floor : float
        Damping ratio: errors of a smaller one are relative to this.
    """

    many_unknowns: int = 500
    min_points: int = 2
    time_fraction: float = 0.5
    damping_floor: float = 1e-6


@dataclass(frozen=True)
class NonlinearModeOptions:
    """How a nonlinear mode is found, followed and judged.

    Attributes
    ----------
    linear, units, many, restart, rounding, truncation
        Of the parts, each of a class of its own.
    resonance : float
        Part of a step along the mode, to which a resonance is found.
    """

    linear: LinearModeOptions = field(default_factory=LinearModeOptions)
    units: ModeUnitOptions = field(default_factory=ModeUnitOptions)
    many: ManyContactsOptions = field(default_factory=ManyContactsOptions)
    restart: RestartOptions = field(default_factory=RestartOptions)
    rounding: RoundingOptions = field(default_factory=RoundingOptions)
    truncation: TruncationOptions = field(default_factory=TruncationOptions)
    resonance: float = 1e-9


NONLINEAR_MODE = NonlinearModeOptions()  # where nothing else is said
