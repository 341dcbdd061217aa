"""Waiting for changed files, without a clock: the waiting function of a test changes the files."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from cfepy.io import WatchedFiles


def written(path: Path, text: str = "") -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    return path


def acting(*acts: Callable[[], object]) -> Callable[[float], None]:
    """Return a waiting function that does one act at each call, and nothing after the last one."""
    left = [*acts]
    return lambda seconds: left.pop(0)() if left else None  # type: ignore[func-returns-value]


def nothing() -> None:
    """Change nothing."""


def test_changed_new_and_removed_files_are_found(tmp_path: Path) -> None:
    one, two = written(tmp_path / "m/one.py"), written(tmp_path / "m/sub/two.py")
    other = written(tmp_path / "lib/other.py")
    files = WatchedFiles(tmp_path / "m", [str(other)])
    assert files.changed() == []
    written(one, "x")
    two.unlink()
    new = written(tmp_path / "m/sub/new.msg")
    written(other, "y")
    assert files.changed() == sorted(map(str, (one, two, new, other)))


def test_wait_ends_when_the_files_rest(tmp_path: Path) -> None:
    one, two = written(tmp_path / "one.py"), written(tmp_path / "two.py")
    files = WatchedFiles(tmp_path)
    pause = acting(nothing, lambda: written(one, "1"), lambda: written(two, "2"), nothing, lambda: written(one, "late"))
    assert files.wait(pause) == [str(one), str(two)]
    assert files.changed() == []


def test_change_before_the_wait_counts(tmp_path: Path) -> None:
    one = written(tmp_path / "one.py")
    files = WatchedFiles(tmp_path)
    written(one, "during the run")
    assert files.wait(acting()) == [str(one)]


def test_change_that_is_undone_does_not_count(tmp_path: Path) -> None:
    files = WatchedFiles(tmp_path)
    one, two = tmp_path / "one.py", tmp_path / "two.py"
    assert files.wait(acting(lambda: written(one), one.unlink, lambda: written(two))) == [str(two)]


def test_outputs_hidden_and_made_files_do_not_count(tmp_path: Path) -> None:
    files = WatchedFiles(
        tmp_path, [str(tmp_path / "run.json")], but=[str(tmp_path / "run.json"), str(tmp_path / "out")]
    )
    for name in ("run.json", "out/ram/x.log", ".git/index", ".one.py.swp", "__pycache__/one.pyc", "one.py~"):
        written(tmp_path / name, "x")
    assert files.changed() == []


def test_added_files_count_from_then_on(tmp_path: Path) -> None:
    late = written(tmp_path / "lib/late.py")
    files = WatchedFiles(None)
    files.add([str(late), str(tmp_path / "missing.py")])
    assert files.changed() == []
    written(late, "x")
    written(tmp_path / "missing.py")
    assert files.changed() == sorted([str(late), str(tmp_path / "missing.py")])
