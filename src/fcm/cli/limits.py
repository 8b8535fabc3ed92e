"""Options of the command line: how much is shown, and what can be requested."""

from __future__ import annotations

from fcm.frozen import Frozen


class RemarkOptions(Frozen):
    """Options on how much sentences, tables and pictures of the command line show."""

    harmonics: int = 10  # highest harmonic of an engine order whose nodal diameter is listed
    width: int = 120  # characters of a line of a table, from which on each degree of freedom has a line
    folds: int = 4  # most folds of a curve that a line of a table lists; of more their number and range
    stretches: int = 3  # most frequency ranges that a sentence names
    named: int = 3  # most motions, and degrees of freedom, that a sentence names
    # width relative to the frequency range, below which nothing is seen in a sweep or a picture
    resolution: float = 1e-3
    # change of an amplitude by a jump, relative to it, below which the jump is not seen either
    small_jump: float = 1e-2
    # width relative to the frequency, below which a window of unknown stability has no line of its own
    narrow_window: float = 1e-3
    tried: int = 2  # values listed on either side of an optimum that was found by trials
    # relative error of a peak at an optimum, or of random draws, from which on it is reported
    doubtful_error: float = 0.1
    unreliable_error: float = 0.3  # relative error of a greatest peak beyond which a result is called so
    # relative amount below the least peak from which on the response at an optimum lacks that peak
    lacking: float = 1e-3
    lines: int = 12  # lines of a table of peaks, jumps or windows that all curves share
    of_each_curve: int = 3  # least lines of such a table for each curve
    rows: int = 10  # most contacts in the table of an interface, those with the greatest loads
    flexible: int = 5  # most modes that stand for flexibility in a list of modes
    # modal assurance criterion of a stuck and an open mode, below which they have no common line
    least_alike: float = 0.5
    directions: int = 6  # most directions with participation on one line
    forces: int = 2  # of these, columns kept for forces if contacts need the others
    contacts: int = 3  # most contacts beside the degrees of freedom on a line
    problems: int = 3  # most problems listed on a terminal; --json has all
    contact_name: int = 24  # most characters of a contact's name
    redraw: float = 0.1  # [s] shortest time between two drawings of the progress line
    first_line: float = 20.0  # [s] time after which progress is printed as lines, where no bar can be drawn
    bar: int = 24  # characters of the progress bar
    long_run: float = 60.0  # [s] expected time of all curves from which on it is printed
    # [s] time after which the first curves give an estimate for all; earlier, loading counts too much
    time_shown: float = 5.0
    memory: float = 500e6  # [byte] size of results from which on it is printed
    # [s] estimated time of a curve from which on it is printed before the curve begins; for many short
    # curves the first shows it
    long_curve: float = 60.0
    # points of a curve from which on their number is printed: some seconds, and files of 10 MB and more
    many_points: int = 30_000
    # share of the progress bar for the scene's response, if a part of a table is built for it
    response_share: float = 0.5


class RequestOptions(Frozen):
    """Limits of what can be requested on the command line."""

    panels: int = 8  # most panels of coefficients in one picture
    farthest: float = 1e6  # greatest end of a range that is drawn; beyond, no change is visible
    longest_name: int = 50  # most characters of the name of a coefficient
    periods: int = 8  # most periods that --periods can ask for
    frequencies: int = 100_000  # most frequencies in one request; each takes milliseconds at least
    loops: int = 12  # most loops in a picture: three rows
    highest_harmonic: int = 100  # highest harmonic of the motion of a loop
    repeats: int = 3  # number of times that a table is opened, of which the best time is reported
    # points at which the error of a part of a table is measured, unless the user says
    points_of_part: int = 100_000
    csv_size: float = 2.5  # bytes of a number's digits in CSV, relative to its bytes in netCDF
    least_memory: int = 240_000_000  # bytes of addresses (`ulimit -v`) that numpy, scipy and HDF5 take


SENTENCES = RemarkOptions()
REQUESTS = RequestOptions()
