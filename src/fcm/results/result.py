"""Results of a calculation: curves with regimes, errors, peaks and folds."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from fcm.contact.limits import FloatArray
from fcm.frozen import Frozen
from fcm.model.ring import of_sector
from fcm.model.scene import InTime, Scene, in_time
from fcm.results.cause import Cause
from fcm.results.contact_maxima import Greatest
from fcm.results.curve_extracts import CurveExtract
from fcm.results.curve_summary import curve_summary
from fcm.results.directions import directions_of, positions_of
from fcm.results.jumps import FrequencySweep, Jump, swept
from fcm.results.peak import Peak

if TYPE_CHECKING:
    from fcm.harmonic_balance.contact_motions import ContactMotions
    from fcm.results.fitted import Fitted
    from fcm.results.motions import ResponseMotions
    from fcm.results.nonlinear_mode import NonlinearMode
    from fcm.results.orbits import Orbits
    from fcm.results.tracked import Tracking
    from fcm.sensitivity.peaks import Sensitivities
    from fcm.time_domain.histories import Histories

DEFECT = "a defect of fcm"  # how the reason of a curve that was lost to one is worded,
INTERRUPTED = "interrupted"  # and that of one which an interruption has cut off, or left out; see `Cause`
NOT_BEGUN = f"{INTERRUPTED} before it was traced"


@dataclass(eq=False)
class Curve:
    """One response curve; frequencies in rad/s.

    Separate branches follow one another, with a point of NaN between them.
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
    cycle_error: FloatArray  # (point, contact, 4) of these, estimated, each relative to itself
    stable: FloatArray  # (point,) 1 where small disturbances die out, 0 where not, NaN where it is not known
    table_error: FloatArray  # (point,) shift of the response from table to closed form, relative
    error: FloatArray  # (point, dof) of amplitude, estimated, relative; at a peak that of its height
    truncation_error: (
        FloatArray  # (point,) the greatest of these that matters, see `fcm.accuracy.embedded_pair`
    )
    complete: bool
    reason: str  # why it is not complete, in words, else ''
    peaks: dict[str, Peak]  # of each dof
    folds: list[float]  # frequencies [rad/s] in the order along the curve
    seconds: float
    bifurcations: list[tuple[str, float]] = field(default_factory=list)  # others: which, and where [rad/s]
    short_of: str = ""  # what keeps it from the accuracy that was asked for, if anything
    uncertain_at: list[float] = field(default_factory=list)  # [rad/s] where branches may have been missed
    folds_uncertain_at: list[float] = field(default_factory=list)  # [rad/s] from where no folds were followed
    symmetry_lost: list[float] = field(default_factory=list)  # [rad/s] by harmonics that are not balanced
    shakedown_at: float = np.nan  # [rad/s] where a contact that sticks would slip if it began unstressed
    may_wedge: bool = False  # motions are unstable, and contacts may stick that friction presses together
    levels: list[float] | None = None  # [rad/s] at which the level of the forces was followed, if known
    folds_between: tuple[float, float] | None = None  # levels of the forces, see `fcm.branches.isolas`
    not_confirmed: int = 0  # points of unknown stability, where those that may be looked at did not suffice
    isolated: tuple[int, ...] = ()  # branches of a balance that are closed, and that no other one crosses
    mirrored: int = 0  # branches whose mirror images are branches, too, and are not traced
    evaluations: int = 0  # of the equations, to follow it
    level: FloatArray | None = None  # (point,) of the forces, where that is what is followed
    level_folds: list[float] = field(default_factory=list)  # levels at which that curve turns back
    greatest: Greatest | None = None  # forces, slip and energy of the contacts along the curve
    harmonics: tuple[int, ...] = ()  # of the balance
    harmonic: npt.NDArray[np.complex128] | None = None  # (point, harmonic, dof) of Im(X exp(i h omega t))
    orbits: Orbits | None = None  # of the exact motion
    undetermined: int = 0  # points at which a contact never slips and another may feel it, if that is unknown
    extract: CurveExtract | None = (
        None  # if that is known; in the place of most points, where only peaks and folds were asked for
    )
    mode: NonlinearMode | None = None
    sensitivity: Sensitivities | None = None  # of the peaks
    across: ContactMotions | None = None  # motions of the contacts, see `contact_motions`
    cause: Cause = Cause.CALCULATION  # why it is not complete, if it is not
    error_at_frequency: FloatArray | None = None  # (point, dof) at peaks, too; None: as error

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Restores a curve from another process or a file, sharing values equal in all curves."""
        vars(self).update({name: _shared(value) for name, value in state.items()})

    @property
    def same_frequency_error(self) -> FloatArray:
        """Error (point, dof) of the amplitude at the same frequency, at peaks, too."""
        return self.error if self.error_at_frequency is None else self.error_at_frequency

    @property
    def points(self) -> int:
        """Number of points that were computed, be they kept or not."""
        return int(np.isfinite(self.frequency).sum()) if self.extract is None else self.extract.points

    @property
    def branch(self) -> npt.NDArray[np.intp]:
        """Number of the branch of each point, (point,); a row of NaN stands between branches."""
        return np.cumsum(np.isnan(self.frequency))

    def swept(self) -> FrequencySweep:
        """Jumps of a slow upward and a slow downward sweep of the frequency."""
        if self.orbits is not None and self.orbits.swept is not None:
            return self.orbits.swept
        if self.level is not None or self.mode is not None:
            return FrequencySweep([], [])
        if self.orbits is not None and (self.orbits.repeats > 1).any():
            repeats = self.orbits.repeats
            return swept(self.frequency, self.amplitude, self.stable, repeats=repeats).without_flips()
        return swept(self.frequency, self.amplitude, self.stable)

    def jumps(self) -> list[Jump]:
        """Jumps of a slow upward and a slow downward sweep of the frequency."""
        return self.swept().jumps

    def summary(self, unit: str = "rad/s", contacts: Sequence[str] = ()) -> dict[str, Any]:
        """The curve as `fcm respond --json` prints it, frequencies in unit; contacts are their names."""
        return curve_summary(self, unit, contacts)


_EMPTY: dict[tuple[Any, ...], npt.NDArray[Any]] = {}  # by shape and kind


def _shared(value: Any) -> Any:
    if isinstance(value, np.ndarray) and value.size == 0:
        return _EMPTY.setdefault((value.shape, value.dtype.str), value)
    if isinstance(value, dict):
        return {sys.intern(key) if type(key) is str else key: item for key, item in value.items()}
    return value


class Blades(Frozen):
    """Data on the sectors of a mistuned ring beside its curves; frequencies in rad/s."""

    names: tuple[str, ...]  # degrees of freedom of a sector
    factors: FloatArray  # (curve, sector) of the stiffness
    tuned: FloatArray  # (curve, dof) greatest amplitude of the tuned ring; NaN where that is not known
    tuned_frequency: FloatArray  # (curve, dof)
    tuned_at_end: npt.NDArray[np.bool_]  # (curve, dof) whether that is at an end of the range, and no peak

    @property
    def sectors(self) -> int:
        """Number of sectors."""
        return int(self.factors.shape[1])

    def columns(self, dofs: Sequence[str]) -> npt.NDArray[np.intp]:
        """Indices (dof, sector) of the sectors' degrees of freedom among all."""
        place = {name: number for number, name in enumerate(dofs)}
        return np.array([[place[of_sector(name, k)] for k in range(self.sectors)] for name in self.names])


@dataclass(eq=False)
class Response:
    """Result of a response calculation: all curves of a scene."""

    title: str
    dofs: tuple[str, ...]
    contacts: tuple[str, ...]
    curves: list[Curve]
    method: str
    frequency_unit: str
    seconds: float = 0.0
    left_out: list[str] = field(default_factory=list)
    without_stability: bool = False  # whether none was looked for on some curves, as `left_out` says
    notes: list[str] = field(default_factory=list)  # of the scene: what was taken for what
    drawn: tuple[str, ...] = ()  # swept keys whose values are random draws
    units: tuple[str, str] = ("", "")  # of length and force, for labels; empty where they are not given
    histories: Histories | None = None  # of the scene's schedule
    defects: list[str] = field(default_factory=list)  # tracebacks, of curves that were lost to them
    peaks_only: bool = False  # whether the curves were asked for without their points
    output: tuple[str, ...] = ()  # degrees of freedom that the scene asks for; none where it does not say
    directions: dict[str, tuple[str, ...]] = field(default_factory=dict)  # of contacts that slide in a plane
    tracking: Tracking | None = None  # special points followed in a number of the scene, and optima
    fitted: Fitted | None = None  # numbers fitted to measured data
    positions: dict[str, FloatArray] = field(default_factory=dict)  # (3,) of contacts of which that is known
    motions: ResponseMotions | None = None  # at peaks or chosen frequencies, with contact forces and modes
    blades: Blades | None = None  # of a mistuned ring
    in_time: InTime = InTime.COMPUTED  # whether the exact motion of the scene is
    span: tuple[float, float] | None = None  # [rad/s] over which curves are traced; None for no such range

    @staticmethod
    def of(scene: Scene, curves: list[Curve], method: str) -> Response:
        """Curves of a scene, with the names, units and notes of the scene."""
        contacts = tuple(contact.name for contact in scene.contacts)
        response = Response(scene.title, scene.modal.dofs, contacts, curves, method, scene.frequency_unit)
        response.notes, response.units, response.drawn = list(scene.notes), scene.units, scene.drawn
        response.output = scene.output
        response.directions, response.positions = directions_of(scene), positions_of(scene)
        response.in_time = in_time(scene)
        response.span = scene.frequency_range if scene.has_range else None
        return response

    @staticmethod
    def without_curves(scene: Scene) -> Response:
        """The response of a scene that has a schedule, but no range of frequencies."""
        return Response.of(scene, [], "none")

    @property
    def complete(self) -> bool:
        """Whether every curve reached the end of its range, and of the schedule if there is one."""
        simulated = self.histories is None or self.histories.complete
        tracked = self.tracking is None or self.tracking.complete
        fitted = self.fitted is None or not self.fitted.interrupted
        return simulated and tracked and fitted and all(curve.complete for curve in self.curves)

    @property
    def interrupted(self) -> bool:
        """Whether curves, or parts of the schedule, are missing because the run was interrupted."""
        if any(one is not None and one.interrupted for one in (self.tracking, self.fitted)):
            return True
        simulated = [] if self.histories is None else self.histories.records
        curves = (curve for curve in self.curves if not curve.complete)
        cut_off = any(curve.cause is Cause.INTERRUPTED for curve in curves)
        return cut_off or any(record.interrupted for record in simulated)

    @property
    def parameters(self) -> list[dict[str, float]]:
        """The swept values of each curve, be it traced or simulated."""
        simulated = self.histories.records if self.histories is not None else []
        return [one.parameters for one in self.curves or simulated]
