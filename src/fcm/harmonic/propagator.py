r"""Disturbances of many modes carried through a state of the contacts, by the eigenvalues of that state.

In time, not in angle, the equations of a state do not depend on the frequency:

    q' = v,    v' = -K q - D v + B w

So they are decomposed once for each state that comes up again, on the whole of a curve.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from fcm.scene.model import FloatArray

MOST = 256  # states that are remembered
WORST = 1e6  # condition of the eigenvectors, beyond which they are not used

ComplexArray = npt.NDArray[np.complex128]


class _Parts(NamedTuple):
    """The eigenvalues of a state, by time, one of each pair; shares of them as real and imaginary parts."""

    values: ComplexArray  # (value,)
    still: npt.NDArray[np.intp]  # those that are 0
    share: FloatArray  # (2 modes, 2 values) of (q, v)
    driven: (
        FloatArray | None
    )  # (contact, 2 values) of the places, of which none counts where no contact sticks
    back: FloatArray  # (2 values, 2 modes)


class Propagator:
    """States by their keys, each seen once before it is decomposed."""

    def __init__(self) -> None:
        self.known: dict[bytes, _Parts | None] = {}
        self.seen: set[bytes] = set()

    def through(
        self,
        key: bytes,
        angle: float,
        omega: float,
        system: Callable[[], tuple[FloatArray, FloatArray, FloatArray]],
        X: FloatArray,
    ) -> bool:
        """Carry the rows (q, dq / dangle) of X, above those of w, through an angle; false if it cannot yet.

        system makes K, D (mode,) and B of derivatives by the angle.
        """
        parts = self._parts(key, omega, system)
        if parts is None:
            return False
        m, time = len(parts.share) // 2, angle / omega
        X[m : 2 * m] *= omega
        more = np.expm1(parts.values * time)
        share = (X[: 2 * m].T @ parts.share).view(np.complex128)
        share += more * share
        if parts.driven is not None:
            more[parts.still] = time
            share += more * (X[2 * m :].T @ parts.driven).view(np.complex128)
        X[: 2 * m] = (share.view(np.float64) @ parts.back).T
        X[m : 2 * m] /= omega
        return True

    def _parts(
        self, key: bytes, omega: float, system: Callable[[], tuple[FloatArray, FloatArray, FloatArray]]
    ) -> _Parts | None:
        if key in self.known:
            return self.known[key]
        if key not in self.seen or len(self.known) >= MOST:
            self.seen.add(key)
            return None
        K, D, B = system()
        m = len(D)
        A = np.zeros((2 * m, 2 * m))
        A[:m, m:] = np.eye(m)
        A[m:, :m], A[m:, m:] = -omega * omega * K, -np.diag(omega * D)
        self.known[key] = _decomposed(A, np.vstack((np.zeros_like(B), omega * omega * B)))
        return self.known[key]


def _decomposed(A: FloatArray, B: FloatArray) -> _Parts | None:
    """None where the eigenvectors are nearly dependent."""
    try:
        values, vectors = np.linalg.eig(A)
        unit = np.repeat([1.0, np.abs(values).max()], len(A) // 2)[:, None]  # of places and velocities
        if not np.linalg.cond(vectors / unit) < WORST:
            return None
        inverse = np.linalg.inv(vectors / unit) / unit.T
    except np.linalg.LinAlgError:
        return None
    one = values.imag >= 0.0
    values, vectors, inverse = values[one].astype(np.complex128), vectors[:, one], inverse[one]
    pair = np.where(values.imag > 0.0, 2.0, 1.0)
    still = np.flatnonzero(values == 0.0)
    # what drives grows by (exp(value time) - 1) / value, of no value by the time
    driven = _real((inverse @ B) / np.where(values == 0.0, 1.0, values)[:, None]) if B.any() else None
    return _Parts(values, still, _real(inverse), driven, _real(np.conj(vectors * pair).T).T.copy())


def _real(rows: ComplexArray) -> FloatArray:
    """(value, n) as (n, 2 values): real and imaginary parts side by side."""
    return np.ascontiguousarray(rows.T, dtype=np.complex128).view(np.float64)
