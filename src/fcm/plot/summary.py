"""The summary in a response file, which holds data that its variables lack."""

from __future__ import annotations

import json
from typing import Any


def summary_of(data: Any) -> dict[str, Any]:
    """The JSON summary of a response file, empty without one; ValueError if it is no dictionary."""
    found = json.loads(str(getattr(data, "summary", "{}")))
    if not isinstance(found, dict):
        raise ValueError("its attribute summary is not of a response")
    return found


def jumps_of(data: Any) -> list[list[tuple[str, float]]]:
    """The jumps of each curve: direction of the sweep and frequency; ValueError if the summary has others."""
    try:
        return [
            [(str(one["sweep"]), float(one["frequency"])) for one in curve.get("jumps", ())]
            for curve in summary_of(data).get("curves", ())
        ]
    except (AttributeError, KeyError, TypeError):
        raise ValueError("its attribute summary has curves that are not of a response") from None
