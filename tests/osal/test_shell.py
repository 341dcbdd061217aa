"""OS_ShellOutputToFile."""

from __future__ import annotations

import pytest

from cfepy.osal.limits import OS_FILE_FLAG_CREATE, OS_READ_ONLY, OS_READ_WRITE
from cfepy.status import OS_ERR_INVALID_ID, OS_ERROR
from tests.osal.helpers import Bench
from tests.osal.test_queues import status_of


def said(bench: Bench, command: str) -> bytes:
    """Return the output of a command."""
    filedes = bench.os.open_create("/ram/out", OS_FILE_FLAG_CREATE, OS_READ_WRITE)
    bench.os.shell_output_to_file(command, filedes)
    bench.os.close(filedes)
    data = bench.os.files.read_file("/ram/out")
    bench.os.remove("/ram/out")
    return data


def test_commands_on_the_virtual_file_system(bench: Bench) -> None:
    files = bench.os.files
    files.write_file("/ram/x", b"content\n")
    assert said(bench, 'echo "a  b" c') == b"a  b c\n"
    assert said(bench, "cat /ram/x /ram/x") == b"content\ncontent\n"
    for silent in ("cp /ram/x /ram/y", "mv /ram/y /ram/z", "mkdir /ram/d", "rm /ram/x", ""):
        assert said(bench, silent) == b""
    assert said(bench, "ls /ram") == b"d\nout\nz\n"
    assert said(bench, "rmdir /ram/d") == b""
    assert not files.exists("/ram/d")


@pytest.mark.parametrize(
    ("command", "complaint"),
    [
        ("format c:", b"sh: format: not found\n"),
        ("cat /ram/none", b"cat: OS_ERROR (-1): file /ram/none does not exist\n"),
        ("cp /ram/x", b"cp: OS_ERROR (-1): takes 2 paths\n"),
        ("echo 'open", b"sh: No closing quotation\n"),
    ],
)
def test_failed_command_writes_its_error_to_the_file(bench: Bench, command: str, complaint: bytes) -> None:
    filedes = bench.os.open_create("/ram/out", OS_FILE_FLAG_CREATE, OS_READ_WRITE)
    assert status_of(bench.os.shell_output_to_file, command, filedes) == OS_ERROR
    assert bench.os.files.read_file("/ram/out") == complaint


def test_invalid_descriptor_is_refused(bench: Bench) -> None:
    assert status_of(bench.os.shell_output_to_file, "ls /ram", 0) == OS_ERR_INVALID_ID
    filedes = bench.os.open_create("/ram/out", OS_FILE_FLAG_CREATE, OS_READ_ONLY)
    assert status_of(bench.os.shell_output_to_file, "echo x", filedes) == OS_ERROR
