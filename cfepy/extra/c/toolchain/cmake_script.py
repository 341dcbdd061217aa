"""A reader of CMake's language: enough of it for the files of cFS applications and of catkin packages.

It is not CMake: it finds nothing on the computer and builds nothing. It follows variables, `if`, `foreach`, `function`
and `macro`, lists, `file(GLOB)` and the files of subfolders. A subclass defines the meaning of a command. A condition
holds only if it is known to be true: an unset variable is false.

A file may come from any source, so the work that it can cause is limited (`CMakeBudget`). A file beyond the limit is
refused.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from fnmatch import fnmatchcase
from pathlib import Path
from typing import NamedTuple

from cfepy.reading.input_limits import CMAKE_CHARACTERS, CMAKE_COMMANDS, CMAKE_DEPTH, CMAKE_FILES
from cfepy.status import UsageError

FILE = "CMakeLists.txt"
FALSE = ("", "0", "OFF", "NO", "FALSE", "N", "IGNORE", "NOTFOUND")
_TOKEN = re.compile(
    r"(?P<comment>#\[=*\[)|#[^\n]*|(?P<quoted>\"(?:[^\"\\]|\\.)*+\"?)|(?P<open>\()|(?P<close>\))"
    r"|(?P<space>\s+)|(?P<word>(?:[^\s()\"#\\]|\\.)++)|.",
    re.DOTALL,
)
_NAME = re.compile(r"[A-Za-z_]\w*")
_WORD = re.compile(r'"((?:[^"\\]|\\.)*+)"|([^\s;]+)', re.DOTALL)
_ASKED = re.compile(r'"((?:[^"\\]|\\.)*+)"|([()])|([^\s;()]+)', re.DOTALL)
_VARIABLE = re.compile(r"\$\{(\w+)\}")
_NUMBER = re.compile(r"[0-9]{1,18}")
_DEEP = "**"  # any number of folders, in a pattern
_MOST_PARTS = 40  # of a pattern
_LONGEST_PART = 255  # characters of a file's name
_ROUNDS = 8  # of replacements of variables in names and values of variables
_ENDS = {"if": "endif", "foreach": "endforeach", "while": "endwhile", "function": "endfunction", "macro": "endmacro"}


class CMakeBudget:
    """Limits for the files of a package, including subfolders.

    Args:
        file: the outermost one, for errors.
    """

    def __init__(self, file: Path) -> None:
        self._file = file
        self._commands = CMAKE_COMMANDS
        self._characters = CMAKE_CHARACTERS
        self._files = CMAKE_FILES
        self._depth = 0

    def command(self) -> None:
        """Count a command. It raises the errors of `spend`."""
        self._commands -= 1
        if self._commands < 0:
            raise self._error(f"executes more than {CMAKE_COMMANDS:,} commands, loops included")

    def turns(self, count: int) -> None:
        """Count the turns of a loop, each as a command. It raises the errors of `spend`."""
        self._commands -= count
        if self._commands < 0:
            raise self._error(f"has a loop of {count:,} iterations, more than {CMAKE_COMMANDS:,} commands")

    def spend(self, characters: int) -> None:
        """Count characters of words that are read or made.

        Raises:
            UsageError: they are too many.
        """
        self._characters -= characters
        if self._characters < 0:
            raise self._error(f"makes words of more than {CMAKE_CHARACTERS:,} characters")

    def look(self) -> None:
        """Count a file or folder that a pattern examines. It raises the errors of `spend`."""
        self._files -= 1
        if self._files < 0:
            raise self._error(f"has patterns that match more than {CMAKE_FILES:,} files")

    @contextmanager
    def inside(self) -> Iterator[None]:
        """Count a nested block, call or subfolder in this context. It raises the errors of `spend`."""
        self._depth += 1
        if self._depth > CMAKE_DEPTH:
            raise self._error(f"has more than {CMAKE_DEPTH} nested blocks, calls and subfolders")
        yield
        self._depth -= 1

    def _error(self, what: str) -> UsageError:
        return UsageError(f"{what}, the limit; simplify it", file=self._file)


class CMakeCommand(NamedTuple):
    """A command: its name in small letters, and the text between the parentheses."""

    name: str
    text: str

    @property
    def words(self) -> list[str]:
        """Its words, with unexpanded variables."""
        return [quoted or plain for quoted, plain in _WORD.findall(self.text)]


@dataclass(frozen=True, slots=True)
class _Block:
    """Successive commands of a file.

    Attributes:
        commands: all of the file.
        ends: by the number of a command that begins a structure, the number of its end; missing if it does not end.
        start, stop: the first, and the one after the last.
    """

    commands: Sequence[CMakeCommand]
    ends: Mapping[int, int]
    start: int
    stop: int

    def end_of(self, at: int) -> int:
        """Return the end of a structure; the end of the block if it does not end."""
        return min(self.ends.get(at, self.stop), self.stop)

    def part(self, start: int, stop: int) -> _Block:
        """Return a part of the block."""
        return _Block(self.commands, self.ends, start, max(start, stop))


class CMakeScript:
    """Executes a file; a subclass gives meaning to commands.

    Args:
        folder: of the file.
        variables: variables that are already set.
        budget: the remaining budget of the including file; None for a separate file.

    Attributes:
        folder: of the file that is being read.
        variables: by name, each a list.
        budget: the remaining budget.
        follows_loops: whether `foreach` is executed.
    """

    follows_loops = True

    def __init__(self, folder: Path, variables: Mapping[str, Sequence[str]], budget: CMakeBudget | None = None) -> None:
        self.folder = folder
        self.budget = CMakeBudget(folder / FILE) if budget is None else budget
        self.budget.spend(sum(len(name) + len(values) for name, values in variables.items()))
        self.variables = {name: list(values) for name, values in variables.items()}
        self._routines: dict[str, tuple[list[str], _Block]] = {}

    def run(self, text: str) -> None:
        """Execute a file's text.

        Raises:
            UsageError: it exceeds the budget.
        """
        self.budget.spend(len(text))
        commands = list(_commands(text))
        with self.budget.inside():
            self._all(_Block(commands, _ends(commands), 0, len(commands)))

    def command(self, name: str, words: list[str]) -> None:
        """Execute a command outside of structures, with expanded words. Subclasses add more commands."""
        match name, words:
            case "set", [variable, *values]:
                self.variables[variable] = _until(_until(values, "CACHE"), "PARENT_SCOPE")
            case "unset", [variable, *_]:
                self.variables.pop(variable, None)
            case "list", ["APPEND", variable, *values]:
                self.variables.setdefault(variable, []).extend(values)
            case "list", ["REMOVE_ITEM", variable, *values]:
                before, unwanted = self.variables.get(variable, []), set(values)
                self.budget.spend(len(before))
                self.variables[variable] = [each for each in before if each not in unwanted]
            case "aux_source_directory", [folder, variable]:
                self.variables.setdefault(variable, []).extend(self.glob(f"{folder}/*.c*"))
            case "file", ["GLOB" | "GLOB_RECURSE" as kind, variable, *patterns]:
                self.variables[variable] = self._globbed(patterns, kind == "GLOB_RECURSE")

    def glob(self, pattern: str, deep: bool = False) -> list[str]:
        """Return files of a pattern, sorted, relative to the folder; with `deep` also those of subfolders."""
        base, _, name = pattern.rpartition("/")
        pattern = f"{base}/**/{name}".lstrip("/") if deep else pattern
        return _matching_files(self.folder, pattern, self.budget.look)

    def holds(self, words: Sequence[str]) -> bool:
        """Return True if a condition holds. An unknown condition does not hold."""
        return _Condition(self, words).value()

    def is_true(self, word: str) -> bool:
        """Return True if a word is true: a constant, or a variable that is not false."""
        if word.upper() in ("1", "ON", "YES", "TRUE", "Y"):
            return True
        values = self.variables.get(word, [])
        return bool(values) and values[0].upper() not in FALSE and not values[0].upper().endswith("-NOTFOUND")

    def expanded(self, words: Sequence[str]) -> list[str]:
        """Return words with their variables replaced. A variable that is a whole word becomes a word for each value."""
        found: list[str] = []
        for word in words:
            whole = _VARIABLE.fullmatch(word)
            if whole:
                values = self.variables.get(whole[1], [])
                self.budget.spend(len(values) + sum(map(len, values)))
                found += values
            else:
                found.append(self.text(word))
        return found

    def text(self, word: str) -> str:
        """Return a word with its variables replaced, including those in names of variables."""
        self.budget.spend(len(word))
        for _ in range(_ROUNDS):
            replaced = _VARIABLE.sub(self._value, word)
            if replaced == word:
                break
            word = replaced
        return word

    def _value(self, variable: re.Match[str]) -> str:
        value = " ".join(self.variables.get(variable[1], []))
        self.budget.spend(len(value) + 1)
        return value

    # -- structures ----------------------------------------------------------------------------------------------------

    def _all(self, block: _Block) -> bool:
        """Execute commands. Returns False if `return` ends the file or function."""
        at = block.start
        while at < block.stop:
            self.budget.command()
            each = block.commands[at]
            end = block.end_of(at) if each.name in _ENDS else at
            if each.name == "return":
                return False
            if not self._one(each, block.part(at + 1, end)):
                return False
            at = end + 1
        return True

    def _one(self, each: CMakeCommand, body: _Block) -> bool:
        match each.name:
            case "if":
                with self.budget.inside():
                    return self._all(self._branch(each, body))
            case "foreach":
                with self.budget.inside():
                    return not self.follows_loops or self._loop(self._words(each), body)
            case "function" | "macro":
                name, *parameters = self._words(each) or [""]
                self._routines[name.lower()] = (parameters, body)
            case "while":
                pass  # its condition is not known here
            case name if name in self._routines:
                with self.budget.inside():
                    self._call(*self._routines[name], self._words(each))
            case name:
                self.command(name, self._words(each))
        return True

    def _words(self, command: CMakeCommand) -> list[str]:
        self.budget.spend(len(command.text))
        return self.expanded(command.words)

    def _branch(self, first: CMakeCommand, body: _Block) -> _Block:
        """Return the commands of the branch that holds."""
        condition: CMakeCommand | None = first
        start = at = body.start
        while at <= body.stop:
            each = body.commands[at] if at < body.stop else None
            if each is None or each.name in ("elseif", "else"):
                if condition is None or self.holds(self._asked(condition)):
                    return body.part(start, at)
                if each is None:
                    break
                condition = each if each.name == "elseif" else None
                start = at + 1
            at = (body.end_of(at) if each is not None and each.name in _ENDS else at) + 1
        return body.part(body.stop, body.stop)

    def _asked(self, condition: CMakeCommand) -> list[str]:
        self.budget.spend(len(condition.text))
        return [quoted or mark or plain for quoted, mark, plain in _ASKED.findall(condition.text)]

    def _loop(self, words: list[str], body: _Block) -> bool:
        name, *values = words or [""]
        match values:
            case ["IN", *rest]:
                values = [item for each in rest if each != "ITEMS" for item in self._listed(each, "LISTS" in rest)]
            case ["RANGE", *numbers] if all(map(_NUMBER.fullmatch, numbers)) and len(numbers) in (1, 2):
                first, last = (0, *map(int, numbers))[-2:]
                self.budget.turns(max(last - first, 0))
                values = [str(each) for each in range(first, last + 1)]
        self.budget.turns(len(values))
        for value in values:
            self.variables[name] = [value]
            if not self._all(body):
                return False
        return True

    def _listed(self, word: str, of_lists: bool) -> list[str]:
        found = [] if word == "LISTS" else self.variables.get(word, []) if of_lists else [word]
        self.budget.spend(len(found))
        return found

    def _call(self, parameters: Sequence[str], body: _Block, words: list[str]) -> None:
        own = (*parameters, "ARGV", "ARGN")
        self.budget.spend(len(own) + len(words))
        before = {name: self.variables[name] for name in own if name in self.variables}
        for name, value in zip(parameters, words, strict=False):
            self.variables[name] = [value]
        self.variables |= {"ARGV": words, "ARGN": words[len(parameters) :]}
        self._all(body)
        for name in own:
            if name in before:
                self.variables[name] = before[name]
            else:
                self.variables.pop(name, None)

    def _globbed(self, patterns: Sequence[str], deep: bool) -> list[str]:
        found: list[str] = []
        names = iter(patterns)
        for each in names:
            if each == "RELATIVE":
                next(names, None)
            elif each not in ("CONFIGURE_DEPENDS", "FOLLOW_SYMLINKS"):
                found += self.glob(each, deep)
        return found


class _Condition:
    """A condition of `if`, read from left to right: OR binds least, then AND, then NOT.

    Args:
        script: the script with the variables.
        words: of the condition.
    """

    def __init__(self, script: CMakeScript, words: Sequence[str]) -> None:
        self._script = script
        self._words = words
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
            with self._script.budget.inside():
                found = self._either()
            self._take(")")
            return found
        word = self._next()
        if word in _TESTS and self._ahead() not in ("", "AND", "OR", ")"):
            return _TESTS[word](self._script, self._script.text(self._next()))
        if self._ahead() in _COMPARISONS:
            compare = _COMPARISONS[self._next()]
            return compare(self._meant(word), self._meant(self._next()))
        return self._script.is_true(self._script.text(word))

    def _ahead(self) -> str:
        """Return the next word; empty if there is none."""
        return self._words[self._at] if self._at < len(self._words) else ""

    def _next(self) -> str:
        word = self._ahead()
        self._at += 1
        return word

    def _take(self, word: str) -> bool:
        if self._ahead() != word:
            return False
        self._at += 1
        return True

    def _meant(self, word: str) -> str:
        values = self._script.variables.get(word)
        if values is None:
            return self._script.text(word)
        meant = " ".join(values)
        self._script.budget.spend(len(meant))
        return meant


_TESTS: Mapping[str, Callable[[CMakeScript, str], bool]] = {
    "DEFINED": lambda script, word: word in script.variables,
    "EXISTS": lambda script, word: os.path.exists(script.folder / word),
    "IS_DIRECTORY": lambda script, word: os.path.isdir(script.folder / word),
    "TARGET": lambda script, word: False,
    "COMMAND": lambda script, word: False,
    "POLICY": lambda script, word: False,
}
_COMPARISONS: Mapping[str, Callable[[str, str], bool]] = {
    "STREQUAL": lambda one, other: one == other,
    "EQUAL": lambda one, other: one == other,
    "MATCHES": lambda one, other: other in one,
    "VERSION_LESS": lambda one, other: _version(one) < _version(other),
    "VERSION_GREATER": lambda one, other: _version(one) > _version(other),
    "VERSION_EQUAL": lambda one, other: _version(one) == _version(other),
    "VERSION_LESS_EQUAL": lambda one, other: _version(one) <= _version(other),
    "VERSION_GREATER_EQUAL": lambda one, other: _version(one) >= _version(other),
}


def _version(text: str) -> list[tuple[int, str]]:
    """Return the numbers of a version in a form that compares as numbers, with any number of digits."""
    numbers = (each.lstrip("0") for each in re.findall(r"[0-9]+", text))
    return [(len(each), each) for each in numbers]


def _until(words: list[str], word: str) -> list[str]:
    return words[: words.index(word)] if word in words else words


def _commands(text: str) -> Iterator[CMakeCommand]:
    """Yield the commands of a file; an unfinished one is left out."""
    name, parts, depth, at = "", [""], 0, 0
    while at < len(text):
        token = _TOKEN.match(text, at)
        assert token is not None  # the last alternative takes any character
        at = token.end()
        kind = token.lastgroup
        if kind == "comment":
            end = text.find(f"]{'=' * (len(token[0]) - 3)}]", at)
            at = len(text) if end < 0 else end + len(token[0]) - 1
        elif kind == "open" and (depth or name):
            depth += 1
            parts += ["("] if depth > 1 else []
        elif kind == "close" and depth:
            depth -= 1
            if depth:
                parts.append(")")
            else:
                yield CMakeCommand(name.lower(), "".join(parts))
                name, parts = "", []
        elif depth:
            parts += [token[0]] if kind is not None else []
        elif kind != "space" and kind is not None:
            name, parts = token[0] if kind == "word" and _NAME.fullmatch(token[0]) else "", []


def _ends(commands: Sequence[CMakeCommand]) -> dict[int, int]:
    """Return the ends of structures, by the commands that begin them."""
    open_at: dict[str, list[int]] = {end: [] for end in _ENDS.values()}
    found = {}
    for at, each in enumerate(commands):
        if each.name in _ENDS:
            open_at[_ENDS[each.name]].append(at)
        elif open_at.get(each.name):
            found[open_at[each.name].pop()] = at
    return found


# -- files of a pattern: links can form cycles, which the budget ends --------------------------------------------------


def _matching_files(folder: Path, pattern: str, look: Callable[[], object]) -> list[str]:
    """Find the files and folders of a pattern.

    Args:
        folder: folder in which the search begins.
        pattern: a path with `*`, `?` and `[...]` in its parts; `**` stands for any number of folders, and follows no
            symbolic links.
        look: called for each file or folder that is examined; may raise.

    Returns:
        Paths relative to the folder, sorted; empty for an absolute pattern.
    """
    parts = [each for each in pattern.split("/") if each not in ("", ".")]
    is_strange = any((_DEEP in each and each != _DEEP) or len(each) > _LONGEST_PART or "\0" in each for each in parts)
    if not parts or pattern.startswith("/") or is_strange or len(parts) > _MOST_PARTS:
        return []
    return sorted(set(_below(folder, "", parts, look)))


def _below(folder: Path, inner: str, parts: Sequence[str], look: Callable[[], object]) -> Iterator[str]:
    """Yield paths in an inner folder that match the parts."""
    part, *rest = parts
    if part == _DEEP:
        for place in _folders(folder, inner, look):
            yield from _below(folder, place, rest, look) if rest else [place] if place else []
    elif any(mark in part for mark in "*?["):
        for entry in _entries(folder, inner, look):
            if fnmatchcase(entry.name, part) and (not rest or os.path.isdir(entry.path)):
                found = f"{inner}{entry.name}"
                yield from _below(folder, f"{found}/", rest, look) if rest else [found]
    else:
        look()
        found = f"{inner}{part}"
        if os.path.exists(folder / found):
            yield from _below(folder, f"{found}/", rest, look) if rest else [found]


def _folders(folder: Path, inner: str, look: Callable[[], object]) -> Iterator[str]:
    """Yield an inner folder and all folders in it, each with a slash at its end."""
    waiting = [inner]
    while waiting:
        place = waiting.pop()
        yield place
        inside = (each for each in _entries(folder, place, look) if each.is_dir(follow_symlinks=False))
        waiting += [f"{place}{each.name}/" for each in inside]


def _entries(folder: Path, inner: str, look: Callable[[], object]) -> Iterator[os.DirEntry[str]]:
    try:
        with os.scandir(folder / inner) as found:
            for entry in found:
                look()
                yield entry
    except OSError:
        return
