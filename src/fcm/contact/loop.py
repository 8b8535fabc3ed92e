"""The hysteresis loop: the states of a cycle, when each begins, the force at any angle (section 3.4)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from fcm.contact.cycle import OPEN, SLIPPING, STUCK, Cycle, behaviour, cycle, stuck_force
from fcm.contact.limits import FloatArray, slip_limits

# A slip that moves w by less than this, a stick shorter than this, is below what float64 can tell from none.
INVISIBLE = 1e-15


@dataclass(frozen=True)
class Loop:
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

    def states(self, theta: npt.ArrayLike) -> npt.NDArray[np.str_]:
        """State letter at each angle theta [rad]."""
        return np.array(list(self.sequence))[self._region(np.asarray(theta, dtype=np.float64))]

    def normal_load(self, theta: npt.ArrayLike) -> FloatArray:
        """mu n / (k_u a) [-] at each angle theta [rad], equation (1)."""
        angle = np.asarray(theta, dtype=np.float64)
        return np.maximum(self.n0_bar + self.b_bar * np.sin(angle + self.phi), 0.0)

    def force(self, theta: npt.ArrayLike) -> FloatArray:
        """Friction force f / (k_u a) [-] at each angle theta [rad], equations (3), (4) and (7).

        >>> hysteresis_loop(0.5, 0.0, 0.0).force(np.pi / 2).item()
        0.5
        """
        angle = np.asarray(theta, dtype=np.float64)
        region = self._region(angle)
        state = np.array(list(self.sequence))[region]
        load = self.normal_load(angle)
        stick = np.sin(angle) - np.nan_to_num(self.slip_motion)[region]
        stick = np.clip(stick, -load, load)  # at an event, a rounding error may put it past the limit
        return np.select([state == "E", state == "P", state == "N"], [stick, load, -load], 0.0)

    def _region(self, theta: FloatArray) -> npt.NDArray[np.intp]:
        if self.angles.size == 0:
            return np.zeros(theta.shape, dtype=np.intp)
        since = np.mod(self.angles - self.angles[0], 2.0 * np.pi)
        return np.searchsorted(since, np.mod(theta - self.angles[0], 2.0 * np.pi), side="right") - 1


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
    Sequences: figure 7 of the paper, with E (no slip), EPEN (slip without separation), S (fully open), and
    their common limit SE at phi = 0, b_bar > 1. Transition angles: (A2) to (A13).

    Examples
    --------
    >>> loop = hysteresis_loop(0.8, 1.0, 0.5)
    >>> loop.sequence
    'SEPEN'
    """
    values = [float(x) for x in (n0_bar, b_bar, phi)]
    if not np.all(np.isfinite(values)):
        raise ValueError("n0_bar, b_bar and phi must be finite numbers")
    if values[1] < 0.0:
        raise ValueError("b_bar is an amplitude and must not be negative; shift phi by pi instead")
    n0, b, ph = (np.array([x]) for x in values)
    limits = slip_limits(b, ph)
    code = behaviour(n0, b, limits)[0]
    if code == OPEN:
        return Loop(*values, "S", np.empty(0), np.full(1, np.nan))
    path = cycle(n0, b, ph, limits)
    regions = [] if code == STUCK else _regions(path)
    if all(state == "E" for state, _, _ in regions):
        return Loop(*values, "E", np.empty(0), -stuck_force(n0, b, limits))
    sequence = "".join(state for state, _, _ in regions)
    angles = np.mod([angle for _, angle, _ in regions], 2.0 * np.pi)
    angles[angles >= 2.0 * np.pi] = 0.0  # the remainder of a tiny negative angle rounds to 2 pi
    return Loop(*values, sequence, angles, np.array([w for _, _, w in regions]))


def _regions(path: Cycle) -> list[tuple[str, float, float]]:
    """(state, angle where it begins, w while it sticks) in order, from a cycle of one contact."""
    angle = float(np.arctan2(path.start.sin[0], path.start.cos[0]))
    regions: list[tuple[str, float, float]] = []
    if path.opens[0]:
        regions.append(("S", angle + 2.0 * float(path.theta_1[0]), np.nan))
    for span, (stick, slip) in zip(path.spans, _visible(path), strict=True):
        if stick[0]:
            regions.append(("E", angle, float(span.w_start[0])))
        angle += float(span.length[0])
        if slip[0]:
            regions.append(("P" if span.side[0] > 0.0 else "N", angle - float(span.slip[0]), np.nan))
    return regions


def _visible(path: Cycle) -> list[tuple[npt.NDArray[np.bool_], npt.NDArray[np.bool_]]]:
    """For each span, whether a new stick region begins in it, and a new slip region."""
    shown = []
    state = np.where(path.opens, 2.0, -1.0)  # +1 positive slip, -1 negative slip, 0 stick, 2 separation
    for span in path.spans:
        moves = np.abs(span.w_end - span.w_start) > INVISIBLE
        sticks = span.length - np.where(moves, span.slip, 0.0) > INVISIBLE
        # between opposite slips there is always a stick, however short
        stick = (state != 0.0) & (sticks | (moves & (state == -span.side)))
        state = np.where(stick, 0.0, state)
        slip = moves & (state != span.side)
        state = np.where(slip, span.side, state)
        shown.append((stick, slip))
    return shown


LETTERS = " EPNS"


def sequences(n0_bar: npt.ArrayLike, b_bar: npt.ArrayLike, phi: npt.ArrayLike) -> npt.NDArray[np.str_]:
    """The sequence of each of many contacts; the arguments broadcast, NaN gives ''.

    >>> sequences([2.0, 0.5, -1.0], 0.0, 0.0).tolist()
    ['E', 'EPEN', 'S']
    """
    broadcast = np.broadcast_arrays(*(np.asarray(x, dtype=np.float64) for x in (n0_bar, b_bar, phi)))
    n0, b, ph = (np.ascontiguousarray(x).reshape(-1) for x in broadcast)
    known = np.flatnonzero(np.isfinite(n0) & np.isfinite(b) & np.isfinite(ph))
    limits = slip_limits(b[known], ph[known])
    code = behaviour(n0[known], b[known], limits)
    digits = np.zeros(n0.size, dtype=np.int64)  # the letters of a sequence as a number in base 5
    digits[known] = np.where(code == OPEN, LETTERS.index("S"), LETTERS.index("E"))
    moving = known[code == SLIPPING]
    digits[moving] = _digits(cycle(n0[moving], b[moving], ph[moving]))
    values, which = np.unique(digits, return_inverse=True)
    names = np.array([_word(int(value)) for value in values], dtype="<U6")
    return names[which].reshape(broadcast[0].shape)


def _digits(path: Cycle) -> npt.NDArray[np.int64]:
    digits = np.where(path.opens, LETTERS.index("S"), 0)
    for span, (stick, slip) in zip(path.spans, _visible(path), strict=True):
        digits = np.where(stick, digits * 5 + LETTERS.index("E"), digits)
        side = np.where(span.side > 0.0, LETTERS.index("P"), LETTERS.index("N"))
        digits = np.where(slip, digits * 5 + side, digits)
    return digits


def _word(digits: int) -> str:
    word = ""
    while digits:
        digits, letter = divmod(digits, 5)
        word = LETTERS[letter] + word
    return word
