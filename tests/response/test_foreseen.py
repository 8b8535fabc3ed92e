"""Contacts that stay stuck or open have no unknowns: the answer is that of all, or is solved again."""

from dataclasses import replace

import numpy as np
import pytest

import fcm
from fcm.response import foreseen, trace
from fcm.scene.model import Contact

from .test_leave_out import structure

STEP = 0.2


def both(scene, **options):
    """Solved with what is left out, and with everything."""
    return trace(scene, "closed-form", **options), trace(scene, "closed-form", tolerance=None)


def same(light, full, rel=1e-9):
    for one, other in zip(light.curves, full.curves, strict=True):
        assert one.complete and other.complete
        assert one.folds == pytest.approx(other.folds, rel=rel)
        for dof, peak in other.peaks.items():
            assert one.peaks[dof] == pytest.approx(peak, rel=rel)
        for column in range(len(full.contacts)):
            if (
                len(set(other.regime[:, column])) == 1
            ):  # the others may pass through a regime between two points
                assert set(one.regime[:, column]) == set(other.regime[:, column])


def about_contacts(response):
    return [text for text in response.left_out if text.startswith("contact")]


def with_loads(scene, loads):
    contacts = zip(scene.contacts, loads, strict=True)
    return replace(scene, contacts=tuple(replace(c, n_0=n) for c, n in contacts), curves=())


def test_most_contacts_stuck_or_open():
    """Six of eight contacts without unknowns: the same curve, its means and its stability."""
    scene = with_loads(structure(20, 8, 20, 30.0), (0.2, 50.0, 50.0, -40.0, 0.1, 50.0, -40.0, 60.0))
    light, full = both(scene)
    assert [text.partition(":")[0] for text in about_contacts(light)] == [
        "contacts c1, c2, c5, c7", "contacts c3, c6",
    ]  # fmt: skip
    assert all("no effect" in text for text in about_contacts(light)) and full.left_out == []
    same(light, full)
    one, other = light.curves[0], full.curves[0]
    assert {"E"} == set(one.regime[:, 1]) and {"S"} == set(one.regime[:, 3]) and one.loop.shape[1] == 8
    for at in (one.frequency.argmin(), one.frequency.argmax()):
        there = other.frequency == one.frequency[at]
        assert one.mean[at] == pytest.approx(other.mean[there][0], abs=1e-10 * np.abs(other.mean).max())
        assert one.truncation_error[at] == pytest.approx(other.truncation_error[there][0], rel=1e-6)
        assert one.stable[at] == other.stable[there][0]
    assert np.abs(other.mean).max() > 0.0


def test_a_single_stuck_contact_is_a_linear_structure(monkeypatch):
    monkeypatch.setattr("fcm.table.open_table", lambda *_: pytest.fail("opened"))
    scene = with_loads(replace(fcm.load_scene("yang1998"), max_step=STEP), (1000.0,))
    response = trace(scene)
    assert [text.partition(":")[0] for text in response.left_out] == ["contact shroud", "the table"]
    (curve,) = response.curves
    assert curve.peaks["u"][0] == pytest.approx(35.1325, abs=1e-4)  # the paper's at n_0 = 100, stuck
    assert set(curve.regime.ravel()) == {"E"} and curve.loop.shape == (curve.points, 1, 5)


def test_a_contact_that_slips_on_one_curve_of_a_sweep_is_kept_on_all():
    scene = fcm.load_scene("yang1998")
    stuck, slips = (replace(scene.curves[i], max_step=STEP) for i in (0, 1))
    response = trace(replace(scene, curves=(stuck, slips)), "closed-form")
    assert response.left_out == []
    scenes = tuple(with_loads(stuck, (n,)) for n in (150.0, 200.0))
    response = trace(replace(scene, curves=scenes), "closed-form")
    assert len(about_contacts(response)) == 1


def test_what_was_foreseen_wrongly_is_solved_again(monkeypatch):
    """As if every preloaded contact stayed stuck: the curves on which it does not are found out."""
    scene = replace(fcm.load_scene("yang1998"), max_step=STEP)
    curves = tuple(with_loads(scene, (n,)) for n in (150.0, 100.0, 10.0))  # 100: stuck, with a mean friction
    scene = replace(scene, curves=curves)
    full = trace(scene, "closed-form", tolerance=None)
    monkeypatch.setattr("fcm.response.foreseen.FORESEEN", -1.0)
    light = trace(scene, "closed-form")
    (text,) = about_contacts(light)
    assert "2 of 3 curves, where this is not so, solved again" in text
    same(light, full)
    (text,) = about_contacts(trace(replace(scene, curves=curves[1:]), "closed-form"))
    assert "foreseen to stay stuck, but not so" in text


def test_a_solution_at_an_end_of_the_range_on_which_it_slips_keeps_a_contact(monkeypatch):
    """A branch of large amplitude may begin there, whatever the linear responses say."""
    scene = with_loads(replace(fcm.load_scene("yang1998"), max_step=STEP), (150.0,))
    assert foreseen.foreseen((scene,)) == {0: foreseen.STUCK}
    small, large = (np.full((1, 1, 5), size) for size in (0.1, 1e3))
    monkeypatch.setattr("fcm.response.foreseen._starts", lambda _: iter((small, large)))
    assert foreseen.foreseen((scene,)) == {}


@pytest.mark.parametrize("state", [foreseen.STUCK, foreseen.OPEN])
def test_the_room_is_nothing_where_the_loop_begins_to_change(state):
    """Against the closed form: F_b = F_c = 0, F_s = 1 just as long as there is room; while open all are 0."""
    random = np.random.default_rng(0)
    u, v = random.normal(size=(2, 200)) + 1j * random.normal(size=(2, 200))
    sign = 1.0 if state == foreseen.STUCK else -1.0
    contact = Contact("", np.ones(1), np.ones(1), mu=0.3, k_u=2.0, k_v=1.5, n_0=sign)
    room = foreseen.room(contact, state, u, v, np.zeros(200))
    for factor, inside in ((1.0 - 1e-6, True), (1.0 + 1e-3, False)):
        # amplitudes scaled so that they use up all the room there is, but for the factor
        a, b = (np.abs(x) * (1.0 + room) * factor for x in (u, v))
        F = fcm.fourier_coefficients(
            0.3 * sign / (2.0 * a), 0.3 * 1.5 * b / (2.0 * a), np.angle(v) - np.angle(u)
        )
        linear = (0.0, 1.0, 0.0) if state == foreseen.STUCK else (0.0, 0.0, 0.0)
        linear = np.abs(np.transpose(F) - linear).max(axis=1) < 1e-9
        assert np.all(linear == inside)


def test_friction_is_computed_only_where_there_is_any():
    """Without friction a contact's other forces, and those of its neighbours, are the same."""
    scene = with_loads(structure(12, 3, 20, 10.0), (0.2, 0.1, 0.3))
    smooth, nearly = (
        replace(scene, contacts=(replace(scene.contacts[0], mu=mu), *scene.contacts[1:]))
        for mu in (0.0, 1e-9)
    )
    one, other = (trace(each, "closed-form", tolerance=0.0) for each in (smooth, nearly))
    assert [text for text in one.left_out if "friction" in text] == [
        "the friction of contact c0: mu or k_u is 0 (no effect)"
    ]
    for dof, peak in other.curves[0].peaks.items():
        assert one.curves[0].peaks[dof] == pytest.approx(peak, rel=1e-7)


def test_normal_forces_are_computed_only_where_something_moves_along_them():
    """A contact whose normal degree of freedom no mode moves has a constant load, like one with k_v = 0."""
    scene = with_loads(structure(12, 3, 20, 10.0), (0.2, 0.1, 0.3))
    shapes = scene.modal.shapes.copy()
    shapes[:, scene.contacts[1].normal != 0.0] = 0.0
    scene = replace(scene, modal=replace(scene.modal, shapes=shapes))
    light, full = (trace(scene, "closed-form", tolerance=tolerance) for tolerance in (0.0, None))
    assert "the normal force of contact c1" in [text.partition(":")[0] for text in light.left_out]
    same(light, full)
    soft = (scene.contacts[0], replace(scene.contacts[1], k_v=0.0), scene.contacts[2])
    same(light, trace(replace(scene, contacts=soft), "closed-form", tolerance=None))
