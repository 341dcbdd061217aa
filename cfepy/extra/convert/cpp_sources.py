"""The files of a node: its sources and all headers that they include, found as the compiler finds them."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from cfepy.extra.convert.source_names import includes_of, without_comments
from cfepy.reading.input_files import read_limited, text_limited
from cfepy.reading.input_limits import CPP_BYTES, CPP_FILES, CPP_FILES_BYTES
from cfepy.status import UsageError
from rospy_shim.types.msgs import Library

HEADER = ".h"
_MAIN = re.compile(r"\bint\s+main\s*\(\s*(void\s*)?(\))?")
_SERVICE_PARTS = ("Request", "Response")


@dataclass(slots=True)
class SourceSet:
    """Sources and headers of a node.

    Attributes:
        texts: of each file, without comments; the sources first.
        contents: of each file, unchanged.
        headers: that each file includes itself and that are in one of the folders.
        missing: headers that are in none of the folders, as written.
    """

    texts: dict[Path, str] = field(default_factory=dict)
    contents: dict[Path, bytes] = field(default_factory=dict)
    headers: dict[Path, list[Path]] = field(default_factory=dict)
    missing: list[str] = field(default_factory=list)

    def read_with(self, source: Path) -> list[bytes]:
        """Return the contents of the files that a compiler reads for one source: its own, and all its headers'."""
        files = {source: None}
        waiting = [source]
        for file in waiting:
            new = [each for each in self.headers[file] if each not in files]
            files.update(dict.fromkeys(new))
            waiting += new
        return [self.contents[each] for each in files]


def collect(sources: Iterable[Path], includes: Sequence[Path]) -> SourceSet:
    """Follow the includes of sources. Preprocessor conditions are ignored.

    Args:
        sources: files.
        includes: folders of headers, the first searched first.

    Raises:
        OSError: a source cannot be read.
        UsageError: a source or a header is too large or not a file, or they are too many.
    """
    found = SourceSet()
    waiting = list(sources)
    missing: dict[str, None] = {}
    where: dict[str, Path | None] = {}
    size = 0
    for file in waiting:
        if file in found.texts:
            continue
        found.contents[file] = read_limited(file, CPP_BYTES)
        size += len(found.contents[file])
        if size > CPP_FILES_BYTES or len(found.contents) > CPP_FILES:
            most = f"{CPP_FILES:,} files or {CPP_FILES_BYTES:,} bytes"
            raise UsageError(f"includes headers of more than {most}, counting nested includes", file=waiting[0])
        text = found.texts[file] = without_comments(found.contents[file].decode("utf-8", "replace"))
        headers = found.headers[file] = []
        for name in dict.fromkeys(includes_of(text)):
            beside = file.parent / name
            if ".." in beside.parts:  # otherwise files that include each other would get ever new names
                beside = Path(os.path.normpath(beside))
            if _is_there(beside):
                headers.append(beside)
                continue
            if name not in where:
                where[name] = next((each / name for each in includes if _is_there(each / name)), None)
            header = where[name]
            if header is None:
                missing[name] = None
            else:
                headers.append(header)
        waiting += headers
    found.missing = list(missing)
    return found


def _is_there(file: Path) -> bool:
    """Return True if a header exists, even if it is not a regular file, so that reading it raises the error."""
    return os.path.exists(file) and not os.path.isdir(file)


def message_types(headers: Iterable[str], library: Library) -> list[str]:
    """Return the message and service types whose headers are included, sorted.

    Args:
        headers: names as included, such as "std_msgs/String.h".
        library: of the available types.
    """
    found = {name for header in headers if (name := _type_of(header, library))}
    return sorted(found)


def _type_of(header: str, library: Library) -> str:
    name = header.removesuffix(HEADER)
    if not header.endswith(HEADER) or name.count("/") != 1:
        return ""
    if library.has(name) or library.has(name, "srv"):
        return name
    service = next((name.removesuffix(part) for part in _SERVICE_PARTS if name.endswith(part)), "")
    return service if service and library.has(service, "srv") else ""


def main_form(sources: Iterable[Path], where: Path) -> bool:
    """Return True if the main function of a node has parameters.

    Args:
        sources: of the node.
        where: the package, for errors.

    Raises:
        UsageError: there is no main function, or more than one.
    """
    texts = (without_comments(text_limited(each, CPP_BYTES, "replace")) for each in sources)
    found = [match for text in texts for match in _MAIN.finditer(text)]
    if len(found) != 1:
        what = "no main function" if not found else f"{len(found)} main functions"
        raise UsageError(f"its sources must have one main function, not {what} [main-form]", file=where)
    return found[0][2] is None
