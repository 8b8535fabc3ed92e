"""The tolerances of continuation: frozen, and documented field by field.

Lengths are those of the scaled unknowns, in which a curve is about 1 long; a part is of the quantity named.
"""

from __future__ import annotations

import dataclasses
from dataclasses import field
from typing import Any

import cython

if not cython.compiled:
    from dataclasses import dataclass
else:
    from cython.dataclasses import dataclass  # type: ignore[no-redef]


@cython.cclass
class Options:
    """What the options have in common, written once: they are compared, shown and sent by their fields."""

    def _values(self) -> tuple[Any, ...]:
        return tuple(getattr(self, one.name) for one in dataclasses.fields(self))  # type: ignore[arg-type]

    def __eq__(self, other: object) -> bool:
        return type(self) is type(other) and self._values() == other._values()

    def __hash__(self) -> int:
        return hash(self._values())

    def __repr__(self) -> str:
        names = (one.name for one in dataclasses.fields(self))  # type: ignore[arg-type]
        shown = (f"{name}={value!r}" for name, value in zip(names, self._values(), strict=True))
        return f"{type(self).__name__}({', '.join(shown)})"

    def __reduce__(self) -> tuple[type, tuple[Any, ...]]:
        return type(self), self._values()


@cython.cclass
@dataclass(frozen=True, eq=False, repr=False)
class NewtonOptions(Options):
    """When Newton's method has come to the curve, and when it is given up; see `corrector`.

    Attributes
    ----------
    iterations : int
        Steps before a guess is judged too far away.
    close : float
        Error that a point may have, estimated from the convergence.
    preliminary : float
        The same of a point from which the next is looked for and nothing else.
    small : float
        A step after which there is no further one.
    exact : float
        A step that is not worth another evaluation.
    halves : int
        Half steps where the equations begin as a root, before whole ones are tried again.
    rough : float
        A step that does not shrink, and is taken for rounding though the way was long.
    left : float
        A step that grows, and is taken for rounding; longer ones have met a corner.
    chord : float
        A step after which the Jacobian from before it will do.
    chords, kept : int
        Steps with one Jacobian; and where to solve takes far less than to factor.
    shrinking : float
        Part of the step before, that each of those may be.
    brief : float
        A step after which a last one takes the Jacobian from before it.
    hopeless : float
        Part of the step before, above which the fourth and later steps of a costly problem lead nowhere.
    slight : float
        Part of the greatest first step: a second step this short is no sign of failure.
    coarsest : float
        A longer step is none that rounding makes.
    roundings : float
        A step no longer than so many of rounding may be one.
    """

    iterations: cython.int = 8
    close: cython.double = 1e-13
    preliminary: cython.double = 1e-9
    small: cython.double = 1e-12
    exact: cython.double = 1e-11
    halves: cython.int = 8
    rough: cython.double = 1e-9
    left: cython.double = 1e-10
    chord: cython.double = 1e-6
    chords: cython.int = 3
    kept: cython.int = 16
    shrinking: cython.double = 0.3
    brief: cython.double = 1e-5
    hopeless: cython.double = 0.5
    slight: cython.double = 0.02
    coarsest: cython.double = 1e-6
    roundings: cython.double = 8.0


@cython.cclass
@dataclass(frozen=True, eq=False, repr=False)
class StepOptions(Options):
    """Which step is accepted, and how long the next one is; see `step_control`.

    Attributes
    ----------
    first, shortest : float
        The first step; one that is still too long then leads nowhere.
    most : int
        Steps of a curve.
    cosine : float
        Of the angle by which the curve may turn in a step: 20 degrees.
    sharp : float
        A shorter step may turn by any angle below a right angle: there is a corner that nothing tells of.
    far : float
        Part of its length, by which a step may miss the curve.
    turn : float
        [rad] The turn that a step aims at.
    miss : float
        Part of its length, by which a step aims to miss the curve.
    uneven : float
        Change of an output over its size, that a step aims not to have foreseen;
    uneven_times : float
        so many times as much it may have.
    shrink, grow, haste : float
        Part of a step that the next is at least, and at most; and at most where nothing but values of the
        parameter is asked for.
    share : float
        Part of the next step that all aims allow.
    after, resumed : float
        The first step beyond a corner; or this part of that before it, where each point is costly.
    shortened : float
        Part of a step that is tried next where it does not lead over all corners.
    back : tuple of int
        Points by which a curve is taken back where no step leads on: one attempt each.
    """

    first: cython.double = 1e-3
    shortest: cython.double = 1e-9
    most: cython.int = 20_000
    cosine: cython.double = 0.94
    sharp: cython.double = 1e-4
    far: cython.double = 0.5
    turn: cython.double = 0.2
    miss: cython.double = 0.03
    uneven: cython.double = 0.15
    uneven_times: cython.double = 4.0
    shrink: cython.double = 0.4
    grow: cython.double = 2.5
    haste: cython.double = 10.0
    share: cython.double = 0.9
    after: cython.double = 1e-5
    resumed: cython.double = 0.1
    shortened: cython.double = 0.25
    back: tuple[int, ...] = (1, 8, 64)


@cython.cclass
@dataclass(frozen=True, eq=False, repr=False)
class EventOptions(Options):
    """How events are found within a step; see `events` and `extremum_search`.

    Attributes
    ----------
    most : int
        Points of the curve that are computed to find one.
    fine : float
        Part of a step, to which an event is known.
    enclosed : float
        Distance of two points about a fold that is no regular point of the curve.
    rise : float
        Growth of an output over its size, along a unit of length, that is not rounding.
    nearly_greatest : float
        Part of the greatest output so far, below which no peak is looked for.
    even : float
        Part of the lesser slope at the ends: a parameter whose slope changes by less goes on evenly.
    doubtful : float
        Part of the lesser slope at the ends: a cubic less steep between them may hide a way back.
    blurred : float
        A step this short tells more of rounding than of a way back.
    high, high_of_many : float
        Part of an output, to which a peak is known where points are costly; and where each of many outputs
        has its own, at a point each.
    outputs : int
        So many are many.
    same : float
        Part of the greatest unknown: points closer than this are one.
    same_way : float
        Cosine beyond which a curve closes, and does not cross itself.
    landing : float
        Part of the width of a value of the parameter that is to be landed on, within which a step ends there.
    """

    most: cython.int = 40
    fine: cython.double = 1e-11
    enclosed: cython.double = 1e-4
    rise: cython.double = 1e-7
    nearly_greatest: cython.double = 0.9
    even: cython.double = 0.2
    doubtful: cython.double = 0.25
    blurred: cython.double = 1e-4
    high: cython.double = 1e-11
    high_of_many: cython.double = 5e-7
    outputs: cython.int = 24
    same: cython.double = 1e-6
    same_way: cython.double = 0.5
    landing: cython.double = 0.25


@cython.cclass
@dataclass(frozen=True, eq=False, repr=False)
class SwitchingOptions(Options):
    """How corners are come to and left where a switching function changes its sign; see `nonsmooth_points`.

    Attributes
    ----------
    most : int
        Predictions that are looked at to find how far ahead a corner is.
    known, known_label : float
        Part of the length to there, to which that is found; and where a label changes.
    past : float
        Part of a step that ends at a corner, by which it goes past.
    across : float
        Times as long as the way to where a margin vanishes that goes on as it does, is a step across that.
    met : float
        Part of that way, within which the prediction comes to a margin that is a root: half of it.
    before : float
        Part of the way to a corner: up to here the curve is smooth.
    touched : float
        A corner this near is met: less than `beyond`.
    touched_root : float
        The same where a margin is the root of the distance, which rounding hides.
    near, nearer : float
        A corner further away is gone to by steps, each this part of the way.
    beyond : float
        Length past a corner at which the curve's new direction is looked for first,
    further : int
        at so many lengths, each ten times the last,
    pieces : int
        in so many of the smooth pieces that meet in the corner.
    astray : float
        Part of that length: a point this far from its prediction is another.
    many : int
        Unknowns from which on slight corners are stepped over where the parameter goes on evenly.
    """

    most: cython.int = 50
    known: cython.double = 1e-4
    known_label: cython.double = 2e-3
    past: cython.double = 1e-3
    across: cython.double = 1.1
    met: cython.double = 0.75
    before: cython.double = 1e-6
    touched: cython.double = 1e-8
    touched_root: cython.double = 1e-4
    near: cython.double = 1e-4
    nearer: cython.double = 0.9
    beyond: cython.double = 1e-7
    further: cython.int = 3
    pieces: cython.int = 3
    astray: cython.double = 0.5
    many: cython.int = 64


@dataclasses.dataclass(frozen=True)  # of no kernel
class LabelOptions:
    """Steps where switching functions are labels, which tell no distance; see `labelled_switching`.

    Attributes
    ----------
    error, most : float
        Distance of the curve from where it is predicted that a step aims at, and times as much it may have.
    strayed : float
        Part of the parameter's change, by which a step may miss it: more may be the way past two folds.
    gently : float
        Cosine of the turn of a step.
    astray, misled : float
        Parts of its length, by which a step may miss the curve; and by which the first step of Newton's
        method may.
    shorter, refused, longer, wary : float, (float, float), float, float
        Parts of a step that the next is at least; that one in its point is between; that the next is at
        most; and after a shortened one.
    straight : float
        Cosine beyond which a change of orientation is a branch point and no way back.
    aside : float
        Times as long as its turn alone makes it, a short step may be.
    short_of : float
        Part of the way to where a label changes, by which a step ends before it.
    met : float
        A change of label this near is met where no curve is found up to there.
    looks : int
        ExtremumSearch beyond one corner, each ten times as far.
    away : float
        Times as far from the corner is the next point, at least.
    back, spike : float
        Cosines below which a curve goes back on the way that it came; the second where its label is new.
    same : float
        Distance of two folds that are one;
    loop : int
        points that a closed curve has at least.
    reaches : tuple of float
        Lengths beyond a corner at which the curve is looked for,
    parts : tuple of float
        of these, by which a direction is looked for beyond, and a guess is aside.
    around : int
        Directions into other pieces.
    """

    error: float = 5e-4
    most: float = 4.0
    strayed: float = 0.5
    gently: float = 0.5
    astray: float = 0.5
    misled: float = 0.5
    shorter: float = 0.3
    refused: tuple[float, float] = (0.1, 0.5)
    longer: float = 3.0
    wary: float = 1.0
    straight: float = 0.999
    aside: float = 2.0
    short_of: float = 3e-3
    met: float = 1e-6
    looks: int = 5
    away: float = 10.0
    back: float = -0.99
    spike: float = -1.0 + 1e-6
    same: float = 1e-8
    loop: int = 20
    reaches: tuple[float, ...] = (1e-5, 1e-4, 1e-3, 1e-6)
    parts: tuple[float, ...] = (1.0, 0.1, 1e-2, 1e-3)
    around: int = 16


@cython.cclass
@dataclass(frozen=True, eq=False, repr=False)
class FollowOptions(Options):
    """How a curve is followed.

    Attributes
    ----------
    max_step : float
        Longest step.
    hasty : bool
        Whether only the passings of values of the parameter matter. Corners are then gone to, and left, by
        longer steps.
    newton, step, events, switching, labels : NewtonOptions, StepOptions, EventOptions, SwitchingOptions,\
 LabelOptions
        Of the parts.

    Examples
    --------
    >>> from dataclasses import replace
    >>> replace(FollowOptions(), max_step=0.2).max_step
    0.2
    """

    max_step: cython.double = 0.05
    hasty: cython.bint = False
    newton: NewtonOptions = field(default_factory=NewtonOptions)
    step: StepOptions = field(default_factory=StepOptions)
    events: EventOptions = field(default_factory=EventOptions)
    switching: SwitchingOptions = field(default_factory=SwitchingOptions)
    labels: LabelOptions = field(default_factory=LabelOptions)


@dataclasses.dataclass(frozen=True)  # of no kernel
class PathOptions:
    """When a solution lies on a path that was followed; see `all_branches` and `segment`.

    Attributes
    ----------
    same : float
        In the problem's scale: solutions closer than this are one.
    beside : float
        Part of a chord: what is further from it is not on its part of a path.
    chords : int
        Nearest ones that are looked at.
    flat : float
        Cosine of a turn, below which a length across the chord is no measure of the way.
    """

    same: float = 1e-5
    beside: float = 0.5
    chords: int = 4
    flat: float = 0.1


NEWTON = NewtonOptions()
FOLLOW = FollowOptions()
PATH = PathOptions()
