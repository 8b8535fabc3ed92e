"""Tolerances and limits of reported results: jumps of slow sweeps, percentiles of random draws, peaks."""

from __future__ import annotations

from dataclasses import field

from fcm.frozen import Frozen


class JumpOptions(Frozen):
    """Options on jumps: when two points of a curve are the same, and when a change is not a jump.

    Attributes
    ----------
    amplitude_tolerance : float
        Relative difference of amplitudes at one frequency up to which they are the same point.
    branch_point_tolerance : float
        Difference of amplitudes, relative to the greatest, up to which the end of a stable branch lies on
        another branch.
    frequency_tolerance : float
        Relative difference of frequencies up to which they are the same.
    flip_tolerance : float
        Relative change of an amplitude, from the last point before a period doubling to the first after it,
        below which it is not a jump.
    """

    amplitude_tolerance: float = 1e-6
    branch_point_tolerance: float = 1e-4
    frequency_tolerance: float = 1e-13
    flip_tolerance: float = 0.01


class DrawOptions(Frozen):
    """Options on the results of random draws.

    Attributes
    ----------
    band_frequencies : int
        Number of frequencies at which the percentiles of a band are computed.
    frequency_tolerance : float
        Relative error of the frequency of a jump, by which it may be earlier; equal to the default accuracy.
    confidence : float
        Confidence of the intervals of percentiles; either tail has half of the rest.
    """

    band_frequencies: int = 600
    frequency_tolerance: float = 1e-2
    confidence: float = 0.9


class NetcdfOptions(Frozen):
    """Options on how variables are laid out in a netCDF file.

    Attributes
    ----------
    chunk : int
        [byte] Approximate size of the part of a variable of many curves that is written at a time.
    contiguous : int
        [byte] Size of a variable up to which it is not compressed, as compression would take longer than
        writing.
    """

    chunk: int = 1 << 20
    contiguous: int = 1 << 16


class ListedPeakOptions(Frozen):
    """Options on which local maxima of a curve are listed as peaks besides the highest.

    Attributes
    ----------
    least_share : float
        Amplitude of a local maximum, relative to the highest of its degree of freedom, below which it is not
        listed.
    least_prominence : float
        Rise above the curve on either side, relative to the height, below which a local maximum is a ripple.
    """

    least_share: float = 1e-3
    least_prominence: float = 0.01


class PointErrorOptions(Frozen):
    """Options on ranges of frequency whose errors of points are reported separately.

    Attributes
    ----------
    least_error : float
        Error of a point, relative to the greatest amplitude there, above which it belongs to such a range:
        ten times the default accuracy.
    least_width : float
        Width of a range, relative to its frequency, below which it is not reported. A shift of a flank by
        less than the default accuracy explains it.
    """

    least_error: float = 0.1
    least_width: float = 0.01


class ResultOptions(Frozen):
    """All options on reported results.

    Attributes
    ----------
    jumps, draws, file, peaks : JumpOptions, DrawOptions, NetcdfOptions, ListedPeakOptions
        Options of the parts.
    point_errors : PointErrorOptions
        Options of ranges with large errors of points.
    """

    jumps: JumpOptions = field(default_factory=JumpOptions)
    draws: DrawOptions = field(default_factory=DrawOptions)
    file: NetcdfOptions = field(default_factory=NetcdfOptions)
    peaks: ListedPeakOptions = field(default_factory=ListedPeakOptions)
    point_errors: PointErrorOptions = field(default_factory=PointErrorOptions)


RESULTS = ResultOptions()  # the defaults
