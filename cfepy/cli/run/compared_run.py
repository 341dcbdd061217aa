"""A run in a process of its own whose trace another process reads; `--check-determinism` starts it.

`python -m cfepy.cli.run.compared_run RUN`, where RUN is a `ComparedRun` as JSON. It writes to the pipe: all records,
or, with `look_at`, a description of one of them.
"""

from __future__ import annotations

import dataclasses
import json
import os
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NoReturn

from cfepy.attachment import Recorder
from cfepy.cli.main import BAD_USAGE, ENDED_WELL
from cfepy.cli.run.record_event import MESSAGE, OTHER, OVER, RecordEvent, due_timer, is_message, timer_line
from cfepy.cli.trace_text import TraceText
from cfepy.cli.watched_host import Interrupts, WatchedHost
from cfepy.ground import dictionary_of, flat, library_of, plain, text_of, topics_of
from cfepy.interpreter.blas_threads import use_one_blas_thread
from cfepy.interpreter.child_pipes import descriptor_of
from cfepy.journal import Replay, read_journal, staged
from cfepy.mission import Mission, MissionSpec
from cfepy.pilot import RunPlan, fly
from cfepy.pilot.determinism import ComparedTrace, RecordWriter, hear_calls
from cfepy.pilot.determinism_look import Look, LookingTrace, outside_lines
from cfepy.pilot.host_access import OpenWorld
from cfepy.status import CfeError, UsageError
from cfepy.trace import TIME, UNSENT

_FIRST_MARK = 0x20  # smaller first bytes begin packets
LINES = 6  # records that are shown before the one that is looked at


def fields_of(record: bytes, mission: Mission) -> dict[str, str]:
    """Return name and value of each field; empty for a record of another kind, or of an unknown type."""
    if record[:1] == UNSENT:
        topic, _, message = record[1:].partition(b"\0")
        if topic:
            return _of_message(topic.decode(), message, mission)
        record = message
    if not record or record[0] >= _FIRST_MARK:
        return {}
    dictionary = dictionary_of(mission.spec)
    dictionary.learn(topics_of(mission))
    try:
        decoded = dictionary.decode(record)
    except CfeError:
        return {}
    time = {} if decoded.time_s is None else {"time of the header": f"{decoded.time_s:.6f}"}
    return {"sequence": str(decoded.sequence), **time, **_texts(decoded.values)}


def _of_message(name: str, data: bytes, mission: Mission) -> dict[str, str]:
    """Return the fields of a message that the bus does not carry."""
    topic = next((each for each in topics_of(mission) if each.name == name), None)
    if topic is None or not topic.type:
        return {}
    try:
        return _texts(plain(library_of(topic).message_class(topic.type)().deserialize(data)))
    except Exception:  # the generated code may raise any error for bytes of another type
        return {}


def _texts(values: object) -> dict[str, str]:
    return {path: text_of(value) for path, value in flat(values).items()}


@dataclass(frozen=True, slots=True)
class ComparedRun:
    """A run whose records another process reads, and the choice of the records.

    Attributes:
        plan: the run; None for the run of the journal.
        journal: path of a journal to replay, or None.
        pipe: number of the pipe to write to.
        look_at: number of the record to look at; None writes all records.
        ordered_sets: all nodes get ordered sets, regardless of the mission file.
        lines: number of records to show before the one that is looked at.
        decode: records, in hexadecimal digits, whose names and fields are wanted with the look.
        scratch: folder for temporary files; empty for the computer's default.
    """

    plan: RunPlan | None = None
    journal: str | None = None
    pipe: int = -1
    look_at: int | None = None
    ordered_sets: bool = False
    lines: int = LINES
    decode: tuple[str, ...] = ()
    scratch: str = ""

    def to_json(self) -> str:
        """Serialize to JSON for the child's command line."""
        plain = {each.name: getattr(self, each.name) for each in dataclasses.fields(self)}
        return json.dumps({**plain, "plan": None if self.plan is None else self.plan.to_dict()})

    @classmethod
    def from_json(cls, text: str) -> ComparedRun:
        """Parse the result of `to_json`."""
        plain = json.loads(text)
        return cls(**{**plain, "plan": None if plain["plan"] is None else RunPlan.from_dict(plain["plan"])})


class RecordPipe(Recorder):
    """The recorder of a run that writes all records, and at the end its contacts outside the simulated computer.

    Attributes:
        problems: the problems of the run, for the comparing process; set when it is over.
    """

    def __init__(self, writer: RecordWriter, world: OpenWorld) -> None:
        self.trace = ComparedTrace(writer.write)
        self.problems: list[str] = []
        self._writer = writer
        self._world = world

    def __exit__(self, kind: type[BaseException] | None, *error: object) -> None:
        if kind is None:
            contacts = [*self._world.contacts, *outside_lines(), *filter(None, [use_one_blas_thread()])]
            self._writer.end({"digest": self.trace.digest(), "contacts": contacts, "problems": self.problems})

    def begin(self, mission: Mission) -> None:
        """Watch the calls of compiled applications as well."""
        hear_calls(mission.kernel, self.trace)


class Lookout(Recorder):
    """The recorder of a run that looks at one record, and then ends the process.

    Args:
        writer: receives the look.
        world: has the accesses of the run to the computer outside the simulation.
        index: number of the record.
        lines: how many records before it are shown.
        decode: as in `ComparedRun`.
        root: folder in which the files of a journal were unpacked for this run, if they were.
    """

    def __init__(
        self,
        writer: RecordWriter,
        world: OpenWorld,
        index: int,
        lines: int,
        decode: Sequence[str] = (),
        root: str = "",
    ) -> None:
        self._world = world
        self._before = lines
        self._last = ""  # the line of the record before the one that is looked at
        self._decode = [bytes.fromhex(each) for each in decode]
        self._root = root
        self.trace = self._looking = LookingTrace(index, self._lines, self._seen)
        self._writer = writer
        self._text = TraceText()
        self._mission: Mission | None = None

    def __exit__(self, kind: type[BaseException] | None, *error: object) -> None:
        if kind is None:
            self._seen(self._looking.look(b""))

    def begin(self, mission: Mission) -> None:
        """Learn the names in this mission."""
        self._mission = mission
        hear_calls(mission.kernel, self.trace)
        self._text.watch(mission)

    def _lines(self, records: list[bytes]) -> list[str]:
        lines = list(self._text.lines(records))
        if records[-1][:1] == TIME and self._mission is not None:  # such a record has no line of its own
            lines.append(timer_line(due_timer(records[-1], self._mission)))
        self._last = lines[-2] if len(lines) > 1 else ""
        return lines[-self._before - 1 :]

    def _seen(self, look: Look) -> NoReturn:
        """Write the look and end the process. It is called deep inside the simulation, where a run cannot be ended
        properly.
        """
        look = replace(look.without_root(self._root), contacts=tuple(self._world.contacts))
        event = self._event(look).to_dict()
        decoded = [self._decoded(record) for record in self._decode]
        self._writer.end({**look.to_dict(), "last": self._last, "event": event, "decoded": decoded})
        os._exit(ENDED_WELL)

    def _event(self, look: Look) -> RecordEvent:
        record, mission = look.record, self._mission
        if not record or mission is None:
            return RecordEvent(OVER, self._text.now_ns)
        if record[:1] == TIME:
            found = due_timer(record, mission)
            return replace(found, place=found.place.removeprefix(self._root))
        _, task, what = look.lines[-1].split(" ", 2)
        culprit = look.culprit
        place = "" if culprit is None else f"{Path(culprit.file).name}:{culprit.number}: {culprit.source}"
        if is_message(record):
            name, fields = self._decoded(record)
            return RecordEvent(MESSAGE, self._text.now_ns, task, name, place, fields, record.hex())
        return RecordEvent(OTHER, self._text.now_ns, task, what, place)

    def _decoded(self, record: bytes) -> tuple[str, dict[str, str]]:
        """Return the topic or packet of a message, and its fields."""
        return self._text.subject(record), {} if self._mission is None else fields_of(record, self._mission)


def run(asked: ComparedRun) -> None:
    """Fly the run that the command line describes.

    Raises:
        UsageError: the mission cannot run.
    """
    if asked.plan is None:
        _run_again(asked)
        return
    spec = asked.plan.spec()
    if asked.ordered_sets:
        spec = _with_ordered_sets(spec)
    with (
        Interrupts() as interrupts,
        OpenWorld() as world,
        _recorder(asked, world) as recorder,
        WatchedHost(interrupts) as host,
    ):
        trace, console = recorder.trace, host.console
        flown = fly(asked.plan, spec=spec, attachments=[recorder], console=console, trace=trace, host=host)
        if isinstance(recorder, RecordPipe):
            recorder.problems = flown.results.problems


def _run_again(asked: ComparedRun) -> None:
    """Replay a journal with its own files.

    Raises:
        UsageError: its mission cannot run.
    """
    assert asked.journal is not None
    journal = read_journal(asked.journal)
    with (
        staged(journal) as stage,
        Interrupts() as interrupts,
        OpenWorld() as world,
        _recorder(asked, world, stage.root) as recorder,
        WatchedHost(interrupts) as host,
    ):
        Replay(journal, stage).fly([recorder], console=host.console, trace=recorder.trace, host=host)


def _recorder(asked: ComparedRun, world: OpenWorld, root: str = "") -> RecordPipe | Lookout:
    writer = RecordWriter(open(descriptor_of(asked.pipe), "wb"))  # noqa: SIM115  # as long as the process
    return (
        RecordPipe(writer, world)
        if asked.look_at is None
        else Lookout(writer, world, asked.look_at, asked.lines, asked.decode, root)
    )


def _with_ordered_sets(spec: MissionSpec) -> MissionSpec:
    nodes = {app: dataclasses.replace(node, ordered_sets=True) for app, node in spec.ros.nodes.items()}
    return dataclasses.replace(spec, ros=dataclasses.replace(spec.ros, nodes=nodes, ordered_sets=True))


def main() -> int:
    """Run the plan on the command line. Returns the exit status."""
    try:
        asked = ComparedRun.from_json(sys.argv[1])
        tempfile.tempdir = asked.scratch or None
        run(asked)
    except (UsageError, OSError) as error:
        print(error, file=sys.stderr)
        return BAD_USAGE
    return ENDED_WELL


if __name__ == "__main__":
    sys.exit(main())
