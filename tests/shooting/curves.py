"""Exact curves of a scene over a range of its frequencies."""

from dataclasses import replace

import numpy as np

from fcm.response.exact import trace_exact

from ..response.random_scenes import random_scene


def between(scene, low, high, **changes):
    return replace(scene, frequency_range=(low, high), **changes)


def curve_of(scene, **options):
    (curve,) = trace_exact(scene, **options).curves
    return curve


def light():
    """Nine modes, hardly damped, and three contacts, of which the third sticks."""
    scene = random_scene(8)
    return replace(scene, modal=replace(scene.modal, damping=np.full(scene.modal.mass.size, 1e-4)))
