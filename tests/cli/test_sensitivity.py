"""``fcm respond --sensitivity`` and ``fcm plot sensitivity``."""

import json

import netCDF4
import numpy as np
import pytest

from fcm.cli.messages import Messages
from fcm.cli.sensitivity import added
from fcm.plot.sensitivity import draw_sensitivity, read_sensitivity
from fcm.response import trace
from fcm.results.cause import Cause
from fcm.scene import load_scene

from ..interrupted import Interrupting


@pytest.fixture
def result(fcm, scene, tmp_path):
    path = tmp_path / "result.nc"
    assert fcm("respond", scene, "--sensitivity", "--harmonics", 1, "-o", path).code == 0
    return path


def test_the_file_and_json_hold_the_derivative_of_each_peak_by_each_number(fcm, scene, result):
    done = fcm("respond", scene, "--sensitivity", "--harmonics", 1, "--json")
    of_u = json.loads(done.out)["curves"][0]["sensitivity"]["u"]
    with netCDF4.Dataset(result) as data:
        names = data["number"][:].tolist()
        assert data["sensitivity"].dimensions == ("curve", "dof", "number")
        assert [of_u["numbers"][name]["amplitude"] for name in names] == data["sensitivity"][0, 0].tolist()
        assert data["peak_kind"][0].tolist() == ["smooth", "smooth"]
    assert {"contact.shroud.mu", "contact.shroud.n_0", "force.u.amplitude", "modal.damping.1"} <= set(names)
    # all forces and preloads together: the response is in proportion to them
    parts = [of_u["numbers"][name] for name in ("contact.shroud.n_0", "force.u.amplitude")]
    assert sum(part["relative"] for part in parts) == pytest.approx(1.0, rel=1e-9)
    assert sum(part["value"] * part["frequency"] for part in parts) == pytest.approx(0.0, abs=1e-8)


def test_the_picture(fcm, result, tmp_path):
    done = fcm("plot", "sensitivity", result, "--dof", "v")
    assert (done.code, done.err) == (0, f"wrote {tmp_path / 'result-sensitivity.png'}\n")


def test_modes_are_counted_as_in_the_table_of_modes(fcm, scene, result):
    """Paths count from 0: the picture says which mode it is, and the table has its numbers."""
    drawn = read_sensitivity(result)
    figure = draw_sensitivity(drawn)
    names = [one.get_text() for one in figure.axes[0].get_yticklabels()]
    ofmode = {name for name in names if "mode" in name.split("(")[-1]}
    assert ofmode == {name for name in names if name.startswith("modal.")} != set()
    with netCDF4.Dataset(result) as data:
        values = dict(zip(data["number"][:].tolist(), data["number_value"][0].tolist(), strict=True))
    listed = json.loads(fcm("plot", "modes", scene, "--json").out)["modes"]
    for name in ofmode:
        key, _, mode = name.removesuffix(")").partition(" (mode ")
        kind = key.split(".")[1]
        assert values[key] == pytest.approx(listed[int(mode) - 1][kind])


@pytest.mark.parametrize(
    ("args", "said"),
    [(["--dof", "x"], 'no degree of freedom "x"'), (["--curve", 3], "the file has 1 curve, number 0")],
)
def test_what_is_not_there_to_draw_is_said(fcm, result, args, said):
    done = fcm("plot", "sensitivity", result, *args)
    assert done.code == 2 and said in done.err


def test_a_file_without_them(fcm, scene):
    assert fcm("respond", scene, "--harmonics", 1, "-o", "plain.nc").code == 0
    done = fcm("plot", "sensitivity", "plain.nc")
    assert done.code == 2 and "fcm respond --sensitivity" in done.err


@pytest.mark.parametrize(
    "args",
    [
        ["--method", "exact"],
        ["--level", "0:1", "--at", 1.0],
        ["--mode", 1, "--level", "1:2"],
        ["--peaks-only"],  # it was taken, and nothing came of it
    ],
)
def test_only_of_peaks_of_a_balance(fcm, scene, args):
    done = fcm("respond", scene, "--sensitivity", *args)
    assert done.code == 2 and "--sensitivity is of no use with" in done.err


@pytest.mark.parametrize(("args", "shown"), [((), False), (("--json",), True), (("-o", "a.nc"), True)])
def test_where_nothing_shows_sensitivities_it_is_said(fcm, scene, args, shown):
    done = fcm("respond", scene, "--sensitivity", "--harmonics", 1, *args)
    assert done.code == 0 and ("the sensitivities are in no table" not in done.err) == shown


def test_a_hidden_degree_of_freedom_has_none(fcm, scene):
    scene.write_text(scene.read_text() + "output = []\n")
    scene.write_text(scene.read_text().replace('normal = "v"', "normal = { u = 0.5, v = 1.0 }"))
    done = fcm("respond", scene, "--sensitivity", "--harmonics", 1, "--json")
    curve = json.loads(done.out)["curves"][0]
    assert done.code == 0 and list(curve["sensitivity"]) == list(curve["peak"])
    assert np.isfinite([n["amplitude"] for n in curve["sensitivity"]["u"]["numbers"].values()]).all()


def test_an_interruption_keeps_the_curves(fcm, scene):
    """All of them were lost, unless they went to a file from which a run could go on."""
    scene.write_text(scene.read_text() + '\n[sweep]\n"contact.shroud.mu" = [0.3, 0.4, 0.5]\n')
    options = ("--sensitivity", "--harmonics", 1, "--jobs", 1, "--json", "-o", "a.nc")
    done = fcm("respond", scene, *options, messages=Interrupting("sensitivities", 2))
    found = json.loads(done.out)["curves"]
    with netCDF4.Dataset("a.nc") as data:
        assert np.isfinite(data["sensitivity"][:].filled(np.nan)).any(axis=(1, 2)).tolist() == [
            True,
            False,
            False,
        ]
    assert done.code == 3 and all(curve["points"] > 50 for curve in found)
    assert ["sensitivity" in curve for curve in found] == [True, False, False]
    assert [curve.get("reason") for curve in found] == [
        None,
        *["interrupted before its sensitivities were known"] * 2,
    ]


def test_after_an_interruption_none_is_begun(scene):
    """The time that a run may take is over then."""
    scene.write_text(scene.read_text() + '\n[sweep]\n"contact.shroud.mu" = [0.3, 0.4]\n')
    loaded = load_scene(scene)
    response = trace(loaded, harmonics=1)
    cut_off = response.curves[1]
    cut_off.complete, cut_off.reason, cut_off.cause = False, "interrupted at 1 rad/s", Cause.INTERRUPTED
    added(Messages(), response, loaded, True)
    assert [curve.sensitivity for curve in response.curves] == [None, None]
    reasons = ["interrupted before its sensitivities were known", "interrupted at 1 rad/s"]
    assert [curve.reason for curve in response.curves] == reasons and not response.curves[0].complete
