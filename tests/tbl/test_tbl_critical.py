"""Critical tables: data restored after a processor reset, and data that must not be (cTBL6501.1, cTBL6013)."""

from __future__ import annotations

import pytest

from cfepy.status import (
    CFE_SUCCESS,
    CFE_TBL_ERR_LOAD_IN_PROGRESS,
    CFE_TBL_ERR_NEVER_LOADED,
    CFE_TBL_INFO_RECOVERED_TBL,
    CFE_TBL_INFO_UPDATED,
    CFE_TBL_WARN_NOT_CRITICAL,
    CfeError,
)
from cfepy.tbl import OPT_CRITICAL, OPT_DBL_BUFFER, TableHandle, packets
from tests.tbl.conftest import NOW, Bench, Store

REGISTRY = "CFE_TBL.CritReg"
NAME = "APP.T"


def after_reset(bench: Bench) -> Bench:
    """Return the bench that a processor reset makes of another one."""
    return Bench(bench.store)


def loaded(options: int = OPT_CRITICAL) -> tuple[Bench, TableHandle]:
    bench = Bench()
    handle = bench.tbl.register("T", 4, options)
    bench.put("/cf/t.tbl", NAME, b"abcd")
    bench.tbl.load(handle, "/cf/t.tbl")
    return bench, handle


def content(bench: Bench, handle: int) -> bytes:
    data = bytes(bench.tbl.get_address(handle)[0])
    bench.tbl.release_address(handle)
    return data


@pytest.mark.parametrize("options", [OPT_CRITICAL, OPT_CRITICAL | OPT_DBL_BUFFER], ids=["single", "double"])
def test_critical_table_is_restored_after_a_processor_reset(options: int) -> None:
    bench, handle = loaded(options)
    assert handle.status == CFE_SUCCESS
    before = bench.tbl.get_info(NAME)
    after = after_reset(bench)
    again = after.tbl.register("T", 4, options)
    assert again.status == CFE_TBL_INFO_RECOVERED_TBL
    assert after.tbl.get_address(again) == (memoryview(b"abcd"), True)
    assert after.tbl.get_info(NAME) == before._replace(crc=0)  # cFE does not report how much was restored
    assert after.send_hk()["NumLoadPending"] == 0
    assert (before.critical, before.last_file_loaded, before.time_of_last_update) == (True, "/cf/t.tbl", NOW)


def test_load_of_a_recovered_table_stays_in_progress_in_7_0_0() -> None:
    bench, _ = loaded()
    after = Bench(bench.store, cfe_version="7.0.0")
    handle = after.tbl.register("T", 4, OPT_CRITICAL)
    assert handle.status == CFE_TBL_INFO_RECOVERED_TBL
    assert after.send_hk()["NumLoadPending"] == 1
    with pytest.raises(CfeError) as caught:
        after.tbl.load(handle, b"2nd.")
    assert caught.value.status == CFE_TBL_ERR_LOAD_IN_PROGRESS


def test_latest_image_is_stored() -> None:
    bench, handle = loaded()
    bench.tbl.load(handle, b"2nd.")
    view, _ = bench.tbl.get_address(handle)
    view[0] = ord("X")
    bench.tbl.modified(handle)
    after = after_reset(bench)
    again = after.tbl.register("T", 4, OPT_CRITICAL)
    assert content(after, again) == b"Xnd."


def test_load_from_the_ground_is_stored_when_it_is_activated() -> None:
    bench, handle = loaded()
    bench.put("/cf/n.tbl", NAME, b"new.")
    bench.ground(packets.LOAD, LoadFilename="/cf/n.tbl")
    assert bench.store.blocks[NAME] == b"abcd"
    bench.ground(packets.ACTIVATE, TableName=NAME)
    assert bench.tbl.manage(handle) == CFE_TBL_INFO_UPDATED
    assert bench.store.blocks[NAME] == b"new."


def test_registry_has_the_layout_of_c() -> None:
    bench, _ = loaded()
    data = bench.store.blocks[REGISTRY]
    assert len(data) == 4096
    record = packets.CRITICAL_RECORD.unpack(data)
    assert (record["CDSHandle"], record["Name"], record["LastFileLoaded"]) == (0x150002, NAME, "/cf/t.tbl")
    assert record["TableLoadedOnce"] is True
    assert packets.CRITICAL_RECORD.offsets["TableLoadedOnce"] == 124


def never_loaded(bench: Bench, handle: TableHandle) -> bool:
    with pytest.raises(CfeError) as caught:
        bench.tbl.get_address(handle)
    return caught.value.status == CFE_TBL_ERR_NEVER_LOADED


@pytest.mark.parametrize("broken", [NAME, REGISTRY])
def test_damaged_table_is_never_loaded(broken: str) -> None:
    bench, _ = loaded()
    bench.store.broken.add(broken)
    after = after_reset(bench)
    handle = after.tbl.register("T", 4, OPT_CRITICAL)
    assert handle.status == CFE_SUCCESS
    assert never_loaded(after, handle)
    assert any("ailed to recover" in line for line in after.log)


def test_table_that_was_never_loaded_is_not_restored() -> None:
    bench = Bench()
    bench.tbl.register("T", 4, OPT_CRITICAL)
    after = after_reset(bench)
    handle = after.tbl.register("T", 4, OPT_CRITICAL)
    assert handle.status == CFE_SUCCESS
    assert never_loaded(after, handle)
    records = [packets.CRITICAL_RECORD.unpack(after.store.blocks[REGISTRY], at) for at in range(0, 4096, 128)]
    assert sum(record["Name"] == NAME for record in records) == 2
    with pytest.raises(CfeError) as caught:
        after.tbl.load(handle, b"abcd")
    assert caught.value.status == CFE_TBL_ERR_LOAD_IN_PROGRESS


def test_table_of_another_size_is_new() -> None:
    bench, _ = loaded()
    after = after_reset(bench)
    handle = after.tbl.register("T", 8, OPT_CRITICAL)
    assert handle.status == CFE_SUCCESS
    assert never_loaded(after, handle)
    third = after_reset(after)
    assert third.tbl.register("T", 8, OPT_CRITICAL).status == CFE_SUCCESS


def test_tables_are_not_critical_without_a_cds() -> None:
    store = Store()
    store.is_there = False
    bench = Bench(store)
    handle = bench.tbl.register("T", 4, OPT_CRITICAL)
    assert handle.status == CFE_TBL_WARN_NOT_CRITICAL
    assert bench.tbl.load(handle, b"abcd") == CFE_SUCCESS
    assert bench.tbl.get_info(NAME).critical is False
    assert bench.log == [
        "CFE_TBL_EarlyInit: Failed to create Critical Table Registry (Err=0xC400FFFF)",
        "CFE_TBL_Register: Failed to register 'APP.T' as a CDS (ErrCode=0xC400FFFF)",
    ]


def test_the_registry_of_critical_tables_can_be_full() -> None:
    bench = Bench(tbl_max_critical_tables=1)
    bench.tbl.register("A", 4, OPT_CRITICAL)
    assert bench.tbl.register("B", 4, OPT_CRITICAL).status == CFE_SUCCESS
    full = "CFE_TBL_RegisterWithCriticalTableRegistry: Failed to find a free Crit Tbl Reg Rec for 'APP.B'"
    assert bench.log == [full]


def test_delete_cds() -> None:
    bench, handle = loaded()
    bench.take_events()
    bench.named(packets.DELETE_CDS, NAME)
    bench.tbl.unregister(handle)
    bench.store.running.add("APP")
    bench.named(packets.DELETE_CDS, NAME)
    bench.store.running.clear()
    bench.named(packets.DELETE_CDS, NAME)
    bench.named(packets.DELETE_CDS, NAME)
    bench.named(packets.DELETE_CDS, "NO.SUCH")
    assert [(event_id, text) for event_id, _, text in bench.take_events()] == [
        (82, "'APP.T' found in Table Registry. CDS cannot be deleted until table is unregistered"),
        (87, "CDS 'APP.T' owning app is still active"),
        (38, "Successfully removed 'APP.T' from CDS"),
        (85, "Unable to locate 'APP.T' in CDS Registry"),
        (84, "Table 'NO.SUCH' is not found in Critical Table Registry"),
    ]
    values = bench.send_hk()
    assert (values["CommandCounter"], values["CommandErrorCounter"]) == (1, 4)
    after = after_reset(bench)
    assert after.tbl.register("T", 4, OPT_CRITICAL).status == CFE_SUCCESS


def test_cds_of_another_type_and_with_errors() -> None:
    bench, handle = loaded()
    bench.tbl.unregister(handle)
    bench.take_events()
    bench.store.types[NAME] = False
    bench.named(packets.DELETE_CDS, NAME)
    text = "Table 'APP.T' is in Critical Table Registry but CDS is not tagged as a table"
    assert bench.take_events() == [(83, 3, text)]
    bench.store.is_there = False
    bench.named(packets.DELETE_CDS, NAME)
    text = "Error while deleting 'APP.T' from CDS, See SysLog.(Err=0xC400FFFF)"
    assert bench.take_events() == [(86, 3, text)]
