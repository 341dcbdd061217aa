"""Small mission trees for tests: the files of cFS missions in the layouts of cFS 7 and cFS 6, with two applications."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping
from pathlib import Path

MAIN = """
    #include "cfe.h"
    #include "{name}_msgids.h"
    {more}
    void {NAME}_Main(void)
    {{
        CFE_EVS_Register(NULL, 0, CFE_EVS_EventFilter_BINARY);
        CFE_EVS_SendEvent(1, CFE_EVS_EventType_INFORMATION, "{NAME} has 0x%04X", (unsigned)({NAME}_CMD_MID));
        while (CFE_ES_RunLoop(NULL)) OS_TaskDelay(500);
    }}
"""
MSGIDS = """
    #include "cfe_core_api_base_msgids.h"
    #define {NAME}_CMD_MID CFE_PLATFORM_CMD_TOPICID_TO_MIDV(0x{topic})
"""
TABLE = """
    #include "cfe_tbl_filedef.h"
    #include "shared_tbl.h"
    Shared_t Rows = {{{value}}};
    CFE_TBL_FILEDEF(Rows, {owner}.Rows, Rows of the test, rows.tbl)
"""
SCRIPT = """
    CFE_LIB, shared, Shared_Init, SHARED, 0, 0, 0x0, 0;
    CFE_APP, one, ONE_Main, ONE, 50, 16384, 0x0, 0;
    CFE_APP, two, TWO_Main, TWO, 60, 16384, 0x0, 0;
    !
"""
TARGETS = """
    SET(MISSION_NAME "Small")
    SET(SPACECRAFT_ID 0x51)
    list(APPEND MISSION_GLOBAL_APPLIST shared)
    SET(MISSION_CPUNAMES cpu1 cpu2)
    SET(cpu1_PROCESSORID 1)
    SET(cpu1_APPLIST one two)
    SET(cpu1_FILELIST cfe_es_startup.scr notes.txt)
    SET(cpu2_PROCESSORID 2)
    SET(cpu2_APPLIST one)
"""
FILES: Mapping[str, str] = {
    "small_defs/targets.cmake": TARGETS,
    "small_defs/cpu1_cfe_es_startup.scr": SCRIPT,
    "small_defs/notes.txt": "a file of the target\n",
    "small_defs/global_build_options.cmake": "include_directories(${MISSION_DEFS}/inc)\n",
    "small_defs/default_osconfig.cmake": "set(OSAL_CONFIG_MAX_MUTEXES 33)\nset(OSAL_CONFIG_MAX_FILE_NAME 20)\n",
    "small_defs/inc/small_rows.h": "#define SMALL_ROWS 4\n",
    "apps/one/CMakeLists.txt": """
        project(ONE C)
        set(FILES fsw/src/one.c)
        foreach(EXT_APP two gone)
          list(FIND TGTSYS_${SYSVAR}_APPS ${EXT_APP} HAVE_APP)
          if (HAVE_APP GREATER_EQUAL 0)
            string(TOUPPER "HAVE_${EXT_APP}" MACRO)
            add_definitions(-D${MACRO})
            include_directories($<TARGET_PROPERTY:${EXT_APP},INTERFACE_INCLUDE_DIRECTORIES>)
          endif()
        endforeach()
        add_cfe_app(one ${FILES})
        target_include_directories(one PUBLIC fsw/inc)
        add_cfe_app_dependency(one shared)
        add_cfe_tables(one fsw/tables/rows.c)
    """,
    "apps/one/arch_build.cmake": "generate_configfile_set(one_msgids.h)\n",
    "apps/one/config/default_one_msgids.h": MSGIDS.format(NAME="ONE", topic="90"),
    "apps/one/fsw/src/one.c": MAIN.format(
        name="one",
        NAME="ONE",
        more='#include "two_api.h"\n#include "shared_tbl.h"\n#ifndef HAVE_TWO\n#error two\n#endif',
    ),
    "apps/one/fsw/inc/one.h": "",
    "apps/one/fsw/tables/rows.c": TABLE.format(value=1, owner="ONE"),
    "apps/two/CMakeLists.txt": """
        project(TWO C)
        add_subdirectory(parts)
        add_cfe_app(two fsw/src/two.c $<TARGET_OBJECTS:two_parts>)
        target_include_directories(two PUBLIC ${TWO_SOURCE_DIR}/fsw/public_inc)
    """,
    "apps/two/parts/CMakeLists.txt": """
        add_library(two_parts OBJECT)
        target_sources(two_parts PRIVATE part.c)
        target_include_directories(two_parts PRIVATE inside)
    """,
    "apps/two/parts/part.c": '#include "inside.h"\nint TWO_Part(void) { return INSIDE; }\n',
    "apps/two/parts/inside/inside.h": "#define INSIDE 7\n",
    "apps/two/arch_build.cmake": """
        foreach(FILE two_msgids.h two_own.h)
          generate_config_includefile(FILE_NAME "${FILE}" FALLBACK_FILE
            "${CMAKE_CURRENT_LIST_DIR}/config/default_${FILE}")
        endforeach()
    """,
    "apps/two/config/default_two_msgids.h": MSGIDS.format(NAME="TWO", topic="92"),
    "apps/two/fsw/src/two.c": MAIN.format(name="two", NAME="TWO", more='#include "two_own.h"\nint TWO_Part(void);'),
    "apps/two/fsw/public_inc/two_api.h": "",
    "libs/shared/CMakeLists.txt": """
        add_cfe_app(shared fsw/src/shared.c)
        target_include_directories(shared PUBLIC fsw/public_inc)
    """,
    "libs/shared/fsw/src/shared.c": '#include "cfe.h"\nint32 Shared_Init(uint32 Id) { return CFE_SUCCESS; }\n',
    "libs/shared/fsw/public_inc/shared_tbl.h": '#include "cfe.h"\ntypedef struct { uint32 Value; } Shared_t;\n',
}
"""A tree in the layout of cFS 7."""

OLD_FILES: Mapping[str, str] = {
    "old_defs/targets.cmake": """
        SET(MISSION_NAME "Old")
        SET(SPACECRAFT_ID 42)
        SET(TGT1_NAME cpu1)
        SET(TGT1_APPLIST one)
        SET(TGT1_FILELIST cfe_es_startup.scr)
    """,
    "old_defs/cpu1_cfe_es_startup.scr": "CFE_APP, /cf/apps/one.so, ONE_Main, ONE, 50, 16384, 0x0, 0;\n!\n",
    "old_defs/old_mission_cfg.h": "#define CFE_MISSION_TIME_DEF_LEAPS 32\n#define CFE_MISSION_ES_CRC_16 2\n",
    "old_defs/cpu1_platform_cfg.h": """
        #define CFE_PLATFORM_ES_MAX_APPLICATIONS (16 * 2 + 8)
        #define CFE_PLATFORM_ES_START_TASK_STACK_SIZE CFE_PLATFORM_ES_DEFAULT_STACK_SIZE
        #define CFE_PLATFORM_ES_DEFAULT_STACK_SIZE 16384
        #define CFE_PLATFORM_TIME_CFG_CLIENT false
        #define CFE_PLATFORM_TBL_VALID_SCID_1 (CFE_PLATFORM_TBL_U32FROM4CHARS('a', 'b', 'c', 'd'))
    """,
    "apps/one/fsw/src/one.c": MAIN.format(name="one", NAME="ONE", more='#include "one.h"'),
    "apps/one/fsw/src/one.h": "",
    "apps/one/fsw/platform_inc/one_msgids.h": "#define ONE_CMD_MID 0x1890\n",
    "apps/one/fsw/mission_inc/shared_tbl.h": '#include "cfe.h"\ntypedef struct { uint32 Value; } Shared_t;\n',
    "apps/one/fsw/tables/rows.c": TABLE.format(value=1, owner="ONE"),
}
"""A tree in the layout of cFS 6, whose application has no CMakeLists.txt."""


def write_tree(folder: Path, changed: Mapping[str, str | None] | None = None, files: Mapping[str, str] = FILES) -> Path:
    """Write a tree.

    Args:
        folder: its folder.
        changed: replaced files; None for a file that is left out.
        files: path to text, indented as in the source of a test.
    """
    for name, text in {**files, **(changed or {})}.items():
        if text is not None:
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / name).write_text(textwrap.dedent(text).lstrip(), encoding="utf-8")
    return folder
