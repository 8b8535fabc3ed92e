"""Every test of the contact runs with floating-point errors raised, not warned of or ignored."""

import numpy as np
import pytest


@pytest.fixture(autouse=True, scope="module")
def strict_arithmetic():
    # underflow to zero is what should happen to terms of order 1e-300
    before = np.seterr(all="raise", under="ignore")
    yield
    np.seterr(**before)
