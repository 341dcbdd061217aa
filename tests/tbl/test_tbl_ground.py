"""Commands from the ground, housekeeping, dumps (cTBL6001 and following)."""

from __future__ import annotations

import pytest

from cfepy.fs import crc16, read_header
from cfepy.msg import Command, Layout, command, get_msg_id
from cfepy.status import (
    CFE_SUCCESS,
    CFE_TBL_ERR_INVALID_HANDLE,
    CFE_TBL_INFO_DUMP_PENDING,
    CFE_TBL_INFO_NO_DUMP_PENDING,
    CFE_TBL_INFO_NO_VALIDATION_PENDING,
    CFE_TBL_INFO_UPDATE_PENDING,
    CFE_TBL_INFO_UPDATED,
    CFE_TBL_INFO_VALIDATION_PENDING,
    CfeError,
)
from cfepy.tbl import OPT_DBL_BUFFER, OPT_DUMP_ONLY, packets, read
from tests.layouts import assert_same
from tests.tbl.conftest import NOW, POOL_ID, Bench

NAME = "APP.T"


def load_file(bench: Bench, path: str = "/cf/t.tbl") -> None:
    bench.ground(packets.LOAD, LoadFilename=path)


def validate(bench: Bench, flag: int, name: str = NAME) -> None:
    bench.ground(packets.VALIDATE, ActiveTableFlag=flag, TableName=name)


def dump(bench: Bench, flag: int, path: str = "/ram/t.tbl", name: str = NAME) -> None:
    bench.ground(packets.DUMP, ActiveTableFlag=flag, TableName=name, DumpFilename=path)


@pytest.fixture
def loaded(bench: Bench) -> Bench:
    """A bench with a loaded table and a good file for it."""
    handle = bench.tbl.register("T", 4, 0, lambda image: -1 if image[0] == 0xFF else 0)
    bench.tbl.load(handle, b"old.")
    bench.put("/cf/t.tbl", NAME, b"new.")
    bench.handle = handle  # type: ignore[attr-defined]
    bench.take_events()
    return bench


@pytest.mark.parametrize(
    ("layout", "struct"),
    [
        (packets.HOUSEKEEPING, "CFE_TBL_HousekeepingTlm_Payload_t"),
        (packets.REGISTRY_PACKET, "CFE_TBL_TblRegPacket_Payload_t"),
        (packets.REGISTRY_RECORD, "CFE_TBL_RegDumpRec_t"),
    ],
    ids=["housekeeping", "registry packet", "registry record"],
)
def test_layouts_match_nasas_structures(layout: Layout, struct: str) -> None:
    assert_same(layout, struct)


def test_load_from_the_ground_updates_the_table(loaded: Bench) -> None:
    handle = loaded.handle  # type: ignore[attr-defined]
    load_file(loaded)
    where = "LoadFile,app=CFE_TBL,file=/cf/t.tbl,tbl=APP.T"
    assert loaded.take_events() == [(12, 2, f"{where}:Successful load into working buffer")]
    assert loaded.tbl.get_status(handle) == CFE_SUCCESS
    loaded.named(packets.ACTIVATE, NAME)
    assert loaded.take_events() == [
        (81, 3, "Activate,app=,tbl=APP.T:Cannot activate table, Inactive image not Validated")
    ]
    validate(loaded, packets.INACTIVE_BUFFER)
    assert loaded.tbl.get_status(handle) == CFE_TBL_INFO_VALIDATION_PENDING
    assert loaded.tbl.manage(handle) == CFE_SUCCESS
    assert loaded.take_events() == [(36, 2, "APP validation successful for inactive 'APP.T'")]
    loaded.named(packets.ACTIVATE, NAME)
    assert loaded.tbl.get_status(handle) == CFE_TBL_INFO_UPDATE_PENDING
    assert loaded.tbl.manage(handle) == CFE_TBL_INFO_UPDATED
    assert bytes(loaded.tbl.get_address(handle)[0]) == b"new."
    values = loaded.send_hk()
    assert (values["CommandCounter"], values["CommandErrorCounter"]) == (3, 1)
    assert (values["ValidationCounter"], values["SuccessValCounter"], values["NumValRequests"]) == (1, 1, 1)
    assert (values["LastValTableName"], values["LastValCrc"]) == (NAME, crc16(b"new."))
    assert (values["LastFileLoaded"], values["LastTableLoaded"]) == ("/cf/t.tbl", NAME)
    assert (values["LastUpdatedTable"], values["NumFreeSharedBufs"], values["NumTables"]) == (NAME, 4, 1)
    assert values["LastUpdateTime"] == {"Seconds": NOW[0], "Subseconds": NOW[1]}


def test_invalid_image_from_the_ground_is_never_activated(loaded: Bench) -> None:
    loaded.put("/cf/bad.tbl", NAME, b"\xff...")
    load_file(loaded, "/cf/bad.tbl")
    validate(loaded, packets.INACTIVE_BUFFER)
    loaded.take_events()
    loaded.tbl.manage(loaded.handle)  # type: ignore[attr-defined]
    assert loaded.take_events() == [(96, 3, "APP validation failed for APP.T 'inactive', Status=0xFFFFFFFF")]
    loaded.named(packets.ACTIVATE, NAME)
    assert loaded.take_events()[0][0] == 81
    values = loaded.send_hk()
    assert (values["FailedValCounter"], values["LastValStatus"], values["NumLoadPending"]) == (1, -1, 1)
    loaded.named(packets.ABORT_LOAD, NAME)
    assert loaded.take_events() == [(21, 2, "Table Load Aborted for 'APP.T'")]
    assert loaded.send_hk()["NumFreeSharedBufs"] == 4


def test_missing_inactive_image_is_reported(bench: Bench) -> None:
    bench.tbl.register("T", 4)
    validate(bench, packets.INACTIVE_BUFFER)
    bench.named(packets.ACTIVATE, NAME)
    assert bench.take_events() == [
        (80, 3, "Validate,app=,tbl=APP.T:Request had illegal buffer parameter (0x00000000)"),
        (70, 3, "Activate,app=,tbl=APP.T:Cannot activate table, No Inactive image available"),
    ]


def test_table_without_validator_is_valid(bench: Bench) -> None:
    handle = bench.tbl.register("T", 4)
    bench.put("/cf/t.tbl", NAME, b"new.")
    load_file(bench)
    bench.take_events()
    validate(bench, packets.INACTIVE_BUFFER)
    text = "Validate,app=,tbl=APP.T:No Validation Function has been registered, assumed valid"
    assert bench.take_events() == [(23, 2, text)]
    bench.named(packets.ACTIVATE, NAME)
    assert bench.tbl.manage(handle) == CFE_TBL_INFO_UPDATED


@pytest.mark.parametrize(
    "wish", [packets.SEND_REGISTRY, packets.ABORT_LOAD, packets.DUMP], ids=["reg", "abort", "dump"]
)
def test_unknown_tables_are_reported(bench: Bench, wish: Command) -> None:
    bench.named(wish, "NO.SUCH")
    assert bench.take_events() == [(57, 3, "Unable to locate 'NO.SUCH' in Table Registry")]


@pytest.mark.parametrize("wish", [packets.ACTIVATE, packets.VALIDATE], ids=["activate", "validate"])
def test_activation_and_validation_of_unknown_tables_cause_no_event(bench: Bench, wish: Command) -> None:
    bench.named(wish, "NO.SUCH")
    assert bench.take_events() == []
    assert bench.send_hk()["CommandErrorCounter"] == 1


def test_invalid_loads_from_the_ground_are_refused(loaded: Bench) -> None:
    loaded.put("/cf/x.tbl", "NO.SUCH", b"1234")
    load_file(loaded, "/cf/x.tbl")
    load_file(loaded, "/cf/none.tbl")
    load_file(loaded)
    load_file(loaded)
    assert [(event_id, text) for event_id, _, text in loaded.take_events()] == [
        (57, "LoadFile,app=CFE_TBL,file=/cf/x.tbl,tbl=[unknown]:Tbl Hdr has invalid name: 'NO.SUCH'"),
        (53, "LoadFile,app=CFE_TBL,file=/cf/none.tbl,tbl=[unknown]:Unable to open, Status = -108"),
        (12, "LoadFile,app=CFE_TBL,file=/cf/t.tbl,tbl=APP.T:Successful load into working buffer"),
        (100, "LoadFile,app=CFE_TBL,tbl=APP.T:Load already in progress"),
    ]


def test_refused_file_stays_in_progress_until_it_is_aborted(loaded: Bench) -> None:
    loaded.files["/cf/t.tbl"] = loaded.files["/cf/t.tbl"][:-1]
    load_file(loaded)
    load_file(loaded)
    assert [event_id for event_id, _, _ in loaded.take_events()] == [71, 100]
    values = loaded.send_hk()
    assert (values["NumLoadPending"], values["NumFreeSharedBufs"]) == (1, 3)
    loaded.named(packets.ABORT_LOAD, NAME)
    values = loaded.send_hk()
    assert (values["NumLoadPending"], values["NumFreeSharedBufs"]) == (0, 4)


def test_valid_files_loaded_from_the_ground_stay_open(loaded: Bench) -> None:
    loaded.files["/cf/short.tbl"] = loaded.files["/cf/t.tbl"][:70]
    load_file(loaded, "/cf/short.tbl")
    load_file(loaded)
    load_file(loaded)
    loaded.tbl.load(loaded.tbl.register("U", 4), b"data")
    assert loaded.left_open == ["/cf/t.tbl", "/cf/t.tbl"]


def test_shared_buffers_run_out() -> None:
    bench = Bench(tbl_max_simultaneous_loads=1)
    for name in "AB":
        bench.tbl.load(bench.tbl.register(name, 1), b"0")
        bench.put(f"/cf/{name}.tbl", f"APP.{name}", b"1")
        load_file(bench, f"/cf/{name}.tbl")
    text = "LoadFile,app=CFE_TBL,tbl=APP.B:No working buffers available, stat=0xffffffffcc00000f"
    assert bench.take_events()[-1] == (60, 3, text)


def test_single_buffered_table_can_be_dumped_after_its_second_load(loaded: Bench) -> None:
    dump(loaded, packets.ACTIVE_BUFFER)
    values = loaded.send_hk()
    assert (loaded.take_events(), values["CommandErrorCounter"], values["NumFreeSharedBufs"]) == ([], 1, 4)
    loaded.tbl.load(loaded.handle, b"2nd.")  # type: ignore[attr-defined]
    dump(loaded, packets.ACTIVE_BUFFER)
    loaded.send_hk()
    assert read(loaded.files["/ram/t.tbl"]).data == b"2nd."


def test_failed_dumps_occupy_their_dump_slots(loaded: Bench) -> None:
    for _ in range(4):
        dump(loaded, packets.ACTIVE_BUFFER)
    loaded.take_events()
    loaded.tbl.load(loaded.handle, b"2nd.")  # type: ignore[attr-defined]
    loaded.take_events()
    dump(loaded, packets.ACTIVE_BUFFER)
    text = "Dump,table=APP.T,app=,file=/ram/t.tbl:Too many table dumps have been requested"
    assert loaded.take_events() == [(76, 3, text)]


def test_dump_of_an_ordinary_table(loaded: Bench) -> None:
    loaded.tbl.load(loaded.handle, b"old.")  # type: ignore[attr-defined]
    loaded.take_events()
    dump(loaded, packets.ACTIVE_BUFFER)
    assert "/ram/t.tbl" not in loaded.files
    values = loaded.send_hk()
    assert values["NumFreeSharedBufs"] == 3
    where = "Dump,table=[unknown],app=,file=/ram/t.tbl"
    assert loaded.take_events() == [(14, 2, f"{where}:Successfully dumped table")]
    image = read(loaded.files["/ram/t.tbl"])
    assert (image.name, image.data, image.time, image.description) == (NAME, b"old.", NOW, "Table Dump Image")
    dump(loaded, packets.ACTIVE_BUFFER)
    loaded.send_hk()
    assert loaded.take_events() == [(13, 2, f"{where}:Successfully overwrote table dump")]
    values = loaded.send_hk()
    assert (values["LastFileDumped"], values["NumFreeSharedBufs"]) == ("/ram/t.tbl", 4)


def test_dump_of_a_dump_only_table_waits_for_its_owner(bench: Bench) -> None:
    handle = bench.tbl.register("T", 4, OPT_DUMP_ONLY)
    bench.tbl.get_address(handle)[0][:] = b"live"
    dump(bench, packets.ACTIVE_BUFFER)
    dump(bench, packets.ACTIVE_BUFFER)
    assert bench.take_events()[0][::2] == (77, "Dump,table=APP.T,app=,file=/ram/t.tbl:A dump is already pending")
    bench.send_hk()
    assert "/ram/t.tbl" not in bench.files
    assert bench.tbl.get_status(handle) == CFE_TBL_INFO_DUMP_PENDING
    assert bench.tbl.manage(handle) == CFE_SUCCESS
    assert bench.tbl.get_status(handle) == CFE_TBL_INFO_DUMP_PENDING
    with pytest.raises(CfeError) as taken_already:
        bench.tbl.dump_to_buffer(handle)
    assert taken_already.value.status == CFE_TBL_ERR_INVALID_HANDLE
    bench.take_events()
    bench.send_hk()  # cFE never learns how much an app puts into a dump-only table
    text = "Dump,table=[unknown],app=,file=/ram/t.tbl:Error writing Tbl image, Status=-40"
    assert bench.take_events() == [(65, 3, text)]
    assert bench.tbl.dump_to_buffer(handle) == CFE_TBL_INFO_NO_DUMP_PENDING
    assert bench.tbl.get_status(handle) == CFE_SUCCESS
    assert "had stale dump request pending" in bench.log[-1]


def test_invalid_dumps_are_refused(loaded: Bench) -> None:
    dump(loaded, packets.INACTIVE_BUFFER)
    dump(loaded, 7)
    loaded.tbl.load(loaded.handle, b"2nd.")  # type: ignore[attr-defined]
    loaded.events = [event for event in loaded.events if event[0] != 35]
    dump(loaded, packets.ACTIVE_BUFFER, path="nowhere")
    loaded.send_hk()
    dump(loaded, packets.ACTIVE_BUFFER, name="NO.SUCH")
    assert [(event_id, text.rpartition(":")[2]) for event_id, _, text in loaded.take_events()] == [
        (80, "Cmd had illegal buffer parameter (0x00000000)"),
        (80, "Cmd had illegal buffer parameter (0x00000007)"),
        (62, "Error creating dump file, Status=-108"),
        (57, "Unable to locate 'NO.SUCH' in Table Registry"),
    ]
    for _ in range(5):
        dump(loaded, packets.ACTIVE_BUFFER)
    assert loaded.take_events()[0][0] == 76


def test_previous_image_of_a_double_buffered_table_can_be_dumped(bench: Bench) -> None:
    handle = bench.tbl.register("T", 4, OPT_DBL_BUFFER)
    bench.tbl.load(handle, b"one.")
    bench.tbl.load(handle, b"two.")
    dump(bench, packets.INACTIVE_BUFFER)
    bench.send_hk()
    assert read(bench.files["/ram/t.tbl"]).data == b"one."


def test_cleanup_drops_the_dumps_of_an_app_but_not_their_buffers(bench: Bench) -> None:
    bench.tbl.register("T", 4, OPT_DUMP_ONLY)
    dump(bench, packets.ACTIVE_BUFFER)
    bench.tbl.cleanup_app(0x110006)
    values = bench.send_hk()
    assert (values["NumTables"], values["NumFreeSharedBufs"]) == (0, 3)


def test_notification_of_the_owner(loaded: Bench) -> None:
    loaded.tbl.notify_by_message(loaded.handle, 0x1882, 5, 0xCAFE)  # type: ignore[attr-defined]
    load_file(loaded)
    loaded.take_events()
    validate(loaded, packets.INACTIVE_BUFFER)
    assert loaded.take_events() == [(16, 1, "Tbl Services issued validation request for 'APP.T'")]
    assert loaded.sent[-1] == bytes(command(0x1882, 5, (0xCAFE).to_bytes(4, "little")))


def test_active_image_can_be_validated(loaded: Bench) -> None:
    handle = loaded.handle  # type: ignore[attr-defined]
    validate(loaded, packets.ACTIVE_BUFFER)
    loaded.tbl.manage(handle)
    assert loaded.take_events() == [(36, 2, "APP validation successful for active 'APP.T'")]
    assert loaded.send_hk()["ActiveBuffer"] is True
    assert loaded.tbl.validate(handle) == CFE_TBL_INFO_NO_VALIDATION_PENDING


def test_registry_packet_is_sent_once(loaded: Bench) -> None:
    loaded.named(packets.SEND_REGISTRY, NAME)
    loaded.send_hk()
    assert [get_msg_id(packet) for packet in loaded.sent] == [packets.HK_TLM_MID, packets.REG_TLM_MID]
    values = packets.REGISTRY_PACKET.unpack(loaded.sent[1][16:])
    assert (values["Name"], values["OwnerAppName"], values["Size"]) == (NAME, "APP", 4)
    assert (values["Crc"], values["TableLoadedOnce"], values["LoadPending"]) == (crc16(b"old."), True, False)
    loaded.send_hk()
    assert len(loaded.sent) == 1


def test_registry_packet_of_a_removed_table_is_empty(loaded: Bench) -> None:
    loaded.named(packets.SEND_REGISTRY, NAME)
    loaded.tbl.cleanup_app(0x110006)
    loaded.send_hk()
    assert packets.REGISTRY_PACKET.unpack(loaded.sent[1][16:])["Name"] == ""


def test_registry_file(loaded: Bench) -> None:
    loaded.tbl.register("U", 8, OPT_DUMP_ONLY)
    for _ in range(2):
        loaded.ground(packets.DUMP_REGISTRY)
        loaded.background()
    loaded.ground(packets.DUMP_REGISTRY, DumpFilename="/ram/none/x.log")
    loaded.background()
    size = 64 + 2 * packets.REGISTRY_RECORD.size
    assert loaded.take_events() == [
        (22, 1, f"Successfully dumped Table Registry to '/ram/cfe_tbl_reg.log':Size={size},Entries=128"),
        (15, 1, f"Successfully overwrote '/ram/cfe_tbl_reg.log' with Table Registry:Size={size},Entries=128"),
        (62, 3, "Error creating dump file '/ram/none/x.log', Status=0xFFFFFFE5"),
    ]
    data = loaded.files["/ram/cfe_tbl_reg.log"]
    assert (read_header(data).subtype, read_header(data).description) == (9, "Table Registry")
    record = packets.REGISTRY_RECORD.unpack(data, 64)
    assert (record["Name"], record["LoadInProgress"], record["NumUsers"]) == (NAME, -1, 1)


def test_other_commands_are_counted(bench: Bench) -> None:
    bench.ground(packets.NOOP)
    bench.receive(bytes(command(packets.CMD_MID, 99)))
    bench.receive(bytes(command(packets.CMD_MID, 0, b"x")))
    bench.receive(bytes(command(0x1999, 0)))
    bench.tbl.register("T", 4)
    bench.named(packets.DELETE_CDS, NAME)
    bench.named(packets.DELETE_CDS, "NO.SUCH")
    events = bench.take_events()
    assert events[0][2].startswith("No-op Cmd Rcvd: CFE_TBL v")
    assert [(event_id, text) for event_id, _, text in events[1:]] == [
        (51, "Invalid command code -- ID = 0x1804, CC = 99"),
        (52, "Invalid msg length -- ID = 0x1804, CC = 0, Len = 9, Expected = 8"),
        (50, "Invalid message ID -- ID = 0x1999"),
        (82, "'APP.T' found in Table Registry. CDS cannot be deleted until table is unregistered"),
        (84, "Table 'NO.SUCH' is not found in Critical Table Registry"),
    ]
    assert bench.send_hk()["CommandErrorCounter"] == 3
    bench.ground(packets.RESET_COUNTERS)
    assert bench.take_events() == [(11, 1, "Reset Counters command")]
    assert bench.send_hk()["CommandErrorCounter"] == 0


def test_pool_is_made_at_early_init(bench: Bench) -> None:
    assert bench.pools == [(524288, "CFE_TBL")]
    assert bench.send_hk()["MemPoolHandle"] == POOL_ID
    assert bench.table_pool.statistics()["NumBlocksRequested"] == 4


@pytest.mark.parametrize(("version", "told"), [("7.0.0", b"Xld."), ("7.0.1", b"old.")])
def test_validation_reports_the_crc(version: str, told: bytes) -> None:
    loaded = Bench(cfe_version=version)
    handle = loaded.tbl.register("T", 4, 0, lambda image: 0)
    loaded.tbl.load(handle, b"old.")
    loaded.tbl.get_address(handle)[0][0] = ord("X")
    validate(loaded, packets.ACTIVE_BUFFER)
    loaded.tbl.manage(handle)
    assert loaded.send_hk()["LastValCrc"] == crc16(told)
    assert loaded.tbl.get_info(NAME).crc == crc16(b"old.")
