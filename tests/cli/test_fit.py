"""`fcm respond` of a scene with a [fit], as a user meets it."""

import json
import re

import numpy as np
import pytest
import xarray

from fcm.cli.fit import as_table
from fcm.fit.solve import SearchResult
from fcm.response import trace
from fcm.response.fit import is_search_result
from fcm.response.options import FITTED_RESPONSE
from fcm.scene.load import load_scene

from ..interrupted import Interrupting
from ..oscillator import oscillator
from ..program import called

RANGE = "[response]\nfrequency = [0.9, 1.6]\nharmonics = 1\n"
TRUE = {"contact.shroud.k_u": 1.0, "modal.damping.0": 0.02}


def scene(k_u=1.0, damping=0.02, n_0=5.0, amplitude=1.0, k_v=1.0, rest=RANGE):
    text = oscillator(rest, damping=[damping, 0.01], n_0=n_0, amplitude=amplitude)
    return text.replace("k_u = 1.0", f"k_u = {k_u}").replace("k_v = 1.0", f"k_v = {k_v}")


@pytest.fixture
def measured(tmp_path):
    """Writes a scene with other numbers than those of the data beside it; gives its path."""

    def write(n_0=5.0, vary=tuple(TRUE), level=1.0, points=20, k_v=1.0):
        (tmp_path / "true.toml").write_text(scene(n_0=n_0, amplitude=level, k_v=k_v))
        curve = trace(load_scene(tmp_path / "true.toml"), method="closed-form").curves[0]
        at = np.unique(np.linspace(0, curve.points - 1, points).astype(int))
        noise = 1.0 + 0.01 * np.random.default_rng(2).standard_normal(at.size)
        rows = zip(curve.frequency[at], curve.amplitude[at, 0] * noise, strict=True)
        text = "frequency,amplitude\n" + "".join(f"{f:.12g},{a:.12g}\n" for f, a in rows)
        (tmp_path / "data.csv").write_text(text)
        keys = ", ".join(f'"{key}"' for key in vary)
        fit = f'[fit]\nvary = [{keys}]\n[[fit.data]]\nfile = "data.csv"\ndof = "u"\nlevel = {level}\n'
        path = tmp_path / "scene.toml"
        path.write_text(scene(0.8, 0.03, n_0=n_0, k_v=k_v) + fit)
        return path

    return write


@pytest.mark.slow
def test_the_numbers_are_told_with_their_errors_and_drawn(measured, tmp_path):
    path, out = measured(), tmp_path / "fitted.nc"
    done = called("respond", path, "-o", out, "--json")
    assert done.code == 0, done.err
    found = json.loads(done.out)["fitted"]
    for key, true in TRUE.items():
        one = found["numbers"][key]
        assert one["value"] == pytest.approx(true, abs=4.0 * one["standard_error"])
        assert one["standard_error"] < 0.05 * true and one["interval"][0] < one["value"] < one["interval"][1]
    assert 0.001 < found["data"][0]["misfit"] < 0.02 and not found["problems"]
    with xarray.open_dataset(out) as data:
        assert data.fitted.values.tolist() == list(TRUE)
        assert data.data_amplitude.shape == (1, 20) and data.sizes["curve"] == 1
        # the response in the file is that with the numbers fitted
        again = load_scene(path)
        assert data.fitted_value.values == pytest.approx([one["value"] for one in found["numbers"].values()])
        assert again.fit is not None and data.attrs["layout"] == "fcm response 1"
    assert called("plot", "response", out, "-o", tmp_path / "fitted.png").code == 0
    assert (
        called("plot", "response", out, "-o", tmp_path / "b.png", "--points", tmp_path / "data.csv").code == 0
    )


@pytest.mark.slow
def test_the_table_names_numbers_and_data(measured):
    done = called("respond", measured(points=10))
    assert "standard error" in done.out and "contact.shroud.k_u" in done.out and "data.csv u" in done.out
    rough = "10 of 10, rough" in done.out
    assert rough == ("not comparable with those of all" in done.out)
    assert "curve" in done.err


def test_costs_of_rough_searches_are_told_from_those_of_all_points():
    start = {"points": 12, "cost": 23.7, "finished": False, "end": [8.3], "harmonics": [1]}
    numbers = {"standard_error": 0.1, "interval": [0.2, 0.4], "value": 0.3, "start": 0.5}
    data = {"points": 56, "level": [1.0, 1.0], "kind": "response", "damping_misfit": None, "misfit": 0.01}
    data |= {"file": "d.csv", "dof": "u", "error_estimated": False}
    found = {"numbers": {"contact.c.mu": numbers}, "confidence": 0.95, "data": [data], "harmonics": [1]}
    both = [start, start | {"points": 56, "finished": True, "cost": 28.0}]
    table = as_table({"fitted": found | {"starts": both}})
    assert "12 of 56, rough" in table and " all " in table and "not comparable with those of all" in table
    table = as_table({"fitted": found | {"starts": both[1:]}})
    assert "rough" not in table.lower()


@pytest.mark.slow
def test_a_number_that_the_data_do_not_tell_is_said_with_what_would_tell_it(measured):
    """The contact sticks at this level; it slips at three or ten times the level."""
    path = measured(n_0=1000.0, vary=("contact.shroud.mu", "contact.shroud.k_u"), points=12)
    path.write_text(path.read_text().replace("n_0 = 1000.0", "n_0 = 30.0"))
    done = called("respond", path)
    assert done.code == 0, done.err
    assert "contact.shroud.mu has no effect on these data" in done.err
    advice = r'contact.shroud.mu: a response at "[uv]" with forces at a level of (3|10) would determine it'
    assert re.search(advice, done.err)


@pytest.mark.slow
def test_numbers_of_which_a_product_alone_matters_are_indistinguishable(measured):
    path = measured(vary=("contact.shroud.mu", "contact.shroud.n_0"), points=12, k_v=0.0)
    done = called("respond", path, "--json")
    assert done.code == 0, done.err
    found = json.loads(done.out)["fitted"]
    ((one, other, power),) = found["not_told_apart"]
    assert [found["numbers"][key]["interval"] for key in (one, other)] == [[None, None]] * 2
    heads = as_table({"fitted": found, "units": {"length": "mm", "force": "N"}})
    assert "contact.shroud.n_0 [N]\n" in heads and "contact.shroud.mu\n" in heads
    assert sum(line.count("not determined") for line in as_table({"fitted": found}).splitlines()[1:3]) == 2
    assert {one, other} == {"contact.shroud.mu", "contact.shroud.n_0"} and power == pytest.approx(
        1.0, rel=1e-6
    )


@pytest.mark.parametrize(
    "option", [("--method", "exact"), ("--mode", "1", "--level", "1:2"), ("--sensitivity",)]
)
def test_what_means_nothing_with_a_fit_is_refused(measured, option):
    done = called("respond", measured(points=5), *option)
    assert done.code == 2 and "is of no use with [fit]" in done.err


class Evaluations:
    """Counts those of a fit, and interrupts after one of them."""

    def of(self, *arguments, stop=10**9):
        """A run, and how many it took."""
        messages = Interrupting("evaluation", stop)
        run = called("respond", *arguments, "--json", messages=messages)
        return run, sum("evaluation" in text for _, text in messages.shown)


@pytest.mark.slow
def test_a_fit_interrupted_anywhere_tells_the_best_so_far_and_is_gone_on_with(measured, tmp_path):
    """It was begun afresh: nothing of a fit was kept, and before the end of a start nothing was told."""
    path, evaluations = measured(points=12), Evaluations()
    whole, most = evaluations.of(path)
    expected = json.loads(whole.out)["fitted"]["numbers"]
    for stop in (3, most // 2, most - 1):
        out = tmp_path / f"{stop}.nc"
        done, _ = evaluations.of(path, "-o", out, stop=stop)
        assert done.code == 3 and "continue with --resume" in done.err
        found = json.loads(done.out)["fitted"]
        assert found["interrupted"] and not found["final"]
        assert "those shown are the best so far" in done.err
        with xarray.open_dataset(out) as data:
            assert data.fitted_value.values == pytest.approx(
                [one["value"] for one in found["numbers"].values()]
            )
        again, count = evaluations.of(path, "-o", out, "--resume")
        assert again.code == 0, again.err
        told = json.loads(again.out)["fitted"]
        assert told["final"] and not told["interrupted"] and not list(tmp_path.glob("*.unfinished"))
        for key, one in expected.items():
            assert told["numbers"][key]["value"] == pytest.approx(one["value"], rel=1e-5)
        assert count < most if stop < most // 2 else count <= most // 2 + 8


@pytest.mark.slow
def test_numbers_found_are_told_where_their_response_is_interrupted(measured, tmp_path):
    """They were lost."""
    path, out = measured(points=8), tmp_path / "out.nc"
    traced = Interrupting("curves", fraction=FITTED_RESPONSE.fit_share)
    done = called("respond", path, "-o", out, "--json", messages=traced)
    assert done.code == 3 and "before the response with the numbers found was traced" in done.err
    first = json.loads(done.out)["fitted"]
    assert first["final"] and first["interrupted"]
    drawn = called("plot", "response", out, "-o", tmp_path / "out.png")
    assert drawn.code == 2 and "its fit was interrupted, before a response was traced" in drawn.err
    evaluations = Evaluations()
    again, count = evaluations.of(path, "-o", out, "--resume")
    assert again.code == 0 and count < 10  # of one each where the searches have come to
    told = json.loads(again.out)["fitted"]
    assert told["numbers"] == first["numbers"]


def test_what_is_kept_of_other_data_is_not_gone_on_with(measured, tmp_path):
    path, out, evaluations = measured(points=8), tmp_path / "out.nc", Evaluations()
    assert evaluations.of(path, "-o", out, stop=6)[0].code == 3
    (tmp_path / "data.csv").write_text("frequency,amplitude\n1.1,2.0\n1.2,4.0\n1.3,2.0\n")
    done, _ = evaluations.of(path, "-o", out, "--resume", stop=4)
    assert "it is of another scene" in done.err


def test_work_that_no_search_can_have_left_is_passed_over(measured, tmp_path):
    """As of unfinished work that something else has written."""
    good = SearchResult(np.array([0.5, 0.02]), 1.0)
    assert is_search_result(2, [good]) and is_search_result(2, [SearchResult(None, np.inf)])
    wrong = [
        SearchResult(np.array([0.5]), 1.0),
        SearchResult(np.array([0.5, np.nan]), 1.0),
        SearchResult("x", 1.0),
        SearchResult(np.array([0.5, 0.02]), 1.0, "yes"),
    ]
    assert not any(is_search_result(2, [one]) for one in [*wrong, good.x, None]) and not is_search_result(
        2, good
    )


JENKINS = """
[modal]
dofs = ["u"]
frequency = [1.0]
damping = [0.02]
shapes = [[2.0]]

[[contact]]
name = "c"
tangential = "u"
normal = "u"
mu = 0.4
k_u = 0.1
k_v = 0.0
n_0 = 0.6

[[force]]
dof = "u"
amplitude = 0.05

[response]
frequency = [0.8, 1.4]
harmonics = 1

[fit]
vary = ["contact.c.mu", "contact.c.k_u"]

[[fit.data]]
backbone = "backbone.csv"
dof = "u"
"""


@pytest.mark.slow
def test_backbones_are_answered_by_the_nonlinear_mode(tmp_path):
    """Data are of a friction element that slips at 1, by its describing function; the mode's shape is 2."""
    zeta, k, A = 0.02, 0.3, np.geomspace(0.5, 20.0, 12)
    part = np.arccos(np.clip(1.0 - 2.0 / A, -1.0, 1.0))
    stiff = 4.0 * np.where(A > 1.0, k / np.pi * (part - 0.5 * np.sin(2.0 * part)), k)
    loss = 4.0 * np.where(A > 1.0, 4.0 * k * (A - 1.0) / (np.pi * A**2), 0.0)
    omega = np.sqrt(1.0 + stiff)
    table = np.column_stack((A, omega, (2.0 * zeta * omega + loss) / (2.0 * omega**2)))
    np.savetxt(
        tmp_path / "backbone.csv", table, delimiter=",", header="amplitude,frequency,damping", comments=""
    )
    path, out = tmp_path / "scene.toml", tmp_path / "fitted.nc"
    path.write_text(JENKINS)
    done = called("respond", path, "-o", out, "--json")
    assert done.code == 0, done.err
    result = json.loads(done.out)
    found = {key: one["value"] for key, one in result["fitted"]["numbers"].items()}
    assert found == pytest.approx({"contact.c.mu": 0.5, "contact.c.k_u": k}, rel=1e-4)
    assert [one["mode"]["number"] for one in result["curves"]] == [1]
    with xarray.open_dataset(out) as data:
        assert data.data_modal_amplitude[0].values == pytest.approx(A / 2.0, rel=1e-3)
        assert data.modal_amplitude.min() < A[0] / 2.0 and data.modal_amplitude.max() > A[-1] / 2.0
    picture = tmp_path / "fitted.png"
    assert called("plot", "mode", out, "-o", picture).code == 0 and picture.stat().st_size > 0
