"""What harmonics that are left out would do, and the unknowns of a balance that has them."""

import numpy as np
import pytest

from fcm.harmonic_balance.residual_spectrum import FurtherHarmonics
from fcm.harmonic_balance.system import System

from ..accuracy.calibration import with_estimated_errors
from .strips import strip
from .truth import scene


@pytest.fixture(scope="module")
def response():
    return with_estimated_errors(System(scene("yang1998", -5), (1, 2, 3)), 0.0)


def test_padding_keeps_the_motion(response):
    """The balance of more harmonics has the same amplitudes at the extended unknowns."""
    (path,) = response.traced.branches.paths
    more = (1, 2, 3, 5, 9)
    wider = response.system.with_harmonics(more)
    problem = wider.new_balance()
    z = path.z[len(path.z) // 2]
    wide = wider.extended(z, (1, 2, 3))
    problem.evaluate(wide)
    residual = np.asarray(problem.residual).reshape(1, -1)
    assert np.abs(residual[0, :14]).max() < 1e-8 * np.abs(z[:-1]).max()
    assert np.abs(residual[0, 14:]).max() > 0.0
    assert wide[-1] == z[-1]
    assert np.count_nonzero(wide) == np.count_nonzero(z)


def test_a_share_is_what_a_harmonic_then_has(response):
    """The ninth meets the mode at 10 rad/s; its share before it is balanced is about its amplitude after."""
    (path,) = response.traced.branches.paths
    top = response.quantities[0].amplitude[:, 1].argmax()
    further = FurtherHarmonics(response.system)
    amplitude = response.quantities[0].amplitude[top : top + 1]
    z = path.z[top : top + 1]
    share = further.shares(z, amplitude)[0]
    assert not further.linear(z)[0]
    assert (share[:3] == 0.0).all()
    others = share[3:].copy()
    assert others.argmax() + 4 == 9
    with_ninth = with_estimated_errors(response.system.with_harmonics((1, 2, 3, 9)), 0.0)
    problem = with_ninth.system.new_balance()
    highest = with_ninth.quantities[0].amplitude[:, 1].argmax()
    z = with_ninth.traced.branches.paths[0].z[highest]
    problem.evaluate(z)
    problem.evaluate_outputs(z, np.zeros_like(z))
    ninth = np.hypot(problem.displacements.re, problem.displacements.im)[3] / amplitude[0]
    assert share[8] == pytest.approx(ninth.max(), rel=0.3)


def test_a_contact_that_never_slips_or_opens_is_linear():
    found = with_estimated_errors(System(scene("yang1998", 100)), 0.0)
    (path,) = found.traced.branches.paths
    further = FurtherHarmonics(found.system)
    assert further.linear(path.z).all()
    assert (further.shares(path.z, found.quantities[0].amplitude) == 0.0).all()


def test_a_harmonic_meets_a_mode_where_its_frequency_is_that_of_the_mode(response):
    """The eleventh and the tenth meet that at 10 rad/s and lead there, each at the point next to that and at
    those beside it; the ninth meets it where the contact is stuck, and does nothing."""
    (path,), (quantities,) = response.traced.branches.paths, response.quantities
    further, wanted = FurtherHarmonics(response.system), set()
    for harmonic in (11, 10, 9):
        off = path.parameter - 10.0 / harmonic
        for k in np.flatnonzero(off[:-1] * off[1:] < 0.0):
            at = k if abs(off[k]) * path.parameter[k + 1] < abs(off[k + 1]) * path.parameter[k] else k + 1
            (share,) = further.shares(path.z[[at]], quantities.amplitude[[at]])
            if harmonic > 9:
                assert share[harmonic - 1] > 0.5 * share.max()
                wanted |= {at - 1, at, at + 1}
            else:
                assert share.max() == 0.0
    assert further.resonances(path.z, quantities.amplitude).tolist() == sorted(wanted)


def test_meetings_of_many_contacts_are_those_of_every_point_alone():
    """A harmonic that leads there meets a mode at the same points, be forces worked out at all or at some."""
    found = with_estimated_errors(System(strip(stiff=(4.02, 8.3, 11.4)), (1,)), 0.0)
    (path,), (quantities,) = found.traced.branches.paths, found.quantities
    further = FurtherHarmonics(found.system)
    alone = further.resonances(path.z, quantities.amplitude)
    many = further.resonances_of_many(path.z, quantities.amplitude)
    assert 3 <= len(alone) < 0.5 * len(path.z)
    assert many.tolist() == alone.tolist()
