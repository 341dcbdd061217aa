"""Paths with drives: a file that a run writes on drive C: lies below its own folder, and the same path finds it
there."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from cfepy.nodes.files import overlay
from cfepy.nodes.files.paths import parted, path_below, place_below


@pytest.mark.parametrize(
    ("path", "found"),
    [("C:\\a\\b", ("C:", "/a/b")), ("C:/a", ("C:", "/a")), ("/a/b", ("", "/a/b")), ("/a:b", ("", "/a:b"))],
)
def test_the_drive_is_parted_from_a_path(path: str, found: tuple[str, str]) -> None:
    assert parted(path) == found


def test_path_is_recovered_from_its_place() -> None:
    place = place_below("D:/Temp/run", "C:/a/b.txt")
    assert place == "D:/Temp/run/C/a/b.txt"
    assert path_below("D:/Temp/run", place.replace("/", "\\")) == "C:/a/b.txt"
    assert path_below("D:/Temp/run", "C:/elsewhere") == "C:/elsewhere"


@pytest.fixture
def disk(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> overlay.Overlay:
    """Return a run's files on a computer whose drive C: is a folder of this one."""
    monkeypatch.setattr(overlay, "HAS_DRIVES", True)
    (tmp_path / "data").mkdir()
    (tmp_path / "data" / "old.txt").write_text("old", encoding="utf-8")
    return overlay.Overlay(host=lambda path: path.replace("C:", str(tmp_path), 1))


def test_files_of_a_drive_are_read_changed_and_removed(disk: overlay.Overlay, tmp_path: Path) -> None:
    assert disk.real("C:\\data\\..\\data\\.\\old.txt") == "C:/data/old.txt"
    assert disk.real("C:\\..") == "C:/"
    assert disk.names(disk.real("C:\\")) == ["data"]
    descriptor = disk.open("C:\\data\\old.txt", os.O_WRONLY)
    os.write(descriptor, b"new")
    os.close(descriptor)
    os.close(disk.open("C:\\data\\more.txt", os.O_WRONLY | os.O_CREAT))
    assert (tmp_path / "data" / "old.txt").read_text(encoding="utf-8") == "old"
    assert Path(disk.place("C:/data/old.txt")).read_text(encoding="utf-8") == "new"
    assert disk.names("C:/data") == ["more.txt", "old.txt"]
    assert [path for path, _ in disk.written()] == ["C:/data/more.txt", "C:/data/old.txt"]
    disk.remove("C:\\data\\old.txt")
    assert disk.names("C:/data") == ["more.txt"]
    disk.close()
