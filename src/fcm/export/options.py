"""What is fixed about exported motions, each number with its reason."""

from __future__ import annotations

from fcm.frozen import Frozen
from fcm.rotational_dofs import MOST_DOFS


class ExportOptions(Frozen):
    """Of the motions that are exported.

    Attributes
    ----------
    max_peaks
        Degrees of freedom of each curve whose peaks are exported: those that its line of the printed table
        has, the greatest displacements before rotations.
    max_drift
        How far the frequency of a peak may move, relative, where its point is corrected with all digits; what
        the balance has left is far below.
    same_amplitude
        Relative: modal amplitudes nearer than this are one.
    """

    max_peaks: int = MOST_DOFS
    max_drift: float = 1e-6
    same_amplitude: float = 1e-6


EXPORT = ExportOptions()
