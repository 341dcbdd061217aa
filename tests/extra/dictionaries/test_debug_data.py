"""Packets of a shared object, read from its debug data alone."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.extra.dictionaries import read_debug_data
from cfepy.msg import BitLayout
from tests.extra.c.building import compile_c, needs_compiler

pytestmark = needs_compiler

FLAGS = ("-g3", "-fno-eliminate-unused-debug-types")
SOURCE = """
    #define TANK_CMD_MID 0x1820
    #define TANK_HK_TLM_MID 0x0820
    #define TANK_NOOP_CC 0
    #define TANK_SET_MODE_CC TANK_Code_SET_MODE
    #define TANK_DISABLE_PUMPS_CC 5
    #define TANK_DUMP_CC 6
    #define OTHER_CC 7
    typedef struct { uint8_t Bytes[8]; } CFE_MSG_CommandHeader_t;
    typedef struct { uint8_t Bytes[16]; } CFE_MSG_TelemetryHeader_t;
    enum TANK_Codes { TANK_Code_SET_MODE = 3 };
    typedef enum { TANK_MODE_OFF, TANK_MODE_FILL = 2 } TANK_Mode_t;
    typedef struct { CFE_MSG_CommandHeader_t Header; } TANK_NoArgsCmd_t;
    typedef struct { CFE_MSG_CommandHeader_t Header; TANK_Mode_t Mode; } TANK_SetModeCmd_t;
    typedef struct { TANK_Mode_t Modes[2]; union { float Real; uint32_t Word; } Either; void *Place; } TANK_Pay_t;
    typedef struct { CFE_MSG_TelemetryHeader_t Header; TANK_Pay_t Payload; } TANK_HkPacket_t;
    typedef struct { CFE_MSG_CommandHeader_t Header; unsigned Low : 3; unsigned High : 5; } TANK_DumpCmd_t;
    int TANK_DisablePumpCmd(const TANK_NoArgsCmd_t *command) { return command->Header.Bytes[0]; }
    void TANK_Main(void) { OS_TaskDelay(1); }
"""


@pytest.fixture(autouse=True)
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Give debug data a cache of its own."""
    monkeypatch.setattr("cfepy.extra.dictionaries.debug_cache.cache_folder", lambda: tmp_path)


def test_macros_structs_and_functions_belong_together(tmp_path: Path) -> None:
    library = compile_c(tmp_path, "tank", SOURCE, *FLAGS)
    for _ in range(2):  # the second time from the cache
        packets = {each.name: each for each in read_debug_data([library]).packets}
        found = {name: (each.msg_id, each.code, each.payload.size) for name, each in packets.items()}
        assert found == {
            "TANK_NOOP": (0x1820, 0, 0),
            "TANK_SET_MODE": (0x1820, 3, 4),
            "TANK_DISABLE_PUMPS": (0x1820, 5, 0),
            "TANK_HK_TLM": (0x0820, None, 24),
        }
        mode = next(packets["TANK_SET_MODE"].payload.cells())
        assert mode.names is not None
        assert dict(mode.names.values) == {"OFF": 0, "FILL": 2}
        shape = {cell.path: cell.type for cell in packets["TANK_HK_TLM"].payload.cells()}
        assert shape["Modes[1]"] == "u32"
        assert shape["Either[3]"] == "u8"
        assert shape["Place[7]"] == "u8"


def test_bit_fields_of_c_have_no_layout(tmp_path: Path) -> None:
    library = compile_c(tmp_path, "tank", SOURCE, *FLAGS)
    content = read_debug_data([library])
    assert content.layout("TANK_DumpCmd_t") is None
    layout = content.layout("TANK_SetModeCmd_t")
    assert layout is not None
    assert layout.size == 12
    assert not isinstance(layout, BitLayout)
