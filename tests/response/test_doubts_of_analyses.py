"""What the curve at a place is in doubt of, every other analysis of that place is in doubt of, too."""

import json

import netCDF4
import numpy as np
import pytest

BODY = """
[modal]
dofs = ["x0", "x1", "x2"]
frequency = [1.0, 2.89155, 3.17348]
damping = [0.03587, 0.01766, 0.03329]
shapes = [[0.3084, 0.1075, 0.6829], [-0.3969, -1.183, -0.1608], [0.1595, -0.2364, -0.3164]]
[[contact]]
name = "c0"
tangential = "x0"
normal = "x1"
mu = 0.137
k_u = 2.52
k_v = 6.314
n_0 = 0.1058
[[contact]]
name = "c1"
tangential = "x2"
normal = { x1 = -1.0, x0 = 0.5 }
mu = 0.337
k_u = 1.603
k_v = 4.276
n_0 = 0.1261
"""
FORCES = """
[[force]]
dof = "x0"
amplitude = 0.1
[[force]]
dof = "x1"
amplitude = 0.04
phase = 1.0
"""
STATIC = '[[load]]\ndof = "x1"\nforce = -0.1781\n'
RANGE = "[response]\nfrequency = [1.0, 1.08]\nmax_step = 0.3\nharmonics = 3\n"
OPTIMUM = '[optimum]\nvary = ["contact.c0.mu"]\nbounds = [[0.13, 0.14]]\nminimise = "greatest.x0"\n'
NOT_UNIQUE = {  # text after the body, options
    "curve": (RANGE, ()),
    "peaks only": (RANGE, ("--peaks-only",)),
    "sensitivity": (RANGE, ("--sensitivity",)),
    "level": (RANGE, ("--level", "0.5:1.5", "--at", 1.03979)),
    "optimum": (RANGE + OPTIMUM, ()),
    "exact curve": (RANGE, ("--method", "exact")),
    "visited": (RANGE, ("--method", "exact", "--at", 1.03979)),
}


@pytest.mark.parametrize(("more", "options"), NOT_UNIQUE.values(), ids=NOT_UNIQUE)
def test_every_analysis_says_that_the_motion_is_not_unique(fcm, tmp_path, more, options):
    """At 1.03979 rad/s x1 is 0.0085 from rest, and another with another residual friction."""
    (tmp_path / "s.toml").write_text(BODY + FORCES + STATIC + more)
    done = fcm("respond", "s.toml", "-o", "s.nc", "--json", *options)
    assert done.code == 0, done.err
    (curve,) = json.loads(done.out)["curves"]
    assert curve.get("may_not_be_unique", 0) + curve.get("not_unique", 0) > 0
    assert "never slips" in done.err and any(
        word in done.err for word in ("its past decides", "residual friction")
    )


def test_a_nonlinear_mode_says_so(fcm, tmp_path):
    (tmp_path / "s.toml").write_text(BODY + FORCES + RANGE)
    done = fcm("respond", "s.toml", "--mode", 1, "--level", "0.01:0.3", "--json")
    assert done.code == 0, done.err
    assert json.loads(done.out)["curves"][0]["may_not_be_unique"] > 0
    assert "a friction force that its past decides" in done.err and "--method exact" not in done.err


@pytest.mark.slow
def test_tracked_points_say_so(fcm, tmp_path):
    (tmp_path / "s.toml").write_text(BODY + FORCES + STATIC + RANGE.replace("1.0, 1.08", "0.7, 1.5"))
    over = ("--track", "slip", "--over", "level", "--from", 0.9, "--to", 1.1)
    done = fcm("respond", "s.toml", *over, "--json", "--harmonics", 1)
    assert done.code == 0, done.err
    curves = json.loads(done.out)["tracked"]["curves"]
    assert curves and any(one.get("may_not_be_unique") for one in curves)
    assert "a friction force that its past decides" in done.err


def test_the_top_of_a_level_ranges_as_the_exact_motions_do(fcm, tmp_path):
    """With residual friction, beside the exact motions that a period closes with it: at the level 1."""
    (tmp_path / "s.toml").write_text(BODY + FORCES + STATIC + RANGE.replace("harmonics = 3\n", ""))
    at = ("--at", 1.03979, "--json")
    raised = fcm("respond", "s.toml", "--level", "0.5:1", "--harmonics", 7, *at)
    exact = fcm("respond", "s.toml", "--method", "exact", *at)
    peaks, family = (json.loads(done.out)["curves"][0]["peak"] for done in (raised, exact))
    for dof in ("x0", "x1", "x2"):
        told, known = peaks[dof]["residual_change"], family[dof]["residual_change"]
        assert 0.01 < known and told == pytest.approx(known, rel=0.2)  # the members are balanced: an estimate
    assert "may be one of many" in raised.err and "its past decides" in raised.err


@pytest.mark.slow
def test_an_optimum_has_the_residual_friction_of_its_peak(fcm, tmp_path):
    least = '[optimum]\nvary = ["contact.c0.n_0"]\nbounds = [[0.095, 0.1]]\nminimise = "peak.x1"\n'
    text = BODY + FORCES + STATIC + RANGE.replace("1.08", "1.2").replace("harmonics = 3", "harmonics = 7")
    (tmp_path / "s.toml").write_text(text + least)
    found = json.loads(fcm("respond", "s.toml", "--json", "-o", "s.nc").out)["optimum"][0]
    (place,), number = found["at"], found["values"]["contact.c0.n_0"]
    (tmp_path / "there.toml").write_text(text.replace("0.1058", repr(number)))
    peak = json.loads(fcm("respond", "there.toml", "--json").out)["curves"][0]["peak"]["x1"]
    assert place["residual_change"] == pytest.approx(peak["residual_change"], rel=1e-2) and number < 0.1
    assert place["residual_change"] > 0.01
    with netCDF4.Dataset(tmp_path / "s.nc") as file:
        assert file["optimum_residual_change"][0, 0] == place["residual_change"]
    head = fcm("respond", "s.toml").out.splitlines()[0]
    assert f", residual friction {100.0 * place['residual_change']:.2g} %)" in head


def test_a_level_at_which_all_slips_is_unique(fcm, tmp_path):
    (tmp_path / "s.toml").write_text(BODY + FORCES + STATIC + RANGE)
    done = fcm("respond", "s.toml", "--level", "9:11", "--at", 1.03979, "--json")
    assert "may_not_be_unique" not in json.loads(done.out)["curves"][0] and "residual" not in done.err


CREEPING = """
[modal]
dofs = ["u", "v"]
frequency = [0.0, 2.0]
damping = [0.0, 0.05]
shapes = [[1.0, 0.0], [0.2, 1.0]]
[[contact]]
name = "slide"
tangential = "u"
normal = "v"
mu = 0.3
k_u = 1.0
k_v = 1.0
n_0 = 0.5
[[force]]
dof = "u"
amplitude = 1.0
[[force]]
dof = "v"
amplitude = 1.0
phase = 0.7
[response]
frequency = [1.0, 1.5]
harmonics = 1
"""


@pytest.mark.parametrize("options", [(), ("--peaks-only",), ("--level", "0.5:1.5", "--at", 1.2)])
def test_what_creeps_is_no_steady_state_in_any_analysis(fcm, tmp_path, options):
    """Friction on a body that nothing holds: its load varies, so that it is pushed one way on average."""
    (tmp_path / "s.toml").write_text(CREEPING)
    done = fcm("respond", "s.toml", "--json", *options)
    assert done.code == 3, done.err
    (curve,) = json.loads(done.out)["curves"]
    assert not curve["complete"] and "pushes the structure one way" in curve["reason"]
    assert curve["stable"] is False


def test_a_file_without_points_says_what_may_be_missing(fcm, tmp_path):
    (tmp_path / "s.toml").write_text(BODY + FORCES + STATIC + RANGE)
    done = fcm("respond", "s.toml", "--peaks-only", "-o", "s.nc", "--json")
    (curve,) = json.loads(done.out)["curves"]
    with netCDF4.Dataset("s.nc") as file:
        assert file["points_maybe_not_unique"][:].tolist() == [curve["may_not_be_unique"]]
        assert ("branches_unsure_at" in file.variables) == ("branches_unsure_at" in curve)
        if "no_stable_motion" in curve:
            ends = np.ma.filled(file["no_stable_motion"][:], np.nan)[0]
            assert ends.tolist() == curve["no_stable_motion"]
