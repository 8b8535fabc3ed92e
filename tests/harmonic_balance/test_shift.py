"""What the closed form changes of the points that the table leads to."""

import numpy as np
import pytest

import fcm
from fcm.branches.trace import traced
from fcm.continuation.corrector import Newton
from fcm.harmonic_balance.system import System


def test_the_shift_is_the_distance_to_the_solution_by_the_table_alone_and_none_where_nothing_slips():
    scene, table = fcm.load_scene("yang1998-n5"), fcm.open_table()
    path = traced(System(scene, (1,), table)).branches.paths[0]
    newton = Newton(System(scene, (1,), table, corrected=False).balance())
    problem, found, nothing = newton.problem, [], 0
    plain = path.mark == 0  # what happens within a step has the shift of its end
    for z, direction, shift in zip(path.z[plain], path.direction[plain], path.shift[plain], strict=True):
        problem.measure(z)
        newton.z[:], newton.scale[:] = z, problem.scale
        row = direction / np.asarray(problem.scale)
        newton.row[:] = row / np.linalg.norm(row)
        assert newton.correct(1e-3)
        if problem.laws[0].mixed:
            found.append((shift, newton.moved))
        else:
            assert newton.moved < 1e-12 and shift == 0.0
            nothing += 1
    shifts, distances = np.array(found).T
    assert nothing > 20 and len(found) > 100
    assert np.median(shifts / distances) == pytest.approx(1.0, rel=0.02)
    assert 0.5 * distances.max() < shifts.max() < 2.0 * distances.max()
