"""Foreign files are opened by one helper: regular files, and streams from the command line."""

from __future__ import annotations

import ast
import errno
import os
from pathlib import Path

import pytest

from cfepy.reading.input_files import beginning_of, open_input, read_limited, text_limited
from cfepy.reading.marked_yaml import load
from cfepy.status import UsageError

ROOT = Path(__file__).parents[2]
OPENERS = {
    # these read or write cfepy's own files, or files that the user's options name for writing
    "cfepy/cli/json_output.py": "writes",
    "cfepy/cli/user_notes.py": "writes",
    "cfepy/plugins.py": "what pip wrote of installed packages",
    "cfepy/cli/main.py": "the device that swallows all",
    "cfepy/cli/files/log.py": "writes",
    "cfepy/cli/ground/export.py": "writes",
    "cfepy/extra/debugger/command.py": "pipes to gdb",
    "cfepy/extra/reports/commands/trace.py": "writes",
    "cfepy/cli/run/outputs.py": "writes, and reads what the run wrote",
    "cfepy/cli/run/compared_run.py": "a pipe to another process of cfepy",
    "cfepy/cli/run/compared_runs.py": "a pipe to another process of cfepy",
    "cfepy/cli/run/new.py": "templates",
    "cfepy/cli/run/new_schema.py": "schemas of cfepy",
    "cfepy/cli/run/watch.py": "the results of another process of cfepy",
    "cfepy/reading/contained_files.py": "writes",
    "cfepy/reading/input_files.py": "the helper",
    "cfepy/journal/journal.py": "writes",
    "cfepy/ground/bag.py": "writes",
    "cfepy/ground/recording.py": "writes",
    "cfepy/extra/exploration/results_file.py": "writes",
    "cfepy/io/own_names.py": "/etc/hosts",
    "cfepy/config/versions.py": "releases that come with cfepy",
    "cfepy/interpreter/blas_threads.py": "/proc",
    "cfepy/rtos/cpus.py": "/proc",
    "cfepy/rtos/cpu_time.py": "/proc",
    "cfepy/extra/debugger/gdb.py": "/proc",
    "cfepy/extra/c/api/posix_files.py": "files of the mission, for applications in C",
    "cfepy/extra/c/toolchain/compiler.py": "/proc",
    "cfepy/interpreter/compiled.py": "cfepy's own sources",
    "cfepy/extra/c/engine.py": "cfepy's own sources",
    "cfepy/extra/c/toolchain/headers.py": "cfepy's own headers",
    "cfepy/extra/convert/project.py": "cfepy's own sources, and headers that it has made",
    "cfepy/extra/convert/message_headers.py": "headers that it has made",
    "cfepy/extra/convert/build.py": "what the compiler wrote, and headers that it has made",
    "cfepy/extra/convert/node_check/compiler.py": "what the compiler wrote",
    "cfepy/mission/mission.py": "tables of shipped applications",
    "cfepy/pilot/mission_check/cfe_names.py": "cfepy's own sources",
    "cfepy/extra/reports/page.py": "cfepy's own page",
    "cfepy/extra/convert/cmake_answers.py": "what CMake wrote",
    "cfepy/extra/c/trees/mission_folder.py": "cfepy's own applications",
    "cfepy/extra/convert/configurations.py": "in the text of a program that is started",
}
"""Modules of cfepy that open files by themselves, and which those are."""
WORDS = (b"open(", b"read_bytes", b"read_text")
"""One of these stands in the source of each module that opens a file."""
NODES = "cfepy/nodes"  # stands in for `open` in runs


def test_a_regular_file_is_read(tmp_path: Path) -> None:
    file = tmp_path / "x"
    file.write_bytes(b"a" * 200_000)
    assert read_limited(file, 200_000) == b"a" * 200_000
    with pytest.raises(UsageError, match="more than the limit of 199,999 bytes"):
        read_limited(file, 199_999)
    (tmp_path / "empty").touch()
    assert read_limited(tmp_path / "empty", 0) == b""
    assert read_limited("/proc/self/status", 1 << 20).startswith(b"Name:"), "its size is told as 0"


def test_sparse_file_is_refused_before_it_is_read(tmp_path: Path) -> None:
    with (tmp_path / "x").open("wb") as file:
        file.truncate(1 << 40)
    with pytest.raises(UsageError, match="more than the limit of 10 bytes"):
        read_limited(tmp_path / "x", 10)
    assert beginning_of(tmp_path / "x", 4) == bytes(4)


def test_devices_and_pipes_are_refused(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "link").symlink_to("/dev/zero")
    for path in (tmp_path / "pipe", tmp_path / "link", Path("/dev/zero"), Path("/dev/null")):
        with pytest.raises(UsageError, match="a device or a pipe"):
            open_input(path)
        with pytest.raises(UsageError, match="a device or a pipe"):
            open_input(path, handed=True)
        assert beginning_of(path, 10) == b""
        with pytest.raises(UsageError, match="a device or a pipe"):
            load(path)


def test_missing_file_and_folder_are_errors_of_the_system(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        open_input(tmp_path / "none")
    with pytest.raises(IsADirectoryError):
        read_limited(tmp_path, 10)
    assert beginning_of(tmp_path / "none", 10) == b""


@pytest.mark.parametrize("path", ["a\0b", "\0", "/tmp/\0"])
def test_name_with_a_nul_is_not_a_path(path: str) -> None:
    with pytest.raises(UsageError, match="invalid path"):
        read_limited(path, 10)


def test_descriptors_are_accepted_only_from_the_command_line() -> None:
    reader, writer = os.pipe()
    try:
        os.write(writer, b"text\r\n")
        os.close(writer)
        with pytest.raises(UsageError, match="a device or a pipe"):
            text_limited(f"/dev/fd/{reader}", 100)
        assert text_limited(f"/dev/fd/{reader}", 100, handed=True) == "text\n"
    finally:
        os.close(reader)


def test_file_that_is_not_ready_is_not_waited_for(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    reader, writer = os.pipe()
    os.set_blocking(reader, False)
    monkeypatch.setattr("cfepy.reading.input_files.open_input", lambda path, handed: os.fdopen(reader, "rb"))
    with pytest.raises(UsageError, match="not ready for reading"):
        read_limited(tmp_path, 10)
    os.close(writer)


def test_a_missing_file_gets_the_name_of_a_similar_one(tmp_path: Path) -> None:
    (tmp_path / "board.yaml").write_text("name: x", encoding="utf-8")
    with pytest.raises(UsageError) as caught:
        load(tmp_path / "borad.yaml")
    assert caught.value.text == f"cannot be read: No such file or directory; did you mean {tmp_path / 'board.yaml'}?"
    with pytest.raises(UsageError) as caught:
        load(tmp_path / "none" / "board.yaml")
    assert caught.value.text == "cannot be read: No such file or directory; check the path"


def test_input_files_are_opened_only_by_the_helper() -> None:
    found = set()
    for file in sorted((ROOT / "cfepy").rglob("*.py")):
        name, source = file.relative_to(ROOT).as_posix(), file.read_bytes()
        may_open = not name.startswith(NODES) and any(word in source for word in WORDS)
        if may_open and any(map(_opens, ast.walk(ast.parse(source)))):
            found.add(name)
    assert found <= set(OPENERS), "read inputs with cfepy.reading.input_files, or say here what is opened"


def _opens(node: ast.AST) -> bool:
    """Return whether code opens a file: `open(...)`, `path.open("...")`, `path.read_bytes()`, `path.read_text(...)`."""
    if not isinstance(node, ast.Call):
        return False
    if isinstance(node.func, ast.Name):
        return node.func.id == "open"
    if not isinstance(node.func, ast.Attribute):
        return False
    of_path = node.func.attr == "open" and bool(node.args) and isinstance(node.args[0], ast.Constant)
    return of_path or node.func.attr in ("read_bytes", "read_text")


def test_read_error_is_reported(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(path: object, flags: int) -> int:
        raise OSError(errno.EIO, "Input/output error")

    (tmp_path / "x").touch()
    monkeypatch.setattr(os, "open", fail)
    with pytest.raises(OSError, match="Input/output error"):
        open_input(tmp_path / "x")
