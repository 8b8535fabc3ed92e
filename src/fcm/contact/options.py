"""Options for the cycle of one contact on a line; `fcm.contact.plane.options` has the plane."""

from __future__ import annotations

from fcm.frozen import Frozen


class ClosedFormOptions(Frozen):
    """The coefficients in closed form; motion and load are relative to the amplitude a and to k_u a.

    Attributes
    ----------
    min_change : float
        Change of w in a slip, and [rad] length of a stick, up to which there is none: float64 cannot tell.
    light_load : float
        Value of max(|n0_bar|, b_bar) below which the force is integrated: this keeps the relative error of
        the arguments, however small it is. Above it u - w is integrated, which is faster.
    """

    min_change: float = 1e-15
    light_load: float = 0.01


class PeriodicOptions(Frozen):
    """The events of a contact on a line under any periodic motion.

    Attributes
    ----------
    nodes_per_harmonic : int
        Number of intervals of a cycle at first, relative to the highest harmonic. Those in which a zero is
        not ruled out are halved.
    max_halvings : int
        Most halvings of one interval; at half of these rounding has long been reached.
    min_interval : float
        [rad] Length of an interval below which it is not halved further.
    min_state_length : float
        [rad] Length of a state in a loop, and way of a slip relative to its greatest extent, up to which it
        is rounding.
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
        Most kernels of each thread, on a line and in a plane each. The curves of a sweep ask for some eighty
        sets of harmonics.
    """

    max_kernels: int = 128


CLOSED_FORM = ClosedFormOptions()
PERIODIC = PeriodicOptions()
KERNELS = KernelOptions()
