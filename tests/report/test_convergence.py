"""Error against run time with more harmonics: the order found, the marks drawn, the table printed."""

import math

import pytest

from fcm.plot.style import save

from .convergence import as_text, convergence_order
from .convergence_picture import EXACT_ERROR, Balanced, Line, draw_convergence

HARMONICS = (1, 2, 3, 5, 9, 15)


def law(order, first=1.0):
    """Errors 0.1 h**-order; that of one harmonic alone is `first` times what the law says."""
    errors = [0.1 * h**-order * (first if h == 1 else 1.0) for h in HARMONICS]
    return [Balanced(h, error, 5.0 * h) for h, error in zip(HARMONICS, errors, strict=True)]


@pytest.mark.parametrize("order", [0.5, 2.0, 3.7])
@pytest.mark.parametrize("first", [1.0, 0.01])
def test_the_order_of_a_power_law_is_found_whatever_one_harmonic_does(order, first):
    assert convergence_order(law(order, first)) == pytest.approx(order, rel=1e-12)


def test_there_is_no_order_of_a_single_point_or_of_no_error():
    assert convergence_order(law(2.0)[:2]) is None
    assert convergence_order([Balanced(h, 0.0, 1.0) for h in HARMONICS]) is None


@pytest.fixture
def lines():
    table = Balanced(1, 0.1, 4.0)
    return [Line("first", law(2.0), table, 80.0, 2.0), Line("second", law(3.0)[:4], table, 90.0, None)]


def test_all_that_was_measured_is_drawn(lines, tmp_path):
    figure = draw_convergence(lines)
    (axes,) = figure.axes
    assert axes.get_xscale() == axes.get_yscale() == "log"
    drawn = [list(zip(*line.get_data(), strict=True)) for line in axes.lines]
    for line in lines:
        assert [(one.milliseconds, one.error) for one in line.balanced] in drawn
        assert [(line.exact, EXACT_ERROR)] in drawn
    assert drawn.count([(4.0, 0.1)]) == 2
    assert [text.get_text() for text in axes.texts] == [str(h) for h in HARMONICS]  # of the slowest line
    (legend,) = figure.legends
    names = [text.get_text() for text in legend.get_texts()]
    assert names[:2] == ["first, $p$ = 2.0", "second"] and len(names) == 5
    save(figure, tmp_path / "picture.png", dpi=50)
    assert (tmp_path / "picture.png").stat().st_size > 1000


def test_the_table_has_a_row_for_each_scene(lines):
    head, row = as_text(lines[:1])
    assert len(head) == len(row)
    cells = [cell for one in law(2.0) for cell in (f"{one.error:.1e}", f"{math.floor(one.milliseconds)}")]
    assert row.split() == ["first", *cells, "1.0e-01", "4", "80", "2.0"]
