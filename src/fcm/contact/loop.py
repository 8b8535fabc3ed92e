"""The hysteresis loop: the states of a cycle, when each begins, the force at any angle (section 3.4)."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from fcm.contact.cycle import OPEN, SLIPPING, STUCK, Cycle, behaviour, cycle, stuck_force
from fcm.contact.limits import BoolArray, FloatArray, slip_limits, within_range

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
    _since: FloatArray = field(default_factory=lambda: np.empty(0), repr=False)  # angles from the first on

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
        if self._since.size == 0:
            return np.zeros(theta.shape, dtype=np.intp)
        since = np.mod(theta - self.angles[0], 2.0 * np.pi)
        return np.asarray(np.searchsorted(self._since, since, side="right") - 1)


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
    n0_bar, b_bar, phi = float(n0_bar), float(b_bar), float(phi)
    if not np.all(np.isfinite((n0_bar, b_bar, phi))):
        raise ValueError("n0_bar, b_bar and phi must be finite numbers")
    if b_bar < 0.0:
        raise ValueError("b_bar is an amplitude and must not be negative; shift phi by pi instead")
    n0, b = within_range(np.array([n0_bar]), np.array([b_bar]))
    ph = np.array([phi])
    limits = slip_limits(b, ph)
    code = behaviour(n0, b, limits)[0]
    if code == OPEN:
        return Loop(n0_bar, b_bar, phi, "S", np.empty(0), np.full(1, np.nan))
    path = cycle(n0, b, ph, limits)
    regions = [] if code == STUCK else _regions(path)
    if all(state == "E" for state, _, _ in regions):
        return Loop(n0_bar, b_bar, phi, "E", np.empty(0), -stuck_force(n0, b, limits))
    sequence = "".join(state for state, _, _ in regions)
    since = np.array([angle for _, angle, _ in regions])
    since = np.clip(np.maximum.accumulate(since), 0.0, 2.0 * np.pi)
    angles = np.mod(_first_angle(path) + since, 2.0 * np.pi)
    angles[angles >= 2.0 * np.pi] = 0.0  # the remainder of a tiny negative angle rounds to 2 pi
    return Loop(n0_bar, b_bar, phi, sequence, angles, np.array([w for _, _, w in regions]), since)


class _Shown(NamedTuple):
    """What a span adds to the sequence."""

    stick: BoolArray  # True where a new stick region begins
    side: FloatArray  # of the slip region that begins, 0 where none does
    slip: FloatArray  # how long before the end of the span it begins [rad]


def _regions(path: Cycle) -> list[tuple[str, float, float]]:
    """(state, angle since the first begins, w while it sticks) in order, from a cycle of one contact."""
    since = 2.0 * (np.pi - float(path.theta_1[0]))
    regions = [("S", 0.0, np.nan)] if path.opens[0] else []
    for span, shown in zip(path.spans, _shown(path), strict=True):
        if shown.stick[0]:
            regions.append(("E", since, float(span.w_start[0])))
        since += float(span.length[0])
        if shown.side[0]:
            regions.append(("P" if shown.side[0] > 0.0 else "N", since - float(shown.slip[0]), np.nan))
    return regions


def _first_angle(path: Cycle) -> float:
    """Where the first state begins: separation, or the stick after negative slip."""
    first = path.spans[2].end if path.opens[0] else path.start
    return float(np.arctan2(first.sin[0], first.cos[0]))


def _shown(path: Cycle) -> list[_Shown]:
    """The regions of each span that float64 can tell from none, and those without which the others cannot be.

    Between opposite slips there is always a stick, however short. A stick after a slip ends in the opposite
    slip: the limit that pushed w is past its extreme, and w must leave it to be at the other one at the end.
    """
    regions = []
    state = np.where(path.opens, 2.0, -1.0)  # +1 positive slip, -1 negative slip, 0 stick, 2 separation
    last_slip = np.zeros(path.opens.shape)
    for index, span in enumerate(path.spans):
        side = _visible_side(path, index)
        sticks = span.length - np.where(side != 0.0, span.slip, 0.0) > INVISIBLE
        stick = (state != 0.0) & (sticks | ((side != 0.0) & (state == -side)))
        state = np.where(stick, 0.0, state)
        if index == 2:
            side = np.where(path.opens & (state == 0.0) & (side == 0.0), -last_slip, side)
        begins = np.where(state == side, 0.0, side)
        state = np.where(side != 0.0, side, state)
        last_slip = np.where(side != 0.0, side, last_slip)
        regions.append(_Shown(stick, begins, np.where(span.side == side, span.slip, 0.0)))
    return regions


def _visible_side(path: Cycle, index: int) -> FloatArray:
    """Side of the slip in a span, 0 where there is none to be seen."""
    moves = [np.abs(span.w_end - span.w_start) > INVISIBLE for span in path.spans]
    side = np.where(moves[index], path.spans[index].side, 0.0)
    # where the contact never opens there are both slips, equally large, or none
    both = moves[0] | moves[1]
    return np.where(path.opens, side, np.where(both, (1.0, -1.0, 0.0)[index], 0.0))


LETTERS = " EPNS"


def sequences(n0_bar: npt.ArrayLike, b_bar: npt.ArrayLike, phi: npt.ArrayLike) -> npt.NDArray[np.str_]:
    """The sequence of each of many contacts; the arguments broadcast, NaN gives ''.

    >>> sequences([2.0, 0.5, -1.0], 0.0, 0.0).tolist()
    ['E', 'EPEN', 'S']
    """
    broadcast = np.broadcast_arrays(*(np.asarray(x, dtype=np.float64) for x in (n0_bar, b_bar, phi)))
    n0, b, ph = (np.ascontiguousarray(x).reshape(-1) for x in broadcast)
    digits = np.zeros(n0.size, dtype=np.int64)  # the letters of a sequence as a number in base 5
    known = np.flatnonzero(~np.isnan(n0) & np.isfinite(b) & np.isfinite(ph))
    n0, b = within_range(n0[known], b[known])
    ph = ph[known]
    code = behaviour(n0, b, slip_limits(b, ph))
    digits[known] = np.where(code == OPEN, LETTERS.index("S"), LETTERS.index("E"))
    slips = code == SLIPPING
    digits[known[slips]] = _digits(cycle(n0[slips], b[slips], ph[slips]))
    values, which = np.unique(digits, return_inverse=True)
    names = np.array([_word(int(value)) for value in values], dtype="<U6")
    return names[which].reshape(broadcast[0].shape)


def _digits(path: Cycle) -> npt.NDArray[np.int64]:
    digits = np.where(path.opens, LETTERS.index("S"), 0)
    for shown in _shown(path):
        digits = np.where(shown.stick, digits * 5 + LETTERS.index("E"), digits)
        letter = np.where(shown.side > 0.0, LETTERS.index("P"), LETTERS.index("N"))
        digits = np.where(shown.side != 0.0, digits * 5 + letter, digits)
    return digits


def _word(digits: int) -> str:
    word = ""
    while digits:
        digits, letter = divmod(digits, 5)
        word = LETTERS[letter] + word
    return word
