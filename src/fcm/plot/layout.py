"""Layout of the variables of a result file; a file with another layout is refused at reading."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

_CURVE, _POINT, _CYCLE, _PHASE = ("curve",), ("curve", "point"), ("cycle",), ("schedule_phase",)
_DOF, _CONTACT, _PEAK = (*_POINT, "dof"), (*_POINT, "contact"), ("curve", "dof")
_WORST = ("curve", "sector_dof")
_TRACKED, _OF_CYCLE = ("track", "tracked"), ("curve", "cycle", "dof")
_LAYOUT = {
    "dof": ("dof",),
    "contact": ("contact",),
    "harmonic": ("harmonic",),
    "number": ("number",),
    **dict.fromkeys(("frequency", "level", "stable", "table_error", "truncation_error", "sweep"), _POINT),
    **dict.fromkeys(("modal_amplitude", "damping_ratio", "resonant_level", "steady_state"), _POINT),
    "force_level": ("force_level",),
    **dict.fromkeys(("amplitude", "fundamental"), _DOF),
    **dict.fromkeys(("regime", "n0_bar", "b_bar", "phi", "tangential_amplitude", "spring_force"), _CONTACT),
    **dict.fromkeys(("dissipated_energy", "slip_path", "greatest_normal_force"), _CONTACT),
    "contact_position": ("contact", "axis"),
    "contact_harmonic": ("contact_harmonic",),
    "contact_mean": (*_CONTACT, "direction"),
    "contact_start": ("curve", "contact", "direction"),
    **dict.fromkeys(("contact_amplitude", "contact_phase"), (*_CONTACT, "direction", "contact_harmonic")),
    **dict.fromkeys(("contact_mu", "contact_k_u", "contact_k_v", "contact_n_0"), ("curve", "contact")),
    **dict.fromkeys(
        ("peak_amplitude", "peak_frequency", "peak_stable", "peak_error", "peak_at_end", "peak_kind"), _PEAK
    ),
    "complete": _CURVE,
    **dict.fromkeys(("sensitivity", "frequency_sensitivity"), (*_PEAK, "number")),
    "number_value": ("curve", "number"),
    **dict.fromkeys(("time", "cycles"), ("instant",)),
    **dict.fromkeys(("cycle_start", "cycle_elapsed", "cycle_part"), _CYCLE),
    **dict.fromkeys(("schedule_frequency", "schedule_cycles", "schedule_start"), _PHASE),
    "displacement": ("curve", "instant", "dof"),
    **dict.fromkeys(("cycle_mean", "cycle_greatest", "cycle_least"), _OF_CYCLE),
    **dict.fromkeys(("data_frequency", "data_displacement", "data_level"), ("data", "measured")),
    **dict.fromkeys(("data_amplitude", "data_phase"), ("data", "measured")),
    **dict.fromkeys(("data_modal_amplitude", "data_damping"), ("data", "measured")),
    **dict.fromkeys(("data_dof", "data_quantity"), ("data",)),
    "track_what": ("track",),
    "tracked_amplitude": (*_TRACKED, "dof"),
    **dict.fromkeys(
        ("tracked_number", "tracked_frequency", "tracked_turn", "tracked_trough", "tracked_stable"), _TRACKED
    ),
    "optimum_number": ("optimum", "varied"),
    **dict.fromkeys(("optimum_peak", "optimum_higher_peak", "optimum_kind"), ("optimum",)),
    **dict.fromkeys(("optimum_frequency", "optimum_stable"), ("optimum", "equal")),
    "sector_dof": ("sector_dof",),
    "stiffness_factor": ("curve", "sector"),
    "envelope": (*_POINT, "sector_dof"),
    **dict.fromkeys(("worst_amplitude", "worst_frequency", "worst_sector"), _WORST),
    **dict.fromkeys(("tuned_amplitude", "tuned_frequency", "amplification"), _WORST),
    **dict.fromkeys(("worst_at_end", "tuned_at_end"), _WORST),
}
_TEXTS = {
    "dof",
    "contact",
    "number",
    "regime",
    "sweep",
    "peak_kind",
    "track_what",
    "optimum_kind",
    "data_dof",
    "data_quantity",
    "sector_dof",
}


def check_layout(variables: Any, names: Iterable[str]) -> None:
    """Raise ValueError if a variable that is there has other dimensions or another kind (text, numbers)."""
    for name in names:
        if name not in variables:
            continue
        found, kind = variables[name].dimensions, variables[name].dtype
        if found != _LAYOUT[name]:
            raise ValueError(f"{name} is by {_by(found)}, not by {_by(_LAYOUT[name])}")
        if is_text(kind) != (name in _TEXTS):
            raise ValueError(f"{name} holds {'text' if is_text(kind) else 'numbers'}")


def is_text(kind: Any) -> bool:
    """Whether a variable of this type holds no numbers."""
    return kind is str or getattr(kind, "kind", "O") not in "biuf"


def _by(dimensions: Iterable[str]) -> str:
    return "(" + ", ".join(dimensions) + ")"
