"""The folder of cfepy's builds: the user's cache, CFEPY_CACHE, or a folder of its own among temporary ones."""

from __future__ import annotations

import errno
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

from cfepy.extra.c import build_cache
from cfepy.extra.c.build_cache import KEPT_S, cache_folder, mark_used, remove_unused, writing_cache
from cfepy.extra.c.toolchain import headers_folder
from cfepy.status import UsageError
from tests.extra.c.building import needs_compiler


@pytest.fixture(autouse=True)
def _environment(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Set a home that is a file, so that even root cannot make a folder in it, and a folder for temporary files."""
    (tmp_path / "home").write_text("", encoding="utf-8")
    (tmp_path / "tmp").mkdir()
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    monkeypatch.setenv("TMPDIR", str(tmp_path / "tmp"))
    monkeypatch.setattr(tempfile, "tempdir", None)
    for name in ("CFEPY_CACHE", "XDG_CACHE_HOME"):
        monkeypatch.delenv(name, raising=False)


def fallback(tmp_path: Path) -> Path:
    return tmp_path / "tmp" / f"cfepy-cache-{os.getuid()}"


def test_cache_folder_is_in_a_writable_home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HOME", str(tmp_path))
    assert cache_folder() == tmp_path / ".cache/cfepy"
    assert cache_folder().is_dir()


def test_cache_folder_is_set_by_a_variable(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CFEPY_CACHE", str(tmp_path / "a/b"))
    assert cache_folder() == tmp_path / "a/b"


def test_unwritable_home_is_reported_once(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert cache_folder() == fallback(tmp_path)
    said = capsys.readouterr().err
    assert f"{tmp_path}/home/.cache/cfepy cannot be made: Not a directory" in said
    assert str(fallback(tmp_path)) in said
    assert "CFEPY_CACHE" in said
    assert said.count("\n") == 1
    assert cache_folder() == fallback(tmp_path)
    assert capsys.readouterr().err == ""


def test_fallback_folder_is_accessible_only_to_the_user(tmp_path: Path) -> None:
    assert cache_folder().stat().st_mode & 0o777 == 0o700
    assert headers_folder().is_relative_to(fallback(tmp_path))


def test_fallback_folder_writable_by_others_is_refused(tmp_path: Path) -> None:
    fallback(tmp_path).mkdir()
    fallback(tmp_path).chmod(0o777)
    with pytest.raises(UsageError, match=r"only you can write; set CFEPY_CACHE") as failure:
        cache_folder()
    assert failure.value.file == str(fallback(tmp_path))


def test_fallback_folder_that_is_a_link_is_refused(tmp_path: Path) -> None:
    (tmp_path / "elsewhere").mkdir()
    fallback(tmp_path).symlink_to(tmp_path / "elsewhere")
    with pytest.raises(UsageError, match="only you can write"):
        cache_folder()


def test_folder_that_cannot_be_created_is_an_error(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CFEPY_CACHE", str(tmp_path / "home/cache"))
    with pytest.raises(UsageError, match=r"home/cache: cannot be written: Not a directory; set CFEPY_CACHE"):
        headers_folder()


def test_full_cache_is_named() -> None:
    full = OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
    expected = r"^/cache/x: cannot be written: No space left on device; set CFEPY_CACHE"
    with pytest.raises(UsageError, match=expected), writing_cache(Path("/cache/x")):
        raise full


def test_error_outside_the_cache_is_not_attributed_to_it() -> None:
    with pytest.raises(FileNotFoundError), writing_cache(Path("/cache/x")):
        raise FileNotFoundError(errno.ENOENT, "No such file", "/source.c")


APP = "void APP_Main(void) { CFE_ES_ExitApp(CFE_ES_RunStatus_APP_EXIT); }\n"


@needs_compiler
def test_application_is_built_and_flown_without_a_home(tmp_path: Path) -> None:
    (tmp_path / "app.c").write_text('#include "cfe.h"\n' + APP, encoding="utf-8")
    (tmp_path / "startup.scr").write_text("CFE_APP, app.so, APP_Main, APP, 50, 16384, 0x0, 0;\n!\n", encoding="utf-8")
    cfepy = [sys.executable, "-m", "cfepy"]
    made = subprocess.run([*cfepy, "build", str(tmp_path)], capture_output=True, text=True, check=False)
    assert made.returncode == 0, made.stderr
    assert made.stderr.count("CFEPY_CACHE") == 1
    library = Path(made.stdout.splitlines()[0])
    library.rename(tmp_path / "app.so")
    flown = subprocess.run([*cfepy, "run", str(tmp_path), "--for", "1"], capture_output=True, text=True, check=False)
    assert flown.returncode == 0, flown.stdout + flown.stderr
    assert "CFEPY_CACHE" not in flown.stderr


def entry(path: Path, size: int, used_s: float) -> Path:
    """Write a file of a cache that was used at a time, in seconds since 1970."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(bytes(size))
    for each in (path, path.parent):  # writing changes the folder, too
        os.utime(each, (used_s, used_s))
    return path


def test_large_cache_loses_entries_with_the_oldest_use(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(build_cache, "MOST_BYTES", 1000)
    monkeypatch.setattr(build_cache, "KEPT_BYTES", 500)
    folder = tmp_path / "roscfe"
    entry(folder / "messages/std_msgs/String.h", 400, 0)
    os.utime(folder / "messages", (1000, 1000))
    entry(folder / "second.o", 300, 2000)
    entry(folder / "third.o", 200, 3000)
    now = entry(folder / "node.so", 200, 4000 + KEPT_S)
    remove_unused(folder)
    assert sorted(each.name for each in folder.iterdir()) == [now.name, "third.o"]


def test_large_cache_keeps_entries_of_the_last_day(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(build_cache, "MOST_BYTES", 1000)
    monkeypatch.setattr(build_cache, "KEPT_BYTES", 500)
    entry(tmp_path / "old.o", 300, 1000)
    entry(tmp_path / "library.a", 300, 2000)
    used = tmp_path / "old.o"
    mark_used(used, tmp_path / "missing.o")
    newest = used.stat().st_mtime
    entry(tmp_path / "young.o", 600, newest - KEPT_S + 1)
    remove_unused(tmp_path)
    assert sorted(each.name for each in tmp_path.glob("*.*")) == ["old.o", "young.o"]


def test_small_cache_keeps_old_entries(tmp_path: Path) -> None:
    entry(tmp_path / "old.o", 300, 1000)
    entry(tmp_path / "node.so", 300, 2000 + 10 * KEPT_S)
    remove_unused(tmp_path)
    assert (tmp_path / "old.o").is_file()
