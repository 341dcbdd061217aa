"""C's own view of cFE's structs, for tests: size and offset of every field as the compiler of NASA's x86-64 build laid
them out (tests/data/layouts.txt), and a check of a `Layout` against it."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import NamedTuple

from cfepy.msg import Layout

DATA = Path(__file__).parent / "data"


class CField(NamedTuple):
    """A field of a C struct. `type` is C's, with "[N]" for an array."""

    name: str
    offset: int
    size: int
    type: str


class CStruct(NamedTuple):
    """A C struct."""

    name: str
    size: int
    fields: tuple[CField, ...]


@cache
def c_structs() -> dict[str, CStruct]:
    """Return every struct of the file, by name."""
    found: dict[str, CStruct] = {}
    for block in (DATA / "layouts.txt").read_text(encoding="utf-8").replace("\n  ", "\t").splitlines():
        head, *rows = block.split("\t")
        name, size = head.split()
        found[name] = CStruct(name, int(size), tuple(_field(row) for row in rows))
    return found


def _field(row: str) -> CField:
    offset, size, kind, declared = row.split()
    name, bracket, count = declared.partition("[")
    return CField(name, int(offset), int(size), kind + bracket + count)


def assert_same(layout: Layout, c_name: str) -> None:
    """A layout has C's size, field names, offsets and field sizes."""
    c = c_structs()[c_name]
    assert layout.size == c.size
    assert list(layout.fields) == [field.name for field in c.fields]
    assert layout.offsets == {field.name: field.offset for field in c.fields}
    assert layout.sizes == {field.name: field.size for field in c.fields}
