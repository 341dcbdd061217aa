"""The samples of output in README equal the output of the commands."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from cfepy.cli.main import main

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")
LEFT_OUT = "..."
HOW_LONG = re.compile(r"in [\d.]+ s: [\d.]+ x real time, board linux, \w+ tasks")


def sample(first: str) -> list[str]:
    """Return the lines of the code block that begins with a line."""
    block = next(each for each in re.findall(r"^```\w*\n(.*?)^```", README, re.M | re.S) if each.startswith(first))
    return block.splitlines()


def masked(line: str) -> str:
    """Return a line without parts that depend on the computer."""
    line = re.sub(r"^trace: .*", "trace: ...", HOW_LONG.sub("in so long", line))
    return re.sub(r" +", " ", line).rstrip()


def missing(lines: list[str], printed: str) -> Iterator[str]:
    """Yield the lines that are not printed, or only before a line above them; `...` stands for any lines."""
    left = [masked(line) for line in printed.splitlines()]
    for line in map(masked, lines):
        if line.strip() == LEFT_OUT:
            continue
        if line not in left:
            yield line
        else:
            del left[: left.index(line) + 1]


@pytest.mark.slow
def test_the_demonstration(capsys: pytest.CaptureFixture[str]) -> None:
    main(["run", "capture", "--for", "20", "--tasks", "greenlet"])
    assert list(missing(sample("CFE_PSP: "), capsys.readouterr().out)) == []


@pytest.mark.slow
def test_the_race(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    command, *lines = sample("$ cfepy explore")
    assert main(command.split()[2:]) == 1
    assert list(missing(lines, capsys.readouterr().out)) == []
