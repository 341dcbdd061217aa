"""SAMPLE_APP: its commands, its telemetry, its table."""

from __future__ import annotations

from pathlib import Path

import pytest

from apps.sample_app import COMMANDS, TABLES, TELEMETRY, SAMPLE_APP_Main, packets
from apps.sample_app.tables import sample_app_tbl
from cfepy.es import APP_ERROR, APP_EXIT
from cfepy.mission import Mission
from cfepy.msg import get_msg_id
from cfepy.status import CFE_SB_BAD_ARGUMENT
from cfepy.tbl import TableImage, build
from cfepy.writing.console import Console
from tests.apps.conftest import APPS, AppBench, cmd


@pytest.fixture
def sample() -> AppBench:
    return AppBench("SAMPLE_APP")


def test_shipped_table_matches_its_definition() -> None:
    assert (APPS / "sample_app/tables/sample_app_tbl.tbl").read_bytes() == build(sample_app_tbl.image())


def test_commands_of_a_session_are_answered(sample: AppBench) -> None:
    sample.symbols["SAMPLE_LIB_Function"] = lambda cfe: sample.printed.append("called")
    sample.run(
        SAMPLE_APP_Main,
        packets.NOOP.packet(),
        packets.PROCESS.packet(),
        packets.DISPLAY_PARAM.packet(ValU32=7, ValI16=-2, ValStr="hello"),
        cmd(packets.CMD_MID, 99),
        cmd(packets.CMD_MID, 0, b"x"),
        cmd(0x1999),
        packets.SEND_HK.packet(),
        packets.RESET_COUNTERS.packet(),
        packets.SEND_HK.packet(),
    )
    version = "equuleus-rc1+dev54"
    text = f"Sample App Initialized.Sample App {version} (Equuleus) v1.1.0 Official Release, EDS disabled"
    assert sample.events[1:] == [
        (1, 2, text),
        (3, 2, f"SAMPLE: NOOP command {version}"),
        (8, 2, "SAMPLE_APP: ValU32=7, ValI16=-2, ValStr=hello"),
        (2, 3, "Invalid ground command code: CC = 99"),
        (6, 3, "Invalid Msg length: ID = 0x1882,  CC = 0, Len = 9, Expected = 8"),
        (5, 3, "SAMPLE: invalid command packet,MID = 0x1999"),
        (4, 2, "SAMPLE: RESET command"),
    ]
    assert sample.log == ["Sample App: Example Table Value 1: 1  Value 2: 2", "Sample App: CRC: 0x00009C00\n\n"]
    assert sample.printed == ["called"]
    first, second = sample.sent
    assert (get_msg_id(first), len(first), first[16:]) == (0x0883, 20, bytes([1, 3, 0, 0]))
    assert second[16:] == bytes(4)
    assert sample.exit_status == APP_EXIT


def test_a_request_for_housekeeping_may_have_any_length(sample: AppBench) -> None:
    """NASA's code does not check it: a request with a length field of 0, meaning 7 bytes, was answered."""
    short = bytearray(packets.SEND_HK.packet())[:7]
    short[4:6] = bytes(2)
    sample.run(SAMPLE_APP_Main, bytes(short), cmd(packets.SEND_HK_MID, 0, b"xyz"))
    assert [(get_msg_id(each), each[16:]) for each in sample.sent] == [(0x0883, bytes(4))] * 2
    assert len(sample.events) == 1 + 1  # of its table, and of its start


def test_missing_library_is_logged(sample: AppBench) -> None:
    sample.run(SAMPLE_APP_Main, packets.PROCESS.packet(), packets.NOOP.packet())
    assert sample.log[-1] == "Sample App: no library has SAMPLE_LIB_Function"
    assert sample.events[-1][0] == 3


def test_compiled_library_is_not_called(sample: AppBench) -> None:
    sample.symbols["SAMPLE_LIB_Function"] = 0x10001000  # its address
    sample.run(SAMPLE_APP_Main, packets.PROCESS.packet(), packets.NOOP.packet())
    assert sample.log[-1] == "Sample App: SAMPLE_LIB_Function is compiled, and only compiled applications can call it"
    assert sample.events[-1][0] == 3


def test_table_out_of_range_is_refused_at_start(sample: AppBench) -> None:
    image = TableImage("SAMPLE_APP.ExampleTable", packets.EXAMPLE_TABLE.pack(Int1=11))
    sample.files["/cf/sample_app_tbl.tbl"] = build(image)
    sample.run(SAMPLE_APP_Main)
    assert sample.exit_status == APP_ERROR
    assert [event[0] for event in sample.events][-1] == 1  # the start is announced all the same


@pytest.mark.parametrize(
    ("function", "event"),
    [
        ("sb.create_pipe", (9, 3, "Sample App: Error creating SB Command Pipe, RC = 0xFFFFFFFFCA000003")),
        ("sb.subscribe", (10, 3, "Sample App: Error Subscribing to HK request, RC = 0xFFFFFFFFCA000003")),
        ("sb.receive_buffer", (7, 3, "SAMPLE APP: SB Pipe Read Error, App Will Exit")),
    ],
)
def test_app_exits_when_the_bus_refuses_a_call(sample: AppBench, function: str, event: tuple[int, int, str]) -> None:
    sample.refuse[function] = CFE_SB_BAD_ARGUMENT
    sample.run(SAMPLE_APP_Main, None)
    assert (sample.exit_status, sample.sent, sample.events[-1]) == (APP_ERROR, [], event)


def test_no_event_services_no_app(sample: AppBench) -> None:
    sample.refuse["evs.register"] = CFE_SB_BAD_ARGUMENT
    sample.run(SAMPLE_APP_Main)
    assert sample.log == ["Sample App: Error Registering Events, RC = 0xFFFFFFFFCA000003"]
    assert sample.exit_status == APP_ERROR


def test_declarations() -> None:
    assert [(each.name, each.msg_id, each.code) for each in COMMANDS] == [
        ("SAMPLE_APP_NOOP", 0x1882, 0),
        ("SAMPLE_APP_RESET_COUNTERS", 0x1882, 1),
        ("SAMPLE_APP_PROCESS", 0x1882, 2),
        ("SAMPLE_APP_DISPLAY_PARAM", 0x1882, 3),
        ("SAMPLE_APP_SEND_HK", 0x1883, None),
    ]
    assert [(each.name, each.msg_id, each.length) for each in TELEMETRY] == [("SAMPLE_APP_HK_TLM", 0x0883, 20)]
    assert [(each.name, each.size, each.file) for each in TABLES] == [
        ("SAMPLE_APP.ExampleTable", 4, "/cf/sample_app_tbl.tbl")
    ]


def test_the_library_in_a_mission(tmp_path: Path) -> None:
    (tmp_path / "startup.scr").write_text(
        "CFE_LIB, sample_lib, SAMPLE_LIB_Init, SAMPLE_LIB, 0, 0, 0x0, 0;\n"
        "CFE_APP, sample_app, SAMPLE_APP_Main, SAMPLE_APP, 50, 16384, 0x0, 0;\n!\n",
        encoding="utf-8",
    )
    with Mission(str(tmp_path), console=Console(quiet=True)) as mission:
        mission.run_for(2)
        mission.cfe.sb.transmit_msg(packets.PROCESS.packet())
        mission.run_for(1)
        lines = mission.console.lines
    start = "SAMPLE Lib Initialized.Sample Lib v7.0.0+dev0 (Draco) v7.0.0 Official Release, EDS disabled"
    assert start in lines
    assert lines[-1] == "SAMPLE_LIB_Function called, buffer='SAMPLE DATA'"
