"""The coverage of the interface library: ways out of conditions, and objects whose sources have short names."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from dev.roscfe.building import ROSCFE
from dev.roscfe.coverage import compiler, decisions, read

PROGRAM = """
extern "C" int __wrap_rand();
int main() { return __wrap_rand() == 1804289383 ? 0 : 1; }
"""


def branch(count: int, *, throws: bool = False) -> dict[str, object]:
    return {"count": count, "throw": throws, "fallthrough": not throws}


def test_ways_out_of_calls_are_no_branches() -> None:
    line = [branch(7), branch(0, throws=True), branch(4), branch(3), branch(3), branch(0, throws=True), branch(0)]
    assert decisions(line) == [4, 3, 0]
    assert decisions([]) == []


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("gcov") is None, reason="there is no gcov")
def test_source_with_a_mapped_name_is_counted(tmp_path: Path) -> None:
    made, source = tmp_path / "made", ROSCFE / "src" / "random.cpp"
    made.mkdir()
    wrapper, main = compiler(made), tmp_path / "main.cpp"
    main.write_text(PROGRAM, encoding="utf-8")
    objects = [tmp_path / "random.o", tmp_path / "main.o"]
    for each, wanted in zip([source, main], objects, strict=True):
        flags = [f"-ffile-prefix-map={each.parent}=.", f"-I{ROSCFE / 'include'}"]
        subprocess.run([wrapper, "-std=c++17", *flags, "-c", each, "-o", wanted], check=True)
    subprocess.run([wrapper, *objects, "-o", tmp_path / "program"], check=True)
    subprocess.run([tmp_path / "program"], check=True)
    (row,) = read(made).rows
    assert row.name == "src/random.cpp"
    assert 0 < row.lines < row.all_lines
    assert 0 < row.branches <= row.all_branches
