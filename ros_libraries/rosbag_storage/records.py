"""Records of a bag: a header of named fields, and data; both with their length in front, in little endian.

The helpers have the names of rosbag's own tools, without the underscore. Imports the errors only.
"""

from __future__ import annotations

import struct
from collections.abc import Mapping
from mmap import mmap
from typing import BinaryIO

from .errors import ROSBagException, ROSBagFormatException

OP_MSG_DEF = 1
OP_MSG_DATA = 2
OP_FILE_HEADER = 3
OP_INDEX_DATA = 4
OP_CHUNK = 5
OP_CHUNK_INFO = 6
OP_CONNECTION = 7

OP_CODES = {
    OP_MSG_DEF: "MSG_DEF",
    OP_MSG_DATA: "MSG_DATA",
    OP_FILE_HEADER: "FILE_HEADER",
    OP_INDEX_DATA: "INDEX_DATA",
    OP_CHUNK: "CHUNK",
    OP_CHUNK_INFO: "CHUNK_INFO",
    OP_CONNECTION: "CONNECTION",
}

VERSION = b"#ROSBAG V2.0\n"
FILE_HEADER_LENGTH = 4096  # bytes of the file header's record, so that it can be written again in place
INDEX_VERSION = 1
CHUNK_INDEX_VERSION = 1
PIECE = 1 << 24  # bytes that are read at once: a length that is a mistake must not take all memory
NS_PER_S = 1_000_000_000

Fields = Mapping[str, "bytes | str"]
Buffer = bytes | memoryview | mmap

pack_uint8 = struct.Struct("<B").pack
pack_uint32 = struct.Struct("<L").pack
pack_uint64 = struct.Struct("<Q").pack
pair = struct.Struct("<LL")
index_entry = struct.Struct("<LLL")
_pack_time = pair.pack
_uint8 = struct.Struct("<B")
_uint32 = struct.Struct("<L")
_uint64 = struct.Struct("<Q")


def pack_time(ns: int) -> bytes:
    """Return a time in ns as seconds and nanoseconds."""
    return _pack_time(ns // NS_PER_S, ns % NS_PER_S)


def pack_header(fields: Fields) -> bytes:
    """Return a header without its length: each field as length, name, "=" and value."""
    parts = []
    for name, value in fields.items():
        content = (name if isinstance(name, bytes) else name.encode()) + b"=" + _bytes(value)
        parts.append(pack_uint32(len(content)) + content)
    return b"".join(parts)


def write_sized(file: BinaryIO, content: bytes | str) -> None:
    """Write bytes with their length in front."""
    data = _bytes(content)
    file.write(pack_uint32(len(data)))
    file.write(data)


def write_header(file: BinaryIO, fields: Fields) -> bytes:
    """Write a header, and return it."""
    header = pack_header(fields)
    write_sized(file, header)
    return header


def write_record(file: BinaryIO, fields: Fields, data: bytes | str = b"", padded_size: int | None = None) -> None:
    """Write a record.

    Args:
        file: the file to write to.
        fields: fields of the header.
        data: data after the header.
        padded_size: total bytes of header and data; the data are filled up with spaces.
    """
    header = write_header(file, fields)
    content = _bytes(data)
    if padded_size is not None:
        content = content.ljust(padded_size - len(header))
    write_sized(file, content)


def read(file: BinaryIO, size: int) -> bytes:
    """Read so many bytes.

    Raises:
        ROSBagException: the file ends before.
    """
    data = file.read(min(size, PIECE))
    while len(data) < size and (more := file.read(min(size - len(data), PIECE))):
        data += more
    if len(data) != size:
        raise ROSBagException(f"expecting {size} bytes, read {len(data)}")
    return data


def read_uint32(file: BinaryIO) -> int:
    """Read a number of four bytes."""
    data = file.read(4)
    if len(data) != 4:
        raise ROSBagFormatException("error unpacking uint32: unpack requires a buffer of 4 bytes")
    return int(_uint32.unpack(data)[0])


def read_sized(file: BinaryIO) -> bytes:
    """Read bytes that have their length in front.

    Raises:
        ROSBagException: the file ends before.
    """
    return read(file, read_uint32(file))


def skip_sized(file: BinaryIO) -> None:
    """Pass over bytes that have their length in front."""
    file.seek(read_uint32(file), 1)


def skip_record(file: BinaryIO) -> None:
    """Pass over a record."""
    skip_sized(file)
    skip_sized(file)


def read_record_data(file: BinaryIO) -> bytes:
    """Read the data of a record after its header."""
    try:
        return read_sized(file)
    except ROSBagException as error:
        raise ROSBagFormatException(f"Error reading record data: {error}") from None


def read_header(file: BinaryIO, op: int | None = None) -> dict[str, bytes]:
    """Read a header.

    Args:
        file: the file to read from.
        op: the kind of record that is expected; None accepts any.

    Raises:
        ROSBagFormatException: it is not a header, or another kind of record.
    """
    try:
        header = read_sized(file)
    except ROSBagException as error:
        raise ROSBagFormatException(f"Error reading header: {error}") from None
    fields = split_header(header)
    if op is not None:
        found = uint8_field(fields, "op")
        if found != op:
            raise ROSBagFormatException(f"Expected op code: {OP_CODES[op]}, got {OP_CODES.get(found, found)}")
    return fields


def split_header(header: bytes) -> dict[str, bytes]:
    """Return the fields of a header, in its order.

    Raises:
        ROSBagFormatException: a field has no name, or is longer than the header.
    """
    fields: dict[str, bytes] = {}
    at = 0
    while at < len(header):
        if len(header) - at < 4:
            raise ROSBagFormatException("Error reading header field")
        size = int(_uint32.unpack_from(header, at)[0])
        at += 4
        if len(header) - at < size:
            left = len(header) - at
            raise ROSBagFormatException(f"Error reading header field: expected {size} bytes, read {left}")
        name, equals, value = header[at : at + size].partition(b"=")
        if not equals:
            raise ROSBagFormatException("Error reading header field")
        fields[name.decode()] = value
        at += size
    return fields


def peek_op(file: BinaryIO) -> int:
    """Return the kind of the record that comes next."""
    at = file.tell()
    fields = read_header(file)
    file.seek(at)
    return uint8_field(fields, "op")


# -- fields ------------------------------------------------------------------------------------------------------------


def field(fields: Mapping[str, bytes], name: str) -> bytes:
    """Return the bytes of a field.

    Raises:
        ROSBagFormatException: there is no field of that name.
    """
    if name not in fields:
        raise ROSBagFormatException(f'expected "{name}" field in record')
    return fields[name]


def _number(fields: Mapping[str, bytes], name: str, layout: struct.Struct) -> int:
    try:
        return int(layout.unpack(field(fields, name))[0])
    except struct.error as error:
        raise ROSBagFormatException(f'error reading field "{name}": {error}') from None


def uint8_field(fields: Mapping[str, bytes], name: str) -> int:
    """Return a number of one byte."""
    return _number(fields, name, _uint8)


def uint32_field(fields: Mapping[str, bytes], name: str) -> int:
    """Return a number of four bytes."""
    return _number(fields, name, _uint32)


def uint64_field(fields: Mapping[str, bytes], name: str) -> int:
    """Return a number of eight bytes."""
    return _number(fields, name, _uint64)


def text_field(fields: Mapping[str, bytes], name: str) -> str:
    """Return a text."""
    return text(field(fields, name))


def time_field(fields: Mapping[str, bytes], name: str) -> int:
    """Return a time, in ns."""
    value = field(fields, name)
    if len(value) != pair.size:
        raise ROSBagFormatException(f'error reading field "{name}": a time has 8 bytes, not {len(value)}')
    seconds, nanoseconds = pair.unpack(value)
    return int(seconds * NS_PER_S + nanoseconds)


def text(value: bytes | str) -> str:
    """Return a value of a header as text."""
    return value if isinstance(value, str) else value.decode()


def _bytes(value: bytes | str) -> bytes:
    return value.encode() if isinstance(value, str) else bytes(value)
