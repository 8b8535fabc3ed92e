r"""Disturbances of many modes carried through a state of the contacts, by the eigenvalues of that state.

In time, not in angle, the equations of a state do not depend on the frequency:

    q' = v,    v' = -K q - D v + B w

So they are decomposed once for each state that comes up again, on the whole of a curve.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from fcm.scene.model import FloatArray

MOST = 256  # states that are remembered
WORST = 1e6  # condition of the eigenvectors, beyond which they are not used

ComplexArray = npt.NDArray[np.complex128]


class Propagator:
    """States by their numbers (contact,), each seen once before it is decomposed."""

    def __init__(self) -> None:
        self.known: dict[bytes, tuple[ComplexArray, ...] | None] = {}
        self.seen: set[bytes] = set()

    def through(
        self,
        state: npt.NDArray[np.intc],
        angle: float,
        omega: float,
        system: tuple[FloatArray, FloatArray, FloatArray],
        X: FloatArray,
    ) -> bool:
        """Carry the rows (q, dq / dangle) of X, above those of w, through an angle; false if it cannot yet.

        system: K, D (mode,) and B of derivatives by the angle.
        """
        parts = self._parts(state.tobytes(), omega, system)
        if parts is None:
            return False
        values, vectors, inverse, driven = parts
        m = len(values) // 2
        X[m : 2 * m] *= omega
        z = values * (angle / omega)
        small = np.abs(z) < 1e-8
        held = (angle / omega) * np.where(small, 1.0 + 0.5 * z, np.expm1(z) / np.where(small, 1.0, z))
        share = np.exp(z)[:, None] * (inverse @ X[: 2 * m]) + held[:, None] * (driven @ X[2 * m :])
        X[: 2 * m] = (vectors @ share).real
        X[m : 2 * m] /= omega
        return True

    def _parts(
        self, key: bytes, omega: float, system: tuple[FloatArray, FloatArray, FloatArray]
    ) -> tuple[ComplexArray, ...] | None:
        """Eigenvalues, eigenvectors, their inverse, and what it makes of B, by time."""
        if key in self.known:
            return self.known[key]
        if key not in self.seen or len(self.known) >= MOST:
            self.seen.add(key)
            return None
        K, D, B = system
        m = len(D)
        A = np.zeros((2 * m, 2 * m))
        A[:m, m:] = np.eye(m)
        A[m:, :m], A[m:, m:] = -omega * omega * K, -np.diag(omega * D)
        self.known[key] = _decomposed(A, np.vstack((np.zeros_like(B), omega * omega * B)))
        return self.known[key]


def _decomposed(A: FloatArray, B: FloatArray) -> tuple[ComplexArray, ...] | None:
    """None where the eigenvectors are nearly dependent."""
    try:
        values, vectors = np.linalg.eig(A)
        unit = np.repeat([1.0, np.abs(values).max()], len(A) // 2)[:, None]  # of places and velocities
        if not np.linalg.cond(vectors / unit) < WORST:
            return None
        inverse = np.linalg.inv(vectors / unit) / unit.T
    except np.linalg.LinAlgError:
        return None
    return tuple(np.asarray(one, dtype=np.complex128) for one in (values, vectors, inverse, inverse @ B))
