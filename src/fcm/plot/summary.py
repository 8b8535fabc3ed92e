"""The summary that a response file carries, for what its variables do not have."""

from __future__ import annotations

import json
from typing import Any


def summary_of(data: Any) -> dict[str, Any]:
    """The summary that a response file has as JSON; empty without one. ValueError of another thing."""
    found = json.loads(str(getattr(data, "summary", "{}")))
    if not isinstance(found, dict):
        raise ValueError("its attribute summary is not of a response")
    return found


def jumps_of(data: Any) -> list[list[tuple[str, float]]]:
    """The jumps of each curve: the way of the sweep, and the frequency. ValueError of another thing."""
    try:
        return [
            [(str(one["sweep"]), float(one["frequency"])) for one in curve.get("jumps", ())]
            for curve in summary_of(data).get("curves", ())
        ]
    except (AttributeError, KeyError, TypeError):
        raise ValueError("its attribute summary has curves that are not of a response") from None
