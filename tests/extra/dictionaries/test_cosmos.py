"""Command and telemetry text of COSMOS: read against packets that NASA's cFE sent, and written."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from cfepy.extra.dictionaries import cosmos_text, read_cosmos
from cfepy.extra.dictionaries.packets import SourceContent
from cfepy.ground import dictionary_of
from cfepy.mission import read_mission
from cfepy.msg import BitLayout, Layout, Telemetry, command
from tests.extra.dictionaries.sheets import write_sheets
from tests.mission.flights import write_mission

RECORDED = json.loads((Path(__file__).parents[2] / "data" / "packets.json").read_text(encoding="utf-8"))
HEADER = """
  APPEND_ID_ITEM CCSDS_STREAMID 16 UINT 0x{:04X} "Packet Identification" BIG_ENDIAN
  APPEND_ITEM CCSDS_SEQUENCE 16 UINT "Sequence" BIG_ENDIAN
  APPEND_ITEM CCSDS_LENGTH 16 UINT "Length" BIG_ENDIAN
  APPEND_ITEM CCSDS_SECONDS 32 UINT "Time" BIG_ENDIAN
  APPEND_ITEM CCSDS_SUBSECS 16 UINT "Time" BIG_ENDIAN
  APPEND_ITEM CCSDS_SPARE 32 UINT "Spare"
"""
EVENT = f"""
# An event of cFE
TELEMETRY CFE EVS_LONG_EVENT_MSG LITTLE_ENDIAN "Event"
{HEADER.format(0x0808)}
  APPEND_ITEM APP_NAME 160 STRING "Application"
  APPEND_ITEM EVENT_ID 16 UINT
  APPEND_ITEM EVENT_TYPE 16 UINT "Type of the event"
    STATE DEBUG 1
    STATE INFORMATION 2
    STATE ERROR 3 RED
  APPEND_ITEM SPACECRAFT 32 UINT
  APPEND_ITEM PROCESSOR 32 UINT
  APPEND_ITEM MESSAGE 976 STRING "Text"
  APPEND_ARRAY_ITEM SPARE 8 UINT 16 "Spare bytes"
"""
COMMAND = """
COMMAND TO_LAB OUTPUT_ENABLE BIG_ENDIAN "Sends telemetry to an address"
  APPEND_ID_PARAMETER CCSDS_STREAMID 16 UINT MIN MAX 0x1880 "MsgId"
  APPEND_PARAMETER CCSDS_SEQUENCE 16 UINT MIN MAX 0xC000
  APPEND_PARAMETER CCSDS_LENGTH 16 UINT MIN MAX 17
  APPEND_ID_PARAMETER CCSDS_FC 8 UINT MIN MAX 6
  APPEND_PARAMETER CCSDS_CHECKSUM 8 UINT MIN MAX 0
  APPEND_PARAMETER DEST_IP 128 STRING "127.0.0.1" "Address"
"""
BITS = f"""
TELEMETRY TANK HK_TLM BIG_ENDIAN "Levels"
{HEADER.format(0x0820)}
  ITEM MODE 128 3 UINT "Mode"
  ITEM OPEN 131 1 UINT "Valve"
  ITEM COUNT 132 12 INT "Count"
  ITEM LEVEL 144 16 UINT "Level" LITTLE_ENDIAN
    UNITS Millimetres mm
    POLY_READ_CONVERSION -10.0 0.5
    LIMITS DEFAULT 1 ENABLED -5 0 50 90
  ITEM RAW 160 24 BLOCK "Bytes"
"""
X = "\n  APPEND_ITEM X 8 UINT"
BAD = {
    "COMMAND TANK": "COMMAND requires a target, a name, and BIG_ENDIAN or LITTLE_ENDIAN",
    "TELEMETRY TANK A BIG_ENDIAN\n  APPEND_ITEM X <%= bits %> UINT": "Ruby between <% and %> is not executed",
    "TELEMETRY TANK A BIG_ENDIAN\n  APPEND_ITEM X 8": "a type is missing; add it",
    "TELEMETRY TANK A BIG_ENDIAN\n  APPEND_ITEM X eight UINT": "must be a whole number, not 'eight'",
    "TELEMETRY TANK A BIG_ENDIAN\n  APPEND_ITEM X 8 WORD": "unknown type WORD; expected UINT, INT",
    "TELEMETRY TANK A BIG_ENDIAN\n  APPEND_ITEM X 0 STRING": "an item of variable size is not supported",
    "TELEMETRY TANK A BIG_ENDIAN\n  APPEND_ITEM X 12 LITTLE": "unknown type LITTLE",
    "TELEMETRY TANK A LITTLE_ENDIAN\n  APPEND_ITEM X 12 UINT": "a LITTLE_ENDIAN number that is not whole bytes",
    "TELEMETRY TANK A BIG_ENDIAN\n  APPEND_ITEM X 16 FLOAT": "a FLOAT has 32 or 64 bits, not 16",
    "TELEMETRY TANK A BIG_ENDIAN\n  ITEM X -8 8 UINT": "a place or size from the end of the packet is not supported",
    "TELEMETRY TANK A BIG_ENDIAN\n  APPEND_ITEM X 8 UINT\n  STATES ON 1": "unknown keyword STATES; did you mean STATE?",
    "TELEMETRY TANK A BIG_ENDIAN\n  STATE ON 1": "STATE requires an item above it; add one",
    "TELEMETRY TANK A BIG_ENDIAN\n  APPEND_ITEM X 8 STRING\n  STATE A 1": "STATE requires a UINT or an INT",
    "TELEMETRY TANK A BIG_ENDIAN\n  APPEND_ITEM X 99999999992 BLOCK": "is larger than 1,048,576 bytes",
    "TELEMETRY TANK A BIG_ENDIAN\n  APPEND_ITEM X 8 UINT": "A has no MsgId; add an ID item",
    f"TELEMETRY TANK A BIG_ENDIAN\n{HEADER.format(0x820)}{2 * X}": "X is declared twice",
}


def read(folder: Path, text: str) -> SourceContent:
    file = folder / "cmd_tlm.txt"
    file.write_text(text, encoding="utf-8")
    return read_cosmos([file])


def test_event_of_nasas_cfe_is_decoded(tmp_path: Path) -> None:
    content = read(tmp_path, EVENT)
    assert not content.problems
    (packet,) = content.packets
    assert (packet.name, packet.msg_id, packet.is_command) == ("CFE_EVS_LONG_EVENT_MSG", 0x0808, False)
    recorded = next(each for each in RECORDED["telemetry"] if each["mid"] == 0x0808)
    values = Telemetry(packet.name, packet.msg_id, packet.payload).read(bytes.fromhex(recorded["hex"]))
    assert values == {
        "APP_NAME": "TO_LAB",
        "EVENT_ID": 3,
        "EVENT_TYPE": 2,
        "SPACECRAFT": 66,
        "PROCESSOR": 1,
        "MESSAGE": "TO telemetry output enabled for IP 127.0.0.1",
        "SPARE": [0, 0],
    }


def test_command_has_the_bytes_that_nasas_cfe_took(tmp_path: Path) -> None:
    (packet,) = read(tmp_path, COMMAND).packets
    recorded = next(each for each in RECORDED["commands"] if each["mid"] == 0x1880 and each["fc"] == 6)
    assert (packet.msg_id, packet.code) == (0x1880, 6)
    made = command(packet.msg_id, packet.code or 0, packet.payload.pack(DEST_IP="127.0.0.1"))
    assert bytes(made).hex() == recorded["hex"]


def test_items_at_bits_have_units_and_limits(tmp_path: Path) -> None:
    (packet,) = read(tmp_path, BITS).packets
    assert isinstance(packet.payload, BitLayout)
    assert packet.payload.size == 7
    data = bytes.fromhex("bffe 6400 010203")
    assert packet.payload.unpack(data) == {"MODE": 5, "OPEN": 1, "COUNT": -2, "LEVEL": 100, "RAW": [1, 2, 3]}
    measured = next(cell.measurement for cell in packet.payload.cells() if cell.path == "LEVEL")
    assert measured is not None
    assert measured.text(100) == "40mm"
    assert measured.text(130) == "55mm[yellow>50]"
    assert packet.lines["LEVEL"] == 1 + BITS.splitlines().index('  ITEM LEVEL 144 16 UINT "Level" LITTLE_ENDIAN')


@pytest.mark.parametrize("text", BAD)
def test_bad_line_is_named_and_other_packets_stay(tmp_path: Path, text: str) -> None:
    content = read(tmp_path, f"{COMMAND}\n{text}\n{EVENT}")
    assert any(BAD[text] in str(each) for each in content.problems), list(map(str, content.problems))
    assert all(str(each).startswith(f"{tmp_path}/cmd_tlm.txt:") for each in content.problems)
    assert {"TO_LAB_OUTPUT_ENABLE", "CFE_EVS_LONG_EVENT_MSG"} <= {each.name for each in content.packets}


def test_table_has_rows_and_columns(tmp_path: Path) -> None:
    text = """
    TABLE TANK.Limits LITTLE_ENDIAN ROW_COLUMN 4 "Limits of levels"
      APPEND_PARAMETER LOW 16 UINT 0 100 1 "Low"
      APPEND_PARAMETER HIGH 16 UINT 0 100 99 "High"
    TABLE TANK.Name BIG_ENDIAN KEY_VALUE
      APPEND_PARAMETER NAME 64 STRING "TANK"
    """
    content = read(tmp_path, text)
    assert not content.problems
    first, second = content.tables
    assert (first.name, first.rows, first.text) == ("TANK.Limits", 4, "Limits of levels")
    assert type(first.row) is Layout
    assert first.row.pack(LOW=1, HIGH=2) == bytes([1, 0, 2, 0])
    assert (second.name, second.rows, second.row.size) == ("TANK.Name", 1, 8)
    bad = read(tmp_path, "TABLE TANK.Limits LITTLE_ENDIAN ROW_COLUMN 0")
    assert "a table has 1 to 100,000 rows, not 0" in str(bad.problems[0])


def test_plain_struct_becomes_a_plain_layout(tmp_path: Path) -> None:
    (packet,) = read(tmp_path, EVENT).packets
    assert type(packet.payload) is Layout


def test_written_text_is_read_back(tmp_path: Path) -> None:
    script = write_mission(tmp_path, "!\n")
    write_sheets(tmp_path / "dictionary")
    spec = read_mission(script)
    dictionary = dictionary_of(spec)
    content = read(tmp_path, cosmos_text(spec, dictionary))
    assert not content.problems
    found = {(each.msg_id, each.code or 0): each.payload for each in content.packets}
    assert dictionary.commands["TANK_SET_MODE"]
    assert dictionary.telemetry["TANK_HK_TLM"]
    for each in (*dictionary.commands.values(), *dictionary.telemetry.values()):
        assert not hasattr(each, "raw"), "a mission without ROS has no topics"
        code = getattr(each, "code", None) or 0
        layout = found[(each.msg_id, code)]
        assert layout.size == each.payload.size, each.name  # type: ignore[union-attr]
        mine = [(cell.start, cell.width) for cell in each.payload.cells()]  # type: ignore[union-attr]
        assert [(cell.start, cell.width) for cell in layout.cells()] == mine, each.name
