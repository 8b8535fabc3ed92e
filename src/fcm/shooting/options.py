"""Tolerances and limits of the exact periodic motions, and of the search for their branches.

`ShootingOptions` has them all. It is a field of `OrbitProblem`, and an argument elsewhere.
"""

from __future__ import annotations

from fcm.continuation.options import SIGN_CHANGE, SignChangeOptions
from fcm.frozen import Frozen
from fcm.stability.options import STABILITY, StabilityOptions


class ClosureOptions(Frozen):
    """Options of Newton's method on the closure of a period, x(T) - x(0) = 0.

    Attributes
    ----------
    tolerance : float
        Closure error of the period, relative to the size of the motion, up to which it counts as periodic.
    max_iterations : int
        Most Newton steps.
    min_step : float
        Factor on a Newton step down to which it is shortened; below it the method has diverged.
    rank_tolerance : float
        Singular value, relative to the greatest, below which the closure does not change along a direction,
        as where a contact never slips.
    min_return : float
        Distance of a multiplier from 1, below which the forces may not determine the motion.
    """

    tolerance: float = 1e-11
    max_iterations: int = 25
    min_step: float = 1e-3
    rank_tolerance: float = 1e-10
    min_return: float = 1e-13


class ApproachOptions(Frozen):
    """Options on the simulation from rest towards a periodic motion.

    Attributes
    ----------
    cycles : tuple of int
        Numbers of cycles that are simulated in turn, each before an attempt to close the period.
    max_drift : float
        Difference of the mean cycle amplitude between two halves, relative to the range of amplitudes, above
        which the motion grows or decays.
    settled_fraction : float
        Remaining part of a disturbance at which it counts as settled.
    """

    cycles: tuple[int, ...] = (10, 20, 40, 80, 160)
    max_drift: float = 0.2
    settled_fraction: float = 0.01


class SteadyOptions(Frozen):
    """Options on the simulation until the motion is steady.

    Attributes
    ----------
    cycles : tuple of int
        Numbers of cycles that are simulated in turn; after each the motion is tested for being periodic.
    ranging_cycles : int
        Number of cycles of such a turn, from which on its amplitudes count for the range of a motion that
        never repeats: it may be intermittent.
    max_periods : int
        Most periods of the force after which a steady motion may repeat.
    max_distance : float
        Distance of a simulated state from the steady motion found near it, relative to the motion, above
        which it belongs to another one.
    return_ratio : float
        Distance of the state after some periods, relative to the least after fewer, below which the motion
        may repeat after them.
    min_spread_ratio : float
        Spread of cycle amplitudes in one window, relative to the window before, below which the motion
        decays.
    distinct_distance : float
        Distance of a motion of twice the periods from the other motion, relative to it, from which on it does
        not count as the one that bifurcates from it.
    """

    cycles: tuple[int, ...] = (20, 40, 80, 160, 320, 640, 640, 640)
    ranging_cycles: int = 640
    max_periods: int = 8
    max_distance: float = 0.1
    return_ratio: float = 0.5
    min_spread_ratio: float = 0.5
    distinct_distance: float = 1.0


class PeriodDoublingOptions(Frozen):
    """Options on motions with twice the period of other motions.

    Attributes
    ----------
    distances : tuple of float
        Distances from a motion, relative to it, at which one of twice its period is sought, in turn.
    max_points : int
        Most points on either side of a flip from which this is tried; the curve may bend beyond them.
    max_distance : float
        Scaled distance of the last point of a curve from a flip, below which the curve ends at that flip.
    closure_tolerance : float
        Closure error after fewer periods, relative to the motion, below which it repeats after these.
    """

    distances: tuple[float, ...] = (0.03, 0.1, 0.3)
    max_points: int = 4
    max_distance: float = 0.2
    closure_tolerance: float = 1e-6


class OrbitOptions(Frozen):
    """Options on the records of the points of a curve of periodic solutions.

    Attributes
    ----------
    max_cached : int
        Most floating-point numbers of cached periods; a point is often needed more than once.
    min_duration : float
        Duration of a contact's state, relative to the period, below which it is left out.
    min_amplitude : float
        Amplitude, relative to the greatest, up to which a displacement is not reported.
    """

    max_cached: int = 1_000_000
    min_duration: float = 1e-9
    min_amplitude: float = 1e-9


class StartOptions(Frozen):
    """Options on motions from which curves are followed.

    Attributes
    ----------
    max_guesses : int
        Most guesses about a peak of the balance; the highest motion found from them is followed.
    min_height : float
        Height of a motion, relative to the peak, from which on no further guess is tried: the balance may
        have an error.
    frequencies : int
        Number of intervals of the range at whose ends starts corrected with more harmonics are tried, if
        nothing else was found.
    damped_frequencies : int
        Number of intervals of the range at whose ends starts with more damping are tried, if still nothing
        was found.
    harmonics : tuple of int
        Harmonics of the balance that gives the corrected starts.
    corrected_harmonics : tuple of int
        Harmonics of the balance that corrects the starts.
    distinct_distance : float
        Scaled distance of two solutions above which they are different.
    """

    max_guesses: int = 16
    min_height: float = 0.9
    frequencies: int = 24
    damped_frequencies: int = 12
    harmonics: tuple[int, ...] = (1,)
    corrected_harmonics: tuple[int, ...] = (1, 2, 3, 4, 5, 6, 7)
    distinct_distance: float = 1e-6


class BalanceOptions(Frozen):
    """Options of the harmonic balance that gives the guesses of exact motions.

    Attributes
    ----------
    accuracy : float
        Relative accuracy of the balance.
    peak_spacing : int
        Number of points of a path within which one peak represents those of other degrees of freedom.
    peak_offsets : tuple of int
        Offsets, in points, from a peak to the points from which motions are sought, in turn.
    harmonics : tuple of int
        Harmonics of the balance whose branches are sought; with three harmonics the error of an isola may be
        as large as its distance from another branch.
    guess_harmonics : tuple of int
        Harmonics of a guess, where contacts are few.
    many_contacts : int
        Number of contacts from which on a guess has one harmonic.
    force_harmonics : int
        Highest harmonic of the forces of a guess, relative to the highest harmonic of its motion.
    others : tuple
        Options of its branches that are not the default, of the classes of `fcm.branches.options`.
    """

    accuracy: float = 1e-2
    peak_spacing: int = 8
    peak_offsets: tuple[int, ...] = (1, 2, 3, 4, 6, 8, 11, 16, 23, 32)
    harmonics: tuple[int, ...] = (1, 2, 3, 4, 5)
    guess_harmonics: tuple[int, ...] = (1, 2, 3)
    many_contacts: int = 5
    force_harmonics: int = 3
    others: tuple[object, ...] = ()


class DampingHomotopyOptions(Frozen):
    """Options on the homotopy from a motion with more damping.

    Attributes
    ----------
    damping_ratio : float
        Damping ratio to which the least damped mode is raised: with it motions are found from remote guesses.
    first_factor, min_factor : float
        Factor on the damping in the first step, and in the largest step.
    max_factor : float
        Factor on the damping from which on a step is too short: the homotopy has failed.
    """

    damping_ratio: float = 0.03
    first_factor: float = 0.5
    min_factor: float = 0.2
    max_factor: float = 0.999


class ForceLevelOptions(Frozen):
    """Options on continuation in the level of the forces.

    Attributes
    ----------
    max_step : float
        Longest step along the curve, in its scaled unknowns.
    retry_fraction : float
        Longest step of a second attempt, relative to the first.
    linear_fraction : float
        Lowest level of a curve, relative to the level up to which contacts are linear.
    level_floor : float
        Least unit of the level along the curve; a greater level is its own unit.
    """

    max_step: float = 0.2
    retry_fraction: float = 0.25
    linear_fraction: float = 0.5
    level_floor: float = 0.1


class LinearOrbitOptions(Frozen):
    """Options on motions in which no contact changes its state.

    Attributes
    ----------
    max_combined : int
        Number of contacts up to which all combinations of closed and open are tried; with more, only all
        closed.
    limit_distance : float
        Distance of a motion from its slip limits, relative to the forces, that is tried first.
    min_limit_distance : float
        Distance of a motion from its slip limits, relative to the forces, that is tried last; a motion on the
        limit is part of another curve.
    """

    max_combined: int = 3
    limit_distance: float = 0.01
    min_limit_distance: float = 1e-6


class PartlyStickingOptions(Frozen):
    """Options on motions in which some contacts always stick.

    Attributes
    ----------
    limit_distances : tuple of float
        Distances of the residual friction from its limits, relative to the forces, that are tried in turn.
    min_distance : float
        Distance between two residual frictions, relative to the largest distance, up to which the second is
        not tried.
    max_tries : int
        Most residual frictions that are tried for the same contacts.
    amplitude_tolerance : float
        Relative difference of an amplitude from a family's range, up to which the motion lies within it.
    closure_tolerance : float
        Closure error of a motion found with held contacts, relative to the motion, below which it is a guess
        for the released contacts.
    cycles : tuple of int
        Numbers of cycles that are simulated in turn, each before an attempt to close the period.
    """

    limit_distances: tuple[float, ...] = (0.01, 1.0)
    min_distance: float = 0.2
    max_tries: int = 6
    amplitude_tolerance: float = 1e-3
    closure_tolerance: float = 1e-6
    cycles: tuple[int, ...] = (10, 40)


class LocatedPeakOptions(Frozen):
    """Options on peaks and folds that are located from guesses, without the whole curve.

    Attributes
    ----------
    windows : tuple of float
        Widths to either side of a guess, relative to its frequency, in which the point is sought, in turn.
    max_distance : float
        Scaled distance of the curve from a guess, from which on it is a different curve.
    min_growth : float
        Slope of an amplitude by scaled length, relative to the amplitude, up to which it counts as 0, as it
        does in continuation.
    peak_tolerance : float
        Relative difference of two frequencies or amplitudes, up to which they are the same.
    """

    windows: tuple[float, ...] = (0.005, 0.02, 0.08)
    max_distance: float = 0.5
    min_growth: float = 1e-7
    peak_tolerance: float = 1e-7


class ResidualFrictionOptions(Frozen):
    """Options on the residual friction force of a contact that always sticks.

    Attributes
    ----------
    margin : float
        Least distance of the residual friction from the slip limit, relative to the forces.
    rounding : float
        Difference from the wanted residual friction, relative to that distance, up to which it counts as
        reached without evaluation of the limits.
    """

    margin: float = 1e-9
    rounding: float = 1e-3


class FamilyOptions(Frozen):
    """Options on families of motions over the residual friction of contacts that always stick.

    Attributes
    ----------
    steps : int
        Number of steps from one slip limit to the other.
    min_step : float
        Length of a step, relative to the longest before, down to which it is shortened; if it fails, the
        family ends there.
    max_iterations : int
        Most Newton steps for a motion: if more are needed, a shorter step along the family is faster.
    min_fraction : float
        Factor on a Newton step down to which it is shortened.
    max_factor : float
        Greatest ratio of a step along the family to the one before.
    max_distance : float
        Residual friction, relative to the first distance between its limits, beyond which the family counts
        as endless: such a contact is pressed together by its own residual friction.
    zero_distance : float
        Least change of the distance from the limits in a step, relative to the greatest distance, in the
        computation of the next step.
    max_combined : int
        Number of contacts up to which all combinations of directions are followed.
    bound_tolerance : tuple[float, float]
        Distance of a motion beyond the range of a family, relative to that range, up to which it belongs to
        the family: with one sticking contact, and with several.
    halvings_to_stable : int
        Number of bisections between two motions of which one is stable.
    halvings_to_extreme : int
        Number of bisections about the motion with the greatest or the least amplitude.
    amplitude_tolerance : float
        Range of an amplitude over a family, relative to the amplitude, up to which it is constant.
    max_motions : int
        Most motions of a family that are computed: a family may pass hundreds of sets of sticking contacts.
    """

    steps: int = 8
    min_step: float = 1e-3
    max_iterations: int = 8
    min_fraction: float = 0.1
    max_factor: float = 4.0
    max_distance: float = 1e4
    zero_distance: float = 1e-12
    max_combined: int = 3
    bound_tolerance: tuple[float, float] = (1e-6, 0.25)
    halvings_to_stable: int = 12
    halvings_to_extreme: int = 4
    amplitude_tolerance: float = 1e-6
    max_motions: int = 500


class StabilityChangeOptions(Frozen):
    """Options on changes of stability along a curve.

    Attributes
    ----------
    max_evaluations : int
        Most motions that are computed to locate one change.
    certain_fraction : float
        Distance of the greatest multiplier from the stability limit, relative to the tolerance of growth, up
        to which the change counts as located.
    max_divisions : int
        Most divisions of the interval between two points in search of a window of stability.
    safe_growth : float
        Logarithm of the greatest multiplier, at both of two points, below which no window is sought between
        them.
    max_ranges : int
        Most frequency ranges without a stable motion, the widest first, in whose middle the motion is
        simulated.
    sign_change : SignChangeOptions
        How a change is bracketed.
    """

    max_evaluations: int = 60
    certain_fraction: float = 0.01
    max_divisions: int = 4
    safe_growth: float = -0.3
    max_ranges: int = 3
    sign_change: SignChangeOptions = SIGN_CHANGE


class BranchSearchOptions(Frozen):
    """Options on the search for all branches.

    Attributes
    ----------
    compared_motions : int
        Number of motions of a branch that are compared with other branches, to decide whether it is new.
    max_broken : int
        Number of branches that break off, from which on no others are sought: where contacts rattle, with ten
        or more impacts per period, unstable motions are countless.
    poll_interval : float
        [s] Time between two readings of the processor time, which are slow on some machines.
    rounding_frequency : float
        Frequency, relative to that of the highest mode, above which the motion in a period is close to
        rounding.
    """

    compared_motions: int = 7
    max_broken: int = 3
    poll_interval: float = 0.05
    rounding_frequency: float = 1e3


class ShootingOptions(Frozen):
    """All options of shooting, grouped by purpose; see the class of each field.

    Examples
    --------
    >>> from dataclasses import replace
    >>> import fcm
    >>> from fcm.shooting import periodic
    >>> loose = replace(SHOOTING, closure=ClosureOptions(tolerance=1e-7))
    >>> periodic(fcm.load_scene("yang1998-n5"), 1.3, options=loose).stable
    True
    """

    closure: ClosureOptions = ClosureOptions()
    approach: ApproachOptions = ApproachOptions()
    steady: SteadyOptions = SteadyOptions()
    doubling: PeriodDoublingOptions = PeriodDoublingOptions()
    orbit: OrbitOptions = OrbitOptions()
    start: StartOptions = StartOptions()
    balance: BalanceOptions = BalanceOptions()
    damping: DampingHomotopyOptions = DampingHomotopyOptions()
    level: ForceLevelOptions = ForceLevelOptions()
    linear: LinearOrbitOptions = LinearOrbitOptions()
    partly_sticking: PartlyStickingOptions = PartlyStickingOptions()
    peaks: LocatedPeakOptions = LocatedPeakOptions()
    traction: ResidualFrictionOptions = ResidualFrictionOptions()
    family: FamilyOptions = FamilyOptions()
    stability: StabilityChangeOptions = StabilityChangeOptions()
    search: BranchSearchOptions = BranchSearchOptions()
    floquet: StabilityOptions = STABILITY


SHOOTING = ShootingOptions()  # the default
