"""``fcm respond --mode`` and ``fcm plot mode``."""

import json

import netCDF4
import numpy as np
import pytest

from ..interrupted import Interrupting

MODE = ("respond", "yang1998-n5", "--mode", 1, "--level", "0.1:100", "--harmonics", 1)


@pytest.fixture
def result(fcm, tmp_path):
    path = tmp_path / "mode.nc"
    assert fcm(*MODE, "-o", path, "--csv", "mode.csv").code == 0
    return path


def test_the_file_holds_frequency_and_damping_against_amplitude(result, tmp_path):
    with netCDF4.Dataset(result) as data:
        data.set_auto_mask(False)
        a, D, w = (data[name][0] for name in ("modal_amplitude", "damping_ratio", "frequency"))
        assert (a[0], a[-1]) == pytest.approx((0.1, 100.0))
        assert w[0] == pytest.approx(np.sqrt(2.0), rel=1e-3) and D.max() > 4.0 * D[0]
        level, force, flank = (data[x][0] for x in ("resonant_level", "modal_force", "flank_frequency"))
        assert level == pytest.approx(2.0 * D * w**2 * np.sqrt(1.0 - D**2) * a / force)
        assert np.array_equal(np.isfinite(flank[:, 0, 1]), level <= 1.0)
        summary = json.loads(data.summary)["curves"][0]
    assert summary["mode"]["greatest_damping"]["damping"] == D.max()
    rows = (tmp_path / "mode.csv").read_text().splitlines()
    assert len(rows) == a.size + 1 and "modal_amplitude,damping_ratio" in rows[0]


def test_json_says_where_the_forces_of_the_scene_are_in_resonance(fcm):
    done = fcm(*MODE, "--json")
    (one,) = json.loads(done.out)["curves"][0]["mode"]["resonances"]
    assert done.code == 0 and one["frequency"] == pytest.approx(1.19, abs=0.01)
    assert one["amplitude"]["u"] == pytest.approx(15.831, rel=0.02)  # the peak of the response itself


@pytest.mark.slow
def test_the_response_is_predicted_at_any_level_of_the_forces(fcm):
    done = fcm(*MODE, "--force-level", 0.5, "--force-level", 2, "--json", "-o", "levels.nc")
    found = json.loads(done.out)["curves"][0]["mode"]["resonances"]
    assert [one["level"] for one in found] == [0.5, 2.0]
    for one in found:
        lines = []
        for w in np.linspace(0.98, 1.02, 3) * one["frequency"]:
            alone = fcm("respond", "yang1998-n5", "--level", "0:3", "--at", w, "--harmonics", 1, "-o", "a.nc")
            assert alone.code == 0
            with netCDF4.Dataset("a.nc") as data:
                at, u = data["level"][0], data["amplitude"][0, :, 0]
                crossed = np.flatnonzero((at[1:] - one["level"]) * (at[:-1] - one["level"]) <= 0.0)
                lines.append(max(max(u[i], u[i + 1]) for i in crossed))
        assert max(lines) == pytest.approx(one["amplitude"]["u"], rel=0.15)
    with netCDF4.Dataset("levels.nc") as data:
        assert data["force_level"][:].tolist() == [0.5, 2.0]


@pytest.mark.slow
def test_a_level_whose_resonance_is_not_among_the_amplitudes_is_told(fcm):
    """The response has them: of the level 1 at the amplitude 15.8 of u, and more beyond, less below."""
    levels = [x for level in (1e-3, 1, 20) for x in ("--force-level", level)]
    done = fcm(*MODE[:4], "--level", "5:30", "--harmonics", 1, *levels)
    assert done.code == 0
    wider = "a wider --level FROM:TO, which is of modal amplitudes, has these resonances"
    assert done.out.splitlines()[3:6] == [
        "force level 0.001: its resonance lies below the modal amplitude 5",
        "force level 20: its resonance lies beyond the modal amplitude 30",
        wider,
    ]
    assert done.out.splitlines()[1].count("(level ") == 1 and "(level 1)" in done.out
    several = ("respond", "yang1998", *MODE[2:4], "--level", "5:30", "--harmonics", 1, "--force-level", 20)
    told = "force level 20: its resonance lies beyond the modal amplitude 30, in 10 of 10 curves"
    assert fcm(*several).out.splitlines()[12:] == [told, wider]
    mode = json.loads(fcm(*MODE[:4], "--level", "5:30", "--harmonics", 1, *levels, "--json").out)["curves"][0]
    assert [one["level"] for one in mode["mode"]["not_met"]] == [0.001, 20.0]
    assert [one["level"] for one in mode["mode"]["resonances"]] == [1.0]


def test_as_many_harmonics_as_an_accuracy_takes(fcm):
    done = fcm("respond", "two-contacts", "--mode", 1, "--level", "1e-5:1e-3", "--accuracy", 1e-3, "--json")
    curve = json.loads(done.out)["curves"][0]
    assert done.code == 0 and len(curve["harmonics"]) > 1 and curve["truncation_error"] <= 1e-3


@pytest.mark.slow
def test_the_picture(fcm, result, tmp_path):
    done = fcm("plot", "mode", result)
    assert (done.code, done.err) == (0, f"wrote {tmp_path / 'mode-mode.png'}\n")
    assert (tmp_path / "mode-mode.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("args", "said"),
    [
        (["--mode", 1], "--mode needs --level FROM:TO"),
        (["--mode", 1, "--level", "0:1"], "a --level that begins above 0"),
        (["--mode", 1, "--level", "1:2", "--at", 1.2], "--at is of no use with --mode"),
        (["--mode", 1, "--level", "1:2", "--method", "exact"], "--method is of no use with --mode"),
        (["--mode", 9, "--level", "1:2"], "there is no mode 9; the structure has the modes 1 to 2"),
        (["--mode", 1, "--level", "1e-9:1e9"], "by at most a factor of 1e+15"),
        (["--force-level", 2], "--force-level needs --mode"),
        (
            ["--mode", 1, "--level", "1e-3"],
            '"1e-3": give both ends, FROM:TO. Without --mode they are factors',
        ),
        (["--mode", 0, "--level", "1:2"], "0 is not in the range x>=1"),
    ],
)
def test_what_is_wrong_is_said(fcm, args, said, tmp_path):
    done = fcm("respond", "yang1998-n5", *args, "-o", "a.nc")
    assert done.code == 2 and said in done.err and not (tmp_path / "a.nc").exists()


def test_what_a_modal_amplitude_is_of_displacements_is_told(fcm):
    """So that its span can be chosen: of a mode of mass 1 with the contact stuck, by the eigenvectors."""
    done = fcm("respond", "yang1998-n5", "--mode", 1, "--level", "1e-3:1e-2", "--harmonics", 1)
    shapes = np.array([[0.707, 0.707], [1.0, -0.5]])
    springs = shapes @ np.diag([1.0, 1.0]) @ shapes.T  # k_u along u, k_v along v
    u, v = np.abs(shapes.T @ np.linalg.eigh(np.diag([1.0, 100.0]) + springs)[1][:, 0])
    assert f"a modal amplitude of 1 means, at the least that was followed: u {u:.4g}, v {v:.4g}\n" in done.out


def test_another_file_is_no_mode(fcm, tmp_path):
    netCDF4.Dataset(tmp_path / "a.nc", "w").close()
    done = fcm("plot", "mode", "a.nc")
    assert done.code == 2 and "no variable frequency, modal_amplitude" in done.err


@pytest.mark.slow
def test_an_interruption_keeps_the_modes_that_are_finished(fcm, scene):
    """All of them were lost. Of one that had been followed with fewer harmonics, that is kept."""
    scene.write_text(scene.read_text() + '\n[sweep]\n"contact.shroud.mu" = [0.3, 0.4, 0.5]\n')
    mode = ("respond", scene, "--mode", 1, "--level", "0.1:100", "--json")
    every = json.loads(fcm(*mode, "--harmonics", 1).out)["curves"]
    done = fcm(*mode, "--harmonics", 1, messages=Interrupting("2 of 3 curves"))
    found = json.loads(done.out)["curves"]
    assert done.code == 3 and [one["mode"] for one in found[:2]] == [one["mode"] for one in every[:2]]
    assert [one["complete"] for one in found] == [True, True, False]
    assert done.err.endswith("; what was traced is reported\n")  # and to no file was it written
    fine = (*mode, "--accuracy", 1e-4)
    first, *rest = json.loads(fcm(*fine, messages=Interrupting("with 3 harmonics")).out)["curves"]
    assert first["mode"] == every[0]["mode"] and first["reason"].endswith("known with 3 harmonics")
    assert [one["reason"] for one in rest] == ["interrupted before it was traced"] * 2
    # and so, if the error with more is not known
    first = json.loads(fcm(*fine, messages=Interrupting("error with 3 harmonics")).out)["curves"][0]
    assert first["mode"] == every[0]["mode"] and first["harmonics"] == [1]


def test_loads_that_nothing_holds_are_said(fcm, scene):
    """The first mode has no stiffness, and the contact holds it by its friction alone, 2 at most."""
    text = scene.read_text().replace("frequency = [1.0, 10.0]", "frequency = [0.0, 10.0]")
    text = text.replace("[[0.707, 0.707], [1.0, -0.5]]", "[[1.0, 0.0], [0.0, 1.0]]")
    scene.write_text(text + '\n[[load]]\ndof = "u"\nforce = 5.0\n')
    done = fcm("respond", scene, "--mode", 1, "--level", "0.1:10")
    assert done.code == 3 and "no equilibrium" in done.out and "friction is at most mu n" in done.out
    scene.write_text(scene.read_text().replace("mu = 0.4", "mu = 0"))
    done = fcm("respond", scene, "--mode", 1, "--level", "0.1:10")
    assert done.code == 2 and "does not come to rest" in done.err


@pytest.mark.parametrize(
    ("force", "said"),
    [
        (101.0, "under the static loads 1 of 1 contacts are closed; their normal forces sum to 6\n"),
        (-606.0, "under the static loads no contact is closed (1 in all). Do they push the faces apart?"),
    ],
)
def test_which_contacts_loads_close_is_said(fcm, scene, force, said):
    """Along the normal the structure has a stiffness of 100, the contact of 1 and a preload of 5."""
    text = scene.read_text().replace("[[0.707, 0.707], [1.0, -0.5]]", "[[1.0, 0.0], [0.0, 1.0]]")
    scene.write_text(f'{text}\n[[load]]\ndof = "v"\nforce = {force}\n')
    done = fcm("respond", scene, "--mode", 1, "--level", "0.1:10", "--harmonics", 1)
    assert done.code == 0 and said in done.err


def test_a_mode_outside_the_range_of_the_scene_is_told(fcm):
    """Perhaps another is meant. The range of the scene is from 0.7 to 1.7."""
    level = "--level", "1e-3:1e-2", "--harmonics", 1
    assert "outside the scene's range" not in fcm("respond", "yang1998-n5", "--mode", 1, *level).err
    done = fcm("respond", "yang1998-n5", "--mode", 2, *level)
    assert done.code == 0 and "mode 2 goes from 10." in done.err
    assert "outside the scene's range of 0.7 to 1.7 rad/s: is another --mode meant?" in done.err


@pytest.mark.slow
def test_a_mode_is_drawn_over_the_response_of_its_scene(fcm, result, tmp_path):
    assert fcm("respond", "yang1998-n5", "-o", "r.nc").code == 0
    done = fcm("plot", "response", "r.nc", "--backbone", result, "-o", "b.png")
    assert (done.code, done.err) == (0, "wrote b.png\n")
    assert fcm("plot", "response", "r.nc", "-o", "alone.png").code == 0
    assert (tmp_path / "b.png").read_bytes() != (tmp_path / "alone.png").read_bytes()
    done = fcm("plot", "response", "r.nc", "--backbone", "r.nc")
    assert done.code == 2 and "not a file of nonlinear modes (fcm respond --mode)" in done.err


@pytest.mark.slow
def test_the_last_line_says_at_how_many_points_the_error_was_estimated(fcm, tmp_path):
    """It gave the error of the one point at which it was known as that of the whole mode."""
    done = fcm("respond", "beam", "--mode", 1, "--level", "1e-6:1e-2", "-o", tmp_path / "a.nc")
    with netCDF4.Dataset(tmp_path / "a.nc") as data:
        error, amplitude = (data[name][0].filled(np.nan) for name in ("truncation_error", "modal_amplitude"))
        (curve,) = json.loads(data.summary)["curves"]
    known, points = np.isfinite(error).sum(), np.isfinite(amplitude).sum()
    assert 0 < known < points and done.code == 0
    assert curve["mode"]["error_known"]["points"] == known
    assert curve["mode"]["error_known"]["modal_amplitude"] == amplitude[np.isfinite(error)].max()
    assert f"estimated at {known} of {points} points" in done.err
    result = done.err.splitlines()[-1]
    assert result.startswith("result: complete; errors of amplitudes are ")
    assert f", unknown at {points - known} of {points} points" in result


RESONANT = """
[modal]
dofs = ["u", "v"]
frequency = [1.0, {second}]
damping = 0.002
shapes = [[0.8, 0.5], [0.7, -0.6]]
[[contact]]
name = "c"
tangential = "u"
normal = "v"
mu = 0.4
k_u = 0.3
k_v = 0.3
n_0 = 1.0
[[force]]
dof = "u"
amplitude = 0.3
[response]
frequency = [0.85, 1.25]
"""


@pytest.mark.slow
@pytest.mark.parametrize(("second", "resonant"), [(3.2, True), (5.0, False)])
def test_an_internal_resonance_is_told(fcm, tmp_path, second, resonant):
    """Where the third harmonic meets the second mode, the mode predicts a peak that the response has not."""
    scene = tmp_path / "a.toml"
    scene.write_text(RESONANT.format(second=second))
    run = fcm("respond", scene, "--mode", "1", "--level", "0.01:100", "--harmonics", "1-7", "--json")
    (curve,) = json.loads(run.out)["curves"]
    assert ("internal_resonance" in curve["mode"]) == ("internal resonance:" in run.err) == resonant
    (predicted,) = curve["mode"]["resonances"]
    (response,) = json.loads(fcm("respond", scene, "--harmonics", "1-7", "--json").out)["curves"]
    off = abs(predicted["amplitude"]["u"] / response["peak"]["u"]["amplitude"] - 1.0)
    assert off > 0.2 if resonant else off < 0.01
    if resonant:
        there = curve["mode"]["internal_resonance"]
        low, high = there["frequency"]
        assert there["harmonic"] == 3 and 3.2 < 3.0 * low < 3.0 * high < 3.3
        assert 0.2 < there["share"] < 1.0
