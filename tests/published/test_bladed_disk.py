"""The lumped disk of 24 sectors of pyHarm's sixth tutorial, after Laxalde and others (2007), by that program.

Tuto_006_LumpedBladedDisk.ipynb prints the 72 frequencies of the whole disk in order, with ten digits:
those of nodal diameters 1 to 11 stand there twice, of 0 and 12 once.
"""

from __future__ import annotations

import numpy as np
import pytest

import fcm
from fcm.structure.ring import nodal_diameters

ONCE = [88.26374399, 195.67605066, 249.31165161, 617.32579659, 619.34330474, 2062.97567761]  # Hz
TWICE = [169.3441295, 189.3018526, 193.0496227, 194.33310084, 194.91823247, 195.23065575, 195.41408815]
TWICE += [195.52784525, 195.59979933, 195.64415084, 195.66835088, 335.56537939, 555.31017863, 615.15017797]
TWICE += [616.585022, 616.96341859, 617.12696788, 617.21324764, 617.2635722, 617.29423701, 617.31270821]
TWICE += [617.32265229, 619.82021678, 626.2025859, 810.0067968, 1044.51877441, 1264.6832341, 1464.72871426]
TWICE += [1640.60424871, 1789.01493852, 1907.27068187, 1993.2626374, 2045.47055708]


@pytest.fixture(scope="module")
def diameters():
    return nodal_diameters(fcm.load_scene("bladed-disk"))


def test_first_frequencies_of_the_lowest_diameters(diameters):
    assert [one.number for one in diameters] == list(range(13))
    found = [one.opened[0] / (2.0 * np.pi) for one in diameters[:3]]
    assert found == pytest.approx([ONCE[0], *TWICE[:2]], rel=5e-10)


def test_all_frequencies_of_the_whole_disk(diameters):
    counted = [(one.opened / (2.0 * np.pi), 1 if one.number in (0, 12) else 2) for one in diameters]
    found = np.sort(np.concatenate([np.repeat(frequency, times) for frequency, times in counted]))
    assert found == pytest.approx(np.sort([*ONCE, *TWICE, *TWICE]), rel=5e-10)
