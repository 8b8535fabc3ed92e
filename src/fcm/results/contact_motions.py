"""The variables in files of motions across contacts, and the names of their directions."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import numpy as np
import numpy.typing as npt

from fcm.model.scene import FloatArray
from fcm.results.padded_arrays import Field, by_point
from fcm.results.result import Curve

DIRECTIONS = ("x", "y", "normal")  # of contacts in a plane
ON_A_LINE = ("tangential", "normal")
LAW = ("mu", "k_u", "k_v", "n_0")


def motions_across(curves: Sequence[Curve]) -> dict[str, Field]:
    """Variables of the motions across contacts; for contacts in a plane also of their friction."""
    known = next(one.across for one in curves if one.across is not None)
    _, contacts, directions, _ = known.motion.shape
    numbers = sorted({h for curve in curves if curve.across is not None for h in curve.harmonics})

    def friction(curve: Curve, i: int) -> FloatArray:
        known = None if curve.across is None else curve.across.friction
        return np.full((curve.frequency.size, contacts), np.nan) if known is None else known[..., i]

    def waves(curve: Curve) -> npt.NDArray[np.complex128]:
        shape = (curve.frequency.size, contacts, directions, len(numbers))
        found = np.full(shape, np.nan, dtype=np.complex128)
        if curve.across is not None:
            found[..., [numbers.index(h) for h in curve.harmonics]] = 1j * curve.across.motion[..., 1:]
        return found

    def means(curve: Curve) -> FloatArray:
        nothing = np.full((curve.frequency.size, contacts, directions), np.nan)
        return nothing if curve.across is None else curve.across.motion[..., 0].real

    each = [known if one.across is None else one.across for one in curves]
    law, start = np.array([one.law for one in each]), np.array([one.start for one in each])
    at, of = ("curve", "point", "contact"), ("curve", "point", "contact", "direction", "contact_harmonic")
    about = "amplitude of the fundamental of the friction force along the {} direction of a contact"
    sine = "as contact_amplitude * sin(harmonic omega t + contact_phase)"
    names = DIRECTIONS if directions == len(DIRECTIONS) else ON_A_LINE
    in_plane = {
        name: Field(at, by_point(curves, partial(friction, i=i)), {"long_name": about.format(which)})
        for i, (name, which) in enumerate((("friction_x", "first"), ("friction_y", "second")))
        if known.friction is not None
    }
    return {
        "direction": Field(("direction",), np.array(names), {"long_name": "direction of a contact"}),
        "contact_harmonic": Field(("contact_harmonic",), np.array(numbers), {"long_name": "harmonic"}),
        **in_plane,
        "contact_mean": Field(
            of[:4],
            by_point(curves, means),
            {"long_name": "mean displacement across the contact"},
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
        "contact_start": Field(
            ("curve", "contact", "direction"),
            start,
            {"long_name": "displacement across the contact at which it starts unstressed"},
        ),
        **{
            f"contact_{name}": Field(
                ("curve", "contact"), law[..., i], {"long_name": f"{name} of the contact"}
            )
            for i, name in enumerate(LAW)
        },
    }


def csv_columns(contacts: Sequence[str], planar: Sequence[str], force: str) -> list[str]:
    """Headers of the columns of `csv_values`, with the unit of force."""
    unit = f" [{force}]" if force else ""
    return [f"friction_{axis} {contact}{unit}" for contact in contacts if contact in planar for axis in "xy"]


def csv_values(curve: Curve, point: int, which: Sequence[int]) -> list[str]:
    """Friction amplitudes of some contacts at a point, as text for CSV."""
    if curve.across is None or curve.across.friction is None:
        return ["nan"] * (2 * len(which))
    return [repr(float(value)) for value in curve.across.friction[point, list(which)].ravel()]
