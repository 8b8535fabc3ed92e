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

    A subclass says what they are at equally spaced instants of one cycle. The harmonic balance takes their
    Fourier coefficients, and solves with their derivatives. Give it to a contact by
    `fcm.scene.Scene.with_laws`.

    Attributes
    ----------
    samples : int
        Instants of a cycle at least [-]; more for the highest harmonic that is asked for. What a law does
        faster than that folds back onto the harmonics of the balance, and no error shows it.

    Notes
    -----
    The forces are those beyond rest: of a motion that is zero they are subtracted. The mean of the normal
    force at rest is so the preload.

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
        """Forces of a motion over one cycle, and their change with the motion.

        Parameters
        ----------
        x : (direction, sample)
            Relative displacements over one cycle: along the tangential direction, or the two of a scene with
            a contact in a plane, and last the normal. They repeat themselves: what the law remembers has to
            as well, so that it goes through the cycle until it does.
        dx : (direction, sample, variation)
            Small changes of the motion.

        Returns
        -------
        force : (direction, sample)
            On the structure, as of a spring that resists: positive for a positive displacement.
        change : (direction, sample, variation)
            Of the forces with the motion, to first order in dx.
        """

    def off_by(self, x: FloatArray, step: float = 1e-6) -> float:
        """Greatest error of the changes of the forces against central differences, relative to the greatest
        change.

        x : (direction, sample), one motion about which each displacement is moved by step times the greatest.
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
