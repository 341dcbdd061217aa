"""The build of compiled applications: from the sources to a shared object and table files that a mission flies.

Code that calls the C compiler or reads its output belongs here. It has the headers, from cfepy or a cFS tree
(`headers`), and the reader for folders of sources (`source_files`, `cmake_script`). It has the compiler itself
(`compiler`), and the build with tables out of object files (`application`). Loading and running a shared object does
not belong here.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.interpreter.faces import face

if TYPE_CHECKING:
    from cfepy.extra.c.toolchain.application import Built, Options, TableFiles, build
    from cfepy.extra.c.toolchain.cmake_budget import CMakeBudget
    from cfepy.extra.c.toolchain.cmake_conditions import version_of
    from cfepy.extra.c.toolchain.cmake_script import CMakeScript
    from cfepy.extra.c.toolchain.cmake_words import split_list
    from cfepy.extra.c.toolchain.compiler import CompilerError, call_bounded, cpp_compiler, end_bounded, start_bounded
    from cfepy.extra.c.toolchain.generator_expressions import GeneratorExpressions
    from cfepy.extra.c.toolchain.headers import headers_folder

__all__ = [
    "Built",
    "CMakeBudget",
    "CMakeScript",
    "CompilerError",
    "GeneratorExpressions",
    "Options",
    "TableFiles",
    "build",
    "call_bounded",
    "cpp_compiler",
    "end_bounded",
    "headers_folder",
    "split_list",
    "start_bounded",
    "version_of",
]

if not TYPE_CHECKING:  # a type checker sees the names above, and no others
    __getattr__, __dir__ = face(
        __name__,
        {
            ".application": ("Built", "Options", "TableFiles", "build"),
            ".cmake_conditions": ("version_of",),
            ".cmake_budget": ("CMakeBudget",),
            ".cmake_script": ("CMakeScript",),
            ".cmake_words": ("split_list",),
            ".generator_expressions": ("GeneratorExpressions",),
            ".compiler": ("CompilerError", "call_bounded", "cpp_compiler", "end_bounded", "start_bounded"),
            ".headers": ("headers_folder",),
        },
    )
