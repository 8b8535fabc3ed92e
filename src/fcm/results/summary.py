"""A response as the summary that ``fcm respond --json`` prints: peaks, folds, errors, scatter, optima."""

from __future__ import annotations

from typing import Any

import numpy as np

from fcm.results.contact_motions import DIRECTIONS
from fcm.results.result import Response
from fcm.results.scatter import scatter, summary_of
from fcm.units import in_unit


def summary(response: Response) -> dict[str, Any]:
    """Output of ``fcm respond --json``; NaN becomes None."""
    data = {
        "curves": [curve.summary(response.frequency_unit, response.contacts) for curve in response.curves],
        "method": response.method,
        "exact_motion": response.in_time.value,
        "frequency_unit": response.frequency_unit,
        "left_out": response.left_out,
        "without_stability": response.without_stability,
        "notes": response.notes,
        "units": dict(zip(("length", "force"), response.units, strict=True)),
        "seconds": response.seconds,
    }
    if response.span is not None:
        data["range"] = in_unit(np.array(response.span), response.frequency_unit).tolist()
    if response.output:
        data["output"] = list(response.output)
    if response.directions:
        data["directions"] = {
            name: dict(zip(DIRECTIONS, along, strict=True)) for name, along in response.directions.items()
        }
    if response.curves and (found := scatter(response)):
        unit = response.frequency_unit
        data["scatter"] = [summary_of(one, response.dofs, unit) for one in found]
    if response.curves and response.blades is not None:
        from fcm.results.blades import add_to_summary

        add_to_summary(response, data)
    if response.histories is not None:
        from fcm.time_domain import history_output

        data["histories"] = history_output.summary(response.histories)
    if response.tracking is not None:
        unit = response.frequency_unit
        data["tracked"] = response.tracking.summary(unit, response.dofs)
        if response.tracking.optima:
            data["optimum"] = [one.summary(unit) for one in response.tracking.optima]
    if response.fitted is not None:
        data["fitted"] = response.fitted.summary()
    return without_nan(data)  # type: ignore[no-any-return]


def without_nan(value: Any) -> Any:
    """The value with every number that is not finite replaced by None, for JSON."""
    if isinstance(value, dict):
        return {key: without_nan(item) for key, item in value.items()}
    if isinstance(value, list):
        return [without_nan(item) for item in value]
    return None if isinstance(value, float) and not np.isfinite(value) else value
