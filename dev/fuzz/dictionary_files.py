"""Files of a dictionary to damage: data sheets, text of COSMOS, XTCE, headers and macros."""

from __future__ import annotations

from pathlib import Path

from cfepy.extra.c.macros import Macro, Macros
from cfepy.extra.dictionaries import DataSheets, read_cosmos, read_document, read_xtce
from cfepy.extra.dictionaries.c_header import header_difference
from cfepy.extra.dictionaries.packets import SourceContent

SHEET = """<PackageFile xmlns="http://www.ccsds.org/schema/sois/seds">
  <Package name="TANK">
    <DataTypeSet>
      <EnumeratedDataType name="Mode"><EnumerationList><Enumeration label="Off" value="0"/><Enumeration label="On"/>
        </EnumerationList><IntegerDataEncoding sizeInBits="8" encoding="unsigned"/></EnumeratedDataType>
      <IntegerDataType name="Index"><Range><MinMaxRange min="0" max="2" rangeType="inclusiveMinInclusiveMax"/></Range>
      </IntegerDataType>
      <ArrayDataType name="Levels" dataTypeRef="BASE_TYPES/uint16"><DimensionList><Dimension size="3"/>
        <Dimension indexTypeRef="Index"/></DimensionList></ArrayDataType>
      <AliasDataType name="Name" type="BASE_TYPES/ApiName"/>
      <ContainerDataType name="Cmd" baseType="CFE_HDR/CommandHeader"/>
      <ContainerDataType name="SetCmd" baseType="Cmd">
        <ConstraintSet><ValueConstraint entry="Sec.FunctionCode" value="3"/></ConstraintSet>
        <EntryList><Entry name="Mode" type="Mode"/><PaddingEntry sizeInBits="24"/><Entry name="Name" type="Name"/>
        <FixedValueEntry name="Key" type="BASE_TYPES/uint32" fixedValue="7"/></EntryList>
      </ContainerDataType>
      <ContainerDataType name="Hk" baseType="CFE_HDR/TelemetryHeader">
        <EntryList><Entry name="Levels" type="Levels"/><Entry name="Open" type="BASE_TYPES/StatusBit"/>
        <Entry name="Flow" type="BASE_TYPES/float" unit="l/s"/></EntryList>
      </ContainerDataType>
    </DataTypeSet>
    <ComponentSet><Component name="Application">
      <RequiredInterfaceSet>
        <Interface name="CMD" type="CFE_SB/Telecommand"><GenericTypeMapSet><GenericTypeMap name="T" type="Cmd"/>
        </GenericTypeMapSet></Interface>
        <Interface name="HK_TLM" type="CFE_SB/Telemetry"><GenericTypeMapSet><GenericTypeMap name="T" type="Hk"/>
        </GenericTypeMapSet></Interface>
        <Interface name="Table" type="CFE_TBL/Table"><GenericTypeMapSet><GenericTypeMap name="T" type="Levels"/>
        </GenericTypeMapSet></Interface>
      </RequiredInterfaceSet>
      <Implementation><VariableSet>
        <Variable name="Cmd" initialValue="${CFE_MISSION/TELECOMMAND_BASE_TOPICID} + 2 * (3 + 0x10)"/>
        <Variable name="Hk" initialValue="${CFE_MISSION/HS_HK_TLM_TOPICID} + 2 ^ 3 - 1"/>
      </VariableSet><ParameterMapSet>
        <ParameterMap interface="CMD" parameter="TopicId" variableRef="Cmd"/>
        <ParameterMap interface="HK_TLM" parameter="TopicId" variableRef="Hk"/>
      </ParameterMapSet></Implementation>
    </Component></ComponentSet>
  </Package>
</PackageFile>
"""
COSMOS = """
COMMAND TANK SET BIG_ENDIAN "Sets the mode"
  APPEND_ID_PARAMETER CCSDS_STREAMID 16 UINT MIN MAX 0x1820 "MsgId"
  APPEND_PARAMETER CCSDS_SEQUENCE 16 UINT MIN MAX 0xC000
  APPEND_PARAMETER CCSDS_LENGTH 16 UINT MIN MAX 5
  APPEND_ID_PARAMETER CCSDS_FC 8 UINT MIN MAX 3
  APPEND_PARAMETER CCSDS_CHECKSUM 8 UINT MIN MAX 0
  APPEND_PARAMETER MODE 8 UINT 0 3 1 "Mode" LITTLE_ENDIAN
    STATE OFF 0
    STATE ON 1 GREEN
  PARAMETER NAME 72 160 STRING "A" "Name"
  APPEND_ARRAY_PARAMETER LEVELS 16 INT 48 "Levels"
TELEMETRY TANK HK_TLM LITTLE_ENDIAN "Levels"
  ID_ITEM CCSDS_STREAMID 0 16 UINT 0x0820 "MsgId" BIG_ENDIAN
  ITEM MODE 128 3 UINT "Mode"
  ITEM LEVEL 144 16 UINT "Level"
    UNITS Millimetres mm
    POLY_READ_CONVERSION -10.0 0.5
    LIMITS DEFAULT 1 ENABLED -5 0 50 90
  ITEM RAW 160 24 BLOCK "Bytes"
"""
XTCE = """<SpaceSystem name="TANK" xmlns="http://www.omg.org/spec/XTCE/20180204">
  <TelemetryMetaData>
    <ParameterTypeSet>
      <IntegerParameterType name="u16"><UnitSet><Unit>V</Unit></UnitSet><IntegerDataEncoding sizeInBits="16">
        <DefaultCalibrator><PolynomialCalibrator><Term coefficient="0.5" exponent="1"/></PolynomialCalibrator>
        </DefaultCalibrator></IntegerDataEncoding><DefaultAlarm><StaticAlarmRanges><WarningRange minInclusive="1"/>
        </StaticAlarmRanges></DefaultAlarm></IntegerParameterType>
      <StringParameterType name="text"><StringDataEncoding><SizeInBits><Fixed><FixedValue>112</FixedValue></Fixed>
        </SizeInBits></StringDataEncoding></StringParameterType>
      <AggregateParameterType name="row"><MemberList><Member name="a" typeRef="u16"/></MemberList>
        </AggregateParameterType>
      <ArrayParameterType name="rows" arrayTypeRef="row"><DimensionList><Dimension><StartingIndex>
        <FixedValue>0</FixedValue></StartingIndex><EndingIndex><FixedValue>3</FixedValue></EndingIndex></Dimension>
        </DimensionList></ArrayParameterType>
    </ParameterTypeSet>
    <ParameterSet><Parameter name="Id" parameterTypeRef="u16"/><Parameter name="Rest" parameterTypeRef="text"/>
      <Parameter name="Rows" parameterTypeRef="rows"/></ParameterSet>
    <ContainerSet>
      <SequenceContainer name="Head" abstract="true"><EntryList><ParameterRefEntry parameterRef="Id"/>
        <ParameterRefEntry parameterRef="Rest"/></EntryList></SequenceContainer>
      <SequenceContainer name="Hk"><EntryList><ParameterRefEntry parameterRef="Rows"><LocationInContainerInBits>
        <FixedValue>8</FixedValue></LocationInContainerInBits></ParameterRefEntry></EntryList>
        <BaseContainer containerRef="Head"><RestrictionCriteria><Comparison parameterRef="Id" value="2080"/>
        </RestrictionCriteria></BaseContainer></SequenceContainer>
    </ContainerSet>
  </TelemetryMetaData>
  <CommandMetaData>
    <ArgumentTypeSet><FloatArgumentType name="f32"><FloatDataEncoding sizeInBits="32"/></FloatArgumentType>
    </ArgumentTypeSet>
    <MetaCommandSet><MetaCommand name="Set"><ArgumentList><Argument name="Level" argumentTypeRef="f32"/></ArgumentList>
      <CommandContainer name="Set"><EntryList><FixedValueEntry binaryValue="1820c00000050300" sizeInBits="64"/>
      <ArgumentRefEntry argumentRef="Level"/></EntryList></CommandContainer></MetaCommand></MetaCommandSet>
  </CommandMetaData>
</SpaceSystem>
"""
HEADER = """/* TANK */
#define TANK_CMD_MID TO_MIDV(CMD)
#define TO_MIDV(topic) (BASE_##topic | (0x20 + 3))
#define BASE_CMD ((uint16)0x1800 << (2 - 1 * 2))
typedef struct { CFE_MSG_TelemetryHeader_t Header; uint8 Mode; /* mode */ uint16 Levels[3]; float Flow; } TANK_Hk_t;
"""
MEMBERS = (("Mode", "u8", 1), ("Levels", "u16", 3), ("Flow", "f32", 1))


def data_sheet(data: bytes, path: Path) -> None:
    """A data sheet, with all its packets."""
    _use(DataSheets([read_document(path)]).content())


def cosmos(data: bytes, path: Path) -> None:
    """A file of COSMOS."""
    _use(read_cosmos([path]))


def xtce(data: bytes, path: Path) -> None:
    """A document of XTCE."""
    _use(read_xtce([read_document(path)]))


def c_header(data: bytes, path: Path) -> None:
    """A C header with macros and a struct."""
    header_difference(path, "TANK_Hk_t", MEMBERS)
    known: dict[str, Macro] = {}
    for line in data.decode("utf-8", "replace").splitlines():
        words = line.partition("#define ")[2].split(" ", 1)
        if len(words) == 2:
            name, bracket, parameters = words[0].partition("(")
            known[name] = Macro(tuple(parameters.rstrip(")").split(",")) if bracket else None, words[1])
    for name in known:
        Macros(known).value(name, {"CMD": 1})


def _use(content: SourceContent) -> None:
    for packet in content.packets:
        packet.payload.pack(packet.payload.unpack(bytes(packet.payload.size)))
