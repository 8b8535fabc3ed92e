"""The error of a table over the plane: the same that calling both would give, and its worst point."""

import numpy as np
import pytest

import fcm
from fcm.contact.surface import COEFFICIENTS, ParameterPlane, boundaries
from fcm.table.error_map import error_map

PLANE = ParameterPlane(0.5)


class Wrong:
    """A table whose F_s is too large around one point, most by 0.01."""

    at = (0.3212345, 0.5678901)
    width = 0.2

    def __call__(self, n0, b, phi):
        F_b, F_s, F_c = fcm.fourier_coefficients(n0, b, phi)
        distance = np.hypot(n0 - self.at[0], b - self.at[1])
        return F_b, F_s + 0.01 * np.maximum(1.0 - distance / self.width, 0.0), F_c


def test_the_worst_point_is_found_between_the_cells():
    found = error_map("F_s", PLANE, Wrong(), steps=(50, 20))
    assert found.worst == pytest.approx(Wrong.at, abs=1e-4)
    assert found.largest == pytest.approx(0.01, rel=1e-3)
    assert found.error.shape == (20, 50) and found.error.max() < found.largest


def test_no_error_is_no_error():
    found = error_map("F_c", PLANE, fcm.fourier_coefficients, steps=(50, 20))
    assert found.largest == 0.0 and not found.error.any()


@pytest.mark.parametrize("coefficient", COEFFICIENTS)
def test_of_the_shipped_table_no_point_is_worse_than_its_record(default, coefficient):
    found = error_map(coefficient, PLANE, default)
    assert found.error.max() <= found.largest <= default.error["max"]
    n0, b = found.worst
    index = COEFFICIENTS.index(coefficient)
    error = abs(default(n0, b, 0.5)[index] - fcm.fourier_coefficients(n0, b, 0.5)[index])
    assert found.largest == pytest.approx(float(error), abs=1e-14)


@pytest.mark.parametrize(("name", "phi"), [("default", 0.0), ("fast", np.pi / 6)])
def test_no_other_point_is_worse(request, name, phi):
    table = request.getfixturevalue(name)
    random = np.random.default_rng(7)
    b = random.uniform(0.0, 2.0, 200_000)
    share = random.random(b.size)
    slip = b + (boundaries(b, phi)["slip"] - b) * share
    n0 = np.where(random.random(b.size) < 0.6, -b * np.cos(np.pi * share), slip)
    exact = fcm.fourier_coefficients(n0, b, phi)
    for k, values in enumerate(table(n0, b, phi)):
        greatest = abs(values - exact[k]).max()
        assert error_map(COEFFICIENTS[k], ParameterPlane(phi), table).largest > 0.99 * greatest


def test_the_error_belongs_to_the_middle_of_each_cell(default):
    found = error_map("F_s", PLANE, default, steps=(10, 4))
    assert found.n0_bar.shape == (11,) and found.b_bar.shape == (5,)
    n0, b = -2.0 + 0.5 * 6.5, 0.5 * 1.5
    error = default(n0, b, 0.5)[1] - fcm.fourier_coefficients(n0, b, 0.5)[1]
    assert found.error[1, 6] == pytest.approx(abs(float(error)), abs=1e-15)
