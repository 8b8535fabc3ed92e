"""The blade whose peaks are measured with fewer and fewer modes."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.linalg

from . import kept_modes, plane_blade


def test_the_blade_is_one_of_steel():
    """Its mass, no strain when it moves as a whole, and the first bending of a slender strip."""
    made = plane_blade.blade(60, 4)
    K, M = made.stiffness.toarray(), made.mass.toarray()
    value = scipy.linalg.eigh(K, M, eigvals_only=True, subset_by_index=[0, 0])
    slender = 1.875104**2 * np.sqrt(2.1e11 / 7800.0 / 12.0) * 0.02 / 0.2**2
    assert np.sqrt(value[0]) == pytest.approx(slender, rel=0.03)
    element_K, element_M = plane_blade._element(0.004, 0.004)
    turned = np.stack((-plane_blade.CORNERS[:, 1], plane_blade.CORNERS[:, 0]), axis=1).ravel()
    for still in (np.tile([1.0, 0.0], 4), np.tile([0.0, 1.0], 4), turned):
        assert np.abs(element_K @ still).max() < 1e-9 * np.abs(element_K).max()
    assert np.tile([1.0, 0.0], 4) @ element_M @ np.tile([1.0, 0.0], 4) == pytest.approx(
        7800 * 0.004**2 * 0.005
    )


def test_errors_are_within_the_bounds_and_far_from_those_without_flexibility():
    made = plane_blade.blade(20, 2)
    scene = plane_blade.blade_scene(made, preloads=(300.0,))
    rows = kept_modes.errors(scene, f"{made.middle}y", (4, 12))
    for one in rows:
        assert all(x < bound for x, bound in zip(one.with_flexibility, one.bound, strict=True))
        assert all(10.0 * x < y for x, y in zip(one.with_flexibility, one.without, strict=True))
    assert rows[1].with_flexibility < rows[0].with_flexibility
    assert kept_modes.texts(rows)[1][0] == "12"
