"""How exactly the cycle of one contact is followed, on a line; `fcm.contact.plane.options` has the plane."""

from __future__ import annotations

from fcm.frozen import Frozen


class ClosedFormOptions(Frozen):
    """The coefficients in closed form; angles in radians, motion and load over the amplitude a and k_u a.

    min_change: of w in a slip, and length of a stick; what is less, float64 cannot tell from none.
    light_load: of max(|n0_bar|, b_bar); a load below is integrated as a force, which keeps the relative error
    of the arguments however small it is. Else u - w is, which is faster.
    """

    min_change: float = 1e-15
    light_load: float = 0.01


class PeriodicOptions(Frozen):
    """The events of a contact on a line under any periodic motion; angles in radians.

    nodes_per_harmonic: times the highest harmonic, intervals of a cycle at first; those that prove nothing
    are halved. max_halvings: of one of them; at half of these, rounding has long been reached. min_interval:
    length of an interval that is not halved further. min_state_length: of a state in a loop, and of the way
    of a slip over its greatest extent; what is shorter is rounding.
    """

    nodes_per_harmonic: int = 4
    max_halvings: int = 60
    min_interval: float = 1e-15
    min_state_length: float = 1e-14


class KernelOptions(Frozen):
    """Kernels that are kept.

    max_kernels: of a thread, on a line and in a plane each; the curves of a sweep ask for some eighty sets of
    harmonics.
    """

    max_kernels: int = 128


CLOSED_FORM = ClosedFormOptions()
PERIODIC = PeriodicOptions()
KERNELS = KernelOptions()
