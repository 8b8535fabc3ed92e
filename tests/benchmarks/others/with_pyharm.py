"""Curves of pyHarm-os (PyPI; Apache licence), a harmonic-balance engine with elements for contacts.

Those of its own that have a normal motion fail when a preloaded contact opens, so it gets the law of the
paper as a plug-in element: sampled over the cycle, marched through two cycles from an unstressed start, with
its exact tangent, compiled by numba as its own elements are (not counted). Its longest step is chosen for
each curve from the known peak, so that it makes about as many points as fcm; its tolerance is its default,
1e-8, far below the error of its sampling.
"""

from __future__ import annotations

import contextlib
import io
import logging
import warnings
from importlib.metadata import version
from typing import Any

import numpy as np
from numba import njit
from numba.core.errors import NumbaPerformanceWarning
from pyHarm.Elements.SubstructureMatrixElements.MatrixElement import MatrixElement
from pyHarm.Maestro import Maestro
from solved import PER_PEAK, OutOfTimeError, Problem, Result, Solved, limited, result, run


@njit(cache=True)
def marched(u, v, du, dv, mu, k_u, k_v, n_0):  # type: ignore[no-untyped-def]
    """Friction and normal force at the samples, and their derivatives by the unknowns, after two cycles."""
    samples, unknowns = du.shape
    f, n = np.zeros(samples), np.zeros(samples)
    df, dn = np.zeros((samples, unknowns)), np.zeros((samples, unknowns))
    for cycle in range(2):
        for t in range(samples):
            load = n_0 + k_v * v[t]
            n[t] = max(load, 0.0)
            if cycle == 0 and t == 0:
                continue
            trial = f[t - 1] + k_u * (u[t] - u[t - 1])  # t - 1 = -1 is the last sample
            for j in range(unknowns):
                dn[t, j] = k_v * dv[t, j] if load > 0.0 else 0.0
            if abs(trial) <= mu * n[t]:
                f[t] = trial
                for j in range(unknowns):
                    df[t, j] = df[t - 1, j] + k_u * (du[t, j] - du[t - 1, j])
            else:
                sign = 1.0 if trial > 0.0 else -1.0
                f[t] = sign * mu * n[t]
                for j in range(unknowns):
                    df[t, j] = sign * mu * dn[t, j]
    return f, n, df, dn


class PaperContact(MatrixElement):  # type: ignore[misc]
    """The contact of the paper between two directions of a structure and the ground."""

    factory_keyword = "PaperContact"

    def __flag_update__(self, *_: Any) -> None:
        self.flag_nonlinear = self.flag_AFT = True

    def _generateMatrices(self, data: dict[str, Any]) -> None:
        self.law = tuple(float(data[key]) for key in ("mu", "k_u", "k_v", "n_0"))
        # displacement at the samples from the unknowns: mean, cosine, sine, ... each of all modes
        self.du = np.kron(self.D["ft"].T, data["tangential"])
        self.dv = np.kron(self.D["ft"].T, data["normal"])
        self.last: tuple[Any, Any, Any] | None = None  # displacements, residual, Jacobian

    def adim(self, lc: float, wc: float) -> None:
        raise NotImplementedError

    def _both(self, x: Any) -> tuple[Any, Any]:
        """Residual and Jacobian, marched once for both."""
        if self.last is not None and np.array_equal(x, self.last[0]):
            return self.last[1:]
        f, n, df, dn = marched(self.du @ x, self.dv @ x, self.du, self.dv, *self.law)
        to_harmonics = self.D["tf"].T
        n = n - max(self.law[3], 0.0)  # the structure at rest is in equilibrium with the preload
        t, v = np.asarray(self.data["tangential"]), np.asarray(self.data["normal"])
        R = np.kron(to_harmonics @ f, t) + np.kron(to_harmonics @ n, v)
        J = np.kron(to_harmonics @ df, t[:, None]) + np.kron(to_harmonics @ dn, v[:, None])
        self.last = x.copy(), R, J
        return R, J

    def evalResidual(self, xg: Any, om: float) -> Any:
        self.R, _ = self._both(xg[self.indices])
        return self.R

    def evalJacobian(self, xg: Any, om: float) -> Any:
        _, self.J = self._both(xg[self.indices])
        self.dJdom = np.zeros((self.indices.size, 1))
        return self.J, self.dJdom


def inputs(problem: Problem, samples: int) -> dict[str, Any]:
    """The problem as pyHarm-os takes it."""
    natural, damping = np.array(problem["natural"]), np.array(problem["damping"])
    forcing = (("CosinusForcing", problem["cosine"]), ("SinusForcing", problem["sine"]))
    connectors: dict[str, Any] = {
        f"{kind} {i}": {"type": kind, "connect": {"structure": [0]}, "dirs": [i], "amp": amplitude}
        for kind, amplitudes in forcing
        for i, amplitude in enumerate(amplitudes)
        if amplitude
    }
    connectors |= {
        f"contact {i}": {"type": "PaperContact", "connect": "structure", **contact}
        for i, contact in enumerate(problem["contacts"])
    }
    longest = problem["peak"] / max(map(abs, problem["output"])) / PER_PEAK
    low, high = problem["range"]
    matrix = {"M": np.eye(natural.size), "C": np.diag(2.0 * damping * natural), "K": np.diag(natural**2)}
    return {
        "plugin": [PaperContact],
        "system": {"type": "Base", "nh": problem["harmonics"], "nti": samples, "adim": {"status": False}},
        "substructures": {"structure": {"ndofs": natural.size, "matrix": matrix}},
        "connectors": connectors,
        "kinematics": {},
        "analysis": {
            "frf": {
                "study": "frf", "solver": "NewtonRaphson", "solver_options": {"max_iter": 30},
                "predictor": "tangent", "corrector": "arc_length",
                "puls_inf": low, "puls_sup": high, "sign_ds": 1,
                "ds0": 0.1 * longest, "ds_max": longest, "ds_min": 1e-7, "verbose": False,
                "predictor_options": {"verbose": False},
            }
        },
    }  # fmt: skip


def solved(maestro: Any, limit: float) -> Solved:
    analysis, state = maestro.nls["frf"], ""
    try:
        with limited(limit), contextlib.redirect_stdout(io.StringIO()):
            maestro.operate()
    except OutOfTimeError:
        state = f"stopped after {limit:g} s"
    except Exception as error:
        state = f"{type(error).__name__}: {error}"
    points = np.array([s.x for s in analysis.SolList if s.flag_accepted])
    points = points.reshape(len(points), -1) if len(points) else np.zeros((0, 1))
    return Solved(points[:, :-1], points[:, -1], state)


def curve(problem: Problem, samples: int, limit: float) -> Result:
    with contextlib.redirect_stdout(io.StringIO()):
        maestro = Maestro(inputs(problem, samples))
    return result(problem, samples, limit, lambda: solved(maestro, limit))


def compile_all() -> None:
    """What numba compiles, and keeps, is not counted."""
    problem: Problem = {
        "name": "", "harmonics": 1, "natural": [1.0, 10.0], "damping": [0.01, 0.01], "range": [0.7, 1.0],
        "cosine": [1.0, 1.0], "sine": [1.0, 1.0], "output": [1.0, 1.0], "peak": 3.0,
        "contacts": [{"mu": 0.4, "k_u": 1.0, "k_v": 1.0, "n_0": 5.0, "tangential": [1.0, 1.0],
                      "normal": [1.0, -1.0]}],
    }  # fmt: skip
    curve(problem, 64, 600.0)


if __name__ == "__main__":
    warnings.simplefilter("ignore", NumbaPerformanceWarning)
    logging.disable(logging.CRITICAL)
    compile_all()
    run(f"pyHarm-os {version('pyHarm-os')}", curve)
