"""Schedules: what is kept of them, how phases continue, figure 15, energy in every limit."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import fcm
from fcm.scene import Phase, Start
from fcm.shooting import periodic
from fcm.time_domain import State, energy, histories, simulate_phases
from fcm.time_domain.equations_of_motion import LETTERS
from fcm.time_domain.options import TIME, SimulationOptions
from fcm.time_domain.schedule_plan import Plan
from fcm.time_domain.schedule_record import INTERRUPTED, NOT_BEGUN, record, unsettled

from ..interrupted import interrupted_after
from .cases import one_mode, two_contacts, yang

PHASES = (Phase(1.3, 4.0), Phase(1.1, 2.5), Phase(1.9, 3.0))


def scheduled(scene, *phases, **start):
    made = Start(
        np.zeros(scene.modal.mass.size), np.zeros(scene.modal.mass.size), np.zeros(len(scene.contacts)), 0.0
    )
    return replace(scene, schedule=phases or PHASES, start=replace(made, **start) if start else None)


@pytest.mark.parametrize("scene", [yang(), two_contacts()], ids=lambda s: s.title)
def test_what_is_kept_is_the_motion(scene):
    """Sampled, measured and counted cycle by cycle, beside the whole motion at once."""
    scene = scheduled(scene)
    plan = Plan(scene.schedule, len(scene.modal.dofs))
    kept, motion = record(scene, plan), simulate_phases(scene, scene.schedule)
    assert plan.time[-1] == pytest.approx(motion.duration, rel=1e-14)
    assert kept.displacement == pytest.approx(motion.displacement(plan.time), abs=1e-12)
    measures = motion.measures()
    for name in ("amplitude", "mean", "greatest", "least"):
        assert np.array_equal(getattr(kept, name), [getattr(one, name) for one in measures])
    found = motion.transitions()
    assert kept.transition_time == pytest.approx([one.time for one in found], abs=1e-12)
    assert kept.transition_contact.tolist() == [one.contact for one in found]
    assert [LETTERS[code] for code in kept.transition_state] == [one.after for one in found]
    assert sum(phase.transitions for phase in kept.phases) == len(found) > 10
    whole = energy(motion)
    assert kept.energy == pytest.approx(whole, rel=1e-12)
    assert max(kept.energy.error, *(phase.energy.error for phase in kept.phases)) < 1e-13
    assert kept.complete and kept.cycles == 9.5


def test_the_sampled_states_are_those_between_transitions():
    scene = scheduled(yang())
    plan, kept = Plan(scene.schedule, 2), record(scene)
    state = kept.state[0, 0]
    changes = dict(zip(kept.transition_time, kept.transition_state, strict=True))
    for time, sampled in zip(plan.time, kept.state[:, 0], strict=True):
        state = next((code for at, code in reversed(changes.items()) if at <= time), state)
        if not np.isclose(list(changes), time, atol=1e-9).any():
            assert sampled == state


def test_the_force_continues_in_phase_when_the_frequency_changes():
    """No contact closes: the linear structure under sin(theta), theta' = omega, by solve_ivp."""
    scene = scheduled(one_mode(n_0=-1e9))
    time, kept = Plan(scene.schedule, 2).time, record(scene)
    y, begin, angle = np.zeros(2), 0.0, 0.3
    for phase in scene.schedule:
        end = begin + phase.cycles * 2.0 * np.pi / phase.frequency

        def rhs(t, y, omega=phase.frequency, begin=begin, angle=angle):
            return y[1], np.sin(angle + omega * (t - begin)) - 0.04 * y[1] - y[0]

        found = solve_ivp(rhs, (begin, end), y, "DOP853", rtol=1e-12, atol=1e-13, dense_output=True)
        inside = (time >= begin) & (time <= end)
        assert kept.displacement[inside, 0] == pytest.approx(found.sol(time[inside])[0], abs=1e-9)
        y, begin, angle = found.y[:, -1], end, angle + 2.0 * np.pi * phase.cycles


def test_a_schedule_goes_on_from_where_another_has_ended():
    whole = record(scheduled(yang()))
    first = record(scheduled(yang(), *PHASES[:2])).end
    start = {"displacement": first.q, "velocity": first.velocity, "friction": first.friction}
    second = record(scheduled(yang(), PHASES[2], **start, angle=first.angle))
    assert first.angle == pytest.approx(np.pi)
    assert second.end.q == pytest.approx(whole.end.q, abs=1e-13)
    assert second.amplitude[-1] == pytest.approx(whole.amplitude[-1], abs=1e-13)


def test_figure_15():
    """Upper branch at 1.195; lost at 1.190; not found again at 1.195, where the motion from rest is."""
    scene = fcm.load_scene("yang1998-jump")
    assert [(phase.frequency, phase.cycles) for phase in scene.schedule] == [
        (1.195, 100),
        (1.19, 120),
        (1.195, 30),
    ]
    first, second, third = record(scene).phases
    lower = periodic(scene, 1.195)
    upper = periodic(scene, 1.195, simulate_phases(scene, scene.schedule[:1], State.start(scene)).end)
    assert lower.states == ("E",) and upper.stable and upper.states == ("SPEN",)
    assert first.settled and first.amplitude == pytest.approx(upper.measure.amplitude, rel=1e-4)
    assert second.amplitude[0] < 2.0 and not second.settled
    assert third.amplitude == pytest.approx(lower.measure.amplitude, rel=5e-3)


def test_the_lower_state_at_n_0_5_ends_between_1235_and_1240():
    phases = [Phase(1.2, 60), Phase(1.22, 60), Phase(1.235, 100), Phase(1.24, 160)]
    *_, lower, upper = record(scheduled(yang(), *phases)).phases
    assert lower.amplitude[0] < 3.0 and upper.amplitude[0] > 10.0


def test_plans_of_any_length_are_bounded():
    for cycles, columns in [(10, 2), (30_000, 2), (100_000, 2), (1_000_000, 2), (1000, 300), (7, 10**6)]:
        plan = Plan([Phase(1.0, cycles)], columns)
        assert (
            plan.instants * columns <= TIME.history.max_displacements + 2 * TIME.history.min_samples * columns
        )
        assert plan.time.size == plan.cycles.size == plan.instants
        assert (np.diff(plan.time) > 0.0).all() and plan.cycles[-1] == cycles
    assert Plan([Phase(1.0, 10)], 2).samples == 64
    assert Plan([Phase(1.0, 100_000)], 2).sentence == "16 samples a cycle"
    assert Plan([Phase(1.0, 1_000_000)], 2).sentence == "8 samples of every 4th cycle"


def test_a_decimated_history_is_part_of_the_whole():
    scene = scheduled(yang(), Phase(1.3, 5.0))
    thin = Plan(scene.schedule, TIME.history.max_displacements // 16)
    assert (thin.samples, thin.every) == (8, 3)
    whole, part = record(scene), record(scene, thin)
    assert part.displacement == pytest.approx(whole.displacement[[*range(0, 64, 8), *range(192, 321, 8)]])
    assert np.array_equal(part.amplitude, whole.amplitude)


@pytest.mark.parametrize("rate", [0.5, 0.9, 0.99])
def test_what_is_left_of_a_decay_is_found(rate):
    decay = 3.0 + np.outer(rate ** np.arange(40.0), [0.5, -1.0])
    assert unsettled(decay) == pytest.approx(np.abs(3.0 / decay[-1] - 1.0).max(), rel=1e-3, abs=1e-9)


def test_what_does_not_decay_has_not_settled():
    n = np.arange(60.0)[:, None]
    for growing in (n, 1.02**n, 2.0 + 0.1 * (-1.0) ** n):
        assert unsettled(growing) == np.inf
    assert unsettled(np.zeros((60, 2))) == 0.0 == unsettled(np.ones((60, 2)))
    assert np.isnan(unsettled(np.ones((20, 2))))


def test_an_interrupted_schedule_keeps_what_is_finished():
    scene = scheduled(yang())
    whole, part = record(scene), record(scene, progress=interrupted_after(4))
    assert part.reason == INTERRUPTED and not part.complete and part.cycles == 5.0
    assert np.array_equal(part.amplitude[:5], whole.amplitude[:5]) and np.isnan(part.amplitude[5:]).all()
    reached = 5 * 64
    assert np.array_equal(part.displacement[:reached], whole.displacement[:reached])
    assert np.isnan(part.displacement[reached:]).all() and (part.state[reached:] == -1).all()
    assert part.phases[0].amplitude == pytest.approx(whole.phases[0].amplitude)
    assert [phase.cycles for phase in part.phases] == [4.0, 1.0]


def test_an_interrupted_sweep_keeps_the_finished_curves():
    scene = scheduled(yang())
    curves = tuple(replace(scene, parameters={"k": float(i)}) for i in range(3))
    found = histories(replace(scene, curves=curves), interrupted_after(14))
    assert [one.reason for one in found.records] == ["", INTERRUPTED, NOT_BEGUN]
    assert [one.cycles for one in found.records] == [9.5, 5.0, 0.0] and not found.complete


def test_interrupted_before_anything_is_finished(monkeypatch):
    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr("fcm.time_domain.schedule_record.cycles_from", interrupted)
    with pytest.raises(KeyboardInterrupt):
        histories(scheduled(yang()))


def test_contacts_that_chatter_without_end_leave_it_incomplete():
    few = replace(TIME, simulation=SimulationOptions(max_transitions=20))
    kept = record(scheduled(yang(k_u=1e6), Phase(1.3, 3.0)), options=few)
    assert "the contacts chatter" in kept.reason and kept.cycles == 1.0


LIMITS = {
    "chattering": {"k_u": 1e6},
    "zero force": {"force": 0.0},
    "no friction": {"mu": 0.0},
    "constant load": {"k_v": 0.0},
    "no tangential stiffness": {"k_u": 0.0},
    "nothing": {"mu": 0.0, "k_u": 0.0, "k_v": 0.0, "n_0": 0.0},
    "just touching": {"n_0": 0.0},
    "undamped": {"damping": 0.0, "frequency": 1.1},
    "undamped and free": {"damping": 0.0, "frequency": 1.1, "n_0": -1e9},
    "rigid": {"frequency": 0.0},
} | {
    f"{which} {stiffness:g}, n_0 = {n_0:g}": dict.fromkeys(which.split(), stiffness) | {"n_0": n_0}
    for which in ("k_u", "k_v", "k_u k_v")
    for stiffness in (1e-6, 1e4, 1e8)
    for n_0 in (1.0, 0.0, -0.3)
}


@pytest.mark.parametrize("changes", LIMITS.values(), ids=LIMITS)
def test_energy_balances_in_every_limit(changes):
    """From motion that was going on, also where nothing pushes."""
    start = {"displacement": np.array([0.5]), "velocity": np.array([0.4])}
    kept = record(scheduled(one_mode(**changes), Phase(1.1, 1.5), Phase(0.7, 0.5), **start))
    assert kept.complete, kept.reason
    assert kept.energy.turnover > 0.0 and kept.energy.error < 1e-10


@pytest.mark.parametrize(("angle", "state"), [(np.pi / 2, "E"), (-np.pi / 2, "N")])
def test_released_exactly_at_rest(angle, state):
    """Held at the slip limit without velocity, and pushed back or on."""
    scene = one_mode(k_v=0.0, force=3.0)
    scene = replace(scene, forces=(replace(scene.forces[0], phase=0.0),))
    kept = record(scheduled(scene, Phase(1.0, 0.1), friction=np.array([-0.6]), angle=angle))
    assert LETTERS[kept.state[0, 0]] == state and kept.energy.error < 1e-12
