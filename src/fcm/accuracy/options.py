"""What the embedded pair is calculated with."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from fcm.continuation.options import EventOptions, FollowOptions, NewtonOptions, StepOptions


@dataclass(frozen=True)
class PairOptions:
    """How the partner of a curve is chosen, and how closely it is looked at.

    Attributes
    ----------
    times, least, most : int
        The partner has the harmonics up to so many times the number of those of the curve, and up to
        the least, but no more than the most beyond that number.
    named : int
        So many more that the spectrum of the exact forces names,
    share : float
        each with at least this part of what all that are left out would do.
    leads, matters : float
        Part of the greatest share at a point, and of an amplitude, from which on a harmonic that meets a mode
        there is named.
    unknowns, fewest : int
        No more unknowns than this, but so many harmonics more than the curve in any case.
    every : int
        Points of the curve from one that is displaced to the next, before it is known how they change.
    interpolated : float
        Part of a displacement, by which it may be off where it is interpolated.
    nothing : float
        A displacement, relative, that is too small to be looked at more closely.
    steep : float
        Relative change of an amplitude over that of the frequency, up to which both count.
    seconds : float
        Of work, as of `fcm.harmonic_balance.cost_model`, that following the partner may take where no
        point of it lies normal to the curve; as much again for points that are not found;
    part, unnoticed : float
        but no more than this part of the work that the response itself took, or so many seconds.
    seconds_elsewhere, elsewhere, unnoticed_elsewhere : float
        The same of what the partner has elsewhere.
    piece : float
        Part of what is left of that, that following the partner from one motion may take.
    probes, alike : int, float
        About so many points along a curve are displaced first. Where less than this part of them is found,
        the partner is another curve.
    fewer_times : tuple of int
        `times` where following it takes longer than it may, about as many evaluations as the curve did for
        so many times as many harmonics: the first with which it does not.
    following, roughly : FollowOptions
        How the partner is followed; and what it has elsewhere, where corners and folds matter less, and peaks
        not at all.
    points : float
        The same that all points may take that are moved to the partner, those that are found too.
    beyond : float
        Times the width of a stretch, how far beyond it the partner is followed.
    tries : int
        Points at an end of a stretch, from which the partner is sought.
    same : float
        Relative difference of amplitudes up to which the partner has come to the other end of a stretch; of
        amplitudes and frequency, up to which a fold elsewhere is that of the curve.
    together : float
        Part of the length of a curve: of the greatest amplitudes of degrees of freedom that lie so closely
        together one tells for all what the harmonics do that are left out, and of tops and folds which.
    own : float
        Part of a displacement, by which the partner itself is off: no error at a point is told to be less.
    chance : float
        Part of the typical error of the degrees of freedom: less is a chance, at a change of sign;
    chance_at_peaks : float
        the same of peaks.
    again : int
        Times the partner's harmonics those of its own partner are, which is looked for where amplitudes of
        curve and partner cross,
    again_named : int
        with so many more that the spectrum names,
    dearest : int
        and with no more unknowns than this,
    crossings, hidden : int, float
        at so many places at most, those of the crossings that hide most, and at least this;
    near : int
        points apart, up to which they are one place.
    beside : tuple of int
        Points to either side of a top where it is looked for, too, if it is not at the top.
    rival : float
        Part of the greatest amplitude: what is this high may become the greatest.
    gap : float
        Part of a change of an amplitude, by which it may be more in the gap that a moved corner leaves.
    past : float
        Times the harmonic that meets the highest mode, up to which is looked at what the partner lacks,
    farthest, products : int
        the last that is looked at, and the multiplications of modes that this may take.
    samples : int
        Of the period of the highest harmonic.
    enough : float
        Part of a displacement: when a step of Newton's method was less than this, what is left is far less.
    kept : int
        Balances that are kept for the next curve.
    at_once : int
        Places that are compared with all points of a curve.
    around : int
        Points to either side of the highest that may be higher where they are only interpolated.
    rounding : float
        Part of the greatest of a force, slip or energy of a contact: differences of this are nothing.
    """

    times: int = 4
    least: int = 5
    most: int = 15
    named: int = 4
    share: float = 0.02
    leads: float = 0.5
    matters: float = 1e-3
    unknowns: int = 240
    fewest: int = 3
    every: int = 16
    interpolated: float = 0.2
    nothing: float = 3e-5
    steep: float = 100.0
    seconds: float = 2.0
    points: float = math.inf
    part: float = 0.3
    unnoticed: float = 0.4
    seconds_elsewhere: float = 8.0
    elsewhere: float = 1.2
    unnoticed_elsewhere: float = 0.8
    piece: float = 0.25
    probes: int = 24
    alike: float = 0.5
    fewer_times: tuple[int, ...] = (3, 2)
    following: FollowOptions = field(
        default_factory=lambda: FollowOptions(0.1, events=EventOptions(high_of_many=1e-5))
    )
    roughly: FollowOptions = field(
        default_factory=lambda: FollowOptions(
            0.2,
            hasty=True,
            newton=NewtonOptions(preliminary=1e-6),
            step=StepOptions(turn=0.4, miss=0.1, uneven=0.5, cosine=0.8),
            events=EventOptions(nearly_greatest=math.inf),
        )
    )
    beyond: float = 1.0
    tries: int = 8
    same: float = 0.02
    together: float = 0.005
    own: float = 0.05
    chance: float = 0.1
    chance_at_peaks: float = 0.05
    again: int = 2
    again_named: int = 8
    dearest: int = 480
    crossings: int = 12
    hidden: float = 1e-4
    near: int = 4
    beside: tuple[int, ...] = (1, 2, 4, 8)
    rival: float = 0.8
    gap: float = 0.2
    past: float = 1.5
    farthest: int = 1024
    products: int = 10_000_000
    samples: int = 8
    enough: float = 0.01
    kept: int = 24
    at_once: int = 256
    around: int = 8
    rounding: float = 1e-9


PAIR = PairOptions()
# of harmonics that are given: the pair is for the errors alone, and nothing is traced again
OF_GIVEN = PairOptions(part=2.0, seconds=8.0, elsewhere=2.0)
# at single points, where many harmonics take little: as many as the partner of a partner has
AT_POINTS = PairOptions(times=PAIR.times * PAIR.again, least=PAIR.least * PAIR.again, named=PAIR.again_named)


@dataclass(frozen=True)
class RefinementOptions:
    """How harmonics are added to a curve until its pair agrees.

    Attributes
    ----------
    rounds : int
        Of tracing, estimating, choosing.
    spare : float
        Part of the accuracy, to which what is left out is chosen to come.
    unknown : float
        Times what harmonics do without feedback, what they do, as long as the pair does not tell.
    first, times : int
        Harmonics that are added at most to one, and times as many as there are to more.
    rival : float
        Part of the greatest amplitude, from which on a top of a branch is looked at.
    nothing : float
        Part of the greatest amplitude: degrees of freedom that move less have no peak.
    beside : tuple of int
        Points to either side of a top, where the partner may be found if it is not at the top.
    folds : int
        Folds of a branch that are looked at, at most.
    low : int
        Harmonic up to which no single one is left out: stability between folds may hang on it.
    doubtful : float
        [s] that rounds may take of which nothing tells that they bring the accuracy nearer.
    """

    rounds: int = 8
    spare: float = 0.4
    unknown: float = 3.0
    first: int = 6
    times: int = 2
    rival: float = 0.8
    nothing: float = 1e-6
    beside: tuple[int, ...] = (1, 2, 4, 8)
    folds: int = 24
    low: int = 3
    doubtful: float = 3.0


REFINEMENT = RefinementOptions()


@dataclass(frozen=True)
class ValidityOptions:
    """Up to which errors the stability of solutions is told.

    Attributes
    ----------
    believed : float
        Estimated relative error of the amplitudes, up to which a solution is called stable.
    at_fold : float
        Part of its frequency, by which a fold may be moved where nothing is said of the accuracy.
    row : int
        Points in a row without a partner, after which a branch is not one of more harmonics.
    changed : float
        Part of the greatest displacement: a change by more is not believed, as another branch may be there.
    """

    believed: float = 0.2
    at_fold: float = 1e-2
    row: int = 64
    changed: float = 0.5


VALIDITY = ValidityOptions()


@dataclass(frozen=True)
class StabilityLimitOptions:
    """How the limits of stability of more harmonics are found beside those of fewer.

    Attributes
    ----------
    far : float
        Points to either side up to which the crossing of more harmonics is sought,
    first : float
        from these on.
    fine : float
        Part of the way between two points, to which it is found: an error is told to a few parts of itself,
    part : float
        or to this part of itself, and of what it may be,
    looks : int
        with so many looks at most.
    least : float
        Growth over a period, logarithmic, that is as good as any that is less.
    same : float
        Part of the way to any other crossing, within which that of more harmonics is that of fewer.
    """

    far: float = 32.0
    first: float = 0.5
    fine: float = 1e-5
    part: float = 0.03
    looks: int = 40
    least: float = -0.3
    same: float = 0.1


STABILITY_LIMITS = StabilityLimitOptions()
