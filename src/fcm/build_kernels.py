"""How the kernels are compiled: the modules of ``ext-modules`` in pyproject.toml, by Cython and a C compiler.

A kernel is Python that Cython's pure mode can also compile. Where it is compiled, Python imports the machine
code, which then lies beside the source; where it could not be, the source itself: slower, and else the same.
``python src/fcm/build_kernels.py`` in the top folder, or ``make kernels``, compiles them in place.

What the .pxd beside a kernel declares is C: functions, methods and attributes that need no Python and no lock,
and that other kernels import as ``from cython.cimports.fcm...``; see `fcm.contact.cycle` and `closed_form`.
There a float is a double; other types are named as Cython does. What is not declared is for Python to call.
"""

from __future__ import annotations

from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

DIRECTIVES = {
    "language_level": 3,
    "boundscheck": False,
    "wraparound": False,
    "cdivision": True,
    "initializedcheck": False,
}
# One rounding for each operation as it is written: the sequence of a contact hangs on signs.
FLAGS = ["-O3", "-g0", "-ffp-contract=off"]
ANY_PYTHON = ("Py_LIMITED_API", "0x030B0000")  # from 3.11 on


class Kernels(build_ext):
    """The step of setuptools that compiles; in place, for developers, a failure is an error."""

    def finalize_options(self) -> None:
        for kernel in self.distribution.ext_modules:
            kernel.py_limited_api = True
            kernel.define_macros, kernel.extra_compile_args = [ANY_PYTHON], FLAGS
        super().finalize_options()
        self.cython_directives, self.cython_c_in_temp = DIRECTIVES, True

    def build_extension(self, ext: Extension) -> None:
        ext.optional = self.editable_mode or not self.inplace
        made, source = Path(self.get_ext_fullpath(ext.name)), Path(ext.sources[0])
        if made.exists() and made.stat().st_mtime < source.stat().st_mtime:
            made.unlink()  # should this fail, the old one must not be taken
        super().build_extension(ext)


if __name__ == "__main__":
    setup(script_args=["build_ext", "--inplace"])
