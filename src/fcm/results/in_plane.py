"""The variables of contacts that slide in a plane in files, and the names of their directions."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from fcm.model.scene import FloatArray
from fcm.results.field import Field
from fcm.results.padded_arrays import by_point
from fcm.results.result import Curve

DIRECTIONS = ("x", "y", "normal")
LAW = ("mu", "k_u", "k_v", "n_0")


def plane_fields(curves: Sequence[Curve]) -> dict[str, Field]:
    """Variables of the contacts in a plane."""
    known = next(one.in_plane for one in curves if one.in_plane is not None)
    contacts = known.motion.shape[1]
    numbers = sorted({h for curve in curves for h in curve.harmonics})

    def friction(curve: Curve, i: int) -> FloatArray:
        nothing = np.full((curve.frequency.size, contacts), np.nan)
        return nothing if curve.in_plane is None else curve.in_plane.friction[..., i]

    def waves(curve: Curve) -> npt.NDArray[np.complex128]:
        found = np.full((curve.frequency.size, contacts, 3, len(numbers)), np.nan, dtype=np.complex128)
        if curve.in_plane is not None:
            found[..., [numbers.index(h) for h in curve.harmonics]] = 1j * curve.in_plane.motion[..., 1:]
        return found

    def means(curve: Curve) -> FloatArray:
        nothing = np.full((curve.frequency.size, contacts, 3), np.nan)
        return nothing if curve.in_plane is None else curve.in_plane.motion[..., 0].real

    law = np.array([known.law if one.in_plane is None else one.in_plane.law for one in curves])
    at, of = ("curve", "point", "contact"), ("curve", "point", "contact", "direction", "contact_harmonic")
    about = "amplitude of the fundamental of the friction force along the {} direction of a contact"
    sine = "as contact_amplitude * sin(harmonic omega t + contact_phase)"
    return {
        "direction": Field(("direction",), np.array(DIRECTIONS), {"long_name": "direction of a contact"}),
        "contact_harmonic": Field(("contact_harmonic",), np.array(numbers), {"long_name": "harmonic"}),
        "friction_x": Field(
            at, by_point(curves, lambda c: friction(c, 0)), {"long_name": about.format("first")}
        ),
        "friction_y": Field(
            at, by_point(curves, lambda c: friction(c, 1)), {"long_name": about.format("second")}
        ),
        "contact_mean": Field(
            of[:4], by_point(curves, means), {"long_name": "mean displacement across the contact"}
        ),
        "contact_amplitude": Field(
            of,
            by_point(curves, lambda c: np.abs(waves(c))),
            {"long_name": "amplitude of the displacement across the contact, of each harmonic"},
        ),
        "contact_phase": Field(
            of,
            by_point(curves, lambda c: np.angle(waves(c))),
            {"long_name": f"its phase, {sine}", "units": "radian"},
        ),
        **{
            f"contact_{name}": Field(
                ("curve", "contact"), law[..., i], {"long_name": f"{name} of the contact"}
            )
            for i, name in enumerate(LAW)
        },
    }


def csv_columns(contacts: Sequence[str], planar: Sequence[str], units: tuple[str, str]) -> list[str]:
    """Heads of the columns of `csv_values`."""
    length, force = units
    work = f" [{force} {length}]" if length and force else ""
    of_force, of_length = (f" [{unit}]" if unit else "" for unit in (force, length))
    return [
        f"{name} {contact}{unit}"
        for contact in contacts
        if contact in planar
        for name, unit in (
            ("friction_x", of_force), ("friction_y", of_force), ("slip_path", of_length),
            ("dissipated_energy", work),
        )
    ]  # fmt: skip


def csv_values(curve: Curve, point: int, which: Sequence[int]) -> list[str]:
    """Of a point the amplitudes of friction, way of the slip and energy of some contacts."""
    if curve.in_plane is None:
        return ["nan"] * (4 * len(which))
    found: list[Any] = []
    for i in which:
        found += [*curve.in_plane.friction[point, i].tolist(), *curve.cycle[point, i, 2:].tolist()]
    return [repr(float(value)) for value in found]
