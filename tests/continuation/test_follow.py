"""Following curves that are known exactly, whatever the longest step."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq

from fcm.continuation import End, Events, FollowOptions, Mark, Problem, Status, all_branches, follow
from fcm.continuation.all_branches import Following
from fcm.continuation.corrector import Newton
from fcm.continuation.options import NewtonOptions
from fcm.continuation.path import PathInterrupted
from fcm.continuation.step_control import Stepper

STEPS = (0.2, 0.1, 0.05, 0.02, 0.01)
CLOSE = 1e-10  # to which a point is on its curve
LAST = 1e-4  # to which its direction is that of the curve, which is taken before the last correction


class Planar(Problem):
    """f(x, p) = 0 for the first of two unknowns, which the second equals; |x| is reported.

    f gives its value and derivatives by x and p; margin, if there is one, is a function of x.
    """

    def __init__(self, f, margin=None):
        Problem.__init__(self, 2, 0 if margin is None else 1, 1)
        self.f, self.of_margin = f, margin

    def evaluate(self, z):
        self.residual[0], self.jacobian[0, 0], self.jacobian[0, 2] = self.f(z[0], z[2])
        self.residual[1] = z[1] - z[0]
        self.jacobian[1, 0], self.jacobian[1, 1] = -1.0, 1.0
        return 0

    def evaluate_scale(self, z):
        self.scale[0] = self.scale[1] = 1.0
        self.scale[2] = 2.0
        return 0

    def evaluate_margins(self, z):
        if self.of_margin is not None:
            self.margin[0] = self.of_margin(z[0])
        return 0

    def evaluate_outputs(self, z, direction):
        self.output[0] = abs(z[0])
        self.growth[0] = direction[0] * np.sign(z[0])
        return 0


def start(x, p):
    return np.array([x, x, p])


def cubic():
    return Planar(lambda x, p: (x**3 - x + 2.0 - p, 3.0 * x * x - 1.0, -1.0))


def circle():
    """(x - 3)^2 + (p - 2)^2 = 4."""
    return Planar(lambda x, p: ((x - 3.0) ** 2 + (p - 2.0) ** 2 - 4.0, 2.0 * (x - 3.0), 2.0 * (p - 2.0)))


def zigzag(back):
    """p rises with x up to the corner at x = 2, falls with slope -back for 1, and rises with slope 2."""

    def f(x, p):
        if x < 2.0:
            return x - p, 1.0, -1.0
        if x < 3.0:
            return 2.0 - back * (x - 2.0) - p, -back, -1.0
        return 2.0 - back + 2.0 * (x - 3.0) - p, 2.0, -1.0

    return Planar(f, lambda x: (x - 2.0) * (x - 3.0))


@pytest.mark.parametrize("step", STEPS)
def test_an_s_shaped_curve_through_both_folds(step):
    """p = x^3 - x + 2 has its folds at x = -+1/sqrt(3), where p = 2 +- 2/(3 sqrt(3))."""
    path = follow(cubic(), start(-1.32, 1.0), (1.0, 3.0), options=FollowOptions(step))
    assert path.status is Status.COMPLETE
    x, p = path.z[:, 0], path.parameter
    assert p[0] == 1.0 and p[-1] == 3.0 and np.all(np.diff(x) > 0.0)
    assert x[-1] == pytest.approx(-x[0], abs=CLOSE)
    assert x**3 - x + 2.0 == pytest.approx(p, abs=1e-9)
    folds = path.where(Mark.FOLD)
    across = 2.0 / (3.0 * np.sqrt(3.0))
    assert p[folds] == pytest.approx([2.0 + across, 2.0 - across], abs=1e-10)
    assert x[folds] == pytest.approx([-1.0 / np.sqrt(3.0), 1.0 / np.sqrt(3.0)], abs=1e-6)
    ends = np.concatenate(([1.0], np.sign(path.direction[:, -1])[1:-1], [1.0]))
    assert np.count_nonzero(np.diff(ends[np.setdiff1d(np.arange(ends.size), folds)])) == 2


def test_a_start_or_a_span_that_cannot_be_meant_is_refused():
    with pytest.raises(ValueError, match=r"the start has the shape \(1,\), and should have \(3,\)"):
        follow(cubic(), np.array([1.3]), (-1.0, 1.0))
    with pytest.raises(ValueError, match="the span is 1 to -1; its lower end comes first"):
        follow(cubic(), start(1.3, -1.0), (1.0, -1.0))


@pytest.mark.parametrize("step", STEPS)
def test_directions_are_tangents(step):
    path = follow(cubic(), start(-1.32, 1.0), (1.0, 3.0), options=FollowOptions(step))
    x, direction = path.z[:, 0], path.direction
    assert (3.0 * x * x - 1.0) * direction[:, 0] == pytest.approx(direction[:, -1], abs=LAST)


@pytest.mark.parametrize("step", STEPS)
def test_the_work_is_bounded(step):
    """A point takes a prediction and some corrections; folds and ends of the range a few more in all."""
    path = follow(cubic(), start(-1.32, 1.0), (1.0, 3.0), options=FollowOptions(step))
    smooth = path.z.shape[0] - path.where(Mark.FOLD | Mark.END).size
    assert path.evaluations < 5 * smooth + 50


def test_a_smaller_step_gives_more_points():
    points = [
        follow(cubic(), start(-1.32, 1.0), (1.0, 3.0), options=FollowOptions(s)).z.shape[0] for s in STEPS
    ]
    assert points == sorted(points)
    path = follow(cubic(), start(-1.32, 1.0), (1.0, 3.0), options=FollowOptions(STEPS[-1]))
    apart = np.diff(path.z, axis=0) / [1.0, 1.0, 2.0]  # in the problem's scale
    assert np.linalg.norm(apart, axis=1).max() < 1.1 * STEPS[-1]


@pytest.mark.parametrize("step", STEPS)
@pytest.mark.parametrize("back", [0.5, 2.0, 20.0])
def test_a_corner_at_which_the_curve_turns_back(step, back):
    low = min(1.0, 2.0 - back - 0.5)
    path = follow(zigzag(back), start(low, low), (low, 6.0), options=FollowOptions(step))
    assert path.status is Status.COMPLETE
    x, p = path.z[:, 0], path.parameter
    assert np.all(np.diff(x) > 0.0) and p[-1] == 6.0
    corners = path.where(Mark.CORNER)
    assert x[corners] == pytest.approx([2.0, 3.0], abs=1e-8)
    assert p[corners] == pytest.approx([2.0, 2.0 - back], abs=1e-8 * max(1.0, back))
    assert np.all(path.mark[corners] & Mark.FOLD)
    assert path.where(Mark.FOLD).tolist() == corners.tolist()


@pytest.mark.parametrize("step", STEPS)
def test_a_corner_at_which_it_goes_on(step):
    """The slope changes from 1 to 4: a corner, but neither a fold nor a branch."""
    bent = Planar(
        lambda x, p: (x - p, 1.0, -1.0) if x < 2.0 else (2.0 + 4.0 * (x - 2.0) - p, 4.0, -1.0),
        lambda x: x - 2.0,
    )
    path = follow(bent, start(1.0, 1.0), (1.0, 5.0), options=FollowOptions(step))
    assert path.status is Status.COMPLETE
    (corner,) = path.where(Mark.CORNER)
    assert path.z[corner, 0] == pytest.approx(2.0, abs=1e-10)
    assert path.where(Mark.FOLD).size == path.where(Mark.BRANCH).size == 0
    assert path.z[-1, 0] == pytest.approx(2.75, abs=1e-10)


@pytest.mark.parametrize("step", STEPS)
@pytest.mark.parametrize("wide", [0.0, 1e-12, 1e-10, 3e-9])
def test_a_piece_that_is_all_but_nothing_is_part_of_a_corner(step, wide):
    """p rises with x up to 2, falls steeply while x rises by no more than wide, then gently for ever."""

    class Thin(Planar):
        def __init__(self):
            Planar.__init__(self, self.piece, lambda x: 0.0)
            Problem.__init__(self, 2, 2, 1)

        @staticmethod
        def piece(x, p):
            if x < 2.0:
                return x - p, 1.0, -1.0
            if x < 2.0 + wide:
                return 2.0 - 30.0 * (x - 2.0) - p, -30.0, -1.0
            return 2.0 - 30.0 * wide - 0.1 * (x - 2.0 - wide) - p, -0.1, -1.0

        def evaluate_margins(self, z):
            self.margin[0], self.margin[1] = z[0] - 2.0, z[0] - 2.0 - wide
            return 0

    path = follow(Thin(), start(1.0, 1.0), (1.0, 3.0), options=FollowOptions(step))
    assert path.status is Status.RETURNED
    assert np.all(np.diff(path.z[:, 0]) > 0.0)
    assert path.z[-1, 0] == pytest.approx(12.0, abs=1e-6)
    assert path.parameter[path.where(Mark.FOLD)] == pytest.approx([2.0], abs=1e-8)


@pytest.mark.parametrize("step", STEPS)
@pytest.mark.parametrize("stiff", [1.0, 1e3, 1e6])
def test_a_stiffness_that_begins_like_a_root(step, stiff):
    """p = x + stiff (x - 2)^1.5 from 2 on, as a contact that closes: its slope grows at once."""
    closing = Planar(
        lambda x, p: (
            x + stiff * max(x - 2.0, 0.0) ** 1.5 - p,
            1.0 + 1.5 * stiff * max(x - 2.0, 0.0) ** 0.5,
            -1.0,
        ),
        lambda x: x - 2.0,
    )
    path = follow(closing, start(1.0, 1.0), (1.0, 5.0), options=FollowOptions(step))
    assert path.status is Status.COMPLETE
    x, p = path.z[:, 0], path.parameter
    assert np.all(np.diff(p) > 0.0) and path.where(Mark.FOLD | Mark.BRANCH).size == 0
    assert x + stiff * np.maximum(x - 2.0, 0.0) ** 1.5 == pytest.approx(p, abs=1e-9)
    assert p[path.where(Mark.CORNER)] == pytest.approx([2.0], abs=1e-8)


@pytest.mark.parametrize("step", STEPS)
def test_an_end_of_the_range_next_to_a_corner_is_landed_on(step):
    path = follow(zigzag(0.5), start(1.0, 1.0), (1.0, 2.0 - 5e-9), options=FollowOptions(step))
    assert path.status is Status.COMPLETE and path.parameter[-1] == 2.0 - 5e-9
    path = follow(
        zigzag(0.5), start(2.5, 1.75), (1.5 + 5e-9, 2.0 + 5e-9), options=FollowOptions(step), forward=False
    )
    assert path.parameter[-1] == 1.5 + 5e-9 and path.z[-1, 0] < 3.0


@pytest.mark.parametrize("step", STEPS)
def test_a_peak_is_a_point(step):
    """Of x on the circle: 5, at p = 2; it rises and falls, so that no fold is there."""
    path = follow(circle(), start(3.0 + np.sqrt(3.0), 1.0), (1.0, 3.0), options=FollowOptions(step))
    assert path.status is Status.COMPLETE
    (peak,) = path.where(Mark.PEAK)
    assert path.z[peak, 0] == pytest.approx(5.0, abs=1e-10)
    assert path.parameter[peak] == pytest.approx(2.0, abs=1e-6)
    assert path.where(Mark.FOLD).size == 0


@pytest.mark.parametrize("step", STEPS)
def test_a_peak_in_a_corner(step):
    """x = p up to the corner at p = 2, then x = 4 - p."""

    class Roof(Planar):
        def __init__(self):
            Planar.__init__(
                self, lambda x, p: (x - p, 1.0, -1.0) if p < 2.0 else (x - 4.0 + p, 1.0, 1.0), abs
            )

        def evaluate_margins(self, z):
            self.margin[0] = z[2] - 2.0
            return 0

    path = follow(Roof(), start(1.0, 1.0), (1.0, 3.0), options=FollowOptions(step))
    assert path.status is Status.COMPLETE
    (corner,) = path.where(Mark.CORNER)
    assert path.z[corner] == pytest.approx([2.0, 2.0, 2.0], abs=1e-8)
    assert path.where(Mark.PEAK).tolist() == [corner] and path.where(Mark.FOLD).size == 0


class OnSymmetry(Planar):
    """Reported is also what would be 0 but for rounding, which turns back all the time."""

    def __init__(self, f, rounding):
        Problem.__init__(self, 2, 0, 2)
        self.f, self.of_margin, self.rounding = f, None, rounding

    def evaluate_outputs(self, z, direction):
        Planar.evaluate_outputs(self, z, direction)
        self.output[1] = self.rounding * (1.0 + 0.5 * np.sin(1e7 * z[0]))
        self.growth[1] = self.rounding * abs(np.cos(1e7 * z[0])) * direction[0]
        return 0


@pytest.mark.parametrize("step", [0.2, 0.05])
def test_outputs_that_are_rounding_make_no_steps_shorter(step):
    smooth, noisy = (
        follow(OnSymmetry(cubic().f, size), start(-1.32, 1.0), (1.0, 3.0), options=FollowOptions(step))
        for size in (0.0, 1e-13)
    )
    assert np.array_equal(noisy.z, smooth.z)


class NearSymmetry(OnSymmetry):
    """Reported is also what hardly moves, as where a mesh is symmetric to nine digits.

    It grows with x all the time, but for what the corrector leaves.
    """

    def evaluate_outputs(self, z, direction):
        Planar.evaluate_outputs(self, z, direction)
        self.output[1] = 1e-9 + 1e-10 * z[0] + self.rounding * np.sin(1e7 * z[0])
        self.growth[1] = 1e-10 * direction[0]
        return 0


@pytest.mark.parametrize("step", [0.2, 0.05])
def test_what_the_corrector_leaves_of_an_output_that_hardly_moves_makes_no_steps_shorter(step):
    smooth, noisy = (
        follow(NearSymmetry(cubic().f, size), start(-1.32, 1.0), (1.0, 3.0), options=FollowOptions(step))
        for size in (0.0, 1e-11)
    )
    assert np.array_equal(noisy.z, smooth.z)


@pytest.mark.parametrize("step", STEPS)
def test_a_curve_that_leaves_its_range_where_it_entered(step):
    path = follow(circle(), start(3.0 - np.sqrt(3.0), 1.0), (1.0, 5.0), options=FollowOptions(step))
    assert path.status is Status.RETURNED
    assert path.z[-1] == pytest.approx([3.0 + np.sqrt(3.0)] * 2 + [1.0], abs=1e-10)
    assert path.parameter[path.where(Mark.FOLD)] == pytest.approx([4.0], abs=1e-10)
    assert path.z[path.where(Mark.PEAK), 0] == pytest.approx([5.0], abs=1e-10)


@pytest.mark.parametrize("step", STEPS)
@pytest.mark.parametrize("before", [1e-2, 1e-4, 1e-6, 1e-8])
def test_a_range_that_ends_next_to_a_fold(step, before):
    """The circle leaves it there, and would be back within the same step."""
    path = follow(circle(), start(1.0, 2.0), (-1.0, 4.0 - before), options=FollowOptions(step))
    assert path.status is Status.COMPLETE and path.parameter.max() == path.parameter[-1] == 4.0 - before
    across = np.sqrt(4.0 - (2.0 - before) ** 2)
    assert path.z[-1, 0] == pytest.approx(3.0 - across, abs=1e-7)


@pytest.mark.parametrize("step", STEPS)
@pytest.mark.parametrize("forward", [True, False])
def test_a_closed_loop_from_inside_the_range(step, forward):
    path = follow(
        circle(), start(1.0, 2.0), (-1.0, 5.0), Events([3.0]), options=FollowOptions(step), forward=forward
    )
    assert path.status is Status.CLOSED
    assert path.z[-1] == pytest.approx(path.z[0], abs=1e-10)
    assert path.parameter[path.where(Mark.FOLD)] == pytest.approx(
        [4.0, 0.0][:: 1 if forward else -1], abs=1e-10
    )
    around = np.unwrap(np.arctan2(path.parameter - 2.0, path.z[:, 0] - 3.0))
    assert abs(around[-1] - around[0]) == pytest.approx(2.0 * np.pi, abs=1e-9)
    assert np.all(np.diff(around) * (-1.0 if forward else 1.0) > 0.0)
    found = path.z[path.where(Mark.USER_POINT)]
    assert found[:, -1].tolist() == [3.0, 3.0]
    assert sorted(found[:, 0]) == pytest.approx([3.0 - np.sqrt(3.0), 3.0 + np.sqrt(3.0)], abs=1e-10)


@pytest.mark.parametrize("step", STEPS)
@pytest.mark.parametrize("forward", [True, False])
@pytest.mark.parametrize("beside", [-1e-3, 1e-3])
def test_a_closed_loop_ends_at_a_user_point_where_it_began_and_not_at_the_next_one(step, forward, beside):
    """The last step passes both; going around once is an angle of 2 pi."""
    begin = start(3.0 - np.sqrt(3.0), 3.0)
    path = follow(
        circle(),
        begin,
        (-1.0, 5.0),
        Events([3.0, 3.0 + beside]),
        options=FollowOptions(step),
        forward=forward,
    )
    assert path.status is Status.CLOSED
    around = np.unwrap(np.arctan2(path.parameter - 2.0, path.z[:, 0] - 3.0))
    assert abs(around[-1] - around[0]) == pytest.approx(2.0 * np.pi, abs=1e-9)
    assert np.all(np.diff(around) * (-1.0 if forward else 1.0) > 0.0)  # no point twice


def test_a_curve_that_is_lost_to_a_closed_one_goes_around_it_once():
    """A straight line up to x = 5, p = 2 becomes the circle, which comes back to it in a gap of 1e-4."""
    loop = circle().f

    def joined(x, p):
        return (x - 5.0, 1.0, 0.0) if p < 2.0 and x > 5.0 - 1e-4 else loop(x, p)

    path = follow(Planar(joined), start(5.0, -1.0), (-1.0, 5.0), Events([3.0]), options=FollowOptions(0.05))
    assert path.status is Status.AROUND
    passed = path.z[path.where(Mark.USER_POINT), 0]
    high = 3.0 + np.sqrt(3.0)
    assert passed == pytest.approx([high, 3.0 - np.sqrt(3.0), high], abs=1e-10)


def test_a_curve_that_is_lost_to_a_closed_one_ends_at_a_corner_that_it_comes_to_again():
    """The same without a user point: two corners of each round, at x = 2.5, are all that is known again."""
    loop = circle().f

    def joined(x, p):
        return (x - 5.0, 1.0, 0.0) if p < 2.0 and x > 5.0 - 1e-4 else loop(x, p)

    problem = Planar(joined, lambda x: x - 2.5)
    path = follow(problem, start(5.0, -1.0), (-1.0, 5.0), options=FollowOptions(0.05))
    assert path.status is Status.AROUND
    corners = path.z[path.where(Mark.CORNER)]
    half = np.sqrt(4.0 - 0.25)
    assert corners[:, 0] == pytest.approx([2.5, 2.5, 2.5], abs=1e-6)
    assert corners[:, -1] == pytest.approx([2.0 + half, 2.0 - half, 2.0 + half], abs=1e-6)


@pytest.mark.parametrize("step", STEPS)
@pytest.mark.parametrize("back", [1e-2, 1e-3, 1e-4])
@pytest.mark.parametrize("middle", [2.0, 2.03, 2.1])
def test_two_folds_within_one_step(step, back, middle):
    """p = 2 + (x - m)^3 - back (x - m) goes back between x = m -+ sqrt(back / 3)."""

    def f(x, p):
        y = x - middle
        return 2.0 + y**3 - back * y - p, 3.0 * y * y - back, -1.0

    path = follow(Planar(f), start(middle - 1.0, 1.0 + back), (1.0, 3.0), options=FollowOptions(step))
    assert path.status is Status.COMPLETE
    across = 2.0 * (back / 3.0) ** 1.5
    assert path.parameter[path.where(Mark.FOLD)] == pytest.approx([2.0 + across, 2.0 - across], abs=1e-10)


@pytest.mark.parametrize("step", STEPS)
@pytest.mark.parametrize("middle", [2.0, 2.03, 2.1])
def test_two_folds_within_one_step_that_its_cubic_does_not_have(step, middle):
    """p' = (1 - 1.1 / (1 + y^2)) / 100 with y = (x - m) / 0.08 is less than 0 for y^2 < 0.1."""
    width, rate = 0.08, 0.01

    def along(x):
        y = (x - middle) / width
        return 2.0 + rate * width * (y - 1.1 * np.arctan(y))

    def f(x, p):
        y = (x - middle) / width
        return along(x) - p, rate * (1.0 - 1.1 / (1.0 + y * y)), -1.0

    begin, end = along(middle - 1.0), along(middle + 1.0)
    path = follow(Planar(f), start(middle - 1.0, begin), (begin, end), options=FollowOptions(step))
    assert path.status is Status.COMPLETE
    turns = middle + width * np.sqrt(0.1) * np.array([-1.0, 1.0])
    assert path.parameter[path.where(Mark.FOLD)] == pytest.approx(along(turns), abs=1e-12)


@pytest.mark.parametrize("step", STEPS)
@pytest.mark.parametrize("back", [1e-2, 1e-3, 1e-4])
def test_a_peak_and_a_least_value_within_one_step(step, back):
    """x = 2 + y^3 - back y, y = p - 2, has a peak at y = -sqrt(back / 3)."""

    def f(x, p):
        y = p - 2.0
        return x - 2.0 - y**3 + back * y, 1.0, -3.0 * y * y + back

    path = follow(Planar(f), start(1.0 + back, 1.0), (1.0, 2.5), options=FollowOptions(step))
    (peak,) = path.where(Mark.PEAK)
    assert path.parameter[peak] == pytest.approx(2.0 - np.sqrt(back / 3.0), abs=1e-6)


@pytest.mark.parametrize("step", STEPS)
def test_every_passing_of_a_user_point(step):
    """p = 2 on the S-shaped curve at x = -1, 0, 1."""
    path = follow(cubic(), start(-1.32, 1.0), (1.0, 3.0), Events([2.0]), options=FollowOptions(step))
    found = path.where(Mark.USER_POINT)
    assert path.parameter[found].tolist() == [2.0] * 3
    assert path.z[found, 0] == pytest.approx([-1.0, 0.0, 1.0], abs=1e-10)


@pytest.mark.parametrize("step", STEPS)
@pytest.mark.parametrize("before", [1e-2, 1e-4, 1e-6, 1e-8])
def test_a_user_point_next_to_a_fold_is_passed_twice(step, before):
    """The circle turns back at p = 4, where x = 3 -+ sqrt(4 before) about."""
    path = follow(circle(), start(1.0, 2.0), (-1.0, 5.0), Events([4.0 - before]), options=FollowOptions(step))
    assert path.status is Status.CLOSED
    found = path.z[path.where(Mark.USER_POINT)]
    across = np.sqrt(4.0 - (2.0 - before) ** 2)
    assert found[:, -1].tolist() == [4.0 - before] * 2
    assert found[:, 0] == pytest.approx([3.0 - across, 3.0 + across], abs=1e-7)


@pytest.mark.parametrize("step", STEPS)
def test_another_curve_that_crosses(step):
    """x (x - p + 2) = 0: x = 0 is followed past p = 2, where x = p - 2 crosses it."""
    crossed = Planar(lambda x, p: (x * (x - p + 2.03), 2.0 * x - p + 2.03, -x))
    path = follow(crossed, start(0.0, 1.0), (1.0, 3.0), options=FollowOptions(step))
    assert path.status is Status.COMPLETE and np.all(path.z[:, 0] == 0.0)
    (after,) = path.where(Mark.BRANCH)
    assert path.parameter[after - 1] < 2.03 < path.parameter[after]
    assert np.unique(np.sign(path.orientation[:after])).size == 1
    assert path.orientation[after] == -path.orientation[after - 1]


def test_where_there_is_no_curve_nothing_is_followed():
    none = Planar(lambda x, p: (x * x + 1.0, 2.0 * x, 0.0))
    path = follow(none, start(0.5, 1.0), (1.0, 3.0))
    assert path.status is Status.STALLED and path.z.shape == (0, 3)


def test_a_resonance_without_damping_has_no_limit():
    """x = 1 / (2 - p), in units of its size as it grows."""

    class Pole(Planar):
        def evaluate_scale(self, z):
            self.scale[0] = self.scale[1] = abs(z[0])
            self.scale[2] = 2.0
            return 0

    pole = Pole(lambda x, p: (x * (2.0 - p) - 1.0, 2.0 - p, -x))
    path = follow(pole, start(1.0, 1.0), (1.0, 3.0), options=FollowOptions(0.2))
    assert path.status is Status.UNBOUNDED and path.parameter[-1] == pytest.approx(2.0, abs=1e-8)


def test_a_curve_that_ends_is_kept_up_to_there():
    """The curve ends at x = 2: no further point is found, and the points up to there are kept."""

    def f(x, p):
        return (x - p, 1.0, -1.0) if p < 2.0 else (1.0 + x * x, 2.0 * x, 0.0)

    path = follow(Planar(f), start(1.0, 1.0), (1.0, 3.0), options=FollowOptions(0.1))
    assert path.status is Status.STALLED
    assert path.parameter[-1] == pytest.approx(2.0, abs=1e-6)


class Ended(Problem):
    """A closed curve in space of which there is only what lies near a value of the parameter."""

    def __init__(self, at):
        Problem.__init__(self, 2, 0, 0)
        self.at = at

    def evaluate(self, z):
        x, y, p = z
        self.residual[0] = x * x + p * p + 0.3 * y - 1.0 if abs(p - self.at) < 1e-3 else np.nan
        self.residual[1] = y - 0.5 * x * p
        self.jacobian[0, 0], self.jacobian[0, 1], self.jacobian[0, 2] = 2.0 * x, 0.3, 2.0 * p
        self.jacobian[1, 0], self.jacobian[1, 1], self.jacobian[1, 2] = -0.5 * p, 1.0, -0.5 * x
        return 0


def test_a_curve_that_ends_where_it_begins_is_not_closed():
    """It is taken back to its first point, which rounding may put before where it began."""
    for angle in np.linspace(0.05, 1.5, 200):
        begin = np.array([np.cos(angle), 0.0, np.sin(angle)])
        path = follow(Ended(np.sin(angle)), begin, (-2.0, 2.0))
        assert path.status is Status.STALLED and len(path.z) > 1


class Hook(Problem):
    """y = c w(r), r = s + y / 2: nothing for r < 0, the root of r up to q^2, then straight on.

    So moves the slider of a contact in the plane that ceases to slip between two discs: along the edge of the
    place that they leave it, until one disc alone holds it.
    """

    def __init__(self, c, q):
        super().__init__(1, 1, 0)
        self.has_root_margins, self.c, self.q = True, c, q

    def evaluate(self, z):
        r, w, rate = z[1] + 0.5 * z[0], 0.0, 0.0
        if 0.0 < r < self.q**2:
            w, rate = np.sqrt(r), 0.5 / np.sqrt(r)
        elif r > 0.0:
            w, rate = self.q - 0.3 * (r - self.q**2), -0.3
        self.residual[0] = z[0] - self.c * w
        self.jacobian[0, 0], self.jacobian[0, 1] = 1.0 - 0.5 * self.c * rate, -self.c * rate
        return 0

    def evaluate_margins(self, z):
        r = z[1] + 0.5 * z[0]
        self.margin[0] = np.sign(r) * np.sqrt(abs(r))
        return 0


@pytest.mark.parametrize("q", [1e-2, 1e-3, 5e-4])
def test_a_corner_that_is_a_hook(q):
    """The curve comes with r < 0, goes back along the root by 0.25 q, and then on: as one corner."""
    path = follow(Hook(0.5, q), np.array([0.0, -1.0]), (-1.0, 1.0))
    assert path.status is Status.COMPLETE
    y, s = path.z[-1]  # where y = (q - 0.3 (s + y / 2 - q^2)) / 2
    assert s == 1.0 and y == pytest.approx((q - 0.3 + 0.3 * q * q) / 2.15, abs=1e-9)


def test_backwards_and_then():
    path = follow(cubic(), start(-1.32, 1.0), (1.0, 3.0), options=FollowOptions(0.1))
    back = path.backwards()
    assert np.array_equal(back.z, path.z[::-1]) and np.array_equal(back.direction, -path.direction[::-1])
    assert np.array_equal(back.backwards().z, path.z)


@pytest.mark.parametrize("longest", [0.02, 0.05, 0.1, 0.2])
@pytest.mark.parametrize("apart", [1e-12, 1e-11, 1e-10, -1e-12])
def test_branches_that_nearly_meet_are_not_exchanged(longest, apart):
    """x^3 - p x = apart has one real root for p < 0; the curve through it becomes that of one sign."""

    def f(x, p):
        return x**3 - p * x - apart, 3.0 * x * x - p, -x

    path = follow(Planar(f), start(-apart, -1.0), (-1.0, 1.0), options=FollowOptions(longest))
    assert path.status is Status.COMPLETE and path.where(Mark.BRANCH).size == 0
    assert np.sign(apart) * path.z[-1, 0] == pytest.approx(1.0, abs=1e-9)


@pytest.mark.parametrize("longest", [0.02, 0.05, 0.1, 0.2])
@pytest.mark.parametrize("bend", [0.0, 1.0, 30.0])
def test_branches_that_meet_are_followed_straight_on(longest, bend):
    """x (x - p - bend p^3) = 0 has a line and a cubic, which meet at p = 0."""

    def f(x, p):
        other = x - p - bend * p**3
        return x * other, other + x, -x * (1.0 + 3.0 * bend * p * p)

    for x in (0.0, 1.0):
        begin, end = (x * (p + bend * p**3) for p in (-0.9137, 1.0))
        path = follow(Planar(f), start(begin, -0.9137), (-0.9137, 1.0), options=FollowOptions(longest))
        assert path.status is Status.COMPLETE and path.z[-1, 0] == pytest.approx(end, abs=1e-9)
        (at,) = path.where(Mark.BRANCH)
        assert path.parameter[at] == pytest.approx(0.0, abs=2e-4)


def test_all_branches_once_each():
    """A circle and a line through the range, from five solutions on them."""

    def f(x, p):
        loop, line = (x - 3.0) ** 2 + (p - 2.0) ** 2 - 4.0, x - 8.0
        return loop * line, 2.0 * (x - 3.0) * line + loop, 2.0 * (p - 2.0) * line

    solutions = [start(8.0, -1.0), start(8.0, 5.0), start(1.0, 2.0), start(5.0, 2.0), start(8.0, 2.0)]
    found = all_branches(lambda: Planar(f), solutions, (-1.0, 5.0), Following(FollowOptions(0.05)))
    assert [path.status for path in found.paths] == [Status.COMPLETE, Status.CLOSED]
    assert found.status is Status.COMPLETE and found.lost == ()
    line, loop = found.paths
    assert line.z[:, 0] == pytest.approx(8.0, abs=1e-9) and np.all(np.diff(line.parameter) > 0.0)
    assert np.hypot(loop.z[:, 0] - 3.0, loop.parameter - 2.0) == pytest.approx(2.0, abs=1e-9)


def test_a_start_inside_the_range_is_followed_both_ways():
    found = all_branches(cubic, [start(0.0, 2.0)], (1.0, 3.0), Following(FollowOptions(0.1)))
    (path,) = found.paths
    assert found.status is Status.COMPLETE
    assert (path.parameter[0], path.parameter[-1]) == (1.0, 3.0)
    assert path.where(Mark.FOLD).size == 2


def cut_short(share):
    """`follow`, but for the last points of a path: a share is left, or those up to its second fold."""

    def short(*args, **more):
        path = follow(*args, **more)
        left = int(share * len(path.z)) if share else path.where(Mark.FOLD)[1] + 1
        return replace(path.part(np.arange(left)), status=Status.STALLED)

    return short


@pytest.mark.parametrize(("share", "joined"), [(0.7, True), (None, True), (0.4, False)])
def test_two_paths_that_both_end_too_early_are_one_branch_where_they_overlap(share, joined):
    """Of a curve with two folds, each followed from its end."""
    ends = [
        start(sign * float(np.real(np.roots([1.0, 0.0, -1.0, -1.0])[0])), 2.0 + sign) for sign in (-1.0, 1.0)
    ]
    found = all_branches(cubic, ends, (1.0, 3.0), Following(FollowOptions(0.1), cut_short(share)))
    if not joined:
        assert [path.status for path in found.paths] == [Status.STALLED] * 2
        return
    (path,) = found.paths
    assert found.status is Status.COMPLETE
    assert (path.parameter[0], path.parameter[-1]) == (1.0, 3.0)
    assert np.all(np.diff(path.z[:, 0]) > 0.0) and path.where(Mark.FOLD).size == 2
    assert path.z[:, 0] ** 3 - path.z[:, 0] + 2.0 == pytest.approx(path.parameter, abs=CLOSE)
    beside_folds = (path.mark & Mark.FOLD) == 0
    assert np.all((path.parity == np.sign(3.0 * path.z[:, 0] ** 2 - 1.0))[beside_folds])


def test_a_path_that_ends_too_early_is_part_of_the_branch_that_comes_by_from_the_other_end():
    """Of a curve with two folds: from one end it stops on the way, from the other it is followed whole."""
    short = cut_short(0.7)

    def from_above(problem, first, *args, **more):
        return (follow if first[-1] == 3.0 else short)(problem, first, *args, **more)

    ends = [
        start(sign * float(np.real(np.roots([1.0, 0.0, -1.0, -1.0])[0])), 2.0 + sign) for sign in (-1.0, 1.0)
    ]
    found = all_branches(cubic, ends, (1.0, 3.0), Following(FollowOptions(0.1), from_above))
    (path,) = found.paths
    assert found.status is Status.COMPLETE and (path.parameter[0], path.parameter[-1]) == (1.0, 3.0)


def test_a_path_that_ends_too_early_both_ways_is_part_of_no_complete_branch():
    """From a point inside the range it leads to neither end, though it comes to the path from one of them."""
    span = (1.0, 3.0)

    def short(problem, first, *args, **more):
        path = follow(problem, first, *args, **more)
        if first[-1] in span:
            return replace(path.part(np.arange(int(0.7 * len(path.z)))), status=Status.STALLED)
        left = path.part(np.flatnonzero(np.abs(path.z[:, 0]) < 1.0))
        return replace(left, status=Status.STALLED)

    inside, end = start(0.0, 2.0), start(float(np.real(np.roots([1.0, 0.0, -1.0, -1.0])[0])), 3.0)
    found = all_branches(cubic, [inside, end], span, Following(FollowOptions(0.1), short))
    assert found.status is Status.STALLED


class Labelled(Planar):
    """A curve whose only margin is the label of its smooth piece."""

    def __init__(self, f, label):
        Planar.__init__(self, f, label)
        self.labelled = True


def tent():
    """p = 1 - |x| (1 + x / 4): a fold that is a corner, at x = 0."""

    def f(x, p):
        side = np.sign(x) or 1.0
        return 1.0 - side * x * (1.0 + 0.25 * x) - p, -side * (1.0 + 0.5 * x), -1.0

    return Labelled(f, lambda x: float(x < 0.0))


@pytest.mark.parametrize("max_step", STEPS)
def test_a_corner_that_only_a_label_tells_of_is_turned_at(max_step):
    path = follow(tent(), start(-0.9, 0.3025), (0.3, 2.0), options=FollowOptions(max_step))
    assert path.status is Status.RETURNED or path.parameter[-1] == 0.3
    (fold,) = path.where(Mark.FOLD)
    assert path.parameter[fold] == pytest.approx(1.0, abs=1e-7)
    assert path.z[-1, 0] > 0.5


class RoofBesideALine(Problem):
    """p = 2 - (x^2 + radius^2)^(1/2), smooth with a narrow fold, and on another branch p = 2.1 + x."""

    def __init__(self, radius):
        Problem.__init__(self, 1, 1, 0)
        self.labelled, self.radius = True, radius

    def evaluate(self, z):
        x, p = z
        high = np.hypot(x, self.radius)
        roof, line = p - 2.0 + high, p - 2.1 - x
        self.residual[0] = roof * line
        self.jacobian[0, 0], self.jacobian[0, 1] = x / high * line - roof, line + roof
        return 0


@pytest.mark.parametrize("radius", [1e-3, 1e-5, 1e-7, 1e-8, 1e-9])
@pytest.mark.parametrize("max_step", STEPS)
def test_no_step_leads_from_a_narrow_fold_to_another_branch(radius, max_step):
    """Beyond the fold the curve is at right angles to what it was, where a short step sees the other one."""
    path = follow(RoofBesideALine(radius), np.array([-0.5, 1.5]), (1.0, 3.0), options=FollowOptions(max_step))
    assert path.parameter == pytest.approx(2.0 - np.hypot(path.z[:, 0], radius), abs=1e-7)
    assert path.status is Status.COMPLETE and path.z[-1, 0] == pytest.approx(1.0, abs=1e-6)


class Pieces(Labelled):
    """x = sum over the slopes of the pieces of a broken line in p, with corners at 2, 3, ..."""

    def __init__(self, *slopes):
        def f(x, p):
            k = min(max(int(np.floor(p)) - 1, 0), len(slopes) - 1)
            at = 1.0 + max(k, 0.0)
            return x - sum(slopes[:k]) - slopes[k] * (p - at), 1.0, -slopes[k]

        Labelled.__init__(self, f, None)
        Problem.__init__(self, 2, 1, 1)
        self.labelled = True

    def evaluate_margins(self, z):
        self.margin[0] = np.floor(z[2])
        return 0


@pytest.mark.parametrize("max_step", STEPS)
def test_a_spike_is_gone_round_if_its_other_side_has_another_label(max_step):
    """The parameter goes on where all else turns back, by an angle of 176 degrees."""
    path = follow(Pieces(10.0, -10.0), start(0.0, 1.0), (1.0, 2.8), options=FollowOptions(max_step))
    assert path.status is Status.COMPLETE
    assert path.z[:, 0] == pytest.approx(10.0 - 10.0 * abs(path.parameter - 2.0), abs=1e-8)
    assert path.z[:, 0].max() == pytest.approx(10.0, abs=1e-6)
    assert path.where(Mark.FOLD).size == 0


class Touch(Problem):
    """x = p, y = c p as long as x < 0, from where both feel I(x): a root of x, within the depth a power 3/2.

    x = p + I and y = c p - I, where p falls again as soon as I' > 1.
    """

    def __init__(self, c, depth):
        Problem.__init__(self, 2, 1, 0)
        self.labelled, self.c, self.depth = True, c, depth

    def evaluate(self, z):
        x, y, p = z
        inside = max(x, 0.0)
        impact = inside**1.5 / (inside + self.depth)
        rate = (1.5 * inside**0.5 - impact) / (inside + self.depth)
        self.residual[0], self.residual[1] = x - p - impact, y - self.c * p + impact
        self.jacobian[0, 0], self.jacobian[0, 2] = 1.0 - rate, -1.0
        self.jacobian[1, 0], self.jacobian[1, 1], self.jacobian[1, 2] = rate, 1.0, -self.c
        return 0

    def evaluate_scale(self, z):
        self.scale[0] = self.scale[1] = self.scale[2] = 1.0
        return 0

    def evaluate_margins(self, z):
        self.margin[0] = float(z[0] > 0.0)
        return 0


@pytest.mark.parametrize("depth", [1e-3, 1e-4, 1e-5, 1e-6])
@pytest.mark.parametrize("c", [10.0, 30.0, 100.0])
def test_a_curve_that_turns_back_as_contacts_touch_goes_on_with_these_touching(c, depth):
    """It turns within less than any step, and its other side is close to the way there."""
    path = follow(Touch(c, depth), np.array([-0.2, -0.2 * c, -0.2]), (-0.2, 1.0), options=FollowOptions(0.05))
    end = brentq(lambda x: x - x**1.5 / (x + depth) + 0.2, 0.01, 0.2)
    assert path.status is Status.RETURNED and path.z[-1, 0] == pytest.approx(end, abs=1e-9)
    (fold,) = path.where(Mark.FOLD)
    assert abs(path.parameter[fold]) < depth and (path.z[fold + 1 :, 0] > 0.0).all()


def shallow():
    """p = 3 - 0.02 |x|: a step passes the corner."""

    def f(x, p):
        side = 0.02 * (np.sign(x) or 1.0)
        return 3.0 - side * x - p, -side, -1.0

    return Labelled(f, lambda x: float(x < 0.0))


def soft_circle():
    circle_ = circle()
    return Labelled(circle_.f, lambda x: 0.0)


def evaluations_at(problem):
    """How often it is evaluated at a place that is new."""
    seen, evaluate = set(), problem.evaluate

    def counted(z):
        seen.add(np.asarray(z).tobytes())
        return evaluate(z)

    problem.evaluate = counted
    return seen


@pytest.mark.parametrize("max_step", STEPS)
def test_a_fold_in_a_corner_within_a_step_is_found_by_few_looks(max_step):
    """It takes forty to enclose it by halves."""
    problem = shallow()
    seen = evaluations_at(problem)
    path = follow(problem, start(-1.0, 2.98), (2.98, 4.0), options=FollowOptions(max_step))
    (fold,) = path.where(Mark.FOLD)
    assert path.parameter[fold] == pytest.approx(3.0, abs=1e-12)
    assert len(seen) < 3 * len(path.z) + 25


@pytest.mark.parametrize("max_step", STEPS)
def test_smooth_folds_and_peaks_of_a_soft_problem(max_step):
    """Folds at p = 4 and 0, a peak of x = 5."""
    problem = soft_circle()
    seen = evaluations_at(problem)
    path = follow(problem, start(5.0, 2.0), (-1.0, 5.0), options=FollowOptions(max_step))
    folds, peaks = path.where(Mark.FOLD), path.where(Mark.PEAK)
    assert path.status is Status.CLOSED
    assert path.parameter[folds] == pytest.approx([4.0, 0.0], abs=0.1 * CLOSE)
    assert path.z[folds, 0] == pytest.approx(3.0, abs=1e-6)
    assert path.z[peaks, 0] == pytest.approx(5.0, abs=1e-10)
    assert len(seen) < 3 * len(path.z) + 15


def step_back(slope, height, width):
    """p = 1 + slope x - height tanh((x - 3) / width): nearly a line, but for two folds around x = 3."""

    def f(x, p):
        back = np.tanh((x - 3.0) / width)
        rise = slope - height / width * (1.0 - back * back)
        return 1.0 + slope * x - height * back - p, rise, -1.0

    return Labelled(f, lambda x: 0.0)


@pytest.mark.parametrize("max_step", STEPS)
def test_two_folds_that_a_step_hardly_misses_the_curve_by_are_found(max_step):
    """Either side of them the curve rises as slowly, so that both ends of a step across them look alike."""
    slope, height, width = 4e-3, 2e-4, 0.01
    path = follow(
        step_back(slope, height, width), start(1.0, 1.0042), (1.0042, 1.02), options=FollowOptions(max_step)
    )
    turn = np.sqrt(1.0 - slope * width / height)  # tanh where p neither rises nor falls
    up = height * turn - slope * width * np.arctanh(turn)
    assert path.status is Status.COMPLETE
    assert path.parameter[path.where(Mark.FOLD)] == pytest.approx([1.012 + up, 1.012 - up], abs=1e-9)


def test_a_curve_goes_on_from_any_stage_to_the_same_points():
    stages = []
    whole = follow(cubic(), start(-1.5, 0.125), (0.0, 4.0), options=FollowOptions(0.1), watch=stages.append)
    for stage in stages[:: max(len(stages) // 5, 1)]:
        again = follow(cubic(), start(-1.5, 0.125), (0.0, 4.0), options=FollowOptions(0.1), checkpoint=stage)
        assert again.status is whole.status
        np.testing.assert_array_equal(again.z, whole.z)
        np.testing.assert_array_equal(again.mark, whole.mark)


class Many(Problem):
    """p = x^3 - x + 2 - slight sum_k max(x - x_k, 0)^(3/2) of the first of many equal unknowns.

    Each x_k is a margin; 2 - (x + 0.2)^2 is reported.
    """

    def __init__(self, unknowns, slight):
        self.corners = np.linspace(-1.0, 1.0, 20)
        Problem.__init__(self, unknowns, 20, 1)
        self.slight, self.group = slight, 1
        self.matrix = np.asarray(self.jacobian)
        self.matrix[:, 0] = -1.0
        self.matrix[:, :-1] += np.eye(unknowns)
        self.matrix[0, -1] = -1.0

    def curve(self, x):
        beyond = np.maximum(x - self.corners, 0.0)
        value = x**3 - x + 2.0 - self.slight * (beyond**1.5).sum()
        return value, 3.0 * x * x - 1.0 - 1.5 * self.slight * (beyond**0.5).sum()

    def evaluate(self, z):
        z = np.asarray(z)
        value, self.matrix[0, 0] = self.curve(z[0])
        self.residual[:] = np.append(value - z[-1], z[1:-1] - z[0])
        return 0

    def evaluate_scale(self, z):
        self.scale[:] = np.append(np.full(self.unknowns, np.sqrt(self.unknowns)), 2.0)
        return 0

    def evaluate_margins(self, z):
        self.margin[:] = z[0] - self.corners
        return 0

    def evaluate_outputs(self, z, direction):
        self.output[0] = 2.0 - (z[0] + 0.2) ** 2
        self.growth[0] = -2.0 * (z[0] + 0.2) * direction[0]
        return 0


@pytest.mark.parametrize("step", (0.2, 0.05, 0.02))
def test_slight_corners_of_many_unknowns_are_stepped_over(step):
    """Folds and the peak are where they are nonetheless, and the work is that of a smooth curve."""
    path, plain = (
        follow(
            Many(120, slight), np.append(np.full(120, -1.32), 1.02), (1.02, 3.0), options=FollowOptions(step)
        )
        for slight in (1e-3, 0.0)
    )
    assert path.status is Status.COMPLETE
    of = Many(120, 1e-3)
    exact = [brentq(lambda x: of.curve(x)[1], a, b, xtol=1e-14) for a, b in ((-1.0, 0.0), (0.0, 1.0))]
    folds = path.where(Mark.FOLD)
    assert path.parameter[folds] == pytest.approx([of.curve(x)[0] for x in exact], abs=1e-10)
    assert path.z[folds, 0] == pytest.approx(exact, abs=1e-5)
    peaks = path.where(Mark.PEAK)
    assert path.z[peaks, 0] == pytest.approx([-0.2], abs=1e-5)
    assert [of.curve(z[0])[0] - z[-1] for z in path.z] == pytest.approx(np.zeros(len(path.z)), abs=1e-9)
    assert path.evaluations < 1.5 * plain.evaluations


@pytest.mark.parametrize("step", (0.2, 0.05))
def test_slight_corners_of_some_unknowns_are_stepped_over_where_the_parameter_goes_on_evenly(step):
    """The folds are landed on as closely, with half the work of landing on every corner."""
    of, fewer = Many(80, 1e-3), Many(40, 1e-3)
    path, landed = (
        follow(one, np.append(np.full(one.unknowns, -1.32), 1.02), (1.02, 3.0), options=FollowOptions(step))
        for one in (of, fewer)
    )
    exact = [brentq(lambda x: of.curve(x)[1], a, b, xtol=1e-14) for a, b in ((-1.0, 0.0), (0.0, 1.0))]
    assert path.status is Status.COMPLETE
    assert path.parameter[path.where(Mark.FOLD)] == pytest.approx([of.curve(x)[0] for x in exact], abs=1e-10)
    assert path.evaluations < 0.5 * landed.evaluations


class Narrow(Many):
    """p = x + 2 - 6 (max(x - a, 0)^(3/2) - max(x - b, 0)^(3/2)), which falls near b alone."""

    def __init__(self, unknowns, first):
        Many.__init__(self, unknowns, 6.0)
        self.corners = np.append([first, first + 0.02], np.full(18, 9.0))

    def curve(self, x):
        beyond = np.maximum(x - self.corners[:2], 0.0)
        return x + 2.0 - 6.0 * np.dot([1.0, -1.0], beyond**1.5), 1.0 - 9.0 * np.dot([1.0, -1.0], beyond**0.5)


@pytest.mark.parametrize("unknowns", (80, 120))
@pytest.mark.parametrize("first", np.linspace(-0.5, 0.5, 11))
def test_no_pair_of_folds_between_two_corners_is_stepped_over(unknowns, first):
    """However the steps lie to it: p' = 0 at 1/81 of a unit beyond a, and where the roots differ by 1/9."""
    path = follow(
        Narrow(unknowns, first),
        np.append(np.full(unknowns, -0.9), 1.1),
        (1.1, 2.9),
        options=FollowOptions(0.2),
    )
    beyond = [1.0 / 81.0, (0.02 * 9.0 + 1.0 / 9.0) ** 2 / 4.0]
    assert path.z[path.where(Mark.FOLD), 0] - first == pytest.approx(beyond, abs=1e-6)


class Widened(Problem):
    """A problem of two unknowns with a hundred more, which are zero."""

    def __init__(self, inner):
        Problem.__init__(self, 102, inner.margins, 1)
        self.inner, self.margin = inner, inner.margin
        self.matrix = np.asarray(self.jacobian)
        self.matrix[:, :-1] = np.eye(102)

    def evaluate(self, z):
        z = np.asarray(z)
        self.inner.evaluate(z[[0, 1, -1]])
        self.residual[:] = np.append(self.inner.residual, z[2:-1])
        self.matrix[np.ix_([0, 1], [0, 1, -1])] = self.inner.jacobian
        return 0

    def evaluate_scale(self, z):
        self.scale[:] = np.append(np.ones(102), 2.0)
        return 0

    def evaluate_margins(self, z):
        self.inner.evaluate_margins(z)
        return 0

    def evaluate_outputs(self, z, direction):
        self.output[0], self.growth[0] = abs(z[0]), direction[0] * np.sign(z[0])
        return 0


@pytest.mark.parametrize("step", (0.2, 0.05))
@pytest.mark.parametrize("back", [0.5, 20.0])
def test_a_corner_at_which_a_curve_of_many_unknowns_turns_back_is_landed_on(step, back):
    low = min(1.0, 2.0 - back - 0.5)
    z = np.append(np.zeros(102), low)
    z[:2] = low
    path = follow(Widened(zigzag(back)), z, (low, 6.0), options=FollowOptions(step))
    assert path.status is Status.COMPLETE
    folds = path.where(Mark.FOLD)
    assert path.where(Mark.CORNER).tolist() == folds.tolist()
    assert path.z[folds, 0] == pytest.approx([2.0, 3.0], abs=1e-8)
    assert path.parameter[folds] == pytest.approx([2.0, 2.0 - back], abs=1e-8 * back)


@pytest.mark.parametrize("step", (0.2, 0.05))
def test_a_corner_of_many_unknowns_is_gone_to_at_once_and_left_by_a_share_of_the_step(step):
    """Where its other side is found from this one."""
    z = np.append(np.zeros(102), 1.0)
    z[:2] = 1.0
    path = follow(Widened(zigzag(0.5)), z, (1.0, 6.0), options=FollowOptions(step))
    for corner in path.where(Mark.FOLD):
        beside = np.linalg.norm((path.z - path.z[corner])[:, [0, 1, -1]] / [1.0, 1.0, 2.0], axis=1)
        assert np.count_nonzero(beside < 1e-3) <= 3


def test_a_margin_is_the_same_only_within_its_group():
    """However near another of its kind is: here that of the other group, by its angle."""
    problem = Problem(1, 4, 0)
    problem.group = 2
    stepper = Stepper(problem)
    for place, angles in ((stepper.here, (1.0, 2.0, 1.1, 2.1)), (stepper.there, (1.2, 2.2, 1.0, 2.0))):
        np.asarray(place.kind)[:] = (0, 1, 0, 1)
        np.asarray(place.angle)[:] = angles
        np.asarray(place.margin)[:] = np.arange(1.0, 5.0)
    assert [stepper.here.margin_at(k, stepper.there) for k in range(4)] == [1.0, 2.0, 3.0, 4.0]


class Counted(Planar):
    """How often it was evaluated, and how often without its derivatives."""

    evaluated = probed = 0

    def evaluate(self, z):
        self.evaluated += 1
        return super().evaluate(z)

    def evaluate_residual(self, z):
        self.probed += 1
        return super().evaluate(z)


def corrected(f, x, p, costly=False, close=1e-13):
    """Newton's method from x at the parameter p."""
    newton = Newton(Counted(f))
    newton.problem.costly, newton.tolerance = costly, close
    newton.z[:], newton.scale[:] = start(x, p), 1.0
    newton.row[:] = np.array([0.0, 0.0, 1.0])
    assert newton.correct(1.0)
    return newton, (newton.problem.evaluated, newton.problem.probed)


def rooted(x, p):
    """x + |x| ** 1.5 = p, whose derivative changes as a root."""
    return x + abs(x) ** 1.5 - p, 1.0 + 1.5 * np.sqrt(abs(x)), -1.0


@pytest.mark.parametrize("costly", [False, True])
def test_the_last_step_takes_the_derivatives_from_before_where_they_hardly_change(costly):
    """The point is as exact as with those there, the direction to what the step before was long."""
    newton, counts = corrected(circle().f, 3.0 + 2.02 * np.sin(0.5), 2.0 + 2.02 * np.cos(0.5), costly)
    assert counts == (3, 1)
    x, p = newton.z[0], newton.z[2]
    assert x == pytest.approx(3.0 + np.sqrt(4.0 - (p - 2.0) ** 2), rel=1e-15)
    assert newton.tangent[2] / newton.tangent[0] == pytest.approx(-(x - 3.0) / (p - 2.0), rel=1e-4)


def test_where_derivatives_change_as_a_root_the_last_step_takes_its_own():
    """Unless places are costly: the direction is then off by the root of the step before."""
    for costly, off in ((False, 1e-9), (True, 1e-4)):
        newton, (_, probed) = corrected(rooted, 1e-3, 1e-6 + 1e-9, costly)
        assert newton.z[0] == pytest.approx(1e-6, rel=1e-9)
        assert probed == int(costly)
        assert newton.tangent[2] / newton.tangent[0] == pytest.approx(1.0015, rel=off)


def test_where_places_are_costly_each_may_interrupt_the_curve():
    """And not only every few steps: one at a corner may take many."""
    problem, left = Counted(circle().f), iter(range(20))
    problem.costly = True

    def poll():
        if next(left, None) is None:
            raise KeyboardInterrupt

    stepper = Stepper(problem)
    stepper.newton.poll = poll
    with pytest.raises(PathInterrupted) as stopped:
        follow(problem, start(1.0, 2.0), (-1.0, 5.0), stepper=stepper)
    assert 0 < len(stopped.value.path.z) < problem.evaluated == 20


def test_folds_are_known_to_what_points_are_where_only_user_points_matter():
    """Folds at p = 4 and 0, with fewer looks than to rounding."""
    taken = []
    for hasty in (False, True):
        problem = soft_circle()
        seen = evaluations_at(problem)
        newton = NewtonOptions(preliminary_tolerance=1e-4)
        path = follow(problem, start(5.0, 2.0), (-1.0, 5.0), options=FollowOptions(0.2, hasty, newton=newton))
        assert path.parameter[path.where(Mark.FOLD)] == pytest.approx([4.0, 0.0], abs=1e-3)
        taken.append(len(seen) - len(path.z))
    assert taken[1] < taken[0]


def test_a_point_that_need_not_be_close_takes_fewer_evaluations():
    x, p = 3.0 + 2.02 * np.sin(0.5), 2.0 + 2.02 * np.cos(0.5)
    rough, few = corrected(circle().f, x, p, close=1e-9)
    exact, many = corrected(circle().f, x, p)
    assert sum(few) < sum(many)
    assert 1e-15 < abs(rough.z[0] - exact.z[0]) < 1e-9


@pytest.mark.parametrize("last", [2.5, 2.9])
@pytest.mark.parametrize("jumps", [False, True])
def test_a_curve_ends_where_a_function_becomes_negative(last, jumps):
    """Just before; on a circle of radius 2 about (3, 2), where its unknown passes a value."""

    def until(z):
        return 1.0 - 2.0 * (z[0] > last) if jumps else last - z[0]

    events = Events(ends=[End(lambda z: 1.0), End(until)])
    path = follow(circle(), start(1.0, 2.0), (-1.0, 5.0), events, FollowOptions(0.1))
    assert path.status is Status.EVENT and path.ended_by == 1
    assert last - 1e-9 < path.z[-1, 0] <= last
    assert path.parameter[-1] == pytest.approx(2.0 + np.sqrt(4.0 - (last - 3.0) ** 2), abs=1e-8)


def test_a_curve_ends_at_the_first_event_of_a_kind():
    path = follow(cubic(), start(-1.32, 1.0), (1.0, 3.0), Events(last=Mark.FOLD), FollowOptions(0.1))
    assert path.status is Status.EVENT and path.where(Mark.FOLD).tolist() == [len(path.z) - 1]


def test_a_curve_may_begin_in_any_direction():
    """At the fold of a circle, where the parameter neither rises nor falls."""
    top = start(3.0, 4.0)
    path = follow(circle(), top, (-1.0, 5.0), options=FollowOptions(0.1), direction=np.array([1.0, 1.0, 0.0]))
    assert path.status is Status.CLOSED and path.z[1, 0] > 3.0


OLD_AND_NEW = {
    "probe": "evaluate_residual",
    "measure": "evaluate_scale",
    "bound": "evaluate_margins",
    "report": "evaluate_outputs",
    "square": "squared_margin",
}


@pytest.mark.parametrize(("old", "new"), OLD_AND_NEW.items())
def test_a_function_of_a_problem_by_its_old_name_alone_is_refused(old, new):
    """It was not called, and the curve had no peaks or no corners."""

    def function(self, *arguments):
        return 0

    problem = type("Beam", (Problem,), {"evaluate": function, old: function})
    with pytest.raises(TypeError, match=f"Beam.{old}: this function of a problem is {new} now"):
        problem(1, 1, 1)
    with pytest.raises(TypeError, match=f"Plate.{old}"):
        type("Plate", (problem,), {})(1, 1, 1)
    both = type("Beam", (Problem,), {"evaluate": function, old: function, new: function})
    assert both(1, 1, 1).outputs == 1
