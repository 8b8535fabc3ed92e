"""Exact curves of a scene over a range of its frequencies."""

from dataclasses import replace

import numpy as np

from fcm.response.exact import trace_exact
from fcm.response.options import RESPONSE
from fcm.run import Execution

from ..response.random_scenes import random_scene


def between(scene, low, high, **changes):
    return replace(scene, frequency_range=(low, high), **changes)


def within(seconds, options=RESPONSE):
    """Options with so much processor time for a curve."""
    return replace(options, exact=replace(options.exact, max_seconds=seconds))


def curve_of(scene, at=None, only=None, periods=1, options=RESPONSE, **execution):
    response = trace_exact(scene, at, Execution(**execution), only=only, periods=periods, options=options)
    (curve,) = response.curves
    return curve


def light():
    """Nine modes, hardly damped, and three contacts, of which the third sticks."""
    scene = random_scene(8)
    return replace(scene, modal=replace(scene.modal, damping=np.full(scene.modal.mass.size, 1e-4)))
