"""A reader of CMake's language: enough of it for the files of cFS applications and of catkin packages.

This is no CMake: nothing is found on the computer and nothing is built. Variables, `if`, `foreach`, `function` and
`macro`, lists, `file(GLOB)` and the files of subfolders are followed; what a command means is decided by a subclass.
A condition holds when what it asks is known to be so: a variable that nobody has set is false.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

FILE = "CMakeLists.txt"
FALSE = ("", "0", "OFF", "NO", "FALSE", "N", "IGNORE", "NOTFOUND")
MOST_COMMANDS = 100_000
"""Commands that are carried out of one file, loops included: a file may call itself."""
_COMMAND = re.compile(r"([A-Za-z_]\w*)\s*\(((?:[^()\"]|\"[^\"]*\"|\([^()]*\))*)\)")
_WORD = re.compile(r'"([^"]*)"|([^\s;]+)')
_ASKED = re.compile(r'"([^"]*)"|([()])|([^\s;()]+)')
_VARIABLE = re.compile(r"\$\{(\w+)\}")
_ENDS = {"if": "endif", "foreach": "endforeach", "while": "endwhile", "function": "endfunction", "macro": "endmacro"}


class CMakeCommand(NamedTuple):
    """A command: its name in small letters, and what stands between the parentheses."""

    name: str
    text: str

    @property
    def words(self) -> list[str]:
        """Its words, with their variables."""
        return [quoted or plain for quoted, plain in _WORD.findall(self.text)]


class CMakeScript:
    """Carries out a file; a subclass gives meaning to commands.

    Args:
        folder: of the file.
        variables: those that are set before.

    Attributes:
        folder: of the file that is being read.
        variables: by name, each a list.
        follows_loops: whether `foreach` is carried out.
    """

    follows_loops = True

    def __init__(self, folder: Path, variables: Mapping[str, Sequence[str]]) -> None:
        self.folder = folder
        self.variables = {name: list(values) for name, values in variables.items()}
        self._routines: dict[str, tuple[list[str], list[CMakeCommand]]] = {}
        self._left = MOST_COMMANDS

    def run(self, text: str) -> None:
        """Carry out a file's text."""
        text = re.sub(r"#[^\n]*", "", text)
        self._all([CMakeCommand(match[1].lower(), match[2]) for match in _COMMAND.finditer(text)])

    def command(self, name: str, words: list[str]) -> None:
        """A command that belongs to no structure, its words expanded; subclasses know more of them."""
        match name, words:
            case "set", [variable, *values]:
                self.variables[variable] = _until(_until(values, "CACHE"), "PARENT_SCOPE")
            case "unset", [variable, *_]:
                self.variables.pop(variable, None)
            case "list", ["APPEND", variable, *values]:
                self.variables.setdefault(variable, []).extend(values)
            case "list", ["REMOVE_ITEM", variable, *values]:
                self.variables[variable] = [each for each in self.variables.get(variable, []) if each not in values]
            case "aux_source_directory", [folder, variable]:
                self.variables.setdefault(variable, []).extend(self.glob(f"{folder}/*.c*"))
            case "file", ["GLOB" | "GLOB_RECURSE" as kind, variable, *patterns]:
                self.variables[variable] = self._globbed(patterns, kind == "GLOB_RECURSE")

    def glob(self, pattern: str, deep: bool = False) -> list[str]:
        """Files of a pattern, sorted, as seen from the folder; with `deep` those of subfolders as well."""
        base, _, name = pattern.rpartition("/")
        pattern = f"{base}/**/{name}".lstrip("/") if deep else pattern
        try:
            return sorted(each.relative_to(self.folder).as_posix() for each in self.folder.glob(pattern))
        except (ValueError, NotImplementedError):  # a pattern that leads out of the folder
            return []

    def holds(self, words: Sequence[str]) -> bool:
        """Whether a condition holds; what cannot be known does not."""
        return _Condition(self, words).value()

    def is_true(self, word: str) -> bool:
        """Whether a word is true: a constant, or a variable that is not false."""
        if word.upper() in ("1", "ON", "YES", "TRUE", "Y"):
            return True
        values = self.variables.get(word, [])
        return bool(values) and values[0].upper() not in FALSE and not values[0].upper().endswith("-NOTFOUND")

    def expanded(self, words: Sequence[str]) -> list[str]:
        """Words with their variables replaced; a variable that is a word of its own becomes as many words as it has."""
        found: list[str] = []
        for word in words:
            whole = _VARIABLE.fullmatch(word)
            if whole:
                found += self.variables.get(whole[1], [])
            else:
                found.append(self.text(word))
        return found

    def text(self, word: str) -> str:
        """A word with its variables replaced, those in names of variables too."""
        for _ in range(8):
            replaced = _VARIABLE.sub(lambda match: " ".join(self.variables.get(match[1], [])), word)
            if replaced == word:
                break
            word = replaced
        return word

    # -- structures ----------------------------------------------------------------------------------------------------

    def _all(self, commands: Sequence[CMakeCommand]) -> bool:
        """Carry out commands; False when `return` ends the file or function."""
        at = 0
        while at < len(commands) and self._left > 0:
            self._left -= 1
            each = commands[at]
            end = _end_of(commands, at) if each.name in _ENDS else at
            if each.name == "return":
                return False
            if not self._one(each, commands[at + 1 : end]):
                return False
            at = end + 1
        return True

    def _one(self, each: CMakeCommand, body: Sequence[CMakeCommand]) -> bool:
        match each.name:
            case "if":
                return self._all(self._branch(each, body))
            case "foreach":
                return not self.follows_loops or self._loop(self.expanded(each.words), body)
            case "function" | "macro":
                name, *parameters = self.expanded(each.words) or [""]
                self._routines[name.lower()] = (parameters, list(body))
            case "while":
                pass  # counts something that is not known here
            case name if name in self._routines:
                self._call(*self._routines[name], self.expanded(each.words))
            case name:
                self.command(name, self.expanded(each.words))
        return True

    def _branch(self, first: CMakeCommand, body: Sequence[CMakeCommand]) -> Sequence[CMakeCommand]:
        """The commands of the branch that holds."""
        condition: CMakeCommand | None = first
        start = at = 0
        while at <= len(body):
            ends = at == len(body) or body[at].name in ("elseif", "else")
            if ends:
                if condition is None or self.holds(_asked(condition.text)):
                    return body[start:at]
                if at == len(body):
                    break
                condition = body[at] if body[at].name == "elseif" else None
                start = at + 1
            at = (_end_of(body, at) if at < len(body) and body[at].name in _ENDS else at) + 1
        return ()

    def _loop(self, words: list[str], body: Sequence[CMakeCommand]) -> bool:
        name, *values = words or [""]
        match values:
            case ["IN", *rest]:
                values = [item for each in rest if each != "ITEMS" for item in self._listed(each, "LISTS" in rest)]
            case ["RANGE", *numbers] if all(each.isdigit() for each in numbers) and len(numbers) in (1, 2):
                first, last = (0, *map(int, numbers))[-2:]
                values = [str(each) for each in range(first, last + 1)]
        for value in values:
            self.variables[name] = [value]
            if not self._all(body):
                return False
        return True

    def _listed(self, word: str, of_lists: bool) -> list[str]:
        return [] if word == "LISTS" else self.variables.get(word, []) if of_lists else [word]

    def _call(self, parameters: Sequence[str], body: Sequence[CMakeCommand], words: list[str]) -> None:
        before = dict(self.variables)
        for name, value in zip(parameters, words, strict=False):
            self.variables[name] = [value]
        self.variables |= {"ARGV": words, "ARGN": words[len(parameters) :]}
        self._all(body)
        for name in (*parameters, "ARGV", "ARGN"):
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
        script: whose variables it is about.
        words: of the condition.
    """

    def __init__(self, script: CMakeScript, words: Sequence[str]) -> None:
        self._script = script
        self._words = list(words)

    def value(self) -> bool:
        """Whether it holds."""
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
        if self._take("NOT"):
            return not self._single()
        if self._take("("):
            found = self._either()
            self._take(")")
            return found
        word = self._words.pop(0) if self._words else ""
        if word in _TESTS and self._words and self._words[0] not in ("AND", "OR", ")"):
            return _TESTS[word](self._script, self._script.text(self._words.pop(0)))
        if self._words and self._words[0] in _COMPARISONS:
            compare = _COMPARISONS[self._words.pop(0)]
            other = self._words.pop(0) if self._words else ""
            return compare(self._meant(word), self._meant(other))
        return self._script.is_true(self._script.text(word))

    def _take(self, word: str) -> bool:
        if self._words[:1] == [word]:
            del self._words[0]
            return True
        return False

    def _meant(self, word: str) -> str:
        values = self._script.variables.get(word)
        return self._script.text(word) if values is None else " ".join(values)


_TESTS: Mapping[str, Callable[[CMakeScript, str], bool]] = {
    "DEFINED": lambda script, word: word in script.variables,
    "EXISTS": lambda script, word: (script.folder / word).exists(),
    "IS_DIRECTORY": lambda script, word: (script.folder / word).is_dir(),
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


def _version(text: str) -> list[int]:
    return [int(each) for each in re.findall(r"\d+", text)]


def _asked(text: str) -> list[str]:
    return [quoted or mark or plain for quoted, mark, plain in _ASKED.findall(text)]


def _until(words: list[str], word: str) -> list[str]:
    return words[: words.index(word)] if word in words else words


def _end_of(commands: Sequence[CMakeCommand], at: int) -> int:
    """Where a structure ends that begins at a command; the last command when it does not."""
    start, depth = commands[at].name, 0
    for index in range(at, len(commands)):
        depth += (commands[index].name == start) - (commands[index].name == _ENDS[start])
        if depth == 0:
            return index
    return len(commands)
