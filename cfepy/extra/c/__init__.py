"""Compiled applications: unmodified C, built against NASA's headers, as lines of a startup script.

Code that runs or builds compiled applications belongs here:

- the engine, a C extension that runs such code as coroutines (`engine/`);
- the loader for shared objects, which does not use the host's (`elf.py`, `image.py`);
- the memory that C code sees (`arena.py`);
- the public functions of OSAL, the PSP and cFE for C, with their arguments, outputs and structures (`api/`);
- the build of applications from their sources (`toolchain/`, with `headers/`).

The services do not belong here. The package is imported only when a mission has an ELF file where a startup script
names one, or when an application is built. The central file is `cfepy/extra/c/runtime.py`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.interpreter.faces import face

if TYPE_CHECKING:
    from cfepy.extra.c.abi import AbiProfile, abi_profile
    from cfepy.extra.c.api import function_names
    from cfepy.extra.c.build_cache import cache_folder, mark_used, remove_unused, writing_cache
    from cfepy.extra.c.devices import Device
    from cfepy.extra.c.elf import ElfError, check_elf_reader, read_shared_object
    from cfepy.extra.c.engine import GDB_SYMBOLS
    from cfepy.extra.c.ground_check import ground_differences
    from cfepy.extra.c.linking import wanted_names
    from cfepy.extra.c.loading import CompiledLoader
    from cfepy.extra.c.macros import Macros, macros_of
    from cfepy.extra.c.refused import refusal_of
    from cfepy.extra.c.runtime import CRuntime
    from cfepy.extra.c.structs import CStruct, FieldType, StructField, StructPlace, Structs, structs_of
    from cfepy.extra.c.toolchain import (
        Built,
        CMakeBudget,
        CMakeScript,
        CompilerError,
        GeneratorExpressions,
        Options,
        TableFiles,
        build,
        call_bounded,
        cpp_compiler,
        end_bounded,
        headers_folder,
        split_list,
        start_bounded,
        version_of,
    )

__all__ = [
    "GDB_SYMBOLS",
    "AbiProfile",
    "Built",
    "CMakeBudget",
    "CMakeScript",
    "CRuntime",
    "CStruct",
    "CompiledLoader",
    "CompilerError",
    "Device",
    "ElfError",
    "FieldType",
    "GeneratorExpressions",
    "Macros",
    "Options",
    "StructField",
    "StructPlace",
    "Structs",
    "TableFiles",
    "abi_profile",
    "build",
    "cache_folder",
    "call_bounded",
    "check_elf_reader",
    "cpp_compiler",
    "end_bounded",
    "function_names",
    "ground_differences",
    "headers_folder",
    "macros_of",
    "mark_used",
    "read_shared_object",
    "refusal_of",
    "remove_unused",
    "split_list",
    "start_bounded",
    "structs_of",
    "version_of",
    "wanted_names",
    "writing_cache",
]

if not TYPE_CHECKING:  # a type checker sees the names above, and no others
    __getattr__, __dir__ = face(
        __name__,
        {
            ".abi": ("AbiProfile", "abi_profile"),
            ".api": ("function_names",),
            ".build_cache": ("cache_folder", "mark_used", "remove_unused", "writing_cache"),
            ".devices": ("Device",),
            ".elf": ("ElfError", "check_elf_reader", "read_shared_object"),
            ".engine": ("GDB_SYMBOLS",),
            ".ground_check": ("ground_differences",),
            ".linking": ("wanted_names",),
            ".loading": ("CompiledLoader",),
            ".macros": ("Macros", "macros_of"),
            ".structs": ("CStruct", "FieldType", "StructField", "StructPlace", "Structs", "structs_of"),
            ".refused": ("refusal_of",),
            ".runtime": ("CRuntime",),
            ".toolchain": (
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
            ),
        },
    )
