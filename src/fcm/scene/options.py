"""Scene: tolerances and limits."""

from __future__ import annotations

from fcm.frozen import Frozen


class TomlOptions(Frozen):
    """Limits of the text of a scene, and of what is looked for in a faulty one."""

    # [s] time without a byte from a pipe after which it is said that the scene is awaited
    patience: float = 2.0
    # [byte] largest scene: a larger one is a mistake, or its modes belong in a file of their own
    largest_file: int = 10_000_000
    # most parts of a dotted key: the parser takes the square of their number in time and memory
    deepest_key: int = 16
    most_slips: int = 30  # most mistakes of writing that are looked for in one file
    most_read: int = 5_000_000  # most characters that are read to try remedies, in all: some seconds
    longest_mended: int = 2_000  # most characters of a line in which a remedy is looked for
    longest_line: int = 70  # most characters that are shown of a line; of a longer one those that change
    # number of lines before the one where reading ends, on which a bracket may be missing
    lines_before: int = 3


class MessageOptions(Frozen):
    """Options on how much messages about a scene show."""

    mistakes: int = 30  # most mistakes that are listed one by one; the rest are counted
    longest_value: int = 60  # most characters of a value shown in a message
    names_compared: int = 2000  # most names that a misspelt one is compared with
    nearest_number: int = 10  # greatest difference of a node's number from the one that may be meant
    entries: int = 3  # most entries of a matrix that a message names
    longest_path: int = 400  # most characters of a path shown in a message
    known_keys: int = 8  # number of a table's keys up to which all are named beside one that is not known
    faults: int = 5  # most faults of a file beside a scene that are said one by one
    groups: int = 3  # most groups of contacts, or of names, in one sentence
    stuck_modes: int = 3  # most modes whose frequencies are said, while all contacts stick
    # relative change of the response by damping that is left out, above which it is said
    damping_left_out: float = 1e-4
    # [byte] memory that directions of contacts take in a large structure, above which it is said
    memory: float = 2e9
    seconds_of_draws: float = 5.0  # [s] time of drawing numbers, above which it is said before
    # relative excess of a start's friction over the limit of its contact, up to which nothing is said
    start_rounding: float = 1e-9
    # frequency of the highest mode relative to the range's end, below which it is said that modes are
    # missing, unless their flexibility is kept
    range_above: float = 2.0
    # stiffness of a contact relative to the structure's there, above which it is asked about
    stiff_contact: float = 1e6
    # relative change of a resonance while all contacts stick, below which it is asked about: friction then
    # adds no damping ratio beyond about 1e-3
    soft_contacts: float = 2.5e-3
    # ratio of a contact's stiffnesses, or its inverse, above which it is asked about: metal faces and a slip
    # of units by a thousand leave it that large
    unequal_springs: float = 300.0
    # ratio of a gap to a bound of the motion there, above which it is asked about
    far_gap: float = 10.0
    # distance from the ends of the range, relative to it in logarithms, that a mode has to have where a
    # slip of units would put it
    range_margin: float = 0.05
    flat_face: float = 0.01  # distance from its plane, relative to its width, up to which a face is flat
    leaning_normal: float = 10.0  # [degree] angle to a flat face's own, beyond which a normal is asked about
    # ratio of the range's begin to the first resonance, above which it is asked about
    far_below: float = 10.0
    # ratio of the range's ends to a mode's frequency, or its inverse, within which the mode is near the
    # range
    range_near: float = 2.0


class FrictionDampingOptions(Frozen):
    """The estimate of how much friction can damp each resonance."""

    modes: int = 10  # number of modes of which the estimate is made
    # number of values of theta that are tried, from the least up to pi, in a geometric series
    angles: int = 48
    least_angle: float = 1e-2  # [rad] least value of theta that is tried


class LimitOptions(Frozen):
    """Limits of what a scene may request, and of the values of its numbers."""

    # largest magnitude of a number: larger ones overflow when three of them are multiplied
    largest: float = 1e100
    smallest: float = 1e-100  # least magnitude of a number that is divided by
    harmonics: int = 50  # the greatest harmonic that can be asked for
    # shortest step relative to a curve's extent: the curve then has a hundred thousand points and more
    shortest_step: float = 1e-5
    longest_step: float = 0.05  # longest step relative to a curve's extent, where the scene names none
    narrowest: float = 1e-10  # least relative width of a range: its points are still some 1e5 roundings apart
    # [byte] longest name: "contact.NAME.tangential.NAME" is the name of a variable of a file, 256 at most
    longest_name: int = 100
    fitted: int = 20  # most numbers that are fitted together
    chosen: int = 3  # most numbers that are chosen together by [optimum]
    # factor on the value in the scene, up to which a number may be chosen where no bounds are given
    optimum_range: float = 10.0
    cycles: int = 10_000_000  # most cycles of all phases of a schedule, hours of computing
    curves: int = 1_000_000  # most curves of a sweep
    bytes_of_curve: float = 1000.0  # [byte] memory of the numbers of one curve of a sweep
    draws_timed: int = 8  # number of draws of a number that are timed before all are made
    draws_seconds: float = 600.0  # [s] longest time of all draws of a number; with more they are refused
    mistuning: float = 0.5  # factor of every blade below which more likely a deviation is meant
    friction: float = 2.0  # coefficient of friction above which more likely a percentage is meant
    # damping ratio of every mode from which on no resonance is seen, and a percentage may be meant
    damping_of_all: float = 0.2
    # the same of a scene with units, thus of a real structure: bolted ones have some 0.01 to 0.03
    damping_with_units: float = 0.1
    # damping ratio from which on a mode does not vibrate, and more likely a percentage is meant
    damping_ratio: float = 1.0
    # number of degrees of freedom up to which all are in the results, where no others are asked for
    reported: int = 50
    # [byte] memory for each row of matrices that the flexibility along a direction takes, measured
    bytes_of_direction: float = 8 * 14
    # frequency relative to the range's lower end, below which it is far below everything that is traced
    of_no_interest: float = 0.01
    outputs: int = 30  # most degrees of freedom of results whose own flexibility is kept
    # number of rows from which on a structure is a mesh, whose highest modes are above any range
    mesh_rows: int = 100


class InputFileOptions(Frozen):
    """Limits of files beside a scene, and of the process that reads them."""

    # [byte] largest file beside a scene, unpacked: what fits in any machine's memory twice
    largest: int = 1_000_000_000
    memory: int = 500_000_000  # [byte] memory for a reader itself
    copies: int = 3  # number of copies of the arrays in memory, while they are read, converted and written


class ToleranceOptions(Frozen):
    """Relative differences of a scene's numbers that are taken for none."""

    # negative eigenvalue of a correlation matrix, relative to its size, down to which it is one of zero
    correlation: float = 1e-12
    asymmetry: float = 1e-8  # relative difference of two entries that ought to be equal
    # difference relative to the largest entry of a matrix, up to which it is rounding
    negligible: float = 1e-12
    displacement: float = 1e-12  # displacement relative to the largest, up to which it is none
    # displacement in the shape of a mode relative to its largest, by the ratio of the greatest square of a
    # frequency to its own, up to which it is rounding: measured are 5e-16
    shape: float = 1e-14
    cancelled: float = 1e-14  # sum of forces relative to their sizes, up to which it is rounding
    # ratio of modal masses above which sums over the modes lose the heavy ones to rounding
    mass_ratio: float = 1e20
    # relative difference of the masses along the axes of a floating structure, up to which they are the
    # same
    floating_mass: float = 1e-3
    # ratio of the masses along the axes of a held structure, up to which the rows that are held explain it
    held_mass: float = 10.0
    # entries of a stiffness relative to those of full blocks of its coupled rows, up to which it is that of a
    # mesh, and not of a reduced structure
    mesh_entries: float = 0.5
    # relative difference of the masses along the axes of a mesh whose nodes are held as a whole, up to which
    # the elements at held nodes explain it: 4 % of the mass of each, 1/3 against 13/35, for a beam
    mesh_mass: float = 0.05
    # difference from 1 of the largest value of a shape, below which shapes were scaled to it
    scaled_shape: float = 1e-6
    same_direction: float = 1e-9  # difference of two directions up to which they are the same
    # relative difference of the frequencies of a ring's diameters, up to which they are those of one sector
    same_modes: float = 1e-9
    right_angle: float = 0.01  # sine of the angle by which a normal may lean: about half a degree
    # part of a direction, relative to it, by which its projection on a plane may be shorter, up to which it
    # lies in the plane
    square: float = 1e-6
    # relative difference of the lengths of two directions, or of one from 1, and cosine between two, up to
    # which they are of one length and at right angles: weights of three digits are so far off
    written: float = 2e-3
    # distance of a node from its place, relative to the extent of the places, or part of rigid-body motions
    # that does not fit: above it nodes are not where a file says
    placed: float = 0.05
    # square of a frequency, and relative change of one without damping, up to which it is rounding
    undamped: float = 1e-12
    equal_frequency: float = 1e-6  # relative difference of frequencies up to which they are the same
    # imaginary part of a ring's shape, relative to it, up to which it is real but for a factor
    rotated: float = 1e-8
    # relative difference of what two datasets write, up to which they mean the same mode
    same_mode: float = 1e-6
    # imaginary part of a shape that is turned to be real, relative to the shape, up to which it is real
    collinear: float = 1e-4


TOML = TomlOptions()
FRICTION_DAMPING = FrictionDampingOptions()
MESSAGES = MessageOptions()
LIMITS = LimitOptions()
FILES = InputFileOptions()
TOLERANCES = ToleranceOptions()
