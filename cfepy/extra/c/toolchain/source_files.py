"""The folder of a compiled application: the files to compile, and the folders of its headers.

A cFS application keeps its code in `fsw/src`, its headers in `fsw/inc` and beside them, and tables in `fsw/tables`.
Settings of a mission are in `config`: a file `config/default_NAME.h` there is included as `NAME.h`, unless the mission
has one. The folder's CMakeLists.txt takes precedence over these conventions: its name, sources, tables, include folders
and dependencies.

`cmake_project` reads that file, with the files of subfolders and of the neighbours that it refers to: the applications
and libraries beside it, and those in `apps` and `libs` of the same tree. A condition holds if its variable was set to a
true value in a file: no EDS, no unit tests, no options, as in a plain build of the mission. An application counts as
part of the mission if its folder is there.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from cfepy.extra.c.toolchain.cmake_project import Project, ProjectScript, TableCall
from cfepy.extra.c.toolchain.cmake_script import FILE
from cfepy.extra.c.toolchain.cmake_targets import INTERFACE, Target
from cfepy.extra.c.toolchain.compiler import SOURCE_SUFFIXES
from cfepy.extra.c.toolchain.git_submodules import absent_submodule_above, has_files
from cfepy.reading.input_files import text_limited
from cfepy.reading.input_limits import CMAKE_BYTES
from cfepy.status import UsageError

INCLUDES = ("fsw/inc", "fsw/public_inc", "fsw/mission_inc", "fsw/platform_inc", "inc", "include")
CODE = ("fsw/src", "src", ".")
TABLES = ("fsw/tables", "tables")
FIRST_CPU = "cpu1_"
DEFINITIONS = (".", "inc", "mission_inc", "platform_inc", "fsw/mission_inc", "fsw/platform_inc")
DEFAULT = "default_"
NEIGHBOURS = (".", "apps", "libs")
CORE_TARGETS = (
    *("core_api", "core_private", "cfe_core", "osal", "osal_public_api", "osal_bsp"),
    *("psp", "psp_module_api", "iodriver"),
)
"""Targets of cFE, OSAL and the PSP, whose headers are cfepy's."""
_FILE_LIST = re.compile(r"set\(\w{1,100}_FILE_LIST([^()]*+)\)")
_SYSTEM = "native_default_cpu1"
_LEGAL = re.compile(r"\w[\w.+-]*")
_SHOWN = 100  # characters of a name that is wrong
_EDS = re.compile(r"_eds_\w+$")
"""Sources that replace others where messages are described by electronic data sheets."""


@dataclass(slots=True)
class Sources:
    """The sources of an application.

    Attributes:
        name: of the shared object.
        folder: of the application.
        code: files to be compiled and linked.
        tables: files that define tables.
        includes: folders of headers, the first searched first.
        chosen: headers to write for the compiler: a name, and the file that stands for it; None for an empty one.
        definitions: the compiler's -D.
        missing: applications and libraries that its headers come from and that were not found.
        table_includes, table_definitions: more folders and -D for the sources of tables.
        replaced: the application's own source of a table, by the mission's source that replaces it.
    """

    name: str
    folder: Path
    code: list[Path]
    tables: list[Path]
    includes: list[Path] = field(default_factory=list)
    chosen: dict[str, Path | None] = field(default_factory=dict)
    definitions: list[str] = field(default_factory=list)
    missing: list[str] = field(default_factory=list)
    table_includes: list[Path] = field(default_factory=list)
    table_definitions: list[str] = field(default_factory=list)
    replaced: dict[Path, Path] = field(default_factory=dict)


def find_sources(folder: Path, definitions: Path | None = None) -> Sources:
    """Find the sources in the folder of an application.

    Args:
        folder: of the application.
        definitions: a folder of a mission's headers, which go before the application's own.

    Raises:
        UsageError: there is no such folder, or nothing in it to compile.
    """
    if not os.path.isdir(folder):
        raise UsageError("folder not found; give the folder that contains the application's fsw/src", file=folder)
    if definitions is not None and not os.path.isdir(definitions):
        raise UsageError("folder of the mission's headers not found", file=definitions)
    headers = [] if definitions is None else _folders(definitions, DEFINITIONS)
    if not os.path.isfile(folder / FILE):
        found = sources_by_convention(folder)
        found.name = folder.resolve().name
        found.includes = headers + _folders(folder, INCLUDES)
        found.table_includes = _folders(folder, CODE[:-1])
        _choose(found, folder, headers)
    else:
        found = _sources_of_cmake(folder, headers)
    if not found.code:
        raise UsageError("missing C sources: add them to fsw/src, or name them in CMakeLists.txt", file=folder)
    for each in [] if definitions is None else sorted(definitions.glob(f"{FIRST_CPU}*.h")):
        name = each.name.removeprefix(FIRST_CPU)  # a build of cFS 6 gives the processor's header this name
        if not any(os.path.isfile(one / name) for one in (*headers, *found.includes)):
            found.chosen.setdefault(name, each.resolve())
    found.includes = list(dict.fromkeys(found.includes))
    return found


def own_headers(sources: Sources) -> list[Path]:
    """Return the headers in an application's own folder, beside its sources and in its include folders."""
    folders = {each for each in sources.includes if each.is_relative_to(sources.folder)}
    folders |= {each.parent for each in sources.code}
    return sorted({file for folder in folders for file in folder.glob("*.h")})


def _sources_of_cmake(folder: Path, headers: list[Path]) -> Sources:
    """Return the sources that a CMakeLists.txt names; the conventional ones for the rest."""
    here = Path(os.path.abspath(folder))
    project, target, used = read_project(here)
    name = folder.resolve().name if target is None else target.name
    if not _LEGAL.fullmatch(name):
        text = f"invalid application name {name[:_SHOWN]!r} in {FILE}; expected letters, digits, '_', '-' and '.'"
        raise UsageError(text, file=folder / FILE)
    calls = [each for each in project.tables if each.folder == str(here)]
    code = [] if target is None else sources_of(project, target)
    tables = [here / word for each in calls for word in each.words]
    tables = [each for each in tables if each.suffix in SOURCE_SUFFIXES]
    for each in (*code, *tables):
        if not each.is_file():
            shown = os.path.relpath(each, here)
            raise UsageError(f"{FILE} names a missing file: {shown}{_made_by(project, each)}", file=folder / FILE)
    found = Sources(name, folder, _given(code, here, folder) or _code_in(folder), _given(tables, here, folder))
    if not found.tables:  # the Makefiles of cFS 6 build them, with the headers beside the code
        found.tables = _all_in(folder, TABLES)
        found.table_includes = _folders(folder, CODE[:-1])
    named = _given(_folders_of(project, target), here, folder)
    found.includes = [*headers, *named, *_folders(folder, INCLUDES)]
    found.definitions = [] if target is None else definitions_of(project, target)
    if target is None:
        found.definitions = list(project.root.settings.definitions) if project.root is not None else []
    _choose(found, folder, headers)
    for other in used.values():
        found.includes += _folders(other, INCLUDES)
        _choose(found, other, headers)
    add_table_settings(found, project, target, calls)
    found.missing = [each for each in project.absent if each not in CORE_TARGETS]
    return found


def _given(paths: Iterable[Path], here: Path, folder: Path) -> list[Path]:
    """Return absolute paths as the user gave the folder, which may be relative, for the compiler's messages."""
    return [folder / each.relative_to(here) if each.is_relative_to(here) else each for each in paths]


def read_project(folder: Path) -> tuple[Project, Target | None, dict[str, Path]]:
    """Read the CMakeLists.txt of an application alone.

    Args:
        folder: of the application.

    Returns:
        The project, the application's target (None if the file makes none), and the folders of the neighbours that its
        settings refer to, by name.
    """
    neighbours = _neighbours(folder)
    project = Project(folder / FILE, neighbours)
    for name in CORE_TARGETS:
        project.targets.all[name] = Target(name, INTERFACE, "")
    variables = {f"{name}_MISSION_DIR": [str(other)] for name, other in neighbours.items()}
    variables |= {f"{folder.name}_MISSION_DIR": [str(folder)], "UNIX": ["1"], "CMAKE_SYSTEM_NAME": ["Linux"]}
    variables |= {"SYSVAR": [_SYSTEM], f"TGTSYS_{_SYSTEM}_APPS": list(neighbours), "IS_CFS_ARCH_BUILD": ["TRUE"]}
    variables |= {"CMAKE_C_COMPILER_ID": ["GNU"], "TGTNAME": ["cpu1"], "CFE_SYSTEM_PSPNAME": ["pc-linux"]}
    project.root = ProjectScript(project, folder, variables)
    project.add_folder(folder, project.root)
    made = [each for each in project.targets.all.values() if each.folder == str(folder) and each.kind != INTERFACE]
    target = next((each for each in made if each.is_application), None)
    target = target or next((each for each in made if each.kind in ("MODULE", "SHARED")), None)
    if target is not None:
        project.targets.includes(target)  # reads the neighbours that the settings refer to
    return project, target, {name: each for name, each in neighbours.items() if project.has_used(name)}


def _neighbours(folder: Path) -> dict[str, Path]:
    """Return the folders of other applications and libraries: beside this one, or in `libs` or `apps` one level up.

    A link to the folder has the neighbours of the link, then the folder's own. An empty folder, such as a git
    submodule that was not fetched, is none.
    """
    found: dict[str, Path] = {}
    for above in dict.fromkeys((Path(os.path.abspath(folder)).parent, folder.resolve().parent)):
        for place in (above, *(above.parent / each for each in NEIGHBOURS)):
            for other in sorted(place.glob("*/")):
                if other.resolve() != folder.resolve() and has_files(other):
                    found.setdefault(other.name, other)
    return found


def sources_of(project: Project, target: Target) -> list[Path]:
    """Return the sources of a target in C and C++, and of the tree's libraries that it links."""
    return [Path(each) for each in project.targets.sources(target) if Path(each).suffix in SOURCE_SUFFIXES]


def definitions_of(project: Project, target: Target) -> list[str]:
    """Return the compiler's -D of a target and of its parts."""
    everything = [target, *project.targets.parts(target)]
    return list(dict.fromkeys(each for one in everything for each in project.targets.definitions(one)))


def _folders_of(project: Project, target: Target | None) -> list[Path]:
    if target is None:
        named = [] if project.root is None else project.root.settings.includes
        return [Path(each) for each in named if os.path.isdir(each)]
    everything = [target, *project.targets.parts(target)]
    named = [each for one in everything for each in project.targets.includes(one)]
    return [Path(each) for each in dict.fromkeys(named) if os.path.isdir(each)]


def add_table_settings(found: Sources, project: Project, target: Target | None, calls: Iterable[TableCall]) -> None:
    """Add the include folders and definitions that calls of `add_cfe_tables` have for their tables alone."""
    targets = project.targets
    for each in calls:
        helper = target if target is None else targets.all.get(f"{target.name}.table", target)
        more = {} if helper is None else helper.properties
        of = helper or Target("", INTERFACE, each.folder)
        words = [*each.settings.includes, *more.get("INTERFACE_INCLUDE_DIRECTORIES", [])]
        named = [Path(one) for word in words for one in targets.evaluated(word, of)]
        found.table_includes += [one for one in dict.fromkeys(named) if one.is_dir()]
        words = [*each.settings.definitions, *more.get("INTERFACE_COMPILE_DEFINITIONS", [])]
        found.table_definitions += [one for word in words for one in targets.evaluated(word, of)]


def _made_by(project: Project, file: Path) -> str:
    """Return why a source is missing, for an error: a custom command makes it, or it is in a submodule."""
    if str(file) in project.generated:
        return f", which a custom command of the build makes: {project.generated[str(file)]}"
    url = absent_submodule_above(file)
    return f", which is in a git submodule that was not fetched; its URL is {url}" if url else ""


def sources_by_convention(folder: Path) -> Sources:
    """Return the sources of a folder without a CMakeLists.txt: fsw/src, fsw/tables, and the folders of headers."""
    includes = _folders(folder, (*INCLUDES, "fsw/src", "fsw/tables"))
    return Sources(folder.name, folder, _code_in(folder), _all_in(folder, TABLES), includes)


def chosen_headers(folders: Iterable[Path], overriding: Sequence[Path] = ()) -> dict[str, Path]:
    """Return the headers `NAME.h` that files `default_NAME.h` stand for.

    Args:
        folders: folders with such files.
        overriding: folders that may have their own `NAME.h`, which is used instead.
    """
    found: dict[str, Path] = {}
    for folder in folders:
        for file in sorted(folder.glob(f"{DEFAULT}*.h")):
            name = file.name.removeprefix(DEFAULT)
            found[name] = next((each / name for each in overriding if os.path.isfile(each / name)), file)
    return found


def _choose(found: Sources, folder: Path, overriding: Sequence[Path]) -> None:
    for name, file in chosen_headers([folder / "config"], overriding).items():
        if not any(os.path.isfile(each / name) for each in found.includes if each.is_relative_to(folder)):
            found.chosen.setdefault(name, file.resolve())
    for name in _declared(folder):
        if name not in found.chosen and not any(os.path.isfile(each / name) for each in (*overriding, *found.includes)):
            found.chosen[name] = None


def _declared(folder: Path) -> Iterator[str]:
    """Yield headers that a mission makes for an application, including those without a default, which are empty."""
    for name in ("mission_build.cmake", "arch_build.cmake"):
        file = folder / name
        if os.path.isfile(file):
            for words in _FILE_LIST.findall(text_limited(file, CMAKE_BYTES, "replace")):
                yield from (word for word in words.split() if word.endswith(".h") and _LEGAL.fullmatch(word))


def _code_in(folder: Path) -> list[Path]:
    for name in CODE:
        files = _all_in(folder, (name,))
        if files:
            return files
    return []


def _all_in(folder: Path, names: Iterable[str]) -> list[Path]:
    files = (file for name in names for suffix in SOURCE_SUFFIXES for file in (folder / name).glob(f"*{suffix}"))
    return sorted(file for file in files if not _EDS.search(file.stem))


def _folders(folder: Path, names: Iterable[str]) -> list[Path]:
    return [folder / name for name in names if name[:1] != "/" and os.path.isdir(folder / name)]
