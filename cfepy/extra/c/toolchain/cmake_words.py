"""The text of CMake's language: commands, and their words with variables, escapes and lists.

A file may come from any source: each pattern here takes time linear in the text.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

_TOKEN = re.compile(
    r"(?P<comment>#\[=*\[)|#[^\n]*|(?P<bracket>\[=*\[)|\"(?P<quoted>(?:[^\"\\]|\\.)*+)\"?|(?P<open>\()|(?P<close>\))"
    r"|(?P<space>\s+)|(?P<word>(?:[^\s()\"#\\]|\\.)(?:[^\s()\"#\\]|\\.|\"(?:[^\"\\\n]|\\.)*+\")*+)|.",
    re.DOTALL,
)
_NAME = re.compile(r"[A-Za-z_]\w*")
_SPECIAL = re.compile(r"\\(.?)|\$\{|\$(?:ENV|CACHE)\{|\}", re.DOTALL)
_PARTS = re.compile(r"((?:[^;\\\[\]]|\\.|\\$)+)|([;\[\]])", re.DOTALL)
_LETTERS = {"n": "\n", "t": "\t", "r": "\r", ";": "\\;"}
"""Escapes that do not stand for themselves. That of a semicolon is resolved when a list is split."""
_DEEPEST = 20  # references to variables in names of variables


class CMakeWord(NamedTuple):
    """An argument of a command, as written.

    Attributes:
        text: without its quotes.
        kind: "plain", "quoted", or "bracket", whose text is taken literally.
    """

    text: str
    kind: str = "plain"


class CMakeCommand(NamedTuple):
    """A command.

    Attributes:
        name: in small letters.
        words: its arguments; brackets inside them are words.
        size: characters of its text.
    """

    name: str
    words: Sequence[CMakeWord]
    size: int


def commands_of(text: str) -> Iterator[CMakeCommand]:
    """Yield the commands of a file; an unfinished one is left out."""
    name, words, depth, at, start = "", list[CMakeWord](), 0, 0, 0
    while at < len(text):
        token = _TOKEN.match(text, at)
        assert token is not None  # the last alternative takes any character
        begun, at = at, token.end()
        kind = token.lastgroup
        if kind == "comment" or (kind == "bracket" and depth):
            equals = token[0].count("=")
            end = text.find(f"]{'=' * equals}]", at)
            inner = text[at:] if end < 0 else text[at:end]
            at = len(text) if end < 0 else end + equals + 2
            if kind == "bracket":
                words.append(CMakeWord(inner.removeprefix("\n"), "bracket"))
        elif kind == "open" and (depth or name):
            depth += 1
            words += [CMakeWord("(")] if depth > 1 else []
        elif kind == "close" and depth:
            depth -= 1
            if depth:
                words.append(CMakeWord(")"))
            else:
                yield CMakeCommand(name.lower(), words, at - start)
                name, words = "", []
        elif depth and kind in ("word", "quoted"):
            words.append(CMakeWord(token[kind], "plain" if kind == "word" else "quoted"))
        elif not depth and kind != "space" and kind is not None:
            name = token[0] if kind == "word" and _NAME.fullmatch(token[0]) else ""
            words, start = [], begun


def expanded_text(text: str, value_of: Callable[[str], str]) -> str:
    """Return a text with its references to variables and its escapes replaced, in one pass as CMake does.

    Args:
        text: of a word that is not in brackets.
        value_of: returns the value of a variable, with semicolons between the items of a list. The value is not
            examined again.
    """
    parts: list[list[str]] = [[]]
    marks: list[str] = []
    at = 0
    for found in _SPECIAL.finditer(text):
        parts[-1].append(text[at : found.start()])
        at = found.end()
        if found[0].startswith("\\"):
            parts[-1].append(_LETTERS.get(found[1], found[1]))
        elif found[0] != "}" and len(marks) < _DEEPEST:
            marks.append(found[0])
            parts.append([])
        elif found[0] == "}" and marks:
            name = "".join(parts.pop())
            parts[-1].append(value_of(name) if marks.pop() == "${" else "")
        else:
            parts[-1].append(found[0])
    while marks:  # an unfinished reference
        inner = parts.pop()
        parts[-1] += [marks.pop(), *inner]
    return "".join([*parts[0], text[at:]])


def split_list(text: str) -> list[str]:
    """Return the items of a list without the empty ones. A semicolon in square brackets does not separate items."""
    if ";" not in text:
        return [text] if text else []
    items, depth = [""], 0
    pieces: list[list[str]] = [[]]
    for plain, mark in _PARTS.findall(text):
        if mark == ";" and depth == 0:
            pieces.append([])
            continue
        depth += {"[": 1, "]": -1 if depth else 0}.get(mark, 0)
        pieces[-1].append(plain or mark)
    items = ["".join(each).replace("\\;", ";") for each in pieces]
    return [each for each in items if each]
