r"""Sensitivities: derivatives of the height and frequency of peaks by the numbers of a scene.

Let R(z, p) = 0 be the balance, with the unknowns and the frequency in z, and t the tangent of the curve. A
change of a number p moves a solution by w, with R_z w = -R_p and t . w = 0, and by alpha t along the curve.
The peak of an amplitude A has A_z . t = 0. So the derivative of its height is A_p + A_z . w, exact from the
Jacobian. At the peak the slope c = A_z . t / |t| stays 0, so that alpha = -c_p / c_s. These two derivatives
are differences of c between solutions at p +- delta, and at s +- delta along the curve.

A peak can be at a corner of the curve, where a margin of the problem is 0. The corner is then located at
several values of the number around p, and the derivatives are differences of fourth order. They hold as long
as the peak stays at the corner.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from fcm.frozen import Frozen
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray, Scene
from fcm.quoting import quoted
from fcm.scene.address import Addresses
from fcm.scene.draft import Draft, Number, number_of
from fcm.sensitivity.options import SENSITIVITY, SensitivityOptions
from fcm.sensitivity.parameter_derivatives import rates_of
from fcm.sensitivity.peak import PeakKind, PeakSolution, Unknown, moved_by


class Sensitivities(Frozen):
    """Derivatives of the peaks of one curve by numbers; NaN where they are unknown."""

    numbers: tuple[str, ...]  # key paths
    values: FloatArray  # (number,)
    height: FloatArray  # (dof, number) derivative of the peak's height
    frequency: FloatArray  # (dof, number) and of its frequency [rad/s]
    kind: tuple[PeakKind, ...]  # (dof,)
    why: tuple[Unknown, ...]  # (dof,) reason if the derivatives by all numbers are unknown
    why_by_number: tuple[tuple[Unknown, ...], ...]  # (dof, number) reason for peaks of a known kind


def numbers_of(scene: Scene) -> list[Number]:
    """The numbers of a scene for which derivatives are computed: of contacts, forces, base, loads and modes.

    Numbers of contacts of one group change together. The scene is that of one curve, see `unswept`.
    """
    assert scene.draft is not None
    parts = scene.draft.parts
    contacts = [draft.get("group") or draft["name"] or str(i) for i, draft in enumerate(parts["contact"])]
    load = {
        name: "gap" if "gap" in draft else "n_0"
        for name, draft in zip(contacts, parts["contact"], strict=True)
    }
    keys = [f"contact.{name}.{key}" for name in load for key in ("mu", "k_u", "k_v", load[name])]
    forces, bases = _names(parts["force"]), len(parts["base"])
    keys += [f"force.{name}.amplitude" for name in forces]
    phases = ["base.phase"] * bases + [f"force.{name}.phase" for name in forces]
    keys += phases if len(phases) > 1 else []  # a single phase only shifts the time
    keys += ["base.acceleration"] * bases + [f"load.{name}.force" for name in _names(parts["load"])]
    own = scene.modal.mass.size - scene.modal.added  # without those for the flexibility of omitted modes
    keys += [f"modal.{key}.{i}" for key in ("frequency", "damping") for i in range(own)]
    known = Addresses(parts)
    return [number_of(scene, key) for key in keys if known.numbers.get(key) or key.startswith("contact.")]


def _names(drafts: Sequence[Mapping[str, Any]]) -> list[str]:
    """Names of forces or loads in key paths; the index replaces a name that is not unique."""
    names = [draft["name"] for draft in drafts]
    return [name if name and names.count(name) == 1 else str(i) for i, name in enumerate(names)]


def unswept(scene: Scene) -> Scene:
    """The scene of one curve without a sweep: the curve's swept values are written into its draft."""
    draft = scene.draft
    if not isinstance(draft, Draft):
        raise ValueError(f"the scene {quoted(scene.name)} was not read from a file or a dict")
    return replace(scene, draft=draft.fixed(scene), parameters={})


def sensitivities(
    scene: Scene,
    harmonics: tuple[int, ...],
    peaks: Sequence[tuple[int, FloatArray, bool]],
    dofs: int,
    options: SensitivityOptions = SENSITIVITY,
) -> Sensitivities:
    """Derivatives of peaks by every number of a scene, which is that of one curve.

    Parameters
    ----------
    peaks : sequence of (dof, z, edge)
        The index of the degree of freedom, a point (unknown + 1,) at or very near its peak, and whether the
        peak is at an end of the range.
    dofs : int
        Number of degrees of freedom.
    options : SensitivityOptions, optional
        Steps and tolerances.
    """
    scene = unswept(scene)
    system = System(scene, harmonics)
    points = [PeakSolution(system, d, z, edge, options) for d, z, edge in peaks]
    numbers = numbers_of(scene)
    height, frequency = (np.full((dofs, len(numbers)), np.nan) for _ in range(2))
    why_by_number = [[Unknown.NOTHING] * len(numbers) for _ in range(dofs)]
    for k, number in enumerate(numbers):
        try:
            rates = rates_of(system, number.key, options)
        except ValueError:  # the number changes the rigid-body motions
            for point in points:
                why_by_number[point.dof][k] = Unknown.RIGID
            continue
        moved = moved_by(scene, number, harmonics, options)
        for point in points:
            found = height[point.dof, k], frequency[point.dof, k] = point.derivatives(rates, moved)
            if not np.isfinite(found).all():
                why_by_number[point.dof][k] = Unknown.LOST
    kind, why = [PeakKind.UNKNOWN] * dofs, [Unknown.AT_REST] * dofs
    for point in points:
        kind[point.dof], why[point.dof] = point.kind, point.why
        if point.kind is PeakKind.UNKNOWN:
            why_by_number[point.dof] = [Unknown.NOTHING] * len(numbers)
    values = np.array([number.value(scene) for number in numbers])
    keys = tuple(number.key for number in numbers)
    return Sensitivities(
        keys, values, height, frequency, tuple(kind), tuple(why), tuple(map(tuple, why_by_number))
    )
