"""Friction contacts with variable normal load: closed-form hysteresis, tables, response curves.

The names below are imported at their first use, so that a command imports only what it needs.
"""

from __future__ import annotations

from fcm.lazy_import import on_demand

TYPE_CHECKING = False  # importing typing would take as long as everything else
if TYPE_CHECKING:
    from fcm.contact import (
        fourier_coefficients,
        fourier_gradients,
        hysteresis_loop,
        normal_coefficients,
        normal_gradients,
        periodic_forces,
        periodic_gradients,
        periodic_loop,
        planar_forces,
        planar_gradients,
        planar_loop,
    )
    from fcm.contact.contact_law import ContactLaw
    from fcm.continuation import Problem, follow
    from fcm.response import respond
    from fcm.scene import load_scene
    from fcm.table import open_table

__version__ = "0.1.0"

_HOME = {
    "ContactLaw": "contact",
    "Problem": "continuation",
    "follow": "continuation",
    "fourier_coefficients": "contact",
    "fourier_gradients": "contact",
    "hysteresis_loop": "contact",
    "load_scene": "scene",
    "normal_coefficients": "contact",
    "normal_gradients": "contact",
    "open_table": "table",
    "periodic_forces": "contact",
    "periodic_gradients": "contact",
    "periodic_loop": "contact",
    "planar_forces": "contact",
    "planar_gradients": "contact",
    "planar_loop": "contact",
    "respond": "response",
}

__all__ = [
    "ContactLaw",
    "Problem",
    "follow",
    "fourier_coefficients",
    "fourier_gradients",
    "hysteresis_loop",
    "load_scene",
    "normal_coefficients",
    "normal_gradients",
    "open_table",
    "periodic_forces",
    "periodic_gradients",
    "periodic_loop",
    "planar_forces",
    "planar_gradients",
    "planar_loop",
    "respond",
]


__getattr__ = on_demand(__name__, _HOME)


def __dir__() -> list[str]:
    return sorted([*__all__, "__version__"])
