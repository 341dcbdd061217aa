"""File services (CFE_FS): file and table headers, CRC and file names; `services` has `cfe.fs`.

Code that defines the layout and names of cFE's files, or writes files in the background, belongs here. The content of a
file belongs to the service that writes it. You can use all names below without a mission, except `FileServices`. The
central file is `cfepy/fs/services.py`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.interpreter.faces import face

if TYPE_CHECKING:
    from cfepy.fs.background import FileWriteEvent, FileWriteMetaData
    from cfepy.fs.crc import CRC_8, CRC_16, CRC_32, CRC_NONE, calculate_crc, crc16
    from cfepy.fs.filename import (
        MAX_PATH_LEN,
        MODULE_EXTENSION,
        NONVOL_MOUNT_POINT,
        RAM_MOUNT_POINT,
        FileCategory,
        FileNameError,
        dump_file_name,
        extract_filename_from_path,
        get_default_extension,
        get_default_mount_point,
        parse_input_file_name,
        parse_input_file_name_ex,
    )
    from cfepy.fs.header import (
        CONTENT_ID,
        DESCRIPTION_SIZE,
        HEADER_SIZE,
        SUBTYPE_ES_ERLOG,
        SUBTYPE_ES_PERFDATA,
        SUBTYPE_EVS_APPDATA,
        SUBTYPE_EVS_EVENTLOG,
        SUBTYPE_SB_MAPDATA,
        SUBTYPE_SB_PIPEDATA,
        SUBTYPE_SB_ROUTEDATA,
        SUBTYPE_TBL_IMG,
        SUBTYPE_TBL_REG,
        TABLE_HEADER_SIZE,
        TABLE_NAME_SIZE,
        TIMESTAMP_OFFSET,
        FileHeader,
        TableHeader,
        init_header,
        read_header,
        read_table_file,
        read_table_header,
        stamp_header,
        write_table_file,
    )
    from cfepy.fs.services import FileServices

__all__ = [
    "CONTENT_ID",
    "CRC_8",
    "CRC_16",
    "CRC_32",
    "CRC_NONE",
    "DESCRIPTION_SIZE",
    "HEADER_SIZE",
    "MAX_PATH_LEN",
    "MODULE_EXTENSION",
    "NONVOL_MOUNT_POINT",
    "RAM_MOUNT_POINT",
    "SUBTYPE_ES_ERLOG",
    "SUBTYPE_ES_PERFDATA",
    "SUBTYPE_EVS_APPDATA",
    "SUBTYPE_EVS_EVENTLOG",
    "SUBTYPE_SB_MAPDATA",
    "SUBTYPE_SB_PIPEDATA",
    "SUBTYPE_SB_ROUTEDATA",
    "SUBTYPE_TBL_IMG",
    "SUBTYPE_TBL_REG",
    "TABLE_HEADER_SIZE",
    "TABLE_NAME_SIZE",
    "TIMESTAMP_OFFSET",
    "FileCategory",
    "FileHeader",
    "FileNameError",
    "FileServices",
    "FileWriteEvent",
    "FileWriteMetaData",
    "TableHeader",
    "calculate_crc",
    "crc16",
    "dump_file_name",
    "extract_filename_from_path",
    "get_default_extension",
    "get_default_mount_point",
    "init_header",
    "parse_input_file_name",
    "parse_input_file_name_ex",
    "read_header",
    "read_table_file",
    "read_table_header",
    "stamp_header",
    "write_table_file",
]

if not TYPE_CHECKING:  # type checkers see only the names above
    __getattr__, __dir__ = face(
        __name__,
        {
            ".background": (
                "FileWriteEvent",
                "FileWriteMetaData",
            ),
            ".crc": (
                "CRC_8",
                "CRC_16",
                "CRC_32",
                "CRC_NONE",
                "calculate_crc",
                "crc16",
            ),
            ".filename": (
                "MAX_PATH_LEN",
                "MODULE_EXTENSION",
                "NONVOL_MOUNT_POINT",
                "RAM_MOUNT_POINT",
                "FileCategory",
                "FileNameError",
                "dump_file_name",
                "extract_filename_from_path",
                "get_default_extension",
                "get_default_mount_point",
                "parse_input_file_name",
                "parse_input_file_name_ex",
            ),
            ".header": (
                "CONTENT_ID",
                "DESCRIPTION_SIZE",
                "HEADER_SIZE",
                "SUBTYPE_ES_ERLOG",
                "SUBTYPE_ES_PERFDATA",
                "SUBTYPE_EVS_APPDATA",
                "SUBTYPE_EVS_EVENTLOG",
                "SUBTYPE_SB_MAPDATA",
                "SUBTYPE_SB_PIPEDATA",
                "SUBTYPE_SB_ROUTEDATA",
                "SUBTYPE_TBL_IMG",
                "SUBTYPE_TBL_REG",
                "TABLE_HEADER_SIZE",
                "TABLE_NAME_SIZE",
                "TIMESTAMP_OFFSET",
                "FileHeader",
                "TableHeader",
                "init_header",
                "read_header",
                "read_table_file",
                "read_table_header",
                "stamp_header",
                "write_table_file",
            ),
            ".services": ("FileServices",),
        },
    )
