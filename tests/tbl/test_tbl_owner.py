"""Registering, loading and updating tables by an app (cTBL6000 and following)."""

from __future__ import annotations

import pytest

from cfepy.fs import crc16
from cfepy.status import (
    CFE_ES_ERR_MEM_BLOCK_SIZE,
    CFE_ES_ERR_RESOURCEID_NOT_VALID,
    CFE_STATUS_VALIDATION_FAILURE,
    CFE_SUCCESS,
    CFE_TBL_ERR_ACCESS,
    CFE_TBL_ERR_BAD_PROCESSOR_ID,
    CFE_TBL_ERR_BAD_SPACECRAFT_ID,
    CFE_TBL_ERR_DUMP_ONLY,
    CFE_TBL_ERR_DUPLICATE_DIFF_SIZE,
    CFE_TBL_ERR_DUPLICATE_NOT_OWNED,
    CFE_TBL_ERR_FILE_FOR_WRONG_TABLE,
    CFE_TBL_ERR_FILE_TOO_LARGE,
    CFE_TBL_ERR_HANDLES_FULL,
    CFE_TBL_ERR_ILLEGAL_SRC_TYPE,
    CFE_TBL_ERR_INVALID_HANDLE,
    CFE_TBL_ERR_INVALID_NAME,
    CFE_TBL_ERR_INVALID_OPTIONS,
    CFE_TBL_ERR_INVALID_SIZE,
    CFE_TBL_ERR_LOAD_IN_PROGRESS,
    CFE_TBL_ERR_LOAD_INCOMPLETE,
    CFE_TBL_ERR_NEVER_LOADED,
    CFE_TBL_ERR_NO_ACCESS,
    CFE_TBL_ERR_NO_BUFFER_AVAIL,
    CFE_TBL_ERR_NO_STD_HEADER,
    CFE_TBL_ERR_NO_TBL_HEADER,
    CFE_TBL_ERR_PARTIAL_LOAD,
    CFE_TBL_ERR_REGISTRY_FULL,
    CFE_TBL_ERR_UNREGISTERED,
    CFE_TBL_INFO_NO_UPDATE_PENDING,
    CFE_TBL_INFO_TABLE_LOCKED,
    CFE_TBL_INFO_UPDATED,
    CFE_TBL_WARN_DUPLICATE,
    CFE_TBL_WARN_PARTIAL_LOAD,
    CFE_TBL_WARN_SHORT_FILE,
    CfeError,
)
from cfepy.tbl import (
    OPT_CRITICAL,
    OPT_DBL_BUFFER,
    OPT_DUMP_ONLY,
    OPT_USR_DEF_ADDR,
    TableImage,
    build,
    mark_for,
    mark_in,
    with_mark,
)
from tests.tbl.conftest import NOW, Bench


def content(bench: Bench, handle: int) -> bytes:
    data = bytes(bench.tbl.get_address(handle)[0])
    bench.tbl.release_address(handle)
    return data


def failure(call: object, *args: object, **more: object) -> int:
    with pytest.raises(CfeError) as caught:
        call(*args, **more)  # type: ignore[operator]
    return caught.value.status


def test_first_load_updates_the_active_buffer(bench: Bench) -> None:
    handle = bench.tbl.register("T", 4)
    assert failure(bench.tbl.get_address, handle) == CFE_TBL_ERR_NEVER_LOADED
    bench.put("/cf/t.tbl", "APP.T", b"abcd")
    assert bench.tbl.load(handle, "/cf/t.tbl") == CFE_SUCCESS
    assert bench.take_events() == [(35, 1, "Successfully loaded 'APP.T' from '/cf/t.tbl'")]
    view, updated = bench.tbl.get_address(handle)
    assert (bytes(view), updated) == (b"abcd", True)
    assert bench.tbl.get_address(handle)[1] is False
    info = bench.tbl.get_info("APP.T")
    assert (info.size, info.crc, info.num_users, info.table_loaded_once) == (4, crc16(b"abcd"), 1, True)
    assert (info.last_file_loaded, info.time_of_last_update) == ("/cf/t.tbl", NOW)


def test_second_load_is_an_information_event(bench: Bench) -> None:
    handle = bench.tbl.register("T", 4)
    bench.tbl.load(handle, b"1234")
    bench.take_events()
    bench.tbl.load(handle, b"5678")
    (event,) = bench.take_events()
    assert event[:2] == (35, 2)
    assert content(bench, handle) == b"5678"


@pytest.mark.parametrize(
    ("name", "size", "options", "status"),
    [
        ("", 4, 0, CFE_TBL_ERR_INVALID_NAME),
        ("x" * 16, 4, 0, CFE_TBL_ERR_INVALID_NAME),
        ("T", 0, 0, CFE_TBL_ERR_INVALID_SIZE),
        ("T", 16385, 0, CFE_TBL_ERR_INVALID_SIZE),
        ("T", 16385, OPT_DBL_BUFFER, CFE_TBL_ERR_INVALID_SIZE),
        ("T", 4, OPT_DUMP_ONLY | OPT_DBL_BUFFER, CFE_TBL_ERR_INVALID_OPTIONS),
        ("T", 4, OPT_USR_DEF_ADDR | OPT_DBL_BUFFER, CFE_TBL_ERR_INVALID_OPTIONS),
        ("T", 4, OPT_USR_DEF_ADDR & ~OPT_DUMP_ONLY, CFE_TBL_ERR_INVALID_OPTIONS),
        ("T", 4, OPT_DUMP_ONLY | OPT_CRITICAL, CFE_TBL_ERR_INVALID_OPTIONS),
    ],
)
def test_bad_registration(bench: Bench, name: str, size: int, options: int, status: int) -> None:
    assert failure(bench.tbl.register, name, size, options) == status
    (event,) = bench.take_events()
    assert event == (90, 3, f"APP Failed to Register table '{name}', Status=0x{status & 0xFFFFFFFF:08X}")


def test_duplicates(bench: Bench) -> None:
    handle = bench.tbl.register("T", 4)
    again = bench.tbl.register("T", 4)
    assert (again, again.status, handle.status) == (handle, CFE_TBL_WARN_DUPLICATE, CFE_SUCCESS)
    assert failure(bench.tbl.register, "T", 8) == CFE_TBL_ERR_DUPLICATE_DIFF_SIZE
    bench.tbl.registry.by_name("APP.T").owner = 0x110007
    assert failure(bench.tbl.register, "T", 4) == CFE_TBL_ERR_DUPLICATE_NOT_OWNED


def test_full_limits_leave_no_entries() -> None:
    shared, small = 4 * (32 + 16384), 32 + 48
    bench = Bench(tbl_max_num_tables=2, tbl_max_num_handles=3, tbl_buf_memory_bytes=shared + 2 * small)
    bench.tbl.register("A", 40)
    assert failure(bench.tbl.register, "BIG", 200) == CFE_ES_ERR_MEM_BLOCK_SIZE
    bench.tbl.register("B", 40)
    assert failure(bench.tbl.register, "C", 1) == CFE_TBL_ERR_REGISTRY_FULL
    bench.tbl.share("APP.A")
    assert failure(bench.tbl.share, "APP.A") == CFE_TBL_ERR_HANDLES_FULL


def test_access_to_a_table_depends_on_the_application(bench: Bench) -> None:
    handle = bench.tbl.register("T", 4)
    bench.tbl.load(handle, b"1234")
    bench.as_app("OTHER")
    assert failure(bench.tbl.get_address, handle) == CFE_TBL_ERR_NO_ACCESS
    assert bench.log[-1] == "CFE_TBL_GetAddress: Bad AppId=1114119"
    shared = bench.tbl.share("APP.T")
    assert bench.tbl.get_address(shared)[1] is True
    bench.take_events()
    assert failure(bench.tbl.load, shared, b"5678") == CFE_TBL_ERR_NO_ACCESS
    assert failure(bench.tbl.load, 99, b"5678") == CFE_TBL_ERR_INVALID_HANDLE
    assert bench.take_events() == [
        (103, 3, "Load,app=OTHER,tbl=APP.T:No access to Tbl Handle"),
        (57, 3, "Load,app=OTHER,tbl=[unknown]:Unable to locate in Table Registry"),
    ]
    assert failure(bench.tbl.get_address, 99) == CFE_TBL_ERR_INVALID_HANDLE
    assert failure(bench.tbl.share, "APP.NO") == CFE_TBL_ERR_INVALID_NAME
    bench.as_app("CFE_TBL")
    assert bench.tbl.get_status(handle) == CFE_SUCCESS
    bench.as_app(None)
    assert failure(bench.tbl.register, "T", 4) == CFE_ES_ERR_RESOURCEID_NOT_VALID


def test_shared_table_exists_until_its_last_user_unregisters(bench: Bench) -> None:
    handle = bench.tbl.register("T", 4)
    bench.tbl.load(handle, b"1234")
    bench.as_app("OTHER")
    shared = bench.tbl.share("APP.T")
    bench.tbl.cleanup_app(0x110006)
    assert failure(bench.tbl.get_address, shared) == CFE_TBL_ERR_UNREGISTERED
    assert len(bench.tbl.registry.tables) == 1
    bench.tbl.unregister(shared)
    assert len(bench.tbl.registry.tables) == 0
    assert failure(bench.tbl.unregister, shared) == CFE_TBL_ERR_INVALID_HANDLE


FILE_FAULTS = [
    ("/cf/none.tbl", CFE_TBL_ERR_ACCESS, 53, "tbl=APP.T:Unable to open, Status = -108"),
    ("/cf/tiny.tbl", CFE_TBL_ERR_NO_STD_HEADER, 54, "tbl=APP.T:Unable to read std header, Status = 0xc8000005"),
    ("/cf/half.tbl", CFE_TBL_ERR_NO_TBL_HEADER, 55, "tbl=APP.T:Unable to read tbl header, Status = 0x0000000a"),
    ("/cf/wrong.tbl", CFE_TBL_ERR_FILE_FOR_WRONG_TABLE, 102, "tbl=APP.T:File for wrong table 'APP.X'"),
    ("/cf/empty.tbl", CFE_TBL_ERR_NO_TBL_HEADER, 73, "tbl=APP.T:Table header indicates no data in file"),
    ("/cf/part.tbl", CFE_TBL_ERR_PARTIAL_LOAD, 74, "tbl=APP.T:partial load for uninitialized table"),
    ("/cf/long.tbl", CFE_TBL_ERR_FILE_TOO_LARGE, 72, "tbl=APP.T:Cannot load 5 at off 0"),
    ("/cf/cut.tbl", CFE_TBL_ERR_LOAD_INCOMPLETE, 71, "tbl=APP.T:Incomplete load into working buffer"),
    ("/cf/more.tbl", CFE_TBL_ERR_FILE_TOO_LARGE, 75, "tbl=APP.T:File has more data than Tbl Hdr indicates (4)"),
]


@pytest.mark.parametrize(("path", "status", "event_id", "text"), FILE_FAULTS)
def test_invalid_files_are_refused(bench: Bench, path: str, status: int, event_id: int, text: str) -> None:
    bench.put("/cf/good.tbl", "APP.T", b"abcd")
    good = bench.files["/cf/good.tbl"]
    bench.files |= {
        "/cf/tiny.tbl": b"cFE",
        "/cf/half.tbl": good[:74],
        "/cf/empty.tbl": good[:72] + bytes(4) + good[76:],
        "/cf/cut.tbl": good[:-1],
        "/cf/more.tbl": good + b"e",
    }
    bench.put("/cf/wrong.tbl", "APP.X", b"abcd")
    bench.put("/cf/part.tbl", "APP.T", b"ab", offset=2)
    bench.put("/cf/long.tbl", "APP.T", b"abcde")
    handle = bench.tbl.register("T", 4)
    assert failure(bench.tbl.load, handle, path) == status
    assert bench.take_events() == [(event_id, 3, f"LoadFile,app=APP,file={path},{text}")]
    assert bench.tbl.load(handle, "/cf/good.tbl") == CFE_SUCCESS


def test_short_and_partial_files_keep_the_remaining_bytes(bench: Bench) -> None:
    handle = bench.tbl.register("T", 6)
    bench.put("/cf/short.tbl", "APP.T", b"ab")
    bench.put("/cf/part.tbl", "APP.T", b"XY", offset=3)
    assert bench.tbl.load(handle, "/cf/short.tbl") == CFE_TBL_WARN_SHORT_FILE
    bench.tbl.load(handle, b"123456")
    assert bench.tbl.load(handle, "/cf/part.tbl") == CFE_TBL_WARN_PARTIAL_LOAD
    assert content(bench, handle) == b"123XY6"
    assert failure(bench.tbl.load, handle, b"12") == CFE_TBL_ERR_LOAD_INCOMPLETE


def test_validator_can_refuse_an_image(bench: Bench) -> None:
    handle = bench.tbl.register("T", 4, 0, lambda image: -7 if image[0] == 0xFF else 0)
    bench.tbl.load(handle, b"good")
    bench.take_events()
    assert failure(bench.tbl.load, handle, b"\xffbad") == -7
    assert bench.take_events() == [
        (96, 3, "Load,app=APP,tbl=APP.T:Validation func reports table invalid (Stat=fffffffffffffff9)")
    ]
    assert content(bench, handle) == b"good"
    assert not bench.tbl.registry.by_name("APP.T").is_loading


def test_positive_result_of_a_validator_is_a_failure(bench: Bench) -> None:
    handle = bench.tbl.register("T", 4, 0, lambda image: 1)
    assert failure(bench.tbl.load, handle, b"1234") == CFE_STATUS_VALIDATION_FAILURE
    assert [event[0] for event in bench.take_events()] == [93, 96]


def test_validator_that_raises_does_not_change_the_table(bench: Bench) -> None:
    def broken(image: memoryview) -> int:
        raise ZeroDivisionError

    handle = bench.tbl.register("T", 4, 0, broken)
    with pytest.raises(ZeroDivisionError):
        bench.tbl.load(handle, b"1234")
    assert not bench.tbl.registry.by_name("APP.T").is_loading


def test_double_buffer_switches_under_a_reader(bench: Bench) -> None:
    handle = bench.tbl.register("T", 4, OPT_DBL_BUFFER)
    bench.tbl.load(handle, b"old.")
    old, _ = bench.tbl.get_address(handle)
    assert bench.tbl.load(handle, b"new.") == CFE_SUCCESS
    assert bytes(old) == b"old."
    assert bench.tbl.get_address(handle)[1] is True
    assert content(bench, handle) == b"new."


def test_double_buffer_has_no_third_buffer(bench: Bench) -> None:
    handle = bench.tbl.register("T", 4, OPT_DBL_BUFFER)
    bench.tbl.load(handle, b"one.")
    bench.tbl.get_address(handle)
    bench.tbl.load(handle, b"two.")
    bench.take_events()
    assert failure(bench.tbl.load, handle, b"tri.") == CFE_TBL_ERR_NO_BUFFER_AVAIL
    assert bench.take_events() == [
        (60, 3, "Load,app=APP,tbl=APP.T:No working buffers available, stat=0xffffffffcc00000f")
    ]
    assert "Inactive Buff Locked for 'APP.T' by AppId=1114118" in bench.log[-1]
    assert bench.tbl.release_address(handle) == CFE_TBL_INFO_UPDATED
    assert bench.tbl.load(handle, b"tri.") == CFE_SUCCESS


def test_single_buffer_waits_for_the_reader(bench: Bench) -> None:
    handle = bench.tbl.register("T", 4)
    bench.tbl.load(handle, b"1st.")
    bench.tbl.get_address(handle)
    assert bench.tbl.load(handle, b"old.") == CFE_SUCCESS  # the buffer of the first load has no id to be locked by
    bench.tbl.release_address(handle)
    view, _ = bench.tbl.get_address(handle)
    bench.take_events()
    assert bench.tbl.load(handle, b"new.") == CFE_TBL_INFO_TABLE_LOCKED
    assert bench.take_events()[0][0] == 95
    assert bytes(view) == b"old."
    assert bench.tbl.manage(handle) == CFE_TBL_INFO_TABLE_LOCKED
    assert failure(bench.tbl.load, handle, b"3rd.") == CFE_TBL_ERR_LOAD_IN_PROGRESS
    bench.tbl.release_address(handle)
    bench.take_events()
    assert bench.tbl.manage(handle) == CFE_TBL_INFO_UPDATED
    assert bench.take_events() == [(37, 2, "APP Successfully Updated 'APP.T'")]
    assert content(bench, handle) == b"new."
    assert bench.tbl.update(handle) == CFE_TBL_INFO_NO_UPDATE_PENDING


def test_modified_table_is_reported_to_other_users(bench: Bench) -> None:
    handle = bench.tbl.register("T", 4)
    bench.tbl.load(handle, b"1234")
    content(bench, handle)
    bench.as_app("OTHER")
    shared = bench.tbl.share("APP.T")
    content(bench, shared)
    bench.as_app("APP")
    view, _ = bench.tbl.get_address(handle)
    view[0] = ord("X")
    bench.tbl.modified(handle)
    bench.tbl.release_address(handle)
    assert bench.tbl.get_info("APP.T").last_file_loaded.endswith("(*)")
    assert bench.tbl.get_info("APP.T").crc == crc16(b"X234")
    assert bench.tbl.get_address(handle)[1] is False
    bench.as_app("OTHER")
    assert bench.tbl.get_address(shared)[1] is True


def test_dump_only_tables(bench: Bench) -> None:
    handle = bench.tbl.register("T", 4, OPT_DUMP_ONLY)
    view, updated = bench.tbl.get_address(handle)
    assert (bytes(view), updated) == (bytes(4), False)
    assert failure(bench.tbl.load, handle, b"1234") == CFE_TBL_ERR_DUMP_ONLY


def test_table_at_an_address_of_the_app(bench: Bench) -> None:
    handle = bench.tbl.register("T", 4, OPT_USR_DEF_ADDR)
    assert failure(bench.tbl.load, handle, "/cf/t.tbl") == CFE_TBL_ERR_ILLEGAL_SRC_TYPE
    mine = bytearray(b"1234")
    assert bench.tbl.load(handle, mine) == CFE_SUCCESS
    mine[0] = ord("X")
    assert content(bench, handle) == b"X234"
    assert failure(bench.tbl.load, handle, mine) == CFE_TBL_ERR_DUMP_ONLY


def test_several_addresses_are_returned_together_or_not_at_all(bench: Bench) -> None:
    first, second = bench.tbl.register("A", 1), bench.tbl.register("B", 1)
    bench.tbl.load(first, b"a")
    assert failure(bench.tbl.get_addresses, [first, second]) == CFE_TBL_ERR_NEVER_LOADED
    bench.tbl.load(second, b"b")
    assert [bytes(view) for view, _ in bench.tbl.get_addresses([first, second])] == [b"a", b"b"]
    assert bench.tbl.release_addresses([first, second]) == CFE_SUCCESS
    assert bench.tbl.load(first, b"c") == CFE_SUCCESS


def test_handle_ids(bench: Bench) -> None:
    handle = bench.tbl.register("A", 1)
    assert bench.tbl.handle_from_id(bench.tbl.handle_to_id(handle)) == handle
    assert bench.tbl.handle_from_id(0) == -1
    assert bench.tbl.handle_to_id(-1) == 0
    assert bench.tbl.handle_id_is_defined(handle)
    assert not bench.tbl.handle_id_is_defined(0)
    assert bench.tbl.handle_id_is_equal(handle, bench.tbl.handle_id_as_int(handle))


def test_files_for_other_spacecraft_are_refused_when_configured() -> None:
    bench = Bench(tbl_valid_scid=(0x42, 0x43), tbl_valid_prid=(1,))
    handle = bench.tbl.register("T", 4)
    bench.put("/cf/t.tbl", "APP.T", b"abcd")
    assert bench.tbl.load(handle, "/cf/t.tbl") == CFE_SUCCESS
    bench.take_events()
    bench.files["/cf/s.tbl"] = build(TableImage("APP.T", b"abcd", spacecraft_id=0x44))
    assert failure(bench.tbl.load, handle, "/cf/s.tbl") == CFE_TBL_ERR_BAD_SPACECRAFT_ID
    bench.files["/cf/p.tbl"] = build(TableImage("APP.T", b"abcd", processor_id=2))
    assert failure(bench.tbl.load, handle, "/cf/p.tbl") == CFE_TBL_ERR_BAD_PROCESSOR_ID
    where = "LoadFile,app=APP,file=/cf/{}.tbl,tbl=APP.T:"
    assert bench.take_events() == [
        (97, 3, where.format("s") + "Invalid Spacecraft ID (0x00000044)"),
        (98, 3, where.format("p") + "Invalid Processor ID (0x00000002)"),
    ]


def test_file_with_a_wrong_mark_is_refused(bench: Bench) -> None:
    handle = bench.tbl.register("T", 4)
    good = with_mark(build(TableImage("APP.T", b"abcd")))
    bench.files["/cf/t.tbl"] = good
    assert bench.tbl.load(handle, "/cf/t.tbl") == CFE_SUCCESS
    bench.take_events()
    bench.files["/cf/t.tbl"] = good[:-1] + b"e"
    assert failure(bench.tbl.load, handle, "/cf/t.tbl") == CFE_STATUS_VALIDATION_FAILURE
    text = f"File is damaged, mark = 0x{mark_in(good):08x}, expected 0x{mark_for(good[:-1] + b'e'):08x}"
    assert bench.take_events() == [(61, 3, f"LoadFile,app=APP,file=/cf/t.tbl,tbl=APP.T:{text}")]


def test_addresses_of_several_tables_are_returned_as_in_c(bench: Bench) -> None:
    first, second, third = (bench.tbl.register(name, 1) for name in ("A", "B", "C"))
    bench.tbl.load(first, b"a")
    bench.tbl.load(third, b"c", address=0x1234)
    assert bench.tbl.get_info("APP.C").last_file_loaded == "Addr 0x00001234"
    images, status = bench.tbl.get_addresses_in_c([first, second, -1, third])
    assert [None if image is None else bytes(image) for image in images] == [b"a", None, None, b"c"]
    assert status == CFE_TBL_INFO_UPDATED  # of the first one
    assert bench.tbl.get_addresses_in_c([second, third])[1] == CFE_TBL_ERR_NEVER_LOADED


def test_unknown_source_type_is_refused(bench: Bench) -> None:
    table = bench.tbl.register("A", 1)
    assert failure(bench.tbl.load, table, b"a", source_type=-1) == CFE_TBL_ERR_ILLEGAL_SRC_TYPE
    assert "Attempted to load from illegal source type=-1" in bench.events[-1][2]


def test_tables_keep_copies_of_memory_that_is_freed(bench: Bench) -> None:
    single = bench.tbl.register("A", 1)
    own = bytearray(b"mine")
    user = bench.tbl.register("B", 4, OPT_USR_DEF_ADDR)
    bench.tbl.load(single, b"a")
    bench.tbl.load(user, own)
    image, _ = bench.tbl.get_address(single)
    bench.tbl.leave_memory(lambda data: True)
    image[0], own[0] = 0, 0
    assert bytes(bench.tbl.get_address(single)[0]) == b"a"
    assert bytes(bench.tbl.get_address(user)[0]) == b"mine"
