"""The three files: equal to NASA's own, byte for byte, after the same pipes, subscriptions and messages."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from cfepy import fs
from cfepy.fs.background import FileWriteEvent
from cfepy.msg import Command, Layout
from cfepy.sb import POLL, SbTask
from cfepy.sb import packets as pk
from cfepy.status import CFE_STATUS_EXTERNAL_RESOURCE_FAIL
from tests.layouts import DATA
from tests.sb.harness import App, Bench, packet


def rows(name: str, layout: Layout) -> list[dict[str, Any]]:
    data = (DATA / name).read_bytes()
    return [layout.unpack(data, at) for at in range(fs.HEADER_SIZE, len(data), layout.size)]


PIPES = rows("cfe_sb_pipe.dat", pk.PIPE_FILE_ENTRY)
ROUTES = rows("cfe_sb_route.dat", pk.ROUTING_FILE_ENTRY)
MAP = rows("cfe_sb_msgmap.dat", pk.MAP_FILE_ENTRY)


def as_app(bench: Bench, row: dict[str, Any]) -> str:
    name: str = row["AppName"]
    bench.apps.setdefault(name, App(row["AppId"], name))
    return name


def use(bench: Bench, row: dict[str, Any]) -> None:
    """Fill a pipe to the peak of NASA's, and empty it to where NASA's stood."""
    filler = next(one["MsgId"] for one in ROUTES if one["PipeId"] == row["PipeId"])
    (destination,) = (one for one in bench.bus.routes[filler].destinations if one.pipe.name == row["PipeName"])
    destination.limit, others = 50, bench.bus.routes[filler].destinations
    for other in others:
        other.active = other is destination
    bench.bus.routes[filler].refresh()
    for _ in range(row["PeakQueueDepth"]):
        bench.bus.transmit_msg(packet(filler))
    for _ in range(row["PeakQueueDepth"] - row["CurrentQueueDepth"]):
        assert bench.bus.receive_buffer(row["PipeId"], POLL)
    for other in others:
        other.active = True
    bench.bus.routes[filler].refresh()


@pytest.fixture(scope="module")
def bench() -> Iterator[Bench]:
    bench = Bench()
    owners = {row["PipeId"]: as_app(bench, row) for row in PIPES}
    for row in PIPES:
        made = bench.do(owners[row["PipeId"]], lambda: bench.bus.create_pipe(row["MaxQueueDepth"], row["PipeName"]))  # noqa: B023
        assert made == row["PipeId"]
    for entry in MAP:  # the oldest subscriber of a route stands last
        for row in reversed([each for each in ROUTES if each["MsgId"] == entry["MsgId"]]):
            bench.do(owners[row["PipeId"]], lambda: bench.bus.subscribe(row["MsgId"], row["PipeId"]))  # noqa: B023
    yield bench
    bench.kernel.shutdown()


def written(bench: Bench, command: Command, name: str = "") -> bytes:
    SbTask(bench.bus).process(command.packet(Filename=name))
    return bench.files.write()


@pytest.mark.parametrize(
    ("command", "golden"),
    [
        (pk.WRITE_ROUTING_INFO, "cfe_sb_route.dat"),
        (pk.WRITE_PIPE_INFO, "cfe_sb_pipe.dat"),
        (pk.WRITE_MAP_INFO, "cfe_sb_msgmap.dat"),
    ],
)
def test_files_match_nasas(bench: Bench, command: Command, golden: str) -> None:
    if command is pk.WRITE_PIPE_INFO:
        for row in PIPES:
            use(bench, row)
    data = (DATA / golden).read_bytes()
    header = fs.read_header(data)
    SbTask(bench.bus).process(command.packet())
    meta = bench.files.waiting[0]
    assert (meta.file_name, meta.description) == (f"/ram/{golden}", header.description)
    assert meta.file_subtype == header.subtype
    assert bench.files.write() == data[fs.HEADER_SIZE :]


def test_event_at_the_end_has_size_and_entries(bench: Bench) -> None:
    before = bench.bus.counters.command
    written(bench, pk.WRITE_PIPE_INFO, "mine.dat")
    assert bench.events.sent[-1] == (39, f"/ram/mine.dat written:Size={60 * len(PIPES)},Entries=64")
    assert bench.bus.counters.command == before + 1


def test_second_file_is_refused_while_one_is_written(bench: Bench) -> None:
    task = SbTask(bench.bus)
    task.process(pk.WRITE_MAP_INFO.packet(Filename="/ram/first"))
    before = bench.bus.counters.command_error
    task.process(pk.WRITE_ROUTING_INFO.packet(Filename="/ram/second"))
    assert bench.bus.counters.command_error == before + 1
    assert bench.events.sent[-1][0] == 40
    assert bench.events.sent[-1][1].startswith("Error creating file /ram/first, stat=0x")
    bench.files.write()


def test_invalid_file_name_is_refused(bench: Bench) -> None:
    SbTask(bench.bus).process(pk.WRITE_MAP_INFO.packet(Filename="/ram/"))
    assert bench.events.sent[-1] == (40, "Error creating file /ram/, stat=0xc6000002")
    assert not bench.files.waiting


@pytest.mark.parametrize(
    ("event", "event_id", "text"),
    [
        (FileWriteEvent.CREATE_ERROR, 40, "Error creating file /ram/x, stat=0xc8000005"),
        (FileWriteEvent.RECORD_WRITE_ERROR, 49, "File write,byte cnt err,file /ram/x,request=60,actual=-939524091"),
    ],
)
def test_write_error_is_reported(bench: Bench, event: FileWriteEvent, event_id: int, text: str) -> None:
    SbTask(bench.bus).process(pk.WRITE_PIPE_INFO.packet(Filename="/ram/x"))
    bench.files.waiting.pop().on_event(event, CFE_STATUS_EXTERNAL_RESOURCE_FAIL, 3, 60, 244)
    assert bench.events.sent[-1] == (event_id, text)


def test_empty_bus_writes_empty_files() -> None:
    bench = Bench()
    for command in (pk.WRITE_ROUTING_INFO, pk.WRITE_PIPE_INFO, pk.WRITE_MAP_INFO):
        assert written(bench, command) == b""
    bench.kernel.shutdown()
