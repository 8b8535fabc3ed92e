"""Branches of the exact motion that are closed where the balance leads from an end of the range to them."""

from __future__ import annotations

from collections.abc import Iterator

from fcm.motion.state import State
from fcm.orbit.harmonic import MANY, computed_state
from fcm.orbit.periodic import Look
from fcm.scene.model import Scene

SOME = (1, 2, 3, 4, 5)  # harmonics: with three a closed branch may be as far off as another one is
Place = tuple[float, State]  # frequency [rad/s], and a guess there


def states_along(scene: Scene, look: Look) -> Iterator[list[Place]]:
    """Guesses beside each top of each branch of the balance, the nearest to the top first."""
    from fcm.harmonic.beside import around, tops
    from fcm.harmonic.choice import outlined
    from fcm.harmonic.system import System as Balanced

    whole = scene.whole()
    harmonics = SOME if len(whole.contacts) < MANY else SOME[:1]
    balanced = Balanced(whole, harmonics)
    balanced.work.look = look
    found = outlined(balanced)
    for path, shown in zip(found.traced.branches.paths, found.shown, strict=True):
        for top, even in tops(path, shown.amplitude):
            places = around(even, top)
            yield [(float(path.z[i, -1]), computed_state(scene, harmonics, path.z[i])) for i in places]
