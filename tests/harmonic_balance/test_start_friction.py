"""Friction forces that contacts start with choose the member of a family of motions in the balance."""

import json

import numpy as np
import pytest
import xarray

import fcm
from fcm.branches.trace import traced
from fcm.cli.loop_cases import PlanarCase
from fcm.contact.contact_law import ContactLaw
from fcm.harmonic_balance.contact_cycles import ContactRecord
from fcm.harmonic_balance.modal_condensation import CondensationOptions
from fcm.harmonic_balance.system import System
from fcm.reduction.restore import unknowns
from fcm.response import trace
from fcm.results.output import write_netcdf
from fcm.scene import SceneError, scene_from_dict
from fcm.scene.draft import number_of
from fcm.sensitivity.parameter_derivatives import rates_of
from fcm.shooting.harmonic_balance_state import harmonic_state
from fcm.shooting.residual_traction import resting_at
from fcm.time_domain.equations_of_motion import EquationsOfMotion

from ..program import called

DOFS = ["x", "y", "z"]
SHAPES = [[0.8, 0.25, 0.2], [-0.3, 1.0, -0.35], [0.25, 0.4, 0.95]]
A = {"name": "a", "normal": "z", "mu": 0.35, "k_u": 0.7, "k_v": 1.2, "n_0": 2.5}
B = {
    "name": "b",
    "tangential": "y",
    "normal": {"z": 0.9, "x": 0.35},
    "mu": 0.4,
    "k_u": 1.1,
    "k_v": 0.8,
    "n_0": 2.2,
}
ALONG, IN_PLANE = A | {"tangential": "x"}, A | {"tangential": ["x", "y"]}


def made(contact, friction, amplitude, **response):
    """A scene of three modes, whose contacts press on one another through them."""
    data = {
        "modal": {"dofs": DOFS, "frequency": [1.0, 1.4, 3.0], "damping": 0.05, "shapes": SHAPES},
        "contact": [contact, B],
        "force": [{"dof": "x", "amplitude": amplitude}],
        "response": {"frequency": [1.1, 1.3]} | response,
    }
    return scene_from_dict(data | ({} if friction is None else {"start": {"friction": friction}}))


def marched(scene, omega, ramp=10, cycles=45, steps=1500):
    """Least and greatest displacements (dof,) in the last cycle of a march from the undisplaced structure.

    The forces grow over some cycles, so that nothing slips before it has to.
    """
    modal, contacts, h = scene.modal, scene.contacts, 2.0 * np.pi / omega / steps
    along = np.array([[*one.directions[:-1], np.zeros(3)][:2] for one in contacts]) @ modal.shapes.T
    across = np.array([one.normal for one in contacts]) @ modal.shapes.T
    mu, k_u, k_v, n_0 = np.array([(one.mu, one.k_u, one.k_v, one.n_0) for one in contacts]).T
    f = np.column_stack(
        (scene.start.friction, np.zeros(2) if scene.start.second is None else scene.start.second)
    )
    w = -f / k_u[:, None]
    push = scene.forces[0].amplitude * (modal.shapes @ scene.forces[0].direction)
    damp, square = h * modal.damping * modal.frequency, modal.frequency**2
    q, rate, seen = np.zeros(3), np.zeros(3), []
    for k in range(cycles * steps):
        n = np.maximum(n_0 + k_v * (across @ q), 0.0)
        stretch = along @ q - w
        size = np.sqrt((stretch * stretch).sum(axis=1))
        stretch *= np.minimum(1.0, mu * n / k_u / np.maximum(size, 1e-300))[:, None]
        w = along @ q - stretch
        force = min(k / (ramp * steps), 1.0) * push * np.sin(omega * h * k) - (n - n_0) @ across
        force -= np.einsum("c,cd,cdm->m", k_u, stretch, along) + square * q
        rate = (rate * (1.0 - damp) + h * force) / (1.0 + damp)
        q = q + h * rate
        if k >= (cycles - 1) * steps:
            seen.append(q @ modal.shapes)
    return np.min(seen, axis=0), np.max(seen, axis=0)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("contact", "friction", "amplitude", "states"),
    [
        (ALONG, [0.3, -0.35], 0.12, ("E", "E")),
        (IN_PLANE, [[0.2, -0.25], 0.3], 0.12, ("E", "E")),
        (ALONG, [0.2, -0.35], 0.8, ("S", "E")),
        (IN_PLANE, [[0.15, -0.2], 0.3], 0.8, ("S", "E")),
    ],
)
def test_a_march_comes_to_the_same_member(contact, friction, amplitude, states):
    scene = made(contact, friction, amplitude, accuracy=1e-3)
    curve = fcm.respond(scene).isel(curve=0)
    other = fcm.respond(made(contact, None, amplitude, accuracy=1e-3)).isel(curve=0)
    i = len(curve.frequency) // 2
    least, greatest = marched(scene, float(curve.frequency[i]))
    size = (greatest - least).max()
    words = curve.regime.values[i].tolist()
    assert words[1] == "E" and (words[0] == "E") == (states[0] == "E")
    assert curve.amplitude.values[i] == pytest.approx((greatest - least) / 2, abs=2e-3 * size)
    middle = (greatest + least) / 2  # which is the mean where nothing slips
    assert curve["mean"].values[i] == pytest.approx(
        middle, abs=(1e-4 if words == ["E", "E"] else 2e-2) * size
    )
    assert abs(curve["mean"].values[i] - other["mean"].values[len(other.frequency) // 2]).max() > 0.02 * size


@pytest.mark.slow
@pytest.mark.parametrize(
    ("friction", "amplitude"),
    [([0.3, -0.35], 0.12), ([0.3, -0.35], 0.8), ([2.5, -0.3], 0.12), ([-0.6, 0.5], 0.8)],
)
def test_the_exact_motion_is_of_the_same_member(friction, amplitude):
    """Also where a contact starts with more than it can carry: then it is at its limit."""
    scene = made(ALONG, friction, amplitude, accuracy=1e-3)
    balance = fcm.respond(scene).isel(curve=0)
    exact = fcm.respond(scene, "exact", max_step=0.02).isel(curve=0)
    order, size = np.argsort(exact.frequency.values), float(balance.amplitude.max())
    i = len(balance.frequency) // 2
    for name in ("amplitude", "mean"):
        at = [
            np.interp(balance.frequency[i], exact.frequency.values[order], exact[name].values[order, d])
            for d in range(3)
        ]
        assert balance[name].values[i] == pytest.approx(at, abs=3e-3 * size)


def joint(count, amplitude, planar):
    """Many contacts on a structure of few modes, each with friction to start with."""
    rng = np.random.default_rng(3)
    tangential = [[f"{i}x", f"{i}y"] if planar else f"{i}x" for i in range(count)]
    given = {"mu": 0.4, "k_u": 0.5, "k_v": 0.7, "n_0": 3.0}
    return {
        "modal": {
            "dofs": [f"{i}{axis}" for i in range(count) for axis in "xyz"],
            "frequency": np.sort(rng.uniform(1.0, 8.0, 10)).tolist(),
            "damping": 0.01,
            "shapes": (rng.normal(size=(10, 3 * count)) / np.sqrt(count)).tolist(),
        },
        "contact": [
            given | {"name": f"c{i}", "tangential": one, "normal": f"{i}z"}
            for i, one in enumerate(tangential)
        ],
        "force": [{"dof": "0x", "amplitude": amplitude}],
        "start": {"friction": rng.uniform(-0.4, 0.4, (count, 2) if planar else count).tolist()},
        "response": {"frequency": [1.5, 1.7], "harmonics": [1, 2, 3]},
    }


@pytest.mark.parametrize("planar", [False, True])
def test_many_stuck_contacts_are_springs_that_are_stretched(planar):
    data = joint(60, 0.05, planar)
    curve, scene = fcm.respond(scene_from_dict(data)).isel(curve=0), scene_from_dict(data)
    dofs, shapes = data["modal"]["dofs"], np.array(data["modal"]["shapes"])
    stiffness, force = np.diag(np.square(data["modal"]["frequency"])), np.zeros(10)
    for contact, given in zip(data["contact"], data["start"]["friction"], strict=True):
        for name, one in zip(np.atleast_1d(contact["tangential"]), np.atleast_1d(given), strict=True):
            shape = shapes[:, dofs.index(name)]
            stiffness, force = stiffness + contact["k_u"] * np.outer(shape, shape), force - one * shape
        shape = shapes[:, dofs.index(contact["normal"])]
        stiffness = stiffness + contact["k_v"] * np.outer(shape, shape)
    mean = dict(zip(dofs, np.linalg.solve(stiffness, force) @ shapes, strict=True))
    assert System(scene, (1, 2, 3)).new_balance().rank > 0 and (curve.regime == "E").all()
    expected = np.array([mean[one] for one in curve.dof.values.tolist()])
    assert abs(curve["mean"].values - expected).max() < 1e-12 < 1e-3 < abs(expected).max()


@pytest.mark.parametrize("planar", [False, True])
def test_condensed_equations_of_many_that_slip_or_stick(planar):
    scene = scene_from_dict(joint(40, 60.0, planar))
    system = System(scene, (1, 2, 3))
    z = traced(system).branches.paths[0].z[::20]
    words = ContactRecord.at(system, z).words
    assert (words == "E").any() and (words != "E").any() and system.new_balance().rank > 0
    whole = System(scene, (1, 2, 3), condensation=CondensationOptions(min_unknowns=10**9)).new_balance()
    for one in z:
        whole.evaluate(np.ascontiguousarray(one))
        assert not whole.rank and abs(np.asarray(whole.residual)).max() < 1e-9 * abs(one).max()


def test_a_rigid_body_mode_rests_where_friction_is_in_balance():
    contacts = [
        {"name": "a", "tangential": "x", "normal": "y", "mu": 0.5, "k_u": 1.0, "k_v": 0.5, "n_0": 3.0},
        {
            "name": "b",
            "tangential": "x",
            "normal": {"y": -1.0},
            "mu": 0.5,
            "k_u": 2.0,
            "k_v": 0.5,
            "n_0": 4.0,
        },
    ]
    data = {
        "modal": {
            "dofs": ["x", "y"],
            "frequency": [0.0, 2.0],
            "damping": 0.01,
            "shapes": [[1.0, 0.0], [0.0, 1.0]],
        },
        "contact": contacts,
        "force": [{"dof": "x", "amplitude": 0.1}],
        "start": {"friction": [0.4, 0.2]},
        "response": {"frequency": [0.5, 1.0]},
    }
    curve = fcm.respond(scene_from_dict(data)).isel(curve=0)
    assert curve["mean"].sel(dof="x").values == pytest.approx(-0.6 / 3.0, rel=1e-12)


def test_a_start_without_friction_changes_nothing():
    plain, zero = (fcm.respond(made(ALONG, one, 0.8)) for one in (None, [0.0, 0.0]))
    for name in ("frequency", "amplitude", "phase", "mean", "error", "stable"):
        assert plain[name].values.tobytes() == zero[name].values.tobytes()


@pytest.mark.parametrize("key", ["contact.a.k_u", "contact.*.k_u", "contact.b.n_0", "modal.frequency.1"])
@pytest.mark.parametrize("contact", [ALONG, IN_PLANE])
def test_rates_of_the_residual_are_its_differences(key, contact):
    scene = made(contact, [0.3 if contact is ALONG else [0.2, -0.3], -0.35], 0.8)
    system = System(scene, (1, 3))
    z = np.append(0.3 * np.random.default_rng(1).normal(size=system.layout.unknowns), 1.2)

    def residual(change):
        moved = number_of(scene, key)
        more = {address: value + change for one, value, _ in moved.each(scene) for address in one.addresses}
        balance = System(scene.draft.curve(scene, {}, more), (1, 3)).new_balance()
        balance.evaluate(z)
        return np.array(balance.residual)

    rate, _ = rates_of(system, key).at(system.new_balance(), z)
    assert rate == pytest.approx((residual(1e-5) - residual(-1e-5)) / 2e-5, abs=1e-7)


def test_a_point_of_a_curve_is_a_solution_and_a_state_with_that_friction():
    scene = made(ALONG, [0.3, -0.35], 0.12, harmonics=1)
    response = fcm.respond(scene)
    point = response.isel(curve=0, point=3)
    balance, omega = System(scene, (1,)).new_balance(), float(point.frequency)
    (curve,) = fcm.response.trace(scene).curves
    z = unknowns(curve, scene, np.array([3]), curve.harmonics)[0]
    balance.evaluate(z)
    assert abs(np.asarray(balance.residual)).max() < 1e-10
    state = harmonic_state(scene, omega, point.amplitude, point.phase, point["mean"])
    system = EquationsOfMotion(scene, omega)
    at = resting_at(system, np.concatenate((state.q, state.velocity, state.friction)))
    assert at == pytest.approx([-0.3 / A["k_u"], 0.35 / B["k_u"]], abs=1e-6)


@pytest.mark.slow
def test_the_loop_in_a_plane_is_of_the_displacement_and_of_that_friction(tmp_path):
    """Where the contact sticks, f = f_0 + k_u u, with the displacements of the structure in the file."""
    write_netcdf(trace(made(IN_PLANE, [[0.2, -0.25], 0.3], 0.12, harmonics=1)), tmp_path / "a.nc")
    data = xarray.open_dataset(tmp_path / "a.nc").isel(curve=0)
    k = int(np.argmin(abs(data.frequency.values - 1.2)))
    one = data.isel(point=k)
    assert one.contact_mean.isel(contact=0).values == pytest.approx(one["mean"].values, abs=1e-12)
    assert data.contact_start.isel(contact=0).values == pytest.approx([-0.2 / 0.7, 0.25 / 0.7, 0.0])
    args = "--contact", "a", "--at", float(one.frequency), "--json"
    (told,) = json.loads(called("plot", "loop", tmp_path / "a.nc", *args, "-o", tmp_path / "a.svg").out)[
        "loops"
    ]
    theta = np.linspace(0.0, 2.0 * np.pi, 20001)[:, None]
    u = one["mean"].values[:2] + one.amplitude.values[:2] * np.sin(theta + one.phase.values[:2])
    expected = np.hypot(*(np.array([0.2, -0.25]) + 0.7 * u).T).max()
    assert told["sequence"] == "E"
    assert told["greatest_friction_force"] == pytest.approx(expected, rel=1e-6)


def test_a_dimensionless_loop_in_a_plane_starts_as_it_did():
    start, theta = (-0.3, 0.4), np.linspace(0.0, 6.0, 13)
    motion = [0.1, 0.2], [-0.1, 0.15j], [0.0, 0.3]
    loop = fcm.planar_loop(*motion, 0.5, 0.7, 1.0, 2.0, start_x=start[0], start_y=start[1])
    scaled = PlanarCase(loop, ("x", "y"), (), "", {"a": 2.0, "k_u a": 1.4}, None, start).dimensionless()
    assert 1.4 * scaled.force(theta) == pytest.approx(loop.force(theta), abs=1e-12)
    assert 2.0 * scaled.slider(theta) == pytest.approx(np.tile(start, (13, 1)), abs=1e-12)


@pytest.mark.parametrize(
    ("contact", "friction", "message"),
    [
        (
            ALONG,
            [[0.2, 0.1], 0.1],
            'friction[0]: must be one number, is a list of 2: contact "a" slides on a line',
        ),
        (
            IN_PLANE,
            [0.2, 0.1],
            'friction[0]: must be a pair of numbers, as [0.1, 0.0], is 0.2: contact "a" slides',
        ),
        (IN_PLANE, [[0.2], 0.1], "friction[0]: must be a pair of numbers, as [0.1, 0.0], is a list of 1"),
        (IN_PLANE, [[0.2, "b"], 0.1], "friction[0][1]: must be a number"),
        (IN_PLANE, [[0.2, 0.1], [0.1, 0.0]], "friction[1]: must be one number"),
        (IN_PLANE, [[0.2, 0.1]], "or a pair if it slides in a plane, 2 in all, has 1"),
        (IN_PLANE, 0.3, "or a pair if it slides in a plane, is 0.3"),
    ],
)
def test_mistakes_in_friction(contact, friction, message):
    with pytest.raises(SceneError) as caught:
        made(contact, friction, 0.8)
    assert message in str(caught.value)


def test_friction_beyond_the_limit_in_a_plane_is_said():
    notes = made(IN_PLANE, [[2.0, 1.0], 0.1], 0.12).notes
    assert any(
        "start.friction[0]: [2, 1] is beyond what a can carry there, mu n = 0.875" in one for one in notes
    )


class Spring(ContactLaw):
    def forces(self, x, dx):
        return 2.0 * x, 2.0 * dx


def test_a_law_of_ones_own_starts_with_no_friction():
    scene = made(ALONG, [0.0, -0.35], 0.8)
    assert scene.with_laws({"a": Spring()}).with_own_laws
    with pytest.raises(ValueError, match='law of "b" has no residual friction'):
        scene.with_laws({"b": Spring()})
