"""Tolerances and limits of nonlinear modes.

`NonlinearModeOptions` has them all. It is an argument of `nonlinear_mode`; what is computed from a mode later
takes those with which it was followed.
"""

from __future__ import annotations

from dataclasses import field

from fcm.frozen import Frozen


class LinearModeOptions(Frozen):
    """Where a mode begins.

    Attributes
    ----------
    rigid_tolerance : float
        Part of the greatest square of a frequency: rigid-body modes are below.
    contact_shares : tuple of float
        Shares of its springs that a contact which just touches may have in the mean: one guess for each.
    frequency_ratio : float
        Ratio of frequencies: modes this near to what the motion may come to are unknowns.
    """

    rigid_tolerance: float = 1e-12
    contact_shares: tuple[float, ...] = (0.5, 0.0, 1.0)
    frequency_ratio: float = 1.25


class ModeUnitOptions(Frozen):
    """Units of the unknowns, in which lengths along a mode are measured.

    Attributes
    ----------
    own_fraction, greatest_fraction : float
        Parts of its own greatest size so far, and of the greatest of all, that the unit of a displacement is
        at least.
    damping : float
        Unit of the damping ratio.
    damping_offset : float
        Added to the damping ratio where its change is judged: that of nearly nothing is rounding.
    max_log_amplitude : float
        ln a, beyond which nothing is calculated.
    """

    own_fraction: float = 0.1
    greatest_fraction: float = 1e-3
    damping: float = 0.1
    damping_offset: float = 0.05
    max_log_amplitude: float = 300.0


class ManyContactsOptions(Frozen):
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


class RestartOptions(Frozen):
    """How a mode is taken up again beyond a corner where its steps make no progress.

    Attributes
    ----------
    max_restarts : int
        Restarts of a mode.
    max_reports, min_progress : int, float
        Reports of progress, of 16 steps each, within which ln a has to move by that part of its span.
    end_fraction : float
        Part of the way to where steps make no progress, by which the part before ends short of that.
    restart_lengths : tuple of float
        Of the unit of ln a, by which the mode is taken up further on: the first that leads to a solution,
    max_distance_ratio : float
        which is no further away than so many times as much: another is none of this mode.
    """

    max_restarts: int = 12
    max_reports: int = 12
    min_progress: float = 1e-9
    end_fraction: float = 1e-6
    restart_lengths: tuple[float, ...] = (1e-6, 1e-5, 1e-4, 1e-3, 3e-3)
    max_distance_ratio: float = 30.0


class RoundingOptions(Frozen):
    """What of the damping is rounding.

    Attributes
    ----------
    last_digits : float
        Units of the last digit of float64 that a sum of forces may be off.
    """

    last_digits: float = 100.0


class TruncationOptions(Frozen):
    """At which points of a mode the error by the harmonics left out is estimated.

    Attributes
    ----------
    many_unknowns : int
        Unknowns with twice as many harmonics, from which on it is estimated at some of them, evenly
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


class NonlinearModeOptions(Frozen):
    """How a nonlinear mode is found, followed and judged.

    Attributes
    ----------
    linear, units, many, restart, rounding, truncation
        Of the parts, each of a class of its own.
    resonance : float
        Part of a step along the mode, to which a resonance is found.
    same_end : float
        Relative: what is sought is at an end of the mode where its value there is as near.
    """

    linear: LinearModeOptions = field(default_factory=LinearModeOptions)
    units: ModeUnitOptions = field(default_factory=ModeUnitOptions)
    many: ManyContactsOptions = field(default_factory=ManyContactsOptions)
    restart: RestartOptions = field(default_factory=RestartOptions)
    rounding: RoundingOptions = field(default_factory=RoundingOptions)
    truncation: TruncationOptions = field(default_factory=TruncationOptions)
    resonance: float = 1e-9
    same_end: float = 1e-9


NONLINEAR_MODE = NonlinearModeOptions()  # where nothing else is said
