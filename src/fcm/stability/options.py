"""Tolerances and limits of the stability of balanced motions.

`StabilityOptions` has them all. It is an argument of `multipliers_of` and of `stability`.
"""

from __future__ import annotations

from fcm.continuation.options import SIGN_CHANGE, SignChangeOptions
from fcm.frozen import Frozen


class ClassificationOptions(Frozen):
    """Options on what multipliers say of one solution.

    Attributes
    ----------
    growth_tolerance : float
        Growth, the logarithm of the largest multiplier's size, up to which a motion counts as stable.
    real_uncertainty : float
        Logarithm of a real multiplier up to which truncation may have put it on the wrong side of 1.
    shift_factor : float
        Logarithm of a real multiplier, relative to its shift between the balanced harmonics and more, up to
        which it may be on the wrong side of 1. The larger of both limits holds.
    flip_angle : float
        [rad] Angle from -1 within which a pair of multipliers is followed closely: there modes flip.
    small_multiplier : float
        Size of a multiplier below which it is far from growth, wherever it turns.
    neutral_tolerance : float
        Distance from 1 below which the multipliers of an unconstrained mode of zero frequency are left out.
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
        Number of modes above which those far above the excitation are taken to follow without delay.
    many_contacts : int
        Number of contacts on a line from which on each change of one contact's state updates the matrices.
    above_excitation, above_harmonics : float
        Frequency of a mode above which it is far, relative to the excitation, and relative to its highest
        harmonic; the larger limit holds.
    above_of_few : float
        Factor on that limit where modes are few and contacts in a plane.
    min_yield : float
        Compliance of the far modes along a combination of contacts, relative to their springs, up to which
        the structure is taken as rigid along it.
    max_cached : int
        Number of disturbances up to which the last workspace is used again.
    max_entries : int
        Number of matrix entries from which on no further point is added to one call of LAPACK.
    max_disturbances : int
        Most disturbances of the sectors of a ring. With more a point takes seconds, and stability is reported
        as unknown.
    """

    many_modes: int = 24
    many_contacts: int = 12
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
        Decay in a period, as a logarithm, that truncation hardly turns into growth: it needs no confirmation.
    decay_ratio : float
        Decay in a period, relative to what further harmonics add to the displacements, that needs no
        confirmation: light impacts may turn a smaller decay into growth. The larger limit holds.
    growth_ratio : float
        Growth in a period, relative to what further harmonics add, up to which truncation may have made it.
    min_addition : float
        Addition of further harmonics, relative to the displacements, below which it is neglected if no
        contact slips or opens.
    frequency_step : float
        First relative change of the frequency that shows how fast a pair of multipliers turns towards -1.
    max_frequency_change : float
        Relative change of the frequency within which the pair has to meet at -1: otherwise it does not.
    max_evaluations : int
        Most frequencies at which that is computed.
    meeting_tolerance : float
        Square of the pair's angle [rad] from -1, below which it counts as met.
    meeting_decay : float
        Decay in a period, as a logarithm, that the pair needs where it meets, to stay stable.
    tolerance : float
        Error of a solution of many contacts with more harmonics, relative to its distance from the start.
    max_change : float
        Distance of a solution with more harmonics, relative to its size, above which it is another one.
    homotopy_parts : tuple of float
        Parts of the further harmonics' equations in a homotopy, used where all at once do not converge.
    max_unknowns : int
        Number of unknowns from which on this homotopy is not tried.
    point_interval : int
        Number of points from one confirmed point to the next, with few contacts. The middle between them is
        confirmed, too, and more where the growth does not lie on a line.
    max_fraction_of_many : float
        Most confirmed points of a curve of many contacts, relative to all its points. The others are not
        confirmed.
    max_addition : float
        Addition of the harmonics beyond the further ones, relative to the displacements, up to which a motion
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
        Error of a predicted minimum, relative to the differences between the three values that predict it.
    margin_reduction : float
        Factor on that margin for each division of an interval: differences fall with its square, errors with
        its cube.
    max_multipliers : int
        Number of multipliers above which no window is sought: two are then always about to meet.
    min_size : float
        Size of a multiplier up to which it is left out.
    min_length : float
        Length of an interval, relative to the size of the solution, below which it is not divided.
    min_distance : float
        Least distance of a new place from the two around it, relative to their distance; a window may begin
        nearer to one of them.
    max_divisions : int
        Most divisions of the interval between two places.
    edge_distance : float
        Distance of two places, relative to the step, up to which no edge of a window is sought between them.
    angle_factor, angle_margin : float
        The angle by which two multipliers may approach one another is angle_factor times the angle by which
        multipliers turn, plus angle_margin [rad].
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
    """Options on which points of a path are classified, and on locating changes of stability between them.

    Attributes
    ----------
    interval_one_harmonic : int
        Number of points from one that is always classified to the next, with one harmonic.
    interval_several_harmonics : int
        Number of points from one that is always classified to the next, with several harmonics, where the
        growth jumps as a contact's states change.
    interval_many_contacts : int
        Number of points from one that is always classified to the next, with many contacts and several
        harmonics: each contact changes the growth by little.
    max_deviation : float
        Deviation of the growth at a middle point from a straight line, relative to its size, from which on
        more points are classified.
    safe_growth : float
        Growth below which such a deviation is ignored.
    sufficient_decay : float
        Growth that stands for any smaller one.
    max_phase : float
        [rad] Angle by which multipliers that are not small may turn from one classified point to the next.
    tolerance : float
        Error of the place of a crossing, relative to the step.
    tolerance_many_contacts : float
        The same error with many contacts, where one evaluation takes as long as tens of points of the curve.
    confirmed_tolerance : float
        The same error where classifications have to be confirmed, so that the growth may jump from one motion
        to a finer one.
    growth_tolerance : float
        Size of the growth below which a crossing is found.
    max_evaluations : int
        Most classifications for one crossing.
    sign_change : SignChangeOptions
        How the crossing is bracketed.
    """

    interval_one_harmonic: int = 16
    interval_several_harmonics: int = 4
    interval_many_contacts: int = 8
    max_deviation: float = 1.0
    safe_growth: float = -0.05
    sufficient_decay: float = -0.3
    max_phase: float = 1.5
    tolerance: float = 1e-7
    tolerance_many_contacts: float = 1e-2
    confirmed_tolerance: float = 1e-4
    growth_tolerance: float = 1e-10
    max_evaluations: int = 60
    sign_change: SignChangeOptions = SIGN_CHANGE


class HillOptions(Frozen):
    """Options of Hill's method, which replaces the monodromy matrix if contacts have laws of their own.

    Attributes
    ----------
    min_offset : float
        Mean harmonic of a disturbance above which it may be a copy of another, shifted by whole harmonics.
    multiplier_tolerance : float
        Relative difference of the multipliers of two disturbances, below which one is such a copy.
    """

    min_offset: float = 0.25
    multiplier_tolerance: float = 1e-9


class PlanarStabilityOptions(Frozen):
    """Options on how disturbances of contacts in a plane are propagated.

    Attributes
    ----------
    stages : tuple of int
        Numbers of Radau points that a step may have, ascending. A step takes the number that reaches the next
        event at the least cost.
    tolerance : float
        Last Legendre coefficient of the velocities over a step, relative to the size of a disturbance, up to
        which the step is accepted. The error of multipliers is about a twentieth of it.
    coefficient_floor : float
        Least value taken for that coefficient, relative to the last but one: it may vanish by chance.
    end_factor : float
        Factor on the tolerance for steps that end where a slipping contact opens, or begin where one closes.
    max_step : float
        [rad] Longest step.
    min_factor, max_factor, safety : float
        Least and greatest ratio of a step to the one before, and the factor on what the tolerance allows.
    max_retry_factor : float
        Greatest ratio of a rejected step's next attempt to it.
    min_step : float
        [rad] Shortest step; stability is unknown if a shorter one would be needed.
    max_disturbances : int
        Most disturbances; with more, stability is unknown.
    initial_panels : int
        Initial room for panels of slip of a contact.
    event_tolerance : float
        [rad] Distance of two events up to which they count as one, as with contacts that mirror one another.
        The error of multipliers is about as large.
    min_gap : float
        [rad] Distance of two events above which a period may begin between them.
    """

    stages: tuple[int, ...] = (3, 5, 7)
    tolerance: float = 1e-4
    coefficient_floor: float = 0.1
    end_factor: float = 0.01
    max_step: float = 1.0
    min_factor: float = 0.2
    max_factor: float = 2.5
    safety: float = 0.8
    max_retry_factor: float = 0.7
    min_step: float = 1e-13
    max_disturbances: int = 800
    initial_panels: int = 200
    event_tolerance: float = 1e-7
    min_gap: float = 1e-6


class PropagationOptions(Frozen):
    """Options on how disturbances of contacts on a line are propagated between changes of state.

    Attributes
    ----------
    max_states, max_numbers : int
        Most states of the contacts whose matrices are kept, and most numbers in these matrices.
    max_condition : float
        Condition number of the eigenvectors of a state above which they are not used.
    step_radians, step_radians_of_many : float
        [rad] Angle of the fastest motion in a step of the series, with few contacts and with many.
    series_tolerance : float
        Bound of the last term of the series, relative to the first.
    blas_products : int
        Number of multiplications of a matrix product above which it is left to BLAS.
    max_steps : float
        Number of steps of the series above which the matrix exponential is squared instead.
    few_disturbances : int
        Number of disturbances up to which the matrix exponential itself is computed, by squaring.
    squared_radians : float
        [rad] Angle of the fastest motion above which the exponential is squared. Its series has ten terms,
        complete at 0.25.
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
    """All options of stability, grouped by purpose; see the class of each field."""

    classification: ClassificationOptions = ClassificationOptions()
    structure: StructureOptions = StructureOptions()
    confirmation: ConfirmationOptions = ConfirmationOptions()
    windows: WindowOptions = WindowOptions()
    sampling: SamplingOptions = SamplingOptions()
    hill: HillOptions = HillOptions()
    planar: PlanarStabilityOptions = PlanarStabilityOptions()
    propagation: PropagationOptions = PropagationOptions()


STABILITY = StabilityOptions()  # the defaults
