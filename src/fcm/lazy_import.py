"""Imports the modules of a package at the first use of their names, so that commands start fast."""

from __future__ import annotations

TYPE_CHECKING = False  # importing typing would take as long as everything else
if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from typing import Any


def on_demand(package: str, homes: Mapping[str, str]) -> Callable[[str], Any]:
    """The ``__getattr__`` of a package; `homes` maps each name to the module that defines it."""

    def imported(name: str) -> Any:
        if name not in homes:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        from importlib import (
            import_module,
        )  # imported here because it takes half of the time of a bare import

        return getattr(import_module(f"{package}.{homes[name]}"), name)

    return imported
