"""A startup script and the code that it names: entries, names, sources, entry points, the ABI of compiled code."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence
from pathlib import Path

from cfepy.es import CFE_APP, CFE_LIB, StartupEntry, startup_script
from cfepy.input_files import read_limited
from cfepy.input_limits import OBJECT_BYTES
from cfepy.marked_yaml import Mistakes
from cfepy.mission import CORE_APPS, NODE_SYMBOL, MissionSections, find_code, find_compiled, find_node, sources
from cfepy.osal import OS_MAX_FILE_NAME
from cfepy.pilot.check.problem import MissionProblem
from cfepy.suggestions import did_you_mean

NO_SYMBOL = "NULL"
FILES = "/cf/"
C_SOURCES = "fsw/src"
PROFILE = "omit_deprecated"
SHOWN = 8
"""Names of missing functions that are listed."""


def check_startup(script: Path, data: bytes, entries: list[StartupEntry], longest: int) -> Iterator[MissionProblem]:
    """What is wrong with a startup script, and with the code of the applications that it starts.

    Args:
        script: its path; code is looked for in its folder.
        data: its contents.
        entries: what it starts.
        longest: characters of an entry that the mission's release of cFE reads.
    """
    for note in startup_script.check(data, longest):
        yield MissionProblem(script, note.line, note.explanation, note.is_warning)
    yield from _check_names(script, entries)
    for entry in entries:
        yield from _check_code(script, entries, entry)


def app_sources(folder: Path, entries: list[StartupEntry]) -> Iterator[tuple[Path, str]]:
    """The sources of applications and libraries, each with its entry point; nodes have none.

    Args:
        folder: of the mission.
        entries: what its startup script starts.
    """
    for entry in entries:
        code = find_code(entry.path, folder) if entry.path.startswith(FILES) else None
        source = None if code is None or entry.symbol == NODE_SYMBOL else sources.source_of(code)
        if source is not None:
            yield source, entry.symbol


def _check_names(script: Path, entries: list[StartupEntry]) -> Iterator[MissionProblem]:
    """Names that are taken; applications and libraries have a name space each."""
    taken = {(CFE_APP, name): "the core application" for name in CORE_APPS}
    for entry in entries:
        if not entry.name:
            continue  # the reader of the script has told it
        key = (entry.kind, entry.name)
        if key in taken:
            text = f"the name {entry.name!r} is taken by {taken[key]}; give this one another name"
            yield MissionProblem(script, entry.line, text)
        taken.setdefault(key, f"line {entry.line}")


def _check_code(script: Path, entries: list[StartupEntry], entry: StartupEntry) -> Iterator[MissionProblem]:
    folder = script.parent
    if not entry.path.startswith(FILES) or ".." in entry.path:
        text = f"{entry.path} is not below /cf, which is the mission's folder; write {FILES}..."
        yield MissionProblem(script, entry.line, text)
        return
    is_node = entry.symbol == NODE_SYMBOL
    if not is_node and len(entry.path.rpartition("/")[2]) >= OS_MAX_FILE_NAME:
        text = f"the file name in {entry.path} has {OS_MAX_FILE_NAME} characters or more; choose a shorter one"
        yield MissionProblem(script, entry.line, text)
        return
    compiled = None if is_node else find_compiled(entry.path, folder)
    if compiled is not None:
        yield from _check_compiled(script, entries, entry, compiled)
        return
    code = (find_node(entry.path, folder) if is_node else None) or find_code(entry.path, folder)
    if code is None:
        stem = Path(entry.path).stem
        text = f"no code for {entry.path}: no {stem}.py and no package {stem} in {folder}, no app or module {stem}"
        yield MissionProblem(script, entry.line, text + "; add it, or correct the name")
        return
    if is_node and not isinstance(code, Path):
        yield MissionProblem(
            script, entry.line, f"the node {entry.name} is no script of the mission's folder; add the script"
        )
        return
    source = sources.source_of(code)
    if source is not None and not is_node:
        broken = list(_check_syntax(source))
        yield from broken or _check_symbol(script, entry, source)


def _check_compiled(
    script: Path, entries: Sequence[StartupEntry], entry: StartupEntry, file: Path
) -> Iterator[MissionProblem]:
    """What is wrong with a compiled application or library.

    Args:
        script: the startup script.
        entries: what it starts.
        entry: the line that names the file.
        file: the shared object.
    """
    from cfepy.c import ElfError, read_shared_object, wanted_names

    try:
        source = read_shared_object(read_limited(file, OBJECT_BYTES), file.name)
        wanted = wanted_names(source)
    except ElfError as error:
        yield MissionProblem(file, 0, str(error))
        return
    functions = [each.name for each in source.symbols if each.is_defined and each.kind == "STT_FUNC"]
    if entry.symbol not in ("", NO_SYMBOL, *functions):
        hint = did_you_mean(entry.symbol, functions, "correct the name, or export the function (it may be static)")
        yield MissionProblem(script, entry.line, f"{file.name} has no function {entry.symbol}; {hint}")
    yield from _check_needs(script, entries, entry, set(wanted))


def _check_needs(
    script: Path, entries: Sequence[StartupEntry], entry: StartupEntry, wanted: set[str]
) -> Iterator[MissionProblem]:
    from cfepy.c import function_names

    wanted -= function_names()
    before = True
    for each in entries:
        if each is entry:
            before = False
            continue
        exported = _exported(script.parent, each) & wanted
        if exported and not before:
            text = (
                f"{entry.name} needs {_listed(exported)} of the library {each.name}, which line {each.line} loads later"
            )
            yield MissionProblem(script, entry.line, text + "; move that line up", is_warning=True)
        wanted -= exported
    if wanted:
        text = f"{entry.name} needs {_listed(wanted)}, which neither cfepy nor a library of the mission has"
        yield MissionProblem(script, entry.line, text + "; a call of it is a fault", is_warning=True)


def _exported(folder: Path, entry: StartupEntry) -> set[str]:
    """What a library has."""
    from cfepy.c import ElfError, read_shared_object

    file = find_compiled(entry.path, folder) if entry.kind == CFE_LIB else None
    if file is None:
        return set()
    try:
        source = read_shared_object(read_limited(file, OBJECT_BYTES), file.name)
    except ElfError:
        return set()
    return {each.name for each in source.symbols if each.is_defined}


def check_profiles(script: Path, entries: list[StartupEntry], said: MissionSections) -> Iterator[MissionProblem]:
    """Shared objects that were built for the other profile than the mission's, and those of which that is not known.

    Of the latter nothing is told when the mission file says itself which profile holds.

    Args:
        script: the startup script.
        entries: what it starts.
        said: what the mission file says.
    """
    named = [find_compiled(each.path, script.parent) for each in entries if each.symbol != NODE_SYMBOL]
    files = [file for file in dict.fromkeys(named) if file is not None]
    if not files:
        return
    from cfepy.c import AbiProfile, ElfError, abi_profile, read_shared_object

    omits = said.compiled.omit_deprecated
    unknown = []
    for file in files:
        try:
            profile = abi_profile(read_shared_object(read_limited(file, OBJECT_BYTES), file.name))
        except ElfError:
            continue  # told with the line that names the file
        if profile.contradicts(omits):
            text = f"was built {profile.value}, and the mission is for the other: build it with the option"
            text += f" OMIT_DEPRECATED={_word(omits)}, or write {_line(not omits)} into the mission file"
            yield MissionProblem(file, 0, text)
        elif profile is AbiProfile.UNKNOWN:
            unknown.append(file.name)
    if unknown and not _says_profile(said):
        text = f"whether {', '.join(unknown)} have OMIT_DEPRECATED cannot be told, without debug data of table handles;"
        text += (
            f" {_word(omits)} is taken: write {_line(omits)} into the mission file if that is right, or compile with -g"
        )
        yield MissionProblem(script, 0, text, is_warning=True)


def _word(value: bool) -> str:
    return str(value).lower()


def _line(omits: bool) -> str:
    return f"`compiled: {{{PROFILE}: {_word(omits)}}}`"


def _says_profile(said: MissionSections) -> bool:
    """Whether the mission file itself says the profile."""
    section = said.places.get("compiled")
    return section is not None and PROFILE in Mistakes(keep=True).mapping(section)


def _listed(names: set[str]) -> str:
    ordered = sorted(names)
    more = f" and {len(ordered) - SHOWN} more" if len(ordered) > SHOWN else ""
    return ", ".join(ordered[:SHOWN]) + more


def _check_syntax(source: Path) -> Iterator[MissionProblem]:
    for file in sources.files_of(source):
        error = sources.syntax_error(file)
        if error is not None:
            yield MissionProblem(file, error[0], f"is not Python: {error[1]}")


def _check_symbol(script: Path, entry: StartupEntry, source: Path) -> Iterator[MissionProblem]:
    if entry.symbol in ("", NO_SYMBOL):
        return  # what becomes of an application without one, the reader of the script has told
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
    """A function that cannot be an entry point, though it has the name, as far as its source tells."""
    functions = [each for each in sources.tree_of(source).body if getattr(each, "name", None) == entry.symbol]
    if len(functions) != 1 or not isinstance(functions[0], ast.FunctionDef | ast.AsyncFunctionDef):
        return
    function = functions[0]
    if function.decorator_list:
        return
    if isinstance(function, ast.AsyncFunctionDef):
        text = "is async: calling it runs nothing; make it a plain function"
    elif _takes_one(function.args):
        return
    else:
        text = f"does not take one argument, the handle of the services; write `def {function.name}(cfe):`"
    yield MissionProblem(source, function.lineno, f"the entry point {function.name} of {entry.name} {text}")


def _takes_one(arguments: ast.arguments) -> bool:
    """Whether a function can be called with one positional argument."""
    positional = len(arguments.posonlyargs) + len(arguments.args)
    needed = positional - len(arguments.defaults)
    by_name = any(default is None for default in arguments.kw_defaults)
    return needed <= 1 and (positional >= 1 or arguments.vararg is not None) and not by_name
