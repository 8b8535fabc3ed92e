"""The level of the forces followed with the exact motion, and what it passes."""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest

from fcm import load_scene
from fcm.branches.force_level import level_frequencies
from fcm.continuation import Status, follow
from fcm.harmonic_balance.system import System as Balanced
from fcm.harmonic_balance.work_budget import WorkLimitError
from fcm.shooting import OrbitProblem
from fcm.shooting.force_level import ForceLevelShooting, LevelMotions, level_motions, level_motions_at
from fcm.shooting.options import SHOOTING
from fcm.shooting.periodic_orbit import never_interrupt
from fcm.shooting.residual import Shooting
from fcm.shooting.work_budget import BranchBudget
from fcm.time_domain import State, simulate

from ..response.random_scenes import random_scene
from ..time_domain.cases import three_harmonics, two_contacts, yang


def at_level(scene, level):
    """The scene with all its harmonic forces times a level."""
    return replace(scene, forces=tuple(replace(one, amplitude=level * one.amplitude) for one in scene.forces))


@pytest.mark.parametrize(
    ("scene", "omega"), [(yang(), 1.3), (yang(0.0), 1.1), (two_contacts(), 1.7), (three_harmonics(), 0.9)]
)
def test_the_derivative_by_the_level_is_that_of_differences_of_the_forces(scene, omega):
    """Away from where the period closes, from a motion that slips."""
    x, level, step = (
        ForceLevelShooting(scene, omega).shooting.unknowns(simulate(scene, omega, 20).end),
        0.9,
        1e-6,
    )
    shot = Shooting(scene).residual(x, omega, level, by_level=True)
    gaps = [Shooting(at_level(scene, level + h)).residual(x, omega).closure for h in (0.0, step, -step)]
    assert shot.closure == pytest.approx(gaps[0], abs=1e-13 * np.abs(x).max())
    quotient = (gaps[1] - gaps[2]) / (2.0 * step)
    assert shot.by_parameter / shot.scale == pytest.approx(quotient / shot.scale, abs=1e-7)
    assert np.abs(quotient / shot.scale).max() > 0.1


def unbounded(poll=never_interrupt):
    return BranchBudget(poll, np.inf)


def test_every_passing_of_the_level_1_is_a_motion():
    """Ten modes, hardly damped, above a contact: simulated, each of the three repeats after a period."""
    scene, omega = random_scene(3), 2.1490306
    found = level_motions_at(scene, Balanced(scene, (1,)), omega, (), unbounded())
    m, free = scene.modal.mass.size, OrbitProblem(scene).free
    starts = np.zeros((len(found.motions), 2 * m + 1))
    starts[:, free] = [z[:-1] for z in found.motions]
    ends = [simulate(scene, omega, 1, State(x[:m], x[m : 2 * m], x[2 * m :])).end.q for x in starts]
    assert found.complete and len(starts) == 3
    assert np.array(ends) == pytest.approx(starts[:, :m], abs=1e-9 * np.abs(starts).max())
    assert min(np.abs(a - b).max() for a, b in combinations(starts, 2)) > 1e-3 * np.abs(starts).max()


def test_what_a_level_passed_is_kept_when_its_time_is_over():
    scene, omega = random_scene(3), 2.1490306
    one, looks = Balanced(scene, (1,)), []
    whole = level_motions_at(scene, one, omega, (), unbounded(lambda: looks.append(0)))
    left = iter(looks[: -len(looks) // 4])

    def poll():
        if next(left, None) is None:
            raise WorkLimitError

    part = level_motions_at(scene, one, omega, (), unbounded(poll))
    assert part.out_of_time and not part.complete and 0 < len(part.motions) <= len(whole.motions)
    for z in part.motions:
        assert min(np.abs(z - other).max() for other in whole.motions) < 1e-9 * np.abs(z).max()


def test_where_the_level_from_rest_stalls_it_is_followed_from_what_is_known():
    """Once is enough from rest: other steps end there, too."""
    scene, omega, begun = load_scene("yang1998-n5"), 1.22, []
    one = Balanced(scene, (1,))
    whole = level_motions_at(scene, one, omega, (), unbounded())

    def stalls(problem, start, *rest, **options):
        begun.append(start[-1])
        path = follow(problem, start, *rest, **options)
        return replace(path, z=path.z[:2], status=Status.STALLED) if start[-1] == begun[0] else path

    found = level_motions_at(scene, one, omega, whole.motions[:1], unbounded(), along=stalls)
    assert not found.complete and begun.count(begun[0]) == 1 and begun[0] != 1.0
    assert len(whole.motions) == 3
    for z in whole.motions:
        assert min(np.abs(z - other).max() for other in found.motions) < 1e-9 * np.abs(z).max()


def test_levels_have_equal_shares_of_the_time_and_what_others_leave():
    """Of 22 s for each level the first takes 30, the others 5: it is begun, given up, and followed to its
    end."""
    scene, now, came = random_scene(3), [0.0], []
    frequencies = level_frequencies(Balanced(scene, (1,)))
    count = len(frequencies)

    def at(scene, one, omega, known, bounded):
        begin, end = now[0], now[0] + (30.0 if omega == frequencies[0] else 5.0)
        while now[0] < end:
            now[0] += 0.5
            try:
                bounded.poll()
            except WorkLimitError:
                came.append((omega, now[0] - begin))
                return LevelMotions(omega, (), False, out_of_time=True)
        came.append((omega, now[0] - begin))
        return LevelMotions(omega, (), True)

    options = replace(SHOOTING, search=replace(SHOOTING.search, poll_interval=-1.0))
    limited = BranchBudget(never_interrupt, 22.0 * count, options, lambda: now[0])
    found = list(limited.each(level_motions(scene, lambda omega: (), limited, at)))
    others = [(omega, 5.0) for omega in frequencies[1:]]
    assert count > 2 and came == [(frequencies[0], 22.5), *others, (frequencies[0], 30.0)]
    assert found[-1].complete and not limited.given_up
    assert [one.omega for one in found] == [*frequencies, frequencies[0]]
