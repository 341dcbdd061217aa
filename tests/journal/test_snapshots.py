"""Facts about files that a run did not open: a replay gets the same ones on any computer."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

import pytest

from cfepy.journal import Journal, read_journal, record, replay
from cfepy.journal.snapshots import ABSENT, FOLDER, LINK, REGULAR, PathLook, put_in_place
from cfepy.pilot import RunPlan
from cfepy.reading.contained_files import is_contained
from cfepy.status import UsageError
from tests.journal.replays import CONTEXTS
from tests.mission.flights import write_mission

NAMES = ("there", "gone", "folder", "empty", "link", "link/inside", "folder/inside", "nowhere", "alias", "dangling")
LOOKS = """
import os
from pathlib import Path
def tell(say):
    os.chdir({place!r})
    for name in {names!r}:
        path = Path(name)
        say(f"{{name}} {{path.exists()}} {{path.is_dir()}} {{os.path.islink(name)}} {{os.access(name, os.W_OK)}}")
        if path.exists():
            state = path.stat()
            say(f"  {{state.st_size}} {{oct(state.st_mode)}} {{state.st_mtime_ns}} {{state.st_nlink}}")
    say(f"{{os.readlink('alias')}} {{Path('link/inside').read_text()}} {{os.path.realpath('alias')}}")
    try:
        say(open("settings").read())
    except FileNotFoundError as error:
        say(f"defaults: {{error}}")
"""
NODE = LOOKS + "tell(print)\nimport time\ntime.sleep(0.2)\n"
APP = LOOKS + '\ndef Main(cfe):\n    tell(lambda text: cfe.os.printf(text + "\\n"))\n'
STARTUP = {
    "node": "CFE_APP, program.py, __main__, PROGRAM, 100, 16384, 0x0, 0;\n!",
    "app": "CFE_APP, program, Main, PROGRAM, 100, 16384, 0x0, 0;\n!",
}


@pytest.fixture
def place(tmp_path: Path) -> Path:
    """Return a folder outside of the mission with one entry of each kind."""
    found = tmp_path / "place"
    (found / "folder").mkdir(parents=True)
    (found / "empty").mkdir(mode=0o700)
    (found / "folder" / "inside").write_text("text", encoding="utf-8")
    (found / "there").write_bytes(b"0123456789")
    os.utime(found / "there", (1000, 1000))
    (found / "there").chmod(0o640)
    (found / "link").symlink_to("folder")
    (found / "alias").symlink_to(found / "there")
    (found / "dangling").symlink_to("no/where")
    return found


def recorded(kind: str, place: Path, tmp_path: Path) -> tuple[Journal, str]:
    source = (NODE if kind == "node" else APP).format(place=str(place), names=NAMES)
    (tmp_path / "mission").mkdir()
    mission = write_mission(tmp_path / "mission", STARTUP[kind], program=source)
    flown = record(RunPlan((mission,), seconds=1.0), tmp_path / "run.cfepy")
    assert any("defaults: " in line for line in flown.mission.console.lines)
    return read_journal(tmp_path / "run.cfepy"), flown.trace


def assert_same(journal: Journal, trace: str) -> None:
    for tasks in CONTEXTS:
        again = replay(journal, tasks=tasks)
        assert again.verdict.same
        assert again.flown.trace == trace


@pytest.mark.parametrize("kind", ["node", "app"])
def test_run_is_reproduced_on_a_computer_without_the_files(kind: str, place: Path, tmp_path: Path) -> None:
    journal, trace = recorded(kind, place, tmp_path)
    shutil.rmtree(place)
    assert_same(journal, trace)


@pytest.mark.parametrize("kind", ["node", "app"])
def test_run_is_reproduced_on_a_computer_with_other_files(kind: str, place: Path, tmp_path: Path) -> None:
    journal, trace = recorded(kind, place, tmp_path)
    (place / "gone").write_text("now there", encoding="utf-8")
    (place / "settings").write_text("others", encoding="utf-8")
    (place / "nowhere").mkdir()
    (place / "there").write_text("longer than it was", encoding="utf-8")
    shutil.rmtree(place / "empty")
    (place / "link").unlink()
    (place / "link").mkdir()
    (place / "alias").unlink()
    (place / "alias").symlink_to("gone")
    assert_same(journal, trace)


def test_file_facts_are_in_the_journal(place: Path, tmp_path: Path) -> None:
    looks = recorded("node", place, tmp_path)[0].looks
    assert looks[f"{place}/there"] == PathLook(f"{place}/there", REGULAR, 10, 0o640, 1000 * 10**9)
    assert looks[f"{place}/gone"] == PathLook(f"{place}/gone", ABSENT)
    assert looks[f"{place}/link"].target == "folder"
    assert {each.kind for each in looks.values()} == {ABSENT, FOLDER, LINK, REGULAR}
    assert all(map(is_contained, looks))
    assert not any(path.startswith(os.path.dirname(os.__file__) + "/") for path in looks)


def test_link_does_not_lead_outside(tmp_path: Path) -> None:
    outside = tmp_path / "outside"
    outside.mkdir()
    root = tmp_path / "root"
    root.mkdir()
    first = PathLook("/way", LINK, target=str(outside))
    for kind in (REGULAR, FOLDER):  # which are put in place first, whatever the order
        assert put_in_place(root, [first, PathLook("/way/in", kind)]) == frozenset()
        assert not list(outside.iterdir())
        shutil.rmtree(root / "way")
    put_in_place(root, [first])
    with pytest.raises(UsageError, match="symbolic link"):
        put_in_place(root, [PathLook("/way/in", REGULAR)])


def test_large_file_takes_no_disk_space(tmp_path: Path) -> None:
    put_in_place(tmp_path, [PathLook("/large", REGULAR, 1 << 35, 0o644, 5)])
    found = (tmp_path / "large").stat()
    assert (found.st_size, found.st_mtime_ns) == (1 << 35, 5)
    assert found.st_blocks == 0
