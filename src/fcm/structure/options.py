"""Structure: tolerances and limits."""

from __future__ import annotations

from fcm.frozen import Frozen


class FlexibilityOptions(Frozen):
    """Modes that stand for those left out of a structure."""

    tolerance: float = 1e-6  # relative error of the receptance: no more blocks are taken
    max_blocks: int = 4  # of vectors, each by a further solution with the stiffness
    min_energy: float = 1e-10  # relative energy below which a displacement is a combination of the others
    static_tolerance: float = 1e-6  # relative: displacements as near to the static ones are static
    batch_size: int = 200  # displacements, for which as many numbers as rows are held at a time
    # times the frequencies of interest and those kept: there the mode of rows without mass stands
    massless_ratio: float = 1e3


class DampingOptions(Frozen):
    """The effect of damping that a structure's modes leave out."""

    max_resonances: int = 60  # at and beside which two responses are compared
    # places up to each next one: an effect between two of them is then seen to a fifth
    places_between: int = 4
    # complex multiplications of all places, some tenths of a second: with many modes there are fewer
    max_multiplications: float = 3e8
    refined_places: int = 12  # further places beside the one with the greatest effect
    rounding: float = 1e-9  # of the greatest coefficient: less negative than that is none
    cancellation_tolerance: float = 1e-13  # of the terms of a sum: what is left of them is rounding
    min_ratio: float = 1e-9  # of an undamped mode at its own frequency, relative


class ReceptanceOptions(Frozen):
    """How sums over the modes are made: they decide how fast, not what comes out."""

    blas_products: int = 4000  # of a sum, from which on BLAS is faster
    many_ports: int = 4  # from which on the sums of all their pairs go on side by side


class RetainedModeOptions(Frozen):
    """Which modes of a structure are kept, and what is reported of them."""

    min_modes: int = 10  # modes that are kept at least, where none are asked for
    frequency_factor: float = 3.0  # times the highest frequency of interest: modes up to there are kept
    # of other displacements whose rounding is looked at: it is greatest beside what moves little
    max_stiff_displacements: int = 50
    max_products: int = 10_000_000  # other rows times rows: each takes a solution, and more are not reported
    full_size: int = 30  # rows up to which all modes are kept
    # times the shift: a first elastic mode that is so much farther has lost five digits
    max_shift_ratio: float = 1e5
    max_places: int = 8  # places between resonances at which the rounding of a receptance is looked at
    # of many contacts, on which that is looked at: those off most, or moving least, at rest
    max_loads: int = 24
    safety: float = 2.0  # times what is found at these places: beside them it is not much more
    # how far squares of frequencies are from resonances at least, relative
    min_resonance_distance: float = 0.01
    shape_tolerance: float = 1e-12  # relative: shapes this near are the same
    max_cached: int = 8  # structures, as all curves of a sweep have the same
    max_combination: float = 10.0  # times a shape, of those that it is combined from


class RigidBodyOptions(Frozen):
    """What distinguishes rigid-body modes from elastic ones."""

    # of the next frequency: so low are rigid-body modes that come out of an eigensolver
    rigid_ratio: float = 1e-3
    # share of the elastic energy's terms that is left where it is rounding
    cancellation_tolerance: float = 4e-16
    max_cancelled_ratio: float = 0.1  # of the next frequency: a mode of such energy is below it
    # of the largest ratio of stiffness to mass on the diagonals: a mode below it may be rigid
    soft_stiffness: float = 1e-8
    max_soft_ratio: float = 1e-4  # of the next frequency: such a mode is below it
    uncoupled_share: float = 0.99  # share of its terms that a row has which the stiffness couples to no other
    uncoupled_stiffness: float = 1e-11  # `low`, where all rows of a mode are such
    negative_factor: float = 10.0  # times the most negative stiffness: what is no greater is as little known
    # of the energy by the digits of the entries: a mode of less may be rigid
    standard_deviations: float = 4.0
    max_frequency_ratio: float = 0.3  # of the next frequency: such a mode is below it
    # of the first elastic frequency: so near to it a soft mode may be taken for a rigid one
    doubtful_ratio: float = 0.03
    rounding: float = 1e-13  # relative: a sum of products this small is zero
    # relative normal motion at the contacts below which a rigid-body motion is not held by them
    min_normal_motion: float = 1e-9
    sampled_entries: int = 1000  # entries of a matrix whose digits are looked at
    min_digits: int = 5  # of entries: fewer leave no structure
    max_digits: int = 15  # of entries: more are all that there are
    typed_digits: int = 7  # fewer than that may be exact, as somebody typed them
    min_distinct_entries: int = 20  # different ones, of which even fewer digits are not typed
    # share of the terms that is left, and part of the next frequency: such a mode may be rigid
    nearly_rigid: tuple[float, ...] = (1e-6, 1e-4)
    # exponent by which the next frequency may be nearer, where less of the terms is left
    ratio_exponent: float = 0.36
    min_ratio: float = 0.03  # of the next frequency: it may be no nearer


FLEXIBILITY = FlexibilityOptions()
DAMPING = DampingOptions()
RECEPTANCE = ReceptanceOptions()
REDUCTION = RetainedModeOptions()
RIGID_BODY = RigidBodyOptions()
