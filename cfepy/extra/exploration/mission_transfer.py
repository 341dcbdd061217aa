"""The inputs of a campaign on this computer: find the files that its mission reads, compare them, and ship them.

The mission is flown once to see which files it opens. Their digests and the versions show whether two campaigns are the
same. On another computer the files lie in a folder as they lie here in the root: /home/me/arm/startup.scr in
FOLDER/home/me/arm/startup.scr. So relative names of files still work, and the mission does not see the folder.
"""

from __future__ import annotations

import os
import stat
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from hashlib import file_digest
from pathlib import Path
from typing import Any

from cfepy.attachment import Attachment
from cfepy.extra.exploration.verdict import Failure, Verdict
from cfepy.journal import (
    Carrier,
    HiddenRoot,
    MissionFile,
    ReadFiles,
    environ_of,
    files_of,
    moved_environ,
    settled,
    versions,
)
from cfepy.mission import MissionSpec, find_script, launch_file, node_script
from cfepy.pilot import LAUNCH, NODE, BootError, RunPlan, fly
from cfepy.reading.contained_files import make_folder, write_contained
from cfepy.reading.input_files import open_input
from cfepy.status import UsageError

_DIGITS = 16  # of a hash that is shown to a person
LIMIT = 256 << 20  # bytes
_FILES = ("board", "script", "faults", "play")
"""Attributes of a plan that may be paths."""


def files_read(plan: RunPlan) -> list[str]:
    """Fly a run once. Returns the absolute paths of the files that it depends on, sorted.

    All files of a folder that it lists are among them.

    Args:
        plan: the run.

    Raises:
        UsageError: it cannot be flown.
    """
    seen: list[str] = []

    def listed(folder: str, names: list[str]) -> None:
        seen.extend(filter(os.path.isfile, (os.path.join(folder, name) for name in names)))

    with ReadFiles(seen.append, listed):
        spec = plan.spec()
        try:
            fly(plan, spec=spec)
        except BootError:
            pass  # it cannot boot, which is a result too
    return sorted({*seen, *files_of(spec)})


def identity_of(plan: RunPlan, files: Sequence[str], search: Mapping[str, Any]) -> dict[str, Any]:
    """Return the identity of a campaign. Results of two campaigns can be combined when it is the same.

    Args:
        plan: the run.
        files: the files that it reads; see `files_read`.
        search: other settings that decide the schedules and the failures, by option.

    Returns:
        Plain data, so that an error message can name a changed value.
    """
    contents = {path: _hash_of(path) for path in files}
    return {"plan": plan.to_dict(), "search": dict(search), "files": contents, "versions": comparable_versions()}


def _hash_of(path: str) -> str:
    with open_input(path) as file:
        return file_digest(file, "sha256").hexdigest()[:_DIGITS]


def comparable_versions() -> dict[str, str]:
    """Return the versions of cfepy, cFE and Python; only the minor version of Python counts."""
    found = versions()
    return {**found, "python": ".".join(found["python"].split(".")[:2])}


@dataclass(frozen=True, slots=True)
class PlanElsewhere(RunPlan):
    """A run whose mission lies below a folder that stands for the root of another computer.

    Attributes:
        root: the folder.
    """

    root: str = ""

    @classmethod
    def of(cls, plan: RunPlan, root: str) -> PlanElsewhere:
        """Return a plan whose paths already lie below the root."""
        return cls(**{each.name: getattr(plan, each.name) for each in fields(plan)}, root=root)

    def spec(self) -> MissionSpec:
        return settled(RunPlan.spec(self), self.root)

    def attachments(self) -> list[Attachment]:
        return [HiddenRoot(self.root)]


@dataclass(frozen=True, slots=True)
class Shipment:
    """The inputs of a run from this computer.

    Attributes:
        plan: the run; its words begin with an absolute path.
        files: all files that it reads.
        folder: working directory, absolute.
        environ: variables that the mission can see.
    """

    plan: RunPlan
    files: tuple[MissionFile, ...] = field(repr=False)
    folder: str
    environ: Mapping[str, str]

    def unpack(self, root: Path) -> Unpacked:
        """Write the files into a folder.

        Args:
            root: the folder; it is made.
        """
        root.mkdir(parents=True, exist_ok=True)
        for file in self.files:
            write_contained(root, file.path, file.data or b"")
            os.chmod(f"{root}{file.path}", stat.S_IMODE(file.mode) | stat.S_IRUSR)
        return Unpacked(root, make_folder(root, self.folder))

    def plan_in(self, inside: Unpacked) -> PlanElsewhere:
        """Return the run with the paths of the unpacked files."""
        plan = self.plan
        same = {each.name: getattr(plan, each.name) for each in fields(plan)}
        places = {name: value and inside.moved(value) for name, value in same.items() if name in _FILES}
        words = tuple(map(inside.moved, plan.words))
        return PlanElsewhere(**{**same, **places, "words": words}, root=str(inside.root))

    def environ_in(self, inside: Unpacked) -> dict[str, str]:
        """Return the variables with the paths of the unpacked files."""
        return moved_environ(self.environ, str(inside.root))


@dataclass(frozen=True, slots=True)
class Unpacked:
    """Files of another computer.

    Attributes:
        root: folder that stands for its root.
        folder: the working directory in it.
    """

    root: Path
    folder: Path

    def moved(self, text: str) -> str:
        """Return the new path of a file if a text is the absolute path of one; otherwise return the text."""
        here = f"{self.root}{text}"
        return here if text.startswith("/") and os.path.exists(here) else text

    def told(self, verdict: Verdict) -> Verdict:
        """Return a verdict in which files have the names of their original computer."""
        root = str(self.root)

        def told(failure: Failure) -> Failure:
            detail = failure.detail.replace(root, "")
            return replace(failure, text=failure.text.replace(root, ""), detail=detail)

        return replace(verdict, failures=tuple(map(told, verdict.failures)), trouble=verdict.trouble.replace(root, ""))


def ship(plan: RunPlan, files: Sequence[str]) -> Shipment:
    """Pack the inputs of a run.

    Args:
        plan: the run.
        files: the files that it reads; see `cfepy.extra.exploration.mission_transfer`.

    Raises:
        UsageError: the files are too large.
    """
    size = sum(os.path.getsize(path) for path in files)
    if size > LIMIT:
        text = (
            f"must have at most {LIMIT >> 20} MiB of files, not {size >> 20} MiB; remove unneeded files from its folder"
        )
        raise UsageError(text, file=plan.words[0], field="--cluster")
    plan = replace(plan, words=_absolute(plan))
    return Shipment(plan, tuple(map(Carrier(LIMIT).take, files)), os.getcwd(), environ_of(plan.spec()))


def _absolute(plan: RunPlan) -> tuple[str, ...]:
    """Return the words of a plan, with the absolute path of its file first."""
    if plan.command == LAUNCH:
        file, args = launch_file(plan.words)
        return (str(file), *(f"{name}:={value}" for name, value in args.items()))
    if plan.command == NODE:
        if len(plan.words) > 1 and not os.path.isfile(plan.words[0]):
            return plan.words  # a package, which each computer finds in the same folder
        script, words = node_script(plan.words)
        return (str(script), *words)
    return (str(find_script(plan.words[0])), *plan.words[1:])
