"""Observing from inside: the transmission of a packet, the task on the processor, and that nothing changes."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.monitors.observer import MESSAGE_LIMIT, OLDEST, PIPE_FULL, Observer, Sent, app_of
from cfepy.pilot.pilot import Flown, fly
from cfepy.pilot.plan import RunPlan
from cfepy.rtos import Task
from cfepy.sb.pipe import Pipe
from cfepy.schedules.schedule import Schedule
from tests.mission.flights import write_mission

READER = """\
import struct
from cfepy.msg import init

def READER_AppMain(cfe):
    kernel = cfe.es.kernel
    sb = cfe.sb
    sent = 0

    def send(count, origination=True):
        nonlocal sent
        for _ in range(count):
            packet = init(0x0A00, 24)
            packet[16:24] = struct.pack("<q", sent)
            sb.transmit_msg(bytes(packet), origination)
            sent += 1
            cfe.os.task_delay(10)

    def take(pipe):
        while True:
            packet = sb.receive_buffer(pipe, 0)
            if packet is None:
                return
            cfe.os.printf("took %d\\n" % struct.unpack("<q", packet[16:24]))

    cfe.es.wait_for_startup_sync(1000)
    pipe = sb.create_pipe(3, "A")
    sb.subscribe_ex(0x0A00, pipe, 0, 2)
    send(4); take(pipe)                     # two meet the message limit
    send(1); take(pipe)
    sb.unsubscribe(0x0A00, pipe)
    sb.subscribe_ex(0x0A00, pipe, 0, 100)
    send(5); take(pipe)                     # two find the pipe full
    send(2, False); take(pipe)              # from elsewhere, with a sequence count of their own
    sb.find_pipe(pipe).keeps_newest = True
    send(6); take(pipe)                     # three make room
    sb.delete_pipe(pipe)
    send(1)
    pipe = sb.create_pipe(2, "A")
    sb.subscribe(0x0A00, pipe)
    send(2); take(pipe)
    while cfe.es.run_loop():
        cfe.os.task_delay(100)
"""


class Seen(Observer):
    """Keeps its notifications."""

    def __init__(self) -> None:
        super().__init__()
        self.numbers: dict[int, int] = {}  # number within the packet, by number of the transmission
        self.taken: list[int] = []
        self.unknown = 0
        self.drops: list[str] = []
        self.depths: list[int] = []
        self.lines: list[str] = []
        self.notes: list[str] = []
        self.running: Task | None = None

    def on_send(self, sent: Sent, packet: bytes | bytearray) -> None:
        if sent.msg_id == 0x0A00:
            self.numbers[sent.number] = int.from_bytes(packet[16:24], "little")
            assert app_of(sent.task) == "READER"

    def on_receive(self, sent: Sent | None, pipe: Pipe, task: Task, at_ns: int) -> None:
        self.unknown += sent is None
        if sent is not None:
            assert sent.at_ns <= at_ns
            if sent.number in self.numbers:
                self.taken.append(self.numbers[sent.number])

    def on_drop(self, msg_id: int, pipe: Pipe, why: str, at_ns: int) -> None:
        self.drops.append(why)

    def on_depth(self, pipe: Pipe, at_ns: int) -> None:
        if pipe.name == "A":
            self.depths.append(len(pipe.items))

    def on_run(self, task: Task, at_ns: int) -> None:
        assert self.running is None, "two tasks have the processor"
        self.running = task

    def on_leave(self, task: Task, at_ns: int, waits: bool) -> None:
        assert self.running is task
        self.running = None

    def on_console(self, line: str, at_ns: int) -> None:
        self.lines.append(line)

    def on_note(self, text: str, at_ns: int) -> None:
        self.notes.append(text)


@pytest.fixture
def mission(tmp_path: Path) -> str:
    return write_mission(tmp_path, "CFE_APP, /cf/reader.so, READER_AppMain, READER, 50, 8192, 0x0, 0;\n", reader=READER)


def flight_of(mission: str, *observers: Observer, schedule: str = "fifo") -> Flown:
    return fly(RunPlan((mission,), seconds=2.0, schedule=Schedule.parse(schedule)), attachments=observers)


def test_received_packets_are_matched_with_sent_ones(mission: str) -> None:
    seen = Seen()
    flight_of(mission, seen)
    told = [int(line.split()[1]) for line in seen.lines if line.startswith("took ")]
    assert len(told) == 13
    assert seen.taken == told
    assert seen.unknown == 0


def test_lost_packet_is_reported_with_the_reason(mission: str) -> None:
    seen = Seen()
    flight_of(mission, seen)
    assert seen.drops == [MESSAGE_LIMIT] * 2 + [PIPE_FULL] * 2 + [OLDEST] * 3
    assert max(seen.depths) == 3
    assert min(seen.depths) == 0


@pytest.mark.parametrize("schedule", ["fifo", "random:2", "random:2:any"])
def test_several_observers_do_not_change_the_run(mission: str, schedule: str) -> None:
    one, other = Seen(), Seen()
    assert flight_of(mission, one, other, schedule=schedule).trace == flight_of(mission, schedule=schedule).trace
    assert one.taken == other.taken != []


def test_console_lines_and_notes_are_distinguished(mission: str) -> None:
    class Noting(Seen):
        def conclude(self) -> None:
            self.mission.trace.note("only in the trace")
            self.mission.console.write("on the console")

    seen = Noting()
    flown = flight_of(mission, seen)
    assert seen.lines == flown.mission.console.lines
    assert seen.notes == ["only in the trace"]
