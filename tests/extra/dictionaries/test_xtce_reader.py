"""XTCE documents as a source: cfepy reads its own documents back, and documents of other tools."""

from __future__ import annotations

import random
from pathlib import Path

import pytest

from cfepy.extra.dictionaries import read_document, read_xtce
from cfepy.extra.dictionaries.packets import SourceContent
from cfepy.ground import dictionary_of, flat
from cfepy.ground.xtce import xtce_of
from cfepy.mission import read_mission
from cfepy.msg import Telemetry
from tests.extra.dictionaries.sheets import write_sheets
from tests.mission.flights import write_mission

HEADER = """
      <IntegerParameterType name="u3"><IntegerDataEncoding sizeInBits="3"/></IntegerParameterType>
      <IntegerParameterType name="u1"><IntegerDataEncoding sizeInBits="1"/></IntegerParameterType>
      <IntegerParameterType name="u11"><IntegerDataEncoding sizeInBits="11"/></IntegerParameterType>
      <BinaryParameterType name="rest"><BinaryDataEncoding><SizeInBits><FixedValue>112</FixedValue></SizeInBits>
      </BinaryDataEncoding></BinaryParameterType>
"""
OWN = """
      <EnumeratedParameterType name="mode"><IntegerDataEncoding sizeInBits="8"/>
        <EnumerationList><Enumeration value="1" label="On"/></EnumerationList></EnumeratedParameterType>
      <IntegerParameterType name="le16" signed="true">
        <IntegerDataEncoding sizeInBits="16" encoding="twosComplement" byteOrder="leastSignificantByteFirst"/>
      </IntegerParameterType>
      <AggregateParameterType name="row"><MemberList><Member name="a" typeRef="mode"/><Member name="b" typeRef="le16"/>
      </MemberList></AggregateParameterType>
      <ArrayParameterType name="rows" arrayTypeRef="row"><DimensionList><Dimension>
        <StartingIndex><FixedValue>0</FixedValue></StartingIndex><EndingIndex><FixedValue>1</FixedValue></EndingIndex>
      </Dimension></DimensionList></ArrayParameterType>
"""
DOCUMENT = f"""<xtce:SpaceSystem name="TANK" xmlns:xtce="http://www.omg.org/spec/XTCE/20180204">
  <TelemetryMetaData>
    <ParameterTypeSet>{HEADER}{OWN}</ParameterTypeSet>
    <ParameterSet>
      <Parameter name="V" parameterTypeRef="u3"/><Parameter name="T" parameterTypeRef="u1"/>
      <Parameter name="S" parameterTypeRef="u1"/><Parameter name="A" parameterTypeRef="u11"/>
      <Parameter name="R" parameterTypeRef="rest"/>
      <Parameter name="Mode" parameterTypeRef="mode"/><Parameter name="Rows" parameterTypeRef="rows"/>
    </ParameterSet>
    <ContainerSet>
      <SequenceContainer name="Header" abstract="true"><EntryList>
        <ParameterRefEntry parameterRef="V"/><ParameterRefEntry parameterRef="T"/><ParameterRefEntry parameterRef="S"/>
        <ParameterRefEntry parameterRef="A"/><ParameterRefEntry parameterRef="R"/>
      </EntryList></SequenceContainer>
      <SequenceContainer name="TankHk"><EntryList>
        <ParameterRefEntry parameterRef="Mode"/>
        <ParameterRefEntry parameterRef="Rows">
          <LocationInContainerInBits><FixedValue>8</FixedValue></LocationInContainerInBits></ParameterRefEntry>
      </EntryList><BaseContainer containerRef="/TANK/Header"><RestrictionCriteria><ComparisonList>
        <Comparison parameterRef="T" value="0"/><Comparison parameterRef="S" value="1"/>
        <Comparison parameterRef="A" value="32"/>
      </ComparisonList></RestrictionCriteria></BaseContainer></SequenceContainer>
    </ContainerSet>
  </TelemetryMetaData>
</xtce:SpaceSystem>
"""
BAD = {
    ('parameterRef="Mode"', 'parameterRef="Mood"'): "<ParameterRefEntry>: unknown name Mood; did you mean Mode?",
    ('containerRef="/TANK/Header"', 'containerRef="Head"'): "unknown container Head; did you mean Header?",
    ('containerRef="/TANK/Header"', 'containerRef="TankHk"'): "is derived from itself",
    ('sizeInBits="11"', 'sizeInBits="eleven"'): "must be a whole number, not 'eleven'",
    ('sizeInBits="11"', 'sizeInBits="99"'): "a number of 99 bits is not supported",
    ('encoding="twosComplement"', 'encoding="BCD"'): "the encoding 'BCD' is not supported",
    ('arrayTypeRef="row"', 'arrayTypeRef="rows"'): "the type rows contains itself",
    (
        "<EndingIndex><FixedValue>1",
        "<EndingIndex><FixedValue>999999999",
    ): "an array of 1000000000 items is not possible",
    ("<SizeInBits><FixedValue>112</FixedValue></SizeInBits>", ""): "a variable size is not supported",
    (
        "<FixedValue>8</FixedValue></Loc",
        "<DynamicValue/></Loc",
    ): "a place that depends on other values is not supported",
    ('<Comparison parameterRef="A" value="32"/>', ""): "",
    ('<Comparison parameterRef="T" value="0"/>', '<Comparison parameterRef="T"/>'): "missing attribute value",
    ('value="1" label="On"', 'label="On"'): "missing attribute value",
}


def read(folder: Path, text: str) -> SourceContent:
    file = folder / "tank.xml"
    file.write_text(text, encoding="utf-8")
    return read_xtce([read_document(file)])


def test_document_with_aggregates_and_places_is_read(tmp_path: Path) -> None:
    content = read(tmp_path, DOCUMENT)
    assert not content.problems
    (packet,) = content.packets
    assert (packet.name, packet.msg_id, packet.payload.size) == ("TANK_HK", 0x0820, 8)
    values = Telemetry(packet.name, packet.msg_id, packet.payload).read(bytes(16) + bytes.fromhex("0100 01feff 000200"))
    assert values == {"Mode": 1, "Rows": [{"a": 1, "b": -2}, {"a": 0, "b": 2}]}
    assert next(packet.payload.cells()).names is not None


def test_container_without_base_is_the_row_of_a_table(tmp_path: Path) -> None:
    row = '<SequenceContainer name="Row"><EntryList><ParameterRefEntry parameterRef="Rows"/></EntryList>'
    content = read(tmp_path, DOCUMENT.replace("</ContainerSet>", f"{row}</SequenceContainer></ContainerSet>"))
    assert not content.problems
    layout = content.layout("Row")
    assert layout is not None
    assert layout.pack(Rows=[{"a": 1, "b": 2}]).hex() == "010200000000"
    assert content.layout("Nothing") is None


@pytest.mark.parametrize("change", BAD)
def test_bad_part_is_named_with_file_and_line(tmp_path: Path, change: tuple[str, str]) -> None:
    assert change[0] in DOCUMENT
    content = read(tmp_path, DOCUMENT.replace(*change))
    if not BAD[change]:
        assert content.packets[0].msg_id == 0x0800
        return
    (found,) = map(str, content.problems)
    assert BAD[change] in found
    assert found.startswith(f"{tmp_path}/tank.xml:")


def test_written_document_is_read_back(tmp_path: Path) -> None:
    script = write_mission(tmp_path, "!\n")
    write_sheets(tmp_path / "dictionary")
    dictionary = dictionary_of(read_mission(script))
    content = read(tmp_path, xtce_of("mission", dictionary))
    assert not content.problems
    found = {(each.msg_id, each.code or 0): each.payload for each in content.packets}
    draw = random.Random(4)
    for each in (*dictionary.commands.values(), *dictionary.telemetry.values()):
        assert isinstance(each, Telemetry) or hasattr(each, "code")
        layout = found[(each.msg_id, getattr(each, "code", None) or 0)]
        assert layout.size == each.payload.size, each.name  # type: ignore[union-attr]
        data = draw.randbytes(layout.size)
        mine = flat(each.payload.unpack(data))  # type: ignore[union-attr]
        assert repr(list(flat(layout.unpack(data)).values())) == repr(list(mine.values())), each.name
