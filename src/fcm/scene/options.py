"""Scene: tolerances and limits."""

from __future__ import annotations

from fcm.frozen import Frozen


class TomlOptions(Frozen):
    """Limits of the text of a scene, and of what is looked for in a faulty one."""

    patience: float = 2.0  # [s] without a byte from a pipe before that is said
    # bytes; a larger one is a mistake, or its modes belong in a file of their own
    largest_file: int = 10_000_000
    # parts of a dotted key: the parser takes the square of their number in time and memory
    deepest_key: int = 16
    most_slips: int = 30  # mistakes of writing that are looked for in one file
    most_read: int = 5_000_000  # characters that are read to try remedies, in all: some seconds
    longest_mended: int = 2_000  # characters of a line in which a remedy is looked for
    longest_line: int = 70  # characters that are shown of a line; of a longer one those that change
    lines_before: int = 3  # lines before the one where reading ends, on which a bracket may be missing


class MessageOptions(Frozen):
    """How much messages about a scene show."""

    mistakes: int = 30  # listed one by one; the rest are counted
    longest_value: int = 60  # characters of a value shown in a message
    names_compared: int = 2000  # names that a misspelt one is compared with
    nearest_number: int = 10  # by which that of a node may be off from the one that is meant
    entries: int = 3  # of a matrix that a message names
    longest_path: int = 400  # characters of a path shown in a message
    known_keys: int = 8  # of a table, which are all said beside one that is not known
    faults: int = 5  # of a file beside a scene that are said one by one
    groups: int = 3  # of contacts in one sentence
    stuck_modes: int = 3  # whose frequencies are said, while all contacts stick
    damping_left_out: float = 1e-4  # relative change of the response by damping that is left out
    # [byte] that directions of contacts take in a large structure: from here on it is said
    memory: float = 2e9
    seconds_of_draws: float = 5.0  # [s] from which on it is said before numbers are drawn
    start_rounding: float = 1e-9  # of the limit of the contact's force, by which a start may be off unsaid
    # times the range's end: modes ought to reach there, or their flexibility be kept
    range_above: float = 2.0
    # times the structure's flexibility there: stiffnesses of contacts beyond these are asked about
    stiff_contact: float = 1e6
    soft_contact: float = 5e-3  # friction then adds no damping ratio beyond about 1e-3
    # of the range, logarithmic: where a slip of units would put a mode it is so far from the ends
    range_margin: float = 0.05
    far_below: float = 10.0  # times: a first resonance so far below the range is asked about
    range_near: float = 2.0  # times the range's ends: a mode within that is near it


class FrictionDampingOptions(Frozen):
    """The estimate of how much friction can damp each resonance."""

    modes: int = 10  # of which it is made
    angles: int = 48  # values of theta that are tried, from the least up to pi, each so much greater
    least_angle: float = 1e-2  # [rad]


class LimitOptions(Frozen):
    """What a scene may ask for, and what a number of it may be."""

    largest: float = 1e100  # magnitudes beyond this overflow when three of them are multiplied
    smallest: float = 1e-100  # of numbers that are divided by
    harmonics: int = 50  # the greatest harmonic that can be asked for
    # relative to a curve's extent: it then has a hundred thousand points and more
    shortest_step: float = 1e-5
    longest_step: float = 0.05  # along a curve, when the scene names none
    narrowest: float = 1e-10  # relative width of a range: its points are still some 1e5 roundings apart
    # bytes: "contact.NAME.tangential.NAME" is the name of a variable of a file, 256 at most
    longest_name: int = 100
    fitted: int = 20  # numbers that are fitted together
    chosen: int = 3  # numbers that are chosen together by [optimum]
    # times its value in the scene, to which a number may go where no bounds are given
    optimum_range: float = 10.0
    cycles: int = 10_000_000  # of all phases of a schedule, hours of computing
    curves: int = 1_000_000  # of a sweep
    bytes_of_curve: float = 1000.0  # of the numbers of one curve of a sweep
    draws_timed: int = 8  # draws of a number that are timed before all are made
    draws_seconds: float = 600.0  # [s] longest time of all draws of a number
    friction: float = 2.0  # coefficient of friction: beyond it more likely a percentage is meant
    damping_of_all: float = (
        0.2  # of every mode: from here on no resonance is seen, and a percentage may be meant
    )
    damping_ratio: float = 1.0  # from here on a mode does not vibrate, and more likely a percentage is meant
    reported: int = 50  # degrees of freedom of which all are in the results, where no others are asked for
    # bytes at each row of matrices that the flexibility along a direction takes, measured
    bytes_of_direction: float = 8 * 14
    of_no_interest: float = 0.01  # of the range's lower end: a frequency far below everything that is traced
    outputs: int = 30  # degrees of freedom of results whose own flexibility is kept
    mesh_rows: int = 100  # from which a structure is a mesh, whose highest modes are above any range


class FileOptions(Frozen):
    """Limits of files beside a scene, and of the process that reads them."""

    # bytes of a file beside a scene, unpacked: what fits in any machine's memory twice
    largest: int = 1_000_000_000
    memory: int = 500_000_000  # [byte] for a reader itself
    copies: int = 3  # of the arrays, while they are read, converted and written


class ToleranceOptions(Frozen):
    """Relative differences of a scene's numbers that are taken for none."""

    # of a correlation matrix: an eigenvalue that is less below zero is one of zero
    correlation: float = 1e-12
    asymmetry: float = 1e-8  # relative difference of two entries that ought to be equal
    negligible: float = 1e-12  # of the largest entry of a matrix: differences this small are rounding
    displacement: float = 1e-12  # a displacement this small, beside the largest, is none
    cancelled: float = 1e-14  # of the sizes of forces: where no more is left of their sum, it is rounding
    mass_ratio: float = 1e20  # of modes: beyond it, sums over the modes lose the heavy ones to rounding
    floating_mass: float = 1e-3  # masses along axes of a structure that floats, which are the same
    scaled_shape: float = 1e-6  # how near to 1 the largest value of a shape is that was scaled to it
    same_direction: float = 1e-9  # directions that differ by no more are one
    same_modes: float = 1e-9  # frequencies of a ring's diameters that differ by no more are one sector's
    right_angle: float = 0.01  # sine of the angle by which a normal may lean: about half a degree
    square: float = 1e-6  # cosine of the angle between two directions at right angles, at most
    # of lengths of directions, and cosine of the angle between them: so far are weights of three digits off
    written: float = 2e-3
    placed: float = 0.05  # of the motion of rigid bodies: so far their nodes may be from where a file says
    undamped: float = 1e-12  # of a frequency without damping: rounding that nobody would notice
    equal_frequency: float = 1e-6  # of frequencies that are one
    rotated: float = 1e-8  # of ring shapes that are real but for a factor: what is left of the imaginary part
    same_mode: float = 1e-6  # of what two datasets write of one mode
    collinear: float = 1e-4  # of a shape: what may be left when it is turned to be real


TOML = TomlOptions()
FRICTION_DAMPING = FrictionDampingOptions()
MESSAGES = MessageOptions()
LIMITS = LimitOptions()
FILES = FileOptions()
TOLERANCES = ToleranceOptions()
