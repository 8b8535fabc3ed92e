"""A solid of many rows, its factorisation by each package: python -m tests.benchmarks.solid [NX NY NZ]

Bricks of eight nodes, one face clamped. Each package factorises the stiffness, solves it once, and
reduces the structure to 10 modes with five contacts, as `fcm plot modes` does, in a process of its own.
"""

from __future__ import annotations

import resource
import subprocess
import sys
import tempfile
import time
from functools import partial
from pathlib import Path

import numpy as np
import scipy.sparse
from tests.structure.solids import bricks

from fcm.structure import eigen
from fcm.structure.factor import FactorOptions, has_cholmod, solver

SIZE = (87, 23, 23)  # elements: 150,336 rows
PAIRS = 5


def scene_files(folder: Path, size: tuple[int, int, int]) -> Path:
    """A scene of such a solid, pushed at the middle of its free end, that rubs there at five nodes."""
    K, M, names = bricks(*size)
    for name, matrix in (("K", K), ("M", M)):
        scipy.sparse.save_npz(folder / f"{name}.npz", matrix, compressed=False)
    (folder / "dofs.txt").write_text("\n".join(names))
    last = [int(name[:-1]) for name in names[-3 * PAIRS :: 3]]
    data = [
        '[structure]\ndofs = "dofs.txt"\nmass = "M.npz"\nstiffness = "K.npz"\ndamping = 0.01\nmodes = 10\n',
        *(
            f'[[contact]]\nname = "c{node}"\ntangential = "{node}x"\nnormal = "{node}y"\n'
            "mu = 0.3\nk_u = 0.1\nk_v = 0.1\nn_0 = 1\n"
            for node in last
        ),
        f'[[force]]\ndof = "{last[0]}y"\namplitude = 1.0\n',
        "[response]\nfrequency = [1e-5, 1e-3]\n",
    ]
    (folder / "solid.toml").write_text("".join(data))
    return folder / "solid.toml"


def factorise(package: str, size: tuple[int, int, int]) -> None:
    """Seconds and memory of one factorisation, and of a solution."""
    K = bricks(*size)[0]
    begin = time.process_time()
    solve = solver(K, options=FactorOptions(package=package))
    made = time.process_time()
    solve(np.ones(K.shape[0]))
    solved = time.process_time() - made
    print(f"{package}: {K.shape[0]} rows, {K.nnz} entries: {made - begin:.1f} s, {solved:.2f} s a solution")


def modes(package: str, scene: str) -> None:
    """The whole of `fcm plot modes --json`."""
    from fcm.scene import load_scene
    from fcm.scene.listing import listing

    eigen.solver = partial(solver, options=FactorOptions(package=package))
    begin = time.process_time()
    first = listing(load_scene(scene))["modes"][0]["frequency"]
    print(f"{package}: first mode {first:.6g}, {time.process_time() - begin:.1f} s in all")


def main() -> None:
    arguments = sys.argv[1:]
    if arguments and arguments[0] in ("factorise", "modes"):
        if arguments[0] == "factorise":
            factorise(arguments[1], (int(arguments[2]), int(arguments[3]), int(arguments[4])))
        else:
            modes(arguments[1], arguments[2])
        used = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
        print(f"  {used:.0f} MB")
        return
    size = (int(arguments[0]), int(arguments[1]), int(arguments[2])) if len(arguments) == 3 else SIZE
    with tempfile.TemporaryDirectory() as folder:
        scene = scene_files(Path(folder), size)
        for package in ("CHOLMOD", "fronts", "SuperLU")[not has_cholmod() :]:
            for rest in (("factorise", package, *map(str, size)), ("modes", package, str(scene))):
                subprocess.run([sys.executable, "-m", "tests.benchmarks.solid", *rest], check=True)


if __name__ == "__main__":
    main()
