"""The tolerances with which branches are looked for."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class SurfaceOptions:
    """How places on the surface of all solutions are found; lengths are in the scaled unknowns."""

    least: float = 0.1  # levels are measured by themselves, and below this by this
    iterations: int = 8  # of Newton's method, before a place is judged too far away
    close: float = 1e-4  # a step that ends them: about its square is left
    flat: float = 1e-7  # a step along which the matrix does not change,
    share: float = 1e-3  # or this share of the way from the centre
    far: float = 1e6  # a step that leads nowhere


SURFACE = SurfaceOptions()


@dataclass(frozen=True)
class FoldOptions:
    """How folds of the level of the forces are followed in (frequency, level).

    Lengths are in the scaled unknowns: displacements by their own size, the frequency by its range, the level
    by itself.
    """

    lowest: float = 0.25  # level at which a curve of folds is left, being too far below 1,
    highest: float = 4.0  # and above it
    first: float = 0.01  # step,
    longest: float = 0.3
    shortest: float = 1e-4  # with which no fold was found any more
    thin: float = 3e-3  # strip between two curves of folds that meet
    turn: float = 0.25  # [rad] by which the chord of a step is to leave the tangent,
    most_turn: float = 0.9  # and by which it may at most
    fine: float = 0.02  # [rad] to which the direction of the chord is found
    upright: float = 100.0  # times the axes: tangents longer than this are of another part of the surface
    wider: tuple[float, ...] = (1.0, 5.0, 25.0)  # times the first step: circles about a start beside a fold
    round: float = 0.01  # square of the axes of the ellipse in (frequency, level) that a circle about a fold
    # of a smooth surface is: where it is rounder, the fold is in a corner
    circle: int = 16  # places on a circle, where folds are looked for at first and where none is ahead
    most: int = 400  # steps of a curve
    retreats: int = 4  # of a curve by a step after which no fold was found, to take a shorter one
    report: int = 16  # steps after which it is told what they took
    near: float = 0.3  # of a step: a known fold this near to a curve is on it
    share: float = 0.5  # of the work before, that all curves may take,
    unnoticed: float = 0.2  # and seconds of work that they may in any case

    def within(self, level: float) -> bool:
        """Whether folds at a level are looked at."""
        return self.lowest < level < self.highest


FOLDS = FoldOptions()


@dataclass(frozen=True)
class LevelOptions:
    """Where the level of the forces is followed besides the resonances and the ends of the range."""

    low: int = 3  # harmonics whose resonances are strong enough to keep themselves up
    near: float = 0.02  # to a frequency that was looked at: a closed branch is about as wide
    wide: float = 0.1  # of the range: of a range without a stable motion that is wider, halves as well
    many: int = 9  # harmonics with which it is followed there: the branches of more are theirs, too
    share: float = 0.2  # of the work before, that all may take,
    unnoticed: float = 0.1  # and seconds of work that they may in any case


LEVELS = LevelOptions()


@dataclass(frozen=True)
class ProlongationOptions:
    """Which points of a branch are prolongated to more harmonics."""

    of_a_kind: int = 8  # peaks, and folds
    even: int = 9  # points along the branch
    far: float = 0.5  # of a solution's size: what moves further has come to another one
    times: int = 3  # as many harmonics at once, where all at once lead nowhere
    enough: float = 1e-6  # of a displacement, from which Newton's method ends at the precision of numbers


PROLONGATION = ProlongationOptions()


@dataclass(frozen=True)
class BranchingOptions:
    """How branches are left at branch points; lengths are in the scaled unknowns."""

    fine: float = 1e-4  # of a step, to which a branch point is found
    distances: tuple[float, ...] = (0.003, 0.01, 0.03, 0.1)  # from it at which other branches are looked for
    astray: float = 0.9  # of such a distance: what Newton's method finds further away is no such solution
    alike: float = 1e-5  # of a displacement: motions that differ by less are the same
    rounds: int = 4  # branches that leave branches that leave ...
    most: int = 64  # starts
    driven: float = 1e-6  # of a displacement: harmonics that a motion would have more of belong to it


BRANCHING = BranchingOptions()
