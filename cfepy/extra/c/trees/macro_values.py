"""Values of C macros, as the compiler computes them from a mission's headers.

A configuration header defines values by other macros and by arithmetic, so only a compiler knows them. It compiles a
variable for each macro, and the values are read from the object file. Each variable is in a function of its own,
because a compiler reports an unknown name once a function. Nothing of the mission is executed.
"""

from __future__ import annotations

import re
import struct
import tempfile
from collections.abc import Iterable, Sequence
from io import BytesIO
from pathlib import Path

from cfepy.extra.c.elf import elf_file
from cfepy.extra.c.engine import compiler
from cfepy.extra.c.toolchain.compiler import C_FLAGS, COMMON, CompilerError, call_bounded, compile_file
from cfepy.reading.input_files import read_limited
from cfepy.reading.input_limits import OBJECT_BYTES

_DEFINED = re.compile(r"^#define (\w+) (\S.*)$", re.MULTILINE)
_IN_FUNCTION = re.compile(r"In function .cfepy_(\d+).")
_ROUNDS = 6
_LAYOUT = struct.Struct("<q")
_PREFIX = "cfepy_value_"
COMMON_LINES = (
    "#include <stdbool.h>",
    "#include <stdint.h>",
    "#ifndef TRUE",
    "#define TRUE 1",
    "#define FALSE 0",
    "#endif",
)
"""Names that cFE's own sources have before its configuration: those of C, and those of cFE 6."""
ERRORS = ("-fmax-errors=0", "-Werror=int-conversion", "-Werror=pointer-to-int-cast")


def macro_names(headers: Sequence[str], flags: Sequence[str]) -> list[str]:
    """Return the macros without arguments that headers define, and those that they include.

    Args:
        headers: names of headers, as in `#include`.
        flags: flags of the compiler, such as -I.

    Raises:
        CompilerError: a header cannot be read.
        UsageError: there is no compiler.
    """
    with tempfile.TemporaryDirectory(prefix="cfepy-macros-") as scratch:
        source = Path(scratch) / "names.c"
        source.write_text("".join(f'#include "{each}"\n' for each in headers), encoding="utf-8")
        status, said = call_bounded([*compiler(), *C_FLAGS, *COMMON, "-w", *flags, "-E", "-dM", str(source)])
    if status:
        raise CompilerError(said)
    return [name for name, _ in _DEFINED.findall(said)]


def macro_values(headers: Sequence[str], expressions: Iterable[str], flags: Sequence[str]) -> dict[str, int]:
    """Return the values of expressions that are integers.

    Args:
        headers: names of headers, as in `#include`.
        expressions: macros, or calls of macros.
        flags: flags of the compiler, such as -I.

    Raises:
        CompilerError: a header cannot be compiled.
        UsageError: there is no compiler.
    """
    wanted = dict(enumerate(expressions))
    with tempfile.TemporaryDirectory(prefix="cfepy-macros-") as scratch:
        source, made = Path(scratch) / "values.c", Path(scratch) / "values.o"
        for _ in range(_ROUNDS):
            lines = [*COMMON_LINES, *(f'#include "{each}"' for each in headers)]
            for number, text in wanted.items():
                variable = f"static const long long {_PREFIX}{number} __attribute__((used)) = (long long)({text});"
                lines.append(f"void cfepy_{number}(void) {{ {variable} }}")
            source.write_text("\n".join(lines) + "\n", encoding="utf-8")
            try:
                compile_file(source, made, ["-w", *ERRORS, *flags])
            except CompilerError as error:
                wrong = {int(each) for each in _IN_FUNCTION.findall(str(error))} & set(wanted)
                if not wrong:
                    raise
                for number in wrong:
                    del wanted[number]
            else:
                found = _read(read_limited(made, OBJECT_BYTES))
                return {text: found[number] for number, text in wanted.items() if number in found}
    return {}


def _read(data: bytes) -> dict[int, int]:
    elf = elf_file(BytesIO(data))
    found = {}
    for each in elf.get_section_by_name(".symtab").iter_symbols():
        if each.name.startswith(_PREFIX) and isinstance(each["st_shndx"], int):
            section = elf.get_section(each["st_shndx"])
            at = each["st_value"]
            content = bytes(_LAYOUT.size) if section["sh_type"] == "SHT_NOBITS" else section.data()[at : at + 8]
            found[int(each.name.removeprefix(_PREFIX).partition(".")[0])] = _LAYOUT.unpack(content)[0]
    return found
