"""Base class for user-defined contact laws: forces over a cycle of a motion and their derivatives."""

from __future__ import annotations

from abc import ABC, abstractmethod

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]


class ContactLawError(ValueError):
    """Raised for a contact law whose forces cannot be used; the message says why."""


class ContactLaw(ABC):
    """A user-defined contact law in Python: the forces of a contact on the structure in periodic motion.

    A subclass returns them at equally spaced instants of one cycle. The harmonic balance takes their Fourier
    coefficients, and solves with their derivatives. `fcm.scene.Scene.with_laws` gives a law to a contact.

    Attributes
    ----------
    samples : int
        Least number of instants of a cycle [-]; more are taken if the highest harmonic needs them. Harmonics
        of a law beyond them alias onto the harmonics of the balance, and no error shows it.

    Notes
    -----
    The forces are relative to rest: the forces of a zero motion are subtracted. So the mean normal force at
    rest is the preload.

    Examples
    --------
    A spring that hardens, f = k x + c x^3, along both directions:

    >>> import numpy as np
    >>> class Cubic(ContactLaw):
    ...     def __init__(self, k, c):
    ...         self.k, self.c = k, c
    ...     def forces(self, x, dx):
    ...         return self.k * x + self.c * x**3, (self.k + 3 * self.c * x**2)[..., None] * dx
    >>> Cubic(1.0, 0.5).off_by(np.random.default_rng(1).normal(size=(2, 8))) < 1e-6
    True
    """

    samples: int = 256

    @abstractmethod
    def forces(self, x: FloatArray, dx: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Forces of a motion over one cycle, and their changes with the motion.

        Parameters
        ----------
        x : (direction, sample)
            Relative displacements over one cycle: along one tangential direction (two for a contact in a
            plane), and last the normal. They are periodic. A law with memory has to pass through the cycle
            until its memory is periodic as well.
        dx : (direction, sample, variation)
            Small changes of the motion.

        Returns
        -------
        force : (direction, sample)
            On the structure, as of a spring that resists: positive at a positive displacement.
        change : (direction, sample, variation)
            Changes of the forces, to first order in dx.
        """

    def off_by(self, x: FloatArray, step: float = 1e-6) -> float:
        """Greatest error of the changes of the forces against central differences.

        It is relative to the greatest change.

        x : (direction, sample), the motion; each of its displacements is moved by step times the greatest.
        """
        x = np.asarray(x, dtype=np.float64)
        size = step * float(np.abs(x).max())
        every = np.eye(x.size).reshape(*x.shape, x.size)
        change = self.forces(x, every)[1]
        none = np.zeros((*x.shape, 1))
        moved = [size * every[..., k] for k in range(x.size)]
        two = [(self.forces(x + one, none)[0], self.forces(x - one, none)[0]) for one in moved]
        differences = np.stack([(a - b) / (2.0 * size) for a, b in two], axis=-1)
        return float(np.abs(change - differences).max() / np.abs(differences).max())
