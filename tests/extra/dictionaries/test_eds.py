"""Electronic data sheets: types, packets, tables, and errors of bad ones."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.extra.dictionaries import memory_layout, read_document, wire_layout
from cfepy.msg import BitLayout, Layout
from cfepy.status import UsageError
from tests.extra.dictionaries.sheets import COMPONENT, TOPICS, TYPES, sheet, sheets_of, write_sheets

BAD_TYPES = {
    '<Entry name="A" type="Nothing"/>': "<Entry A>: unknown type TANK/Nothing; add the file that defines it",
    '<Entry name="A" type="BASE_TYPES/unit8"/>': "did you mean BASE_TYPES/uint8?",
    '<Entry name="A" type="Self"/>': "the type TANK/Self contains itself",
    '<Entry name="A" type="Mode"/><Entry name="A" type="Mode"/>': "<Entry A>: is declared twice",
    '<Entry type="Mode"/>': "<Entry>: missing attribute name",
    '<PaddingEntry sizeInBits="0"/>': "sizeInBits must be from 1 to",
    '<PaddingEntry sizeInBits="${TANK/MISSING}"/>': "unknown parameter TANK/MISSING",
    '<PaddingEntry sizeInBits="9 ^ 99"/>': "a value is larger than 2 ^ 128",
    f'<PaddingEntry sizeInBits="{"-" * 990}1"/>': "sizeInBits must be a whole number or a sum of such",
    '<PaddingEntry sizeInBits="1 +"/>': "a number is missing",
    '<PaddingEntry sizeInBits="8 / 0"/>': "must be a whole number or a sum of such",
    '<ListEntry name="A" type="Mode"/>': "a list of variable length is not supported",
}


def texts(folder: Path, text: str, topics: str = TOPICS) -> list[str]:
    return [str(problem) for problem in sheets_of(folder, text, topics).content().problems]


def test_packets_have_names_codes_and_layouts(tmp_path: Path) -> None:
    content = sheets_of(tmp_path).content()
    assert not content.problems
    found = {each.name: (each.msg_id, each.code, each.payload.size) for each in content.packets}
    assert found == {
        "TANK_NOOP": (0x1820, 0, 0),
        "TANK_SET_MODE": (0x1820, 3, 24),
        "TANK_SEND_HK": (0x1821, None, 0),
        "TANK_HK_TLM": (0x0820, None, 12),
    }
    assert content.names == {0x1820: "TANK_CMD", 0x1821: "TANK_SEND_HK", 0x0820: "TANK_HK_TLM"}


def test_fields_have_names_of_values_units_and_lines(tmp_path: Path) -> None:
    content = sheets_of(tmp_path).content()
    packet = next(each for each in content.packets if each.name == "TANK_SET_MODE")
    cells = {cell.path: cell for cell in packet.payload.cells()}
    assert {path: (cell.type, cell.offset) for path, cell in cells.items()} == {
        "Mode": ("u8", 0),
        "Level": ("u16", 2),
        "Reason": ("char[20]", 4),
    }
    assert cells["Mode"].names is not None
    assert cells["Mode"].names.number("fill") == 2
    assert cells["Level"].measurement is not None
    assert cells["Level"].measurement.unit == "mm"
    line = sheet().splitlines().index('          <Entry name="Level" type="BASE_TYPES/uint16" unit="mm"/>') + 1
    assert packet.lines["Level"] == line
    assert packet.text == "Sets the mode"


def test_table_has_rows_of_its_type(tmp_path: Path) -> None:
    tables = {each.name: each for each in sheets_of(tmp_path).content().tables}
    assert (tables["TANK.Limits"].rows, tables["TANK.Limits"].row.fields) == (4, ("Low", "High"))
    assert tables["TANK.LimitsTable"].row.size == 4, "a type with the name of a table is one, too"


def test_memory_is_little_endian_and_aligned_and_the_wire_as_declared(tmp_path: Path) -> None:
    types = (
        '<ContainerDataType name="Mixed"><EntryList><Entry name="Byte" type="BASE_TYPES/uint8"/>'
        '<Entry name="Word" type="BASE_TYPES/uint32"/></EntryList></ContainerDataType>'
    )
    found = sheets_of(tmp_path, sheet(TYPES + types)).types.type("TANK/Mixed")
    values = {"Byte": 1, "Word": 0x01020304}
    memory, wire = memory_layout(found), wire_layout(found)  # type: ignore[arg-type]
    assert type(memory) is Layout
    assert memory.pack(values).hex() == "0100000004030201"
    assert wire.pack(values).hex() == "0101020304"


def test_bits_share_bytes_from_the_highest_one_on(tmp_path: Path) -> None:
    types = (
        '<IntegerDataType name="U3"><IntegerDataEncoding sizeInBits="3" encoding="unsigned"/></IntegerDataType>'
        '<IntegerDataType name="I5"><IntegerDataEncoding sizeInBits="5" encoding="twosComplement"/></IntegerDataType>'
        '<ContainerDataType name="Bits"><EntryList><Entry name="A" type="U3"/><Entry name="B" type="I5"/>'
        '<Entry name="Flag" type="BASE_TYPES/StatusBit"/><PaddingEntry sizeInBits="7"/></EntryList></ContainerDataType>'
    )
    layout = memory_layout(sheets_of(tmp_path, sheet(TYPES + types)).types.type("TANK/Bits"))  # type: ignore[arg-type]
    assert isinstance(layout, BitLayout)
    assert layout.pack(A=5, B=-2, Flag=True).hex() == "be80"
    assert layout.unpack(bytes.fromhex("be80")) == {"A": 5, "B": -2, "Flag": True}


@pytest.mark.parametrize("entry", BAD_TYPES)
def test_bad_entry_is_named_with_file_and_line(tmp_path: Path, entry: str) -> None:
    types = TYPES.replace('<Entry name="CommandCounter" type="BASE_TYPES/uint8"/>', entry)
    types = types.replace('name="HkTlm_Payload"', 'name="Self"').replace('type="HkTlm_Payload"', 'type="Self"')
    (found,) = texts(tmp_path, sheet(types))
    assert BAD_TYPES[entry] in found
    place, line, *_ = found.split(":")
    assert place == str(tmp_path / "tank.xml")
    assert int(line) > 1


def test_packets_without_error_stay(tmp_path: Path) -> None:
    text = sheet(TYPES.replace('type="BASE_TYPES/float"', 'type="Nothing"'))
    content = sheets_of(tmp_path, text).content()
    assert {each.name for each in content.packets} == {"TANK_NOOP", "TANK_SET_MODE", "TANK_SEND_HK"}


def test_telemetry_of_a_topic_of_commands_is_refused(tmp_path: Path) -> None:
    (found,) = texts(tmp_path, sheet(), TOPICS.replace("${CFE_MISSION/TELEMETRY_BASE_TOPICID} + 2 * (8 + 8)", "20"))
    assert found.endswith("the topic 20 is not one of telemetry; correct the mission's cfe-topicids.xml")


def test_interface_without_topic_is_refused(tmp_path: Path) -> None:
    component = COMPONENT.replace('<ParameterMap interface="HK_TLM"', '<ParameterMap interface="OTHER"')
    (found,) = texts(tmp_path, sheet(component=component))
    assert "<Interface HK_TLM>: has no TopicId" in found


def test_parameter_that_contains_itself_is_refused(tmp_path: Path) -> None:
    topics = TOPICS.replace('name="SENSORS" value="3"', 'name="SENSORS" value="${TANK/SENSORS} + 1"')
    assert any("the parameter TANK/SENSORS contains itself" in each for each in texts(tmp_path, sheet(), topics))


def test_huge_arrays_are_refused_before_they_are_made(tmp_path: Path) -> None:
    types = TYPES
    for number in range(9):
        item = "BASE_TYPES/uint8" if number == 0 else f"A{number - 1}"
        dimensions = '<DimensionList><Dimension size="100"/></DimensionList>'
        types += f'<ArrayDataType name="A{number}" dataTypeRef="{item}">{dimensions}</ArrayDataType>'
    text = sheet(types.replace('type="BASE_TYPES/float"', 'type="A8"'))
    assert any("the array is larger than" in each or "is larger than" in each for each in texts(tmp_path, text))


def test_types_inside_each_other_without_end_are_refused(tmp_path: Path) -> None:
    types = TYPES + "".join(f'<AliasDataType name="T{number}" type="T{number + 1}"/>' for number in range(80))
    text = sheet(types.replace('type="BASE_TYPES/float"', 'type="T0"'))
    assert any("types are nested more than 60 deep" in each for each in texts(tmp_path, text))


def test_entities_are_not_expanded(tmp_path: Path) -> None:
    bomb = '<!DOCTYPE a [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;">]>\n'
    file, _ = write_sheets(tmp_path, sheet().replace("<PackageFile", bomb + "<PackageFile", 1))
    with pytest.raises(UsageError, match="entity 'b' must be a short text") as caught:
        read_document(file)
    assert (caught.value.file, caught.value.line) == (str(file), 2)


@pytest.mark.parametrize("cut", range(40, 2000, 197))
def test_truncated_file_has_an_error_with_its_line(tmp_path: Path, cut: int) -> None:
    file, _ = write_sheets(tmp_path, sheet()[:cut])
    with pytest.raises(UsageError, match="is not XML") as caught:
        read_document(file)
    assert caught.value.file == str(file)
    assert caught.value.line


def test_number_without_encoding_attribute_is_signed_as_in_edslib(tmp_path: Path) -> None:
    types = TYPES.replace(
        '<IntegerDataEncoding sizeInBits="8" encoding="unsigned"/>', '<IntegerDataEncoding sizeInBits="8"/>'
    )
    content = sheets_of(tmp_path, sheet(types)).content()
    packet = next(each for each in content.packets if each.name == "TANK_SET_MODE")
    assert next(packet.payload.cells()).type == "i8"
