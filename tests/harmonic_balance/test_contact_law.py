"""Contact laws of one's own: against a march in time, the laws of fcm, and exact multipliers."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import fcm
from fcm.branches.force_level import solutions
from fcm.contact import ContactLawError
from fcm.harmonic_balance.sampled_law import check_own_laws
from fcm.harmonic_balance.system import System
from fcm.response import ResponseError
from fcm.scene import scene_from_dict
from fcm.stability.floquet import multipliers

DATA = {
    "title": "a contact with a law of its own",
    "modal": {
        "dofs": ["u", "v"],
        "frequency": [1.0, 3.0],
        "damping": 0.02,
        "shapes": [[0.8, 0.6], [0.6, -0.8]],
    },
    "contact": [
        {"name": "joint", "tangential": "u", "normal": "v", "mu": 0.4, "k_u": 1.0, "k_v": 0.5, "n_0": 2.0}
    ],
    "force": [{"dof": "u", "amplitude": 0.3}],
    "response": {"frequency": [0.9, 1.6]},
}


class Cubic(fcm.ContactLaw):
    """f = k x + c x^3 in each direction."""

    def __init__(self, k, c):
        self.k, self.c = k, c

    def forces(self, x, dx):
        return self.k * x + self.c * x**3, (self.k + 3.0 * self.c * x**2)[..., None] * dx


class Friction(fcm.ContactLaw):
    """The law of fcm itself, on a line: a spring and a slider under a load that varies and may vanish.

    With a kinetic coefficient it slides with that, once it has begun with mu, until it sticks again.
    """

    samples = 256

    def __init__(self, mu, k_u, k_v, n_0, kinetic=None):
        self.mu, self.k_u, self.k_v, self.n_0 = mu, k_u, k_v, n_0
        self.kinetic = mu if kinetic is None else kinetic

    def forces(self, x, dx):
        load = self.n_0 + self.k_v * x[1]
        closed = load > 0.0
        n, dn = np.where(closed, load, 0.0), np.where(closed, self.k_v, 0.0)[:, None] * dx[1]
        f, df = np.zeros(x.shape[1]), np.zeros_like(dx[1])
        w, dw, mu = 0.0, np.zeros(dx.shape[2]), self.mu
        for _ in range(2):  # the second time round the slider is where the cycle leaves it
            for s in range(x.shape[1]):
                f[s], df[s] = self.k_u * (x[0, s] - w), self.k_u * (dx[0, s] - dw)
                if abs(f[s]) <= mu * n[s]:
                    mu = self.mu
                    continue
                mu, sign = self.kinetic, np.sign(f[s])
                f[s], df[s] = sign * mu * n[s], sign * mu * dn[s]
                w, dw = x[0, s] - f[s] / self.k_u, dx[0, s] - df[s] / self.k_u
        return np.stack((f, n)), np.stack((df, dn))


def scene_of(law, **response):
    data = {**DATA, "response": {**DATA["response"], **response}}
    return scene_from_dict(data, "own.toml").with_laws({"joint": law})


def marched(scene, law, omega, periods):
    """Displacements (dof, instant) in the last of some periods from rest."""
    modal = scene.modal
    shapes, w = np.asarray(modal.shapes), np.asarray(modal.frequency)
    rest = law.forces(np.zeros((2, 1)), np.zeros((2, 1, 1)))[0][:, 0]

    def slope(t, y):
        force = -(law.forces((shapes.T @ y[:2])[:, None], np.zeros((2, 1, 1)))[0][:, 0] - rest)
        force[0] += 0.3 * np.sin(omega * t)
        return np.concatenate((y[2:], shapes @ force - 2.0 * modal.damping * w * y[2:] - w**2 * y[:2]))

    end, T = periods * 2.0 * np.pi / omega, 2.0 * np.pi / omega
    at = np.linspace(end - T, end, 400)
    y = solve_ivp(slope, (0.0, end), np.zeros(4), method="DOP853", rtol=1e-9, atol=1e-10, t_eval=at).y
    return shapes.T @ y[:2]


def test_a_cubic_stiffness_moves_as_when_it_is_marched():
    law = Cubic(0.3, 0.4)
    scene, omega = scene_of(law), 1.1
    found = solutions(System(scene, (1, 2, 3, 4, 5)), omega)
    (z,) = found.solutions
    X = z[2:-1].reshape(5, 2, 2) @ np.array([1.0, 1j])
    theta = np.linspace(0.0, 2.0 * np.pi, 400)
    x = z[:2, None] + np.real(np.einsum("hp,hs->ps", X, np.exp(1j * np.arange(1, 6)[:, None] * theta)))
    there = marched(scene, law, omega, 80)
    assert np.allclose(np.ptp(x, axis=1), np.ptp(there, axis=1), rtol=1e-4)


def test_friction_written_as_a_law_moves_as_the_law_of_fcm():
    own = scene_of(Friction(mu=0.4, k_u=1.0, k_v=0.5, n_0=2.0))
    (z,), (ours,) = (
        solutions(System(one, (1, 2, 3)), 1.35).solutions for one in (own, scene_from_dict(DATA, "ours.toml"))
    )
    assert np.allclose(z, ours, rtol=0.0, atol=3e-3 * np.abs(ours[:-1]).max())
    law = System(scene_from_dict(DATA, "ours.toml"), (1, 2, 3)).laws()[0]
    law.evaluate(ours, 0)
    assert law.nonlinear  # it slips


def test_a_kinetic_coefficient_lets_it_slide_farther():
    """Energy that friction takes from a motion of amplitude a, if it is small: 4 mu_k n (a - mu_k n / k)."""
    theta = 2.0 * np.pi / 4096 * np.arange(4096)
    x = np.stack((5.0 * np.sin(theta), np.zeros(4096)))
    law = Friction(0.4, 1.0, 0.0, 2.0, kinetic=0.3)
    f, _ = law.forces(x, np.zeros((2, 4096, 1)))
    taken = float(np.sum(f[0] * 5.0 * np.cos(theta)) * 2.0 * np.pi / 4096)
    # it breaks away at mu n, later than at mu_k n, and so takes what the spring gives up at once
    n, k, a = 2.0, 1.0, 5.0
    static, kinetic = 0.4 * n, 0.3 * n
    sliding = 4.0 * kinetic * a - 2.0 * kinetic * (static + kinetic) / k
    assert taken == pytest.approx(sliding + (static**2 - kinetic**2) / k, rel=2e-3)


def test_multipliers_of_a_linear_law_are_exact():
    scene = scene_of(Cubic(0.3, 0.0))
    (z,) = solutions(system := System(scene, (1, 3)), 1.3).solutions
    shapes, w = np.asarray(scene.modal.shapes), np.asarray(scene.modal.frequency)
    stiffness = np.diag(w**2) + 0.3 * shapes @ shapes.T
    rate = np.diag(2.0 * 0.02 * w)
    exponents = np.linalg.eigvals(np.block([[np.zeros((2, 2)), np.eye(2)], [-stiffness, -rate]]))
    exact = np.exp(2.0 * np.pi / 1.3 * exponents)
    found = multipliers(system, z)
    assert np.allclose(np.sort_complex(found), np.sort_complex(exact), rtol=1e-9)


def test_multipliers_of_a_cubic_law_are_those_of_its_disturbances():
    law, omega = Cubic(0.3, 0.4), 1.1
    scene = scene_of(law)
    (z,) = solutions(system := System(scene, (1, 2, 3, 4, 5, 6, 7)), omega).solutions
    X = z[2:-1].reshape(7, 2, 2) @ np.array([1.0, 1j])
    shapes, w = np.asarray(scene.modal.shapes), np.asarray(scene.modal.frequency)

    def slope(t, y):
        x = z[:2] + np.real(np.exp(1j * np.arange(1, 8) * omega * t) @ X)
        stiffness = shapes @ np.diag(0.3 + 1.2 * x**2) @ shapes.T + np.diag(w**2)
        y = y.reshape(4, 4)
        return np.concatenate((y[2:], -stiffness @ y[:2] - (0.04 * w)[:, None] * y[2:])).ravel()

    T = 2.0 * np.pi / omega
    end = solve_ivp(slope, (0.0, T), np.eye(4).ravel(), method="DOP853", rtol=1e-10, atol=1e-12).y[:, -1]
    exact = np.linalg.eigvals(end.reshape(4, 4))
    found = multipliers(system, z)
    assert np.allclose(np.sort_complex(found), np.sort_complex(exact), atol=1e-4)


def test_between_its_folds_a_hardening_curve_is_unstable_and_it_is_said_how_that_is_known():
    data = fcm.respond(scene_of(Cubic(0.1, 0.02), frequency=[0.9, 2.4]), "closed-form", harmonics=1)
    folds = np.sort(data.fold_frequency.values[0])
    assert len(folds) == 2
    between = (data.frequency[0] > folds[0] * 1.001) & (data.frequency[0] < folds[1] * 0.999)
    assert set(np.unique(data.stable[0][between])) == {0.0, 1.0}
    assert set(np.unique(data.stable[0][data.frequency[0] < folds[0] * 0.999])) == {1.0}
    assert "Hill" in data.attrs["summary"] and set(np.unique(data.regime[0])) == {""}


@pytest.mark.parametrize("asked", [{"method": "exact"}, {"sensitivity": True}])
def test_what_needs_more_than_its_forces_is_refused(asked):
    with pytest.raises(ResponseError, match=r'contact "joint": .* its own law gives'):
        fcm.respond(scene_of(Cubic(0.3, 0.1)), **asked)


class Wrong(fcm.ContactLaw):
    def __init__(self, force, change):
        self.force, self.change = force, change

    def forces(self, x, dx):
        return self.force(x), self.change(dx)


@pytest.mark.parametrize(
    ("law", "said"),
    [
        (Wrong(lambda x: x[0], lambda dx: dx), 'the law Wrong of the contact "joint": forces of shape'),
        (Wrong(lambda x: x, lambda dx: dx[0]), "changes of shape"),
        (Wrong(lambda x: x / 0.0 if x.any() else x, lambda dx: dx), "is not a finite number"),
    ],
)
def test_a_law_of_no_use_is_told(law, said):
    with pytest.raises(ContactLawError, match=said), np.errstate(all="ignore"):
        fcm.respond(scene_of(law), "closed-form")


@pytest.mark.parametrize(
    ("returned", "said"),
    [
        (lambda x, dx: x[0], r"an array of shape \(\d+,\)"),
        (lambda x, dx: x, r"an array of shape \(2, \d+\)"),  # of as many rows as there are to be arrays
        (lambda x, dx: (x, dx, x), "3 values"),
        (lambda x, dx: None, "a NoneType"),
    ],
)
def test_a_law_that_does_not_return_two_arrays_is_told_what_is_expected(returned, said):
    class Odd(fcm.ContactLaw):
        def forces(self, x, dx):
            return returned(x, dx)

    told = (
        rf'the law Odd of the contact "joint": forces\(x, dx\) has returned {said}. It is to return two '
        r"arrays: the forces, of shape \(2, \d+\) as x, and their changes, of \(2, \d+, 6\) as dx"
    )
    with pytest.raises(ContactLawError, match=told):
        fcm.respond(scene_of(Odd()), "closed-form")


class Doubled(Cubic):
    """The changes are twice what they should be."""

    def forces(self, x, dx):
        force, change = super().forces(x, dx)
        return force, 2.0 * change


@pytest.mark.parametrize("numbers", [{}, {"n_0": 0.0}, {"n_0": 2e-6}, {"k_u": 0.0}])
def test_changes_that_are_not_those_of_the_forces_are_told_before_anything_is_solved(numbers):
    contact = DATA["contact"][0] | numbers
    scene = scene_from_dict(DATA | {"contact": [contact]}, "own.toml").with_laws({"joint": Doubled(1.0, 0.1)})
    said = r'the law Doubled of the contact "joint": its changes are off by 1 from central differences'
    with pytest.raises(ContactLawError, match=said):
        fcm.respond(scene, "closed-form")
    for law in (Cubic(1.0, 0.1), Friction(0.4, 1.0, 0.5, 2.0), Friction(0.4, 1.0, 0.5, 2.0, 0.3)):
        check_own_laws(scene.with_laws({"joint": law}))


def test_contacts_that_cannot_have_it():
    scene = scene_from_dict(DATA, "own.toml")
    with pytest.raises(ValueError, match='no contact is called "joints"; there are "joint"'):
        scene.with_laws({"joints": Cubic(1.0, 0.0)})
    with pytest.raises(ValueError, match=r"no fcm\.ContactLaw"):
        scene.with_laws({"joint": lambda x: x})
    swept = scene_from_dict({**DATA, "sweep": {"contact.joint.k_u": [1.0, 2.0]}}, "own.toml")
    with pytest.raises(ValueError, match="are swept, which its own law has not"):
        swept.with_laws({"joint": Cubic(1.0, 0.0)})


PAIRS = {
    "modal": {"dofs": ["7x", "7y", "8x", "8y"], "frequency": [1.0] * 4, "damping": 0.1}
    | {"shapes": np.eye(4).tolist()},
    "contact": [
        {"name": "tip", "nodes": [[7], [8]], "tangential": "x", "normal": "y"}
        | {"mu": 0.4, "k_u": 1.0, "k_v": 1.0, "n_0": 1.0}
    ],
    "force": [{"dof": "7x", "amplitude": 1.0}],
    "response": {"frequency": [0.8, 1.6]},
}


def test_the_name_of_pairs_of_nodes_stands_for_all_of_them():
    scene, law, other = scene_from_dict(PAIRS), Cubic(1.0, 0.0), Cubic(2.0, 0.0)
    assert [one.law for one in scene.with_laws({"tip": law}).contacts] == [law, law]
    assert [one.law for one in scene.with_laws({"tip_2": other, "tip": law}).contacts] == [law, other]
    with pytest.raises(ValueError, match=r'"tipp"; there are "tip", "tip_1", "tip_2"$'):
        scene.with_laws({"tipp": law})


@pytest.mark.parametrize("swept", ["contact.tip.mu", "contact.*.mu"])
@pytest.mark.parametrize("name", ["tip", "tip_1"])
def test_swept_numbers_of_pairs_of_nodes_are_none_of_their_law(name, swept):
    scene = scene_from_dict(PAIRS | {"sweep": {swept: [0.1, 0.2]}})
    with pytest.raises(ValueError, match="are swept, which its own law has not"):
        scene.with_laws({name: Cubic(1.0, 0.0)})


def test_derivatives_that_are_none_are_told():
    class Off(Cubic):
        def forces(self, x, dx):
            force, change = super().forces(x, dx)
            return force, 1.1 * change

    x = np.random.default_rng(3).normal(size=(2, 6))
    assert Cubic(1.0, 0.5).off_by(x) < 1e-6 < 0.05 < Off(1.0, 0.5).off_by(x)
