"""Random scenes of the kinds of which branches were missed, each from a seed."""

import numpy as np

from fcm.scene import scene_from_dict

FORCE = [{"dof": "x0", "amplitude": 1.0}]


def harmonic_meets_resonance(seed):
    """An oscillator against one stop, with a preload or a gap: the second or third harmonic of the forces
    meets its resonance with the stop closed."""
    rng = np.random.default_rng(seed)
    order = 2 + seed % 2
    at = rng.uniform(1.2, 1.8)  # the frequency at which it does
    k_v = (order * at) ** 2 - 1.0
    n_0 = rng.uniform(0.5, 3.0) if seed % 4 < 2 else -rng.uniform(0.2, 2.0)
    modal = {
        "dofs": ["x0"],
        "frequency": [1.0],
        "damping": [float(rng.uniform(0.02, 0.05))],
        "shapes": [[1.0]],
    }
    stop = {"name": "stop", "tangential": "x0", "normal": "x0", "mu": 0.0, "k_u": 1.0}
    stop |= {"k_v": float(k_v), "n_0": float(n_0)}
    return _scene(modal, [stop], (0.4, 3.0))


def equal_stops(seed):
    """Two modes between two equal stops with friction."""
    rng = np.random.default_rng(1000 + seed)
    modal = {
        "dofs": ["x0", "x1"],
        "frequency": [1.0, float(rng.uniform(1.5, 3.5))],
        "damping": rng.uniform(0.01, 0.04, 2).tolist(),
        "shapes": rng.uniform(0.4, 1.4, (2, 2)).tolist(),
    }
    modal["shapes"][0][1] *= -1.0
    k = float(rng.uniform(2.0, 8.0))
    law = {"tangential": "x1", "mu": float(rng.uniform(0.05, 0.3)), "k_u": k, "k_v": k}
    law["n_0"] = -float(rng.uniform(0.1, 1.0))
    stops = [{"name": "upper", "normal": "x0"} | law, {"name": "lower", "normal": {"x0": -1.0}} | law]
    return _scene(modal, stops, (0.6, 2.0))


def _scene(modal, contacts, span):
    given = {"modal": modal, "contact": contacts, "force": FORCE, "response": {"frequency": list(span)}}
    return scene_from_dict(given).each_curve()[0]


KINDS = {"meets": harmonic_meets_resonance, "stops": equal_stops}
EACH = 40
