"""Peaks and folds do not depend on the longest step, with any number of harmonics."""

import numpy as np
import pytest

from fcm import load_scene
from fcm.continuation import FollowOptions, Mark, Status, all_branches
from fcm.continuation.all_branches import Following

from ..time_domain.cases import yang
from .scenes import Curves, gap5, up_to

STEPS = (0.2, 0.1, 0.05, 0.02)
FINEST = 0.005
SCENES = {"n_0 = 5": yang(5.0), "n_0 = -5": yang(-5.0), "gap5": gap5()}


@pytest.mark.slow
@pytest.mark.parametrize("count", [1, 2, 3, 5])
@pytest.mark.parametrize("name", SCENES)
def test_the_same_for_every_step(name, count):
    finest = Curves(SCENES[name], up_to(count), max_step=FINEST)
    assert finest.branches.status is Status.COMPLETE
    for step in STEPS:
        curves = Curves(SCENES[name], up_to(count), max_step=step)
        assert curves.branches.status is Status.COMPLETE and len(curves.paths) == len(finest.paths)
        assert np.sort(curves.folds) == pytest.approx(np.sort(finest.folds), rel=1e-7)
        highest = finest.amplitude.max(axis=0)
        assert curves.amplitude.max(axis=0) == pytest.approx(highest, rel=1e-7)


@pytest.mark.parametrize("step", STEPS)
def test_a_solution_next_to_a_fold_lies_on_the_branch_that_passes_it(step):
    """The points before and after a fold, where a finer step has come, are within 1e-5 of its frequency."""
    scene = yang(5.0)
    finest = Curves(scene, (1,), max_step=FINEST)
    (fine,) = finest.paths
    beside = [fine.z[fold + side] for fold in fine.where(Mark.FOLD) for side in (-1, 1)]
    away = np.repeat(finest.folds, 2) - [z[-1] for z in beside]
    assert np.all((np.abs(away) > 0.0) & (np.abs(away) < 1e-5))
    starts = [fine.z[0], *beside]
    found = all_branches(
        finest.system.new_balance, starts, scene.frequency_range, Following(FollowOptions(step))
    )
    assert found.status is Status.COMPLETE and len(found.paths) == 1


@pytest.mark.parametrize("step", STEPS)
def test_no_curve_leaves_its_range_unseen(step):
    """Springs of 1e8 and 1e-8: what rounding makes of the equations is far above that of their unknowns."""
    scene = load_scene("extreme/stiff-and-soft")
    low, high = scene.frequency_range
    curves = Curves(scene, (1,), max_step=step)
    assert curves.branches.status is Status.COMPLETE
    for path in curves.paths:
        assert low <= path.parameter.min() and path.parameter.max() <= high


@pytest.mark.parametrize("count", [1, 3, 9])
def test_the_work_is_bounded(count):
    """Evaluations for a point, with all that is located: corners, folds, peaks and ends."""
    curves = Curves(yang(5.0), up_to(count))
    points = sum(path.z.shape[0] for path in curves.paths)
    assert sum(path.evaluations for path in curves.paths) < 8 * points
