"""Command line: how much is shown, and what can be asked for."""

from __future__ import annotations

from fcm.frozen import Frozen


class RemarkOptions(Frozen):
    """How much sentences, tables and pictures of the command line show."""

    harmonics: int = 10  # of which it is said what they meet
    width: int = 120  # characters of a line of a table, from which on each degree of freedom has a line
    folds: int = 4  # of which a line has all
    stretches: int = 3  # of frequencies in a sentence
    named: int = 3  # motions, and degrees of freedom, in a sentence
    resolution: float = 1e-3  # of the range: what happens within less is not seen in a sweep or a picture
    small_jump: float = 1e-2  # of the amplitude: a jump of less is not seen either
    narrow_window: float = 1e-3  # of the frequency: narrower ones of unknown stability have no line each
    tried: int = 2  # values on either side of an optimum that was found by trials
    doubtful_error: float = 0.1  # relative, of a peak beside an optimum: a greater one is said
    lines: int = 12  # of a table of peaks, jumps or windows, for all curves; of each curve at least
    of_each_curve: int = 3
    rows: int = 10  # of the table of an interface: contacts that take most
    flexible: int = 5  # modes that stand for flexibility, in a list of modes
    directions: int = 6  # at most, whose participation stands beside each other on a line
    forces: int = 2  # of these directions, where contacts need the others
    contacts: int = 3  # that fit beside the degrees of freedom on a line
    problems: int = 3  # on a terminal; --json has all
    contact_name: int = 24  # characters of a contact's name
    redraw: float = 0.1  # [s] shortest time between two drawings of the progress line
    first_line: float = 20.0  # [s] after which progress is said where it cannot be drawn
    bar: int = 24  # characters of the progress bar
    long_run: float = 60.0  # [s] a run from which on its time is said
    # [s] after which curves show how long others take: before, what is read and loaded once counts too
    time_shown: float = 5.0
    memory: float = 500e6  # [byte] of results from which on their size is said
    # [s] of a curve, which is said before it is begun: of many short ones the first shows it
    long_curve: float = 60.0
    many_points: int = 30_000  # some seconds, and files of 10 MB and more
    response_share: float = (
        0.5  # of the progress bar is for the scene's response, where a part is built for one
    )


class RequestOptions(Frozen):
    """What can be asked for on the command line."""

    panels: int = 8  # of coefficients that can be read in one picture
    farthest: float = 1e6  # of a range that is drawn; beyond, nothing changes that could be seen
    longest_name: int = 50  # characters of the name of a coefficient
    periods: int = 8  # that --periods can ask for
    frequencies: int = 100_000  # that can be asked for; each takes milliseconds at least
    loops: int = 12  # in a picture: three rows
    highest_harmonic: int = 100  # of the motion of a loop
    repeats: int = 3  # of opening a table, of which the best is reported
    points_of_part: int = 100_000  # at which the error of a part is measured, unless the user says
    csv_size: float = 2.5  # times the bytes of netCDF that the digits of a number take
    least_memory: int = 240_000_000  # bytes of addresses (`ulimit -v`) that numpy, scipy and HDF5 take


SENTENCES = RemarkOptions()
REQUESTS = RequestOptions()
