"""A mass driven in a circle on a contact in a plane, by pyHarm's own element: ``make bench-others``.

Its ``Jenkins`` element with two directions samples the force and returns it radially to the disc. The mass
has springs 1 and the damping ratio 0.05, the contact the stiffness 1 and the slip limit 0.5 under constant
load. The peak has a closed form, the greatest a with

    |(1 - w^2 + 0.1 i w) a + r^2 / a + i r sqrt(1 - (r / a)^2)| = 1
"""

from __future__ import annotations

import contextlib
import io
import logging
import time
import warnings
from typing import Any

import numpy as np
from numba.core.errors import NumbaPerformanceWarning
from pyHarm.Maestro import Maestro
from solved import summit

SAMPLES = (64, 256, 1024, 4096, 16384)
LIMIT, SPAN, LONGEST = 0.5, (0.6, 1.8), 0.05


def closed_form() -> float:
    """The greatest radius of all frequencies: for each by bisection."""
    w = np.linspace(*SPAN, 200001)
    low, high = np.full(w.size, LIMIT), np.full(w.size, 100.0)
    for _ in range(80):
        a = 0.5 * (low + high)
        part = LIMIT / a
        force = (1.0 - w**2 + 0.1j * w) * a + LIMIT * part + 1j * LIMIT * np.sqrt(1.0 - part**2)
        inside = np.abs(force) < 1.0
        low, high = np.where(inside, a, low), np.where(inside, high, a)
    return float(low.max())


def inputs(samples: int) -> dict[str, Any]:
    """The problem as pyHarm takes it."""
    matrix = {"M": np.eye(2), "C": 0.1 * np.eye(2), "K": np.eye(2)}
    return {
        "system": {"type": "Base", "nh": 1, "nti": samples, "adim": {"status": False}},
        "substructures": {"mass": {"ndofs": 2, "matrix": matrix}},
        "connectors": {
            "x": {"type": "CosinusForcing", "connect": {"mass": [0]}, "dirs": [0], "amp": 1.0},
            "y": {"type": "SinusForcing", "connect": {"mass": [0]}, "dirs": [1], "amp": 1.0},
            "pad": {
                "type": "Jenkins", "connect": {"mass": [0]}, "dirs": [0, 1], "mu": LIMIT, "N0": 1.0, "k": 1.0,
            },
        },
        "kinematics": {},
        "analysis": {
            "frf": {
                "study": "frf", "solver": "NewtonRaphson", "solver_options": {"max_iter": 30},
                "predictor": "tangent", "corrector": "arc_length",
                "puls_inf": SPAN[0], "puls_sup": SPAN[1], "sign_ds": 1,
                "ds0": 0.1 * LONGEST, "ds_max": LONGEST, "ds_min": 1e-7, "verbose": False,
                "predictor_options": {"verbose": False},
            }
        },
    }  # fmt: skip


def curve(samples: int) -> tuple[float, int, float]:
    """Processor time [s], points and the peak of x."""
    with contextlib.redirect_stdout(io.StringIO()):
        maestro = Maestro(inputs(samples))
        begin = time.process_time()
        maestro.operate()
    seconds = time.process_time() - begin
    points = np.array([s.x for s in maestro.nls["frf"].SolList if s.flag_accepted])
    x = points[:, :-1].reshape(len(points), 3, 2)[:, 1:, 0]  # cosine and sine of x
    return seconds, len(points), summit(points[:, -1], np.hypot(x[:, 0], x[:, 1]))


if __name__ == "__main__":
    warnings.simplefilter("ignore", NumbaPerformanceWarning)
    logging.disable(logging.CRITICAL)
    curve(64)  # what numba compiles is not counted
    exact = closed_form()
    print(
        "A mass driven in a circle, by pyHarm's planar element: samples, points, CPU [s], error of the peak"
    )
    for samples in SAMPLES:
        seconds, points, peak = curve(samples)
        print(f"{samples:8d} {points:6d} {seconds:9.3g} {abs(peak / exact - 1.0):9.1e}", flush=True)
