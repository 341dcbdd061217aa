"""A C application whose packets are declared in its header, a data sheet and its debug data: names, and differences."""

from __future__ import annotations

import json
import shutil
from contextlib import chdir
from pathlib import Path

import pytest

from cfepy.cli.main import main
from cfepy.extra.c import build
from cfepy.extra.dictionaries import read_debug_data
from cfepy.ground import dictionary_of, names_of
from cfepy.mission import read_mission
from cfepy.msg import Command, Telemetry
from cfepy.pilot.mission_check import check_mission
from tests.extra.c.building import needs_compiler

pytestmark = needs_compiler

SHEET = """<PackageFile xmlns="http://www.ccsds.org/schema/sois/seds">
  <Package name="THERMAL">
    <DataTypeSet>
      <ContainerDataType name="CMD" baseType="CFE_HDR/CommandHeader"/>
      <ContainerDataType name="SetValueCmd" baseType="CMD">
        <ConstraintSet><ValueConstraint entry="Sec.FunctionCode" value="2"/></ConstraintSet>
        <EntryList>
          <Entry name="Value" type="BASE_TYPES/uint16" unit="degC"/>
          <Entry name="Spare" type="BASE_TYPES/uint16"/>
        </EntryList>
      </ContainerDataType>
      <ContainerDataType name="HkTlm" baseType="CFE_HDR/TelemetryHeader">
        <EntryList>
          <Entry name="CommandCounter" type="BASE_TYPES/uint8"/>
          <Entry name="CommandErrorCounter" type="BASE_TYPES/uint8"/>
          <Entry name="Value" type="BASE_TYPES/uint16" unit="degC"/>
          <Entry name="OutsideCounter" type="BASE_TYPES/uint16"/>
          <Entry name="Spare" type="BASE_TYPES/uint16"/>
        </EntryList>
      </ContainerDataType>
    </DataTypeSet>
    <ComponentSet>
      <Component name="Application">
        <RequiredInterfaceSet>
          <Interface name="CMD" type="CFE_SB/Telecommand">
            <GenericTypeMapSet><GenericTypeMap name="TelecommandDataType" type="CMD"/></GenericTypeMapSet>
          </Interface>
          <Interface name="HK_TLM" type="CFE_SB/Telemetry">
            <GenericTypeMapSet><GenericTypeMap name="TelemetryDataType" type="HkTlm"/></GenericTypeMapSet>
          </Interface>
        </RequiredInterfaceSet>
        <Implementation>
          <VariableSet>
            <Variable name="Cmd" initialValue="${CFE_MISSION/TELECOMMAND_BASE_TOPICID} + 0xBA"/>
            <Variable name="Hk" initialValue="${CFE_MISSION/TELEMETRY_BASE_TOPICID} + 0xBB"/>
          </VariableSet>
          <ParameterMapSet>
            <ParameterMap interface="CMD" parameter="TopicId" variableRef="Cmd"/>
            <ParameterMap interface="HK_TLM" parameter="TopicId" variableRef="Hk"/>
          </ParameterMapSet>
        </Implementation>
      </Component>
    </ComponentSet>
  </Package>
</PackageFile>
"""


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return new_app(tmp_path_factory.mktemp("template"))


def new_app(parent: Path) -> Path:
    """Build cfepy's template of an application in C, without its ground names in Python."""
    with chdir(parent):
        assert main(["new", "app", "thermal", "--c"]) == 0
    build(parent / "thermal")
    (parent / "thermal" / "thermal.py").unlink()
    return parent / "thermal"


@pytest.fixture
def thermal(built: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Copy the application, and give debug data a cache of its own."""
    (tmp_path / "cache").mkdir()
    monkeypatch.setattr("cfepy.extra.dictionaries.debug_cache.cache_folder", lambda: tmp_path / "cache")
    return Path(shutil.copytree(built, tmp_path / "thermal"))


def with_sheet(thermal: Path, text: str = SHEET) -> Path:
    """Write a data sheet into the mission's dictionary."""
    (thermal / "dictionary").mkdir()
    file = thermal / "dictionary" / "thermal.xml"
    file.write_text(text, encoding="utf-8")
    return file


def warnings_of(thermal: Path) -> list[str]:
    return [str(each) for each in check_mission(str(thermal))]


def test_debug_data_names_all_packets(thermal: Path) -> None:
    content = read_debug_data([thermal / "thermal.so"])
    found = {each.name: (each.msg_id, each.code, each.payload.size) for each in content.packets}
    assert found == {
        "THERMAL_NOOP": (0x18BA, 0, 0),
        "THERMAL_RESET_COUNTERS": (0x18BA, 1, 0),
        "THERMAL_SET_VALUE": (0x18BA, 2, 4),
        "THERMAL_SEND_HK": (0x18BB, None, 0),
        "THERMAL_HK_TLM": (0x08BB, None, 8),
    }
    packet = next(each for each in content.packets if each.name == "THERMAL_HK_TLM")
    assert packet.file.name == "thermal_msg.h"
    assert packet.structs == ("THERMAL_HkTlm_t",)


def test_cache_answers_the_second_time_and_heals(thermal: Path, tmp_path: Path) -> None:
    first = read_debug_data([thermal / "thermal.so"])
    (file,) = (tmp_path / "cache" / "packets").iterdir()
    again = read_debug_data([thermal / "thermal.so"])
    assert [(each.name, list(each.payload.cells())) for each in again.packets] == [
        (each.name, list(each.payload.cells())) for each in first.packets
    ]
    for damaged in ("{", "[]", json.dumps({"made_by": json.loads(file.read_text())["made_by"], "packets": [{}]})):
        file.write_text(damaged, encoding="utf-8")
        assert len(read_debug_data([thermal / "thermal.so"]).packets) == 5, damaged


def test_object_without_macros_declares_nothing(built: Path, thermal: Path) -> None:
    assert main(["build", str(thermal), "--no-debug", "--no-tables"]) == 0
    assert not read_debug_data([thermal / "thermal.so"]).packets


def test_command_and_telemetry_by_name_in_a_flight(thermal: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["cmd", str(thermal), "THERMAL_SET_VALUE", "Value=42", "--for", "2"]) == 0
    assert "THERMAL_SET_VALUE sent to THERMAL" in capsys.readouterr().out
    assert main(["cmd", str(thermal), "THERMAL_SEND_HK", "--for", "2"]) == 0
    assert "THERMAL_HK_TLM CommandCounter=0 CommandErrorCounter=0 Value=" in capsys.readouterr().out


def test_data_sheet_comes_before_debug_data(thermal: Path) -> None:
    with_sheet(thermal)
    dictionary = dictionary_of(read_mission(str(thermal)))
    packet = dictionary.telemetry["THERMAL_HK_TLM"]
    assert isinstance(packet, Telemetry)
    units = {cell.path: cell.measurement.unit for cell in packet.payload.cells() if cell.measurement is not None}
    assert units == {"Value": "degC"}
    assert isinstance(dictionary.commands["THERMAL_NOOP"], Command), "the sheet lacks it, the debug data has it"
    assert names_of(read_mission(str(thermal)))[0x18BA] == "THERMAL_CMD"


def test_equal_declarations_have_no_differences(thermal: Path) -> None:
    with_sheet(thermal)
    assert not [each for each in warnings_of(thermal) if "in the EDS, but" in each]


def test_check_names_sheet_header_and_debug_data_that_differ(thermal: Path, built: Path) -> None:
    file = with_sheet(
        thermal,
        SHEET.replace(
            'name="Value" type="BASE_TYPES/uint16" unit="degC"/>\n          <Entry name="Out',
            'name="Value" type="BASE_TYPES/uint32"/>\n          <Entry name="Out',
        ),
    )
    (found,) = [each for each in warnings_of(thermal) if "THERMAL_HK_TLM" in each]
    line = 1 + [each.strip() for each in file.read_text().splitlines()].index(
        '<Entry name="Value" type="BASE_TYPES/uint32"/>'
    )
    assert found.startswith(f"{file}:{line}: warning: THERMAL_HK_TLM.Value: is u32 at offset 4 in the EDS, ")
    header = built / "fsw" / "inc" / "thermal_msg.h"
    assert f"but u16 at offset 2 in the debug data of thermal.so (THERMAL_HkTlm_t, {header}:" in found


def test_check_names_a_header_that_is_newer_than_the_object(tmp_path: Path) -> None:
    folder = new_app(tmp_path)
    assert not [each for each in warnings_of(folder) if "header" in each or "build it again" in each]
    header = folder / "fsw" / "inc" / "thermal_msg.h"
    text = header.read_text(encoding="utf-8")
    old = "    uint16                    Value;\n    uint16                    OutsideCounter;"
    assert old in text
    header.write_text(text.replace(old, old.replace("uint16 ", "uint32 ", 1)), encoding="utf-8")
    (found,) = [each for each in warnings_of(folder) if "build it again" in each]
    line = 1 + text.splitlines().index("    uint16                    Value;")
    assert found == (
        f"{header}:{line}: warning: THERMAL_HkTlm_t.Value: is u32 here, but u16 in the debug data of thermal.so; "
        "build it again"
    ).replace(f"{Path.cwd()}/", "")


@pytest.mark.parametrize(
    ("old", "new", "text"),
    [
        (
            'value="2"',
            'value="7"',
            "THERMAL_SET_VALUE: has the code 7 in the EDS, but 2 in the debug data of",
        ),
        (
            "+ 0xBB",
            "+ 0xBC",
            "THERMAL_HK_TLM: has the MsgId 0x08BC in the EDS, but 0x08BB in the debug data of",
        ),
    ],
)
def test_other_code_or_msg_id_of_a_packet_is_named(thermal: Path, old: str, new: str, text: str) -> None:
    file = with_sheet(thermal, SHEET.replace(old, new))
    (found,) = [each for each in warnings_of(thermal) if " has the code " in each or " has the MsgId " in each]
    assert found.startswith(f"{file}:")
    assert text in found


def test_command_that_a_sheet_lacks_is_named(thermal: Path) -> None:
    with_sheet(thermal)
    found = [each for each in warnings_of(thermal) if "has no command with the code" in each]
    assert [each.partition("code ")[2][0] for each in found] == ["0", "1"]
    assert "unlike the debug data of thermal.so" in found[0]
    assert "(THERMAL_NOOP); add it" in found[0]


def test_problem_of_a_sheet_is_a_warning_and_not_an_end(thermal: Path) -> None:
    with_sheet(thermal, SHEET.replace('type="HkTlm"', 'type="Hk"'))
    assert any("unknown type THERMAL/Hk; did you mean THERMAL/HkTlm?" in each for each in warnings_of(thermal))
    assert "THERMAL_HK_TLM" in dictionary_of(read_mission(str(thermal))).telemetry


def test_mission_file_names_files_elsewhere(thermal: Path, tmp_path: Path) -> None:
    elsewhere = tmp_path / "sheets"
    elsewhere.mkdir()
    (elsewhere / "thermal.xml").write_text(SHEET, encoding="utf-8")
    (thermal / "mission.yaml").write_text("dictionary: [../sheets, gone.xml]\n", encoding="utf-8")
    assert any(
        each.startswith(str(thermal / "mission.yaml:1")) and "file not found" in each for each in warnings_of(thermal)
    )
    (thermal / "mission.yaml").write_text("dictionary: [../sheets]\n", encoding="utf-8")
    packet = dictionary_of(read_mission(str(thermal))).commands["THERMAL_SET_VALUE"]
    assert next(packet.payload.cells()).measurement is not None


def test_python_module_has_the_same_packets(thermal: Path, tmp_path: Path) -> None:
    with_sheet(thermal)
    made = tmp_path / "made.py"
    assert main(["export", "python", str(thermal), "-o", str(made)]) == 0
    names: dict[str, object] = {}
    exec(compile(made.read_text(encoding="utf-8"), str(made), "exec"), names)
    dictionary = dictionary_of(read_mission(str(thermal)))
    commands, telemetry = names["COMMANDS"], names["TELEMETRY"]
    assert isinstance(commands, tuple)
    assert isinstance(telemetry, tuple)
    assert {each.name for each in commands} == set(dictionary.commands)
    for each in (*commands, *telemetry):
        original = dictionary.commands.get(each.name) or dictionary.telemetry[each.name]
        assert each.msg_id == original.msg_id
        assert isinstance(original, Command | Telemetry)
        mine, theirs = (
            [(c.path, c.type, c.offset, c.measurement) for c in packet.payload.cells()] for packet in (each, original)
        )
        assert mine == theirs, each.name


def test_ctf_files_have_codes_and_parameters(thermal: Path, tmp_path: Path) -> None:
    assert main(["export", "ctf", str(thermal), "-o", str(tmp_path / "ccdd")]) == 0
    commands = json.loads((tmp_path / "ccdd" / "THERMAL_CMD_MID_interface.json").read_text(encoding="utf-8"))
    assert commands["cmd_mid_name"] == "THERMAL_CMD_MID"
    code = next(each for each in commands["cmd_codes"] if each["cc_value"] == "2")
    assert code["cc_name"] == "THERMAL_SET_VALUE_CC"
    assert [(each["name"], each["data_type"]) for each in code["cc_parameters"]] == [
        ("Value", "uint16"),
        ("Spare", "uint16"),
    ]
    telemetry = json.loads((tmp_path / "ccdd" / "CFE_ES_HK_TLM_MID_interface.json").read_text(encoding="utf-8"))
    assert telemetry["tlm_mid"] == "0x0800"


@pytest.mark.parametrize("name", ["rows.yaml", "rows.json"])
def test_table_file_by_a_struct_of_the_debug_data(thermal: Path, name: str) -> None:
    document = {"table": "THERMAL.Limits", "layout": "THERMAL_Limits_t", "rows": [{"Low": 3, "High": 700}]}
    (thermal / name).write_text(json.dumps(document), encoding="utf-8")
    assert main(["tbl", "build", str(thermal / name), "-o", str(thermal / "out.tbl")]) == 0
    assert (thermal / "out.tbl").read_bytes()[-4:] == bytes.fromhex("0300bc02")


def test_unknown_struct_of_a_table_is_named(thermal: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (thermal / "rows.yaml").write_text("table: THERMAL.Limits\nlayout: Nothing_t\nrows: []\n", encoding="utf-8")
    assert main(["tbl", "build", str(thermal / "rows.yaml")]) == 2
    assert "rows.yaml:2: layout: unknown struct Nothing_t; give the fields" in capsys.readouterr().err
