"""The files of a mission on their way to another computer.

There they lie in a folder as they lie here in the root: /home/me/arm/startup.scr in FOLDER/home/me/arm/startup.scr. So
whatever names another file in a relative way finds it. May import cfepy.mission and cfepy.journal.
"""

from __future__ import annotations

import os
import zlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from cfepy.explore.verdict import Failure, Verdict
from cfepy.journal.facts import environ_of
from cfepy.mission.launch import launch_file
from cfepy.mission.run_plan import LAUNCH, NODE, RunPlan
from cfepy.mission.single_node import node_script
from cfepy.mission.spec import find_script
from cfepy.status import UsageError

LIMIT = 256 << 20  # bytes
_PATHS = ("ROS_PACKAGE_PATH", "CMAKE_PREFIX_PATH")


@dataclass(frozen=True, slots=True)
class PackedFile:
    """A file.

    Attributes:
        path: absolute.
        mode: its permissions.
        packed: its content, compressed.
    """

    path: str
    mode: int
    packed: bytes

    @classmethod
    def of(cls, path: str) -> PackedFile:
        """The file as it is now."""
        return cls(path, os.stat(path).st_mode & 0o777, zlib.compress(Path(path).read_bytes()))

    def unpack(self, root: Path) -> None:
        """Write it where it belongs in a folder that stands for the root."""
        target = Path(f"{root}{self.path}")
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(zlib.decompress(self.packed))
        target.chmod(self.mode | 0o600)


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
    files: tuple[PackedFile, ...] = field(repr=False)
    folder: str
    environ: Mapping[str, str]

    def unpack(self, root: Path) -> Unpacked:
        """Put the files into a folder.

        Args:
            root: the folder.
        """
        for file in self.files:
            file.unpack(root)
        inside = Unpacked(root, Path(f"{root}{self.folder}"))
        inside.folder.mkdir(parents=True, exist_ok=True)
        return inside

    def plan_in(self, inside: Unpacked) -> RunPlan:
        """The run, with the files where they were unpacked."""
        plan = self.plan
        return replace(
            plan,
            words=tuple(map(inside.moved, plan.words)),
            launch_args=tuple((name, inside.moved(value)) for name, value in plan.launch_args),
            board=plan.board and inside.moved(plan.board),
            script=plan.script and inside.moved(plan.script),
            faults=plan.faults and inside.moved(plan.faults),
        )

    def environ_in(self, inside: Unpacked) -> dict[str, str]:
        """The variables, with the files where they were unpacked."""
        moved = {
            name: os.pathsep.join(map(inside.moved, self.environ[name].split(os.pathsep)))
            for name in _PATHS
            if name in self.environ
        }
        return {**self.environ, **moved}


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
    return Shipment(plan, tuple(map(PackedFile.of, files)), os.getcwd(), environ_of(plan.spec()))


def _absolute(plan: RunPlan) -> tuple[str, ...]:
    """The words of a plan, with the file that they mean in front."""
    if plan.command == LAUNCH:
        file, args = launch_file(plan.words)
        return (str(file), *(f"{name}:={value}" for name, value in args.items()))
    if plan.command == NODE:
        script, words = node_script(plan.words)
        return (str(script), *words)
    return (str(find_script(plan.words[0])), *plan.words[1:])
