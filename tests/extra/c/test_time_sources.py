"""External inputs from C code to Time Services: times and tones; and calls reserved for the core."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.extra.c.building import compile_c, console_of, fly, fly_c, needs_compiler, said, write_mission

pytestmark = needs_compiler

DECLARED = """
    typedef struct { uint32_t seconds, subseconds; } Time;
    void CFE_TIME_ExternalMET(Time);
    void CFE_TIME_ExternalGPS(Time, int16_t);
    void CFE_TIME_ExternalTime(Time);
    void CFE_TIME_ExternalTone(void);
    void CFE_TIME_Local1HzISR(void);
    int16_t CFE_TIME_GetLeapSeconds(void);
"""


@pytest.mark.parametrize(("source", "call"), [("met", "MET(time)"), ("gps", "GPS(time, -3)"), ("time", "Time(time)")])
def test_external_time_is_accepted_when_the_mission_has_the_source(tmp_path: Path, source: str, call: str) -> None:
    code = f"""
        void TEST_Main(void)
        {{
            Time time = {{5000, 0}};
            OS_TaskDelay(2000);
            CFE_TIME_External{call};
            CFE_TIME_ExternalTone();
            CFE_TIME_Local1HzISR();
            OS_TaskDelay(2000);
            SAY("leap seconds %d", CFE_TIME_GetLeapSeconds());
        }}
    """
    compile_c(tmp_path, "TEST", DECLARED + code)
    folder = write_mission(tmp_path, "TEST")
    limits = f"time_cfg_source: true, time_cfg_src_{source}: true, time_cfg_fake_tone: false"
    (tmp_path / "mission.yaml").write_text(f"limits: {{{limits}}}\n", encoding="utf-8")
    mission = fly(folder, 6)
    assert said(console_of(mission)) == [f"leap seconds {-3 if source == 'gps' else 37}"]
    assert not mission.record.resets


def test_external_time_is_a_fault_when_the_mission_lacks_the_source(tmp_path: Path) -> None:
    console = fly_c(tmp_path, DECLARED + "void TEST_Main(void) { CFE_TIME_ExternalMET((Time){1, 0}); }")
    assert "CFE_TIME_ExternalMET() was called" in console


def test_the_core_deletes_blocks_of_the_critical_data_store(tmp_path: Path) -> None:
    console = fly_c(
        tmp_path,
        """
        int32_t CFE_ES_DeleteCDS(const char *, bool);
        int32_t CFE_ES_RegisterCDS(uint32_t *, size_t, const char *);
        void TEST_Main(void)
        {
            uint32_t block;
            CFE_ES_RegisterCDS(&block, 8, "Data");
            SAY("%08X", (unsigned)CFE_ES_DeleteCDS("TEST.Nothing", false));
            SAY("%08X", (unsigned)CFE_ES_DeleteCDS("TEST.Data", true));
            SAY("%08X", (unsigned)CFE_ES_DeleteCDS("TEST.Data", false));
        }
        """,
    )
    assert said(console) == ["C4000002", "C4000020", "C4000022"]
