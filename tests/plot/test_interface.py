"""Pictures of the contacts of a response, and what is read for them."""

import re
from dataclasses import replace

import netCDF4
import numpy as np
import pytest

from fcm.plot import PlotError
from fcm.plot.interface import draw_interface, greatest_takers, points_of, read_interface, read_places

from ..harmonic_balance.strips import strip
from ..program import called

SCENE = """modal = {{ dofs = {dofs}, frequency = [1.0], damping = [0.05], shapes = [{shapes}] }}
response = {{ frequency = [1.0, 3.0], harmonics = 1 }}
force = [{{ dof = "1x", amplitude = 0.01 }}]
[[contact]]
name = "joint"
nodes = "pairs.csv"
tangential = "x"
normal = "z"
mu = 0.3
k_u = 0.1
k_v = 0.1
n_0 = 5.0
"""


def _dofs(nodes):
    names = [f"{node}{axis}" for node in range(1, nodes + 1) for axis in "xz"]
    return {"dofs": names, "shapes": [1.0 + 0.1 * k for k in range(len(names))]}


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    """A response of twelve contacts, and the dataset that was written."""
    from fcm.response import respond

    path = tmp_path_factory.mktemp("interface") / "strip.nc"
    dataset = respond(strip(), harmonics=1)
    dataset.to_netcdf(path)
    return path, dataset


@pytest.mark.slow
def test_states_are_those_of_the_loops(file):
    path, dataset = file
    read = read_interface(path)
    (top,) = points_of(read, ())
    amplitude = dataset.amplitude.values[0]
    k = int(np.nanargmax(np.nanmax(np.nan_to_num(amplitude, nan=-1.0), axis=1)))
    assert top.frequency == dataset.frequency.values[0, k]
    assert np.array_equal(top.contact_loads[0], dataset.dissipated_energy.values[0, k])


def test_each_state_is_what_the_letters_of_the_loop_say(file):
    path, dataset = file
    read, seen = read_interface(path), set()
    omega = dataset.frequency.values[0]
    for at in (0.91, 1.05, 1.2, 1.35, 1.49):
        (point,) = points_of(read, (at,))
        (k,) = np.flatnonzero(omega == point.frequency)[:1]
        for word, state in zip(dataset.regime.values[0, k], point.state, strict=True):
            letters = set(str(word))
            seen.add(state)
            if state == 3:
                assert letters == {"S"}
            elif state == 2:
                assert "S" in letters and letters > {"S"}
            else:
                assert "S" not in letters and (letters == {"E"}) == (state == 0)
    assert len(seen) > 1


def test_the_contacts_that_take_most_are_listed_first(file):
    read = read_interface(file[0])
    (top,) = points_of(read, (1.2,))
    rows = greatest_takers(read, top, 5)
    energy = [float(row[2]) for row in rows]
    assert energy == sorted(energy, reverse=True)
    assert energy[0] == pytest.approx(np.nanmax(top.contact_loads[0]), rel=1e-3)
    assert sum(float(row[3].split()[0]) for row in greatest_takers(read, top, 12)) == pytest.approx(
        100, abs=1
    )


def test_a_column_for_each_frequency_and_marks_at_the_places(file):
    read = read_interface(file[0])
    points = points_of(read, (1.0, 1.2))
    assert [abs(one.frequency - at) < 0.05 for one, at in zip(points, (1.0, 1.2), strict=True)] == [
        True,
        True,
    ]
    row = draw_interface(read, points)
    assert len(row.axes) == 8
    places = np.array([(i % 4, i // 4) for i in range(12)], dtype=float)
    drawn = draw_interface(read, points, places)
    panels = [axes for axes in drawn.axes if axes.get_label() != "<colorbar>"]
    assert len(panels) == 8
    for axes in panels:
        marks = np.vstack([one.get_offsets() for one in axes.collections])
        assert sorted(map(tuple, np.asarray(marks).tolist())) == sorted(map(tuple, places.tolist()))
        assert axes.get_xlim()[0] < 0.0 and axes.get_ylim()[1] > 2.0


def test_columns_of_unlike_size_are_told_by_a_logarithm_and_bars_are_in_line(file):
    """Values of the second column a hundredth: on a linear scale they would all be of one colour."""
    read = read_interface(file[0])
    (one,) = points_of(read, (1.2,))
    loads = np.tile(np.arange(12.0), (3, 1))
    places = np.array([(i % 4, i // 4) for i in range(12)], dtype=float)
    points = [replace(one, contact_loads=loads), replace(one, contact_loads=0.01 * loads)]
    figure = draw_interface(read, points, places)
    figure.draw_without_rendering()
    marks = [axes.collections for axes in figure.axes[2:8]]
    assert [len(none.get_offsets()) for none, _ in marks] == [1] * 6  # what is 0 is white
    for _, small in marks[1::2]:
        assert len(np.unique(small.get_facecolors(), axis=0)) == 11
    bars = [axes.child_axes[0].get_window_extent() for axes in figure.axes[3:8:2]]
    for bar, axes in zip(bars, figure.axes[3:8:2], strict=True):
        assert bar.x0 == pytest.approx(bars[0].x0) and bar.width == pytest.approx(bars[0].width)
        assert bar.height == pytest.approx(axes.get_window_extent().height)
    alike = draw_interface(read, points[:1], places)
    (_, linear) = alike.axes[1].collections
    assert (linear.norm.vmin, linear.norm.vmax) == (0.0, 11.0)


def test_places_that_do_not_fit_are_all_said_at_once(tmp_path):
    file = tmp_path / "places.txt"
    file.write_text("a 0 0\nb, 1.5, 2e-3  # a remark\n\n")
    assert read_places(file, ("a", "b")).tolist() == [[0.0, 0.0], [1.5, 2e-3]]
    with pytest.raises(PlotError, match="no line for c"):
        read_places(file, ("a", "b", "c"))
    file.write_text("a 0\nd 1 2\na 0 0\na 1 1\nb 1 nan\n")
    with pytest.raises(PlotError) as raised:
        read_places(file, ("a", "b"))
    said = str(raised.value).splitlines()
    assert [one.partition("line ")[2][0] for one in said] == ["1", "2", "4", "5"]
    file.write_bytes(b"\xff\xfe a")
    with pytest.raises(PlotError, match="not a text"):
        read_places(file, ("a",))


def test_what_is_not_in_the_file_is_said(file):
    read = read_interface(file[0])
    with pytest.raises(PlotError, match=r"the curve goes from 0\.9 to 1\.5 rad/s"):
        points_of(read, (7.0,))
    with pytest.raises(PlotError, match="there is no curve 3"):
        points_of(read, (), 3)


def test_the_command_writes_a_picture_and_lists_contacts(file, fcm):
    path = file[0]
    done = fcm("plot", "contacts", path, "--at", "1.2", "-o", path.with_suffix(".svg"))
    assert done.code == 0
    assert "contact" in done.err and "wrote" in done.err and path.with_suffix(".svg").stat().st_size > 5000
    many = [word for _ in range(7) for word in ("--at", "1.2")]
    assert fcm("plot", "contacts", path, *many).code == 2


def test_curves_of_a_sweep_are_columns_each_at_its_own_peak(tmp_path, fcm):
    scene = SCENE + '[sweep]\n"force.1x.amplitude" = [0.01, 5.0, 20.0]\n'
    (tmp_path / "pairs.csv").write_text("node,other\n1,\n2,\n")
    (tmp_path / "model.toml").write_text(scene.format(**_dofs(2)))
    output = tmp_path / "a.nc"
    assert fcm("respond", tmp_path / "model.toml", "-o", output).code == 0
    read = read_interface(output)
    points = [point for curve in (0, 2) for (point,) in [points_of(read, (), curve)]]
    with netCDF4.Dataset(output) as data:
        tops = [float(np.max(data["amplitude"][k])) for k in (0, 2)]
        at = []
        for k, top in zip((0, 2), tops, strict=True):
            at.append(data["frequency"][k][np.any(data["amplitude"][k] == top, axis=1)])
    assert [one.frequency for one in points] == [float(one[0]) for one in at]
    assert points[0].contact_loads[0].sum() == 0.0 < points[1].contact_loads[0].sum()  # the first sticks
    figure = draw_interface(read, points)
    heads = [axes.get_title() for axes in figure.axes[:2]]
    assert "0.01" in heads[0] and "20" in heads[1]
    unknown = replace(points[0], stable=np.nan)
    said = [
        draw_interface(read, [one]).axes[0].get_title() for one in (unknown, replace(unknown, forced=False))
    ]
    assert ["stability unknown" in one for one in said] == [True, False]  # a nonlinear mode has none
    done = fcm("plot", "contacts", output, "--curve", "0", "--curve", "2", "-o", tmp_path / "a.svg")
    swept = [re.search(rf"curve {k} \(.*= ([0-9.]+)\); 2", done.err) for k in (0, 2)]
    assert done.code == 0 and [one and one[1] for one in swept] == ["0.01", "20"]
    assert "(amplitude = 0.01); 2 contacts: none takes energy" in done.err and "$" not in done.err
    few = [word for k in (0, 1, 2) for word in ("--curve", k)]
    many = [word for at in ("1.2", "1.3", "1.4") for word in ("--at", at)]
    assert "ask for 9 points" in fcm("plot", "contacts", output, *few, *many).err


def test_contacts_of_node_pairs_are_drawn_where_they_are(tmp_path):
    """Coordinates of the scene's file of pairs, seen in the plane of the contacts: distances are kept."""
    corners = np.array([[0.0, 0.0, 2.0], [3.0, 0.0, 2.0], [3.0, 4.0, 2.0], [0.0, 1.0, 2.0]])
    rows = [f"{k + 1},,{x},{y},{z}" for k, (x, y, z) in enumerate(corners)]
    (tmp_path / "pairs.csv").write_text("\n".join(["node,other,x,y,z", *rows]))
    scene = SCENE.format(**_dofs(4))
    (tmp_path / "model.toml").write_text(scene)
    output = tmp_path / "a.nc"
    assert called("respond", tmp_path / "model.toml", "-o", output).code == 0
    read = read_interface(output)
    assert read.contacts == tuple(f"joint_{k}" for k in range(1, 5))
    between = np.linalg.norm(read.places[:, None] - read.places, axis=2)
    assert between == pytest.approx(np.linalg.norm(corners[:, None] - corners, axis=2))
    with netCDF4.Dataset(output) as data:
        assert np.array_equal(data["contact_position"][:], corners)
