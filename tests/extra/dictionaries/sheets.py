"""Electronic data sheets for tests: an application TANK with commands, telemetry and a table."""

from __future__ import annotations

from pathlib import Path

from cfepy.extra.dictionaries import DataSheets, read_document

TOPICS = """
<DesignParameters>
  <Package name="CFE_MISSION">
    <Define name="TANK_CMD_TOPICID" value="${CFE_MISSION/TELECOMMAND_BASE_TOPICID} + 0x20"/>
    <Define name="TANK_SEND_HK_TOPICID" value="${CFE_MISSION/TANK_CMD_TOPICID} + 1"/>
    <Define name="TANK_HK_TLM_TOPICID" value="${CFE_MISSION/TELEMETRY_BASE_TOPICID} + 2 * (8 + 8)"/>
  </Package>
  <Package name="TANK"><Define name="SENSORS" value="3"/></Package>
</DesignParameters>
"""
TYPES = """
      <EnumeratedDataType name="Mode">
        <EnumerationList><Enumeration label="Off" value="0"/><Enumeration label="Fill" value="2"/></EnumerationList>
        <IntegerDataEncoding sizeInBits="8" encoding="unsigned"/>
      </EnumeratedDataType>
      <ArrayDataType name="Levels" dataTypeRef="BASE_TYPES/uint16">
        <DimensionList><Dimension size="${TANK/SENSORS}"/></DimensionList>
      </ArrayDataType>
      <ContainerDataType name="SetMode_Payload">
        <EntryList>
          <Entry name="Mode" type="Mode"/>
          <PaddingEntry sizeInBits="8"/>
          <Entry name="Level" type="BASE_TYPES/uint16" unit="mm"/>
          <Entry name="Reason" type="BASE_TYPES/ApiName"/>
        </EntryList>
      </ContainerDataType>
      <ContainerDataType name="HkTlm_Payload">
        <EntryList>
          <Entry name="CommandCounter" type="BASE_TYPES/uint8"/>
          <Entry name="Mode" type="Mode"/>
          <Entry name="Levels" type="Levels"/>
          <Entry name="Flow" type="BASE_TYPES/float"/>
        </EntryList>
      </ContainerDataType>
      <ContainerDataType name="CommandBase" baseType="CFE_HDR/CommandHeader"/>
      <ContainerDataType name="SendHkCmd" baseType="CFE_HDR/CommandHeader"/>
      <ContainerDataType name="NoopCmd" baseType="CommandBase">
        <ConstraintSet><ValueConstraint entry="Sec.FunctionCode" value="0"/></ConstraintSet>
      </ContainerDataType>
      <ContainerDataType name="SetModeCmd" baseType="CommandBase" shortDescription="Sets the mode">
        <ConstraintSet><ValueConstraint entry="Sec.FunctionCode" value="3"/></ConstraintSet>
        <EntryList><Entry name="Payload" type="SetMode_Payload"/></EntryList>
      </ContainerDataType>
      <ContainerDataType name="HkTlm" baseType="CFE_HDR/TelemetryHeader">
        <EntryList><Entry name="Payload" type="HkTlm_Payload"/></EntryList>
      </ContainerDataType>
      <ContainerDataType name="LimitsRow">
        <EntryList>
          <Entry name="Low" type="BASE_TYPES/uint16"/>
          <Entry name="High" type="BASE_TYPES/uint16"/>
        </EntryList>
      </ContainerDataType>
      <ArrayDataType name="LimitsTable" dataTypeRef="LimitsRow">
        <DimensionList><Dimension size="4"/></DimensionList>
      </ArrayDataType>
"""
COMPONENT = """
      <Component name="Application">
        <RequiredInterfaceSet>
          <Interface name="CMD" type="CFE_SB/Telecommand">
            <GenericTypeMapSet><GenericTypeMap name="TelecommandDataType" type="CommandBase"/></GenericTypeMapSet>
          </Interface>
          <Interface name="SEND_HK" type="CFE_SB/Telecommand">
            <GenericTypeMapSet><GenericTypeMap name="TelecommandDataType" type="SendHkCmd"/></GenericTypeMapSet>
          </Interface>
          <Interface name="HK_TLM" type="CFE_SB/Telemetry" shortDescription="Housekeeping">
            <GenericTypeMapSet><GenericTypeMap name="TelemetryDataType" type="HkTlm"/></GenericTypeMapSet>
          </Interface>
          <Interface name="Limits" type="CFE_TBL/Table">
            <GenericTypeMapSet><GenericTypeMap name="TableDataType" type="LimitsTable"/></GenericTypeMapSet>
          </Interface>
        </RequiredInterfaceSet>
        <Implementation>
          <VariableSet>
            <Variable type="BASE_TYPES/uint16" name="Cmd" initialValue="${CFE_MISSION/TANK_CMD_TOPICID}"/>
            <Variable type="BASE_TYPES/uint16" name="SendHk" initialValue="${CFE_MISSION/TANK_SEND_HK_TOPICID}"/>
            <Variable type="BASE_TYPES/uint16" name="Hk" initialValue="${CFE_MISSION/TANK_HK_TLM_TOPICID}"/>
          </VariableSet>
          <ParameterMapSet>
            <ParameterMap interface="CMD" parameter="TopicId" variableRef="Cmd"/>
            <ParameterMap interface="SEND_HK" parameter="TopicId" variableRef="SendHk"/>
            <ParameterMap interface="HK_TLM" parameter="TopicId" variableRef="Hk"/>
          </ParameterMapSet>
        </Implementation>
      </Component>
"""


def sheet(types: str = TYPES, component: str = COMPONENT) -> str:
    """Return the text of TANK's data sheet."""
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n<PackageFile xmlns="http://www.ccsds.org/schema/sois/seds">\n'
        f'  <Package name="TANK">\n    <DataTypeSet>{types}    </DataTypeSet>\n'
        f"    <ComponentSet>{component}    </ComponentSet>\n  </Package>\n</PackageFile>\n"
    )


def write_sheets(folder: Path, text: str | None = None, topics: str = TOPICS) -> list[Path]:
    """Write the data sheet and the parameters of its mission; returns the files."""
    files = [folder / "tank.xml", folder / "topics.xml"]
    folder.mkdir(parents=True, exist_ok=True)
    files[0].write_text(sheet() if text is None else text, encoding="utf-8")
    files[1].write_text(topics.lstrip(), encoding="utf-8")
    return files


def sheets_of(folder: Path, text: str | None = None, topics: str = TOPICS) -> DataSheets:
    """Return TANK's data sheets; see `write_sheets`."""
    return DataSheets([read_document(file) for file in write_sheets(folder, text, topics)])
