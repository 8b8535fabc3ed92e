"""``fcm plot response --band``, and what a run says of random draws."""

import numpy as np
import pytest

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
