"""Draws of any distribution of scipy.stats, and their correlation."""

import re

import numpy as np
import pytest
from scipy import stats

from fcm.scene import scene_from_dict
from fcm.scene.options import LIMITS

MU, N_0, K_U = "contact.shroud.mu", "contact.shroud.n_0", "contact.shroud.k_u"


def drawn(data, **sweep):
    curves = scene_from_dict(data | {"sweep": sweep}).curves
    return np.array([tuple(curve.parameters.values()) for curve in curves]).T


@pytest.mark.parametrize(
    ("name", "shapes"),
    [
        ("lognorm", {"s": 0.2, "scale": 0.4}),
        ("weibull_min", {"c": 2.0, "loc": 1.0, "scale": 3.0}),
        ("truncnorm", {"a": -1.0, "b": 2.0, "loc": 5.0, "scale": 0.5}),
        ("beta", {"a": 2.0, "b": 5.0}),
        ("triang", {"c": 0.3, "loc": 1.0}),
        ("expon", {}),
        ("randint", {"low": 2, "high": 9}),
    ],
)
def test_draws_have_their_distribution(data, name, shapes):
    (values,) = drawn(data, **{N_0: {"distribution": name, "count": 2000, "seed": 4} | shapes})
    own = getattr(stats, name)(**shapes)
    low, high = own.interval(0.8)
    assert values.mean() == pytest.approx(own.mean(), abs=4.0 * own.std() / np.sqrt(values.size))
    assert np.mean((low <= values) & (values <= high)) == pytest.approx(
        own.cdf(high) - own.cdf(low - 1e-9), abs=0.04
    )


def test_they_depend_on_seed_and_key_alone(data):
    form = {"distribution": "expon", "count": 50, "seed": 1}
    alone = drawn(data, **{N_0: form})[0]
    assert np.array_equal(drawn(data, **{MU: form, N_0: form})[1], alone)
    assert not np.array_equal(drawn(data, **{MU: form, N_0: form})[0], alone)
    assert not np.array_equal(drawn(data, **{N_0: form | {"seed": 2}})[0], alone)


def test_a_correlation_is_that_of_the_normal_scores(data):
    """And leaves each distribution as it is."""
    count, rho = 4000, np.array([[1.0, 0.7, -0.5], [0.7, 1.0, 0.0], [-0.5, 0.0, 1.0]])
    forms = {
        MU: {"distribution": "lognorm", "s": 0.2, "scale": 0.4, "count": count},
        N_0: {"normal": [5.0, 0.5], "count": count, "seed": 3},
        K_U: {"uniform": [1.0, 2.0], "count": count},
    }
    correlation = {"keys": [MU, N_0, K_U], "matrix": rho.tolist()}
    values = drawn(data, **forms, correlation=correlation)
    assert values.shape == (3, count)
    marginals = stats.lognorm(s=0.2, scale=0.4), stats.norm(5.0, 0.5), stats.uniform(1.0, 1.0)
    scores = [stats.norm.ppf(own.cdf(x)) for own, x in zip(marginals, values, strict=True)]
    assert np.corrcoef(scores) == pytest.approx(rho, abs=0.05)
    for own, x in zip(marginals, values, strict=True):
        assert stats.kstest(x, own.cdf).pvalue > 1e-3
    again = drawn(data, **forms, correlation=correlation)
    assert np.array_equal(again, values)


def test_keys_in_full_correlation_are_functions_of_one_another(data):
    form = {"normal": [5.0, 0.5], "count": 20}
    correlation = {"keys": [N_0, K_U], "matrix": [[1.0, -1.0], [-1.0, 1.0]]}
    n_0, k_u = drawn(data, **{N_0: form, K_U: form}, correlation=correlation)
    assert n_0 + k_u == pytest.approx(10.0)


REFUSED = [
    (
        {"distribution": "lognrom", "count": 2},
        'no distribution "lognrom" in scipy.stats; did you mean "lognorm"?',
    ),
    ({"distribution": "gauss", "count": 2}, 'distribution "gauss" in scipy.stats; did you mean "norm"?'),
    ({"distribution": "Gaussian", "count": 2}, 'did you mean "norm"?'),
    ({"distribution": "rv_continuous", "count": 2}, "there is no distribution"),
    ({"distribution": 3, "count": 2}, "must be a string"),
    ({"distribution": "", "count": 2}, 'distribution: is empty; name one of scipy.stats, such as "lognorm"'),
    ({"distribution": "lognorm", "count": 2}, '.s: missing; give a number'),
    ({"distribution": "expon", "sacle": 2, "count": 2}, 'sacle: unknown key; did you mean "scale"?'),
    ({"distribution": "expon", "scale": 0, "count": 2}, "scale: must be greater than 0, is 0"),
    ({"distribution": "beta", "a": -1, "b": 1, "count": 2}, "beta has no values with a = -1, b = 1"),
    ({"distribution": "expon"}, "count: missing; give a whole number"),
    ({"distribution": "randint", "low": 1, "high": 3, "scale": 2, "count": 2}, "scale: unknown key"),
]  # fmt: skip


@pytest.mark.parametrize(("form", "words"), REFUSED)
def test_distributions_that_are_refused(data, mistakes, form, words):
    data["sweep"] = {N_0: form}
    assert words in mistakes(data)


def test_values_that_a_number_may_not_have_are_counted(data, mistakes):
    data["sweep"] = {K_U: {"distribution": "norm", "count": 1000}}
    assert "of its 1000 values are not allowed; the first must be at least 0" in mistakes(data)


PLAIN = {"normal": [5.0, 0.1], "count": 3}
WRONG = [
    ({"keys": [N_0, K_U]}, "correlation.matrix: missing"),
    ({"matrix": [[1.0]]}, "correlation.keys: missing"),
    ({"keys": N_0, "matrix": [[1]]}, "keys: must be a list of strings"),
    ({"keys": [N_0], "matrix": [[1]]}, "two keys or more"),
    ({"keys": [N_0, MU], "matrix": [[1, 0], [0, 1]]}, f'"{MU}" is not drawn: its values are given'),
    ({"keys": [N_0, "contact.shroud.k_w"], "matrix": [[1, 0], [0, 1]]}, '"contact.shroud.k_w" is not swept'),
    ({"keys": [N_0, "contact.shroud.k_v"], "matrix": [[1, 0], [0, 1]]}, "but have 3 and 4 draws"),
    ({"keys": [N_0, K_U], "matrix": [[1, 0.5], [0.4, 1]]}, "[0][1] is 0.5 and [1][0] is 0.4"),
    ({"keys": [N_0, K_U], "matrix": [[1, 2], [2, 1]]}, "numbers from -1 to 1"),
    ({"keys": [N_0, K_U], "matrix": [[2, 0], [0, 1]]}, "1 everywhere on its diagonal"),
    ({"keys": [N_0, K_U], "matrix": [[1, 0]]}, "must be square, is 1 rows of 2"),
    ({"keys": [N_0, K_U], "matrix": [[1, "a"], [0, 1]]}, 'matrix[0][1]: must be a number, is the string "a"'),
    ({"keys": [N_0, K_U], "matrix": [[1, 0, 0], [0, 1, 0], [0, 0, 1]]}, "has 3 rows, but there are 2 keys"),
    ({"keys": [N_0, K_U], "matrix": 1}, "must be a list of rows"),
    ({"keys": [N_0, K_U], "matrix": []}, "matrix: is empty; give a row for each key"),
    (
        {"keys": [N_0, K_U, "modal.damping"], "matrix": [[1, 0.9, 0.9], [0.9, 1, -0.9], [0.9, -0.9, 1]]},
        "negative eigenvalue",
    ),
    ({"keys": [N_0, K_U], "matrix": [[1, 0], [0, 1]], "kind": 1}, "kind: unknown key"),
]  # fmt: skip


@pytest.mark.parametrize(("correlation", "words"), WRONG)
def test_correlations_that_are_refused(data, mistakes, correlation, words):
    data["sweep"] = {
        N_0: PLAIN, K_U: PLAIN, "modal.damping": {"uniform": [0.01, 0.02], "count": 3}, MU: [0.1, 0.2],
        "contact.shroud.k_v": PLAIN | {"count": 4}, "correlation": correlation,
    }  # fmt: skip
    assert words in mistakes(data)


def test_all_mistakes_of_draws_at_once(data, mistakes):
    data["sweep"] = {
        N_0: {"distribution": "lognrom", "count": 2},
        K_U: {"normal": [1, -1], "count": 2},
        "correlation": {"keys": [N_0, K_U], "matrix": [[1, 2], [2, 1]]},
    }
    assert "3 mistakes" in mistakes(data)


def test_a_deviation_in_percent_of_its_mean_is_refused_with_what_it_comes_to(data, mistakes):
    said = mistakes(data | {"sweep": {N_0: PLAIN | {"normal": [-3.0, "20 %"]}}})
    assert 'normal[1]: "20 %" is no number: the standard deviation is in the units of the key' in said
    assert said.rstrip().endswith("write 0.6")


def test_draws_that_would_take_days_are_told_before_they_are_made(data, mistakes):
    """Of a distribution of which each takes milliseconds; few of them are drawn all the same."""
    slow = {"distribution": "norminvgauss", "a": 1.25, "b": 0.5, "count": 1_000_000}
    said = "".join(mistakes(data | {"sweep": {N_0: slow}}))
    found = re.search(
        r"1000000 draws of this distribution take about \d+ \w+, (\S+) s each: give (\d+)", said
    )
    assert 0.9 < float(found[1]) * float(found[2]) / LIMITS.draws_seconds < 1.1
    assert drawn(data, **{N_0: slow | {"count": 10}})[0].size == 10
