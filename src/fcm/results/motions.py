"""Single motions of a response, at peaks and chosen frequencies: contact forces and modes by harmonics."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from fcm.contact.limits import FloatArray
from fcm.frozen import Frozen
from fcm.results.padded_arrays import Field
from fcm.units import CF_UNIT, in_unit

ComplexArray = npt.NDArray[np.complex128]
LINE, PLANE = ("friction", "normal"), ("friction_x", "friction_y", "normal")  # forces of a contact
ON = "force of a contact, which acts on the structure against its direction"
SINE = "amplitude * sin(harmonic omega t + phase)"


class ResponseMotion(Frozen):
    """A steady motion, x = mean + Im(sum_h X_h exp(i h omega t)); arrays begin with the mean, which is real.

    The forces of a contact are those of `fcm.periodic_forces` along its directions, friction before normal.
    On the structure they act against these directions. The normal force is the whole load, including the
    preload.
    """

    curve: int
    parameters: dict[str, float]  # swept values of the curve
    of: tuple[str, ...]  # degrees of freedom whose maximum is here; none at a chosen frequency
    frequency: float  # [rad/s]
    stable: float  # 1 where small disturbances die out, 0 where not, NaN if unknown
    harmonics: tuple[int, ...]
    force: ComplexArray  # (contact, direction, 1 + harmonic)
    modal: ComplexArray | None  # (mode, 1 + harmonic), of modes of mass 1; None for a ring's sector
    amplitude: float = np.nan  # modal amplitude of a nonlinear mode
    states: tuple[str, ...] = ()  # state sequence of each contact over a cycle
    contact_loads: FloatArray | None = None  # (contact, 4): greatest normal and friction force, slip, energy

    def at(self, harmonic: int) -> int:
        """Index of a harmonic in the arrays; -1 if the motion does not have it."""
        return (
            0 if harmonic == 0 else 1 + self.harmonics.index(harmonic) if harmonic in self.harmonics else -1
        )


class ResponseMotions(Frozen):
    """Motions of a response, and which of their variables the netCDF file gets."""

    motions: tuple[ResponseMotion, ...]
    forces: bool
    modes: bool


def harmonics_of(motions: Sequence[ResponseMotion]) -> list[int]:
    """All harmonics that occur in the motions, in order."""
    return sorted({h for one in motions for h in one.harmonics})


def motion_fields(found: ResponseMotions, unit: str) -> dict[str, Field]:
    """The variables of a file: the places of the motions, and their forces and modes if requested."""
    motions = found.motions
    if not motions or not (found.forces or found.modes):
        return {}
    numbers, by = harmonics_of(motions), ("motion", "motion_harmonic")
    text = np.array([" ".join(one.of) for one in motions], dtype=str)
    out = {
        "motion_curve": _field(by[:1], np.array([one.curve for one in motions]), "number of its curve"),
        "motion_of": _field(by[:1], text, "degrees of freedom whose peak the motion is"),
        "motion_frequency": _field(
            by[:1],
            in_unit(np.array([one.frequency for one in motions]), unit),
            "excitation frequency of the motion",
            CF_UNIT[unit],
        ),
        "motion_stable": _field(
            by[:1], np.array([one.stable for one in motions]), "1 where small disturbances die out", "1"
        ),
        "motion_harmonic": _field(by[1:], np.array(numbers), "number of the harmonic"),
    }
    if found.forces:
        kinds = LINE if motions[0].force.shape[1] == len(LINE) else PLANE
        values = np.stack([_by_number(one.force, one, numbers) for one in motions])
        dims = ("motion", "contact", "contact_force_direction")
        out["contact_force_direction"] = _field(dims[2:], np.array(kinds), "which force of a contact")
        out |= _waves("contact_force", (*dims, "motion_harmonic"), values, ON)
    if found.modes:
        values = np.stack([_by_number(_modal(one), one, numbers) for one in motions])
        what = "displacement of the mode, of modes of mass 1"
        out |= _waves("mode_displacement", ("motion", "mode", "motion_harmonic"), values, what)
    return out


def _modal(motion: ResponseMotion) -> ComplexArray:
    assert motion.modal is not None  # rings are refused before
    return motion.modal


def _field(dims: tuple[str, ...], values: npt.NDArray[np.generic], what: str, units: str = "") -> Field:
    return Field(dims, values, {"long_name": what} | ({"units": units} if units else {}))


def _waves(name: str, dims: tuple[str, ...], values: ComplexArray, what: str) -> dict[str, Field]:
    """The mean, and amplitude and phase of each harmonic."""
    mean: FloatArray = values[..., 0].real
    sine = f"as {name}_{SINE.replace('phase', f'{name}_phase')}"
    return {
        f"{name}_mean": _field(dims[:-1], mean, f"mean {what}"),
        f"{name}_amplitude": _field(dims, np.abs(values[..., 1:]), f"amplitude of a harmonic of the {what}"),
        f"{name}_phase": _field(dims, np.angle(values[..., 1:]), f"its phase, {sine}", "radian"),
    }


def _by_number(values: ComplexArray, motion: ResponseMotion, numbers: Sequence[int]) -> ComplexArray:
    """Values (..., 1 + harmonic) with a place for every number; NaN for harmonics that the motion lacks."""
    out = np.full((*values.shape[:-1], 1 + len(numbers)), np.nan, dtype=np.complex128)
    out[..., [0, *(1 + numbers.index(h) for h in motion.harmonics)]] = values
    return out
