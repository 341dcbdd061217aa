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


@pytest.mark.parametrize(
    ("command", "complaint"),
    [
        ("cp /ram/x /ram/./x", b"cp: OS_ERROR (-1): /ram/x and /ram/./x are the same file\n"),
        ("mv /ram/x /ram", b"mv: OS_ERROR (-1): /ram/x and /ram/x are the same file\n"),
        ("cat /ram/x >> /ram/x", b"cat: OS_ERROR (-1): /ram/x: input file is output file\n"),
        ("rm /ram/d", b"rm: OS_ERROR (-1): /ram/d is a folder\n"),
        ("mkdir /ram/d", b"mkdir: OS_ERROR (-1): /ram/d already exists\n"),
        ("cat /ram/d", b"cat: OS_ERROR (-1): file /ram/d does not exist\n"),
        ("cat /ram/x | cat", b"sh: | is not supported here\n"),
        ("echo >", b"sh: > is not supported here\n"),
    ],
)
def test_command_on_the_wrong_file_fails_as_in_the_hosts_shell(bench: Bench, command: str, complaint: bytes) -> None:
    bench.os.files.write_file("/ram/x", b"content\n")
    bench.os.mkdir("/ram/d")
    filedes = bench.os.open_create("/ram/out", OS_FILE_FLAG_CREATE, OS_READ_WRITE)
    assert status_of(bench.os.shell_output_to_file, command, filedes) == OS_ERROR
    assert bench.os.files.read_file("/ram/out") == complaint
    assert bench.os.files.read_file("/ram/x") == b"content\n"


def test_output_goes_to_the_file_behind_the_sign(bench: Bench) -> None:
    files = bench.os.files
    for command in ('echo a ">" b > "/ram/x y"', "echo c >> '/ram/x y'", "cp '/ram/x y' /ram/z"):
        assert said(bench, command) == b""
    assert files.read_file("/ram/z") == b"a > b\nc\n"
    assert said(bench, "cat /ram/z > /ram/z") == b""  # the shell empties it before cat reads it
    assert files.read_file("/ram/z") == b""


def test_command_that_reads_its_own_output_fails(bench: Bench) -> None:
    filedes = bench.os.open_create("/ram/out", OS_FILE_FLAG_CREATE, OS_READ_WRITE)
    bench.os.write(filedes, b"content")
    assert status_of(bench.os.shell_output_to_file, "cat /ram/out", filedes) == OS_ERROR


def test_invalid_descriptor_is_refused(bench: Bench) -> None:
    assert status_of(bench.os.shell_output_to_file, "ls /ram", 0) == OS_ERR_INVALID_ID
    filedes = bench.os.open_create("/ram/out", OS_FILE_FLAG_CREATE, OS_READ_ONLY)
    assert status_of(bench.os.shell_output_to_file, "echo x", filedes) == OS_ERROR
