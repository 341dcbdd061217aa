"""File services (CFE_FS): on bytes and text, file and table headers, CRC, file names; in `services`, `cfe.fs`.

What is exported here is usable without a mission and imports only cfepy.status.
"""

from __future__ import annotations

from cfepy.fs.crc import CRC_8, CRC_16, CRC_32, CRC_NONE, calculate_crc, crc16
from cfepy.fs.filename import (
    MAX_PATH_LEN,
    MODULE_EXTENSION,
    NONVOL_MOUNT_POINT,
    RAM_MOUNT_POINT,
    FileCategory,
    dump_file_name,
    extract_filename_from_path,
    get_default_extension,
    get_default_mount_point,
    parse_input_file_name,
    parse_input_file_name_ex,
)
from cfepy.fs.header import (
    CONTENT_ID,
    HEADER_SIZE,
    TABLE_HEADER_SIZE,
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

__all__ = [
    "CONTENT_ID",
    "CRC_8",
    "CRC_16",
    "CRC_32",
    "CRC_NONE",
    "HEADER_SIZE",
    "MAX_PATH_LEN",
    "MODULE_EXTENSION",
    "NONVOL_MOUNT_POINT",
    "RAM_MOUNT_POINT",
    "TABLE_HEADER_SIZE",
    "TIMESTAMP_OFFSET",
    "FileCategory",
    "FileHeader",
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
