"""A sampled (AFT) harmonic balance of a strip on contacts as a user would write it: ``make bench-many``.

    python with_numba.py FOLDER HARMONICS SAMPLES

prints the processor time [s] of its curve, without compiling, and the peak of the last dof along the strip.
It balances modal coordinates and goes by arc length. It tells no errors, no stability and no branches. Forces
are marched through two cycles of samples, with their derivatives.

Source: T. M. Cameron, J. H. Griffin, Journal of Applied Mechanics 56 (1989), for the balance in samples.
"""

from __future__ import annotations

import json
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numba
import numpy as np
import numpy.typing as npt
import scipy.linalg
import scipy.sparse

FloatArray = npt.NDArray[np.float64]
CYCLES, LONGEST, SHORTEST, NEWTON = 2, 0.02, 1e-7, 8  # steps are of the scaled arc
CONVERGED, POINTS = 1e-8, 4000  # of a curve, at most


@dataclass(frozen=True)
class Contacts:
    """Rows of the modal matrix along and across each contact (contact, mode), and what they share."""

    along: FloatArray
    across: FloatArray
    mu: float
    k_u: float
    k_v: float
    n_0: float


class Sampled(NamedTuple):
    """What was traced: frequencies [rad/s] and amplitudes of the first harmonic of one dof."""

    frequency: FloatArray
    amplitude: FloatArray


@numba.njit(cache=True)  # type: ignore[untyped-decorator]
def marched(u: Any, v: Any, E: Any, mu: float, k_u: float, k_v: float, n_0: float) -> Any:
    """Friction and change of normal force (contact, sample); df/du, df/dv, dn/dv (contact, sample, term)."""
    samples, terms = E.shape
    contacts = u.shape[0]
    f, n = np.zeros((contacts, samples)), np.zeros((contacts, samples))
    f_u, f_v = np.zeros((contacts, samples, terms)), np.zeros((contacts, samples, terms))
    n_v = np.zeros((contacts, samples, terms))
    for c in range(contacts):
        motion, gap = E @ u[c], E @ v[c]
        w, w_u, w_v = 0.0, np.zeros(terms), np.zeros(terms)
        for k in range(CYCLES * samples):
            i = k % samples
            load = n_0 + k_v * gap[i]
            closed = load > 0.0
            load = load if closed else 0.0
            trial, limit = k_u * (motion[i] - w), mu * load
            if abs(trial) > limit:
                sign = 1.0 if trial > 0.0 else -1.0
                w = motion[i] - sign * limit / k_u
                for a in range(terms):
                    w_u[a] = E[i, a]
                    w_v[a] = -sign * mu * k_v * E[i, a] / k_u if closed else 0.0
            if k >= (CYCLES - 1) * samples:
                f[c, i], n[c, i] = k_u * (motion[i] - w), load - max(n_0, 0.0)
                for a in range(terms):
                    f_u[c, i, a], f_v[c, i, a] = k_u * (E[i, a] - w_u[a]), -k_u * w_v[a]
                    n_v[c, i, a] = k_v * E[i, a] if closed else 0.0
    return f, n, f_u, f_v, n_v


@dataclass(frozen=True)
class Balance:
    """Residual of the modal equations with harmonics 0 to H, and its derivatives.

    Unknowns q (term, mode): mean, then cosine and sine of each harmonic. frequencies [rad/s] and damping are
    of the modes, force (mode,) is the cosine of the first harmonic.
    """

    contacts: Contacts
    frequencies: FloatArray
    damping: float
    force: FloatArray
    harmonics: int
    samples: int = 128

    @property
    def terms(self) -> int:
        return 2 * self.harmonics + 1

    def waves(self) -> FloatArray:
        angle = 2.0 * np.pi * np.arange(self.samples) / self.samples
        E = np.ones((self.samples, self.terms))
        for h in range(1, self.harmonics + 1):
            E[:, 2 * h - 1], E[:, 2 * h] = np.cos(h * angle), np.sin(h * angle)
        return E

    def residual(self, q: FloatArray, omega: float) -> tuple[FloatArray, FloatArray, FloatArray]:
        """R (unknown,), dR/dq and dR/domega."""
        c, terms, modes = self.contacts, self.terms, self.frequencies.size
        Q, E = q.reshape(terms, modes), self.waves()
        motions = (np.ascontiguousarray((Q @ rows.T).T) for rows in (c.along, c.across))
        f, n, f_u, f_v, n_v = marched(*motions, E, c.mu, c.k_u, c.k_v, c.n_0)
        B = 2.0 * E.T / self.samples
        B[0] *= 0.5
        R = B @ f.T @ c.along + B @ n.T @ c.across
        J = np.zeros((terms, terms, modes, modes))
        for slopes, row, column in (
            *((f_u, c.along, c.along), (f_v, c.along, c.across)),
            (n_v, c.across, c.across),
        ):
            D = np.tensordot(B, slopes, axes=(1, 1))  # (term, contact, term)
            J += row.T @ (D.transpose(0, 2, 1)[..., None] * column)
        J = J.transpose(0, 2, 1, 3)  # (term, mode, term, mode)
        R[1] -= self.force
        d_omega, each = np.zeros((terms, modes)), np.arange(modes)
        w = self.frequencies
        R[0] += w**2 * Q[0]
        J[0, each, 0, each] += w**2
        for h in range(1, self.harmonics + 1):
            a, b = 2 * h - 1, 2 * h
            k, d = w**2 - (h * omega) ** 2, 2.0 * self.damping * w * h * omega
            R[a] += k * Q[a] + d * Q[b]
            R[b] += k * Q[b] - d * Q[a]
            for i, j, value in ((a, a, k), (b, b, k), (a, b, d), (b, a, -d)):
                J[i, each, j, each] += value
            d_omega[a] = -2.0 * h**2 * omega * Q[a] + 2.0 * self.damping * w * h * Q[b]
            d_omega[b] = -2.0 * h**2 * omega * Q[b] - 2.0 * self.damping * w * h * Q[a]
        size = terms * modes
        return R.ravel(), J.reshape(size, size), d_omega.ravel()


def curve(balance: Balance, row: FloatArray, span: tuple[float, float]) -> Sampled:
    """By steps along the arc from the lower end of the span to the upper; row (mode,) is of the dof shown."""
    low, high = span
    q = np.zeros(balance.terms * balance.frequencies.size)
    for _ in range(30):
        R, J, _ = balance.residual(q, low)
        change = np.linalg.solve(J, -R)
        q += change
        if np.abs(change).max() < 1e-10 * max(np.abs(q).max(), 1e-9):
            break
    z, step = np.append(q, low), LONGEST
    tangent = np.zeros(z.size)
    tangent[-1] = 1.0
    points = [z]
    while z[-1] < high:
        scale = np.append(np.full(q.size, max(np.abs(z[:-1]).max(), 1e-3)), high - low)
        _, J, d = balance.residual(z[:-1], z[-1])
        system = np.vstack((np.column_stack((J, d)) * scale, tangent))
        tangent = np.linalg.solve(system, np.eye(z.size)[-1])
        tangent /= np.linalg.norm(tangent)
        while True:
            y, begin = z / scale + step * tangent, z / scale
            for iteration in range(NEWTON):  # noqa: B007
                R, J, d = balance.residual(y[:-1] * scale[:-1], y[-1] * scale[-1])
                system = np.vstack((np.column_stack((J, d)) * scale, tangent))
                change = np.linalg.solve(system, -np.append(R, tangent @ (y - begin) - step))
                y = y + change
                if np.abs(change).max() < CONVERGED:
                    break
            else:
                step *= 0.5
                if step < SHORTEST:
                    raise RuntimeError(f"the sampled balance stops at {z[-1]:g} rad/s")
                continue
            break
        z = y * scale
        step = min(step * (1.3 if iteration < 3 else 0.8 if iteration > 4 else 1.0), LONGEST)
        points.append(z)
        if len(points) > POINTS:
            raise RuntimeError(f"the sampled balance has not come beyond {z[-1]:g} rad/s")
    found = np.array(points)
    first = found[:, :-1].reshape(len(found), balance.terms, -1)[:, 1:3] @ row
    return Sampled(found[:, -1], np.hypot(*first.T))


def main(folder: str, harmonics: str, samples: str) -> None:
    given = json.loads((Path(folder) / "strip.json").read_text(encoding="utf-8"))
    mass, stiffness = (
        scipy.sparse.load_npz(Path(folder) / f"{name}.npz").toarray() for name in ("mass", "stiffness")
    )
    squares, shapes = scipy.linalg.eigh(stiffness, mass, subset_by_index=(0, given["modes"] - 1))
    count = len(mass) // 2
    along, across = shapes[:count], shapes[count:]
    contacts = Contacts(along, across, *(given[key] for key in ("mu", "k_u", "k_v", "n_0")))
    force = given["forces"][0] * along[-1] + given["forces"][1] * across[-1]
    balance = Balance(contacts, np.sqrt(squares), given["damping"], force, int(harmonics), int(samples))
    balance.residual(np.zeros(balance.terms * squares.size), 1.0)  # compiles
    begin = time.process_time()
    found = curve(balance, along[-1], tuple(given["span"]))
    print(time.process_time() - begin, found.amplitude.max())


if __name__ == "__main__":
    main(*sys.argv[1:])
