"""What loads a structure beside harmonic forces: static loads, forces that grow as omega^2, a moving base."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg
import scipy.optimize

import fcm
from fcm.harmonic_balance.static_equilibrium import RestError, rest_of
from fcm.harmonic_balance.system import System
from fcm.model.scene import Force, Load
from fcm.response import ResponseError, trace
from fcm.response.level import LevelRequest, trace_levels
from fcm.scene import load_scene, scene_from_dict
from fcm.shooting.residual import Shooting
from fcm.time_domain import State, simulate
from fcm.time_domain.energy import energy

from ..program import called
from ..time_domain.reference import Law, integrate
from .linear_response import linear_response

YANG = load_scene("yang1998-n5")
U, V = np.eye(2)


def loaded(scene=YANG, loads=(), **contact):
    """With static loads (on u, on v), and a changed contact."""
    found = tuple(Load(np.asarray(direction), force) for direction, force in loads)
    return replace(scene, loads=found, contacts=(replace(scene.contacts[0], **contact),))


def stiffness(scene):
    """The static stiffness of the structure without contacts."""
    modal = scene.modal
    inverse = np.linalg.inv(modal.shapes)
    return inverse @ np.diag(modal.mass * modal.frequency**2) @ inverse.T


def growing(scene, omega_ref):
    """With forces in proportion to omega^2 that have at one frequency the amplitudes that are constant."""
    forces = [replace(one, amplitude=one.amplitude / omega_ref**2, power=2) for one in scene.forces]
    return replace(scene, forces=tuple(forces))


def same(one, other, rel=1e-8):
    assert one.complete and other.complete
    assert one.folds == pytest.approx(other.folds, rel=rel)
    for dof, peak in one.peaks.items():
        assert peak[:2] == pytest.approx(other.peaks[dof][:2], rel=rel)


@pytest.mark.parametrize("harmonics", [1, 3])
def test_on_a_contact_that_always_sticks_a_static_load_is_linear_statics(harmonics):
    scene = loaded(loads=[(U, 2.0), (V, -1.5)], n_0=1e3)
    (curve,) = trace(scene, harmonics=harmonics).curves
    held = np.linalg.solve(stiffness(scene) + np.diag([1.0, 1.0]), [2.0, -1.5])  # k_u = k_v = 1
    assert curve.mean == pytest.approx(np.broadcast_to(held, curve.mean.shape), rel=1e-10)
    same(curve, trace(loaded(n_0=1e3), harmonics=harmonics).curves[0])  # a linear response has no say in it
    exact = fcm.respond(scene, "exact", at=[1.3])
    assert exact["mean"].values[0, 0] == pytest.approx(held, rel=1e-9)


@pytest.mark.parametrize("before, after", [(5.0, 12.0), (-5.0, 5.0), (12.0, 5.0), (5.0, -5.0)])
def test_a_static_normal_load_is_another_preload(before, after):
    """One that moves the structure along the contact's normal by s, against what the contact gains of it.

    Then n_0 + k_v s is the preload of the displacements counted from there.
    """
    s = after - before  # k_v = 1
    force = stiffness(YANG) @ [0.0, s] + [0.0, max(after, 0.0) - max(before, 0.0)]
    scene = loaded(loads=[(U, force[0]), (V, force[1])], n_0=before)
    (shifted,), (plain,) = trace(scene, harmonics=3).curves, trace(loaded(n_0=after), harmonics=3).curves
    same(shifted, plain)
    assert shifted.folds or after == 12.0
    top = [int(np.nanargmax(one.amplitude[:, 0])) for one in (shifted, plain)]
    assert shifted.mean[top[0]] == pytest.approx(plain.mean[top[1]] + [0.0, s], rel=1e-6)
    if after == 12.0:
        exact, other = (fcm.respond(one, "exact", at=[1.35]) for one in (scene, loaded(n_0=after)))
        assert exact.amplitude.values == pytest.approx(other.amplitude.values, rel=1e-9)


def test_a_load_that_makes_the_contact_slip_counts_with_its_friction_in_the_mean():
    """At rest the sum of all forces vanishes, also where friction is at its limit."""
    for loads in ([(U, 20.0), (V, 3.0)], [(V, -40.0)], [(U, -1.0), (V, 2.0)]):
        scene = loaded(loads=loads)
        q, friction = rest_of(scene)
        law, y = Law(replace(scene, forces=()), 1.0), np.append(np.concatenate((q, 0.0 * q)), 0.0)
        load = max(5.0 + law.V[0] @ q, 0.0)
        assert abs(friction[0]) <= 0.4 * load * (1.0 + 1e-12)
        y[-1] = law.U[0] @ q - friction[0]  # k_u = 1
        state = "E" if load > 0.0 else "S"
        assert law.rhs(0.0, y, [state]) == pytest.approx(np.zeros(y.size), abs=1e-12)
    assert State.rest(scene).q == pytest.approx(q)


@pytest.mark.parametrize("method", ["closed-form", "exact"])
def test_a_force_that_grows_is_at_one_frequency_a_constant_one(method):
    omega = 1.3
    narrow = replace(YANG, frequency_range=(omega, 1.5))
    ends = []
    for scene in (narrow, growing(narrow, omega)):
        found = fcm.respond(scene, method, harmonics=[1, 2, 3] if method != "exact" else None)
        at = int(np.argmin(np.abs(found.frequency.values[0] - omega)))
        assert float(found.frequency[0, at]) == omega
        ends.append(found.amplitude.values[0, at])
    assert ends[0] == pytest.approx(ends[1], rel=1e-9)


def test_derivatives_by_the_frequency_know_that_forces_grow():
    scene = loaded(growing(YANG, 1.0), [(U, 0.5), (V, 1.0)])
    balance = System(scene, (1, 2, 3)).new_balance()
    z = np.append(np.random.default_rng(1).normal(size=balance.unknowns), 1.2)
    step = 1e-6 * np.eye(z.size)[-1]
    balance.evaluate(z)
    by_frequency, sides, shown = np.array(balance.jacobian)[:, -1], [], []
    balance.evaluate_outputs(z, np.eye(z.size)[-1])
    growth = np.array(balance.growth)
    for sign in (1.0, -1.0):
        balance.evaluate(z + sign * step)
        balance.evaluate_outputs(z + sign * step, 0.0 * z)
        sides.append(np.array(balance.residual))
        shown.append(np.array(balance.output))
    assert by_frequency == pytest.approx((sides[0] - sides[1]) / 2e-6, rel=1e-6, abs=1e-6)
    assert growth == pytest.approx((shown[0] - shown[1]) / 2e-6, rel=1e-5, abs=1e-6)
    problem, x = Shooting(scene), np.array([3.0, 1.0, 2.0, -4.0, 0.5])
    ends = [problem.residual(x, 1.2 + h) for h in (0.0, 1e-6, -1e-6)]
    assert ends[0].by_parameter == pytest.approx(
        (ends[1].closure - ends[2].closure) / 2e-6, rel=1e-5, abs=1e-5
    )


def test_the_exact_motion_under_all_of_them_is_that_of_an_ordinary_solver():
    scene = loaded(growing(YANG, 1.5), [(U, 0.8), (V, 2.0)])
    scene = replace(scene, forces=(*scene.forces, Force(V, 0.7, 0.4)))
    times = np.linspace(0.0, 3.0 * 2.0 * np.pi / 1.2, 40)
    motion = simulate(scene, 1.2, 3, State(np.zeros(2), np.zeros(2), np.zeros(1)))  # loaded all at once
    assert motion.displacement(times) == pytest.approx(integrate(scene, 1.2, 3, times), abs=1e-8)
    assert energy(motion).error < 1e-12


def test_many_harmonics_come_to_the_exact_motion_under_static_and_growing_loads():
    scene = loaded(growing(YANG, 1.2), [(U, 0.5), (V, 3.0)])
    many, exact = trace(scene, harmonics=9).curves[0], fcm.respond(scene, "exact")
    assert sorted(many.folds) == pytest.approx(sorted(exact.fold_frequency.values[0]), rel=1e-4)
    assert np.nanmax(many.amplitude, axis=0) == pytest.approx(
        exact.amplitude.max("point").values[0], rel=1e-3
    )
    (one,) = trace(scene, harmonics=1).curves
    true = float(exact.amplitude.sel(dof="u").max())
    assert 0.3 < one.peaks["u"].error / abs(one.peaks["u"].amplitude / true - 1.0) < 3.0  # and says so
    assert {0.0, 1.0} <= set(many.stable[np.isfinite(many.stable)])  # the branch between the folds is not


def test_static_loads_do_not_scale_with_the_level():
    scene = loaded(growing(YANG, 1.2), [(U, 0.5), (V, 3.0)])
    (curve,) = trace_levels(scene, LevelRequest([1.2], (0.0, 1.0)), harmonics=3).curves
    at_rest = scene.modal.shapes.T @ rest_of(scene)[0]
    assert curve.level[0] <= 1e-3 and curve.mean[0] == pytest.approx(at_rest, rel=1e-3)
    (narrow,) = trace(replace(scene, frequency_range=(1.2, 1.25)), harmonics=3).curves
    ends = [narrow.amplitude[i] for i in np.flatnonzero(narrow.frequency == 1.2)]
    passing = curve.amplitude[curve.level == 1.0]
    assert len(ends) and all(np.abs(passing - end).max(axis=1).min() < 1e-7 for end in ends)


BODY = {"dofs": ["x", "y"], "mass": [1.0, 1.0], "frequency": [0.5, 0.0], "damping": [0.02, 0.0],
        "shapes": [[1.0, 0.0], [0.0, 1.0]]}  # fmt: skip
CONTACT = {"name": "c", "tangential": "x", "normal": "y", "mu": 0.4, "k_u": 1.0, "k_v": 2.0}


def body(load, modal=BODY, **contact):
    return {
        "modal": modal,
        "contact": [CONTACT | contact],
        "force": [{"dof": "x", "amplitude": 1.0}, {"dof": "y", "amplitude": 0.5}],
        "load": [{"dof": dof, "force": force} for dof, force in load.items()],
        "response": {"frequency": [0.3, 1.7], "max_step": 0.2, "harmonics": 1},
    }


@pytest.mark.parametrize("before", [-3.0, 1.0])
def test_a_free_body_that_a_load_presses_onto_a_contact(before):
    """Beside its gap it has no place of its own; the load moves it until the contact bears that."""
    modal = BODY | {"frequency": [0.0, 2.0], "damping": [0.02, 0.02], "shapes": [[0.8, 0.3], [-0.3, 0.9]]}
    after, k_v = 20.0, 1.0
    s = (after - before) / k_v
    free = scene_from_dict(body({"x": 1.0}, modal, n_0=before, k_v=k_v))
    force = stiffness(free) @ [0.0, s] + [0.0, after - max(before, 0.0)]
    scene = scene_from_dict(body(dict(zip("xy", force, strict=True)), modal, n_0=before, k_v=k_v))
    (curve,), (plain,) = (
        trace(each).curves for each in (scene, scene_from_dict(body({}, modal, n_0=after, k_v=k_v)))
    )
    same(curve, plain)
    q, friction = rest_of(scene)
    assert scene.modal.shapes.T @ q == pytest.approx([0.0, s], abs=1e-9)
    assert friction == pytest.approx([0.0], abs=1e-9)


def test_what_nothing_can_hold_is_refused_in_plain_words(tmp_path):
    adrift = BODY | {"frequency": [0.0, 0.0], "damping": 0.0}
    with pytest.raises(ResponseError, match="push the structure along a rigid-body mode that no contact"):
        fcm.respond(scene_from_dict(body({"x": 0.1}, adrift, n_0=5.0, mu=0.0)))
    (curve,) = trace(scene_from_dict(body({"x": 2.1}, adrift, n_0=5.0))).curves  # more than mu n_0
    assert not curve.complete and "no equilibrium with the static loads" in curve.reason
    pulled = scene_from_dict(body({"y": -6.0}, n_0=1.0))  # off its contact
    with pytest.raises(RestError, match="no equilibrium"):
        rest_of(pulled)
    (curve,) = trace(pulled).curves
    assert not curve.complete and "no equilibrium with the static loads" in curve.reason
    path = tmp_path / "pulled.toml"
    path.write_text(
        '[modal]\ndofs = ["x", "y"]\nmass = [1, 1]\nfrequency = [0.5, 0]\ndamping = [0.02, 0]\n'
        "shapes = [[1, 0], [0, 1]]\n[[contact]]\nname = 'c'\ntangential = 'x'\nnormal = 'y'\nmu = 0.4\n"
        "k_u = 1\nk_v = 2\nn_0 = 1\n[[force]]\ndof = 'x'\namplitude = 1\n[[load]]\ndof = 'y'\nforce = -6\n"
        "[response]\nfrequency = [0.3, 2]\n[[schedule]]\nfrequency = 1\ncycles = 3\n"
    )
    for options in ([], ["--method", "exact"], ["--method", "exact", "--at", "1"]):
        done = called("respond", path, "-o", tmp_path / "a.nc", *options)
        assert done.code == 3 and "no equilibrium" in done.out + done.err


def test_a_moving_base_is_the_forces_of_inertia():
    """-M d a on the relative displacements: here with a full mass matrix, a contact, and slip."""
    M, K = np.array([[2.0, 0.3], [0.3, 1.0]]), np.array([[3.0, -1.0], [-1.0, 2.0]])
    contact = [
        {"name": "c", "tangential": "1x", "normal": "1y", "mu": 0.4, "k_u": 1.0, "k_v": 1.0, "n_0": 2.0}
    ]
    table = {"dofs": ["1x", "1y"], "mass": M.tolist(), "stiffness": K.tolist(), "damping": 0.01}
    top = {"structure": table, "contact": contact, "response": {"frequency": [0.6, 2.2], "harmonics": 3}}
    push = -M @ [1.0, 0.0] * 1.5
    forces = [
        {"dof": dof, "amplitude": f, "phase": "30deg"} for dof, f in zip(table["dofs"], push, strict=True)
    ]
    based = top | {"base": {"acceleration": 1.5, "direction": "x", "phase": "30deg"}}
    (one,), (other,) = (trace(scene_from_dict(each)).curves for each in (based, top | {"force": forces}))
    assert one.complete and one.folds == pytest.approx(other.folds, rel=1e-8)
    assert np.ptp([len(set(row[0])) for row in one.regime]) > 0  # it slips somewhere
    for dof in table["dofs"]:
        assert one.peaks[dof][:2] == pytest.approx(other.peaks[dof][:2], rel=1e-8)


def test_the_linear_response_grows_with_the_forces():
    scene = growing(YANG, 1.0)
    springs = np.array([1.0, 1.0])
    for omega in (0.8, 1.7):
        one, other = (linear_response(each, np.array([omega]), springs) for each in (scene, YANG))
        assert one == pytest.approx(omega**2 * other, rel=1e-12)


def test_bolts_press_a_joint_together_where_it_does_not_open():
    """A beam on unilateral springs: those in contact bear the loads, by an active set of linear statics."""
    nodes, k_v, bolts = 9, 50.0, {2: 3.0, 4: 5.0}
    bend = np.diff(np.eye(nodes), 2, axis=0)
    K = 40.0 * bend.T @ bend + 1e-9 * np.eye(nodes)  # nothing else holds it
    square, shapes = np.linalg.eigh(K)
    force = np.zeros(nodes)
    force[list(bolts)] = list(bolts.values())
    closed, before = np.ones(nodes, dtype=bool), None
    while before is None or (closed != before).any():
        v = np.linalg.solve(K + np.diag(k_v * closed), force)
        before, closed = closed, v > 0.0
    assert 0 < closed.sum() < nodes and k_v * v[closed].sum() == pytest.approx(8.0, rel=1e-6)
    scene = scene_from_dict(
        {
            "modal": {
                "dofs": [f"{i}z" for i in range(nodes)] + ["x"],
                "frequency": [*np.sqrt(square), 3.0],
                "damping": [0.02] * (nodes + 1),
                "shapes": scipy.linalg.block_diag(shapes.T, 1.0),
            },
            "contact": [
                {"name": f"c{i}", "tangential": "x", "normal": f"{i}z", "mu": 0.3, "k_u": 1.0, "k_v": k_v,
                 "n_0": 0.0} for i in range(nodes)
            ],
            "load": [{"dof": f"{i}z", "force": one} for i, one in bolts.items()],
            "force": [{"dof": "x", "amplitude": 1e-4}],
            "response": {"frequency": [3.0, 5.0], "harmonics": 1},
        },
        "bolts",
    )  # fmt: skip
    rest = rest_of(scene)[0] @ scene.modal.shapes
    assert rest[:nodes] == pytest.approx(v, rel=1e-6, abs=1e-9)
    found = fcm.respond(scene)
    pressed = found.greatest_normal_force.values[0, 0]  # the load does not vary
    assert pressed == pytest.approx(np.where(closed, k_v * v, 0.0), rel=1e-6, abs=1e-9)
    stick = np.sqrt(9.0 + closed.sum())  # of each closed contact k_u
    assert found.peak_frequency.sel(dof="x").item() == pytest.approx(stick, rel=1e-3)


def floating_plate(load, count=30):
    """On an elastic one, and held by contacts in the plane alone: these just touch without the load."""
    turn = np.linalg.qr(np.random.default_rng(3).normal(size=(4, 4)))[0]  # any basis of rigid-body modes
    return scene_from_dict(
        {
            "modal": {
                "dofs": ["x", "y", "z", "ry", "x_below", "y_below", "z_below"],
                "frequency": [0.0, 0.0, 0.0, 0.0, 3.0, 4.0, 5.0],
                "damping": 0.01,
                "shapes": scipy.linalg.block_diag(turn, np.eye(3)).tolist(),
            },
            "contact": [
                {
                    "name": f"c{i}",
                    "tangential": [{"x": 1.0, "x_below": -1.0, "ry": 0.4}, {"y": 1.0, "y_below": -1.0}],
                    "normal": {"z": 1.0, "ry": place, "z_below": -1.0},
                    "mu": 0.3,
                    "k_u": 7.0,
                    "k_v": 11.0,
                    "n_0": 0.0,
                }
                for i, place in enumerate(np.linspace(-1.3, 1.1, count))
            ],
            "load": [{"dof": {"z": 1.0, "ry": 0.3, "z_below": -1.0}, "force": load}],
            "force": [{"dof": "x", "amplitude": 0.1}],
            "response": {"frequency": [0.3, 1.0], "harmonics": 1},
        },
        "plate",
    )


def test_a_floating_plate_rests_where_contacts_balance_the_load_or_nowhere():
    """With none closed at first its equations are singular, and their solution is rounding."""
    scene = floating_plate(6.0)
    q = rest_of(scene)[0] @ scene.modal.shapes
    n, f = np.zeros(30), np.zeros((30, 2))
    for i, contact in enumerate(scene.contacts):
        n[i] = max(11.0 * contact.normal @ q, 0.0)
        f[i] = 7.0 * np.array([contact.tangential @ q, contact.second @ q])
        f[i] *= min(1.0, 0.3 * n[i] / np.hypot(*f[i]))
    assert n.sum() == pytest.approx(6.0, rel=1e-9)
    assert n @ [contact.normal[3] for contact in scene.contacts] == pytest.approx(1.8, rel=1e-9)
    assert f.sum(axis=0) == pytest.approx([0.0, 0.0], abs=1e-9)  # along x and y friction alone holds it
    assert q[4:] * [9.0, 16.0, 25.0] == pytest.approx([0.0, 0.0, 0.0], abs=1e-9)
    with pytest.raises(RestError, match="no equilibrium"):
        rest_of(floating_plate(-6.0))


PLACES = np.array([[-1.0, 0.3], [-0.4, -0.5], [0.1, 0.6], [0.8, -0.2], [1.2, 0.4]])


def block_on_friction(push, amplitude=1e-4):
    """Free but for five contacts, which bear different loads; a load presses it down and pushes it along."""
    turn = np.linalg.qr(np.random.default_rng(5).normal(size=(5, 5)))[0]  # any basis of rigid-body modes
    contacts = [
        {"name": f"c{i}", "tangential": [{"x": 1.0, "rz": -y}, {"y": 1.0, "rz": x}],
         "normal": {"z": 1.0, "ry": x}, "mu": 0.3, "k_u": 7.0, "k_v": 11.0, "n_0": 0.0}
        for i, (x, y) in enumerate(PLACES.tolist())
    ]  # fmt: skip
    data = {
        "modal": {"dofs": ["x", "y", "rz", "z", "ry"], "frequency": [0.0] * 5, "damping": 0.0,
                  "shapes": turn.tolist()},
        "contact": contacts,
        "load": [{"dof": {"z": 1.0, "ry": 0.4}, "force": 9.0},
                 {"dof": {"x": 0.8, "y": 0.6, "rz": 0.7}, "force": push}],
        "force": [{"dof": "y", "amplitude": amplitude}],
        "response": {"frequency": [0.7, 1.1], "harmonics": 1},
    }  # fmt: skip
    return scene_from_dict(data, "block")


@pytest.mark.slow
@pytest.mark.parametrize("push", [0.5, 2.0])
def test_contacts_that_stick_hold_a_free_body_in_their_plane(push):
    """As the sum of all forces, by a solver that knows neither modes nor shares: with the larger push some
    slip. It was at x = y = 0, and what pushed it was refused, or not balanced."""
    x, y = PLACES.T

    def forces(q):
        n = np.maximum(11.0 * (q[3] + x * q[4]), 0.0)
        u = np.array([q[0] - y * q[2], q[1] + x * q[2]])
        return 7.0 * u * np.minimum(1.0, 0.3 * n / (7.0 * np.hypot(*u))), n

    def unbalanced(q):
        (f_x, f_y), n = forces(q)
        held = f_x.sum(), f_y.sum(), (x * f_y - y * f_x).sum(), n.sum(), (x * n).sum()
        return np.array([0.8 * push, 0.6 * push, 0.7 * push, 9.0, 3.6]) - held

    expected = scipy.optimize.root(unbalanced, [0.01, 0.01, 0.01, 0.15, 0.05])
    assert np.abs(unbalanced(expected.x)).max() < 1e-9
    (f_x, f_y), n = forces(expected.x)
    slipping = np.hypot(f_x, f_y) > 0.3 * n * (1.0 - 1e-9)
    assert slipping.any() == (push > 1.0) and not slipping.all()
    scene = block_on_friction(push)
    assert rest_of(scene)[0] @ scene.modal.shapes == pytest.approx(expected.x, rel=1e-7)
    assert rest_of(scene)[1] == pytest.approx(f_x, rel=1e-7)
    (curve,) = trace(scene).curves  # which hardly moves it
    assert curve.complete and curve.mean == pytest.approx(
        np.broadcast_to(expected.x, curve.mean.shape), rel=1e-3
    )


def test_what_friction_holds_at_rest_creeps_where_it_slips():
    """As the exact motion does from rest: it stays where the contact sticks, and moves on near resonance."""
    adrift = BODY | {"frequency": [0.0, 2.0], "damping": [0.0, 0.02]}
    data = body({"x": 1.0}, adrift, n_0=5.0) | {"force": [{"dof": "x", "amplitude": 0.3}]}
    scene = scene_from_dict(data)
    assert rest_of(scene)[0] @ scene.modal.shapes == pytest.approx([1.0, 0.0], abs=1e-12)
    (curve,) = trace(scene).curves
    ends = [float(word) for word in curve.reason.split()[1:4:2]]
    assert "the static loads push the structure on" in curve.reason and 0.8 < ends[0] < 1.0 < ends[1] < 1.2
    for omega, stays in ((0.5, True), (sum(ends) / 2.0, False)):
        mean = simulate(scene, omega, 300).measures(last=100)[-1].mean[0]
        assert (abs(mean - 1.0) < 0.1) == stays and (stays or mean > 50.0)
    slip = (curve.regime != "E").all(axis=1)
    assert (curve.mean[:, 0] == 1.0).all() and slip.any()
    assert (curve.stable[slip] == 0.0).all()


def test_a_load_in_the_plane_that_friction_cannot_hold_is_refused():
    (curve,) = trace(block_on_friction(4.0)).curves  # 0.3 times the load of 9 is 2.7
    assert not curve.complete and "no equilibrium with the static loads" in curve.reason


def test_no_peaks_are_looked_for_where_only_loads_work():
    """There rounding may be all that moves; of 40 pairs under bolts a curve took 14834 points, now 124."""
    scene = replace(YANG, reported=("u",))
    for one, grows in ((YANG, [True, True]), (scene, [True, False])):
        balance = System(one).new_balance()
        z = np.append(np.full(balance.unknowns, 0.1), 1.2)
        balance.evaluate(z)
        balance.evaluate_outputs(z, np.ones(z.size))
        assert (np.asarray(balance.growth) != 0.0).tolist() == grows
        assert (np.asarray(balance.output) > 0.0).all()
