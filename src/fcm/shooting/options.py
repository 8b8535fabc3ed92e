"""Tolerances and limits of the exact periodic motions, and of the search for their branches.

`ShootingOptions` has them all. It is a field of `OrbitProblem`, and an argument elsewhere.
"""

from __future__ import annotations

from fcm.continuation.options import SIGN_CHANGE, SignChangeOptions
from fcm.frozen import Frozen
from fcm.stability.options import STABILITY, StabilityOptions


class ClosureOptions(Frozen):
    """Newton's method on the closure of a period.

    Attributes
    ----------
    tolerance : float
        Of the closure, relative to the size of the motion.
    max_iterations : int
        At most.
    min_step : float
        Part of a step; a shorter one counts as divergence.
    rank_tolerance : float
        Relative singular value, below which nothing changes along a direction, as where a contact never
        slips.
    min_return : float
        Distance of a multiplier from 1, below which the forces may not decide what the motion is.
    """

    tolerance: float = 1e-11
    max_iterations: int = 25
    min_step: float = 1e-3
    rank_tolerance: float = 1e-10
    min_return: float = 1e-13


class ApproachOptions(Frozen):
    """A simulation from rest towards a periodic motion.

    Attributes
    ----------
    cycles : tuple of int
        Simulated before each attempt to close the period.
    max_drift : float
        Part of the range of cycle amplitudes, by which their mean may differ from half to half.
    settled_fraction : float
        Part of a disturbance that damping leaves of it, when it has settled.
    """

    cycles: tuple[int, ...] = (10, 20, 40, 80, 160)
    max_drift: float = 0.2
    settled_fraction: float = 0.01


class SteadyOptions(Frozen):
    """A simulation until the motion is steady.

    Attributes
    ----------
    cycles : tuple of int
        Simulated before each look whether it is.
    ranging_cycles : int
        Looks at so many cycles tell together how far a motion ranges, as it may linger and burst out.
    max_periods : int
        Of the force, after which a steady motion may repeat, at most.
    max_distance : float
        Distance of a simulated state from the steady one that it belongs to, relative to the motion.
    return_ratio : float
        Part of its distance after fewer periods, to which the motion comes back after more.
    min_spread_ratio : float
        Part of the spread of cycle amplitudes in one window, of which the next has less if it decays.
    distinct_distance : float
        Distance from a motion, relative to it, at which a motion of twice its periods is another.
    """

    cycles: tuple[int, ...] = (20, 40, 80, 160, 320, 640, 640, 640)
    ranging_cycles: int = 640
    max_periods: int = 8
    max_distance: float = 0.1
    return_ratio: float = 0.5
    min_spread_ratio: float = 0.5
    distinct_distance: float = 1.0


class PeriodDoublingOptions(Frozen):
    """Motions of twice the periods of others.

    Attributes
    ----------
    distances : tuple of float
        From a motion, relative to it, at which one of twice its periods is sought.
    max_points : int
        To either side of a flip from which it is sought; further ones are beyond bends.
    max_distance : float
        Distance of the last point of a curve from the flip at which it ends, at most.
    closure_tolerance : float
        Relative to the motion; one that closes better after fewer periods repeats after these.
    """

    distances: tuple[float, ...] = (0.03, 0.1, 0.3)
    max_points: int = 4
    max_distance: float = 0.2
    closure_tolerance: float = 1e-6


class OrbitOptions(Frozen):
    """The points of a curve.

    Attributes
    ----------
    max_cached : int
        Numbers of computed periods that are kept at most, as a place is asked for more than once.
    min_duration : float
        Part of a period; a state of a contact that lasts less is none.
    min_amplitude : float
        Part of the greatest amplitude; what moves less is not reported.
    """

    max_cached: int = 1_000_000
    min_duration: float = 1e-9
    min_amplitude: float = 1e-9


class StartOptions(Frozen):
    """Motions from which curves are followed.

    Attributes
    ----------
    max_guesses : int
        About a peak of the balance, of whose motions the highest is followed.
    min_height : float
        Part of that of the peak; the first motion as high is taken, as the balance of one harmonic may be
        off.
    frequencies : int
        Of the range, between which more harmonics are tried where nothing else was found.
    damped_frequencies : int
        The same with more damping, where nothing was found so either.
    harmonics : tuple of int
        That are looked for.
    corrected_harmonics : tuple of int
        Harmonics with which these are corrected.
    distinct_distance : float
        Relative distance; solutions further apart are different.
    """

    max_guesses: int = 16
    min_height: float = 0.9
    frequencies: int = 24
    damped_frequencies: int = 12
    harmonics: tuple[int, ...] = (1,)
    corrected_harmonics: tuple[int, ...] = (1, 2, 3, 4, 5, 6, 7)
    distinct_distance: float = 1e-6


class BalanceOptions(Frozen):
    """The harmonic balance that exact motions begin near.

    Attributes
    ----------
    accuracy : float
        Of it, relative.
    peak_spacing : int
        Points of a path, within which one peak stands for those of other degrees of freedom.
    peak_offsets : tuple of int
        Points from a peak, from which motions are sought.
    harmonics : tuple of int
        Of the branches that are looked for; with three a closed branch may be as far off as another one
        is.
    guess_harmonics : tuple of int
        Harmonics of a guess.
    many_contacts : int
        From so many on a guess has one harmonic.
    force_harmonics : int
        Times the highest harmonic of a guess, up to which its forces have harmonics.
    others : tuple
        Options of its branches, of the classes of `fcm.branches.options`; the others are the default.
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
    """A motion that is reached from one with more damping.

    Attributes
    ----------
    damping_ratio : float
        Of the least damped mode, from which motions are found from afar.
    first_factor, min_factor : float
        Factors of the damping in the first step, and in the largest.
    max_factor : float
        Factor; a step nearer to 1 leads no further.
    """

    damping_ratio: float = 0.03
    first_factor: float = 0.5
    min_factor: float = 0.2
    max_factor: float = 0.999


class ForceLevelOptions(Frozen):
    """The level of the forces as the parameter.

    Attributes
    ----------
    max_step : float
        Longest, along the curve.
    retry_fraction : float
        Part of it, with which the curve is followed once more.
    linear_fraction : float
        Part of the level up to which contacts are linear; curves are followed down to it.
    level_floor : float
        Unit of lower levels; higher ones are measured by themselves.
    """

    max_step: float = 0.2
    retry_fraction: float = 0.25
    linear_fraction: float = 0.5
    level_floor: float = 0.1


class LinearOrbitOptions(Frozen):
    """Motions in which no contact changes its state.

    Attributes
    ----------
    max_combined : int
        Contacts, up to which all combinations of closed and open are tried; of more, all closed.
    limit_distance : float
        Part of the forces, by which a motion keeps away from its limits if it can.
    min_limit_distance : float
        Part of them, by which it does so at least; one on its limit belongs to others.
    """

    max_combined: int = 3
    limit_distance: float = 0.01
    min_limit_distance: float = 1e-6


class PartlyStickingOptions(Frozen):
    """Motions in which some contacts always stick.

    Attributes
    ----------
    limit_distances : tuple of float
        Parts of the forces, by which residual friction keeps away from two limits at a time.
    min_distance : float
        Part of the largest distance; residual friction nearer to another is not tried.
    max_tries : int
        For the same contacts, at most.
    amplitude_tolerance : float
        Relative difference of amplitudes, up to which a motion is within an extent.
    closure_tolerance : float
        Of a motion found with fixed contacts, once these are free.
    cycles : tuple of int
        Simulated before each look whether the motion has become periodic.
    """

    limit_distances: tuple[float, ...] = (0.01, 1.0)
    min_distance: float = 0.2
    max_tries: int = 6
    amplitude_tolerance: float = 1e-3
    closure_tolerance: float = 1e-6
    cycles: tuple[int, ...] = (10, 40)


class PeakOptions(Frozen):
    """Peaks and folds that are located alone, from guesses.

    Attributes
    ----------
    windows : tuple of float
        Parts of the frequency to either side of a guess; the next where one has nothing.
    max_distance : float
        Of the curve from a guess, in its own size; one further away is another.
    min_growth : float
        Growth of an amplitude, over its size, along a unit of arc; paths take no notice of less.
    peak_tolerance : float
        Part of the frequency or of the amplitude, by which what is found twice differs.
    """

    windows: tuple[float, ...] = (0.005, 0.02, 0.08)
    max_distance: float = 0.5
    min_growth: float = 1e-7
    peak_tolerance: float = 1e-7


class ResidualFrictionOptions(Frozen):
    """The friction force of a contact that always sticks.

    margin: distance from its limit, relative to the forces. rounding: part of that; a contact this near to
    what is wanted has it, whatever its limits.
    """

    margin: float = 1e-9
    rounding: float = 1e-3


class FamilyOptions(Frozen):
    """Families of motions over the residual friction of contacts that always stick.

    Attributes
    ----------
    steps : int
        From one limit of slip to the other.
    min_step : float
        Part of a step; below it the family has an end of its own.
    max_iterations : int
        Of Newton's method; with more a shorter step is found later.
    min_fraction : float
        Of one of these steps, the smallest that is tried.
    max_factor : float
        Of a step to the next, at most.
    max_distance : float
        Times the first distance between the limits; a contact that its own residual friction presses
        together has no end.
    zero_distance : float
        Part of that distance.
    max_combined : int
        Contacts, up to which all combinations of directions are followed.
    bound_tolerance : tuple[float, float]
        Part of bounds, by which a motion may be beyond, of one contact, and of several by lines.
    halvings_to_stable : int
        Of the way between two motions of which one is stable.
    halvings_to_extreme : int
        Of the way about the motion with the greatest or the least amplitude.
    amplitude_tolerance : float
        Relative range of amplitudes that are one.
    max_motions : int
        Motions, at most, as some contacts have hundreds of sets of those that stick.
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
    """Where stability changes along a curve.

    Attributes
    ----------
    max_evaluations : int
        At places between two points, at most.
    certain_fraction : float
        Part of the excess of a multiplier over 1 up to which a motion is stable, by which it may differ
        from that where stability changes.
    max_divisions : int
        Divisions of the way between two points in search of a window of stability.
    safe_growth : float
        Logarithm of the greatest multiplier of both; below it no window is looked for.
    max_ranges : int
        Of the frequency without a stable motion, in whose middle the motion is simulated, the widest
        first.
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
    """The search for all branches.

    Attributes
    ----------
    compared_motions : int
        Of a branch that are looked for on the others.
    max_broken : int
        Branches that break off, after which no others are looked for: where contacts rattle, with ten
        impacts a period and more, unstable motions are countless.
    poll_interval : float
        [s] between two looks at the processor time, which takes long to tell on some machines.
    rounding_frequency : float
        Times the frequency of the highest mode, from where what a period does is near to rounding.
    """

    compared_motions: int = 7
    max_broken: int = 3
    poll_interval: float = 0.05
    rounding_frequency: float = 1e3


class ShootingOptions(Frozen):
    """All of the package, by what they are for: see the class of each field.

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
    peaks: PeakOptions = PeakOptions()
    traction: ResidualFrictionOptions = ResidualFrictionOptions()
    family: FamilyOptions = FamilyOptions()
    stability: StabilityChangeOptions = StabilityChangeOptions()
    search: BranchSearchOptions = BranchSearchOptions()
    floquet: StabilityOptions = STABILITY


SHOOTING = ShootingOptions()  # where nothing else is said
