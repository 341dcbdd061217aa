"""Checks of a startup script and its code: entries, names, sources, entry points, the ABI of compiled code."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

from cfepy.es import CFE_APP, NODE_SYMBOL, StartupEntry, startup_script
from cfepy.mission import CORE_APPS, find_code, find_compiled, find_node
from cfepy.mission import app_sources as sources
from cfepy.osal import OS_MAX_FILE_NAME
from cfepy.pilot.mission_check.problem import MissionProblem
from cfepy.plugins import Hook, missing
from cfepy.reading.resources import shipped
from cfepy.reading.suggestions import did_you_mean

NO_SYMBOL = "NULL"
FILES = "/cf/"
C_SOURCES = "fsw/src"
CheckCompiled = Callable[[Path, Sequence[StartupEntry], StartupEntry, Path], Iterator[MissionProblem]]
CHECK_COMPILED: Hook[CheckCompiled] = Hook("check_compiled")
"""Checks compiled code: startup script, its entries, the entry of the file, the file."""


def check_startup(script: Path, data: bytes, entries: list[StartupEntry], longest: int) -> Iterator[MissionProblem]:
    """Check a startup script, and the code of its applications.

    Args:
        script: its path; code is searched in its folder.
        data: its contents.
        entries: its entries.
        longest: maximum number of characters in an entry for the mission's release of cFE.
    """
    for note in startup_script.check(data, longest):
        yield MissionProblem(script, note.line, note.explanation, note.is_warning)
    yield from _check_names(script, entries)
    for entry in entries:
        yield from _check_code(script, entries, entry)


def app_sources(folder: Path, entries: list[StartupEntry]) -> Iterator[tuple[Path, str]]:
    """Yield the sources of applications and libraries, each with its entry point; nodes have none.

    Args:
        folder: folder of the mission.
        entries: the entries of its startup script.
    """
    for entry in entries:
        code = find_code(entry.path, folder) if entry.path.startswith(FILES) else None
        source = None if code is None or entry.symbol == NODE_SYMBOL else sources.source_of(code)
        if source is not None:
            yield source, entry.symbol


def _check_names(script: Path, entries: list[StartupEntry]) -> Iterator[MissionProblem]:
    """Yield duplicate names; applications and libraries have separate name spaces."""
    taken = {(CFE_APP, name): "the core application" for name in CORE_APPS}
    for entry in entries:
        if not entry.name:
            continue  # the check of the script has reported it
        key = (entry.kind, entry.name)
        if key in taken:
            text = f"the name {entry.name!r} is already taken by {taken[key]}; choose another name"
            yield MissionProblem(script, entry.line, text)
        taken.setdefault(key, f"line {entry.line}")


def _check_code(script: Path, entries: list[StartupEntry], entry: StartupEntry) -> Iterator[MissionProblem]:
    folder = script.parent
    if not entry.path.startswith(FILES) or ".." in entry.path:
        text = f"{entry.path} must be below /cf, the mission's folder; write {FILES}..."
        yield MissionProblem(script, entry.line, text)
        return
    is_node = entry.symbol == NODE_SYMBOL
    if not is_node and len(entry.path.rpartition("/")[2]) >= OS_MAX_FILE_NAME:
        text = f"the file name in {entry.path} must have fewer than {OS_MAX_FILE_NAME} characters"
        yield MissionProblem(script, entry.line, text)
        return
    compiled = None if is_node else find_compiled(entry.path, folder)
    if compiled is not None:
        check = CHECK_COMPILED.first()
        if check is None:
            yield MissionProblem(script, entry.line, missing(f"compiled code, as {compiled.name},", "c"))
        else:
            yield from check(script, entries, entry, compiled)
        return
    code = (find_node(entry.path, folder) if is_node else None) or find_code(entry.path, folder)
    if code is None:
        stem = Path(entry.path).stem
        text = (
            f"missing code for {entry.path}: found no {stem}.py and no package {stem} "
            f"in {folder}, and no app or module {stem}"
        )
        names = [*_sources_in(folder), *(each.name for each in shipped("apps").iterdir())]
        hint = did_you_mean(stem, names, before="; ")
        yield MissionProblem(script, entry.line, f"{text}; add it, or correct the name{hint}")
        return
    if is_node and not isinstance(code, Path):
        yield MissionProblem(
            script, entry.line, f"the script of node {entry.name} is missing in the mission's folder; add it"
        )
        return
    source = sources.source_of(code)
    if source is not None and not is_node:
        broken = list(_check_syntax(source))
        yield from broken or _check_symbol(script, entry, source)


def _sources_in(folder: Path) -> list[str]:
    """Return the names of the Python files and packages of a folder, as a startup script names them."""
    found = [each for each in folder.iterdir() if each.suffix == ".py" or (each / "__init__.py").is_file()]
    return sorted(each.stem for each in found)


def _check_syntax(source: Path) -> Iterator[MissionProblem]:
    for file in sources.files_of(source):
        error = sources.syntax_error(file)
        if error is not None:
            yield MissionProblem(file, error[0], f"is not Python: {error[1]}")


def _check_symbol(script: Path, entry: StartupEntry, source: Path) -> Iterator[MissionProblem]:
    if entry.symbol in ("", NO_SYMBOL):
        return  # the check of the script has reported an application without one
    if not sources.defines(source, entry.symbol):
        functions = [name for file in sources.files_of(source) for name in sources.functions_of(file)]
        add = f"write {NODE_SYMBOL} if it is a ROS node, or add the function"
        if (script.parent / C_SOURCES).is_dir():
            add = f"if it is the application in {C_SOURCES}, compile it: cfepy build {script.parent}"
        hint = did_you_mean(entry.symbol, functions, add)
        yield MissionProblem(script, entry.line, f"{source} has no function {entry.symbol}; {hint}")
    else:
        yield from _check_entry_point(entry, source)


def _check_entry_point(entry: StartupEntry, source: Path) -> Iterator[MissionProblem]:
    """Yield an entry point with the right name that cannot be called as one, according to its source."""
    functions = [each for each in sources.tree_of(source).body if getattr(each, "name", None) == entry.symbol]
    if len(functions) != 1 or not isinstance(functions[0], ast.FunctionDef | ast.AsyncFunctionDef):
        return
    function = functions[0]
    if function.decorator_list:
        return
    if isinstance(function, ast.AsyncFunctionDef):
        text = "must not be async, because calling it runs nothing; make it a plain function"
    elif _takes_one(function.args):
        return
    else:
        text = f"must take one argument, the handle of the services; write `def {function.name}(cfe):`"
    yield MissionProblem(source, function.lineno, f"the entry point {function.name} of {entry.name} {text}")


def _takes_one(arguments: ast.arguments) -> bool:
    """Return whether a function can be called with one positional argument."""
    positional = len(arguments.posonlyargs) + len(arguments.args)
    needed = positional - len(arguments.defaults)
    by_name = any(default is None for default in arguments.kw_defaults)
    return needed <= 1 and (positional >= 1 or arguments.vararg is not None) and not by_name
