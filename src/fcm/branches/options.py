"""Tolerances and limits of the search for branches."""

from __future__ import annotations

from dataclasses import field

from fcm.continuation.options import StepOptions
from fcm.frozen import Frozen


class SurfaceOptions(Frozen):
    """Options on how points on the surface of all solutions are found.

    Lengths are in the scaled unknowns.
    """

    # least unit of the level of the forces: the unit of a higher level is the level itself
    level_floor: float = 0.1
    max_iterations: int = 8  # number of Newton steps after which a guess is given up as too far away
    tolerance: float = 1e-4  # length of the last Newton step: the error that is left is about its square
    singular_step: float = 1e-7  # length of the last Newton step below which the matrix is not factored anew
    diverged_step: float = 1e6  # length of a Newton step from which on the iteration counts as divergent


SURFACE = SurfaceOptions()


class FoldOptions(Frozen):
    """Options on how folds of the level of the forces are followed in (frequency, level).

    Lengths are in the scaled unknowns: displacements by their own size, the frequency by its range, the level
    by itself.
    """

    min_level: float = 0.25  # level below which a curve of folds is given up: too far below 1
    max_level: float = 4.0  # level above which a curve of folds is given up: too far above 1
    initial_step: float = 0.01  # length of the first step
    max_step: float = 0.1  # length of the longest step
    min_step: float = 1e-4  # step below which no fold is sought any more; a strip half as wide has ended
    # width of a strip between two curves of folds, up to which the end of the strip is sought
    strip_width: float = 3e-3
    target_turn: float = 0.25  # [rad] target for the angle between the chord of a step and the tangent
    # [rad] angle between the chord of a step and the tangent within which the next place is sought
    max_turn: float = 0.9
    angle_tolerance: float = 0.005  # [rad] error to which the direction of the chord is found
    # tangent relative to the axes from which on a place lies on another part of the surface
    max_tangent: float = 100.0
    # radii, relative to `initial_step`, of the circles about a start on which folds are sought in turn
    start_circles: tuple[float, ...] = (1.0, 0.1, 0.01, 5.0, 25.0)
    # ratio of the squared axes of the ellipse that a circle about a fold of a smooth surface maps to, in
    # (frequency, level): where it is rounder, the fold lies in a corner
    corner_roundness: float = 0.01
    circle_points: int = 16  # number of places on a circle between which folds are sought
    max_steps: int = 400  # most steps of a curve of folds
    # most times that a curve goes back by a step, and takes a shorter one, as no fold was found
    max_retreats: int = 4
    report_interval: int = 16  # number of steps after which their work is charged to the budget
    # distance of a known fold from a chord of a curve, relative to the chord, below which it is on it
    curve_tolerance: float = 0.3
    work_fraction: float = 0.5  # most work of all curves of folds, relative to the work done before
    min_seconds: float = 1.0  # [s] work that the curves of folds may take in any case

    def covers(self, level: float) -> bool:
        """Whether folds at a level are followed."""
        return self.min_level < level < self.max_level


FOLDS = FoldOptions()


class LevelOptions(Frozen):
    """Options on where the force level is followed besides resonances and the ends of the range."""

    # highest harmonic whose resonances are assumed to be strong enough to sustain a motion of their own
    strong_harmonics: int = 3
    # relative distance from a known frequency, up to which the level is not followed again: a closed branch
    # is about as wide
    distinct_frequency: float = 0.02
    # width of a gap without a stable motion, relative to the frequency range, above which its halves are
    # searched, too
    wide_range: float = 0.1
    # number of harmonics with which the level is followed: further ones have the same branches
    max_harmonics: int = 9
    work_fraction: float = 0.2  # most work of all these curves, relative to the work done before
    min_seconds: float = 0.1  # [s] work that these curves may take in any case


LEVELS = LevelOptions()


class ProlongationPointOptions(Frozen):
    """Options on which points of a branch are prolongated to more harmonics."""

    max_of_a_kind: int = 8  # most peaks, and most folds, that are prolongated
    spaced_points: int = 9  # number of points, evenly spaced along the branch, that are prolongated, too
    # change of the solution, relative to its size, from which on it counts as another one
    max_change: float = 0.5
    # distance from a corner or a fold, relative to the greatest unknown, below which both coincide
    same_point: float = 1e-6
    # ratio of the numbers of harmonics of two stages, used where Newton's method diverges with all at once
    harmonics_factor: int = 3
    # length of the last Newton step, relative to a displacement: with less, steps end at rounding
    tolerance: float = 1e-6


PROLONGATION_POINTS = ProlongationPointOptions()


class BranchingOptions(Frozen):
    """Options on how branches are left at branch points.

    Lengths are in the scaled unknowns.
    """

    tolerance: float = 1e-4  # error of a branch point's place, relative to the step in which it lies
    # distances from a branch point at which other branches are sought, in turn
    distances: tuple[float, ...] = (0.003, 0.01, 0.03, 0.1)
    # distance of a solution from its guess, relative to that one of `distances`, beyond which it is rejected
    max_deviation: float = 0.9
    # difference of two motions, relative to a displacement, below which they are the same
    motion_tolerance: float = 1e-5
    max_rounds: int = 4  # most rounds, each of which leaves the branches found by the one before
    max_starts: int = 64  # most branch points that are left by other branches
    # residual of harmonics left out, relative to a displacement, from which on they belong to the motion
    min_residual: float = 1e-6
    # largest relative change of a branch point's frequency by lacking harmonics that is ignored
    max_displacement: float = 0.01
    # size of an even harmonic, relative to the greatest, above which it counts where a level loses symmetry
    min_leading_fraction: float = 0.1
    max_level_step: float = 0.1  # longest step of branches that leave a curve of the level
    # highest even harmonic by which few contacts may lose their symmetry, relative to the highest balanced
    even_factor: float = 2.0
    symmetry_points: int = 16  # number of points at which the symmetry of a path is tested


BRANCHING = BranchingOptions()


class FrictionOptions(Frozen):
    """Options on where contacts shake down, and how friction is raised from zero.

    Attributes
    ----------
    load_tolerance : float
        Change of a contact's load, relative to the residual friction of another, below which it counts as
        rounding.
    shakedown_level : float
        Level of the forces below which a contact that began unstressed would slip, although none does at 1.
    difference : float
        Step of the residual's difference quotient, relative to the coefficients of friction. It is less than
        the distance from a point to the next change of a contact.
    """

    load_tolerance: float = 1e-9
    shakedown_level: float = 0.999
    difference: float = 1e-9


FRICTION = FrictionOptions()


class LevelCurveOptions(Frozen):
    """Options on how the level of the forces is followed at one frequency, from rest.

    Levels are relative to that of the scene. Steps are lengths along the curve in its scaled unknowns; the
    unit of the level is the level itself.

    Attributes
    ----------
    linear_levels : tuple of float
        Levels at which contacts are nearly linear, tried in turn as starts of the curve.
    linear_fraction : float
        Level at which the curve starts, relative to the least level at which a contact is nonlinear: below it
        the response is linear.
    max_step : float
        Longest step of the curve where its course matters.
    max_step_user_points : float
        Longest step where only the points at the level 1 matter.
    stalled_fraction : float
        Longest step of the next attempt, relative to `max_step`, after a curve has stalled.
    reversed_fraction : float
        Longest step of the next attempt, relative to that of the one before, after a curve has gone back on
        itself.
    reversal_tolerance : float
        Relative difference of the levels at which both attempts go back, up to which it is the same corner.
        Then no other step leads further.
    few_harmonics : int
        Most harmonics whose curve shows how far that of more is to be followed.
    few_unknowns : int
        Number of unknowns that limits those few harmonics if contacts are many.
    reliable_harmonics : int
        Number of harmonics with which a peak is accurate to some per cent, although one harmonic may give
        twice its height.
    clear_level : float
        Level above which a curve has to stay, so that the curve of more harmonics is assumed not to come back
        to 1.
    reach_factor : float
        Level up to which the curve of more harmonics is followed, relative to the greatest level before the
        few harmonics' curve stays above `clear_level`.
    level_tolerance : float
        Relative difference of two levels, computed in two ways, up to which they are the same.
    resonance_offset : float
        Relative distance from a resonance at which the response is computed: at the resonance itself an
        undamped structure has none.
    max_gap : float
        Relative distance of two frequencies at which the level is followed, above which more are inserted
        between them, where a mode may resonate, from all contacts open to all stuck.
    distinct_peak : float
        Relative distance of a peak from those frequencies, above which the level is followed at that peak,
        too. The peak is one that fewer harmonics have, and more have lost.
    same_peak : tuple of float
        Two conditions for a peak of fewer harmonics to be met by one of more: greatest relative distance of
        their frequencies; and least size with more harmonics, relative to that with fewer.
    step : StepOptions
        Options of the step control.
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
    same_peak: tuple[float, float] = (0.02, 0.7)
    step: StepOptions = field(default_factory=StepOptions)


LEVEL_CURVE = LevelCurveOptions()


class LevelFoldOptions(Frozen):
    """Options on how folds of the level of the forces are brought to the level 1.

    Attributes
    ----------
    max_level : float
        Level, and its reciprocal, between which folds are brought to the level 1.
    stage_factor : float
        Ratio of the levels of two stages on the way to the level 1.
    min_stage : float
        Shortest stage, in the logarithm of the level, relative to the first: where Newton's method fails, a
        stage is halved down to this.
    offsets : tuple of float
        Distances along the curve, relative to a solution's size, at which solutions on either side of the
        fold are sought.
    max_change : float
        Change of a solution in a stage, relative to its size, from which on it no longer belongs to the fold.
    """

    max_level: float = 4.0
    stage_factor: float = 1.25
    min_stage: float = 0.5
    offsets: tuple[float, ...] = (0.02, 0.1)
    max_change: float = 0.5


LEVEL_FOLDS = LevelFoldOptions()


class LinearLimitOptions(Frozen):
    """Options on the level up to which contacts keep their states; levels are relative to that of the scene.

    Attributes
    ----------
    level_factor : float
        Level up to which the curve is followed, relative to the one at which the last contact changes its
        state.
    max_level : float
        Level beyond which the curve is never followed.
    max_kept : int
        Most systems whose linear responses are kept, for the next systems of a sweep.
    max_resonances : int
        Most narrow resonances at which a point is computed. If there are more, the widest are taken, and so
        those of the lowest harmonics.
    """

    level_factor: float = 3.0
    max_level: float = 1e4
    max_kept: int = 8
    max_resonances: int = 200


LINEAR_LIMITS = LinearLimitOptions()


class SharedLevelOptions(Frozen):
    """Options on how curves of the level are shared by systems with other preloads.

    Attributes
    ----------
    max_kept : int
        Most curves that are kept in each thread.
    extrapolation : float
        Distance beyond the end of a chord between two points, relative to the chord, up to which a solution
        counts as between them.
    """

    max_kept: int = 32
    extrapolation: float = 1e-3


SHARED_LEVELS = SharedLevelOptions()
