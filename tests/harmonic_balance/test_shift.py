"""How far the table's solutions are from those of the closed form."""

import numpy as np

import fcm
from fcm.branches.trace import traced
from fcm.continuation import Mark
from fcm.continuation.corrector import Newton
from fcm.harmonic_balance.reported_quantities import recorded, table_errors
from fcm.harmonic_balance.system import System

BESIDE_CORNERS = 8  # points, which are moved otherwise


def test_the_error_is_the_distance_to_the_solution_by_the_table_alone_and_none_where_nothing_slips():
    scene, table = fcm.load_scene("yang1998-n5"), fcm.open_table()
    system = System(scene, (1,), table)
    points = recorded(system, traced(system).branches.paths)
    newton, problem = Newton(balance := System(scene, (1,), table, corrected=False).new_balance()), balance
    corners = np.flatnonzero(points.mark & (Mark.CORNER | Mark.END))
    error, found, nothing = table_errors(system, points), [], 0
    for i, (z, direction) in enumerate(zip(points.z, points.tangent, strict=True)):
        if np.abs(i - corners).min() < BESIDE_CORNERS:
            continue
        problem.evaluate_scale(z)
        newton.z[:], newton.scale[:] = z, problem.scale
        row = direction / np.asarray(problem.scale)
        newton.row[:] = row / np.linalg.norm(row)
        assert newton.correct(1e-3)
        if points.linear[i]:
            assert newton.moved < 1e-12 and error[i] == 0.0
            nothing += 1
        else:
            found.append((error[i], newton.moved * np.sqrt(system.layout.ports)))
    errors, distances = np.array(found).T
    assert nothing > 10 and len(found) > 100
    # one step misses what the table's splines bend by: at one point in forty that is much
    assert np.quantile(np.abs(errors / distances - 1.0), 0.95) < 0.02
    assert 0.5 * distances.max() < errors.max() < 2.0 * distances.max()
