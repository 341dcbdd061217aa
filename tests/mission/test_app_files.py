"""Files that applications write with Python's own functions belong to their run, as with nodes."""

from __future__ import annotations

import tempfile
from pathlib import Path
from xml.etree import ElementTree  # noqa: F401  # the host's own, which an application looks at

import pytest

from cfepy.cli.main import main
from cfepy.journal import read_journal, record
from cfepy.pilot import RunPlan, fly
from tests.journal.replays import assert_same_again
from tests.mission.flights import write_mission

STARTUP = "CFE_APP, keeper, Main, KEEPER, 100, 16384, 0x0, 0;\n!"
KEEPER = """
    import codecs, logging, os, shutil, sqlite3, tempfile, zipfile
    import logging.handlers
    from pathlib import Path
    from xml.etree import ElementTree
    import numpy as np

    def Main(cfe):
        with open("starts", "a+") as file:
            file.seek(0)
            cfe.os.printf(f"start {len(file.read())}\\n")
            file.write("x")
        scratch = Path(tempfile.mkdtemp())
        base = sqlite3.connect(scratch / "base.db")
        base.execute("create table starts (at)")
        cfe.os.task_delay(200)
        base.execute("insert into starts values (1)")
        base.commit()
        base.close()
        np.save(scratch / "array.npy", np.arange(3))
        ElementTree.ElementTree(ElementTree.Element("tree")).write(scratch / "tree.xml")
        codecs.open(scratch / "text", "w", "utf-8").close()
        with zipfile.ZipFile(scratch / "all.zip", "w") as archive:
            archive.write(scratch / "text")
        shutil.copy(scratch / "tree.xml", scratch / "copy.xml")
        for handler in (
            logging.FileHandler(scratch / "log"),
            logging.handlers.RotatingFileHandler(scratch / "turns", maxBytes=10, backupCount=1),
        ):
            for text in ("first one", "second one"):
                handler.emit(logging.makeLogRecord({"msg": text}))
            handler.close()
        assert np.load(scratch / "array.npy").sum() == 3 and np.linalg.norm([3, 4]) == 5
        assert (scratch / "turns.1").read_text() == "first one\\n"
        os.remove("old")
        found = [(each.name, each.stat().st_mtime_ns) for each in sorted(scratch.iterdir())]
        for each in (scratch, os.listdir("."), *found):
            cfe.os.printf(f"{each}\\n")
        while cfe.es.run_loop():
            cfe.os.task_delay(1000)
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The working directory of a run, with two files."""
    home = tmp_path / "home"
    home.mkdir()
    (home / "starts").write_text("xx", encoding="utf-8")
    (home / "old").write_text("y", encoding="utf-8")
    monkeypatch.chdir(home)
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))  # where runs have their own files
    return home


@pytest.fixture
def mission(tmp_path: Path, folder: Path) -> str:
    (tmp_path / "mission").mkdir()
    return write_mission(tmp_path / "mission", STARTUP, keeper=KEEPER)


def plan(mission: str, tasks: str = "thread", seed: int = 0) -> RunPlan:
    return RunPlan((mission,), seconds=1.0, tasks=tasks, seed=seed)


def unchanged(folder: Path) -> bool:
    names = {path.name for path in folder.parent.iterdir() if path.suffix != ".cfepy"}
    return names == {"home", "mission"} and {
        path.name: path.read_text(encoding="utf-8") for path in folder.iterdir()
    } == {
        "starts": "xx",
        "old": "y",
    }


def test_files_written_by_an_application_are_private_to_the_run(mission: str, folder: Path) -> None:
    runs = [fly(plan(mission, tasks)) for tasks in ("thread", "greenlet", "thread")]
    lines = runs[0].mission.console.lines
    assert not runs[0].results.problems
    assert "start 2" in lines
    assert "['starts']" in lines
    assert len([line for line in lines if line.startswith("('")]) == 9
    assert len({run.trace for run in runs}) == 1
    assert fly(plan(mission, seed=1)).trace != runs[0].trace  # temporary files have names of the run's
    assert unchanged(folder)


def test_journal_has_the_files_that_were_read(mission: str, folder: Path, tmp_path: Path) -> None:
    flown = record(plan(mission), tmp_path / "run.cfepy")
    assert str(folder / "starts") in read_journal(tmp_path / "run.cfepy").files
    (folder / "starts").write_text("another computer", encoding="utf-8")
    (folder / "old").unlink()
    assert_same_again(read_journal(tmp_path / "run.cfepy"), flown.trace)


def test_written_files_can_be_saved(
    mission: str, folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("TMPDIR", raising=False)
    out = tmp_path / "out"
    assert main(["run", mission, "--for", "1", "--quiet", "--save-files", str(out)]) == 0
    assert (out / str(folder).lstrip("/") / "starts").read_text(encoding="utf-8") == "xxx"
    (log,) = out.glob("tmp/tmp*/log")
    assert log.read_text(encoding="utf-8") == "first one\nsecond one\n"


@pytest.mark.slow
def test_file_access_is_not_reported_as_nondeterminism(
    mission: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["run", mission, "--for", "1", "--check-determinism", "2"]) == 0
    assert "past the simulated computer" not in capsys.readouterr().out


def flown_with(tmp_path: Path, startup: str, **sources: str) -> list[str]:
    """Return the lines of the console of a mission that flies for two seconds."""
    (tmp_path / "other").mkdir(exist_ok=True)
    flown = fly(RunPlan((write_mission(tmp_path / "other", startup, **sources),), seconds=2.0))
    return list(flown.mission.console.lines)


ONE = "CFE_APP, app, Main, APP, 100, 16384, 0x0, 0;\n!"


def test_apps_and_nodes_share_one_set_of_files(folder: Path, tmp_path: Path) -> None:
    note = tmp_path / "note"
    writer = f'def Main(cfe):\n    with open("{note}", "w") as file:\n        file.write("from the app")\n'
    reader = f'import time\ntime.sleep(0.5)\nprint(open("{note}").read())\n'
    startup = "CFE_APP, app, Main, APP, 100, 16384, 0, 0;\nCFE_APP, node.py, __main__, NODE, 100, 16384, 0, 0;\n!"
    lines = flown_with(tmp_path, startup, app=writer, node=reader)
    assert "[NODE] from the app" in lines
    assert not note.exists()


def test_modules_of_a_package_use_the_files_of_the_run(folder: Path, tmp_path: Path) -> None:
    package = tmp_path / "other" / "app"
    (package / "inner").mkdir(parents=True)
    (package / "__init__.py").write_text(
        "from .inner import keep\nfrom . import words\nMain = keep.Main\n", encoding="utf-8"
    )
    (package / "words.py").write_text("def text():\n    return open('starts').read()\n", encoding="utf-8")
    (package / "inner" / "__init__.py").write_text("", encoding="utf-8")
    main_function = """
from .. import words
from ..words import text
def Main(cfe):
    assert text is words.text
    open("starts", "w").close()
    cfe.os.printf(f"{text()!r} {words.__name__.rpartition('_')[2]}\\n")
"""
    (package / "inner" / "keep.py").write_text(main_function, encoding="utf-8")
    assert "'' 1.words" in flown_with(tmp_path, ONE)
    assert (folder / "starts").read_text(encoding="utf-8") == "xx"


def test_missing_module_is_reported_as_by_python(folder: Path, tmp_path: Path) -> None:
    package = tmp_path / "other" / "app"
    package.mkdir(parents=True)
    (package / "__init__.py").write_text("from . import words\n", encoding="utf-8")
    lines = flown_with(tmp_path, ONE)
    assert any("ImportError: cannot import name 'words' from 'cfepy_app_" in line for line in lines)


def test_missing_file_is_reported_with_its_line(folder: Path, tmp_path: Path) -> None:
    lines = flown_with(tmp_path, ONE, app="def Main(cfe):\n    open('nothing')\n")
    text = "\n".join(lines)
    assert "FileNotFoundError: [Errno 2] No such file or directory: 'nothing'" in text
    assert "cfepy/nodes" not in text


def test_other_modules_use_the_real_functions(folder: Path, tmp_path: Path) -> None:
    source = """
    import importlib, os, pathlib, sys, threading, logging, numpy, json, io
    import importlib.resources
    import xml.etree.ElementTree as tree
    def Main(cfe):
        host = sys.modules
        assert threading is host["threading"] and json is host["json"]
        assert importlib.import_module("json") is json and importlib.import_module("os") is os
        assert importlib.util is host["importlib.util"] and importlib.resources is host["importlib.resources"]
        assert logging.getLogger() is host["logging"].getLogger()
        assert os.environ is host["os"].environ and isinstance(pathlib.Path(), os.PathLike)
        assert numpy.ndarray is host["numpy"].ndarray and numpy.random is host["numpy"].random
        assert tree.Element is host["xml.etree.ElementTree"].Element
        assert isinstance(open("starts"), io.TextIOWrapper)
        with open("starts", "rb", buffering=0) as raw:
            assert isinstance(raw, io.FileIO)
            assert os.fdopen(os.dup(raw.fileno()), "rb").read() == b"xx"
        cfe.os.printf("all well\\n")
    """
    lines = flown_with(tmp_path, ONE, app=source)
    assert "all well" in lines


def test_run_without_file_access_has_no_run_files(tmp_path: Path) -> None:
    flown = fly(RunPlan((write_mission(tmp_path, ONE, app="def Main(cfe):\n    pass\n"),), seconds=1.0))
    assert flown.mission.run_files is None


def test_second_processor_finds_files_of_the_first(folder: Path, tmp_path: Path) -> None:
    source = """
    import os
    def Main(cfe):
        with open("starts", "a") as file:
            file.write("x")
        cfe.os.printf(f"{os.path.getsize('starts')} bytes, {os.path.exists('/tmp/left')}\\n")
        os.chdir("/tmp")
        global left
        left = open("left", "w")
        left.write("open")
        cfe.os.task_delay(100)
        if not os.path.getsize("left") and not os.path.exists("again"):
            open("again", "w").close()
            cfe.es.reset_cfe(1)
    """
    lines = flown_with(tmp_path, ONE, app=source)
    assert [line for line in lines if "bytes" in line] == ["3 bytes, False", "4 bytes, True"]
