"""Building compiled applications: from the sources of one to a shared object and table files that a mission flies.

What belongs here calls the C compiler or reads what it made: the headers it is given, cfepy's or those of a cFS tree
(`headers`), what a folder of sources consists of (`source_files`, `cmake`), the compiler itself (`compiler`), tables
out of object files (`tables`). Loading and running a shared object is not of this package.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.interpreter.faces import face

if TYPE_CHECKING:
    from cfepy.extra.c.toolchain.application import Built, Options, build
    from cfepy.extra.c.toolchain.cmake_script import CMakeBudget, CMakeScript
    from cfepy.extra.c.toolchain.compiler import CompilerError, call_bounded, cpp_compiler, end_bounded, start_bounded
    from cfepy.extra.c.toolchain.headers import headers_folder

__all__ = [
    "Built",
    "CMakeBudget",
    "CMakeScript",
    "CompilerError",
    "Options",
    "build",
    "call_bounded",
    "cpp_compiler",
    "end_bounded",
    "headers_folder",
    "start_bounded",
]

if not TYPE_CHECKING:  # a type checker sees the names above, and no others
    __getattr__, __dir__ = face(
        __name__,
        {
            ".application": ("Built", "Options", "build"),
            ".cmake_script": ("CMakeBudget", "CMakeScript"),
            ".compiler": ("CompilerError", "call_bounded", "cpp_compiler", "end_bounded", "start_bounded"),
            ".headers": ("headers_folder",),
        },
    )
