"""Stiff parts beside soft ones, and fine meshes: little is left of the terms of a mode's elastic energy."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.linalg
import scipy.sparse

from fcm.scene import scene_from_dict
from fcm.structure.eigen import StructureError
from fcm.structure.options import REDUCTION
from fcm.structure.reduced import ModeSelection, reduced
from fcm.structure.rounding import of_receptances

from . import beams
from .solids import bricks

CANTILEVER, FREE = 1.8751040687**2, 4.7300407449**2  # (beta L)^2, published
MASSES, AT, OMEGA = 30, 20, 0.25


@pytest.mark.slow
@pytest.mark.parametrize("elements, off", [(2000, 1e-7), (4000, 1e-5)])
def test_a_fine_mesh_has_no_other_rigid_body_modes(elements, off):
    """Their stiffness is summed of terms that are up to 1e15 times as great."""
    for clamped, rigid, first in ((True, 0, CANTILEVER), (False, 2, FREE)):
        K, M, names = beams.beam(elements, clamped)
        load = np.eye(len(names))[:, [names.index(f"{elements}w")]]
        found = reduced(K, M, load, 30.0, ModeSelection(None))
        error = np.sqrt(found.modes.stiffness[rigid]) / first - 1.0
        assert found.rigid == rigid
        assert abs(error) < off and abs(error) < 3.0 * found.rounding


def chain(springs):
    """Stiffness and mass of equal masses, the first of them on a spring to the ground."""
    K = np.diag(springs + np.append(springs[1:], 0.0)) - np.diag(springs[1:], 1) - np.diag(springs[1:], -1)
    return K, np.eye(len(springs))


def as_one(K, M):
    """The same with the two masses beside the stiff spring as one body, exact but for 1 / its stiffness."""
    both = np.delete(np.eye(MASSES), AT, axis=1)
    both[AT, AT - 1] = 1.0
    return both.T @ K @ both, both.T @ M @ both, both


@pytest.mark.parametrize("stiff", [1e6, 1e9, 1e12])
@pytest.mark.parametrize("free", [False, True])
def test_a_stiff_spring_hides_no_soft_mode_and_the_bound_has_the_rounding(stiff, free):
    springs = np.ones(MASSES)
    springs[0], springs[AT] = 0.0 if free else 1.0, stiff
    K, M = chain(springs)
    loads = np.eye(MASSES)[:, [MASSES - 1, 12]]
    found = reduced(scipy.sparse.csc_array(K), scipy.sparse.csc_array(M), loads, OMEGA, ModeSelection(4))
    springs[AT] = 0.0  # the two are one body: no entry is large
    k, m, both = as_one(*chain(springs))
    exact = scipy.linalg.eigh(k, m, eigvals_only=True)
    assert found.rigid == free
    assert np.sqrt(found.modes.stiffness[free:4] / exact[free:4]) == pytest.approx(
        1.0, abs=3.0 * found.rounding + 2.0 / stiff
    )
    static = ((found.modes.shapes[:, free:].T @ loads) ** 2 / found.modes.stiffness[free:, None]).sum(axis=0)
    for omega in (0.3 * OMEGA, OMEGA):
        on_modes = found.modes.shapes.T @ loads
        own = on_modes.T @ (on_modes / (found.modes.stiffness - omega**2)[:, None])
        true = both[[MASSES - 1, 12]] @ np.linalg.solve(k - omega**2 * m, both.T @ loads)
        off = np.abs(own - true) / np.sqrt(static * static[:, None])
        near = max(1.0, (np.abs(true) / np.sqrt(static * static[:, None])).max())  # a resonance raises it
        assert off.max() < near * found.bound + 2.0 / stiff


def solved(A, loads):
    """By improving a solution with residuals of more digits; A has them."""
    factor, loads = scipy.linalg.lu_factor(A.astype(float)), loads.astype(np.longdouble)
    x = scipy.linalg.lu_solve(factor, loads.astype(float)).astype(np.longdouble)
    for _ in range(4):
        x += scipy.linalg.lu_solve(factor, (loads - A @ x).astype(float))
    return x.astype(float)


@pytest.mark.parametrize("seed", [109, 147, 223, 4, 5, 6])
def test_the_bound_has_the_rounding_at_all_frequencies(seed):
    """Of uneven chains and beams, at rest, in the range and at its end; at a resonance it is as much more."""
    rng = np.random.default_rng(seed)
    if seed % 3:
        K, M = chain(10.0 ** rng.uniform(0.0, 6.0, 80))
    else:
        K, M = (one[2:, 2:] for one in uneven_beam(rng, 40))
    value = scipy.linalg.eigh(K, M, eigvals_only=True)
    loads = np.eye(len(K))[:, rng.choice(len(K), 2, False)]
    kept = int(rng.integers(2, 13))
    top = np.sqrt(value[kept]) * rng.uniform(0.3, 0.9)
    found = reduced(*map(scipy.sparse.csc_array, (K, M)), loads, top, ModeSelection(kept))
    on_modes = found.modes.shapes.T @ loads
    size = np.sqrt(np.diagonal(loads.T @ solved(K.astype(np.longdouble), loads)))
    for share in (0.0, 0.3, 0.5, 0.7, 1.0):
        omega = np.longdouble(share * top)
        exact = loads.T @ solved(K.astype(np.longdouble) - omega**2 * M, loads)
        own = on_modes.T @ (on_modes / (found.modes.stiffness - share**2 * top**2)[:, None])
        near = max(1.0, (1.0 / np.abs(1.0 - share**2 * top**2 / value)).max())
        assert (np.abs(own - exact) / np.outer(size, size)).max() <= near * found.bound


def frame(rng, nodes=12):
    """A space frame that nothing holds: bars between random nodes, each with its 6 nearest."""
    at, K = rng.random((nodes, 3)), np.zeros((3 * nodes, 3 * nodes))
    for i in range(nodes):
        for j in np.argsort(np.linalg.norm(at - at[i], axis=1))[1:7]:
            along = np.zeros(3 * nodes)
            along[3 * i : 3 * i + 3] = (at[i] - at[j]) / np.linalg.norm(at[i] - at[j]) ** 1.5
            along[3 * j : 3 * j + 3] = -along[3 * i : 3 * i + 3]
            K += 1e8 * np.outer(along, along)
    return K, np.diag(np.repeat(rng.random(nodes) + 0.5, 3))


def written(K, digits):
    if digits == "single":
        return K.astype(np.float32).astype(np.float64)
    return np.vectorize(lambda value: float(f"{value:.{digits - 1}e}"))(K)


@pytest.mark.parametrize("digits", [17, 15, 12, 9, 8, "single"])
def test_rigid_bodies_of_matrices_written_with_few_digits(digits):
    """Their stiffness is then that of the rounding, positive or negative; one on soft springs has its own."""
    for seed in range(3):
        K, M = frame(np.random.default_rng(seed))
        first = scipy.linalg.eigh(K, M, eigvals_only=True)[6]
        loads = np.eye(len(K))[:, :1]
        for held, rigid in ((0.0, 6), (0.05**2 * first, 0)):
            rounded = scipy.sparse.csc_array(written(K + held * M, digits))
            found = reduced(rounded, scipy.sparse.csc_array(M), loads, 0.5 * first**0.5, ModeSelection(8))
            assert found.rigid == rigid
            frequency = np.sqrt(found.modes.stiffness)
            exact = np.sqrt(first + held)
            assert abs(frequency[6] / exact - 1.0) <= max(2.0 * found.rounding, 1e-12)


@pytest.mark.parametrize("digits", [17, 12, 9, "single"])
def test_rigid_bodies_of_several_bodies(digits):
    """Six of each; contacts alone may hold them together."""
    bodies = [frame(np.random.default_rng(seed)) for seed in range(3)]
    K, M = (scipy.linalg.block_diag(*matrices) for matrices in zip(*bodies, strict=True))
    rounded = scipy.sparse.csc_array(written(K, digits))
    found = reduced(rounded, scipy.sparse.csc_array(M), np.eye(len(K))[:, :1], 100.0, ModeSelection(24))
    exact = scipy.linalg.eigh(K, M, eigvals_only=True)[18:24]
    assert found.rigid == 18
    assert np.sqrt(found.modes.stiffness[18:24] / exact) == pytest.approx(
        1.0, abs=2.0 * found.rounding + 1e-12
    )


def test_a_load_that_moves_rigid_bodies_alone_has_a_bound_that_is_true():
    """A weight has no static answer of a free structure: its displacements are those of its acceleration."""
    K, M, names = beams.beam(60, clamped=False)
    upwards = np.array([name.endswith("w") for name in names], dtype=float)
    loads = np.stack((M @ upwards, np.eye(len(names))[0]), axis=1)
    omega = 12.0  # below the first bending mode
    found = reduced(K, M, loads, omega, ModeSelection(None))
    assert found.rigid == 2 and found.bound < 1e-6
    modes = found.modes
    assert modes.count <= found.kept + 4  # for the load on the end, none for rounding
    pushed = modes.shapes.T @ loads
    answer = pushed.T @ (pushed / (modes.stiffness - omega**2)[:, None])
    exact = -1.0 / omega**2  # of the mass 1
    assert np.abs(answer[0] / exact - 1.0).max() <= 2.0 * found.bound


def uneven_beam(rng, elements=100):
    """A beam that nothing holds, its elements of different lengths, widths and densities."""
    K, M = np.zeros((2, 2 * elements + 2, 2 * elements + 2))
    lengths = rng.uniform(0.5, 1.5, elements)
    for e, length in enumerate(lengths / lengths.sum()):
        k, m, _ = beams.beam(1, clamped=False)
        scale = np.array([1.0, length, 1.0, length])
        at = np.s_[2 * e : 2 * e + 4, 2 * e : 2 * e + 4]
        K[at] += rng.uniform(0.5, 2.0) / length**3 * k.toarray() * np.outer(scale, scale)
        M[at] += rng.uniform(0.5, 2.0) * length * m.toarray() * np.outer(scale, scale)
    return K, M


@pytest.mark.parametrize("uneven", [True, False])
@pytest.mark.parametrize("digits", [10, 9, 8, "single"])
def test_a_fine_mesh_written_with_few_digits(digits, uneven):
    """Both rigid-body motions, and the first bending mode, off by no more than what is said."""
    for seed in range(2):
        if uneven:
            K, M = uneven_beam(np.random.default_rng(seed))
        else:
            K, M = (np.pi * one.toarray() for one in beams.beam(97 + seed, clamped=False)[:2])
        first = scipy.linalg.eigh(K, M, eigvals_only=True, subset_by_index=(2, 2))[0]
        rounded = scipy.sparse.csc_array(written(K, digits))
        found = reduced(rounded, scipy.sparse.csc_array(M), np.eye(len(K))[:, :1], 10.0, ModeSelection(8))
        assert found.rigid == 2
        assert abs(np.sqrt(found.modes.stiffness[2] / first) - 1.0) <= 1.5 * found.rounding < 0.5
        # a soft spring that would make a mode just there is not seen in what was written
        assert found.unclear > 0.03 or digits == 10


def test_modes_that_the_digits_do_not_tell_from_rigid_bodies_are_said():
    K, M = uneven_beam(np.random.default_rng(3))

    def notes(digits):
        structure = {"stiffness": written(K, digits).tolist(), "mass": M.tolist(), "damping": 0.01}
        data = {
            "structure": structure | {"dofs": [f"x{i}" for i in range(len(K))], "modes": 6},
            "force": [{"dof": "x5", "amplitude": 1.0}],
            "response": {"frequency": [5.0, 30.0]},
        }
        return scene_from_dict(data).notes

    said = " ".join(notes(8))
    assert "written with 8 digits. Modes below" in said and "2 rigid-body modes" in said
    assert "as its stiffness was written with 8 digits" in said
    assert not any("digits" in note for note in notes(17))


def test_numbers_that_somebody_has_typed_are_exact():
    """A soft spring beside a stiff one, in the seventh digit of an entry."""
    K, M = np.array([[1e7 + 10.0, -1e7], [-1e7, 1e7]]), np.eye(2)
    found = reduced(*map(scipy.sparse.csc_array, (K, M)), np.eye(2)[:, :1], 1.0, ModeSelection(2))
    assert found.rigid == 0
    assert found.modes.stiffness[0] == pytest.approx(5.0, rel=1e-6)


def test_a_scene_says_by_how_much_rounding_moves_its_frequencies():
    """Where that is some of the width of a resonance, and only there."""

    def notes(stiff, damping):
        springs = np.ones(MASSES)
        springs[AT] = stiff
        K, M = chain(springs)
        structure = {"stiffness": K.tolist(), "mass": np.diag(M).tolist(), "damping": damping, "modes": 4}
        data = {
            "structure": structure | {"dofs": [f"x{i}" for i in range(MASSES)]},
            "force": [{"dof": "x5", "amplitude": 1.0}],
            "response": {"frequency": [0.02, OMEGA]},
        }
        return scene_from_dict(data).notes

    (said,) = (note for note in notes(1e12, 1e-3) if "rounding changes" in note)
    assert 1e-7 < float(said.partition("by up to ")[2].partition(",")[0]) < 1e-3
    assert not any("rounding" in note for note in (*notes(1e12, 1.0), *notes(1e3, 1e-4)))
    assert not any("rounding" in note for note in notes(1e7, 0.0))  # no width to compare with
    assert any("rounding" in note for note in notes(1e14, 0.0))


def test_rigid_body_modes_take_no_digits_from_the_elastic_ones():
    """Those of a free frame are orthogonal to them, and balance, to the machine's precision."""
    K, M = frame(np.random.default_rng(7))
    found = reduced(
        scipy.sparse.csc_array(K), scipy.sparse.csc_array(M), np.eye(len(K))[:, :2], 1e3, ModeSelection(12)
    )
    shapes, stiffness = found.modes.shapes[:, : found.kept], found.modes.stiffness[: found.kept]
    assert found.rigid == 6
    assert shapes.T @ M @ shapes == pytest.approx(np.eye(found.kept), abs=1e-12)
    forces = K @ shapes[:, 6:] - M @ shapes[:, 6:] * stiffness[6:]
    assert np.abs(forces).max() < 1e-12 * np.abs(K).max() * np.abs(shapes).max()


def craig_bampton(K, M, boundary, modes):
    """The matrices on the boundary's rows and the first modes with the boundary held."""
    inner = np.setdiff1d(np.arange(len(K)), boundary)
    turn = np.zeros((len(K), len(boundary) + modes))
    turn[boundary, : len(boundary)] = np.eye(len(boundary))
    turn[inner, : len(boundary)] = -np.linalg.solve(K[np.ix_(inner, inner)], K[np.ix_(inner, boundary)])
    if modes:
        held = (one[np.ix_(inner, inner)] for one in (K, M))
        turn[inner, len(boundary) :] = scipy.linalg.eigh(*held, subset_by_index=(0, modes - 1))[1]
    return tuple((small + small.T) / 2 for small in (turn.T @ K @ turn, turn.T @ M @ turn))


def free_body(kind, scale):
    """A beam in a plane or a frame of bars that nothing holds; scale is that of the stiffness."""
    if kind == "beam":
        K, M, _ = beams.beam(40, clamped=False)
        return scale * K.toarray(), M.toarray(), 2
    K, M = frame(np.random.default_rng(5))
    return scale / 1e8 * K, M, 6


BOUNDARIES = {
    "beam": {"one end": [0, 1], "both ends": [0, 1, 80, 81], "places": [0, 40, 80]},
    "frame": {"one node and more": [0, 1, 2, 9, 10, 20], "three nodes": [*range(6), *range(30, 33)]},
}


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e11])
@pytest.mark.parametrize("modes", [0, 1, 8])
@pytest.mark.parametrize("kind, place", [(kind, place) for kind in BOUNDARIES for place in BOUNDARIES[kind]])
def test_rigid_bodies_of_superelements_whatever_the_units_of_their_rows(kind, place, modes, scale):
    """Their fixed-interface modes are coupled by the mass alone, and a reduction leaves its own rounding."""
    whole_K, whole_M, rigid = free_body(kind, scale)
    boundary = BOUNDARIES[kind][place]
    K, M = craig_bampton(whole_K, whole_M, boundary, modes)
    if len(K) <= rigid:
        return
    first = scipy.linalg.eigh(K, M, eigvals_only=True)[rigid]
    for unit in (np.ones(len(K)), 10.0 ** np.random.default_rng(1).uniform(-4.0, 4.0, len(K))):
        k, m = (scipy.sparse.csc_array(one * unit * unit[:, None]) for one in (K, M))
        found = reduced(k, m, np.eye(len(K))[:, :1] * unit[0], np.sqrt(first), ModeSelection(None))
        assert found.rigid == rigid and (found.modes.stiffness[:rigid] == 0.0).all()
        assert np.sqrt(found.modes.stiffness[rigid] / first) == pytest.approx(1.0, abs=1e-6)


def test_a_superelement_answers_as_its_modes():
    """A free bar with two ends and a fixed-interface mode, at the frequencies between its resonances."""
    K = np.array([[6.26, -6.26, 0.0], [-6.26, 6.26, 0.0], [0.0, 0.0, 73.4]])
    M = np.array([[0.8847, 0.1667, 0.4455], [0.1667, 0.7899, 0.4455], [0.4455, 0.4455, 1.0]])
    structure = {"dofs": ["1x", "2x", "q1"], "stiffness": K.tolist(), "mass": M.tolist(), "damping": 0.01}
    data = {
        "structure": structure,
        "force": [{"dof": "2x", "amplitude": 1.0}],
        "response": {"frequency": [0.5, 6.0]},
    }
    scene = scene_from_dict(data)
    assert scene.modal.frequency[0] == 0.0
    assert "structure: 1 rigid-body mode, of frequency 0" in scene.notes
    for omega in (0.5, 3.0, 6.0):
        modes = scene.modal.shapes * scene.modal.shapes[:, [1]]
        own = (modes / (scene.modal.frequency**2 - omega**2)[:, None]).sum(axis=0)
        assert own == pytest.approx(np.linalg.solve(K - omega**2 * M, [0.0, 1.0, 0.0]), rel=1e-10)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_negative_stiffness_that_is_no_rounding_is_refused(sign):
    K, M = np.diag([-sign, 4.0, 9.0]), np.eye(3)
    if sign > 0.0:
        with pytest.raises(StructureError, match="negative eigenvalue"):
            reduced(*map(scipy.sparse.csc_array, (K, M)), np.eye(3)[:, :1], 1.0, ModeSelection(2))
    else:
        assert (
            reduced(*map(scipy.sparse.csc_array, (K, M)), np.eye(3)[:, :1], 1.0, ModeSelection(2)).rigid == 0
        )


def test_a_loose_solid_by_lanczos():
    """Six rigid-body modes of a bar of bricks, and its first elastic one as of all modes at once."""
    K, M, names = bricks(8, 4, 4, clamped=False)
    assert len(names) > 600
    exact = scipy.linalg.eigh(K.toarray(), M.toarray(), eigvals_only=True, subset_by_index=(6, 9))
    load = np.eye(len(names))[:, -1:]
    for top in (0.0, float(np.sqrt(exact[0]))):
        found = reduced(K, M, load, top, ModeSelection(10))
        assert found.rigid == 6
        assert found.modes.stiffness[6:10] == pytest.approx(exact, rel=1e-9)
        assert np.abs(found.modes.shapes[:, :6].T @ (M @ found.modes.shapes[:, 6:10])).max() < 1e-9


@pytest.mark.parametrize("seed", range(6))
def test_of_many_loads_those_are_looked_at_of_which_most_is_lost(seed):
    """Beside each alone: what the rounding of the worst is, to the factor that is spared."""
    rng = np.random.default_rng(seed)
    K, M = map(scipy.sparse.csc_array, chain(10.0 ** rng.uniform(0.0, 6.0, 80)))
    loads = np.eye(80)
    modes = reduced(K, M, loads[:, :1], 0.0, ModeSelection(80)).modes
    top = 3.0 * np.sqrt(modes.stiffness[2])
    each = [of_receptances(K, M, modes, loads[:, [i]], top) for i in range(80)]
    told = of_receptances(K, M, modes, loads, top)
    assert max(each) / REDUCTION.safety <= told <= REDUCTION.safety * max(each)
    assert max(each) > 10.0 * min(each)
