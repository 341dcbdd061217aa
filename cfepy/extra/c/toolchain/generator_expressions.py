"""CMake's generator expressions, as they are when a package is built on Linux with GCC."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence

from cfepy.extra.c.toolchain.cmake_conditions import FALSE, version_of
from cfepy.extra.c.toolchain.cmake_words import split_list

OBJECTS = "TARGET_OBJECTS"
_MARK = re.compile(r"\$<|>")
_DEEPEST = 30
_ARE = {
    "PLATFORM_ID": "Linux",
    "CXX_COMPILER_ID": "GNU",
    "C_COMPILER_ID": "GNU",
}
"""The value of a fact, by its expression. With arguments, the expression asks whether one of them is the value."""
_SIGNS = {"COMMA": ",", "SEMICOLON": ";", "ANGLE-R": ">", "QUOTE": '"'}


class GeneratorExpressions:
    """Evaluates expressions.

    Args:
        is_target: returns True if a target exists.
        property_of: returns a property of a target, with semicolons between its items; empty if it is not known.
        build_type: such as "Release"; empty without one.
        language: of the sources: "C" or "CXX".
    """

    def __init__(
        self,
        is_target: Callable[[str], bool],
        property_of: Callable[[str, str], str],
        build_type: str = "",
        language: str = "CXX",
    ) -> None:
        self._are = {**_ARE, "CONFIG": build_type, "COMPILE_LANGUAGE": language, "LINK_LANGUAGE": language}
        self._is_target = is_target
        self._property_of = property_of

    def words(self, words: Sequence[str]) -> list[str]:
        """Return words with their expressions evaluated. Words that belong to one expression are put together."""
        if not any("$<" in each for each in words):
            return list(words)
        return [each.strip() for each in split_list(self.text(";".join(words))) if each.strip()]

    def text(self, text: str) -> str:
        """Return a text with its expressions evaluated; an unfinished one becomes empty."""
        parts: list[list[str]] = [[]]
        at = 0
        for found in _MARK.finditer(text):
            parts[-1].append(text[at : found.start()])
            at = found.end()
            if found[0] == "$<":
                if len(parts) > _DEEPEST:
                    return ""
                parts.append([])
            elif len(parts) > 1:
                inner = "".join(parts.pop())
                parts[-1].append(self._value(inner))
            else:
                parts[-1].append(">")
        return "".join(parts[0]) + (text[at:] if len(parts) == 1 else "")

    def _value(self, inner: str) -> str:
        name, colon, rest = inner.partition(":")
        if name in _SIGNS:
            return _SIGNS[name]
        if not colon:
            return self._are.get(name, "")
        if name in ("0", "1"):
            return rest if name == "1" else ""
        if name in self._are:
            return _bit(any(each.lower() == self._are[name].lower() for each in rest.split(",")))
        if name == "TARGET_EXISTS":
            return _bit(self._is_target(rest))
        if name == "TARGET_NAME_IF_EXISTS":
            return rest if self._is_target(rest) else ""
        if name == OBJECTS:
            return f"$<{OBJECTS}:{rest}>"
        if name == "TARGET_PROPERTY":
            target, comma, which = rest.partition(",")
            return self._property_of(target, which) if comma else ""
        made = _OTHERS.get(name)
        return "" if made is None else made(rest)


def _bit(value: bool) -> str:
    return "1" if value else "0"


def _is_true(text: str) -> bool:
    return text.upper() not in FALSE and not text.upper().endswith("-NOTFOUND")


def _choice(rest: str) -> str:
    condition, _, both = rest.partition(",")
    one, _, other = both.partition(",")
    return one if condition == "1" else other


def _pair(compare: Callable[[str, str], bool]) -> Callable[[str], str]:
    def of_text(rest: str) -> str:
        one, _, other = rest.partition(",")
        return _bit(compare(one, other))

    return of_text


def _joined(rest: str) -> str:
    items, _, glue = rest.rpartition(",")
    return glue.join(split_list(items))


_OTHERS: Mapping[str, Callable[[str], str]] = {
    "BUILD_INTERFACE": lambda rest: rest,
    "LINK_ONLY": lambda rest: rest,
    "GENEX_EVAL": lambda rest: rest,
    "BUILD_LOCAL_INTERFACE": lambda rest: rest,
    "BOOL": lambda rest: _bit(_is_true(rest)),
    "NOT": lambda rest: _bit(rest == "0"),
    "AND": lambda rest: _bit("0" not in rest.split(",")),
    "OR": lambda rest: _bit("1" in rest.split(",")),
    "IF": _choice,
    "STREQUAL": _pair(lambda one, other: one == other),
    "EQUAL": _pair(lambda one, other: one == other),
    "IN_LIST": _pair(lambda one, other: one in split_list(other)),
    "VERSION_LESS": _pair(lambda one, other: version_of(one) < version_of(other)),
    "VERSION_GREATER": _pair(lambda one, other: version_of(one) > version_of(other)),
    "VERSION_EQUAL": _pair(lambda one, other: version_of(one) == version_of(other)),
    "VERSION_LESS_EQUAL": _pair(lambda one, other: version_of(one) <= version_of(other)),
    "VERSION_GREATER_EQUAL": _pair(lambda one, other: version_of(one) >= version_of(other)),
    "LOWER_CASE": str.lower,
    "UPPER_CASE": str.upper,
    "JOIN": _joined,
}
