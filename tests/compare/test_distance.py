"""Distance of curves: against brute force, on a curve that folds, and indifferent to units."""

import numpy as np
import pytest

from fcm.compare.distance import Shape, of_curve, of_points, resolution, size_of
from fcm.compare.lines import Line


def folded(count, shift=0.0, scale=1.0, part=1.0):
    """A line with two folds: ln omega = 0.3 sin(s) + 0.05 s, amplitude growing with s."""
    s = np.linspace(0.0, 7.0 * part, count)
    omega = np.exp(0.3 * np.sin(s) + 0.05 * s + shift)
    amplitude = scale * np.column_stack((s / 7.0, 0.5 + s / 14.0))
    return Line(omega, amplitude, {}, (), True)


def brute(points, count=200_000):
    """Least distance of each point from the same curve, sampled very finely."""
    fine = folded(count)
    chain = np.column_stack((np.log(fine.frequency), fine.amplitude / np.sqrt(2.0)))
    return np.array([np.sqrt(((chain - p) ** 2).sum(axis=1)).min() for p in points])


ONE = np.ones(2)


@pytest.mark.parametrize("shift", [1e-4, 1e-2, 0.1])
def test_distance_of_points_is_that_of_brute_force(shift):
    reference, moved = Shape(folded(800), ONE, smooth=True), Shape(folded(40, shift), ONE, smooth=False)
    assert reference.from_(moved.points) == pytest.approx(brute(moved.points), rel=1e-3, abs=6e-7)


def test_a_shift_of_frequency_is_its_relative_size_where_the_curve_is_steep():
    reference, moved = Shape(folded(800), ONE, smooth=True), Shape(folded(800, 1e-3), ONE, smooth=False)
    assert of_points(moved, reference) == pytest.approx(1e-3, rel=1e-2)


def test_a_missing_part_is_an_error_of_the_curve_and_not_of_its_points():
    reference, short = Shape(folded(800), ONE, smooth=True), Shape(folded(400, part=0.5), ONE, smooth=False)
    whole, half = folded(800), folded(400, part=0.5)
    there = np.column_stack((np.log(half.frequency), half.amplitude / np.sqrt(2.0)))
    end = np.append(np.log(whole.frequency[-1]), whole.amplitude[-1] / np.sqrt(2.0))
    assert of_points(short, reference) < 1e-6
    assert of_curve(short, reference) >= 0.99 * np.sqrt(((there - end) ** 2).sum(axis=1)).min()


def test_units_do_not_matter():
    errors = []
    for unit, hertz in ((1.0, 1.0), (1e-12, 2.0 * np.pi)):

        def units(line):
            return Line(line.frequency * hertz, line.amplitude * unit, {}, (), True)  # noqa: B023

        whole = units(folded(300))
        size = size_of(whole)
        errors.append(
            of_curve(Shape(units(folded(30, 0.01)), size, smooth=False), Shape(whole, size, smooth=True))
        )
    assert errors[0] == pytest.approx(errors[1], rel=1e-6)


def test_straight_lines_between_points_err_by_the_square_of_their_length():
    reference = Shape(folded(2000), ONE, smooth=True)
    coarse, fine = (of_curve(Shape(folded(n), ONE, smooth=False), reference) for n in (41, 161))
    assert 12.0 < coarse / fine < 20.0


@pytest.mark.parametrize("count", [30, 100, 300])
def test_the_resolution_is_a_bound_on_a_smooth_curve(count):
    true = folded(40_001)
    points = np.column_stack((np.log(true.frequency), true.amplitude / np.sqrt(2.0)))
    missed = Shape(folded(count), ONE, smooth=True).from_(points[::7]).max()
    assert 0.05 * resolution(folded(count), ONE) < missed < resolution(folded(count), ONE)


def test_branches_are_not_joined():
    """A point in the gap between two branches is as far away as their ends are."""
    gap = np.array([1.0, 1.1, np.nan, 2.0, 2.1])
    line = Line(gap, np.where(np.isnan(gap), np.nan, 1.0)[:, None], {}, (), True)
    shape = Shape(line, np.ones(1), smooth=False)
    assert shape.from_(np.array([[np.log(1.5), 1.0]])) == pytest.approx([np.log(2.0 / 1.5)])
    assert len(line.branches()) == 2 and line.points == 4


def test_a_line_without_points_has_no_distance():
    empty = Shape(Line(np.empty(0), np.empty((0, 2)), {}, (), False), ONE, smooth=True)
    assert np.isnan(of_points(Shape(folded(10), ONE, smooth=False), empty))
