"""What decides how numbers are fitted: errors taken for granted, starts, and when a number is not told."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class FitOptions:
    """How numbers are fitted.

    amplitude_error : of a measured amplitude, relative to the greatest of its data, where nothing is said.
    frequency_error : of a measured frequency of a response, relative; as good as none.
    backbone_error : of a measured frequency of a backbone, relative.
    damping_error : of a measured damping ratio, relative to the greatest of its data.
    blurred : errors of both while a start is sought, relative to the extent of the data.
    starts : how many are tried, the numbers of the scene first.
    seeking : share of the work that is done when the starts are.
    agreeing : starts that lead to the same numbers, after which no further one is tried.
    same : relative difference of numbers that are the same.
    equal : relative difference of costs that are the same.
    finalists : starts whose numbers are then fitted to all points.
    few_points : of each data while a start is sought.
    starting, finishing : evaluations of a start, and of a finalist.
    margin : of the range that is traced, on both sides of the data, relative to their width.
    span : from which part of a number to which multiple it may go without bounds.
    levels, level_step : of the forces that are traced where every point has its own: at most so many,
        and no nearer to one another than by this ratio.
    effect : rate in units of the errors, by a factor e of a number, below which it has none.
    untold : standard error of a number, relative, from which it is not told.
    alike : correlation from which two numbers may not be told apart.
    apart : standard error of a number, relative, up to which it is told whatever it is correlated with.
    poor : misfit of data, relative, from which the model does not meet them.
    confidence : of the intervals.
    reweighted : times that errors which are not stated are estimated, and the fit is made again.
    least_error : of a measured value, relative to the greatest: what is below is rounding.
    rank : of the greatest singular value, below which a combination of numbers is not seen at all.
    lost : residual where the model has no response, in units of the errors.
    """

    amplitude_error: float = 0.01
    frequency_error: float = 1e-6
    backbone_error: float = 1e-3
    damping_error: float = 0.05
    blurred: float = 0.02
    starts: int = 8
    seeking: float = 0.7
    agreeing: int = 2
    same: float = 1e-2
    equal: float = 1e-6
    finalists: int = 2
    few_points: int = 60
    starting: int = 25
    finishing: int = 60
    margin: float = 0.1
    span: float = 100.0
    levels: int = 9
    level_step: float = 1.2
    effect: float = 1e-3
    untold: float = 0.5
    alike: float = 0.98
    apart: float = 0.05
    poor: float = 0.1
    confidence: float = 0.95
    reweighted: int = 2
    least_error: float = 1e-8
    rank: float = 1e-10
    lost: float = 1e6


@dataclass(frozen=True)
class NearestOptions:
    """How the nearest point of a curve is found.

    steps : at most, along the curve.
    close : of the last of them, in units of the errors.
    longest : step along the curve, in its own scaled units.
    halvings : of a step that leads further away.
    """

    steps: int = 30
    close: float = 1e-6
    longest: float = 0.1
    halvings: int = 8


@dataclass(frozen=True)
class BackboneOptions:
    """How a mode of the model is met at the amplitudes of a backbone.

    beyond, beyond_modal : factor by which it is followed past the amplitudes measured; past modal ones.
    difference : of the residual by a number, and of an amplitude along a direction, relative.
    steps, close : at most, to where a displacement has its amplitude, and the last of them in ln a.
    """

    beyond: float = 3.0
    beyond_modal: float = 1.01
    difference: float = 1e-5
    steps: int = 20
    close: float = 1e-10


@dataclass(frozen=True)
class AdviceOptions:
    """Which measurements are imagined.

    factors : of the least and the greatest level that were measured.
    dofs : at most, those measured first.
    points : of each.
    better : part of the standard error that it has to leave at most, to be worth a sentence.
    least : eigenvalue of the scaled information, below which it is rounding.
    """

    factors: tuple[float, ...] = (0.1, 0.3, 3.0, 10.0)
    dofs: int = 4
    points: int = 40
    better: float = 0.5
    least: float = 1e-14


FIT, NEAREST, BACKBONE, ADVICE = FitOptions(), NearestOptions(), BackboneOptions(), AdviceOptions()
