"""Kernels that would lose an exception of what they call, as by Ctrl-C, are refused."""

from pathlib import Path

import pytest
from Cython.Compiler.Main import CompilationOptions, compile

from fcm import build_kernels
from fcm.build_kernels import DIRECTIVES, losing

CALLED_BACK = """import cython

@cython.cfunc
@cython.nogil
@cython.exceptval({value}check=False)
def called(report: object, x: cython.double) -> cython.double:
    with cython.gil:
        report(x)
    return 0.5 * x

@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def half(x: cython.double) -> cython.double:
    return 0.5 * x

@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def first(x: cython.double[:, ::1]) -> cython.double:
    return row(x[0])

@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def row(x: cython.double[::1]) -> cython.double:
    return half(x[0])

def run(report, x: float) -> float:
    return called(report, x)
"""


@pytest.mark.slow
@pytest.mark.parametrize(("value", "expected"), [("", ["kernel.called"]), ("-1, ", [])])
def test_a_function_that_calls_python_hands_an_exception_on(tmp_path, value, expected):
    source = tmp_path / "kernel.py"
    source.write_text(CALLED_BACK.format(value=value))
    options = CompilationOptions(compiler_directives=DIRECTIVES, output_file=str(tmp_path / "kernel.c"))
    assert compile(str(source), options).num_errors == 0
    assert losing(Path(tmp_path / "kernel.c").read_text()) == expected


def test_what_cython_adds_is_optimised_less_and_the_code_of_a_kernel_is_not(tmp_path):
    """Once: else every build would compile all kernels again."""
    sections = ("module_code", *(section for section, _ in build_kernels.LEVELS), "end")
    source, code = tmp_path / "kernel.c", [build_kernels.SECTION.format(one) for one in sections]
    source.write_text("".join(f"{mark}int {one};\n" for mark, one in zip(code, sections, strict=True)))
    build_kernels.set_up_plainly(source)
    made = source.read_text()
    assert "#pragma" not in made.partition(code[1])[0]
    for (_, level), mark in zip(build_kernels.LEVELS, code[1:-1], strict=True):
        assert made.partition(mark)[2].splitlines()[1] == f'#pragma GCC optimize ("{level}")'
    build_kernels.set_up_plainly(source)
    assert source.read_text() == made
