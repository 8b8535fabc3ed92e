"""Tolerances and limits of comparisons of methods."""

from __future__ import annotations

from dataclasses import field

from fcm.frozen import Frozen


class ChainOptions(Frozen):
    """Options on how finely a line is drawn for its distance from another.

    Attributes
    ----------
    chain_points : int
        Approximate number of points of the fine line.
    max_fineness, min_fineness : int
        Most and fewest of these points between two neighbours of the line.
    distinct_length : float
        Distance up to which two neighbours are one point.
    """

    chain_points: int = 4000
    max_fineness: int = 16
    min_fineness: int = 3
    distinct_length: float = 1e-13


class ExactLineOptions(Frozen):
    """Options on how curves of the exact motion are calculated for a comparison.

    Attributes
    ----------
    limit : float
        [s] Processor time of a curve, after which it is stopped.
    peak : float
        Relative error of the frequency of a peak.
    jump : float
        Relative change of amplitude from which on a solution near a peak is on another branch.
    """

    limit: float = 60.0
    peak: float = 1e-8
    jump: float = 0.2


class StartupOptions(Frozen):
    """Options on how the start of a program is timed.

    Attributes
    ----------
    repeats : int
        Number of starts, of which the fastest counts; with 0 none is timed.
    timeout : float
        [s] Time after which a start is given up and its time is unknown.
    """

    repeats: int = 2
    timeout: float = 60.0


class CompareOptions(Frozen):
    """Options on how methods are compared.

    Attributes
    ----------
    chain, exact, startup : ChainOptions, ExactLineOptions, StartupOptions
        Options of the parts.
    margin : float
        Ratio of the least error that is shown to the reference's own error.
    steps, exact_steps : tuple of float
        Longest steps of the runs, relative to that of the scene, for harmonic balance and for the exact
        motion, whose points are exact with any step.
    finest_step, finest_exact_step : float
        Longest steps of the two references, relative to that of the scene.
    floor, exact_floor : float
        Relative errors to which points of the two references are solved and their peaks located.
    """

    chain: ChainOptions = field(default_factory=ChainOptions)
    exact: ExactLineOptions = field(default_factory=ExactLineOptions)
    startup: StartupOptions = field(default_factory=StartupOptions)
    margin: float = 10.0
    steps: tuple[float, ...] = (4.0, 2.0, 1.0, 0.5, 0.25)
    exact_steps: tuple[float, ...] = (2.0, 1.0)
    finest_step: float = 1.0 / 16.0
    finest_exact_step: float = 0.25
    floor: float = 1e-9
    exact_floor: float = 1e-8


COMPARE = CompareOptions()  # the defaults
