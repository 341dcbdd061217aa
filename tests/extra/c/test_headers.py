"""The headers for compiled applications against facts of cFE 7.0.0: values, sizes, offsets, prototypes.

`tests/data/c_interface` has them as a build of NASA's for Linux on x86-64 knows them, with deprecated names.
"""

from __future__ import annotations

import re
import subprocess
from collections.abc import Iterator
from dataclasses import fields
from io import BytesIO
from pathlib import Path
from typing import Any
from unittest.mock import MagicMock

import pytest

from cfepy.config.platform import PlatformConfig
from cfepy.extra.c import api
from cfepy.extra.c.elf import elf_file
from cfepy.extra.c.engine import compiler
from cfepy.extra.c.toolchain.application import WITHOUT_DEPRECATED, WITHOUT_DEPRECATED_OSAL
from cfepy.extra.c.toolchain.compiler import cpp_compiler
from cfepy.extra.c.toolchain.headers import DECLARATIONS, NAMES, NAMES_6, headers_folder, names
from tests.extra.c.building import needs_compiler

pytestmark = needs_compiler

DATA = Path(__file__).parents[2] / "data"
FACTS = DATA / "c_interface"
OMITTED = [f"-D{each}" for each in (*WITHOUT_DEPRECATED, WITHOUT_DEPRECATED_OSAL)]
PROFILES = {"with deprecated names": [], "without deprecated names": OMITTED}
PRIVATE = "CFE_SBR_"
OTHER_CONSTANTS = {"CFE_TBL_BAD_TABLE_HANDLE": "0"}
STRUCTURES = {"OS_OBJECT_CREATOR_ANY", "OS_OBJECT_ID_UNDEFINED"}
"""Constants that are structures without deprecated names, and no constant expressions with them."""
CONSTANTS_LEFT_OUT = {"CFE_MISSION_ES_CRC_8", "CFE_MISSION_ES_CRC_16", "CFE_MISSION_ES_CRC_32", "CFE_TIME_1HZ_CMD_MID"}
OTHER_SIZES = {"CFE_TBL_Handle_t": "4"}
"""What is another size or value without deprecated names."""

each_profile = pytest.mark.parametrize("flags", PROFILES.values(), ids=PROFILES)


def rows(file: str) -> Iterator[tuple[str, str]]:
    """Yield the rows of a table of facts."""
    for line in (FACTS / file).read_text(encoding="utf-8").splitlines():
        name, _, value = line.partition("\t")
        yield name, value


def compile_text(folder: Path, text: str, *flags: str, command: list[str] | None = None) -> str:
    """Return the compiler's output for a file that includes every header."""
    file = folder / "facts.c"
    includes = "".join(f'#include "{name}.h"\n' for name in sorted(names()))
    file.write_text(f"{includes}{text}\nint end;\n", encoding="utf-8")
    tool = command or [*compiler(), "-std=gnu11"]
    whole = [*tool, "-Wall", "-Wextra", "-Werror", "-fsyntax-only", *flags, f"-I{headers_folder()}", str(file)]
    return subprocess.run(whole, capture_output=True, text=True, check=False).stderr


def test_limits_of_osal_are_the_defaults_of_a_mission() -> None:
    text = (Path(api.__file__).parents[1] / "headers" / "osal_config.h").read_text(encoding="utf-8")
    header = {name.lower(): int(value) for name, value in re.findall(r"#define (OS_MAX_\w+|OS_QUEUE_\w+) +(\d+)", text)}
    limits = {
        each.name: each.default for each in fields(PlatformConfig) if each.name.startswith(("os_max_", "os_queue_"))
    }
    assert limits == {name: header[name] for name in limits}


@each_profile
def test_constants_have_their_values(flags: list[str], tmp_path: Path) -> None:
    left_out = CONSTANTS_LEFT_OUT if flags else set()
    text = ""
    for name, value in rows("constants.tsv"):
        if name in STRUCTURES:
            text += f"osal_id_t {name.lower()}(void) {{ return {name}; }}\n"
        elif name in left_out:
            text += f"#ifdef {name}\n#error {name}\n#endif\n"
        elif value.startswith('"'):
            text += f'_Static_assert(__builtin_strcmp({name}, {value}) == 0, "{name}");\n'
        else:
            wanted = OTHER_CONSTANTS.get(name, value) if flags else value
            text += f'_Static_assert((long long)({name}) == {wanted}, "{name}");\n'
    assert compile_text(tmp_path, text, *flags) == ""


@each_profile
def test_structures_have_nasas_layouts(flags: list[str], tmp_path: Path) -> None:
    text = ""
    for name, layout in rows("structures.tsv"):
        size, *members = layout.split()
        wanted = OTHER_SIZES.get(name, size) if flags else size
        text += f'_Static_assert(sizeof({name}) == {wanted}, "{name}");\n'
        for member, offset in zip(members[::2], members[1::2], strict=True):
            text += f'_Static_assert(offsetof({name}, {member}) == {offset}, "{name}.{member}");\n'
    assert compile_text(tmp_path, text, *flags) == ""


@each_profile
def test_functions_have_their_prototypes(flags: list[str], tmp_path: Path) -> None:
    text = "".join(
        f'_Static_assert(__builtin_types_compatible_p(__typeof__({name}), __typeof__({kind})), "{name}");\n'
        for name, kind in rows("functions.tsv")
    )
    assert compile_text(tmp_path, text, *flags) == ""


def test_swapped_integers(tmp_path: Path) -> None:
    text = """
        _Static_assert(CFE_MAKE_BIG16(0x1234) == 0x3412, "16");
        _Static_assert(CFE_MAKE_BIG32(0x12345678u) == 0x78563412u, "32");
        _Static_assert(CFE_MAKE_BIG32(0xF2345687u) == 0x875634F2u, "32, with high bits");
    """
    assert compile_text(tmp_path, text) == ""


def test_every_public_name_is_declared(tmp_path: Path) -> None:
    functions = {name for name, _ in rows("functions.tsv")}
    text = ""
    for file in (DATA / "api").glob("*.txt"):
        for line in file.read_text(encoding="utf-8").splitlines():
            name = line.split()[0]
            if line.startswith("#") or name.startswith(PRIVATE):
                continue
            if "(macro)" in line:
                text += f"#ifndef {name}\n#error {name}\n#endif\n"
            else:
                assert name in functions
    assert compile_text(tmp_path, text) == ""


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(names()))
def test_each_header_compiles_alone(name: str, tmp_path: Path) -> None:
    file = tmp_path / "alone.c"
    file.write_text(f'#include "{name}.h"\n#include "{name}.h"\nint end;\n', encoding="utf-8")
    command = [*compiler(), "-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", "-fsyntax-only"]
    done = subprocess.run([*command, f"-I{headers_folder()}", str(file)], capture_output=True, text=True, check=False)
    assert done.stderr == ""


@each_profile
def test_headers_compile_as_cpp(flags: list[str], tmp_path: Path) -> None:
    assert compile_text(tmp_path, "", "-x", "c++", "-std=c++17", *flags, command=cpp_compiler()) == ""


def test_each_declaration_file_is_used_by_a_header() -> None:
    led_to = {each for file in (NAMES, NAMES_6) for ours in names(file).values() for each in ours}
    there = {each.stem for each in DECLARATIONS.glob("*.h")}
    assert led_to <= there
    included = {
        each
        for file in DECLARATIONS.glob("*.h")
        for each in re.findall(r'"(\w+)\.h"', file.read_text(encoding="utf-8"))
    }
    assert there == led_to | included


# -- declarations of the engine ----------------------------------------------------------------------------------------

KINDS_OF_LETTERS = {
    **dict.fromkeys("iI", "4"),
    **dict.fromkeys("hH", "2"),
    **dict.fromkeys("Bb", "1"),
    **dict.fromkeys("qQt", "8"),
    **dict.fromkeys("pPsSm1248wz", "*"),
}


def declared() -> dict[str, str]:
    """Return the functions that Python answers, with the letters of their parameters."""
    found: dict[str, str] = {}

    class Recorder(MagicMock):
        def add(self, name: str, signature: str, *_: Any) -> None:
            found[name] = signature.lstrip("=~$&@")

    api.declare(Recorder(), MagicMock())  # type: ignore[arg-type]  # a stand-in, since nothing is called
    return found


def kinds(folder: Path, functions: dict[str, str]) -> dict[str, str]:
    """Return the parameters of functions: `*` for pointers, else their size."""
    text = '#include "cfe.h"\n#include "cfe_config.h"\n#include "iodriver_base.h"\n'
    text += "#define CFE_TBL_Handle_t uint32\n"  # the engine takes it so: of 16 bits or 32, as the application has it
    text += "#define K(type) (__builtin_classify_type(*(type *)0) == 5 ? '*' : (char)('0' + sizeof(type)))\n"
    text += "const char kinds[] = {\n"
    for kind in functions.values():
        types = [each.strip() for each in kind[kind.rindex("(") + 1 : -1].split(",")]
        types = [re.sub(r"\s*\[\d*\]", "*", each) for each in types if each not in ("void", "...")]
        text += "".join(f"    K({each}),\n" for each in types) + "    '\\n',\n"
    (folder / "kinds.c").write_text(text + "};\n", encoding="utf-8")
    made = folder / "kinds.o"  # not run: the compiler may target another computer
    subprocess.run([*compiler(), f"-I{headers_folder()}", "-c", str(folder / "kinds.c"), "-o", str(made)], check=True)
    elf = elf_file(BytesIO(made.read_bytes()))
    [symbol] = elf.get_section_by_name(".symtab").get_symbol_by_name("kinds")
    data = elf.get_section(symbol["st_shndx"]).data()[symbol["st_value"] :][: symbol["st_size"]]
    return dict(zip(functions, data.decode().splitlines(), strict=True))


def test_engine_declares_functions_like_the_headers(tmp_path: Path) -> None:
    letters = declared()
    known = {name: kind for name, kind in rows("functions.tsv") if name in letters}
    assert len(known) > 50
    wrong = []
    for name, wanted in kinds(tmp_path, known).items():
        mine = letters[name].removesuffix("f")
        fits = len(mine) == len(wanted) - (mine != letters[name]) and all(
            letter == "-" or KINDS_OF_LETTERS[letter] == kind for letter, kind in zip(mine, wanted, strict=False)
        )
        if not fits:
            wrong.append((name, letters[name], wanted))
    assert wrong == [], wrong
