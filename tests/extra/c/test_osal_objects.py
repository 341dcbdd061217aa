"""OS_*: modules and symbols, object ids, error names and the frame around flight software, as C code sees them."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.extra.c.building import compile_c, console_of, fly, fly_c, needs_compiler, said, write_mission
from tests.extra.c.test_osal import HEADER, results

pytestmark = needs_compiler


def test_modules_and_symbols(tmp_path: Path) -> None:
    compile_c(tmp_path, "MODULE", "int answer(void) { return 42; }\nint shared = 7;")
    body = """
        Id id = 9;
        uint64_t at = 5;
        ModuleInfo info;
        DID(OS_ModuleLoad(&id, "M", "/cf/none.so", 0));
        DID(id);
        DID(OS_ModuleLoad(&id, "M", NULL, 0));
        DID(OS_ModuleLoad(&id, NULL, "/cf/MODULE.so", 0));
        DID(OS_ModuleLoad(&id, "M", "/cf/MODULE.so", 0));
        DID(OS_ModuleSymbolLookup(id, &at, "answer"));
        DID(((int (*)(void))at)());
        DID(OS_ModuleSymbolLookup(id, &at, "nothing"));
        DID(at);
        DID(OS_SymbolLookup(&at, "shared"));
        DID(*(int *)at);
        DID(OS_SymbolLookup(&at, "TEST_Main"));
        DID(at == (uint64_t)TEST_Main);
        DID(OS_SymbolLookup(&at, "OS_TaskGetId"));
        DID(((Id (*)(void))at)() == OS_TaskGetId());
        DID(OS_SymbolLookup(&at, "nothing"));
        DID(OS_SymbolLookup(NULL, "nothing"));
        DID(OS_ModuleInfo(id, &info));
        SAY("%s %s %u", info.name, info.filename, info.addr.valid);
        OS_SymbolLookup(&at, "answer");
        DID(at >= info.addr.code && at < info.addr.code + info.addr.code_size);
        DID(OS_SymbolTableDump("/ram/x", 1000));
        DID(OS_ModuleUnload(id));
        DID(OS_ModuleUnload(id));
    """
    console = fly_c(tmp_path, f"{HEADER}\nvoid TEST_Main(void)\n{{\n{body}\n}}\n", 2)
    assert said(console)[:23] == [
        *("-1", "0", "-2", "-2", "0", "0", "42", "-1", "0", "0", "7", "0", "1", "0", "1", "-1", "-2"),
        *("0", "M /cf/MODULE.so 0", "0", "-28", "0", "-16"),
    ]


def test_code_of_a_module_is_gone_with_it_and_a_file_is_loaded_once(tmp_path: Path) -> None:
    compile_c(tmp_path, "MODULE", "int answer(void) { return 42; }")
    body = """
        Id id, other;
        uint64_t at, mine;
        DID(OS_ModuleLoad(&id, "M", "/cf/MODULE.so", 1));
        DID(OS_SymbolLookup(&at, "answer"));
        DID(((int (*)(void))at)());
        DID(OS_ModuleLoad(&other, "OTHER", "/cf/TEST.so", 0));
        DID(OS_ModuleSymbolLookup(other, &mine, "TEST_Main"));
        DID(mine == (uint64_t)TEST_Main);
        DID(OS_ModuleUnload(other));
        DID(OS_ModuleUnload(id));
        DID(OS_SymbolLookup(&mine, "answer"));
        ((int (*)(void))at)();
        SAY("alive");
    """
    console = fly_c(tmp_path, f"{HEADER}\nvoid TEST_Main(void)\n{{\n{body}\n}}\n", 2)
    assert said(console) == ["0", "0", "42", "0", "0", "1", "0", "0", "-1"]
    assert "SIGSEGV" in console


def test_global_module_stays_while_others_use_it_and_for_good_once_it_was_looked_up(tmp_path: Path) -> None:
    compile_c(tmp_path, "FIRST", "static int calls;\nint first(void) { return ++calls; }")
    compile_c(tmp_path, "SECOND", "int first(void);\nint second(void) { return 100 + first(); }")
    body = """
        Id id, user, again;
        uint64_t at;
        OS_ModuleLoad(&id, "FIRST", "/cf/FIRST.so", 0);
        OS_ModuleLoad(&user, "SECOND", "/cf/SECOND.so", 1);
        OS_ModuleSymbolLookup(user, &at, "second");
        DID(CALL());
        DID(OS_ModuleUnload(id));
        DID(CALL()); /* SECOND uses it */
        OS_ModuleLoad(&id, "FIRST", "/cf/FIRST.so", 1);
        OS_ModuleLoad(&again, "AGAIN", "/cf/FIRST.so", 1);
        OS_ModuleSymbolLookup(id, &at, "first");
        DID(CALL());
        DID(OS_ModuleUnload(id));
        DID(CALL());
        OS_ModuleUnload(again);
        OS_ModuleUnload(user);
        DID(OS_ModuleLoad(&id, "FIRST", "/cf/FIRST.so", 1));
        DID(OS_ModuleLoad(&user, "SECOND", "/cf/SECOND.so", 1)); /* it has left memory, and is not global now */
        OS_ModuleLoad(&again, "AGAIN", "/cf/FIRST.so", 0);
        DID(OS_SymbolLookup(&at, "first"));
        DID(CALL());
        OS_ModuleUnload(id);
        OS_ModuleUnload(again);
        DID(OS_SymbolLookup(&at, "first"));
        DID(CALL());
    """
    call = "#define CALL() (((int (*)(void))at)())\n"
    console = fly_c(tmp_path, f"{HEADER}{call}void TEST_Main(void)\n{{\n{body}\n}}\n", 1)
    assert said(console) == ["101", "0", "102", "3", "0", "4", "0", "-1", "0", "1", "0", "2"]


def test_code_loaded_later_uses_symbols_of_global_modules(tmp_path: Path) -> None:
    compile_c(tmp_path, "FIRST", "int first(void) { return 1; }")
    compile_c(tmp_path, "SECOND", "int first(void);\nint second(void) { return 1 + first(); }")
    body = """
        Id id, user;
        uint64_t at;
        DID(OS_ModuleLoad(&id, "FIRST", "/cf/FIRST.so", 0));
        DID(OS_ModuleLoad(&user, "SECOND", "/cf/SECOND.so", 1));
        OS_ModuleSymbolLookup(user, &at, "second");
        DID(((int (*)(void))at)());
        OS_ModuleUnload(user);
        OS_ModuleUnload(id);
        DID(OS_ModuleLoad(&id, "FIRST", "/cf/FIRST.so", 1));
        DID(OS_ModuleLoad(&user, "SECOND", "/cf/SECOND.so", 1));
    """
    console = fly_c(tmp_path, f"{HEADER}\nvoid TEST_Main(void)\n{{\n{body}\n}}\n", 1)
    assert said(console)[:5] == ["0", "0", "2", "0", "-1"]
    assert "OS_ModuleLoad: Error loading shared library: /cf/SECOND.so: undefined symbol: first" in console


LOADER = f"""{HEADER}
void LOADER_Main(void)
{{
    Id id;
    uint64_t at;
    DID(OS_ModuleLoad(&id, "M", "/cf/MODULE.so", 0));
    DID(OS_ModuleSymbolLookup(id, &at, "answer"));
    OS_TaskDelay(100);
    AT_THE_END;
}}
"""
LATER = f"""{HEADER}
void TEST_Main(void)
{{
    Id id;
    uint64_t at;
    OS_TaskDelay(2000);
    DID(OS_SymbolLookup(&at, "answer"));
    DID(OS_ModuleLoad(&id, "M", "/cf/MODULE.so", 0));
}}
"""


@pytest.mark.parametrize(
    ("at_the_end", "seen"), [("CFE_ES_ExitApp(EXIT)", ["-1", "0"]), ("return", ["0", "-15"])], ids=["exits", "returns"]
)
def test_modules_are_unloaded_if_es_ends_their_application(tmp_path: Path, at_the_end: str, seen: list[str]) -> None:
    compile_c(tmp_path, "MODULE", "int answer(void) { return 42; }")
    compile_c(tmp_path, "LOADER", LOADER.replace("AT_THE_END", at_the_end))
    compile_c(tmp_path, "TEST", LATER)
    assert said(console_of(fly(write_mission(tmp_path, "LOADER", "TEST"), 4))) == ["0", "0", *seen]


def test_ids_and_names(tmp_path: Path) -> None:
    before = """
    static int seen;
    static void count(Id id, void *arg) { seen += *(int *)arg; }
    """
    body = """
        Id id;
        int one = 1;
        uint32_t index = 9;
        char name[20] = "?";
        OS_QueueCreate(&id, "QUEUE", 1, 4, 0);
        DID(OS_IdentifyObject(id));
        DID(OS_ConvertToArrayIndex(id, &index));
        DID(index < 64);
        DID(OS_ObjectIdToArrayIndex(2, id, &index));
        DID(OS_ObjectIdToArrayIndex(1, id, &index));
        DID(OS_ConvertToArrayIndex(0, &index));
        DID(OS_ConvertToArrayIndex(id, NULL));
        DID(OS_GetResourceName(id, name, sizeof name));
        SAY("%s", name);
        DID(OS_GetResourceName(id, name, 4));
        SAY("%s", name);
        DID(OS_GetResourceName(id + 1, name, sizeof name));
        SAY("[%s]", name);
        DID(OS_GetResourceName(id, name, 0));
        OS_ForEachObject(OS_TaskGetId(), count, &one);
        OS_ForEachObjectOfType(2, 0, count, &one); /* and the queues of cFE's five pipes */
        OS_ForEachObjectOfType(99, 0, count, &one);
        SAY("%d", seen);
    """
    assert results(tmp_path, body, before=before) == [
        *("2", "0", "1", "0", "-16", "-16", "-2", "0", "QUEUE", "-13", "QUE", "-16", "[]", "-40", "7")
    ]


def test_errors_versions_and_the_computer(tmp_path: Path) -> None:
    body = """
        char name[35], text[12], host[40];
        uint8_t numbers[4];
        size_t heap[3];
        DID(OS_GetErrorName(-16, name));
        SAY("%s", name);
        DID(OS_GetErrorName(12345, name));
        SAY("%s", name);
        DID(OS_GetErrorName(0, NULL));
        SAY("%s", OS_StatusToString(-103, text));
        DID(OS_StatusToString(0, NULL) == NULL);
        OS_GetVersionNumber(numbers);
        SAY("%s %s %d.%d.%d.%d", OS_GetVersionString(), OS_GetVersionCodeName(), numbers[0], numbers[1], numbers[2],
            numbers[3]);
        DID(OS_GetBuildNumber());
        DID(OS_NetworkGetID());
        DID(OS_NetworkGetHostName(host, sizeof host));
        SAY("%s", host);
        DID(OS_NetworkGetHostName(host, 2));
        SAY("[%s]", host);
        DID(OS_NetworkGetHostName(NULL, 2));
        DID(OS_HeapGetInfo(heap));
        SAY("%u %s %d", OS_BSP_GetArgC(), OS_BSP_GetArgV()[0], OS_BSP_GetArgV()[1] == NULL);
        DID(OS_API_Init());
    """
    assert results(tmp_path, body) == [
        *("0", "OS_ERR_INVALID_ID", "-1", "OS_UNKNOWN(12345)", "-2", "-103", "1", "v7.0.0+dev0 Draco 7.0.0.0", "0"),
        *("1", "0", "cpu1", "-1", "[]", "-2", "-28", "1 core-cpu1 1", "0"),
    ]


def test_a_shell_command(tmp_path: Path) -> None:
    body = """
        Id id;
        char text[20] = "";
        OS_OpenCreate(&id, "/ram/x", 3, 2);
        DID(OS_ShellOutputToFile("echo hello", id));
        DID(OS_ShellOutputToFile(NULL, id));
        DID(OS_ShellOutputToFile("echo hello", 0));
        OS_lseek(id, 0, 0);
        DID(OS_read(id, text, sizeof text));
        SAY("%.5s", text);
    """
    assert results(tmp_path, body) == ["0", "-2", "-16", "6", "hello"]


def test_application_exit_ends_the_run(tmp_path: Path) -> None:
    assert results(tmp_path, 'SAY("here");\nOS_ApplicationExit(0);\nSAY("never");') == ["here"]
