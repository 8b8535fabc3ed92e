"""Additional quantities of curves of a nonlinear mode, and the resonances that they predict."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from fcm.contact.limits import FloatArray
from fcm.frozen import Frozen
from fcm.units import in_unit


class Resonance(NamedTuple):
    """Predicted resonance of a nonlinear mode with the scene's forces, by single nonlinear mode theory."""

    level: float  # level of the scene's forces
    frequency: float  # [rad/s] of the forces
    modal_amplitude: float
    amplitude: dict[str, float]  # of each dof, half the peak-to-peak displacement
    damping: float  # ratio


class InternalResonance(NamedTuple):
    """Points of a nonlinear mode at which higher harmonics have much of its power."""

    modal_amplitude: tuple[float, float]  # the least and the greatest
    frequency: tuple[float, float]  # [rad/s] of these points, the lowest and the highest
    harmonic: int  # the harmonic with the most power
    share: float  # greatest share of the power in higher harmonics

    def summary(self, unit: str) -> dict[str, Any]:
        """Entries for `fcm respond --json`, frequencies in unit."""
        return self._asdict() | {"frequency": in_unit(np.array(self.frequency), unit).tolist()}


class MotionOfMode(Frozen):
    """The motion at a point of a nonlinear mode."""

    amplitude: float  # modal
    frequency: float  # [rad/s]
    contacts: FloatArray  # (unknown + 1,) displacements as in `contact_law`, and the frequency
    modes: npt.NDArray[np.complex128]  # (mode, 1 + harmonic) of Im(q exp(i h omega t)), the mean first


@dataclass(eq=False)
class NonlinearMode:
    """Additional quantities at the points of a nonlinear mode; the curve's `frequency` is its own."""

    number: int
    amplitude: FloatArray  # (point,) modal amplitude a, of modes of mass 1
    damping: FloatArray  # (point,) ratio
    force: FloatArray  # (point,) modal force p of the scene's forces
    resonant_level: FloatArray  # (point,) level of the scene's forces whose resonance has the amplitude
    levels: tuple[float, ...]  # levels of the scene's forces at which the response is predicted
    flanks: FloatArray  # (point, level, 2) [rad/s] where they give the amplitude, below and above resonance
    folds: list[float]  # modal amplitudes at which the curve turns back
    resonances: list[Resonance]  # at these levels
    steady: npt.NDArray[np.bool_]  # (point,) False where nothing holds a rigid-body mode
    internal: InternalResonance | None = None
    motions: tuple[MotionOfMode, ...] = ()  # motions to export

    def summary(
        self, frequency: FloatArray, unit: str, amplitude: Mapping[str, FloatArray]
    ) -> dict[str, Any]:
        """Entries for `fcm respond --json`; amplitude (point,) is given for each degree of freedom.

        `displacement` is that of a modal amplitude of 1, at the least amplitude that was followed.
        """
        top, least = int(self.damping.argmax()), int(self.amplitude.argmin())
        return {
            "number": self.number,
            "frequency": in_unit(frequency[[0, -1]], unit).tolist(),
            "damping": self.damping[[0, -1]].tolist(),
            "modal_amplitude": self.amplitude[[0, -1]].tolist(),
            "displacement": {
                dof: float(one[least] / self.amplitude[least]) for dof, one in amplitude.items()
            },
            "greatest_damping": {
                "damping": float(self.damping[top]),
                "frequency": float(in_unit(frequency[top], unit)),
                "modal_amplitude": float(self.amplitude[top]),
            },
            "folds": self.folds,
            "resonances": [
                {
                    "level": one.level,
                    "frequency": float(in_unit(one.frequency, unit)),
                    "modal_amplitude": one.modal_amplitude,
                    "damping": one.damping,
                    "amplitude": {dof: one.amplitude[dof] for dof in amplitude},
                }
                for one in self.resonances
            ],
            "not_met": [{"level": level, "why": why} for level in self.levels if (why := self._unmet(level))],
            **({"internal_resonance": self.internal.summary(unit)} if self.internal else {}),
        }

    def _unmet(self, level: float) -> str:
        """Why the mode has no resonance at a force level, or not the greatest one; empty if it has it."""
        if not self.force.any():
            return "the forces do nothing on the mode"
        least, most = int(self.amplitude.argmin()), int(self.amplitude.argmax())
        if self.resonant_level[most] < level:
            return f"its resonance lies beyond the modal amplitude {self.amplitude[most]:.4g}"
        if self.resonant_level[least] > level and all(one.level != level for one in self.resonances):
            return f"its resonance lies below the modal amplitude {self.amplitude[least]:.4g}"
        return ""
