"""The Critical Data Store on memory that survives it: blocks, resets, and damage to every single bit."""

from __future__ import annotations

from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cfepy.es.cds import RECORD, SIGNATURE_BEGIN, SIGNATURE_END, CdsBlock, pack
from cfepy.es.pools import DESCRIPTOR
from cfepy.fs import crc16
from cfepy.psp.profile import load_profile
from cfepy.status import (
    CFE_ES_BAD_ARGUMENT,
    CFE_ES_BUFFER_NOT_IN_POOL,
    CFE_ES_CDS_ALREADY_EXISTS,
    CFE_ES_CDS_BLOCK_CRC_ERR,
    CFE_ES_CDS_INVALID_SIZE,
    CFE_ES_ERR_MEM_BLOCK_SIZE,
    CFE_ES_ERR_NAME_NOT_FOUND,
    CFE_ES_ERR_RESOURCEID_NOT_VALID,
    CFE_ES_NO_RESOURCE_IDS_AVAILABLE,
    CFE_SUCCESS,
    CfeError,
)
from dev.fuzz.cds_board import ENTRIES, SIZE, Board
from tests.statuses import status_of

POOL_AT = 12 + ENTRIES * RECORD.size
FIRST_BLOCK = 0x150001


EACH_OR_SOME = pytest.mark.parametrize("step", [5, pytest.param(1, marks=pytest.mark.slow)])
"""Every bit is left to the slow tests."""


def test_data_outlive_a_reset() -> None:
    board = Board()
    handle, status = board.cds.register(10, "APP.Data", is_table=False)
    assert (handle, status) == (FIRST_BLOCK, CFE_SUCCESS)
    assert board.cds.read(handle) == bytes(10)
    board.cds.write(handle, b"0123456789")
    after = board.boot()
    assert after.register(10, "APP.Data", is_table=False) == (handle, CFE_ES_CDS_ALREADY_EXISTS)
    assert after.read(handle) == b"0123456789"


def test_layout_of_the_memory_matches_c() -> None:
    board = Board()
    handle, _ = board.cds.register(10, "APP.Data", is_table=True)
    board.cds.write(handle, b"0123456789")
    memory = bytes(board.memory)
    assert memory.startswith(SIGNATURE_BEGIN + ENTRIES.to_bytes(4, "little"))
    assert memory.endswith(SIGNATURE_END)
    found, _, offset, size, name, is_table = RECORD.unpack_from(memory, 12 + RECORD.size)
    assert (found, offset, size, name.rstrip(b"\0"), is_table) == (handle, POOL_AT + 24, 14, b"APP.Data", True)
    assert DESCRIPTOR.unpack_from(memory, POOL_AT) == (0x5A5A, 0xAAAA + 16, 14, 0)  # the second smallest of 17 sizes
    assert memory[offset:].startswith(crc16(b"0123456789").to_bytes(4, "little") + b"0123456789")


def test_another_size_makes_a_new_block() -> None:
    board = Board()
    handle, _ = board.cds.register(10, "APP.Data", is_table=False)
    board.cds.write(handle, b"0123456789")
    again, status = board.cds.register(20, "APP.Data", is_table=False)
    assert (again, status) == (handle, CFE_SUCCESS)
    assert board.cds.read(handle) == bytes(20)
    assert board.cds.register(10, "APP.Other", is_table=False)[1] == CFE_SUCCESS
    assert board.cds.read(board.cds.named("APP.Other").handle) == bytes(10)


def test_a_new_size_without_room_keeps_name_and_handle() -> None:
    board = Board()
    cds = board.cds
    handle, _ = cds.register(10, "APP.Data", is_table=False)
    assert status_of(lambda: cds.register(40_000, "APP.Data", is_table=False)) == CFE_ES_ERR_MEM_BLOCK_SIZE
    assert (cds.named("APP.Data").handle, cds.named("APP.Data").user_size) == (handle, 0)
    assert status_of(lambda: cds.write(handle, b"0123456789")) == CFE_ES_BUFFER_NOT_IN_POOL
    assert status_of(lambda: cds.read(handle)) == CFE_ES_BUFFER_NOT_IN_POOL
    cds.register(4, "APP.Other", is_table=False)
    assert cds.register(12, "APP.Data", is_table=False) == (handle, CFE_SUCCESS)
    assert status_of(lambda: cds.register(40_000, "APP.Data", is_table=False)) == CFE_ES_ERR_MEM_BLOCK_SIZE
    cds.delete("APP.Data")
    assert cds.find("APP.Data") is None
    assert board.boot().find("APP.Other") is not None


def test_invalid_arguments_are_refused() -> None:
    board = Board()
    cds = board.cds
    assert status_of(lambda: cds.register(0, "A.A", is_table=False)) == CFE_ES_CDS_INVALID_SIZE
    assert status_of(lambda: cds.register(1 << 30, "A.A", is_table=False)) == CFE_ES_CDS_INVALID_SIZE
    assert status_of(lambda: cds.register(100_000, "A.A", is_table=False)) == CFE_ES_ERR_MEM_BLOCK_SIZE
    assert status_of(lambda: cds.register(40_000, "A.A", is_table=False)) == CFE_ES_ERR_MEM_BLOCK_SIZE
    for number in range(ENTRIES):
        cds.register(4, f"A.{number}", is_table=False)
    assert status_of(lambda: cds.register(4, "A.A", is_table=False)) == CFE_ES_NO_RESOURCE_IDS_AVAILABLE
    assert status_of(lambda: cds.get(FIRST_BLOCK + 100)) == CFE_ES_ERR_RESOURCEID_NOT_VALID
    assert status_of(lambda: cds.get(0)) == CFE_ES_ERR_RESOURCEID_NOT_VALID
    assert status_of(lambda: cds.named("A.A")) == CFE_ES_ERR_NAME_NOT_FOUND
    assert status_of(lambda: cds.write(cds.named("A.0").handle, b"12345")) == CFE_ES_BAD_ARGUMENT


def test_deleted_blocks_are_used_again_also_after_a_reset() -> None:
    board = Board()
    for name in ("A.A", "A.B", "A.C"):
        board.cds.register(12, name, is_table=False)
    place = board.cds.named("A.B").offset
    board.cds.delete("A.B")
    after = board.boot()
    assert [block.name for block in after] == ["A.A", "A.C"]
    after.register(12, "A.D", is_table=False)
    assert after.named("A.D").offset == place


def test_a_registry_of_another_size_is_not_taken_over() -> None:
    board = Board()
    board.cds.register(10, "APP.Data", is_table=False)
    board.entries = ENTRIES // 2
    assert list(board.boot()) == []
    assert board.log == [f"CFE_ES_RebuildCDS: Registry in CDS incorrect size ({ENTRIES})"]


def test_a_cds_that_is_too_small_is_not_available() -> None:
    board = Board(size=512)
    assert not board.cds.is_available
    assert board.log == ["CFE_ES_CDS_EarlyInit: CDS Size (512) less than required (852)"]


def small() -> Board:
    """Return three blocks, the middle one given back, so that every kind of byte is there."""
    board = Board()
    for name, data in (("A.One", b"first."), ("A.Gone", b"gone.."), ("B.Two", b"second")):
        handle, _ = board.cds.register(6, name, is_table=name == "B.Two")
        board.cds.write(handle, data)
    board.cds.delete("A.Gone")
    return board


def found(board: Board) -> dict[str, bytes | int]:
    """Return the owners' view after a reset: name to data, or the status of the attempt to read them."""
    contents: dict[str, bytes | int] = {}
    for name in ("A.One", "B.Two"):
        handle, status = board.cds.register(6, name, is_table=name == "B.Two")
        if status == CFE_ES_CDS_ALREADY_EXISTS:
            try:
                contents[name] = board.cds.read(handle)
            except CfeError as error:
                contents[name] = error.status
    return contents


GOOD = {"A.One": b"first.", "B.Two": b"second"}
TAIL = POOL_AT + 3 * (24 + 16)
"""Where the pool's blocks end: three descriptors with blocks of 16 bytes."""


def flips(start: int, end: int) -> list[int]:
    return list(range(start * 8, end * 8))


def after_flip(bit: int) -> Board:
    board = small()
    board.memory[bit // 8] ^= 1 << bit % 8
    board.boot()
    return board


def test_without_damage_all_is_found() -> None:
    board = small()
    board.boot()
    assert found(board) == GOOD
    assert board.log == []


@EACH_OR_SOME
def test_no_flip_of_a_bit_is_ever_taken_for_data(step: int) -> None:
    for bit in [*flips(0, TAIL), *flips(SIZE - 8, SIZE)][::step]:
        board = after_flip(bit)
        for name, content in found(board).items():
            assert content in (GOOD[name], CFE_ES_CDS_BLOCK_CRC_ERR), f"bit {bit}: {name} is {content!r}"


def test_flip_in_the_signatures_or_the_registry_size_makes_the_cds_anew() -> None:
    for bit in flips(0, 12) + flips(SIZE - 8, SIZE):
        board = after_flip(bit)
        assert board.log, f"bit {bit}"
        assert found(board) == {}
        assert status_of(lambda: board.cds.named("A.Gone")) == CFE_ES_ERR_NAME_NOT_FOUND  # noqa: B023


@EACH_OR_SOME
def test_every_flip_in_the_registry_costs_that_entry_alone(step: int) -> None:
    for bit in list(flips(12, POOL_AT))[::step]:
        board = after_flip(bit)
        slot = (bit // 8 - 12) // RECORD.size
        assert f"Entry {slot} of the CDS registry" in board.log[0], f"bit {bit}"
        lost = {1: "A.One", 3: "B.Two"}.get(slot)
        assert found(board) == {name: data for name, data in GOOD.items() if name != lost}


@pytest.mark.parametrize(("block", "name"), [(0, "A.One"), (2, "B.Two")])
def test_every_flip_in_a_block_is_found(block: int, name: str) -> None:
    start = POOL_AT + block * 40
    for bit in flips(start, start + 24):
        board = after_flip(bit)
        assert board.log, f"bit {bit} of the descriptor"
        assert name not in found(board)
    for bit in flips(start + 24, start + 24 + 4 + 6):
        assert found(after_flip(bit))[name] == CFE_ES_CDS_BLOCK_CRC_ERR, f"bit {bit} of the data"


def test_flip_while_running_is_found() -> None:
    for bit in flips(POOL_AT, POOL_AT + 24 + 10):
        board = small()
        board.memory[bit // 8] ^= 1 << bit % 8
        assert status_of(lambda: board.cds.read(FIRST_BLOCK)) != CFE_SUCCESS, f"bit {bit}"  # noqa: B023


def test_small_board_has_room_for_its_critical_tables() -> None:
    config = load_profile("rx64m").config()
    board = Board(config.es_cds_size, config.es_cds_max_num_entries)
    assert board.cds.is_available
    assert board.cds.register(128 * config.tbl_max_critical_tables, "CFE_TBL.CritReg", is_table=True)[1] == CFE_SUCCESS
    assert board.cds.register(1024, "APP.Table", is_table=True)[1] == CFE_SUCCESS


@given(st.randoms(use_true_random=False), st.integers(1, 40))
def test_any_damage_leaves_a_cds_that_works(chance: Random, bytes_hit: int) -> None:
    board = small()
    for _ in range(bytes_hit):
        board.memory[chance.randrange(12, TAIL)] = chance.randrange(256)
    board.boot()
    for content in found(board).values():
        assert content in (*GOOD.values(), CFE_ES_CDS_BLOCK_CRC_ERR)
    handle, _ = board.cds.register(12, "C.New", is_table=False)
    board.cds.write(handle, b"twelve bytes")
    assert board.boot().read(handle) == b"twelve bytes"


def test_second_record_of_a_block_is_dropped() -> None:
    board = Board()
    handle, _ = board.cds.register(6, "A.One", is_table=False)
    (block,) = board.cds
    twin = pack(CdsBlock(handle + 1, block.offset, block.size, "B.Two", is_table=False))
    board.memory[12 + 2 * RECORD.size : 12 + 3 * RECORD.size] = twin
    assert [block.name for block in board.boot()] == ["A.One"]
