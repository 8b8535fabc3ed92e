"""One contact, dimensionless (sections 2 to 4.2 of the paper): cycle, loop, Fourier coefficients."""

from fcm.contact.fourier import fourier_coefficients, fourier_gradients
from fcm.contact.loop import Loop, hysteresis_loop
from fcm.contact.normal import normal_coefficients, normal_gradients

__all__ = [
    "Loop",
    "fourier_coefficients",
    "fourier_gradients",
    "hysteresis_loop",
    "normal_coefficients",
    "normal_gradients",
]
