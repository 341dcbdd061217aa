"""Table Services (CFE_TBL): named blocks of parameters that the ground loads, validates, activates and dumps.

Code that registers, loads and keeps tables, and reads and writes table files as bytes, belongs here. The YAML form of
table files is in `cfepy.ground.cfe_files`. The five services are independent of one another; TBL reaches the others
through its `Ports`. The central file is `cfepy/tbl/services.py`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.interpreter.faces import face

if TYPE_CHECKING:
    from cfepy.tbl.access import BAD_TABLE_HANDLE, TableInfo
    from cfepy.tbl.definition import TableType
    from cfepy.tbl.image import (
        PROCESSOR_ID,
        SPACECRAFT_ID,
        TableImage,
        build,
        is_intact,
        mark_for,
        mark_in,
        pack_rows,
        read,
        unpack_rows,
        with_mark,
        write_beside,
    )
    from cfepy.tbl.packets import COMMANDS, TELEMETRY
    from cfepy.tbl.registry import (
        OPT_CRITICAL,
        OPT_DBL_BUFFER,
        OPT_DEFAULT,
        OPT_DUMP_ONLY,
        OPT_LOAD_DUMP,
        OPT_SNGL_BUFFER,
        OPT_USR_DEF_ADDR,
        TableHandle,
        Validator,
        WaitingLoad,
    )
    from cfepy.tbl.services import TableServices

__all__ = [
    "BAD_TABLE_HANDLE",
    "COMMANDS",
    "OPT_CRITICAL",
    "OPT_DBL_BUFFER",
    "OPT_DEFAULT",
    "OPT_DUMP_ONLY",
    "OPT_LOAD_DUMP",
    "OPT_SNGL_BUFFER",
    "OPT_USR_DEF_ADDR",
    "PROCESSOR_ID",
    "SPACECRAFT_ID",
    "TELEMETRY",
    "TableHandle",
    "TableImage",
    "TableInfo",
    "TableServices",
    "TableType",
    "Validator",
    "WaitingLoad",
    "build",
    "is_intact",
    "mark_for",
    "mark_in",
    "pack_rows",
    "read",
    "unpack_rows",
    "with_mark",
    "write_beside",
]

if not TYPE_CHECKING:  # type checkers see only the names above
    __getattr__, __dir__ = face(
        __name__,
        {
            ".access": (
                "BAD_TABLE_HANDLE",
                "TableInfo",
            ),
            ".definition": ("TableType",),
            ".image": (
                "PROCESSOR_ID",
                "SPACECRAFT_ID",
                "TableImage",
                "build",
                "is_intact",
                "mark_for",
                "mark_in",
                "pack_rows",
                "read",
                "unpack_rows",
                "with_mark",
                "write_beside",
            ),
            ".packets": (
                "COMMANDS",
                "TELEMETRY",
            ),
            ".registry": (
                "OPT_CRITICAL",
                "OPT_DBL_BUFFER",
                "OPT_DEFAULT",
                "OPT_DUMP_ONLY",
                "OPT_LOAD_DUMP",
                "OPT_SNGL_BUFFER",
                "OPT_USR_DEF_ADDR",
                "TableHandle",
                "Validator",
                "WaitingLoad",
            ),
            ".services": ("TableServices",),
        },
    )
