"""The files of a mission on their way to another computer.

There they lie in a folder as they lie here in the root: /home/me/arm/startup.scr in FOLDER/home/me/arm/startup.scr. So
whatever names another file in a relative way finds it, and the mission does not see the folder. May import
cfepy.mission and cfepy.journal.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from pathlib import Path
from typing import Any

from cfepy.attachment import Attachment
from cfepy.explore.verdict import Failure, Verdict
from cfepy.journal.facts import environ_of
from cfepy.journal.mission_files import Carrier, FileRecord
from cfepy.journal.moved import HiddenRoot, moved_environ, settled
from cfepy.mission.launch import launch_file
from cfepy.mission.run_plan import LAUNCH, NODE, Flown, RunPlan
from cfepy.mission.single_node import node_script
from cfepy.mission.spec import MissionSpec, find_script
from cfepy.status import UsageError

LIMIT = 256 << 20  # bytes


@dataclass(frozen=True, slots=True)
class PlanElsewhere(RunPlan):
    """A run whose mission lies below a folder that stands for the root of another computer.

    Attributes:
        root: the folder.
    """

    root: str = ""

    def spec(self) -> MissionSpec:
        """See `RunPlan.spec`."""
        return settled(RunPlan.spec(self), self.root)

    def fly(self, attachments: Sequence[Attachment] = (), **options: Any) -> Flown:
        """See `RunPlan.fly`."""
        return RunPlan.fly(self, [HiddenRoot(self.root), *attachments], **options)


@dataclass(frozen=True, slots=True)
class Shipment:
    """What a run needs of this computer.

    Attributes:
        plan: the run; its words begin with an absolute path.
        files: all that it reads.
        folder: working directory, absolute.
        environ: variables that the mission can see.
    """

    plan: RunPlan
    files: tuple[FileRecord, ...] = field(repr=False)
    folder: str
    environ: Mapping[str, str]

    def unpack(self, root: Path) -> Unpacked:
        """Put the files into a folder.

        Args:
            root: the folder.
        """
        for file in self.files:
            target = Path(f"{root}{file.path}")
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(file.data or b"")
            target.chmod(0o755)  # roslaunch starts executable files only
        inside = Unpacked(root, Path(f"{root}{self.folder}"))
        inside.folder.mkdir(parents=True, exist_ok=True)
        return inside

    def plan_in(self, inside: Unpacked) -> PlanElsewhere:
        """The run, with the files where they were unpacked."""
        plan = self.plan
        same = {each.name: getattr(plan, each.name) for each in fields(plan)}
        places = {name: value and inside.moved(value) for name, value in same.items() if name in _FILES}
        words = tuple(map(inside.moved, plan.words))
        return PlanElsewhere(**{**same, **places, "words": words}, root=str(inside.root))

    def environ_in(self, inside: Unpacked) -> dict[str, str]:
        """The variables, with the files where they were unpacked."""
        return moved_environ(self.environ, str(inside.root))


_FILES = ("board", "script", "faults", "play")
"""Attributes of a plan that may be paths."""


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
        """Where a file is now, if a text is the absolute path of one; otherwise the text."""
        here = f"{self.root}{text}"
        return here if text.startswith("/") and os.path.exists(here) else text

    def told(self, verdict: Verdict) -> Verdict:
        """A verdict in which files have the names of the computer that they come from."""
        root = str(self.root)

        def told(failure: Failure) -> Failure:
            detail = failure.detail.replace(root, "")
            return replace(failure, text=failure.text.replace(root, ""), detail=detail)

        return replace(verdict, failures=tuple(map(told, verdict.failures)), trouble=verdict.trouble.replace(root, ""))


def ship(plan: RunPlan, files: Sequence[str]) -> Shipment:
    """Pack what a run needs.

    Args:
        plan: the run.
        files: that it reads; see `cfepy.explore.inventory`.

    Raises:
        UsageError: these are too many.
    """
    size = sum(os.path.getsize(path) for path in files)
    if size > LIMIT:
        text = (
            f"has {size >> 20} MiB of files, more than {LIMIT >> 20} MiB; take out of its folder what it does not need"
        )
        raise UsageError(text, file=plan.words[0], field="--cluster")
    plan = replace(plan, words=_absolute(plan))
    return Shipment(plan, tuple(map(Carrier(LIMIT).record, files)), os.getcwd(), environ_of(plan.spec()))


def _absolute(plan: RunPlan) -> tuple[str, ...]:
    """The words of a plan, with the file that they mean in front."""
    if plan.command == LAUNCH:
        file, args = launch_file(plan.words)
        return (str(file), *(f"{name}:={value}" for name, value in args.items()))
    if plan.command == NODE:
        script, words = node_script(plan.words)
        return (str(script), *words)
    return (str(find_script(plan.words[0])), *plan.words[1:])
