"""A run in a process of its own whose trace another process reads: what `--check-determinism` starts.

`python -m cfepy.cli.recorded_run PLAN`, where PLAN is a `Plan` as JSON. Everything that it has to say goes to the pipe
of the plan: all records, or, with `look_at`, what there was to see at one of them.
"""

from __future__ import annotations

import argparse
import dataclasses
import json
import os
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NoReturn

from cfepy.attachment import Recorder
from cfepy.cli.failures import booting
from cfepy.cli.flight import Interrupts
from cfepy.cli.main import BAD_USAGE, ENDED_WELL
from cfepy.cli.record_fields import fields_of
from cfepy.cli.recording import arguments_of
from cfepy.cli.run import fly, script_of
from cfepy.cli.trace_text import TraceText
from cfepy.journal.journal import read_journal
from cfepy.journal.replay import Replay
from cfepy.journal.stage import staged
from cfepy.mission import Mission, MissionSpec, read_mission
from cfepy.mission.determinism import ComparedTrace, RecordWriter, comparing
from cfepy.mission.determinism_look import Look, LookingTrace
from cfepy.sb import SoftwareBus
from cfepy.status import UsageError

LINES = 6  # records that are shown before the one that is looked at


@dataclass(frozen=True, slots=True)
class Plan:
    """What to run and where to write.

    Attributes:
        arguments: those of `cfepy run`, by name.
        pipe: descriptor to write to.
        look_at: number of the record to look at; None writes all records.
        ordered_sets: all nodes get ordered sets, whatever the mission file says.
        journal: path of a journal that is replayed, in place of all that `arguments` say; None for none.
        lines: records that are shown before the one that is looked at.
    """

    arguments: dict[str, Any]
    pipe: int = -1
    look_at: int | None = None
    ordered_sets: bool = False
    journal: str | None = None
    lines: int = LINES

    def to_json(self) -> str:
        """Itself as text."""
        return json.dumps(dataclasses.asdict(self))


class RecordPipe(Recorder):
    """The recorder of a run that writes all records."""

    def __init__(self, writer: RecordWriter) -> None:
        self.trace = ComparedTrace(writer.write)
        self._writer = writer

    def __exit__(self, kind: type[BaseException] | None, *error: object) -> None:
        if kind is None:
            self._writer.end({"digest": self.trace.digest()})

    def bus(self, base: type[SoftwareBus]) -> type[SoftwareBus]:
        """One that also records what nobody gets."""
        return comparing(base, self.trace)


class Lookout(Recorder):
    """The recorder of a run that looks at one record, and ends the process then and there.

    Args:
        writer: gets what was seen.
        index: number of the record.
        lines: how many records before it are shown.
        root: folder in which the files of a journal were unpacked for this run, if they were.
    """

    def __init__(self, writer: RecordWriter, index: int, lines: int, root: str = "") -> None:
        self._before = lines
        self._root = root
        self.trace = self._looking = LookingTrace(index, self._lines, self._seen)
        self._writer = writer
        self._text = TraceText()
        self._mission: Mission | None = None

    def __exit__(self, kind: type[BaseException] | None, *error: object) -> None:
        if kind is None:
            self._seen(self._looking.look(b""))

    def bus(self, base: type[SoftwareBus]) -> type[SoftwareBus]:
        """See `RecordPipe.bus`; the two must make the same records."""
        return comparing(base, self.trace)

    def begin(self, mission: Mission) -> None:
        """Learn the names in this mission."""
        self._mission = mission
        self._text.watch(mission)

    def _lines(self, records: list[bytes]) -> list[str]:
        return list(self._text.lines(records))[-self._before - 1 :]

    def _seen(self, look: Look) -> NoReturn:
        """It is called from deep inside the simulation, where a run cannot be given up in an orderly way."""
        fields = {} if self._mission is None else fields_of(look.record, self._mission)
        self._writer.end({**look.without_root(self._root).to_dict(), "fields": fields})
        os._exit(ENDED_WELL)


def run(plan: Plan) -> None:
    """Do what a plan says.

    Raises:
        UsageError: the mission cannot run like this.
    """
    if plan.journal is not None:
        run_again(plan, plan.journal)
        return
    arguments = argparse.Namespace(**plan.arguments)
    spec = read_mission(arguments.mission, dict(arguments.launch_args))
    if plan.ordered_sets:
        spec = _with_ordered_sets(spec)
    with Interrupts() as interrupts, booting(spec.script):
        fly(arguments, spec, interrupts, script_of(arguments, spec), _recorder(plan))


def run_again(plan: Plan, path: str) -> None:
    """Replay a journal with its own files.

    Raises:
        UsageError: its mission cannot run.
    """
    journal = read_journal(path)
    with staged(journal) as stage, Interrupts() as interrupts, booting(Path(path)):
        spec, replay = stage.spec(), Replay(journal, stage)
        arguments = arguments_of(replay.plan, quiet=True)
        fly(arguments, spec, interrupts, script_of(arguments, spec), _recorder(plan, stage.root), replay=replay)


def _recorder(plan: Plan, root: str = "") -> RecordPipe | Lookout:
    writer = RecordWriter(open(plan.pipe, "wb"))  # noqa: SIM115  # as long as the process
    return RecordPipe(writer) if plan.look_at is None else Lookout(writer, plan.look_at, plan.lines, root)


def _with_ordered_sets(spec: MissionSpec) -> MissionSpec:
    nodes = {app: dataclasses.replace(node, ordered_sets=True) for app, node in spec.ros.nodes.items()}
    return dataclasses.replace(spec, ros=dataclasses.replace(spec.ros, nodes=nodes, ordered_sets=True))


def main() -> int:
    """Run the plan on the command line; the exit status."""
    try:
        run(Plan(**json.loads(sys.argv[1])))
    except (UsageError, OSError) as error:
        print(error, file=sys.stderr)
        return BAD_USAGE
    return ENDED_WELL


if __name__ == "__main__":
    sys.exit(main())
