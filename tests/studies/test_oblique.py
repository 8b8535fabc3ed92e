"""Two elastic bodies on an oblique plane beside the glued mesh, whose modes CalculiX finds itself."""

import shutil

import numpy as np
import pytest

from fcm.harmonic_balance.system import System
from fcm.nonlinear_modes.backbone import linear_modes
from fcm.scene.load import load_scene

from .oblique import frequencies, mesh, scene

pytestmark = pytest.mark.skipif(shutil.which("ccx") is None, reason="needs CalculiX")


@pytest.mark.slow
def test_contacts_that_stick_rigidly_are_the_glued_mesh(tmp_path):
    (glued, *_), (alone, *_) = (
        frequencies(tmp_path, name, mesh(**{name: True})) for name in ("glued", "alone")
    )
    found = load_scene(scene(tmp_path, stiffness=1e13))
    assert len(found.contacts) == 26
    assert any("26 pairs, of coincident nodes" in note for note in found.notes)
    assert any("30 degrees from x" in note for note in found.notes)
    system = System(found.in_use(), (1,))
    assert linear_modes(system, 1)[0].omega / (2.0 * np.pi) == pytest.approx(glued, rel=1e-4)
    assert np.sort(system.linear.natural)[:2] / (2.0 * np.pi) == pytest.approx([alone, alone], rel=1e-4)
    soft = System(load_scene(scene(tmp_path)).in_use(), (1,))
    assert alone < linear_modes(soft, 1)[0].omega / (2.0 * np.pi) < 0.97 * glued
