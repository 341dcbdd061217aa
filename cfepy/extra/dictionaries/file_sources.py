"""Files of a dictionary, told apart by their content: electronic data sheets, text of COSMOS, XTCE."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from cfepy.extra.dictionaries.cosmos_reader import is_cosmos, read_cosmos
from cfepy.extra.dictionaries.eds_packets import ROOTS, DataSheets
from cfepy.extra.dictionaries.packets import SourceContent
from cfepy.extra.dictionaries.xml_tags import XmlTag, read_document
from cfepy.extra.dictionaries.xtce_reader import ROOT as XTCE_ROOT
from cfepy.extra.dictionaries.xtce_reader import read_xtce
from cfepy.reading.input_files import read_limited
from cfepy.reading.input_limits import LINE_FILE_BYTES
from cfepy.status import UsageError


def contents_of_files(files: Iterable[Path]) -> tuple[SourceContent, ...]:
    """Return the content of each kind of file, the one with precedence first.

    Args:
        files: files of any kind; others are left out.
    """
    unread = SourceContent("files")
    sheets: list[XmlTag] = []
    texts: list[Path] = []
    systems: list[XmlTag] = []
    for file in files:
        try:
            if file.suffix.lower() != ".xml":
                texts += [file] if _is_cosmos(file) else []
                continue
            root = read_document(file)
            if root.name in ROOTS:
                sheets.append(root)
            elif root.name == XTCE_ROOT:
                systems.append(root)
        except UsageError as error:
            unread.add_problem(error, file)
    found: list[SourceContent] = []
    if sheets:
        found.append(DataSheets(sheets).content())
    if texts:
        found.append(read_cosmos(texts))
    if systems:
        found.append(read_xtce(systems))
    return (*found, unread) if unread.problems else tuple(found)


def _is_cosmos(file: Path) -> bool:
    try:
        return is_cosmos(read_limited(file, LINE_FILE_BYTES).decode("utf-8", "replace"))
    except OSError as error:
        raise UsageError(f"cannot be read: {error.strerror}; correct the path", file=file) from None
