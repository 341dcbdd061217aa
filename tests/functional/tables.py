"""The table of CFE_TEST: two numbers of 16 bits, and NASA's file for it."""

from __future__ import annotations

import struct
from pathlib import Path

from cfepy.app import Cfe
from cfepy.tbl import TableHandle
from tests.functional.harness import APP

NAME = "TestTable"
FULL_NAME = f"{APP}.{NAME}"
NUMBERS = struct.Struct("<HH")
SIZE = NUMBERS.size
BAD_HANDLE = -1
FILE = (Path(__file__).parents[1] / "data" / "cfe_test_tbl.tbl").read_bytes()
IN_FILE = (0xF007, 0xBA11)


def register(cfe: Cfe, name: str = NAME, options: int = 0) -> TableHandle:
    """Return the handle of a table of the usual size."""
    return cfe.tbl.register(name, SIZE, options)


def content(cfe: Cfe, handle: int) -> tuple[tuple[int, ...], bool]:
    """Return a table's numbers, and whether they were updated. The address is released."""
    view, is_updated = cfe.tbl.get_address(handle)
    numbers = NUMBERS.unpack(view)
    cfe.tbl.release_address(handle)
    return numbers, is_updated
