"""Master degrees of freedom, by which a curve is followed where many are reported.

All displacements are sums over the same modes, and all excitation acts at contacts or forces. So a curve that
is resolved at these, and where each mode moves most, is resolved for all degrees of freedom. The others are
computed afterwards at the points of the curve, and their peaks are located between these points.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from fcm.accuracy.refinement import RefinedResponse, with_errors
from fcm.accuracy.unchecked_response import UncheckedResponse
from fcm.harmonic_balance.reported_quantities import reported_quantities
from fcm.model.scene import FloatArray, Scene
from fcm.response.options import OPTIMUM
from fcm.results.peak import Peak
from fcm.structure.linear import Linear, linear_of
from fcm.structure.ring import RingLinear


def with_master_dofs(scene: Scene) -> Scene:
    """The scene with the master degrees of freedom of its first curve only; itself if there are few."""
    dofs = scene.modal.dofs
    if len(dofs) <= OPTIMUM.max_dofs:
        return scene
    natural, shapes = _modes(linear_of(scene.each_curve()[0]))
    order = np.argsort(natural)
    within = 1 + int(np.count_nonzero(natural <= scene.frequency_range[1]))
    chosen = np.zeros(len(dofs), dtype=np.bool_)
    chosen[np.abs(shapes[order[: min(within, OPTIMUM.max_dofs)]]).argmax(axis=1)] = True
    return scene.at_attached_and(chosen)


def _modes(linear: Linear) -> tuple[FloatArray, FloatArray]:
    """Natural frequencies (mode,) and sizes of shapes (mode, dof) of the modes that are excited."""
    if isinstance(linear, RingLinear):
        wave = linear.wave(1)
        return wave.natural, np.abs(wave.dofs)
    return linear.natural, linear.dofs


def with_all_dofs(found: RefinedResponse, scene: Scene, accuracy: float) -> RefinedResponse:
    """The response at all degrees of freedom of a scene, with errors; found has the master ones."""
    every = with_errors(of_all_dofs(found, scene), accuracy)
    return replace(every, further=found.further, begun=found.begun)


def of_all_dofs(found: UncheckedResponse, scene: Scene) -> UncheckedResponse:
    """The response at all degrees of freedom of a scene, without errors; found has the master ones."""
    system = found.system.with_scene(scene)
    quantities = tuple(reported_quantities(system, path) for path in found.traced.branches.paths)
    return UncheckedResponse(system, found.traced, quantities, found.seconds)


def with_tops(peaks: Mapping[str, Peak], found: RefinedResponse) -> dict[str, Peak]:
    """Replace peaks (by dof) by higher ones located between the points."""
    from fcm.sensitivity.between_points import tops_between

    raised = dict(peaks)
    for path, quantities in zip(found.traced.branches.paths, found.quantities, strict=True):
        height, omega = tops_between(found.system, path, quantities)
        for dof, value, at in zip(peaks, height.tolist(), omega.tolist(), strict=True):
            if value > raised[dof].amplitude:
                raised[dof] = raised[dof]._replace(amplitude=value, frequency=at)
    return raised
