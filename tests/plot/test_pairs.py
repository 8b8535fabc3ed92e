"""The picture of the pairs of nodes of a scene: what is drawn where."""

import numpy as np
import pytest
from tests.program import called
from tests.scene.test_node_sets import NORMAL, deck, places, read

from fcm.model.interface import Interface
from fcm.plot.errors import PlotError
from fcm.plot.pairs import draw_pairs, view_of


def alone(folder):
    """A scene of twelve pairs, with a node of either set that has no partner."""
    first, second = places(0.05)
    first = np.concatenate((first, [[-2.0, 5.0, 5.0]]))
    second = np.concatenate((second, [[9.0, 5.0, 5.0]]))
    return read(folder, text=deck(first, second))


def test_partners_are_joined_and_nodes_alone_are_crosses(tmp_path):
    (interface,) = alone(tmp_path).interfaces
    along = view_of(interface)
    assert np.abs(along @ NORMAL).max() < 1e-12
    figure = draw_pairs([interface], "mm")
    axes = figure.axes[0]
    ends = np.array([line.get_xydata() for line in axes.get_lines()])
    assert ends.shape == (12, 2, 2)
    assert np.abs(ends[:, 0] - ends[:, 1]).max() < 1e-12  # a gap along the normal is seen end on
    assert ends[:, 0] == pytest.approx(interface.first @ along.T)
    crosses = [one.get_label() for one in axes.collections if one.get_label().endswith("(1)")]
    assert crosses == ["LEFT, alone (1)", "RIGHT, alone (1)"]
    marks = axes.collections[0]
    assert np.asarray(marks.get_array()) == pytest.approx([0.05] * 12)
    assert axes.get_title() == "shroud: 12 pairs" and axes.get_xlabel() == "z (mm)"


def test_a_line_of_nodes_is_drawn_as_well():
    line = np.array([[float(k), 0.0, 0.0] for k in range(4)])
    interface = Interface("edge", line, line + np.array([0.0, 0.1, 0.0]), ("A", "B"))
    along = view_of(interface)
    assert along @ along.T == pytest.approx(np.eye(2))
    assert draw_pairs([interface]).axes


def test_coordinates_are_those_of_the_file():
    flat = np.array([[120.0 + 10.0 * i, 35.0 + 4.0 * j, 2.0] for i in range(3) for j in range(2)])
    axes = draw_pairs([Interface("lap", flat, flat + np.array([0.0, 0.0, 0.1]), ("A", "B"))], "mm").axes[0]
    assert np.asarray(axes.collections[0].get_offsets()).tolist() == flat[:, :2].tolist()
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("x (mm)", "y (mm)")
    bar = draw_pairs([Interface("lap", flat, flat + np.array([0.0, 0.0, 0.1]), ("A", "B"))], "mm").axes[1]
    assert bar.get_ylabel() == "Distance between the nodes of a pair (mm)"


def test_partners_that_touch_have_no_bar_and_axes_go_forward():
    first, _ = places(0.0)
    interface = Interface("lap", first, first.copy(), ("A", "B"))
    along = view_of(interface)
    assert (along[np.arange(2), np.abs(along).argmax(axis=1)] > 0.0).all()
    figure = draw_pairs([interface])
    assert len(figure.axes) == 1 and figure.axes[0].get_title() == "lap: 12 pairs of coincident nodes"
    apart = Interface("lap", first, first + np.array([0.0, 0.0, 0.02]), ("A", "B"))
    _, bar = draw_pairs([apart]).axes
    assert bar.get_ylim() == pytest.approx((0.0, 0.02))


def test_contacts_without_places_are_refused():
    with pytest.raises(PlotError, match="no contact has pairs with places"):
        draw_pairs([])


def test_the_command_draws_and_says_what_was_paired(tmp_path):
    alone(tmp_path)
    (tmp_path / "model.toml").write_text(
        """
        [modal]
        dofs = ["1x", "1y", "1z", "112x", "112y", "112z"]
        frequency = [1.0]
        damping = 0.1
        shapes = [[1.0, 0.5, 0.2, -1.0, -0.4, 0.1]]
        [response]
        frequency = [0.5, 1.5]
        [[force]]
        dof = "1x"
        amplitude = 1.0
        [[contact]]
        name = "joint"
        nodes = { sets = ["one.txt", "other.txt"], mesh = "two.inp", tolerance = 0.1 }
        normal = { x = 0.6, y = 0.8 }
        tangential = "fitted"
        mu = 0.3
        k_u = 1.0
        k_v = 1.0
        n_0 = 1.0
        """
    )
    (tmp_path / "one.txt").write_text("1")
    (tmp_path / "other.txt").write_text("112")
    done = called("plot", "pairs", tmp_path / "model.toml", "-o", tmp_path / "p.png")
    assert done.code == 0 and 'contact "joint": 1 pair, 0.05 apart' in done.err
    assert (tmp_path / "p.png").stat().st_size > 5000
    done = called("plot", "pairs", tmp_path / "model.toml", "--contact", "tip")
    assert done.code == 2 and "no contact of that name has pairs with places; there are joint" in done.err
    assert called("plot", "pairs", "yang1998", "-o", tmp_path / "q.png").code == 2
    (tmp_path / "other.txt").write_text("1")
    done = called("plot", "pairs", tmp_path / "model.toml", "-o", tmp_path / "q.png")
    assert done.code == 2 and "node 1 is in both sets" in done.err
