"""Branches that only those of fewer harmonics lead to."""

import numpy as np
import pytest

from fcm.harmonic.beside import beside
from fcm.harmonic.error import reported
from fcm.harmonic.system import System
from fcm.harmonic.trace import traced

from ..response.random_scenes import random_scene
from .truth import exact


def test_a_closed_branch_is_not_lost_with_more_harmonics():
    """Whose highest peak is stable, and which no level of the forces leads to."""
    fewer = System(random_scene(1), (1, 2, 3, 4, 5))
    paths = traced(fewer).branches.paths
    more = fewer.with_harmonics(range(1, 11))
    near = beside(fewer, paths, [reported(fewer, path).amplitude for path in paths], more.harmonics)
    alone = [reported(more, path).amplitude[:, 0].max() for path in traced(more).branches.paths]
    closed = [path for path in traced(more, near=near).branches.paths if path.status.name == "CLOSED"]
    (path,) = closed
    amplitude = reported(more, path).amplitude
    top = int(amplitude[:, 0].argmax())
    assert amplitude[top, 0] > 1.2 * max(alone)
    assert exact(more, path.z[top]) == pytest.approx(amplitude[top], rel=2e-2)
    assert np.ptp(path.parameter) < 0.2
