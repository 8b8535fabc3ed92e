"""Tolerances and limits of what is reported of curves: jumps of slow sweeps, percentiles of random draws."""

from __future__ import annotations

from dataclasses import field

from fcm.frozen import Frozen


class JumpOptions(Frozen):
    """When points of a curve are one, and what is no jump.

    Attributes
    ----------
    amplitude_tolerance : float
        Relative difference of amplitudes at one frequency that are one point.
    frequency_tolerance : float
        Relative difference of frequencies that are one.
    flip_tolerance : float
        Relative change of an amplitude, from the last point before the period doubles to the first after it:
        less is no jump.
    """

    amplitude_tolerance: float = 1e-6
    frequency_tolerance: float = 1e-13
    flip_tolerance: float = 0.01


class DrawOptions(Frozen):
    """What is reported of random draws.

    Attributes
    ----------
    band_frequencies : int
        Frequencies at which the percentiles of a band are taken.
    frequency_tolerance : float
        Relative: to this the frequency of a jump is known that may be so much earlier. It is the default
        accuracy.
    """

    band_frequencies: int = 600
    frequency_tolerance: float = 1e-2


class FileOptions(Frozen):
    """How variables are laid out in a netCDF file.

    Attributes
    ----------
    chunk : int
        [byte] of a variable of many curves that are made and written at a time, about.
    contiguous : int
        [byte] of a variable up to which to compress it takes longer than to write it.
    """

    chunk: int = 1 << 20
    contiguous: int = 1 << 16


class PeakOptions(Frozen):
    """Which local maxima of a curve are peaks that are listed beside the highest.

    Attributes
    ----------
    least_share : float
        Of the highest amplitude of the degree of freedom: lower ones are not listed.
    least_prominence : float
        Relative to its height: what rises by less above the curve on either side is a ripple.
    """

    least_share: float = 1e-3
    least_prominence: float = 0.01


class ResultOptions(Frozen):
    """What is reported of curves.

    Attributes
    ----------
    jumps, draws, file, peaks : JumpOptions, DrawOptions, FileOptions, PeakOptions
        Of the parts.
    """

    jumps: JumpOptions = field(default_factory=JumpOptions)
    draws: DrawOptions = field(default_factory=DrawOptions)
    file: FileOptions = field(default_factory=FileOptions)
    peaks: PeakOptions = field(default_factory=PeakOptions)


RESULTS = ResultOptions()  # where nothing else is said
