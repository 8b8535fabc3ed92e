"""How much the amplitudes of a transient will still change, from their latest cycles."""

from __future__ import annotations

import numpy as np

from fcm.model.scene import FloatArray
from fcm.time_domain.options import TIME, TimeOptions


def unsettled(amplitude: FloatArray, options: TimeOptions = TIME) -> float:
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
    if amplitude.shape[0] < 2 * options.settling.cycles + 1:
        return float("nan")
    size = np.abs(amplitude[-1])
    size = np.maximum(size, options.settling.min_amplitude * size.max(initial=0.0))
    size = np.where(size > 0.0, size, 1.0)
    later = np.ptp(amplitude[-options.settling.cycles - 1 :], axis=0) / size
    earlier = np.ptp(amplitude[-2 * options.settling.cycles - 1 : -options.settling.cycles], axis=0) / size
    decays = earlier > later
    left = np.where(decays, later**2 / np.where(decays, earlier - later, 1.0), np.inf)
    return float(np.where(later <= options.settling.min_change, later, left).max(initial=0.0))
