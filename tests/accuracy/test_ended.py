"""Points beside a fold that further harmonics move past them: the branch has ended there."""

import pytest

from fcm.accuracy.refinement import with_given_harmonics
from fcm.continuation import Mark
from fcm.harmonic_balance.system import System
from fcm.scene import scene_from_dict


@pytest.mark.slow
def test_nothing_is_told_of_what_further_harmonics_have_no_branch_of():
    """A gap that closes three times a period: with twice as many harmonics the fold is 0.5 % lower."""
    one = scene_from_dict(
        {
            "modal": {
                "dofs": ["a", "b", "c", "d", "e"],
                "frequency": [1.0, 6.2328, 6.7491, 7.2062, 7.4063],
                "damping": [0.006541, 0.0172, 0.05226, 0.005043, 0.006345],
                "shapes": [
                    [2.487, 0.1806, 0.408, 0.8382, -1.395], [-0.1171, -1.425, 1.388, 1.755, 1.552],
                    [0.264, -0.243, -0.4886, 0.8388, -0.8269], [-0.8322, 0.4381, -0.3573, -0.5705, -1.615],
                    [1.594, 0.05507, 0.4198, 0.5681, 0.2941],
                ],
            },
            "contact": [
                {"name": "c", "tangential": "c", "normal": "d", "mu": 0.9663, "k_u": 10.948, "k_v": 4.1112,
                 "n_0": -0.41804}
            ],
            "force": [
                {"dof": {"a": -0.8045, "b": 1.265, "c": 0.3145, "d": -1.063, "e": 1.01}, "amplitude": 1.0,
                 "phase": 4.2819}
            ],
            "response": {"frequency": [0.27, 0.285]},
        }
    )  # fmt: skip
    found = with_given_harmonics(System(one, (*range(1, 10), 11, 12)))
    ((path, errors),) = _with_a_fold(found.traced.branches.paths, found.errors)
    many = with_given_harmonics(System(one, tuple(range(1, 25))))
    ((finer, _),) = _with_a_fold(many.traced.branches.paths, many.errors)
    end = finer.parameter.max()
    assert end < 0.996 * path.parameter.max()
    beyond = path.parameter > 1.0001 * end
    assert beyond.sum() > 20
    assert not errors.is_same_curve[beyond].any()
    assert errors.is_same_curve[~beyond].mean() > 0.5


def _with_a_fold(paths, errors):
    """The branches that turn back, with their errors."""
    return [(path, one) for path, one in zip(paths, errors, strict=True) if path.where(Mark.FOLD).size]
