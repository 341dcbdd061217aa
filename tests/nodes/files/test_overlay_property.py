"""Random sequences of file operations give what they give on a real folder, and leave the host's folder as it was."""

from __future__ import annotations

import io
import os
import stat
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from hypothesis import given, settings
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
        st.tuples(st.just("chmod"), paths, st.sampled_from((0o644, 0o600, 0o755))),
    ),
    max_size=14,
)


def fill(folder: Path) -> None:
    """What the host has."""
    (folder / "d" / "e").mkdir(parents=True)
    (folder / "a").write_bytes(b"host a")
    (folder / "d" / "a").write_bytes(b"host d/a")
    (folder / "l").symlink_to("d")
    (folder / "m").symlink_to("a")


def tree(system: Any, folder: str) -> dict[str, Any]:
    """All that is below a folder: names, kinds, permissions, sizes, targets of links."""
    found = {}
    for name in sorted(system.listdir(folder)):
        path = os.path.join(folder, name)
        facts = system.lstat(path)
        if stat.S_ISDIR(facts.st_mode):
            found[name] = tree(system, path)
        elif stat.S_ISLNK(facts.st_mode):
            found[name] = system.readlink(path)
        else:
            found[name] = (facts.st_mode, facts.st_size, facts.st_nlink)
    return found


def act(system: Any, opening: Callable[..., Any], folder: str, operation: tuple[Any, ...]) -> Any:
    """What an operation gives, or the kind and the text of its error."""
    what, first, *rest = operation
    path = os.path.join(folder, first)
    try:
        if what == "open":
            mode, content = rest
            with opening(path, mode) as file:
                read = file.read() if mode != "wb" and (mode[0] == "r" or "+" in mode) else None
                return read, file.write(content) if mode != "rb" else None, file.name.removeprefix(folder)
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
def test_as_on_a_real_folder(script: list[tuple[Any, ...]]) -> None:
    with TemporaryDirectory() as host, TemporaryDirectory() as other, Kernel() as kernel:
        fill(Path(host))
        fill(Path(other))
        before = tree(os, host)
        overlay = Overlay()
        universe = Universe(kernel, name="node", overlay=overlay)
        system, opening = universe.importer.load("os"), universe.builtins.open
        for operation in script:
            theirs = act(os, open, other, operation)
            assert act(system, opening, host, operation) == theirs, operation
            assert tree(system, host) == tree(os, other), operation
        assert tree(os, host) == before
        overlay.close()
