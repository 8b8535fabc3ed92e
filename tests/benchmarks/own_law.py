"""What a contact law in Python costs beside those of fcm: python -m tests.benchmarks.own_law [HARMONICS]

Curves of ``yang1998-n5`` with its own contact, with the law that stands in the guide, and with the slider of
fcm written as a loop over the instants of a cycle. Processor time, scaled to where np.sin takes 10 ns.
"""

from __future__ import annotations

import doctest
import sys

import numpy as np

import fcm
from fcm.contact import ContactLaw
from fcm.model.scene import Scene

from ..guide.pages import GUIDE, read
from ..harmonic_balance.test_contact_law import Friction
from .unit import SINE, seconds, sine

HARMONICS = 3
SCENE, CONTACT = "yang1998-n5", "shroud"


def of_the_guide() -> ContactLaw:
    """The law of the guide's page on laws: arrays over the whole cycle."""
    names: dict[str, object] = {}
    for example in doctest.DocTestParser().get_examples(read(GUIDE / "howto/extend.md")):
        exec(example.source, names)
        if isinstance(law := names.get("law"), ContactLaw):
            return law
    raise ValueError("the guide has no law")


def main(harmonics: int) -> None:
    own = fcm.load_scene(SCENE)
    joint = next(one for one in own.contacts if one.name == CONTACT)
    looped = Friction(joint.mu, joint.k_u, joint.k_v, joint.n_0)
    laws = {"of fcm": None, "arrays of a cycle": of_the_guide(), "a loop over the instants": looped}
    print(
        f"\n{SCENE}, {harmonics} harmonics\n{'':28s}{'points':>8s}{'ms scaled':>12s}{'times the first':>18s}"
    )
    first = 0.0
    for name, law in laws.items():
        scene = own if law is None else own.with_laws({CONTACT: law})
        points, taken = 0, 0.0

        def run(scene: Scene = scene) -> None:
            nonlocal points
            found = fcm.respond(scene, method="closed-form", harmonics=harmonics)
            points = int(np.isfinite(found.frequency.values).sum())

        if law is None:
            run()  # the first run imports
        taken = seconds(run) / points * 1e-6 * SINE / sine()
        first = first or taken
        print(f"  {name:26s}{points:8d}{1e3 * taken:12.2f}{taken / first:18.0f}")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else HARMONICS)
