"""What a calculation yields: curves of points with their regimes and errors, peaks and folds."""

from __future__ import annotations

import sys
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from fcm.contact.limits import FloatArray
from fcm.results.gist import Gist, gist_of, worst
from fcm.results.jumps import Jump, Swept, Untold, swept
from fcm.results.peak import Peak
from fcm.scene.model import Scene
from fcm.units import in_unit

if TYPE_CHECKING:
    from fcm.harmonic.sensitivity import Sensitivities
    from fcm.motion.histories import Histories
    from fcm.results.nonlinear_mode import NonlinearMode
    from fcm.results.orbits import Orbits, Stuck
    from fcm.results.tracked import Tracking

DEFECT = "a defect of fcm"  # how the reason of a curve begins that was lost to one
INTERRUPTED = "interrupted"  # how it begins where an interruption has cut the curve off, or left it out
NOT_BEGUN = f"{INTERRUPTED} before it was traced"


@dataclass
class Curve:
    """One response curve; frequencies in rad/s.

    Branches that do not hang together follow one another, with a point of NaN between them.
    """

    parameters: dict[str, float]
    frequency: FloatArray  # (point,) [rad/s]
    amplitude: FloatArray  # (point, dof) half the peak-to-peak displacement
    fundamental: FloatArray  # (point, dof) amplitude of the first harmonic
    phase: FloatArray  # (point, dof) [rad], of fundamental * sin(omega t + phase)
    mean: FloatArray  # (point, dof)
    regime: npt.NDArray[np.str_]  # (point, contact) sequence of the loop
    loop: FloatArray  # (point, contact, 5) n0_bar, b_bar, phi, tangential amplitude a, force k_u a
    cycle: FloatArray  # (point, contact, 4) greatest normal and friction force, slip, energy in a cycle
    stable: FloatArray  # (point,) 1 where small disturbances die out, 0 where not, NaN where it is not known
    table_error: FloatArray  # (point,) shift of the response from table to closed form, relative
    error: FloatArray  # (point, dof) of amplitude, estimated, relative
    truncation_error: FloatArray  # (point,) the greatest of these that matters, see `fcm.harmonic.error`
    complete: bool
    reason: str  # why it is not complete, else ''
    peaks: dict[str, Peak]  # of each dof
    folds: list[float]  # frequencies [rad/s] in the order along the curve
    seconds: float
    short_of: str = ""  # what keeps it from the accuracy that was asked for, if anything
    unsure: list[float] = field(default_factory=list)  # [rad/s] where branches may have been missed
    evaluations: int = 0  # of the equations, to follow it
    level: FloatArray | None = None  # (point,) of the forces, where that is what is followed
    level_folds: list[float] = field(default_factory=list)  # levels at which that curve turns back
    harmonics: tuple[int, ...] = ()  # of the balance
    harmonic: npt.NDArray[np.complex128] | None = None  # (point, harmonic, dof) of Im(X exp(i h omega t))
    orbits: Orbits | None = None  # of the exact motion
    loose: int = 0  # points at which a contact never slips and another may feel it, if that is not told
    gist: Gist | None = None  # in the place of most points, where only peaks and folds were asked for
    mode: NonlinearMode | None = None
    sensitivity: Sensitivities | None = None  # of the peaks

    def __setstate__(self, state: dict[str, Any]) -> None:
        """From another process or a file: what is the same in all curves is there once."""
        vars(self).update({name: _shared(value) for name, value in state.items()})

    @property
    def points(self) -> int:
        """Number of points."""
        return int(np.isfinite(self.frequency).sum())

    @property
    def branch(self) -> npt.NDArray[np.intp]:
        """Number of the branch of each point, (point,); a row of NaN stands between branches."""
        return np.cumsum(np.isnan(self.frequency))

    def swept(self) -> Swept:
        """What a slow upward and a slow downward sweep of the frequency meet."""
        if self.orbits is not None and self.orbits.swept is not None:
            return self.orbits.swept
        if self.level is not None or self.mode is not None:
            return Swept([], [])
        return swept(self.frequency, self.amplitude, self.stable)

    def jumps(self) -> list[Jump]:
        """Jumps of a slow upward and a slow downward sweep of the frequency."""
        return self.swept().jumps

    def _jump(self, jump: Jump, unit: str) -> dict[str, Any]:
        return {
            "sweep": jump.sweep,
            "frequency": float(in_unit(jump.frequency, unit)),
            "before": dict(zip(self.peaks, jump.before.tolist(), strict=True)),
            "after": dict(zip(self.peaks, jump.after.tolist(), strict=True)),
        }

    def _untold(self, one: Untold, unit: str) -> dict[str, Any]:
        return {
            "sweep": one.sweep,
            "from": float(in_unit(one.start, unit)),
            "to": float(in_unit(one.end, unit)),
            "before": dict(zip(self.peaks, one.before.tolist(), strict=True)),
        }

    def _peak(self, peak: Peak, gist: Gist, unit: str) -> dict[str, Any]:
        """A peak, and whether it is where the range ends, so that it is none of the curve's own."""
        at_edge = self.complete and self.level is None and peak.frequency in gist.ends
        return {
            "amplitude": peak.amplitude,
            "frequency": float(in_unit(peak.frequency, unit)),
            "error": peak.error,
            "stable": None if np.isnan(peak.stable) else bool(peak.stable),
            "at_edge": bool(at_edge),
        }

    def summary(self, unit: str = "rad/s") -> dict[str, Any]:
        """The curve as `fcm respond --json` prints it, frequencies in unit."""
        gist = self.gist or gist_of(self)
        untold = gist.swept.untold
        return {
            "parameters": self.parameters,
            "points": gist.points,
            "complete": self.complete,
            **({} if self.complete else {"reason": self.reason}),
            **({"harmonics": list(self.harmonics)} if self.harmonics else {}),
            **({"short_of_accuracy": self.short_of} if self.short_of else {}),
            **({"branches_unsure_at": in_unit(self.unsure, unit).tolist()} if self.unsure else {}),
            **({"may_not_be_unique": self.loose} if self.loose else {}),
            "peak": {d: self._peak(peak, gist, unit) for d, peak in self.peaks.items()},
            "folds": in_unit(self.folds, unit).tolist(),
            **({} if self.sensitivity is None else {"sensitivity": self._of_numbers(self.sensitivity, unit)}),
            **({} if self.level is None else {"level_folds": self.level_folds}),
            "jumps": [self._jump(jump, unit) for jump in gist.swept.jumps],
            **({"stability_untold": [self._untold(one, unit) for one in untold]} if untold else {}),
            "stable": gist.stable,
            "table_error": gist.table_error,
            "truncation_error": gist.truncation_error,
            **({} if self.orbits is None else self._of_orbits(self.orbits, unit)),
            **({} if self.mode is None else {"mode": self.mode.summary(self.frequency, unit, self.peaks)}),
            "seconds": self.seconds,
        }

    def _of_numbers(self, found: Sensitivities, unit: str) -> dict[str, Any]:
        """Derivatives of each peak in the summary; relative: share of the peak by share of the number."""
        out: dict[str, Any] = {}
        for dof, kind, height, frequency in zip(
            self.peaks, found.kind, found.height, in_unit(found.frequency, unit), strict=True
        ):
            top = self.peaks[dof].amplitude
            out[dof] = {"peak": kind.value, "numbers": {}}
            for key, value, by, by_frequency in zip(
                found.numbers, found.values, height, frequency, strict=True
            ):
                relative = float(by * value / top) if top > 0.0 else np.nan
                out[dof]["numbers"][key] = {
                    "value": float(value),
                    "amplitude": float(by),
                    "frequency": float(by_frequency),
                    "relative": relative,
                }
        return out

    def _of_orbits(self, orbits: Orbits, unit: str) -> dict[str, Any]:
        """What only exact motions have, in the summary."""
        here = np.isfinite(self.frequency)
        known = np.isfinite(orbits.family_greatest).any(axis=1)
        families = {
            dof: [float(orbits.family_least[k, i]), float(orbits.family_greatest[k, i])]
            for i, (dof, peak) in enumerate(self.peaks.items())
            for k in np.flatnonzero(known & (self.frequency == peak.frequency))[:1]
        }
        return {
            "closure_error": worst(orbits.closure_error),
            "repeats": sorted({int(x) for x in orbits.repeats[here]}),
            "not_unique": int(known.sum()),
            **({} if orbits.span is None else {"only": "peaks"}),
            **({"peak_range": families} if families else {}),
            **({"stuck_beside": [self._stuck(one, unit) for one in orbits.stuck]} if orbits.stuck else {}),
        }

    def _stuck(self, one: Stuck, unit: str) -> dict[str, Any]:
        return {
            "frequency": float(in_unit(one.frequency, unit)),
            "regime": list(one.states),
            "start_friction": one.friction.tolist(),
            "amplitude": {
                dof: [float(one.least[i]), float(one.greatest[i])] for i, dof in enumerate(self.peaks)
            },
        }


_EMPTY: dict[tuple[Any, ...], npt.NDArray[Any]] = {}  # by shape and kind


def _shared(value: Any) -> Any:
    if isinstance(value, np.ndarray) and value.size == 0:
        return _EMPTY.setdefault((value.shape, value.dtype.str), value)
    if isinstance(value, dict):
        return {sys.intern(key) if type(key) is str else key: item for key, item in value.items()}
    return value


@dataclass
class Response:
    """All curves of a scene."""

    title: str
    dofs: tuple[str, ...]
    contacts: tuple[str, ...]
    curves: list[Curve]
    method: str
    frequency_unit: str
    seconds: float = 0.0
    left_out: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)  # of the scene: what was taken for what
    drawn: tuple[str, ...] = ()  # swept keys whose values are random draws
    units: tuple[str, str] = ("", "")  # of length and force, for labels; empty where they are not given
    histories: Histories | None = None  # of the scene's schedule
    defects: list[str] = field(default_factory=list)  # tracebacks, of curves that were lost to them
    peaks_only: bool = False  # whether the curves were asked for without their points
    tracking: Tracking | None = None  # special points followed in a number of the scene, and optima

    @staticmethod
    def without_curves(scene: Scene) -> Response:
        """The response of a scene that has a schedule, but no range of frequencies."""
        contacts = tuple(contact.name for contact in scene.contacts)
        return Response(scene.title, scene.modal.dofs, contacts, [], "none", scene.frequency_unit)

    @property
    def complete(self) -> bool:
        """Whether every curve reached the end of its range, and of the schedule if there is one."""
        simulated = self.histories is None or self.histories.complete
        tracked = self.tracking is None or self.tracking.complete
        return simulated and tracked and all(curve.complete for curve in self.curves)

    @property
    def interrupted(self) -> bool:
        """Whether curves, or parts of the schedule, are missing because the run was interrupted."""
        if self.tracking is not None and self.tracking.interrupted:
            return True
        simulated = [] if self.histories is None else self.histories.records
        reasons = [*(curve.reason for curve in self.curves), *(record.reason for record in simulated)]
        return any(reason.startswith(INTERRUPTED) for reason in reasons)

    @property
    def parameters(self) -> list[dict[str, float]]:
        """The swept values of each curve, be it traced or simulated."""
        simulated = self.histories.records if self.histories is not None else []
        return [one.parameters for one in self.curves or simulated]
