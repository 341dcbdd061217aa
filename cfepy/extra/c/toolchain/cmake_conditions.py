"""The conditions of CMake's `if` and `while`."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Protocol

from cfepy.extra.c.toolchain.cmake_commands import found_in
from cfepy.extra.c.toolchain.cmake_words import CMakeWord

FALSE = ("", "0", "OFF", "NO", "FALSE", "N", "IGNORE", "NOTFOUND")
_TRUE = ("ON", "YES", "TRUE", "Y")
_NUMBER = re.compile(r"\s*[-+]?[0-9]+(?:\.[0-9]*)?\s*")
_LONGEST_NUMBER = 30


class Conditional(Protocol):
    """The parts of a script that conditions depend on."""

    folder: Path
    variables: dict[str, list[str]]

    def text(self, word: CMakeWord) -> str:
        """Return a word with its variables replaced."""

    def knows(self, kind: str, name: str) -> bool:
        """Return True if there is such a TARGET, COMMAND or POLICY."""

    def matched(self, groups: Sequence[str]) -> None:
        """Set the variables of a regular expression that has matched."""

    def descend(self) -> None:
        """Count a nested bracket, and refuse too many."""

    def ascend(self) -> None:
        """End a nested bracket."""


class CMakeCondition:
    """A condition: OR binds least, then AND, then NOT.

    Args:
        script: the script with the variables.
        words: of the condition, as written.
    """

    def __init__(self, script: Conditional, words: Sequence[CMakeWord]) -> None:
        self._script = script
        self._words = [CMakeWord(script.text(each), each.kind) for each in words]
        self._at = 0

    def value(self) -> bool:
        """Return True if it holds."""
        return bool(self._words) and self._either()

    def _either(self) -> bool:
        found = self._both()
        while self._take("OR"):
            found = self._both() or found
        return found

    def _both(self) -> bool:
        found = self._single()
        while self._take("AND"):
            found = self._single() and found
        return found

    def _single(self) -> bool:
        negated = False
        while self._take("NOT"):
            negated = not negated
        return self._plain() != negated

    def _plain(self) -> bool:
        if self._take("("):
            self._script.descend()
            found = self._either()
            self._script.ascend()
            self._take(")")
            return found
        word = self._next()
        if word.kind == "plain" and word.text in _TESTS and self._ahead() not in ("", "AND", "OR", ")"):
            return _TESTS[word.text](self._script, self._next().text)
        compare = self._ahead()
        if compare in _COMPARISONS:
            self._next()
            return _COMPARISONS[compare](self._meant(word), self._meant(self._next()))
        if compare == "MATCHES":
            self._next()
            groups = found_in(self._next().text, self._meant(word))
            self._script.matched(groups or ())
            return groups is not None
        if compare == "IN_LIST":
            self._next()
            return self._meant(word) in self._script.variables.get(self._next().text, [])
        return self._is_true(word)

    def _is_true(self, word: CMakeWord) -> bool:
        upper = word.text.upper()
        if upper in _TRUE:
            return True
        if _NUMBER.fullmatch(word.text):
            return any(digit in "123456789" for digit in word.text)
        if word.kind != "plain" or upper in FALSE:
            return False
        value = ";".join(self._script.variables.get(word.text, [])).upper()
        return value not in FALSE and not value.endswith("-NOTFOUND")

    def _ahead(self) -> str:
        """Return the next word if it can be a keyword; empty otherwise."""
        if self._at >= len(self._words) or self._words[self._at].kind != "plain":
            return "" if self._at >= len(self._words) else '"'
        return self._words[self._at].text

    def _next(self) -> CMakeWord:
        word = self._words[self._at] if self._at < len(self._words) else CMakeWord("", "quoted")
        self._at += 1
        return word

    def _take(self, word: str) -> bool:
        if self._ahead() != word:
            return False
        self._at += 1
        return True

    def _meant(self, word: CMakeWord) -> str:
        values = self._script.variables.get(word.text) if word.kind == "plain" else None
        return word.text if values is None else ";".join(values)


def _number(text: str) -> float | None:
    return float(text) if _NUMBER.fullmatch(text) and len(text) <= _LONGEST_NUMBER else None


def _numbers(compare: Callable[[float, float], bool]) -> Callable[[str, str], bool]:
    def of_texts(one: str, other: str) -> bool:
        first, second = _number(one), _number(other)
        return first is not None and second is not None and compare(first, second)

    return of_texts


def version_of(text: str) -> list[tuple[int, str]]:
    """Return the numbers of a version in a form that compares as numbers, with any number of digits."""
    numbers = [each.lstrip("0") for each in re.findall(r"[0-9]+", text)]
    while numbers and not numbers[-1]:
        numbers.pop()
    return [(len(each), each) for each in numbers]


_TESTS: Mapping[str, Callable[[Conditional, str], bool]] = {
    "DEFINED": lambda script, word: word in script.variables,
    "EXISTS": lambda script, word: os.path.exists(script.folder / word),
    "IS_DIRECTORY": lambda script, word: os.path.isdir(script.folder / word),
    "IS_ABSOLUTE": lambda script, word: word.startswith("/"),
    "TARGET": lambda script, word: script.knows("TARGET", word),
    "COMMAND": lambda script, word: script.knows("COMMAND", word),
    "POLICY": lambda script, word: script.knows("POLICY", word),
    "TEST": lambda script, word: False,
}
_COMPARISONS: Mapping[str, Callable[[str, str], bool]] = {
    "STREQUAL": lambda one, other: one == other,
    "STRLESS": lambda one, other: one < other,
    "STRGREATER": lambda one, other: one > other,
    "EQUAL": _numbers(lambda one, other: one == other),
    "LESS": _numbers(lambda one, other: one < other),
    "GREATER": _numbers(lambda one, other: one > other),
    "LESS_EQUAL": _numbers(lambda one, other: one <= other),
    "GREATER_EQUAL": _numbers(lambda one, other: one >= other),
    "VERSION_LESS": lambda one, other: version_of(one) < version_of(other),
    "VERSION_GREATER": lambda one, other: version_of(one) > version_of(other),
    "VERSION_EQUAL": lambda one, other: version_of(one) == version_of(other),
    "VERSION_LESS_EQUAL": lambda one, other: version_of(one) <= version_of(other),
    "VERSION_GREATER_EQUAL": lambda one, other: version_of(one) >= version_of(other),
}
