"""Stability along a curve of many contacts, of which few points are looked at."""

import numpy as np
import pytest

from fcm.branches.trace import traced
from fcm.harmonic_balance.system import System
from fcm.stability.bifurcations import stability
from fcm.stability.floquet import multipliers_of

from ..harmonic_balance.strips import strip


@pytest.mark.slow
@pytest.mark.parametrize(("harmonics", "looks"), [((1,), 0.4), ((1, 2, 3), 0.5)])
def test_few_points_tell_the_stability_of_all(harmonics, looks):
    """Beside the multipliers of every point, as far as these tell."""
    system = System(strip(), harmonics)
    path = traced(system).branches.paths[0]
    found = stability(system, path)
    assert found.evaluations < looks * len(path.z)
    of = multipliers_of(system, float(path.parameter.max()))
    even = path.orientation * np.sign(path.direction[:, -1]) > 0.0
    assert not found.stable[~even & (path.mark == 0)].any()
    each = np.array([of.verdict(z).stable for z in path.z[even]])
    told = ~np.isnan(each) & ~np.isnan(found.stable[even])
    assert told.mean() > 0.9
    assert (each[told] == found.stable[even][told]).all()
