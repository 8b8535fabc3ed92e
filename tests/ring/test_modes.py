"""The modes of a ring's sector: of matrices, and given for each nodal diameter."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.linalg
import scipy.sparse

from fcm.branches.force_level import solutions
from fcm.harmonic_balance.system import System
from fcm.scene import SceneError, scene_from_dict
from fcm.structure.linear import linear_of
from fcm.structure.ring import nodal_diameters

from . import rings


@pytest.mark.parametrize("sectors", [2, 5, 6])
def test_frequencies_are_those_of_the_ring_open_and_stuck(sectors):
    data = rings.sector(sectors, 1, (rings.SHROUD, rings.DAMPER))
    mass, stiffness = rings.matrices(data)
    for contact in rings.written_out(data)["contact"]:
        for key, spring in (("tangential", "k_u"), ("normal", "k_v")):
            direction = np.zeros(len(mass))
            for name, weight in contact[key].items():
                dof, number = name.split("_")
                direction[3 * int(number) + rings.DOFS.index(dof)] += weight
            stiffness = np.dstack((stiffness, contact[spring] * np.outer(direction, direction))).sum(axis=2)
    for state, matrix in (("opened", rings.matrices(data)[1]), ("stuck", stiffness)):
        expected = np.sqrt(scipy.linalg.eigh(matrix, mass, eigvals_only=True))
        diameters = nodal_diameters(scene_from_dict(data))
        counted = [(one, 1 if 2 * one.number in (0, sectors) else 2) for one in diameters]
        found = np.concatenate([np.repeat(getattr(one, state), times) for one, times in counted])
        assert np.sort(found) == pytest.approx(expected, rel=1e-9)


def modes_of(data):
    """Nodal diameter, frequency [Hz] and mass-normalised shape of each mode, by Hermitian eigenvalues."""
    structure, sectors = data["structure"], data["cyclic"]["sectors"]
    C, K = np.array(structure["coupling"]["stiffness"]), np.array(structure["stiffness"])
    for diameter in range(sectors // 2 + 1):
        turn = np.exp(2j * np.pi * diameter / sectors)
        value, shape = scipy.linalg.eigh(K + turn * C + np.conj(turn) * C.T, np.diag(structure["mass"]))
        yield from ((diameter, np.sqrt(v) / (2.0 * np.pi), s) for v, s in zip(value, shape.T, strict=True))


def with_modal(data, modal):
    del data["structure"]
    return data | {"modal": {"dofs": rings.DOFS, "damping": 0.002} | modal}


def tip(data):
    system = System(scene_from_dict(data), (1, 2, 3))
    return solutions(system, 2.0 * np.pi * 190.0).solutions[0]


@pytest.mark.parametrize("order", [1, 4])
def test_complex_modes_in_the_scene_or_a_file_are_those_of_the_matrices(order, tmp_path):
    data = rings.sector(5, order)
    expected = tip(data)
    diameter, frequency, shapes = map(list, zip(*modes_of(data), strict=True))
    shapes = [shape * np.exp(0.3j * i) for i, shape in enumerate(shapes)]  # the factor is of no importance
    pairs = [[[float(z.real), float(z.imag)] for z in shape] for shape in shapes]
    given = {"frequency": frequency, "nodal_diameter": diameter}
    assert tip(with_modal(rings.sector(5, order), given | {"shapes": pairs})) == pytest.approx(
        expected, rel=1e-9
    )
    mass = np.arange(1.0, 1.0 + len(frequency))
    scaled = np.array(shapes) * np.sqrt(mass)[:, None]
    np.savez(tmp_path / "modes.npz", shapes=scaled, mass=mass, dofs=rings.DOFS, damping=0.002, **given)
    found = with_modal(rings.sector(5, order), {"file": "modes.npz"})
    system = System(scene_from_dict(found, folder=tmp_path), (1, 2, 3))
    assert solutions(system, 2.0 * np.pi * 190.0).solutions[0] == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("sectors", [5, 6])
def test_cosine_and_sine_pairs_are_modes_of_the_whole_ring(sectors):
    data = rings.sector(sectors, 1)
    expected = tip(data)
    mass, stiffness = rings.matrices(data)
    rows, given = [], {"frequency": [], "nodal_diameter": []}
    for diameter, frequency, z in modes_of(data):
        around = np.exp(2j * np.pi * diameter * np.arange(sectors) / sectors)
        wave = np.outer(around, z * np.exp(0.4j) if 0 < 2 * diameter < sectors else z).ravel()
        single = 2 * diameter in (0, sectors)
        for part in [wave.real] if single else [wave.real, wave.imag]:
            whole = part * np.sqrt((1.0 if single else 2.0) / sectors)
            assert whole @ mass @ whole == pytest.approx(1.0)
            assert stiffness @ whole == pytest.approx((2.0 * np.pi * frequency) ** 2 * mass @ whole, rel=1e-6)
            rows.append(whole[:3].tolist())
            given["frequency"].append(float(frequency))
            given["nodal_diameter"].append(diameter)
    found = with_modal(rings.sector(sectors, 1), given | {"shapes": rows, "pairs": True})
    assert tip(found) == pytest.approx(expected, rel=1e-9)
    with pytest.raises(
        SceneError, match=r"modal\.pairs: missing: modes 4 and 5 have one diameter and one freq"
    ):
        scene_from_dict(with_modal(rings.sector(sectors, 1), given | {"shapes": rows}))
    scene_from_dict(with_modal(rings.sector(sectors, 1), given | {"shapes": rows, "pairs": False}))


@pytest.mark.slow
@pytest.mark.parametrize("rows", [40, 700])  # all modes at once; by Lanczos
def test_flexibility_of_modes_left_out_keeps_the_receptances(rows):
    """A chain in a ring of chains, coupled askew, beside direct solutions."""
    own = scipy.sparse.diags_array(
        [[-1.0] * (rows - 1), [2.05] * rows, [-1.0] * (rows - 1)], offsets=(-1, 0, 1)
    )
    block = scipy.sparse.lil_array((rows, rows))
    block[rows - 1, 0], block[0, 5] = -0.02, 0.01
    names = [f"{i}x" for i in range(1, rows + 1)]
    data = {
        "cyclic": {"sectors": 7, "engine_order": 2},
        "structure": {
            "dofs": names, "mass": [1.0] * rows, "stiffness": own.toarray().tolist(), "damping": 0.0,
            "coupling": {"stiffness": block.toarray().tolist()}, "modes": 12,
        },
        "contact": [
            {"name": "c", "tangential": {f"{rows}x": 1.0, "next.1:1": -1.0}, "normal": "20x",
             "mu": 0.3, "k_u": 0.1, "k_v": 0.1, "n_0": 1.0},
        ],
        "force": [{"dof": "30x", "amplitude": 1.0}],
        "response": {"frequency": [0.1, 0.15], "output": ["7x"]},
    }  # fmt: skip
    scene = scene_from_dict(data)
    assert scene.reported == ("1x", "7x", "20x", "30x", f"{rows}x")
    linear = linear_of(scene)
    bound = float(scene.notes[0].split("off by at most ")[1])
    for harmonic in (1, 2, 3):
        omega = 0.15 / harmonic
        seen = linear.receptance(np.array([1.0, float(harmonic)]))
        seen.at(omega)
        turn = np.exp(2j * np.pi * 2 * harmonic / 7)
        K = own + turn * block + np.conj(turn) * block.T
        value, shape = np.linalg.eigh(K.toarray())
        ports = np.zeros((rows, 2), dtype=complex)
        ports[rows - 1, 0], ports[0, 0], ports[19, 1] = 1.0, -turn, 1.0
        still, expected = (
            ports.T @ (shape / (value - w**2)) @ shape.conj().T @ ports.conj()
            for w in (0.0, harmonic * omega)
        )
        found = np.asarray(seen.G_re)[-1] + 1j * np.asarray(seen.G_im)[-1]
        size = np.sqrt(np.diagonal(still).real)
        assert np.abs((found - expected) / np.outer(size, size)).max() < bound + 1e-11
