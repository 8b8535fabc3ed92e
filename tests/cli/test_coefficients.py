"""``fcm plot surface``, ``error``, ``normal``: a picture, or one message and exit code 2."""

import math
import shutil

import pytest

from fcm.plot.surface import draw_surfaces
from fcm.table.shipped import DEFAULT

SOME = ("--coefficient", "F_c", "--phi", "15deg")
WHATS = (("surface", *SOME), ("surface", "--contour", *SOME), ("error", *SOME), ("normal",))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("what", "name", "begin"),
    [
        (WHATS[0], "a.svg", b"<?xml"),
        (WHATS[1], "a.pdf", b"%PDF"),
        (WHATS[1], "a.png", b"\x89PNG"),
        (WHATS[2], "a.svg", b"<?xml"),
        (WHATS[2], "a.pdf", b"%PDF"),
        (WHATS[3], "a.png", b"\x89PNG"),
    ],
)
def test_the_ending_is_the_format_and_the_bytes_are_the_same_again(fcm, tmp_path, what, name, begin):
    for output in (name, "again" + name):
        done = fcm("plot", *what, "-o", output)
        assert (done.code, done.out) == (0, "") and done.err.startswith(f"wrote {output}")
        assert len(done.err.splitlines()) == 1
    content = (tmp_path / name).read_bytes()
    assert content.startswith(begin) and content == (tmp_path / ("again" + name)).read_bytes()
    assert {path.name for path in tmp_path.iterdir()} == {name, "again" + name}


@pytest.mark.slow
def test_every_picture_has_a_name_of_its_own(fcm, tmp_path):
    for what in ("surface", "error", "normal"):
        assert fcm("plot", what).code == 0
    assert {path.name for path in tmp_path.iterdir()} == {"surface.png", "error.png", "normal.png"}


def drawn(fcm, monkeypatch, *args):
    """Coefficient and phase of each surface that would be drawn."""
    seen = []
    monkeypatch.setattr(
        "fcm.plot.surface.draw_surfaces", lambda some: seen.extend(some) or draw_surfaces(some[:1])
    )
    assert fcm("plot", "surface", *args).code == 0
    return seen


def test_by_default_it_is_figure_10(fcm, monkeypatch):
    assert [(one.coefficient, one.plane.phi) for one in drawn(fcm, monkeypatch)] == [
        ("F_s", 0.0),
        ("F_c", 0.0),
    ]


def test_options_reach_the_picture(fcm, monkeypatch):
    args = (
        "--coefficient",
        "F_b",
        "--phi",
        "0.5",
        "--phi=-30deg",
        "--n0-bar",
        "-1",
        "4",
        "--b-bar",
        "0.5",
        "3",
    )
    surfaces = drawn(fcm, monkeypatch, *args)
    assert [one.plane.phi for one in surfaces] == [0.5, math.radians(-30.0)]
    for one in surfaces:
        assert one.coefficient == "F_b"
        assert (one.n0_bar[0], one.n0_bar[-1], one.b_bar[0], one.b_bar[-1]) == (-1.0, 4.0, 0.5, 3.0)


def test_a_table_is_drawn_instead_of_the_closed_form(fcm, monkeypatch):
    fast = DEFAULT.with_name("fast.nc")
    exact, table = (drawn(fcm, monkeypatch, "--phi", "0.5", *more) for more in ((), ("--table", fast)))
    difference = abs(exact[0].values - table[0].values).max()
    assert 1e-6 < difference < 2e-3


@pytest.mark.slow
def test_the_worst_point_is_printed(fcm):
    done = fcm("plot", "error", "--coefficient", "F_c", "--phi", "30deg")
    assert "greatest error" in done.err and "of F_c at n0_bar " in done.err and "phi 0.5236 rad" in done.err


@pytest.mark.parametrize(
    ("args", "said"),
    [
        (["-o", "a.jpg"], ".png or .svg or .pdf"),
        (["-o", "no/a.png"], "there is no folder"),
        (["--coefficient", "F_x"], "F_x"),
        (["--phi", "15°"], '"15°" is no angle'),
        (["--phi", "nan"], '"nan" is no angle'),
        (["--phi", "1e999deg"], "is no angle"),
        (["--phi", ""], '"" is no angle'),
        (["--n0-bar", "1", "1"], "a lower and a higher number"),
        (["--n0-bar", "nan", "1"], "a lower and a higher number"),
        (["--n0-bar", "-1e300", "1e300"], "a lower and a higher number"),
        (["--b-bar", "-1", "1"], "an amplitude is not negative"),
        (["--b-bar", "2", "inf"], "a lower and a higher number"),
        ([f"--phi={i}" for i in range(9)], "too many"),
        (["--table", "nothing.nc"], "nothing.nc"),
        (["--table", "."], "."),
    ],
)
@pytest.mark.parametrize("what", ["surface", "error"])
def test_wrong_options_write_nothing(fcm, tmp_path, what, args, said):
    done = fcm("plot", what, *args)
    assert done.code == 2 and said in done.err and "Traceback" not in done.err
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("what", ["surface", "error"])
def test_a_damaged_table_is_one_message(fcm, tmp_path, what):
    path = tmp_path / "a.nc"
    shutil.copy(DEFAULT.with_name("fast.nc"), path)
    path.write_bytes(path.read_bytes()[:-100])
    done = fcm("plot", what, "--table", path, "-o", "a.png")
    assert done.code == 2 and len(done.err.splitlines()) == 1
    assert not (tmp_path / "a.png").exists()
