"""`cfepy run --save-files`: files that a mission wrote reach the host."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.cli.main import main

WRITER = '''
OPEN = 3  # create, truncate


def Writer(cfe):
    """Writes two files, changes one of the mission's own, and removes a third."""
    for path, data in (("/ram/note.txt", b"hello"), ("/ram/gone.txt", b"x"), ("/cf/plan.txt", b"new")):
        file = cfe.os.open_create(path, OPEN, 2)
        cfe.os.write(file, data)
        cfe.os.close(file)
    cfe.os.remove("/ram/gone.txt")
    cfe.os.mkdir("/ram/sub", 0)
    file = cfe.os.open_create("/ram/sub/deep.txt", OPEN, 2)
    cfe.os.close(file)
    while cfe.es.run_loop(1):
        cfe.os.task_delay(100)
'''


@pytest.fixture
def mission(tmp_path: Path) -> Path:
    folder = tmp_path / "mission"
    folder.mkdir()
    (folder / "writer.py").write_text(WRITER, encoding="utf-8")
    (folder / "plan.txt").write_text("old", encoding="utf-8")
    (folder / "startup.scr").write_text("CFE_APP, writer, Writer, WRITER, 50, 8192, 0, 0;\n!\n", encoding="utf-8")
    return folder


def test_what_the_mission_wrote_is_saved(mission: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    target = tmp_path / "made" / "out"
    assert main(["run", str(mission), "--for", "1", "--no-console", "--save-files", str(target)]) == 0
    saved = {str(path.relative_to(target)): path.read_bytes() for path in target.rglob("*") if path.is_file()}
    assert saved == {"ram/note.txt": b"hello", "ram/sub/deep.txt": b"", "cf/plan.txt": b"new"}
    assert f"saved to {target}: 3 files" in capsys.readouterr().out
    assert (mission / "plan.txt").read_text(encoding="utf-8") == "old"


def test_a_folder_that_cannot_be_made_is_an_error_before_the_run(
    mission: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "file").write_text("", encoding="utf-8")
    assert main(["run", str(mission), "--save-files", str(tmp_path / "file" / "out")]) == 2
    out, err = capsys.readouterr()
    assert "--save-files: cannot be made" in err
    assert out == ""


def test_a_file_that_cannot_be_written(mission: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "out" / "ram" / "note.txt").mkdir(parents=True)
    command = ["run", str(mission), "--for", "1", "--no-console", "--save-files", str(tmp_path / "out")]
    assert main(command) == 2
    out, err = capsys.readouterr()
    assert "note.txt" in err
    assert "cannot be written" in err
    assert "Applications" in out
