"""Options of the derivatives of peaks by numbers of a scene: steps and tolerances."""

from __future__ import annotations

from fcm.frozen import Frozen


class SensitivityOptions(Frozen):
    """Options on how derivatives of peaks are computed.

    Lengths are along the curve, in scaled unknowns.

    Attributes
    ----------
    step : float
        Step of a difference quotient: relative to a number, and as a length along the curve.
    side_distance : float
        Distance from a peak, on either side, at which the slope of the amplitude is tested.
    flat_slope : float
        Slope at this distance, relative to the amplitude, below which a peak is smooth. Otherwise it is a
        corner if a margin changes sign there.
    max_iterations : int
        Greatest number of Newton steps from a given point to the peak.
    tolerance : float
        Length of a Newton step below which it is the last.
    corner, corner_tolerance : float
        Distance within which a corner is searched for after a change of the number, and its tolerance.
    number : float
        Step of the difference quotients of the structure's arrays, relative to the number.
    friction : float
        Small coefficient of friction in place of mu = 0, to compute the derivative by mu from its forces.
    """

    step: float = 1e-4
    side_distance: float = 1e-6
    flat_slope: float = 1e-5
    max_iterations: int = 8
    tolerance: float = 1e-10
    corner: float = 1e-2
    corner_tolerance: float = 1e-14
    number: float = 3e-3
    friction: float = 1e-9


SENSITIVITY = SensitivityOptions()  # the defaults
