"""Files of a replayed mission, and their changes since the run was recorded.

Files in the journal are unpacked into a folder that replaces the root of the computer: the mission sees them at their
old paths, and can write there without harm. The mission must not see that folder, so its parameters, arguments and
environment contain the paths of the recorded computer.
"""

from __future__ import annotations

import contextlib
import linecache
import os
import stat
import tempfile
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from cfepy.attachment import Attachment
from cfepy.journal.computer_facts import host_facts, versions
from cfepy.journal.journal import Header, Journal, JournalError
from cfepy.journal.mission_files import MissionFile
from cfepy.journal.snapshots import put_in_place
from cfepy.mission import LAUNCH_FILES, Mission, MissionSpec
from cfepy.nodes import NodeConfig
from cfepy.pilot import LAUNCH, NODE, RUN, RunPlan, boot_of
from cfepy.reading.contained_files import link_contained, make_folder, write_contained
from cfepy.reading.input_limits import JOURNAL_FILES_BYTES
from cfepy.rtos import GREENLET, THREAD, has_greenlets
from cfepy.status import UsageError

MOST_NAMED = 8


@dataclass(frozen=True, slots=True)
class Stage:
    """Files and plan of a replay.

    Attributes:
        plan: plan of the run, with paths of this computer.
        root: folder that stands for the root of the recorded computer; empty for this computer's own.
        absent: paths that did not exist.
        notes: hints for the user, before the run.
        reasons: why the run may differ.
    """

    plan: RunPlan
    root: str
    notes: tuple[str, ...]
    reasons: tuple[str, ...]
    absent: Collection[str] = frozenset()

    def spec(self) -> MissionSpec:
        """Return the mission.

        Raises:
            UsageError: if it does not exist, or has a mistake.
        """
        return settled(self.plan.spec(), self.root, self.absent)


@contextlib.contextmanager
def staged(journal: Journal, from_disk: bool = False) -> Iterator[Stage]:
    """Context of a replay: working directory and environment of the recorded run.

    Args:
        journal: the run.
        from_disk: use the mission's files on this computer instead of those in the journal.
    """
    changed = [each for each in journal.files.values() if not each.same_on_disk()]
    left_out = [each for each in changed if each.packed is None and each.sha256]
    plan, on_threads = _on_tasks_here(journal.plan)
    changes = tuple(_warnings(journal))
    warnings = (*changes, *on_threads)
    reasons = (*changes, *_host_changes(journal))
    with contextlib.ExitStack() as stack:
        if from_disk or left_out or not any(each.packed for each in journal.files.values()):
            other = f"other files than then: {_named(changed)}"
            stage = Stage(plan, "", (_note(changed, from_disk, left_out), *warnings), (other, *reasons))
        else:
            root, absent = stack.enter_context(_unpacked(journal))
            notes = (f"with the recorded files; on this computer others are now: {_named(changed)}",) if changed else ()
            moved = replace(moved_plan(journal.header, root), tasks=plan.tasks)
            stage = Stage(moved, root, (*notes, *warnings), reasons, absent)
        stack.enter_context(_in_place_of(journal.header, stage.root))
        yield stage


def _on_tasks_here(plan: RunPlan) -> tuple[RunPlan, tuple[str, ...]]:
    """Return the plan with an implementation of tasks that this Python has, since all give the same run, and a note on
    it.
    """
    if plan.tasks != GREENLET or has_greenlets():
        return plan, ()
    note = "recorded on greenlets, but greenlet is not installed: replayed on threads, which give the same run"
    return replace(plan, tasks=THREAD), (note,)


def _note(changed: Sequence[MissionFile], from_disk: bool, left_out: Sequence[MissionFile]) -> str:
    """Return notes on a replay with the files of this computer."""
    if not changed:
        return "with the files on this computer, which equal the files of the run"
    if from_disk:
        return f"with the files on this computer; these differ from the run: {_named(changed)}"
    text = f"the journal does not carry {_named(left_out)}"
    return f"with the files on this computer, since {text}; these differ from the run: {_named(changed)}"


@contextlib.contextmanager
def _unpacked(journal: Journal) -> Iterator[tuple[str, Collection[str]]]:
    """Provide a folder with files at their old paths, and the paths that did not exist.

    Meanwhile, tracebacks show the lines of these files, not of the computer's files at the same paths.
    """
    with tempfile.TemporaryDirectory(prefix="cfepy-replay-") as folder:
        root = os.path.realpath(folder)
        try:
            carried = sum(each.size for each in journal.files.values() if each.packed is not None)
            if carried > JOURNAL_FILES_BYTES:
                raise UsageError(
                    f"they have {carried:,} bytes, more than the limit of {JOURNAL_FILES_BYTES:,}; use --from-disk"
                )
            for each in journal.files.values():
                _unpack(each, Path(root))
            for path, names in journal.folders.items():
                _fill(Path(root), path, names)
            make_folder(Path(root), journal.header.cwd)  # before a folder is made read-only
            absent = put_in_place(Path(root), journal.looks.values())
        except (OSError, UsageError) as error:
            why = error.strerror if isinstance(error, OSError) else error
            raise JournalError(f"its files cannot be unpacked: {why}", file=journal.path) from None
        lines = _show_lines(journal.files.values())
        try:
            yield root, absent
        finally:
            for name in lines:
                linecache.cache.pop(name, None)


def _unpack(file: MissionFile, root: Path) -> None:
    """Put a file at its path; if the journal does not contain it, it comes from this computer if unchanged."""
    data = file.data
    if data is None:
        link_contained(root, file.path)
    else:
        write_contained(root, file.path, data)
        os.chmod(f"{root}{file.path}", stat.S_IMODE(file.mode) | stat.S_IRUSR)


def _fill(root: Path, path: str, names: Mapping[str, bool]) -> None:
    """Create the names of a folder; a file that is not in the journal was never opened, so it may be empty."""
    folder = make_folder(root, path)
    for name, is_folder in names.items():
        if is_folder:
            make_folder(root, os.path.join(path, name))
        elif not os.path.lexists(folder / name):
            write_contained(root, os.path.join(path, name), b"")


def _show_lines(files: Iterable[MissionFile]) -> list[str]:
    """Make tracebacks show the lines of these files; returns their paths."""
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
    cwd = str(make_folder(Path(root), header.cwd)) if root else header.cwd
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
    """Yield the differences between cfepy and Python now and in the run."""
    then, now = journal.header.versions, versions()
    for name in ("cfepy", "cfe"):
        if then.get(name) != now[name]:
            yield f"recorded with {name} {then.get(name)}, this is {now[name]}: the run may differ"
    if then.get("cfepy") == now["cfepy"] and then.get("source") != now["source"]:
        yield "recorded with another state of cfepy's own source: the run may differ"
    if _minor(then.get("python", "")) != _minor(now["python"]):
        yield f"recorded with Python {then.get('python')}, this is {now['python']}: the run may differ"


def _minor(version: str) -> str:
    return ".".join(version.split(".")[:2])


def _named(files: Sequence[MissionFile]) -> str:
    names = ", ".join(each.path for each in files[:MOST_NAMED])
    return f"{names} and {len(files) - MOST_NAMED} more" if len(files) > MOST_NAMED else names


def _host_changes(journal: Journal) -> Iterator[str]:
    now = host_facts()
    for name, value in journal.header.host.items():
        if now.get(name, value) != value:
            yield f"recorded on another computer: {name} was {value}, is {now[name]}"


def moved_plan(header: Header, root: str) -> RunPlan:
    """Return the plan of a run, with the paths of its files below a root."""
    plan = header.plan
    files: dict[str, Any] = {
        name: _moved(getattr(plan, name), header.cwd, root)
        for name in ("script", "faults", "play", "board", "cpp_nodes")
    }
    beside = tuple(_moved_mission(text, header.cwd, root) for text in plan.beside)
    return replace(plan, words=(root + header.startup, *_arguments(header)), beside=beside, **files)


def _moved_mission(text: str, cwd: str, root: str) -> str:
    """Return the current place of a mission that flew together with the journal's mission.

    A mission that is included in cfepy keeps its place.
    """
    mission, _ = boot_of(text)
    place = root + os.path.normpath(os.path.join(cwd, mission))
    return place + text[len(mission) :] if os.path.exists(place) else text


def _arguments(header: Header) -> tuple[str, ...]:
    """Return the arguments that follow the mission, launch file or script on the command line."""
    words = header.plan.words
    if header.plan.command == LAUNCH:
        return tuple(word for word in words if ":=" in word)
    if header.plan.command == NODE:
        is_file = Path(words[0]).name == Path(header.startup).name
        return words[1:] if is_file else words[2:]
    return ()


def _moved(path: str | None, cwd: str, root: str) -> str | None:
    """Return the current path of a file on a command line; other arguments stay."""
    if path is None:
        return None
    whole = os.path.normpath(os.path.join(cwd, path))
    return next((place for place in (root + whole, whole) if os.path.isfile(place)), path)


def moved_environ(environ: Mapping[str, str], root: str) -> dict[str, str]:
    """Return environment variables with folders replaced by those below the root."""
    return {name: os.pathsep.join(map(_folder_in(root), value.split(os.pathsep))) for name, value in environ.items()}


def _folder_in(root: str) -> Any:
    return lambda word: root + word if root and word.startswith(os.sep) and os.path.isdir(root + word) else word


def settled(spec: MissionSpec, root: str, absent: Collection[str] = frozenset()) -> MissionSpec:
    """Return a mission that was read below a root, without that root.

    Args:
        spec: the mission.
        root: the folder; empty for none.
        absent: paths that do not exist.
    """
    if not root:
        return spec
    nodes = {app: _settled_node(node, root) for app, node in spec.ros.nodes.items()}
    params = _without(spec.ros.params, root)
    return replace(spec, ros=replace(spec.ros, nodes=nodes, params=params, root=root, absent=absent))


def _settled_node(node: NodeConfig, root: str) -> NodeConfig:
    return replace(
        node, args=_without(node.args, root), env=_without(node.env, root), params=_without(node.params, root)
    )


def _without(value: Any, root: str) -> Any:
    """Return a value with the root removed from all texts."""
    if isinstance(value, str):
        return value.replace(root, "")
    if isinstance(value, Mapping):
        return {name: _without(each, root) for name, each in value.items()}
    if isinstance(value, (list, tuple)):
        return type(value)(_without(each, root) for each in value)
    return value


class HiddenRoot(Attachment):
    """Removes the root from console output, such as tracebacks.

    Args:
        root: the folder.
    """

    def __init__(self, root: str) -> None:
        self._root = root

    def begin(self, mission: Mission) -> None:
        console, root = mission.console, self._root
        for name in ("record", "sink"):
            show = getattr(console, name)
            if show is not None:
                setattr(console, name, lambda line, show=show: show(line.replace(root, "")))
