"""How much the amplitudes of a transient will still change, from their latest cycles."""

from __future__ import annotations

import numpy as np

from fcm.model.scene import FloatArray

WINDOW = 10  # cycles
ROUNDING = 1e-9  # changes below are none, relative
LEAST = 1e-6  # of the greatest amplitude: smaller ones are not judged


def unsettled(amplitude: FloatArray) -> float:
    """Relative change that is still to come, were what is left to decay as it did of late.

    With the ranges d_1 and d_2 of the amplitude over the last WINDOW cycles and the ones before, what is
    left of a transient that decays as a power is d_1 rho / (1 - rho), rho = d_1 / d_2.

    Parameters
    ----------
    amplitude : (cycle, dof)
        Of successive whole cycles.

    Returns
    -------
    float
        The greatest over the dofs; nan for fewer than 2 WINDOW + 1 cycles, inf when nothing decays.

    Examples
    --------
    >>> import numpy as np
    >>> decay = 1.0 + 0.5 * 0.9 ** np.arange(60.0)[:, None]
    >>> bool(np.isclose(unsettled(decay), 1.0 - 1.0 / decay[-1, 0]))
    True
    >>> unsettled(np.arange(60.0)[:, None])
    inf
    """
    if amplitude.shape[0] < 2 * WINDOW + 1:
        return float("nan")
    size = np.abs(amplitude[-1])
    size = np.maximum(size, LEAST * size.max(initial=0.0))
    size = np.where(size > 0.0, size, 1.0)
    later = np.ptp(amplitude[-WINDOW - 1 :], axis=0) / size
    earlier = np.ptp(amplitude[-2 * WINDOW - 1 : -WINDOW], axis=0) / size
    decays = earlier > later
    left = np.where(decays, later**2 / np.where(decays, earlier - later, 1.0), np.inf)
    return float(np.where(later <= ROUNDING, later, left).max(initial=0.0))
