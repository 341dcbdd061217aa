"""docs/how_to/sbn.md: its commands, unchanged."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest

from cfepy.cli.main import main

PAGE = Path(__file__).parents[2] / "docs/how_to/sbn.md"
_BLOCK = re.compile(r"^```(\w*)\n(.*?)^```", re.MULTILINE | re.DOTALL)


def commands() -> list[str]:
    """Return the lines that are commands, in their order."""
    text = "".join(text for _, text in _BLOCK.findall(PAGE.read_text(encoding="utf-8")))
    return [line for line in text.splitlines() if line.startswith("cfepy ")]


@pytest.mark.slow
def test_its_commands_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "missions").symlink_to(PAGE.parents[2] / "missions")
    free = [line for line in commands() if "--realtime" not in line]  # those are flown in tests/twin/test_sbn.py
    assert len(free) == 9
    for line in free:
        assert main(shlex.split(line)[1:]) == 0, line
        assert "Traceback" not in capfd.readouterr().out
