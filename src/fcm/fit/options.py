"""Options of a fit: errors of data that state none, starts, and when a number is undetermined."""

from __future__ import annotations

from fcm.frozen import Frozen


class FitOptions(Frozen):
    """Options on how numbers of a scene are fitted to measured data.

    amplitude_error : error of a measured amplitude, relative to the greatest of its data, where none is
        stated.
    frequency_error : relative error of a measured frequency of a response: as good as none.
    backbone_error : relative error of a measured frequency of a backbone.
    damping_error : error of a measured damping ratio, relative to the greatest of its data.
    search_error : error of all measured values in the search for a start, relative to the extent of the
        data.
    starts : greatest number of starts; the first is the scene's numbers.
    search_share : share of the progress bar for trying the starts.
    weighing_shares : shares of a finalist's progress that are complete after its search, and after each of
        two fits with estimated errors.
    agreeing_starts : number of starts with the same result after which no further one is tried.
    number_tolerance : relative difference up to which two numbers are the same.
    cost_tolerance : relative difference up to which two costs are the same.
    finalists : number of starts whose results are then fitted to all points.
    few_points : number of points of each data set in the search for a start.
    start_evaluations, finalist_evaluations : most evaluations of the model for a start, and for a finalist.
    margin : width of the traced range beyond the data on either side, relative to the width of the data.
    unbounded_factor : factor by which a number without bounds may grow or shrink from the scene's value.
    max_levels, level_step : if the points have many force levels, the greatest number of levels to trace,
        and their least ratio.
    min_effect : change of the data for a factor e of a number, in units of their errors, below which the
        number has no effect.
    max_standard_error : relative standard error of a number above which it is undetermined.
    max_correlation : correlation above which two numbers may be indistinguishable.
    sure_standard_error : relative standard error up to which a number is determined despite any correlation.
    poor_misfit : relative misfit of data above which the model does not describe them.
    remedied : misfit with a common factor or a change of phases, relative to the misfit without, below which
        the change is reported.
    scale_error : error of amplitudes, relative to their greatest, in the search for such a factor. It is so
        large that each measured point is compared with the response at the same frequency.
    confidence : probability of the intervals of the numbers.
    reweightings : greatest number of times that unstated errors are estimated and the fit repeated.
    settled_move : change of the numbers in a repetition, in standard errors, below which it is the last.
    min_error : least error of a measured value, relative to the greatest value; below it is rounding.
    rank_tolerance : singular value, relative to the greatest, below which a combination of numbers has no
        effect at all.
    lost_residual : residual, in units of the errors, that each point gets where the model has no response.
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
    remedied: float = 0.5
    scale_error: float = 1e6
    confidence: float = 0.95
    reweightings: int = 30
    settled_move: float = 1e-3
    min_error: float = 1e-8
    rank_tolerance: float = 1e-10
    lost_residual: float = 1e6


class NearestOptions(Frozen):
    """Options of the search for the point of a curve nearest to a measured one.

    max_steps : greatest number of steps along the curve.
    step_tolerance : length of a step, in units of the errors, below which it is the last.
    max_step : longest step along the curve, in its scaled units.
    max_halvings : greatest number of halvings of a step that leads further away.
    """

    max_steps: int = 30
    step_tolerance: float = 1e-6
    max_step: float = 0.1
    max_halvings: int = 8


class BackboneOptions(Frozen):
    """Options on how a mode of the model is solved at the amplitudes of a measured backbone.

    amplitude_factor, modal_amplitude_factor : factors by which a mode is followed beyond measured
        displacements, and beyond measured modal amplitudes.
    shown_factor : factor by which the fitted mode is shown beyond the measured amplitudes.
    difference : relative step of the difference quotients of the residual by a number, and of an amplitude
        along a direction.
    max_steps, step_tolerance : greatest number of Newton steps in ln a to the measured displacement, and the
        length of a step below which it is the last.
    """

    amplitude_factor: float = 3.0
    modal_amplitude_factor: float = 1.01
    shown_factor: float = 1.1
    difference: float = 1e-5
    max_steps: int = 20
    step_tolerance: float = 1e-10


class AdviceOptions(Frozen):
    """Options on the trial measurements from which the best one is advised.

    level_factors : trial force levels, relative to the least and the greatest measured level.
    max_dofs : greatest number of degrees of freedom for trial measurements; the measured ones come first.
    points : number of points of each trial measurement.
    max_ratio : standard error with the measurement, relative to that without, up to which it is advised.
    min_eigenvalue : eigenvalue of the scaled information below which it is rounding.
    """

    level_factors: tuple[float, ...] = (0.1, 0.3, 3.0, 10.0)
    max_dofs: int = 4
    points: int = 40
    max_ratio: float = 0.5
    min_eigenvalue: float = 1e-14


FIT, NEAREST, BACKBONE, ADVICE = FitOptions(), NearestOptions(), BackboneOptions(), AdviceOptions()
