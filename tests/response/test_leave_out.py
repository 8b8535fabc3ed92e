"""What is left out changes nothing, or less than is said."""

from dataclasses import replace

import numpy as np
import pytest

import fcm
from fcm.reduction import negligible_parts
from fcm.reduction.linear import change, comparison_frequencies
from fcm.reduction.options import REDUCTION
from fcm.reduction.static_modes import condensed
from fcm.response import trace
from fcm.response.options import ResponseOptions, leaving_out
from fcm.scene import scene_from_dict

from .linear_response import linear_response


def structure(modes, contacts, dofs, top, **more):
    """Modes of a bar with some disorder; the first three have resonances in the range."""
    random = np.random.default_rng(1)
    names = [f"x{i}" for i in range(dofs)]
    frequency = np.sort(random.uniform(3.0, top, modes))
    frequency[:3] = 1.0, 1.7, 2.6
    along = np.linspace(0.0, 1.0, dofs)
    shapes = [
        np.sin((k + 1) * np.pi * along + 0.3 * k) + 0.2 * random.normal(size=dofs) for k in range(modes)
    ]

    def contact(number):
        one, two = random.choice(dofs, 2, replace=False)
        tangential = {names[one]: 1.0, names[two]: -1.0} if number % 2 else names[one]
        load = {"n_0": float(random.uniform(-0.2, 0.6)), "mu": 0.4, "k_u": 0.05, "k_v": 0.05}
        return {"name": f"c{number}", "tangential": tangential, "normal": names[two], **load}

    return scene_from_dict(
        {
            "modal": {"dofs": names, "frequency": frequency, "damping": 0.01, "shapes": np.array(shapes)},
            "contact": [contact(number) for number in range(contacts)],
            "force": [{"dof": names[3], "amplitude": 0.3}],
            "response": {"frequency": [0.8, 2.2], "max_step": 0.2, "harmonics": 1},
            **more,
        }
    )


def bound(response):
    """The number in the sentence on modes."""
    (sentence,) = [text for text in response.left_out if "far above" in text]
    return float(sentence.partition("less than ")[2].partition(",")[0])


@pytest.mark.slow
def test_five_hundred_modes_within_the_bound():
    scene = structure(500, 4, 40, 300.0)
    light, full = trace(scene), trace(scene, options=leaving_out(None))
    assert full.left_out == [] and 0.0 < bound(light) <= REDUCTION.tolerance
    one, other = light.curves[0], full.curves[0]
    assert len(one.folds) == len(other.folds)
    for dof, (amplitude, frequency, *_) in other.peaks.items():
        assert one.peaks[dof][0] == pytest.approx(amplitude, rel=bound(light))
        assert one.peaks[dof][1] == pytest.approx(frequency, rel=bound(light))


def test_a_smaller_tolerance_keeps_more():
    scene = structure(200, 2, 20, 150.0)
    kept = []
    for tolerance in (1e-3, 1e-5, 1e-7):
        lighter = negligible_parts.without_negligible_parts((scene,), tolerance)
        kept.append(lighter.curves[0].modal.frequency.size)
    assert kept[0] <= kept[1] <= kept[2]
    assert negligible_parts.without_negligible_parts((scene,), 0.0).curves == (scene,)


def test_the_error_falls_with_the_fourth_power_of_the_frequency():
    scene = structure(200, 2, 20, 150.0)
    modal = replace(scene.modal, damping=np.zeros(200))
    directions = np.array([c.tangential for c in scene.contacts]).T
    fewer = condensed(modal, directions, modal.frequency > 20.0)

    def response(modal, omega):
        return ((modal.shapes @ directions).T / (modal.mass * (modal.frequency**2 - omega**2))) @ modal.shapes

    error = [np.abs(response(fewer, w) - response(modal, w)).max() for w in (2.0, 4.0)]
    assert np.log2(error[1] / error[0]) == pytest.approx(4.0, abs=0.3)


@pytest.mark.slow
def test_a_wrong_estimate_is_found_and_everything_kept():
    scene = structure(120, 2, 20, 100.0)
    reference = trace(scene, options=leaving_out(None))
    any_estimate = ResponseOptions(reduction=replace(REDUCTION, estimate_margin=np.inf))
    response = trace(scene, options=leaving_out(1e-9, any_estimate))
    assert not any("far above" in sentence for sentence in response.left_out)
    for dof, peak in reference.curves[0].peaks.items():
        assert response.curves[0].peaks[dof][:2] == pytest.approx(peak[:2], rel=1e-9)


def strip(contacts):
    """Two rows of masses and springs on contacts, one along and one across: all modes, lowest first."""
    chain = np.diag([1.0, *[2.0] * (contacts - 2), 1.0]) - np.eye(contacts, k=1) - np.eye(contacts, k=-1)
    frequency, shapes = [], []
    names = [f"{axis}{i}" for axis in "uv" for i in range(contacts)]
    for row, (stiffness, ground) in enumerate(((100.0, 20.0), (30.0, 50.0))):
        square, vectors = np.linalg.eigh(stiffness * contacts**2 * chain + ground * np.eye(contacts))
        frequency += np.sqrt(square).tolist()
        shapes += [np.roll([*v, *[0.0] * contacts], row * contacts) for v in vectors.T * contacts**0.5]
    order, last = np.argsort(frequency), contacts - 1
    law = {"mu": 0.4, "k_u": 200.0 / contacts, "k_v": 300.0 / contacts, "n_0": 8.0 / contacts}
    return scene_from_dict(
        {
            "modal": {
                "dofs": names,
                "frequency": np.array(frequency)[order],
                "damping": 0.01,
                "shapes": np.array(shapes)[order],
            },
            "contact": [
                law | {"name": f"c{i}", "tangential": f"u{i}", "normal": f"v{i}"} for i in range(contacts)
            ],
            "force": [{"dof": f"u{last}", "amplitude": 1.5}, {"dof": f"v{last}", "amplitude": 0.6}],
            "response": {"frequency": [8.0, 20.0], "harmonics": 1},
        }
    )


def test_of_many_contacts_few_combinations_answer():
    """Against the structure itself, solved as matrices, with springs that part of the contacts are."""
    scene = strip(120)
    (lighter,) = negligible_parts.without_negligible_parts((scene,), REDUCTION.tolerance).curves
    assert lighter.modal.frequency.size < 0.4 * scene.modal.frequency.size
    assert negligible_parts.without_negligible_parts((scene,), 1e-6).curves[0].modal.frequency.size > (
        lighter.modal.frequency.size
    )

    def response(modal, omega, springs):
        """Amplitudes (dof,) by the dynamic stiffness of the modes with the springs (port,) in it."""
        ports = modal.shapes @ np.array(scene.directions_of_contacts()).T
        force = modal.shapes @ sum(f.direction * f.amplitude for f in scene.forces)
        own = modal.mass * (modal.frequency**2 - omega**2 + 0.02j * modal.frequency * omega)
        return np.linalg.solve(np.diag(own) + (ports * springs) @ ports.T, force) @ modal.shapes

    springs = np.array([(c.k_u, c.k_v) for c in scene.contacts]).ravel()
    front = np.clip(np.linspace(-1.0, 3.0, springs.size), 0.0, 1.0)
    for stuck in (0.0, 1.0, front):
        for omega in (8.0, 11.3, 20.0):
            one, other = (response(each.modal, omega, springs * stuck) for each in (lighter, scene))
            assert np.abs(one - other).max() < REDUCTION.tolerance * np.abs(other).max()


@pytest.mark.parametrize("share", [0.0, 0.3, 1.0])
def test_the_change_by_modes_left_out_is_the_difference_of_both_responses(share):
    scene = strip(20)
    fewer = replace(scene, modal=condensed(scene.modal, np.eye(40)[:, :3], scene.modal.frequency > 60.0))
    springs = share * np.array([(c.k_u, c.k_v) for c in scene.contacts]).ravel()
    omega = comparison_frequencies(fewer, springs)
    one, other = (linear_response(each, omega, springs) for each in (fewer, scene))
    expected = (np.abs(one - other).max(axis=1) / np.abs(other).max(axis=1)).max()
    assert expected > 1e-6
    assert change(scene, fewer, springs) == pytest.approx(expected, rel=0.1)


def oscillator(**more):
    """The paper's oscillator and a third degree of freedom that moves in the third mode only."""
    data = {
        "modal": {
            "dofs": ["u", "v", "w"],
            "frequency": [1.0, 10.0, 0.0],
            "damping": 0.01,
            "shapes": [[0.707, 0.707, 0.0], [1.0, -0.5, 0.0], [0.0, 0.0, 1.0]],
        },
        "contact": [
            {"name": "shroud", "tangential": "u", "normal": "v", "mu": 0.4, "k_u": 1, "k_v": 1, "n_0": 10},
            {"name": "idle", "tangential": "v", "normal": "w", "mu": 0.0, "k_u": 1, "k_v": 0, "n_0": 3},
            {"name": "far", "tangential": "u", "normal": "v", "mu": 0.4, "k_u": 0, "k_v": 0, "gap": 3},
        ],
        "force": [{"dof": "u", "amplitude": 1.0}, {"dof": "v", "amplitude": 1.0}],
        "response": {"frequency": [0.7, 1.7], "max_step": 0.2, "harmonics": 1},
    }
    return scene_from_dict(data | more)


def test_idle_modes_and_contacts_have_no_effect():
    response = trace(oscillator(), "closed-form")
    paper = trace(replace(fcm.load_scene("yang1998"), curves=()), "closed-form")
    assert response.contacts == ("shroud", "idle", "far")
    assert [text.partition(":")[0] for text in response.left_out] == [
        "contact idle", "contact far", "1 mode of 3",
    ]  # fmt: skip
    assert all("no effect" in text for text in response.left_out)
    assert response.curves[0].regime.shape[1] == 3
    assert response.curves[0].peaks["u"][0] == pytest.approx(6.236, abs=2e-3)
    assert response.curves[0].peaks["w"][0] == 0.0
    assert paper.left_out == []


def test_the_regimes_of_contacts_left_out_are_those_of_contacts_kept():
    scene = oscillator()
    light, full = trace(scene, "closed-form"), trace(scene, "closed-form", options=leaving_out(None))
    assert len(light.left_out) == 3 and [text.partition(",")[0] for text in full.left_out] == [
        "the mean of 1 rigid-body mode"
    ]
    one, other = light.curves[0], full.curves[0]
    assert one.peaks["u"][:2] == pytest.approx(other.peaks["u"][:2], rel=1e-7)
    assert one.regime.shape[1] == other.regime.shape[1] == 3
    for column in range(3):
        assert set(one.regime[:, column]) == set(other.regime[:, column])


def test_a_scene_whose_contacts_are_all_idle_is_linear():
    idle = {"tangential": "v", "normal": "w", "mu": 0.0, "k_u": 1.0, "k_v": 0.0, "n_0": 3.0}
    response = trace(oscillator(contact=[{"name": "one", **idle}, {"name": "two", **idle}]))
    (curve,) = response.curves
    assert response.complete and curve.regime.shape[1] == 2 and (curve.regime != "").all()
    assert len(response.left_out) == 4  # the contacts, a mode, the table
    assert curve.peaks["u"][0] == pytest.approx(50.0, rel=1e-2)  # free resonance


def test_no_table_is_opened_without_friction():
    contact = {"name": "c", "tangential": "u", "normal": "v", "mu": 0.0, "k_u": 1.0, "k_v": 1.0, "n_0": -1.0}
    response = trace(oscillator(contact=[contact]))
    assert response.complete and any(text.startswith("the table") for text in response.left_out)


def test_nothing_is_left_out_of_what_a_sweep_needs_anywhere():
    swept = {"contact.idle.mu": [0.0, 0.4]}
    response = trace(oscillator(sweep=swept), "closed-form")
    assert [text.partition(":")[0] for text in response.left_out] == [
        "contact far", "1 mode of 3", "the normal force of contact idle",
    ]  # fmt: skip


def with_loads(scene, loads):
    contacts = zip(scene.contacts, loads, strict=True)
    return replace(scene, contacts=tuple(replace(c, n_0=n) for c, n in contacts), curves=())


def same(light, full, rel=1e-9):
    for one, other in zip(light.curves, full.curves, strict=True):
        assert one.complete and other.complete
        assert one.folds == pytest.approx(other.folds, rel=rel)
        for dof, peak in other.peaks.items():
            assert one.peaks[dof][:2] == pytest.approx(
                peak[:2], rel=rel, nan_ok=True
            )  # none where nothing moves


def test_friction_is_computed_only_where_there_is_any():
    """Without friction a contact's other forces, and those of its neighbours, are the same."""
    scene = with_loads(structure(12, 3, 20, 10.0), (0.2, 0.1, 0.3))
    smooth, nearly = (
        replace(scene, contacts=(replace(scene.contacts[0], mu=mu), *scene.contacts[1:]))
        for mu in (0.0, 1e-9)
    )
    one, other = (trace(each, "closed-form", options=leaving_out(0.0)) for each in (smooth, nearly))
    assert [text for text in one.left_out if "friction" in text] == [
        "the friction of contact c0: mu or k_u is 0 (no effect)"
    ]
    same(one, other, rel=1e-7)


def test_normal_forces_are_computed_only_where_something_moves_along_them():
    """A contact whose normal degree of freedom no mode moves has a constant load, like one with k_v = 0."""
    scene = with_loads(structure(12, 3, 20, 10.0), (0.2, 0.1, 0.3))
    shapes = scene.modal.shapes.copy()
    shapes[:, scene.contacts[1].normal != 0.0] = 0.0
    scene = replace(scene, modal=replace(scene.modal, shapes=shapes))
    light, full = (trace(scene, "closed-form", options=leaving_out(tolerance)) for tolerance in (0.0, None))
    assert "the normal force of contact c1" in [text.partition(":")[0] for text in light.left_out]
    same(light, full)
    soft = (scene.contacts[0], replace(scene.contacts[1], k_v=0.0), scene.contacts[2])
    same(light, trace(replace(scene, contacts=soft), "closed-form", options=leaving_out(None)))


@pytest.mark.slow
def test_contacts_that_stay_stuck_or_open_are_springs_or_nothing():
    """Six of eight contacts keep to one state, as linear springs or not at all."""
    loads = (0.2, 50.0, 50.0, -40.0, 0.1, 50.0, -40.0, 60.0)
    scene = with_loads(structure(20, 8, 20, 30.0), loads)
    response = trace(scene, "closed-form")
    (curve,) = response.curves
    assert curve.complete and not any(text.startswith("contact") for text in response.left_out)
    for column, load in enumerate(loads):
        if abs(load) > 1.0:
            assert set(curve.regime[:, column]) == {"E" if load > 0.0 else "S"}
    same(response, trace(scene, "closed-form", options=leaving_out(None)))
