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
