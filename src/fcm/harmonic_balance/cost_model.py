"""Cost model: what a balance of more harmonics would take, so that too much is said and not begun.

It is in seconds of a core on which numpy's sine takes 10 ns a number. It follows from the size of the
balance, not from a clock, so that the same scene has the same answer on every machine.
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
    """Estimated seconds of evaluations of the balance with a number of harmonics, each solved for a step.

    A condensed matrix (see `modal_condensation`) is formed first, by 2 multiplications a mode and entry.
    """
    layout = layout_of(len(system.scene.contacts), system.scene.directions_of_contact, harmonics)
    rank = condensed_size(system, layout.ports, harmonics)
    return evaluations * _evaluation(layout, rank, system.options.cost)


def _evaluation(layout: Layout, rank: int, cost: EvaluationCost) -> float:
    """Seconds of one evaluation, solved by a condensed system of a rank, or as it is where that is 0."""
    contacts, width, unknowns, harmonics = layout.contacts, layout.width, layout.unknowns, layout.harmonics
    solved = rank or unknowns
    cubes = float(solved) ** 3 + 6.0 * rank / (1 + 2 * harmonics) * unknowns * rank
    of_contacts, of_entries = contacts * (1 + harmonics), unknowns * (solved + width)
    return cost.cycle * of_contacts + cost.entry * of_entries + cost.system * cubes


class CurveCost(Frozen):
    """Cost of the curves of a scene, measured with 50 to 200 contacts and one harmonic.

    evaluations: least number of evaluations of a curve; the cost of one is `each`. evaluations_per_point:
    evaluations of each point that the longest step leads to, which replace these if they are more. overhead:
    seconds for each evaluation, contact and coefficient of its motion, for levels, stability and errors.
    high_frequency: frequency relative to the highest of the harmonics, above which few modes can stand for
    all.
    """

    evaluations: float = 1500.0
    evaluations_per_point: float = 7.0
    overhead: float = 2.5e-5
    high_frequency: float = 2.0
    each: EvaluationCost = HARMONIC_BALANCE.cost


CURVE_COST = CurveCost()


def seconds_of_curve(scene: Scene, harmonics: int, cost: CurveCost = CURVE_COST) -> float:
    """Estimated seconds for a curve of a scene, from its sizes alone.

    Many contacts are taken as condensed to all modes where these are fewer than half their directions; modes
    far above the harmonics are not counted.

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
    """Estimated seconds for following curves of a system with a number of harmonics.

    evaluations are those that its own took: they grow as the harmonics do, with the corners and folds.
    """
    return seconds_of(system, evaluations, harmonics) * harmonics / max(len(system.harmonics), 1)


def with_twice_as_many(system: System, evaluations: int) -> System | None:
    """A system with the harmonics up to twice the highest and one more, for what is followed again with more
    and more of them; None where none are left, or that takes too long.

    evaluations: what following it with its own harmonics took.
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
    """The path that follow returns; the work it takes is added to that of the system as it goes on.

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
