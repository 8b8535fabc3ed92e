"""`fcm respond` of a scene with a [fit], as a user meets it."""

import json
import re

import numpy as np
import pytest
import xarray

from fcm.response import trace
from fcm.scene.load import load_scene

from ..oscillator import oscillator
from ..program import called, python

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


def test_the_table_names_numbers_and_data(measured):
    done = called("respond", measured(points=10))
    assert "standard error" in done.out and "contact.shroud.k_u" in done.out and "data.csv u" in done.out
    assert "curve" in done.err


@pytest.mark.slow
def test_a_number_that_the_data_do_not_tell_is_said_with_what_would_tell_it(measured):
    """The contact sticks at this level; it slips at three or ten times the level."""
    path = measured(n_0=1000.0, vary=("contact.shroud.mu", "contact.shroud.k_u"), points=12)
    path.write_text(path.read_text().replace("n_0 = 1000.0", "n_0 = 30.0"))
    done = called("respond", path)
    assert done.code == 0, done.err
    assert "contact.shroud.mu has no effect on these data" in done.err
    advice = r'to tell contact.shroud.mu: a response at "[uv]" with forces at a level of (3|10) would tell it'
    assert re.search(advice, done.err)


@pytest.mark.slow
def test_numbers_of_which_a_product_alone_matters_are_not_told_apart(measured):
    path = measured(vary=("contact.shroud.mu", "contact.shroud.n_0"), points=12, k_v=0.0)
    done = called("respond", path, "--json")
    assert done.code == 0, done.err
    ((one, other, power),) = json.loads(done.out)["fitted"]["not_told_apart"]
    assert {one, other} == {"contact.shroud.mu", "contact.shroud.n_0"} and power == pytest.approx(
        1.0, rel=1e-6
    )


@pytest.mark.parametrize(
    "option", [("--method", "exact"), ("--mode", "1", "--level", "1:2"), ("--resume", "-o", "x.nc")]
)
def test_what_means_nothing_with_a_fit_is_refused(measured, option):
    done = called("respond", measured(points=5), *option)
    assert done.code == 2 and "is of no use with [fit]" in done.err


@pytest.mark.slow
def test_an_interrupted_fit_tells_the_best_so_far(measured, tmp_path):
    """By a limit of time: what is told then says that it is not the end."""
    path = measured(points=12)
    code = (
        "import fcm.fit.solve as s, fcm.cli.__main__ as m\n"
        "least = s.Problem.least\n"
        "def once(self, x, evaluations, told=[]):\n"
        "    told.append(1)\n"
        "    if len(told) > 1: raise KeyboardInterrupt\n"
        "    return least(self, x, evaluations)\n"
        "s.Problem.least = once\n"
        "m.run()\n"
    )
    done = python("-c", code, "respond", str(path), "--json")
    assert done.code in (3, 130), done.err
    found = json.loads(done.out)["fitted"]
    assert found["interrupted"] and found["numbers"]["contact.shroud.k_u"]["value"] == pytest.approx(
        1.0, rel=0.1
    )
