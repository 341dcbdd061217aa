"""Runs the files of procedures: ERB, modules `openc3`, `load_utility`, and the lines of errors."""

from __future__ import annotations

import ast
import builtins
import re
import sys
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType, TracebackType
from typing import Any

from cfepy.extra.procedures.connection import CfepyConnection, CfsTest_Connection
from cfepy.extra.procedures.erb import Template
from cfepy.extra.procedures.limit_functions import functions_of
from cfepy.extra.procedures.procedure_errors import (
    REFUSED,
    CheckError,
    SkipScript,
    StopScript,
    UnsupportedError,
    place_in,
    refusing,
)
from cfepy.extra.procedures.requirements import Requirements, requirement
from cfepy.extra.procedures.script_api import ScriptApi
from cfepy.extra.procedures.suites import ProcedureGroup, ProcedureSuite
from cfepy.reading.input_files import read_limited
from cfepy.reading.input_limits import LINE_FILE_BYTES
from cfepy.reading.suggestions import did_you_mean
from cfepy.status import UsageError

LINE = "__cfepy_line__"
"""Name of the function that procedures call before each line."""
_SUITE = re.compile(r"^\s*class\s+\w+\s*\(\s*(?:\w+\.)*(?:Test)?Suite\s*\)", re.M)
_SECOND_DOOR = re.compile(r"^\s*DEFAULT_APP_NAME\s*=", re.M)
_MODULES = ("openc3", "openc3.script", "openc3.script.suite", "openc3.script.exceptions", "cfepy_procedures")
_CONNECTION = "cfs_test_connection"
_STRING = re.compile(r"([rRbBuUfF]{0,2})(\"\"\"|'''|\"|')")


def find_procedures(path: Path) -> list[Path]:
    """Return the files to fly: the file itself, or those in a folder that declare a suite or use the second door.

    Raises:
        UsageError: if there is none.
    """
    if path.is_file():
        return [path.resolve()]
    if not path.is_dir():
        raise UsageError("does not exist; name a file or a folder of procedures", file=path)
    found = [each.resolve() for each in sorted(path.rglob("*.py")) if _is_procedure(each)]
    if not found:
        raise UsageError("has no suite; a suite is a class derived from ProcedureSuite", file=path)
    return found


def _is_procedure(file: Path) -> bool:
    text = read_limited(file, LINE_FILE_BYTES).decode("utf-8", "replace")
    if "openc3" not in text and "DEFAULT_APP_NAME" not in text:
        return False
    return _SUITE.search(text) is not None or _SECOND_DOOR.search(text) is not None


def suites_in(file: Path) -> list[str]:
    """Return the names of the suites of a file, found without a flight; [""] for a script without a suite.

    Raises:
        UsageError: if the file has a mistake.
    """
    text = read_limited(file, LINE_FILE_BYTES).decode("utf-8", "replace")
    if file.suffix == ".rb":
        raise UsageError("is Ruby; only Python procedures run", file=file)
    names = re.findall(r"^\s*class\s+(\w+)\s*\(\s*(?:\w+\.)*(?:Test)?Suite\s*\)", text, re.M)
    return names or [""]


def has_second_door(file: Path) -> bool:
    """Return whether a file has tests for a connection, see `connection.py`."""
    return _SECOND_DOOR.search(read_limited(file, LINE_FILE_BYTES).decode("utf-8", "replace")) is not None


class Procedures:
    """The files of procedures in one flight.

    Args:
        api: the functions of procedures.
        folders: folders in which `load_utility` looks for files, and Python for modules.
        variables: variables of ERB.
        requirements: where `@requirement` and the tracker write.

    Attributes:
        files: paths of the files that were run.
    """

    def __init__(
        self, api: ScriptApi, folders: list[Path], variables: Mapping[str, Any], requirements: Requirements
    ) -> None:
        self.files: set[str] = set()
        self._template = Template(variables, api._targets.helper)
        self._folders = folders
        self._names: dict[str, Any] = {
            **{name: refusing(name) for name in REFUSED},
            **functions_of(api, api._limits, api._records),
            "load_utility": self.load,
            "require_utility": self.require,
            "start": self.load,
            "Group": ProcedureGroup,
            "TestGroup": ProcedureGroup,
            "Suite": ProcedureSuite,
            "TestSuite": ProcedureSuite,
            "SkipScript": SkipScript,
            "SkipTestCase": SkipScript,
            "StopScript": StopScript,
            "CheckError": CheckError,
            "requirement": requirement,
        }
        self._names["set_requirement_status"] = requirements.set_status
        self._clock = procedure_clock(api)
        own = {**vars(builtins), "__import__": self._import, LINE: api._before_line}
        self._globals: dict[str, Any] = {"__name__": "procedure", "__builtins__": own, **self._names}
        self._before: dict[str, ModuleType] = {}
        self._path: list[str] = []

    def __enter__(self) -> Procedures:
        self._before = dict(sys.modules)
        self._path = list(sys.path)
        for name in _MODULES:
            sys.modules[name] = self._module(name)
        sys.modules[_CONNECTION] = _connections()
        sys.path[:0] = [str(each) for each in self._folders]
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        sys.path[:] = self._path
        for name, module in list(sys.modules.items()):
            if name in (*_MODULES, _CONNECTION) or (name not in self._before and self._is_own(module)):
                sys.modules.pop(name, None)
        for name in (*_MODULES, _CONNECTION):
            if name in self._before:
                sys.modules[name] = self._before[name]

    def _import(self, name: str, *given: Any, **options: Any) -> Any:
        """Import a module for a procedure, whose module `time` has the mission's clock."""
        known = set(sys.modules)
        found = builtins.__import__(name, *given, **options)
        for new in set(sys.modules) - known:
            if self._is_own(sys.modules[new]):
                self._set_clock(sys.modules[new])
        return self._clock if found is time else found

    def _is_own(self, module: ModuleType) -> bool:
        """Return whether a module is a file of the procedures, not one of a virtual environment in their folder."""
        file = getattr(module, "__file__", None) or ""
        roots = tuple(f"{each}/" for each in self._folders)
        installed = tuple(f"{each}/" for each in self._path if f"{each}/".startswith(roots))
        return file.startswith(roots) and not file.startswith(installed)

    def _set_clock(self, module: ModuleType) -> None:
        for name, value in list(vars(module).items()):
            if value is time:
                setattr(module, name, self._clock)
            elif value is time.sleep:
                setattr(module, name, self._clock.sleep)

    def _module(self, name: str) -> ModuleType:
        module = ModuleType(name)
        if name in ("openc3", "openc3.script"):
            module.__path__ = []  # a package, whose modules are in sys.modules already
        names = {"openc3": {}}.get(name, self._names)
        module.__dict__.update(names)
        if name == "openc3.script":
            module.__dict__["suite"] = sys.modules.get("openc3.script.suite") or ModuleType("openc3.script.suite")
        return module

    def run(self, file: Path) -> dict[str, Any]:
        """Run a file, and return the names that it has defined.

        Raises:
            UsageError: if it cannot be read, is Ruby, or has a syntax error.
        """
        before = dict(self._globals)
        self._execute(file)
        return {name: value for name, value in self._globals.items() if before.get(name) is not value}

    def load(self, name: str, *given: Any) -> bool:
        """Run a file as `load_utility` does, in the same names.

        Args:
            name: its path below one of the folders, such as "CFS/procedures/utility.py".
        """
        self._execute(self._found(name))
        return True

    def require(self, name: str) -> bool:
        """Run a file once."""
        file = self._found(name)
        if str(file) in self.files:
            return False
        self._execute(file)
        return True

    def _execute(self, file: Path) -> None:
        if file.suffix == ".rb":
            raise UsageError("is Ruby; only Python procedures run", file=file)
        text = read_limited(file, LINE_FILE_BYTES).decode("utf-8", "replace")
        rendered = self._template.render(text, file)
        try:
            code = compile(with_pauses(_parsed(rendered, file)), str(file), "exec")
        except SyntaxError as error:
            remedy = "; it looks like Ruby" if _is_ruby(rendered) else ""
            raise UsageError(f"{error.msg}{remedy}", file=file, line=error.lineno) from None
        self.files.add(str(file))
        exec(code, self._globals)

    def _found(self, name: str) -> Path:
        if name.endswith(".rb"):
            raise UnsupportedError(f"{name} is Ruby; only Python procedures run")
        parts = Path(name).parts
        for folder in self._folders:
            for tail in (parts, parts[1:]):  # the first part is the name of the target
                candidate = folder.joinpath(*tail)
                if tail and candidate.is_file():
                    return candidate.resolve()
        known = [each.name for folder in self._folders for each in folder.glob("**/*.py")]
        raise UsageError(f"{name} does not exist; {did_you_mean(Path(name).name, known, 'give its folder')}")

    def trackers(self) -> list[Any]:
        """Return the objects of procedures and of their modules that track requirements, each once."""
        own = [vars(each) for each in list(sys.modules.values()) if self._is_own(each)]
        found = {id(value): value for names in [self._globals, *own] for value in names.values() if _is_tracker(value)}
        return list(found.values())

    def place(self, error: BaseException) -> str:
        """Return the line of a procedure that raised an exception."""
        return place_in(error.__traceback__, self.files)


def _parsed(text: str, file: Path) -> ast.Module:
    try:
        return ast.parse(text, str(file))
    except SyntaxError:
        changed = without_new_f_strings(text)
        if changed == text:
            raise
    return ast.parse(changed, str(file))


def _is_tracker(value: Any) -> bool:
    """Return whether a value is like NASA's RequirementTracker."""
    return not isinstance(value, type) and hasattr(value, "set_requirement") and hasattr(value, "requirements")


def _connections() -> ModuleType:
    module = ModuleType(_CONNECTION)
    module.__dict__["CfsTest_Connection"] = CfsTest_Connection
    module.__dict__["CfepyConnection"] = CfepyConnection
    return module


def _is_ruby(text: str) -> bool:
    lines = [line.strip() for line in text.splitlines()]
    return "end" in lines or any(line.startswith(("require '", "puts ", "load_utility '")) for line in lines)


@contextmanager
def group_output(write: Any) -> Iterator[None]:
    """Let `Group.print` write to the output of the flight; a context manager."""
    before = ProcedureGroup._write
    ProcedureGroup._write = staticmethod(write)
    try:
        yield
    finally:
        ProcedureGroup._write = staticmethod(before)


def with_pauses(tree: ast.Module) -> ast.Module:
    """Return a module with a call of `LINE` before each statement except declarations and docstrings."""
    for node in list(ast.walk(tree)):
        for name in ("body", "orelse", "finalbody"):
            statements = getattr(node, name, None)
            if isinstance(statements, list):
                setattr(node, name, [new for each in statements for new in _paused(each)])
    return ast.fix_missing_locations(tree)


def _paused(statement: ast.stmt) -> list[ast.stmt]:
    is_text = isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Constant)
    declares = (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef, ast.Import, ast.ImportFrom, ast.Global)
    if is_text or isinstance(statement, (*declares, ast.Nonlocal)):
        return [statement]
    call = ast.Expr(ast.Call(ast.Name(LINE, ast.Load()), [], []))
    ast.copy_location(call, statement)
    return [call, statement]


def procedure_clock(api: ScriptApi) -> ModuleType:
    """Return the module `time` of a procedure.

    Args:
        api: its functions.
    """
    module = ModuleType("time")
    module.__dict__.update({name: value for name, value in vars(time).items() if not name.startswith("__")})
    module.__dict__["sleep"] = api._sleep
    for name in ("time", "monotonic", "perf_counter"):
        module.__dict__[name] = api._time
    return module


# -- f-strings -------------------------------------------------------------------------------------------------------


class _TooNewError(Exception):
    """A text that has no form in Python 3.11."""


def without_new_f_strings(source: str) -> str:
    """Return source code of Python 3.12 for 3.11: a text inside of an f-string gets other quotes than the f-string's.

    Args:
        source: source code; it is returned unchanged if it has a text that needs both kinds of quotes.
    """
    try:
        return _code(source, 0, "", "")[0]
    except _TooNewError:
        return source


def _code(source: str, at: int, end: str, outer: str) -> tuple[str, int]:
    """Return code and where it ends.

    Args:
        source: all of the source.
        at: where the code begins.
        end: the bracket that ends it; empty for all of the source.
        outer: the quotes of the f-string around the code; empty outside of one.
    """
    parts: list[str] = []
    depth = 0
    while at < len(source):
        char = source[at]
        match = _STRING.match(source, at)
        if match is not None and not _is_name(source[at - 1 : at]):
            text, at = _string(source, match, outer)
            parts.append(text)
            continue
        if char == "#" and not end:
            last = source.find("\n", at)
            last = len(source) if last < 0 else last
            parts.append(source[at:last])
            at = last
            continue
        if end and depth == 0 and char == end:
            return "".join(parts), at
        depth += (char in "([{") - (char in ")]}")
        parts.append(char)
        at += 1
    if end:
        raise _TooNewError
    return "".join(parts), at


def _is_name(before: str) -> bool:
    return before.isidentifier() or before.isdigit()


def _string(source: str, match: re.Match[str], outer: str) -> tuple[str, int]:
    """Return a text with its prefix and quotes, and where it ends."""
    prefix, quotes = match[1], match[2]
    at = match.end()
    parts: list[str] = []
    while not source.startswith(quotes, at):
        if at >= len(source) or (len(quotes) == 1 and source[at] == "\n"):
            raise _TooNewError
        if source[at] == "\\":
            parts.append(source[at : at + 2])
            at += 2
        elif source[at] == "{" and "f" in prefix.lower() and source[at : at + 2] != "{{":
            code, at = _code(source, at + 1, "}", quotes)
            parts.append("{" + code + "}")
            at += 1
        else:
            width = 2 if source[at : at + 2] == "{{" else 1
            parts.append(source[at : at + width])
            at += width
    body = "".join(parts)
    if outer and quotes[0] == outer[0]:
        quotes = "'" if outer[0] == '"' else '"'
        if quotes in body or "\\" in body:
            raise _TooNewError
    return f"{prefix}{quotes}{body}{quotes}", at + len(match[2])
