"""CMake's commands for lists, texts, paths and numbers, which change only variables, and its regular expressions.

Python tries all ways to match, so a pattern of any source could take years. A repeated group is not searched, nor a
pattern with many repetitions or a long text with several: they match nothing here.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Protocol

from cfepy.extra.c.toolchain.cmake_words import split_list

_EXPRESSION = re.compile(r"[\s0-9+*/%()-]{1,100}")
_FACTOR = re.compile(r"\s*([0-9]{1,10}|[()+*/%-])")
_REPLACED = re.compile(r"\\([0-9])|\\(.)")
_REPEATS = re.compile(r"\\.|\[\^?\]?[^\]]*\]|([*+?])")
_MOST_REPEATS = 4
_MOST_STEPS = 20_000_000
_LONGEST_PATTERN = 300


class Variables(Protocol):
    """The parts of a script that these commands change."""

    folder: Path
    variables: dict[str, list[str]]

    def spend(self, characters: int) -> None:
        """Count characters of words that are made."""


def list_command(script: Variables, words: Sequence[str]) -> None:
    """Execute `list(...)`; a command that is not known here changes nothing."""
    match words:
        case ["JOIN", name, glue, result, *_]:
            _give(script, result, glue.join(_items(script, name)))
        case ["LENGTH", name, result]:
            _give(script, result, str(len(_items(script, name))))
        case ["GET", name, *places, result]:
            items = _items(script, name)
            chosen = [_at(items, each) for each in places]
            script.variables[result] = [each for each in chosen if each is not None] or ["NOTFOUND"]
        case ["SUBLIST", name, begin, length, result] if _is_number(begin) and _is_number(length):
            start, count = int(begin), int(length)
            script.variables[result] = _items(script, name)[start : None if count < 0 else start + count]
        case ["FIND", name, item, result]:
            items = _items(script, name)
            _give(script, result, str(items.index(item) if item in items else -1))
        case [kind, name, *rest]:
            items = _items(script, name)
            changed = _changed(script, kind, items, rest)
            if changed is not None:
                texts = sum(map(len, changed)) if kind == "TRANSFORM" else 0  # others keep the texts of the items
                script.spend(texts + len(changed))
                script.variables[name] = changed


def _changed(script: Variables, kind: str, items: list[str], rest: Sequence[str]) -> list[str] | None:
    """Return the new items of a list that a command changes; None if it does not."""
    match kind, rest:
        case "APPEND", added:
            return [*items, *_split(added)]
        case "PREPEND", added:
            return [*_split(added), *items]
        case "INSERT", [place, *added] if _is_number(place):
            return [*items[: int(place)], *_split(added), *items[int(place) :]]
        case "REMOVE_ITEM", unwanted:
            return [each for each in items if each not in set(unwanted)]
        case "REMOVE_AT", places:
            gone = {int(each) % max(len(items), 1) for each in places if _is_number(each)}
            return [each for at, each in enumerate(items) if at not in gone]
        case "REMOVE_DUPLICATES", _:
            return list(dict.fromkeys(items))
        case "REVERSE", _:
            return items[::-1]
        case "SORT", _:
            return sorted(items, reverse="DESCENDING" in rest)
        case "POP_BACK" | "POP_FRONT", results:
            for each in results:
                script.variables[each] = items[-1:] if kind == "POP_BACK" else items[:1]
            return items[:-1] if kind == "POP_BACK" else items[1:]
        case "FILTER", [mode, "REGEX", pattern]:
            return [each for each in items if (found_in(pattern, each) is not None) == (mode == "INCLUDE")]
        case "TRANSFORM", [action, *given]:
            return _transformed(items, action, given)
    return None


def _transformed(items: list[str], action: str, given: Sequence[str]) -> list[str] | None:
    if "OUTPUT_VARIABLE" in given or {"AT", "FOR", "REGEX"}.intersection(given[1:]):
        return None
    match action, given:
        case "APPEND", [text]:
            return [each + text for each in items]
        case "PREPEND", [text]:
            return [text + each for each in items]
        case "REPLACE", [pattern, text]:
            return [_regex_replaced(pattern, text, each) for each in items]
    change = _LETTERS.get(action)
    return None if change is None else [change(each) for each in items]


def string_command(script: Variables, words: Sequence[str]) -> None:
    """Execute `string(...)`; a command that is not known here changes nothing."""
    match words:
        case ["REPLACE", old, new, result, *texts] if old:
            text = "".join(texts)
            script.spend(len(text) + text.count(old) * len(new))
            _give(script, result, text.replace(old, new))
        case ["REGEX", "REPLACE", pattern, new, result, *texts]:
            script.spend(sum(map(len, texts)) * (len(new) + 1))
            _give(script, result, _regex_replaced(pattern, new, "".join(texts)))
        case ["REGEX", "MATCH", pattern, result, *texts]:
            groups = found_in(pattern, "".join(texts)) or ("",)
            for number, group in enumerate(groups):
                _give(script, f"CMAKE_MATCH_{number}", group)
            _give(script, result, groups[0])
        case ["REGEX", "MATCHALL", pattern, result, *texts]:
            text = "".join(texts)
            compiled = compiled_for(pattern, len(text))
            script.variables[result] = [] if compiled is None else [each[0] for each in compiled.finditer(text)]
        case ["CONCAT", result, *texts]:
            _give(script, result, "".join(texts))
        case ["JOIN", glue, result, *texts]:
            script.spend(len(glue) * len(texts))
            _give(script, result, glue.join(texts))
        case ["APPEND" | "PREPEND" as side, name, *texts]:
            held, added = ";".join(_items(script, name)), "".join(texts)
            _give(script, name, held + added if side == "APPEND" else added + held)
        case ["LENGTH", text, result]:
            _give(script, result, str(len(text.encode())))
        case ["SUBSTRING", text, begin, length, result] if _is_number(begin) and _is_number(length):
            start, count = int(begin), int(length)
            _give(script, result, text[start : None if count < 0 else start + count])
        case ["FIND", text, part, result, *mode]:
            _give(script, result, str(text.rfind(part) if mode == ["REVERSE"] else text.find(part)))
        case ["COMPARE", kind, one, other, result]:
            same = {"EQUAL": one == other, "NOTEQUAL": one != other, "LESS": one < other, "GREATER": one > other}
            _give(script, result, "1" if same.get(kind, False) else "0")
        case [kind, text, result] if kind in _LETTERS:
            _give(script, result, _LETTERS[kind](text))


def path_command(script: Variables, words: Sequence[str]) -> None:
    """Execute `get_filename_component(...)`."""
    match words:
        case [result, file, kind, *rest]:
            base = Path(rest[1]) if rest[:1] == ["BASE_DIR"] and len(rest) > 1 else script.folder
            made = _PATHS.get(kind)
            _give(script, result, file if made is None else made(base, file))


def math_command(script: Variables, words: Sequence[str]) -> None:
    """Execute `math(EXPR ...)` of whole numbers."""
    match words:
        case ["EXPR", result, text, *_] if _EXPRESSION.fullmatch(text):
            value = _Sum(_FACTOR.findall(text)).value()
            _give(script, result, "0" if value is None else str(value))


class _Sum:
    """A sum of products of whole numbers.

    Args:
        tokens: numbers, operators and brackets.
    """

    def __init__(self, tokens: Sequence[str]) -> None:
        self._tokens = list(tokens)[::-1]

    def value(self) -> int | None:
        """Return its value; None if it is not one."""
        try:
            found = self._sum()
        except (IndexError, ValueError, ZeroDivisionError, RecursionError):
            return None
        return None if self._tokens else found

    def _sum(self) -> int:
        found = self._product()
        while self._tokens and self._tokens[-1] in "+-":
            found += self._product() if self._tokens.pop() == "+" else -self._product()
        return found

    def _product(self) -> int:
        found = self._factor()
        while self._tokens and self._tokens[-1] in "*/%":
            mark, other = self._tokens.pop(), self._factor()
            whole = abs(found) // abs(other) if mark != "*" else 0
            whole = -whole if (found < 0) != (other < 0) else whole
            found = found * other if mark == "*" else whole if mark == "/" else found - whole * other
        return found

    def _factor(self) -> int:
        token = self._tokens.pop()
        if token == "(":
            found = self._sum()
            if self._tokens.pop() != ")":
                raise ValueError
            return found
        return -self._factor() if token == "-" else int(token)


def found_in(pattern: str, text: str) -> tuple[str, ...] | None:
    """Return the first match of a pattern and its groups; None without one."""
    compiled = compiled_for(pattern, len(text))
    match = None if compiled is None else compiled.search(text)
    return None if match is None else (match[0], *(group or "" for group in match.groups()))


def compiled_for(pattern: str, length: int) -> re.Pattern[str] | None:
    """Return a pattern for a text of some length; None if it is not one, or could take too long."""
    found = _compiled(pattern)
    if found is None or max(length, 1) ** (found[1] + 1) > _MOST_STEPS:
        return None
    return found[0]


@lru_cache(maxsize=200)
def _compiled(pattern: str) -> tuple[re.Pattern[str], int] | None:
    if len(pattern) > _LONGEST_PATTERN or "(?" in pattern or "{" in pattern or re.search(r"\)[*+?]", pattern):
        return None
    repeats = sum(1 for match in _REPEATS.finditer(pattern) if match[1])
    if repeats > _MOST_REPEATS:
        return None
    try:
        return re.compile(re.sub(r"\$$", r"\\Z", pattern) if not pattern.endswith("\\$") else pattern), repeats
    except (re.error, RecursionError, OverflowError):
        return None


def _regex_replaced(pattern: str, new: str, text: str) -> str:
    compiled = compiled_for(pattern, len(text))
    if compiled is None:
        return text

    def replaced(match: re.Match[str]) -> str:
        groups = (match[0], *match.groups())
        return _REPLACED.sub(
            lambda each: (groups[int(each[1])] or "") if each[1] and int(each[1]) < len(groups) else each[2] or "", new
        )

    return compiled.sub(replaced, text)


def _give(script: Variables, name: str, text: str) -> None:
    script.spend(len(text))
    script.variables[name] = split_list(text)


def _items(script: Variables, name: str) -> list[str]:
    items = script.variables.get(name, [])
    script.spend(len(items))
    return items


def _split(words: Iterable[str]) -> list[str]:
    return [item for word in words for item in split_list(word)]


def _at(items: Sequence[str], place: str) -> str | None:
    at = int(place) if _is_number(place) else len(items)
    return items[at] if -len(items) <= at < len(items) else None


def _is_number(text: str) -> bool:
    return re.fullmatch(r"-?[0-9]{1,9}", text) is not None


def _without_suffix(name: str, longest: bool) -> str:
    dot = name.find(".", 1) if longest else name.rfind(".")
    return name if dot < 1 else name[:dot]


def _longest_suffix(name: str) -> str:
    return name[len(_without_suffix(name, longest=True)) :]


_LETTERS: Mapping[str, Callable[[str], str]] = {
    "TOLOWER": str.lower,
    "TOUPPER": str.upper,
    "STRIP": str.strip,
    "MAKE_C_IDENTIFIER": lambda text: re.sub(r"^(?=[0-9])", "_", re.sub(r"[^A-Za-z0-9_]", "_", text)),
}
_PATHS: Mapping[str, Callable[[Path, str], str]] = {
    "NAME": lambda base, file: os.path.basename(file),
    "NAME_WE": lambda base, file: _without_suffix(os.path.basename(file), longest=True),
    "NAME_WLE": lambda base, file: _without_suffix(os.path.basename(file), longest=False),
    "EXT": lambda base, file: _longest_suffix(os.path.basename(file)),
    "LAST_EXT": lambda base, file: os.path.splitext(os.path.basename(file))[1],
    "DIRECTORY": lambda base, file: os.path.dirname(file),
    "PATH": lambda base, file: os.path.dirname(file),
    "ABSOLUTE": lambda base, file: os.path.normpath(base / file),
    "REALPATH": lambda base, file: os.path.normpath(base / file),
}
