"""Results at the reported degrees of freedom only, and a check of static loads."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from fcm.harmonic_balance.static_equilibrium import RIGID_BODY_FAULT, loads_move_rigid_body
from fcm.harmonic_balance.system import System
from fcm.model.scene import Scene
from fcm.response.request import ResponseError
from fcm.results.result import Curve, Response

POINTS = ("amplitude", "fundamental", "phase", "mean", "error")  # of curves, arrays over the dofs
ORBITS = ("cycle_least", "cycle_greatest", "family_least", "family_greatest")
CYCLES = ("displacement", "amplitude", "mean", "greatest", "least")  # of histories


def check_solvable(scene: Scene) -> None:
    """Raise ResponseError for a scene that no method can solve: static loads that nothing holds."""
    if any(curve.loads and _loads_move_rigid_body(curve) for curve in scene.each_curve()):
        raise ResponseError(f"{scene.name}: load: {RIGID_BODY_FAULT}")


def _loads_move_rigid_body(curve: Scene) -> bool:
    system = System(curve)
    return loads_move_rigid_body(system.linear, system.springs(stuck=True))


def visible(response: Response, scene: Scene) -> Response:
    """The response at only those degrees of freedom that the scene reports."""
    shown = np.array([scene.reports(dof) for dof in response.dofs])
    if shown.all():
        return response
    dofs = tuple(name for name, one in zip(response.dofs, shown, strict=True) if one)
    curves = [_curve(curve, shown, dofs) for curve in response.curves]
    histories = response.histories
    if histories is not None:
        records = [_record(one, shown) for one in histories.records]
        modal = histories.scene.modal.at(shown)
        histories = replace(histories, records=records, scene=replace(histories.scene, modal=modal))
    tracking = response.tracking
    if tracking is not None:
        tracking = replace(tracking, curves=[_at(one, ("amplitude",), shown) for one in tracking.curves])
    return replace(response, dofs=dofs, curves=curves, histories=histories, tracking=tracking)


def _curve(curve: Curve, shown: Any, dofs: tuple[str, ...]) -> Curve:
    orbits = None if curve.orbits is None else _at(curve.orbits, ORBITS, shown)
    if orbits is not None and orbits.swept is not None:
        orbits = replace(orbits, swept=orbits.swept.at(shown))
    names = (*POINTS, *(["error_at_frequency"] if curve.error_at_frequency is not None else []))
    found: Curve = _at(curve, names, shown)
    harmonic = None if curve.harmonic is None else curve.harmonic[..., shown]
    if (by := curve.sensitivity) is not None:
        kinds = tuple(kind for kind, one in zip(by.kind, shown, strict=True) if one)
        by = replace(by, height=by.height[shown], frequency=by.frequency[shown], kind=kinds)
    peaks = {name: curve.peaks[name] for name in dofs}
    extract = None if curve.extract is None else curve.extract.at(shown)
    return replace(found, peaks=peaks, orbits=orbits, harmonic=harmonic, extract=extract, sensitivity=by)


def _record(record: Any, shown: Any) -> Any:
    phases = [_at(one, ("amplitude", "mean"), shown) for one in record.phases]
    return replace(_at(record, CYCLES, shown), phases=phases)


def _at(one: Any, names: tuple[str, ...], shown: Any) -> Any:
    return replace(one, **{name: getattr(one, name)[..., shown] for name in names})
