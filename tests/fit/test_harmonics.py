"""Fits with as many harmonics as the data take: those left out move the response by less than the misfit."""

import numpy as np
import pytest

from fcm.fit.parameters import parameters_of
from fcm.fit.solve import solved
from fcm.model.scene import Measured
from fcm.response import trace
from fcm.response.fit import fit
from fcm.run import Execution
from fcm.scene.load import scene_from_dict

TRUE = {"contact.c.mu": 0.4, "contact.c.k_u": 0.8, "contact.c.n_0": 2.0}


def blade(mu, k_u, n_0, **more):
    """Two modes and a contact that slips and opens: three harmonics leave 1e-3 of the response."""
    return scene_from_dict(
        {
            "modal": {"dofs": ["u", "v"], "frequency": [1.0, 3.3], "damping": [0.01, 0.01],
                      "shapes": [[0.707, 0.5], [0.9, -0.6]]},
            "contact": [{"name": "c", "tangential": "u", "normal": "v", "mu": mu, "k_u": k_u, "k_v": 0.6,
                         "n_0": n_0}],
            "force": [{"dof": "u", "amplitude": 1.0}],
            "response": {"frequency": [0.8, 1.7]},
            **more,
        }
    )  # fmt: skip


@pytest.fixture(scope="module")
def measured():
    """Frequencies and amplitudes with far more harmonics than the accuracy of a response takes."""
    curve = trace(blade(*TRUE.values()), harmonics=15).curves[0]
    at = np.unique(np.linspace(0, curve.points - 1, 30).astype(int))
    return curve.frequency[at], curve.amplitude[at, 0]


def table(path, frequency, amplitude):
    rows = np.column_stack((frequency, amplitude))
    np.savetxt(path, rows, delimiter=",", header="frequency,amplitude", comments="")
    return {"vary": list(TRUE), "data": [{"file": str(path), "dof": "u"}]}


@pytest.mark.slow
def test_the_truth_is_found_where_three_harmonics_would_make_up_for_the_others(measured, tmp_path):
    """They ended at other numbers, 3e-3 off and more than the standard error, from the truth as well."""
    shown = list[tuple[float, str]]()
    execution = Execution(progress=lambda share, text: shown.append((share, text)))
    found = fit(blade(0.25, 1.2, 3.0, fit=table(tmp_path / "data.csv", *measured)), execution=execution)
    of_searches = [share for share, text in shown if "evaluation" in text]
    assert np.diff(of_searches).min() > -0.05  # each round began at 0 again, and the bar stood at 100 %
    told = found.fitted
    assert told.values == pytest.approx(list(TRUE.values()), rel=1e-4)
    assert {curve.harmonics for curve in found.curves} == {told.harmonics}
    # what is told is the end of a search, and no other with these harmonics has less left
    last = [one for one in told.starts if one.finished and one.harmonics == told.harmonics]
    least = min(last, key=lambda one: one.cost)
    assert (least.end == told.values).all() and told.starts[0].harmonics == (1,)


@pytest.mark.slow
def test_that_is_begun_with_whose_data_are_nearest(measured):
    """The first leads to a friction of 1.01, where no step lessens the misfit."""
    scene = blade(0.25, 1.2, 3.0)
    parameters = parameters_of(scene, list(TRUE), [None] * 3)
    ones = np.ones(measured[0].size)
    data = Measured("made", "u", *measured, ones, ones)
    begin = [np.array([1.014, 1.179, 0.856]), np.array([0.39, 0.81, 2.05])]
    found = solved(parameters, [data], (1, 2, 3, 4), begin=begin)
    assert found.values == pytest.approx(list(TRUE.values()), rel=2e-3)


@pytest.mark.slow
def test_harmonics_that_are_given_and_too_few_leave_a_systematic_misfit(measured, tmp_path):
    given = {"frequency": [0.8, 1.7], "harmonics": 1}
    scene = blade(0.4, 0.8, 2.0, fit=table(tmp_path / "data.csv", *measured), response=given)
    told = fit(scene).fitted
    assert told.harmonics == (1,) and told.data[0].systematic
    assert any("off to the same side" in said for said in told.problems())
