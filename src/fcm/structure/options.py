"""Structure: tolerances and limits."""

from __future__ import annotations

from fcm.frozen import Frozen


class FlexibilityOptions(Frozen):
    """Displacement shapes that stand for the modes left out of a structure."""

    tolerance: float = 1e-6  # bound of the relative error of the receptance at which no more blocks are added
    max_blocks: int = 4  # most blocks of vectors, each by a further solution with the stiffness
    min_energy: float = 1e-10  # relative energy below which a displacement is a combination of the others
    static_tolerance: float = 1e-6  # relative error that the static displacements may have
    # number of displacements whose columns, as long as the structure has rows, are held at a time
    batch_size: int = 200
    # frequency of a mode that stands for rows without mass, relative to the highest of interest and of
    # those kept
    massless_ratio: float = 1e3


class DampingOptions(Frozen):
    """Options on how the effect of damping that a structure's modes leave out is estimated."""

    max_resonances: int = 60  # most resonances at and beside which two responses are compared
    # number of places between two of them: an effect between two places is then found to a fifth
    places_between: int = 4
    # most complex multiplications at all places, some tenths of a second: with many modes there are fewer
    # places
    max_multiplications: float = 3e8
    refined_places: int = 12  # number of further places beside the one with the greatest effect
    # negative damping coefficient, relative to the greatest, down to which it is rounding; below it is an
    # error
    rounding: float = 1e-9
    cancellation_tolerance: float = 1e-13  # sum of terms, relative to their sizes, up to which it is rounding
    # loss factor of a mode that nothing damps, at its own frequency alone
    min_loss_factor: float = 1e-9


class ReceptanceOptions(Frozen):
    """Options on how sums over the modes are made: they decide how fast, not what comes out."""

    blas_products: int = 4000  # number of multiplications of a sum above which it is left to BLAS
    many_ports: int = 4  # number of ports from which on the sums of all their pairs are computed side by side


class RetainedModeOptions(Frozen):
    """Options on which modes of a structure are kept, and what is reported of them."""

    min_modes: int = 10  # least number of modes that are kept, where no number is asked for
    frequency_factor: float = 3.0  # frequency up to which modes are kept, relative to the highest of interest
    # most displacements that nobody reports whose rounding is computed: it is greatest beside what moves
    # little
    max_stiff_displacements: int = 50
    # number of these displacements times rows, above which they are left out: each takes a solution
    max_products: int = 10_000_000
    full_size: int = 30  # number of rows up to which all modes are kept
    # first elastic eigenvalue relative to the shift, above which all modes are solved for again about
    # another shift: they have lost five digits
    max_shift_ratio: float = 1e5
    max_places: int = 8  # most places between resonances at which the rounding of a receptance is computed
    # most loads for which it is: of more contacts, those off most, or moving least, at rest
    max_loads: int = 24
    safety: float = 2.0  # factor on the rounding found at these places: beside them it is not much more
    # relative distance of squared frequencies from resonances that these places have at least
    min_resonance_distance: float = 0.01
    shape_tolerance: float = 1e-12  # relative difference of shapes up to which they are the same
    max_cached: int = 8  # most structures whose arrays are kept, as all curves of a sweep have the same
    # size of the terms of a shape, relative to it, above which it is not combined from others
    max_combination: float = 10.0


class RigidBodyOptions(Frozen):
    """Options that distinguish rigid-body modes from elastic ones."""

    # frequency relative to the next, up to which modes of an eigensolver are rigid-body modes
    rigid_ratio: float = 1e-3
    # sum of the terms of a mode's elastic energy, relative to their sizes, up to which it is rounding
    cancellation_tolerance: float = 4e-16
    # frequency relative to the next, up to which such a mode is a rigid-body mode
    max_cancelled_ratio: float = 0.1
    # stiffness over mass, relative to the largest ratio on the diagonals, up to which a mode may be rigid
    soft_stiffness: float = 1e-8
    # frequency relative to the next, up to which such a mode is a rigid-body mode
    max_soft_ratio: float = 1e-4
    # sum of the terms relative to their sizes, from which on the stiffness couples the rows of a mode to no
    # others
    uncoupled_share: float = 0.99
    uncoupled_stiffness: float = 1e-11  # the limit in place of `soft_stiffness` for such a mode
    # stiffness relative to the most negative one, up to which it is as little known
    negative_factor: float = 10.0
    # energy relative to its uncertainty by the digits of the entries, up to which a mode may be rigid
    standard_deviations: float = 4.0
    # frequency relative to the next, up to which such a mode is a rigid-body mode
    max_frequency_ratio: float = 0.3
    # part of the first elastic frequency above which it is said that soft modes may be taken for rigid ones
    doubtful_ratio: float = 0.03
    rounding: float = 1e-13  # sum of products, relative to their sizes, up to which it is zero
    # relative normal motion at the contacts up to which a rigid-body motion is not held by them
    min_normal_motion: float = 1e-9
    sampled_entries: int = 1000  # number of entries of a matrix whose digits are counted
    min_digits: int = 5  # fewest digits of entries that are looked for: fewer leave no structure
    max_digits: int = 15  # most digits of entries that are looked for: no number has more
    # fewest digits that are looked for where there are few entries: they may be exact, as somebody typed
    # them
    typed_digits: int = 7
    min_distinct_entries: int = 20  # number of different entries from which on they are not typed
    # sum of the terms relative to their sizes, and frequency relative to the next, up to which a mode may
    # be rigid
    nearly_rigid: tuple[float, ...] = (1e-6, 1e-4)
    # exponent by which that frequency may be nearer to the next, where the sum is less
    ratio_exponent: float = 0.36
    min_ratio: float = 0.03  # greatest frequency relative to the next in that case


FLEXIBILITY = FlexibilityOptions()
DAMPING = DampingOptions()
RECEPTANCE = ReceptanceOptions()
REDUCTION = RetainedModeOptions()
RIGID_BODY = RigidBodyOptions()
