"""The picture of the guide shows what it says."""

import numpy as np

from .fold_picture import calculated, draw


def test_curves_of_folds_cross_the_level_one_at_the_ends_of_the_closed_branch():
    picture = calculated()
    (closed,) = (one for one, is_closed in zip(picture.branches, picture.closed, strict=True) if is_closed)
    ends = np.array([closed[:, 0].min(), closed[:, 0].max()])
    off = np.abs(np.array(list(picture.crossings()))[:, None] / ends - 1.0)
    assert off.min(axis=0).max() < 1e-2 and off.min(axis=1).max() < 1e-2
    above, below = draw(picture).axes
    assert len(above.lines) >= len(picture.folds) and len(below.lines) >= len(picture.branches)
