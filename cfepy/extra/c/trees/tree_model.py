"""A mission tree as one of its processors needs it: modules with their sources, headers, files and notes.

`make_model` makes it from a project whose files have been read, by cfepy's own reader (`tree_reader`) or by CMake
(`cmake_reader`). It prefers the mission's own headers, tables and files in the order of cFS's build.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from cfepy.extra.c.toolchain.cmake_project import Project
from cfepy.extra.c.toolchain.cmake_script import FILE
from cfepy.extra.c.toolchain.cmake_targets import Target
from cfepy.extra.c.toolchain.compiler import SOURCE_SUFFIXES
from cfepy.extra.c.toolchain.headers import names as core_names
from cfepy.extra.c.toolchain.source_files import INCLUDES, Sources, add_table_settings, definitions_of, sources_of
from cfepy.extra.c.trees.tree_layout import SEARCHED, TreeLayout
from cfepy.reading.suggestions import expected
from cfepy.status import UsageError

MISSIONS_OWN = ("cfe_perfids",)
"""Headers of cFE that a mission's own version replaces. All others are cfepy's, whose values the simulator has."""
_NUMBER = re.compile(r"0[xX][0-9a-fA-F]{1,8}|[0-9]{1,10}")


@dataclass(slots=True)
class TreeModule:
    """An application or library of a tree.

    Attributes:
        name: of its shared object.
        folder: its folder; None if the tree does not have it.
        sources: its sources; None if it cannot be built.
        reason: why it cannot be built; empty otherwise.
        libraries: libraries of the host that it links.
    """

    name: str
    folder: Path | None
    sources: Sources | None = None
    reason: str = ""
    libraries: list[str] = field(default_factory=list)


@dataclass(slots=True)
class TreeModel:
    """A tree as one of its processors needs it.

    Attributes:
        layout: its places.
        cpu: name of the processor.
        cpus: names of all processors.
        mission_name: its name; empty if targets.cmake gives none.
        spacecraft_id, processor_id: the numbers in targets.cmake; None if it gives none.
        modules: the applications and libraries, in the order of targets.cmake.
        variables: variables of targets.cmake and the mission's options.
        headers: headers that the build makes, and the file for each; None for an empty one.
        files: files that the target's folder gets: the name there, and the file.
        written: texts that the build writes, by path.
        notes: facts for the report.
        read_by: "cfepy", or "CMake" with its version.
    """

    layout: TreeLayout
    cpu: str
    cpus: list[str]
    mission_name: str = ""
    spacecraft_id: int | None = None
    processor_id: int | None = None
    modules: list[TreeModule] = field(default_factory=list)
    variables: Mapping[str, Sequence[str]] = field(default_factory=dict)
    headers: dict[str, Path | None] = field(default_factory=dict)
    files: dict[str, Path] = field(default_factory=dict)
    written: Mapping[str, str] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)
    read_by: str = "cfepy"


Variables = Mapping[str, Sequence[str]]


def make_model(
    layout: TreeLayout, cpu: str, project: Project, made_by: Mapping[str, Sequence[Target]], variables: Variables
) -> TreeModel:
    """Make the model of a tree whose files have been read.

    Args:
        layout: its places.
        cpu: the processor.
        project: the targets and notes of its files.
        made_by: the targets of each module, by the module's name, in the order of targets.cmake.
        variables: variables of targets.cmake and of the mission's options.
    """
    return _Maker(layout, cpu, project, made_by, variables).make()


def choose_cpu(wanted: str | None, cpus: Sequence[str], file: Path) -> str:
    """Return the processor that a user wants, or the first one.

    Raises:
        UsageError: there is none, or none of that name.
    """
    if not cpus:
        raise UsageError("names no processor; set MISSION_CPUNAMES, or TGT1_NAME", file=file)
    cpu = wanted or cpus[0]
    if cpu not in cpus:
        raise UsageError(f"unknown processor {cpu!r}{expected(cpu, cpus)}", field="--cpu", file=file)
    return cpu


def module_folders(layout: TreeLayout, names: Iterable[str] = ()) -> dict[str, Path]:
    """Return the folders of all modules of a tree by name, those that come first in `TreeLayout.searched`.

    Args:
        layout: the places of the tree.
        names: names of wanted modules. One can be a path in a searched folder, such as `imu/fsw/cfs`.
    """
    found: dict[str, Path] = {}
    for place in (layout.tree / each for each in layout.searched):
        folders = {each.name: each for each in sorted(place.glob("*"))}
        folders |= {each: place / each for each in names if "/" in each}
        for name, folder in folders.items():
            if folder.is_dir():
                found.setdefault(name, folder)
    return found


class _Maker:
    def __init__(
        self,
        layout: TreeLayout,
        cpu: str,
        project: Project,
        made_by: Mapping[str, Sequence[Target]],
        variables: Variables,
    ) -> None:
        self._layout = layout
        self._folders = module_folders(layout, made_by)
        self._project = project
        self._made_by = made_by
        self._variables = variables
        self._model = TreeModel(
            layout,
            cpu,
            list(variables.get("MISSION_CPUNAMES", [])),
            mission_name=" ".join(variables.get("MISSION_NAME", [])),
            spacecraft_id=_number(variables.get("SPACECRAFT_ID", [])),
            processor_id=_number(variables.get(f"{cpu}_PROCESSORID", [])),
            variables=dict(variables),
        )

    def make(self) -> TreeModel:
        model = self._model
        model.headers = self._headers(model.cpu)
        model.modules = [each for name in self._made_by for each in self._modules(name, model)]
        model.written = self._project.written
        model.files = self._files(model.cpu)
        model.notes += self._notes()
        return model

    # -- modules -------------------------------------------------------------------------------------------------------

    def _modules(self, name: str, model: TreeModel) -> Iterator[TreeModule]:
        folder = self._folders.get(name)
        url = self._layout.absent_submodule(folder or self._layout.tree / "apps" / name)
        if folder is None or url:
            more = [os.path.relpath(each, self._layout.tree) for each in self._layout.searched if os.path.isabs(each)]
            reason = f"is not in {' or '.join((*more, *SEARCHED[:2]))}"
            if url:
                reason = f"is a git submodule that was not fetched; its URL is {url}"
            yield TreeModule(name, folder, reason=reason)
            return
        made = self._made_by.get(name, [])
        if not made:
            text = f"{FILE} defines no application" if (folder / FILE).is_file() else f"has neither {FILE} nor fsw"
            yield TreeModule(name, folder, reason=text)
        for target in made:
            yield self._module(target, folder, model)

    def _module(self, target: Target, folder: Path, model: TreeModel) -> TreeModule:
        targets = self._project.targets
        everything = [target, *targets.parts(target)]
        code = sources_of(self._project, target)
        module = TreeModule(target.name, folder, libraries=targets.libraries(target))
        missing = [each for each in code if not each.is_file()]
        if missing or not code:
            module.reason = self._why_missing(missing) if missing else "has no source in C or C++"
            return module
        sources = Sources(target.name, folder, code, [])
        includes = [Path(each) for one in everything for each in targets.includes(one)]
        includes += [folder / each for each in INCLUDES] + self._mission_folders(model.cpu)
        sources.includes = [each for each in dict.fromkeys(includes) if each.is_dir()]
        sources.definitions = definitions_of(self._project, target)
        sources.chosen = dict(model.headers)
        self._add_tables(sources, target, folder, model)
        module.sources = sources
        return module

    def _add_tables(self, sources: Sources, target: Target, folder: Path, model: TreeModel) -> None:
        targets = self._project.targets
        for each in self._project.tables:
            app = each.name.partition(".")[0]
            if app != target.name and (app in targets.all or not Path(each.folder).is_relative_to(folder)):
                continue
            add_table_settings(sources, self._project, target, [each])
            for word in each.words:
                file = locate_table(self._layout, model.cpu, word, Path(each.folder))
                if file is None:
                    model.notes.append(f"{target.name}: source of a table is missing: {word}")
                elif file not in sources.tables and file.suffix in SOURCE_SUFFIXES:
                    sources.tables.append(file)
                    own = Path(os.path.normpath(Path(each.folder) / word))
                    if own != file and own.is_file():
                        sources.replaced[file] = own

    def _why_missing(self, missing: Sequence[Path]) -> str:
        for each in missing:
            if str(each) in self._project.generated:
                command = self._project.generated[str(each)]
                return f"{each.name} is made by a custom command of the build: {command}"
            if str(each) in self._project.written:
                return f"{each.name} is written by the tree's CMake files; the code is elsewhere, such as in Rust"
            url = self._layout.absent_submodule(each)
            if url:
                return f"{self._inside(each)} is in a git submodule that was not fetched; its URL is {url}"
        names = ", ".join(self._inside(each) for each in missing[:3])
        more = f" and {len(missing) - 3} more" if len(missing) > 3 else ""
        return f"source files are missing: {names}{more}"

    def _inside(self, path: Path) -> str:
        return os.path.relpath(path, self._layout.tree)

    def _mission_folders(self, cpu: str) -> list[Path]:
        definitions = self._layout.definitions
        return [definitions / cpu, definitions, definitions / "inc"]

    # -- files of the mission ------------------------------------------------------------------------------------------

    def _headers(self, cpu: str) -> dict[str, Path | None]:
        core = {each for each in core_names() if each not in MISSIONS_OWN}
        found: dict[str, Path | None] = {}
        for name, default in self._project.headers.items():
            base = os.path.basename(name)
            if base.removesuffix(".h") not in core:
                platform = () if name in self._project.mission_headers else ("default", cpu)
                own = locate_header(self._layout.definitions, base, platform)
                found[base] = own or (None if default is None else Path(default))
        for name in MISSIONS_OWN:
            own = locate_header(self._layout.definitions, f"{name}.h", ())
            if own is not None:
                found[f"{name}.h"] = own
        return found

    def _files(self, cpu: str) -> dict[str, Path]:
        found = {}
        variables = self._variables
        for name in (*variables.get(f"{cpu}_FILELIST", []), *variables.get("MISSION_GLOBAL_FILELIST", [])):
            file = locate_installed(self._layout.definitions, cpu, name)
            if file is not None:
                found[name] = file
            else:
                self._project.note("missing file", self._layout.definitions, name)
        for each in self._project.installed:
            if os.path.isfile(each):
                found.setdefault(os.path.basename(each), Path(each))
        return found

    def _notes(self) -> list[str]:
        found = []
        for each in self._project.notes:
            where = os.path.relpath(each.folder, self._layout.tree)
            if each.kind == "missing folder":
                folder = Path(each.text)
                url = self._layout.absent_submodule(folder)
                more = f"; its git submodule was not fetched: {url}" if url else ""
                found.append(f"{where}: subfolder is missing: {self._inside(folder)}{more}")
            elif each.kind in ("error", "command", "package", "missing file"):
                found.append(f"{where}: {_KINDS[each.kind]}: {each.text}")
        return found


_KINDS = {
    "error": "the file ends with an error",
    "command": "not executed",
    "package": "not searched for",
    "missing file": "file is missing",
}


def locate_header(definitions: Path, name: str, prefixes: Sequence[str]) -> Path | None:
    """Return a mission's own version of a header, in the order of cFS's build, which takes the last one.

    Args:
        definitions: the folder of definitions.
        name: of the header.
        prefixes: names of configurations and of the processor, from the most general to the most special.
    """
    return _last(definitions, name, prefixes, "config")


def locate_table(layout: TreeLayout, cpu: str, source: str, folder: Path) -> Path | None:
    """Return the source of a table: the processor's, then the mission's, then the application's own."""
    name = os.path.basename(source)
    own = Path(os.path.normpath(folder / source))
    found = _last(layout.definitions, name, (cpu,), "tables")
    if found is None:
        places = [layout.tree / "tables" / f"{cpu}_{name}", layout.tree / "tables" / name]
        found = next((each for each in places if each.is_file()), None)
    return found or (own if own.is_file() else None)


def locate_installed(definitions: Path, cpu: str, name: str) -> Path | None:
    """Return a file of the list FILELIST: the processor's, or the mission's."""
    places = (definitions / cpu / name, definitions / f"{cpu}_{name}", definitions / name)
    return next((each for each in places if each.is_file()), None)


def _last(definitions: Path, name: str, prefixes: Sequence[str], subfolder: str) -> Path | None:
    found = None
    for base in (definitions, definitions / subfolder):
        for place in (base, *(definitions / each / base.relative_to(definitions) for each in prefixes)):
            inside = place.relative_to(definitions).parts
            for file in (place / name, *(place / f"{each}_{name}" for each in prefixes if each not in inside)):
                if file.is_file():
                    found = file
    return found


def _number(words: Sequence[str]) -> int | None:
    return int(words[0], 0) if len(words) == 1 and _NUMBER.fullmatch(words[0]) else None
