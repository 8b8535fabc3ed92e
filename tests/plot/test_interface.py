"""Pictures of the contacts of a response, and what is read for them."""

import json
import re
from dataclasses import replace

import netCDF4
import numpy as np
import pytest

from fcm.plot import PlotError
from fcm.plot.interface import draw_interface, greatest_takers, points_of, read_interface, read_places
from fcm.plot.solutions import solutions_at

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


def test_a_panel_beside_the_frequency_asked_for_has_both_in_its_title(file):
    """A picture alone did not say that another frequency was asked for."""
    read = read_interface(file[0])
    (beside,) = points_of(read, (1.2,))
    row = draw_interface(read, [beside, *points_of(read, (beside.frequency,))])
    titles = [axes.get_title() for axes in row.axes[:2]]
    assert beside.frequency != 1.2 and "asked: 1.2 rad/s" in titles[0].split("\n")
    assert f"{beside.frequency:.6g} rad/s" in titles[0] and "asked" not in titles[1]


@pytest.mark.slow
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


@pytest.mark.slow
def test_bars_of_unlike_columns_have_a_logarithmic_axis(file):
    """Those of a small amplitude lay on the foot of the axis beside those of a great one."""
    read = read_interface(file[0])
    (one,) = points_of(read, (1.2,))
    loads = np.tile(np.arange(12.0), (3, 1))
    for factor, kind in ((0.01, "log"), (0.5, "linear"), (0.0, "linear")):
        small = replace(one, contact_loads=np.diag([factor, factor, 1.0]) @ loads)
        figure = draw_interface(read, [replace(one, contact_loads=loads), small])
        assert [axes.get_yscale() for axes in figure.axes[2:]] == [kind] * 4 + ["linear"] * 2
        low, high = figure.axes[3].get_ylim()
        assert low < max(factor, 0.5) and high > 11.0  # each that is not 0 has a bar
    far = replace(one, contact_loads=1e-9 * loads)
    figure = draw_interface(read, [replace(one, contact_loads=loads), far])
    assert figure.axes[2].get_ylim()[0] > 1e-2  # what is far below the greatest has none


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
    file.write_text("what is no place\n" * 40)
    with pytest.raises(PlotError) as raised:
        read_places(file, ("a", "b"))
    said = str(raised.value).splitlines()
    assert len(said) == 6 and said[-1].endswith("35 more of this kind")
    file.write_bytes(b"\xff\xfe a")
    with pytest.raises(PlotError, match="not a text"):
        read_places(file, ("a",))


def test_what_is_not_in_the_file_is_said(file):
    read = read_interface(file[0])
    with pytest.raises(PlotError, match=r"the curve goes from 0\.9 to 1\.5 rad/s"):
        points_of(read, (7.0,))
    with pytest.raises(PlotError, match="there is no curve 3"):
        points_of(read, (), 3)


@pytest.mark.slow
def test_the_command_writes_a_picture_and_lists_contacts(file, fcm):
    path = file[0]
    done = fcm("plot", "contacts", path, "--at", "1.2", "-o", path.with_suffix(".svg"))
    assert done.code == 0
    assert "contact" in done.err and "wrote" in done.err
    (point,) = points_of(read_interface(path), (1.2,))
    states = re.search(r"; (\d+) contacts? \((.*)\)", done.err)
    counts = [int(part.partition(": ")[2]) for part in states[2].split(", ")]
    assert sum(counts) == int(states[1]) == point.state.size
    assert (f"sticks: {np.count_nonzero(point.state == 0)}" in states[2]) == bool((point.state == 0).any())
    assert path.with_suffix(".svg").stat().st_size > 5000
    drawn = f"at 1.2: drawn is the nearest point of the file, at {point.frequency:.6g} rad/s. A smaller"
    assert drawn in done.err
    exact = fcm("plot", "contacts", path, "--at", repr(point.frequency), "-o", path.with_suffix(".svg"))
    assert exact.code == 0 and "nearest point" not in exact.err
    assert "nearest point" not in fcm("plot", "contacts", path, "-o", path.with_suffix(".svg")).err
    many = [word for _ in range(7) for word in ("--at", "1.2")]
    assert fcm("plot", "contacts", path, *many).code == 2


@pytest.mark.slow
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
        draw_interface(read, [one]).axes[0].get_title()
        for one in (unknown, replace(unknown, modal_amplitude=1.0))
    ]
    assert ["stability unknown" in one for one in said] == [True, False]  # a nonlinear mode has none
    done = fcm("plot", "contacts", output, "--curve", "0", "--curve", "2", "-o", tmp_path / "a.svg")
    swept = [re.search(rf"curve {k} \(.*= ([0-9.]+)\); 2", done.err) for k in (0, 2)]
    assert done.code == 0 and [one and one[1] for one in swept] == ["0.01", "20"]
    assert "(amplitude = 0.01); 2 contacts (sticks: 2): none takes energy" in done.err and "$" not in done.err
    lines = done.err.splitlines()
    heads, listed = (
        [k for k, line in enumerate(lines) if what in line] for what in ("curve 2 (", "slip path")
    )
    assert listed == [heads[0] + 1] and lines[heads[0]].endswith("those that take most energy:")
    few = [word for k in (0, 1, 2) for word in ("--curve", k)]
    many = [word for at in ("1.2", "1.3", "1.4") for word in ("--at", at)]
    assert "9 points by --at and --curve are too many" in fcm("plot", "contacts", output, *few, *many).err


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


def line_of(nodes, rows, tmp_path, **contact):
    """A response of node pairs at places, and what its file says of them."""
    (tmp_path / "pairs.csv").write_text("\n".join(["node,other,x,y,z", *rows]))
    (tmp_path / "model.toml").write_text(SCENE.format(**_dofs(nodes)))
    assert called("respond", tmp_path / "model.toml", "-o", tmp_path / "a.nc").code == 0
    return read_interface(tmp_path / "a.nc")


def test_contacts_on_a_line_are_bars_along_it_with_their_names(tmp_path):
    read = line_of(3, [f"{k + 1},,{120.0 + 10.0 * k},35.0,2.0" for k in range(3)], tmp_path)
    (point,) = points_of(read, ())
    figure = draw_interface(read, [point], read.places, read.axes)
    lowest = figure.axes[-1]
    assert lowest.get_xticks().tolist() == [120.0, 130.0, 140.0]
    assert [one.get_text() for one in lowest.get_xticklabels()] == [
        f"joint_{k + 1}\n{120 + 10 * k}" for k in range(3)
    ]
    assert lowest.get_xlabel() == "contact, at x"
    bars = sorted((one.get_x() + 0.5 * one.get_width(), one.get_height()) for one in lowest.patches)
    assert [at for at, _ in bars] == pytest.approx([120.0, 130.0, 140.0])
    assert [high for _, high in bars] == pytest.approx(point.contact_loads[2].tolist())
    assert figure.get_size_inches()[0] < 4.0  # one column of a journal
    given = draw_interface(read, [point], np.array([[0.0, 0.0], [3.0, 4.0], [6.0, 8.0]]))
    assert given.axes[-1].get_xlabel() == "contact, at 0.6 X + 0.8 Y"


@pytest.mark.slow
def test_names_that_find_no_room_give_way_to_coordinates(tmp_path):
    read = line_of(60, [f"{k + 1},,{float(k)},0.0,0.0" for k in range(60)], tmp_path)
    figure = draw_interface(read, points_of(read, ()), read.places, read.axes)
    figure.draw_without_rendering()
    assert figure.axes[-1].get_xlabel() == "x" and len(figure.axes[-1].get_xticks()) < 12
    row = draw_interface(read, points_of(read, ()))
    row.draw_without_rendering()
    ticks = row.axes[-1].get_xticks()
    assert row.axes[-1].get_xlabel() == "contact" and (ticks == np.round(ticks)).all()


def test_few_contacts_in_a_row_have_their_names(file):
    read = replace(read_interface(file[0]), contacts=("shroud", "platform"))
    (point,) = points_of(read, (1.2,))
    two = replace(point, state=point.state[:2], contact_loads=point.contact_loads[:, :2])
    axes = draw_interface(read, [two]).axes[-1]
    assert [one.get_text() for one in axes.get_xticklabels()] == ["shroud", "platform"]
    assert all(bar.get_width() < 0.2 * np.ptp(axes.get_xlim()) for bar in axes.patches)


def test_contacts_without_energy_and_slip_say_so_in_place_of_an_axis_of_nothing(file):
    """As those of stops without friction: the axes went from 0 to 1."""
    read = read_interface(file[0])
    (point,) = points_of(read, (1.2,))
    loads = np.stack((np.zeros(12), np.zeros(12), np.arange(12.0)))
    _, energy, slip, force = draw_interface(read, [replace(point, contact_loads=loads)]).axes
    for axes in (energy, slip):
        assert [one.get_text() for one in axes.texts] == ["none"] and axes.get_yticks().tolist() == [0.0]
    assert not force.texts and len(force.get_yticks()) > 1


def test_an_open_contact_and_one_without_a_value_have_marks_of_their_own(file):
    """Both were white circles."""
    read = read_interface(file[0])
    (point,) = points_of(read, (1.2,))
    loads = np.tile(np.arange(12.0), (3, 1))
    places = np.array([(i % 4, i // 4) for i in range(12)], dtype=float)
    opened = replace(point, state=np.full(12, 3), contact_loads=loads)
    figure = draw_interface(read, [opened], places)
    words = [one.get_text() for one in figure.legends[0].get_texts()]
    assert words[-2:] == ["open (12)", "none, or below the colours"]
    *_, ring, cross = figure.legends[0].legend_handles
    assert ring.get_marker() == "o" and cross.get_marker() == "x"
    (none, _) = figure.axes[1].collections
    assert none.get_offsets().tolist() == [[0.0, 0.0]]
    all_there = draw_interface(read, [replace(opened, contact_loads=1.0 + loads)], places)
    assert len(all_there.legends[0].get_texts()) == 4


def test_axes_are_the_coordinates_of_the_file(tmp_path):
    corners = [(100.0, 20.0), (130.0, 20.0), (130.0, 60.0), (100.0, 60.0)]
    read = line_of(4, [f"{k + 1},,{x},2.0,{z}" for k, (x, z) in enumerate(corners)], tmp_path)
    places = dict(zip(read.axes, read.places.T, strict=True))
    assert places["x"].tolist() == [x for x, _ in corners] and places["z"].tolist() == [z for _, z in corners]
    figure = draw_interface(read, points_of(read, ()), read.places, read.axes)
    assert {figure.get_supxlabel(), figure.get_supylabel()} == {"x", "z"}
    names = {one.get_text() for one in figure.axes[0].texts}
    assert names == {f"joint_{k}" for k in range(1, 5)}


def test_the_page_has_names_of_contacts_and_coordinates_at_its_axes(file, tmp_path):
    pytest.importorskip("plotly")
    from fcm.plot.interactive import contacts_page

    read = read_interface(file[0])
    points, places = points_of(read, (1.2,)), np.array([(i % 4, i // 4) for i in range(12)], dtype=float)
    contacts_page(read, points, places, tmp_path / "a.html", ("x", "z"))
    contacts_page(read, points, None, tmp_path / "b.html")
    plane, row = ((tmp_path / name).read_text(encoding="utf-8") for name in ("a.html", "b.html"))
    assert '"title":{"text":"x"}' in plane and '"title":{"text":"z"}' in plane
    names = ",".join(f'"{name}"' for name in read.contacts)
    assert f'"ticktext":[{names}]' in row
    assert ", asked: 1.2 rad" in row


@pytest.mark.slow
def test_of_a_nonlinear_mode_points_are_chosen_by_its_modal_amplitude(tmp_path):
    """Its frequency says little: that of a stiff joint moves by a percent over three decades."""
    path = tmp_path / "mode.nc"
    run = ("respond", "yang1998-n5", "--mode", 1, "--level", "0.1:100", "--harmonics", 1, "-o", path)
    assert called(*run).code == 0
    read = read_interface(path)
    with netCDF4.Dataset(path) as data:
        amplitude, energy = (np.asarray(data[name][0]) for name in ("modal_amplitude", "dissipated_energy"))
        frequency = np.asarray(data["frequency"][0])
    for one in (0.1, 3.0, 20.0, 100.0):
        (point,) = points_of(read, (), amplitude=(one,))
        (k,) = np.flatnonzero(amplitude == point.modal_amplitude)
        assert abs(np.log(amplitude[k] / one)) <= np.abs(np.diff(np.log(amplitude))).max()
        assert point.frequency == frequency[k] and point.contact_loads[0].tolist() == energy[k].tolist()
    with pytest.raises(PlotError, match=r"--amplitude 300: the curve goes from 0\.1 to 100$"):
        points_of(read, (), amplitude=(300.0,))
    with pytest.raises(PlotError, match=r"--at 20: .* rad/s; --amplitude takes modal amplitudes"):
        points_of(read, (20.0,))
    said = called("plot", "contacts", path, "--amplitude", 3, "--amplitude", 20, "-o", tmp_path / "a.png")
    assert said.code == 0 and said.err.count("modal amplitude ") == 2
    assert (
        f"at 3: drawn is the nearest point of the file, at {point_at(read, 3.0).modal_amplitude:.6g}. A"
        in said.err
    )
    figure = draw_interface(read, [point_at(read, 3.0)])
    assert "asked: 3" in figure.axes[0].get_title().split("\n")
    said = called("plot", "loop", path, "--amplitude", 20, "--json", "-o", tmp_path / "l.png")
    (loop,) = json.loads(said.out)["loops"]
    assert loop["frequency"] == point_at(read, 20.0).frequency
    both = ("--at", 1.2, "--amplitude", 20)
    assert all("both say where" in called("plot", one, path, *both).err for one in ("contacts", "loop"))


def point_at(read, amplitude):
    (found,) = points_of(read, (), amplitude=(amplitude,))
    return found


@pytest.mark.slow
def test_of_levels_points_are_chosen_by_the_level(tmp_path):
    """Their frequency is one, which told nothing."""
    path = tmp_path / "level.nc"
    run = ("respond", "yang1998-n5", "--level", "0:2", "--at", 1.2, "--harmonics", 1, "-o", path)
    assert called(*run).code == 0
    (point,) = points_of(read_interface(path), (1.5,))
    assert abs(point.frequency - 1.5) < 0.1
    assert (
        f"at level {point.frequency:.6g};"
        in called("plot", "contacts", path, "--at", 1.5, "-o", tmp_path / "a.png").err
    )


def test_the_list_has_units_and_places(file, tmp_path):
    read = replace(read_interface(file[0]), places=np.arange(24.0).reshape(12, 2))
    (top,) = points_of(read, (1.2,))
    for row in greatest_takers(read, top, 5):
        i = read.contacts.index(row[0])
        assert row[-1] == f"{2 * i}, {2 * i + 1}"


def test_solutions_are_the_nearer_ends_of_all_pieces_that_pass_a_place_greatest_first():
    along = np.array([1.0, 2.0, 3.0, 2.4, 1.6, 1.5, 2.6, np.nan, 5.0, np.nan, 2.0])
    amplitude = np.array([1.0, 2.0, 9.0, 5.0, 3.0, 3.5, 4.0, np.nan, 1.0, np.nan, 2.0])
    found = solutions_at(along, 2.1, amplitude)
    assert [(one.point, str(one)) for one in found] == [(3, "1 of 3"), (6, "2 of 3"), (1, "3 of 3")]
    assert solutions_at(along, 2.1, amplitude, 2) == found[1:2]
    (alone,) = solutions_at(along, 4.8, amplitude)  # beside a gap
    assert alone.point == 8 and str(alone) == ""
    with pytest.raises(PlotError, match=r"--solution 2: the curve has 1 solution at 5$"):
        solutions_at(along, 5.0, amplitude, 2)


def test_names_that_would_overlap_are_numbers(tmp_path):
    """Of twenty pairs in two rows the names ran into one another."""
    places = [(10.0 * k, y) for k in range(10) for y in (0.0, 20.0)]
    read = line_of(20, [f"{k + 1},,{x},2.0,{z}" for k, (x, z) in enumerate(places)], tmp_path)
    figure = draw_interface(read, points_of(read, ()), read.places, read.axes)
    assert [one.get_text() for one in figure.axes[0].texts] == [str(k) for k in range(1, 21)]


def test_numbers_that_would_overlap_are_left_out(tmp_path):
    """Ten pairs in the room of one, and one far off."""
    places = [(0.1 * k, 20.0 * (k % 2)) for k in range(10)] + [(100.0, 0.0)]
    read = line_of(11, [f"{k + 1},,{x},2.0,{z}" for k, (x, z) in enumerate(places)], tmp_path)
    figure = draw_interface(read, points_of(read, ()), read.places, read.axes)
    assert [one.get_text() for one in figure.axes[0].texts] == ["1", "2", "11"]
