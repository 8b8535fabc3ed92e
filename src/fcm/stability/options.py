"""Tolerances and limits of the stability of balanced motions.

`StabilityOptions` has them all. It is an argument of `multipliers_of` and of `stability`.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class VerdictOptions:
    """What multipliers say of one solution.

    excess: of a multiplier over 1, up to which a motion is stable. real: logarithm of a real multiplier that
    truncation may put on the wrong side of 1 in any case. shifts: times the shift of one from the balanced
    harmonics to more, which may be on the wrong side, too. flip: [rad] from -1, within which a pair is
    followed as it passes, as modes flip there. small: multipliers below are far from growth, wherever they
    turn. neutral: distance from 1 of the multipliers of a mode of zero frequency that nothing holds.
    """

    excess: float = 1e-7
    real: float = 0.02
    shifts: float = 2.0
    flip: float = 0.4
    small: float = 0.75
    neutral: float = 1e-5


@dataclass(frozen=True)
class StructureOptions:
    """The structure whose disturbances are followed.

    modes: with more, those far above the excitation follow without delay. contacts: from so many on a change
    of one's state is followed as that. displacement: part of the contacts' displacement that a far mode
    gives; one that gives less is left out. above_excitation, above_harmonics: times the excitation, and times
    the highest harmonic, from where modes are far. remembered: disturbances; with fewer the last workspace is
    used again. disturbances: of the sectors of a ring; with more a point takes seconds, and stability is not
    told.
    """

    modes: int = 24
    contacts: int = 12
    displacement: float = 1e-3
    above_excitation: float = 6.0
    above_harmonics: float = 1.5
    remembered: int = 12
    disturbances: int = 600


@dataclass(frozen=True)
class ConfirmationOptions:
    """Whether further harmonics may change a verdict.

    decay: logarithm in a period, which truncation hardly makes a growth. safe: times what further harmonics
    add to the displacements, that such a decay also is; light impacts make that of it. slight: the same of a
    growth that truncation may have made. rounding: part of the displacements that further harmonics add;
    less may be none.

    step: relative change of the frequency, by which it is found how fast a pair turns towards -1. furthest:
    change of the frequency until it meets there. looks: until then. met: square of the angle [rad] that is
    then left. meeting: logarithm of the decay there.

    enough: part of the way to a solution of many contacts with more harmonics, to which that is known.
    distance: of a solution's size; one with more harmonics that is further away is another. parts: of the
    further harmonics' equations, where all at once are too much. unknowns: from so many on these are not
    tried. span: points from one that is confirmed to the next, between which all are. settled: part of the
    displacements that the harmonics beyond the further ones may add to a motion that confirms.
    """

    decay: float = 0.05
    safe: float = 200.0
    slight: float = 4.0
    rounding: float = 1e-6
    step: float = 1e-4
    furthest: float = 0.05
    looks: int = 8
    met: float = 1e-3
    meeting: float = 1e-3
    enough: float = 1e-6
    distance: float = 0.5
    parts: tuple[float, ...] = (0.1, 0.25, 0.45, 0.7, 1.0)
    unknowns: int = 240
    span: int = 8
    settled: float = 0.05


@dataclass(frozen=True)
class WindowOptions:
    """Windows of stability that are hidden between two points.

    doubt: part of the differences between three values, by which what they foretell may be too high.
    divided: of it, each time that the way was divided, as differences fall by squares and errors by cubes.
    multipliers: with more, two are always about to meet. size: of multipliers that matter. narrow: a way,
    relative to the size of the solution, that is not divided. near: part of the way between two places; none
    nearer to one of them is looked at, but a window may begin there. dips: divisions of a way, at most.
    edge: part of a step; between places nearer than this the edge of a window is not looked for. ahead,
    about: times the angle by which multipliers turn, and [rad], by which two may come nearer to one another.
    """

    doubt: float = 0.1
    divided: float = 0.5
    multipliers: int = 60
    size: float = 0.5
    narrow: float = 1e-3
    near: float = 0.1
    dips: int = 4
    edge: float = 0.3
    ahead: float = 1.5
    about: float = 0.4


@dataclass(frozen=True)
class AlongOptions:
    """Which points of a path are looked at, and where stability changes between them.

    one_harmonic: points of one harmonic, from one that is always looked at to the next. several_harmonics: of
    more, as the growth jumps where a contact's states change. many_contacts: of many contacts with more, of
    which each changes the growth by little. deviation: of the growth from a straight line, over its own size,
    that is followed up. safe: growth; less is not followed up. enough: growth that counts as any that is
    less. phase: [rad] by which multipliers that are not small turn at most, from one point to the next.

    fine: part of a step, to which a crossing is known where the growth jumps. confirmed: the same where
    verdicts are confirmed, as the jump may be from one motion to a finer one. zero: growth at a crossing.
    looks: at a crossing, at most.
    """

    one_harmonic: int = 16
    several_harmonics: int = 4
    many_contacts: int = 8
    deviation: float = 1.0
    safe: float = -0.05
    enough: float = -0.3
    phase: float = 1.5
    fine: float = 1e-7
    confirmed: float = 1e-4
    zero: float = 1e-10
    looks: int = 60


@dataclass(frozen=True)
class HillOptions:
    """Hill's method, of contacts with laws of one's own.

    offset: mean harmonic of a disturbance, from which on another one may be the same. same: relative
    difference of the multipliers of two that are.
    """

    offset: float = 0.25
    same: float = 1e-9


@dataclass(frozen=True)
class PlanarStabilityOptions:
    """How disturbances of contacts in a plane are followed.

    stages: Radau's points of a step. tolerance: of the velocities' last coefficient in Legendre's polynomials
    over a step, beside the size of a disturbance; multipliers err by about a thousandth of it. before: of the
    last coefficient but one, what the last is taken for at least, as it may vanish by chance. ends: times the
    tolerance, what steps may leave out that end where a slipping contact opens, or begin where it closes.
    longest: step [rad]. shrink, grow, safety: limits of the ratio of two steps, and what it is multiplied by.

    most, most_of_many: disturbances that are followed, of few and of many contacts; with more, stability is
    not told. panels: of slip that are recorded
    for a contact at first. same: [rad] between events that are one. apart: [rad] between events, from where
    on a period may begin between them.
    """

    stages: int = 5
    tolerance: float = 1e-4
    before: float = 0.1
    ends: float = 0.01
    longest: float = 1.0
    shrink: float = 0.2
    grow: float = 2.5
    safety: float = 0.8
    most: int = 160
    most_of_many: int = 800
    panels: int = 200
    same: float = 1e-13
    apart: float = 1e-6


@dataclass(frozen=True)
class StabilityOptions:
    """All of the package, by what they are for: see the class of each field."""

    verdict: VerdictOptions = VerdictOptions()
    structure: StructureOptions = StructureOptions()
    confirmation: ConfirmationOptions = ConfirmationOptions()
    windows: WindowOptions = WindowOptions()
    along: AlongOptions = AlongOptions()
    hill: HillOptions = HillOptions()
    planar: PlanarStabilityOptions = PlanarStabilityOptions()


STABILITY = StabilityOptions()  # where nothing else is said
