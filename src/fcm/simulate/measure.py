"""What is reported of a cycle: greatest and least displacement, mean, fundamental, in closed form."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from fcm.scene.model import FloatArray
from fcm.simulate.cycle import NODES, WEIGHTS, Cycle, Piece, pieces
from fcm.simulate.flow import ORDER

IntArray = npt.NDArray[np.intp]
_ORDERS = np.arange(ORDER + 1.0)
_POWERS = NODES[:, None] ** _ORDERS  # (node, ORDER + 1)
NEWTON = 5


@dataclass(frozen=True)
class Measure:
    """One cycle of each degree of freedom; lengths in the scene's unit."""

    amplitude: FloatArray  # (dof,) half the peak-to-peak
    fundamental: FloatArray  # (dof,) amplitude of the fundamental
    phase: FloatArray  # (dof,) [rad], of fundamental * sin(omega t + phase)
    mean: FloatArray  # (dof,) time average
    greatest: FloatArray  # (dof,)
    least: FloatArray  # (dof,)


def measure(cycle: Cycle, rows: FloatArray) -> Measure:
    """Measure rows @ y over a cycle.

    The integrals are by Gauss quadrature on steps so short that it is exact to rounding; each extreme
    is a root of the velocity, found by Newton's method.
    """
    total = np.zeros(rows.shape[0], dtype=np.complex128)
    mean = np.zeros(rows.shape[0])
    high, low = np.full(rows.shape[0], -np.inf), np.full(rows.shape[0], np.inf)
    for piece in pieces(cycle, rows):
        x = _nodes(piece)
        one, wave = _integrals(piece, x, cycle)
        mean, total = mean + one, total + wave
        high = np.maximum(high, _greatest(piece, x, 1.0))
        low = np.minimum(low, -_greatest(piece, x, -1.0))
    # x = a sin(theta + phase): its transform over exp(-i theta) is a exp(i phase) / 2i
    harmonic = 2j * total / cycle.duration
    return Measure(0.5 * (high - low), np.abs(harmonic), np.angle(harmonic), mean / cycle.duration, high, low)


def _nodes(piece: Piece) -> FloatArray:
    """The rows at the nodes of each step, (step, node, row); only the last step may be short."""
    x: FloatArray = _POWERS @ piece.powers
    x[-1] = ((NODES * piece.lengths[-1])[:, None] ** _ORDERS) @ piece.powers[-1]
    return x


def _integrals(piece: Piece, x: FloatArray, cycle: Cycle) -> tuple[FloatArray, FloatArray]:
    """Integrals of x and of x exp(-i theta) over the piece."""
    lengths = piece.lengths[:, None] * NODES  # (step, node)
    h = piece.segment.flow.step
    times = piece.segment.start + h * (piece.first + np.arange(piece.lengths.size)[:, None] + lengths)
    weights = h * piece.lengths[:, None] * WEIGHTS
    wave = weights * np.exp(-1j * (cycle.angle + cycle.system.omega * times))
    return np.einsum("sn,snr->r", weights, x), np.einsum("sn,snr->r", wave, x)


def _greatest(piece: Piece, x: FloatArray, sign: float) -> FloatArray:
    """Greatest value of each row of sign * x over the piece; x, (step, node, row), are values inside it.

    Wherever the velocity changes its sign from the start of a step to its end, Newton's method finds where.
    """
    powers = sign * piece.powers
    best: FloatArray = np.maximum((sign * x).max(axis=(0, 1)), powers[:, 0].max(axis=0))
    step, row, rising, falling = _turns(powers, piece.lengths)
    if step.size:
        limit = piece.lengths[step]
        value, _ = _peak(powers[step, :, row], limit * rising / (rising - falling), limit)
        np.maximum.at(best, row, value)
    return best


def _turns(powers: FloatArray, lengths: FloatArray) -> tuple[IntArray, IntArray, FloatArray, FloatArray]:
    """Steps and rows in which the slope turns from positive to negative, with its values at both ends."""
    rising = powers[:, 1]
    weights = _ORDERS[1:] * lengths[:, None] ** _ORDERS[:-1]
    falling = (weights[:, None] @ powers[:, 1:])[:, 0]
    step, row = ((rising > 0.0) & (falling <= 0.0)).nonzero()
    return step, row, rising[step, row], falling[step, row]


def _peak(powers: FloatArray, position: FloatArray, limit: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Values and positions of the maxima of polynomials (peak, ORDER + 1) next to positions in [0, limit]."""
    first = powers[:, 1:] * _ORDERS[1:]
    second = first[:, 1:] * _ORDERS[1:-1]
    for _ in range(NEWTON):
        x = position[:, None] ** _ORDERS
        bend = (second * x[:, :-2]).sum(axis=1)
        down = bend < 0.0
        move = -(first * x[:, :-1]).sum(axis=1) / np.where(down, bend, 1.0)
        position = np.clip(position + np.where(down, move, 0.0), 0.0, limit)
    value: FloatArray = (powers * position[:, None] ** _ORDERS).sum(axis=1)
    return value, position


def extreme(powers: FloatArray, lengths: FloatArray) -> tuple[float, float]:
    """The greatest value of one row over its steps, (step, ORDER + 1, 1), and where it is (in steps)."""
    starts = powers[:, 0, 0]
    k = int(starts.argmax())
    best, where = float(starts[k]), float(k)
    step, _, rising, falling = _turns(powers, lengths)
    if step.size:
        guess = lengths[step] * rising / (rising - falling)
        value, position = _peak(powers[step, :, 0], guess, lengths[step])
        k = int(value.argmax())
        if value[k] > best:
            best, where = float(value[k]), float(step[k] + position[k])
    return best, where
