"""A ring whose blades differ, beside the same written out with its matrices, and beside the tuned ring."""

from __future__ import annotations

import copy
import json

import netCDF4
import numpy as np
import pytest

import fcm
from fcm.branches.force_level import solutions
from fcm.harmonic_balance.reported_quantities import reported_at
from fcm.harmonic_balance.system import System
from fcm.response import trace
from fcm.response.options import ResponseOptions, SweepOptions
from fcm.scene import SceneError, scene_from_dict
from fcm.structure.linear import linear_of
from fcm.structure.mistuned import basis_of, modes_of_mistuned

from ..program import called
from . import rings

BLADE = ((0, 1, 1e6), (1, 2, 2e6))  # its springs: from the disk, and to the tip
FACTORS = [1.04, 0.93, 1.02, 0.97, 1.06, 0.99]


def sector(sectors, order, contacts=(rings.SHROUD, rings.DAMPER), coupling=rings.SKEW, **response):
    """A sector whose skew coupling is of its disk alone where blades are named by their rows."""
    data = rings.sector(sectors, order, contacts, coupling, **response)
    data["cyclic"]["mistuning"] = {"factors": FACTORS[:sectors], "stiffness": blade_stiffness().tolist()}
    return data


def blade_stiffness():
    found = np.zeros((3, 3))
    for i, j, k in BLADE:
        found[np.ix_([i, j], [i, j])] += [[k, -k], [-k, k]]
    return found


def written_out(data, factors=None):
    """The whole ring as an ordinary scene of matrices, the springs of its blades times the factors."""
    full = rings.written_out(data)
    stiffness = np.array(full["structure"]["stiffness"])
    for k, factor in enumerate(data["cyclic"]["mistuning"]["factors"] if factors is None else factors):
        place = slice(3 * k, 3 * k + 3)
        stiffness[place, place] += (factor - 1.0) * blade_stiffness()
    full["structure"]["stiffness"] = stiffness.tolist()
    return full


def names(sectors, between):
    return [f"{dof}{between}{k}" for k in range(sectors) for dof in rings.DOFS]


@pytest.mark.parametrize(("sectors", "order"), [(6, 1), (5, 2), (4, 2), (5, -1), (2, 1)])
def test_modes_and_the_linear_response_are_those_of_the_ring_written_out(sectors, order):
    """With all contacts open, and with all of them stuck: springs in their places."""
    data = sector(sectors, order)
    one, whole = (scene_from_dict(found).in_use() for found in (data, written_out(data)))
    assert one.modal.frequency == pytest.approx(whole.modal.frequency, rel=1e-11)
    omega = 2.0 * np.pi * np.array([155.0, 187.0, 236.0])
    pushes = [linear_of(scene) for scene in (one, whole)]
    for stuck in (False, True):
        found = [
            response(linear, scene, omega, stuck) for linear, scene in zip(pushes, (one, whole), strict=True)
        ]
        np.testing.assert_allclose(found[0], found[1], rtol=1e-8, atol=1e-10 * np.abs(found[1]).max())


def response(linear, scene, omega, stuck):
    """Displacements (frequency, dof) of the structure, with springs for contacts if they are stuck."""
    rows = linear.ports * np.sqrt([k for one in scene.contacts for k in (one.k_u, one.k_v)])
    found = []
    for w in omega:
        dynamic = np.diag(linear.natural**2 - w * w + 2j * w * linear.damping * linear.natural)
        if stuck:
            dynamic = dynamic + rows @ rows.T
        found.append(linear.dofs.T @ np.linalg.solve(dynamic, linear.force[0]))
    return np.array(found)


@pytest.mark.parametrize("harmonics", [(1,), (1, 2, 3)])
@pytest.mark.parametrize(
    ("sectors", "order", "contacts"),
    [(4, 1, (rings.SHROUD, rings.DAMPER)), (5, 2, (rings.SHROUD,)), (4, 1, (rings.IN_PLANE, rings.DAMPER))],
)
def test_the_balance_is_that_of_the_ring_written_out(sectors, order, contacts, harmonics):
    """Residuals, derivatives and displacements shown, at motions in which contacts slip and open."""
    data = sector(sectors, order, contacts)
    data["force"].append({"dof": "blade", "amplitude": 20.0, "harmonic": 2, "phase": 0.3})
    data["load"] = [{"dof": "tip", "force": 40.0}]
    one, whole = (System(scene_from_dict(found), harmonics) for found in (data, written_out(data)))
    assert one.harmonics == whole.harmonics == tuple(sorted({2, *harmonics}))
    generator = np.random.default_rng(5)
    for omega in 2.0 * np.pi * np.array([172.0, 205.0]):
        z = np.append(1e-4 * generator.standard_normal(one.new_balance().unknowns), omega)
        found, expected = (system.new_balance() for system in (one, whole))
        for balance in (found, expected):
            balance.evaluate(z)
        for name in ("residual", "jacobian"):
            values, wanted = (np.array(getattr(balance, name)) for balance in (found, expected))
            assert np.abs(values - wanted).max() < 1e-10 * np.abs(wanted).max()
        of_one, of_ring = reported_at(one, z[None]), reported_at(whole, z[None])
        (X,), (mean,), (ring_X,), (ring_mean,) = of_one.X, of_one.mean, of_ring.X, of_ring.mean
        assert pytest.approx(ring_X, rel=1e-8, abs=1e-10 * np.abs(ring_X).max()) == X
        assert mean == pytest.approx(ring_mean, rel=1e-8, abs=1e-10 * np.abs(ring_X).max())


def test_blades_named_by_their_rows_have_the_springs_from_their_root():
    data = sector(5, 2, coupling=rings.COUPLING)
    named = copy.deepcopy(data)
    named["cyclic"]["mistuning"] = {"factors": FACTORS[:5], "blade": ["bl*", "tip"]}
    found, expected = (scene_from_dict(one).modal for one in (named, data))
    assert found.frequency == pytest.approx(expected.frequency, rel=1e-12)


def test_traced_curves_their_envelope_and_the_worst_blade():
    data = sector(3, 1, (rings.SHROUD,), harmonics=1, max_step=0.5, frequency=[165.0, 200.0])
    one, whole = (fcm.respond(scene_from_dict(found), "closed-form") for found in (data, written_out(data)))
    assert one.complete.item() == whole.complete.item() == 1
    expected = whole.peak_amplitude.sel(dof=names(3, "_")).values.reshape(3, 3)
    found = one.peak_amplitude.sel(dof=names(3, "@")).values.reshape(3, 3)
    assert found == pytest.approx(expected, rel=1e-8)
    assert one.sector_dof.values.tolist() == rings.DOFS
    assert one.stiffness_factor.values.tolist() == [FACTORS[:3]]
    assert one.worst_amplitude.values[0] == pytest.approx(expected.max(axis=0), rel=1e-8)
    assert one.worst_sector.values[0].tolist() == expected.argmax(axis=0).tolist()
    amplitude = one.amplitude.sel(dof=[f"tip@{k}" for k in range(3)]).values[0]
    assert np.array_equal(one.envelope.sel(sector_dof="tip").values[0], amplitude.max(axis=1))
    del data["cyclic"]["mistuning"]
    tuned = fcm.respond(scene_from_dict(data), "closed-form")
    assert one.tuned_amplitude.values == pytest.approx(tuned.peak_amplitude.values, rel=1e-12)
    assert one.amplification.values == pytest.approx(
        one.worst_amplitude.values / tuned.peak_amplitude.values, rel=1e-12
    )


def test_alike_blades_are_the_tuned_ring_whatever_its_engine_order():
    """Scaled by nothing; each curve of a sweep beside the tuned ring's of the same engine order."""
    data = sector(3, 1, (rings.SHROUD,), harmonics=1, max_step=0.5, frequency=[165.0, 200.0])
    data["cyclic"]["mistuning"]["scale"] = 0.0
    data["sweep"] = {"cyclic.engine_order": [0, 1]}
    found = fcm.respond(scene_from_dict(data), "closed-form")
    assert found.complete.values.tolist() == [1, 1]
    assert found.amplification.values == pytest.approx(np.ones((2, 3)), rel=1e-7)
    assert found.tuned_amplitude.values[0] != pytest.approx(found.tuned_amplitude.values[1], rel=0.01)
    peaks = found.peak_amplitude.values.reshape(2, 3, 3)
    assert peaks == pytest.approx(np.tile(found.tuned_amplitude.values[:, None], (1, 3, 1)), rel=1e-7)


def test_contacts_are_swept_in_all_sectors_and_set_in_one():
    data = sector(4, 1, (rings.SHROUD,))
    data["sweep"] = {"contact.shroud.n_0": [5.0, 6.0], "contact.shroud@2.mu": [0.1, 0.2]}
    scene = scene_from_dict(data)
    last = scene.curves[-1]
    assert [one.name for one in last.contacts] == [f"shroud@{k}" for k in range(4)]
    assert [(one.n_0, one.mu) for one in last.contacts] == [(6.0, 0.3), (6.0, 0.3), (6.0, 0.2), (6.0, 0.3)]
    assert [one.parameters for one in scene.tuned.curves] == [{"contact.shroud.n_0": n} for n in (5.0, 6.0)]


def test_drawn_rings_have_percentiles_and_each_is_as_if_it_were_given():
    data = sector(3, 1, (rings.SHROUD,), harmonics=1, max_step=0.5, frequency=[165.0, 200.0])
    factors = {"normal": [1.0, 0.02], "count": 3, "seed": 7}
    data["cyclic"]["mistuning"] |= {"factors": factors, "of": "frequency"}
    response = trace(
        scene_from_dict(data), "closed-form", options=ResponseOptions(sweep=SweepOptions(peaks_only=True))
    )
    few = copy.deepcopy(data)
    few["cyclic"]["mistuning"]["factors"]["count"] = 2
    drawn = response.blades.factors
    assert np.array_equal(drawn[:2], [_factors(c) for c in scene_from_dict(few).curves])
    assert np.sqrt(drawn).std() == pytest.approx(0.02, rel=0.5) and np.unique(drawn).size == 9
    whole = scene_from_dict(written_out(data, drawn[2]))
    assert scene_from_dict(data).curves[2].modal.frequency == pytest.approx(whole.modal.frequency, rel=1e-11)
    from fcm.results.output import to_dataset
    from fcm.results.summary import summary

    found, stored = summary(response), to_dataset(response)
    each = stored.amplification.sel(sector_dof="tip").values
    (scatter,) = found["scatter"]
    assert scatter["blades"]["tip"]["amplification"]["50"] == pytest.approx(np.median(each))
    assert stored.amplification_percentile.values[0, 2, 2] == pytest.approx(np.median(each))
    assert [one["blades"]["tip"]["amplification"] for one in found["curves"]] == pytest.approx(each)


def _factors(curve):
    from fcm.scene.mistuning import factors_of

    return factors_of(curve.draft.fixed(curve).parts["whole"][0])


def modal(families=2, **more):
    """Modes of five sectors: of each family one shape, whatever the diameter, turned by a phase."""
    shapes = np.array([[0.1, 0.6, 1.0], [0.3, 1.0, -0.5]])[:families]
    phases = [1.0, np.exp(0.4j), np.exp(-1.1j)]
    rows = [phase * shape for shape in shapes for phase in phases]
    return {
        "dofs": rings.DOFS, "damping": 0.003, "nodal_diameter": [0, 1, 2] * families,
        "frequency": [100.0, 103.0, 105.0, 300.0, 303.0, 309.0][: 3 * families],
        "shapes": [[[z.real, z.imag] for z in row] for row in rows],
    } | more  # fmt: skip


def of_modes(**more):
    data = rings.sector(5, 1, (rings.DAMPER,))
    data["response"]["frequency"] = [90.0, 120.0]
    data["modal"] = modal(**more)
    del data["structure"]
    data["cyclic"]["mistuning"] = {"factors": FACTORS[:5]}
    return data


def test_modes_of_a_family_deform_their_sectors_alike():
    """Written out: the strains of a family as displacements of sectors, whose stiffness is the factor."""
    scene = scene_from_dict(of_modes())
    frequency = np.array([[100.0, 103.0, 105.0, 105.0, 103.0], [300.0, 303.0, 309.0, 309.0, 303.0]])
    turn = np.exp(2j * np.pi * np.outer(range(5), range(5)) / 5) / np.sqrt(5.0)  # sector, diameter
    expected = []
    for own in frequency:
        strain = turn * own  # of each wave at each sector
        expected.append(np.linalg.eigvalsh(strain.conj().T @ (np.array(FACTORS[:5])[:, None] * strain)))
    assert scene.modal.frequency / (2 * np.pi) == pytest.approx(
        np.sqrt(np.sort(np.ravel(expected))), rel=1e-10
    )
    assert any("taken as a family" in note for note in scene.notes)
    data = of_modes()
    data["cyclic"]["mistuning"]["factors"] = [1.21] * 5
    stiffer = scene_from_dict(data)
    assert stiffer.modal.frequency == pytest.approx(2.2 * np.pi * np.sort(frequency.ravel()), rel=1e-10)


def test_modes_with_the_stiffness_of_a_blade():
    """Those of the sector's matrices, given as modes: the ring written out again."""
    data = sector(5, 2, coupling=rings.SKEW)
    tuned = copy.deepcopy(data)
    del tuned["cyclic"]["mistuning"]
    ring = scene_from_dict(tuned).ring
    given = copy.deepcopy(data)
    del given["structure"]
    given["modal"] = {
        "dofs": rings.DOFS, "frequency": (ring.frequency / 2 / np.pi).tolist(), "damping": 0.002,
        "nodal_diameter": ring.diameter.tolist(), "shapes": ring.shapes[:, :3],
    }  # fmt: skip
    found, expected = (scene_from_dict(one).modal for one in (given, written_out(data)))
    assert found.frequency == pytest.approx(expected.frequency, rel=1e-10)


def test_damping_is_that_of_the_tuned_modes_by_their_share():
    scene = scene_from_dict(of_modes(families=1, damping=[0.001, 0.002, 0.003]))
    assert scene.modal.damping.sum() == pytest.approx(0.001 + 2 * 0.002 + 2 * 0.003)
    assert 0.001 < scene.modal.damping.min() and scene.modal.damping.max() < 0.003


def test_a_base_shakes_all_blades():
    data = sector(4, 0)
    data["base"] = {"acceleration": 900.0, "phase": 0.3, "direction": dict.fromkeys(rings.DOFS, 1.0)}
    full = written_out(data)
    full["base"] = data["base"] | {"direction": dict.fromkeys(full["structure"]["dofs"], 1.0)}
    one, whole = (System(scene_from_dict(found), (1,)) for found in (data, full))
    (z,) = solutions(one, 2.0 * np.pi * 95.0).solutions
    balance = whole.new_balance()
    balance.evaluate(z)
    assert np.abs(balance.residual).max() < 1e-10 * np.abs(z[:-1]).max()


def test_coordinates_are_of_modal_mass_one():
    """Shapes of any phase of a ring of masses alone; and of eigenvalues a million million apart."""
    for sectors in (2, 5, 6):
        diameter = np.repeat(np.arange(sectors // 2 + 1), 1)
        phase = np.where((diameter == 0) | (2 * diameter == sectors), 1.0, np.exp(0.7j))
        shapes = basis_of(diameter, sectors).shapes(phase[:, None]).reshape(sectors, -1)
        assert shapes @ shapes.T == pytest.approx(np.eye(sectors), abs=1e-14)
    squared = np.array([1.0, 2.0, 3e12])
    shape = np.array([[1.0, 2.0, 1e6]])
    found, vectors = modes_of_mistuned(squared, 0.1 * shape.T @ shape)
    held = np.diag(squared[:2]) + 0.1 * shape[0, :2, None] * shape[0, :2] * (1 - 0.1 / 3.1)  # condensed
    assert found[:2] == pytest.approx(np.linalg.eigvalsh(held), rel=1e-11)
    assert vectors.T @ vectors == pytest.approx(np.eye(3), abs=1e-13)


@pytest.mark.parametrize(
    ("factors", "asked"), [([0.02, 0.03, 0.01, 0.03, 0.04, 0.02], True), (FACTORS, False)]
)
def test_factors_that_are_deviations_are_asked_about(factors, asked):
    data = sector(6, 1)
    data["cyclic"]["mistuning"] = {"factors": factors, "stiffness": (0.5 * blade_stiffness()).tolist()}
    said = [one for one in scene_from_dict(data).notes if one.startswith("cyclic.mistuning")]
    sentence = "cyclic.mistuning.factors: is 0.04, the greatest, right? "
    sentence += "Properties are multiplied by them: write 0.97 for 3 % less"
    assert said == ([sentence] if asked else [])


@pytest.mark.parametrize(
    ("mistuning", "said"),
    [
        ({"factors": [1.0, 1.1]},
         ["factors: has 2 numbers, but there are 6 sectors", "blade: missing; name"]),
        ({"stiffness": [1.0] * 3, "of": "mass"},
         ['of: must be "stiffness" or', 'factors: missing; give a list']),
        ({"stiffness": [1.0] * 3, "of": {"from": 1.0}, "factors": FACTORS},
         ['of: must be "stiffness" or "frequency", is a table']),
        ({"blade": ["tp"], "factors": FACTORS},
         ['blade[0]: no degree of freedom matches "tp"; did you mean']),
        ({"blade": ["tip"], "factors": FACTORS},
         ['blade: "tip" is coupled to the next sector, so its rows']),
        ({"blade": ["tip"], "stiffness": [1.0], "factors": FACTORS},
         ["has both blade and stiffness"]),
        ({"stiffness": [1.0], "factors": FACTORS},
         ["stiffness: has 1 rows, but a sector has 3"]),
        ({"stiffness": [0.0, 0.0, 1e7], "factors": [0.1] * 6},
         ["blade is not part of the sector's stiffness; of factors write 0.97 for 3 % less"]),
        ({"stiffness": [1.0] * 3, "factors": [0.02, -0.03, 0.01, 0.03, 0.04, 0.02]},
         ["factors[1]: must be greater than 0, as 0.97 for 3 % less, is -0.03"]),
        ({"stiffness": [1.0] * 3, "factors": FACTORS, "scale": 30.0},
         ["with scale = 30 a factor is -1.1"]),
        ({"stiffness": [1.0] * 3, "factors": {"normal": [1, 1], "count": 9}},
         ["of its 54 draws are not all"]),
        ({"stiffness": [1.0] * 3, "factors": {"count": 9}},
         ["factors: must be { normal = [mean, deviation]"]),
        ({"stiffness": [1.0] * 3, "factors": FACTORS, "blad": 1},
         ['blad: unknown key; did you mean "blade"?']),
    ],
)  # fmt: skip
def test_mistakes_are_named(mistuning, said):
    data = sector(6, 1)
    data["cyclic"]["mistuning"] = mistuning
    with pytest.raises(SceneError) as caught:
        scene_from_dict(data, "ring.toml")
    found = list(caught.value.mistakes)
    assert len(found) == len(said)
    for mistake, part in zip(found, said, strict=True):
        assert mistake.startswith("cyclic.mistuning") and part in mistake


@pytest.mark.parametrize(
    ("more", "said"),
    [
        ({"nodal_diameter": [0, 1, 1, 0, 1, 1]}, "mistuning couples all diameters; there are no modes of 2"),
        ({"nodal_diameter": [0, 1, 2, 0, 1, 1]}, "there are 1 modes of one diameter and 3 of another"),
        (
            {"shapes": [[1, 0, 0], [0, 1, 0], [1, 0, 0], *[[1, 1, 1]] * 3]},
            "mode 2 has another shape than the",
        ),
    ],
)
def test_modes_that_are_no_families_need_the_stiffness_of_a_blade(more, said):
    with pytest.raises(SceneError, match=said):
        scene_from_dict(of_modes(**more))


@pytest.mark.slow
def test_the_bundled_ring_is_told_in_words_and_numbers(tmp_path):
    done = called("respond", "mistuned-ring", "--peaks-only", "--json", "-o", tmp_path / "a.nc")
    assert done.code == 0
    curves = json.loads(done.out)["curves"]
    with netCDF4.Dataset(tmp_path / "a.nc") as file:
        found = np.asarray(file["amplification"][:, 2])
        assert found == pytest.approx([c["blades"]["tip"]["amplification"] for c in curves])
    drawn = called("plot", "campbell", "mistuned-ring", "--json")
    assert drawn.code == 0 and json.loads(drawn.out)["sectors"] == file_sectors(curves)


def file_sectors(curves):
    """Sectors of the names of peaks."""
    return 1 + max(int(name.partition("@")[2]) for name in curves[0]["peak"])


@pytest.mark.parametrize("key", ["cyclic.mistuning.scale", "contact.shroud@3.n_0"])
def test_numbers_of_a_ring_that_another_mistake_keeps_from_being_made_are_none(key):
    """They were said not to be there."""
    data = sector(6, 1) | {"schedule": [{"frequency": 1.0, "cycles": 2}], "sweep": {key: [1.0, 2.0]}}
    with pytest.raises(SceneError, match="schedule: cannot be beside") as caught:
        scene_from_dict(data)
    assert caught.value.count == 1
    del data["schedule"]
    assert [curve.parameters[key] for curve in scene_from_dict(data).curves] == [1.0, 2.0]
