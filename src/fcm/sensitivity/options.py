"""Steps and tolerances of the derivatives of peaks by numbers of a scene."""

from __future__ import annotations

from fcm.frozen import Frozen


class SensitivityOptions(Frozen):
    """Options on how derivatives of peaks are found.

    Lengths are along the curve, in the scale of its unknowns.

    Attributes
    ----------
    step : float
        Step of a difference quotient: relative to a number, and as a length along the curve.
    side_distance : float
        Length to either side of a peak at which its slope has the one sign and the other.
    flat_slope : float
        Slope of the amplitude at that length, relative to the amplitude, below which a peak is smooth; above
        it is a corner.
    max_iterations : int
        Most Newton steps from where a peak is said to be to where it is.
    tolerance : float
        Length of a Newton step below which it is the last.
    corner, corner_tolerance : float
        Length within which a corner moves with the number, and error to which the corner is found.
    number : float
        Step of the difference quotients of the structure's arrays, relative to the number.
    friction : float
        Coefficient of friction that stands for none: the derivative by it is taken from its forces.
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


SENSITIVITY = SensitivityOptions()  # where nothing else is said
