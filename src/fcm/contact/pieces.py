"""The pieces of a loop, one for each state, and the friction force in them."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from fcm.contact.kernel_arguments import ComplexArray, FloatArray

Piece = tuple[str, float, Any]


class Pieces:
    """A cycle of states and the angles at which each begins, in order from the first."""

    sequence: str
    angles: FloatArray
    _since: FloatArray

    def states(self, theta: npt.ArrayLike) -> npt.NDArray[np.str_]:
        """State letter at each angle theta [rad]."""
        return np.array(list(self.sequence))[self._piece(np.asarray(theta, dtype=np.float64))]

    def _piece(self, theta: FloatArray) -> npt.NDArray[np.intp]:
        """Number of the piece that contains each angle theta [rad]."""
        if self._since.size == 0:
            return np.zeros(theta.shape, dtype=np.intp)
        since = np.mod(theta - self.angles[0], 2.0 * np.pi)
        return np.asarray(np.searchsorted(self._since, since, side="right") - 1)


class LoadedPieces(Pieces):
    """A cycle of states of a contact under the normal motion v."""

    v: ComplexArray
    mu: float
    k_v: float
    n_0: float

    def normal_load(self, theta: npt.ArrayLike) -> FloatArray:
        """Normal load n = max(n_0 + k_v v, 0) [force] at each angle theta [rad]."""
        return np.maximum(self.n_0 + self.k_v * waves_at(self.v, theta), 0.0)

    def slip_limit(self, theta: npt.ArrayLike) -> FloatArray:
        """Slip limit mu n [force] at each angle theta [rad]."""
        return self.mu * self.normal_load(theta)


def from_piece(first: int, pieces: list[Piece]) -> list[Piece]:
    """The pieces (state, first angle, place of the slider) of a cycle in order, from a given one on."""
    turned = [(state, begin + 2.0 * np.pi, place) for state, begin, place in pieces[:first]]
    return pieces[first:] + turned


def transitions_of(pieces: list[Piece]) -> tuple[str, FloatArray, FloatArray]:
    """The sequence of states, and the angles [rad] where they begin: in [0, 2 pi), and relative to the first.

    There are no angles if there is one piece only."""
    sequence, begin = "".join(state for state, _, _ in pieces), np.array([begin for _, begin, _ in pieces])
    since = begin[: 0 if len(pieces) == 1 else None] - begin[0]
    return sequence, within_turn(begin[0] + since), since


def within_turn(angle: FloatArray) -> FloatArray:
    """Angles [rad] reduced to [0, 2 pi)."""
    found = np.mod(angle, 2.0 * np.pi)
    found[found >= 2.0 * np.pi] = 0.0  # the remainder of a tiny negative angle rounds to 2 pi
    return found


def waves_at(X: ComplexArray, theta: npt.ArrayLike) -> FloatArray:
    """Value of the series Re sum_h X_h exp(i h theta)."""
    angle = np.asarray(theta, dtype=np.float64)
    values: FloatArray = (np.exp(1j * np.multiply.outer(angle, np.arange(X.size))) @ X).real
    return values


def friction(state: npt.NDArray[np.str_], stick: FloatArray, limit: FloatArray) -> FloatArray:
    """Friction force of the states: `stick` while sticking, plus or minus the limit while slipping."""
    held = np.clip(stick, -limit, limit)  # at an event, rounding may put it beyond the limit
    return np.select([state == "E", state == "P", state == "N"], [held, limit, -limit], 0.0)
