"""Analyses of contacts in a plane: as many harmonics as an accuracy takes, optima, fits, draws, rings."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import fcm
from fcm.fit.parameters import parameters_of
from fcm.fit.solve import solved
from fcm.model.scene import Measured
from fcm.response import trace
from fcm.response.optimum import optimise
from fcm.scene import scene_from_dict
from fcm.table import open_table

from .test_plane import ELLIPSE, OBLIQUE, rotating, single, with_still

RING = {
    "cyclic": {"sectors": 6, "engine_order": 2},
    "structure": {
        "dofs": ["disk", "blade"],
        "mass": [1.0, 0.3],
        "stiffness": [[12.0, -1.0], [-1.0, 1.0]],
        "damping": 0.02,
        "coupling": {"stiffness": [[-5.0, 0.0], [0.0, 0.0]]},
    },
    "contact": [
        {
            "name": "shroud", "tangential": {"next.blade": 1.0, "blade": -1.0},
            "normal": {"next.blade": -0.2, "blade": 0.2}, "mu": 0.3, "k_u": 0.2, "k_v": 0.2, "n_0": 1.0,
        }
    ],
    "force": [{"dof": "blade", "amplitude": 0.1}],
    "response": {"frequency": [1.4, 2.4], "harmonics": [1, 3]},
}  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("oscillators", [ELLIPSE, OBLIQUE])
def test_peaks_with_as_many_harmonics_as_an_accuracy_takes_are_those_of_a_march(oscillators):
    """The march's top is that of a parabola. With the default accuracy, 1e-2, the error is that told."""
    scene = replace(oscillators.scene((0.8, 1.5)), harmonics=None)
    default, fine = (fcm.respond(scene, "closed-form", accuracy=one) for one in (None, 1e-4))
    top, step = float(fine.peak_frequency.sel(dof="x")[0]), 2e-3
    low, middle, high = (oscillators.extrapolated(top + k * step, 60, 200)[0] for k in (-1, 0, 1))
    peak = middle + (high - low) ** 2 / (8.0 * (2.0 * middle - low - high))
    assert float(fine.peak_amplitude.sel(dof="x")[0]) == pytest.approx(peak, rel=1e-4)
    error = abs(float(default.peak_amplitude.sel(dof="x")[0]) / peak - 1.0)
    assert error < 2e-3
    assert float(default.peak_error.sel(dof="x")[0]) == pytest.approx(error, rel=0.1)


@pytest.mark.slow
def test_the_best_preload_of_a_contact_in_a_plane_is_that_of_many_tried():
    given = {"lag": 1.0, "force": (1.0, 0.6, 0.0), "damping": 0.05, "span": (0.7, 1.7)}
    wanted = {"vary": ["contact.pad.n_0"], "bounds": [[0.5, 12.0]], "minimise": "peak.x"}
    (found,) = optimise(rotating(**given, optimum=wanted), harmonics=(1,)).tracking.optima
    tried = np.linspace(0.5, 12.0, 24)
    heights = []
    for n_0 in tried:
        response = fcm.respond(rotating(**(given | {"n_0": float(n_0)})), "closed-form", harmonics=1)
        heights.append(float(response.peak_amplitude.sel(dof="x")[0]))
    assert found.value <= min(heights) * (1.0 + 1e-9)
    assert found.values["contact.pad.n_0"] == pytest.approx(tried[np.argmin(heights)], abs=0.5)


@pytest.mark.slow
def test_optimum_fit_and_draws_of_a_still_direction_are_those_of_a_line():
    short = {"frequency": [1.0, 1.5], "harmonics": 1}
    wanted = {"vary": ["contact.shroud.n_0"], "bounds": [[2.0, 8.0]], "minimise": "peak.u"}
    data = single("yang1998-n5", response=short)
    optima, fits, draws = [], [], []
    measured = trace(scene_from_dict(data)).curves[0]
    for one in (data, with_still(data)):
        scene = scene_from_dict(one | {"optimum": wanted})
        optima.append(optimise(scene, harmonics=(1,)).tracking.optima[0])
        keys = ["contact.shroud.mu", "contact.shroud.n_0"]
        away = parameters_of(scene_from_dict(one), keys, [None, None]).at(np.array([0.35, 5.5]))
        points = Measured(
            "made",
            "u",
            measured.frequency[::8],
            measured.amplitude[::8, 0],
            *np.ones((2, measured.frequency[::8].size)),
        )
        fits.append(solved(parameters_of(away, keys, [None, None]), [points], (1,)).values)
        drawn = scene_from_dict(
            one | {"sweep": {"contact.shroud.n_0": {"normal": [5.0, 0.5], "count": 3, "seed": 4}}}
        )
        draws.append(fcm.respond(drawn, "closed-form").peak_amplitude.sel(dof="u").values)
    assert optima[1].value == pytest.approx(optima[0].value, rel=1e-9)
    assert optima[1].values["contact.shroud.n_0"] == pytest.approx(
        optima[0].values["contact.shroud.n_0"], rel=1e-6
    )
    assert fits[1] == pytest.approx(fits[0], rel=1e-7)
    assert draws[1] == pytest.approx(draws[0], rel=1e-9)


@pytest.mark.slow
def test_a_ring_whose_second_direction_never_moves_is_that_of_a_line():
    still = RING["structure"] | {
        "dofs": ["disk", "blade", "still"],
        "mass": [1.0, 0.3, 1.0],
        "stiffness": [[12.0, -1.0, 0.0], [-1.0, 1.0, 0.0], [0.0, 0.0, 50.0]],
        "coupling": {"stiffness": [[-5.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]]},
    }
    (contact,) = RING["contact"]
    second = {"next.still": 1.0, "still": -1.0}
    plane = RING | {
        "structure": still,
        "contact": [contact | {"tangential": [contact["tangential"], second]}],
    }
    peaks = [
        fcm.respond(scene_from_dict(one), "closed-form").peak_amplitude.sel(dof="blade").values
        for one in (RING, plane)
    ]
    assert peaks[1] == pytest.approx(peaks[0], rel=1e-9)


@pytest.mark.parametrize(
    "given, harmonics, times", [(False, 1, 1), (False, 2, 0), (True, 1, 1), (True, 2, 1)]
)
def test_a_table_is_said_once_to_be_of_no_use_where_it_would_be_used(given, harmonics, times):
    scene = ELLIPSE.scene((0.95, 1.05))
    method = open_table() if given else "table"
    said = trace(scene, method=method, harmonics=tuple(range(1, harmonics + 1))).left_out
    assert sum("the table: forces of contacts in a plane are exact" in one for one in said) == times
