"""CFE_PSP_*: the board and its memory, as C code sees them; status codes are NASA's."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.mission import Mission
from cfepy.psp import PanicError
from cfepy.writing.console import Console
from tests.extra.c.building import compile_c, console_of, fly, fly_c, needs_compiler, said, write_mission

pytestmark = needs_compiler
HEADER = '#include "psp.h"\n#define DID(call) SAY("%d", (int)(call))\n'


def program(body: str, before: str = "") -> str:
    """Return an application with this main function. DID prints the result of a call."""
    return f"{HEADER}{before}\nvoid TEST_Main(void)\n{{\n{body}\n}}\n"


def results(folder: Path, body: str, *, before: str = "", memory: str = "linux") -> list[str]:
    """Return the output of a main function's body."""
    (folder / "mission.yaml").write_text(f"memory: {memory}\n", encoding="utf-8")
    return said(fly_c(folder, program(body, before), 2))


def test_processor_identity_and_time_are_reported(tmp_path: Path) -> None:
    body = """
        uint32_t subtype, seconds, ns;
        int64_t time, later;
        char text[12];
        SAY("%u %u %s %s", CFE_PSP_GetProcessorId(), CFE_PSP_GetSpacecraftId(), CFE_PSP_GetProcessorName(),
            CFE_PSP_GetVersionString());
        DID(CFE_PSP_GetRestartType(&subtype));
        SAY("%u %u", subtype, CFE_PSP_GetRestartType(NULL));
        CFE_PSP_GetTime(&time);
        CFE_PSP_Get_Timebase(&seconds, &ns);
        DID(time / 10000000 == seconds && ns > 0);
        DID(CFE_PSP_GetTimerTicksPerSecond());
        do CFE_PSP_GetTime(&later); while (later < time + 1000);
        SAY("%s", CFE_PSP_StatusToString(-21, text));
        CFE_PSP_WatchdogSet(5000);
        DID(CFE_PSP_WatchdogGet());
        DID(CFE_PSP_InitSSR(0, 0, "SSR"));
    """
    assert results(tmp_path, body) == [*("1 66 cpu1 v7.0.0+dev0", "2", "1 2", "1", "1000000000", "-21", "5000", "-1")]


def test_the_order_of_bytes(tmp_path: Path) -> None:
    body = """
        SAY("%x %x", CFE_PSP_HtoBE16(0x1234), CFE_PSP_BE32toH(0x12345678));
        DID(CFE_PSP_HtoBE64(0x1122334455667788) == 0x8877665544332211);
        DID(CFE_PSP_LE64toH(0x1122334455667788) == 0x1122334455667788);
        SAY("%d %d", CFE_PSP_IsBigEndian(), CFE_PSP_IsLittleEndian());
    """
    assert results(tmp_path, body) == ["3412 78563412", "1", "1", "0 1"]


def test_the_memory_of_compiled_code_is_a_range(tmp_path: Path) -> None:
    before = "static uint32_t word = 0x11223344, other;"
    body = """
        uint64_t at = (uint64_t)&word;
        uint8_t byte;
        uint16_t half;
        uint32_t found, kind, attributes;
        uint64_t start;
        size_t size, word_size;
        DID(CFE_PSP_MemValidateRange(at, 4, 1));
        DID(CFE_PSP_MemValidateRange(at, 4, 2));
        DID(CFE_PSP_MemValidateRange(at, 4, 9));
        DID(CFE_PSP_MemValidateRange(16, 4, 3));
        DID(CFE_PSP_MemRead8(at, &byte));
        DID(CFE_PSP_MemRead16(at + 2, &half));
        DID(CFE_PSP_MemRead32(at, &found));
        SAY("%x %x %x", byte, half, found);
        DID(CFE_PSP_MemRead16(at + 1, &half));
        DID(CFE_PSP_MemRead8(16, &byte));
        DID(CFE_PSP_MemRead8(at + (1ull << 32), &byte));
        DID(CFE_PSP_MemRead8(at, NULL));
        DID(CFE_PSP_MemWrite8(at, 0xAA));
        DID(CFE_PSP_MemWrite16(at + 2, 0xBBCC));
        SAY("%x", word);
        DID(CFE_PSP_MemWrite32(at, 5));
        DID(CFE_PSP_MemCpy(&other, &word, 4));
        DID(other);
        DID(CFE_PSP_MemSet(&other, 1, 4));
        SAY("%x", other);
        DID(CFE_PSP_MemCpy(NULL, &word, 4));
        DID(CFE_PSP_MemSet(NULL, 1, 4));
        DID(CFE_PSP_MemRanges());
        DID(CFE_PSP_MemRangeGet(3, &kind, &start, &size, &word_size, &attributes));
        DID(kind == 1 && start <= at && at < start + size);
        DID(CFE_PSP_MemRangeGet(3, &kind, NULL, &size, &word_size, &attributes));
        DID(CFE_PSP_MemRangeGet(10, &kind, &start, &size, &word_size, &attributes));
        DID(CFE_PSP_MemRangeSet(4, 1, at, 4, 4, 3));
        DID(CFE_PSP_MemRangeSet(4, 1, at, 4, 3, 3));
    """
    assert results(tmp_path, body, before=before, memory="ranges") == [
        *("0", "-21", "-22", "-21", "0", "0", "0", "44 1122 11223344", "-3", "-21", "-21", "-2"),
        *("0", "0", "bbcc33aa", "0", "0", "5", "0", "1010101", "-1", "-1", "10", "0", "1", "-2", "-23", "0", "-24"),
    ]


def test_the_eeprom_is_read_by_pointer_and_written_by_function(tmp_path: Path) -> None:
    body = """
        uint32_t kind, attributes;
        uint64_t start;
        size_t size, word_size;
        uint8_t byte;
        CFE_PSP_MemRangeGet(1, &kind, &start, &size, &word_size, &attributes);
        SAY("%u %zx", kind, size);
        DID(CFE_PSP_MemValidateRange(start, size, 2));
        DID(CFE_PSP_MemValidateRange(start, size + 1, 2));
        DID(CFE_PSP_EepromWrite8(start + 1, 7));
        DID(CFE_PSP_EepromWrite32(start + 4, 0x12345678));
        SAY("%d %x", ((uint8_t *)start)[1], ((uint32_t *)start)[1]);
        DID(CFE_PSP_MemWrite8(start, 1));
        DID(CFE_PSP_MemRead8(0x10000001, &byte));
        DID(byte);
        DID(CFE_PSP_EepromWriteEnable(0));
        DID(CFE_PSP_EepromPowerUp(0));
    """
    compile_c(tmp_path, "TEST", program(body))
    (tmp_path / "mission.yaml").write_text("memory: ranges\n", encoding="utf-8")
    with Mission(write_mission(tmp_path, "TEST"), console=Console(quiet=True)) as mission:
        mission.run_for(2)
        lines = said(console_of(mission))
        mission.finish()
        assert bytes(mission.cfe.psp.retained.eeprom[:8]) == b"\0\7\0\0\x78\x56\x34\x12"
    assert lines == ["2 80000", "0", "-21", "0", "0", "7 12345678", "-22", "0", "7", "-27", "0"]


def test_ram_is_read_and_written_by_address_with_ram_direct(tmp_path: Path) -> None:
    body = """
        uint64_t at = (uint64_t)&word, user;
        uint32_t found, size;
        DID(CFE_PSP_MemWrite16(at + 2, 0xBBCC));
        DID(CFE_PSP_MemRead32(at, &found));
        DID(CFE_PSP_MemRead32(at + 1, &found));
        CFE_PSP_GetUserReservedArea(&user, &size);
        DID(CFE_PSP_MemWrite8(user, 7));
        SAY("%x %d", found, *(uint8_t *)user);
    """
    before = "static uint32_t word = 0x11223344;"
    assert results(tmp_path, body, before=before, memory="direct") == ["0", "0", "-3", "0", "bbcc3344 7"]


FAULTS = {
    "CFE_PSP_MemCpy(&word, (void *)16, 4)": "0x13",
    "CFE_PSP_MemSet((void *)16, 1, 4)": "0x10",
    "CFE_PSP_EepromWrite8(16, 1)": "0x10",
    "CFE_PSP_MemRead8(16, (uint8_t *)&word)": "0x10",
    "CFE_PSP_MemWrite32(16, 1)": "0x10",
    "CFE_PSP_MemRead8((uint64_t)&word, NULL)": "0x0",
}


@pytest.mark.parametrize(("call", "address"), FAULTS.items(), ids=FAULTS)
def test_an_address_without_memory_is_a_fault_of_the_caller(tmp_path: Path, call: str, address: str) -> None:
    text = program(f"{call};\nOS_TaskDelay(9000);", "uint32_t word;")
    (tmp_path / "mission.yaml").write_text("memory: direct\n", encoding="utf-8")
    assert f"CFault: bad address {address}, in TEST_Main (TEST.c:6)" in fly_c(tmp_path, text, 2)


def test_areas_of_the_board(tmp_path: Path) -> None:
    body = """
        uint64_t at = 1;
        uint32_t size = 1;
        char text[4] = "";
        DID(CFE_PSP_GetResetArea(&at, &size));
        SAY("%u", size);
        DID(CFE_PSP_GetResetArea(&at, NULL));
        DID(CFE_PSP_GetVolatileDiskMem(&at, &size));
        SAY("%lu %u", at, size);
        at = size = 1;
        DID(CFE_PSP_GetKernelTextSegmentInfo(&at, &size));
        SAY("%lu %u", at, size);
        DID(CFE_PSP_GetCFETextSegmentInfo(&at, NULL));
        DID(CFE_PSP_GetCDSSize(&size));
        DID(CFE_PSP_WriteToCDS("abc", size - 4, 4));
        DID(CFE_PSP_WriteToCDS("abc", size - 3, 4));
        DID(CFE_PSP_WriteToCDS(NULL, 0, 4));
        DID(CFE_PSP_ReadFromCDS(text, size - 4, 4));
        SAY("%s", text);
        DID(CFE_PSP_ReadFromCDS(text, size, 1));
        DID(CFE_PSP_GetCDSSize(NULL));
    """
    assert results(tmp_path, body) == [
        *("0", "16384", "-1", "0", "0 0", "-27", "0 0", "-1", "0", "0", "-1", "-1", "0", "abc", "-1", "-1")
    ]


def test_user_reserved_area_survives_a_processor_reset_and_python_shares_it(tmp_path: Path) -> None:
    body = """
        uint64_t at;
        uint32_t size;
        DID(CFE_PSP_GetUserReservedArea(&at, &size));
        uint8_t *area = (uint8_t *)at;
        SAY("%u bytes: %d %d", size, area[0], area[1]);
        area[0] += 1;
        OS_TaskDelay(100);
        SAY("then %d", area[1]);
        if (area[0] < 3)
            CFE_PSP_Restart(1);
        CFE_PSP_Restart(2);
    """
    compile_c(tmp_path, "TEST", program(body))
    folder = write_mission(tmp_path, "TEST")

    (tmp_path / "startup.scr").write_text(
        (tmp_path / "startup.scr")
        .read_text(encoding="utf-8")
        .replace("!", "CFE_APP, other, main, OTHER, 60, 8192, 0x0, 0;\n!"),
        encoding="utf-8",
    )
    (tmp_path / "other.py").write_text(
        "def main(cfe):\n    cfe.os.task_delay(50)\n    area = cfe.psp.get_user_reserved_area()\n"
        "    area[1] = 10 * area[0]\n",
        encoding="utf-8",
    )
    lines = said(console_of(fly(folder, 4)))
    assert lines[:12] == [
        *("0", "1048576 bytes: 0 0", "then 10", "0", "1048576 bytes: 1 10", "then 20"),
        *("0", "1048576 bytes: 2 20", "then 30", "0", "1048576 bytes: 0 0", "then 10"),
    ]


def test_exceptions(tmp_path: Path) -> None:
    body = """
        uint32_t context, task;
        char reason[10];
        DID(CFE_PSP_Exception_GetCount());
        DID(CFE_PSP_Exception_GetSummary(&context, &task, reason, sizeof reason));
        DID(CFE_PSP_Exception_CopyContext(5, reason, sizeof reason));
        DID(CFE_PSP_Exception_CopyContext(5, NULL, sizeof reason));
    """
    assert results(tmp_path, body) == ["0", "-30", "-30", "-2"]


def test_a_panic_ends_the_run(tmp_path: Path) -> None:
    before = "int32_t OS_RegisterEventHandler(int32_t (*)(uint32_t, uint32_t, void *));\n"
    before += "int32_t OS_BinSemCreate(uint32_t *, const char *, uint32_t, uint32_t);\n"
    before += "static int32_t on_event(uint32_t event, uint32_t id, void *data) { CFE_PSP_Panic(7); return 0; }"
    body = """
        uint32_t id;
        SAY("here");
        OS_RegisterEventHandler(on_event);
        OS_BinSemCreate(&id, "B", 0, 0);
        SAY("never");
    """
    compile_c(tmp_path, "TEST", program(body, before))
    console = Console(quiet=True)
    mission = Mission(write_mission(tmp_path, "TEST"), console=console)
    try:
        with pytest.raises(PanicError, match="code 7"):
            mission.run_for(2)
    finally:
        mission.close()
    assert said("\n".join(console.lines)) == ["here"]
    assert "CFE_PSP_Panic called with error code = 0x00000007. Exiting." in "\n".join(console.lines)


@pytest.mark.slow
def test_the_load_of_the_cpu(tmp_path: Path) -> None:
    before = "static int32_t sample; static const Reading reading = {1, &sample};"
    body = """
        uint32_t id = 9, direction = 9;
        DID(CFE_PSP_IODriver_FindByName("nothing", &id));
        DID(id);
        DID(CFE_PSP_IODriver_FindByName("iodriver", &id));
        SAY("%x", id);
        DID(CFE_PSP_IODriver_FindByName("linux_sysmon", &id));
        SAY("%x", id);
        Location all = {id, 0, 0}, none = {1, 0, 0}, bad = {id, 7, 0};
        DID(CFE_PSP_IODriver_Command(&none, 0, 0));
        DID(CFE_PSP_IODriver_Command(&bad, 0, 0));
        DID(CFE_PSP_IODriver_Command(&all, 0, 0));
        DID(CFE_PSP_IODriver_Command(&all, 5, (uint64_t)"per-cpu"));
        DID(CFE_PSP_IODriver_Command(&all, 6, (uint64_t)"cpu-load"));
        DID(CFE_PSP_IODriver_Command(&all, 6, (uint64_t)"nothing"));
        DID(CFE_PSP_IODriver_Command(&all, 8, (uint64_t)&direction));
        DID(direction);
        DID(CFE_PSP_IODriver_Command(&all, 0x10001, (uint64_t)&reading));
        DID(CFE_PSP_IODriver_Command(&all, 1, 1));
        DID(CFE_PSP_IODriver_Command(&all, 2, 0));
        for (int i = 0; i < 310; i++) {
            int64_t now, then;
            CFE_PSP_GetTime(&then);
            do CFE_PSP_GetTime(&now); while (now < then + 500000);
            OS_TaskDelay(50);
        }
        DID(CFE_PSP_IODriver_Command(&all, 0x10001, (uint64_t)&reading));
        SAY("%d percent", (sample >> 12) * 100 / 4096);
        DID(CFE_PSP_IODriver_Command(&all, 1, 0));
        DID(CFE_PSP_IODriver_Command(&all, 2, 0));
    """
    lines = said(fly_c(tmp_path, program(body, before), 35))
    assert lines[:17] == [
        *("-28", "0", "-28", "110ff05", "0", "110ff06", "-27", "-27", "0", "1", "0", "-27", "0", "1", "-1", "0", "1")
    ]
    assert lines[17:] == ["0", "50 percent", "0", "0"]
