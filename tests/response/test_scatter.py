"""Percentiles over random draws: of peaks, of their frequencies, and of jumps; bands of the response."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import xarray

import fcm
from fcm.plot.band import draw_bands
from fcm.plot.read import DrawnCurve, read_response
from fcm.response.sweep import trace
from fcm.results.bands import bands_of, greatest_at
from fcm.results.output import write_netcdf
from fcm.results.scatter import scatter, summary_of
from fcm.results.spread import spreads_of
from fcm.results.summary import summary, without_nan
from fcm.scene import scene_from_dict

COUNT = 12
N_0 = {"normal": [5.0, 0.4], "count": COUNT, "seed": 2}


@pytest.fixture(scope="module")
def scene():
    return scene_from_dict(
        {
            "modal": {
                "dofs": ["u", "v"], "frequency": [1.0, 10.0], "damping": 0.01,
                "shapes": [[0.707, 0.707], [1.0, -0.5]],
            },
            "contact": [
                {"name": "c", "tangential": "u", "normal": "v", "mu": 0.4, "k_u": 1.0, "k_v": 1.0, "n_0": 5.0}
            ],
            "force": [{"dof": "u", "amplitude": 1.0}, {"dof": "v", "amplitude": 1.0}],
            "response": {"frequency": [0.9, 1.6], "harmonics": 1},
            "sweep": {
                "contact.c.mu": [0.4, 0.3],
                "contact.c.n_0": N_0,
                "contact.c.k_u": {"distribution": "lognorm", "s": 0.05, "count": COUNT},
            },
        }
    )  # fmt: skip


@pytest.fixture(scope="module")
def response(scene):
    found = trace(scene, "closed-form")
    found.drawn = scene.drawn
    return found


@pytest.fixture(scope="module")
def path(response, tmp_path_factory):
    path = tmp_path_factory.mktemp("scatter") / "a.nc"
    write_netcdf(response, path)
    return path


def test_draws_of_which_no_curve_is_complete_have_a_file_without_percentiles(response, tmp_path):
    lost = replace(response, curves=[replace(one, complete=False) for one in response.curves])
    write_netcdf(lost, tmp_path / "lost.nc")
    with xarray.open_dataset(tmp_path / "lost.nc") as file:
        assert file.peak_percentile.sizes["dof"] == 2 and file.peak_percentile.isnull().all()


@pytest.mark.slow
def test_percentiles_are_over_the_draws_of_each_given_value(scene, response):
    assert scene.drawn == ("contact.c.n_0", "contact.c.k_u")
    found = summary(response)["scatter"]
    assert [one["parameters"] for one in found] == [{"contact.c.mu": 0.4}, {"contact.c.mu": 0.3}]
    for one in found:
        curves = [
            c for c in response.curves if c.parameters["contact.c.mu"] == one["parameters"]["contact.c.mu"]
        ]
        peaks = [c.peaks["u"][:2] for c in curves]
        median = np.median(peaks, axis=0)
        assert one["curves"] == COUNT
        assert one["peak"]["u"]["amplitude"]["50"] == pytest.approx(median[0])
        assert one["peak"]["u"]["frequency"]["50"] == pytest.approx(median[1])
        up = [
            c.folds[0] for c in curves if c.folds
        ]  # of these curves the first fold is that of an upward sweep
        assert one["jumps"]["up"]["share"] == len(up) / COUNT
        assert one["jumps"]["up"]["frequency"]["75"] == pytest.approx(np.percentile(up, 75.0))


def test_the_dataset_holds_them(response):
    from fcm.results.output import to_dataset

    data = to_dataset(response)
    assert data.peak_percentile.dims == ("scatter", "percent", "dof")
    one = summary(response)["scatter"][1]
    assert data.peak_percentile.sel(percent=25.0, dof="u").values[1] == one["peak"]["u"]["amplitude"]["25"]
    assert data.jump_percentile.values[1, 1, 0] == one["jumps"]["up"]["frequency"]["25"]
    assert np.isnan(data.peak_percentile.sel(percent=5.0, dof="u").values[1])  # of 12 draws


def curve_with(stable, tail=()):
    """Along 1 to 4 rad/s at amplitude 1, and tail: (frequency, amplitude, stable) of more points."""
    more = np.array(tail, dtype=float).reshape(-1, 3)
    frequency = np.concatenate((np.linspace(1.0, 4.0, len(stable)), more[:, 0]))
    amplitude = np.concatenate((np.ones(len(stable)), more[:, 1]))[:, None]
    kept = trace(fcm.load_scene("yang1998-n5"), "closed-form").curves[0]
    peaks = {"u": kept.peaks["u"]}
    told = np.concatenate((np.array(stable, dtype=float), more[:, 2]))
    states, error = kept.regime[: frequency.size], kept.truncation_error[: frequency.size]  # of no matter
    return replace(
        kept,
        frequency=frequency,
        amplitude=amplitude,
        stable=told,
        regime=states,
        truncation_error=error,
        peaks=peaks,
        extract=None,
    )


def test_a_first_jump_that_is_not_known_is_none_of_the_percentiles(scatter_of):
    """Of seven points 0.5 apart, by hand: upwards one jumps at 2.5, one at 3, of one it is not known, as
    it may do so from 1.5 on, of one not whether it does; one is stable, and one begins where nothing is."""
    nan = np.nan
    given = [
        [1, 1, 1, 1, 0, 0, 1],
        [1, 1, 1, 1, 1, 0, 1],
        [1, 1, nan, 1, 0, 0, 1],
        [1, 1, nan, nan, 1, 1, 1],
        [1, 1, 1, 1, 1, 1, 1],
        [0, 1, 1, 1, 1, 1, 1],
    ]
    up = scatter_of([curve_with(stable) for stable in given])["jumps"]["up"]
    assert (up["share"], up["untold"]) == (pytest.approx(2 / 6), pytest.approx(2 / 6))
    assert up["frequency"]["50"] == pytest.approx(2.75)
    assert up["frequency_range"] == pytest.approx([2.5, 3.0]) and np.isnan(up["frequency"]["25"])


def test_a_jump_before_stability_is_unknown_is_no_jump_before(scatter_of):
    """Downwards from 4 the motion is lost at 3, and is not told to be stable from 2 down."""
    (one, other) = ([1, nan_, nan_, 0, 1, 1, 1] for nan_ in (np.nan, 1.0))
    down = scatter_of([curve_with(one), curve_with(other)])["jumps"]["down"]
    assert (down["share"], down["untold"], down["frequency"]["50"]) == (1.0, 0.0, 3.0)


def test_a_jump_that_may_be_a_little_earlier_is_known(scatter_of):
    """Lost at 2.5 in any case, and not told to be stable from 2.49, 0.4 %, or 2.45, 2 %, on."""
    for unknown, expected in ((2.49, (1.0, 0.0)), (2.45, (0.0, 1.0))):
        curve = curve_with([1, 1, 1, 1, 0, 0, 1])
        place = [1.0, 1.5, unknown, 0.5 * (unknown + 2.5), 2.5, 3.0, 4.0]
        told = np.array([1, 1, 1, np.nan, 1, 0, 1])
        up = scatter_of([replace(curve, frequency=np.array(place), stable=told)])["jumps"]["up"]
        assert (up["share"], up["untold"]) == expected


@pytest.fixture
def scatter_of(response):
    """Of curves that differ in drawn numbers alone."""

    def made(curves):
        numbers = [{"contact.c.n_0": float(i)} for i, _ in enumerate(curves)]
        own = [replace(curve, parameters=one) for curve, one in zip(curves, numbers, strict=True)]
        (found,) = scatter(replace(response, curves=own, dofs=("u",)))
        return summary_of(found, ("u",), "rad/s")

    return made


def test_peaks_that_no_motion_stays_at_are_said_to_be_unstable(scatter_of, response):
    """By hand: of four draws one peak is not stable, and of one that is not told."""
    curves = [curve_with([1] * 7) for _ in range(4)]
    for curve, stable in zip(curves, (1.0, 0.0, np.nan, 1.0), strict=True):
        curve.peaks["u"] = curve.peaks["u"]._replace(stable=stable)
    one = scatter_of(curves)
    assert (one["peak"]["u"]["unstable"], one["peak"]["u"]["untold"]) == (0.25, 0.25)
    from fcm.cli.curves import as_table
    from fcm.results.curve_fields import scatter_fields

    printed = summary(response) | {"scatter": [one | {"peak": dict.fromkeys("uv", one["peak"]["u"])}]}
    (line,) = [row for row in as_table(printed, "rad/s").splitlines() if row.split()[:2] == ["peak", "u"]][
        -1:
    ]
    assert line.endswith("25 % unstable, 25 % of unknown stability")
    numbers = [{"contact.c.n_0": float(i)} for i, _ in enumerate(curves)]
    own = [replace(curve, parameters=by) for curve, by in zip(curves, numbers, strict=True)]
    fields = scatter_fields(scatter(replace(response, curves=own, dofs=("u",))), "rad/s")
    assert fields["peak_unstable_share"].values.tolist() == [[0.25]]
    assert fields["peak_untold_share"].values.tolist() == [[0.25]]


def test_percentiles_without_bounds_as_errors_are_unknown(scatter_of, response):
    from fcm.cli.curves import as_table

    curves = [curve_with([1] * 7) for _ in range(11)]
    for height, curve in enumerate(curves, 1):
        curve.peaks["u"] = curve.peaks["u"]._replace(
            amplitude=float(height), error=0.125 if height < 3 else np.nan
        )
    one = scatter_of(curves)
    printed = without_nan(
        summary(response) | {"scatter": [one | {"peak": dict.fromkeys("uv", one["peak"]["u"])}]}
    )
    said = "the bounds of 25, 50 and 75 % are unknown where there is a -: without the draws whose errors"
    assert f"{said} are unknown, too few are left" in as_table(printed, "rad/s")


def test_percentiles_of_peaks_have_bounds_by_errors_and_by_the_number_of_draws(scatter_of, response):
    """By hand: of peaks 1 to 11, an eighth in error, the quarter is between the first and the sixth."""
    from fcm.cli.curves import as_table
    from fcm.results.curve_fields import scatter_fields

    curves = [curve_with([1] * 7) for _ in range(11)]
    for height, curve in enumerate(curves, 1):
        curve.peaks["u"] = curve.peaks["u"]._replace(amplitude=float(height), error=0.125)
    one = scatter_of(curves)
    peak = one["peak"]["u"]
    assert peak["interval"]["25"] == pytest.approx([0.875, 6.75])
    assert np.isnan(peak["interval"]["5"][0]) and peak["interval"]["5"][1] == pytest.approx(3.375)
    assert (peak["greatest_error"], peak["error_unknown"]) == (0.125, 0)
    assert one["confidence"] == 0.9 and one["curves_needed"]["95"] == 59
    printed = without_nan(summary(response) | {"scatter": [one | {"peak": dict.fromkeys("uv", peak)}]})
    *_, table = as_table(printed, "rad/s").partition("percentiles of 11 curves")
    rows = [line.split() for line in table.splitlines()]
    assert ["peak", "u", "1.00000", "-", "3.50000", "6.00000", "8.50000", "-", "11.0000"] in rows
    assert "\n- of peak u and peak v: a percentile of too few curves. It takes 20 for 5 and 95" in table
    assert ["from", "-", "0.875", "2.62", "5.25", "7.87"] in rows
    assert ["to", "3.38", "6.75", "10.2", "12.4", "-"] in rows
    assert "with 90 % confidence. They count the errors of peaks, 1.2e-01 at most\n" in table
    assert "11 draws are too few for both bounds of 5 and 95 %: 59 are needed" in table
    numbers = [{"contact.c.n_0": float(i)} for i, _ in enumerate(curves)]
    own = [replace(curve, parameters=by) for curve, by in zip(curves, numbers, strict=True)]
    fields = scatter_fields(scatter(replace(response, curves=own, dofs=("u",))), "rad/s")
    assert fields["peak_percentile_low"].values[0, 1] == pytest.approx([0.875])
    assert fields["peak_percentile_high"].values[0, 1] == pytest.approx([6.75])


def test_draws_of_unknown_errors_are_counted_and_of_few_it_is_said(scatter_of, response):
    from fcm.cli.curves import as_table

    curves = [curve_with([1] * 7) for _ in range(8)]
    for curve, error in zip(curves, (np.nan, *[0.01] * 7), strict=True):
        curve.peaks["u"] = curve.peaks["u"]._replace(error=error)
    for count, said in (
        (8, "errors of peaks, 1.0e-02 at most, unknown of 1 of 8\n8 draws are"),
        (1, "1 draw is"),
    ):
        one = scatter_of(curves[:count])
        printed = without_nan(
            summary(response) | {"scatter": [one | {"peak": dict.fromkeys("uv", one["peak"]["u"])}]}
        )
        text = as_table(printed, "rad/s")
        assert said in text and ("from, to" in text) == (count == 8)


def test_draws_without_a_complete_curve_are_counted_by_the_bounds(response):
    """By hand: of peaks 1 to 11 and two unknown ones, the half is between the second and the tenth."""
    from fcm.cli.curves import as_table

    curves = [curve_with([1] * 7) for _ in range(13)]
    for height, curve in enumerate(curves, 1):
        curve.peaks["u"] = curve.peaks["u"]._replace(amplitude=float(height), error=0.0)
        curve.complete = height < 12
    own = [replace(one, parameters={"contact.c.n_0": float(i)}) for i, one in enumerate(curves)]
    (found,) = scatter(replace(response, curves=own, dofs=("u",)))
    one = summary_of(found, ("u",), "rad/s")
    assert (one["curves"], one["left_out"]) == (11, 2)
    assert one["peak"]["u"]["interval"]["50"] == [2.0, 10.0]
    printed = without_nan(
        summary(response) | {"scatter": [one | {"peak": dict.fromkeys("uv", one["peak"]["u"])}]}
    )
    assert "2 of 13 draws have no complete curve. The percentiles are without them" in as_table(
        printed, "rad/s"
    )


def test_what_is_not_known_is_printed_and_written(scatter_of, response):
    from fcm.cli.curves import as_table
    from fcm.results.curve_fields import scatter_fields

    told = [[1, 1, np.nan, 1, np.nan, 1, 1], [1, 1, 1, 1, 1, 1, 1]]
    curves = [curve_with(stable) for stable in told]
    one = scatter_of(curves)
    printed = summary(response) | {"scatter": [one | {"peak": dict.fromkeys("uv", one["peak"]["u"])}]}
    text = as_table(printed, "rad/s")
    assert "of 0 % of the curves, unknown of 50 %" in text
    assert text.endswith("unknown: stability is not known, and a sweep may jump")
    own = [replace(c, parameters={"contact.c.n_0": float(i)}) for i, c in enumerate(curves)]
    fields = scatter_fields(scatter(replace(response, curves=own, dofs=("u",))), "rad/s")
    assert fields["jump_untold_share"].values.tolist() == [[0.5, 0.5]]


def test_nothing_is_said_where_nothing_is_drawn():
    scene = fcm.load_scene("yang1998-n5")
    assert scene.drawn == () and "peak_percentile" not in fcm.respond(scene, harmonics=1)


def test_a_band_holds_its_share_of_the_curves(path, response):
    drawn = read_response(path)
    bands = bands_of(drawn.curves, drawn.drawn, 0, (10.0, 90.0))
    assert [band.parameters for band in bands] == [{"contact.c.mu": 0.4}, {"contact.c.mu": 0.3}]
    band = bands[0]
    assert (band.low <= band.median).all() and (band.median <= band.high).all()
    values = np.array([greatest_at(c, 0, band.frequency) for c in drawn.curves[:COUNT]])
    inside = ((values >= band.low) & (values <= band.high)).mean(axis=0)
    least = COUNT - 2 * np.ceil(0.1 * (COUNT - 1))  # percentiles lie between draws
    assert inside.min() * COUNT == pytest.approx(least) and np.isfinite(values).all()


def test_a_band_knows_its_draws_and_the_percentages_of_its_ends(path):
    """Curves without a point were among the draws that the picture told of."""
    drawn = read_response(path)
    first = drawn.curves[:COUNT]
    (band,) = bands_of(first[1:], drawn.drawn, 0, (0.0, 95.0))
    assert (band.draws, band.reached) == (COUNT - 1, (0.0, 100.0 if COUNT - 1 < 20 else 95.0))
    title = draw_bands(drawn, 0, [band], (0.0, 95.0), None).axes[0].get_title(loc="right")
    assert f" {COUNT - 1} draws" in title


def test_spreads_are_over_the_draws_of_each_given_value():
    rng = np.random.default_rng(3)
    mu, n_0 = np.repeat([0.4, 0.3], 30), rng.normal(10.0, 1.0, 60)
    peak, frequency = 2.0 * n_0 + mu, 1.0 + n_0 / 100.0
    counted = np.ones(60, dtype=bool)
    counted[::7] = False
    found = spreads_of({"mu": mu, "n_0": n_0}, ("n_0",), [peak, frequency], counted)
    assert [one.parameters for one in found] == [{"mu": 0.4}, {"mu": 0.3}]
    for one in found:
        own = counted & (mu == one.parameters["mu"])
        for spread, values in zip(one.spreads, (peak, frequency), strict=True):
            assert spread.count == own.sum() and spread.percents
            assert spread.median == pytest.approx(np.median(values[own]))
            assert (values[own] < spread.low).sum() == (values[own] > spread.high).sum() == 2
    (whole,) = spreads_of({"n_0": n_0}, ("n_0",), [peak], counted)
    assert whole.parameters == {} and whole.spreads[0].count == counted.sum()


def test_the_greatest_stable_amplitude_of_a_curve_that_folds():
    x = np.array([1.0, 2.0, 3.0, 2.5, 2.0, 3.0, 4.0])
    y = np.array([1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0])
    stable = np.array([1, 1, 1, 0, 1, 1, 1], bool)
    places = np.array([1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5])
    found = greatest_at(DrawnCurve({}, x, y[:, None], stable), 0, places)
    assert found == pytest.approx([1.0, 1.5, 5.0, 5.5, 6.0, 6.5, 7.0, np.nan], nan_ok=True)
