"""Packets of compiled applications in the cache folder, since reading debug data takes up to a second for each.

The name of a cache file is the hash of the shared object. A file that is missing, damaged or of another version of
cfepy is made again.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Mapping
from hashlib import sha256
from pathlib import Path
from typing import Any

from cfepy import __version__
from cfepy.extra.c import cache_folder
from cfepy.extra.dictionaries.packets import DeclaredPacket, SourceContent
from cfepy.msg import Layout, ValueNames
from cfepy.reading.input_files import read_limited
from cfepy.status import UsageError

FOLDER = "packets"
_FORM = 3
_MOST_BYTES = 8 << 20


def cached_content(data: bytes, read: Callable[[], SourceContent]) -> SourceContent:
    """Return the declarations of a shared object.

    Args:
        data: its bytes.
        read: reads it, if the cache does not know it.
    """
    try:
        file = cache_folder() / FOLDER / f"{sha256(data).hexdigest()}.json"
    except UsageError:
        return read()  # no folder can be written
    found = _loaded(file)
    if found is not None:
        return found
    content = read()
    _save(file, content)
    return content


def _loaded(file: Path) -> SourceContent | None:
    try:
        document = json.loads(read_limited(file, _MOST_BYTES))
        if document["made_by"] != [__version__, _FORM]:
            return None
        packets = [_packet(each) for each in document["packets"]]
        return SourceContent("debug data", packets, names={int(key): name for key, name in document["names"].items()})
    except (OSError, UsageError, ValueError, KeyError, TypeError, AttributeError):
        return None


def _save(file: Path, content: SourceContent) -> None:
    document = {
        "made_by": [__version__, _FORM],
        "names": {str(msg_id): name for msg_id, name in content.names.items()},
        "packets": [_values(each) for each in content.packets],
    }
    scratch = file.with_suffix(f".{os.getpid()}")
    try:
        file.parent.mkdir(exist_ok=True)
        scratch.write_text(json.dumps(document), encoding="utf-8")
        os.replace(scratch, file)
    except OSError:
        scratch.unlink(missing_ok=True)  # a full disk: the next use reads the shared object again


def _values(packet: DeclaredPacket) -> dict[str, Any]:
    return {
        "name": packet.name,
        "msg_id": packet.msg_id,
        "payload": _shape(packet.payload),
        "is_command": packet.is_command,
        "file": str(packet.file),
        "line": packet.line,
        "code": packet.code,
        "structs": packet.structs,
        "header_size": packet.header_size,
    }


def _packet(values: Mapping[str, Any]) -> DeclaredPacket:
    payload = _type(values["payload"])
    if not isinstance(payload, Layout):
        raise TypeError("a payload is a layout")
    return DeclaredPacket(
        str(values["name"]),
        int(values["msg_id"]),
        payload,
        bool(values["is_command"]),
        Path(values["file"]),
        int(values["line"]),
        None if values["code"] is None else int(values["code"]),
        structs=tuple(map(str, values["structs"])),
        header_size=int(values["header_size"]),
    )


def _shape(kind: Any) -> Any:
    """Return a type in JSON: a word, [item, count], an enumeration, or a struct."""
    if isinstance(kind, Layout):
        fields = [[name, _shape(inner)] for name, inner in kind.types()]
        return {"name": kind.name, "fields": fields, "packed": kind.is_packed}
    if isinstance(kind, ValueNames):
        return {"type": kind.type, "values": dict(kind.values)}
    return [_shape(kind[0]), kind[1]] if isinstance(kind, tuple) else str(kind)


def _type(shape: Any) -> Any:
    if isinstance(shape, dict) and "values" in shape:
        return ValueNames.of(str(shape["type"]), {str(name): int(value) for name, value in shape["values"].items()})
    if isinstance(shape, dict):
        fields = [(str(name), _type(inner)) for name, inner in shape["fields"]]
        return Layout(str(shape["name"]), fields, packed=bool(shape["packed"]))
    return (_type(shape[0]), int(shape[1])) if isinstance(shape, list) else str(shape)
