"""Rows of contacts on structures with smooth modes, for tests of many contacts."""

import numpy as np
import scipy.linalg

from fcm.scene import scene_from_dict


def strip(contacts=12, kept=(1.0, 1.6, 2.7), stiff=(14.0, 40.0, 90.0), n_0=1.2):
    """Smooth shapes on a row of contacts; the modes of high frequency hardly yield beside them."""
    x = (np.arange(contacts) + 0.5) / contacts
    frequency = [*kept, *stiff]
    shapes = [
        np.ravel((np.cos(np.pi * i * x), np.sin(np.pi * (i + 0.5) * x)), "F") for i in range(len(frequency))
    ]
    dofs = [f"x{i}" for i in range(2 * contacts)]
    return scene_from_dict(
        {
            "modal": {
                "dofs": dofs,
                "frequency": frequency,
                "damping": [0.02] * len(frequency),
                "shapes": [shape.tolist() for shape in shapes],
            },
            "contact": [
                {
                    "name": f"c{i}",
                    "tangential": dofs[2 * i],
                    "normal": dofs[2 * i + 1],
                    "mu": 0.4,
                    "k_u": 1.5 / contacts,
                    "k_v": 2.0 / contacts,
                    "n_0": n_0 / contacts,
                }
                for i in range(contacts)
            ],
            "force": [{"dof": "x0", "amplitude": 1.2}, {"dof": "x1", "amplitude": 0.4}],
            "response": {"frequency": [0.9, 1.5]},
        }
    )


def planar_strip(contacts=12, n_0=1.2, frequency=(0.9, 1.5)):
    """As `strip`, with contacts that slide across the row, too."""
    x = (np.arange(contacts) + 0.5) / contacts
    natural = [1.0, 1.2, 1.6, 2.7, 14.0, 40.0]
    shapes = [
        np.ravel(
            (np.cos(np.pi * i * x), 0.7 * np.cos(np.pi * (i + 1) * x), np.sin(np.pi * (i + 0.5) * x)), "F"
        )
        for i in range(len(natural))
    ]
    dofs = [f"{way}{i}" for i in range(contacts) for way in "xyv"]
    law = {"mu": 0.4, "k_u": 1.5 / contacts, "k_v": 2.0 / contacts, "n_0": n_0 / contacts}
    return scene_from_dict(
        {
            "modal": {
                "dofs": dofs,
                "frequency": natural,
                "damping": [0.02] * len(natural),
                "shapes": [shape.tolist() for shape in shapes],
            },
            "contact": [
                {"name": f"c{i}", "tangential": [f"x{i}", f"y{i}"], "normal": f"v{i}", **law}
                for i in range(contacts)
            ],
            "force": [
                {"dof": "x0", "amplitude": 1.2},
                {"dof": "y0", "amplitude": 0.8, "phase": 1.0},
                {"dof": "v0", "amplitude": 0.4},
            ],
            "response": {"frequency": list(frequency)},
        }
    )


def elastic_strip(span, contacts=12, modes=12):
    """Pressed on its foundation all along and driven at one end, where it lifts off on its upper branch."""
    dofs = [f"u{i}" for i in range(contacts)] + [f"v{i}" for i in range(contacts)]
    chain = 2.0 * np.eye(contacts) - np.eye(contacts, k=1) - np.eye(contacts, k=-1)
    chain[[0, -1], [0, -1]] = 1.0
    stiff = 100.0 * contacts * scipy.linalg.block_diag(chain, 0.3 * chain)
    stiff += np.diag(np.repeat([20.0, 50.0], contacts) / contacts)
    squares, shapes = scipy.linalg.eigh(stiff, np.eye(2 * contacts) / contacts)
    law = {"mu": 0.4, "k_u": 200.0 / contacts, "k_v": 300.0 / contacts, "n_0": 8.0 / contacts}
    return scene_from_dict(
        {
            "modal": {
                "dofs": dofs,
                "frequency": np.sqrt(squares[:modes]).tolist(),
                "damping": [0.01] * modes,
                "shapes": shapes[:, :modes].T.tolist(),
            },
            "contact": [
                {"name": f"c{i}", "tangential": f"u{i}", "normal": f"v{i}", **law} for i in range(contacts)
            ],
            "force": [
                {"dof": dofs[contacts - 1], "amplitude": 1.5},
                {"dof": dofs[-1], "amplitude": 0.6},
            ],
            "response": {"frequency": list(span), "output": [dofs[contacts - 1]]},
        }
    )
