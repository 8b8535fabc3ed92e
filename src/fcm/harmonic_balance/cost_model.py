"""Cost model: estimated time of a balance with more harmonics, so that too long a run is not begun.

The unit is a second of a core on which numpy's sine takes 10 ns a number. The estimate depends on the size of
the balance and on no clock, so that a scene has the same estimate on every machine.
"""

from __future__ import annotations

from collections.abc import Callable

from fcm.continuation import Path, PathInterrupted
from fcm.continuation.follow import Progress
from fcm.continuation.step_control import Stepper
from fcm.frozen import Frozen
from fcm.harmonic_balance.modal_condensation import CONDENSATION, condensed_size
from fcm.harmonic_balance.options import HARMONIC_BALANCE, EvaluationCost
from fcm.harmonic_balance.system import System
from fcm.model.scene import Scene
from fcm.scene.options import LIMITS
from fcm.scene.rules import harmonics_up_to
from fcm.structure.layout import Layout, layout_of


def seconds_of(system: System, evaluations: int, harmonics: int) -> float:
    """Estimated seconds of evaluations with a number of harmonics, each followed by a Newton step.

    Forming a condensed matrix (see `modal_condensation`) takes 2 multiplications per mode and entry.
    """
    layout = layout_of(len(system.scene.contacts), system.scene.directions_of_contact, harmonics)
    rank = condensed_size(system, layout.ports, harmonics)
    return evaluations * _evaluation(layout, rank, system.options.cost)


def _evaluation(layout: Layout, rank: int, cost: EvaluationCost) -> float:
    """Seconds of one evaluation and solution, by a condensed system of a rank; rank 0 is not condensed."""
    contacts, width, unknowns, harmonics = layout.contacts, layout.width, layout.unknowns, layout.harmonics
    solved = rank or unknowns
    cubes = float(solved) ** 3 + 6.0 * rank / (1 + 2 * harmonics) * unknowns * rank
    of_contacts, of_entries = contacts * (1 + harmonics), unknowns * (solved + width)
    return cost.cycle * of_contacts + cost.entry * of_entries + cost.system * cubes


class CurveCost(Frozen):
    """Cost of the curves of a scene, measured with 50 to 200 contacts and one harmonic.

    evaluations: least number of evaluations of a curve. evaluations_per_point: evaluations per point if all
    steps have the greatest length; the greater of the two estimates counts. each: cost of an evaluation.
    overhead: seconds for each evaluation, contact and coefficient of its motion, for levels, stability and
    errors. high_frequency: frequency relative to the highest harmonic, above which modes are not counted.
    """

    evaluations: float = 1500.0
    evaluations_per_point: float = 7.0
    overhead: float = 2.5e-5
    high_frequency: float = 2.0
    each: EvaluationCost = HARMONIC_BALANCE.cost


CURVE_COST = CurveCost()


def seconds_of_curve(scene: Scene, harmonics: int, cost: CurveCost = CURVE_COST) -> float:
    """Estimated seconds for a curve of a scene, from its sizes alone.

    Many contacts count as condensed to the modes if these are few compared with the contacts' directions.
    Modes far above the harmonics are not counted.

    >>> from fcm import load_scene
    >>> f"{seconds_of_curve(load_scene('yang1998'), 1):.1f}"
    '0.1'
    """
    layout = layout_of(len(scene.contacts), scene.directions_of_contact, harmonics)
    highest = cost.high_frequency * harmonics * scene.frequency_range[1]
    modes, many = int((scene.modal.frequency <= highest).sum()), layout.unknowns >= CONDENSATION.min_unknowns
    few = many and scene.ring is None and modes < CONDENSATION.max_fraction * layout.ports
    each = _evaluation(layout, modes * (1 + 2 * harmonics) if few else 0, cost.each)
    further = cost.overhead * layout.contacts * (1 + harmonics)
    return max(cost.evaluations, cost.evaluations_per_point / scene.max_step) * (each + further)


def seconds_with(system: System, evaluations: int, harmonics: int) -> float:
    """Estimated seconds for following the curves of a system with another number of harmonics.

    evaluations is the number with the system's own harmonics. It grows in proportion to the harmonics, since
    corners and folds do.
    """
    return seconds_of(system, evaluations, harmonics) * harmonics / max(len(system.harmonics), 1)


def with_twice_as_many(system: System, evaluations: int) -> System | None:
    """The system with all harmonics up to 2 H + 1, where H is the highest; for curves followed repeatedly.

    None if there are no further harmonics, or if it would take too long. evaluations: number with the
    system's own harmonics.
    """
    highest = system.harmonics[-1]
    more = min(2 * highest + 1, LIMITS.harmonics)
    most = system.options.work.max_seconds_repeated
    if more == highest or seconds_with(system, evaluations, more) > most:
        return None
    return system.with_harmonics(harmonics_up_to(more))


def charged_to_work(
    system: System, stepper: Stepper, progress: Progress | None, follow: Callable[[Progress], Path]
) -> Path:
    """Return the path of follow, and add its work to that of the system while it runs.

    follow is called with the progress to report to.
    """
    known, each = 0, seconds_of(system, 1, len(system.harmonics))

    def add(evaluations: int) -> None:
        nonlocal known
        new, known = evaluations - known, evaluations
        system.work.add(new * each)

    def report(share: float) -> None:
        add(stepper.newton.evaluations)
        if progress is not None:
            progress(share)

    with system.exclusive_balance():
        stepper.newton.poll = system.work.poll
        try:
            path = follow(report)
        finally:
            stepper.newton.poll = None
    try:
        add(path.evaluations)
    except KeyboardInterrupt:
        raise PathInterrupted(path) from None
    return path
