"""Applications whose code is only on the virtual file system."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from cfepy.es.packets import RESTART_APP, START_APP
from cfepy.mission import Mission
from cfepy.mission.python_code import find_virtual_code
from cfepy.osal import FileSystem
from cfepy.writing.console import Console
from tests.mission.flights import write_mission


@pytest.mark.parametrize("written", ["/ram/x.py", "/ram/x.so", "/cf/x.o"])
def test_source_is_found_with_and_without_its_suffix(written: str) -> None:
    files = FileSystem()
    files.write_file(written, b"A = 1\n")
    found = find_virtual_code(written.replace(".py", ".so"), files)
    assert found is not None
    assert (found.path, found.source) == (written, b"A = 1\n")
    assert find_virtual_code("/ram/y.so", files) is None


@pytest.mark.parametrize(
    ("source", "said"),
    [
        (b"def late_main(cfe):\n    raise ValueError('too late')\n", "    raise ValueError('too late')"),
        (b"def late_main(cfe)\n", "SyntaxError: expected ':'"),
        (b"\xff\x00", "SyntaxError" if sys.version_info >= (3, 11, 4) else "ValueError"),
    ],
)
def test_traceback_shows_lines_of_virtual_source(tmp_path: Path, source: bytes, said: str) -> None:
    with Mission(write_mission(tmp_path, "!"), console=Console(quiet=True)) as mission:
        mission.run_for(2)
        mission.files.write_file("/ram/late.py", source)
        start = START_APP.packet(Application="LATE", AppEntryPoint="late_main", AppFileName="/ram/late.so")
        mission.cfe.sb.transmit_msg(start, is_origination=False)
        mission.run_for(2)
        assert any(line.startswith(said) for line in mission.console.lines), mission.console.lines
        assert any('"/ram/late.py"' in line for line in mission.console.lines) or source == b"\xff\x00"


OLD = """
    def main(cfe):
        cfe.os.printf("the old code")
        while cfe.es.run_loop():
            cfe.os.task_delay(100)
"""
NEW = (
    b"def main(cfe):\n    cfe.os.printf('the new code')\n    while cfe.es.run_loop():\n        cfe.os.task_delay(100)\n"
)


@pytest.fixture
def patched(tmp_path: Path) -> Iterator[Mission]:
    """Return a mission whose application LATE was started from its folder."""
    startup = "CFE_APP, late, main, LATE, 50, 8192, 0, 0;!"
    with Mission(write_mission(tmp_path, startup, late=OLD), console=Console(quiet=True)) as mission:
        mission.run_for(2)
        yield mission


def restart(mission: Mission) -> None:
    mission.cfe.sb.transmit_msg(RESTART_APP.packet(Application="LATE"), is_origination=False)
    mission.run_for(8)


def test_overwritten_file_of_the_mission_is_used_by_the_next_start(patched: Mission) -> None:
    patched.files.write_file("/cf/late.py", NEW)
    restart(patched)
    assert [line for line in patched.console.lines if line.startswith("the ")] == ["the old code", "the new code"]


def test_removed_file_cannot_be_started(patched: Mission) -> None:
    patched.files.remove("/cf/late.py")
    restart(patched)
    assert any("Cannot Restart Application LATE, File /cf/late.so does not exist" in x for x in patched.console.lines)


def test_unchanged_file_is_read_from_the_host(patched: Mission) -> None:
    patched.files.read_file("/cf/late.py")
    restart(patched)
    assert [line for line in patched.console.lines if line.startswith("the ")] == ["the old code"] * 2


def test_app_edited_within_a_second_is_reloaded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "dont_write_bytecode", False)
    monkeypatch.setattr(sys, "pycache_prefix", None)
    said = []
    for number in (1, 2):
        app = f"def main(cfe):\n    cfe.es.write_to_sys_log('edition {number}')\n"
        folder = write_mission(tmp_path, "CFE_APP, app, main, APP, 50, 16384, 0, 0;\n!", app=app)
        os.utime(tmp_path / "app.py", (0, 0))
        with Mission(folder, console=Console(quiet=True)) as mission:
            mission.run_for(1)
            said += [line.split()[-1] for line in mission.console.lines if " edition " in line]
    assert said == ["1", "2"]
    assert not list(tmp_path.rglob("*.pyc")), "a run writes nothing to the host"


def test_an_app_is_compiled_once(tmp_path: Path) -> None:
    app = "def main(cfe):\n    cfe.os.printf(f'code {id(main.__code__)}\\n')\n"
    folder = write_mission(tmp_path, "CFE_APP, app, main, APP, 50, 16384, 0, 0;\n!", app=app)
    said = set()
    for _ in range(2):
        with Mission(folder, console=Console(quiet=True)) as mission:
            mission.run_for(1)
            said |= {line for line in mission.console.lines if line.startswith("code ")}
    assert len(said) == 1
