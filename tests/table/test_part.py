"""A part of a table, for one scene: the same numbers, fewer nodes, the closed form outside."""

import json
import pickle

import netCDF4
import numpy as np
import pytest
import xarray

import fcm
from fcm.response import trace
from fcm.scene import load_scene
from fcm.table import TableError, build_table, open_table, spline
from fcm.table.nodes import PRESETS
from fcm.table.options import NODE_OPTIONS
from fcm.table.partial_table import ChartRanges, TablePart

from ..oscillator import oscillator

SCENE = "yang1998-n5"


@pytest.fixture(scope="module")
def reach():
    reach = ChartRanges(PRESETS["fast"])
    for curve in trace(load_scene(SCENE), "closed-form", harmonics=1).curves:
        reach.note(*curve.loop[:, 0, :3].T)
    return reach


@pytest.fixture(scope="module")
def path(reach, tmp_path_factory):
    path = tmp_path_factory.mktemp("part") / "part.nc"
    build_table(path, PRESETS["fast"], points=10_000, part=reach.part())
    return path


@pytest.fixture(scope="module")
def table(path):
    return open_table(path)


def random_points(count=20_000, seed=3):
    random = np.random.default_rng(seed)
    b = 10.0 ** random.uniform(-3, 3, count)
    return (
        b * random.uniform(-1.2, 1.2, count) + (random.random(count) < 0.5),
        b,
        random.uniform(-4, 4, count),
    )


def test_a_part_has_fewer_nodes_and_bytes(table, path):
    assert table.part.nodes < 0.6 * TablePart.all_of(PRESETS["fast"]).nodes
    assert path.stat().st_size < 0.6 * 888_482
    assert table.resolution == PRESETS["fast"]


def test_values_and_gradients_are_those_of_all_nodes(table, fast):
    before = table.outside
    points = table.part.sample(20_000, seed=5)
    F, dF = table.gradients(*points)
    assert table.outside - before < 20  # rounding at the very end of an axis
    every, slopes = fast.gradients(*points)
    assert np.abs(F - every).max() < 1e-6
    assert np.abs(dF - slopes).max() < 1e-3 * np.abs(slopes).max()
    assert np.abs(np.stack(table(*points)) - F).max() < 1e-15


def test_a_single_point_is_as_in_an_array(table):
    n0, b, phi = table.part.sample(20, seed=6)
    together = np.stack(table(n0, b, phi))
    for k in range(20):
        assert np.abs(np.array(table(n0[k], b[k], phi[k])) - together[:, k]).max() < 1e-14


def test_outside_it_is_the_closed_form_and_counted(path, fast):
    table = open_table(path)
    points = random_points()
    F, dF = table.gradients(*points)
    exact, slopes = fcm.contact.fourier_gradients(*points)
    error = np.abs(F - exact).max(axis=0)
    assert 0 < table.outside < 20_000
    assert error.max() < 2e-3
    assert np.count_nonzero(error < 1e-14) >= table.outside
    assert dF.shape == slopes.shape


def test_nothing_is_outside_where_no_table_is_needed(path):
    table = open_table(path)
    b = 10.0 ** np.linspace(-9, 9, 100)
    stuck, opened = table(1e12, b, 0.3), table(-1e12, b, 0.3)
    assert np.all(stuck[1] == 1.0) and np.all(np.stack(opened) == 0.0)
    assert table.outside == 0


@pytest.mark.parametrize("chart", ["separation", "slip"])
def test_a_chart_that_is_not_reached_is_left_out(chart, tmp_path, tiny_file):
    part = TablePart.all_of((9, 5, 11, 9))._replace(**{chart: (0, 0)})
    build_table(tmp_path / "one.nc", part.resolution, 10_000, part=part)
    table, every = open_table(tmp_path / "one.nc"), open_table(tiny_file)
    assert table.part == part
    points = part.sample(5000, seed=7)
    assert np.abs(np.stack(table(*points)) - np.stack(every(*points))).max() < 1e-6
    assert table.outside < 5
    other = part._replace(separation=part.slip, slip=part.separation)
    points = other._replace(**{chart: ((0, 9) if chart == "separation" else (0, 5))}).sample(100, seed=8)
    assert np.isfinite(np.stack(table(*points))).all()
    with xarray.open_dataset(tmp_path / "one.nc") as data:
        assert all({"long_name", "units"} <= set(data[name].attrs) for name in data.variables)


def test_any_cut_is_right_everywhere(tmp_path, tiny_file):
    """Whatever nodes are cut away: the numbers of all nodes inside, exact ones outside."""
    resolution = (25, 19, 27, 23)
    path = tmp_path / "all.nc"
    build_table(path, resolution, points=10_000)
    every = open_table(path)
    points = random_points()
    exact, whole = np.stack(fcm.fourier_coefficients(*points)), np.stack(every(*points))
    for part in (
        TablePart(resolution, (0, 14), (5, 19), (7, 24), (3, 22)),
        TablePart(resolution, (8, 25), (0, 15), (0, 15), (0, 16)),
        TablePart(resolution, (4, 20), (2, 17), (11, 27), (7, 23)),
    ):
        build_table(path, resolution, points=10_000, part=part)
        table = open_table(path)
        found = np.stack(table(*points))
        near = np.minimum(np.abs(found - exact), np.abs(found - whole))
        assert 0 < table.outside < points[0].size
        assert near.max() < 1e-5


def test_guards_are_wide_enough():
    assert (2.0 - np.sqrt(3.0)) ** NODE_OPTIONS.guard < 4e-4
    assert spline.FREE != spline.FLAT


def test_response_is_the_same(table):
    (curve,) = trace(load_scene(SCENE), method=table).curves
    (other,) = trace(load_scene(SCENE), method="closed-form").curves
    assert curve.peaks["u"][:2] == pytest.approx(other.peaks["u"][:2], rel=1e-6)
    assert len(curve.folds) == 2
    assert np.ravel(curve.folds) == pytest.approx(np.ravel(other.folds), rel=1e-6)


def test_sweep_is_the_same_with_its_own_table(tmp_path):
    reach = ChartRanges(PRESETS["fast"])
    scene = load_scene("yang1998")
    exact = trace(scene, "closed-form", harmonics=1)
    for curve in exact.curves:
        reach.note(*curve.loop[:, 0, :3].T)
    build_table(tmp_path / "t.nc", PRESETS["fast"], points=10_000, part=reach.part())
    table = open_table(tmp_path / "t.nc")
    response = trace(scene, method=table)
    for curve, other in zip(response.curves, exact.curves, strict=True):
        assert curve.peaks["u"][:2] == pytest.approx(other.peaks["u"][:2], rel=1e-6)
        assert np.ravel(curve.folds) == pytest.approx(np.ravel(other.folds), rel=1e-6)
    assert table.outside <= 0.01 * sum(curve.evaluations for curve in response.curves)


def test_it_goes_to_other_processes(table):
    points = table.part.sample(10, seed=1)
    again = pickle.loads(pickle.dumps(table))
    assert np.array_equal(np.stack(again(*points)), np.stack(table(*points)))


def test_an_older_fcm_would_refuse_it(path):
    with netCDF4.Dataset(path) as file:
        assert file.layout == 2 and file.part.size == 8


def test_a_changed_part_is_refused(path, tmp_path):
    copy = tmp_path / "copy.nc"
    copy.write_bytes(path.read_bytes())
    with netCDF4.Dataset(copy, "r+") as file:
        file.part = np.array(file.part) + 1
    with pytest.raises(TableError, match="damaged"):
        open_table(copy)


def test_command_says_what_it_saved(fcm, tmp_path):
    done = fcm("tabulate", "--preset", "fast", "--for", SCENE, "--points", 10_000, "-o", "t.nc", "--json")
    assert done.code == 0
    for words in ("of 36482 nodes", "MB instead of", "computed in", "opens in", "wrote t.nc"):
        assert words in done.err
    part = json.loads(done.out)["part"]
    assert part["nodes"] < part["nodes_of_all"] and (tmp_path / "t.nc").stat().st_size < part["bytes_of_all"]
    assert fcm("tabulate", "--verify", "t.nc").code == 0
    done = fcm("respond", SCENE, "--table", "t.nc")
    assert done.code == 0 and "outside" not in done.err
    done = fcm("respond", "yang1998", "--table", "t.nc")
    assert done.code == 0 and "look-ups outside the part it holds" in done.err


STUCK = oscillator("[response]\nfrequency = [0.7, 1.7]\n", n_0=1e9, amplitude=1e-3)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--for", "none.toml"), "no such file"),
        (("--for", "stuck.toml"), "so it needs no table"),
        (("--for", "bad.toml"), "bad.toml"),
        (("--verify", "t.nc", "--for", SCENE), "--for is of no use with --verify"),
    ],
)
def test_wrong_input_is_one_clear_message(fcm, tmp_path, options, message):
    (tmp_path / "stuck.toml").write_text(STUCK)
    (tmp_path / "bad.toml").write_text("[modal]\n")
    done = fcm("tabulate", *options)
    assert done.code == 2, done.err
    assert message in done.err
    assert not (tmp_path / "table.nc").exists()
