"""Payload layouts against C's own."""

from __future__ import annotations

from typing import Any

import pytest

from cfepy import msg
from cfepy.msg import Layout
from cfepy.status import CfeError, UsageError
from tests.layouts import assert_same, c_structs
from tests.msg.golden import golden_telemetry

TIME = Layout("CFE_TIME_SysTime_t", [("Seconds", "u32"), ("Subseconds", "u32")])
C_TYPES = {
    "uint8": "u8",
    "uint16": "u16",
    "int16": "i16",
    "uint32": "u32",
    "int32": "i32",
    "_Bool": "bool",
    "CFE_ES_MemOffset_t": "u64",
    "CFE_ES_MemAddress_t": "u64",
    "CFE_SB_MsgId_t": "u32",
    "CFE_SB_PipeId_t": "u32",
    "CFE_ES_AppId_t": "u32",
    "CFE_ES_TaskId_t": "u32",
    "CFE_ResourceId_t": "u32",
    "CFE_ES_MemHandle_t": "u32",
    "CFE_ES_ExceptionAction_Enum_t": "u8",
    "CFE_ES_TaskPriority_Atom_t": "u16",
    "CFE_TIME_ClockState_Enum_t": "i16",
    "CFE_EVS_EventType_Enum_t": "u16",
    "CFE_SB_Qos_t": "u8[2]",
    "CFE_SB_RouteId_Atom_t": "u16",
}


def from_c(name: str) -> Layout:
    """Return a layout made of nothing but the field types of a C struct, in order."""
    return Layout(name, [(field.name, _kind(field.type)) for field in c_structs()[name].fields])


def _kind(c_type: str) -> Any:
    base, bracket, count = c_type.partition("[")
    if base == "char":
        return c_type
    if base in C_TYPES:
        return C_TYPES[base] + bracket + count
    inner = from_c(base)
    return (inner, int(count[:-1])) if bracket else inner


HK_PAYLOADS = [name for name in c_structs() if name.endswith("_Payload_t")]


@pytest.mark.parametrize("name", HK_PAYLOADS)
def test_payloads_have_the_layout_of_c(name: str) -> None:
    assert_same(from_c(name), name)


def test_payloads_include_all_services() -> None:
    assert {f"CFE_{service}_HousekeepingTlm_Payload_t" for service in ("ES", "EVS", "SB", "TBL", "TIME")} <= set(
        HK_PAYLOADS
    )


def test_housekeeping_survives_a_round_trip() -> None:
    names = {0x0800: "ES", 0x0803: "SB", 0x0805: "TIME"}
    seen = 0
    for golden in golden_telemetry():
        if golden["mid"] in names:
            layout = from_c(f"CFE_{names[golden['mid']]}_HousekeepingTlm_Payload_t")
            payload = bytes.fromhex(golden["hex"])[msg.TLM_HEADER_SIZE :]
            assert layout.pack(layout.unpack(payload)) == payload
            seen += 1
    assert seen >= 3


def test_nested_arrays_and_texts() -> None:
    layout = Layout("T", [("Flag", "bool"), ("At", (TIME, 2)), ("Names", "char[2][4]"), ("Grid", "i8[2][3]")])
    assert layout.offsets == {"Flag": 0, "At": 4, "Names": 20, "Grid": 28}
    assert layout.size == 36
    data = layout.pack(Flag=True, At=[{"Seconds": 1}], Names=["ab", "full"], Grid=[[1, -2]])
    assert layout.unpack(b"??" + data, 2) == {
        "Flag": True,
        "At": [{"Seconds": 1, "Subseconds": 0}, {"Seconds": 0, "Subseconds": 0}],
        "Names": ["ab", "full"],
        "Grid": [[1, -2, 0], [0, 0, 0]],
    }


def test_a_mapping_and_keywords_go_together() -> None:
    assert TIME.pack({"Seconds": 1, "Subseconds": 2}, Seconds=3) == TIME.pack(Seconds=3, Subseconds=2)


@pytest.mark.parametrize(
    ("values", "text"),
    [
        ({"Id": 256}, "Id: 256 does not fit u8; expected 0 to 255"),
        ({"Id": "x"}, "Id: must be a number, not 'x'"),
        ({"Id": 1.5}, "Id: must be an integer, not 1.5"),
        ({"Name": "12345"}, "Name: must have at most 4 bytes, not 5"),
        ({"Name": 7}, "Name: must be a text, not 7"),
        ({"At": [{}, {"Seconds": -1}]}, r"At\[1\].Seconds: -1 does not fit u32"),
        ({"At": [{}, {}, {}]}, "At: must have at most 2 items, not 3"),
        ({"At": [7]}, r"At\[0\]: must be a mapping"),
        ({"At": 7}, "At: must be a list, not 7"),
        ({"Real": 1e300}, "Real: 1e.300 does not fit f32"),
        ({"Nope": 1}, "Nope: unknown field of T; expected Id, Name, At or Real"),
    ],
)
def test_invalid_values_name_their_field(values: dict[str, Any], text: str) -> None:
    layout = Layout("T", [("Id", "u8"), ("Name", "char[4]"), ("At", (TIME, 2)), ("Real", "f32")])
    with pytest.raises(UsageError, match=text):
        layout.pack(values)


def test_a_short_buffer() -> None:
    with pytest.raises(CfeError, match="CFE_STATUS_WRONG_MSG_LENGTH"):
        TIME.unpack(b"1234567")


@pytest.mark.parametrize("kind", ["u7", "u8[", "", "char[x]"])
def test_invalid_types_are_refused(kind: str) -> None:
    with pytest.raises(UsageError, match="invalid type"):
        Layout("T", [("Field", kind)])


def test_a_field_twice() -> None:
    with pytest.raises(UsageError, match=r"T\.A: is declared twice"):
        Layout("T", [("A", "u8"), ("A", "u8")])


def test_cells_have_every_number_and_text_with_its_place() -> None:
    inner = Layout("Inner", [("Id", "u8"), ("Name", "char[3]")])
    outer = Layout(
        "Outer", [("A", "u8"), ("B", "u32"), ("In", (inner, 2)), ("Grid", "u16[2][2]"), ("Names", "char[2][2]")]
    )
    assert [tuple(cell)[:4] for cell in outer.cells()] == [
        ("A", "u8", 0, 1),
        ("B", "u32", 4, 4),
        ("In[0].Id", "u8", 8, 1),
        ("In[0].Name", "char[3]", 9, 3),
        ("In[1].Id", "u8", 12, 1),
        ("In[1].Name", "char[3]", 13, 3),
        ("Grid[0][0]", "u16", 16, 2),
        ("Grid[0][1]", "u16", 18, 2),
        ("Grid[1][0]", "u16", 20, 2),
        ("Grid[1][1]", "u16", 22, 2),
        ("Names[0]", "char[2]", 24, 2),
        ("Names[1]", "char[2]", 26, 2),
    ]
    assert outer.size == 28
