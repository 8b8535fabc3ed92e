"""What is said of a curve that falls short of the accuracy."""

from types import SimpleNamespace

import numpy as np
import pytest

from fcm.response.short_of import short_of


@pytest.mark.parametrize(("accuracy", "remains"), [(0.5, False), (1e-2, True)])
def test_an_error_within_the_accuracy_is_no_reason(accuracy, remains):
    """Folds whose errors cannot be told keep the curve from it; its peaks only where they are far off."""
    found = SimpleNamespace(
        reached=False, folds=np.array([np.nan, 1e-3]), peak=np.array([2.8e-2]), worst=np.nan, told=2.8e-2,
        further=(), system=SimpleNamespace(harmonics=(1, 2, 3)),
    )  # fmt: skip
    said = short_of(found, [], accuracy)
    assert ("an estimated error of 2.8e-02 remains" in said) == remains
    assert "1 of 2 folds cannot be told" in said
