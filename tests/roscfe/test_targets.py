"""Parts of the library on computers of other kinds, big-endian and of 32 bits: the same answers as here.

Numbers are the same to the bit where the compiler keeps each operation by itself (-ffp-contract=off), and where libm
does without instructions that multiply and add at once, which change the last bits of sines. QEMU's PowerPC lacks an
instruction that libm takes, so the big-endian one is MIPS.
"""

from __future__ import annotations

import os
import subprocess
from collections.abc import Sequence
from pathlib import Path

import pytest

from cfepy.extra.convert.message_headers import Profile, write_headers
from dev.roscfe.building import HERE, STRICT_FLAGS, Target, compile_program, needs_cpp, target_named
from dev.roscfe.random_messages import LIBRARY
from tests.roscfe.frame_scripts import scripts
from tests.roscfe.test_fixed import REFUSED
from tests.roscfe.test_frames import CACHE
from tests.roscfe.test_frames import LIBRARY as TRANSFORMS
from tests.roscfe.test_geometry import NAMES, ON_RECORD, RECORDED, words
from tests.roscfe.test_linear_math import inputs
from tests.roscfe.test_roscpp import PRINTED, PROGRAMS

pytestmark = [pytest.mark.slow, needs_cpp]
FOLDER = Path(__file__).parent
GEOMETRY = [f"geometry_msgs/{name}Stamped" for name in NAMES]


@pytest.fixture(params=["mips", "arm"])
def target(request: pytest.FixtureRequest) -> Target:
    """A kind of computer that is emulated."""
    return target_named(request.param)


class There:
    """Programs that are compiled for a kind of computer, and run."""

    def __init__(self, folder: Path, target: Target) -> None:
        folder.mkdir(exist_ok=True)
        self._folder, self._target = folder, target
        write_headers([*PRINTED, *GEOMETRY], folder / "messages", Profile.HOST, LIBRARY)

    def compile(self, name: str, *more: Path, flags: Sequence[str] = ()) -> Path:
        """Return a program of this folder, with other sources."""
        given = (f"-I{self._folder / 'messages'}", "-O1", "-ffp-contract=off", *flags)
        made = self._folder / name
        sources = [FOLDER / f"{name}.cpp", *more]
        return compile_program(made, sources, *given, target=self._target, base=STRICT_FLAGS)

    def run(self, program: Path, *words: str, given: str = "", status: int = 0) -> tuple[str, str]:
        """Return its output, and its log."""
        command = [*self._target.runner, str(program), *words]
        environ = {**os.environ, "GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4"}
        done = subprocess.run(command, input=given, env=environ, capture_output=True, text=True, check=False)
        assert done.returncode == status, done.stderr[-3000:]
        return done.stdout, done.stderr


def test_program_prints_the_output_recorded_with_roscpp(tmp_path: Path, target: Target) -> None:
    there = There(tmp_path, target)
    for name in PROGRAMS:
        assert there.run(there.compile(name))[0] == (FOLDER / f"{name}.txt").read_text(encoding="utf-8"), name


def test_strings_and_vectors_of_fixed_capacity(tmp_path: Path, target: Target) -> None:
    there = There(tmp_path, target)
    program = there.compile("fixed", flags=["-fno-exceptions"])
    assert there.run(program, "0") == ("", "")
    for case, said in REFUSED.items():
        assert there.run(program, str(case), status=3)[0] == said + "\n"


def test_linear_math(tmp_path: Path, target: Target) -> None:
    cases = inputs(200)
    given = "\n".join(" ".join(map(float.hex, case)) for case in cases)
    there, here = There(tmp_path / "there", target), There(tmp_path / "here", HERE)
    found, wanted = (each.run(each.compile("linear_math"), given=given)[0] for each in (there, here))
    assert len(wanted.splitlines()) > 1000
    assert found == wanted


def test_geometry(tmp_path: Path, target: Target) -> None:
    there = There(tmp_path, target)
    cases = inputs(ON_RECORD)
    given = "\n".join(" ".join(map(float.hex, case)) for case in cases)
    printed = there.run(there.compile("geometry", FOLDER / "stubs.cpp"), given=given)[0].splitlines()
    for line, other in zip(printed, RECORDED.read_text(encoding="utf-8").splitlines(), strict=True):
        found = [float.fromhex(word) if "0x" in word else word for word in line.split()]
        assert found == words(other)


def test_transforms(tmp_path: Path, target: Target) -> None:
    there, here = There(tmp_path / "there", target), There(tmp_path / "here", HERE)
    programs = [each.compile("frames", FOLDER / "stubs.cpp", *TRANSFORMS) for each in (there, here)]
    for seed in range(6):
        given = "\n".join(scripts(seed)) + "\n"
        found, wanted = (
            each.run(program, str(CACHE), given=given) for each, program in zip((there, here), programs, strict=True)
        )
        assert found == wanted, seed
