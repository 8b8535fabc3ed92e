"""What the methods of a comparison yield."""

import pytest

from fcm.compare.methods import CLOSED_FORM, EXACT, Method, solve
from fcm.scene import scene_from_dict

LAW = {"mu": 0.4, "k_u": 1.0, "k_v": 1.0, "n_0": 10.0}


@pytest.mark.parametrize("method", [CLOSED_FORM, EXACT])
def test_only_what_the_scene_reports_is_compared(method):
    """And not the displacement that the motion of a base works on, which no result has."""
    scene = scene_from_dict(
        {
            "modal": {
                "dofs": ["u", "v", "w"], "frequency": [1.0, 10.0], "damping": [0.05, 0.05],
                "shapes": [[0.7, 0.7, 3.0], [1.0, -0.5, 5.0]], "participation": [1.0, 0.3],
            },
            "base": {"acceleration": 1.0},
            "contact": [{"name": "c", "tangential": "u", "normal": "v"} | LAW],
            "response": {"frequency": [1.2, 1.25], "output": ["v"], "harmonics": 1},
        }
    )  # fmt: skip
    (line,) = solve(Method(method), scene, None)
    assert line.complete
    assert [*line.peaks] == ["u", "v"]
    assert line.amplitude.shape == (line.frequency.size, 2)
