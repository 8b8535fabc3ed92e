"""Tolerances and limits of the exact periodic motions, and of the search for their branches.

`ShootingOptions` has them all. It is a field of `OrbitProblem`, and an argument elsewhere.
"""

from __future__ import annotations

from dataclasses import dataclass

from fcm.stability.options import STABILITY, StabilityOptions


@dataclass(frozen=True)
class ClosureOptions:
    """Newton's method on the closure of a period.

    tolerance: of the closure, relative to the size of the motion. iterations: at most. shortest: part of a
    step; a shorter one leads nowhere. rank: relative singular value, below which nothing changes along a
    direction, as where a contact never slips.
    """

    tolerance: float = 1e-11
    iterations: int = 25
    shortest: float = 1e-3
    rank: float = 1e-10


@dataclass(frozen=True)
class ApproachOptions:
    """A simulation from rest towards a periodic motion.

    cycles: simulated before each attempt to close the period. drift: part of the range of cycle amplitudes,
    by which their mean may differ from half to half. settled: part of a disturbance that damping leaves of
    it, when it has settled.
    """

    cycles: tuple[int, ...] = (10, 20, 40, 80, 160)
    drift: float = 0.2
    settled: float = 0.01


@dataclass(frozen=True)
class SteadyOptions:
    """A simulation until the motion is steady.

    cycles: simulated before each look whether it is. ranging: from so many cycles on they tell together how
    far a motion ranges, as it may linger and burst out. periods: of the force, after which a steady motion
    may repeat, at most. near: distance of a simulated state from the steady one that it belongs to, relative
    to the motion. nearer: part of its distance after fewer periods, to which the motion comes back after
    more. lasting: part of the spread of cycle amplitudes in one half that the other must have. other:
    distance from a motion, relative to it, at which a motion of twice its periods is another.
    """

    cycles: tuple[int, ...] = (20, 40, 80, 160, 320, 640, 640, 640)
    ranging: int = 640
    periods: int = 8
    near: float = 0.1
    nearer: float = 0.5
    lasting: float = 0.5
    other: float = 1.0


@dataclass(frozen=True)
class PeriodDoublingOptions:
    """Motions of twice the periods of others.

    distances: from a motion, relative to it, at which one of twice its periods is sought. points: to either
    side of a flip from which it is sought; further ones are beyond bends. near: distance of the last point of
    a curve from the flip at which it ends, at most. closure: relative to the motion; one that closes better
    after fewer periods repeats after these.
    """

    distances: tuple[float, ...] = (0.03, 0.1, 0.3)
    points: int = 4
    near: float = 0.2
    closure: float = 1e-6


@dataclass(frozen=True)
class OrbitOptions:
    """The points of a curve.

    remembered: numbers of computed periods that are kept at most, as a place is asked for more than once.
    instant: part of a period; a state of a contact that lasts less is none. still: part of the greatest
    amplitude; what moves less is not reported.
    """

    remembered: int = 1_000_000
    instant: float = 1e-9
    still: float = 1e-9


@dataclass(frozen=True)
class StartOptions:
    """Motions from which curves are followed.

    guesses: about a peak of the balance, of whose motions the highest is followed. height: part of that of
    the peak; the first motion as high is taken, as the balance of one harmonic may be off. places: of the
    range, between which more harmonics are tried where nothing else was found. damped_places: the same with
    more damping, where nothing was found so either. harmonics: that are looked for. corrected: harmonics with
    which these are corrected. distinct: relative distance; solutions further apart are different.
    """

    guesses: int = 16
    height: float = 0.9
    places: int = 24
    damped_places: int = 12
    harmonics: tuple[int, ...] = (1,)
    corrected: tuple[int, ...] = (1, 2, 3, 4, 5, 6, 7)
    distinct: float = 1e-6


@dataclass(frozen=True)
class BalanceOptions:
    """The harmonic balance that exact motions begin near.

    error: of it, relative. together: points of a path, within which one peak stands for those of other
    degrees of freedom. around: points from a peak, from which motions are sought. harmonics: of the branches
    that are looked for; with three a closed branch may be as far off as another one is. few: harmonics of a
    guess. contacts: from so many on a guess has one harmonic. forces: times the highest harmonic of a guess,
    up to which its forces have harmonics.
    """

    error: float = 1e-2
    together: int = 8
    around: tuple[int, ...] = (1, 2, 3, 4, 6, 8, 11, 16, 23, 32)
    harmonics: tuple[int, ...] = (1, 2, 3, 4, 5)
    few: tuple[int, ...] = (1, 2, 3)
    contacts: int = 5
    forces: int = 3


@dataclass(frozen=True)
class DampingHomotopyOptions:
    """A motion that is reached from one with more damping.

    ratio: of the least damped mode, from which motions are found from afar. first, largest: factors of the
    damping in the first step, and in the largest. smallest: factor; a step nearer to 1 leads no further.
    """

    ratio: float = 0.03
    first: float = 0.5
    largest: float = 0.2
    smallest: float = 0.999


@dataclass(frozen=True)
class ForceLevelOptions:
    """The level of the forces as the parameter.

    step: longest, along the curve. shorter: part of it, with which the curve is followed once more. linear:
    part of the level up to which contacts are linear; curves are followed down to it. least: unit of lower
    levels; higher ones are measured by themselves.
    """

    step: float = 0.2
    shorter: float = 0.25
    linear: float = 0.5
    least: float = 0.1


@dataclass(frozen=True)
class LinearOrbitOptions:
    """Motions in which no contact changes its state.

    combinations: contacts, up to which all combinations of closed and open are tried; of more, all closed.
    kept: part of the forces, by which a motion keeps away from its limits if it can. least: part of them, by
    which it does so at least; one on its limit belongs to others.
    """

    combinations: int = 3
    kept: float = 0.01
    least: float = 1e-6


@dataclass(frozen=True)
class PartlyStickingOptions:
    """Motions in which some contacts always stick.

    kept: parts of the forces, by which residual friction keeps away from two limits at a time. apart: part of
    the largest distance; residual friction nearer to another is not tried. tried: for the same contacts, at
    most. same: relative difference of amplitudes, up to which a motion is within an extent. closure: of a
    motion found with fixed contacts, once these are free. cycles: simulated before each look whether the
    motion has become periodic.
    """

    kept: tuple[float, ...] = (0.01, 1.0)
    apart: float = 0.2
    tried: int = 6
    same: float = 1e-3
    closure: float = 1e-6
    cycles: tuple[int, ...] = (10, 40)


@dataclass(frozen=True)
class PeakOptions:
    """Peaks and folds that are located alone, from guesses.

    windows: parts of the frequency to either side of a guess; the next where one has nothing. distance: of
    the curve from a guess, in its own size; one further away is another. level: growth of an amplitude, over
    its size, along a unit of arc; paths take no notice of less. same: part of the frequency or of the
    amplitude, by which what is found twice differs.
    """

    windows: tuple[float, ...] = (0.005, 0.02, 0.08)
    distance: float = 0.5
    level: float = 1e-7
    same: float = 1e-7


@dataclass(frozen=True)
class TractionOptions:
    """The friction force of a contact that always sticks.

    margin: distance from its limit, relative to the forces. rounding: part of that; a contact this near to
    what is wanted has it, whatever its limits.
    """

    margin: float = 1e-9
    rounding: float = 1e-3


@dataclass(frozen=True)
class FamilyOptions:
    """Families of motions over the residual friction of contacts that always stick.

    steps: from one limit of slip to the other. shortest: part of a step; below it the family has an end of
    its own. iterations: of Newton's method; with more a shorter step is found later. part: of one of these
    steps, the smallest that is tried. growth: of a step to the next, at most. furthest: times the first
    distance between the limits; a contact that its own residual friction presses together has no end. none:
    part of that distance.

    directions: contacts, up to which all combinations of directions are followed. within: part of bounds, by
    which a motion may be beyond, of one contact, and of several by lines. halvings_to_stable: of the way
    between two motions of which one is stable. halvings_to_extreme: of the way about the motion with the
    greatest or the least amplitude. same: relative range of amplitudes that are one. tried: motions, at most,
    as some contacts have hundreds of sets of those that stick.
    """

    steps: int = 8
    shortest: float = 1e-3
    iterations: int = 8
    part: float = 0.1
    growth: float = 4.0
    furthest: float = 1e4
    none: float = 1e-12
    directions: int = 3
    within: tuple[float, float] = (1e-6, 0.25)
    halvings_to_stable: int = 12
    halvings_to_extreme: int = 4
    same: float = 1e-6
    tried: int = 500


@dataclass(frozen=True)
class StabilityChangeOptions:
    """Where stability changes along a curve.

    looks: at places between two points, at most. sure: part of the excess of a multiplier over 1 up to which
    a motion is stable, by which it may differ from that where stability changes.
    dips: divisions of the way between two points in search of a window of stability. safe: logarithm of the
    greatest multiplier of both; below it no window is looked for. ranges: of the frequency without a stable
    motion, in whose middle the motion is simulated, the widest first.
    """

    looks: int = 60
    sure: float = 0.01
    dips: int = 4
    safe: float = -0.3
    ranges: int = 3


@dataclass(frozen=True)
class BranchSearchOptions:
    """The search for all branches.

    motions: of a branch that are looked for on the others. broken: branches that break off, after which no
    others are looked for: where contacts rattle, with ten impacts a period and more, unstable motions are
    countless. time: [s] between two looks at the processor time, which takes long to tell on some machines.
    rounding: times the frequency of the highest mode, from where what a period does is near to rounding.
    """

    motions: int = 7
    broken: int = 3
    time: float = 0.05
    rounding: float = 1e3


@dataclass(frozen=True)
class ShootingOptions:
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
    partly: PartlyStickingOptions = PartlyStickingOptions()
    peaks: PeakOptions = PeakOptions()
    traction: TractionOptions = TractionOptions()
    family: FamilyOptions = FamilyOptions()
    stability: StabilityChangeOptions = StabilityChangeOptions()
    search: BranchSearchOptions = BranchSearchOptions()
    floquet: StabilityOptions = STABILITY


SHOOTING = ShootingOptions()  # where nothing else is said
