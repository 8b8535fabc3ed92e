"""Tolerances and limits of nonlinear modes.

`NonlinearModeOptions` has them all. It is an argument of `nonlinear_mode`. Later computations with a mode
take the options with which it was followed.
"""

from __future__ import annotations

from dataclasses import field

from fcm.frozen import Frozen


class LinearModeOptions(Frozen):
    """Options on the linear start of a mode.

    Attributes
    ----------
    rigid_tolerance : float
        Square of a frequency, relative to the greatest, up to which the mode counts as a rigid-body mode.
    contact_shares : tuple of float
        Mean shares of its springs that a contact that just touches may have: one guess of the mode for each.
    frequency_ratio : float
        Ratio of a mode's frequency to those that the motion may reach, up to which the mode's Q is an
        unknown.
    """

    rigid_tolerance: float = 1e-12
    contact_shares: tuple[float, ...] = (0.5, 0.0, 1.0)
    frequency_ratio: float = 1.25


class ModeUnitOptions(Frozen):
    """Units of the unknowns, in which lengths along a mode are measured.

    Attributes
    ----------
    own_fraction, greatest_fraction : float
        Least unit of a displacement, relative to its own greatest size so far, and relative to the greatest
        size of all.
    damping : float
        Unit of the damping ratio.
    damping_offset : float
        Number added to the damping ratio where its relative change is judged, as the change of a very small
        one is rounding.
    max_log_amplitude : float
        Size to which ln a is limited when the amplitude is computed.
    """

    own_fraction: float = 0.1
    greatest_fraction: float = 1e-3
    damping: float = 0.1
    damping_offset: float = 0.05
    max_log_amplitude: float = 300.0


class ManyContactsOptions(Frozen):
    """Options on how a mode of many contacts is followed.

    Steps are nearly those of ln a, and pass over the corners of single contacts. The mean displacement of a
    contact that begins to slip changes like a root, but most contacts hardly change frequency and damping.

    Attributes
    ----------
    min_contacts : int
        Number of contacts from which on corners are not located.
    unit_factor : float
        Factor on the units of all unknowns but ln a with so many contacts.
    """

    min_contacts: int = 16
    unit_factor: float = 100.0


class RestartOptions(Frozen):
    """Options on how a mode is restarted beyond a corner where its steps make no progress.

    Attributes
    ----------
    max_restarts : int
        Most restarts of a mode.
    max_reports, min_progress : int, float
        Most reports in a row, of 16 steps each, without progress; and the change of ln a from one report to
        the next, relative to its span, below which there is none.
    end_fraction : float
        Distance of the end of the first part from where steps make no progress, relative to its length.
    restart_lengths : tuple of float
        Distances in ln a, in its unit, at which a restart is tried, in turn, until a solution is found.
    max_distance_ratio : float
        Distance of that solution from its guess, relative to the distance in ln a, from which on it does not
        belong to this mode.
    """

    max_restarts: int = 12
    max_reports: int = 12
    min_progress: float = 1e-9
    end_fraction: float = 1e-6
    restart_lengths: tuple[float, ...] = (1e-6, 1e-5, 1e-4, 1e-3, 3e-3)
    max_distance_ratio: float = 30.0


class RoundingOptions(Frozen):
    """Options on the rounding of the damping ratio.

    Attributes
    ----------
    last_digits : float
        Error of a sum of forces, in units of the last digit of float64.
    """

    last_digits: float = 100.0


class TruncationOptions(Frozen):
    """Options on the points of a mode at which the error by the harmonics left out is estimated.

    Attributes
    ----------
    many_unknowns : int
        Number of unknowns with twice as many harmonics, from which on the error is estimated only at some
        evenly spread points, including the last one.
    min_points : int
        Least number of these points.
    time_fraction : float
        Time for these points, relative to that of the mode, which sets their number. The time for a point
        grows as the cube of the unknowns.
    damping_floor : float
        Damping ratio to which the error is relative if the mode's greatest one is smaller.
    """

    many_unknowns: int = 500
    min_points: int = 2
    time_fraction: float = 0.5
    damping_floor: float = 1e-6


class NonlinearModeOptions(Frozen):
    """Options on how a nonlinear mode is found, followed and judged.

    Attributes
    ----------
    linear, units, many, restart, rounding, truncation
        Options of the parts, see the class of each.
    resonance : float
        Error of the place of a resonance, relative to the step along the mode.
    same_end : float
        Relative difference of a value from that at an end of the mode, up to which the point sought is that
        end.
    shared_power : float
        Share of further harmonics in the power of the negative damping, above which the mode counts as at an
        internal resonance.
    """

    linear: LinearModeOptions = field(default_factory=LinearModeOptions)
    units: ModeUnitOptions = field(default_factory=ModeUnitOptions)
    many: ManyContactsOptions = field(default_factory=ManyContactsOptions)
    restart: RestartOptions = field(default_factory=RestartOptions)
    rounding: RoundingOptions = field(default_factory=RoundingOptions)
    truncation: TruncationOptions = field(default_factory=TruncationOptions)
    resonance: float = 1e-9
    same_end: float = 1e-9
    shared_power: float = 0.05


NONLINEAR_MODE = NonlinearModeOptions()  # the defaults
