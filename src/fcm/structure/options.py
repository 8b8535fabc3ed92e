"""Structure: tolerances and limits."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class FlexibilityOptions:
    """Modes that stand for those left out of a structure."""

    enough: float = 1e-6  # relative error of the receptance: no more blocks are taken
    most_blocks: int = 4  # of vectors, each by a further solution with the stiffness
    independent: float = 1e-10  # relative energy below which a displacement is a combination of the others
    near_static: float = 1e-6  # relative: displacements as near to the static ones are static
    together: int = 200  # displacements, for which as many numbers as rows are held at a time
    # times the frequencies of interest and those kept: there the mode of rows without mass stands
    massless: float = 1e3


@dataclass(frozen=True)
class DampingOptions:
    """The effect of damping that a structure's modes leave out."""

    most_resonances: int = 60  # at and beside which two responses are compared
    between: int = 4  # places up to each next one: an effect between two of them is then seen to a fifth
    # complex multiplications of all places, some tenths of a second: with many modes there are fewer
    work: float = 3e8
    finer: int = 12  # further places beside the one with the greatest effect
    rounding: float = 1e-9  # of the greatest coefficient: less negative than that is none
    cancelled: float = 1e-13  # of the terms of a sum: what is left of them is rounding
    least: float = 1e-9  # of an undamped mode at its own frequency, relative


@dataclass(frozen=True)
class RetainedModeOptions:
    """Which modes of a structure are kept, and what is told of them."""

    fewest: int = 10  # modes that are kept at least, where none are asked for
    above: float = 3.0  # times the highest frequency of interest: modes up to there are kept
    # of other displacements whose rounding is looked at: it is greatest beside what moves little
    stiffest: int = 50
    most_told: int = 10_000_000  # other rows times rows: each takes a solution, and more are not told of
    whole: int = 30  # rows up to which all modes are kept
    # times the shift: a first elastic mode that is so much farther has lost five digits
    most_lost: float = 1e5
    most_between: int = 8  # places between resonances at which the rounding of a receptance is looked at
    most_loads: int = (
        24  # of many contacts, on which that is looked at: those off most, or moving least, at rest
    )
    spare: float = 2.0  # times what is found at these places: beside them it is not much more
    apart: float = 0.01  # how far squares of frequencies are from resonances at least, relative
    same_shape: float = 1e-12  # relative: shapes this near are the same
    remembered: int = 8  # structures, as all curves of a sweep have the same
    most_combined: float = 10.0  # times a shape, of those that it is combined from


@dataclass(frozen=True)
class RigidBodyOptions:
    """What tells rigid-body modes from elastic ones."""

    # of the next frequency: so low are rigid-body modes that come out of an eigensolver
    far_below: float = 1e-3
    cancelled: float = 4e-16  # share of the elastic energy's terms that is left where it is rounding
    far: float = 0.1  # of the next frequency: a mode of such energy is below it
    # of the largest ratio of stiffness to mass on the diagonals: a mode below it may be rigid
    low: float = 1e-8
    little: float = 1e-4  # of the next frequency: such a mode is below it
    alone: float = 0.99  # share of its terms that a row has which the stiffness couples to no other
    lower: float = 1e-11  # `low`, where all rows of a mode are such
    as_negative: float = 10.0  # times the most negative stiffness: what is no greater is as little known
    deviations: float = 4.0  # of the energy by the digits of the entries: a mode of less may be rigid
    below: float = 0.3  # of the next frequency: such a mode is below it
    # of the first elastic frequency: so near to it a soft mode may be taken for a rigid one
    worth_saying: float = 0.03
    rounding: float = 1e-13  # relative: a sum of products this small is zero
    # relative normal motion at the contacts below which a rigid-body motion is not held by them
    held: float = 1e-9
    sample: int = 1000  # entries of a matrix whose digits are looked at
    fewest_digits: int = 5  # of entries: fewer leave no structure
    most_digits: int = 15  # of entries: more are all that there are
    typed_digits: int = 7  # fewer than that may be exact, as somebody typed them
    many_entries: int = 20  # different ones, of which even fewer digits are not typed
    # share of the terms that is left, and part of the next frequency: such a mode may be rigid
    nearly: tuple[float, ...] = (1e-6, 1e-4)
    steep: float = 0.36  # exponent by which the next frequency may be nearer, where less of the terms is left
    nearest: float = 0.03  # of the next frequency: it may be no nearer


FLEXIBILITY = FlexibilityOptions()
DAMPING = DampingOptions()
REDUCTION = RetainedModeOptions()
RIGID_BODY = RigidBodyOptions()
