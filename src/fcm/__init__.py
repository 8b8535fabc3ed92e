"""Friction contacts with variable normal load: closed-form hysteresis, tables, response curves.

The names below are imported when first used, so that a command pays only for what it needs.
"""

from __future__ import annotations

TYPE_CHECKING = False  # typing alone would take as long as all the rest
if TYPE_CHECKING:
    from typing import Any

    from fcm.contact import (
        fourier_coefficients,
        fourier_gradients,
        hysteresis_loop,
        normal_coefficients,
        normal_gradients,
        periodic_forces,
        periodic_gradients,
        periodic_loop,
    )
    from fcm.response import respond
    from fcm.scene import load_scene
    from fcm.table import open_table

__version__ = "0.1.0"

_HOME = {
    "fourier_coefficients": "fcm.contact",
    "fourier_gradients": "fcm.contact",
    "hysteresis_loop": "fcm.contact",
    "load_scene": "fcm.scene",
    "normal_coefficients": "fcm.contact",
    "normal_gradients": "fcm.contact",
    "open_table": "fcm.table",
    "periodic_forces": "fcm.contact",
    "periodic_gradients": "fcm.contact",
    "periodic_loop": "fcm.contact",
    "respond": "fcm.response",
}

__all__ = [
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
    "respond",
]


def __getattr__(name: str) -> Any:
    if name in _HOME:
        from importlib import import_module

        return getattr(import_module(_HOME[name]), name)
    raise AttributeError(f"module 'fcm' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted([*__all__, "__version__"])
