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

DEFECT = "a defect of fcm"  # reason of a curve lost to a defect
INTERRUPTED = "interrupted"  # reason of a curve that an interruption cut off or left out; see `Cause`
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
    cycle_error: FloatArray  # (point, contact, 4) their estimated relative errors
    stable: FloatArray  # (point,) 1 where small disturbances die out, 0 where not, NaN if unknown
    table_error: FloatArray  # (point,) relative shift of the response from table to closed form
    error: FloatArray  # (point, dof) estimated relative error of the amplitude; at a peak that of its height
    truncation_error: FloatArray  # (point,) the greatest relevant error, see `fcm.accuracy.embedded_pair`
    complete: bool
    reason: str  # why it is incomplete, in words, or ''
    peaks: dict[str, Peak]  # of each dof
    folds: list[float]  # frequencies [rad/s] in the order along the curve
    seconds: float
    bifurcations: list[tuple[str, float]] = field(default_factory=list)  # others: kind, frequency [rad/s]
    short_of: str = ""  # why it misses the requested accuracy, or ''
    uncertain_at: list[float] = field(default_factory=list)  # [rad/s] where branches may have been missed
    folds_uncertain_at: list[float] = field(default_factory=list)  # [rad/s] from which no folds were followed
    symmetry_lost: list[float] = field(default_factory=list)  # [rad/s] by harmonics that are not balanced
    shakedown_at: float = np.nan  # [rad/s] where a sticking contact would slip if it began unstressed
    may_wedge: bool = False  # whether motions are unstable, and contacts pressed by friction may stick
    levels: list[float] | None = None  # [rad/s] at which the force level was followed, if known
    folds_between: tuple[float, float] | None = None  # force levels, see `fcm.branches.isolas`
    not_confirmed: int = 0  # points of unknown stability, as the number of examined points is limited
    isolated: tuple[int, ...] = ()  # numbers of closed branches of a balance that no other crosses
    mirrored: int = 0  # number of branches whose mirror images are branches, too, and are not traced
    evaluations: int = 0  # of the equations, to follow it
    level: FloatArray | None = None  # (point,) force level, if the curve is over the level
    level_folds: list[float] = field(default_factory=list)  # levels at which such a curve turns back
    greatest: Greatest | None = None  # forces, slip and energy of the contacts along the curve
    harmonics: tuple[int, ...] = ()  # of the balance
    harmonic: npt.NDArray[np.complex128] | None = None  # (point, harmonic, dof) of Im(X exp(i h omega t))
    orbits: Orbits | None = None  # of the exact motion
    undetermined: int = 0  # points where a contact never slips, if it is unknown whether another one feels it
    extract: CurveExtract | None = (
        None  # if known; it replaces most points if only peaks and folds are requested
    )
    mode: NonlinearMode | None = None
    sensitivity: Sensitivities | None = None  # of the peaks
    across: ContactMotions | None = None  # motions across the contacts, see `contact_motions`
    cause: Cause = Cause.CALCULATION  # why it is incomplete, if it is
    error_at_frequency: FloatArray | None = None  # (point, dof) also at peaks; None: same as error

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Restore a curve from another process or a file, sharing values that are equal in all curves."""
        vars(self).update({name: _shared(value) for name, value in state.items()})

    @property
    def same_frequency_error(self) -> FloatArray:
        """Error (point, dof) of the amplitude at the same frequency, also at peaks."""
        return self.error if self.error_at_frequency is None else self.error_at_frequency

    @property
    def points(self) -> int:
        """Number of computed points, whether kept or not."""
        return int(np.isfinite(self.frequency).sum()) if self.extract is None else self.extract.points

    @property
    def branch(self) -> npt.NDArray[np.intp]:
        """Number (point,) of each point's branch; a row of NaN separates branches."""
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
    """Data on the sectors of a mistuned ring, besides its curves; frequencies in rad/s."""

    names: tuple[str, ...]  # degrees of freedom of a sector
    factors: FloatArray  # (curve, sector) of the stiffness
    tuned: FloatArray  # (curve, dof) greatest amplitude of the tuned ring; NaN if unknown
    tuned_frequency: FloatArray  # (curve, dof)
    tuned_at_end: npt.NDArray[np.bool_]  # (curve, dof) whether it is at an end of the range, and not a peak

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
    without_stability: bool = False  # whether stability was not examined on some curves, as `left_out` says
    notes: list[str] = field(default_factory=list)  # notes of the scene on how its input was interpreted
    drawn: tuple[str, ...] = ()  # swept keys whose values are random draws
    units: tuple[str, str] = ("", "")  # of length and force, for labels; empty if not given
    histories: Histories | None = None  # of the scene's schedule
    defects: list[str] = field(default_factory=list)  # tracebacks of curves that were lost to defects
    peaks_only: bool = False  # whether the curves are without points, as requested
    output: tuple[str, ...] = ()  # degrees of freedom that the scene requests; empty if it does not say
    directions: dict[str, tuple[str, ...]] = field(default_factory=dict)  # of contacts that slide in a plane
    tracking: Tracking | None = None  # special points followed in a number of the scene, and optima
    fitted: Fitted | None = None  # numbers fitted to measured data
    positions: dict[str, FloatArray] = field(default_factory=dict)  # (3,) of contacts whose position is known
    motions: ResponseMotions | None = None  # at peaks or chosen frequencies, with contact forces and modes
    blades: Blades | None = None  # of a mistuned ring
    in_time: InTime = InTime.COMPUTED  # whether the exact motion of the scene is computed
    span: tuple[float, float] | None = None  # [rad/s] over which curves are traced; None without a range

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
        """Whether every curve, schedule, tracking and fit is complete."""
        simulated = self.histories is None or self.histories.complete
        tracked = self.tracking is None or self.tracking.complete
        fitted = self.fitted is None or not self.fitted.interrupted
        return simulated and tracked and fitted and all(curve.complete for curve in self.curves)

    @property
    def interrupted(self) -> bool:
        """Whether curves, or other parts, are missing because the run was interrupted."""
        if any(one is not None and one.interrupted for one in (self.tracking, self.fitted)):
            return True
        simulated = [] if self.histories is None else self.histories.records
        curves = (curve for curve in self.curves if not curve.complete)
        cut_off = any(curve.cause is Cause.INTERRUPTED for curve in curves)
        return cut_off or any(record.interrupted for record in simulated)

    @property
    def parameters(self) -> list[dict[str, float]]:
        """The swept values of each curve, traced or simulated."""
        simulated = self.histories.records if self.histories is not None else []
        return [one.parameters for one in self.curves or simulated]
