"""Of many places at once: the products that vanish where multipliers leave, and where a dip is foretold."""

from __future__ import annotations

from itertools import combinations

import numpy as np

from fcm.stability.bifurcation_functions import (
    MultiplierSample,
    predicted_minima,
    predicted_minimum,
    products,
)


def test_products_of_multipliers_are_determinants():
    """prod (1 + l_i) = det(I + A), and prod (1 - l_i l_j) = det(I - B) with B on the planes of A."""
    rng, size = np.random.default_rng(1), 6
    for _ in range(5):
        frame = rng.normal(size=(size, size))
        turns = [
            0.9 * np.array([[np.cos(a), -np.sin(a)], [np.sin(a), np.cos(a)]]) for a in rng.uniform(0, 3, 2)
        ]
        blocks = np.zeros((size, size))
        blocks[:2, :2], blocks[2:4, 2:4], blocks[4, 4], blocks[5, 5] = *turns, -0.8, 0.6
        matrix = frame @ blocks @ np.linalg.inv(frame)
        planes = list(combinations(range(size), 2))
        on_planes = [[np.linalg.det(matrix[np.ix_(row, column)]) for column in planes] for row in planes]
        flip, pair = products(np.linalg.eigvals(matrix)[None].astype(complex))
        assert np.isclose(np.exp(flip[0]), abs(np.linalg.det(np.eye(size) + matrix)), rtol=1e-9)
        assert np.isclose(np.exp(pair[0]), abs(np.linalg.det(np.eye(len(planes)) - on_planes)), rtol=1e-7)


def test_a_dip_is_foretold_at_once_where_it_is_one_by_one():
    rng = np.random.default_rng(2)
    s = np.cumsum(rng.choice([0.0, 1e-16, 5e-4, 0.01, 0.1, 0.3], 400) * rng.uniform(0.5, 1.0, 400))
    flip, none = np.log(rng.uniform(0.0, 1.0, s.size) ** 3), np.zeros(s.size)
    places = [
        MultiplierSample(*row) for row in zip(s.tolist(), none + 1.0, none, flip.tolist(), none, strict=True)
    ]
    sides = [[], []]
    for k in range(len(places) - 2):
        three = places[k : k + 3]
        for i, side in enumerate(sides):
            side.append(predicted_minimum(three[i], three[i + 1], three) is not None)
    found = predicted_minima(s, flip, logarithms=True)
    assert 20 < np.sum(found) < 700
    assert np.array_equal(found, sides)
