"""A row of contacts on a structure with smooth modes, for tests of many contacts."""

import numpy as np

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
