"""What decides how numbers are fitted: errors taken for granted, starts, when one is undetermined."""

from __future__ import annotations

from fcm.frozen import Frozen


class FitOptions(Frozen):
    """How numbers are fitted.

    amplitude_error : of a measured amplitude, relative to the greatest of its data, where nothing is said.
    frequency_error : of a measured frequency of a response, relative; as good as none.
    backbone_error : of a measured frequency of a backbone, relative.
    damping_error : of a measured damping ratio, relative to the greatest of its data.
    search_error : errors of both while a start is sought, relative to the extent of the data.
    starts : how many are tried, the numbers of the scene first.
    search_share : share of the work that is done when the starts are.
    weighing_shares : of that of a finalist, what is done after its search, and after each of two with errors
        estimated.
    agreeing_starts : starts that lead to the same numbers, after which no further one is tried.
    number_tolerance : relative difference of numbers that are the same.
    cost_tolerance : relative difference of costs that are the same.
    finalists : starts whose numbers are then fitted to all points.
    few_points : of each data while a start is sought.
    start_evaluations, finalist_evaluations : evaluations of a start, and of a finalist.
    margin : of the range that is traced, on both sides of the data, relative to their width.
    unbounded_factor : from which part of a number to which multiple it may go without bounds.
    max_levels, level_step : of the forces that are traced where every point has its own: at most so many,
        and no nearer to one another than by this ratio.
    min_effect : rate in units of the errors, by a factor e of a number, below which it has none.
    max_standard_error : standard error of a number, relative, from which it is undetermined.
    max_correlation : from which two numbers may not be distinguishable.
    sure_standard_error : standard error of a number, relative, up to which it is determined whatever it is
        correlated with.
    poor_misfit : misfit of data, relative, from which the model does not meet them.
    confidence : of the intervals.
    reweightings : times at most that errors which are not stated are estimated, and the fit is made again.
    settled_move : of the numbers by this, in standard errors, below which they rest.
    min_error : of a measured value, relative to the greatest: what is below is rounding.
    rank_tolerance : of the greatest singular value, below which a combination of numbers is not seen at all.
    lost_residual : where the model has no response, in units of the errors.
    """

    amplitude_error: float = 0.01
    frequency_error: float = 1e-6
    backbone_error: float = 1e-3
    damping_error: float = 0.05
    search_error: float = 0.02
    starts: int = 8
    search_share: float = 0.7
    weighing_shares: tuple[float, float, float] = (0.6, 0.8, 1.0)
    agreeing_starts: int = 2
    number_tolerance: float = 1e-2
    cost_tolerance: float = 1e-6
    finalists: int = 2
    few_points: int = 60
    start_evaluations: int = 25
    finalist_evaluations: int = 60
    margin: float = 0.1
    unbounded_factor: float = 100.0
    max_levels: int = 9
    level_step: float = 1.2
    min_effect: float = 1e-3
    max_standard_error: float = 0.5
    max_correlation: float = 0.98
    sure_standard_error: float = 0.05
    poor_misfit: float = 0.1
    confidence: float = 0.95
    reweightings: int = 30
    settled_move: float = 1e-3
    min_error: float = 1e-8
    rank_tolerance: float = 1e-10
    lost_residual: float = 1e6


class NearestOptions(Frozen):
    """How the nearest point of a curve is found.

    max_steps : at most, along the curve.
    step_tolerance : of the last of them, in units of the errors.
    max_step : step along the curve, in its own scaled units.
    max_halvings : of a step that leads further away.
    """

    max_steps: int = 30
    step_tolerance: float = 1e-6
    max_step: float = 0.1
    max_halvings: int = 8


class BackboneOptions(Frozen):
    """How a mode of the model is met at the amplitudes of a backbone.

    amplitude_factor, modal_amplitude_factor : by which it is followed past the amplitudes measured; past
        modal ones.
    shown_factor : by which the fitted mode is shown past the amplitudes measured.
    difference : of the residual by a number, and of an amplitude along a direction, relative.
    max_steps, step_tolerance : at most, to where a displacement has its amplitude, and the last of them in
        ln a.
    """

    amplitude_factor: float = 3.0
    modal_amplitude_factor: float = 1.01
    shown_factor: float = 1.1
    difference: float = 1e-5
    max_steps: int = 20
    step_tolerance: float = 1e-10


class AdviceOptions(Frozen):
    """Which measurements are imagined.

    level_factors : of the least and the greatest level that were measured.
    max_dofs : at most, those measured first.
    points : of each.
    max_ratio : part of the standard error that it has to leave at most, to be worth a sentence.
    min_eigenvalue : eigenvalue of the scaled information, below which it is rounding.
    """

    level_factors: tuple[float, ...] = (0.1, 0.3, 3.0, 10.0)
    max_dofs: int = 4
    points: int = 40
    max_ratio: float = 0.5
    min_eigenvalue: float = 1e-14


FIT, NEAREST, BACKBONE, ADVICE = FitOptions(), NearestOptions(), BackboneOptions(), AdviceOptions()
