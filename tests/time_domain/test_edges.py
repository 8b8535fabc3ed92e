"""Cases on the boundaries: right answers, or one clear error."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fcm.shooting import periodic
from fcm.time_domain import SimulationError, State, energy, simulate, simulate_schedule
from fcm.time_domain.options import SimulationOptions, TimeOptions

from .cases import one_mode, two_contacts, yang


def amplitude(motion):
    return motion.measures(last=1)[0].amplitude


@pytest.mark.parametrize("changes", [{"mu": 0.0}, {"k_u": 0.0}])
def test_without_friction_the_contact_only_presses(changes):
    """mu = 0 and k_u = 0 are the same scene."""
    motion = simulate(one_mode(**changes), 1.1, 20)
    assert set("".join(motion.cycles[-1].states)) <= {"E", "S"}
    assert energy(motion).slip == 0.0
    other = simulate(one_mode(mu=0.0, k_u=0.0), 1.1, 20)
    assert np.array_equal(amplitude(motion), amplitude(other))


def test_constant_normal_load():
    """k_v = 0: the loop of figure 3, never separated."""
    orbit = periodic(one_mode(k_v=0.0), 1.1)
    assert orbit.states == ("EPEN",)
    assert energy(orbit.motion).error < 1e-13


@pytest.mark.parametrize("n_0", [0.0, -1.0])
def test_no_load_and_no_normal_stiffness_is_no_contact(n_0):
    motion = simulate(one_mode(k_v=0.0, n_0=n_0), 1.1, 5)
    assert motion.cycles[-1].states == ("S",)


@pytest.mark.parametrize("n_0", [2.0, 0.0, -1.0])
def test_without_force_nothing_moves(n_0):
    motion = simulate(one_mode(force=0.0, n_0=n_0), 1.1, 3)
    assert not motion.displacement(np.linspace(0.0, motion.duration, 20)).any()
    assert motion.transitions() == []
    assert energy(motion).error == 0.0


def test_without_force_an_orbit_is_rest():
    orbit = periodic(one_mode(force=0.0), 1.1)
    assert orbit.measure.amplitude.max() == 0.0


def test_undamped_at_its_natural_frequency_grows_linearly():
    """x = (sin t - t cos t) / 2 for x'' + x = sin t."""
    scene = one_mode(damping=0.0, n_0=-1e9)
    scene = replace(scene, forces=(replace(scene.forces[0], phase=0.0),))
    motion = simulate(scene, 1.0, 20)
    t = np.linspace(0.0, motion.duration, 101)
    assert motion.displacement(t)[:, 0] == pytest.approx(0.5 * (np.sin(t) - t * np.cos(t)), abs=1e-11)
    with pytest.raises(SimulationError, match="not become periodic"):
        periodic(scene, 1.0)


def test_a_rigid_body():
    """A free mass under sin t: x = t - sin t, exactly resonant with nothing."""
    scene = one_mode(frequency=0.0, damping=0.0, n_0=-1e9)
    scene = replace(scene, forces=(replace(scene.forces[0], phase=0.0),))
    motion = simulate(scene, 1.0, 10)
    t = np.linspace(0.0, motion.duration, 51)
    assert motion.displacement(t)[:, 0] == pytest.approx(t - np.sin(t), abs=1e-12)


def test_released_exactly_at_rest():
    """Held at the slip limit with no velocity, and pushed back by the force: it sticks, or it slips."""
    scene = one_mode(k_v=0.0)
    for sign, expected in ((1.0, "E"), (-1.0, "N")):
        held = replace(scene, forces=(replace(scene.forces[0], phase=np.pi / 2 * sign, amplitude=3.0),))
        motion = simulate(held, 1.0, 0.1, State(np.zeros(1), np.zeros(1), np.array([-0.6])))
        assert motion.cycles[0].letters[0] == expected


def test_contact_just_touched():
    """A gap of exactly the greatest displacement is grazed, not closed; a shorter one is closed."""
    free = one_mode(n_0=-1e9)
    orbit = periodic(free, 1.1)
    least = float(orbit.measure.greatest[1])
    grazed = one_mode(n_0=-least)
    assert simulate(grazed, 1.1, 5, orbit.state).transitions() == []
    closed = simulate(one_mode(n_0=-least * (1.0 - 1e-9)), 1.1, 1, orbit.state)
    assert [x.after for x in closed.transitions()][-1] == "S"
    assert len(closed.transitions()) >= 2


def test_tangential_and_normal_motion_in_proportion_open_at_once():
    """phi = 0 and b > 1: the contact sticks from closing to opening, as in figure 10."""
    orbit = periodic(one_mode(shape=(0.5, 1.0), mu=0.8, n_0=0.0, k_u=0.5), 1.1)
    assert orbit.states == ("SE",)
    assert abs(energy(orbit.motion).slip) < 1e-14


def test_two_equal_contacts_change_together():
    """Two contacts of half the stiffness and preload move as one."""
    scene = one_mode()
    c = scene.contacts[0]
    half = replace(c, k_u=0.5 * c.k_u, k_v=0.5 * c.k_v, n_0=0.5 * c.n_0)
    pair = replace(scene, contacts=(half, replace(half, name="d")))
    one, two = simulate(scene, 1.1, 10), simulate(pair, 1.1, 10)
    t = np.linspace(0.0, one.duration, 101)
    assert two.displacement(t) == pytest.approx(one.displacement(t), abs=1e-12)


def test_a_contact_that_chatters():
    """Ringing on its own stiffness while it sticks: many transitions, energy still balanced."""
    motion = simulate(yang(k_u=1e6), 1.3, 2)
    assert len(motion.transitions()) > 50
    assert energy(motion).error < 1e-12


def test_chattering_without_end_is_refused():
    few = TimeOptions(simulation=SimulationOptions(max_transitions=20))
    with pytest.raises(SimulationError, match="chatter"):
        simulate(yang(k_u=1e6), 1.3, 2, options=few)


@pytest.mark.parametrize("frequency", [0.0, -1.0, np.nan, np.inf])
def test_frequencies_that_are_none(frequency):
    with pytest.raises(SimulationError, match="frequency"):
        simulate(yang(), frequency, 1)


@pytest.mark.parametrize("cycles", [0.0, -1.0, np.nan, np.inf])
def test_numbers_of_cycles_that_are_none(cycles):
    with pytest.raises(SimulationError, match="cycles"):
        simulate(yang(), 1.3, cycles)


def test_states_of_another_scene():
    with pytest.raises(SimulationError, match=r"2 modes and 1 contact$"):
        simulate(yang(), 1.3, 1, State.rest(two_contacts()))
    with pytest.raises(SimulationError, match="finite"):
        simulate(yang(), 1.3, 1, State(np.zeros(2), np.full(2, np.nan), np.zeros(1)))


def test_a_frequency_out_of_all_proportion():
    with pytest.raises(SimulationError, match="fastest motion"):
        simulate(yang(), 1e-9, 1)


def test_a_scene_without_contacts():
    scene = replace(yang(), contacts=())
    orbit = periodic(scene, 1.3)
    q = 0.707 * 1.414 / (1.0 - 1.3**2 + 0.026j) + 0.5 / (100.0 - 1.3**2 + 0.26j)
    assert orbit.measure.amplitude[0] == pytest.approx(abs(q), rel=1e-10)


def test_a_scene_without_a_schedule():
    with pytest.raises(SimulationError, match="schedule"):
        simulate_schedule(yang())


def test_a_scene_whose_exact_motion_is_not_computed_is_refused():
    """Its second direction of sliding would be left out."""
    scene = one_mode()
    (contact,) = scene.contacts
    plane = replace(scene, contacts=(replace(contact, second=np.zeros_like(contact.tangential)),))
    with pytest.raises(SimulationError, match="but not of contacts in a plane"):
        simulate(plane, 1.1, 5)
