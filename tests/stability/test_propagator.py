"""Disturbances carried by eigenvalues, beside the matrix exponential."""

import numpy as np
from scipy.linalg import expm

from fcm.stability.disturbance import Propagator

KEY = b"a state"


def system(omega, modes=7, contacts=2):
    """Of a state with slip, so that K is not symmetric, by the angle."""
    rng = np.random.default_rng(4)
    K = np.diag(np.linspace(0.5, 9.0, modes)) + 0.3 * rng.normal(size=(modes, modes))
    return (
        K / omega**2,
        0.02 * np.arange(1.0, modes + 1.0) / omega,
        rng.normal(size=(modes, contacts)) / omega**2,
    )


def test_a_state_seen_again_is_carried_as_by_the_exponential_at_any_frequency():
    propagator = Propagator()
    rng = np.random.default_rng(1)
    assert not propagator.through(KEY, 1.0, 1.0, lambda: system(1.0), rng.normal(size=(16, 5)))
    for omega, angle in ((1.0, 2.0), (0.7, 0.01), (1.6, 5.5)):
        K, D, B = system(omega)
        m, contacts = B.shape
        A = np.zeros((2 * m + contacts, 2 * m + contacts))
        A[:m, m : 2 * m] = np.eye(m)
        A[m : 2 * m] = np.hstack((-K, -np.diag(D), B))
        X = rng.normal(size=(2 * m + contacts, 5))
        expected = expm(A * angle) @ X
        assert propagator.through(KEY, angle, omega, lambda made=(K, D, B): made, X)
        np.testing.assert_allclose(X, expected, rtol=1e-9, atol=1e-9)


def test_a_state_whose_eigenvectors_are_dependent_is_left_to_the_series():
    """A mode that nothing holds goes on at its speed: its two eigenvectors are one."""
    K, D, B = system(1.0)
    K[0], K[:, 0], D[0] = 0.0, 0.0, 0.0
    propagator = Propagator()
    for _ in range(3):
        assert not propagator.through(KEY, 1.0, 1.0, lambda: (K, D, B), np.eye(16))


def test_where_no_contact_sticks_the_places_do_not_matter():
    propagator = Propagator()
    K, D, B = system(1.0)
    A = np.block([[np.zeros_like(K), np.eye(len(D))], [-K, -np.diag(D)]])
    for carried in (False, True):
        X = np.eye(16)
        assert propagator.through(KEY, 1.5, 1.0, lambda: (K, D, 0.0 * B), X) == carried
    np.testing.assert_allclose(X[:14, :14], expm(1.5 * A), rtol=1e-9, atol=1e-9)
    np.testing.assert_array_equal(X[:14, 14:], 0.0)
