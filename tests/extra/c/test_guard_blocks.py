"""The guard around memory that cFE and the PSP give to C code: blocks of pools, images of tables, areas."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any, NamedTuple

import pytest

from cfepy.cli.main import main
from cfepy.mission import Mission
from cfepy.tbl import TableServices
from cfepy.writing.console import Console
from tests.extra.c.building import compile_c, console_of, digest_of, fly, needs_compiler, said, write_mission

pytestmark = needs_compiler

SOURCE = """\
#include "guard_test.h"
{before}
void TEST_Main(void)
{{
    uint32_t run = RUN;
    volatile Bytes *p, *q;
    {body}
    OS_TaskDelay(100);
    SAY("not noticed");
    while (CFE_ES_RunLoop(&run))
        OS_TaskDelay(100);
}}
"""


class Mistake(NamedTuple):
    """A mistake: the code `wrong` and the mended `right` in place of @, the expected report, and code before main."""

    body: str
    wrong: str
    right: str
    told: str
    before: str = ""

    def source(self, what: str) -> str:
        """Return the application with `wrong` or `right`."""
        return SOURCE.format(body=self.body.replace("@", what), before=self.before.replace("@", what))


MAIN = "in TEST_Main (TEST.c:7)"
SIGNAL = "SIGSEGV (invalid or read-only memory)"
HERE, IN_CHECK = f"{SIGNAL} {MAIN}, address 0x, offset", f"{SIGNAL} in check (TEST.c:2), address 0x, offset"
PAST, BEFORE = "that was written past its end", "that was written before its start"
CHECK = "static int32_t check(void *at) { volatile Bytes *p = at; @; return 0; }"
DOUBLE_LOADED = "p = image(40, DOUBLE, NULL); CFE_TBL_ReleaseAddress(table); p = image(40, DOUBLE, NULL);"
TWICE = "image(40, SINGLE, check); image(40, SINGLE, check);"

MISTAKES = {
    "behind a pool block": Mistake("p = take(64); p[@] = 1;", "64", "63", f"{HERE} 64 of a pool block of 64 bytes"),
    "shortly behind a pool block": Mistake(
        "p = take(20); p[@] = 1; CFE_ES_PutPoolBuf(pool, (void *)p);",
        *("20", "19"),
        f"CFE_ES_PutPoolBuf() of 0x, a pool block of 20 bytes {PAST}, {MAIN}",
    ),
    "before a pool block": Mistake(
        "p = take(20); p[@] = 1; CFE_ES_PutPoolBuf(pool, (void *)p);",
        *("-1", "0"),
        f"CFE_ES_PutPoolBuf() of 0x, a pool block of 20 bytes {BEFORE}, {MAIN}",
    ),
    "a pool block that was already returned and reused": Mistake(
        "p = take(64); @",
        *("put(p); p[3] += 0;", "p[3] += 0; put(p);"),
        f"{HERE} 3 of a pool block of 64 bytes that was given back",
    ),
    "a pool block that another has": Mistake(
        "p = take(64); put(p); q = take(64); CFE_ES_PutPoolBuf(pool, (void *)@);",
        *("p", "q"),
        f"CFE_ES_PutPoolBuf() of 0x, a pool block that was already returned and reused, {MAIN}",
    ),
    "behind a block of a pool that is deleted": Mistake(
        "p = take(20); p[@] = 1; CFE_ES_PoolDelete(pool);",
        *("20", "19"),
        f"CFE_ES_PoolDelete() of 0x, a pool block of 20 bytes {PAST}, {MAIN}",
    ),
    "behind a table": Mistake("p = image(40, SINGLE, NULL); p[@] = 1;", "40", "39", f"{HERE} 40 of table TEST.T of 40"),
    "behind a table of odd size": Mistake(
        "p = image(7, SINGLE, NULL); p[@] += 0;", "7", "6", f"{HERE} 7 of table TEST.T of 7 bytes"
    ),
    "behind a table with two buffers": Mistake(
        f"{DOUBLE_LOADED} p[@] = 1;", "40", "39", f"{HERE} 40 of table TEST.T of 40 bytes"
    ),
    "behind a table that is only dumped": Mistake(
        "p = image(48, DUMP_ONLY, NULL); p[@] = 1;", "48", "47", f"{HERE} 48 of table TEST.T of 48 bytes"
    ),
    "behind a critical table": Mistake(
        "p = image(4096, CRITICAL, NULL); p[@] = 1;", "4096", "4095", f"{HERE} 4096 of table TEST.T of 4096 bytes"
    ),
    "before a table": Mistake(
        "p = image(40, SINGLE, NULL); p[@] = 1; CFE_TBL_ReleaseAddress(table);",
        *("-1", "0"),
        f"CFE_TBL_ReleaseAddress() of 0x, table TEST.T of 40 bytes {BEFORE}, {MAIN}",
    ),
    "before a table that is given up": Mistake(
        "p = image(40, SINGLE, NULL); p[@] = 1; CFE_TBL_Unregister(table);",
        *("-1", "0"),
        f"CFE_TBL_Unregister() of 0x, table TEST.T of 40 bytes {BEFORE}, {MAIN}",
    ),
    "a validation behind a table's own buffer": Mistake(
        "image(40, DOUBLE, check);",
        *("p[40] += 0", "p[39] += 0"),
        f"{IN_CHECK} 40 of table TEST.T of 40 bytes",
        CHECK,
    ),
    "a validation behind a table in a load buffer": Mistake(
        TWICE,
        "n++ ? p[40]++ : 0",
        "n++ ? p[39]++ : 0",
        f"{IN_CHECK} 40 of an image of table T of 40 bytes",
        "static int n; " + CHECK,
    ),
    "a validation before a table in a load buffer": Mistake(
        TWICE,
        *("n++ ? p[-1]++ : 0", "n++ ? p[0]++ : 0"),
        f"the validation of 0x, an image of table T of 40 bytes {BEFORE}, in image (guard_test.h:",
        "static int n; " + CHECK,
    ),
    "before a message": Mistake(
        "CFE_SB_AllocateMessageBuffer(64); p = CFE_SB_AllocateMessageBuffer(64); p[@] = 1; "
        "CFE_SB_ReleaseMessageBuffer((void *)p);",
        *("-1", "0"),
        f"CFE_SB_ReleaseMessageBuffer() of 0x, a message buffer of 64 bytes {BEFORE}, {MAIN}",
    ),
    "shortly behind a message": Mistake(
        "p = CFE_SB_AllocateMessageBuffer(65); CFE_MSG_Init((void *)p, 0x899, 65); p[@] = 1; "
        "CFE_SB_TransmitBuffer((void *)p, true);",
        *("65", "64"),
        f"CFE_SB_TransmitBuffer() of 0x, a message buffer of 65 bytes {PAST}, {MAIN}",
    ),
    "before a block of malloc": Mistake(
        "malloc(64); p = malloc(64); p[@] = 1; free((void *)p);",
        *("-1", "0"),
        f"free() of 0x, a block of 64 bytes {BEFORE}, {MAIN}",
    ),
}
QUICK = ("behind a table", "shortly behind a pool block")


def compile_app(folder: Path, source: str) -> str:
    """Return the mission of an application."""
    compile_c(folder, "TEST", source, "-O0", "-w")
    return write_mission(folder, "TEST")


def switch(folder: Path, is_on: bool) -> None:
    """Switch the guard on or off."""
    (folder / "mission.yaml").write_text(f"compiled: {{guard: {str(is_on).lower()}}}\n", encoding="utf-8")


def without_addresses(text: object) -> str:
    return re.sub("0x[0-9a-f]+", "0x", str(text))


def found(mission: Mission) -> str:
    """Return the fault of TEST."""
    return without_addresses(mission.cfe.es.history["TEST"].last_error)


def overwritten(mission: Mission) -> list[tuple[str, str]]:
    """Return the reports of overwritten memory at the end."""
    return [(each.app, without_addresses(each.text)) for each in mission.record.overwrites]


@pytest.mark.parametrize(
    "name", [pytest.param(each, marks=() if each in QUICK else pytest.mark.slow) for each in MISTAKES]
)
def test_mistake_in_a_block_is_a_fault_at_its_own_line(tmp_path: Path, name: str) -> None:
    mistake = MISTAKES[name]
    folder = compile_app(tmp_path, mistake.source(mistake.wrong))
    switch(tmp_path, True)
    mission = fly(folder, 1)
    assert mistake.told in found(mission)
    assert said(console_of(mission)) == []
    assert overwritten(mission) == []  # it was already reported


@pytest.mark.slow
@pytest.mark.parametrize("name", MISTAKES)
def test_mistake_in_a_block_is_not_noticed_without_the_guard(tmp_path: Path, name: str) -> None:
    mission = fly(compile_app(tmp_path, MISTAKES[name].source(MISTAKES[name].wrong)), 1)
    assert said(console_of(mission)) == ["not noticed"]


@pytest.mark.slow
@pytest.mark.parametrize("name", MISTAKES)
def test_mended_form_of_a_mistake_is_clean(tmp_path: Path, name: str) -> None:
    folder = compile_app(tmp_path, MISTAKES[name].source(MISTAKES[name].right))
    switch(tmp_path, True)
    mission = fly(folder, 1)
    assert said(console_of(mission)) == ["not noticed"]
    assert overwritten(mission) == []
    assert digest_of(folder, "thread") == digest_of(folder, "greenlet")


LEFT = {
    "a pool block": ("p = take(20); p[20] = 1;", "TEST", "a pool block of 20 bytes at 0x was written past its end"),
    "a table": (
        "p = image(40, 0, NULL); p[-1] = 1;",
        "TEST",
        "table TEST.T of 40 bytes at 0x was written before its start",
    ),
    "a block of malloc": ("p = malloc(99); p[99] = 1;", "TEST", "a block of 99 bytes at 0x was written past its end"),
    "a message": (
        "p = CFE_SB_AllocateMessageBuffer(65); p[65] = 1;",
        *("", "a message buffer of 65 bytes at 0x was written past its end"),
    ),
}


@pytest.mark.slow
@pytest.mark.parametrize("ends", ["", "CFE_ES_ExitApp(EXIT);"])
@pytest.mark.parametrize("name", LEFT)
def test_overwrite_of_a_block_still_held_is_reported_at_the_end(tmp_path: Path, name: str, ends: str) -> None:
    """At the end of the application, or of the mission."""
    body, app, text = LEFT[name]
    folder = compile_app(tmp_path, SOURCE.format(body=body + ends, before=""))
    switch(tmp_path, True)
    with Mission(folder, console=Console(quiet=True)) as mission:
        mission.run_for(9)
        assert ("Exit Application TEST Completed" in console_of(mission)) == bool(ends)
        assert overwritten(mission) == [(app, text)] * bool(ends)
    assert overwritten(mission) == [(app, text)]


def test_overwrite_reported_at_the_end_fails_the_run(tmp_path: Path, capsys: Any) -> None:
    folder = compile_app(tmp_path, SOURCE.format(body=LEFT["a pool block"][0], before=""))
    assert main(["run", folder, "--for", "2", "--guard"]) == 1
    told = "overwritten memory: TEST: a pool block of 20 bytes at 0x was written past its end"
    assert told in without_addresses(capsys.readouterr().err)


@pytest.mark.slow
def test_overwrite_is_a_failure_of_an_exploration(tmp_path: Path, capsys: Any) -> None:
    folder = compile_app(tmp_path, SOURCE.format(body=LEFT["a pool block"][0], before=""))
    assert main(["explore", folder, "--for", "1", "--seeds", "2", "--guard"]) == 1
    assert "overwritten memory: TEST: a pool block of 20 bytes" in capsys.readouterr().out


ASK = """
    enum { ALIGNMENT = 64 };
    static union { long double alignment; Bytes bytes[4096]; } other_memory;
    uint32_t other;
    void *block, *of_other;
    size_t sizes[] = {32, 128};
    CFE_ES_PoolCreateEx_WithAlignment(&pool, memory.bytes, 4096, 2, sizes, false, ALIGNMENT);
    CFE_ES_PoolCreate(&other, other_memory.bytes, 4096);
    CFE_ES_GetPoolBuf(&of_other, other, 40);
    SAY("%d", (int)CFE_ES_GetPoolBuf(&block, pool, 100));
    q = block;
    SAY("%x", (int)CFE_ES_GetPoolBuf(&block, pool, 129));
    SAY("%d", CFE_ES_GetPoolBufInfo(pool, (void *)q));
    for (int offset = -128; offset <= 128; offset += 8)
        SAY("%d: %x %x", offset, CFE_ES_GetPoolBufInfo(pool, (void *)(q + offset)),
            offset ? CFE_ES_PutPoolBuf(pool, (void *)(q + offset)) : 0);
    SAY("%x %x", CFE_ES_GetPoolBufInfo(other, (void *)q), CFE_ES_PutPoolBuf(other, (void *)q));
    SAY("%x %x", CFE_ES_GetPoolBufInfo(pool, of_other), CFE_ES_PutPoolBuf(pool, of_other));
    SAY("%x %x", CFE_ES_GetPoolBufInfo(pool, &other), CFE_ES_PutPoolBuf(pool, NULL));
    SAY("%x %x", CFE_ES_GetPoolBufInfo(99, (void *)q), CFE_ES_PutPoolBuf(99, (void *)q));
    SAY("%d %x %x", CFE_ES_PutPoolBuf(pool, (void *)q), CFE_ES_PutPoolBuf(pool, (void *)q),
        CFE_ES_GetPoolBufInfo(pool, (void *)q));
    SAY("%d", (int)CFE_ES_GetPoolBuf(&block, pool, 0));
    SAY("%x", CFE_ES_PutPoolBuf(pool, block));
    SAY("%d, at %p", CFE_ES_PoolDelete(pool), (void *)&other_memory);
"""


@pytest.mark.slow
def test_pools_answer_as_without_the_guard(tmp_path: Path) -> None:
    folder = compile_app(tmp_path, SOURCE.format(body=ASK, before=""))
    lines = []
    for is_on in (False, True):
        switch(tmp_path, is_on)
        lines.append(said(console_of(fly(folder, 1))))
    assert lines[0] == lines[1]
    assert lines[0][0] == "100"
    assert lines[0][-1] == "not noticed"


@pytest.mark.slow
def test_blocks_have_the_alignment_of_their_pool(tmp_path: Path) -> None:
    body = """
        static Bytes large[1 << 18];
        for (size_t alignment = 4; alignment <= 32768; alignment *= 2) {
            CFE_ES_PoolCreateEx_WithAlignment(&pool, large, sizeof large, 0, NULL, false, alignment);
            p = take(13);
            q = take(100);
            p[12] = q[99] = 1;
            SAY("%d", ((uintptr_t)p | (uintptr_t)q) % alignment == 0);
            CFE_ES_PoolDelete(pool);
        }
    """
    folder = compile_app(tmp_path, SOURCE.format(body=body, before=""))
    switch(tmp_path, True)
    assert said(console_of(fly(folder, 1))) == ["1"] * 14 + ["not noticed"]


@pytest.mark.slow
@pytest.mark.parametrize(("size", "at"), [(1000, 1000), (1001, 1001), (4096, 4096), (4096, -1)])
def test_area_of_any_size_ends_at_protected_memory(tmp_path: Path, size: int, at: int) -> None:
    """The area ends there if its size is a number of whole words.

    Otherwise a write behind it is reported at the end.
    """
    folder = compile_app(tmp_path, SOURCE.format(body=f"p = user_area(); p[{at}] = 1;", before=""))
    for is_on in (False, True):
        switch(tmp_path, is_on)
        with Mission(folder, console=Console(quiet=True)) as mission:
            mission.cfe.psp.retained.user_reserved = bytearray(size)
            mission.run_for(1)
        if not is_on:
            assert said(console_of(mission)) == ["not noticed"] * (size < 4096)
        elif at == 1001:
            told = "the user reserved area of 1001 bytes at 0x was written past its end"
            assert overwritten(mission) == [("", told)]
        else:
            assert f"{HERE} {at} of the user reserved area of {size} bytes" in found(mission)


@pytest.mark.slow
def test_block_of_the_cds_ends_at_its_last_byte(tmp_path: Path) -> None:
    body = """
        uint32_t handle;
        CFE_ES_RegisterCDS(&handle, 100, "C");
        CFE_ES_CopyToCDS(handle, zeros);
        CFE_ES_RestoreFromCDS(malloc(64), handle);
    """
    folder = compile_app(tmp_path, SOURCE.format(body=body, before=""))
    switch(tmp_path, True)
    assert "bad address 0x, offset 0 of a block of 64 bytes, in TEST_Main (TEST.c:11)" in found(fly(folder, 1))


@pytest.mark.slow
def test_a_table_at_an_address_of_the_application_is_validated_there(tmp_path: Path) -> None:
    before = """
        static struct { uint32_t first, second; } mine = {1, 2};
        static int32_t check(void *at) { SAY("mine %d", at == (void *)&mine); return 0; }
    """
    body = """
        enum { AT_ADDRESS = 6 };
        void *at = NULL;
        CFE_TBL_Register(&table, "T", sizeof mine, AT_ADDRESS, check);
        CFE_TBL_Load(table, ADDRESS, &mine);
        CFE_TBL_GetAddress(&at, table);
        SAY("mine %d", at == (void *)&mine);
        CFE_TBL_ReleaseAddress(table);
        CFE_TBL_Unregister(table);
    """
    folder = compile_app(tmp_path, SOURCE.format(body=body, before=before))
    for is_on in (False, True):
        switch(tmp_path, is_on)
        assert said(console_of(fly(folder, 1))) == ["mine 1", "mine 1", "not noticed"]


@pytest.mark.slow
def test_overwrite_is_reported_at_the_end_when_linux_has_no_more_mappings(tmp_path: Path) -> None:
    body = "for (int i = 0; i < 33000; i++) p = malloc(112); p[112] = 1;"
    folder = compile_app(tmp_path, SOURCE.format(body=body, before=""))
    switch(tmp_path, True)
    mission = fly(folder, 1)
    text = "a block of 112 bytes at 0x was written past its end"
    assert overwritten(mission) == [("TEST", text)] or f"{HERE} 112 of a block of 112 bytes" in found(mission)


def image_of(tbl: TableServices) -> memoryview:
    """Return the active image of TEST.T."""
    table = tbl.registry.by_name("TEST.T")
    active = tbl.registry.active(table)
    assert active is not None
    return table.image(active)


@pytest.mark.slow
def test_python_and_c_share_one_image_also_after_its_release(tmp_path: Path) -> None:
    body = """
        p = image(40, SINGLE, NULL);
        p[3] = 7;
        while (p[4] == 0)
            OS_TaskDelay(10);
        SAY("then %d", p[4]);
        CFE_TBL_Unregister(table);
    """
    folder = compile_app(tmp_path, SOURCE.format(body=body, before=""))
    switch(tmp_path, True)
    with Mission(folder, console=Console(quiet=True)) as mission:
        mission.run_for(1)
        image = image_of(mission.cfe.tbl)
        assert image[3] == 7
        image[4] = 9
        mission.run_for(1)
        assert said(console_of(mission)) == ["then 9", "not noticed"]
        assert image[4] == 9
        image[5] = 1
    assert bytes(image[3:6]) == b"\7\11\1"


@pytest.mark.slow
def test_other_addresses_are_the_same_with_and_without_the_guard(tmp_path: Path) -> None:
    before = "int32_t CFE_TBL_GetInfo(void *, const char *);"
    folder = compile_app(tmp_path, SOURCE.format(body='SAY("%p %p", (void *)&memory, (void *)&p);', before=before))
    lines = []
    for is_on in (False, True):
        switch(tmp_path, is_on)
        lines.append(said(console_of(fly(folder, 1))))
    assert lines[0] == lines[1]
