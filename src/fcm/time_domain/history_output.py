"""Write histories as variables of a file, as CSV and as a summary."""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from fcm.files import replacing
from fcm.time_domain.energy import Energy
from fcm.time_domain.equations_of_motion import LETTERS
from fcm.time_domain.histories import Histories
from fcm.time_domain.options import TIME
from fcm.time_domain.schedule_record import NOT_REACHED, PhaseResult, ScheduleRecord
from fcm.time_domain.state import State
from fcm.units import CF_UNIT, in_unit

Variable = tuple[tuple[str, ...], npt.NDArray[Any], dict[str, Any]]  # dimensions, values, attributes
_NUMBERS = "0 separation, 1 stick, 2 positive and 3 negative slip; -1 not reached"
MEANINGS = "not_reached separation stick positive_slip negative_slip"  # of -1 and the indices of LETTERS


def variables(found: Histories) -> dict[str, Variable]:
    """All variables that histories add to a file."""
    return _common(found) | _of_records(found) | _of_phases(found)


def _common(found: Histories) -> dict[str, Variable]:
    """Variables common to all curves: the instants, the cycles, the phases."""
    plan, phases = found.plan, found.scene.schedule
    units = CF_UNIT[found.scene.frequency_unit]
    frequency = in_unit([phase.frequency for phase in phases], found.scene.frequency_unit)
    begins, ends = "time at which the cycle begins", "length of the cycle, 1 unless it ends a phase early"
    return {
        "time": _variable("instant", plan.time, "time from the start of the schedule", units="s"),
        "cycles": _variable("instant", plan.cycles, "periods of the force since the start", units="1"),
        "cycle_start": _variable("cycle", plan.start, begins, units="s"),
        "cycle_elapsed": _variable("cycle", plan.elapsed, "periods of the force before the cycle", units="1"),
        "cycle_part": _variable("cycle", plan.part, ends, units="1"),
        "cycle_phase": _variable("cycle", plan.phase.astype(np.int32), "index of the phase", units="1"),
        "schedule_frequency": _variable("schedule_phase", frequency, "excitation frequency", units=units),
        "schedule_cycles": _variable("schedule_phase", plan.length, "cycles of the phase", units="1"),
        "schedule_start": _variable("schedule_phase", plan.phase_start, "time of its start", units="s"),
    }


def _variable(dims: str, values: npt.NDArray[Any], text: str, **attributes: Any) -> Variable:
    return tuple(dims.split()), values, {"long_name": text, **attributes}


def _of_records(found: Histories) -> dict[str, Variable]:
    """Variables of each curve: displacements, states, cycle measures and transitions."""
    flags: dict[str, Any] = {
        "flag_values": np.arange(NOT_REACHED, len(LETTERS), dtype=np.int8),
        "flag_meanings": MEANINGS,
    }

    def each(dims: str, pick: Callable[[ScheduleRecord], Any], text: str, **attributes: Any) -> Variable:
        return _variable(f"curve {dims}", _stacked([pick(r) for r in found.records]), text, **attributes)

    change = "a change of state of a contact"
    exact = "in the cycle, exact"
    return {
        "displacement": each("instant dof", lambda r: r.displacement, f"displacement, {found.plan.sentence}"),
        "contact_state": each(
            "instant contact", lambda r: r.state, f"state of the contact: {_NUMBERS}", **flags
        ),
        "cycle_amplitude": each("cycle dof", lambda r: r.amplitude, f"half the peak-to-peak {exact}"),
        "cycle_mean": each("cycle dof", lambda r: r.mean, "mean displacement in the cycle"),
        "cycle_greatest": each("cycle dof", lambda r: r.greatest, f"greatest displacement {exact}"),
        "cycle_least": each("cycle dof", lambda r: r.least, f"least displacement {exact}"),
        "transition_time": each("transition", lambda r: r.transition_time, f"time of {change}", units="s"),
        "transition_contact": each("transition", lambda r: r.transition_contact, f"contact of {change}"),
        "transition_state": each(
            "transition", lambda r: r.transition_state, f"state after {change}", **flags
        ),
    }


def _of_phases(found: Histories) -> dict[str, Variable]:
    """Variables with one number for each curve and phase: settling, transitions, energy."""

    def each(pick: Callable[[PhaseResult], float], text: str) -> Variable:
        values = np.full((len(found.records), len(found.scene.schedule)), np.nan)
        for row, record in zip(values, found.records, strict=True):
            row[: len(record.phases)] = [pick(phase) for phase in record.phases]
        return _variable("curve schedule_phase", values, text)

    left = "relative change of the amplitudes that is still to come, estimated"
    return {
        "simulated_cycles": each(lambda p: p.cycles, "cycles that were simulated"),
        "settled": each(
            lambda p: p.settled, "1 where the motion has become periodic at the end of the phase"
        ),
        "unsettled": each(lambda p: p.unsettled, left),
        "transitions": each(lambda p: p.transitions, "changes of state of the contacts"),
        "energy_work": each(lambda p: p.energy.work, "work of the external forces"),
        "energy_slip": each(lambda p: p.energy.slip, "energy dissipated by friction"),
        "energy_damping": each(lambda p: p.energy.damping, "energy dissipated by the modes"),
        "energy_stored": each(lambda p: p.energy.stored, "change of the kinetic and elastic energy"),
        "energy_error": each(lambda p: p.energy.error, "error of the energy balance, relative"),
    }


def _stacked(parts: list[npt.NDArray[Any]]) -> npt.NDArray[Any]:
    """Arrays of one kind and different lengths, stacked and padded with NaN or -1."""
    longest = max(part.shape[0] for part in parts)
    empty = np.nan if parts[0].dtype.kind == "f" else NOT_REACHED
    out = np.full((len(parts), longest, *parts[0].shape[1:]), empty, dtype=parts[0].dtype)
    for row, part in zip(out, parts, strict=True):
        row[: part.shape[0]] = part
    return out


def summary(found: Histories) -> list[dict[str, Any]]:
    """The schedule part of the output of ``fcm respond --json``, one entry for each curve."""
    return [_of_record(found, record) for record in found.records]


def _of_record(found: Histories, record: ScheduleRecord) -> dict[str, Any]:
    return {
        "parameters": record.parameters,
        "complete": record.complete,
        **({} if record.complete else {"reason": record.reason}),
        "cycles": record.cycles,
        "phases": [_of_phase(found, phase) for phase in record.phases],
        "transitions": sum(phase.transitions for phase in record.phases),
        "transitions_with_times": int(record.transition_time.size),
        "energy": _of_energy(record.energy),
        "samples_per_cycle": found.plan.samples,
        "cycles_per_sampled_cycle": found.plan.every,
        "end": _of_state(record.end),
        "seconds": record.seconds,
    }


def _of_phase(found: Histories, phase: PhaseResult) -> dict[str, Any]:
    scene = found.scene
    dofs, names = scene.modal.dofs, [contact.name for contact in scene.contacts]
    return {
        "frequency": float(in_unit(phase.frequency, scene.frequency_unit)),
        "cycles": phase.cycles,
        "amplitude": dict(zip(dofs, phase.amplitude.tolist(), strict=True)),
        "mean": dict(zip(dofs, phase.mean.tolist(), strict=True)),
        "regime": dict(zip(names, map(_shortened, phase.states), strict=True)),
        "transitions": phase.transitions,
        "settled": phase.settled,
        "unsettled": phase.unsettled,
        "energy_error": phase.energy.error,
    }


def _of_energy(balance: Energy) -> dict[str, float]:
    names = ("work", "slip", "damping", "stored")
    return dict(zip(names, balance, strict=False)) | {"error": balance.error}


def _of_state(end: State) -> dict[str, Any]:
    """A state with the keys of a scene's [start]."""
    arrays = {"displacement": end.q, "velocity": end.velocity, "friction": end.friction}
    return {name: array.tolist() for name, array in arrays.items()} | {"angle": end.angle}


def _shortened(states: str) -> str:
    """A sequence of states, shortened to fit a line.

    >>> _shortened("SPEN"), _shortened("EP" * 100)
    ('SPEN', 'EPEPEPEPEPEPEPEPEPEPEPEPEPEPEPEPEPEPEPEP... (200)')
    """
    return (
        states
        if len(states) <= TIME.history.max_letters
        else f"{states[: TIME.history.max_letters]}... ({len(states)})"
    )


def write_csv(found: Histories, path: str | Path) -> None:
    """Writes the sampled displacements as CSV, one row for each instant."""
    scene = found.scene
    names = [contact.name for contact in scene.contacts]
    header = ["curve", *found.records[0].parameters, "phase", "cycles", "time [s]"]
    header += [f"displacement {dof}" for dof in scene.modal.dofs] + [f"state {name}" for name in names]
    with replacing(path) as temporary, temporary.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(header)
        for number, record in enumerate(found.records):
            writer.writerows([number, *record.parameters.values(), *row] for row in _rows(found, record))


def _rows(found: Histories, record: ScheduleRecord) -> Iterator[list[Any]]:
    plan = found.plan
    phase = np.append(np.repeat(plan.phase, plan.sampled), plan.phase[-1]) + 1
    for k in np.flatnonzero(np.isfinite(record.displacement[:, 0])):
        numbers = [plan.cycles[k], plan.time[k], *record.displacement[k]]
        letters = [LETTERS[code] for code in record.state[k]]
        yield [int(phase[k]), *(repr(float(x)) for x in numbers), *letters]
