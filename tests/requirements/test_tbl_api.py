"""Requirements of Table Services that applications see, and the state after resets (cTBL6300-6501)."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from cfepy.evs import packets as evs_packets
from cfepy.fs import crc16
from cfepy.ports import DEBUG, ERROR, INFORMATION
from cfepy.status import (
    CFE_SUCCESS,
    CFE_TBL_ERR_FILE_TOO_LARGE,
    CFE_TBL_ERR_INVALID_HANDLE,
    CFE_TBL_ERR_INVALID_NAME,
    CFE_TBL_ERR_NEVER_LOADED,
    CFE_TBL_INFO_DUMP_PENDING,
    CFE_TBL_INFO_NO_DUMP_PENDING,
    CFE_TBL_INFO_NO_VALIDATION_PENDING,
    CFE_TBL_INFO_RECOVERED_TBL,
    CFE_TBL_INFO_TABLE_LOCKED,
    CFE_TBL_INFO_UPDATE_PENDING,
    CFE_TBL_INFO_UPDATED,
    CFE_TBL_INFO_VALIDATION_PENDING,
    CFE_TBL_WARN_SHORT_FILE,
    CfeError,
)
from cfepy.tbl import OPT_CRITICAL, OPT_DBL_BUFFER, OPT_DUMP_ONLY, OPT_USR_DEF_ADDR
from cfepy.tbl import packets as pk
from tests.requirements.covers import covers
from tests.requirements.flight import POWERON_RESET, PROCESSOR_RESET, Flight
from tests.requirements.tables import (
    FILE_TIME,
    NAME,
    NEW,
    OLD,
    SIZE,
    ProbeTable,
    free_bytes,
    housekeeping,
    put,
    registry,
)

Fly = Callable[..., Flight]


@pytest.fixture
def table(fly: Fly) -> ProbeTable:
    """PROBE.T, loaded with OLD, twice, since it has a buffer that can be locked from then on."""
    table = ProbeTable(fly(pk.HK_TLM_MID, pk.REG_TLM_MID, cfe_version="7.0.1"))
    table.mine("load", OLD)
    table.mine("load", OLD)
    table.content()
    return table


def test_cTBL6300_create(fly: Fly) -> None:
    table = ProbeTable(fly(pk.HK_TLM_MID, pk.REG_TLM_MID, cfe_version="7.0.1"), OPT_DUMP_ONLY, validator=None)
    assert table.content() == bytes(SIZE)
    table.call("register", "Other", 16, OPT_DBL_BUFFER | OPT_CRITICAL, lambda image: 0)
    info = table.call("get_info", "PROBE.Other")
    assert (info.size, info.double_buffered, info.dump_only, info.critical) == (16, True, False, True)
    values = registry(table.flight)
    assert (values["Size"], values["DumpOnly"], values["DoubleBuffered"]) == (SIZE, True, False)
    asked: list[bytes] = []

    def look(image: memoryview) -> int:
        asked.append(bytes(image))
        return 0

    third = table.call("register", "Third", 4, 0, look)
    table.call("load", third, b"data")
    assert asked == [b"data"]


def test_cTBL6300_1_address_of_the_application(fly: Fly) -> None:
    flight = fly(pk.HK_TLM_MID, cfe_version="7.0.1")
    free = free_bytes(flight)
    table = ProbeTable(flight, OPT_USR_DEF_ADDR, validator=None)
    mine = bytearray(OLD)
    table.mine("load", mine)
    assert free_bytes(flight) == free
    mine[:] = NEW
    assert table.content() == NEW
    assert table.info().user_def_addr is True


def test_cTBL6302_initialize_from_a_file(fly: Fly) -> None:
    table = ProbeTable(fly(cfe_version="7.0.1"))
    assert table.status("get_address") == CFE_TBL_ERR_NEVER_LOADED
    put(table.flight, OLD)
    assert table.mine("load", "/ram/t.tbl") == CFE_SUCCESS
    assert table.content() == OLD


def test_cTBL6302_1_too_much_data_is_refused(fly: Fly) -> None:
    table = ProbeTable(fly(cfe_version="7.0.1"))
    put(table.flight, OLD + b"!")
    table.flight.packets.clear()
    assert table.status("load", "/ram/t.tbl") == CFE_TBL_ERR_FILE_TOO_LARGE
    assert [(event.event_id, event.event_type) for event in table.flight.events()] == [(72, ERROR)]
    assert table.status("get_address") == CFE_TBL_ERR_NEVER_LOADED


def test_cTBL6302_2_less_data(fly: Fly) -> None:
    """The event of a first load is one for debugging, as in cFE."""
    table = ProbeTable(fly(cfe_version="7.0.1"))
    table.flight.send(evs_packets.ENABLE_EVENT_TYPE, BitMask=0x0F)
    for data, content, event_type in ((b"XY", b"XY" + bytes(6), DEBUG), (b"Z", b"ZY" + bytes(6), INFORMATION)):
        put(table.flight, data)
        table.flight.packets.clear()
        assert table.mine("load", "/ram/t.tbl") == CFE_TBL_WARN_SHORT_FILE
        assert [(event.event_id, event.event_type) for event in table.flight.events()] == [(35, event_type)]
        assert table.content() == content


def test_cTBL6303_a_handle_on_an_existing_table(table: ProbeTable) -> None:
    cfe, flight = table.flight.cfe, table.flight
    shared = flight.call(lambda: cfe.tbl.share(NAME), app="MUTE")
    assert shared != table.handle
    assert bytes(flight.call(lambda: cfe.tbl.get_address(shared), app="MUTE")[0]) == OLD


def test_cTBL6304_resources_are_freed(fly: Fly) -> None:
    flight = fly(pk.HK_TLM_MID, cfe_version="7.0.1")
    whole = free_bytes(flight)
    ProbeTable(flight).mine("unregister")
    used_once = free_bytes(flight)
    table = ProbeTable(flight)
    assert free_bytes(flight) == used_once < whole, "the pool's block is used again"
    table.mine("unregister")
    assert housekeeping(table.flight)["NumTables"] == 0
    assert table.status("get_address") == CFE_TBL_ERR_INVALID_HANDLE
    with pytest.raises(CfeError) as caught:
        table.info()
    assert caught.value.status == CFE_TBL_ERR_INVALID_NAME


@covers("cTBL6305", "cTBL6305.1", "cTBL6305.2", "cTBL6306", "cTBL6308", "cTBL6308.1")
def test_cTBL6305_address_lock_and_update(table: ProbeTable) -> None:
    view, updated = table.mine("get_address")
    assert (bytes(view), updated) == (OLD, False)
    assert table.mine("load", NEW) == CFE_TBL_INFO_TABLE_LOCKED
    assert table.mine("update") == CFE_TBL_INFO_TABLE_LOCKED
    assert bytes(view) == OLD
    table.mine("release_address")
    assert table.mine("update") == CFE_SUCCESS
    assert table.mine("get_address") == (memoryview(NEW), True)
    assert table.mine("get_address") == (memoryview(NEW), False)


def test_cTBL6309_table_info(table: ProbeTable) -> None:
    table.flight.call(lambda: table.flight.cfe.tbl.share(NAME), app="MUTE")
    put(table.flight, NEW)
    table.mine("load", "/ram/t.tbl")
    info = table.info()
    assert (info.size, info.num_users, info.last_file_loaded, info.file_time) == (SIZE, 2, "/ram/t.tbl", FILE_TIME)
    assert (1001000, 0) < info.time_of_last_update < table.flight.cfe.time.get_time()
    assert (info.table_loaded_once, info.dump_only, info.double_buffered, info.critical) == (True, False, False, False)
    assert (info.crc, info.user_def_addr) == (crc16(NEW), False)
    for name, options, expected in (
        ("Dump", OPT_DUMP_ONLY, (True, True, False, False, False)),
        ("Mine", OPT_USR_DEF_ADDR, (False, True, False, False, True)),
        ("Two", OPT_DBL_BUFFER | OPT_CRITICAL, (False, False, True, True, False)),
    ):
        table.call("register", name, 16, options)
        info = table.call("get_info", f"PROBE.{name}")
        flags = info.table_loaded_once, info.dump_only, info.double_buffered, info.critical, info.user_def_addr
        assert (info.size, info.num_users, flags) == (16, 1, expected)


def test_cTBL6310_pending_actions(table: ProbeTable) -> None:
    assert table.mine("get_status") == CFE_SUCCESS
    table.upload(NEW)
    table.flight.send(pk.VALIDATE, ActiveTableFlag=pk.INACTIVE_BUFFER, TableName=NAME)
    assert table.mine("get_status") == CFE_TBL_INFO_VALIDATION_PENDING
    table.mine("validate")
    table.flight.send(pk.ACTIVATE, TableName=NAME)
    assert table.mine("get_status") == CFE_TBL_INFO_UPDATE_PENDING
    live = table.call("register", "Live", SIZE, OPT_DUMP_ONLY)
    wish = {"ActiveTableFlag": pk.ACTIVE_BUFFER, "TableName": "PROBE.Live", "DumpFilename": "/ram/l.tbl"}
    table.flight.send(pk.DUMP, **wish)
    assert table.call("get_status", live) == CFE_TBL_INFO_DUMP_PENDING


@covers("cTBL6311", "cTBL6311.1", "cTBL6311.2", "cTBL6312")
def test_cTBL6311_several_addresses(table: ProbeTable) -> None:
    other = table.call("register", "Other", SIZE)
    for _ in range(2):
        table.call("load", other, NEW)
    handles = [table.handle, other]
    assert table.call("get_addresses", handles) == [(memoryview(OLD), False), (memoryview(NEW), True)]
    assert table.mine("load", NEW) == CFE_TBL_INFO_TABLE_LOCKED
    assert table.call("load", other, OLD) == CFE_TBL_INFO_TABLE_LOCKED
    assert table.call("release_addresses", handles) == CFE_SUCCESS
    assert [table.call("update", handle) for handle in handles] == [CFE_SUCCESS, CFE_SUCCESS]


@covers("cTBL6313", "cTBL6314")
def test_cTBL6314_dump_to_buffer(fly: Fly) -> None:
    table = ProbeTable(fly(cfe_version="7.0.1"), OPT_DUMP_ONLY, validator=None)
    assert table.mine("validate") == CFE_TBL_INFO_NO_VALIDATION_PENDING
    assert table.mine("dump_to_buffer") == CFE_TBL_INFO_NO_DUMP_PENDING
    table.flight.send(pk.DUMP, ActiveTableFlag=pk.ACTIVE_BUFFER, TableName=NAME, DumpFilename="/ram/d.tbl")
    table.mine("get_address")[0][:] = NEW
    assert table.mine("dump_to_buffer") == CFE_SUCCESS
    (event,) = table.flight.send(pk.SEND_HK)  # cFE does not know of the bytes that the application wrote
    assert (event.event_id, event.text.partition(":")[2]) == (65, "Error writing Tbl image, Status=-40")


def test_cTBL6315_modified(fly: Fly) -> None:
    table = ProbeTable(fly(cfe_version="7.0.1"), OPT_CRITICAL)
    cfe, flight = table.flight.cfe, table.flight
    table.mine("load", OLD)
    shared = flight.call(lambda: cfe.tbl.share(NAME), app="MUTE")
    flight.call(lambda: cfe.tbl.get_address(shared), app="MUTE")
    flight.call(lambda: cfe.tbl.release_address(shared), app="MUTE")
    before = table.info()
    flight.run_for(1)
    table.mine("get_address")[0][:] = NEW
    table.mine("modified")
    after = table.info()
    assert after.time_of_last_update > before.time_of_last_update
    assert (after.crc, after.last_file_loaded) == (crc16(NEW), before.last_file_loaded + "(*)")
    assert cfe.es.restore_from_cds(cfe.es.get_cds_block_id_by_name(NAME)) == NEW
    assert flight.call(lambda: cfe.tbl.get_address(shared), app="MUTE")[1] is True


def test_cTBL6316_manage(table: ProbeTable) -> None:
    table.upload(NEW)
    table.flight.send(pk.VALIDATE, ActiveTableFlag=pk.INACTIVE_BUFFER, TableName=NAME)
    table.flight.packets.clear()
    assert table.mine("manage") == CFE_SUCCESS
    assert [event.event_id for event in table.flight.events()] == [36]
    assert table.content() == OLD
    assert table.activate() == CFE_TBL_INFO_UPDATED
    assert table.content() == NEW
    live = table.call("register", "Live", SIZE, OPT_DUMP_ONLY)
    wish = {"ActiveTableFlag": pk.ACTIVE_BUFFER, "TableName": "PROBE.Live", "DumpFilename": "/ram/l.tbl"}
    table.flight.send(pk.DUMP, **wish)
    assert table.call("manage", live) == CFE_SUCCESS
    table.flight.send(pk.SEND_HK)
    assert table.flight.mission.files.exists("/ram/l.tbl")


@pytest.mark.parametrize("kind", [POWERON_RESET, PROCESSOR_RESET], ids=["cTBL6500", "cTBL6501"])
@covers("cTBL6500", "cTBL6501")
def test_cTBL6500_resets_free_tables(table: ProbeTable, kind: bytes) -> None:
    flight = table.flight
    table.upload(NEW)
    flight.reset(kind)
    values = housekeeping(flight)
    assert (values["NumTables"], values["NumFreeSharedBufs"], values["NumLoadPending"]) == (0, 4, 0)
    assert ProbeTable(flight).status("get_address") == CFE_TBL_ERR_NEVER_LOADED


def test_cTBL6501_1_critical_tables_survive_a_processor_reset(fly: Fly) -> None:
    table = ProbeTable(fly(cfe_version="7.0.1"), OPT_CRITICAL)
    put(table.flight, NEW)
    table.mine("load", "/ram/t.tbl")
    before = table.info()
    table.flight.reset(PROCESSOR_RESET)
    after = ProbeTable(table.flight, OPT_CRITICAL)
    assert after.handle.status == CFE_TBL_INFO_RECOVERED_TBL
    assert (after.content(), after.info()) == (NEW, before._replace(crc=0))
    assert (before.last_file_loaded, before.file_time) == ("/ram/t.tbl", FILE_TIME)
    table.flight.reset(POWERON_RESET)
    gone = ProbeTable(table.flight, OPT_CRITICAL)
    assert gone.handle.status == CFE_SUCCESS
    assert gone.status("get_address") == CFE_TBL_ERR_NEVER_LOADED
