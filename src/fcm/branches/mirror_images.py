"""Branches that are mirror images of others, or of themselves: one of two images is kept."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from fcm.branches.branch_points import sign_changes
from fcm.branches.symmetry import broken_symmetries, is_symmetric
from fcm.continuation import Path, Status
from fcm.continuation.all_branches import contains
from fcm.harmonic_balance.system import System


def without_images(system: System, paths: Sequence[Path]) -> tuple[tuple[Path, ...], tuple[int, ...]]:
    """The paths without mirror images of others, and with only half of a path that is its own image.

    Also returns the numbers of the paths whose images are left out.
    """
    several = paths if len(paths) > 1 else ()
    symmetric = next((path for path in several if is_symmetric(system, path)), None)
    if symmetric is None:
        return tuple(paths), ()
    middle, kept, mirrored = symmetric.z[len(symmetric.z) // 2], list[Path](), set[int]()
    for path in paths:
        z = path.z[len(path.z) // 2]
        images = [one.image(z) for one in broken_symmetries(system, middle, z)]
        balance = system.reset_balance()
        same = (k for k, one in enumerate(kept) if any(contains(one, z, balance) for z in images))
        if (known := next(same, None)) is not None:
            mirrored.add(known)
            continue
        if any(contains(path, z, balance) for z in images):
            mirrored.add(len(kept))
            path = symmetric_half(path)
        kept.append(path)
    return tuple(kept), tuple(sorted(mirrored))


def symmetric_half(path: Path) -> Path:
    """Half of a path that is its own mirror image, cut at branch points; all of another path.

    A closed path is cut at its two branch points, an open one at the middle one of an odd number.
    """
    changes = sign_changes(path.orientation)
    if path.status is Status.CLOSED and len(changes) == 2:
        half = slice(changes[0], changes[1] + 2)
    elif path.status is Status.COMPLETE and len(changes) % 2:
        half = slice(0, changes[len(changes) // 2] + 2)
    else:
        return path
    return replace(
        path,
        z=path.z[half],
        direction=path.direction[half],
        mark=path.mark[half],
        orientation=path.orientation[half],
        status=Status.COMPLETE,
    )
