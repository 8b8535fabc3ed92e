"""Options of exported motions, each with its reason."""

from __future__ import annotations

from fcm.frozen import Frozen
from fcm.rotational_dofs import MOST_DOFS


class ExportOptions(Frozen):
    """Options on which motions are exported, and how accurately.

    Attributes
    ----------
    max_peaks
        Most degrees of freedom of each curve whose peaks are exported: those of the printed table, the
        greatest displacements before rotations.
    max_drift
        Relative change of a peak's frequency by the correction of its point, above which the solution is
        another one. The residual of the balance changes it by far less.
    same_amplitude
        Relative difference of modal amplitudes below which they are the same.
    """

    max_peaks: int = MOST_DOFS
    max_drift: float = 1e-6
    same_amplitude: float = 1e-6


EXPORT = ExportOptions()
