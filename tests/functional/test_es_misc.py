"""Check values, the system log, and the calls of the PSP (es_misc_test.c)."""

from __future__ import annotations

from cfepy.app import Cfe
from cfepy.es.reset_data import DISCARD, OVERWRITE
from cfepy.fs import CRC_16, CRC_32, CRC_NONE
from cfepy.status import CFE_ES_ERR_SYS_LOG_FULL, CFE_ES_ERR_SYS_LOG_TRUNCATED, CFE_SUCCESS
from tests.functional.harness import status_of

CHECK = b"123456789"
LINE = "a line of more than fifty characters, to fill the system log"


def test_calculate_crc(cfe: Cfe) -> None:
    crc, before = cfe.es.calculate_crc, 345353
    assert crc(CHECK, 1, CRC_NONE) == 0
    assert crc(CHECK, 1, CRC_32 + 1) == 0, "a kind that there is not"
    assert crc(CHECK, 0, CRC_16) == 0xBB3D
    assert crc(CHECK) == 0xBB3D, "the mission's default"
    assert crc(b"Random Stuff", 0, CRC_16) == 0x11E3
    assert crc(CHECK, before, CRC_16) == 0xE493
    assert crc(b"", before, CRC_16) == before


def test_write_to_sys_log(cfe: Cfe) -> None:
    write, size = cfe.es.write_to_sys_log, cfe.es.syslog.size
    assert write(LINE) == CFE_SUCCESS
    cfe.es.syslog.set_mode(OVERWRITE)
    assert {write(LINE) for _ in range(size // len(LINE) + 1)} == {CFE_SUCCESS}, "begins again at its top"
    cfe.es.syslog.set_mode(DISCARD)
    cfe.es.syslog.clear()
    found = [write(LINE) for _ in range(size // len(LINE) + 1)]
    assert found[0] == CFE_SUCCESS
    assert found[-1] == CFE_ES_ERR_SYS_LOG_FULL
    assert set(found) <= {CFE_SUCCESS, CFE_ES_ERR_SYS_LOG_TRUNCATED, CFE_ES_ERR_SYS_LOG_FULL}


def test_process_async_event(cfe: Cfe) -> None:
    assert status_of(cfe.es.process_async_event) == CFE_SUCCESS


def test_background_wakeup(cfe: Cfe) -> None:
    assert status_of(cfe.es.background_wakeup) == CFE_SUCCESS
