"""The functions of C11: each is provided, or is refused with a reason that `cfepy check` gives."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest

from cfepy.extra.c.api import function_names
from cfepy.extra.c.engine import compiler
from cfepy.extra.c.linking import STAND_INS, UNUSED
from cfepy.extra.c.refused import BY_REASON, REASONS
from cfepy.pilot.mission_check import check_mission
from tests.extra.c.building import compile_c, console_of, fly, needs_compiler, write_mission

pytestmark = needs_compiler

TABLE = Path(__file__).parent / "libc" / "headers.txt"
PRECISIONS = ("", "f", "l")
_DECLARED = re.compile(r"^/\* (\S+?):\d+:\w+ \*/ extern .*?\b(\w+) \(", re.MULTILINE)


def names_of_headers() -> dict[str, set[str]]:
    """Return the functions of each header."""
    found: dict[str, set[str]] = {}
    for line in TABLE.read_text(encoding="utf-8").splitlines():
        header, *names = line.split()
        if header == "#":
            continue
        if header in ("math.h", "complex.h"):
            names = [name + precision for name in names for precision in PRECISIONS]
        found.setdefault(header, set()).update(names)
    return found


HEADERS = names_of_headers()


@pytest.mark.parametrize("header", HEADERS)
def test_each_function_is_provided_or_refused(header: str) -> None:
    assert HEADERS[header] - function_names() - set(REASONS) == set()


@pytest.mark.parametrize("header", [each for each in HEADERS if each not in ("assert.h", "errno.h", "setjmp.h")])
def test_table_has_all_functions_that_the_compiler_declares(header: str, tmp_path: Path) -> None:
    """Names with two underscores are the compiler's own."""
    source = tmp_path / "of_header.c"
    source.write_text(f"#include <{header}>\n", encoding="utf-8")
    command = [*compiler(), "-std=c11", "-fsyntax-only", "-aux-info", str(tmp_path / "declared"), str(source)]
    if subprocess.run(command, capture_output=True).returncode:
        pytest.skip("this compiler does not tell its declarations")
    declared = _DECLARED.findall((tmp_path / "declared").read_text(encoding="utf-8"))
    names = {name for _, name in declared if not name.startswith("__")}
    assert names - {each for names in HEADERS.values() for each in names} - OF_GLIBC == set()


OF_GLIBC = {"ctermid", "thrd_current"}
"""Functions that this header of glibc declares, but C11 does not have."""


def test_reasons_name_each_function_once() -> None:
    assert sum(len(names) for names in BY_REASON.values()) == len(REASONS)


def test_nothing_that_is_provided_is_refused_except_stand_ins() -> None:
    assert set(REASONS) & function_names() == STAND_INS
    assert function_names() & UNUSED == set()


def test_check_and_load_name_all_refused_functions_with_their_reasons(tmp_path: Path) -> None:
    names = sorted(REASONS)
    declared = "".join(f'extern void f{number}(void) __asm__("{name}");\n' for number, name in enumerate(names))
    calls = "".join(f"f{number}();" for number in range(len(names)))
    source = f"{declared}void TEST_Main(void) {{ if (OS_TaskDelay(1) == 77) {{ {calls} }} }}"
    compile_c(tmp_path, "TEST", source, "-nostdlib")
    folder = write_mission(tmp_path, "TEST")
    texts = [re.sub(r" \(TEST\.c:\d+\)", "", each.text) for each in check_mission(folder)]
    assert len(texts) == len(BY_REASON)
    for text, (reason, names) in zip(texts, BY_REASON.items(), strict=True):
        assert text == f"TEST needs {', '.join(sorted(names))}, but {reason}; calling it is a fault"
    [line] = [each for each in console_of(fly(folder, 1)).splitlines() if "undefined symbols: " in each]
    assert set(line.partition("undefined symbols: ")[2].split(", ")) == set(REASONS)


def test_a_call_of_a_refused_function_gives_the_reason(tmp_path: Path) -> None:
    compile_c(tmp_path, "TEST", "long clock(void); void TEST_Main(void) { clock(); }")
    mission = fly(write_mission(tmp_path, "TEST"), 1)
    error = mission.cfe.es.history["TEST"].last_error
    assert "clock() was called, but cfepy and the libraries of the mission do not define it; CPU time and" in str(error)
