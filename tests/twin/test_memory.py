"""Memory for MM, MD and CS: the packets sent, and equal answers of both if NASA's are built."""

from __future__ import annotations

import struct
from itertools import islice

import pytest

from cfepy import msg
from cfepy.fs import HEADER_SIZE, crc16
from dev.twin import memory_flight
from dev.twin.flight_apps import CS, MD, MM
from dev.twin.memory_commands import LOADS, MemoryCommander, files
from dev.twin.real import installed

ADDRESS = 0x1000000000
BUILT = installed(memory_flight.VARIABLE)
needs_ram = pytest.mark.skipif(BUILT is None, reason=f"{memory_flight.VARIABLE} names no folder with NASA's core-cpu1")
ALL_OF_MM = {*range(2, 10)}


def test_every_command_with_an_address_is_sent() -> None:
    packets = [packet for step in islice(MemoryCommander(1, ADDRESS).steps(), 400) for packet in step.packets]
    flown = {(msg.get_msg_id(each), each[6]) for each in packets}
    assert {(MM.commands_mid, code) for code in ALL_OF_MM} <= flown
    assert {(MD.commands_mid, code) for code in (2, 3, 4)} <= flown
    assert {(CS.commands_mid, code) for code in (2, 3, 16, 20, 23, 27, 30, 36)} <= flown


def test_commands_depend_only_on_the_seed() -> None:
    first, second = (list(islice(MemoryCommander(5, ADDRESS).steps(), 50)) for _ in range(2))
    assert first == second
    assert first != list(islice(MemoryCommander(6, ADDRESS).steps(), 50))


def test_files_to_load_have_their_checksum_except_one() -> None:
    good = []
    for path in LOADS:
        content = files(ADDRESS)[path][HEADER_SIZE:]
        size, check, _ = struct.unpack_from("<III", content, 72)
        assert len(content[88:]) == size
        good.append(crc16(content[88:]) == check)
    assert good == [True, True, True, False]


@needs_ram
@pytest.mark.slow
def test_commands_for_memory_give_the_answers_of_nasas_applications() -> None:
    assert BUILT is not None
    assert [flown for flown in memory_flight.fly(BUILT, 1, 60) if flown.lines] == []
