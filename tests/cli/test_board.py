"""`cfepy board report` and `cfepy board new`."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from cfepy.cli.main import main
from cfepy.psp.profile import load_profile

TIMES = ["--cpu-hz", "100e6", "--round-trip", "14us", "--short", "4.96us", "--long", "65.44us"]


def test_a_report(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "fit.json"
    assert main(["board", "report", "rx64m_pubsub", "--for", "1", "--json", str(file)]) == 0
    told = capsys.readouterr().out
    assert re.search(r"CFE_ES +CDS +8,192\n", told)
    assert re.search(r"CDS +CFE_ES +registry +[\d,]+\n", told)
    assert re.search(r"LEFT +3 +8,192 +no C stack\n", told)
    assert "stacks: LEFT, RIGHT: Python has no C stack that could be measured" in told
    assert "RAM: it fits, 312,136 bytes are left" in told
    assert json.loads(file.read_text(encoding="utf-8"))["board"] == "rx64m"


@pytest.mark.slow
def test_what_does_not_fit_is_told(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["board", "report", "capture", "--board", "rx64m", "--for", "1"]) == 1
    told = capsys.readouterr().out
    assert "RAM: it does not fit, 336,896 bytes are missing" in told
    assert "startup.scr:6: stack of HK_MONITOR: 8192 in place of 65536, for each of 3 tasks, saves 172,032, an" in told


def test_a_profile_of_measured_times(tmp_path: Path) -> None:
    file = tmp_path / "mine.yaml"
    words = ["board", "new", str(file), *TIMES, "--tick", "10ms", "--ram", "512KiB", "--flash", "4MiB"]
    assert main(words) == 0
    board = load_profile(file)
    assert (board.name, board.tick_ns, board.sram_size, board.program_flash) == ("mine", 10_000_000, 512 << 10, 4 << 20)
    assert (board.context_switch_cycles, board.syscall_cycles, board.copy_cycles_per_byte) == (300, 200, 3)
    assert board.max_publish_hz == 100
    assert main(words) == 2  # it is there already


@pytest.mark.parametrize("words", [["a.txt", *TIMES], ["a.yaml", *TIMES, "--ram", "much"]])
def test_no_profile(words: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["board", "new", *words]) == 2
    assert not list(tmp_path.iterdir())
