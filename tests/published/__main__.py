"""Tables of cases that others have published, beside what fcm obtains: those of the guide.

usage: python -m tests.published
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

import fcm

from . import test_den_hartog, test_rubber, test_two_masses


def rubber() -> Iterator[str]:
    """The first mode of RubBeR, while it is stuck."""
    mode = test_rubber.the_mode()
    frequency = mode.omega / (2.0 * np.pi)
    tip = np.abs(mode.displacements()[0][0, 0] @ test_rubber.reduced()[2]) / mode.amplitude[0]
    yield "| RubBeR | published | fcm |"
    yield "| --- | ---: | ---: |"
    yield f"| frequency while stuck [Hz] | {test_rubber.STUCK:.9f} | {frequency[0]:.9f} |"
    yield f"| mass-normalised shape at the tip | {test_rubber.TIP:.8f} | {tip:.8f} |"


def den_hartog() -> Iterator[str]:
    """Closed forms with and without stops, and exact motions on a stiff contact."""
    yield "| frequency | stops | closed form | exact motion |"
    yield "| ---: | --- | ---: | ---: |"
    for r in (0.48, 0.5, 0.6, 0.7, 0.8):
        stops = r < 0.52
        rigid = test_den_hartog.with_stops(r)[0] if stops else test_den_hartog.without_stops(r)
        found = test_den_hartog.exact(1e4, r)
        yield f"| {r:.2f} | {'two' if stops else 'none'} | {rigid:.5f} | {found:.5f} |"


def two_masses() -> Iterator[str]:
    """Amplitudes of both masses, marched with rigid friction and exact."""
    yield "| frequency | first, marched | first, exact | last, marched | last, exact |"
    yield "| ---: | ---: | ---: | ---: | ---: |"
    for omega in (0.4, 0.68, 1.2):
        marched, _ = test_two_masses.marched(omega, test_two_masses.STEPS)
        found = fcm.respond(test_two_masses.scene(omega), "exact", at=[omega]).amplitude.values.reshape(-1, 2)
        exact = found[np.isfinite(found).all(axis=1)][0]
        pairs = " | ".join(f"{a:.4g} | {b:.4g}" for a, b in zip(marched, exact, strict=True))
        yield f"| {omega:.2f} | {pairs} |"


if __name__ == "__main__":
    for table in (rubber, den_hartog, two_masses):
        print("\n".join(table()), end="\n\n")
