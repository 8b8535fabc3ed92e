"""Kernel: what gives the Fourier coefficients of the friction force of a contact, one at a time or many.

The closed form is one such law, a table another. The numbers of a point lie one after the other: F_b, F_s,
F_c, then the derivatives of each by n0_bar, b_bar and phi, twelve in all.
"""

import cython
import numpy as np

NAN = cython.declare(cython.double, float("nan"))


@cython.cclass
class CoefficientLaw:
    """Base class; a subclass defines `evaluate`."""

    def evaluate(
        self,
        n0_bar: float,
        b_bar: float,
        phi: float,
        gradient: bool,
        out: cython.double[::1],
        at: cython.Py_ssize_t,
    ) -> None:
        """The numbers of one point to out[at:], the first three or with the gradient all twelve.

        b_bar is not negative. Where an argument is NaN, or b_bar or phi infinite, they are NaN.
        """

    def unknown(self, gradient: bool, out: cython.double[::1], at: cython.Py_ssize_t) -> None:
        """NaN for each of the numbers."""
        i: cython.Py_ssize_t
        for i in range(12 if gradient else 3):
            out[at + i] = NAN

    def many(self, n0_bar: object, b_bar: object, phi: object, gradient: cython.bint) -> np.ndarray:
        """The numbers of many points, shape (3 or 12, ...); the arguments broadcast to the shape of the rest.

        Raises ValueError if an element of b_bar is negative.
        """
        n0, b, ph = (np.asarray(x, dtype=np.float64) for x in (n0_bar, b_bar, phi))
        if not n0.shape == b.shape == ph.shape:
            n0, b, ph = np.broadcast_arrays(n0, b, ph)
        shape = n0.shape
        numbers: cython.Py_ssize_t = 12 if gradient else 3
        out = np.empty((n0.size, numbers))
        # ravel copies what is not contiguous; elements of a memoryview, unlike an array's, are plain floats
        points = n0.ravel().data, b.ravel().data, ph.ravel().data
        if self._fill(points[0], points[1], points[2], gradient, out.reshape(-1).data, numbers):
            raise ValueError("b_bar is an amplitude and must not be negative; shift phi by pi instead")
        return out.T.reshape(numbers, *shape)

    def _fill(
        self,
        n0_bar: cython.const[cython.double][::1],  # type: ignore[valid-type]
        b_bar: cython.const[cython.double][::1],  # type: ignore[valid-type]
        phi: cython.const[cython.double][::1],  # type: ignore[valid-type]
        gradient: bool,
        out: cython.double[::1],
        numbers: cython.Py_ssize_t,
    ) -> bool:
        """Whether an element of b_bar is negative; if none is, all is done."""
        i: cython.Py_ssize_t
        with cython.nogil:
            for i in range(b_bar.shape[0]):
                if b_bar[i] < 0.0:
                    return True
                self.evaluate(n0_bar[i], b_bar[i], phi[i], gradient, out, i * numbers)
        return False
