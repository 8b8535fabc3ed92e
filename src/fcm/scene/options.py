"""Options for reading scenes: tolerances and limits."""

from __future__ import annotations

from fcm.frozen import Frozen


class TomlOptions(Frozen):
    """Limits of the text of a scene, and of the search for mistakes in a faulty one."""

    # [s] time without a byte from a pipe after which a message says that the program waits for the scene
    patience: float = 2.0
    # [byte] largest scene: a larger one is a mistake, or its modes belong in a separate file
    largest_file: int = 10_000_000
    # most parts of a dotted key: the parser's time and memory grow with the square of their number
    deepest_key: int = 16
    most_slips: int = 30  # most syntax mistakes that are reported for one file
    most_read: int = 5_000_000  # most characters parsed to try remedies, in total: some seconds
    longest_mended: int = 2_000  # most characters of a line for which remedies are tried
    longest_line: int = 70  # most characters shown of a line; a longer line is cut to the changed part
    # number of lines, before that where parsing fails, on which a missing bracket is searched for
    lines_before: int = 3


class MessageOptions(Frozen):
    """Options on how much messages about a scene show."""

    mistakes: int = 30  # most mistakes that are listed one by one; the rest are counted
    longest_value: int = 60  # most characters of a value shown in a message
    names_compared: int = 2000  # most names that a misspelt one is compared with
    nearest_number: int = 10  # greatest difference of a mistyped node number from the suggested one
    entries: int = 3  # most entries of a matrix that a message names
    longest_path: int = 400  # most characters of a path shown in a message
    known_keys: int = 8  # an unknown key is answered with all keys of its table, if these are not more
    faults: int = 5  # most faults of a data file that are listed one by one
    groups: int = 3  # most groups of contacts, or of names, in one sentence
    stuck_modes: int = 3  # most modes with all contacts stuck whose frequencies are reported
    # relative change of the response by omitted damping above which it is reported
    damping_left_out: float = 1e-4
    # [byte] memory for the directions of contacts of a large structure above which it is reported
    memory: float = 2e9
    seconds_of_draws: float = 5.0  # [s] time of drawing numbers above which it is announced
    # relative excess of a start's friction over the limit of its contact that is rounding
    start_rounding: float = 1e-9
    # frequency of the highest mode relative to the end of the range, below which modes are reported as
    # missing, unless their flexibility is kept
    range_above: float = 2.0
    # ratio of a contact's stiffness to that of the structure there, above which it is questioned
    stiff_contact: float = 1e6
    # relative change of a resonance if all contacts stick, below which the contacts are questioned: friction
    # then adds a damping ratio of at most about 1e-3
    soft_contacts: float = 2.5e-3
    # ratio of a contact's two stiffnesses above which they are questioned; for metal faces a unit mistake
    # by a thousand makes it that large
    unequal_springs: float = 300.0
    # ratio of a gap to a bound of the motion there, above which the gap is questioned
    far_gap: float = 10.0
    # least distance of a mode from the ends of the range, relative to the range in logarithms, if a unit
    # mistake is to explain the mode
    range_margin: float = 0.05
    flat_face: float = 0.01  # distance of nodes from their plane, relative to its width, of a flat face
    leaning_normal: float = 10.0  # [degree] angle to that of a flat face above which a normal is questioned
    # ratio of the lower end of the range to the first resonance above which it is questioned
    far_below: float = 10.0
    # ratio of the range's ends to a mode's frequency, or its inverse, up to which the mode is near the
    # range
    range_near: float = 2.0


class FrictionDampingOptions(Frozen):
    """Options of the estimate of how much friction can damp each resonance."""

    modes: int = 10  # number of modes in the estimate
    # number of values of theta, in a geometric series from the least up to pi
    angles: int = 48
    least_angle: float = 1e-2  # [rad] least value of theta


class LimitOptions(Frozen):
    """Limits of what a scene may request, and of the values of its numbers."""

    # largest magnitude of a number: larger ones overflow when three of them are multiplied
    largest: float = 1e100
    smallest: float = 1e-100  # least magnitude of a divisor
    harmonics: int = 50  # the greatest harmonic that can be requested
    # least max_step, relative to a curve's extent: the curve then has a hundred thousand points or more
    shortest_step: float = 1e-5
    longest_step: float = 0.05  # max_step relative to a curve's extent, if the scene gives none
    narrowest: float = 1e-10  # least relative width of a range: its points are still some 1e5 roundings apart
    # [byte] longest name: "contact.NAME.tangential.NAME" is the name of a variable in files, 256 at most
    longest_name: int = 100
    fitted: int = 20  # most numbers that are fitted together
    chosen: int = 3  # most numbers that [optimum] can vary
    # upper default bound of a number to optimise, relative to its value in the scene
    optimum_range: float = 10.0
    cycles: int = 10_000_000  # most cycles of all phases of a schedule, hours of computing
    curves: int = 1_000_000  # most curves of a sweep
    bytes_of_curve: float = 1000.0  # [byte] memory of the numbers of one curve of a sweep
    draws_timed: int = 8  # number of draws of a number that are timed to estimate the total time
    draws_seconds: float = 600.0  # [s] longest total time of the draws of a number; longer is a mistake
    mistuning: float = 0.5  # if the factors of all blades are less, they are probably meant as deviations
    friction: float = 2.0  # a greater coefficient of friction is probably meant as a percentage
    # if all damping ratios are at least this, no resonance is seen, and they may be meant as percentages
    damping_of_all: float = 0.2
    # the same limit for a scene with units, thus of a real structure: bolted ones have some 0.01 to 0.03
    damping_with_units: float = 0.1
    # with at least this damping ratio a mode does not vibrate; it is probably meant as a percentage
    damping_ratio: float = 1.0
    # greatest number of degrees of freedom that are all in results by default
    reported: int = 50
    # [byte] memory for the flexibility along a direction, for each row of matrices; measured
    bytes_of_direction: float = 8 * 14
    # frequency relative to the range's lower end, below which a mode does not matter to what is traced
    of_no_interest: float = 0.01
    outputs: int = 30  # most output degrees of freedom whose own flexibility is kept
    # least number of rows of a mesh, whose highest modes are above any range
    mesh_rows: int = 100


class InputFileOptions(Frozen):
    """Limits of the data files of a scene, and of the process that reads them."""

    # [byte] largest unpacked data file: it fits twice in any machine's memory
    largest: int = 1_000_000_000
    memory: int = 500_000_000  # [byte] memory of the reader without the arrays
    copies: int = 3  # number of copies of the arrays in memory, while they are read, converted and written


class ToleranceOptions(Frozen):
    """Relative differences of a scene's numbers up to which they count as zero."""

    # a negative eigenvalue of a correlation matrix, relative to its size, that counts as zero
    correlation: float = 1e-12
    asymmetry: float = 1e-8  # relative difference of two entries that should be equal
    # difference of entries relative to the largest of a matrix that is rounding
    negligible: float = 1e-12
    displacement: float = 1e-12  # displacement relative to the largest that counts as zero
    # displacement in a mode's shape, relative to its largest and to the ratio of the greatest squared
    # frequency to that of the mode, that is rounding: 5e-16 has been measured
    shape: float = 1e-14
    cancelled: float = 1e-14  # sum of forces relative to their sizes that is rounding
    # ratio of modal masses above which sums over the modes lose the heavy ones to rounding
    mass_ratio: float = 1e20
    # relative difference of the masses along the axes up to which they are equal, for a floating structure
    floating_mass: float = 1e-3
    # ratio of the masses along the axes that held rows can explain, for a held structure
    held_mass: float = 10.0
    # number of entries of a stiffness matrix, relative to full blocks of coupled rows, up to which it is
    # that of a mesh, and not of a reduced structure
    mesh_entries: float = 0.5
    # relative difference of the masses along the axes that elements at held nodes can explain, for a mesh
    # whose nodes are held in all directions: 4 % of the mass of each, 1/3 against 13/35, for a beam
    mesh_mass: float = 0.05
    # difference of the largest value of a shape from 1 up to which shapes are scaled to 1
    scaled_shape: float = 1e-6
    same_direction: float = 1e-9  # difference of two equal directions
    # relative difference of the frequencies of a ring's diameters up to which the sectors are uncoupled
    same_modes: float = 1e-9
    right_angle: float = 0.01  # sine of the angle by which a normal may lean: about half a degree
    # relative difference of a direction's length and that of its projection on a plane, for a direction in
    # the plane
    square: float = 1e-6
    # relative difference of two lengths, or of one from 1, up to which they are equal, and cosine of a right
    # angle: weights with three digits have such errors
    written: float = 2e-3
    # distance of a node from its place, relative to the extent of the places, or residual of a fit by
    # rigid-body motions, above which nodes are not where a file says
    placed: float = 0.05
    # square of a frequency, and relative change of a frequency without damping, that are rounding
    undamped: float = 1e-12
    equal_frequency: float = 1e-6  # relative difference of equal frequencies
    # imaginary part of a ring's shape, relative to it, up to which it is real apart from a complex factor
    rotated: float = 1e-8
    # relative difference of two datasets up to which they are the same mode
    same_mode: float = 1e-6
    # imaginary part of a shape that is rotated to be real, relative to the shape, up to which it is real
    collinear: float = 1e-4


TOML = TomlOptions()
FRICTION_DAMPING = FrictionDampingOptions()
MESSAGES = MessageOptions()
LIMITS = LimitOptions()
FILES = InputFileOptions()
TOLERANCES = ToleranceOptions()
