"""Where a tracked curve has no derivatives: at kinks, and where the response crosses itself."""

from types import SimpleNamespace

import numpy as np
import pytest

from fcm.harmonic_balance.dense_jacobian import jacobian_of
from fcm.harmonic_balance.system import System
from fcm.scene import load_scene
from fcm.scene.draft import number_of
from fcm.tracking import extended_system
from fcm.tracking.curve import both_ways
from fcm.tracking.extended_system import Condition, Kind
from fcm.tracking.kinks import Circle
from fcm.tracking.nonsmooth_continuation import SmoothPieces, land
from fcm.tracking.options import TRACKING
from fcm.tracking.parameter_line import line_along
from fcm.tracking.peak_check import is_top
from fcm.tracking.start_points import special_points
from fcm.tracking.tracked_point import Ending, TrackedPoint, TrackingSetup

RADIUS = 1e-4
PEAK = Condition(Kind.PEAK, 0)


@pytest.fixture(scope="module")
def setup():
    scene = load_scene("yang1998-n5")
    return TrackingSetup(System(scene, (1,)), line_along(number_of(scene, "contact.shroud.n_0")), (4.0, 10.0))


@pytest.fixture(scope="module")
def point(setup):
    """A peak, on which a curve of peaks runs through."""
    here = setup.system.with_scene(setup.line.scene(setup.system.scene, 5.0))
    (_, z), *_ = special_points(here, [PEAK])[0]
    return land(setup, PEAK, np.append(z, 5.0))


class Plane(SimpleNamespace):
    """All solutions are those with z_2 = 0, and what is special is z_1; aside, near its zero, nothing is."""

    options, scale = TRACKING, np.ones(3)

    def surface(self, z):
        if abs(z[1]) < self.blind * RADIUS < abs(z[0]):
            raise np.linalg.LinAlgError
        return z[2:], np.eye(3)[2:], z[1]


@pytest.mark.parametrize(
    ("blind", "ways"), [(0.0, 1), (1e-4, 0), (0.5, 0)], ids=["all", "none at the zero", "none about it"]
)
def test_a_circle_on_which_there_is_no_motion_leads_nowhere(blind, ways):
    circle = Circle(Plane(blind=blind), np.zeros(3), np.eye(3)[0], RADIUS)
    found = circle.changes(np.array([-RADIUS, 0.0, 0.0]))
    assert [np.cos(one.angle) for one in found] == pytest.approx([1.0] * ways)


@pytest.mark.parametrize(("cosine", "taken"), [(0.95, True), (0.5, False)], ids=["away", "passing by"])
def test_from_a_kink_a_curve_goes_on_only_along_a_line_that_leads_away(setup, point, cosine, taken):
    """A curve crosses the circle in both cases; its angle with the radius tells whether it is the way on."""
    follower = SmoothPieces(setup, PEAK)
    follower.switch_equations(None)
    follower.measure_at(point.z)
    assert follower.solve(point.z, follower.held)
    follower.accept()
    follower.points = [follower.point_at(follower.z, follower.t)]
    there, scale = follower.z, np.array(follower.newton.scale)
    aside = np.eye(there.size)[-1] - follower.t[-1] * follower.t
    radius = cosine * follower.t + np.sqrt(1.0 - cosine**2) * aside / np.linalg.norm(aside)
    follower.z = there - RADIUS * scale * radius
    assert (follower.turn_to(there, RADIUS) is not None) == taken


def test_where_the_response_crosses_itself_there_is_a_direction_and_no_peak(setup, point, monkeypatch):
    """Exactly: of its Jacobian one row is nothing, and no matrix closed by another can be solved."""
    problem = setup.tracked(PEAK)
    problem.evaluate_scale(point.z)

    def crossed(balance):
        found = jacobian_of(balance)
        found[0] = 0.0
        return found

    monkeypatch.setattr(extended_system, "jacobian_of", crossed)
    t = problem.along(point.z)[0]
    y = np.array(point.z[:-1])
    problem.varied.balance.evaluate(y)
    assert np.linalg.norm(t) == pytest.approx(1.0)
    assert crossed(problem.varied.balance) @ (np.asarray(problem.scale)[:-1] * t) == pytest.approx(
        0.0, abs=1e-12
    )
    assert not is_top(problem, TrackedPoint(point.z, point.direction))


@pytest.mark.slow
def test_a_peak_is_not_followed_along_a_corner_at_which_its_condition_jumps():
    """A contact of the blade begins another slip within its cycle there: no onset that is tracked."""
    blade = load_scene("blade")
    number = number_of(blade, "contact.*.n_0")
    setup = TrackingSetup(System(number.freed(blade), (1, 2, 3)), line_along(number), (9.7, 9.8), step=0.05)
    condition = Condition(Kind.PEAK, blade.modal.dofs.index("40y"))
    here = setup.system.with_scene(setup.line.scene(setup.system.scene, 9.8))
    starts = [z for _, z in special_points(here, [condition]).points if 2240.0 < z[-1] < 2245.0]
    found = both_ways(setup, condition, land(setup, condition, np.append(starts[0], 9.8)))
    assert len(starts) == 1
    assert Ending.CORNER in found.endings
    for point in found.points:
        problem = setup.tracked(condition)
        problem.evaluate_scale(point.z)
        problem.evaluate(point.z)
        assert abs(problem.residual[-1]) < 1e-6 * problem.scale[problem.n]
