"""The forces of a contact in its plane: against numbers, marches, closed forms and the contact on a line."""

import json
from dataclasses import replace
from pathlib import Path

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize

from fcm import periodic_forces, planar_forces, planar_gradients
from fcm.contact.contact_kernel import ContactParameters
from fcm.contact.plane.options import OPTIONS

from ..scale import SCALE
from .motions import BOUNDARIES, random_cases
from .planar_march import March, returned
from .planar_motions import Planar, kernel, random_planars

POINTS = json.loads((Path(__file__).parent / "planar_points.json").read_text())
STUCK, MIXED = 4, 2


def coefficients(pairs):
    return np.array([complex(*pair) for pair in pairs])


def planar(point):
    motions = (coefficients(point[name]) for name in ("u_x", "u_y", "v"))
    return Planar(*motions, *(point[name] for name in ("mu", "k_u", "k_v", "n_0")))


@pytest.mark.parametrize("i", range(len(POINTS)))
def test_forces_and_work_of_random_motions(i):
    """Numbers of an event-located integration to 1e-12, made elsewhere."""
    point = POINTS[i]
    case = planar(point)
    found = case.forces(harmonics=len(point["f_x"]) - 1)
    for part, name in zip(found, ("f_x", "f_y", "n"), strict=True):
        assert np.abs(part - coefficients(point[name])).max() <= 1e-11 * case.size
    cycle = case.cycle()
    assert (cycle.kind == STUCK) == point["stuck"]
    work = cycle.slider.integrals.work * cycle.motion.scale**2 / case.k_u
    if cycle.kind == MIXED:
        assert work == pytest.approx(point["work"], rel=1e-10)
    else:
        assert abs(point["work"]) < 1e-14


@pytest.mark.parametrize("i", range(len(POINTS)))
def test_forces_of_the_kernel_as_a_balance_uses_it(i):
    """The same numbers, to the tolerance of its own options."""
    case, count = planar(POINTS[i]), len(POINTS[i]["f_x"])
    contact, x = kernel(case, count - 1, OPTIONS)
    contact.at(x, ContactParameters(case.mu, case.k_u, case.k_v, case.n_0), gradient=False)
    forces = np.array(contact.forces)
    found = np.vstack((forces[:3] + 0j, forces[3:].view(complex).reshape(-1, 3)))
    expected = np.column_stack([coefficients(POINTS[i][name]) for name in ("f_x", "f_y", "n")])
    assert np.abs(found - expected)[1:].max() <= 1e-9 * case.size


# the march needs many periods where little slips: these motions come back within its sixty
@pytest.mark.parametrize("seed", [0, 1, 3, 5, 6, 7, 10, 12])
def test_forces_are_those_of_a_march(seed):
    case = random_planars(13, 1, 4)[seed]
    outputs = max(case.u_x.size, case.v.size) + 1
    F, _ = March(*case.arguments(), outputs).forces()
    found = case.forces(harmonics=outputs)
    assert np.abs(np.stack(found[:2]) - F).max() <= 1e-11 * case.size


@pytest.mark.parametrize("share", [1e-6, 0.3, 0.5, 0.99, 1.0 - 1e-12])
def test_a_circle_under_constant_load(share):
    """The radial part of the force is k r^2 / a, the tangential one k r sqrt(1 - (r / a)^2), in 40 digits."""
    k_u, mu = 2.0, 0.25
    f_x, f_y, n = planar_forces([0, 1.5], [0, -1.5j], [0.0], mu, k_u, 1.0, share * 1.5 * k_u / mu)
    with mpmath.workdps(40):
        s = mpmath.mpf(share * 1.5 * k_u / mu) * mu / (k_u * mpmath.mpf(1.5))
        exact = complex(1.5 * k_u * s * s, 1.5 * k_u * s * mpmath.sqrt(1 - s * s))
    # near the slip limit the root has the rounding of its argument, 1 - s^2, over twice itself: four of them
    allowed = 1e-13 + 2.0 * np.finfo(float).eps / np.sqrt(2.0 * (1.0 - share))
    assert abs(f_x[1] / (1.5 * k_u) - exact / (1.5 * k_u)) <= allowed
    assert abs(f_y[1] / (1.5 * k_u) - exact * -1j / (1.5 * k_u)) <= allowed
    assert n[0].real == pytest.approx(share * 1.5 * k_u / mu, rel=1e-15)


def test_the_work_of_a_circle():
    case = Planar(np.array([0, 1]), np.array([0, -1j]), np.zeros(1), 1.0, n_0=0.6)
    sums = case.cycle().slider.integrals
    assert sums.work == pytest.approx(2.0 * np.pi * 0.6 * 0.8, rel=1e-13)
    assert sums.path == pytest.approx(2.0 * np.pi * 0.8, rel=1e-13)


def extrapolated(rate, t, y, h, levels=9):
    """One step of the midpoint rule, extrapolated (Gragg, Bulirsch and Stoer)."""
    rows = []
    for level in range(1, levels + 1):
        n = 2 * level
        before, now = y, y + h / n * rate(t, y)
        for i in range(1, n):
            before, now = now, before + 2 * h / n * rate(t + i * h / n, now)
        row = [(before + now + h / n * rate(t + h, now)) / 2]
        for j, last in enumerate(rows[-1] if rows else []):
            share = (mpmath.mpf(level) / (level - j - 1)) ** 2 - 1
            row.append(row[-1] + (row[-1] - last) / share)
        rows.append(row)
    return rows[-1][-1]


def test_a_slip_that_never_ends_in_thirty_digits():
    """An ellipse of 1 and 0.7 at r = 0.3 + 0.1 cos(theta): the direction by extrapolation."""
    count = 48
    with mpmath.workdps(30):
        b, r_0, r_1 = map(mpmath.mpf, ("0.7", "0.3", "0.1"))

        def rate(t, alpha):
            s, c = mpmath.sin(t), mpmath.cos(t)
            return (b * c * mpmath.cos(alpha) + s * mpmath.sin(alpha)) / (r_0 + r_1 * c)

        t, alpha, h = mpmath.mpf(0), mpmath.pi / 3, 2 * mpmath.pi / count
        total = mpmath.mpc(0)
        for i in range(3 * count):  # what it began with is forgotten after two periods
            if i >= 2 * count:
                total += (r_0 + r_1 * mpmath.cos(t)) * mpmath.expj(alpha - t)
            alpha, t = extrapolated(rate, t, alpha, h), t + h
        first = complex(total / count)  # of f_x + i f_y, along exp(i theta)
    f_x, f_y, _ = planar_forces([0, 1.0], [0, -0.7j], [0, 1.0], 1.0, 1.0, 0.1, 0.3)
    assert abs(0.5 * (f_x[1] + 1j * f_y[1]) - first) <= 1e-12


@pytest.mark.parametrize("angle", [0.0, 2.5])
def test_straight_motion_is_that_of_a_contact_on_a_line(angle):
    cases = [*random_cases(25, 8, most=4), *BOUNDARIES.values()]
    for case in cases:
        f, n = case.forces()
        c, s = np.cos(angle), np.sin(angle)
        f_x, f_y, n_plane = planar_forces(c * case.u, s * case.u, *case.arguments()[1:])
        size = max(case.k_u * np.abs(case.u[1:]).max(initial=0.0), np.abs(f).max(), 1e-300)
        assert np.abs(c * f_x + s * f_y - f).max() <= 1e-11 * size, case
        assert np.abs(c * f_y - s * f_x).max() <= 1e-11 * size, case
        terms = abs(case.n_0) + case.k_v * np.abs(case.v).sum()
        np.testing.assert_allclose(n_plane, n, rtol=0.0, atol=1e-14 * max(terms, 1e-300))


def test_turning_the_axes_turns_the_forces():
    for case in random_planars(60, 2):
        f_x, f_y, _ = case.forces()
        c, s = np.cos(0.7), np.sin(0.7)
        u_x, u_y = c * case.u_x - s * case.u_y, s * case.u_x + c * case.u_y
        g_x, g_y, _ = planar_forces(u_x, u_y, *case.arguments()[2:])
        assert np.abs(g_x - (c * f_x - s * f_y)).max() <= 1e-10 * case.size
        assert np.abs(g_y - (s * f_x + c * f_y)).max() <= 1e-10 * case.size


def test_a_shift_of_time_and_other_units_only_do_that():
    for case in random_planars(60, 3):
        forces = case.forces()
        turn = np.exp(1j * 1.1 * np.arange(case.u_x.size))
        shifted = planar_forces(case.u_x * turn, case.u_y * turn, case.v * turn, *case.arguments()[3:])
        longer = planar_forces(
            1e3 * case.u_x,
            1e3 * case.u_y,
            1e3 * case.v,
            case.mu,
            7e-3 * case.k_u,
            7e-3 * case.k_v,
            7.0 * case.n_0,
        )
        for one, other, third in zip(forces[:2], shifted[:2], longer[:2], strict=True):
            assert np.abs(one * turn - other).max() <= 1e-10 * case.size
            assert np.abs(one * 7.0 - third).max() <= 7e-10 * case.size


def test_friction_takes_energy_and_no_more_than_the_load_allows():
    for case in random_planars(60, 4):
        f_x, f_y, n = case.forces(harmonics=case.u_x.size + 60)
        order = np.arange(case.u_x.size)
        work = np.pi * float(
            sum(
                (order * (1j * u * np.conj(f[: u.size])).real).sum()
                for u, f in ((case.u_x, f_x), (case.u_y, f_y))
            )
        )
        assert work >= -1e-10 * case.size**2 / case.k_u
        cycle = case.cycle()
        scale = cycle.motion.scale**2 / case.k_u
        assert (
            work == pytest.approx(cycle.slider.integrals.work * scale, abs=1e-9 * scale)
            or cycle.kind != MIXED
        )
        # the forces, summed: their series converge as h**-2
        theta = np.linspace(0.0, 2.0 * np.pi, 101)
        wave = np.exp(1j * np.multiply.outer(theta, np.arange(f_x.size)))
        f = np.hypot((wave @ f_x).real, (wave @ f_y).real)
        assert np.all(f <= case.mu * (wave @ n).real + 0.05 * (case.size + case.mu * np.abs(n).max()))


def pushed_aside(rng):
    """Motions with a far mean and little to spare."""
    for _ in range(100):
        u = rng.standard_normal((2, 3)) + 1j * rng.standard_normal((2, 3))
        u[:, 0] = 20.0 * rng.standard_normal(2)
        v = np.array([0, 0.3, 0.2j])
        greatest = np.abs(u[:, 1:]).sum()
        yield Planar(*u, v, 1.0, n_0=rng.uniform(0.6, 1.0) * greatest + 0.5)


def test_a_slider_that_never_slips_rests_where_it_began_or_as_near_as_the_discs_allow():
    """Against places around it that three hundred discs have in common."""
    rng, met = np.random.default_rng(9), {0: 0, 1: 0, 2: 0}
    theta = np.linspace(0.0, 2.0 * np.pi, 301)
    cases = [*random_planars(200, 10, 3), *pushed_aside(rng)]
    for case in cases:
        cycle = case.cycle()
        if cycle.kind != STUCK:
            continue
        met[cycle.resting.held] += 1
        wave = np.exp(1j * np.multiply.outer(theta, np.arange(case.u_x.size)))
        u = np.stack([(wave @ one).real for one in (case.u_x, case.u_y)])
        r = case.mu / case.k_u * (case.n_0 + case.k_v * (wave @ case.v).real)
        f_x, f_y, _ = case.forces()
        w = np.array([(case.u_x[0] - f_x[0] / case.k_u).real, (case.u_y[0] - f_y[0] / case.k_u).real])
        assert np.all(np.hypot(*(u - w[:, None])) <= r + 1e-12 * np.abs(u).max())
        near = w[:, None] + rng.standard_normal((2, 60)) * 0.05 * np.abs(u).max()
        inside = np.all(np.hypot(*(u[:, :, None] - near[:, None])) <= r[:, None], axis=0)
        assert np.all(np.hypot(*near[:, inside]) >= np.hypot(*w) - 1e-4 * np.abs(u).max())
    assert min(met.values()) >= 3, met


def passing_near(rng, count):
    """Motions that pass near to their sliders where the load is least: two discs in turn hold them."""
    size = np.array([1.0, 1.0, 0.25, 1.0 / 9.0])
    wave = np.exp(1j * np.multiply.outer(np.linspace(0.0, 2.0 * np.pi, 2000), np.arange(4)))
    for harmonics in rng.integers(1, 4, count):
        u_x, u_y, v = (rng.standard_normal((3, 4)) + 1j * rng.standard_normal((3, 4))) * size
        u_x[0], u_y[0], v[0] = u_x[0].real, u_y[0].real, v[0].real
        u_x, u_y, v = u_x[: harmonics + 1], u_y[: harmonics + 1], v[: harmonics + 1]
        least = (wave[:, : harmonics + 1] @ v).real.min()
        n_0 = 10.0 ** rng.uniform(-4.0, -1.0) - least
        yield Planar(u_x, u_y, v, 1.0, 10.0 ** rng.uniform(-1.0, 0.0), 1.0, n_0)


def discs(case, count):
    """Centres (2, angle) and radii of those that hold a slider."""
    wave = np.exp(1j * np.multiply.outer(np.linspace(0.0, 2.0 * np.pi, count), np.arange(case.u_x.size)))
    u = np.stack([(wave @ one).real for one in (case.u_x, case.u_y)])
    return u, case.mu / case.k_u * (case.n_0 + case.k_v * (wave @ case.v).real)


@pytest.mark.slow
def test_a_slider_rests_where_discs_less_than_a_step_of_the_sampled_cycle_apart_hold_it():
    """Within each of twenty thousand discs, and as far from where it began as eight thousand demand."""
    near = 0
    for case in passing_near(np.random.default_rng(1), 1000):
        cycle = case.cycle()
        if cycle.kind != STUCK:
            continue
        w = np.array([cycle.resting.w_x, cycle.resting.w_y]) * cycle.motion.scale / case.k_u
        w += np.array([case.u_x[0].real, case.u_y[0].real])
        u, r = discs(case, 20001)
        size = np.abs(u).max() + np.abs(r).max()
        assert np.all(np.hypot(*(u - w[:, None])) <= r + 1e-12 * size)
        u, r = discs(case, 8001)
        room = {"type": "ineq", "fun": lambda w, u=u, r=r: r - np.hypot(*(u - w[:, None]))}
        start = [case.u_x[0].real, case.u_y[0].real]
        best = minimize(lambda w: w @ w, start, constraints=room, method="SLSQP", options={"ftol": 1e-10})
        assert np.hypot(*w) == pytest.approx(np.hypot(*best.x), rel=0.0, abs=1e-5 * size)
        if cycle.resting.held == 2:
            apart = np.abs(np.angle(np.exp(1j * (cycle.resting.basis[0, 3] - cycle.resting.basis[1, 3]))))
            near += bool(apart < cycle.resting.step)
    assert near >= 10


def test_at_the_slip_limit_and_where_the_load_touches_zero():
    circle = (np.array([0, 1.0]), np.array([0, -1j]))
    for n_0 in (1.0, np.nextafter(1.0, 2.0)):  # stuck: the force is the displacement
        f_x, f_y, _ = planar_forces(*circle, [0.0], 1.0, 1.0, 1.0, n_0)
        np.testing.assert_allclose((f_x[1], f_y[1]), (1.0, -1j), rtol=0.0, atol=1e-15)
    ellipse = (np.array([0, 1.0]), np.array([0, -0.4j]))
    touching = Planar(*ellipse, np.array([0, 1.0]), 0.5)
    beside = [Planar(*ellipse, np.array([0, 1.0]), 0.5, n_0=1.0 + miss).forces() for miss in (-1e-9, 1e-9)]
    for one, low, high in zip(touching.forces(), *beside, strict=True):
        assert np.abs(one - low).max() <= 1e-8
        assert np.abs(one - high).max() <= 1e-8


def touched(case):
    """The same with a preload with which the least load of the cycle is nothing."""
    h, theta = np.arange(case.v.size), np.linspace(0.0, 2.0 * np.pi, 20001)
    at = theta[(np.exp(1j * np.outer(theta, h)) @ case.v).real.argmin()]
    for _ in range(20):
        slope, bend = (((1j * h) ** k * np.exp(1j * h * at) * case.v).sum().real for k in (1, 2))
        at -= slope / bend
    return replace(case, n_0=-case.k_v * (np.exp(1j * h * at) * case.v).sum().real)


def test_loads_that_just_touch_zero_against_a_march():
    cases = [touched(case) for case in random_planars(20, 5, 3)]
    marched = returned(cases, 2000, 4)
    for case, F in zip(cases, marched, strict=True):
        found = np.stack(case.forces(harmonics=4)[:2])
        assert np.abs(found - F)[:, 1:].max() <= 5e-6 * case.size, case
        for miss in (-1e-9, 1e-9):  # an opening of no length, and none
            beside = replace(case, n_0=case.n_0 + miss * case.k_v).forces(harmonics=4)
            assert np.abs(np.stack(beside[:2]) - found)[:, 1:].max() <= 2e-8 * case.size, case


HUGE = st.sampled_from([0.0, 1e-12, 1e-6, 0.5, 1.0, 2.0, 1e6, 1e12])
PART = st.sampled_from([0.0, 0.0, 1.0, -1.0, 0.5, 1e-12, 1e12])


EXTREMES = (st.lists(PART, min_size=15, max_size=15), HUGE, HUGE, HUGE, PART)


def extreme(parts, mu, k_u, k_v, n_0):
    """A motion of few, small, equal and great numbers."""
    X = np.array(parts).reshape(3, 5)
    u_x, u_y, v = X[:, 0] + 0j, X[:, 1] + 1j * np.roll(X[:, 2], 1), X[:, 3] + 1j * X[:, 4]
    return Planar(u_x, u_y, v, mu, k_u, k_v, n_0)


@settings(max_examples=max(int(300 * SCALE), 10), deadline=None, derandomize=True)
@given(*EXTREMES)
def test_extremes_and_equalities(parts, mu, k_u, k_v, n_0):
    """A cycle is found, its friction is within the load, and the load is that of a contact on a line."""
    case = extreme(parts, mu, k_u, k_v, n_0)
    f_x, f_y, n = case.forces()
    assert np.all(np.isfinite(np.concatenate((f_x, f_y, n))))
    v = case.v
    _, alone = periodic_forces(np.zeros(3), v, mu, k_u, k_v, n_0)
    assert np.abs(n - alone).max() <= 1e-12 * max(np.abs(alone).max(), k_v * np.abs(v).max())
    most = mu * (max(n_0 + k_v * v[0].real, 0.0) + k_v * np.abs(v[1:]).sum())
    reach = most + 1e-12 * k_u * np.abs(parts).max()
    assert max(np.abs(f_x).max(), np.abs(f_y).max()) <= 2.0 * reach


def test_arguments_broadcast_and_numbers_that_are_not_finite_give_nan():
    f_x, f_y, n = planar_forces([[0, 1], [0, 2]], [0, -1j], [0.0], 0.5, 1.0, 1.0, [[1.0], [0.5], [np.inf]])
    assert f_x.shape == f_y.shape == n.shape == (3, 2, 2)
    assert np.isnan(f_x[2]).all() and np.isfinite(f_x[:2]).all()
    alone = planar_forces([0, 2], [0, -1j], [0.0], 0.5, 1.0, 1.0, 0.5)
    np.testing.assert_array_equal(f_x[1, 1], alone[0])


@pytest.mark.parametrize("of", [planar_forces, planar_gradients])
@pytest.mark.parametrize(("shape", "harmonics"), [((0, 3), 3), ((2, 0, 1), 2)])
def test_no_motions_have_no_forces(of, shape, harmonics):
    f_x, f_y, n, *slopes = of(np.zeros(shape), [0, 1], [0, 1], 1.0, 1.0, 1.0, 1.0)
    assert f_x.shape == f_y.shape == n.shape == (*shape[:-1], harmonics)
    assert all(one.shape == (*shape[:-1], harmonics, 3, harmonics, 2) for one in slopes)


def test_wrong_arguments():
    with pytest.raises(ValueError, match="mu must not be negative"):
        planar_forces([0, 1], [0, 1], [0], -1.0, 1.0, 1.0, 1.0)
    with pytest.raises(ValueError, match="at least one coefficient"):
        planar_forces([0, 1], [], [0], 1.0, 1.0, 1.0, 1.0)


def test_few_harmonics_among_many_are_as_alone():
    case = Planar(
        np.array([0, 1, 0, 0.3j]), np.array([0, -0.5j, 0, 0.1]), np.array([0, 0.4, 0, 0.2]), n_0=0.7
    )
    contact, x = kernel(case)
    contact.at(x, ContactParameters(0.5, 1.0, 1.0, 0.7))
    few = type(contact)([1, 3], [1, 2, 3])
    few.at(np.delete(x, range(9, 15)), ContactParameters(0.5, 1.0, 1.0, 0.7))
    np.testing.assert_allclose(few.forces, contact.forces, rtol=0.0, atol=1e-12)
    mine = np.delete(np.asarray(contact.jacobian), range(9, 15), axis=1)
    np.testing.assert_allclose(few.jacobian, mine, rtol=0.0, atol=1e-10)


def test_a_circle_whose_slip_limit_is_met_at_one_angle():
    """The fixed point is double; the load varies by 1e-6, and the force is u but for the root of that."""
    u_x, u_y, v = [1e12, 1.0, 1e12], [1e12j - 1.0, 0.0, 1e12j], [1e12j, 1.0 + 0.5j, -1.0 - 1.0j]
    f_x, f_y, _ = planar_forces(u_x, u_y, v, 1.0, 1.0, 1e6, 1e12)
    np.testing.assert_allclose((f_x[2], f_y[2]), (1e12, 1e12j), rtol=2e-3, atol=0.0)


def test_a_slider_that_a_period_moves_from_one_side_of_its_place_far_to_the_other():
    """It slips hardly less than all the time: Newton's method alone goes to and fro."""
    u_x = np.array([-0.0009204931847730045, -0.022205270221464242 - 0.7996911087362616j])
    u_y = np.array([-0.00032242310377693487, -0.7996493171257968 + 0.022150432213327798j])
    v = np.array([-1.0706678161955678e-05, -0.0008686104944947823 - 0.0022754563343190615j])
    case = Planar(u_x, u_y, v, 0.4, 1.0, 1.0, 2.0)
    f_x, f_y, _ = case.forces()
    assert case.cycle().periods < 20
    # radial return from beside there comes back: the slider slips a ten-thousandth of its circle in a period
    place = np.array([u_x[0] - f_x[0], u_y[0] - f_y[0]]).real
    w_x, w_y = place + np.array([3e-4, -3e-4])
    turn = np.exp(2j * np.pi * np.arange(2000) / 2000)
    x, y, load = ((one[0] + one[1] * turn).real for one in (u_x, u_y, v))
    limit = 0.4 * (2.0 + load)
    rests = []
    for _ in range(15):
        for a, b, r in zip(x.tolist(), y.tolist(), limit.tolist(), strict=True):
            d_x, d_y = a - w_x, b - w_y
            back = min(1.0, r / np.hypot(d_x, d_y))
            w_x, w_y = a - back * d_x, b - back * d_y
            rests.append((w_x, w_y))
    assert np.mean(rests[-2000:], axis=0) == pytest.approx(place, abs=1e-5)


@pytest.mark.parametrize("n_0", [-1.0, 0.5, 4.0])
def test_friction_far_smaller_than_the_motion_points_along_the_velocity(n_0):
    """f = mu n u' / |u'|, whose coefficients are those of a sum over a period."""
    rng, mu, k_v = np.random.default_rng(12), 1e-12, 1.0
    h, theta = np.arange(4), 2.0 * np.pi * np.arange(1 << 18) / (1 << 18)
    turning = np.exp(1j * np.outer(h, theta))
    for _ in range(10):
        u_x, u_y, v = (rng.normal(size=(3, 4)) + 1j * rng.normal(size=(3, 4))) / np.maximum(h, 1) ** 2
        velocity = (1j * h * np.array([u_x, u_y]) @ turning).real
        load = np.maximum(n_0 + k_v * (np.append(v[0].real, v[1:]) @ turning).real, 0.0)
        force = mu * load * velocity / np.hypot(*velocity)
        expected = np.array([*force, load]) @ turning.conj().T * np.where(h > 0, 2.0, 1.0) / theta.size
        *friction, normal = planar_forces(u_x, u_y, v, mu, 1.0, k_v, n_0)
        np.testing.assert_allclose(friction, expected[:2], rtol=0, atol=1e-9 * mu * max(load.max(), 1.0))
        np.testing.assert_allclose(normal, expected[2], rtol=0, atol=1e-9 * max(load.max(), 1.0))
