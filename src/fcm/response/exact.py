"""Response of exact periodic solutions for every curve of a scene: traced, or visited by sweeps."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from fcm.frozen import Frozen
from fcm.model.scene import Scene
from fcm.reduction.constant_state_contacts import on_contacts
from fcm.reduction.mode_effect import effect, expected_effect
from fcm.reduction.negligible_parts import leave_out_modes
from fcm.reduction.sentences import on_modes
from fcm.response.coexisting_orbits import CoexistingOrbits
from fcm.response.coexisting_search import FOUND
from fcm.response.curve_batches import CurveBatches
from fcm.response.exact_curve import ExactCurveTask
from fcm.response.options import INPUT_LIMITS, RESPONSE, ResponseOptions
from fcm.response.request import ResponseError
from fcm.response.resumable_branches import SAVED_KINDS
from fcm.response.ring_limits import refuse_in_time
from fcm.response.stepped_sweep import STATES
from fcm.results.at_rest import without_rounding
from fcm.results.result import Response
from fcm.run import IN_THIS_PROCESS, Execution, Progress, fingerprint
from fcm.units import UNIT

METHOD = "exact"
ONLY_PEAKS = (
    "all points of the exact curves but the greatest peak of each degree of freedom, folds and jumps. Lower "
    "peaks are left out, too"
)


def trace_exact(
    scene: Scene,
    at: Sequence[float] | None = None,
    execution: Execution = IN_THIS_PROCESS,
    *,
    only: str | None = None,
    periods: int = 1,
    options: ResponseOptions = RESPONSE,
) -> Response:
    """Compute the curves of exact periodic solutions of a scene, in the layout of `fcm.response.trace`.

    Every point is a periodic orbit of the exact equations of motion, found by shooting: no harmonic is left
    out, no table is used. `amplitude` is half the peak-to-peak displacement, `phase` that of the fundamental.
    `regime` has the states over the cycle, and `stable` follows from the Floquet multipliers. `orbits` has
    the rest.

    Parameters
    ----------
    scene : Scene
        From `fcm.load_scene`; one curve for each combination of its swept values.
    at : sequence of float, optional
        Frequencies in the scene's unit. An upward and then a downward sweep visit the steady motion there,
        each point continued from the last. Then other stable motions are sought from the solutions of the
        balance. Without `at` the curve is followed through its range.
    execution : Execution, optional
        As in `fcm.response.trace`.
    only : {"peaks"}, optional
        Compute only peaks, folds and jumps, near those of the harmonic balance.
    periods : {1, 2, 4, 8}
        Follow also motions that repeat only after up to this number of periods of the force, from the period
        doublings on. It has no effect with `at`: there the sweeps find such motions.
    options : ResponseOptions, optional
        Tolerances and limits: `exact` of the curves, `shooting` of the motions (with `at` the default ones),
        and in `reduction` the greatest change of the amplitudes by modes that are left out.

    Raises
    ------
    ResponseError
        If a frequency cannot be visited.

    Examples
    --------
    >>> import fcm
    >>> response = trace_exact(fcm.load_scene("yang1998-n5"))
    >>> [round(fold, 6) for fold in response.curves[0].folds]
    [1.239829, 1.193559]
    """
    refuse_in_time(scene, "the exact motion")
    begin, frequencies = time.perf_counter(), _checked(scene, at)
    tolerance = options.reduction.tolerance
    with execution.checkpoint() as checkpoint:
        task = ExactCurveTask(
            frequencies, only is not None, tolerance is None, periods, options.shooting, options.exact
        )
        run = _SweepRun(task, CurveBatches(execution.processes, checkpoint, execution.place))
        response = run.response(scene, tolerance, execution.progress)
        if not response.interrupted:
            execution.discard(checkpoint)
    response.defects = run.sweep.defects
    response.seconds = time.perf_counter() - begin
    return response


class _SweepRun(Frozen):
    """The sweeps of a run; a second one has all modes, if they turn out to be needed."""

    task: ExactCurveTask
    sweep: CurveBatches

    def response(self, scene: Scene, tolerance: float | None, progress: Progress | None) -> Response:
        """Compute the response without the modes that its curves do not need."""
        scenes = scene.each_curve()
        if tolerance is None:
            return self._swept(scene, scenes, progress)  # for comparisons, which leave out modes themselves
        lighter = leave_out_modes(scenes, tolerance, self.task.options.max_harmonic)
        if lighter.above is not None and 2.0 * expected_effect(lighter) > tolerance:
            lighter = leave_out_modes(scenes, 0.0, self.task.options.max_harmonic)
        response, said = self._swept(scene, lighter.curves, progress), list(lighter.sentences)
        if lighter.above is not None and not response.interrupted:
            change = effect(response, lighter)
            if 2.0 * change <= tolerance:
                said.append(on_modes(lighter, change))
            else:
                response = self._swept(scene, lighter.exact, progress)
        said += on_contacts(response.curves, scenes[0].contacts)
        response.left_out = [*said, *([ONLY_PEAKS] if self.task.only_peaks else [])]
        response.curves = [without_rounding(one) for one in response.curves]
        return response

    def _swept(self, scene: Scene, scenes: Sequence[Scene], progress: Progress | None) -> Response:
        mark = fingerprint(METHOD, replace(self.task, options=replace(self.task.options, max_seconds=None)))
        batches = [(one,) for one in scenes]
        curves = self.sweep.curves(
            self.task, batches, mark, progress, (*STATES, CoexistingOrbits, *SAVED_KINDS, *FOUND)
        )
        return Response.of(scene, curves, METHOD)


def _checked(scene: Scene, at: Sequence[float] | None) -> tuple[float, ...] | None:
    """The frequencies to visit [rad/s], checked and in ascending order; None if a curve is traced."""
    if at is None and not scene.has_range:
        raise ResponseError("the scene has no [response] with frequency = [from, to], so no curve to trace")
    if at is None:
        return None
    frequencies = np.unique(np.asarray(at, dtype=np.float64).ravel())
    wrong = frequencies[~(np.isfinite(frequencies) & (frequencies > 0.0))]
    if frequencies.size == 0 or wrong.size:
        what = f"{wrong[0]:g} is none" if wrong.size else "none is given"
        raise ResponseError(f"frequencies to visit must be positive numbers; {what}")
    highest = _highest(scene) / UNIT[scene.frequency_unit]
    if highest > 0.0 and frequencies[-1] > INPUT_LIMITS.max_frequency_ratio * highest:
        raise ResponseError(
            f"a frequency to visit of {frequencies[-1]:g} {scene.frequency_unit} is a mistake of units. The "
            f"scene has no natural frequency above {highest:.2g}, and the greatest visited is "
            f"{INPUT_LIMITS.max_frequency_ratio:g} times that"
        )
    return tuple((frequencies * UNIT[scene.frequency_unit]).tolist())


def _highest(scene: Scene) -> float:
    """Upper bound [rad/s] of the natural frequencies in all curves, with any contacts stuck."""
    highest = 0.0
    for one in scene.each_curve():
        modal, square = one.modal, float((one.modal.frequency**2).max(initial=0.0))
        for contact in one.contacts:
            for k, row in ((contact.k_u, contact.tangential), (contact.k_v, contact.normal)):
                square += k * float(((modal.shapes @ row) ** 2 / modal.mass).sum())
        highest = max(highest, square**0.5)
    return highest
