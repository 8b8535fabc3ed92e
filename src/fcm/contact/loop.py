"""The hysteresis loop: states of a cycle, their first angles, and the friction force (section 3.4)."""

from __future__ import annotations

from dataclasses import field

import numpy as np
import numpy.typing as npt

from fcm.contact.closed_form import Sequence
from fcm.contact.limits import FloatArray
from fcm.contact.pieces import Pieces, friction, within_turn
from fcm.frozen import Frozen


class Loop(Frozen, Pieces):
    """One steady cycle of a contact under u = sin(theta), v = b sin(theta + phi), dimensionless.

    Attributes
    ----------
    n0_bar, b_bar, phi : float
        The arguments of `hysteresis_loop` [-], [-], [rad].
    sequence : str
        The states in order, E stick, P positive slip, N negative slip, S separation: 'EPEN', 'SEP', ...
    angles : ndarray, shape (len(sequence),) or (0,) for a single state [rad]
        ``angles[i]`` in [0, 2 pi) is where state ``sequence[i]`` begins and the one before it ends.
    slip_motion : ndarray, shape (max(len(angles), 1),) [-]
        w while the contact sticks, for each state; NaN for the others.
    """

    n0_bar: float
    b_bar: float
    phi: float
    sequence: str
    angles: FloatArray
    slip_motion: FloatArray
    _since: FloatArray = field(default_factory=lambda: np.empty(0), repr=False)  # angles from the first on

    def displacement(self, theta: npt.ArrayLike) -> FloatArray:
        """Displacement u / a [-] at each angle theta [rad]."""
        return np.sin(np.asarray(theta, dtype=np.float64))

    def slip_limit(self, theta: npt.ArrayLike) -> FloatArray:
        """Slip limit of the friction force, equal to `normal_load` [-], at each angle theta [rad]."""
        return self.normal_load(theta)

    def normal_load(self, theta: npt.ArrayLike) -> FloatArray:
        """Normal load mu n / (k_u a) [-] at each angle theta [rad], equation (1)."""
        angle = np.asarray(theta, dtype=np.float64)
        return np.maximum(self.n0_bar + self.b_bar * np.sin(angle + self.phi), 0.0)

    def force(self, theta: npt.ArrayLike) -> FloatArray:
        """Friction force f / (k_u a) [-] at each angle theta [rad], equations (3), (4) and (7).

        >>> hysteresis_loop(0.5, 0.0, 0.0).force(np.pi / 2).item()
        0.5
        """
        angle = np.asarray(theta, dtype=np.float64)
        stick = np.sin(angle) - np.nan_to_num(self.slip_motion)[self._piece(angle)]
        return friction(self.states(angle), stick, self.slip_limit(angle))


def hysteresis_loop(n0_bar: float, b_bar: float, phi: float) -> Loop:
    """The steady hysteresis loop of one contact under harmonic motion, in closed form.

    Parameters
    ----------
    n0_bar, b_bar, phi : float
        Preload [-], normal load variation [-] (at least 0) and phase [rad], as in `fourier_coefficients`.

    Returns
    -------
    Loop
        With `sequence`, `angles`, `force(theta)`, `normal_load(theta)` and `states(theta)`.

    Raises
    ------
    ValueError
        If b_bar is negative or an argument is not finite.

    Notes
    -----
    Sequences: figure 7 of the paper, and E (no slip), EPEN (slip without separation) and S (fully open). The
    limit of all of them is SE at phi = 0, b_bar > 1. Transition angles: (A2) to (A13).

    Examples
    --------
    >>> loop = hysteresis_loop(0.8, 1.0, 0.5)
    >>> loop.sequence
    'SEPEN'
    """
    n0_bar, b_bar, phi = float(n0_bar), float(b_bar), float(phi)
    if not np.all(np.isfinite((n0_bar, b_bar, phi))):
        raise ValueError("n0_bar, b_bar and phi must be finite numbers")
    if b_bar < 0.0:
        raise ValueError("b_bar is an amplitude and must not be negative; shift phi by pi instead")
    first, regions = Sequence().loop(n0_bar, b_bar, phi)
    letters, since, w = regions.T
    sequence = "".join(chr(int(letter)) for letter in letters)
    if len(sequence) == 1:
        return Loop(n0_bar, b_bar, phi, sequence, np.empty(0), w)
    since = np.clip(np.maximum.accumulate(since), 0.0, 2.0 * np.pi)
    return Loop(n0_bar, b_bar, phi, sequence, within_turn(first + since), w, since)


def sequences(n0_bar: npt.ArrayLike, b_bar: npt.ArrayLike, phi: npt.ArrayLike) -> npt.NDArray[np.str_]:
    """State sequences of many contacts as words; arguments broadcast, NaN gives ''.

    >>> sequences([2.0, 0.5, -1.0], 0.0, 0.0).tolist()
    ['E', 'EPEN', 'S']
    """
    points = np.empty((3, *np.broadcast(n0_bar, b_bar, phi).shape))
    points[0], points[1], points[2] = n0_bar, b_bar, phi
    found: npt.NDArray[np.str_] = Sequence().words(points.reshape(3, -1)).reshape(points.shape[1:])
    return found
