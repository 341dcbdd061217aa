"""Text of numbers without libc's printf and without std::ostream: the same characters as theirs."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from dev.roscfe.building import ROSCFE, STRICT_FLAGS, compile_program, needs_cpp, target_named

pytestmark = [pytest.mark.slow, needs_cpp]
FOLDER = Path(__file__).parent
FORMATS = [ROSCFE / "src/formats.cpp", ROSCFE / "src/floats.cpp"]
BASE = (*STRICT_FLAGS, "-Wno-format", "-Wno-format-security", "-O1")


@pytest.mark.parametrize("target", ["here", "arm"])
def test_texts_equal_printf_s(tmp_path: Path, target: str) -> None:
    there = target_named(target)
    program = compile_program(tmp_path / "formats", [FOLDER / "printf_texts.cpp", *FORMATS], base=BASE, target=there)
    done = subprocess.run([*there.runner, str(program), "5000"], capture_output=True, text=True, check=False)
    assert done.stdout == "80008 texts, 0 different\n"


@pytest.mark.parametrize("profile", ["POOL", "STRICT"])
def test_log_stream_writes_the_characters_of_ostringstream(tmp_path: Path, profile: str) -> None:
    sources = [FOLDER / "stream_lines.cpp", FOLDER / "stubs.cpp", ROSCFE / "src/log_stream.cpp", *FORMATS]
    program = compile_program(tmp_path / "lines", sources, f"-DROSCFE_PROFILE_{profile}", base=BASE)
    done = subprocess.run([str(program)], capture_output=True, text=True, check=False)
    assert done.stdout == "40016 lines, 0 different\n"


def test_standard_streams_need_no_header_of_the_node(tmp_path: Path) -> None:
    node = tmp_path / "node.cpp"
    node.write_text(
        '#include "ros/console.h"\nstruct Early { Early() { std::cout << "early\\n"; } } early;\n'
        "int main() { int number = 0; std::cin >> number; std::cout << number + 1 << std::endl; }\n",
        encoding="utf-8",
    )
    sources = [node, ROSCFE / "src/standard_streams.cpp"]
    program = compile_program(tmp_path / "streams", sources, "-DROSCFE_PROFILE_POOL", base=BASE)
    done = subprocess.run([str(program)], input="41\n", capture_output=True, text=True, check=False)
    assert done.stdout == "early\n42\n"
