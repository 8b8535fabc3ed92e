"""Surfaces, contours, errors and figure 12: what is drawn, its labels and units; no pixels."""

import math
from itertools import combinations

import numpy as np
import pytest
from matplotlib.text import Text

import fcm
from fcm.contact.surface import ParameterPlane, boundaries, edges, regions, surface
from fcm.plot.normal import draw_normal
from fcm.plot.plane import BOUNDARIES, phase_name
from fcm.plot.surface import draw_contours, draw_surfaces
from fcm.plot.table_error import RANGE, draw_errors
from fcm.table.error_map import ErrorMap

FIFTEEN, THIRTY = (ParameterPlane(math.radians(degrees)) for degrees in (15.0, 30.0))
SMALL = (50, 20)


def panels(figure):
    """The axes with a title; colour bars have none."""
    return [axes for axes in figure.axes if axes.get_title()]


def in_space(*planes, coefficients=("F_c",)):
    return draw_surfaces([surface(name, plane, SMALL) for name in coefficients for plane in planes])


def flat(*planes, coefficient="F_c"):
    return draw_contours([surface(coefficient, p) for p in planes], [regions(p) for p in planes])


def boundary_lines(axes):
    return {
        name: line
        for line in axes.lines
        for name, (label, _) in BOUNDARIES.items()
        if line.get_label() == label
    }


def overlapping(figure):
    """Pairs of texts of a picture whose boxes overlap by more than the air around their letters."""
    figure.draw_without_rendering()
    texts = [text for text in figure.findobj(Text) if text.get_visible() and text.get_text().strip()]
    boxes = [(text, text.get_window_extent().padded(-2)) for text in texts]
    return [(a.get_text(), b.get_text()) for (a, x), (b, y) in combinations(boxes, 2) if x.overlaps(y)]


def test_figure_11_has_a_surface_for_each_phase():
    figure = in_space(FIFTEEN, THIRTY)
    assert [axes.get_title() for axes in panels(figure)] == [
        "(a) $F_c$, $\\phi$ = 15°",
        "(b) $F_c$, $\\phi$ = 30°",
    ]
    for axes in figure.axes:
        assert axes.name == "3d" and len(axes.collections) == 1
        assert axes.get_xlabel() == "$\\bar{n}_0$ (–)" and axes.get_ylabel() == "$\\bar{b}$ (–)"
        assert axes.get_zlabel() == "Damping $F_c$ (–)"


def test_figure_10_has_stiffness_and_damping():
    figure = in_space(ParameterPlane(), coefficients=("F_s", "F_c"))
    assert [axes.get_zlabel() for axes in figure.axes] == ["Stiffness $F_s$ (–)", "Damping $F_c$ (–)"]
    assert figure.axes[0].get_zlim() == pytest.approx((0.0, 1.0))
    assert figure.axes[1].get_zlim() == pytest.approx((0.0, 1.0 / np.pi))  # of constant load


def test_surfaces_of_one_coefficient_have_one_scale():
    first, second = in_space(FIFTEEN, THIRTY).axes
    assert first.get_zlim() == second.get_zlim()
    assert first.collections[0].get_clim() == second.collections[0].get_clim()


@pytest.mark.slow
@pytest.mark.parametrize(
    "plane", [ParameterPlane(), THIRTY, ParameterPlane(math.radians(100.0), (-3.0, 5.0), (0.5, 4.0))]
)
def test_contours_show_the_regimes_where_they_are(plane):
    (axes,) = panels(flat(plane))
    assert axes.get_xlim() == plane.n0_range and axes.get_ylim() == plane.b_range
    lines = boundary_lines(axes)
    assert set(lines) == {"open", "separation", "slip"}
    for name, line in lines.items():
        n0, b = line.get_data()
        assert (b[0], b[-1]) == plane.b_range
        np.testing.assert_array_equal(n0, boundaries(b, plane.phi)[name])


@pytest.mark.slow
def test_contours_carry_symbols_and_units():
    figure = flat(FIFTEEN, THIRTY)
    left, right = panels(figure)
    assert left.get_ylabel() == "Load variation $\\bar{b} = \\mu k_v b / k_u a$ (–)"
    assert right.get_ylabel() == ""
    assert {axes.get_xlabel() for axes in (left, right)} == {"Preload $\\bar{n}_0 = \\mu n_0 / k_u a$ (–)"}
    bars = [axes.get_ylabel() for axes in figure.axes if axes not in (left, right)]
    assert bars == ["Damping $F_c$ (–)"] * 2
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == [label for label, _ in BOUNDARIES.values()]


def test_each_name_is_in_its_region():
    (axes,) = panels(flat(THIRTY))
    named = {text.get_text(): text.get_position() for text in axes.texts}
    assert {"S", "E", "EPEN", "SEP", "SP"} <= set(named)
    for name, (n0, b) in named.items():
        assert fcm.hysteresis_loop(n0, b, THIRTY.phi).sequence == name


def test_a_plane_without_anything_to_see_is_drawn():
    """All of it sticks, with k_u a of force in phase and none in quadrature."""
    for phi in (0.0, 1.0):
        plane = ParameterPlane(phi, (50.0, 60.0), (0.0, 1.0))
        (axes,) = panels(draw_contours([surface("F_c", plane)], [regions(plane)]))
        assert [text.get_text() for text in axes.texts] == ["E"]
        (axes,) = panels(draw_surfaces([surface("F_s", plane, SMALL)]))
        low, high = axes.get_zlim()
        assert low < high and low - 1e-9 <= 1.0 <= high + 1e-9


@pytest.mark.slow
@pytest.mark.parametrize("count", [1, 2, 3])
def test_nothing_overlaps(count):
    planes = [ParameterPlane(phi) for phi in (0.0, 0.5, math.pi)][:count]
    assert overlapping(flat(*planes)) == []
    assert overlapping(flat(*planes, coefficient="F_b")) == []
    assert overlapping(draw_errors([an_error(plane) for plane in planes], "Error of a table")) == []


def an_error(plane=THIRTY, error=None):
    n0, b = plane.nodes(SMALL)
    error = np.full((20, 50), 1e-5) if error is None else error
    return ErrorMap("F_s", plane, n0, b, error, edges(plane), (-1.2345, 1.9876), 3.21e-5)


def test_errors_are_drawn_in_a_fixed_range():
    error = np.zeros((20, 50))
    error[3, 4] = 1e-5
    figure = draw_errors([an_error(error=error), an_error(FIFTEEN)])
    for axes in panels(figure):
        (mesh,) = axes.collections
        assert mesh.get_clim() == RANGE
    shown = panels(figure)[0].collections[0].get_array()
    assert shown[3, 4] == pytest.approx(-5.0) and shown[0, 0] < RANGE[0] and np.isfinite(shown).all()
    (bar,) = (axes for axes in figure.axes if axes not in panels(figure))
    assert bar.get_ylabel() == "$\\log_{10}\\,|F_{\\mathrm{table}} - F_{\\mathrm{exact}}|$ (–)"


def test_the_worst_point_is_marked_and_named():
    (axes,) = panels(draw_errors([an_error()], "Error of $a.nc"))
    (mark,) = (line for line in axes.lines if line.get_label() == "worst")
    assert (mark.get_xdata()[0], mark.get_ydata()[0]) == (-1.2345, 1.9876)
    assert axes.get_title() == (
        "$F_s$, $\\phi$ = 30°\nworst $3.2 \\times 10^{-5}$ at $\\bar{n}_0$ = −1.23, $\\bar{b}$ = 1.99"
    )


def test_figure_12():
    n0_star = np.linspace(-2.0, 2.0, 401)
    (axes,) = draw_normal(n0_star, *fcm.normal_coefficients(n0_star)).axes
    mean, stiffness = (line for line in axes.lines if not line.get_label().startswith("_"))
    assert (mean.get_linestyle(), stiffness.get_linestyle()) == ("-", "--")  # as in the paper
    assert [line.get_label() for line in (mean, stiffness)] == ["mean $N_b$", "stiffness $N_s$"]
    at = {x: int(np.argmin(np.abs(n0_star - x))) for x in (-2.0, -1.0, 0.0, 1.0, 2.0)}
    N_b, N_s = mean.get_ydata(), stiffness.get_ydata()
    assert [N_b[i] for i in at.values()] == pytest.approx([0.0, 0.0, 1.0 / np.pi, 1.0, 2.0], abs=1e-12)
    assert [N_s[i] for i in at.values()] == pytest.approx([0.0, 0.0, 0.5, 1.0, 1.0], abs=1e-12)
    assert axes.get_xlabel() == "Preload $n_0^* = n_0 / k_v b$ (–)"
    assert axes.get_ylabel() == "Coefficients of the normal load $N_b$, $N_s$ (–)"


@pytest.mark.parametrize(
    ("phi", "name"),
    [
        (0.0, "0°"),
        (math.pi / 2, "90°"),
        (-math.pi / 4, "−45°"),
        (math.radians(22.5), "22.5°"),
        (1.0, "1 rad"),
    ],
)
def test_phases_are_named_in_the_shorter_way(phi, name):
    assert phase_name(phi) == f"$\\phi$ = {name}"
