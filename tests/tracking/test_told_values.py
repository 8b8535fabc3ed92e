"""Curves of peaks pass through the numbers that are told of an optimum: picture and table agree."""

import tomllib

import numpy as np
import pytest

from fcm.plot.tracked import draw_tracked, read_tracked
from fcm.response import trace
from fcm.response.optimum import optimise
from fcm.results.output import write_netcdf
from fcm.scene.load import scene_from_dict

from ..oscillator import oscillator

BOUNDS = {"inside": (2.0, 20.0), "bound": (1.0, 2.0)}


def scene(bounds=None, n_0=None):
    table = tomllib.loads(oscillator("[response]\nfrequency = [0.8, 1.6]\nharmonics = 1\n", damping=0.05))
    if n_0 is not None:
        table["contact"][0]["n_0"] = n_0
    if bounds is not None:
        table["optimum"] = {"vary": ["contact.shroud.n_0"], "bounds": [list(bounds)], "minimise": "peak.u"}
    return scene_from_dict(table)


@pytest.fixture(scope="module")
def found():
    return {name: optimise(scene(bounds)) for name, bounds in BOUNDS.items()}


def test_the_curve_of_the_peak_passes_through_the_optimum(found):
    tracking = found["inside"].tracking
    (one,), curves = tracking.optima, [c for c in tracking.curves if c.what == "peak of u"]
    (at,) = one.values.values()
    nearest = min(abs(c.number - at).min() for c in curves)
    height = max(np.interp(at, *_rising(c), left=0.0, right=0.0) for c in curves)
    assert nearest <= 1e-12 * at and height == pytest.approx(one.value, rel=1e-9)


def test_the_peak_is_a_share_more_at_the_ends_that_are_told(found):
    """The peaks of straight lines between points were taken."""
    (one,) = found["inside"].tracking.optima
    near = one.nearly
    known = [end for end, known in ((near.low, near.low_known), (near.high, near.high_known)) if known]
    assert known
    for end in known:
        there = trace(scene(n_0=end), "closed-form").curves[0]
        assert there.peaks["u"].amplitude == pytest.approx((1.0 + near.share) * one.value, rel=1e-6)


@pytest.mark.parametrize("name", BOUNDS)
def test_the_picture_says_that_the_optimum_is_at_a_bound(found, name, tmp_path):
    write_netcdf(found[name], tmp_path / "a.nc")
    drawn = read_tracked(tmp_path / "a.nc")
    assert (found[name].tracking.optima[0].kind == "bound") == (name == "bound") == drawn.at_bound
    titles = [axes.get_title(loc="right") for axes in draw_tracked(drawn).axes]
    assert any("a bound" in title for title in titles) == (name == "bound")


def _rising(curve):
    order = np.argsort(curve.number)
    return curve.number[order], curve.amplitude[order, 0]
