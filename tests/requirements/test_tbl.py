"""Requirements of Table Services that the ground sees: commands, their events, telemetry and files (cTBL6000-6013)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from cfepy.fs import crc16
from cfepy.msg import Command, command
from cfepy.ports import DEBUG, ERROR, INFORMATION
from cfepy.status import CFE_SUCCESS, CFE_TBL_INFO_UPDATED, CFE_TBL_INFO_VALIDATION_PENDING
from cfepy.tbl import OPT_CRITICAL, OPT_DBL_BUFFER, OPT_DUMP_ONLY, read
from cfepy.tbl import packets as pk
from tests.requirements.covers import covers
from tests.requirements.flight import Event, Flight
from tests.requirements.tables import (
    BAD,
    FILE_TIME,
    NAME,
    NEW,
    OLD,
    SIZE,
    ProbeTable,
    fields_of,
    housekeeping,
    put,
    registry,
)

Fly = Callable[..., Flight]
EVS_CMD_MID, ENABLE_APP_EVENT_TYPE_CC = 0x1801, 5
LISTEN = pk.HK_TLM_MID, pk.REG_TLM_MID


@pytest.fixture
def table(fly: Fly) -> ProbeTable:
    """PROBE.T, loaded with OLD, twice, since it has a buffer that can be dumped from then on."""
    table = ProbeTable(fly(*LISTEN, cfe_version="7.0.1"))
    table.mine("load", OLD)
    table.mine("load", OLD)
    return table


def ids(events: list[Event]) -> list[int]:
    return [event.event_id for event in events]


def test_cTBL6000_load_inactive_table_from_file(table: ProbeTable) -> None:
    (event,) = table.upload(NEW)
    assert (event.app, event.event_id, event.event_type) == ("CFE_TBL", 12, INFORMATION)
    assert table.content() == OLD
    dump = {"ActiveTableFlag": pk.INACTIVE_BUFFER, "TableName": NAME, "DumpFilename": "/ram/d.tbl"}
    table.flight.send(pk.DUMP, **dump)
    table.flight.send(pk.SEND_HK)
    assert read(table.flight.mission.files.read_file("/ram/d.tbl")).data == NEW


def test_cTBL6000_1_partial_load_keeps_the_rest_of_the_active_table(table: ProbeTable) -> None:
    assert ids(table.upload(b"XY", offset=2)) == [12]
    assert ids(table.upload(b"ZZ", offset=6)) == [100], "a load is in progress"
    table.validate_inactive()
    table.activate()
    assert table.content() == OLD[:2] + b"XY" + OLD[4:]


@covers("cTBL6000.2", "cTBL6000.3", "cTBL6000.5", "cTBL6010")
def test_cTBL6000_2_invalid_files_are_refused(table: ProbeTable) -> None:
    assert [(event.event_id, event.event_type) for event in table.upload(NEW + b"!")] == [(72, ERROR)]
    table.flight.send(pk.ABORT_LOAD, TableName=NAME)
    put(table.flight, NEW)
    path, files = "/ram/t.tbl", table.flight.mission.files
    whole = files.read_file(path)
    for event_id, data in ((75, whole + b"!"), (71, whole[:-1])):
        files.write_file(path, data)
        assert ids(table.flight.send(pk.LOAD, LoadFilename=path)) == [event_id]
        assert ids(table.flight.send(pk.ABORT_LOAD, TableName=NAME)) == [21]
    assert table.content() == OLD
    table.call("register", "D", SIZE, OPT_DUMP_ONLY)
    put(table.flight, NEW, name="PROBE.D")
    assert ids(table.flight.send(pk.LOAD, LoadFilename=path)) == [79]
    values = housekeeping(table.flight)
    assert (values["CommandErrorCounter"], values["NumLoadPending"]) == (4, 0)


def test_cTBL6001_dump_active_and_inactive(table: ProbeTable) -> None:
    table.upload(NEW)
    for which, path, image in (
        (pk.ACTIVE_BUFFER, "/ram/a.tbl", OLD),
        (pk.INACTIVE_BUFFER, "/ram/i.tbl", NEW),
    ):
        table.flight.send(pk.DUMP, ActiveTableFlag=which, TableName=NAME, DumpFilename=path)
        assert ids(table.flight.send(pk.SEND_HK)) == [14]
        assert read(table.flight.mission.files.read_file(path)).data == image


@covers("cTBL6002", "cTBL6002.1", "cTBL6002.2", "cTBL6313")
def test_cTBL6002_validate_both_images(table: ProbeTable) -> None:
    assert ids(table.upload(bytes([BAD]) + NEW[1:])) == [12]
    for which, image, result in ((pk.ACTIVE_BUFFER, OLD, 0), (pk.INACTIVE_BUFFER, bytes([BAD]) + NEW[1:], -5)):
        table.flight.send(pk.VALIDATE, ActiveTableFlag=which, TableName=NAME)
        assert table.mine("get_status") == CFE_TBL_INFO_VALIDATION_PENDING
        table.mine("validate")
        values = housekeeping(table.flight)
        assert (values["LastValCrc"], values["LastValStatus"]) == (crc16(image), result)
        assert (values["ActiveBuffer"], values["LastValTableName"]) == (which == pk.ACTIVE_BUFFER, NAME)
    assert (values["SuccessValCounter"], values["FailedValCounter"], values["ValidationCounter"]) == (1, 1, 2)
    assert values["NumValRequests"] == 2


@covers("cTBL6002", "cTBL6002.1")
def test_cTBL6002_both_images_may_wait_for_their_validation(table: ProbeTable) -> None:
    """They are handled in order. A request during a pending one is reported, and counts as done."""
    table.upload(NEW)
    for which, event_ids in ((pk.ACTIVE_BUFFER, []), (pk.INACTIVE_BUFFER, [104])):
        assert ids(table.flight.send(pk.VALIDATE, ActiveTableFlag=which, TableName=NAME)) == event_ids
    table.mine("manage")
    assert housekeeping(table.flight)["LastValCrc"] == crc16(OLD)
    table.flight.send(pk.VALIDATE, ActiveTableFlag=pk.INACTIVE_BUFFER, TableName=NAME)
    table.mine("manage")
    values = housekeeping(table.flight)
    assert (values["LastValCrc"], values["ValidationCounter"], values["CommandErrorCounter"]) == (crc16(NEW), 2, 0)


@covers("cTBL6003", "cTBL6003.1")
def test_cTBL6003_validated_image_is_activated(table: ProbeTable) -> None:
    table.upload(NEW)
    (event,) = table.flight.send(pk.ACTIVATE, TableName=NAME)
    assert (event.event_id, event.event_type) == (81, ERROR)
    table.validate_inactive()
    assert table.content() == OLD
    assert table.activate() == CFE_TBL_INFO_UPDATED
    assert table.content() == NEW


def test_cTBL6003_1_1_image_that_failed_validation_is_never_activated(table: ProbeTable) -> None:
    table.upload(bytes([BAD]) + NEW[1:])
    table.validate_inactive()
    assert ids(table.flight.send(pk.ACTIVATE, TableName=NAME)) == [81]
    table.mine("manage")
    assert table.content() == OLD


def test_cTBL6003_1_2_without_validation_function_a_table_is_valid(fly: Fly) -> None:
    table = ProbeTable(fly(cfe_version="7.0.1"), validator=None)
    table.mine("load", OLD)
    table.upload(NEW)
    assert ids(table.flight.send(pk.VALIDATE, ActiveTableFlag=pk.INACTIVE_BUFFER, TableName=NAME)) == [23]
    assert table.activate() == CFE_TBL_INFO_UPDATED


def three_tables(table: ProbeTable) -> None:
    """Prepare PROBE.T (loaded, shared, with a load that waits for its owner), PROBE.Other (never loaded) and
    PROBE.Dump."""
    put(table.flight, OLD, path="/ram/old.tbl")
    table.mine("load", "/ram/old.tbl")
    table.flight.call(lambda: table.flight.cfe.tbl.share(NAME), app="MUTE")
    table.upload(NEW)
    table.validate_inactive()
    table.flight.send(pk.ACTIVATE, TableName=NAME)
    table.call("register", "Other", 16, OPT_DBL_BUFFER | OPT_CRITICAL)
    table.call("register", "Dump", 4, OPT_DUMP_ONLY)


def loaded(table: ProbeTable) -> dict[str, object]:
    """Return the common content of packet and file about PROBE.T."""
    return {
        "Size": SIZE,
        "Crc": crc16(OLD),
        "TimeOfLastUpdate": fields_of(table.info().time_of_last_update),
        "FileTime": fields_of(FILE_TIME),
        "TableLoadedOnce": True,
        "DumpOnly": False,
        "DoubleBuffered": False,
        "Name": NAME,
        "LastFileLoaded": "/ram/old.tbl",
        "OwnerAppName": "PROBE",
    }


def empty() -> dict[str, object]:
    """Return the common content of both about PROBE.Other."""
    return {
        "Size": 16,
        "Crc": 0,
        "TimeOfLastUpdate": fields_of((0, 0)),
        "FileTime": fields_of((0, 0)),
        "TableLoadedOnce": False,
        "LoadPending": False,
        "DumpOnly": False,
        "DoubleBuffered": True,
        "Name": "PROBE.Other",
        "LastFileLoaded": "",
        "OwnerAppName": "PROBE",
    }


@covers("cTBL6005", "cTBL6005.1")
def test_cTBL6005_registry_to_a_file(table: ProbeTable) -> None:
    three_tables(table)
    for path, wish in (("/ram/cfe_tbl_reg.log", {}), ("/ram/mine.log", {"DumpFilename": "/ram/mine.log"})):
        table.flight.send(pk.DUMP_REGISTRY, **wish)
        table.flight.run_for(3)
        data = table.flight.mission.files.read_file(path)
        size = pk.REGISTRY_RECORD.size
        records = [pk.REGISTRY_RECORD.unpack(data, 64 + number * size) for number in range(3)]
        assert len(data) == 64 + 3 * size
        shared = {"NumUsers": 2, "ValidationFunc": True, "CriticalTable": False}
        assert records[0] == loaded(table) | shared | {"LoadInProgress": 3, "LoadPending": True}
        alone = {"NumUsers": 1, "ValidationFunc": False, "CriticalTable": True}
        assert records[1] == empty() | alone | {"LoadInProgress": -1}
        assert (records[2]["Name"], records[2]["DumpOnly"]) == ("PROBE.Dump", True)


def test_cTBL6006_registry_entry_in_telemetry(table: ProbeTable) -> None:
    three_tables(table)
    addresses = "ActiveBufferAddr", "InactiveBufferAddr", "ValidationFuncPtr"
    values = registry(table.flight)
    assert all(values.pop(name) for name in addresses)
    assert values == loaded(table) | {"LoadPending": True, "Critical": False, "ByteAlign4": 0}
    values = registry(table.flight, "PROBE.Other")
    assert [bool(values.pop(name)) for name in addresses] == [False, False, False]
    of_the_packet_before = {name: loaded(table)[name] for name in ("Crc", "FileTime")}
    assert values == empty() | of_the_packet_before | {"Critical": True, "ByteAlign4": 0}
    assert registry(table.flight, "PROBE.Dump")["DumpOnly"] is True
    table.flight.send(pk.SEND_HK)
    assert table.flight.all(pk.REG_TLM) == []


def test_cTBL6007_noop(fly: Fly) -> None:
    (event,) = fly(cfe_version="7.0.1").send(pk.NOOP)
    assert (event.app, event.event_id, event.event_type) == ("CFE_TBL", 10, INFORMATION)
    assert event.text.startswith("No-op Cmd Rcvd: CFE_TBL v7.0.1")


@covers("cTBL6008", "cTBL6009", "cTBL6010")
def test_cTBL6008_counters(table: ProbeTable) -> None:
    table.upload(bytes([BAD]) + NEW[1:])
    table.validate_inactive()
    housekeeping(table.flight)
    table.flight.send(pk.VALIDATE, ActiveTableFlag=pk.ACTIVE_BUFFER, TableName=NAME)
    table.mine("manage")
    table.flight.send(pk.ACTIVATE, TableName="NO.SUCH")
    counted = (
        "CommandCounter",
        "CommandErrorCounter",
        "NumValRequests",
        "SuccessValCounter",
        "FailedValCounter",
        "ValidationCounter",
    )
    values = housekeeping(table.flight)
    assert [values[name] for name in counted] == [3, 1, 2, 1, 1, 2]
    packet = bytes(command(EVS_CMD_MID, ENABLE_APP_EVENT_TYPE_CC, b"CFE_TBL".ljust(20, b"\0") + b"\1\0"))
    table.flight.transmit(packet)
    (event,) = table.flight.send(pk.RESET_COUNTERS)
    assert (event.event_id, event.event_type) == (11, DEBUG)
    values = housekeeping(table.flight)
    assert [values[name] for name in counted] == [0] * 6


@covers("cTBL6009")
def test_cTBL6009_valid_commands_are_counted(table: ProbeTable) -> None:
    put(table.flight, NEW)
    inactive = {"ActiveTableFlag": pk.INACTIVE_BUFFER, "TableName": NAME}
    commands: list[tuple[Command, dict[str, Any]]] = [
        (pk.NOOP, {}),
        (pk.LOAD, {"LoadFilename": "/ram/t.tbl"}),
        (pk.DUMP, inactive | {"DumpFilename": "/ram/d.tbl"}),
        (pk.VALIDATE, inactive),
        (pk.ACTIVATE, {"TableName": NAME}),
        (pk.ABORT_LOAD, {"TableName": NAME}),
        (pk.SEND_REGISTRY, {"TableName": NAME}),
        (pk.DUMP_REGISTRY, {}),
    ]
    for count, (kind, fields) in enumerate(commands, 1):
        table.flight.send(kind, **fields)
        if kind is pk.VALIDATE:
            table.mine("validate")
        values = housekeeping(table.flight)
        assert (values["CommandCounter"], values["CommandErrorCounter"]) == (count, 0), kind.name


@covers("cTBL6010")
def test_cTBL6010_invalid_commands_are_counted(table: ProbeTable) -> None:
    unknown = "NO.SUCH"
    for count, (packet, event_id) in enumerate(
        (
            (command(pk.CMD_MID, 99), 51),
            (pk.LOAD.packet(LoadFilename="/ram/none"), 53),
            (pk.DUMP.packet(TableName=unknown), 57),
            (pk.VALIDATE.packet(TableName=unknown), None),
            (pk.ACTIVATE.packet(TableName=unknown), None),
            (pk.ABORT_LOAD.packet(TableName=unknown), 57),
            (pk.SEND_REGISTRY.packet(TableName=unknown), 57),
            (pk.DELETE_CDS.packet(TableName=unknown), 84),
        ),
        1,
    ):
        table.flight.packets.clear()
        table.flight.transmit(bytes(packet))
        expected = [] if event_id is None else [(event_id, ERROR)]  # VALIDATE and ACTIVATE send no event
        assert [(event.event_id, event.event_type) for event in table.flight.events()] == expected
        values = housekeeping(table.flight)
        assert (values["CommandCounter"], values["CommandErrorCounter"]) == (0, count)
    (event,) = table.flight.send(Command("too long", pk.CMD_MID, pk.NOOP.code, pk.NOTIFY_COMMAND))
    assert (event.event_id, event.event_type) == (52, ERROR)
    assert housekeeping(table.flight)["CommandErrorCounter"] == count, "cFE does not count commands of a wrong length"


def test_cTBL6011_housekeeping(table: ProbeTable) -> None:
    other = table.call("register", "Other", SIZE, OPT_DBL_BUFFER, lambda image: -7 if image == NEW else 0)
    table.call("load", other, OLD)
    table.upload(NEW)
    table.validate_inactive()
    table.activate()
    dump = {"ActiveTableFlag": pk.ACTIVE_BUFFER, "TableName": NAME, "DumpFilename": "/ram/d.tbl"}
    table.flight.send(pk.DUMP, **dump)
    table.flight.send(pk.SEND_HK)
    put(table.flight, NEW, path="/ram/o.tbl", name="PROBE.Other")
    table.flight.send(pk.LOAD, LoadFilename="/ram/o.tbl")
    table.flight.send(pk.VALIDATE, ActiveTableFlag=pk.INACTIVE_BUFFER, TableName="PROBE.Other")
    table.call("validate", other)
    table.flight.send(pk.ACTIVATE, TableName="PROBE.Other")
    values = housekeeping(table.flight)
    assert (values["CommandCounter"], values["CommandErrorCounter"], values["NumTables"]) == (6, 1, 2)
    assert (values["LastUpdatedTable"], values["LastFileLoaded"]) == (NAME, "/ram/o.tbl")
    assert (values["LastFileDumped"], values["LastTableLoaded"]) == ("/ram/d.tbl", "PROBE.Other")
    assert (values["LastValTableName"], values["LastValCrc"]) == ("PROBE.Other", crc16(NEW))
    assert (values["LastValStatus"], values["ActiveBuffer"]) == (-7, False)
    assert (values["NumValRequests"], values["ValidationCounter"]) == (2, 2)
    assert (values["SuccessValCounter"], values["FailedValCounter"]) == (1, 1)
    assert (values["NumFreeSharedBufs"], values["NumLoadPending"]) == (4, 1)
    updated = table.info().time_of_last_update
    assert values["LastUpdateTime"] == {"Seconds": updated[0], "Subseconds": updated[1]}
    stats = table.flight.call(lambda: table.flight.cfe.es.get_mem_pool_stats(values["MemPoolHandle"]))
    assert stats["PoolSize"] == 524288
    table.flight.send(pk.VALIDATE, ActiveTableFlag=pk.ACTIVE_BUFFER, TableName=NAME)
    table.mine("validate")
    values = housekeeping(table.flight)
    assert (values["LastValStatus"], values["ActiveBuffer"]) == (0, True)


@covers("cTBL6012", "cTBL6012.1", "cTBL6012.3")
def test_cTBL6012_abort_a_load(table: ProbeTable) -> None:
    table.upload(NEW)
    table.validate_inactive()
    table.flight.send(pk.ACTIVATE, TableName=NAME)
    assert registry(table.flight)["LoadPending"] is True
    values = housekeeping(table.flight)
    assert (values["NumFreeSharedBufs"], values["NumLoadPending"]) == (3, 1)
    (event,) = table.flight.send(pk.ABORT_LOAD, TableName=NAME)
    assert (event.event_id, event.event_type) == (21, INFORMATION)
    values = housekeeping(table.flight)
    assert (values["NumFreeSharedBufs"], values["NumLoadPending"]) == (4, 0)
    assert registry(table.flight)["LoadPending"] is False
    assert table.mine("manage") == CFE_SUCCESS
    assert table.content() == OLD
    assert ids(table.flight.send(pk.ABORT_LOAD, TableName=NAME)) == [69]


def test_cTBL6012_2_abort_of_a_double_buffered_table(fly: Fly) -> None:
    table = ProbeTable(fly(*LISTEN, cfe_version="7.0.1"), OPT_DBL_BUFFER)
    table.mine("load", OLD)
    table.upload(NEW)
    table.flight.send(pk.ABORT_LOAD, TableName=NAME)
    assert ids(table.flight.send(pk.ACTIVATE, TableName=NAME)) == [70]
    assert ids(table.upload(b"XY", offset=2)) == [12]
    table.validate_inactive()
    table.activate()
    assert table.content() == OLD[:2] + b"XY" + OLD[4:]


@covers("cTBL6013", "cTBL6013.1", "cTBL6013.2", "cTBL6013.3", "cTBL6009")
def test_cTBL6013_delete_the_cds_of_a_table(fly: Fly) -> None:
    flight = fly(*LISTEN, cfe_version="7.0.1")
    cfe, name = flight.cfe, "MUTE.T"
    handle = flight.call(lambda: cfe.tbl.register("T", SIZE, OPT_CRITICAL), app="MUTE")
    flight.call(lambda: cfe.tbl.register("Other", SIZE), app="MUTE")
    assert cfe.es.get_cds_block_id_by_name(name)
    assert ids(flight.send(pk.DELETE_CDS, TableName=name)) == [82]
    flight.call(lambda: cfe.tbl.unregister(handle), app="MUTE")
    assert ids(flight.send(pk.DELETE_CDS, TableName=name)) == [87]
    flight.call(lambda: cfe.es.delete_app(cfe.es.get_app_id_by_name("MUTE")))
    flight.run_for(8)
    (event,) = flight.send(pk.DELETE_CDS, TableName=name)
    assert (event.event_id, event.text) == (38, f"Successfully removed '{name}' from CDS")
    assert name not in [block.name for block in cfe.es.cds_blocks()]
    assert ids(flight.send(pk.DELETE_CDS, TableName=name)) == [85]
    assert ids(flight.send(pk.DELETE_CDS, TableName="MUTE.Other")) == [84]
    values = housekeeping(flight)
    assert (values["CommandCounter"], values["CommandErrorCounter"]) == (1, 4)
