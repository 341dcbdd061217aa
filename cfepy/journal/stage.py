"""Where a replay finds the files of its mission, and what is not as it was when the run was recorded.

Files come from the journal, if it carries them: they are unpacked into a folder that stands for the root of the
computer, so the mission sees them at the paths that they had, and what it writes there harms nobody. May import
cfepy.mission and its neighbours in cfepy.journal.
"""

from __future__ import annotations

import contextlib
import linecache
import os
import tempfile
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from cfepy.journal.facts import host_facts, versions
from cfepy.journal.journal import Header, Journal
from cfepy.journal.mission_files import FileRecord
from cfepy.journal.moved import moved_environ, moved_plan, settled
from cfepy.mission.launch import LAUNCH_FILES
from cfepy.mission.run_plan import RUN, RunPlan
from cfepy.mission.spec import MissionSpec

MOST_NAMED = 8


@dataclass(frozen=True, slots=True)
class Stage:
    """What a replay stands on.

    Attributes:
        plan: what to run, with paths of this computer.
        root: folder that stands for the root of the recorded computer; empty for this computer's own.
        notes: what the user should know before.
        reasons: why the run may be another one.
    """

    plan: RunPlan
    root: str
    notes: tuple[str, ...]
    reasons: tuple[str, ...]

    def spec(self) -> MissionSpec:
        """The mission.

        Raises:
            UsageError: it is not there, or something in it is wrong.
        """
        return settled(self.plan.spec(), self.root)


@contextlib.contextmanager
def staged(journal: Journal, from_disk: bool = False) -> Iterator[Stage]:
    """Around a replay: the working directory and the environment are those of the recorded run.

    Args:
        journal: the run.
        from_disk: take the mission's files as they are on this computer.
    """
    changed = [each for each in journal.files.values() if not each.same_on_disk()]
    left_out = [each for each in changed if each.packed is None and each.sha256]
    warnings = tuple(_warnings(journal))
    reasons = (*warnings, *_host_changes(journal))
    with contextlib.ExitStack() as stack:
        if from_disk or left_out or not any(each.packed for each in journal.files.values()):
            other = f"other files than then: {_named(changed)}"
            stage = Stage(journal.plan, "", (_note(changed, from_disk, left_out), *warnings), (other, *reasons))
        else:
            root = stack.enter_context(_unpacked(journal))
            notes = (f"with the recorded files; on this computer others are now: {_named(changed)}",) if changed else ()
            stage = Stage(moved_plan(journal.header, root), root, (*notes, *warnings), reasons)
        stack.enter_context(_in_place_of(journal.header, stage.root))
        yield stage


def _note(changed: Sequence[FileRecord], from_disk: bool, left_out: Sequence[FileRecord]) -> str:
    """What to know about a replay with the files on this computer."""
    if not changed:
        return "with the files on this computer, which are those of the run"
    if from_disk:
        return f"with the files on this computer; not those of the run are: {_named(changed)}"
    text = f"the journal does not carry {_named(left_out)}"
    return f"with the files on this computer, since {text}; not those of the run are: {_named(changed)}"


@contextlib.contextmanager
def _unpacked(journal: Journal) -> Iterator[str]:
    """A folder with files at the paths that they had; tracebacks show their lines, not those of other files there."""
    with tempfile.TemporaryDirectory(prefix="cfepy-replay-") as folder:
        root = os.path.realpath(folder)
        for each in journal.files.values():
            _unpack(each, Path(root + each.path))
        for path, names in journal.folders.items():
            _fill(Path(root + path), names)
        lines = _show_lines(journal.files.values())
        try:
            yield root
        finally:
            for name in lines:
                linecache.cache.pop(name, None)


def _unpack(file: FileRecord, path: Path) -> None:
    """Put a file where it is expected; what the journal does not carry is on this computer, as it was."""
    path.parent.mkdir(parents=True, exist_ok=True)
    data = file.data
    if data is None:
        path.symlink_to(file.path)
        return
    path.write_bytes(data)
    path.chmod(0o755)  # roslaunch starts executable files only


def _fill(folder: Path, names: Mapping[str, bool]) -> None:
    """Have a folder look as it did: nobody has opened what is missing, so it may be empty."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, is_folder in names.items():
        path = folder / name
        if is_folder:
            path.mkdir(exist_ok=True)
        elif not path.exists():
            path.touch()


def _show_lines(files: Iterable[FileRecord]) -> list[str]:
    """Have tracebacks show the lines of these files; their paths."""
    shown = []
    for each in files:
        data = each.data if each.path.endswith(".py") else None
        if data is not None:
            text = data.decode("utf-8", "replace")
            linecache.cache[each.path] = (len(data), None, text.splitlines(keepends=True), each.path)
            shown.append(each.path)
    return shown


@contextlib.contextmanager
def _in_place_of(header: Header, root: str) -> Iterator[None]:
    here, environ = os.getcwd(), dict(os.environ)
    cwd = root + header.cwd
    if root:
        os.makedirs(cwd, exist_ok=True)
    try:
        if os.path.isdir(cwd):
            os.chdir(cwd)
        if header.plan.command != RUN or header.startup.endswith(LAUNCH_FILES):
            os.environ.clear()  # its nodes saw all of it
        os.environ.update(moved_environ(header.environ, root))
        yield
    finally:
        os.chdir(here)
        os.environ.clear()
        os.environ.update(environ)


def _warnings(journal: Journal) -> Iterator[str]:
    """How this cfepy and this Python differ from those of the run."""
    then, now = journal.header.versions, versions()
    for name in ("cfepy", "cfe"):
        if then.get(name) != now[name]:
            yield f"recorded with {name} {then.get(name)}, this is {now[name]}: the run may be another one"
    if then.get("cfepy") == now["cfepy"] and then.get("source") != now["source"]:
        yield "recorded with another state of cfepy's own source: the run may be another one"
    if _minor(then.get("python", "")) != _minor(now["python"]):
        yield f"recorded with Python {then.get('python')}, this is {now['python']}: the run may be another one"


def _minor(version: str) -> str:
    return ".".join(version.split(".")[:2])


def _named(files: Sequence[FileRecord]) -> str:
    names = ", ".join(each.path for each in files[:MOST_NAMED])
    return f"{names} and {len(files) - MOST_NAMED} more" if len(files) > MOST_NAMED else names


def _host_changes(journal: Journal) -> Iterator[str]:
    now = host_facts()
    for name, value in journal.header.host.items():
        if now.get(name, value) != value:
            yield f"another computer: {name} was {value}, is {now[name]}"
