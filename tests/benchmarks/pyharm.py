"""The paper's oscillator here and in pyHarm-os, in one run: ``make bench-others`` prints the table.

pyHarm-os (PyPI; Apache licence) is a harmonic-balance engine with elements for contacts. Those of its own
that have a normal motion fail when a preloaded contact opens, so it gets the law of the paper as a plug-in
element: sampled over the cycle, marched through two cycles from an unstressed start, with its exact
tangent, compiled by numba as its own elements are. Both sides solve for the mean and one harmonic.

What makes the comparison fair: the same frequency range; steps of pyHarm-os chosen for each curve from its
known peak, so that it makes about as many points; its peaks from a parabola through its three highest
points; its compilation not counted; its default tolerance, 1e-8, far below the error of its sampling; and
processor time for both, the least of as many runs. A curve that takes longer than a minute is stopped, said
to be, and not in the errors.
"""

from __future__ import annotations

import contextlib
import io
import logging
import platform
import signal
import sys
import time
import warnings
from collections.abc import Iterator
from dataclasses import dataclass, replace
from importlib.metadata import version
from typing import Any

import numpy as np
from numba import njit
from numba.core.errors import NumbaPerformanceWarning
from pyHarm.Elements.SubstructureMatrixElements.MatrixElement import MatrixElement
from pyHarm.Maestro import Maestro

import fcm
from fcm.response import trace
from fcm.scene.model import Scene

PRELOADS = (50.0, 20.0, 10.0, 5.0, 2.0, 0.0, -5.0, -20.0)  # without 100 and -60, which are linear
SAMPLES = (128, 1024)  # of a cycle
LIMIT = 60.0  # [s] of processor time for one curve of pyHarm-os
PER_PEAK = 40.0  # its longest step is the greatest displacement divided by this
FINEST = 1.0 / 16.0  # of the longest steps of the reference
REPEATS = 2  # of every curve, here and there; the least time counts


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
    """The contact of the paper between the two degrees of freedom of a structure and the ground."""

    factory_keyword = "PaperContact"

    def __flag_update__(self, *_: Any) -> None:
        self.flag_nonlinear = self.flag_AFT = True

    def _generateMatrices(self, data: dict[str, Any]) -> None:
        self.law = tuple(float(data[key]) for key in ("mu", "k_u", "k_v", "n_0"))
        # displacement at the samples from the unknowns: mean, cosine, sine, each of u and v
        self.du = np.kron(self.D["ft"].T, [1.0, 0.0])
        self.dv = np.kron(self.D["ft"].T, [0.0, 1.0])
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
        R, J = np.empty(x.size), np.empty((x.size, x.size))
        R[0::2], R[1::2] = to_harmonics @ f, to_harmonics @ n
        J[0::2], J[1::2] = to_harmonics @ df, to_harmonics @ dn
        self.last = x.copy(), R, J
        return R, J

    def evalResidual(self, xg: Any, om: float) -> Any:
        self.R, _ = self._both(xg[self.indices])
        return self.R

    def evalJacobian(self, xg: Any, om: float) -> Any:
        _, self.J = self._both(xg[self.indices])
        self.dJdom = np.zeros((self.indices.size, 1))
        return self.J, self.dJdom


@dataclass
class Result:
    """One curve: time [s], and what it found."""

    points: int
    seconds: float
    peak: float
    folds: int
    state: str = ""


def problem(scene: Scene, samples: int, longest: float) -> dict[str, Any]:
    """The scene as an input of pyHarm-os, in the physical coordinates u and v."""
    modal, contact = scene.modal, scene.contacts[0]
    inverse = np.linalg.inv(modal.shapes)  # x = shapes.T q
    matrices = {
        "M": modal.mass,
        "C": modal.mass * 2.0 * modal.damping * modal.frequency,
        "K": modal.mass * modal.frequency**2,
    }
    connectors: dict[str, Any] = {
        f"force {i}": {"type": "SinusForcing", "connect": {"structure": [0]}, "dirs": [i], "amp": f.amplitude}
        for i, f in enumerate(scene.forces)
    }
    connectors["contact"] = {
        "type": "PaperContact", "connect": "structure",
        "mu": contact.mu, "k_u": contact.k_u, "k_v": contact.k_v, "n_0": contact.n_0,
    }  # fmt: skip
    low, high = scene.frequency_range
    return {
        "plugin": [PaperContact],
        "system": {"type": "Base", "nh": 1, "nti": samples, "adim": {"status": False}},
        "substructures": {
            "structure": {
                "ndofs": 2,
                "matrix": {name: inverse @ np.diag(d) @ inverse.T for name, d in matrices.items()},
            }
        },
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


class OutOfTimeError(Exception):
    """A curve took longer than its limit."""


@contextlib.contextmanager
def limited(seconds: float) -> Iterator[None]:
    def stop(*_: object) -> None:
        raise OutOfTimeError

    before = signal.signal(signal.SIGPROF, stop)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        signal.signal(signal.SIGPROF, before)


def in_pyharm(scene: Scene, samples: int, peak: float) -> Result:
    """One curve of pyHarm-os."""
    with contextlib.redirect_stdout(io.StringIO()):
        maestro = Maestro(problem(scene, samples, peak / PER_PEAK))
    analysis = maestro.nls["frf"]
    begin, state = time.process_time(), ""
    try:
        with limited(LIMIT), contextlib.redirect_stdout(io.StringIO()):
            maestro.operate()
    except OutOfTimeError:
        state = f"stopped after {LIMIT:g} s"
    except Exception as error:
        state = f"{type(error).__name__}: {error}"
    seconds = time.process_time() - begin
    found = np.array([s.x for s in analysis.SolList if s.flag_accepted]).reshape(-1, 7)
    omega, amplitude = found[:, -1], np.hypot(found[:, 2], found[:, 4])
    if not state and omega[-1] < 0.99 * scene.frequency_range[1]:
        state = f"ended at {omega[-1]:.4f} rad/s"
    turns = int(np.count_nonzero(np.diff(np.sign(np.diff(omega))) != 0.0))
    return Result(omega.size, seconds, summit(amplitude), turns, state)


def best_in_pyharm(scene: Scene, samples: int, peak: float) -> Result:
    """The quickest of some runs."""
    return min((in_pyharm(scene, samples, peak) for _ in range(REPEATS)), key=lambda result: result.seconds)


def summit(amplitude: Any) -> float:
    """The greatest value of a parabola through the highest point and its neighbours."""
    k = int(amplitude.argmax())
    if not 0 < k < amplitude.size - 1:
        return float(amplitude[k])
    before, here, after = amplitude[k - 1 : k + 2]
    bend = before - 2.0 * here + after
    return float(here - (after - before) ** 2 / (8.0 * bend)) if bend < 0.0 else float(here)


def here(scenes: list[Scene], method: str, table: Any) -> tuple[float, list[Result]]:
    """All curves as one group: least time of some, and their results."""
    whole, best = replace(scenes[0], curves=tuple(scenes)), np.inf
    for _ in range(REPEATS):
        begin = time.process_time()
        curves = trace(whole, method, table).curves
        best = min(best, time.process_time() - begin)
    return float(best), [Result(c.points, c.seconds, c.peaks["u"][0], len(c.folds)) for c in curves]


def one_by_one(scenes: list[Scene], method: str, table: Any) -> tuple[float, list[Result]]:
    """The same, one curve after the other, as pyHarm-os makes them."""
    parts = [here([scene], method, table) for scene in scenes]
    return sum(seconds for seconds, _ in parts), [results[0] for _, results in parts]


def show(name: str, seconds: float, results: list[Result], true: list[float], times: list[float]) -> float:
    """A line of the table, and one for each curve that failed; the greatest error."""
    errors = np.array([abs(r.peak / p - 1.0) for r, p in zip(results, true, strict=True) if not r.state])
    points = sum(r.points for r in results)
    error = f"{errors.max():10.1e} {np.median(errors):8.1e}" if errors.size else f"{'-':>10s} {'-':>8s}"
    ratios = " ".join(f"{seconds / one:9.1f}" for one in times)
    folds = " ".join(str(r.folds) for r in results)
    print(f"{name:29s} {points:6d} {seconds:9.3f} {1e3 * seconds / points:9.3f} {error} {ratios}   {folds}")
    for preload, result in zip(PRELOADS, results, strict=True):
        if result.state:
            print(f"    n_0 = {preload:g}: {result.state}; not in the errors")
    return float(errors.max(initial=0.0))


def main() -> None:
    warnings.simplefilter("ignore", NumbaPerformanceWarning)
    logging.disable(logging.CRITICAL)
    base = fcm.load_scene("yang1998")
    scenes = [replace(c, curves=()) for n in PRELOADS for c in base.curves if c.contacts[0].n_0 == n]
    fine = [replace(scene, max_step=FINEST * scene.max_step) for scene in scenes]
    _, reference = here(fine, "closed-form", None)
    true = [result.peak for result in reference]
    table = fcm.open_table()
    together, as_group = here(scenes, "table", table)
    alone, singles = one_by_one(scenes, "table", table)
    without, closed = one_by_one(scenes, "closed-form", None)
    times = [together, alone]
    print(f"fcm {fcm.__version__}, pyHarm-os {version('pyHarm-os')}, Python {sys.version.split()[0]}, "
          f"numpy {np.__version__}, {platform.machine()}; preloads n_0 = "
          f"{', '.join(f'{n:g}' for n in PRELOADS)}\n"
          "error: of the peaks of u, relative, against the closed form with steps sixteen times shorter,\n"
          f"which has the folds {' '.join(str(r.folds) for r in reference)}; "
          "ratio: of the processor time to that of fcm, curves together and one after another\n")  # fmt: skip
    print(
        f"{'':29s} points   CPU [s]  ms/point   greatest   median  together     alone   folds of each curve"
    )
    ours = show("fcm, curves together", together, as_group, true, times)
    ours = max(ours, show("fcm, one after another", alone, singles, true, times))
    show("the same without a table", without, closed, true, times)
    for samples in SAMPLES:
        in_pyharm(scenes[0], samples, true[0])  # compiled, and not counted
        results = [best_in_pyharm(scene, samples, peak) for scene, peak in zip(scenes, true, strict=True)]
        seconds = sum(r.seconds for r in results)
        theirs = show(f"pyHarm-os, {samples} samples", seconds, results, true, times)
        larger = "no larger" if ours <= theirs else "LARGER: the ratio is not fair"
        ratios = f"{seconds / together:.1f} together, {seconds / alone:.1f} one after another"
        print(f"    ratio at equal error at least {ratios}; fcm's error is {larger}")


if __name__ == "__main__":
    main()
