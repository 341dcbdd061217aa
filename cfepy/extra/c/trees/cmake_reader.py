"""Reading a mission tree with CMake itself, through its File API.

CMake configures a project of ours (`cmake/CMakeLists.txt`), in which cFS's functions are replaced: an application
becomes a plain target. The File API then lists the sources, include folders and definitions of each target, with all
conditions followed. Nothing of cFE, OSAL or a PSP is needed, and nothing is compiled. But CMake executes the files
of the tree, as a build would. So only `cfepy build --cmake` starts it.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from cfepy.extra.c.toolchain.cmake_project import Directory, Project, TableCall
from cfepy.extra.c.toolchain.cmake_targets import DEFINITIONS, INCLUDES, INTERFACE, LINKS, Target
from cfepy.extra.c.toolchain.compiler import call_bounded
from cfepy.extra.c.toolchain.source_files import CORE_TARGETS
from cfepy.extra.c.trees.tree_layout import TARGETS, TreeLayout
from cfepy.extra.c.trees.tree_model import TreeModel, choose_cpu, make_model, module_folders
from cfepy.extra.c.trees.tree_reader import convention_target
from cfepy.reading.input_files import text_limited
from cfepy.reading.input_limits import OBJECT_BYTES
from cfepy.status import UsageError

CMAKE_NOTE = "CMake reads the tree and executes what its files contain, as a build of it does"
PROJECT = Path(__file__).with_name("cmake")
TOLD = "told.jsonl"
_UNKNOWN = re.compile(r'Unknown CMake command "(\w+)"')
_MOST_UNKNOWN = 24
_KIND_SUFFIX = "_LIBRARY"
_KEPT = ("PATH", "TMPDIR")
"""Environment of CMake: a home folder, CFLAGS or a toolchain file of the user would change the results."""

Told = list[str]


def read_with_cmake(layout: TreeLayout, cpu: str | None = None, more: Sequence[str] = ()) -> TreeModel:
    """Read a tree for one processor; see `tree_reader.read_tree`.

    Raises:
        UsageError: CMake is not installed, or refuses the tree; there is no such processor.
    """
    program = shutil.which("cmake")
    if program is None:
        raise UsageError("requires CMake; install it, or leave this option out", field="--cmake")
    ignored: list[str] = []
    while True:
        with tempfile.TemporaryDirectory(prefix="cfepy-cmake-") as scratch:
            status, said = _configure(program, layout, cpu, more, ignored, Path(scratch))
            if status == 0:
                return _Reply(layout, cpu, Path(scratch)).model()
        unknown = [each for each in _UNKNOWN.findall(said) if each not in ignored]
        if not unknown or len(ignored) > _MOST_UNKNOWN:
            raise UsageError(f"CMake cannot read the tree: {_error(said)}", file=layout.definitions / TARGETS)
        ignored += unknown


def _configure(
    program: str, layout: TreeLayout, cpu: str | None, more: Sequence[str], ignored: Sequence[str], scratch: Path
) -> tuple[int, str]:
    build = scratch / "build"
    query = build / ".cmake/api/v1/query"
    query.mkdir(parents=True)
    (query / "codemodel-v2").touch()
    values = {
        "CFEPY_TREE": str(layout.tree),
        "CFEPY_DEFS": str(layout.definitions),
        "CFEPY_CPU": cpu or "",
        "CFEPY_SEARCHED": ";".join(layout.searched),
        "CFEPY_MORE": ";".join(more),
        "CFEPY_IGNORED": ";".join(ignored),
        "CMAKE_INSTALL_PREFIX": str(scratch / "prefix"),
        "CMAKE_POLICY_VERSION_MINIMUM": "3.5",  # most files of cFS ask for CMake 2.6, which CMake 4 refuses
    }
    environment = {name: os.environ[name] for name in _KEPT if name in os.environ}
    settings = [f"{name}={value}" for name, value in {**environment, "HOME": str(scratch), "LC_ALL": "C"}.items()]
    command = [program, "-Wno-dev", "-S", str(PROJECT), "-B", str(build), "-G", "Unix Makefiles"]
    return call_bounded(["env", "-i", *settings, *command, *(f"-D{name}={value}" for name, value in values.items())])


def _error(said: str) -> str:
    lines = [each.strip() for each in said.splitlines() if each.strip()]
    at = next((at for at, each in enumerate(lines) if each.startswith("CMake Error")), 0)
    return " ".join(lines[at : at + 3])


class _Reply:
    """The reply of CMake, as a project."""

    def __init__(self, layout: TreeLayout, cpu: str | None, scratch: Path) -> None:
        self._layout = layout
        self._cpu = cpu
        self._build = scratch / "build"
        self._project = Project(layout.definitions / TARGETS)
        self._variables: dict[str, list[str]] = {}
        self._made_by: dict[str, list[Target]] = {}
        self._module = ""
        self._is_mission = True
        self._table_targets: dict[str, Target] = {}
        self._version = ""

    def model(self) -> TreeModel:
        for name in CORE_TARGETS:
            self._project.targets.all[name] = Target(name, INTERFACE, "")
        self._read_targets()
        lines = text_limited(self._build / TOLD, OBJECT_BYTES, "replace").splitlines()
        told = [json.loads(each) for each in lines]
        for kind, _, _, *words in told:
            if kind == "variable":
                self._variables[words[0]] = words[1:]
        cpu = choose_cpu(self._cpu, self._variables.get("MISSION_CPUNAMES", []), self._layout.definitions / TARGETS)
        for kind, folder, place, *words in told:
            self._tell(kind, folder, place, words)
        wanted = self._variables.get(f"{cpu}_APPLIST", [])
        folders = module_folders(self._layout, wanted)
        made_by = {name: self._made_by.get(name, []) for name in wanted}
        for name, targets in made_by.items():
            if not targets and name in folders:  # a folder that adds its libraries itself
                made_by[name] = [each for each in self._modules() if Path(each.folder).is_relative_to(folders[name])]
        model = make_model(self._layout, cpu, self._project, made_by, self._variables)
        model.read_by = f"CMake {self._version}"
        return model

    def _modules(self) -> list[Target]:
        return [each for each in self._project.targets.all.values() if each.kind in ("MODULE", "SHARED")]

    def _tell(self, kind: str, folder: str, place: str, words: Told) -> None:
        project = self._project
        match kind, words:
            case "module", [name]:
                self._module = name
            case "phase", [name]:
                self._is_mission = name == "mission_build"
            case "app", [name] if name in project.targets.all and self._module:
                project.targets.all[name].is_application = True
                self._made_by.setdefault(self._module, []).append(project.targets.all[name])
            case "convention", [name]:
                target = convention_target(name, module_folders(self._layout, [name])[name], project)
                self._made_by.setdefault(name, []).append(target)
            case "tables", [name, target_name, *sources]:
                target = self._table_targets.get(target_name, Target(target_name, "OBJECT", folder))
                settings = Directory(target.properties.get(INCLUDES, []), target.properties.get(DEFINITIONS, []))
                project.tables.append(TableCall(name, folder, sources, settings))
            case "header", words:
                self._header(place, words)
            case "source", [path]:
                self._missing(folder, path)
            case "generated", [path, *command]:
                project.generated[os.path.normpath(os.path.join(folder, path))] = " ".join(command)
            case "installed", files if "DESTINATION" in files:
                named = files[: files.index("DESTINATION")]
                project.installed += [os.path.normpath(os.path.join(folder, each)) for each in named]
            case "WRITE" | "APPEND", [path, *texts]:
                before = project.written.get(path, "") if kind == "APPEND" else ""
                project.written[path] = before + "".join(texts).replace("{semicolon}", ";")
            case "folder" | "file", [path]:
                project.note(f"missing {kind}", folder, path)
            case "error" | "command" | "package", words:
                project.note(kind, folder, " ".join(words))

    def _missing(self, folder: str, path: str) -> None:
        """Give a target back the source that CMake would have refused, so that the report names it."""
        for target in self._project.targets.all.values():
            if target.folder == folder and target.kind != INTERFACE:
                target.sources.append(path)
                return

    def _header(self, place: str, words: Told) -> None:
        if "FILE_NAME" not in words[:-1]:
            return
        name = words[words.index("FILE_NAME") + 1]
        default = words[words.index("FALLBACK_FILE") + 1] if "FALLBACK_FILE" in words[:-1] else None
        path = None if default is None else os.path.normpath(os.path.join(place, default))
        if self._project.headers.get(name) is None:
            self._project.headers[name] = path if path is not None and os.path.isfile(path) else None
        if self._is_mission:
            self._project.mission_headers.add(name)

    # -- the File API --------------------------------------------------------------------------------------------------

    def _read_targets(self) -> None:
        reply = self._build / ".cmake/api/v1/reply"
        index = _json(next(reply.glob("index-*.json")))
        self._version = index["cmake"]["version"]["string"]
        found = [_json(each) for each in sorted(reply.glob("target-*.json"))]
        needs = {}
        for each in found:
            target = _target(each)
            if target.name.startswith("cfepy_tables_"):
                self._table_targets[target.name] = target
            else:
                self._project.targets.all[target.name] = target
                needs[target.name] = [one["id"].partition("::")[0] for one in each.get("dependencies", [])]
        for name, others in needs.items():
            target = self._project.targets.all[name]
            for other in others:
                part = self._project.targets.all.get(other)
                if part is not None and part.kind in ("OBJECT", "STATIC", "SHARED"):
                    target.add(LINKS, [other])


def _json(file: Path) -> Any:
    return json.loads(text_limited(file, OBJECT_BYTES, "replace"))


def _target(said: Mapping[str, Any]) -> Target:
    root = said["paths"]["source"]
    folder = os.path.normpath(os.path.join(PROJECT, root))
    groups = said.get("compileGroups", [])
    sources = [said["sources"][at]["path"] for group in groups for at in group["sourceIndexes"]]
    target = Target(said["name"], said["type"].removesuffix(_KIND_SUFFIX), folder)
    target.sources = [os.path.normpath(os.path.join(PROJECT, each)) for each in sources]
    target.properties[INCLUDES] = [
        os.path.normpath(each["path"]) for group in groups for each in group.get("includes", [])
    ]
    defined = [each["define"] for group in groups for each in group.get("defines", [])]
    target.properties[DEFINITIONS] = [each for each in defined if not each.endswith("_EXPORTS")]
    fragments = [each["fragment"] for each in said.get("link", {}).get("commandFragments", [])]
    target.properties[LINKS] = [each[2:] for each in fragments if each.startswith("-l")]
    return target
