"""Both packages that factorise matrices, beside dense solutions."""

from __future__ import annotations

import _thread
import os
import signal
import tracemalloc
from contextlib import suppress
from threading import Event

import numpy as np
import pytest
import scipy.sparse
from scipy.sparse.linalg import splu

from fcm.scene import scene_from_dict
from fcm.structure.eigen import StructureError, factored_structure
from fcm.structure.elimination_tree import FrontOptions, tree_of
from fcm.structure.factor import FactorOptions, NotPositiveError, by_blocks, has_cholmod, solver
from fcm.structure.multifrontal import Factor

from .solids import bricks

PACKAGES = [
    FactorOptions("SuperLU"),
    FactorOptions("SuperLU", polled_entries=0, poll_interval=0.001),
    FactorOptions("SuperLU", dissection_size=0),
    FactorOptions("SuperLU", solved_entries=1),
    FactorOptions("fronts"),
    FactorOptions("fronts", fronts=FrontOptions(max_zeros=0.0, max_zeros_of_few=0.0)),
    FactorOptions("fronts", fronts=FrontOptions(max_zeros=1.0)),
    pytest.param(
        FactorOptions("CHOLMOD", superlu_size=0),
        marks=pytest.mark.skipif(not has_cholmod(), reason="needs scikit-sparse"),
    ),
]


@pytest.mark.parametrize("options", PACKAGES)
@pytest.mark.parametrize("turned", [False, True])  # Hermitian
def test_solutions(options, turned):
    K = bricks(3, 2, 2)[0]
    if turned:
        phase = scipy.sparse.diags_array(np.exp(1j * np.arange(K.shape[0])))
        K = phase @ K @ phase.conj()
    loads = np.random.default_rng(0).standard_normal((K.shape[0], 3))
    solve = solver(K, options=options)
    exact = np.linalg.solve(K.toarray(), loads)
    assert solve(loads.astype(K.dtype)) == pytest.approx(exact, rel=1e-9, abs=1e-9 * np.abs(exact).max())
    assert solve(loads[:, 0].astype(K.dtype)) == pytest.approx(
        exact[:, 0], rel=1e-9, abs=1e-9 * np.abs(exact).max()
    )


def test_loads_are_solved_for_by_blocks_between_which_a_signal_ends_it():
    K, seen = bricks(2, 2, 2)[0], []
    loads = np.random.default_rng(0).standard_normal((K.shape[0], 5))

    def solve(some):
        seen.append(some.shape[1])
        return some / 2.0

    np.testing.assert_array_equal(by_blocks(solve, 2 * K.shape[0], loads), loads / 2.0)
    assert seen == [2, 2, 1]


@pytest.mark.parametrize("options", PACKAGES)
def test_negative_eigenvalues_are_counted(options):
    K = bricks(2, 2, 2)[0]
    value = np.linalg.eigvalsh(K.toarray())
    turned = K - 0.5 * (value[2] + value[3]) * scipy.sparse.eye_array(K.shape[0])
    with pytest.raises(NotPositiveError) as refused:
        solver(turned, options=options)
    assert refused.value.negative == 3


def filled(matrix, order):
    """Entries of the factors in an order of the rows."""
    there = scipy.sparse.csc_array(matrix[order][:, order])
    options = {"SymmetricMode": True}
    return splu(there, permc_spec="NATURAL", diag_pivot_thresh=0.0, options=options).nnz


def test_nested_dissection_fills_less_than_the_order_of_the_mesh():
    K = bricks(6, 6, 6)[0]
    order = tree_of(K).order
    assert sorted(order) == list(range(K.shape[0]))
    assert filled(K, order) < 0.8 * filled(K, np.arange(K.shape[0]))


@pytest.mark.parametrize("options", [FactorOptions("fronts"), FactorOptions("SuperLU")])
def test_inertia_of_random_matrices(options):
    """Also of pivots that none of the fronts has positive, and in Hermitian matrices."""
    rng = np.random.default_rng(1)
    for number in range(12):
        rows = int(rng.integers(4, 90))
        part = scipy.sparse.random_array((rows, rows), density=3 / rows, rng=rng)
        if number % 2:
            part = part * (1.0 + 1j)
        matrix = scipy.sparse.csc_array(
            part + part.conj().T + scipy.sparse.diags_array(rng.normal(0, 3, rows))
        )
        value = np.linalg.eigvalsh(matrix.toarray())
        with pytest.raises(NotPositiveError) as refused:
            solver(matrix, options=options)
        assert refused.value.negative in ((value < 0).sum(), None)
        if options.package == "fronts":
            assert refused.value.negative == (value < 0).sum()
            loads = rng.standard_normal((rows, 2)).astype(matrix.dtype)
            found = solver(matrix, definite=False, options=options)(loads)
            assert matrix @ found == pytest.approx(loads, abs=1e-8)


def test_a_singular_matrix_is_said():
    with pytest.raises(NotPositiveError) as refused:
        solver(
            scipy.sparse.csc_array([[1.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
            options=FactorOptions("fronts"),
        )
    assert refused.value.negative == 0


def test_fronts_keep_one_triangle():
    """Less than SuperLU keeps in the same order, whose copy of its pivots took as much again."""
    K = bricks(12, 8, 8)[0]
    tree = tree_of(K)
    factor = Factor(K, tree)
    kept = sum(front.pivots.size + front.beneath.size for front in factor.fronts)
    assert kept == tree.entries < 0.8 * filled(K, tree.order)


@pytest.mark.parametrize("coupled", [False, True])
def test_rows_that_nothing_couples_are_ordered(coupled):
    """And entries that one triangle alone has, as the other is an exact zero."""
    K = scipy.sparse.diags_array(np.arange(1.0, 41.0)).tolil()
    if coupled:
        K[3, 7] = 1e-300
    loads = np.ones(40)
    solve = solver(K, options=FactorOptions("fronts"))
    assert solve(loads) == pytest.approx(1.0 / np.arange(1.0, 41.0), rel=1e-12)


@pytest.mark.slow
def test_nothing_is_dense_in_the_number_of_rows(tmp_path):
    """A square of thirty thousand numbers would be 7 GB."""
    rows = 30_000
    K = scipy.sparse.diags_array(
        [np.full(rows - 1, -1.0), np.full(rows, 2.0), np.full(rows - 1, -1.0)], offsets=(-1, 0, 1)
    )
    scipy.sparse.save_npz(tmp_path / "K.npz", K.tocsc())
    names = [f"{i}x" for i in range(1, rows + 1)]
    contact = {
        "name": "c",
        "tangential": "30000x",
        "normal": "1x",
        "mu": 0.3,
        "k_u": 1.0,
        "k_v": 1.0,
        "n_0": 1.0,
    }
    data = {
        "structure": {"dofs": names, "stiffness": "K.npz", "mass": [1.0] * rows, "damping": 0.01, "modes": 3},
        "contact": [contact | {"n_0": 1.0}],
        "force": [{"dof": "30000x", "amplitude": 1.0}],
        "response": {"frequency": [1e-5, 1e-4]},
        "sweep": {"contact.c.tangential.7x": [0.0, 1.0]},
    }
    tracemalloc.start()
    scene = scene_from_dict(data, "long.toml", tmp_path)
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert scene.modal.frequency[0] == pytest.approx(2 * np.sin(0.5 * np.pi / (rows + 1)), rel=1e-6)
    assert most < 300e6


@pytest.mark.parametrize("by_signal", [True, False])  # or by another thread, as of a time limit
def test_an_interruption_leaves_a_long_factorisation_behind(monkeypatch, by_signal):
    """A compiled call that comes to no end, for one, and hears of no signal."""
    never = Event()

    def without_end(*_args, **_more):
        with suppress(KeyboardInterrupt):
            os.kill(os.getpid(), signal.SIGINT) if by_signal else _thread.interrupt_main()
            never.wait(0.5)
        never.wait(0.5)

    monkeypatch.setattr("fcm.structure.factor.splu", without_end)
    before = signal.signal(signal.SIGINT, signal.default_int_handler)  # a background job has it ignored
    try:
        with pytest.raises(KeyboardInterrupt):
            solver(
                bricks(2, 2, 2)[0], options=FactorOptions("SuperLU", polled_entries=0, poll_interval=0.001)
            )
    finally:
        signal.signal(signal.SIGINT, before)
        never.set()


def test_factors_that_the_memory_does_not_hold_are_said(monkeypatch):
    def refuse(*_args, **_more):
        raise MemoryError

    monkeypatch.setattr("fcm.structure.factor.splu", refuse)
    K, M, _ = bricks(2, 2, 2)
    with pytest.raises(StructureError, match=r"factors of its 54 rows and .* take more memory than there is"):
        factored_structure(K, M)
