"""``fcm plot response --band``, and what a run says of random draws."""

import copy
import json
from dataclasses import replace

import netCDF4
import numpy as np
import pytest

from fcm.cli.curves import as_table
from fcm.plot.band import draw_bands
from fcm.plot.read import read_response
from fcm.results.bands import bands_of

DRAWS = '[sweep]\n"contact.shroud.n_0" = { distribution = "norm", loc = 5, scale = 0.2, count = 4 }\n'


@pytest.fixture
def result(fcm, scene, tmp_path):
    scene.write_text(scene.read_text() + "harmonics = 1\n" + DRAWS)
    done = fcm("respond", scene, "-o", tmp_path / "draws.nc")
    assert done.code == 0 and "percentiles of 4 curves" in done.out and "50 %" in done.out
    assert "a peak and a frequency of one column are not of one draw" in done.out
    return tmp_path / "draws.nc"


@pytest.mark.slow
def test_bands_are_drawn(fcm, result, tmp_path):
    done = fcm("plot", "response", "--band", 5, 95, result, "--dof", "v", "--log")
    assert (done.code, done.err) == (0, f"wrote {tmp_path / 'draws.png'}\n")


@pytest.mark.parametrize(
    ("args", "said"),
    [
        ((95, 5), "the percentages must rise"),
        ((-5, 5), "is not in the range 0.0<=x<=100.0"),
        ((5, 95, "--dof", "x"), 'no degree of freedom "x"'),
    ],
)
def test_what_is_wrong_is_said(fcm, result, args, said):
    done = fcm("plot", "response", result, "--band", *args)
    assert done.code == 2 and said in done.err


def test_without_draws_there_is_no_band(fcm, scene):
    assert fcm("respond", scene, "--harmonics", 1, "-o", "plain.nc").code == 0
    done = fcm("plot", "response", "plain.nc", "--band", 5, 95)
    assert done.code == 2 and "nothing was drawn at random" in done.err


@pytest.mark.parametrize(
    ("span", "said"),
    [
        ((5.0, 95.0), "median, and least to greatest of 4 draws: too few for 5 and 95 %, which take 20"),
        ((25.0, 95.0), "median, and 25 % to greatest of 4 draws: too few for 95 %, which take 20"),
        ((25.0, 75.0), "median, and 25 to 75 % of 4 draws: too few to bound these, 11 are needed"),
        ((50.0, 50.0), "median, and 50 to 50 % of 4 draws: too few to bound these, 5 are needed"),
        ((0.0, 100.0), "median, and 0 to 100 % of 4 draws"),
    ],
)
def test_a_band_says_of_how_many_draws_it_is(result, span, said):
    drawn = read_response(result)
    bands = bands_of(drawn.curves, drawn.drawn, 0, span)
    figure = draw_bands(drawn, 0, bands, span, None)
    assert figure.axes[0].get_title(loc="right") == said


def test_a_band_of_few_draws_is_their_range(result):
    """Of four draws 5 and 95 % would be no more than a little less."""
    drawn = read_response(result)
    few, whole = (bands_of(drawn.curves, drawn.drawn, 0, span) for span in ((5.0, 95.0), (0.0, 100.0)))
    for one, other in zip(few, whole, strict=True):
        assert np.array_equal(one.low, other.low, equal_nan=True)
        assert np.array_equal(one.high, other.high, equal_nan=True)


def test_draws_whose_peaks_err_much_are_said_in_the_picture(result):
    drawn = read_response(result)
    bands = bands_of(drawn.curves, drawn.drawn, 0, (25.0, 75.0))
    at_top = [np.zeros(len(curve.frequency)) for curve in drawn.curves]
    for k in (1, 3):
        at_top[k][np.nanargmax(drawn.curves[k].amplitude[:, 0])] = 0.9
    err = [replace(c, truncation_error=one) for c, one in zip(drawn.curves, at_top, strict=True)]
    titles = [
        draw_bands(replace(drawn, curves=tuple(curves)), 0, bands, (25.0, 75.0), None)
        .axes[0]
        .get_title("right")
        for curves in (
            err,
            [replace(one, truncation_error=0.0 * e) for one, e in zip(err, at_top, strict=True)],
        )
    ]
    assert ["peaks of 2 of 4 draws may err by more than 20 %" in one for one in titles] == [True, False]


def test_percentiles_of_peaks_that_err_much_are_not_relied_on(result):
    with netCDF4.Dataset(result) as data:
        summary = json.loads(data.summary)
    said = "percentiles are not to be relied on: peaks err by up to 35 %"
    for error, kept in ((0.35, True), (0.05, False), (None, False)):
        other = copy.deepcopy(summary)
        for peak in other["scatter"][0]["peak"].values():
            peak["greatest_error"] = error
        assert (said in as_table(other, "rad/s")) == kept
