"""fcm respond --compare and fcm plot accuracy, on a curve that takes seconds."""

import json
from dataclasses import replace
from pathlib import Path

import netCDF4
import numpy as np
import pytest
import xarray

from fcm.compare import MEASURES
from fcm.compare.options import CompareOptions, ExactLineOptions, StartupOptions
from fcm.scene import load_scene
from fcm.shooting import periodic

from ..interrupted import Interrupting
from ..report.evidence import evidence as page

RANGE = "[0.8, 1.6]"
# fewer runs than one waits for, and fewer still, of which no program's start is timed
SHORT = CompareOptions(steps=(2.0, 1.0), exact_steps=(1.0,), finest_step=0.25)
QUICK = CompareOptions(startup=StartupOptions(repeats=0), steps=(1.0,), exact_steps=(1.0,), finest_step=0.25)


@pytest.fixture
def short(scene):
    """A part of the scene."""
    scene.write_text(scene.read_text().replace(RANGE, "[1.36, 1.46]\nmax_step = 0.5"))
    return scene


@pytest.mark.slow
def test_every_method_with_its_errors_and_costs(fcm, short):
    run = fcm("respond", short, "--compare", "--json", "-o", "c.nc", compare=SHORT)
    assert run.code == 0, run.err
    result = json.loads(run.out)
    assert result["complete"] and not result["without_exact"] and not result["notes"]
    runs = result["runs"]
    with_and_without = {(one["method"], one["left_out"]) for one in runs}
    methods = ("default table", "fast table", "closed form", "exact")
    assert with_and_without >= {(method, left_out) for method in methods for left_out in (True, False)}
    for one in runs:
        assert one["complete"] and one["points"] > 5
        assert 0.0 < one["seconds"] and 0.0 <= one["table_seconds"] < one["start_seconds"]
        for against in one["against"].values():
            for measure in set(MEASURES) - {"fold"}:  # there are none
                assert (against["errors"][measure] is None) == (measure in against["below"])
        assert one["evaluations"] > 10 and one["processor_seconds"] > 0.0
    _the_error_of_the_harmonic_is_true(short, result)
    _the_parts_of_the_error(result)
    _the_file_holds_the_same(result)
    assert fcm("plot", "accuracy", "c.nc", "--of", "peak-frequency", "-o", "c.svg").code == 0
    _the_page_shows_it(run.out, result)


def _the_page_shows_it(text, result):
    """With what is missing in it said."""
    Path("c.json").write_text(text)
    Path("study.txt").write_text("ratio < 5")
    page.main([".", "--scene", "c", "--results", "."], standalone_mode=False)
    html = Path("index.html").read_text()
    parts = result["contributions"]
    assert f"<td>{parts['single harmonic']['errors']['peak']:.1e}</td>" in html
    assert (
        "ratio &lt; 5" in html and "make extremes makes it" in html and "What failed or was left out" in html
    )


def _the_error_of_the_harmonic_is_true(path, result):
    """The exact peak by solutions at single frequencies, on a grid around it."""
    peak = next(one for one in result["peaks"] if one["dof"] == "u")
    scene, at = load_scene(path), peak["exact"]["frequency"]
    around = [periodic(scene, at * (1.0 + d)).measure.amplitude[0] for d in (-1e-3, 0.0, 1e-3)]
    assert peak["exact"]["amplitude"] == pytest.approx(max(around), rel=1e-8)
    assert np.argmax(around) == 1
    true = peak["harmonic"]["amplitude"] / max(around) - 1.0
    assert peak["error"] == pytest.approx(true, abs=1e-8)
    assert 0.5 < peak["truncation_error"] / abs(true) < 2.0  # what the README says of estimates


def _the_parts_of_the_error(result):
    """The table errs before the correction and not after; the harmonic by more than both."""
    parts = result["contributions"]
    before, after = parts["fast table, as it is"], parts["fast table, corrected"]
    harmonic = parts["single harmonic"]["errors"]["peak"]
    assert 1e-8 < before["errors"]["peak"] < harmonic
    assert after["errors"]["peak"] is None and after["below"]["peak"] <= 1e-8
    assert parts["step and tolerance"]["below"]["peak"] <= 1e-8


def _the_file_holds_the_same(result):
    with netCDF4.Dataset("c.nc") as file:
        assert json.loads(file.summary) == result
        assert file["error"].dimensions == ("reference", "measure", "run", "curve")
        assert list(file["method"][:]) == [one["method"] for one in result["runs"]]
        i, j = list(file["reference"][:]).index("exact"), list(file["measure"][:]).index("peak")
        errors = np.ma.filled(file["error"][i, j, :, 0], np.nan)
        own = file["own_error"][i, j, 0]
        for error, one in zip(errors, result["runs"], strict=True):
            stated = one["against"]["exact"]["errors"]["peak"]
            assert error < 10.0 * own if stated is None else error == pytest.approx(stated)


@pytest.mark.slow
def test_swept_values_are_coordinates_whatever_the_contact_is_called(fcm, short):
    named = short.read_text().replace("shroud", "left shroud")
    short.write_text(f'{named}[sweep]\n"contact.left shroud.n_0" = [20.0]\n')
    assert fcm("respond", short, "--compare", "-o", "c.nc", compare=QUICK).code == 0
    with xarray.open_dataset("c.nc") as data:
        swept = data["contact.left_shroud.n_0"]
        assert swept.attrs["key"] == "contact.left shroud.n_0" and swept.name in data["error"].coords


@pytest.mark.slow
def test_an_interruption_keeps_what_is_finished(fcm, short):
    third = Interrupting("max_step x", 3, compare=QUICK)
    run = fcm("respond", short, "--compare", "--json", "-o", "c.nc", messages=third)
    assert run.code == 3 and "interrupted" in run.err and "Traceback" not in run.err
    result = json.loads(run.out)
    assert not result["complete"] and len(result["runs"]) == 4  # two of the references, two methods
    assert fcm("plot", "accuracy", "c.nc").code == 0


@pytest.mark.slow
def test_without_an_exact_curve_in_time_the_closed_form_remains(fcm, short):
    run = fcm("respond", short, "--compare", compare=replace(QUICK, exact=ExactLineOptions(limit=0.0)))
    why = "the curve: not finished in 0 s of processor time"
    assert run.code == 0 and f"no exact reference, compared with the closed form alone: {why}" in run.err
    assert "errors against harmonic balance, closed form" in run.out


@pytest.mark.slow
def test_without_a_whole_curve_there_is_nothing_to_compare(fcm, scene):
    """An undamped resonance of the open contact."""
    scene.write_text(
        scene.read_text().replace("damping = 0.05", "damping = 0").replace("n_0 = 5.0", "n_0 = -1e20")
    )
    run = fcm("respond", scene, "--compare", "-o", "c.nc")
    assert run.code == 3 and "no curve is complete, so there is nothing to compare" in run.err


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--method", "closed-form"], "--method is of no use with --compare"),
        (["--csv", "c.csv"], "--csv is of no use with --compare"),
        (["--jobs", "2"], "--jobs is of no use with --compare"),
        (["--keep-all"], "--keep-all is of no use with --compare"),
        (["--resume", "-o", "c.nc"], "--resume is of no use with --compare"),
        (["--harmonics", "3"], "--harmonics is of no use with --compare"),
        (["--accuracy", "1e-3"], "--accuracy is of no use with --compare"),
        (["--track", "folds"], "--track is of no use with --compare"),
        (["--to", "1"], "--to is of no use with --compare"),
        (["--mode", "1"], "--mode is of no use with --compare"),
        (["--level", "0:2"], "--level is of no use with --compare"),
        (["--sensitivity"], "--sensitivity is of no use with --compare"),
    ],
)
def test_options_without_meaning_are_refused(fcm, scene, options, said):
    run = fcm("respond", scene, "--compare", *options)
    assert run.code == 2 and said in run.err


def test_a_scene_without_curves_is_refused(fcm, scene):
    phase = "[[schedule]]\nfrequency = 1.2\ncycles = 3"
    scene.write_text(scene.read_text().replace(f"[response]\nfrequency = {RANGE}", phase))
    run = fcm("respond", scene, "--compare")
    assert run.code == 2 and "--compare needs curves" in run.err


def test_a_file_that_is_no_comparison_is_not_drawn(fcm, scene, tmp_path):
    fcm("respond", scene, "-o", "curves.nc")
    run = fcm("plot", "accuracy", "curves.nc")
    assert run.code == 2 and "not a comparison" in run.err
    (tmp_path / "text.nc").write_text("no")
    assert fcm("plot", "accuracy", "text.nc").code == 2
