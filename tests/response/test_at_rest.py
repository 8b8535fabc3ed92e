"""Degrees of freedom that move by rounding alone are at rest: no peak, error or place, in any analysis."""

import json

import netCDF4
import numpy as np
import pytest

# the axial motions of a bar and a beam that are not coupled, as rows that an eigensolver mixes by rounding
STRUCTURE = """
[structure]
dofs = ["x", "y", "tip_x", "tip_y"]
mass = [[420.0, 0, 70, 0], [0, 156, 0, 54], [70, 0, 140, 0], [0, 54, 0, 156]]
stiffness = [[2.1e7, 0, -2.1e7, 0], [0, 3.2e6, 0, -1.3e6], [-2.1e7, 0, 4.2e7, 0], [0, -1.3e6, 0, 2.9e6]]
damping = 0.01
"""
SUM_AND_DIFFERENCE = """
[modal]
dofs = ["left", "right", "difference"]
frequency = [100.0, 151.0]
damping = 0.01
shapes = [[0.3, 0.3, 0.0], [0.7, -0.7, 1.4]]
"""  # forces that are as great on both sides do nothing on the second mode, beside rounding
REST = """
[[contact]]
name = "ground"
tangential = TANGENTIAL
normal = NORMAL
mu = 0.3
k_u = 1e4
k_v = 1e4
n_0 = PRELOAD
[response]
frequency = [50, 600]
max_step = 0.3
harmonics = 1
"""


def force(dof, amplitude):
    return f'[[force]]\ndof = "{dof}"\namplitude = {amplitude}\n'


def with_contact(text, tangential, normal, preload):
    rest = REST.replace("TANGENTIAL", tangential).replace("NORMAL", normal)
    return text + rest.replace("PRELOAD", str(preload))


SCENES = {  # text, what moves, what does not
    "slips": (
        with_contact(STRUCTURE + force("tip_x", 1e5), '"x"', '"y"', 1e4), ("x", "tip_x"), ("y", "tip_y")
    ),
    "linear": (
        with_contact(STRUCTURE + force("tip_x", 1.0), '"x"', '"y"', 1e9), ("x", "tip_x"), ("y", "tip_y")
    ),
    "stiff": (  # displacements far below the greatest have digits there, but not more than the shapes
        with_contact(STRUCTURE + force("tip_x", 1e5), '"x"', '"y"', 1e9).replace("= 1e4", "= 1e9"),
        ("x", "tip_x"), ("y", "tip_y"),
    ),
    "opposite": (
        with_contact(
            SUM_AND_DIFFERENCE + force("left", 0.1) + force("left", 0.2) + force("right", 0.3),
            "{ left = 1.0, right = 1.0 }", "{ left = 0.0, difference = 1.0 }", 1.0,
        ),
        ("left", "right"), ("difference",),
    ),
}  # fmt: skip
ANALYSES = {
    "balance": (),
    "more harmonics": ("--harmonics", 3),
    "peaks only": ("--peaks-only",),
    "level": ("--level", "0:1", "--at", 110.0),
    "mode": ("--level", "1e-4:1", "--mode"),  # its number is that of the lowest that moves
    "exact": ("--method", "exact", "--only", "peaks"),
    "visited": ("--method", "exact", "--at", "110"),
}


@pytest.mark.slow
@pytest.mark.parametrize("options", ANALYSES.values(), ids=ANALYSES)
@pytest.mark.parametrize("name", SCENES)
def test_no_result_is_rounding(fcm, tmp_path, name, options):
    text, moving, still = SCENES[name]
    (tmp_path / "s.toml").write_text(text)
    number = (1 if name == "opposite" else 2,) if "--mode" in options else ()
    done = fcm("respond", "s.toml", "-o", "s.nc", "--json", *options, *number)
    assert done.code == 0, done.err
    (curve,) = json.loads(done.out)["curves"]
    for dof in still:
        peak = curve["peak"][dof]
        for one in curve.get("mode", {}).get("resonances", ()):
            assert one["amplitude"][dof] == 0.0
        assert (
            peak["amplitude"] == (None if "mode" in curve else 0.0)
            and peak["frequency"] is None
            and peak["error"] is None
        )
        assert not peak["at_edge"]
        for jump in curve["jumps"]:
            assert jump["before"][dof] == 0.0
    for dof in () if "mode" in curve else moving:
        assert curve["peak"][dof]["amplitude"] > 1e-12 and curve["peak"][dof]["frequency"] is not None
    with netCDF4.Dataset("s.nc") as file:
        names = file["dof"][:].tolist()
        for variable in ("amplitude", "fundamental", "harmonic_amplitude", "family_greatest"):
            if variable in file.variables:
                values = np.ma.filled(file[variable][:], np.nan)[..., [names.index(dof) for dof in still]]
                assert set(values[np.isfinite(values)].tolist()) <= {0.0}, variable
        at = np.ma.filled(file["peak_frequency"][:], np.nan)[0]
        assert np.isnan(at[[names.index(dof) for dof in still]]).all()


@pytest.mark.parametrize("options", [*ANALYSES.values(), ("--sensitivity",)], ids=[*ANALYSES, "sensitivity"])
def test_nothing_is_said_of_what_does_not_move(fcm, tmp_path, options):
    (tmp_path / "s.toml").write_text(SCENES["slips"][0])
    done = fcm("respond", "s.toml", *options, *((2,) if "--mode" in options else ()))
    assert done.code == 0, done.err
    assert "not unique" not in done.err and "tip_y" not in done.err
    at_end = options == ANALYSES["level"]  # of the level, where other degrees of freedom move most
    assert ("may rise further" in done.out) == at_end
    if "--mode" not in options:
        assert "0 the degree of freedom does not move, but for rounding" in done.out


def test_small_motions_that_are_known_stay(fcm, tmp_path):
    """A rotation of other units, and a mode that is driven by itself, by little: by hand."""
    text = (
        "[modal]\ndofs = ['far', 'near']\nfrequency = [1.0, 2.0]\ndamping = 0.01\nshapes = [[1.0, 0.0], "
        "[0.0, 1e-6]]\n[response]\nfrequency = [0.5, 1.5]\n" + force("far", 1.0) + force("near", 1e6)
    )
    (tmp_path / "s.toml").write_text(text)
    (curve,) = json.loads(fcm("respond", "s.toml", "--json").out)["curves"]
    at_the_end = 1e-6 / np.abs(4.0 - 1.5**2 + 2j * 0.01 * 2.0 * 1.5)
    assert curve["peak"]["near"]["amplitude"] == pytest.approx(at_the_end, rel=1e-6)
    assert curve["peak"]["near"]["at_edge"]


def test_a_mode_without_damping_has_none(fcm, tmp_path):
    """An elastic wall takes no energy, whatever the amplitude; friction beside it does."""
    wall = (
        '[structure]\ndofs = ["x"]\nmass = [[1.0]]\nstiffness = [[10.0]]\ndamping = 0.0\n[[contact]]\n'
        'name = "wall"\ntangential = "x"\nnormal = "x"\nmu = MU\nk_u = 50.0\nk_v = 50.0\ngap = 0.01\n'
        + force("x", 1.0)
        + "[response]\nfrequency = [2.0, 6.0]\n"
    )
    for mu, none in (("0.0", True), ("0.3", False)):
        (tmp_path / "s.toml").write_text(wall.replace("MU", mu))
        done = fcm("respond", "s.toml", "--mode", 1, "--level", "0.001:1", "-o", "s.nc", "--harmonics", 3)
        assert done.code == 0, done.err
        with netCDF4.Dataset("s.nc") as file:
            damping = file["damping_ratio"][0]
        assert (damping == 0.0).all() if none else damping.max() > 1e-3


@pytest.mark.parametrize("name", ["slips", "opposite"])
def test_no_peak_of_rounding_is_tracked(fcm, tmp_path, name):
    text, moving, _ = SCENES[name]
    (tmp_path / "s.toml").write_text(text)
    over = ("--over", "contact.ground.n_0", "--from", 1.0, "--to", 1.5)
    done = fcm("respond", "s.toml", "--track", "peaks", *over, "--json")
    assert done.code == 0, done.err
    found = {one["what"] for one in json.loads(done.out)["tracked"]["curves"]}
    assert found == {f"peak of {dof}" for dof in moving}


@pytest.mark.parametrize("what", ["peak", "greatest"])
def test_nothing_is_chosen_by_rounding(fcm, tmp_path, what):
    aim = f'[optimum]\nvary = ["contact.ground.n_0"]\nbounds = [[1.0, 1e5]]\nminimise = "{what}.tip_y"\n'
    (tmp_path / "s.toml").write_text(SCENES["slips"][0] + aim)
    done = fcm("respond", "s.toml")
    assert done.code == 2 and done.out == ""
    assert "optimum: tip_y does not move, but for rounding: no force reaches it" in done.err
