"""A reader of CMake's language: enough of it for the files of cFS applications and of catkin packages.

It is not CMake: it finds nothing on the computer and builds nothing. It follows variables and their scopes, `if`,
loops, `function` and `macro`, the commands for lists, texts and paths, `file(GLOB)` and the files of subfolders. A
subclass defines the meaning of a command. A condition holds only if it is known to be true: an unset variable is false.

A file may come from any source, so the work that it can cause is limited (`CMakeBudget`). A file beyond the limit is
refused.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import Enum, auto
from pathlib import Path

from cfepy.extra.c.toolchain.cmake_budget import CMakeBudget, matching_files
from cfepy.extra.c.toolchain.cmake_commands import list_command, math_command, path_command, string_command
from cfepy.extra.c.toolchain.cmake_conditions import CMakeCondition
from cfepy.extra.c.toolchain.cmake_words import CMakeCommand, CMakeWord, commands_of, expanded_text, split_list

FILE = "CMakeLists.txt"
_NUMBER = re.compile(r"-?[0-9]{1,18}")
_ENDS = {"if": "endif", "foreach": "endforeach", "while": "endwhile", "function": "endfunction", "macro": "endmacro"}
_PARENT = "PARENT_SCOPE"


class _End(Enum):
    """How the execution of commands ended."""

    NEXT = auto()
    CONTINUE = auto()
    BREAK = auto()
    RETURN = auto()


_LEAVING = {"return": _End.RETURN, "break": _End.BREAK, "continue": _End.CONTINUE}


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


@dataclass(frozen=True, slots=True)
class _Routine:
    """A function or a macro.

    Attributes:
        parameters: names of its parameters.
        body: its commands.
        is_function: whether it has variables of its own.
    """

    parameters: Sequence[str]
    body: _Block
    is_function: bool


class CMakeScript:
    """Executes a file; a subclass gives meaning to commands.

    Args:
        folder: of the file.
        variables: variables that are already set.
        budget: the remaining budget of the including file; None for a separate file.
        outer: the script of the including folder, whose functions are known and whose variables PARENT_SCOPE sets.

    Attributes:
        folder: of the file that is being read.
        variables: by name, each a list.
        budget: the remaining budget.
    """

    def __init__(
        self,
        folder: Path,
        variables: Mapping[str, Sequence[str]],
        budget: CMakeBudget | None = None,
        outer: CMakeScript | None = None,
    ) -> None:
        self.folder = folder
        self.budget = CMakeBudget(folder / FILE) if budget is None else budget
        self.budget.spend(sum(len(name) + len(values) for name, values in variables.items()))
        self.variables = {name: list(values) for name, values in variables.items()}
        self._routines: dict[str, _Routine] = {} if outer is None else outer._routines
        self._parents: list[dict[str, list[str]]] = [{} if outer is None else outer.variables]

    def run(self, text: str) -> None:
        """Execute a file's text.

        Raises:
            UsageError: it exceeds the budget.
        """
        self.budget.spend(len(text))
        commands = list(commands_of(text))
        with self.budget.inside():
            self._all(_Block(commands, _ends(commands), 0, len(commands)))

    def command(self, name: str, words: list[str]) -> None:
        """Execute a command outside of structures, with expanded words. Subclasses add more commands."""
        match name, words:
            case "set", [variable, *values]:
                self._set(variable, values)
            case "unset", [variable, *rest]:
                (self._parents[-1] if _PARENT in rest else self.variables).pop(variable, None)
            case "option", [variable, _, *default]:
                self.variables.setdefault(variable, default[:1] or ["OFF"])
            case "list", _:
                list_command(self, words)
            case "string", _:
                string_command(self, words)
            case "get_filename_component", _:
                path_command(self, words)
            case "math", _:
                math_command(self, words)
            case "cmake_parse_arguments", [prefix, *rest]:
                self._parse(prefix, rest)
            case "aux_source_directory", [folder, variable]:
                self.variables.setdefault(variable, []).extend(self.glob(f"{folder}/*.c*"))
            case "file", ["GLOB" | "GLOB_RECURSE" as kind, variable, *patterns]:
                self.variables[variable] = self._globbed(patterns, kind == "GLOB_RECURSE")

    def _set(self, variable: str, values: Sequence[str]) -> None:
        is_outer = values[-1:] == [_PARENT]
        values = values[:-1] if is_outer else values
        is_cached = "CACHE" in values
        values = values[: values.index("CACHE")] if is_cached else values
        items = [item for value in values for item in split_list(value)]
        self.spend(len(items))
        if is_cached and variable in self.variables:
            return
        held = self._parents[-1] if is_outer else self.variables
        if values:
            held[variable] = items
        else:
            held.pop(variable, None)

    def glob(self, pattern: str, deep: bool = False) -> list[str]:
        """Return files of a pattern, sorted, relative to the folder; with `deep` also those of subfolders."""
        base, _, name = pattern.rpartition("/")
        pattern = f"{base}/**/{name}".lstrip("/") if deep else pattern
        return matching_files(self.folder, pattern, self.budget.look)

    def expanded(self, words: Sequence[CMakeWord]) -> list[str]:
        """Return words with their variables replaced. A list that is not quoted becomes a word for each item."""
        found: list[str] = []
        for word in words:
            text = self.text(word)
            found += split_list(text) if word.kind == "plain" else [text]
        return found

    def text(self, word: CMakeWord) -> str:
        """Return a word with its variables and escapes replaced."""
        self.spend(len(word.text))
        if word.kind == "bracket" or ("$" not in word.text and "\\" not in word.text):
            return word.text
        return expanded_text(word.text, self._value)

    def _value(self, name: str) -> str:
        value = ";".join(each.replace(";", "\\;") for each in self.variables.get(name, []))
        self.spend(len(value) + 1)
        return value

    # -- what conditions and commands for variables need ---------------------------------------------------------------

    def knows(self, kind: str, name: str) -> bool:
        """Return True if there is such a TARGET, COMMAND or POLICY."""
        return kind == "COMMAND" and name.lower() in self._routines

    def matched(self, groups: Sequence[str]) -> None:
        """Set the variables of a regular expression that has matched."""
        for number, group in enumerate(groups):
            self.variables[f"CMAKE_MATCH_{number}"] = split_list(group)

    def spend(self, characters: int) -> None:
        """Count characters of words that are read or made."""
        self.budget.spend(characters)

    def descend(self) -> None:
        """Count a nested bracket, and refuse too many."""
        self.budget.descend()

    def ascend(self) -> None:
        """End a nested bracket."""
        self.budget.ascend()

    # -- structures ----------------------------------------------------------------------------------------------------

    def _all(self, block: _Block) -> _End:
        """Execute commands, and return how that ended."""
        at = block.start
        while at < block.stop:
            self.budget.command()
            each = block.commands[at]
            end = block.end_of(at) if each.name in _ENDS else at
            if each.name in _LEAVING:
                return _LEAVING[each.name]
            ended = self._one(each, block.part(at + 1, end))
            if ended is not _End.NEXT:
                return ended
            at = end + 1
        return _End.NEXT

    def _one(self, each: CMakeCommand, body: _Block) -> _End:
        match each.name:
            case "if":
                with self.budget.inside():
                    return self._all(self._branch(each, body))
            case "foreach":
                with self.budget.inside():
                    return self._loop(self._words(each), body)
            case "while":
                with self.budget.inside():
                    return self._while(each, body)
            case "function" | "macro":
                name, *parameters = self._words(each) or [""]
                self._routines[name.lower()] = _Routine(parameters, body, each.name == "function")
            case name if name in self._routines:
                with self.budget.inside():
                    return self._call(self._routines[name], self._words(each))
            case name:
                self.command(name, self._words(each))
        return _End.NEXT

    def _words(self, command: CMakeCommand) -> list[str]:
        self.budget.spend(command.size)
        return self.expanded(command.words)

    def _holds(self, condition: CMakeCommand) -> bool:
        self.budget.spend(condition.size)
        words: list[CMakeWord] = []
        for word in condition.words:
            if word.kind == "plain" and "$" in word.text:
                words += [CMakeWord(_literal(each)) for each in split_list(self.text(word))]
            else:
                words.append(word)
        return CMakeCondition(self, words).value()

    def _branch(self, first: CMakeCommand, body: _Block) -> _Block:
        """Return the commands of the branch that holds."""
        condition: CMakeCommand | None = first
        start = at = body.start
        while at <= body.stop:
            each = body.commands[at] if at < body.stop else None
            if each is None or each.name in ("elseif", "else"):
                if condition is None or self._holds(condition):
                    return body.part(start, at)
                if each is None:
                    break
                condition = each if each.name == "elseif" else None
                start = at + 1
            at = (body.end_of(at) if each is not None and each.name in _ENDS else at) + 1
        return body.part(body.stop, body.stop)

    def _while(self, condition: CMakeCommand, body: _Block) -> _End:
        while self._holds(condition):
            self.budget.turns(1)
            ended = self._all(body)
            if ended is _End.RETURN:
                return ended
            if ended is _End.BREAK:
                break
        return _End.NEXT

    def _loop(self, words: list[str], body: _Block) -> _End:
        name, *values = words or [""]
        match values:
            case ["IN", *rest]:
                values = list(self._listed(rest))
            case ["RANGE", *numbers] if all(map(_NUMBER.fullmatch, numbers)) and len(numbers) in (1, 2, 3):
                first, last, step = _range(*map(int, numbers))
                self.budget.turns(max((last - first) // step, 0))
                values = [str(each) for each in range(first, last + (1 if step > 0 else -1), step)]
        self.budget.turns(len(values))
        before = self.variables.get(name)
        ended = _End.NEXT
        for value in values:
            self.variables[name] = [value]
            ended = self._all(body)
            if ended in (_End.RETURN, _End.BREAK):
                break
        if before is None:
            self.variables.pop(name, None)
        else:
            self.variables[name] = before
        return _End.RETURN if ended is _End.RETURN else _End.NEXT

    def _listed(self, words: Sequence[str]) -> Iterator[str]:
        """Yield the values of a loop over LISTS and ITEMS."""
        of_lists = False
        for word in words:
            if word in ("LISTS", "ITEMS"):
                of_lists = word == "LISTS"
                continue
            found = self.variables.get(word, []) if of_lists else [word]
            self.budget.spend(len(found))
            yield from found

    def _call(self, routine: _Routine, words: list[str]) -> _End:
        given = dict(zip(routine.parameters, ([each] for each in words), strict=False))
        given |= {f"ARGV{number}": [each] for number, each in enumerate(words[:20])}
        given |= {"ARGC": [str(len(words))], "ARGV": words, "ARGN": words[len(routine.parameters) :]}
        self.budget.spend(len(given) + len(words))
        outer = self.variables
        if routine.is_function:
            self.budget.spend(len(outer))
            self._parents.append(outer)
            self.variables = {**outer, **given}
            self._all(routine.body)
            self.variables = self._parents.pop()
            return _End.NEXT
        before = {name: outer.get(name) for name in given}
        outer |= given
        ended = self._all(routine.body)
        for name, values in before.items():
            if values is None:
                outer.pop(name, None)
            else:
                outer[name] = values
        return ended

    def _parse(self, prefix: str, words: Sequence[str]) -> None:
        """Execute cmake_parse_arguments."""
        if prefix == "PARSE_ARGV" or len(words) < 3:
            return
        flags, singles, many = (split_list(each) for each in words[:3])
        found: dict[str, list[str]] = {each: ["FALSE"] for each in flags}
        found |= {each: [] for each in (*singles, *many, "UNPARSED_ARGUMENTS")}
        section, most = "UNPARSED_ARGUMENTS", -1
        for each in words[3:]:
            if each in flags:
                found[each], section, most = ["TRUE"], "UNPARSED_ARGUMENTS", -1
            elif each in singles or each in many:
                section, most = each, 1 if each in singles else -1
            elif most == 0:
                found["UNPARSED_ARGUMENTS"].append(each)
            else:
                found[section].append(each)
                most -= most > 0
        for name, values in found.items():
            variable = f"{prefix}_{name}"
            if values:
                self.variables[variable] = values
            else:
                self.variables.pop(variable, None)

    def _globbed(self, patterns: Sequence[str], deep: bool) -> list[str]:
        found: list[str] = []
        base = ""
        names = iter(patterns)
        for each in names:
            if each == "RELATIVE":
                base = next(names, "")
            elif each == "LIST_DIRECTORIES":
                next(names, None)
            elif each not in ("CONFIGURE_DEPENDS", "FOLLOW_SYMLINKS"):
                found += self.glob(each, deep)
        if base:
            found = [os.path.relpath(self.folder / each, self.folder / base) for each in found]
            self.budget.spend(sum(map(len, found)))
        return found


def _literal(text: str) -> str:
    """Return a text as a word that stands for itself."""
    return re.sub(r"[\\$]", r"\\\g<0>", text)


def _range(first: int, *more: int) -> tuple[int, int, int]:
    """Return the first, the last and the step of a range; one number alone is the last."""
    begin, end = (first, more[0]) if more else (0, first)
    step = more[1] if len(more) > 1 and more[1] else 1 if begin <= end else -1
    return begin, end, step


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
