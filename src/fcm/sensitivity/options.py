"""Steps and tolerances of the derivatives of peaks by numbers of a scene."""

from __future__ import annotations

from fcm.frozen import Frozen


class SensitivityOptions(Frozen):
    """How derivatives of peaks are found. Lengths are along the curve, in the scale of its unknowns.

    Attributes
    ----------
    step : float
        Of a difference: part of a number, and length along the curve.
    side_distance : float
        Length to both sides of a peak, where its slope has the one sign and the other.
    flat_slope : float
        Slope over size at that length, below which a peak is smooth.
    max_iterations : int
        Of Newton's method from where a peak is said to be to where it is, at most.
    tolerance : float
        Length of the last of them.
    corner, corner_tolerance : float
        Lengths within which a corner moves with the number, and to which it is found.
    number : float
        Step of a difference of the structure's arrays, relative to the number.
    friction : float
        Coefficient in the place of none, whose forces give the derivative by it.
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
