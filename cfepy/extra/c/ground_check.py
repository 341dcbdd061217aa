"""Ground names of a compiled application, compared with the structs in its debug data.

`heater.py` beside `heater.so` declares packets and tables for the ground a second time. A layout is compared with the
struct of the same name. A struct that begins with a packet's header is compared behind it, and one whose only other
field is a struct, such as NASA's `Payload`, is compared with that.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from cfepy.extra.c.structs import BIT_FIELD, CStruct, FieldType, StructField, structs_of
from cfepy.ground import DeclaredField, DeclaredLayout, declared_layouts
from cfepy.mission import find_compiled, find_declarations
from cfepy.pilot import MissionProblem
from cfepy.reading.input_files import read_limited
from cfepy.reading.input_limits import OBJECT_BYTES
from cfepy.reading.suggestions import did_you_mean, listed

_HEADERS = ("CFE_MSG_CommandHeader", "CFE_MSG_TelemetryHeader")
_FILLERS = ("spare", "pad", "reserved", "_")
_BYTES = ("u8", "i8", "char", "bool")
"""Types of one byte, among which the ground may choose, because they are only shown differently."""
_OPAQUE = ("union", "pointer", BIT_FIELD)
REMEDY = "correct the layout, or build again if the header is newer"


def ground_differences(path: str, folder: Path) -> Iterator[MissionProblem]:
    """Yield the layouts that disagree with the structs of a compiled application.

    Args:
        path: virtual path of the application, as in the startup script.
        folder: folder of the mission; declarations elsewhere are not its own.
    """
    library = find_compiled(path, folder)
    code = find_declarations(path, folder)
    if library is None or not isinstance(code, Path) or not code.is_relative_to(folder):
        return
    declared = declared_layouts(code)
    if not (declared.layouts or declared.unread):
        return
    structs = structs_of(read_limited(library, OBJECT_BYTES))
    if not structs.has_debug_data:
        text = f"its layouts cannot be compared with {library.name}, which has no debug data; compile with -g"
        yield MissionProblem(code, 0, text, is_warning=True)
        return
    for file, line in declared.unread:
        text = f"the layout cannot be compared with {library.name}; write its fields as a list of names and types"
        yield MissionProblem(file, line, text, is_warning=True)
    bases = [each.base for whole in declared.layouts for each in whole.fields.values()]
    nested = {id(base.layout) for base in bases if not isinstance(base, str)}
    for each in declared.layouts:
        found = structs.find(each.name)
        if found is not None and not each.hand_packed:
            yield from _compare(each, _payload(found, each), library.name)
        elif found is None and id(each.layout) not in nested and each.fields:
            hint = did_you_mean(each.name, structs.struct_names(), "give the layout the name of its struct")
            text = f"{library.name} has no struct {each.name} to compare this layout with; {hint}"
            yield MissionProblem(each.file, each.line, text, is_warning=True)


def _payload(struct: CStruct, declared: DeclaredLayout) -> CStruct:
    """Return a struct without the header of a packet, with offsets from the end of the header."""
    if not struct.fields or not _is_header(struct, 0):
        return struct
    header, *rest = struct.fields
    start = header.offset + header.type.size
    if len(rest) == 1 and not isinstance(rest[0].type.base, str) and not rest[0].type.counts:
        inner = rest[0].type.base
        if rest[0].name not in declared.fields:
            return inner._replace(name=f"{struct.name}.{rest[0].name}")
    moved = tuple(each._replace(offset=each.offset - start) for each in rest)
    return CStruct(struct.name, struct.size - start, moved, struct.typedefs[1:])


def _is_header(struct: CStruct, number: int) -> bool:
    base = struct.fields[number].type.base
    names = (struct.typedefs[number], "" if isinstance(base, str) else base.name)
    return any(name.removesuffix("_t") in _HEADERS for name in names)


def _compare(declared: DeclaredLayout, struct: CStruct, library: str, path: str = "") -> Iterator[MissionProblem]:
    """Yield the differences of one layout; differences that follow from an earlier one are left out."""
    shown = path or declared.name
    differs = False
    for problem in (*_fields_of(declared, struct, library, shown), *_missing(declared, struct, library, shown)):
        differs = True
        yield problem
    if not differs and declared.layout.size != struct.size:
        text = f"{shown}: has {declared.layout.size} bytes here, but {struct.size} in {library}"
        yield MissionProblem(declared.file, declared.line, f"{text}; {REMEDY}", is_warning=True)


def _fields_of(declared: DeclaredLayout, struct: CStruct, library: str, shown: str) -> Iterator[MissionProblem]:
    moved = False
    for name, field in declared.fields.items():
        if _is_filler(name):
            continue
        offset, found = declared.layout.offsets[name], struct.field(name)
        here = f"{field.written} at offset {offset}"
        if found is None:
            there = _at(struct, offset)
            hint = did_you_mean(name, [each.name for each in struct.fields], REMEDY)
            text = f"is {here} here, but {library} has {there} there; {hint}"
        elif not _same_type(field, declared.layout.sizes[name], found.type):
            text = f"is {here} here, but {found.type} at offset {found.offset} in {library}; {REMEDY}"
        elif offset != found.offset and not moved:
            text = f"is {here} here, but at offset {found.offset} in {library}; {REMEDY}"
        else:
            yield from _inside(field, found, library, f"{shown}.{name}")
            continue
        moved = True
        yield MissionProblem(declared.file, field.line, f"{shown}.{name}: {text}", is_warning=True)


def _inside(field: DeclaredField, found: StructField, library: str, shown: str) -> Iterator[MissionProblem]:
    """Yield the differences of a nested struct of another name; one of the same name is compared by itself."""
    if isinstance(field.base, str) or isinstance(found.type.base, str) or field.base.name == found.type.base.name:
        return
    yield from _compare(field.base, found.type.base, library, shown)


def _missing(declared: DeclaredLayout, struct: CStruct, library: str, shown: str) -> Iterator[MissionProblem]:
    missing = [each for each in struct.fields if each.name not in declared.fields and not _is_filler(each.name)]
    starts = [declared.layout.offsets[name] for name in declared.fields]
    missing = [each for each in missing if each.offset not in starts]  # reported with the field that is there
    if missing:
        said = listed((f"{each.name} ({each.type} at offset {each.offset})" for each in missing), "and")
        text = f"{shown}: has no {said}, unlike {library}; {REMEDY}"
        yield MissionProblem(declared.file, declared.line, text, is_warning=True)


def _at(struct: CStruct, offset: int) -> str:
    """Return the field of a struct that has an offset."""
    for each in struct.fields:
        if each.offset <= offset < each.offset + max(each.type.size, 1):
            return f"{each.name} ({each.type})"
    return "no field"


def _is_filler(name: str) -> bool:
    return name.lower().startswith(_FILLERS)


def _same_type(field: DeclaredField, size: int, found: FieldType) -> bool:
    base, counts = found.base, found.counts
    while isinstance(base, CStruct) and isinstance(field.base, str) and len(base.fields) == 1:
        inner = base.fields[0].type  # an id is often a struct of its own
        base, counts = inner.base, counts + inner.counts
    if isinstance(base, str) and base in _OPAQUE:
        return base == BIT_FIELD or size == found.size
    if isinstance(field.base, str) != isinstance(base, str):
        return False
    if not isinstance(field.base, str):
        return counts == field.counts
    same = field.base == base or (field.base in _BYTES and base in _BYTES)
    return same and (counts or (1,)) == (field.counts or (1,))
