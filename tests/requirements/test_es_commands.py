"""NASA's requirements for the command counters of Executive Services (cES1002 to 1004): each command, good and bad."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from cfepy.es import packets as pk
from cfepy.msg import Command
from cfepy.ports import ERROR
from tests.requirements.flight import Flight

Fields = dict[str, Any]
START = {"Application": "SECOND", "AppEntryPoint": "main", "AppFileName": "mute"}
MUTE = {"Application": "MUTE"}
NOBODY = {"Application": "NOBODY"}


def pool(flight: Flight) -> Fields:
    """Return an existing memory pool."""
    return {"PoolHandle": flight.call(lambda: flight.cfe.es.pool_create(1024))}


def orphan(flight: Flight) -> Fields:
    """Return a CDS block whose owner is gone."""
    es = flight.cfe.es
    flight.call(lambda: es.register_cds(10, "Data"), app="MUTE")
    flight.call(lambda: es.delete_app(es.get_app_id_by_name("MUTE")))
    flight.run_for(8)
    return {"CdsName": "MUTE.Data"}


VALID: list[tuple[Command, Fields | Callable[[Flight], Fields]]] = [
    (pk.NOOP, {}),
    (pk.START_APP, START),
    (pk.STOP_APP, MUTE),
    (pk.RESTART_APP, MUTE),
    (pk.RELOAD_APP, {**MUTE, "AppFileName": "probe"}),
    (pk.QUERY_ONE, MUTE),
    (pk.QUERY_ALL, {}),
    (pk.CLEAR_SYS_LOG, {}),
    (pk.WRITE_SYS_LOG, {}),
    (pk.CLEAR_ER_LOG, {}),
    (pk.WRITE_ER_LOG, {}),
    (pk.START_PERF_DATA, {}),
    (pk.STOP_PERF_DATA, {}),
    (pk.SET_PERF_FILTER_MASK, {"FilterMaskNum": 3}),
    (pk.SET_PERF_TRIGGER_MASK, {"TriggerMaskNum": 3}),
    (pk.OVER_WRITE_SYS_LOG, {"Mode": 1}),
    (pk.RESET_PR_COUNT, {}),
    (pk.SET_MAX_PR_COUNT, {"MaxPRCount": 4}),
    (pk.DELETE_CDS, orphan),
    (pk.SEND_MEM_POOL_STATS, pool),
    (pk.DUMP_CDS_REGISTRY, {}),
    (pk.QUERY_ALL_TASKS, {}),
]
INVALID: list[tuple[Command, Fields, int]] = [
    (Command("an unknown code", pk.CMD_MID, 3), {}, 22),
    (pk.RESTART, {"RestartType": 9}, 24),
    (pk.START_APP, {**START, "AppFileName": "nowhere"}, 26),
    (pk.STOP_APP, NOBODY, 36),
    (pk.RESTART_APP, NOBODY, 39),
    (pk.RELOAD_APP, NOBODY, 43),
    (pk.QUERY_ONE, NOBODY, 50),
    (pk.QUERY_ALL, {"FileName": "/nowhere/x"}, 51),
    (pk.WRITE_SYS_LOG, {"FileName": "/nowhere/x"}, 55),
    (pk.WRITE_ER_LOG, {"FileName": "/ram/"}, 56),
    (pk.START_PERF_DATA, {"TriggerMode": 3}, 59),
    (pk.STOP_PERF_DATA, {"DataFileName": "/ram/"}, 67),
    (pk.SET_PERF_FILTER_MASK, {"FilterMaskNum": 4}, 64),
    (pk.SET_PERF_TRIGGER_MASK, {"TriggerMaskNum": 4}, 66),
    (pk.OVER_WRITE_SYS_LOG, {"Mode": 2}, 71),
    (pk.DELETE_CDS, {"CdsName": "NOBODY.Data"}, 77),
    (pk.SEND_MEM_POOL_STATS, {"PoolHandle": 0}, 82),
    (pk.DUMP_CDS_REGISTRY, {"DumpFilename": "/nowhere/x"}, 86),
    (pk.QUERY_ALL_TASKS, {"FileName": "/nowhere/x"}, 88),
]


@pytest.fixture
def flight(fly: Callable[..., Flight]) -> Flight:
    return fly(pk.HK_TLM_MID)


def counters(flight: Flight) -> tuple[int, int]:
    values = flight.ask(pk.SEND_HK, pk.HK_TLM)
    return values["CommandCounter"], values["CommandErrorCounter"]


@pytest.mark.parametrize(("command", "fields"), VALID, ids=[command.name for command, _ in VALID])
def test_cES1002_a_valid_command_is_counted(
    flight: Flight, command: Command, fields: Fields | Callable[[Flight], Fields]
) -> None:
    given = fields(flight) if callable(fields) else fields
    valid, invalid = counters(flight)
    flight.send(command, **given)
    assert counters(flight) == (valid + 1, invalid)


def test_cES1002_all_commands_that_can_be_counted_are_tested() -> None:
    uncounted = {pk.RESET_COUNTERS.name, pk.RESTART.name, pk.SEND_HK.name}
    assert {command.name for command, _ in VALID} | uncounted == {command.name for command in pk.COMMANDS}


@pytest.mark.parametrize(("command", "fields", "event"), INVALID, ids=[command.name for command, *_ in INVALID])
def test_cES1003_an_invalid_command_is_counted_and_reported(
    flight: Flight, command: Command, fields: Fields, event: int
) -> None:
    valid, invalid = counters(flight)
    said = flight.send(command, **fields)
    assert [(each.app, each.event_id, each.event_type) for each in said] == [("CFE_ES", event, ERROR)]
    assert counters(flight) == (valid, invalid + 1)


def longer(command: Command) -> bytes:
    """Return a command with a byte too many."""
    packet = bytearray(command.packet() + b"x")
    packet[4:6] = (len(packet) - 7).to_bytes(2, "big")
    return bytes(packet)


def test_a_housekeeping_request_of_another_length_is_answered(flight: Flight) -> None:
    before = counters(flight)
    flight.packets.clear()
    flight.transmit(longer(pk.SEND_HK))
    assert len(flight.all(pk.HK_TLM)) == 1
    assert flight.events() == []
    assert counters(flight) == before


def test_cES1003_a_command_of_another_length_is_counted_and_reported(flight: Flight) -> None:
    for count, command in enumerate((each for each in pk.COMMANDS if each.msg_id == pk.CMD_MID), 1):
        packet = longer(command)
        flight.packets.clear()
        flight.transmit(bytes(packet))
        (event,) = flight.events()
        code = command.code or 0
        assert event.text == (
            f"Invalid msg length: ID = 0x{command.msg_id:X},  CC = {code}, "
            f"Len = {len(packet)}, Expected = {command.length}"
        )
        assert (event.event_id, event.event_type) == (23, ERROR)
        assert counters(flight) == (0, count)


def test_cES1004_both_counters_are_set_to_zero(flight: Flight) -> None:
    flight.send(pk.NOOP)
    flight.send(pk.NOOP)
    flight.send(pk.RESTART, RestartType=9)
    assert counters(flight) == (2, 1)
    flight.send(pk.RESET_COUNTERS)
    assert counters(flight) == (0, 0)
