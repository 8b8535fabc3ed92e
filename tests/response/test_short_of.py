"""What is said of a curve that falls short of the accuracy."""

from types import SimpleNamespace

import numpy as np
import pytest

from fcm.response.accuracy_shortfall import exact_is_advised, shortfall


def scene_at(*dofs, contacts=()):
    modal = SimpleNamespace(dofs=dofs)
    return SimpleNamespace(modal=modal, ring=None, planar=False, with_own_laws=False, contacts=contacts)


@pytest.mark.parametrize(("count", "advised"), [(12, True), (13, False)])
def test_the_exact_motion_is_not_advised_for_many_contacts(count, advised):
    assert exact_is_advised(scene_at("tip", contacts=(None,) * count)) is advised


def test_it_is_said_whose_peaks_fall_short():
    """Not those of which no accuracy is asked."""
    found = SimpleNamespace(
        reached=False, folds=np.empty(0), peak=np.array([1e-3, 2e-2, 9.0, 3e-2]),
        max_error=3e-2, max_known_error=3e-2,
        further=(), system=SimpleNamespace(harmonics=(1,), scene=scene_at("tip", "root", "still", "axis")),
        dofs_of_interest=np.array([True, True, False, True]),
    )  # fmt: skip
    said = "error of 3.0e-02 remains (of 3 peaks, those of axis, root)"
    assert f"{said}. For smaller errors try" in shortfall(found, [], 1e-2)


@pytest.mark.parametrize(
    ("height", "said"),
    [(2e-3, "remains (of root, whose peak is 0.2 % of the greatest). "), (0.5, "remains. ")],
)
def test_where_all_peaks_fall_short_it_is_said_how_low_the_worst_is(height, said):
    found = SimpleNamespace(
        reached=False, folds=np.empty(0), peak=np.array([2e-2, 8.8]), max_error=8.8, max_known_error=8.8,
        further=(), system=SimpleNamespace(harmonics=(1,), scene=scene_at("tip", "root")),
        dofs_of_interest=np.array([True, True]), height=np.array([1.0, height]),
    )  # fmt: skip
    assert said in shortfall(found, [], 1e-2)


@pytest.mark.parametrize(("accuracy", "remains"), [(0.5, False), (1e-2, True)])
def test_an_error_within_the_accuracy_is_no_reason(accuracy, remains):
    """Folds whose errors are unknown keep the curve from it; its peaks only where they are far off."""
    found = SimpleNamespace(
        reached=False, folds=np.array([np.nan, 1e-3]), peak=np.array([2.8e-2]),
        max_error=np.nan, max_known_error=2.8e-2,
        further=(), system=SimpleNamespace(harmonics=(1, 2, 3), scene=scene_at("u")),
        dofs_of_interest=np.array([True]), height=np.array([1.0]),
    )  # fmt: skip
    said = shortfall(found, [], accuracy)
    assert ("an estimated error of 2.8e-02 remains" in said) == remains
    assert "1 of 2 folds are unknown" in said
