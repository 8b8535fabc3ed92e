"""Exact curves of a scene over a range of its frequencies."""

from dataclasses import replace

from fcm.response.exact import trace_exact


def between(scene, low, high, **changes):
    return replace(scene, frequency_range=(low, high), **changes)


def curve_of(scene, **options):
    (curve,) = trace_exact(scene, **options).curves
    return curve
