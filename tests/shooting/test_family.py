"""Motions that are not unique: residual friction of contacts that never slip."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import fcm
from fcm.response.exact import trace_exact
from fcm.response.resumable_branches import TimeOver
from fcm.run import Execution
from fcm.shooting import periodic
from fcm.shooting.initial_orbits import near_balance
from fcm.shooting.periodic_orbit import converged
from fcm.shooting.residual import Shot
from fcm.shooting.residual_traction import resting_at
from fcm.shooting.traction_families import family, member_at_start, members
from fcm.time_domain import SimulationError, State, simulate
from fcm.time_domain.cycle_measures import measure
from fcm.time_domain.equations_of_motion import EquationsOfMotion

from ..time_domain.cases import yang

OMEGA = 1.5
# amplitude of v for residual friction, by another's simulation of 400 cycles from rest with that friction
AMPLITUDES = {-4.0: 1.36, 0.0: 2.14, 4.0: 2.90}


@pytest.fixture(scope="module")
def scene():
    return fcm.load_scene(Path(__file__).parent / "scenes/not_unique.toml")


def at_rest(friction):
    return State(np.zeros(2), np.zeros(2), np.array([0.0, friction]))


def settled(scene, friction, omega=OMEGA):
    return simulate(scene, omega, 400, at_rest(friction))


@pytest.fixture(scope="module")
def found(scene):
    return family(scene, OMEGA, periodic(scene, OMEGA, settled(scene, 0.0).end).state)


def test_the_extent_holds_what_simulations_come_to(scene, found):
    assert found.contacts == (1,) and found.complete
    for friction, published in AMPLITUDES.items():
        amplitude = settled(scene, friction).measures(last=1)[0].amplitude
        assert amplitude[1] == pytest.approx(published, abs=0.005)
        assert (found.least < amplitude).all() and (amplitude < found.greatest).all()
    assert found.spread.min() > 0.5


@pytest.mark.parametrize("end", [0, 1])
def test_beyond_the_extent_the_contact_slips_back_to_it(scene, found, end):
    """Stressed by a little more than the limit, then left to itself, it comes to the end of the family."""
    amplitude = (found.least, found.greatest)[end]
    system, end_state = EquationsOfMotion(scene, OMEGA), settled(scene, 0.0).end
    x = np.concatenate((end_state.q, end_state.velocity, end_state.friction))
    begun, _ = converged(Shot(system, x, resting_at(system, x)))
    shot = member_at_start(begun, np.array([0.0, -1.1 * found.friction[0, end] / scene.contacts[1].k_u]))
    assert shot.chosen[0].limited and measure(shot.cycle).amplitude == pytest.approx(amplitude, rel=1e-6)
    stressed = replace(
        shot.state, friction=shot.state.friction + np.array([0.0, 1e-3 * found.friction[0, end]])
    )
    motion = simulate(scene, OMEGA, 400, stressed)
    assert 1 in {change.contact for change in motion.transitions()}
    assert motion.measures(last=1)[0].amplitude == pytest.approx(amplitude, rel=1e-3)


def test_it_does_not_depend_on_the_member_it_is_sought_from(scene, found):
    for friction in (-4.0, 4.0):
        one = replace(scene, start=replace(scene.start, friction=np.array([0.0, friction])))
        other = family(one, OMEGA, settled(scene, friction).end)
        assert other.least == pytest.approx(found.least, rel=1e-6)
        assert other.greatest == pytest.approx(found.greatest, rel=1e-6)
        assert other.friction == pytest.approx(found.friction, rel=1e-6)


@pytest.mark.parametrize("friction", AMPLITUDES)
def test_the_start_of_the_scene_chooses(scene, friction):
    """The curve goes through the motion that a simulation from that start comes to."""
    one = replace(scene, start=replace(scene.start, friction=np.array([0.0, friction])))
    (curve,) = trace_exact(replace(one, frequency_range=(OMEGA - 1e-3, OMEGA), max_step=1.0)).curves
    long = simulate(scene, OMEGA, 3000, at_rest(friction)).measures(last=1)[0].amplitude
    assert curve.amplitude[-1] == pytest.approx(long, rel=1e-4)
    assert curve.amplitude[-1, 1] == pytest.approx(AMPLITUDES[friction], abs=0.01)


def test_a_curve_tells_the_extent_at_its_peak(scene):
    (curve,) = trace_exact(replace(scene, frequency_range=(1.4, OMEGA), max_step=0.2)).curves
    known = np.flatnonzero(np.isfinite(curve.orbits.family_least).all(axis=1))
    k = int(np.argmax(curve.amplitude[:, 1]))
    assert k in known
    assert curve.orbits.family_least[k, 1] < curve.amplitude[k, 1] < curve.orbits.family_greatest[k, 1]
    assert curve.summary()["not_unique"] == known.size
    low, high = curve.summary()["peak_range"]["v"]
    assert (low, high) == (curve.orbits.family_least[k, 1], curve.orbits.family_greatest[k, 1])


def test_where_there_is_no_time_for_the_extent_it_is_said_to_be_unknown(scene):
    """The search asks for the time; the curve is complete without it."""

    def over(_share, text):
        if "looking for other motions" in text:
            raise TimeOver

    near = replace(scene, frequency_range=(1.4, OMEGA), max_step=0.2)
    (curve,) = trace_exact(near, execution=Execution(progress=over)).curves
    k = int(np.argmax(curve.amplitude[:, 1]))
    assert curve.complete and curve.orbits.family_complete[k] == 0.0
    assert np.isnan(curve.orbits.family_greatest).all()


def test_where_nothing_feels_it_the_amplitude_is_unique():
    (curve,) = trace_exact(yang(100.0), [1.2, 1.3]).curves
    assert set(curve.regime.ravel()) == {"E"} and curve.summary()["not_unique"] == 0


def test_no_contact_that_always_sticks_is_no_family():
    assert family(yang(), 1.3, periodic(yang(), 1.3).state) is None


def test_a_state_of_no_periodic_motion_is_refused():
    with pytest.raises(SimulationError, match="no periodic motion"):
        family(replace(yang(-1e9), modal=replace(yang().modal, damping=np.zeros(2))), 1.0, State.rest(yang()))


def test_two_contacts_that_stick_together():
    """Each alone and both: the limits are those of the joint motion, and it is linear."""
    scene = fcm.load_scene(Path(__file__).parent / "scenes/both_stuck.toml")
    found = family(scene, 1.581, periodic(scene, 1.581).state)
    assert found.contacts == (0, 1) and found.complete
    assert found.spread.max() < 1e-8 and (found.friction[:, 0] < found.friction[:, 1]).all()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "omega", "stress", "reached"),
    [("stuck_by_turns", 0.8518, 30.0, 0.3241), ("all_stuck", 1.487, 30.0, 0.0348)],
)
def test_it_goes_on_where_another_contact_begins_to_slip(name, omega, stress, reached):
    """The greatest amplitude is what a march of the contact law in small steps comes to."""
    scene = fcm.load_scene(Path(__file__).parent / f"scenes/{name}.toml")
    (curve,) = trace_exact(scene, [omega]).curves
    least, greatest = curve.orbits.family_least[0], curve.orbits.family_greatest[0]
    assert curve.orbits.family_complete[0] == 1.0
    modes, contacts = scene.modal.frequency.size, len(scene.contacts)
    found = []
    for friction in np.random.default_rng(0).uniform(-1.0, 1.0, (12, contacts)) * [stress, 0.1, 0.2]:
        rest = State(np.zeros(modes), np.zeros(modes), friction)
        before, last = simulate(scene, omega, 600, rest).measures(last=2)
        assert last.amplitude == pytest.approx(before.amplitude, rel=1e-6)
        found.append(last.amplitude)
    assert (np.array(found) >= least * (1.0 - 1e-4)).all()
    assert (np.array(found) <= greatest * (1.0 + 1e-4)).all()
    assert max(one[0] for one in found) == pytest.approx(reached, abs=1e-4)
    assert greatest[0] == pytest.approx(reached, abs=1e-4)


def test_the_extent_holds_motions_between_its_limits_and_beyond_a_gap():
    """Amplitudes are greatest where no contact is at a limit, and where others slip than at first."""
    scene = fcm.load_scene(Path(__file__).parent / "scenes/in_parts.toml")
    (curve,) = trace_exact(scene, [1.01345]).curves
    least, greatest = curve.orbits.family_least[0], curve.orbits.family_greatest[0]
    found = []
    for friction in (-10.0, -8.0, -6.4, -5.0, -3.0, 0.0, 3.5, 4.0):
        rest = State(np.zeros(3), np.zeros(3), np.array([friction, 0.0, 0.0]))
        found.append(simulate(scene, 1.01345, 400, rest).measures(last=1)[0].amplitude)
    found = np.array(found)
    assert (found >= least * (1.0 - 1e-3)).all() and (found <= greatest * (1.0 + 1e-3)).all()
    assert found[:, 0].max() > 1.02 * found[0, 0] and found[:, 0].max() == pytest.approx(
        greatest[0], rel=0.01
    )


def test_of_a_stable_motion_the_extent_is_that_of_stable_ones():
    """Pushed a little, the member with the least amplitude stays, and one with less is left."""
    scene, omega = fcm.load_scene(Path(__file__).parent / "scenes/lost_stability.toml"), 1.2066666666666668
    start = next(one for one in near_balance(scene, omega) if one.stable).state
    system, x = EquationsOfMotion(scene, omega), np.concatenate((start.q, start.velocity, start.friction))
    shots, _ = members(converged(Shot(system, x, resting_at(system, x)))[0])
    found = family(scene, omega, start)
    amplitude = {id(shot): float(measure(shot.cycle).amplitude[2]) for shot in shots}
    least = min(shots, key=lambda shot: amplitude[id(shot)])
    end = min(shots, key=lambda shot: abs(amplitude[id(shot)] - found.least[2]))
    assert amplitude[id(least)] < 0.7 * found.least[2] == pytest.approx(0.7 * amplitude[id(end)], rel=1e-12)
    for shot, stays in ((least, False), (end, True)):
        pushed = replace(shot.state, velocity=shot.state.velocity * (1.0 + 1e-6))
        last = simulate(scene, omega, 400, pushed).measures(last=20)
        away = max(abs(one.amplitude[2] / amplitude[id(shot)] - 1.0) for one in last)
        assert away < 1e-3 if stays else away > 0.05


BEGUN = [  # one motion, begun with other roundings
    (
        (-0.47410816462340916, 0.8413213360780477, -0.029646197792734766),
        (0.13609457664039534, -0.6700556387376853, 0.03549498060371679),
        (-0.23409214111286983, -3.3101920919155616e-35, -0.03679012841908941),
    ),
    (
        (-0.4741081646234087, 0.8413213360780473, -0.029646197792734717),
        (0.13609457664039518, -0.6700556387376856, 0.03549498060371699),
        (-0.23409214111286966, 0.0, -0.03679012841908936),
    ),
]


@pytest.mark.parametrize("begun", BEGUN)
def test_an_extent_does_not_hang_on_the_rounding_of_the_motion_it_is_begun_at(begun):
    """The least of one amplitude lies between the end of a line and the next motion on it."""
    scene = fcm.load_scene(Path(__file__).parent / "scenes/in_parts.toml").each_curve()[0]
    found = family(scene, 1.01345, State(*map(np.array, begun)))
    rest = State(np.zeros(3), np.zeros(3), np.array([-3.0, 0.0, 0.0]))
    assert found.least[2] < simulate(scene, 1.01345, 400, rest).measures(last=1)[0].amplitude[2]
