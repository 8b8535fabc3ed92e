"""The loop of a contact in its plane: what is drawn where; no pixels."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from matplotlib.patches import Circle

import fcm
from fcm.plot.loop import STATES
from fcm.plot.planar_loop import SLIDER, DrawnPlanarLoop, draw_planar_loop, path_of

MOTION = [0.1, 1.0], [0.0, -0.4j], [0.0, 0.8j]
LOOP = fcm.planar_loop(*MOTION, mu=0.5, k_u=2.0, k_v=1.0, n_0=0.7)


@pytest.fixture(scope="module")
def figure():
    return draw_planar_loop(DrawnPlanarLoop(LOOP, "pad", ("ax - bx", "ay $ by"), ("mm", "N")))


def lines(axes, colour):
    """Those of a colour that are paths and not marks."""
    found = [line for line in axes.lines if to_rgb(line.get_color()) == to_rgb(colour)]
    return [line for line in found if len(line.get_xdata()) > 2]


def test_each_state_has_its_part_of_the_path(figure):
    plane = figure.axes[0]
    for state in set(LOOP.sequence):
        (line,) = lines(plane, STATES[state][1]["color"])
        x, y = np.array(line.get_xdata()), np.array(line.get_ydata())
        there = np.isfinite(x)
        path = path_of(LOOP)
        assert there.sum() >= (path.states == state).sum()
        assert np.hypot(x[there] - 0.1, y[there] / 0.4).max() == pytest.approx(1.0, abs=1e-3)


def test_the_discs_are_where_the_contact_is_and_hold_the_slider(figure):
    plane = figure.axes[0]
    discs = [patch for patch in plane.patches if isinstance(patch, Circle)]
    assert len(discs) == 4
    angles = [float(text.get_text().removesuffix("°")) for text in plane.texts]
    assert angles == [0.0, 90.0, 180.0, 270.0]
    for disc, angle in zip(discs, np.radians(angles), strict=True):
        assert disc.center == pytest.approx(LOOP.displacement(angle), abs=1e-9)
        assert disc.radius == pytest.approx(LOOP.slip_limit(angle) / 2.0, abs=1e-9)
        assert np.hypot(*(LOOP.slider(angle) - disc.center)) <= disc.radius + 1e-9


def test_no_angle_is_written_on_the_paths(figure):
    figure.draw_without_rendering()
    plane, path = figure.axes[0], path_of(LOOP)
    for text in plane.texts:
        box = text.get_window_extent()
        for at in plane.transData.transform(np.concatenate((path.u, path.w))):
            assert not (box.x0 < at[0] < box.x1 and box.y0 < at[1] < box.y1), text.get_text()


def test_displacements_of_both_directions_have_one_power_of_ten():
    """Alone the direction up to 0.011 mm would have none, and that of 0.004 mm a thousandth."""
    loop = fcm.planar_loop([0.0, 0.011], [0.0, -0.004j], [0.0, 0.0], mu=0.5, k_u=2.0, k_v=0.0, n_0=0.002)
    drawn = draw_planar_loop(DrawnPlanarLoop(loop, "pad", ("ax", "ay"), ("mm", "N")))
    plane, along_x, along_y, _ = drawn.axes
    labels = [plane.get_xlabel(), plane.get_ylabel(), along_x.get_xlabel(), along_y.get_xlabel()]
    assert all("10^{-3}$ mm" in label for label in labels), labels


def test_the_slider_is_not_drawn_while_the_contact_is_open(figure):
    (line,) = lines(figure.axes[0], SLIDER)
    path = path_of(LOOP)
    drawn = np.isfinite(np.array(line.get_xdata()))
    assert (drawn == (path.states != "S")).all()


def test_both_hysteresis_loops_and_the_names_of_the_directions(figure):
    plane, above, below, _ = figure.axes
    path = path_of(LOOP)
    for axes, i in ((above, 0), (below, 1)):
        shown = np.concatenate(
            [np.array(line.get_ydata()) for line in axes.lines if len(line.get_xdata()) > 2]
        )
        assert np.nanmax(shown) == pytest.approx(path.f[:, i].max())
        assert np.nanmin(shown) == pytest.approx(path.f[:, i].min())
    assert plane.get_xlabel() == "Displacement $u_x$ = ax - bx (mm)"
    assert plane.get_ylabel() == r"Displacement $u_y$ = ay \$ by (mm)"
    assert [above.get_xlabel(), below.get_xlabel()] == [plane.get_xlabel(), plane.get_ylabel()]
    assert above.get_ylabel() == "$f_x$ (N)"


@pytest.mark.slow
def test_the_force_stays_within_its_limits_and_reaches_them_where_it_slips(figure):
    forces, path = figure.axes[3], path_of(LOOP)
    radii = sorted(patch.radius for patch in forces.patches if isinstance(patch, Circle))
    limit = [LOOP.slip_limit(angle) for angle in np.linspace(0.0, 2.0 * np.pi, 2001)]
    assert radii == pytest.approx([min(limit), max(limit)], rel=1e-4, abs=1e-9)
    assert forces.get_xlabel() == "$f_x$ (N)" and forces.get_aspect() == 1.0
    (slip,) = lines(forces, STATES["P"][1]["color"])
    x, y = (np.array(one) for one in slip.get_data())
    there = np.isfinite(x) & (path.states == "P")
    assert there.any() and np.hypot(x, y)[there] == pytest.approx(2.0 * path.radius[there])
    assert np.abs(np.hypot(*path.f.T)).max() <= radii[1] * (1.0 + 1e-9)
    constant = fcm.planar_loop([0.1, 1.0], [0.0, -0.4j], [0.0, 0.0], mu=0.5, k_u=2.0, k_v=1.0, n_0=0.7)
    (circle,) = draw_planar_loop(DrawnPlanarLoop(constant, "pad")).axes[3].patches
    assert circle.radius == pytest.approx(0.35)


def test_without_tangential_stiffness_there_is_no_disc_and_no_force():
    loop = fcm.planar_loop(*MOTION, mu=0.5, k_u=0.0, k_v=1.0, n_0=0.7)
    plane, above, below, _ = draw_planar_loop(DrawnPlanarLoop(loop, "pad")).axes
    assert all(patch.radius == 0.0 for patch in plane.patches if isinstance(patch, Circle))
    for axes in (above, below):
        shown = [np.array(line.get_ydata()) for line in axes.lines if len(line.get_xdata()) > 2]
        assert shown and np.nanmax(np.abs(shown)) == 0.0


def test_without_dimensions_the_axes_say_by_what_they_are_divided():
    plane, above, *_ = draw_planar_loop(DrawnPlanarLoop(LOOP, "pad", dimensionless=True)).axes
    assert plane.get_xlabel() == "Displacement $u_x$$/a$ = x$/a$"
    assert above.get_ylabel() == "$f_x$$/(k_u a)$"


def test_the_work_of_both_loops_is_the_dissipation():
    """What is drawn: the areas of the two loops together."""
    path = path_of(LOOP)
    area = sum(np.trapezoid(path.f[:, i], path.u[:, i]) for i in range(2))
    assert area == pytest.approx(LOOP.dissipation, rel=1e-4)


def test_a_direction_in_which_there_is_rounding_alone_is_drawn_as_at_rest():
    """Its loop was that of the rounding, at full size: of a joint a hundred thousandth of a millionth."""
    for small in (1e-18, 1e-11):
        y = [small / 10, 3j * small]
        loop = fcm.planar_loop([0.1, 1.0], y, [0.0, 0.2j], mu=0.5, k_u=2.0, k_v=1.0, n_0=0.7)
        path = path_of(loop)
        assert np.ptp(path.f[:, 0]) > 0.5 and not path.f[:, 1].any() and not path.u[:, 1].any()
        _, x, y, _ = draw_planar_loop(DrawnPlanarLoop(loop, "pad")).axes
        assert [one.get_text() for one in y.texts] == ["no motion"] and not x.texts
        assert y.get_xlim() == x.get_xlim() and y.get_ylim() == x.get_ylim()
    some = path_of(fcm.planar_loop([0.1, 1.0], [0.0, 3e-6j], [0.0, 0.2j], mu=0.5, k_u=2.0, k_v=1.0, n_0=0.7))
    assert some.f[:, 1].any() and some.u[:, 1].any()


def test_powers_of_ten_are_in_the_labels_and_not_on_them():
    """Of displacements in m that are some micrometres: labels and numbers together say where a tick is."""
    small = fcm.planar_loop([1e-7, 2e-6], [0.0, -1.5e-6j], [0.0, 8e-7j], mu=0.5, k_u=2.0, k_v=1.0, n_0=7e-7)
    figure = draw_planar_loop(DrawnPlanarLoop(small, "pad", ("x", "y"), ("m", "N")))
    figure.draw_without_rendering()
    plane = figure.axes[0]
    assert plane.get_xlabel() == "Displacement $u_x$ = x ($10^{-6}$ m)"
    assert not plane.xaxis.get_offset_text().get_visible()
    numbers = [float(text.get_text().strip("$").replace("−", "-").removeprefix("\\mathdefault{").rstrip("}"))
               for text in plane.get_xticklabels()]  # fmt: skip
    assert numbers == pytest.approx((1e6 * plane.get_xticks()).tolist())


def test_the_labels_stay_within_the_picture():
    """That of a leaning direction ran out of it at both ends."""
    long = "-0.866025 112y - 0.5 112z + 0.866025 900y + 0.5 900z"
    figure = draw_planar_loop(DrawnPlanarLoop(LOOP, "pad", (long, long), ("mm", "N")))
    figure.draw_without_rendering()
    whole = figure.bbox
    for axes in figure.axes:
        for label in (axes.xaxis.label, axes.yaxis.label):
            box = label.get_window_extent()
            assert whole.x0 <= box.x0 and box.x1 <= whole.x1 and whole.y0 <= box.y0 and box.y1 <= whole.y1
