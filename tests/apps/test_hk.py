"""HK: combined packets from recorded telemetry, commands, table updates, and its reports of failures."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from apps.hk import COMMANDS, TABLES, HK_AppMain, packets, run
from apps.hk import TELEMETRY as TLM
from apps.hk.combined import combined_telemetry
from apps.hk.copy_table import find_fault
from apps.hk.tables import hk_cpy_tbl
from cfepy.es import APP_ERROR, APP_EXIT
from cfepy.msg import Layout, Telemetry, get_msg_id, get_size, telemetry
from cfepy.status import (
    CFE_SB_BAD_ARGUMENT,
    CFE_SB_PIPE_RD_ERR,
    CFE_SUCCESS,
    CFE_TBL_ERR_ACCESS,
    CFE_TBL_ERR_INVALID_HANDLE,
    CFE_TBL_INFO_DUMP_PENDING,
    CFE_TBL_INFO_UPDATE_PENDING,
    CFE_TBL_INFO_VALIDATION_PENDING,
    CfeError,
)
from cfepy.tbl import TableImage, build, read
from cfepy.tbl import packets as tbl_packets
from tests.apps.conftest import APPS, POOL_ID, AppBench, cmd
from tests.declared import assert_as_recorded, assert_complete
from tests.layouts import assert_same

DATA = Path(__file__).parents[1] / "data"
TELEMETRY = {
    packet["mid"]: bytes.fromhex(packet["hex"])
    for packet in json.loads((DATA / "packets.json").read_text(encoding="utf-8"))["telemetry"]
}
COPY_TABLE = packets.COPY_TABLE
SEND_1 = packets.SEND_COMBINED_PKT.packet(OutMsgToSend=0x089C)
SEND_HK = packets.SEND_HK.packet()
CORE = hk_cpy_tbl.CORE_HK_MIDS


@pytest.fixture
def hk() -> AppBench:
    bench = AppBench("HK")
    bench.events.clear()
    return bench


def own(bench: AppBench) -> list[tuple[int, int, str]]:
    """Return HK's own events, without those of Table Services."""
    return [event for event in bench.events if not event[2].startswith(("Successfully loaded", "HK Successfully"))]


def table(*rows: tuple[int, int, int, int, int]) -> bytes:
    keys = packets.COPY_TABLE_ENTRY.fields
    return packets.COPY_TABLE.pack([dict(zip(keys, row, strict=True)) for row in rows])


@pytest.mark.parametrize(
    ("layout", "struct"),
    [
        (packets.HOUSEKEEPING, "HK_HkTlm_Payload_t"),
        (packets.COPY_TABLE_ENTRY, "HK_CopyTableEntry_t"),
        (packets.RUNTIME_TABLE_ENTRY, "HK_RuntimeTableEntry_t"),
        (packets.SEND_COMBINED_PKT_PAYLOAD, "HK_SendCombinedPkt_Payload_t"),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_layouts_match_nasas_structures(layout: Layout, struct: str) -> None:
    assert_same(layout, struct)


def test_declarations_are_complete_and_as_recorded() -> None:
    assert_complete(packets)
    assert_as_recorded(packets, 4)


def test_all_packets_are_declared() -> None:
    assert [(command.name, command.msg_id, command.code, command.length) for command in COMMANDS] == [
        ("HK_NOOP", 0x189A, 0, 8),
        ("HK_RESET_COUNTERS", 0x189A, 1, 8),
        ("HK_SEND_HK", 0x189B, None, 8),
        ("HK_SEND_COMBINED_PKT", 0x189C, None, 12),
    ]
    assert [(telemetry.name, telemetry.msg_id, telemetry.length) for telemetry in TLM] == [("HK_HK_TLM", 0x089B, 28)]
    assert [(table.name, table.size) for table in TABLES] == [("HK.CopyTable", 2048), ("HK.RuntimeTable", 2048)]


def test_shipped_table_matches_its_definition() -> None:
    assert (APPS / "hk/tables/hk_cpy_tbl.tbl").read_bytes() == build(hk_cpy_tbl.image())


def test_table_of_nasa_has_the_same_shape() -> None:
    nasa = read((DATA / "hk_cpy_tbl.tbl").read_bytes())
    assert (nasa.name, len(nasa.data)) == ("HK.CopyTable", len(hk_cpy_tbl.image().data))
    assert find_fault(nasa.data) is None


def test_start(hk: AppBench) -> None:
    hk.run(HK_AppMain)
    assert own(hk) == [(1, 2, "HK Initialized.  Version 7.0.0.0")]
    assert hk.subscriptions == {0x189A, 0x189B, 0x189C, *CORE}
    assert hk.exit_status == APP_EXIT


def test_combined_packet_of_recorded_housekeeping(hk: AppBench) -> None:
    hk.run(HK_AppMain, *(TELEMETRY[mid] for mid in CORE), SEND_1)
    (packet,) = hk.sent
    assert (get_msg_id(packet), get_size(packet), len(packet)) == (0x089C, 36, 36)
    assert packet[16:] == b"".join(TELEMETRY[mid][16:20] for mid in CORE)
    assert any(packet[16:])
    assert len(own(hk)) == 1


def test_with_nasas_table_the_combined_packet_is_nasas(hk: AppBench) -> None:
    """Its table copies the spare bytes in front of the payloads, so that only zeros are combined."""
    hk.files["/cf/hk_cpy_tbl.tbl"] = (DATA / "hk_cpy_tbl.tbl").read_bytes()
    hk.run(HK_AppMain, *(TELEMETRY[mid] for mid in CORE), SEND_1)
    (packet,) = hk.sent
    real = TELEMETRY[0x089C]
    assert len(packet) == len(real) == 32
    assert (packet[:2], packet[4:6], packet[12:]) == (real[:2], real[4:6], real[12:])


def test_missing_input_packet_is_reported_and_the_combined_packet_sent(hk: AppBench) -> None:
    hk.run(HK_AppMain, *(TELEMETRY[mid] for mid in CORE), SEND_1, TELEMETRY[CORE[0]], SEND_1, SEND_HK)
    assert own(hk)[1:] == [(12, 1, "Combined Packet 0x0000089C missing data from Input Pkt 0x00000805")]
    assert hk.sent[0][16:] == hk.sent[1][16:]
    values = packets.HOUSEKEEPING.unpack(hk.sent[2][16:])
    assert (values["CombinedPacketsSent"], values["MissingDataCtr"]) == (2, 1)
    assert values["MemPoolHandle"] == POOL_ID


def test_incomplete_packet_is_discarded_when_configured(hk: AppBench) -> None:
    whole = [TELEMETRY[mid] for mid in CORE]
    hk.run(lambda cfe: run(cfe, discard_incomplete=True), *whole[1:], SEND_1, *whole, SEND_1, SEND_HK)
    assert own(hk)[1:] == [(12, 1, "Combined Packet 0x0000089C missing data from Input Pkt 0x00000801")]
    combined, own_packet = hk.sent
    assert combined[16:] == b"".join(packet[16:20] for packet in whole)
    values = packets.HK_TLM.read(own_packet)
    assert (values["CombinedPacketsSent"], values["MissingDataCtr"]) == (1, 1)


def test_commands(hk: AppBench) -> None:
    unknown = packets.SEND_COMBINED_PKT.packet(OutMsgToSend=0x089D)
    hk.run(
        HK_AppMain,
        cmd(packets.CMD_MID, 0),
        unknown,
        cmd(packets.CMD_MID, 77),
        cmd(packets.CMD_MID, 0, b"x"),
        cmd(packets.SEND_HK_MID, 0, b"x"),
        SEND_HK,
        cmd(packets.CMD_MID, 1),
        SEND_HK,
    )
    assert own(hk)[1:] == [
        (4, 2, "HK No-op command, Version 7.0.0.0"),
        (11, 2, "Combined HK Packet 0x0000089D is not found in current HK Copy Table"),
        (2, 3, "Cmd Msg with Invalid command code Rcvd -- ID = 0x0000189A, CC = 77"),
        (3, 3, "Cmd Msg with Bad length Rcvd: ID = 0x0000189A, CC = 0, Exp Len = 8, Len = 9"),
        (28, 3, "Msg with Bad length Rcvd: ID = 0x0000189B, Exp Len = 8, Len = 9"),
        (5, 2, "HK Reset Counters command received"),
    ]
    first, second = (packets.HOUSEKEEPING.unpack(packet[16:]) for packet in hk.sent)
    assert (first["CmdCounter"], first["ErrCounter"]) == (1, 2)
    assert (second["CmdCounter"], second["ErrCounter"]) == (0, 0)


def test_short_input_packet_is_reported_once(hk: AppBench) -> None:
    rows = [(0x0801, 16, 0x089C, 16, 4), (0x0801, 18, 0x089C, 20, 4)]
    hk.files["/cf/hk_cpy_tbl.tbl"] = build(TableImage("HK.CopyTable", table(*rows)))
    hk.run(HK_AppMain, bytes(telemetry(0x0801, b"ab")))
    text = "HK table definition exceeds packet length. MID:0x00000801, Length:18, Count:2"
    assert own(hk)[1:] == [(6, 3, text)]


def test_new_table_from_the_ground(hk: AppBench) -> None:
    hk.files["/cf/new.tbl"] = build(TableImage("HK.CopyTable", table((0x0883, 16, 0x089D, 16, 2))))

    def load() -> None:
        hk.ground(tbl_packets.LOAD, LoadFilename="/cf/new.tbl")
        hk.ground(tbl_packets.VALIDATE, ActiveTableFlag=0, TableName="HK.CopyTable")

    def activate() -> None:
        hk.named(tbl_packets.ACTIVATE, "HK.CopyTable")

    send_2 = packets.SEND_COMBINED_PKT.packet(OutMsgToSend=0x089D)
    hk.run(HK_AppMain, load, None, activate, None, bytes(telemetry(0x0883, b"XY")), send_2, SEND_1)
    assert hk.subscriptions == {0x189A, 0x189B, 0x189C, 0x0883}
    assert hk.sent[0][16:] == b"XY"
    assert hk.events[-1][0] == 11
    assert hk.exit_status == APP_EXIT
    assert hk.pool is not None
    assert sum(row["NumCreated"] - row["NumFree"] for row in hk.pool.blocks.block_stats()) == 1


def test_runtime_table_is_filled_when_a_dump_is_requested(hk: AppBench) -> None:
    wish = {"ActiveTableFlag": 1, "TableName": "HK.RuntimeTable", "DumpFilename": "/ram/rt.tbl"}
    hk.run(HK_AppMain, TELEMETRY[0x0801], lambda: hk.ground(tbl_packets.DUMP, **wish), None)
    table = hk.tbl.registry.by_name("HK.RuntimeTable")
    data = bytes(table.buffers[0].data)
    rows = [packets.RUNTIME_TABLE_ENTRY.unpack(data, at) for at in range(0, len(data), 16)]
    assert [row["DataPresent"] for row in rows[:6]] == [1, 0, 0, 0, 0, 0]
    assert [row["InputMidSubscribed"] for row in rows[:6]] == [1, 1, 1, 1, 1, 0]
    assert len({row["OutputPktAddr"] for row in rows[:5]}) == 1
    hk.take_events()
    hk.send_hk()
    assert hk.take_events() == [
        (65, 3, "Dump,table=[unknown],app=,file=/ram/rt.tbl:Error writing Tbl image, Status=-40")
    ]


@pytest.mark.parametrize(
    ("row", "fault"),
    [
        ((0x0801, 16, 0x2000, 16, 4), "Invalid Output MID: 0x2000"),
        ((0, 16, 0x089C, 16, 4), "Invalid Input MID: 0x0"),
        ((0x0801, 1498, 0x089C, 16, 4), "Invalid input offset+size: 1502 > 1500, mid 0x801"),
        ((0x0801, 16, 0x089C, 1498, 4), "Invalid output offset+size: 1502 > 1500, mid 0x89c"),
    ],
)
def test_bad_table(hk: AppBench, row: tuple[int, int, int, int, int], fault: str) -> None:
    image = table((0x0801, 16, 0x089C, 16, 4), row)
    hk.files["/cf/hk_cpy_tbl.tbl"] = build(TableImage("HK.CopyTable", image))
    hk.run(HK_AppMain)
    assert hk.events[0] == (36, 3, f"HK Validate: {fault} at entry index 1\n")
    assert hk.events[-1] == (21, 3, "Error Loading Copy Table,RC=0xFFFFFFFF")
    assert hk.exit_status == APP_ERROR


@pytest.mark.parametrize(
    ("function", "event_id", "text"),
    [
        ("sb.create_pipe", 14, "Error Creating SB Pipe,RC=0xCA000003"),
        ("sb.subscribe", 15, "Error Subscribing to HK Snd Cmb Pkt, MID=0x0000189C, RC=0xCA000003"),
        ("es.pool_create", 18, "Error Creating Memory Pool,RC=0xCA000003"),
    ],
)
def test_start_that_fails(hk: AppBench, function: str, event_id: int, text: str) -> None:
    hk.refuse[function] = CFE_SB_BAD_ARGUMENT
    hk.run(HK_AppMain)
    assert hk.events == [(event_id, 3, text)]
    assert hk.exit_status == APP_ERROR


def test_missing_table_file_ends_hk(hk: AppBench) -> None:
    del hk.files["/cf/hk_cpy_tbl.tbl"]
    hk.run(HK_AppMain)
    assert hk.events[-1] == (21, 3, f"Error Loading Copy Table,RC=0x{CFE_TBL_ERR_ACCESS & 0xFFFFFFFF:08X}")
    assert hk.exit_status == APP_ERROR


def test_pool_that_is_full_costs_the_packet_only(hk: AppBench) -> None:
    hk.refuse["es.get_pool_buf"] = CFE_SB_BAD_ARGUMENT
    hk.run(HK_AppMain, TELEMETRY[0x0801], SEND_1)
    assert own(hk)[0] == (7, 3, "HK Processing New Table: ES_GetPoolBuf for size 36 returned 0xCA000003")
    assert hk.events[-1][0] == 11


def test_broken_pipe_ends_hk(hk: AppBench) -> None:
    hk.refuse["sb.receive_buffer"] = CFE_SB_PIPE_RD_ERR
    hk.run(HK_AppMain, None)
    assert hk.events[-1] == (26, 3, "HK_APP Exiting due to CFE_SB_RcvMsg error 0xCA000006")
    assert hk.log == ["HK_APP Exiting due to CFE_SB_RcvMsg error 0xCA000006"]
    assert hk.exit_status == APP_ERROR


def test_no_event_services_no_hk(hk: AppBench) -> None:
    hk.refuse["evs.register"] = CFE_SB_BAD_ARGUMENT
    hk.run(HK_AppMain)
    assert hk.log == ["HK: error registering for event services: 0xCA000003"]
    assert (hk.events, hk.exit_status) == ([], APP_ERROR)


@pytest.mark.parametrize(
    ("function", "status", "event"),
    [
        ("get_status", None, (10, 4, "Unexpected CFE_TBL_GetStatus return (0xCC000001) for Copy Table")),
        ("validate", CFE_TBL_INFO_VALIDATION_PENDING, (32, 3, "Unexpected CFE_TBL_Validate return")),
        ("release_address", CFE_TBL_INFO_UPDATE_PENDING, (31, 4, "Unexpected CFE_TBL_ReleaseAddress return")),
        ("update", CFE_TBL_INFO_UPDATE_PENDING, (30, 4, "Unexpected CFE_TBL_Update return (0xCC000001)")),
        ("get_address", CFE_TBL_INFO_UPDATE_PENDING, (29, 4, "Unexpected CFE_TBL_GetAddress return (0xCC000001)")),
        ("dump_to_buffer", CFE_TBL_INFO_DUMP_PENDING, (33, 4, "Unexpected CFE_TBL_DumpToBuffer return")),
    ],
)
def test_table_calls_that_fail(
    hk: AppBench, monkeypatch: pytest.MonkeyPatch, function: str, status: int | None, event: tuple[int, int, str]
) -> None:
    statuses = [CFE_SUCCESS, status] if status == CFE_TBL_INFO_DUMP_PENDING else [status, CFE_SUCCESS]

    def refuse(*args: object) -> int:
        raise CfeError(CFE_TBL_ERR_INVALID_HANDLE)

    def fail_from_now_on() -> None:
        if status is not None:
            monkeypatch.setattr(hk.tbl, "get_status", lambda handle: statuses.pop(0))
            monkeypatch.setattr(hk.tbl, "update", lambda handle: CFE_SUCCESS)
        monkeypatch.setattr(hk.tbl, function, refuse)

    hk.run(HK_AppMain, fail_from_now_on, None)
    assert hk.events[-1][:2] == event[:2]
    assert hk.events[-1][2].startswith(event[2])
    assert hk.exit_status == (APP_EXIT if function == "validate" else APP_ERROR)


def test_combined_packets_have_the_fields_of_their_input_packets() -> None:
    """Whole fields have their names, the rest is bytes. Overlapping parts and parts in the header are left out."""
    source = Telemetry("SRC_HK_TLM", 0x0880, Layout("Src", [("A", "u8"), ("B", "u32"), ("C", "char[4]")]))
    copies = [  # from packet, byte, to packet, byte, bytes
        (0x0880, 20, 0x089C, 17, 8),
        (0x0880, 22, 0x089C, 26, 2),
        (0x0880, 20, 0x089C, 28, 4),
        (0x0880, 16, 0x089C, 16, 2),
        (0x0881, 18, 0x08A1, 12, 6),
    ]
    rows = [dict(zip(COPY_TABLE.row.fields, (a, b, c, d, e), strict=True)) for a, b, c, d, e in copies]
    one, other = combined_telemetry(COPY_TABLE.pack(rows), {0x0880: source})
    assert (one.name, one.msg_id, other.name, other.msg_id) == ("HK_COMBINED_PKT1", 0x089C, "HK_COMBINED_08A1", 0x08A1)
    assert list(one.payload.offsets.items()) == [
        ("SRC_HK_TLM_A", 0),
        ("SRC_HK_TLM_B", 1),
        ("SRC_HK_TLM_C", 5),
        ("spare_9", 9),
        ("SRC_HK_TLM_from_22", 10),
        ("SRC_HK_TLM_B_2", 12),
    ]
    assert one.payload.size == 16
    assert list(other.payload.offsets.items()) == [("MID_0881_from_22", 0)]
    assert (other.payload.size, next(other.payload.cells()).type) == (2, "u8")
