"""Curves of TMDSimPy (github.com/tmd-lab/tmdsimpy; MIT licence): its own contact, solver and continuation.

Its element for elastic dry friction with variable normal load, differentiated and compiled by JAX (not
counted), is the law of the paper, the preload given as a gap below zero. Settings are those of its example
`2dof_eldry_fric`, with which it makes about as many points as fcm.
"""

from __future__ import annotations

import contextlib
import io
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

SOURCE = Path(sys.argv[4])  # where the repository is
sys.path.append(str(SOURCE))
os.environ["XLA_FLAGS"] = "--xla_cpu_multi_thread_eigen=false intra_op_parallelism_threads=1"

import jax  # noqa: E402
import numpy as np  # noqa: E402
import tmdsimpy.utils.harmonic as harmonic  # noqa: E402
from solved import OutOfTimeError, Problem, Result, Solved, limited, result, run  # noqa: E402
from tmdsimpy.continuation import Continuation  # noqa: E402
from tmdsimpy.jax.nlforces.elastic_dry_fric_2d import ElasticDryFriction2D  # noqa: E402
from tmdsimpy.solvers import NonlinearSolver  # noqa: E402
from tmdsimpy.vibration_system import VibrationSystem  # noqa: E402

FIRST, SHORTEST, LONGEST = 0.05, 1e-3, 0.1  # steps, in units of its scaled unknowns


def system(problem: Problem) -> tuple[Any, Any]:
    """Its system in modal coordinates, and its load."""
    natural, damping = np.array(problem["natural"]), np.array(problem["damping"])
    modes, h = natural.size, np.arange(problem["harmonics"] + 1)
    vibrating = VibrationSystem(np.eye(modes), np.diag(natural**2), C=np.diag(2.0 * damping * natural))
    load = np.zeros(modes * harmonic.Nhc(h))
    load[modes : 2 * modes], load[2 * modes : 3 * modes] = problem["cosine"], problem["sine"]
    for c in problem["contacts"]:
        local = np.array([c["tangential"], c["normal"]])
        vibrating.add_nl_force(
            ElasticDryFriction2D(local, local.T, c["k_u"], c["k_v"], c["mu"], meso_gap=-c["n_0"] / c["k_v"])
        )
        load[:modes] += max(c["n_0"], 0.0) * local[1]  # at rest in equilibrium with the preload
    return vibrating, load


def solved(problem: Problem, samples: int, limit: float) -> Solved:
    vibrating, load = system(problem)
    h, (low, high) = np.arange(problem["harmonics"] + 1), problem["range"]
    start = np.append(np.zeros_like(load), low)
    scale = harmonic.harmonic_wise_conditioning(start, len(problem["natural"]), h, delta=1e-3)
    scale[-1] = high
    kept: list[Any] = []
    settings = {
        "DynamicCtoP": True, "TargetNfev": 200, "MaxSteps": 8000, "dsmin": SHORTEST,
        "dsmax": LONGEST, "verbose": -1, "xtol": 1e-9 * load.size, "corrector": "Ortho",
        "callback": lambda point, _direction: kept.append(point),
    }  # fmt: skip
    solver = NonlinearSolver()
    state = ""
    try:
        with limited(limit), contextlib.redirect_stdout(io.StringIO()):
            jacobian = vibrating.hbm_res(start, load, h, Nt=samples)[1] * scale[:-1]
            weight = 1.0 / np.max(np.abs(np.diag(jacobian)))
            Continuation(solver, ds0=FIRST, CtoP=scale, RPtoC=weight, config=settings).continuation(
                lambda z: vibrating.hbm_res(z, load, h, Nt=samples), start, low, high
            )
    except OutOfTimeError:
        state = f"stopped after {limit:g} s"
    except Exception as error:
        state = f"{type(error).__name__}: {error}"
    points = np.array([z for z in kept if np.isfinite(z).all()]).reshape(-1, start.size)
    return Solved(points[:, :-1], points[:, -1], state)


def curve(problem: Problem, samples: int, limit: float) -> Result:
    """One curve; what is compiled has been before."""
    vibrating, load = system(problem)
    h = np.arange(problem["harmonics"] + 1)
    vibrating.hbm_res(np.append(np.zeros_like(load), 1.0), load, h, Nt=samples)
    return result(problem, samples, limit, lambda: solved(problem, samples, limit))


if __name__ == "__main__":
    commit = subprocess.run(
        ["git", "-C", str(SOURCE), "rev-parse", "--short", "HEAD"], capture_output=True, text=True, check=True
    ).stdout.strip()
    run(f"tmdsimpy {commit}, jax {jax.__version__}", curve)
