"""Lines of command and telemetry text of COSMOS and OpenC3: words, types of items, and numbers.

Two readers share them: one for the dictionary of a mission, one for procedures, which needs more of each item.
"""

from __future__ import annotations

import re

from cfepy.status import UsageError

ITEM_KINDS = {"UINT": "u", "INT": "i", "FLOAT": "f", "STRING": "char", "BLOCK": "block", "BOOL": "bool"}
"""The kind of an item's values by the word in the text; `kind_of_item` reads one."""
DERIVED = "DERIVED"
"""The type of an item without a place in the packet."""
_WORD = re.compile(r'"((?:[^"\\]|\\.)*)"|\'((?:[^\'\\]|\\.)*)\'|(#.*)|(\S+)')
_ITEMS = ("ITEM", "PARAMETER")
_FORMS = {"APPEND", "ID", "ARRAY"}


def words_of(line: str) -> list[str]:
    """Return the words of a line without its comment; a quoted text is one word."""
    words = []
    for match in _WORD.finditer(line):
        if match[3] is not None:
            break
        words.append(next(part for part in (match[1], match[2], match[4]) if part is not None))
    return words


def item_forms(keyword: str) -> set[str] | None:
    """Return the words before ITEM or PARAMETER in a keyword, such as APPEND and ID; None for another keyword."""
    *forms, last = keyword.split("_")
    return {*forms} if last in _ITEMS and {*forms} <= _FORMS else None


def next_word(rest: list[str], meaning: str) -> str:
    """Remove and return the first word.

    Args:
        rest: the words of a line that are not read yet.
        meaning: the missing thing in the error, such as "a name".

    Raises:
        UsageError: there is no word left.
    """
    if not rest:
        raise UsageError(f"{meaning} is missing; add it")
    return rest.pop(0)


def kind_of_item(rest: list[str]) -> str:
    """Remove the type of an item and return its kind, one of ITEM_KINDS' values or DERIVED.

    Raises:
        UsageError: there is none, or it is unknown.
    """
    word = next_word(rest, "a type").upper()
    if word == DERIVED:
        return DERIVED
    if word not in ITEM_KINDS:
        raise UsageError(f"unknown type {word}; expected {', '.join([*ITEM_KINDS, DERIVED])}")
    return ITEM_KINDS[word]


def whole_number(word: str) -> int:
    """Return a whole number, which may be hexadecimal.

    Raises:
        UsageError: it is none.
    """
    try:
        return int(word, 0)
    except ValueError:
        raise UsageError(f"must be a whole number, not {word!r}") from None
