"""Macros of a shared object that was compiled with `-g3`, and their values.

The section `.debug_macro` (DWARF 5, or GNU's form for DWARF 4) has the text of each macro. `Macros.value` expands and
computes it as the compiler does, as far as it is a whole number.
"""

from __future__ import annotations

import re
import struct
from collections.abc import Iterator, Mapping
from functools import lru_cache
from io import BytesIO
from typing import NamedTuple

from cfepy.extra.c.elf import elf_file

_TOKEN = re.compile(r"\s*(0[xX][0-9a-fA-F]+[uUlL]*|\d+[uUlL]*|\w+|##|<<|>>|[-+*/%&|^~!()#,])")
_MACRO = re.compile(r"(\w+)(\(([^)]*)\))?(?:\s+(.*))?", re.DOTALL)
_MOST_TOKENS = 5_000
_DEEP = 60
_LEVELS = (("|",), ("^",), ("&",), ("<<", ">>"), ("+", "-"), ("*", "/", "%"))
"""Binary operators, those that bind least first."""
_DEFINE, _UNDEF, _START_FILE, _END_FILE, _DEFINE_STRP, _UNDEF_STRP, _IMPORT = range(1, 8)
_LARGEST = 1 << 64


class Macro(NamedTuple):
    """A macro: its parameters, None for a macro without brackets, and its text."""

    parameters: tuple[str, ...] | None
    text: str


class _NoNumberError(Exception):
    """The text of a macro is not a whole number."""


class Macros:
    """The macros of a shared object; use `macros_of`.

    Args:
        known: the macros by name.
    """

    def __init__(self, known: Mapping[str, Macro]) -> None:
        self._known = known

    def names(self, *suffixes: str) -> list[str]:
        """Return the names that end with one of the suffixes, in the order of their definitions."""
        return [name for name, macro in self._known.items() if name.endswith(suffixes) and macro.parameters is None]

    def value(self, name: str, constants: Mapping[str, int]) -> int | None:
        """Return the value of a macro, or None if it is not a whole number.

        Args:
            name: the macro.
            constants: values of enumerators.
        """
        try:
            tokens = [*self._expanded([name], frozenset(), constants, 0)]
            return _Sum(tokens).value()
        except (_NoNumberError, ValueError, ArithmeticError, RecursionError):  # a text of anybody
            return None

    def _expanded(
        self, tokens: list[str], hidden: frozenset[str], constants: Mapping[str, int], depth: int
    ) -> Iterator[str]:
        """Yield tokens with all macros expanded, but for those that are being expanded."""
        if depth > _DEEP or len(tokens) > _MOST_TOKENS:
            raise _NoNumberError
        at = 0
        while at < len(tokens):
            token = tokens[at]
            at += 1
            macro = None if token in hidden else self._known.get(token)
            if macro is None:
                yield str(constants[token]) if token in constants else token
            elif macro.parameters is None:
                yield from self._expanded(_tokens(macro.text), hidden | {token}, constants, depth + 1)
            elif tokens[at : at + 1] == ["("]:
                arguments, at = _arguments(tokens, at + 1)
                filled = _filled(macro, arguments)
                yield from self._expanded(filled, hidden | {token}, constants, depth + 1)
            else:
                raise _NoNumberError


def _tokens(text: str) -> list[str]:
    found, at = [], 0
    while text[at:].strip():
        match = _TOKEN.match(text, at)
        if match is None:
            raise _NoNumberError
        found.append(match[1])
        at = match.end()
    return found


def _arguments(tokens: list[str], at: int) -> tuple[list[list[str]], int]:
    """Return the arguments of a call, and the place after its closing bracket."""
    arguments: list[list[str]] = [[]]
    depth = 0
    while at < len(tokens):
        token = tokens[at]
        at += 1
        if token == ")" and depth == 0:
            return arguments, at
        if token == "," and depth == 0:
            arguments.append([])
            continue
        depth += {"(": 1, ")": -1}.get(token, 0)
        arguments[-1].append(token)
    raise _NoNumberError


def _filled(macro: Macro, arguments: list[list[str]]) -> list[str]:
    """Return the text of a macro with its arguments, and with names joined at ##."""
    given = dict(zip(macro.parameters or (), arguments, strict=False))
    filled: list[str] = []
    joins = False
    for token in _tokens(macro.text):
        if token == "##":
            joins = True
            continue
        part = given.get(token, [token])
        if joins and filled and part:
            filled[-1] += part[0]
            part = part[1:]
        filled += part
        joins = False
    return filled


class _Sum:
    """An expression of whole numbers."""

    def __init__(self, tokens: list[str]) -> None:
        self._tokens = tokens

    def value(self) -> int:
        found = self._level(0)
        if self._tokens:
            raise _NoNumberError
        return found

    def _level(self, level: int) -> int:
        if level == len(_LEVELS):
            return self._atom()
        left = self._level(level + 1)
        while self._tokens and self._tokens[0] in _LEVELS[level]:
            left = _applied(self._tokens.pop(0), left, self._level(level + 1))
        return left

    def _atom(self) -> int:
        if not self._tokens:
            raise _NoNumberError
        token = self._tokens.pop(0)
        if token in ("-", "+", "~"):
            value = self._atom()
            return {"-": -value, "+": value, "~": ~value & 0xFFFFFFFF}[token]
        if token == "(":
            return self._bracket()
        digits = token.rstrip("uUlL")
        if digits[:1].isdigit():
            octal = len(digits) > 1 and digits.isdigit() and digits[0] == "0"
            return int(digits, 8 if octal else 0)
        raise _NoNumberError

    def _bracket(self) -> int:
        """Return the value of a bracket, or of the number after a cast such as `(uint16)`."""
        inner, self._tokens = _bracketed(self._tokens)
        if inner and all(re.fullmatch(r"[A-Za-z_]\w*", each) for each in inner):
            return self._atom()
        return _Sum(inner).value()


def _bracketed(tokens: list[str]) -> tuple[list[str], list[str]]:
    """Return the tokens up to the bracket that closes, and those after it."""
    depth = 1
    for number, token in enumerate(tokens):
        depth += {"(": 1, ")": -1}.get(token, 0)
        if depth == 0:
            return tokens[:number], tokens[number + 1 :]
    raise _NoNumberError


def _applied(operator: str, left: int, right: int) -> int:
    if operator in ("<<", ">>") and not 0 <= right <= 64:
        raise _NoNumberError
    if operator in ("/", "%") and (left < 0 or right <= 0):
        raise _NoNumberError
    found = {
        "|": lambda: left | right,
        "^": lambda: left ^ right,
        "&": lambda: left & right,
        "<<": lambda: left << right,
        ">>": lambda: left >> right,
        "+": lambda: left + right,
        "-": lambda: left - right,
        "*": lambda: left * right,
        "/": lambda: left // right,
        "%": lambda: left % right,
    }[operator]()
    if abs(found) > _LARGEST:
        raise _NoNumberError
    return found


# -- reading -----------------------------------------------------------------------------------------------------------


@lru_cache(32)  # a mission is read for each of its tools
def macros_of(data: bytes) -> Macros:
    """Return the macros of a shared object; none if it was compiled without `-g3`.

    Args:
        data: the bytes of its file.
    """
    try:
        elf = elf_file(BytesIO(data))
        section, strings = (elf.get_section_by_name(name) for name in (".debug_macro", ".debug_str"))
        texts = b"" if strings is None else strings.data()
        found = {} if section is None else dict(_read(section.data(), texts))
    except Exception:  # debug data may be damaged: pyelftools raises errors of many types
        found = {}
    return Macros(found)


def _read(data: bytes, strings: bytes) -> Iterator[tuple[str, Macro]]:
    """Yield the macros of all units; the first definition of a name stays."""
    seen: set[str] = set()
    for text in _defined(data, strings):
        match = _MACRO.match(text)
        if match is None or match[1] in seen:
            continue
        seen.add(match[1])
        parameters = None if match[2] is None else tuple(part.strip() for part in match[3].split(","))
        yield match[1], Macro(parameters, match[4] or "")


def _defined(data: bytes, strings: bytes) -> Iterator[str]:
    """Yield the texts of all definitions.

    Raises:
        ValueError, IndexError, struct.error: for a damaged section.
    """
    at = 0
    while at + 3 <= len(data):
        _, flags = struct.unpack_from("<HB", data, at)
        at += 3
        word = 8 if flags & 1 else 4
        at += word if flags & 2 else 0
        if flags & 4:
            return  # operands of other operations: no compiler writes them
        while data[at]:
            operation = data[at]
            at += 1
            if operation in (_DEFINE, _UNDEF):
                at = _after_number(data, at)
                end = data.index(b"\0", at)
                if operation == _DEFINE:
                    yield data[at:end].decode(errors="replace")
                at = end + 1
            elif operation in (_DEFINE_STRP, _UNDEF_STRP):
                at = _after_number(data, at)
                place = int.from_bytes(data[at : at + word], "little")
                if operation == _DEFINE_STRP:
                    yield strings[place : strings.index(b"\0", place)].decode(errors="replace")
                at += word
            elif operation == _START_FILE:
                at = _after_number(data, _after_number(data, at))
            elif operation == _IMPORT:
                at += word
            elif operation != _END_FILE:
                raise ValueError(f"unknown operation {operation}")
        at += 1


def _after_number(data: bytes, at: int) -> int:
    """Return the place after a number of variable length (LEB128)."""
    while data[at] & 0x80:
        at += 1
    return at + 1
