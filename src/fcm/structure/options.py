"""Structure: tolerances and limits."""

from __future__ import annotations

from fcm.frozen import Frozen


class FlexibilityOptions(Frozen):
    """Options on the displacement shapes that represent the modes left out of a structure."""

    tolerance: float = 1e-6  # bound of the relative error of the receptance at which no more blocks are added
    max_blocks: int = 4  # most blocks of vectors, each of which needs a further solution with the stiffness
    min_energy: float = 1e-10  # relative energy up to which a displacement is a combination of others
    static_tolerance: float = 1e-6  # relative error that the static displacements may have
    # number of displacements held at a time, each a column with as many entries as the structure has rows
    batch_size: int = 200
    # frequency of a mode that represents rows without mass, relative to the highest of interest and of the
    # kept modes
    massless_ratio: float = 1e3


class DampingOptions(Frozen):
    """Options on how the effect of damping that the uncoupled modes leave out is estimated."""

    max_resonances: int = 60  # most resonances at and next to which two responses are compared
    # number of places between two of them: an effect between two places is then found to a fifth
    places_between: int = 4
    # most complex multiplications at all places, some tenths of a second: with many modes there are fewer
    # places
    max_multiplications: float = 3e8
    refined_places: int = 12  # number of further places around the one with the greatest effect
    # negative damping coefficient, relative to the greatest, down to which it is rounding; below it is an
    # error
    rounding: float = 1e-9
    cancellation_tolerance: float = 1e-13  # sum of terms, relative to their sizes, up to which it is rounding
    # loss factor of an undamped mode, at its own frequency only
    min_loss_factor: float = 1e-9


class ReceptanceOptions(Frozen):
    """Options on how sums over the modes are computed; they affect the speed, not the results."""

    blas_products: int = 4000  # number of multiplications of a sum above which BLAS computes it
    many_ports: int = 4  # number of ports from which on the sums of all their pairs are computed side by side


class RetainedModeOptions(Frozen):
    """Options on which modes of a structure are kept, and how their rounding is estimated."""

    min_modes: int = 10  # least number of modes that are kept if no number is given
    frequency_factor: float = 3.0  # frequency up to which modes are kept, relative to the highest of interest
    # most displacements at other rows whose rounding is computed: it is greatest for those that move least
    max_stiff_displacements: int = 50
    # number of these displacements times rows above which they are left out: each needs a solution
    max_products: int = 10_000_000
    full_size: int = 30  # number of rows up to which all modes are kept
    # first elastic eigenvalue relative to the shift, above which all modes are computed again with another
    # shift: they have lost five digits
    max_shift_ratio: float = 1e5
    max_places: int = 8  # most places between resonances at which the rounding of a receptance is computed
    # most loads for which it is computed: of more, those with the greatest error or least motion at rest
    max_loads: int = 24
    safety: float = 2.0  # factor on the rounding found at these places: elsewhere it is not much more
    # least relative distance of these places from resonances, in squared frequency
    min_resonance_distance: float = 0.01
    shape_tolerance: float = 1e-12  # relative difference of shapes up to which they are the same
    max_cached: int = 8  # most structures whose arrays are cached; all curves of a sweep share one
    # size of the terms of a shape, relative to it, above which it is not combined from others
    max_combination: float = 10.0


class RigidBodyOptions(Frozen):
    """Options that distinguish rigid-body modes from elastic ones."""

    # frequency relative to the next, up to which modes of an eigensolver are rigid-body modes
    rigid_ratio: float = 1e-3
    # elastic energy of a mode, relative to the sizes of its terms, up to which it is rounding
    cancellation_tolerance: float = 4e-16
    # frequency relative to the next, up to which such a mode is a rigid-body mode
    max_cancelled_ratio: float = 0.1
    # stiffness over mass, relative to the largest ratio on the diagonals, up to which a mode may be rigid
    soft_stiffness: float = 1e-8
    # frequency relative to the next, up to which such a mode is a rigid-body mode
    max_soft_ratio: float = 1e-4
    # elastic energy relative to the sizes of its terms, from which on the stiffness does not couple the rows
    # of a mode to others
    uncoupled_share: float = 0.99
    uncoupled_stiffness: float = 1e-11  # the limit in place of `soft_stiffness` for such a mode
    # stiffness relative to the most negative one, up to which it is as uncertain
    negative_factor: float = 10.0
    # energy relative to its uncertainty by the digits of the entries, up to which a mode may be rigid
    standard_deviations: float = 4.0
    # frequency relative to the next, up to which such a mode is a rigid-body mode
    max_frequency_ratio: float = 0.3
    # part of the first elastic frequency above which a warning says that soft modes may count as rigid
    doubtful_ratio: float = 0.03
    rounding: float = 1e-13  # sum of products, relative to their sizes, up to which it is zero
    # relative normal motion at the contacts up to which a rigid-body motion is not held by them
    min_normal_motion: float = 1e-9
    sampled_entries: int = 1000  # number of entries of a matrix whose digits are counted
    min_digits: int = 5  # fewest digits that are tested: fewer leave no structure
    max_digits: int = 15  # most digits that are tested: no number has more
    # fewest digits that are tested if there are few entries: these may be exact, typed by somebody
    typed_digits: int = 7
    min_distinct_entries: int = 20  # number of different entries from which on they do not count as typed
    # elastic energy relative to the sizes of its terms, and frequency relative to the next, up to which a
    # mode may be rigid
    nearly_rigid: tuple[float, ...] = (1e-6, 1e-4)
    # exponent by which that frequency may be nearer to the next if the energy is less
    ratio_exponent: float = 0.36
    min_ratio: float = 0.03  # greatest frequency relative to the next in that case


FLEXIBILITY = FlexibilityOptions()
DAMPING = DampingOptions()
RECEPTANCE = ReceptanceOptions()
REDUCTION = RetainedModeOptions()
RIGID_BODY = RigidBodyOptions()
