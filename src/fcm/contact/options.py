"""Options for the cycle of one contact on a line; `fcm.contact.plane.options` has the plane."""

from __future__ import annotations

from fcm.frozen import Frozen


class ClosedFormOptions(Frozen):
    """Options on the coefficients in closed form; motion and load are relative to a and to k_u a.

    Attributes
    ----------
    min_change : float
        Change of w in a slip, and length [rad] of a stick, up to which they are rounding.
    light_load : float
        Value of max(|n0_bar|, b_bar) below which the force is integrated, so that the result has the relative
        error of the arguments however small these are. Above it u - w is integrated, which is faster.
    """

    min_change: float = 1e-15
    light_load: float = 0.01


class PeriodicOptions(Frozen):
    """Options on the events of a contact on a line under any periodic motion.

    Attributes
    ----------
    nodes_per_harmonic : int
        Number of intervals of a cycle at first, relative to the highest harmonic. An interval in which a zero
        is not excluded is halved.
    max_halvings : int
        Greatest number of halvings of one interval; half of them reach rounding.
    min_interval : float
        [rad] Length of an interval below which it is not halved further.
    min_state_length : float
        Length [rad] of a state in a loop, and path of a slip relative to the motion, up to which they are
        rounding.
    """

    nodes_per_harmonic: int = 4
    max_halvings: int = 60
    min_interval: float = 1e-15
    min_state_length: float = 1e-14


class KernelOptions(Frozen):
    """Options on the number of kernels that are kept.

    Attributes
    ----------
    max_kernels : int
        Greatest number of kernels of each thread, for contacts on a line and in a plane each. The curves of a
        sweep use some eighty sets of harmonics.
    """

    max_kernels: int = 128


CLOSED_FORM = ClosedFormOptions()
PERIODIC = PeriodicOptions()
KERNELS = KernelOptions()
