"""How often the stated intervals hold the true numbers: fits to noisy data made by the model itself.

usage: python -m tests.fit.coverage [DRAWS] [relative|constant]
"""

import sys

import numpy as np

from fcm.fit.estimate import estimated
from fcm.fit.options import FIT
from fcm.fit.parameters import parameters_of
from fcm.fit.solve import solved
from fcm.model.scene import Measured
from fcm.scene.load import scene_from_dict

TRUE = {"contact.shroud.mu": 0.4, "contact.shroud.k_u": 1.0, "modal.damping.0": 0.01}
NOISE = 0.01
LEVELS, POINTS = (0.5, 2.0), 25


def scene(mu=0.4, k_u=1.0, damping=0.01, level=1.0):
    """An oscillator with one contact whose normal load varies."""
    return scene_from_dict(
        {
            "modal": {"dofs": ["u", "v"], "frequency": [1.0, 10.0], "damping": [damping, 0.01],
                      "shapes": [[1.0, 0.0], [0.2, 1.0]]},
            "contact": [{"name": "shroud", "tangential": "u", "normal": "v", "mu": mu, "k_u": k_u, "k_v": 1.0,
                         "n_0": 5.0}],
            "force": [{"dof": "u", "amplitude": level}],
            "response": {"frequency": [0.8, 1.8], "harmonics": 1},
        }
    )  # fmt: skip


def curves():
    """Frequency and amplitude of the true response at each level."""
    from fcm.response import trace

    found = []
    for level in LEVELS:
        curve = trace(scene(level=level), method="closed-form").curves[0]
        known = np.flatnonzero(np.isfinite(curve.frequency))
        chosen = known[np.unique(np.linspace(0, known.size - 1, POINTS).astype(int))]
        found.append((level, curve.frequency[chosen], curve.amplitude[chosen, 0]))
    return found


def noisy(rng, kind="relative"):
    """The same as measured points whose amplitudes err."""
    data = []
    for level, frequency, amplitude in curves():
        size = amplitude if kind == "relative" else amplitude.max()
        off = amplitude + NOISE * size * rng.standard_normal(amplitude.size)
        ones = np.ones(frequency.size)
        data.append(Measured("made", "u", frequency, off, ones, level * ones))
    return data


def main(draws=100, kind="relative"):
    """Print how many of the intervals hold the true number."""
    truth = np.array(list(TRUE.values()))
    held = np.zeros(truth.size, dtype=int)
    parameters = parameters_of(scene(0.35, 1.1, 0.012), list(TRUE), [None] * truth.size)
    for draw in range(draws):
        data = noisy(np.random.default_rng(draw), kind)
        found = solved(parameters, data, (1,), begin=parameters.start)
        told = estimated(parameters, found.values, found.rows)
        held += (told.interval[:, 0] <= truth) & (truth <= told.interval[:, 1])
        print(f"\r{draw + 1}: {held.tolist()}", end="", file=sys.stderr, flush=True)
    print(file=sys.stderr)
    for key, count in zip(TRUE, held.tolist(), strict=True):
        print(f"{key}: {count} of {draws} intervals of {100 * FIT.confidence:g} % hold {TRUE[key]:g}")


if __name__ == "__main__":
    main(*([int(sys.argv[1])] if len(sys.argv) > 1 else []), *sys.argv[2:])
