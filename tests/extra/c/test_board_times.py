"""The application that measures a board: on a profile it finds the profile's own times."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest

from cfepy.cli.board.program import LINE
from cfepy.cli.main import main
from tests.extra.c.building import needs_compiler

pytestmark = needs_compiler

COSTS = ["--cpu-hz", "100e6", "--tick", "1ms", "--ram", "8MiB"]
TIMES = {"--round-trip": 14_000, "--short": 4_960, "--long": 65_440}  # ns


def board(file: Path, times: dict[str, int]) -> str:
    """Write a profile with these times and without the cost of calls that may wait."""
    words = [word for option, time in times.items() for word in (option, f"{time}ns")]
    assert main(["board", "new", str(file), *COSTS, *words]) == 0
    text = file.read_text(encoding="utf-8")
    file.write_text(text + "node_call_ns: 0\n", encoding="utf-8")
    return text


def told(folder: Path, profile: Path, capsys: pytest.CaptureFixture[str]) -> dict[str, int]:
    """Return the application's measurements, by option."""
    capsys.readouterr()
    assert main(["run", str(folder), "--for", "3", "--board", str(profile)]) == 0
    (words,) = re.findall(r"BOARD_TIMES 1: (.*)", capsys.readouterr().out)
    fields = shlex.split(words)
    return {option: int(time.removesuffix("ns")) for option, time in zip(fields[::2], fields[1::2], strict=True)}


def test_measured_times_match_the_profile_of_the_board(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    program, folder = tmp_path / "program", tmp_path / "mission"
    assert main(["board", "program", str(program)]) == 0
    assert LINE in capsys.readouterr().out
    folder.mkdir()
    assert main(["build", str(program), "-o", str(folder / "board_times.so"), "--flag=-Werror"]) == 0
    (folder / "startup.scr").write_text(f"{LINE}\n!\n", encoding="utf-8")
    first = board(tmp_path / "first.yaml", TIMES)
    found = told(folder, tmp_path / "first.yaml", capsys)
    assert found == pytest.approx(TIMES, abs=1)
    second = board(tmp_path / "second.yaml", found)
    costs = re.compile(r"_cycles.*: \d+")
    assert costs.findall(second) == costs.findall(first)


def test_existing_folder_is_not_changed(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["board", "program", str(tmp_path)]) == 2
    assert "already exists" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())
