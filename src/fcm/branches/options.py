"""The tolerances with which branches are looked for."""

from __future__ import annotations

from dataclasses import field

from fcm.continuation.options import StepOptions
from fcm.frozen import Frozen


class SurfaceOptions(Frozen):
    """How places on the surface of all solutions are found; lengths are in the scaled unknowns."""

    level_floor: float = 0.1  # levels are measured by themselves, and below this by this
    max_iterations: int = 8  # of Newton's method, before a place is judged too far away
    tolerance: float = 1e-4  # a step that ends them: about its square is left
    singular_step: float = 1e-7  # a step along which the matrix does not change,
    singular_fraction: float = 1e-3  # or this share of the way from the centre
    diverged_step: float = 1e6  # a step at which Newton's method diverges


SURFACE = SurfaceOptions()


class FoldOptions(Frozen):
    """How folds of the level of the forces are followed in (frequency, level).

    Lengths are in the scaled unknowns: displacements by their own size, the frequency by its range, the level
    by itself.
    """

    min_level: float = 0.25  # level at which a curve of folds is left, being too far below 1,
    max_level: float = 4.0  # and above it
    initial_step: float = 0.01  # step,
    max_step: float = 0.1
    min_step: float = 1e-4  # with which no fold was found any more; of half that width, a strip has ended
    strip_width: float = 3e-3  # widest strip between two curves of folds of which the end is looked for
    target_turn: float = 0.25  # [rad] by which the chord of a step is to leave the tangent,
    max_turn: float = 0.9  # and by which it may at most
    angle_tolerance: float = 0.005  # [rad] to which the direction of the chord is found
    max_tangent: float = 100.0  # times the axes: tangents longer than this are of another part of the surface
    start_circles: tuple[float, ...] = (
        1.0,
        5.0,
        25.0,
    )  # times the first step: circles about a start beside a fold
    corner_roundness: float = (
        0.01  # square of the axes of the ellipse in (frequency, level) that a circle about a fold
    )
    # of a smooth surface is: where it is rounder, the fold is in a corner
    circle_points: int = 16  # places on a circle, where folds are looked for at first and where none is ahead
    max_steps: int = 400  # steps of a curve
    max_retreats: int = 4  # of a curve by a step after which no fold was found, to take a shorter one
    report_interval: int = 16  # steps after which it is reported what they took
    curve_tolerance: float = 0.3  # of a step: a known fold this near to a curve is on it
    work_fraction: float = 0.5  # of the work before, that all curves may take,
    min_seconds: float = 1.0  # and seconds of work that they may in any case

    def covers(self, level: float) -> bool:
        """Whether folds at a level are looked at."""
        return self.min_level < level < self.max_level


FOLDS = FoldOptions()


class LevelOptions(Frozen):
    """Where the level of the forces is followed besides the resonances and the ends of the range."""

    strong_harmonics: int = 3  # harmonics whose resonances are strong enough to keep themselves up
    distinct_frequency: float = 0.02  # to a frequency that was looked at: a closed branch is about as wide
    wide_range: float = 0.1  # of the range: of a range without a stable motion that is wider, halves as well
    max_harmonics: int = 9  # harmonics with which it is followed there: the branches of more are theirs, too
    work_fraction: float = 0.2  # of the work before, that all may take,
    min_seconds: float = 0.1  # and seconds of work that they may in any case


LEVELS = LevelOptions()


class ProlongationOptions(Frozen):
    """Which points of a branch are prolongated to more harmonics."""

    max_of_a_kind: int = 8  # peaks, and folds
    spaced_points: int = 9  # points along the branch
    max_change: float = 0.5  # of a solution's size: what moves further has come to another one
    same_point: float = 1e-6  # of the greatest unknown: a point nearer to a corner or a fold is at it
    harmonics_factor: int = 3  # as many harmonics at once, where Newton's method diverges with all
    tolerance: float = 1e-6  # of a displacement, from which Newton's method ends at the precision of numbers


PROLONGATION = ProlongationOptions()


class BranchingOptions(Frozen):
    """How branches are left at branch points; lengths are in the scaled unknowns."""

    tolerance: float = 1e-4  # of a step, to which a branch point is found
    distances: tuple[float, ...] = (0.003, 0.01, 0.03, 0.1)  # from it at which other branches are looked for
    max_deviation: float = (
        0.9  # of such a distance: what Newton's method finds further away is no such solution
    )
    motion_tolerance: float = 1e-5  # of a displacement: motions that differ by less are the same
    max_rounds: int = 4  # branches that leave branches that leave ...
    max_starts: int = 64  # starts
    min_residual: float = 1e-6  # of a displacement: harmonics that a motion would have more of belong to it
    max_displacement: float = 0.01  # relative, of a branch point's frequency by harmonics that lack
    min_leading_fraction: float = 0.1  # of the greatest, of even harmonics by which a level loses symmetry
    max_level_step: float = 0.1  # longest, of branches that leave a curve of the level
    symmetry_points: int = 16  # of a path, all of which are symmetric if it is


BRANCHING = BranchingOptions()


class FrictionOptions(Frozen):
    """Where contacts shake down, and how friction is raised from none.

    Attributes
    ----------
    load_tolerance : float
        Change of a contact's load, relative to the residual friction of another: less is rounding.
    shakedown_level : float
        Level of the forces below which a contact that began unstressed would slip, although none does at 1.
    difference : float
        Part of the coefficients, by which the residual is differentiated: less than what is between a point
        and the next change of a contact.
    """

    load_tolerance: float = 1e-9
    shakedown_level: float = 0.999
    difference: float = 1e-9


FRICTION = FrictionOptions()


class LevelCurveOptions(Frozen):
    """How the level of the forces is followed at one frequency, from rest.

    Levels are relative to that of the scene. Steps are lengths along the curve in its scaled unknowns, where
    the level is measured by itself.

    Attributes
    ----------
    linear_levels : tuple of float
        Levels at which contacts are nearly linear.
    linear_fraction : float
        Times the least level at which a contact is nonlinear: up to there nothing is to be followed.
    max_step : float
        Longest step,
    max_step_user_points : float
        and where the passings of the level 1 alone matter.
    stalled_fraction : float
        Part of the longest step, where a curve has stalled,
    reversed_fraction : float
        and where it has gone back on itself.
    reversal_tolerance : float
        Relative difference of the levels from which both go back, up to which they are at one corner. Then no
        other step goes on.
    few_harmonics : int
        Harmonics whose curve shows those of more how far they are to be followed,
    few_unknowns : int
        or as many as make this many unknowns.
    reliable_harmonics : int
        Harmonics with which a peak that one harmonic has at twice its height is within some per cent.
    clear_level : float
        Level that a curve has to stay above for that of more harmonics not to come back to 1.
    reach_factor : float
        Times its greatest level before, up to which that of more harmonics is followed.
    level_tolerance : float
        Relative difference by which two ways to one level may differ.
    resonance_offset : float
        Relative distance from a resonance, which an undamped structure has no response at.
    max_gap : float
        Relative distance of two frequencies between which a mode may resonate, from where it is open to
        where it is stuck: in wider gaps the level is followed, too.
    distinct_peak : float
        Relative distance from other such frequencies, from which on that of a peak is used, too, that fewer
        harmonics have and more have lost.
    same_peak : tuple of float
        Relative distance of the frequencies of a peak with fewer harmonics and with more, at most; and part
        of its size that it has with more, at least.
    step : StepOptions
        How its steps are chosen.
    """

    linear_levels: tuple[float, ...] = (1e-3, 1e-6, 1e-9)
    linear_fraction: float = 0.9
    max_step: float = 0.2
    max_step_user_points: float = 1.0
    stalled_fraction: float = 0.5
    reversed_fraction: float = 0.25
    reversal_tolerance: float = 1e-6
    few_harmonics: int = 5
    few_unknowns: int = 64
    reliable_harmonics: int = 3
    clear_level: float = 3.0
    reach_factor: float = 2.0
    level_tolerance: float = 1e-9
    resonance_offset: float = 1e-4
    max_gap: float = 0.25
    distinct_peak: float = 0.01
    same_peak: tuple[float, float] = (0.05, 0.7)
    step: StepOptions = field(default_factory=StepOptions)


LEVEL_CURVE = LevelCurveOptions()


class LevelFoldOptions(Frozen):
    """How folds of the level of the forces are brought to the level 1.

    Attributes
    ----------
    max_level : float
        Folds between this level and its reciprocal may come to 1 within a range,
    stage_factor : float
        by stages, each of so many times the level,
    min_stage : float
        and this part of that where Newton's method does not lead from one to the next.
    offsets : tuple of float
        Part of a solution's size: from one beside a fold to those on either side of the fold.
    max_change : float
        Part of a solution's size: what Newton's method finds further away has little to do with the fold.
    """

    max_level: float = 4.0
    stage_factor: float = 1.25
    min_stage: float = 0.5
    offsets: tuple[float, ...] = (0.02, 0.1)
    max_change: float = 0.5


LEVEL_FOLDS = LevelFoldOptions()


class LinearLimitOptions(Frozen):
    """Up to which level contacts change what they do; levels are relative to that of the scene.

    Attributes
    ----------
    level_factor : float
        Times the level at which the last contact changes what it does, up to which the level is followed,
    max_level : float
        but no further than this level.
    max_kept : int
        Systems of which linear responses are kept, as contacts of a sweep are closed at rest, or open.
    max_resonances : int
        Narrow resonances that are looked at; of more the widest, and so those of the lowest harmonics, as
        each costs a point.
    """

    level_factor: float = 3.0
    max_level: float = 1e4
    max_kept: int = 8
    max_resonances: int = 200


LINEAR_LIMITS = LinearLimitOptions()


class SharedLevelOptions(Frozen):
    """How curves of the level are shared by systems of other preloads.

    Attributes
    ----------
    max_kept : int
        Curves that are kept for each thread.
    extrapolation : float
        Part of the way from a point to the next, by which a solution between them may lie beyond.
    """

    max_kept: int = 32
    extrapolation: float = 1e-3


SHARED_LEVELS = SharedLevelOptions()
