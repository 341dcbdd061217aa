"""The system log byte for byte, as a ring of 3072 bytes in C."""

from __future__ import annotations

from typing import Any

import pytest

from cfepy.config.platform import PlatformConfig
from cfepy.es.reset_data import DISCARD, OVERWRITE, SysLogData
from cfepy.es.syslog import SystemLog
from cfepy.status import (
    CFE_ES_BAD_ARGUMENT,
    CFE_ES_ERR_SYS_LOG_FULL,
    CFE_ES_ERR_SYS_LOG_TRUNCATED,
    CFE_SUCCESS,
    CfeError,
)
from cfepy.writing.console import Console

STAMP = "1980-012-14:03:20.00000"


class Clock:
    def text(self) -> str:
        return STAMP


class Ports:
    time = Clock()


def make(size: int = 3072, mode: int = OVERWRITE) -> SystemLog:
    ports: Any = Ports()
    log = SystemLog(ports, Console(quiet=True), PlatformConfig(es_system_log_size=size))
    log.set_mode(mode)
    return log


def line(text: str) -> bytes:
    return f"{STAMP} {text}\n".encode()


def test_a_line_has_a_stamp_and_shows_on_the_console() -> None:
    log = make()
    assert log.write_to_sys_log("hello \n") == CFE_SUCCESS
    assert log.read() == line("hello")
    assert log._console.lines == [f"{STAMP} hello"]
    assert (log.data.write_index, log.data.end_index, log.data.entries) == (30, 30, 1)


def test_a_line_is_cut_where_cs_buffer_ends() -> None:
    log = make()
    assert log.write_to_sys_log("x" * 500) == CFE_SUCCESS
    assert log.read() == line("x" * 122)
    log.clear()
    log.write_to_sys_log("ä" * 100)  # two bytes each
    assert len(log.read()) == 147


def test_a_line_longer_than_half_of_a_small_log_is_truncated() -> None:
    log = make(size=100)
    assert log.write_to_sys_log("x" * 60) == CFE_ES_ERR_SYS_LOG_TRUNCATED
    assert log.read() == line("x" * 60)[:49] + b"\n"


def test_overwriting_begins_at_the_top_and_reads_whole_lines_from_the_oldest_on() -> None:
    log = make(size=100)
    for text in ("one", "two", "three"):  # 28, 28 and 30 bytes
        log.write_to_sys_log(text)
    log.write_to_sys_log("four")
    assert (log.data.write_index, log.data.end_index, log.data.entries) == (29, 86, 4)
    assert log.read() == line("three") + line("four")  # the rest of "two" begins with its stamp's second byte
    assert bytes(log.data.memory[:56]) == line("four") + line("two")[1:]


@pytest.mark.parametrize(
    ("size", "status", "kept"),
    [
        (100, CFE_ES_ERR_SYS_LOG_FULL, b""),  # 14 bytes left: too few even for a stamp
        (110, CFE_ES_ERR_SYS_LOG_FULL, b""),  # 24: the limit
        (111, CFE_ES_ERR_SYS_LOG_TRUNCATED, f"{STAMP} \n".encode()),
        (114, CFE_ES_ERR_SYS_LOG_TRUNCATED, f"{STAMP} fou\n".encode()),
        (115, CFE_SUCCESS, line("four")),
    ],
)
def test_full_log_in_discard_mode_keeps_the_part_that_fits(size: int, status: int, kept: bytes) -> None:
    log = make(size=size, mode=DISCARD)
    for text in ("one", "two", "three"):
        assert log.write_to_sys_log(text) == CFE_SUCCESS
    assert log.write_to_sys_log("four") == status
    assert log.read() == line("one") + line("two") + line("three") + kept


def test_log_continues_in_retained_memory() -> None:
    first, second = make(), make()
    first.write_to_sys_log("before")
    second.data = first.data
    second.write_to_sys_log("after")
    assert second.read() == line("before") + line("after")
    assert isinstance(second.data, SysLogData)


def test_modes() -> None:
    with pytest.raises(CfeError) as caught:
        make(mode=2)
    assert caught.value.status == CFE_ES_BAD_ARGUMENT
