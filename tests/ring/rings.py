"""Rings of sectors, and the same written out as ordinary scenes."""

from __future__ import annotations

import tomllib
from importlib.resources import files
from pathlib import Path

import numpy as np

DOFS = ["disk", "blade", "tip"]
COUPLING = [[-5e7, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]]
STRUCTURE = {  # a lumped disk
    "dofs": DOFS,
    "mass": [1.2, 0.35, 0.25],
    "stiffness": [[1.016e8, -1e6, 0.0], [-1e6, 3e6, -2e6], [0.0, -2e6, 2e6]],
    "damping": 0.002,
    "coupling": {"stiffness": COUPLING},
}
SKEW = [[-4.8e7, 0.0, 2e5], [-1e5, 0.0, 0.0], [0.0, -1.5e5, -5e4]]  # not symmetric: it turns waves
SHROUD = {
    "name": "shroud",
    "tangential": {"next.tip": 1.0, "tip": -1.0},
    "normal": {"next.blade": 0.4, "tip": -0.6, "disk": 0.3},
    "mu": 0.3,
    "k_u": 2e5,
    "k_v": 1e5,
    "n_0": 30.0,
}
DAMPER = {
    "name": "damper", "tangential": "blade", "normal": {"disk": 1.0, "next.disk": -1.0},
    "mu": 0.4, "k_u": 3e5, "k_v": 2e5, "n_0": 20.0,
}  # fmt: skip


IN_PLANE = SHROUD | {
    "tangential": [{"next.tip": 1.0, "tip": -1.0}, {"next.blade": 1.0, "disk": -1.0}],
    "k_u": 1.5e5,
}


def sector(sectors, engine_order, contacts=(SHROUD,), coupling=SKEW, amplitude=400.0, **response):
    """The scene of one sector, with a coupling and a force that distinguish left from right."""
    structure = STRUCTURE | {"coupling": {"stiffness": coupling}}
    force = [{"dof": "tip", "amplitude": amplitude}, {"dof": "blade", "amplitude": 8.0, "phase": 0.7}]
    return {
        "frequency_unit": "Hz",
        "cyclic": {"sectors": sectors, "engine_order": engine_order},
        "structure": structure,
        "contact": [dict(one) for one in contacts],
        "force": force,
        "response": {"frequency": [150.0, 260.0], "max_step": 0.1, **response},
    }


def matrices(scene):
    """Mass and stiffness of the whole ring."""
    count, rows = scene["cyclic"]["sectors"], len(scene["structure"]["dofs"])
    ahead = np.roll(np.eye(count), 1, axis=1)  # row k has sector k + 1
    structure = scene["structure"]
    found = []
    for key in ("mass", "stiffness"):
        own = np.array(structure[key])
        matrix = np.kron(np.eye(count), np.diag(own) if own.ndim == 1 else own)
        block = np.kron(ahead, structure["coupling"].get(key, np.zeros((rows, rows))))
        found.append(matrix + block + block.T)
    return found


def written_out(scene):
    """The whole ring as an ordinary scene: names "dof_k" and "contact_k"."""
    count, order = scene["cyclic"]["sectors"], scene["cyclic"]["engine_order"]
    mass, stiffness = matrices(scene)
    damping = scene["structure"]["damping"]
    names = [f"{dof}_{k}" for k in range(count) for dof in scene["structure"]["dofs"]]
    full = {key: value for key, value in scene.items() if key != "cyclic"}
    full["structure"] = {
        "dofs": names, "mass": mass.tolist(), "stiffness": stiffness.tolist(), "damping": damping,
        "modes": len(names),
    }  # fmt: skip
    full["contact"] = [
        one
        | {"name": f"{one['name']}_{k}"}
        | {key: _at(one[key], k, count) for key in ("tangential", "normal")}
        for k in range(count)
        for one in scene["contact"]
    ]
    full["force"] = [
        one | {"dof": f"{one['dof']}_{k}", "phase": one.get("phase", 0.0) + one.get("harmonic", 1) * ahead}
        for k, ahead in enumerate(2.0 * np.pi * order * np.arange(count) / count)
        for one in scene["force"]
    ]
    loads = scene.get("load", ())
    full["load"] = [one | {"dof": f"{one['dof']}_{k}"} for k in range(count) for one in loads]
    return full


def _at(direction, k, count):
    if isinstance(direction, list):  # of a contact in a plane
        return [_at(one, k, count) for one in direction]
    terms = {direction: 1.0} if isinstance(direction, str) else direction
    found = {}
    for name, weight in terms.items():
        own = name.removeprefix("next.")
        place = f"{own}_{(k + (own != name)) % count}"
        found[place] = found.get(place, 0.0) + weight
    return found


def scene_of(name):
    """The keys of a bundled scene."""
    path = Path(str(files("fcm") / "scenes" / f"{name}.toml"))
    return tomllib.loads(path.read_text())


def around(z, harmonics, contacts, ring):
    """Unknowns of the ring from those of one sector: harmonic h of sector k turns by h k phi."""
    blocks = z[:-1].reshape(contacts, -1)
    each = blocks.shape[1] // (1 + 2 * len(harmonics))  # directions of a contact
    phi = 2.0 * np.pi * ring.engine_order / ring.sectors
    out = []
    for k in range(ring.sectors):
        turned = blocks.copy()
        for j, h in enumerate(harmonics):
            for first in range(each * (1 + 2 * j), each * (3 + 2 * j), 2):
                X = (blocks[:, first] + 1j * blocks[:, first + 1]) * np.exp(1j * h * k * phi)
                turned[:, first], turned[:, first + 1] = X.real, X.imag
        out.append(turned.ravel())
    return np.concatenate((*out, z[-1:]))
