"""The command itself: help, version, and the modules loaded for them."""

from __future__ import annotations

import importlib
import subprocess
import sys
from pathlib import Path

import pytest

import cfepy
from cfepy.cli.main import ALIASES, ROOMS, main
from cfepy.cli.parser import CommandParser
from cfepy.interpreter import compiled


@pytest.mark.parametrize("words", [["--help"], ["run", "--help"], ["check", "--help"], ["new", "--help"]])
def test_help(words: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(words)
    assert ended.value.code == 0
    assert capsys.readouterr().out.startswith("usage: cfepy")


def test_version(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["--version"])
    first, *releases = capsys.readouterr().out.splitlines()
    assert first == f"cfepy {cfepy.__version__} ({compiled.state()})"
    assert releases[0] == "cfe_version 7.0.1: cfe v7.0.1+dev0, osal v7.0.0+dev0, psp v7.0.0+dev0, the default"
    assert [line.partition(":")[0] for line in releases] == [
        f"cfe_version {name}" for name in ("7.0.1", "7.0.0", "dev")
    ]


@pytest.mark.parametrize("words", [[], ["fly"], ["run"], ["new", "app"], ["run", "x", "--tasks", "fibers"]])
def test_bad_usage(words: list[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(words)
    assert ended.value.code == 2


@pytest.mark.parametrize(
    ("words", "command"),
    [(["board", "list", "x"], "cfepy board list"), (["tbl", "show", "a.tbl", "b.tbl"], "cfepy tbl show")],
)
def test_words_too_many_show_the_usage_of_the_command(
    words: list[str], command: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit):
        main(words)
    said = capsys.readouterr().err
    assert said.startswith(f"usage: {command} ")
    assert f"{command}: error: unrecognized arguments: {words[-1]}" in said


@pytest.mark.parametrize(("room", "names"), ROOMS.items())
def test_each_room_adds_the_commands_that_it_is_asked_for(room: str, names: tuple[str, ...]) -> None:
    commands = CommandParser().add_subparsers()
    importlib.import_module(f"cfepy.cli.{room}").add(commands)
    assert tuple(name for name in commands.choices if name not in ALIASES) == names


def test_a_wrong_command_is_answered_with_all_of_them(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["fly"])
    said = capsys.readouterr().err
    assert all(repr(name) in said for names in ROOMS.values() for name in names)


def test_help_imports_nothing_heavy() -> None:
    program = "import sys\nfrom cfepy.cli.main import main\ntry: main(['--help'])\nfinally: print(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    loaded = set(done.stdout.splitlines()[-1].split())
    assert loaded.isdisjoint({"rich", "numpy", "yaml", "cfepy.mission", "cfepy.rtos"})


def test_an_empty_run_imports_neither_ros_nor_what_other_commands_need(tmp_path: Path) -> None:
    (tmp_path / "startup.scr").write_text("!\n", encoding="utf-8")
    words = ["run", str(tmp_path), "--for", "0.6", "--quiet"]
    program = f"import sys\nfrom cfepy.cli.main import main\nmain({words})\nprint(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    loaded = set(done.stdout.splitlines()[-1].split())
    assert {"cfepy.mission", "cfepy.rtos"} <= loaded
    others = {f"cfepy.cli.{room}" for room in ROOMS if room != "run"}
    assert loaded.isdisjoint(
        {"rich", "numpy", "json", "rospy_shim.runtime", "cfepy.io", "cfepy.script.script_run"} | others
    )


def test_boards(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["board", "list"]) == 0
    shown = capsys.readouterr().out
    assert "120 MHz" in shown
    assert "552 KiB" in shown
