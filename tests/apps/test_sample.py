"""SAMPLE_APP: its commands, its telemetry, its table."""

from __future__ import annotations

import pytest

from apps.sample import SAMPLE_APP_Main, messages
from apps.sample.tables import sample_app_tbl
from cfepy.es import APP_ERROR, APP_EXIT
from cfepy.msg import get_msg_id
from cfepy.status import CFE_SB_BAD_ARGUMENT
from cfepy.tbl import TableImage, build
from tests.apps.conftest import APPS, AppBench, cmd

SEND_HK = cmd(messages.SEND_HK_MID)


@pytest.fixture
def sample() -> AppBench:
    return AppBench("SAMPLE_APP")


def test_shipped_table_is_what_its_definition_says() -> None:
    assert (APPS / "sample/tables/sample_app_tbl.tbl").read_bytes() == build(sample_app_tbl.image())


def test_its_way_through_a_session(sample: AppBench) -> None:
    display = messages.DISPLAY_PARAM.pack(ValU32=7, ValI16=-2, ValStr="hello")
    sample.run(
        SAMPLE_APP_Main,
        cmd(messages.CMD_MID, messages.NOOP_CC),
        cmd(messages.CMD_MID, messages.PROCESS_CC),
        cmd(messages.CMD_MID, messages.DISPLAY_PARAM_CC, display),
        cmd(messages.CMD_MID, 99),
        cmd(messages.CMD_MID, messages.NOOP_CC, b"x"),
        cmd(0x1999),
        SEND_HK,
        cmd(messages.CMD_MID, messages.RESET_COUNTERS_CC),
        SEND_HK,
    )
    assert sample.events[1:] == [
        (1, 2, "Sample App Initialized.Sample App v1.0.0"),
        (3, 2, "SAMPLE: NOOP command v1.0.0"),
        (8, 2, "SAMPLE_APP: ValU32=7, ValI16=-2, ValStr=hello"),
        (2, 3, "Invalid ground command code: CC = 99"),
        (6, 3, "Invalid Msg length: ID = 0x1882,  CC = 0, Len = 9, Expected = 8"),
        (5, 3, "SAMPLE: invalid command packet,MID = 0x1999"),
        (4, 2, "SAMPLE: RESET command"),
    ]
    assert sample.log == ["Sample App: Example Table Value 1: 1  Value 2: 2"]
    first, second = sample.sent
    assert (get_msg_id(first), len(first), first[16:]) == (0x0883, 20, bytes([2, 3, 0, 0]))
    assert second[16:] == bytes(4)
    assert sample.exit_status == APP_EXIT


def test_table_out_of_range_is_refused_at_start(sample: AppBench) -> None:
    image = TableImage("SAMPLE_APP.ExampleTable", messages.EXAMPLE_TABLE.pack(Int1=11))
    sample.files["/cf/sample_app_tbl.tbl"] = build(image)
    sample.run(SAMPLE_APP_Main)
    assert sample.exit_status == APP_ERROR
    assert sample.log[-1].startswith("SAMPLE_APP: cannot start: ")


def test_no_pipe_no_app(sample: AppBench) -> None:
    sample.refuse["sb.create_pipe"] = CFE_SB_BAD_ARGUMENT
    sample.run(SAMPLE_APP_Main)
    assert (sample.exit_status, sample.sent) == (APP_ERROR, [])
