"""Meanings of the variables of a response file: names, texts and units."""

from __future__ import annotations

import re
from collections.abc import Iterable

_OVER_FRICTION = (
    "over the residual friction of contacts that never slip: of a stable point that of stable motions"
)
ORBIT_KINDS = ("cycle_least", "cycle_greatest", "family_least", "family_greatest")
LOOP: tuple[tuple[str, str, dict[str, str]], ...] = (  # of Curve.loop: name, meaning, units
    ("n0_bar", "mu (n_0 + k_v mean v) / (k_u a) of the loop", {"units": "1"}),
    ("b_bar", "mu k_v b / (k_u a) of the loop", {"units": "1"}),
    ("phi", "phase of the normal motion before the tangential, of the loop", {"units": "radian"}),
    (
        "tangential_amplitude",
        "amplitude a of the tangential motion across the contact; in a plane its half-axis",
        {},
    ),
    ("spring_force", "k_u a, by which the loop's forces are divided", {}),
)

CYCLE = (  # of Curve.cycle
    ("greatest_normal_force", "greatest normal force of the cycle"),
    ("greatest_friction_force", "greatest friction force of the cycle"),
    ("slip_path", "way of the slider in slip, in a cycle"),
    ("dissipated_energy", "energy that friction takes in a cycle"),
)
CYCLE_ERROR = "estimated error of {}, relative; inf where it is 0 and with more harmonics is not"

EXACT = {  # meanings that differ for curves of exact periodic solutions
    "regime": "states of the contact over the exact cycle: E stick, P, N positive and negative slip, "
    "S separation",
    "table_error": "0: no table was used",
    "truncation_error": "0: no harmonic was left out",
    "stable": "1 where small disturbances die out: no Floquet multiplier of a period beyond the unit circle; "
    "nan where repeats is 0",
}
ORBITS: dict[str, tuple[tuple[str, ...], dict[str, str]]] = {  # variables of such curves only
    "closure_error": (
        (),
        {"long_name": "by which a period fails to close, relative to the motion", "units": "1"},
    ),
    "repeats": (
        (),
        {
            "long_name": "periods of the force after which the motion repeats, up to 8; 0 if it is "
            "quasi-periodic, irregular or of more",
            "units": "1",
        },
    ),
    "cycle_least": (("dof",), {"long_name": "least half the peak-to-peak of a cycle that was looked at"}),
    "cycle_greatest": (
        ("dof",),
        {"long_name": "greatest half the peak-to-peak of a cycle that was looked at"},
    ),
    "family_least": (("dof",), {"long_name": f"least amplitude {_OVER_FRICTION}"}),
    "family_greatest": (("dof",), {"long_name": f"greatest amplitude {_OVER_FRICTION}"}),
    "family_complete": (
        (),
        {
            "long_name": "1 where family_least and family_greatest are of all residual friction, 0 where "
            "some was not reached",
            "units": "1",
        },
    ),
    "sweep": ((), {"long_name": "direction of the sweep that came to the point, if one did: up or down"}),
}

LENGTHS = (
    "amplitude", "mean", "fundamental", "peak_amplitude", "tangential_amplitude", "displacement",
    "cycle_amplitude", "cycle_mean", "cycle_greatest", "cycle_least", "family_greatest", "family_least",
    "harmonic_amplitude", "contact_amplitude", "contact_mean", "contact_start", "slip_path",
    "peak_slip_path",
    "peak_percentile", "peak_percentile_low", "peak_percentile_high", "tracked_amplitude", "optimum_peak",
    "contact_position",
)  # fmt: skip
FORCES = (
    "spring_force", "greatest_normal_force", "greatest_friction_force", "peak_greatest_normal_force",
    "peak_greatest_friction_force", "friction_x", "friction_y", "contact_n_0",
    "contact_force_mean", "contact_force_amplitude",
)  # fmt: skip
ENERGIES = ("dissipated_energy", "peak_dissipated_energy")


_KEPT = re.compile(r"[A-Za-z][A-Za-z0-9_.+@-]*")  # netCDF's own rule, before it admitted other characters
_OTHER = re.compile(r"[^A-Za-z0-9_.+@-]")


def variable_names(keys: Iterable[str]) -> dict[str, str]:
    """A distinct name for each key that is valid in netCDF, in CF, and in a list separated by blanks.

    A key that is such a name is unchanged. Otherwise each invalid character becomes an underscore, a number
    distinguishes equal names, and a letter begins the name; the key itself then belongs in an attribute.

    >>> variable_names(["contact.left shroud.n_0", "contact.left_shroud.n_0", "1/x"])
    {'contact.left shroud.n_0': 'contact.left_shroud.n_0_2', 'contact.left_shroud.n_0': \
'contact.left_shroud.n_0', '1/x': 'n_1_x'}
    """
    keys = list(keys)
    taken = {key for key in keys if _KEPT.fullmatch(key)}
    names = {}
    for key in keys:
        if key not in taken:
            name = first = _begun_with_letter(_OTHER.sub("_", key))
            number = 1
            while name in taken:
                number += 1
                name = f"{first}_{number}"
            taken.add(name)
            names[key] = name
    return {key: names.get(key, key) for key in keys}


def _begun_with_letter(name: str) -> str:
    return name if name[:1].isalpha() else f"n_{name}"
