"""The build of a mission tree: from its files to a mission folder that `cfepy run` flies.

The folder gets a shared object for each application and library, their table files, the startup script, and a mission
file with the tree's configuration. A part that cannot be built is left out, or an application of cfepy's own stands in
for it. The report names every part.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path

from cfepy.es import CFE_APP
from cfepy.extra.c.elf import ElfError, read_shared_object
from cfepy.extra.c.toolchain.application import (
    Built,
    Options,
    TableFiles,
    build_sources,
    build_tables,
    check_options,
)
from cfepy.extra.c.toolchain.cfe6 import ADVICE, BUILD_WITH, REMOVED_TEXT
from cfepy.extra.c.toolchain.compiler import CompilerError
from cfepy.extra.c.toolchain.source_files import Sources
from cfepy.extra.c.trees.build_report import BUILT, KEPT, LEFT_OUT, STANDS_IN, BuildReport
from cfepy.extra.c.trees.configuration import Configuration, mission_file, read_configuration
from cfepy.extra.c.trees.startup_scripts import StartupScript, find_startup, made_startup
from cfepy.extra.c.trees.tree_layout import TreeLayout, find_layout
from cfepy.extra.c.trees.tree_model import TreeModel, TreeModule, module_folders
from cfepy.extra.c.trees.tree_reader import read_tree
from cfepy.mission import STARTUP_SCRIPT
from cfepy.reading.contained_files import write_contained
from cfepy.reading.input_files import read_limited, unwritable
from cfepy.reading.input_limits import OBJECT_BYTES
from cfepy.reading.resources import shipped
from cfepy.reading.suggestions import expected
from cfepy.rtos import Stopwatch
from cfepy.status import UsageError
from cfepy.tbl import build as table_file
from cfepy.tbl import read as read_table_image
from cfepy.writing.work_progress import WorkProgress

MISSION_FILE = "mission.yaml"
_TABLE_PATH = re.compile(rb"/cf/((?:[\w.-]+/)+)([\w.-]+\.tbl)\0")
_CODE_FOLDER = re.compile(r"/cf/((?:[\w.-]+/)*)[^/]*")
_FUNCTION = re.compile(r"^def (\w+)\(", re.MULTILINE)
_MOST_FILE = 64 << 20

Reader = Callable[[TreeLayout, str | None, tuple[str, ...]], TreeModel]


@dataclass(frozen=True, slots=True)
class TreeOptions:
    """Options for the build of a tree.

    Attributes:
        cpu: the processor; the first one of the tree when None.
        definitions: the tree's folder of definitions; the only one when None.
        modules: more folders with modules, searched before the tree's own.
        startup: a startup script in place of the tree's.
        only: names of the modules to build; all when empty.
        stand_ins: names of modules for which cfepy's own applications stand in, even if the tree's could be built.
        build: options for each application.
        reader: reads the tree.
    """

    cpu: str | None = None
    definitions: str | None = None
    modules: tuple[str, ...] = ()
    startup: Path | None = None
    only: tuple[str, ...] = ()
    stand_ins: tuple[str, ...] = ()
    build: Options = field(default_factory=Options)
    reader: Reader = read_tree


def build_tree(tree: Path, folder: Path | None = None, options: TreeOptions | None = None) -> BuildReport:
    """Build a mission folder from a tree.

    Args:
        tree: the mission tree.
        folder: the mission folder; TREE_CPU in the working directory when None.
        options: the build options; the defaults when None.

    Returns:
        The report. Its `folder` is the mission folder.

    Raises:
        UsageError: it is not a tree, it has no such processor, nothing can be built, or there is no compiler.
    """
    options = options or TreeOptions()
    check_options(options.build)
    for name in options.stand_ins:
        if not (shipped("apps") / name).is_dir():
            known = [each.name for each in shipped("apps").iterdir() if (each / "app.py").is_file()]
            text = f"cfepy has no application {name!r} that could stand in{expected(name, sorted(known))}"
            raise UsageError(text, field="--stand-in")
    layout = find_layout(tree, options.definitions, options.modules)
    model = options.reader(layout, options.cpu, ())
    startup = find_startup(model, options.startup)
    more = _named_modules(model, startup)
    if more:
        model = options.reader(layout, options.cpu, more)
        startup = find_startup(model, options.startup)
    made = folder if folder is not None else Path(f"{layout.tree.name}_{model.cpu}")
    return _Build(model, startup, made, options).build()


def _named_modules(model: TreeModel, startup: StartupScript | None) -> tuple[str, ...]:
    """Return modules of the tree that the startup script names and targets.cmake does not."""
    known = {each.name for each in model.modules} | {each.folder.name for each in model.modules if each.folder}
    folders = module_folders(model.layout)
    names = [_file_name(each.file) for each in (startup.lines if startup is not None else ())]
    return tuple(each for each in dict.fromkeys(names) if each not in known and each in folders)


class _Build:
    def __init__(self, model: TreeModel, startup: StartupScript | None, folder: Path, options: TreeOptions) -> None:
        self._model = model
        self._startup = startup
        self._folder = folder
        self._options = options
        self._report = BuildReport(
            model.mission_name or model.layout.tree.name, model.cpu, str(folder), model.read_by, notes=list(model.notes)
        )
        self._built: dict[str, Built] = {}
        self._wrong_names: list[str] = []
        self._stand_ins: list[str] = []

    def build(self) -> BuildReport:
        if not any(each.sources for each in self._model.modules) and not self._startup:
            raise UsageError("has no application that can be built", file=self._model.layout.tree)
        configuration = read_configuration(self._model)
        self._report.notes += configuration.notes
        try:
            return self._written(configuration)
        except OSError as error:
            raise unwritable(error.filename or self._folder, error, "--output") from None

    def _written(self, configuration: Configuration) -> BuildReport:
        self._folder.mkdir(parents=True, exist_ok=True)
        with WorkProgress(Stopwatch().elapsed_ns) as progress:
            for module in self._model.modules:
                if not self._options.only or module.name in self._options.only:
                    self._module(module, configuration, progress)
        built = self._built.items()
        modules = ((name, functions_of(each.library), list(each.names.values())) for name, each in built)
        startup = self._startup or made_startup(modules)
        self._copy_tables()
        self._copy_files()
        startup = self._with_entry_points(startup)
        self._write(STARTUP_SCRIPT, startup.text, startup.origin)
        self._write(MISSION_FILE, mission_file(self._report.mission, configuration), "limits and names of the tree")
        self._check_startup(startup, configuration)
        return self._report

    # -- modules -------------------------------------------------------------------------------------------------------

    def _module(self, module: TreeModule, configuration: Configuration, progress: WorkProgress) -> None:
        if module.name in self._options.stand_ins:
            self._without(module.name, "--stand-in asks for it")
            return
        if module.sources is None:
            self._without(module.name, module.reason)
            return
        options = self._options.build
        flags = [*options.flags, *(f"-D{name}=0x{value:04X}" for name, value in configuration.bases.items())]
        options = replace(
            options, flags=flags, omit_deprecated=options.omit_deprecated or configuration.omit_deprecated
        )
        library = self._folder / self._code_folder(module.name) / f"{module.name}.so"
        try:
            built = build_sources(module.sources, library, replace(options, goes_on_without_tables=True), progress)
            self._own_tables(module.sources, built, options, progress)
        except (CompilerError, UsageError) as error:
            self._without(module.name, self._first_error(error))
            return
        self._built[module.name] = built
        self._report.warnings += built.warnings
        tables = [each.name for each in built.tables]
        text = f"{len(module.sources.code)} sources" + (f", tables {', '.join(tables)}" if tables else "")
        if module.libraries:
            text += f"; not linked: {', '.join(module.libraries)} of the host"
        self._report.add(BUILT, module.name, text)
        for each in built.kept:
            self._report.add(KEPT, each.name, "differs from the table in the tree; --tables overwrites it")

    def _own_tables(self, sources: Sources, built: Built, options: Options, progress: WorkProgress) -> None:
        """Build the application's own tables in place of the mission's tables that the compiler refused."""
        for file, error in list(built.refused.items()):
            inside, reason = self._inside(file), self._first_error(error)
            own = sources.replaced.get(file)
            if own is not None:
                only = replace(sources, tables=[own], replaced={})
                again = build_tables(only, built.library, replace(options, goes_on_without_tables=True), progress)
                built.tables += again.tables
                built.kept += again.kept
                built.names |= again.names
                if not again.refused:
                    self._report.add(STANDS_IN, file.name, f"{self._inside(own)} for {inside}: {reason}")
                    continue
            self._report.add(LEFT_OUT, file.name, reason)

    def _inside(self, path: Path) -> str:
        return os.path.relpath(path, self._model.layout.tree)

    def _first_error(self, error: object) -> str:
        """Return the first error of a compiler, with a path relative to the tree, and advice about names of cFE 6."""
        lines = str(error).splitlines()
        errors = [each for each in lines if " error: " in each] or lines
        found = next((each for each in errors if REMOVED_TEXT in each), errors[0] if errors else "")
        advice = next((each for each in lines if each.startswith(f"({ADVICE}")), None)
        if advice is not None:
            found = f"{found} {advice}"
        return found.replace(f"{self._model.layout.tree}/", "")

    def _without(self, name: str, reason: str) -> None:
        if (shipped("apps") / name).is_dir():
            self._report.add(STANDS_IN, name, f"cfepy's own in Python ({reason})")
            self._stand_ins.append(name)
        else:
            self._report.add(LEFT_OUT, name, reason)

    def _code_folder(self, name: str) -> str:
        """Return the folder below /cf from which the startup script loads a module."""
        for each in () if self._startup is None else self._startup.lines:
            found = _CODE_FOLDER.fullmatch(each.path)
            if found is not None and _file_name(each.file) == name:
                return found[1]
        return ""

    # -- files ---------------------------------------------------------------------------------------------------------

    def _copy_tables(self) -> None:
        """Put a table also where the code of an application looks for it, such as /cf/apps."""
        tables = {file.name: file for each in self._built.values() for file in (*each.tables, *each.kept)}
        for each in self._built.values():
            for folder, name in _TABLE_PATH.findall(read_limited(each.library, OBJECT_BYTES)):
                file = tables.get(name.decode())
                if file is not None:
                    self._write(f"{folder.decode()}{name.decode()}", read_limited(file, _MOST_FILE), None)

    def _copy_files(self) -> None:
        for name, file in self._model.files.items():
            if not name.endswith(".scr") and "/" not in name:
                self._write(name, read_limited(file, _MOST_FILE), "file of the tree")

    def _write(self, name: str, data: bytes, text: str | None) -> None:
        """Write a file of the mission folder. One with other contents stays, because it may be the user's."""
        path = self._folder / name
        overwrites = self._options.build.tables is TableFiles.WRITE
        if os.path.lexists(path) and not overwrites and read_limited(path, _MOST_FILE) != data:
            self._report.add(KEPT, name, "differs from the tree's; --tables overwrites it")
            return
        write_contained(self._folder, f"/{name}", data)
        if text is not None:
            self._report.add(BUILT, name, text)

    # -- the startup script --------------------------------------------------------------------------------------------

    def _check_startup(self, startup: StartupScript, configuration: Configuration) -> None:
        """Note modules of the startup script that are not there, and modules that it does not start."""
        reported = {each.name for each in self._report.entries}
        named = [_file_name(each.file) for each in startup.lines]
        for name in dict.fromkeys(named):
            if name not in self._built and name not in reported:
                self._without(name, self._why_absent(name))
        self._name_tables(startup)
        left_out = {each.name for each in self._report.named(LEFT_OUT)}
        self._report.is_complete = left_out.isdisjoint(named)
        self._check_tables(startup)
        idle = [name for name in self._built if name not in named]
        if idle:
            self._report.notes.append(f"the startup script does not start {', '.join(idle)}")
        if configuration.bases:
            values = ", ".join(f"{_BASE_WORDS[name]} 0x{value:04X}" for name, value in configuration.bases.items())
            text = "applications have the mission's MsgIds; cFE's own packets keep 0x1800 and 0x0800"
            self._report.notes.append(f"MsgId bases of the mission: {values}; {text}")
        self._report.steps = [*_steps(self._report, self._model), *dict.fromkeys(self._wrong_names)]

    def _why_absent(self, name: str) -> str:
        url = self._model.layout.absent_submodule(self._model.layout.tree / "cfe/modules" / name)
        if name.startswith("cfe_") and url:
            return (
                f"the startup script names this module of cFE, a git submodule that was not fetched; its URL is {url}"
            )
        return "the startup script names it, and it is not in the tree"

    def _with_entry_points(self, startup: StartupScript) -> StartupScript:
        """Give stand-ins their own entry points, which older scripts write in other letters: CI_Lab_AppMain."""
        text = startup.text
        for each in startup.lines:
            app = _file_name(each.file)
            if app in self._built or not (shipped("apps") / app).is_dir():
                continue
            for name in _python_functions(app):
                if name != each.symbol and name.lower() == each.symbol.lower():
                    text = text.replace(each.symbol.encode(), name.encode())
                    self._report.notes.append(
                        f"{STARTUP_SCRIPT}: {name}, as cfepy's own {app} has it, for {each.symbol}"
                    )
        return startup._replace(text=text)

    def _name_tables(self, startup: StartupScript) -> None:
        """Give tables of stand-ins the name that the startup script gives their application, as cFE requires it."""
        names = {_file_name(each.file): each.name for each in startup.lines if each.kind == CFE_APP}
        for app in self._stand_ins:
            for file in sorted((shipped("apps") / app / "tables").glob("*.tbl")):
                table = read_table_image(read_limited(file, _MOST_FILE))
                owner, dot, rest = table.name.partition(".")
                if app in names and names[app] != owner and dot:
                    data = table_file(table._replace(name=f"{names[app]}.{rest}"))
                    self._write(file.name, data, f"table of the stand-in {app}, named {names[app]}.{rest}")

    def _check_tables(self, startup: StartupScript) -> None:
        """Note tables that cFE will refuse, because their application has another name in the startup script."""
        for each in startup.lines:
            built = self._built.get(_file_name(each.file))
            if each.kind != CFE_APP or built is None:
                continue
            for file, table in built.names.items():
                owner = table.partition(".")[0]
                if owner != each.name and not any(line.name == owner for line in startup.lines):
                    text = f"{file} is the table {table}, but the startup script names the application {each.name}"
                    self._report.notes.append(f"{text}: cFE refuses the file")
                    step = f"in {STARTUP_SCRIPT}, name the application {owner} in place of {each.name}"
                    self._wrong_names.append(step)


_BASE_WORDS = {
    "CFEPY_CMD_MID_BASE": "commands",
    "CFEPY_TLM_MID_BASE": "telemetry",
    "CFEPY_GLOBAL_CMD_MID_BASE": "global commands",
    "CFEPY_GLOBAL_TLM_MID_BASE": "global telemetry",
}


def _steps(report: BuildReport, model: TreeModel) -> Iterator[str]:
    """Yield steps for the user about missing parts, the most useful first; equal reasons are one step."""
    fetched = [each for each in report.entries if "git submodule" in each.text]
    if fetched:
        yield f"fetch the git submodules: git -C {model.layout.tree} submodule update --init --recursive"
    older: dict[str, str] = {}
    for each in report.entries:
        _, found, option = each.text.partition(BUILD_WITH)
        if found and ADVICE in each.text:
            older[each.name] = option.partition(".)")[0]
    for option in dict.fromkeys(older.values()):
        several = [name for name, wanted in older.items() if wanted == option]
        yield f"build the tree again with {option}, because of names of cFE 6 in {', '.join(several)}"
    reasons: dict[str, list[str]] = {}
    for each in report.named(LEFT_OUT):
        if each not in fetched and each.name not in older:
            reasons.setdefault(each.text, []).append(each.name)
    for text, names in reasons.items():
        yield f"{', '.join(names)}: {text}"


def _file_name(file: str) -> str:
    return os.path.basename(file).partition(".")[0]


def _python_functions(app: str) -> list[str]:
    """Return the functions of one of cfepy's own applications."""
    files = sorted((shipped("apps") / app).glob("*.py"))
    return [name for file in files for name in _FUNCTION.findall(file.read_text(encoding="utf-8"))]


def functions_of(library: Path) -> list[str]:
    """Return the functions that a shared object defines; empty if it cannot be read."""
    try:
        found = read_shared_object(read_limited(library, OBJECT_BYTES), library.name)
    except ElfError:
        return []
    return [each.name for each in found.symbols if each.is_defined and each.kind == "STT_FUNC"]
