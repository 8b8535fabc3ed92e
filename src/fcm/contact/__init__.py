"""One dimensionless contact (sections 2 to 4.2 of the paper): cycle, loop, Fourier coefficients.

The names below are imported at first use, as a harmonic balance needs few of them.
"""

import warnings
from importlib.util import find_spec
from typing import TYPE_CHECKING

from fcm.lazy_import import on_demand

if TYPE_CHECKING:
    from fcm.contact.contact_law import ContactLaw, ContactLawError
    from fcm.contact.fourier import fourier_coefficients, fourier_gradients
    from fcm.contact.loop import Loop, hysteresis_loop
    from fcm.contact.normal import normal_coefficients, normal_gradients
    from fcm.contact.periodic.coefficients import PeriodicGradients, periodic_forces, periodic_gradients
    from fcm.contact.periodic.loop import PeriodicLoop, periodic_loop
    from fcm.contact.plane.coefficients import PlanarGradients, planar_forces, planar_gradients
    from fcm.contact.plane.loop import PlanarLoop, planar_loop

__all__ = [
    "ContactLaw",
    "ContactLawError",
    "Loop",
    "PeriodicGradients",
    "PeriodicLoop",
    "PlanarGradients",
    "PlanarLoop",
    "fourier_coefficients",
    "fourier_gradients",
    "hysteresis_loop",
    "normal_coefficients",
    "normal_gradients",
    "periodic_forces",
    "periodic_gradients",
    "periodic_loop",
    "planar_forces",
    "planar_gradients",
    "planar_loop",
]

_HOME = {
    "ContactLaw": "contact_law",
    "ContactLawError": "contact_law",
    "Loop": "loop",
    "PeriodicGradients": "periodic.coefficients",
    "PeriodicLoop": "periodic.loop",
    "PlanarGradients": "plane.coefficients",
    "PlanarLoop": "plane.loop",
    "fourier_coefficients": "fourier",
    "fourier_gradients": "fourier",
    "hysteresis_loop": "loop",
    "normal_coefficients": "normal",
    "normal_gradients": "normal",
    "periodic_forces": "periodic.coefficients",
    "periodic_gradients": "periodic.coefficients",
    "periodic_loop": "periodic.loop",
    "planar_forces": "plane.coefficients",
    "planar_gradients": "plane.coefficients",
    "planar_loop": "plane.loop",
}

__getattr__ = on_demand(__name__, _HOME)


if (kernel := find_spec("fcm.contact.closed_form")) and str(kernel.origin).endswith(".py"):
    import multiprocessing

    if multiprocessing.parent_process() is None:  # worker processes need not repeat it
        warnings.warn(
            "the kernels of fcm run as Python, slowly: they were not compiled when it was installed, for "
            "want of a C compiler",
            RuntimeWarning,
            stacklevel=2,
        )
