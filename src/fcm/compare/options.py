"""Tolerances and limits of comparisons of methods."""

from __future__ import annotations

from dataclasses import field

from fcm.frozen import Frozen


class ChainOptions(Frozen):
    """How finely a line is drawn for its distance from another.

    Attributes
    ----------
    chain_points : int
        Of the fine chain, about.
    max_fineness, min_fineness : int
        Points on a piece between two neighbours, at most and at least.
    distinct_length : float
        Distance below which two neighbours are one point.
    """

    chain_points: int = 4000
    max_fineness: int = 16
    min_fineness: int = 3
    distinct_length: float = 1e-13


class ExactLineOptions(Frozen):
    """Curves of the exact motion.

    Attributes
    ----------
    limit : float
        [s] of processor time for a curve.
    peak : float
        Relative, to which the frequency of a peak is located.
    jump : float
        Relative change of amplitude from which on a solution near a peak is one of another branch.
    """

    limit: float = 60.0
    peak: float = 1e-8
    jump: float = 0.2


class StartupOptions(Frozen):
    """How the start of a program is timed.

    Attributes
    ----------
    repeats : int
        Of which the faster counts; with 0 none is timed.
    timeout : float
        [s] after which the time is not known.
    """

    repeats: int = 2
    timeout: float = 60.0


class CompareOptions(Frozen):
    """How methods are compared.

    Attributes
    ----------
    chain, exact, startup : ChainOptions, ExactLineOptions, StartupOptions
        Of the parts.
    margin : float
        A shown error is at least this many times the reference's own.
    steps, exact_steps : tuple of float
        Longest steps of the runs, in those of the scene: of harmonic balance, and of the exact motion, whose
        points are exact with any.
    finest_step, finest_exact_step : float
        The same of the references.
    floor, exact_floor : float
        Relative, to which points of a reference are solved and its peaks located.
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


COMPARE = CompareOptions()  # where nothing else is said
