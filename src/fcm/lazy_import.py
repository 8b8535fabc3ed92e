"""Names of a package whose modules are imported when one is first used: a command pays for what it needs."""

from __future__ import annotations

TYPE_CHECKING = False  # typing alone would take as long as all the rest
if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from typing import Any


def on_demand(package: str, homes: Mapping[str, str]) -> Callable[[str], Any]:
    """The ``__getattr__`` of a package; `homes` says in which of its modules each name stands."""

    def imported(name: str) -> Any:
        if name not in homes:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        from importlib import (
            import_module,
        )  # not before it is needed: it is half of the time of a bare import

        return getattr(import_module(f"{package}.{homes[name]}"), name)

    return imported
