"""The loops in a response file: the points of a curve at a frequency, and the loop of a contact there."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from fcm.frozen import Frozen
from fcm.plot.dof import greatest_column
from fcm.plot.errors import PlotError
from fcm.plot.options import READ
from fcm.plot.read import FloatArray, chosen_curve, floats, on_curve, opened, read_response
from fcm.plot.reader_process import apart
from fcm.plot.solutions import Solution, solutions_at
from fcm.plot.summary import summary_of

_ENERGY = "dissipated_energy"
_ALSO = (
    "contact",
    "frequency",
    "level",
    "modal_amplitude",
    "steady_state",
    "stable",
    _ENERGY,
    "harmonic",
    "regime",
    "contact_start",
)
_MOTION = (
    "contact_harmonic", "contact_mean", "contact_amplitude", "contact_phase",
    "contact_mu", "contact_k_u", "contact_k_v", "contact_n_0",
)  # fmt: skip
_PARTS = ("n0_bar", "b_bar", "phi", "tangential_amplitude", "spring_force")


class PlanePoint(Frozen):
    """Arguments of `fcm.planar_loop` for a contact that slides in a plane, with names of its directions."""

    motion: npt.NDArray[np.complex128]  # (direction, harmonic), the mean first
    law: tuple[float, float, float, float]  # mu, k_u, k_v, n_0
    start: tuple[float, float]  # displacements at which it starts unstressed
    directions: tuple[str, str]


class LinePoint(Frozen):
    """Arguments of `fcm.periodic_loop` for a contact on a line; u is without its mean.

    The origin of the angle makes the fundamental of u a sine.
    """

    motion: npt.NDArray[np.complex128]  # (u and v, harmonic), the mean first
    law: tuple[float, float, float, float]  # mu, k_u, k_v, n_0


class NormalPoint(Frozen):
    """The normal motion of a contact without friction, and the numbers of its normal law."""

    motion: npt.NDArray[np.complex128]  # (harmonic,), the mean first
    law: tuple[float, float]  # k_v, n_0


class PointIndex(NamedTuple):
    """A contact at a point of a curve, in the arrays of a file."""

    curve: int
    point: int
    contact: int


class MotionFile(Frozen):
    """Data of a response file on the motions across contacts, in a plane or in several harmonics."""

    mean: FloatArray  # (curve, point, contact, direction)
    amplitude: FloatArray  # (curve, point, contact, direction, harmonic)
    phase: FloatArray
    harmonics: tuple[int, ...]
    law: FloatArray  # (4, curve, contact)
    start: FloatArray  # (curve, contact, direction) displacements at which they start unstressed
    directions: dict[str, Any]  # of each contact in a plane, by x, y and normal

    def at(self, index: PointIndex, contact: str) -> PlanePoint | LinePoint | NormalPoint | None:
        """Motion at a point; None for a contact with friction on a line that moves in one harmonic only."""
        names = self.directions.get(contact)
        mean = self.mean[index]
        motion = np.zeros((mean.size, 1 + max(self.harmonics)), dtype=np.complex128)
        motion[:, 0] = mean
        waves = self.amplitude[index] * np.exp(1j * self.phase[index]) / 1j
        motion[:, list(self.harmonics)] = np.nan_to_num(waves)
        mu, k_u, k_v, n_0 = law = self.law[:, index.curve, index.contact].tolist()
        if mu == 0.0 and not np.isnan(mean).any():
            return NormalPoint(motion[-1], (k_v, n_0))
        if isinstance(names, dict):
            axes = str(names.get("x", "x")), str(names.get("y", "y"))
            x, y, _ = self.start[index.curve, index.contact].tolist()
            return PlanePoint(motion, (mu, k_u, k_v, n_0), (x, y), axes)
        if np.isnan(mean).any() or self.harmonics == (1,):
            return None
        if not np.isfinite(law).all():
            raise ValueError(f"the numbers of contact {contact} are not finite")
        turned = np.exp(-1j * np.arange(motion.shape[1]) * (np.angle(motion[0, 1]) + 0.5 * np.pi))
        motion[0, 0] = 0.0
        return LinePoint(motion[[0, -1]] * turned, (mu, k_u, k_v, n_0))


class LoopPoint(Frozen):
    """Data of one contact at one point of a curve."""

    curve: int
    parameters: dict[str, float]  # the swept values of the curve
    contact: str
    frequency: float  # of the point, in the file's unit
    solution: Solution  # which of those that the curve has near this frequency
    stable: bool | None  # None where the file does not know
    n0_bar: float
    b_bar: float
    phi: float  # [rad]
    amplitude: float  # a, of the tangential motion
    force: float  # k_u a
    harmonics: tuple[int, ...]  # of the motion
    states: str  # with all harmonics
    fundamental: bool  # whether the loop is that of the first harmonic, because the file lacks the others
    motion: PlanePoint | LinePoint | NormalPoint | None = None  # None: in one harmonic, with friction
    output: str = ""  # the degree of freedom whose peak is the default; see `LoopFile.column`
    displacement: float = float("nan")  # its amplitude
    peak: bool = False  # whether the point is this peak
    modal_amplitude: float | None = None  # of a nonlinear mode


class PlaceOnCurve(NamedTuple):
    """Where on a curve: at a frequency or a level, or, of a nonlinear mode, at a modal amplitude."""

    value: float
    modal: bool = False

    def of(self, point: LoopPoint) -> float:
        """Frequency, level or modal amplitude of a point, as `modal` says."""
        if not self.modal:
            return point.frequency
        assert point.modal_amplitude is not None  # else there is no place by it
        return point.modal_amplitude


class LoopFile(Frozen):
    """Data of a response file on the loops of its contacts."""

    path: Path
    unit: str
    contacts: tuple[str, ...]
    parameters: tuple[dict[str, float], ...]  # (curve,)
    frequency: FloatArray  # (curve, point) in the file's unit
    stable: FloatArray  # (curve, point) 1, 0 or NaN
    loop: FloatArray  # (5, curve, point, contact)
    energy: FloatArray  # (contact,) greatest that friction takes in a cycle; 0 where the file lacks it
    harmonics: tuple[int, ...]
    states: npt.NDArray[np.str_]  # (curve, point, contact)
    units: Mapping[str, str]  # of swept keys, if the file says them
    dimensions: tuple[str, str] | None  # units of length and force, if it says both
    dofs: tuple[str, ...]
    amplitude: FloatArray  # (curve, point, dof)
    column: int  # of the greatest amplitude, among the degrees of freedom that the scene asks for, if any
    motions: MotionFile | None = None
    modal_amplitude: FloatArray | None = None  # (curve, point) of nonlinear modes
    steady: FloatArray | None = None  # (curve, point) 0 where these have no steady state


@apart
def read_loops(path: Path) -> LoopFile:
    """Read what ``fcm respond -o`` has written; PlotError if the file holds no loops."""
    response = read_response(path)
    with opened(path, "a response file", (), (*_PARTS, *_ALSO, *_MOTION)) as data:
        missing = [name for name in (*_PARTS, "contact") if name not in data.variables]
        if missing:
            raise PlotError(f"{path}: holds no loops: it has no variable {', '.join(missing)}")
        contacts = tuple(str(name) for name in np.atleast_1d(data["contact"][:]))
        frequency = floats(data["level" if response.frequency_unit == "level" else "frequency"])
        modal = floats(data["modal_amplitude"]) if "modal_amplitude" in data.variables else None
        steady = (
            None if modal is None or "steady_state" not in data.variables else floats(data["steady_state"])
        )
        stable = floats(data["stable"]) if "stable" in data.variables else np.full(frequency.shape, np.nan)
        parts = [floats(data[name]) for name in _PARTS]
        length, force = (str(getattr(data[name], "units", "")) for name in _PARTS[3:])
        energy = floats(data[_ENERGY]) if _ENERGY in data.variables else np.zeros((0, len(contacts)))
        orders = floats(data["harmonic"]) if "harmonic" in data.variables else np.ones(1)
        if not orders.size or orders[0] != 1.0 or not (np.diff(orders) > 0.0).all() or (orders % 1.0).any():
            raise ValueError("its harmonics are not 1 and others above, one after the other")
        states = np.asarray(data["regime"][:]).astype(str) if "regime" in data.variables else None
        motions, amplitude = _motions(data), floats(data["amplitude"])
    dofs = response.own_dofs
    column = greatest_column(dofs, amplitude.reshape(-1, len(dofs)), response.asked)
    shape = (*frequency.shape, len(contacts))
    swept = tuple(curve.parameters for curve in response.curves)
    if states is None:
        states = np.full(shape, "", dtype="<U1")
    return LoopFile(
        path, response.frequency_unit, contacts, swept, frequency, stable, np.stack(parts),
        _greatest(energy, len(contacts)),
        tuple(int(h) for h in orders), states, response.units, (length, force) if length and force else None,
        dofs, amplitude, column, motions, modal, steady,
    )  # fmt: skip


def _motions(data: Any) -> MotionFile | None:
    """Motions of contacts in a plane or in several harmonics; None where there are none."""
    if not all(name in data.variables for name in _MOTION):
        return None
    orders = floats(data["contact_harmonic"])
    if not orders.size or (orders < 1.0).any() or (orders % 1.0).any() or not (np.diff(orders) > 0.0).all():
        raise ValueError("contact_harmonic is not of numbers from 1 on, one after the other")
    names = summary_of(data).get("directions", {})
    law = np.stack([floats(data[name]) for name in _MOTION[4:]])
    mean, amplitude, phase = (floats(data[name]) for name in _MOTION[1:4])
    harmonics = tuple(int(h) for h in orders)
    unstressed = np.zeros((*mean.shape[:1], *mean.shape[2:]))  # for files without contact_start
    start = floats(data["contact_start"]) if "contact_start" in data.variables else unstressed
    return MotionFile(mean, amplitude, phase, harmonics, law, start, names if isinstance(names, dict) else {})


def points_at(
    file: LoopFile,
    curve: int | None,
    contact: str | None,
    place: PlaceOnCurve | None,
    solution: int | None = None,
) -> list[LoopPoint]:
    """The points of a curve nearest to a place.

    Each solution at the place has a point, or only the numbered `solution`; see `solutions_at`. The default
    place is the peak of the scene's output, see `LoopFile.column`; the default contact is the `busiest`.

    Raises
    ------
    PlotError
        If the curve, the contact, the place along the curve or the solution is not in the file.
    """
    row, column = chosen_curve(file.path, curve, len(file.parameters)), _column(file, contact)
    along, unit, amplitude = file.frequency[row], f" {file.unit}", file.loop[3, row, :, column]
    if place is not None and place.modal:
        if file.modal_amplitude is None:
            raise PlotError(f"{file.path}: --amplitude is of nonlinear modes (fcm respond --mode); take --at")
        along, unit = file.modal_amplitude[row], ""
    if not np.isfinite(amplitude).any():
        raise PlotError(
            f"{file.path}: curve {row} holds no loops: no points at all, or exact motions, not harmonic ones"
        )
    if place is None:
        there = np.isfinite(amplitude)
        if file.steady is not None and (held := there & (file.steady[row] != 0.0)).any():
            there = held
        top = int(np.nanargmax(np.where(there, file.amplitude[row, :, file.column], np.nan)))
        found = [Solution(top, 1, 1)]
    else:
        at = on_curve(along, place.value)
        if np.isnan(at):
            ends = f"from {np.nanmin(along):.6g} to {np.nanmax(along):.6g}{unit}"
            raise PlotError(f"{file.path}: curve {row} goes {ends}, not to {place.value:.6g}")
        found = solutions_at(along, at, file.amplitude[row, :, file.column], solution)
    return [_point(file, PointIndex(row, one.point, column), one, place is None) for one in found]


def _point(file: LoopFile, index: PointIndex, solution: Solution, peak: bool) -> LoopPoint:
    row, k, column = index
    n0_bar, b_bar, phi, amplitude, force = file.loop[:, row, k, column].tolist()
    frequency, stable = float(file.frequency[row, k]), float(file.stable[row, k])
    name = file.contacts[column]
    motion = None if file.motions is None else file.motions.at(index, name)
    if not amplitude > 0.0 and not isinstance(motion, NormalPoint):
        raise PlotError(
            f"{file.path}: {name} has no tangential motion at {frequency:.6g} {file.unit}, and so no loop"
            + (f": that is the peak of {file.dofs[file.column]}; choose another by --at" if peak else "")
        )
    if n0_bar == b_bar == 0.0 and not isinstance(motion, NormalPoint):
        raise PlotError(
            f"{file.path}: {name} has no friction, and so no loop, and the file has not its normal motion; "
            "fcm respond -o writes it now"
        )
    return LoopPoint(
        row, file.parameters[row], name, frequency, solution,
        None if np.isnan(stable) else stable != 0.0, n0_bar, b_bar, phi, amplitude, force,
        file.harmonics, str(file.states[index]),
        file.motions is None and len(file.harmonics) > 1, motion,
        file.dofs[file.column], float(file.amplitude[row, k, file.column]), peak,
        None if file.modal_amplitude is None else float(file.modal_amplitude[row, k]),
    )  # fmt: skip


def _greatest(energy: FloatArray, contacts: int) -> FloatArray:
    """Greatest value of each contact over all points; 0 if it is known at none."""
    each = energy.reshape(-1, contacts)
    found: FloatArray = np.nanmax(np.where(np.isfinite(each), each, 0.0), axis=0, initial=0.0)
    return found


def busiest(file: LoopFile) -> tuple[str, str]:
    """The contact whose friction takes most energy in a cycle, and a message on how to choose another.

    Without energies it is the contact that moves most. With one contact or none the message is empty.
    """
    if len(file.contacts) < 2:
        return (file.contacts[0] if file.contacts else ""), ""
    moved = np.nan_to_num(file.loop[3]).max(axis=(0, 1), initial=0.0)
    by_energy = bool(file.energy.any())
    column, *others = np.argsort(-(file.energy if by_energy else moved), kind="stable").tolist()
    why = "takes most energy in a cycle" if by_energy else "moves most"
    named = ", ".join(file.contacts[i] for i in others[: READ.contacts_named])
    more = ", ..." if len(others) > READ.contacts_named else ""
    name, count = file.contacts[column], len(file.contacts)
    return name, f"{name} of {count} contacts {why}; --contact NAME takes another: {named}{more}"


def _names(file: LoopFile) -> str:
    """The contacts for a message; of many, those that take most energy, the greatest first."""
    if len(file.contacts) <= READ.contacts_named:
        return ", ".join(f'"{name}"' for name in file.contacts)
    first = np.argsort(-file.energy, kind="stable")[: READ.contacts_named]
    most = "that take most energy in a cycle" if file.energy.any() else "first in the file"
    names = ", ".join(f'"{file.contacts[i]}"' for i in first.tolist())
    return f"of {len(file.contacts)} those {most}: {names}"


def _column(file: LoopFile, contact: str | None) -> int:
    if not file.contacts:
        raise PlotError(f"{file.path}: its scene has no contact, and so no loop")
    name = busiest(file)[0] if contact is None else contact
    if name not in file.contacts:
        from fcm.scene.errors import quoted

        raise PlotError(f"{file.path}: there is no contact {quoted(name)}; it has {_names(file)}")
    return file.contacts.index(name)
