"""Tables of compiled applications: place, lifetime and users of their images."""

from __future__ import annotations

from pathlib import Path

from cfepy.mission import Mission
from cfepy.tbl import TableServices
from cfepy.writing.console import Console
from tests.extra.c.building import compile_c, console_of, digest_of, fly, needs_compiler, said, write_mission

pytestmark = needs_compiler

DECLARED = """
    typedef struct { uint32_t first, second; } Table;
    int32_t CFE_TBL_Share(int16_t *, const char *);
    int32_t CFE_TBL_ReleaseAddress(int16_t);
    int32_t CFE_ES_GetResetType(uint32_t *);
    int32_t CFE_ES_ResetCFE(uint32_t);
    enum { CRITICAL = 8, MINE = 6, ADDRESS = 1 };
"""

OWNER = (
    DECLARED
    + """
    void OWNER_Main(void)
    {
        int16_t table;
        Table values = {VALUE, 22}, *image;
        void *place;
        CFE_TBL_Register(&table, "T", sizeof values, 0, NULL);
        CFE_TBL_Load(table, ADDRESS, &values);
        CFE_TBL_GetAddress(&place, table);
        image = place;
        SAY("table at %p: %u %u", (void *)image, image->first, image->second);
        image->second = 33;
        CFE_TBL_ReleaseAddress(table);
        uint32_t run = RUN;
        while (CFE_ES_RunLoop(&run))
            OS_TaskDelay(100);
        CFE_ES_ExitApp(run);
    }
"""
)


def table_of(tbl: TableServices, name: str) -> bytes:
    """Return the image of a table, as Python sees it."""
    table = tbl.registry.by_name(name)
    active = tbl.registry.active(table)
    assert active is not None
    return bytes(table.image(active))


def test_addresses_of_tables_are_the_same_in_each_run(tmp_path: Path) -> None:
    compile_c(tmp_path, "OWNER", OWNER, "-DVALUE=21")
    folder = write_mission(tmp_path, "OWNER")
    lines = [said(console_of(fly(folder, tasks=tasks))) for tasks in ("thread", "greenlet", "thread")]
    assert lines[0] == lines[1] == lines[2]
    assert lines[0][0].endswith(": 21 22")
    assert digest_of(folder, "thread") == digest_of(folder, "greenlet")


def test_python_reads_values_of_c_also_after_the_mission_is_closed(tmp_path: Path) -> None:
    missions = []
    for value in (21, 99):
        folder = tmp_path / str(value)
        folder.mkdir()
        compile_c(folder, "OWNER", OWNER, f"-DVALUE={value}")
        mission = Mission(write_mission(folder, "OWNER"), console=Console(quiet=True))
        mission.run_for(2)
        expected = value.to_bytes(4, "little") + (33).to_bytes(4, "little")
        assert table_of(mission.cfe.tbl, "OWNER.T") == expected
        mission.close()
        missions.append((mission, expected))
    for mission, expected in missions:  # the second one flew where the first one's memory was
        assert table_of(mission.cfe.tbl, "OWNER.T") == expected


def test_two_missions_at_once_have_separate_tables(tmp_path: Path) -> None:
    compile_c(tmp_path, "OWNER", OWNER, "-DVALUE=21")
    folder = write_mission(tmp_path, "OWNER")
    with Mission(folder, console=Console(quiet=True)) as one, Mission(folder, console=Console(quiet=True)) as two:
        one.run_for(2)
        two.run_for(2)
        places = [said(console_of(mission))[0] for mission in (one, two)]
        assert places[0] != places[1]
        table_one = one.cfe.tbl.registry.by_name("OWNER.T")
        image = one.cfe.tbl.registry.active(table_one)
        assert image is not None
        image.data[0] = 77
        assert table_of(two.cfe.tbl, "OWNER.T")[0] == 21


def test_table_of_an_ended_application_keeps_its_last_values(tmp_path: Path) -> None:
    source = """
        static Table mine = {5, 6};
        void OWNER_Main(void)
        {
            int16_t table;
            uint32_t run = RUN;
            CFE_TBL_Register(&table, "Mine", sizeof mine, MINE, NULL);
            CFE_TBL_Load(table, ADDRESS, &mine);
            mine.first = 7;
            for (int i = 0; i < 5 && CFE_ES_RunLoop(&run); i++)
                OS_TaskDelay(100);
            CFE_ES_ExitApp(EXIT);
        }
    """
    sharer = """
        void SHARER_Main(void)
        {
            int16_t table;
            void *image;
            uint32_t run = RUN;
            OS_TaskDelay(100);
            CFE_TBL_Share(&table, "OWNER.Mine");
            CFE_TBL_GetAddress(&image, table);
            SAY("shared %u", ((Table *)image)->first);
            while (CFE_ES_RunLoop(&run))
                OS_TaskDelay(100);
            CFE_ES_ExitApp(run);
        }
    """
    compile_c(tmp_path, "OWNER", DECLARED + source)
    compile_c(tmp_path, "SHARER", DECLARED + sharer)
    with Mission(write_mission(tmp_path, "OWNER", "SHARER"), console=Console(quiet=True)) as mission:
        mission.run_for(10)
        assert "Exit Application OWNER Completed" in console_of(mission)
        assert said(console_of(mission)) == ["shared 7"]
        assert table_of(mission.cfe.tbl, "OWNER.Mine")[0] == 7  # its memory is gone, and its last values are kept


def test_critical_table_is_restored_after_a_processor_reset(tmp_path: Path) -> None:
    source = """
        void TEST_Main(void)
        {
            int16_t table;
            Table values = {1, 2};
            void *image = NULL;
            uint32_t subtype, run = RUN;
            SAY("register: %08X", (unsigned)CFE_TBL_Register(&table, "Crit", sizeof values, CRITICAL, NULL));
            SAY("address: %08X", (unsigned)CFE_TBL_GetAddress(&image, table));
            if (image != NULL)
                SAY("values %u %u", ((Table *)image)->first, ((Table *)image)->second);
            CFE_TBL_ReleaseAddress(table);
            if (CFE_ES_GetResetType(&subtype) == 2) {
                CFE_TBL_Load(table, ADDRESS, &values);
                CFE_ES_RunLoop(&run);
                OS_TaskDelay(500);
                CFE_ES_ResetCFE(1);
            }
            while (CFE_ES_RunLoop(&run))
                OS_TaskDelay(100);
        }
    """
    compile_c(tmp_path, "TEST", DECLARED + source)
    console = console_of(fly(write_mission(tmp_path, "TEST"), 4))
    recovered = ["register: 4C000027", "address: 4C00000E", "values 1 2"]
    assert said(console) == ["register: 00000000", "address: CC000005", *recovered]


def test_a_table_in_memory_that_was_freed_is_zeros_for_the_ground(tmp_path: Path) -> None:
    source = """
        int32_t CFE_TBL_Modified(int16_t);
        void TEST_Main(void)
        {
            int16_t table;
            uint32_t run = RUN;
            Table *mine = malloc(sizeof *mine);
            mine->first = 5;
            CFE_TBL_Register(&table, "Mine", sizeof *mine, MINE, NULL);
            CFE_TBL_Load(table, ADDRESS, mine);
            free(mine);
            SAY("modified: %08X", (unsigned)CFE_TBL_Modified(table));
            while (CFE_ES_RunLoop(&run))
                OS_TaskDelay(100);
        }
    """
    compile_c(tmp_path, "TEST", DECLARED + source, "-Wno-use-after-free")
    folder = write_mission(tmp_path, "TEST")
    (tmp_path / "mission.yaml").write_text("compiled: {guard: true}\n", encoding="utf-8")
    with Mission(folder, console=Console(quiet=True)) as mission:
        mission.run_for(2)
        assert said(console_of(mission)) == ["modified: 00000000"]
    assert table_of(mission.cfe.tbl, "TEST.Mine") == bytes(8)
