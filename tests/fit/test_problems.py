"""What is said of a fit that is not to be relied on."""

from dataclasses import replace

import numpy as np
import pytest

from fcm.model.scene import Measured
from fcm.results.fitted import Fitted, FittedData


def fitted(off, damping=None, off_damping=0.0):
    """A number fitted to points that the model misses by a part of the greatest."""
    ones = np.ones(4)
    damped = None if damping is None else damping * ones
    data = Measured("a.csv", "u", ones, 2.0 * ones, ones, ones, damping=damped)
    residual = np.column_stack((off * ones * (2.0 if damping is None else 1.0), off_damping * ones))
    error = ones[:, None] if damping is None else np.column_stack((ones, ones))
    one = np.ones(1)
    return Fitted(
        keys=("contact.c.mu",), begin=one, values=one, error=0.1 * one, interval=np.array([[0.8, 1.2]]),
        confidence=0.95, poor=0.1, correlation=np.eye(1), without_effect=0.0 * one, undetermined=0.0 * one,
        at_bound=0.0 * one, alike=(), data=[FittedData(data, residual, error, 0)], starts=[], harmonics=(1,),
    )  # fmt: skip


@pytest.mark.parametrize("off", [0.0, 0.09])
def test_data_that_are_met_are_not_named(off):
    assert fitted(off).problems() == []


def test_data_that_the_model_misses_are_named():
    """A fit at a thousand times the frequency said nothing of it."""
    (said,) = fitted(0.25).problems()
    assert said.startswith("a.csv: the model is off from these data by 25 %")


def test_so_is_the_damping_of_a_backbone():
    (said,) = fitted(0.01, damping=0.02, off_damping=0.01).problems()
    assert "is off from these data by 50 %" in said


def test_numbers_that_are_no_end_are_said():
    found = fitted(0.0)
    found.final = False
    assert "best so far" in found.problems()[0]


def test_numbers_that_are_hardly_told_are_said_once_and_their_product():
    """By percents as far as these say something."""
    two = np.array([1.0, 2.0])
    hardly = replace(
        fitted(0.0),
        keys=("contact.c.mu", "contact.c.n_0"),
        begin=two,
        values=two,
        error=np.array([1.5, 3e4]),
        without_effect=0.0 * two,
        undetermined=1.0 + 0.0 * two,
        at_bound=0.0 * two,
        alike=((0, 1, 1.0),),
    )
    assert hardly.problems() == [
        "contact.c.mu and contact.c.n_0 are hardly determined by these data: their standard errors are 150 "
        "% and many times as large",
        "contact.c.mu and contact.c.n_0 cannot be distinguished: these data determine "
        "contact.c.mu * contact.c.n_0 alone",
    ]
    (said,) = replace(hardly, undetermined=np.array([1.0, 0.0]), alike=()).problems()
    assert said == "contact.c.mu is hardly determined by these data: its standard error is 150 %"


def test_many_numbers_that_hang_together_are_said_in_one_sentence():
    four = np.ones(4)
    hardly = replace(
        fitted(0.0),
        keys=("k_1", "n_1", "k_2", "n_2"),
        begin=four,
        values=four,
        error=1e5 * four,
        without_effect=0.0 * four,
        undetermined=four,
        at_bound=0.0 * four,
        alike=((0, 1, -1.0), (0, 2, 0.5), (1, 2, 0.5), (0, 3, 0.5), (1, 3, 0.5), (2, 3, -1.0)),
    )
    assert hardly.problems() == [
        "k_1, n_1, k_2 and n_2 are hardly determined by these data: their standard errors are many times as "
        "large",
        "k_1, n_1, k_2 and n_2 cannot be distinguished: these data determine k_1 / n_1, k_1 * k_2^0.5 and "
        "k_1 * n_2^0.5 alone",
    ]


def misfit_of(residual):
    """Data of a response whose points are off by this, in units of errors of 1 % of the greatest."""
    ones = np.ones(residual.size)
    data = Measured("a.csv", "u", np.arange(1.0, residual.size + 1.0), 2.0 * ones, ones, ones)
    off = np.column_stack((0.0 * residual, residual))
    return FittedData(data, off, 0.02 * ones[:, None], 0)


def test_points_off_by_chance_are_no_systematic_misfit_and_those_of_a_wave_are():
    """Of 1000 sets of independent points a share as rare as three standard deviations is named."""
    rng = np.random.default_rng(4)
    drawn = [misfit_of(rng.standard_normal(40)) for _ in range(1000)]
    assert sum(one.systematic for one in drawn) <= 5
    assert np.mean([one.scatter for one in drawn]) == pytest.approx(0.01, rel=0.03)
    wave = misfit_of(np.sin(np.linspace(0.0, 4.0 * np.pi, 40)) + 0.1 * rng.standard_normal(40))
    assert wave.systematic and wave.scatter < 0.3 * wave.misfit
    one = replace(fitted(0.0), data=[wave])
    (said,) = one.problems()
    assert said.startswith("a.csv: neighbouring points are off to the same side. Of the misfit, 0.7")


def test_a_point_that_stands_alone_is_said_and_one_of_a_resonance_that_is_missed_is_not():
    rng = np.random.default_rng(5)
    chance = [rng.standard_normal(40) for _ in range(1000)]
    assert sum(bool(misfit_of(one).outliers) for one in chance) <= 2
    wild = chance[0].copy()
    wild[[7, 20]] = 30.0, -25.0
    assert misfit_of(wild).outliers == [7, 20] and misfit_of(wild).summary()["outliers"] == [8, 21]
    said = replace(fitted(0.0), data=[misfit_of(wild)]).problems()[0]
    assert said.startswith("a.csv: points 8 and 21 of 40 stand alone, at least 8 times as far")
    missed = 30.0 / (1.0 + (np.arange(40.0) - 20.0) ** 2)
    assert misfit_of(missed).outliers == []
    assert misfit_of(np.zeros(40)).outliers == []


def test_a_search_that_stopped_early_is_said():
    assert any("before a minimum" in one for one in replace(fitted(0.0), settled=False).problems())
    assert not any("before a minimum" in one for one in fitted(0.0).problems())
