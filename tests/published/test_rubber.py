"""The cantilever RubBeR with a friction contact, as NLtest models it (github.com/maltekrack/NLtest).

Scheel, Weigele and Krack, Journal of Sound and Vibration 485 (2020) 115580, built and measured it; the
model is that of the example `BT01_virtualRubBeR`: L = 0.71 m, height 0.05 m, width 0.06 m, 15 nodes. At the
sixth is a Jenkins element of 1e7 N/m that slides at 15 N. The beam is reduced to that node and three modes
with it held; seven harmonics. Published there are the frequency with the contact stuck and the
mass-normalised shape at the tip.
"""

from pathlib import Path

import numpy as np
import pytest
import scipy.io
import scipy.linalg

import fcm
from fcm.harmonic_balance.system import System
from fcm.nonlinear_modes.backbone import nonlinear_mode
from fcm.scene import scene_from_dict

STUCK, TIP = 80.36779980815375, 0.5038879529045213  # Hz, 1 / sqrt(kg)
STIFFNESS, LIMIT = 1e7, 15.0  # N/m, N
SCENES = Path(fcm.__file__).parent / "scenes"
PERIODS, STEPS = 30, 1000


def reduced():
    """Mass, stiffness and where the tip is in the unknowns: the contact's displacement, and three modes."""
    M, K = (scipy.io.mmread(SCENES / f"beam-{name}.mtx").toarray() for name in ("mass", "stiffness"))
    at, last = 8, 26  # displacements of the sixth node and of the fifteenth; the clamped one has none
    others = [i for i in range(len(M)) if i != at]
    inner = np.ix_(others, others)
    _, modes = scipy.linalg.eigh(K[inner], M[inner])
    T = np.zeros((len(M), 4))
    T[at, 0] = 1.0
    T[others, 0] = -np.linalg.solve(K[inner], K[others, at])
    T[np.ix_(others, [1, 2, 3])] = modes[:, :3]
    return T.T @ M @ T, T.T @ K @ T, T[last]


def scene(damping=0.0, force=1.0, span=(350.0, 600.0)):
    M, K, tip = reduced()
    return scene_from_dict(
        {
            "structure": {
                "dofs": ["w6", "q1", "q2", "q3"], "mass": M.tolist(), "stiffness": K.tolist(),
                "damping": {"mass": damping, "stiffness": 0.0}, "modes": 4,
            },
            "contact": [{"name": "rub", "tangential": "w6", "normal": "q1", "mu": 1.0, "k_u": STIFFNESS,
                         "k_v": 0.0, "n_0": LIMIT}],
            "force": [{"dof": dict(zip(["w6", "q1", "q2", "q3"], tip.tolist(), strict=True)),
                       "amplitude": force}],
            "response": {"frequency": list(span), "harmonics": 7},
        }
    )  # fmt: skip


def the_mode():
    return nonlinear_mode(System(scene(), tuple(range(1, 8))), 1, (1e-5, 3e-2), 0.05)


@pytest.fixture(scope="module")
def mode():
    return the_mode()


def test_frequency_and_shape_while_stuck_are_those_published(mode):
    tip = reduced()[2]
    shape = np.abs(mode.displacements()[0][0, 0] @ tip) / mode.amplitude[0]
    assert mode.omega[0] / (2.0 * np.pi) == pytest.approx(STUCK, rel=1e-9)
    assert shape == pytest.approx(TIP, rel=1e-8)


def test_it_begins_to_slide_where_the_spring_bears_the_limit(mode):
    """And ends at the frequency without contact."""
    M, K, _ = reduced()
    K[0, 0] += STIFFNESS
    _, shapes = scipy.linalg.eigh(K, M)
    onset = LIMIT / STIFFNESS / abs(shapes[0, 0])
    before = mode.amplitude < onset
    assert np.abs(mode.damping[before]).max() < 1e-12
    assert mode.damping[~before][2:].min() > 0.0 and mode.damping.max() > 0.05
    K[0, 0] -= STIFFNESS
    free = np.sqrt(scipy.linalg.eigh(K, M)[0][0])
    assert mode.omega[-1] == pytest.approx(free, rel=2e-3)


def marched(damping, force, omega):
    """Half the peak-to-peak displacement of the tip in the last of the periods, by leapfrog steps."""
    M, K, tip = reduced()
    step = 2.0 * np.pi / omega / STEPS
    inverse = np.linalg.inv(M)
    stiffness, push = step * inverse @ K, step * inverse @ tip * force
    pull, x, v, friction, track = step * inverse[:, 0], np.zeros(4), np.zeros(4), 0.0, []
    kept, lost = 1.0 - 0.5 * damping * step, 1.0 / (1.0 + 0.5 * damping * step)
    for n in range(STEPS * PERIODS):
        v = lost * (kept * v + push * np.sin(omega * n * step) - stiffness @ x - pull * friction)
        x = x + step * v
        friction = min(max(friction + STIFFNESS * step * v[0], -LIMIT), LIMIT)
        if n >= STEPS * (PERIODS - 1):
            track.append(tip @ x)
    return np.ptp(track) / 2.0


@pytest.mark.slow
@pytest.mark.parametrize("force", [5.0, 15.0])
def test_the_forced_response_is_that_of_a_march(force):
    """Stuck most of the time, and mainly sliding."""
    damping, omega = 40.0, 460.0
    found = fcm.respond(scene(damping, force, (omega, omega + 1.0))).isel(curve=0)
    there = found.isel(point=int(np.flatnonzero(found.frequency.values == omega)[0]))
    assert "P" in str(there.regime.values)
    motion = there.harmonic_amplitude.values * np.exp(1j * there.harmonic_phase.values)
    turn = np.exp(2j * np.pi * np.outer(np.arange(256), there.harmonic.values) / 256)
    tip = (turn @ motion @ reduced()[2]).imag
    assert np.ptp(tip) / 2.0 == pytest.approx(marched(damping, force, omega), rel=5e-3)
