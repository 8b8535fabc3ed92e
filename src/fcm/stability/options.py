"""Tolerances and limits of the stability of balanced motions.

`StabilityOptions` has them all. It is an argument of `multipliers_of` and of `stability`.
"""

from __future__ import annotations

from fcm.continuation.options import SIGN_CHANGE, SignChangeOptions
from fcm.frozen import Frozen


class ClassificationOptions(Frozen):
    """What multipliers say of one solution.

    Attributes
    ----------
    growth_tolerance : float
        Of a multiplier over 1, up to which a motion is stable.
    real_uncertainty : float
        Logarithm of a real multiplier that truncation may put on the wrong side of 1 in any case.
    shift_factor : float
        Times the shift of one from the balanced harmonics to more, which may be on the wrong side, too.
    flip_angle : float
        [rad] from -1, within which a pair is followed as it passes, as modes flip there.
    small_multiplier : float
        Multipliers below are far from growth, wherever they turn.
    neutral_tolerance : float
        Distance from 1 of the multipliers of a mode of zero frequency that nothing holds.
    """

    growth_tolerance: float = 1e-7
    real_uncertainty: float = 0.02
    shift_factor: float = 2.0
    flip_angle: float = 0.4
    small_multiplier: float = 0.75
    neutral_tolerance: float = 1e-5


class StructureOptions(Frozen):
    """The structure whose disturbances are followed.

    Attributes
    ----------
    many_modes : int
        With more, those far above the excitation follow without delay.
    many_contacts : int
        From so many on a change of one's state is followed as that.
    flexible_contacts : int
        The same of contacts in a plane, where some modes follow without delay.
    above_excitation, above_harmonics : float
        Times the excitation, and times the highest harmonic, from where modes are far.
    above_of_few : float
        Times that, with fewer modes, and contacts in a plane.
    min_yield : float
        Of many contacts' springs, by which the structure yields along a combination of modes that are far:
        along others it is taken as rigid.
    max_cached : int
        Disturbances; with fewer the last workspace is used again.
    max_entries : int
        Entries of the matrices of points that are held at once, whose eigenvalues are found together.
    max_disturbances : int
        Of the sectors of a ring; with more a point takes seconds, and stability is unknown.
    """

    many_modes: int = 24
    many_contacts: int = 12
    flexible_contacts: int = 2
    above_excitation: float = 6.0
    above_harmonics: float = 1.5
    above_of_few: float = 2.0
    min_yield: float = 1e-3
    max_cached: int = 12
    max_entries: int = 20_000
    max_disturbances: int = 600


class ConfirmationOptions(Frozen):
    """Whether further harmonics may change a classification.

    Attributes
    ----------
    safe_decay : float
        Logarithm in a period, which truncation hardly makes a growth.
    decay_ratio : float
        Times what further harmonics add to the displacements, that such a decay also is; light impacts
        make that of it.
    growth_ratio : float
        The same of a growth that truncation may have made.
    min_addition : float
        Part of the displacements that further harmonics add; less may be none.
    frequency_step : float
        Relative change of the frequency, by which it is found how fast a pair turns towards -1.
    max_frequency_change : float
        Change of the frequency until it meets there.
    max_evaluations : int
        Until then.
    meeting_tolerance : float
        Square of the angle [rad] that is then left.
    meeting_decay : float
        Logarithm of the decay there.
    tolerance : float
        Part of the way to a solution of many contacts with more harmonics, to which that is known.
    max_change : float
        Of a solution's size; one with more harmonics that is further away is another.
    homotopy_parts : tuple of float
        Of the further harmonics' equations, where all at once are too much.
    max_unknowns : int
        From so many on these are not tried.
    point_interval : int
        Points from one that is looked at to the next, of few contacts; between them the middle is, too, and
        more where the growth is not on a line.
    max_fraction_of_many : float
        Points of a curve of many contacts that are looked at, at most, over all that it has: the others are
        not confirmed.
    max_addition : float
        Part of the displacements that the harmonics beyond the further ones may add to a motion that
        confirms.
    """

    safe_decay: float = 0.05
    decay_ratio: float = 200.0
    growth_ratio: float = 4.0
    min_addition: float = 1e-6
    frequency_step: float = 1e-4
    max_frequency_change: float = 0.05
    max_evaluations: int = 8
    meeting_tolerance: float = 1e-3
    meeting_decay: float = 1e-3
    tolerance: float = 1e-6
    max_change: float = 0.5
    homotopy_parts: tuple[float, ...] = (0.1, 0.25, 0.45, 0.7, 1.0)
    max_unknowns: int = 240
    point_interval: int = 16
    max_fraction_of_many: float = 0.25
    max_addition: float = 0.05


class WindowOptions(Frozen):
    """Windows of stability that are hidden between two points.

    Attributes
    ----------
    margin : float
        Part of the differences between three values, by which what they foretell may be too high.
    margin_reduction : float
        Of it, each time that the way was divided, as differences fall by squares and errors by cubes.
    max_multipliers : int
        With more, two are always about to meet.
    min_size : float
        Of multipliers that matter.
    min_length : float
        A way, relative to the size of the solution, that is not divided.
    min_distance : float
        Part of the way between two places; none nearer to one of them is looked at, but a window may
        begin there.
    max_divisions : int
        Divisions of a way, at most.
    edge_distance : float
        Part of a step; between places nearer than this the edge of a window is not looked for.
    angle_factor, angle_margin : float
        Times the angle by which multipliers turn, and [rad], by which two may come nearer to one another.
    """

    margin: float = 0.1
    margin_reduction: float = 0.5
    max_multipliers: int = 60
    min_size: float = 0.5
    min_length: float = 1e-3
    min_distance: float = 0.1
    max_divisions: int = 4
    edge_distance: float = 0.3
    angle_factor: float = 1.5
    angle_margin: float = 0.4


class SamplingOptions(Frozen):
    """Which points of a path are looked at, and where stability changes between them.

    Attributes
    ----------
    interval_one_harmonic : int
        Points of one harmonic, from one that is always looked at to the next.
    interval_several_harmonics : int
        Of more, as the growth jumps where a contact's states change.
    interval_many_contacts : int
        Of many contacts with more harmonics, of which each changes the growth by little.
    max_deviation : float
        Of the growth from a straight line, over its own size, that is followed up.
    safe_growth : float
        Growth; less is not followed up.
    sufficient_decay : float
        Growth that counts as any that is less.
    max_phase : float
        [rad] by which multipliers that are not small turn at most, from one point to the next.
    tolerance : float
        Part of a step, to which a crossing is known.
    confirmed_tolerance : float
        The same where classifications are confirmed and the growth jumps, as it may from one motion to a
        finer one.
    growth_tolerance : float
        Growth at a crossing.
    max_evaluations : int
        At a crossing, at most.
    sign_change : SignChangeOptions
        How it is bracketed.
    """

    interval_one_harmonic: int = 16
    interval_several_harmonics: int = 4
    interval_many_contacts: int = 8
    max_deviation: float = 1.0
    safe_growth: float = -0.05
    sufficient_decay: float = -0.3
    max_phase: float = 1.5
    tolerance: float = 1e-7
    confirmed_tolerance: float = 1e-4
    growth_tolerance: float = 1e-10
    max_evaluations: int = 60
    sign_change: SignChangeOptions = SIGN_CHANGE


class HillOptions(Frozen):
    """Hill's method, of contacts with laws of one's own.

    Attributes
    ----------
    min_offset : float
        Mean harmonic of a disturbance, from which on another one may be the same.
    multiplier_tolerance : float
        Relative difference of the multipliers of two that are.
    """

    min_offset: float = 0.25
    multiplier_tolerance: float = 1e-9


class PlanarStabilityOptions(Frozen):
    """How disturbances of contacts in a plane are followed.

    stages, stages_of_many: Radau's points of a step, of few and of many contacts. tolerance: of the
    velocities' last coefficient in Legendre's polynomials over a step, beside the size of a disturbance;
    multipliers err by about a thousandth of it. tolerance_of_many: the same of many contacts, of which
    multipliers err by about a hundredth. coefficient_floor: of the last coefficient but one, what the last
    is taken for at least, as it may vanish by chance. end_factor: times the tolerance, what steps may leave
    out that end where a slipping contact opens, or begin where it closes. max_step: step [rad]. min_factor,
    max_factor, safety: limits of the ratio of two steps, and what it is multiplied by. max_retry_factor: the
    same limit of a step that is taken again, shorter. min_step: [rad]; where none as short will do, stability
    is unknown.

    max_disturbances, most_of_many: disturbances that are followed, of few and of many contacts; with more,
    stability is unknown. initial_panels: of slip that are recorded for a contact at first. event_tolerance:
    [rad] between events that are one, as those of contacts that mirror one another are; multipliers err by
    about as much. min_gap: [rad] between events, from where on a period may begin between them.
    """

    stages: int = 5
    stages_of_many: int = 7
    tolerance: float = 8e-5
    tolerance_of_many: float = 1e-3
    coefficient_floor: float = 0.1
    end_factor: float = 0.01
    max_step: float = 1.0
    min_factor: float = 0.2
    max_factor: float = 2.5
    safety: float = 0.8
    max_retry_factor: float = 0.7
    min_step: float = 1e-13
    max_disturbances: int = 160
    most_of_many: int = 800
    initial_panels: int = 200
    event_tolerance: float = 1e-7
    min_gap: float = 1e-6


class PropagationOptions(Frozen):
    """How disturbances of contacts on a line are carried through a state of the contacts.

    Attributes
    ----------
    max_states, max_numbers : int
        States of the contacts that are remembered, and the numbers that their matrices may have.
    max_condition : float
        Of the eigenvectors of a state; worse ones are not used.
    step_radians, step_radians_of_many : float
        [rad] of the fastest motion in a step of the series; and with many contacts.
    series_tolerance : float
        Bound of the last term of the series, relative to the first.
    blas_products : int
        Products of a matrix from which on BLAS is faster.
    max_steps : float
        Steps that take longer than to square the exponential.
    few_disturbances : int
        Up to which the exponential itself is made, by squaring.
    squared_radians : float
        [rad] of the fastest motion, from which it is squared. Its series has ten terms, complete at 0.25.
    """

    max_states: int = 256
    max_numbers: int = 4_000_000
    max_condition: float = 1e6
    step_radians: float = 6.0
    step_radians_of_many: float = 3.0
    series_tolerance: float = 1e-13
    blas_products: int = 3000
    max_steps: float = 3.0
    few_disturbances: int = 12
    squared_radians: float = 0.25


class StabilityOptions(Frozen):
    """All of the package, by what they are for: see the class of each field."""

    classification: ClassificationOptions = ClassificationOptions()
    structure: StructureOptions = StructureOptions()
    confirmation: ConfirmationOptions = ConfirmationOptions()
    windows: WindowOptions = WindowOptions()
    sampling: SamplingOptions = SamplingOptions()
    hill: HillOptions = HillOptions()
    planar: PlanarStabilityOptions = PlanarStabilityOptions()
    propagation: PropagationOptions = PropagationOptions()


STABILITY = StabilityOptions()  # where nothing else is said
