"""Modes of matrices, and the flexibility of those that are left out, beside direct solutions."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.linalg
import scipy.sparse

import fcm
from fcm.scene import scene_from_dict
from fcm.structure.eigen import Modes, StructureError, factored_structure, modes_of
from fcm.structure.flexibility import Truncation, flexibility
from fcm.structure.options import FlexibilityOptions
from fcm.structure.reduced import ModeSelection, reduced

from . import beams

CANTILEVER = np.array([1.8751040687, 4.6940911330, 7.8547574382, 10.9955407349]) ** 2  # (beta L)^2, published
FREE = np.array([4.7300407449, 7.8532046241]) ** 2


@pytest.mark.parametrize("elements", [60, 400])  # all modes at once; by Lanczos
def test_published_frequencies_of_a_cantilever(elements):
    K, M, _ = beams.beam(elements)
    found = modes_of(factored_structure(K, M), 4)
    assert np.sqrt(found.stiffness) == pytest.approx(CANTILEVER, rel=2e-5)
    assert found.shapes.T @ (M @ found.shapes) == pytest.approx(np.eye(4), abs=1e-9)


@pytest.mark.parametrize("elements", [60, 400])
def test_a_free_beam_has_two_rigid_body_modes(elements):
    K, M, _ = beams.beam(elements, clamped=False)
    found = modes_of(factored_structure(K, M), 4)
    assert np.abs(found.stiffness[:2]).max() < 1e-6 * FREE[0] ** 2
    assert np.sqrt(found.stiffness[2:]) == pytest.approx(FREE, rel=2e-5)


def test_rows_without_mass_are_no_modes():
    K = scipy.sparse.csc_array(np.array([[3.0, -1, 0], [-1, 2, -1], [0, -1, 1]]))
    M = scipy.sparse.csc_array(np.diag([1.0, 0.0, 2.0]))
    found = modes_of(factored_structure(K, M), 3)
    condensed = np.array([[2.5, -0.5], [-0.5, 0.5]])  # the middle row taken out by hand
    value = np.linalg.eigvals(np.diag([1.0, 0.5]) @ condensed)
    assert found.stiffness == pytest.approx(np.sort(value))


@pytest.mark.parametrize(
    "change, words",
    [
        (lambda K, M: (K - 1e3 * M, M), "negative eigenvalue"),
        (lambda K, M: (K, 0 * M), "the mass has no entry greater than 0"),
        (
            lambda K, M: (K, M - 0.03 * M.max() * scipy.sparse.eye_array(40)),
            "the mass has .* negative eigenvalue",
        ),
        (lambda K, M: (K, 1e-320 * M), "too small beside the stiffness"),
        (lambda K, M: (0 * K, M), "the stiffness has no entry"),
    ],
)
def test_matrices_of_no_structure(change, words):
    K, M, _ = beams.beam(20)
    with pytest.raises(StructureError, match=words):
        reduced(
            *(scipy.sparse.csc_array(one) for one in change(K, M)), np.ones((40, 1)), 1.0, ModeSelection(4)
        )


@pytest.mark.slow
def test_the_stiffness_of_bodies_that_nothing_holds_in_the_place_of_their_mass():
    """Its modes without mass went through a Cholesky factorisation, which failed as a defect of fcm."""
    slope = np.diff(np.eye(117), axis=0)
    K = scipy.sparse.block_diag([slope.T @ slope] * 6, format="csc")
    with pytest.raises(StructureError, match="and mass may be in each other's place"):
        modes_of(factored_structure(scipy.sparse.eye_array(702, format="csc"), K), 150)


def test_all_rigid_body_modes_are_kept_and_a_soft_mode_is_none():
    """Three masses that nothing holds, a fourth on a very soft spring."""
    K = scipy.sparse.csc_array(np.diag([0.0, 0.0, 0.0, 1e-9, 1.0]))
    M = scipy.sparse.eye_array(5, format="csc")
    found = reduced(K, M, np.ones((5, 1)), 0.5, ModeSelection(1))
    assert found.rigid == 3 <= found.kept
    assert found.modes.stiffness[:3].tolist() == [0.0, 0.0, 0.0] and found.modes.stiffness[3] > 0.9e-9


def test_no_mode_of_several_equal_frequencies_is_passed_by():
    """Five equal beams beside each other, by Lanczos, which starts from one vector."""
    K, M, _ = beams.beam(80)
    K, M = (scipy.sparse.block_diag([one] * 5, format="csc") for one in (K, M))
    found = modes_of(factored_structure(K, M), 12)
    assert np.sqrt(found.stiffness) == pytest.approx(np.repeat(CANTILEVER[:3], 5)[:12], rel=2e-5)
    assert found.shapes.T @ (M @ found.shapes) == pytest.approx(np.eye(12), abs=1e-8)


@pytest.mark.parametrize("kept", [2, 3, 5, 12])
@pytest.mark.parametrize("blocks", [1, 2])
def test_the_bound_holds_and_is_no_exaggeration(kept, blocks):
    """Of receptances at two points and along a combination, up to just below the first mode left out."""
    options = FlexibilityOptions(tolerance=0.0, max_blocks=blocks)
    K, M, names = beams.beam(60)
    loads = np.zeros((len(names), 3))
    for column, weights in enumerate([{"60w": 1.0}, {"31w": 1.0}, {"60r": 0.3, "45w": -0.7}]):
        for name, weight in weights.items():
            loads[names.index(name), column] = weight
    system = factored_structure(K, M)
    whole = modes_of(system, kept + 1)
    first = Modes(whole.stiffness[:kept], whole.shapes[:, :kept])
    beyond = float(whole.stiffness[kept])
    static = np.diagonal(loads.T @ beams.direct(K, M, 0.0, loads, 0.0)).real
    value, shapes = scipy.linalg.eigh(K.toarray(), M.toarray())
    third = ((shapes[:, kept:].T @ loads) ** 2 / value[kept:, None] ** 1.5).sum(axis=0)  # m_3
    for omega in np.sqrt(beyond) * np.array([0.1, 0.5, 0.9]):
        more = flexibility(Truncation(system, first, omega, beyond, options), loads)
        exact = loads.T @ beams.direct(K, M, 0.0, loads, omega).real
        found, left_out = np.zeros((3, 3)), exact.copy()
        for modes in (first, more.modes):
            on_modes = modes.shapes.T @ loads
            found += on_modes.T @ (on_modes / (modes.stiffness - omega**2)[:, None])
            if modes is first:
                left_out = exact - found
        error = np.diagonal(exact - found) / static
        standing = ((more.modes.shapes.T @ loads) ** 2 / more.modes.stiffness[:, None] ** 1.5).sum(axis=0)
        off = omega * np.abs(standing - third) / static
        assert off.max() < more.damping + 1e-9
        assert blocks > 1 or more.damping < 40 * off.max()
        rounding = 1e-8 * np.abs(np.diagonal(exact) / static).max()
        assert -rounding < error.min() and error.max() < more.bound + rounding
        assert error.max() < np.abs(np.diagonal(left_out) / static).max() + rounding
        if more.bound > 100 * rounding and omega < 0.6 * np.sqrt(beyond):
            assert more.bound < 3 * error.max()


@pytest.mark.parametrize("free", [False, True])
@pytest.mark.parametrize("kept", [4, 8])
def test_the_bound_where_no_flexibility_of_its_own_is_kept(kept, free):
    """At all displacements under a load in the middle, undamped, and with one ratio by all modes."""
    K, M, names = beams.beam(60, clamped=not free)
    value, shapes = scipy.linalg.eigh(K.toarray(), M.toarray())
    rigid, ratio = (2 if free else 0), 0.02
    loads, others = np.eye(len(names))[:, [names.index("31w")]], range(len(names))
    static = (shapes[:, rigid:] ** 2 / value[rigid:]).sum(axis=1)
    unit = np.sqrt(static * static[names.index("31w")])
    for share in (0.3, 0.8):
        omega = share * np.sqrt(value[kept])
        found = reduced(K, M, loads, omega, ModeSelection(kept, other_rows=others))
        undamped = damped = 0.0
        for lam, phi, sign in ((value, shapes, 1.0), (found.modes.stiffness, found.modes.shapes, -1.0)):
            lam = np.where(np.arange(lam.size) < rigid, 0.0, lam)
            force = sign * (phi.T @ loads)[:, 0]
            undamped = undamped + phi @ (force / (lam - omega**2))
            damped = damped + phi @ (force / (lam - omega**2 + 2j * ratio * np.sqrt(lam) * omega))
        error, whole = np.abs(undamped / unit).max(), np.abs(damped / unit).max()
        assert 1e-7 < error < found.other_rows[0] < 30.0 * error
        assert whole < found.other_rows[0] + 2.0 * ratio * found.other_rows[1]


def of_reduction(scene):
    """Notes, but for that of the resonances open and stuck."""
    return [note for note in scene.notes if "first resonances" not in note]


def test_many_outputs_are_said_to_keep_no_flexibility_of_their_own(tmp_path):
    few, many = (scene(tmp_path, modes=4, output=one) for one in (["1*"], ["*"]))
    (note,) = of_reduction(few)
    same, said = of_reduction(many)
    assert "own flexibility" not in note + same and many.modal.added < few.modal.added
    assert said.startswith(
        "structure: the 120 outputs are more than 30, so that their own flexibility is not"
    )
    K, M, names = beams.beam(60)
    load = np.eye(len(names))[:, [names.index("31w")]]
    static = np.sqrt(np.diagonal(beams.direct(K, M, 0.0, np.eye(len(names)), 0.0)).real)
    exact = beams.direct(K, M, 0.0, load, 30.0).real[:, 0]
    at = [many.modal.dofs.index(name) for name in names]
    denominator = many.modal.frequency**2 - 30.0**2
    found = many.modal.shapes.T[at] @ (many.modal.shapes[:, at[names.index("31w")]] / denominator)
    off = np.abs((found - exact) / (static * static[names.index("31w")])).max()
    assert 1e-7 < off < float(said.rpartition(" ")[2])
    assert len(of_reduction(scene(tmp_path, modes=4, output=["*"], flexibility=False))) == 1
    assert len(of_reduction(scene(tmp_path, modes=120, output=["*"]))) == 1


@pytest.mark.parametrize("count", [None, 2])
@pytest.mark.parametrize("free", [False, True])
def test_rows_without_mass_keep_their_flexibility(free, count):
    """A chain with masses at two of its rows, loaded at one without, at the other and at a mass."""
    springs = [0.0 if free else 3.0, 1.0, 5.0, 2.0, 4.0]
    K = np.diag(np.add(springs, [*springs[1:], 0.0]))
    K -= np.diag(springs[1:], 1) + np.diag(springs[1:], -1)
    M = np.diag([2.0, 0.0, 1.0, 0.0, 1.5])
    loads = np.eye(5)[:, [1, 3, 4]]
    omega = 0.4
    found = reduced(scipy.sparse.csc_array(K), scipy.sparse.csc_array(M), loads, omega, ModeSelection(count))
    on_modes = found.modes.shapes.T @ loads
    receptance = on_modes.T @ (on_modes / (found.modes.stiffness - omega**2)[:, None])
    exact = np.linalg.solve(K - omega**2 * M, loads)
    assert (found.kept, found.rigid) == (count or 3, int(free))
    assert (
        np.abs(receptance - loads.T @ exact).max() < 2.0 * (found.bound + 1e-8) * np.abs(exact).max() < 1e-4
    )
    few = reduced(
        scipy.sparse.csc_array(K), scipy.sparse.csc_array(M), loads[:, 2:], omega, ModeSelection(None)
    )
    assert few.modes.count == 3  # nothing is added where nothing without mass is loaded


def scene(folder, elements=60, output=(), **structure):
    """A beam that rubs at its tip, pushed in the middle."""
    K, M, names = beams.beam(elements)
    scipy.sparse.save_npz(folder / "K.npz", K)
    scipy.sparse.save_npz(folder / "M.npz", M)
    (folder / "dofs.txt").write_text("\n".join(names))
    table = {"dofs": "dofs.txt", "mass": "M.npz", "stiffness": "K.npz", "damping": 0.01} | structure
    contact = {"name": "tip", "tangential": "60w", "normal": "45w", "mu": 0.4, "k_u": 200.0, "k_v": 20.0}
    data = {
        "structure": table,
        "contact": [contact | {"n_0": 0.6}],
        "force": [{"dof": "31w", "amplitude": 1.0}],
        "response": {"frequency": [2.0, 30.0], "harmonics": 1} | ({"output": output} if output else {}),
    }
    return scene_from_dict(data, "beam.toml", folder)


def peak(one):
    """Greatest amplitude at the tip, and its frequency, of the one harmonic."""
    data = fcm.respond(one, "closed-form")
    return np.array([data[name].sel(dof="60w").item() for name in ("peak_amplitude", "peak_frequency")])


@pytest.mark.slow
def test_few_modes_with_the_flexibility_of_the_others_are_as_good_as_all(tmp_path):
    """And without it they are not: the contact's own flexibility is missing."""
    whole = peak(scene(tmp_path, modes=120))
    errors = {}
    for kept in (2, 4):
        for keep in (True, False):
            one = scene(tmp_path, modes=kept, flexibility=keep)
            errors[kept, keep] = np.abs(peak(one) / whole - 1).max()
            if keep:
                (stated,) = of_reduction(one)
                assert errors[kept, True] < float(stated.rpartition(" ")[2])
    assert errors[4, True] < 1e-6
    assert errors[2, False] > errors[4, False] > 1e-4
    assert all(errors[kept, True] < 0.02 * errors[kept, False] for kept in (2, 4))


def test_a_scene_says_what_is_kept_and_how_far_it_is_off(tmp_path):
    few = scene(tmp_path, modes=4)
    assert few.modal.frequency.size == 4 + few.modal.added
    (note,) = of_reduction(few)
    assert note.startswith("structure: 4 modes of 120 degrees of freedom are kept, and the flexibility")
    bound, damping = (float(part.split()[0].strip(",")) for part in note.split("by at most ")[1:])
    assert damping < 0.01
    K, M, names = beams.beam(60)
    at = [names.index(name) for name in few.modal.dofs]
    loads = np.eye(len(few.modal.dofs))
    exact = beams.direct(K, M, 0.0, np.eye(len(names))[:, at], 30.0)[at].real
    undamped = beams.receptance(few.modal, loads, 30.0)
    # damping 0.01 of every mode: compare far from resonances, to its order
    assert np.abs(undamped.real - exact).max() < (bound + 0.01) * np.abs(exact).max()
    (note,) = of_reduction(scene(tmp_path, modes=4, flexibility=False))
    assert "the flexibility of the others is left out" in note
    (note,) = of_reduction(scene(tmp_path, modes=500))
    assert note.endswith("120 modes of 120 degrees of freedom are kept, all that there are")


def test_a_range_beyond_the_modes_is_said(tmp_path):
    one = scene(tmp_path, modes=1)
    assert any("within the range that are not kept" in note for note in one.notes)
    assert any("how far it is off is unknown" in note for note in one.notes)
