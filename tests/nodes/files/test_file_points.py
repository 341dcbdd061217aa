"""Scheduling points before calls of `os`: the paths that they report, read or written."""

from __future__ import annotations

import errno
from typing import Any, cast

import pytest

from cfepy.nodes import FilePoints
from cfepy.nodes.files import READS_FILE, WRITES_FILE


class Kernel:
    """Keeps the points and the reports."""

    def __init__(self) -> None:
        self.points = 0
        self.reports: list[tuple[str, str]] = []

    def point(self) -> None:
        self.points += 1

    def tell(self, subject: object, call: str, args: tuple[str, ...]) -> None:
        self.reports.append((call, args[0]))


def where(path: Any, dir_fd: int | None = None) -> str:
    if path == "/dev/tty":
        raise OSError(errno.ENXIO, "no terminal")
    return f"/home/{path}"


@pytest.mark.parametrize(
    ("name", "args", "options", "reports"),
    [
        ("stat", ("a",), {}, [(READS_FILE, "/home/a")]),
        ("stat", (3,), {}, []),
        ("open", ("a", 0), {}, [(READS_FILE, "/home/a")]),
        ("open", ("a",), {"flags": 1}, [(WRITES_FILE, "/home/a")]),
        ("remove", (), {"path": "a"}, [(WRITES_FILE, "/home/a")]),
        ("replace", ("a", "b"), {}, [(WRITES_FILE, "/home/a"), (WRITES_FILE, "/home/b")]),
        ("replace", ("a",), {"dst": "b"}, [(WRITES_FILE, "/home/a"), (WRITES_FILE, "/home/b")]),
        ("symlink", ("a", "b"), {}, [(WRITES_FILE, "/home/b")]),
        ("symlink", (), {"src": "a", "dst": "b"}, [(WRITES_FILE, "/home/b")]),
        ("setxattr", ("a", "user.x", b"v"), {}, [(WRITES_FILE, "/home/a")]),
        ("pwrite", (3, b"bytes", 0), {}, []),
        ("access", ("/dev/tty", 4), {}, []),
    ],
)
def test_a_call_reports_its_paths(
    name: str, args: tuple[Any, ...], options: dict[str, Any], reports: list[tuple[str, str]]
) -> None:
    kernel = Kernel()
    call = FilePoints(cast(Any, kernel)).around(name, lambda *given, **more: (given, more), where)
    assert call(*args, **options) == (args, options)
    assert kernel.reports == reports
    assert kernel.points == 1


def test_closing_a_descriptor_has_no_point() -> None:
    assert FilePoints(cast(Any, Kernel())).around("close", min, where) is min
