"""Completion: the words for a shell, and the shells that are installed here."""

from __future__ import annotations

import io
import os
import shutil
import stat
import subprocess
import sys
from pathlib import Path

import pytest

from cfepy.cli.main import ALIASES, ROOMS, main, parser_for
from cfepy.cli.shell_completion import complete
from cfepy.plugins import OWN
from tests.cli.parsers import options, parsers
from tests.cli.ros_packages import Launch, demo, write_launch

__all__ = ["demo", "write_launch"]  # fixtures

pytest.importorskip("argcomplete")


def told(line: str, monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Return the completions of the word at the end of a line."""
    said = {"COMP_LINE": line, "COMP_POINT": str(len(line)), "_ARGCOMPLETE": "1", "_ARGCOMPLETE_IFS": "\n"}
    for name, value in said.items():
        monkeypatch.setenv(name, value)
    stream = io.StringIO()
    complete(parser_for, stream, end=lambda status: None)
    return [word.strip() for word in stream.getvalue().split("\n") if word]


def test_all_commands(monkeypatch: pytest.MonkeyPatch) -> None:
    own = (
        {name for names in ROOMS.values() for name in names}
        | {name for each in OWN for name in each.commands}
        | {*ALIASES}
    )
    assert set(told("cfepy ", monkeypatch)) == own


@pytest.mark.slow
def test_every_option_of_every_command(monkeypatch: pytest.MonkeyPatch) -> None:
    for words, parser in parsers().items():
        shown = told(f"cfepy {words} --", monkeypatch)
        names = {name for each in options(parser) for name in each.option_strings if name.startswith("--")}
        assert names <= set(shown), words


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("cfepy run capt", {"capture"}),
        ("cfepy rostopic echo --for 2 capt", {"capture"}),
        ("cfepy tbl show --mission capt", {"capture"}),
        ("cfepy run lab --board rx", {"rx64m"}),
        ("cfepy run lab --tasks ", {"auto", "thread", "greenlet"}),
        ("cfepy run lab --for ", set()),
        ("cfepy cmd lab CFE_ES_NO", {"CFE_ES_NOOP"}),
        ("cfepy cmd lab CFE_ES_RESTART Re", {"RestartType="}),
        ("cfepy tlm lab CFE_ES_H", {"CFE_ES_HK_TLM"}),
        ("cfepy cmd --show CFE_ES_NO", {"CFE_ES_NOOP"}),
        ("cfepy --completion ", {"bash", "zsh", "fish"}),
        ("cfepy run dem", {"demo/"}),
        ("cfepy run demo/rob", {"demo/robot.launch"}),
        ("cfepy run demo rob", {"robot.launch"}),
        ("cfepy run demo robot.launch --boa", {"--board"}),
    ],
)
def test_names(
    line: str, expected: set[str], demo: Path, write_launch: Launch, monkeypatch: pytest.MonkeyPatch
) -> None:
    Path(write_launch('<node pkg="demo" type="talker.py" name="talker"/>')).rename(demo / "robot.launch")
    monkeypatch.chdir(demo.parent)
    assert set(told(line, monkeypatch)) - {"demo"} == expected


SHELLS = {
    "bash": 'eval "$(cfepy --completion bash)"; COMP_LINE="cfepy run capt"; COMP_POINT=14; COMP_CWORD=2; COMP_TYPE=9; '
    "COMP_WORDS=(cfepy run capt); _python_argcomplete cfepy capt run; echo ${COMPREPLY[0]}",
    "fish": "cfepy --completion fish | source; complete -C 'cfepy run capt'",
}


@pytest.mark.slow
@pytest.mark.parametrize("shell", SHELLS)
def test_a_shell_asks(shell: str, tmp_path: Path) -> None:
    if shutil.which(shell) is None:
        pytest.skip(f"{shell} is not installed")
    command = tmp_path / "cfepy"
    command.write_text(f'#!/bin/sh\nexec {sys.executable} -m cfepy "$@"\n', encoding="utf-8")
    command.chmod(command.stat().st_mode | stat.S_IXUSR)
    environ = {**os.environ, "PATH": f"{tmp_path}{os.pathsep}{os.environ['PATH']}", "PYTHONPATH": str(Path.cwd())}
    done = subprocess.run([shell, "-c", SHELLS[shell]], capture_output=True, text=True, env=environ)
    assert done.stdout.split() == ["capture"]


def test_without_the_library(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setitem(sys.modules, "argcomplete.shell_integration", None)
    assert main(["--completion", "bash"]) == 2
    assert "pip install 'cfepy[completion]'" in capsys.readouterr().err
