"""A sector under an engine order beside the whole ring written out as an ordinary scene."""

from __future__ import annotations

import numpy as np
import pytest

import fcm
from fcm.branches.force_level import solutions
from fcm.branches.trace import traced
from fcm.harmonic_balance.contact_cycles import cycles, loops
from fcm.harmonic_balance.reported_quantities import reported_at
from fcm.harmonic_balance.system import System
from fcm.scene import scene_from_dict
from fcm.stability.bifurcations import stability
from fcm.stability.floquet import multipliers, multipliers_of
from fcm.stability.options import PlanarStabilityOptions, StabilityOptions

from . import rings

BOTH = (rings.SHROUD, rings.DAMPER)
WAVES = [  # sectors, engine order, contacts: below and beyond half, half, none, beyond all, backwards
    (6, 1, BOTH), (6, 5, (rings.SHROUD,)), (6, 3, BOTH), (5, 2, BOTH), (4, 0, (rings.DAMPER,)),
    (5, 8, (rings.SHROUD,)), (2, 1, (rings.SHROUD,)), (5, -1, (rings.SHROUD,)),
    (5, 2, (rings.IN_PLANE,)), (4, 1, (rings.IN_PLANE, rings.DAMPER)),
]  # fmt: skip


def both(sectors, order, contacts, **more):
    data = rings.sector(sectors, order, contacts, **more)
    return scene_from_dict(data), scene_from_dict(rings.written_out(data))


@pytest.mark.parametrize("harmonics", [(1,), (1, 2, 3), (1, 3, 7)])
@pytest.mark.parametrize(("sectors", "order", "contacts"), WAVES)
def test_solutions_of_a_sector_solve_the_ring(sectors, order, contacts, harmonics):
    """Every equation of the ring, and the displacements of each of its sectors, phases included."""
    one, whole = (System(scene, harmonics) for scene in both(sectors, order, contacts))
    ring = one.scene.ring
    for omega in 2.0 * np.pi * np.array([172.0, 205.0]):
        (z,) = solutions(one, omega).solutions
        around = rings.around(z, harmonics, len(contacts), ring)
        balance = whole.new_balance()
        balance.evaluate(around)
        assert np.abs(balance.residual).max() < 1e-11 * np.abs(around[:-1]).max()
        of_one, of_ring = reported_at(one, z[None]), reported_at(whole, around[None])
        (X,), (mean,), (ring_X,), (ring_mean,) = of_one.X, of_one.mean, of_ring.X, of_ring.mean
        phase = 2.0 * np.pi * order / sectors * np.outer(range(sectors), harmonics)
        expected = np.exp(1j * phase)[..., None] * X[None, :, :3]
        found = ring_X.reshape(len(harmonics), sectors, 3).swapaxes(0, 1)
        assert found == pytest.approx(expected, rel=1e-9, abs=1e-11 * np.abs(X).max())
        assert ring_mean == pytest.approx(np.tile(mean[:3], sectors), rel=1e-9, abs=1e-11 * np.abs(X).max())
        assert "P" in cycles(one, z[None], loops(one, z[None]))[0][0, 0]  # it slips


@pytest.mark.parametrize("harmonic", [1, 2, 3])  # two of them travel with an engine order of their own
def test_loads_and_forces_of_any_harmonic_act_on_every_sector(harmonic):
    data = rings.sector(5, 2, BOTH) | {
        "load": [{"dof": "tip", "force": 300.0}, {"dof": "disk", "force": -50.0}]
    }
    grows = {"dof": "blade", "amplitude": 1e-4, "phase": 0.4, "proportional_to": "omega^2"}
    data["force"].append(grows | {"harmonic": harmonic})
    one, whole = (System(scene_from_dict(found), (1, 3)) for found in (data, rings.written_out(data)))
    assert one.harmonics == whole.harmonics == tuple(sorted({1, 3, harmonic}))
    (z,) = solutions(one, 2.0 * np.pi * 190.0).solutions
    around = rings.around(z, one.harmonics, 2, one.scene.ring)
    balance, of_one = whole.new_balance(), one.new_balance()
    balance.evaluate(around)
    assert np.abs(balance.residual).max() < 1e-11 * np.abs(around[:-1]).max()
    of_one.evaluate(z)
    for problem, at in ((balance, around), (of_one, z)):
        problem.evaluate_outputs(at, np.eye(at.size)[-1])
    for name in ("amplitude", "mean", "growth"):
        found, expected = (
            np.asarray(getattr(displacements, name))[:3]
            for displacements in (of_one.displacements, balance.displacements)
        )
        assert found == pytest.approx(expected, rel=1e-8)
    by_frequency = np.asarray(of_one.jacobian)[:, -1]
    assert by_frequency == pytest.approx(
        np.asarray(balance.jacobian)[: by_frequency.size, -1], rel=1e-7, abs=1e-18
    )


@pytest.mark.parametrize("harmonics", [1, 3])
def test_traced_curves_have_the_same_peaks(harmonics):
    scenes = both(3, 1, (rings.SHROUD,), harmonics=harmonics, max_step=0.3, frequency=[165.0, 225.0])
    one, whole = (fcm.respond(scene, "closed-form") for scene in scenes)
    assert one.complete.item() == whole.complete.item() == 1
    assert one.dof.values.tolist() == rings.DOFS
    for name in ("peak_amplitude", "peak_frequency"):
        expected = whole[name].sel(dof=[f"{dof}_2" for dof in rings.DOFS]).values
        assert one[name].values == pytest.approx(expected, rel=1e-8)
    assert one.peak_error.values[0, 2] == pytest.approx(whole.peak_error.sel(dof="tip_0").item(), rel=0.2)


def test_an_accuracy_takes_the_harmonics_that_the_ring_takes():
    scenes = both(3, 1, (rings.SHROUD,), accuracy=1e-3, max_step=0.3, frequency=[165.0, 225.0])
    one, whole = (fcm.respond(scene) for scene in scenes)
    assert one.harmonic.values.tolist() == whole.harmonic.values.tolist() != [1]
    assert one.peak_amplitude.values == pytest.approx(whole.peak_amplitude.values[:, :3], rel=1e-8)


# a ring and the whole of it differ by the errors of their steps
FINE = StabilityOptions(planar=PlanarStabilityOptions(tolerance=1e-6))


@pytest.mark.slow
@pytest.mark.parametrize("contacts", [BOTH, (rings.IN_PLANE, rings.DAMPER)], ids=["lines", "plane"])
@pytest.mark.parametrize(("sectors", "order"), [(5, 2), (6, -1), (6, 2), (6, 0)])
def test_multipliers_are_those_of_the_ring(sectors, order, contacts):
    """All of them where the wave repeats after all sectors; else of those disturbances that repeat as it."""
    one, whole = (System(scene, (1, 3)) for scene in both(sectors, order, contacts))
    z = solutions(one, 2.0 * np.pi * 190.0).solutions[0]
    around = rings.around(z, (1, 3), 2, one.scene.ring)
    found, expected = (
        np.sort(np.abs(multipliers(system, at, FINE))) for system, at in ((one, z), (whole, around))
    )
    found, expected = found[found > 1e-3], expected[expected > 1e-3]  # without those of places that are lost
    if np.gcd(sectors, order) == 1:
        assert found == pytest.approx(expected, rel=1e-7)
    else:
        assert 0 < found.size < expected.size
        assert np.abs(found[:, None] - expected).min(axis=1).max() < 1e-7


def test_neighbours_that_turn_against_each_other_are_told_from_a_fold():
    """A real multiplier above 1 of the ring that is none of the wave's: it breaks up, and does not fold."""
    data = rings.scene_of("bladed-disk")
    data.pop("sweep"), data.pop("units")
    data["cyclic"] = {"sectors": 8, "engine_order": 1}  # as 24 and 3
    one, whole = (System(scene_from_dict(found), (1, 3)) for found in (data, rings.written_out(data)))
    (z,) = solutions(one, 2.0 * np.pi * 239.0).solutions
    growing = [value for value in multipliers(one, z) if abs(value) > 1.005]
    assert len(growing) == 1 and growing[0].real < 0.0
    (of_ring, *_) = multipliers(whole, rings.around(z, (1, 3), 2, one.scene.ring))
    assert of_ring == pytest.approx(abs(growing[0]), rel=1e-6)


def test_so_are_they_in_a_plane():
    """As above, with tips that move sideways too; the wave is said to be unstable there."""
    data = rings.scene_of("bladed-disk")
    data.pop("sweep"), data.pop("units")
    data["cyclic"] = {"sectors": 8, "engine_order": 1}
    coupling = np.pad(rings.COUPLING, (0, 1)).tolist()
    data["structure"] = {
        "dofs": [*rings.DOFS, "side"], "mass": [1.2, 0.35, 0.25, 0.25], "damping": 0.001,
        "stiffness": [
            [1.016e8, -1e6, 0.0, 0.0], [-1e6, 3e6, -2e6, 0.0], [0.0, -2e6, 2e6, -2e5], [0.0, 0.0, -2e5, 3e6],
        ],
        "coupling": {"stiffness": coupling},
    }  # fmt: skip
    shroud, damper = data["contact"]
    across = {"next.side": 1.0, "side": -1.0}
    data["contact"] = [
        shroud | {"tangential": [shroud["tangential"], across], "n_0": 20.0},
        damper | {"tangential": [damper["tangential"], "side"]},
    ]
    one, whole = (System(scene_from_dict(found), (1, 2, 3)) for found in (data, rings.written_out(data)))
    (z,) = solutions(one, 2.0 * np.pi * 240.0).solutions
    growing = [value for value in multipliers(one, z, FINE) if abs(value) > 1.005]
    assert len(growing) == 1 and growing[0].real < 0.0
    (of_ring, *_) = multipliers(whole, rings.around(z, (1, 2, 3), 2, one.scene.ring), FINE)
    assert of_ring == pytest.approx(abs(growing[0]), rel=1e-6)
    assert multipliers_of(one, float(z[-1])).classify(z).stable == 0.0


def test_stability_of_all_points_is_told_by_the_multipliers_of_few():
    """With one harmonic: modes of other diameters, some always near the negative axis, ask for no more."""
    system = System(scene_from_dict(rings.sector(12, 5)), (1,))
    (path,) = traced(system).branches.paths
    found = stability(system, path)
    each = multipliers_of(system, float(path.parameter.max()))
    np.testing.assert_array_equal(found.stable, [each.classify(z).stable for z in path.z])
    assert found.evaluations < 0.6 * len(path.z)


def test_a_base_that_moves_along_the_axis_shakes_all_sectors():
    """Of coupled masses each sector has its half, and that of its neighbour."""
    heavy = {"stiffness": rings.SKEW, "mass": [[0.05, 0.0, 0.01], [0.0, 0.0, 0.0], [0.0, 0.02, 0.0]]}
    data = rings.sector(4, 0, BOTH)
    data["structure"] = data["structure"] | {"coupling": heavy, "mass": np.diag([1.2, 0.35, 0.25]).tolist()}
    data["base"] = {"acceleration": 900.0, "phase": 0.3, "direction": dict.fromkeys(rings.DOFS, 1.0)}
    full = rings.written_out(data)
    full["base"] = data["base"] | {"direction": dict.fromkeys(full["structure"]["dofs"], 1.0)}
    one, whole = (System(scene_from_dict(found), (1, 3)) for found in (data, full))
    (z,) = solutions(one, 2.0 * np.pi * 95.0).solutions
    around = rings.around(z, (1, 3), 2, one.scene.ring)
    balance = whole.new_balance()
    balance.evaluate(around)
    assert np.abs(balance.residual).max() < 1e-11 * np.abs(around[:-1]).max()
    (X,), (ring_X,) = (reported_at(of, at[None]).X for of, at in ((one, z), (whole, around)))
    assert ring_X[:, :3] == pytest.approx(X[:, :3], rel=1e-9, abs=1e-11 * np.abs(X).max())
