"""What holds for every periodic motion: bounds, signs, symmetries; the loop and what it says of the cycle."""

import shutil
from pathlib import Path

import numpy as np
import pytest

import fcm
from fcm import fourier_coefficients, hysteresis_loop, periodic_forces, periodic_loop
from fcm.contact.contact_kernel import ContactParameters
from fcm.contact.periodic.cycle import PeriodicContact

from ..program import python
from .cases import points
from .motions import BOUNDARIES, random_cases

THETA = np.linspace(0.0, 2.0 * np.pi, 2001)
CASES = [*random_cases(150, 21), *BOUNDARIES.values()]
NODES, WEIGHTS = np.polynomial.legendre.leggauss(12)


def loops():
    return [(case, periodic_loop(*case.arguments())) for case in CASES]


def size(case):
    """Of the friction force at most: of the motion, and of the load."""
    load = case.mu * (abs(case.n_0) + case.k_v * np.abs(case.v).sum())
    return case.k_u * np.abs(case.u[1:]).sum() + load + 1e-300


def integrated(loop, what):
    """Integral over the cycle, from transition to transition, in steps short enough for Gauss's rule."""
    cuts = np.unique(np.concatenate((np.linspace(0.0, 2.0 * np.pi, 65), loop.angles)))
    half = 0.5 * np.diff(cuts)[:, None]
    return float(np.sum(what(cuts[:-1, None] + half * (1.0 + NODES)) * half * WEIGHTS))


def rate(X, theta):
    return (np.exp(1j * np.multiply.outer(theta, np.arange(X.size))) @ (1j * np.arange(X.size) * X)).real


def test_friction_is_within_the_load_and_continuous():
    for case, loop in loops():
        theta = np.concatenate((THETA, loop.angles))
        assert np.all(np.abs(loop.force(theta)) <= loop.slip_limit(theta))
        jump = np.abs(loop.force(loop.angles + 1e-9) - loop.force(loop.angles - 1e-9))
        assert np.all(jump <= 1e-6 * size(case))


def test_the_loop_has_the_coefficients():
    """The force of the loop, integrated, is that of `periodic_forces`."""
    for case, loop in loops():
        f, n = case.forces()
        for h in range(0, f.size, 3):
            for force, F in ((loop.force, f[h]), (loop.normal_load, n[h])):
                wave = (
                    lambda t, h=h, force=force: force(t) * np.cos(h * t),
                    lambda t, h=h, force=force: -force(t) * np.sin(h * t),
                )
                found = complex(*(integrated(loop, w) for w in wave)) / (np.pi if h else 2.0 * np.pi)
                assert found == pytest.approx(F, abs=1e-11 * size(case) / min(case.mu or 1.0, 1.0))


def test_energy_is_only_taken():
    """The same by the coefficients, pi Im sum h F_h conj(U_h), by the loop, and as the loop itself says."""
    for case, loop in loops():
        f, _ = case.forces()
        h = np.arange(case.u.size)
        by_coefficients = np.pi * float(np.sum(h * np.imag(f[: case.u.size] * np.conj(case.u))))
        by_force = integrated(loop, lambda t, loop=loop, case=case: loop.force(t) * rate(case.u, t))
        most = size(case) * np.sum(h * np.abs(case.u))
        assert loop.dissipation >= 0.0
        assert loop.dissipation == pytest.approx(by_coefficients, abs=1e-12 * most)
        assert loop.dissipation == pytest.approx(by_force, abs=1e-11 * most)


def test_path_and_extremes():
    for case, loop in loops():
        load = (
            case.n_0
            + case.k_v * (np.exp(1j * np.multiply.outer(THETA, np.arange(case.v.size))) @ case.v).real
        )
        fine = 1e-3 * size(case) * case.v.size**2
        assert loop.least_load <= load.min() + 1e-12 * size(
            case
        ) and loop.greatest_load >= load.max() - 1e-12 * size(case)
        assert loop.least_load == pytest.approx(load.min(), abs=fine / min(case.mu or 1.0, 1.0))
        force = np.abs(loop.force(THETA)).max()
        assert force <= loop.greatest_force * (1.0 + 1e-12) + 1e-15 * size(case)
        assert loop.greatest_force == pytest.approx(force, abs=fine)
        assert loop.slip_path >= 0.0 and (loop.slip_path > 0.0 or not set(loop.sequence) & set("PN"))
        # no friction is greater than the greatest, all along the path
        assert loop.dissipation <= loop.greatest_force * loop.slip_path * (1.0 + 1e-12)
        if "S" not in loop.sequence:
            assert (loop.sequence == "E") == (loop.overlap <= 0.0)


def test_with_one_harmonic_it_is_the_loop():
    for n0, b, phi in zip(*points("linear", 300), strict=True):
        known = hysteresis_loop(n0, b, phi)
        loop = periodic_loop([0.0, -1j], [0.0, b * (np.sin(phi) - 1j * np.cos(phi))], 1.0, 1.0, 1.0, n0)
        assert loop.sequence == known.sequence
        np.testing.assert_allclose(loop.angles, known.angles, atol=1e-10)
        np.testing.assert_allclose(loop.force(THETA), known.force(THETA), atol=1e-12)
        F_c = fourier_coefficients(n0, b, phi)[2]
        assert loop.dissipation == pytest.approx(np.pi * F_c, abs=1e-13)


def test_slip_motion_is_held_while_sticking():
    for _, loop in loops():
        assert loop.slip_motion.shape == (max(len(loop.angles), 1),)
        assert np.array_equal(np.isnan(loop.slip_motion), [state != "E" for state in loop.sequence])


def test_motion_reversed_force_reversed():
    """u to -u, which with one harmonic is phi to phi + pi."""
    for case in CASES:
        f, n = case.forces()
        g, m = periodic_forces(-case.u, *case.arguments()[1:])
        np.testing.assert_allclose(g, -f, atol=1e-14 * size(case))
        np.testing.assert_allclose(m, n, atol=1e-14 * size(case) / min(case.mu or 1.0, 1.0))


def test_shift_of_time():
    for case in CASES:
        for shift in (1e-3, 1.0, np.pi, 5.0):
            turn = np.exp(1j * shift * np.arange(16))
            f, n = case.forces()
            g, m = periodic_forces(
                case.u * turn[: case.u.size], case.v * turn[: case.v.size], *case.arguments()[2:]
            )
            np.testing.assert_allclose(g, f * turn[: f.size], atol=1e-13 * size(case))
            np.testing.assert_allclose(
                m, n * turn[: n.size], atol=1e-13 * size(case) / min(case.mu or 1.0, 1.0)
            )


def test_twice_as_fast():
    """All harmonics doubled, the same cycle twice."""
    for case in CASES:
        u, v = (np.zeros(2 * x.size - 1, complex) for x in (case.u, case.v))
        u[::2], v[::2] = case.u, case.v
        f, n = case.forces()
        g, m = periodic_forces(u, v, *case.arguments()[2:])
        np.testing.assert_allclose(g[::2], f, atol=1e-13 * size(case))
        np.testing.assert_allclose(g[1::2], 0.0, atol=1e-13 * size(case))
        np.testing.assert_allclose(m[::2], n, atol=1e-13 * size(case) / min(case.mu or 1.0, 1.0))


def test_loops_of_arrays_are_refused():
    with pytest.raises(ValueError, match="one motion"):
        periodic_loop(np.zeros((2, 3)), [0.0], 0.4, 1.0, 1.0, 1.0)
    with pytest.raises(ValueError, match="finite"):
        periodic_loop([0.0, np.nan], [0.0], 0.4, 1.0, 1.0, 1.0)


AS_PYTHON = """
import sys, warnings
warnings.simplefilter("ignore")
import numpy as np
from fcm.contact.periodic import cycle, margins, motion
kernels = cycle, margins, motion
assert all(m.__file__.endswith(".py") for m in kernels)
import fcm
data = np.load(sys.argv[1])
found = []
for i in range(len(data["u"])):
    arguments = [data[name][i] for name in ("u", "v", "mu", "k_u", "k_v", "n_0")]
    G, loop = fcm.periodic_gradients(*arguments), fcm.periodic_loop(*arguments)
    numbers = [loop.dissipation, loop.greatest_force, len(loop.sequence)]
    found.append(np.concatenate([np.ravel(x) for x in G] + [numbers]))
np.save(sys.argv[2], found)
"""


def test_the_sources_run_as_python(tmp_path):
    """Without a compiler the same files run, slowly, and give the same numbers."""
    shutil.copytree(
        Path(fcm.__file__).parent,
        tmp_path / "fcm",
        ignore=shutil.ignore_patterns("*.so", "*.pyd", "__pycache__"),
    )
    cases = [
        c for c in [*random_cases(60, 5, most=3), *BOUNDARIES.values()] if c.u.size <= 4 and c.v.size <= 4
    ][:40]
    u, v = (
        np.array([np.pad(x, (0, 4 - x.size)) for x in column])
        for column in zip(*((c.u, c.v) for c in cases), strict=True)
    )
    numbers = {name: [getattr(c, name) for c in cases] for name in ("mu", "k_u", "k_v", "n_0")}
    given, made = tmp_path / "given.npz", tmp_path / "made.npy"
    np.savez(given, u=u, v=v, **numbers)
    done = python("-c", AS_PYTHON, given, made, env={"PYTHONPATH": str(tmp_path)})
    assert done.code == 0, done.err
    for row, case, x, y in zip(np.load(made), cases, u, v, strict=True):
        G = fcm.periodic_gradients(x, y, *case.arguments()[2:])
        loop = periodic_loop(x, y, *case.arguments()[2:])
        here = [np.ravel(part) for part in G] + [[loop.dissipation, loop.greatest_force, len(loop.sequence)]]
        np.testing.assert_allclose(row, np.concatenate(here), rtol=1e-13, atol=1e-14 * (1.0 + size(case)))


@pytest.mark.parametrize("few", [[1], [1, 3]])
def test_few_harmonics_among_many_are_as_alone_and_a_fundamental_takes_its_own_nodes(few):
    many, outputs = [1, 2, 3, 7, 12], [1, 2, 3, 7, 12, 15]
    alone, among = PeriodicContact(few, outputs), PeriodicContact(many, outputs)
    columns = [0, 1, *(2 + 4 * many.index(h) + i for h in few for i in range(4))]
    rng, slipped = np.random.default_rng(3), 0
    for _ in range(50):
        x, law = rng.standard_normal(len(columns)), (0.5, 1.0, 1.3, rng.uniform(-1.0, 2.0))
        padded = np.zeros(2 + 4 * len(many))
        padded[columns] = x
        among.at(
            rng.standard_normal(padded.size), ContactParameters(*law)
        )  # one that moves in all comes before
        assert alone.at(x, ContactParameters(*law)) == among.at(padded, ContactParameters(*law))
        slipped += bool(np.abs(alone.forces)[-4:].any())  # a harmonic that the motion has not
        np.testing.assert_allclose(among.forces, alone.forces, rtol=0.0, atol=1e-12)
        mine = np.asarray(among.jacobian)[:, columns]
        np.testing.assert_allclose(mine, alone.jacobian, rtol=0.0, atol=1e-9)
    assert slipped > 30
    assert among.motion.nodes == (5 if few == [1] else 49)
