"""Further branches of a traced response: isolated ones, and those through branch points."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

from fcm.branches.branch_points import BranchPoint, branch_points, with_leaving
from fcm.branches.force_level import level_frequencies, solutions_at
from fcm.branches.friction_homotopy import with_friction_raised
from fcm.branches.isolas import folds_to_follow, level_one_crossings
from fcm.branches.mirror_images import symmetric_half
from fcm.branches.options import BRANCHING, LEVEL_CURVE
from fcm.branches.prolongation import prolongated
from fcm.branches.symmetry import broken_symmetries
from fcm.branches.symmetry_in_level import unsymmetric_solutions
from fcm.branches.trace import Traced, branches_through, with_further
from fcm.branches.without_preload import peaks_without_preload
from fcm.continuation import Path
from fcm.continuation.all_branches import contains
from fcm.harmonic_balance.system import System


def with_further_branches(system: System, found: Traced, isolated: bool = True) -> Traced:
    """The branches with isolated ones, those through branch points, and those found by raising friction.

    Branch points are those of the response and of curves of the level. If isolated branches are not wanted,
    `Traced.folds_lost` has the folds from which curves would have been followed.
    """
    every = _with_connected(system, found, isolated)
    raised = with_friction_raised(system, every)
    return every if raised is every else _with_connected(system, raised, isolated)


def _with_connected(system: System, found: Traced, isolated: bool) -> Traced:
    """The branches with those to which the known branches and levels lead."""
    if isolated:
        found = with_isolas(system, with_large_motions(system, found))
    else:
        found = replace(found, folds_lost=folds_to_follow(system, found.found))
    return with_unsymmetric(system, with_branching(system, found))


def with_large_motions(system: System, found: Traced) -> Traced:
    """The branches with those found by the level near peaks without preloads that no branch has."""
    lost = found.not_met(peaks_without_preload(system), system.option(LEVEL_CURVE))
    known = {one.omega for one in found.found}
    further = [omega for omega in level_frequencies(system, lost) if omega not in known] if lost else []
    if not further:
        return found
    more = solutions_at(system, further)
    return with_further(system, found, more, [z for one in more for z in one.solutions])


def with_isolas(system: System, found: Traced) -> Traced:
    """The branches with the isolated ones to which curves of folds lead, and where these curves were lost."""
    met = level_one_crossings(system, found.found, found.branches.paths)
    if met.uncertain != found.folds_lost:
        found = replace(found, folds_lost=met.uncertain)
    return with_further(system, found, (), met.solutions) if met.solutions else found


def with_unsymmetric(system: System, found: Traced) -> Traced:
    """The branches with unsymmetric ones to which curves of the level lead; one of two mirror images.

    The level is followed with a few harmonics. Their branch through a solution is prolongated at many points,
    as it may become several with more harmonics. Solutions that need harmonics that the system lacks, and
    frequencies where the level was not followed to its end, are recorded.
    """
    if system.harmonics[-1] < 2:
        return found
    looked = unsymmetric_solutions(system, found.found, found.branches.paths)
    if looked.unfinished:
        levels = (replace(x, complete=x.complete and x.omega not in looked.unfinished) for x in found.found)
        found = replace(found, found=tuple(levels))
    lost, known = list[tuple[float, tuple[int, ...]]](), list[Path]()
    for one in looked.solutions:
        if not {*one.even} <= {*system.harmonics}:
            lost.append((float(one.z[-1]), one.even))
            continue
        images = (symmetry.image(one.z) for symmetry in broken_symmetries(one.few, one.symmetric, one.z))
        balance = one.few.reset_balance()
        if any(contains(path, z, balance) for z in (one.z, *images) for path in known):
            continue
        branch = branches_through(one.few, [one.z]).paths
        known += branch
        symmetric = one.few.layout.with_harmonics(one.symmetric, one.few.harmonics, system.harmonics)
        for z in prolongated(system, one.few.harmonics, branch):
            found = _with_branches_of(system, found, BranchPoint(symmetric, (z,), z - symmetric))
    return replace(found, symmetry_lost_in_level=tuple(lost)) if lost else found


def with_branching(system: System, found: Traced) -> Traced:
    """The branches with those that leave them at branch points; one of two mirror images."""
    if not system.scene.contacts:
        return found
    return with_leaving(
        found,
        lambda found: found.branches.paths,
        partial(branch_points, system),
        partial(_with_branches_of, system),
        system.option(BRANCHING),
    )


def _with_branches_of(system: System, found: Traced, point: BranchPoint) -> Traced:
    """The branches with those through the starts at a branch point, unless they or their images are known."""
    for z in point.starts:
        images = [symmetry.image(z) for symmetry in broken_symmetries(system, point.z, z)]
        paths, balance = found.branches.paths, system.reset_balance()
        if any(contains(path, one, balance) for path in paths for one in (z, *images)):
            continue
        found = with_further(system, found, (), [z])
        if images and len(found.branches.paths) > len(paths):
            new, balance = found.branches.paths[-1], system.reset_balance()
            if any(contains(new, one, balance) for one in images):
                new = symmetric_half(new)
            branches = replace(found.branches, paths=(*found.branches.paths[:-1], new))
            found = replace(found, branches=branches, mirrored=(*found.mirrored, len(paths)))
    return found
