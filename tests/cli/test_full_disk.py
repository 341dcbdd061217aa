"""Outputs on a full disk, and without memory: the error names them, and no partial file is left."""

from __future__ import annotations

import errno
import subprocess
import sys
from pathlib import Path

import pytest

from cfepy.cli import main as entry
from cfepy.cli.main import main
from cfepy.cli.user_notes import writing
from cfepy.status import UsageError

TABLE = str(Path(__file__).parents[1] / "data/hk_cpy_tbl.tbl")
FULL = Path("/dev/full")
pytestmark = pytest.mark.skipif(not FULL.exists(), reason="no /dev/full here")


@pytest.mark.parametrize("option", ["--json", "--yaml"])
def test_a_full_file_is_named(option: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["tbl", "show", TABLE, option, str(FULL)]) == 2
    assert f"/dev/full: {option}: cannot be written: No space left on device" in capsys.readouterr().err


def test_half_a_file_does_not_stay(tmp_path: Path) -> None:
    def half(number: int) -> None:
        (tmp_path / "x").write_text("{", encoding="utf-8")
        raise OSError(number, "told")

    for number, stays in ((errno.ENOSPC, False), (errno.EDQUOT, False), (errno.EACCES, True)):
        with pytest.raises(UsageError, match="x: --json: cannot be written: told"), writing(tmp_path / "x", "--json"):
            half(number)
        assert (tmp_path / "x").exists() is stays


def test_a_run_that_does_not_begin_leaves_no_empty_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", str(tmp_path / "none"), "--json", str(tmp_path / "x.json")]) == 2
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("error", [MemoryError(), OSError(errno.ENOMEM, "Cannot allocate memory")])
def test_without_memory_the_input_is_named(
    error: Exception, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def command(name: str) -> None:
        raise error

    monkeypatch.setattr(entry, "_command", command)
    assert main(["tbl", "show", TABLE]) == 2
    assert f"out of memory in `cfepy tbl show {TABLE}`" in capsys.readouterr().err


@pytest.mark.parametrize("words", [["board", "list"], ["tbl", "show", TABLE, "--json", "-"]], ids=("text", "json"))
def test_a_full_standard_output_is_named(words: list[str]) -> None:
    command = [sys.executable, "-m", "cfepy", *words]
    with FULL.open("w", encoding="utf-8") as full:
        process = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, text=True)
    assert process.stderr == "cfepy: standard output cannot be written: No space left on device\n"
    assert process.returncode == 2


def test_a_full_disk_is_not_taken_for_standard_output(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def command(name: str) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(entry, "_command", command)
    assert main(["tbl", "show", TABLE]) == 2
    assert capsys.readouterr().err.startswith("cfepy: a file cannot be written: No space left on device; make room")
