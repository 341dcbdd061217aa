"""Requirements of Executive Services about the Critical Data Store."""

from __future__ import annotations

from collections.abc import Callable

from cfepy.es import packets as pk
from cfepy.es.cds import RECORD
from cfepy.fs import crc16, read_header
from cfepy.ports import ERROR, INFORMATION
from cfepy.status import (
    CFE_ES_BAD_ARGUMENT,
    CFE_ES_CDS_ALREADY_EXISTS,
    CFE_ES_CDS_BLOCK_CRC_ERR,
    CFE_ES_CDS_INVALID_NAME,
    CFE_ES_CDS_INVALID_SIZE,
    CFE_ES_ERR_MEM_BLOCK_SIZE,
    CFE_ES_ERR_NAME_NOT_FOUND,
    CFE_ES_ERR_RESOURCEID_NOT_VALID,
    CFE_ES_NOT_IMPLEMENTED,
    CFE_SUCCESS,
)
from cfepy.tbl import OPT_CRITICAL
from tests.layouts import DATA
from tests.requirements.covers import covers
from tests.requirements.flight import POWERON_RESET, PROCESSOR_RESET, Flight
from tests.statuses import status_of

Fly = Callable[..., Flight]
NAME = "PROBE.Data"
DATA_BYTES = b"ten bytes."
REGISTRY_AT = 12


def register(flight: Flight, size: int = len(DATA_BYTES), name: str = "Data") -> tuple[int, int]:
    """Handle and status of a block of PROBE's."""
    handle = flight.call(lambda: flight.cfe.es.register_cds(size, name))
    return handle, handle.status


def saved(flight: Flight) -> int:
    """Return the handle of a block with DATA_BYTES."""
    handle, _ = register(flight)
    flight.cfe.es.copy_to_cds(handle, DATA_BYTES)
    return handle


@covers("cES1026", "cES1026.1")
def test_cES1026_registry_to_a_file(fly: Fly) -> None:
    flight = fly()
    files = flight.mission.files
    flight.send(pk.DUMP_CDS_REGISTRY)
    golden = (DATA / "cfe_cds_reg.log").read_bytes()
    assert files.read_file("/ram/cfe_cds_reg.log")[64:] == golden[64:]
    handle, _ = register(flight)
    flight.call(lambda: flight.cfe.tbl.register("T", 24, OPT_CRITICAL))
    flight.send(pk.DUMP_CDS_REGISTRY, DumpFilename="/ram/mine.log")
    data = files.read_file("/ram/mine.log")
    assert (read_header(data).description, read_header(data).subtype) == ("CDS_Registry", 6)
    size = pk.CDS_REG_DUMP_RECORD.size
    records = [pk.CDS_REG_DUMP_RECORD.unpack(data, at) for at in range(64, len(data), size)]
    found = {record["Name"]: (record["Handle"], record["Size"], record["Table"]) for record in records}
    assert list(found) == ["CFE_TBL.CritReg", NAME, "PROBE.T"]
    assert found[NAME] == (handle, 10, False)
    assert found["PROBE.T"] == (flight.cfe.es.get_cds_block_id_by_name("PROBE.T"), 24, True)


def test_cES1027_delete(fly: Fly) -> None:
    flight = fly()
    es = flight.cfe.es
    flight.call(lambda: es.register_cds(10, "Data"), app="MUTE")
    (event,) = flight.send(pk.DELETE_CDS, CdsName="CFE_TBL.CritReg")
    assert (event.event_id, event.event_type) == (79, ERROR)
    (event,) = flight.send(pk.DELETE_CDS, CdsName="MUTE.Data")
    assert (event.event_id, event.text) == (80, "CDS 'MUTE.Data' not deleted because owning app is active")
    flight.call(lambda: es.delete_app(es.get_app_id_by_name("MUTE")))
    flight.run_for(8)
    (event,) = flight.send(pk.DELETE_CDS, CdsName="MUTE.Data")
    assert (event.event_id, event.event_type) == (78, INFORMATION)
    assert status_of(lambda: es.get_cds_block_id_by_name("MUTE.Data")) == CFE_ES_ERR_NAME_NOT_FOUND
    (event,) = flight.send(pk.DELETE_CDS, CdsName="MUTE.Data")
    assert event.event_id == 77


def test_cES1315_reserve(fly: Fly) -> None:
    flight = fly()
    es = flight.cfe.es
    handle, status = register(flight)
    assert status == CFE_SUCCESS
    assert register(flight) == (handle, CFE_ES_CDS_ALREADY_EXISTS)
    assert es.get_cds_block_name(handle) == NAME
    assert es.get_cds_block_id_by_name(NAME) == handle
    flight.packets.clear()
    assert status_of(lambda: register(flight, size=0)) == CFE_ES_CDS_INVALID_SIZE
    assert status_of(lambda: register(flight, name="")) == CFE_ES_CDS_INVALID_NAME
    assert status_of(lambda: register(flight, name="x" * 17)) == CFE_ES_CDS_INVALID_NAME
    assert status_of(lambda: register(flight, size=80_000)) == CFE_ES_ERR_MEM_BLOCK_SIZE
    events = flight.events()
    assert [(event.app, event.event_id, event.event_type) for event in events] == [("PROBE", 69, ERROR)] * 4
    assert events[0].text == "PROBE Failed to Register CDS 'Data', Status=0xC4000010"


def test_cES1315_1_another_size(fly: Fly) -> None:
    flight = fly()
    handle = saved(flight)
    assert register(flight, size=20) == (handle, CFE_SUCCESS)
    assert flight.cfe.es.restore_from_cds(handle) == bytes(20)
    assert [block.name for block in flight.cfe.es.cds_blocks()].count(NAME) == 1
    assert register(flight, name="Other")[0] != handle
    flight.reset(PROCESSOR_RESET)
    assert register(flight, size=20) == (handle, CFE_ES_CDS_ALREADY_EXISTS)


@covers("cES1316", "cES1316.2", "cES1328", "cES1328.2")
def test_cES1316_data_survive_a_copy_to_the_cds_and_back(fly: Fly) -> None:
    es = (flight := fly()).cfe.es
    handle = saved(flight)
    assert es.restore_from_cds(handle) == DATA_BYTES
    before = bytes(flight.cfe.psp.retained.cds)
    for nobodys in (0, handle + 1):
        assert status_of(lambda: es.restore_from_cds(nobodys)) == CFE_ES_ERR_RESOURCEID_NOT_VALID  # noqa: B023
        assert status_of(lambda: es.copy_to_cds(nobodys, bytes(10))) == CFE_ES_ERR_RESOURCEID_NOT_VALID  # noqa: B023
    assert bytes(flight.cfe.psp.retained.cds) == before
    assert status_of(lambda: es.copy_to_cds(handle, b"short")) == CFE_ES_BAD_ARGUMENT
    assert es.restore_from_cds(handle) == DATA_BYTES


@covers("cES1316.1", "cES1328.1")
def test_cES1316_1_damaged_data_are_not_restored(fly: Fly) -> None:
    flight = fly()
    handle = saved(flight)
    memory = flight.cfe.psp.retained.cds
    at = memory.index(DATA_BYTES)
    assert int.from_bytes(memory[at - 4 : at], "little") == crc16(DATA_BYTES)
    memory[at] ^= 1
    assert status_of(lambda: flight.cfe.es.restore_from_cds(handle)) == CFE_ES_CDS_BLOCK_CRC_ERR
    flight.reset(PROCESSOR_RESET)
    assert register(flight) == (handle, CFE_ES_CDS_ALREADY_EXISTS)
    assert status_of(lambda: flight.cfe.es.restore_from_cds(handle)) == CFE_ES_CDS_BLOCK_CRC_ERR


@covers("cES1504", "cES1514")
def test_cES1514_a_processor_reset_preserves_and_a_power_on_reset_clears(fly: Fly) -> None:
    flight = fly()
    handle = saved(flight)
    flight.reset(PROCESSOR_RESET)
    assert register(flight) == (handle, CFE_ES_CDS_ALREADY_EXISTS)
    assert flight.cfe.es.restore_from_cds(handle) == DATA_BYTES
    flight.reset(POWERON_RESET)
    assert DATA_BYTES not in flight.cfe.psp.retained.cds
    assert register(flight)[1] == CFE_SUCCESS


def test_cES1514_damage_outside_a_block(fly: Fly) -> None:
    flight = fly()
    saved(flight)
    slot = 2
    flight.cfe.psp.retained.cds[REGISTRY_AT + slot * RECORD.size + 24] ^= 1
    flight.reset(PROCESSOR_RESET)
    text = f"CFE_ES_RebuildCDS: Entry {slot} of the CDS registry or its block is damaged, it is dropped"
    assert any(text in line for line in flight.mission.console.lines)
    assert register(flight)[1] == CFE_SUCCESS
    flight.cfe.psp.retained.cds[0] ^= 1
    flight.reset(PROCESSOR_RESET)
    assert [block.name for block in flight.cfe.es.cds_blocks()] == ["CFE_TBL.CritReg"]


def test_cds_is_not_available_without_room(fly: Fly) -> None:
    flight = fly(es_cds_size=1024)
    assert status_of(lambda: register(flight)) == CFE_ES_NOT_IMPLEMENTED
    assert status_of(lambda: flight.cfe.es.get_cds_block_name(0x150001)) == CFE_ES_NOT_IMPLEMENTED
    assert flight.send(pk.DUMP_CDS_REGISTRY) == []
    assert len(flight.mission.files.read_file("/ram/cfe_cds_reg.log")) == 64
