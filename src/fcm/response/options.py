"""The tolerances and limits with which responses are calculated and told of."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class InputLimits:
    """What is asked for and is more likely a mistake than meant.

    Attributes
    ----------
    accuracy : float
        Relative, of peaks and folds, where nothing else is said.
    frequency : float
        Times the highest natural frequency, beyond which a frequency is a mistake of units.
    level : float
        Level of the forces, beyond which it is a mistake of units.
    rest : float
        Level of the forces, below which the structure does not move.
    amplitudes : float
        Greatest ratio of the ends of a span of amplitudes.
    narrowest : float
        Relative width of a span: of a narrower one not even the first steps can be told from rounding.
    """

    accuracy: float = 1e-2
    frequency: float = 1e6
    level: float = 1e6
    rest: float = 1e-3
    amplitudes: float = 1e15
    narrowest: float = 1e-6


INPUT_LIMITS = InputLimits()


@dataclass(frozen=True)
class SentenceOptions:
    """How many things one sentence names.

    Attributes
    ----------
    dofs, harmonics, frequencies : int
        Of each kind at most.
    states : int
        Letters of a sequence of contact states: a contact that chatters has more, and the rest is cut off.
    resonant : float
        Relative distance of a harmonic's frequency from a resonance, up to which a curve stops at that.
    soft : float
        Times below that resonance the spring to the ground is that is advised: it shifts it by 1/1800.
    """

    dofs: int = 3
    harmonics: int = 6
    frequencies: int = 5
    states: int = 60
    resonant: float = 1e-5
    soft: float = 30.0


SENTENCES = SentenceOptions()


@dataclass(frozen=True)
class SweepOptions:
    """How the curves of a sweep are traced.

    Attributes
    ----------
    batch : int
        Curves that are finished or interrupted together.
    highest : int
        Harmonic that is expected to be the highest, where an accuracy decides.
    traced : float
        Share of the progress bar at which the curves are traced; then they are checked.
    rounds : int
        Of more harmonics, after which what is left is said.
    saved : float
        [s] after which finished curves are saved before their group is, and no kill can lose them.
    """

    batch: int = 10
    highest: int = 9
    traced: float = 0.9
    rounds: int = 4
    saved: float = 1.0


SWEEP = SweepOptions()


@dataclass(frozen=True)
class SteppedOptions:
    """How a sweep by steps of the frequency follows one motion.

    Attributes
    ----------
    far : float
        Distance along the curve, in units of the motion, that is not continued at once.
    astray : float
        Distance from what the direction foretells, relative to the way, beyond which a solution is on another
        branch;
    close : float
        but never within this distance, in units of the motion.
    smallest : float
        Part of the way between two frequencies that is not divided further: jumps are known to it.
    beyond : float
        Part of that way, past the end of a branch, where the motion is simulated: nearer it would linger.
    leap : float
        Part of the frequency by which a motion that repeats after no single period is taken at once,
    cycles : int
        and periods for which it is simulated after each leap.
    jump : float
        Relative change of an amplitude that is a jump.
    """

    far: float = 0.5
    astray: float = 0.6
    close: float = 0.05
    smallest: float = 1e-6
    beyond: float = 0.1
    leap: float = 0.005
    cycles: int = 10
    jump: float = 0.01


STEPPED = SteppedOptions()


@dataclass(frozen=True)
class ExactOptions:
    """How exact curves are calculated.

    Attributes
    ----------
    highest : int
        Harmonic up to which modes are kept as they are; what that does is measured.
    contacts : int
        Fewest of a scene of which some may be foreseen to keep their state.
    stiff : float
        [s] of processor time for a curve that a stiff contact may keep from ever being finished.
    beside : float
        Part of the time for a curve, that the search for what leads to further branches may take.
    high : float
        Part of the greatest amplitude of a degree of freedom: lower peaks of the balance are not the highest.
    near : float
        Relative error of peaks by one harmonic, beyond which one that is near enough has too many.
    """

    highest: int = 3
    contacts: int = 2
    stiff: float = 10.0
    beside: float = 0.5
    high: float = 0.9
    near: float = 0.1


EXACT_CURVES = ExactOptions()


@dataclass(frozen=True)
class ResumableOptions:
    """How often a curve is saved while it is followed.

    Attributes
    ----------
    often : float
        [s] between two savings at least,
    share : float
        which may take this part of the time.
    seldom : float
        [s] between two looks at the processor time, which takes long to tell on some machines.
    """

    often: float = 0.5
    share: float = 0.05
    seldom: float = 0.05


RESUMABLE = ResumableOptions()


@dataclass(frozen=True)
class CoexistingOptions:
    """Which motions at one frequency are the same.

    Attributes
    ----------
    orbits : float
        Relative difference of two periodic motions, below which they are one.
    within : float
        Relative difference of amplitudes, up to which a motion is within an extent.
    unique : float
        Relative range of amplitudes, below which they are the same.
    """

    orbits: float = 1e-5
    within: float = 1e-3
    unique: float = 1e-6


COEXISTING = CoexistingOptions()


@dataclass(frozen=True)
class ContactChangeOptions:
    """Which changes at a contact are rounding.

    Attributes
    ----------
    point : float
        Distance, in the problem's scale, that rounding may put between the same point of two problems.
    felt : float
        Change of a contact's load, relative to the residual friction of another: less is rounding.
    """

    point: float = 1e-8
    felt: float = 1e-9


CONTACT_CHANGES = ContactChangeOptions()


@dataclass(frozen=True)
class FittedResponseOptions:
    """How the response of a fit is traced.

    Attributes
    ----------
    rounds : int
        Of more harmonics, until the response takes no more than the fit had.
    fitting : float
        Share of the progress bar that is over when the numbers are found.
    """

    rounds: int = 3
    fitting: float = 0.8


FITTED_RESPONSE = FittedResponseOptions()


@dataclass(frozen=True)
class OptimumOptions:
    """How the least peak is found, and the curves of peaks on which it is.

    Attributes
    ----------
    rounds : int
        Of choosing harmonics by the accuracy at the optimum.
    counts : float
        Part of the greatest peak: those that are lower are none.
    seeking : float
        Share of the progress bar that is over when the optimum is found.
    place : float
        Relative difference of frequencies at which a peak was tracked and traced.
    dofs : int
        Degrees of freedom, up to which a curve is followed by all: their peaks are points of it.
    """

    rounds: int = 4
    counts: float = 1e-6
    seeking: float = 0.8
    place: float = 1e-6
    dofs: int = 50


OPTIMUM = OptimumOptions()
