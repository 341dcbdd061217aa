"""Resource ids and their tables."""

from __future__ import annotations

import pytest

from cfepy import ids, status
from cfepy.ids import IdTable
from cfepy.status import CfeError, OsalError


def test_id_arithmetic() -> None:
    first_app = ids.make(ids.ES_APPID_BASE, 1)
    assert first_app == 0x110001
    assert ids.get_base(first_app) == 0x11
    assert ids.get_serial(first_app) == 1
    assert ids.to_index(first_app, ids.ES_APPID_BASE, 32) == 1
    assert ids.is_defined(first_app)
    assert not ids.is_defined(ids.UNDEFINED)
    assert ids.equal(first_app, ids.from_integer(ids.to_integer(first_app)))
    assert (ids.ES_POOLID_BASE, ids.SB_PIPEID_BASE) == (0x14, 0x16)


def test_to_index_refuses_another_kind() -> None:
    with pytest.raises(CfeError, match="CFE_ES_ERR_RESOURCEID_NOT_VALID"):
        ids.to_index(0x160001, ids.ES_APPID_BASE, 32)


def test_serial_wraps_into_the_table() -> None:
    assert ids.find_next(ids.make(0x11, 0xFFFE), 32, lambda _: False) == ids.make(0x11, 0xFFFF % 32)


def test_find_next_ex_uses_its_callbacks() -> None:
    assert ids.find_next_ex(0x110000, lambda i: i + 2, lambda i: i < 0x110006) == 0x110006
    assert ids.find_next_ex(0x110000, lambda i: 0, lambda i: True) == ids.UNDEFINED


def test_create_find_delete() -> None:
    table: IdTable[str] = IdTable(ids.SB_PIPEID_BASE, 3)
    first, second = table.create("a"), table.create("b")
    assert (first, second) == (0x160001, 0x160002)
    assert table.find(first) == table.get(first) == "a"
    assert table.at(table.index(second)) == "b"
    assert table.delete(first) == "a"
    assert table.find(first) is None
    assert table.create("c") == 0x160003
    assert list(table) == ["c", "b"]
    assert first not in table
    assert len(table) == 2


def test_full_table_raises_its_status() -> None:
    table: IdTable[int] = IdTable(ids.SB_PIPEID_BASE, 1, full=status.CFE_SB_MAX_PIPES_MET)
    table.create(1)
    with pytest.raises(CfeError, match="CFE_SB_MAX_PIPES_MET"):
        table.create(2)


def test_osal_tables_raise_osal_errors() -> None:
    table: IdTable[int] = IdTable(ids.OS_QUEUE_BASE, 1)
    table.create(1)
    with pytest.raises(OsalError, match="OS_ERR_NO_FREE_IDS"):
        table.create(2)
    with pytest.raises(OsalError, match="OS_ERR_INVALID_ID"):
        table.get(0x20009)
