"""Compiles the kernels: the modules of ``ext-modules`` in pyproject.toml, by Cython and a C compiler.

A kernel is a Python module that Cython's pure mode can also compile. The machine code lies next to the
source, and Python imports it if it exists. Otherwise Python imports the source, slower but equivalent.
``python src/fcm/build_kernels.py`` in the top folder, or ``make kernels``, compiles them in place.

The .pxd file of a kernel declares what is C: functions, methods and attributes that need neither Python nor
its lock. Other kernels import them as ``from cython.cimports.fcm...``; see `fcm.contact.closed_form`. There a
float is a double; other types have Cython's names. Only Python calls what is not declared. A function that
calls Python must declare its return value for an exception (``except -1``). Declared ``noexcept``, it would
print an interruption and continue with numbers that were not computed; such a kernel is refused.
"""

from __future__ import annotations

import os
import re
from compileall import compile_dir
from pathlib import Path
from tempfile import TemporaryDirectory

from Cython.Build import cythonize
from setuptools import Distribution, Extension, setup
from setuptools.command.bdist_wheel import bdist_wheel
from setuptools.command.build_ext import build_ext, customize_compiler, new_compiler
from setuptools.command.sdist import sdist
from setuptools.errors import CompileError

DIRECTIVES = {
    "language_level": 3,
    "boundscheck": False,
    "wraparound": False,
    "cdivision": True,
    "initializedcheck": False,
    "auto_pickle": False,  # no kernel object is pickled, and this would be a third of the machine code
}
# Each operation is rounded as written (no fused ones): the state sequence of a contact depends on signs.
FLAGS = ["-g0", "-ffp-contract=off"]
# For loops over harmonics -O3 saves a tenth of the time of a curve; elsewhere it only compiles longer.
LOOPS = (
    "fcm.cubic",
    "fcm.contact.",
    "fcm.harmonic_balance.",
    "fcm.continuation.dense_solver",
    "fcm.stability.monodromy",
    "fcm.stability.planar_monodromy",
)
# Decisions made once a step compile in two thirds of the time with -O1, and run no slower.
DECISIONS = (
    "fcm.accuracy.curve_distance",
    "fcm.continuation.events",
    "fcm.continuation.follow",
    "fcm.continuation.options",
    "fcm.continuation.problem",
    "fcm.continuation.recorder",
    "fcm.continuation.step_control",
    "fcm.time_domain.integrator",
    "fcm.time_domain.measures",
    "fcm.time_domain.segment",
)
# Two thirds of a kernel's C are added by Cython, outside of loops. The setup code is not optimised at all,
# the interface to Python little. This saves a quarter of the compile time.
SECTION = "/* #### Code section: {} ### */\n"
LEVELS = (("module_exttypes", "O1"), ("init_module", "O0"), ("utility_code_def", "O1"))
PRAGMA = """#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC optimize ("{}")
#endif
"""
ANY_PYTHON = ("Py_LIMITED_API", "0x030B0000")  # Python 3.11 and later
BESIDE = ("Makefile", ".ci/*", ".github/**/*", "tests/**/*")  # additional files of an sdist, for its tests
ARRAYS = "fcm.kernel_arrays"  # Cython's code for arrays, shared by all kernels

_LOST = re.compile(r'\n\s+__Pyx_WriteUnraisable\("([^"]*)"')  # a translated function that loses exceptions
_NONE = re.compile(  # an exception for None in place of an object, which no kernel passes; it calls no Python
    r'"cannot pass None into a C function[^\n]*\n(?:[^\n]*GILState_Release[^\n]*\n|\s*#[^\n]*\n)*'
    r"[^\n]*__PYX_ERR\([^\n]*\n"
)


def losing(translated: str) -> list[str]:
    """The functions of a kernel in C that would lose an exception from a function they call."""
    code, found = _NONE.sub("\n", translated), []
    for lost in _LOST.finditer(code):
        begin = code.rfind("\nstatic ", 0, lost.start())
        if "__PYX_ERR(" in code[begin : lost.start()]:
            found.append(lost[1])
    return found


class Kernels(build_ext):
    """The setuptools step that compiles the kernels; for developers (in place) a failure is an error."""

    def finalize_options(self) -> None:
        kernels = self.distribution.ext_modules
        kernels.append(Extension(ARRAYS, ["src/fcm/kernel_arrays.c"]))
        for kernel in kernels:
            kernel.py_limited_api = True
            kernel.define_macros = [ANY_PYTHON]
            decides, loops = kernel.name.startswith(DECISIONS), kernel.name.startswith(LOOPS)
            kernel.extra_compile_args = ["-O1" if decides else "-O3" if loops else "-O2", *FLAGS]
        super().finalize_options()
        self.parallel = os.cpu_count()

    def run(self) -> None:
        # stored here because the base class changes inplace
        self.optional, self.in_place = self.editable_mode or not self.inplace, self.inplace
        super().run()

    def build_extensions(self) -> None:
        for kernel in self.extensions:
            kernel.optional = self.optional
            self._discard_if_old(kernel)
        if self.optional and (reason := compiles_not(self.distribution)):
            self.warn(f"the kernels of fcm are not compiled: {reason}")
            return
        translated = cythonize(  # type: ignore[no-untyped-call]
            self.extensions,
            nthreads=self.parallel,
            build_dir=self.build_temp,
            compiler_directives=DIRECTIVES,
            shared_utility_qualified_name=ARRAYS,
            force=self.force,
        )
        for kernel, in_C in zip(self.extensions, translated, strict=True):
            kernel.sources = in_C.sources
            for source in map(Path, in_C.sources):
                set_up_plainly(source)
        if self.editable_mode or self.in_place:  # only for developers: users may have another Cython
            self._check([Path(source) for kernel in translated for source in kernel.sources])
        super().build_extensions()
        if self.editable_mode:
            # pip does this for installed files: without bytecode, a start takes 0.1 s longer
            compile_dir("src/fcm", quiet=1)

    def _check(self, sources: list[Path]) -> None:
        """Refuse kernels that would lose an exception."""
        found = [name for source in sources for name in losing(source.read_text())]
        if found:
            raise CompileError(
                f"exceptions are lost in {', '.join(found)}: declare what is returned for them (except -1)"
            )

    def _discard_if_old(self, kernel: Extension) -> None:
        """Deletes an outdated compiled kernel first, so that its source is used if compiling fails."""
        made, source = Path(self.get_ext_fullpath(kernel.name)), Path(kernel.sources[0])
        if made.exists() and source.exists() and made.stat().st_mtime < source.stat().st_mtime:
            made.unlink()


def set_up_plainly(source: Path) -> None:
    """Lowers gcc's optimisation of what Cython adds to a kernel's C source; only once for a source."""
    code = source.read_text()
    if "#pragma GCC optimize" in code:
        return
    for section, level in LEVELS:
        mark = SECTION.format(section)
        code = code.replace(mark, mark + PRAGMA.format(level), 1)
    source.write_text(code)


def compiles_not(distribution: Distribution) -> str:
    """Why C with Python's headers cannot be compiled here, which makes translating useless; or ''."""
    trial = build_ext(distribution)
    trial.ensure_finalized()
    compiler = new_compiler(compiler=trial.compiler)
    customize_compiler(compiler)
    with TemporaryDirectory() as folder:
        source = Path(folder) / "headers.c"
        source.write_text("#include <Python.h>\n")
        try:
            compiler.compile([str(source)], folder, include_dirs=trial.include_dirs)
        except CompileError as reason:
            return str(reason)
    return ""


class Wheel(bdist_wheel):
    """A wheel with the right tag: without compiled kernels it is for every Python version and machine."""

    def finalize_options(self) -> None:
        wanted = "editable_wheel" not in self.distribution.command_obj  # which handles missing kernels itself
        if wanted and self.distribution.ext_modules and (reason := compiles_not(self.distribution)):
            self.announce(f"the kernels of fcm are not compiled: {reason}", 3)
            self.distribution.ext_modules, self.py_limited_api = [], False
        super().finalize_options()


class Sources(sdist):
    """A source distribution that includes what the tests read: the guide, the Makefile and the tests."""

    def make_release_tree(self, base_dir: str, files: list[str]) -> None:
        found = (path for pattern in BESIDE for path in sorted(Path().glob(pattern)))
        own = {str(path) for path in found if path.is_file() and "__pycache__" not in path.parts}
        super().make_release_tree(base_dir, [*files, *sorted(own.difference(files))])
        Path(base_dir, "tables").symlink_to("src/fcm/tables")  # the files are in the package


if __name__ == "__main__":
    setup(script_args=["build_ext", "--inplace"])
