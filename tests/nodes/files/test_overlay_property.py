"""Random sequences of file operations give the same results as on a real folder, and leave the host's folder unchanged.

The real folder belongs to an ordinary user with limited permissions, even if root runs the tests.
"""

from __future__ import annotations

import io
import os
import stat
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from cfepy.nodes import Universe
from cfepy.nodes.files import Overlay
from cfepy.rtos import Kernel

NAMES = ("a", "b", "d", "d/a", "d/e", "d/e/a", "l", "l/a", "m", "nothing/a")
paths = st.sampled_from(NAMES)
contents = st.binary(max_size=6)
modes = st.sampled_from(("rb", "wb", "ab", "xb", "r+b", "w+b", "a+b"))
operations = st.lists(
    st.one_of(
        st.tuples(st.just("open"), paths, modes, contents),
        st.tuples(st.sampled_from(("mkdir", "rmdir", "remove", "listdir", "stat", "lstat", "readlink", "walk")), paths),
        st.tuples(st.sampled_from(("rename", "replace", "link", "symlink")), paths, paths),
        st.tuples(st.just("truncate"), paths, st.integers(0, 5)),
        st.tuples(st.just("chmod"), paths, st.sampled_from((0o644, 0o600, 0o755, 0o500, 0o300, 0o000))),
        st.tuples(st.just("access"), paths, st.sampled_from((os.F_OK, os.R_OK, os.W_OK, os.X_OK, os.R_OK | os.W_OK))),
        st.tuples(st.just("chown"), paths, st.sampled_from((-1, 0))),
    ),
    max_size=14,
)


NOBODY = 65534


@contextmanager
def ordinary_user() -> Iterator[None]:
    """Perform operations on a real folder as an ordinary user instead of root, and create files with the usual mode."""
    is_root, mask = hasattr(os, "geteuid") and os.geteuid() == 0, os.umask(0o022)
    if is_root:
        os.seteuid(NOBODY)
    try:
        yield
    finally:
        if is_root:
            os.seteuid(0)
        os.umask(mask)


def fill(folder: Path) -> None:
    """Create the host's files."""
    (folder / "d" / "e").mkdir(parents=True)
    (folder / "a").write_bytes(b"host a")
    (folder / "d" / "a").write_bytes(b"host d/a")
    (folder / "l").symlink_to("d")
    (folder / "m").symlink_to("a")


def tree(system: Any, folder: str) -> dict[str, Any]:
    """Return all that is below a folder: names, kinds, permissions, sizes, targets of links."""
    found: dict[str, Any] = {}
    try:
        names = sorted(system.listdir(folder))
    except OSError as error:
        return {"error": error.errno}
    for name in names:
        path = os.path.join(folder, name)
        try:
            facts = system.lstat(path)
        except OSError as error:
            found[name] = error.errno
            continue
        if stat.S_ISDIR(facts.st_mode):
            found[name] = (facts.st_mode, tree(system, path))
        elif stat.S_ISLNK(facts.st_mode):
            found[name] = system.readlink(path)
        else:
            found[name] = (facts.st_mode, facts.st_size, facts.st_nlink)
    return found


def act(system: Any, opening: Callable[..., Any], folder: str, operation: tuple[Any, ...]) -> Any:
    """Return the result of an operation, or the kind and the text of its error."""
    what, first, *rest = operation
    path = os.path.join(folder, first)
    try:
        if what == "open":
            mode, content = rest
            with opening(path, mode) as file:
                read = file.read() if mode != "wb" and (mode[0] == "r" or "+" in mode) else None
                return read, file.write(content) if mode != "rb" else None, file.name.removeprefix(folder)
        if what == "access":
            return system.access(path, *rest, effective_ids=os.access in os.supports_effective_ids)
        if what == "chown":
            return system.chown(path, *rest, -1)
        if what == "symlink":
            return system.symlink(first, os.path.join(folder, rest[0]))
        if what in ("rename", "replace", "link"):
            return getattr(system, what)(path, os.path.join(folder, rest[0]))
        if what == "walk":
            return [
                (place.removeprefix(folder), sorted(inner), sorted(names)) for place, inner, names in system.walk(path)
            ]
        value = getattr(system, what)(path, *rest)
        return (
            (stat.S_IFMT(value.st_mode), value.st_size * stat.S_ISREG(value.st_mode))
            if "stat" in what
            else (sorted(value) if what == "listdir" else value)
        )
    except OSError as error:
        return type(error), error.errno, str(error).replace(folder, "")
    except io.UnsupportedOperation as error:
        return str(error)


@settings(max_examples=15, deadline=None)
@given(operations)
@example([("chmod", "d", 0o644), ("rename", "d", "b")])
@example([("chmod", "d", 0o644), ("walk", "d")])
@example([("chmod", "d", 0o555), ("rename", "d", "b")])
def test_operations_act_as_on_a_real_folder(script: list[tuple[Any, ...]]) -> None:
    with TemporaryDirectory() as host, TemporaryDirectory() as other, Kernel() as kernel:
        if hasattr(os, "geteuid") and os.geteuid() == 0:
            os.chown(other, NOBODY, -1)
        fill(Path(host))
        with ordinary_user():
            fill(Path(other))
        before = tree(os, host)
        overlay = Overlay()
        universe = Universe(kernel, name="node", overlay=overlay)
        system, opening = universe.importer.load("os"), universe.builtins.open
        for operation in script:
            with ordinary_user():
                theirs, their_tree = act(os, open, other, operation), tree(os, other)
            assert act(system, opening, host, operation) == theirs, operation
            assert tree(system, host) == their_tree, operation
        assert tree(os, host) == before
        overlay.close()
        for folder, folders, _ in os.walk(other):
            for name in folders:
                os.chmod(os.path.join(folder, name), 0o700)  # so that it can be removed


@pytest.mark.skipif(not os.path.isdir("/proc/self/fd"), reason="needs a system that shows open files as a folder")
def test_folder_may_change_while_it_is_read() -> None:
    with Kernel() as kernel:
        system = Universe(kernel, name="node", overlay=Overlay()).importer.load("os")
        assert "1" in {entry.name for entry in system.scandir("/proc/self/fd")}
