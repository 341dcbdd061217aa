"""Reading a mission tree for one of its processors, in the order of a cFS build and without CMake.

The order is: the mission's options and targets.cmake; mission_build.cmake, then arch_build.cmake of all modules, which
name the headers that a build makes; CMakeLists.txt of all modules; at last the processor's install_custom.cmake. The
result has the sources of each application and library, ready for `cfepy.extra.c.toolchain`.
"""

from __future__ import annotations

import os
import re
from collections.abc import Sequence
from pathlib import Path

from cfepy.extra.c.toolchain.cmake_project import Directory, Project, ProjectScript, TableCall
from cfepy.extra.c.toolchain.cmake_script import FILE
from cfepy.extra.c.toolchain.cmake_targets import INTERFACE, MODULE, SHARED, Target
from cfepy.extra.c.toolchain.source_files import CORE_TARGETS, sources_by_convention
from cfepy.extra.c.trees.tree_layout import TARGETS, TreeLayout
from cfepy.extra.c.trees.tree_model import TreeModel, choose_cpu, make_model, module_folders

PLATFORM_FOLDERS = "APPLICATION_PLATFORM_INC_LIST"
PARTS = ("PROCESSORID", "APPLIST", "STATIC_APPLIST", "FILELIST", "EMBED_FILELIST", "SYSTEM", "PLATFORM")


_APPLIST = "_APPLIST"
_NO_CPU = ("MISSION_GLOBAL", "TGT")


def read_tree(layout: TreeLayout, cpu: str | None = None, more: Sequence[str] = ()) -> TreeModel:
    """Read a tree for one processor.

    Args:
        layout: its places.
        cpu: name of the processor; the first one when None.
        more: modules that targets.cmake does not list.

    Raises:
        UsageError: there is no such processor, or the files exceed the limits of the reader.
    """
    return _TreeReader(layout, cpu, more).read()


def convention_target(name: str, folder: Path, project: Project) -> Target:
    """Make the target of a folder without a CMakeLists.txt, which a Makefile of the mission builds, as in cFS 6."""
    found = sources_by_convention(folder)
    target = Target(name, MODULE, str(folder), list(map(str, found.code)), is_application=True)
    for key in ("INCLUDE_DIRECTORIES", "INTERFACE_INCLUDE_DIRECTORIES"):
        target.properties[key] = [str(each) for each in found.includes]
    project.targets.all[name] = target
    project.tables.append(TableCall(name, str(folder), list(map(str, found.tables)), Directory()))
    return target


class _TreeReader:
    def __init__(self, layout: TreeLayout, cpu: str | None, more: Sequence[str]) -> None:
        self._layout = layout
        self._folders = module_folders(layout)
        targets_in = {**self._folders, **dict.fromkeys(("ut_assert", "ut_assert_pic"), layout.tree / "osal/ut_assert")}
        self._project = Project(layout.definitions / TARGETS, targets_in)
        for name in CORE_TARGETS:
            self._project.targets.all[name] = Target(name, INTERFACE, "")
        self._root = ProjectScript(self._project, layout.tree / "cfe", build_variables(layout))
        self._project.root = self._root
        self._wanted_cpu = cpu
        self._more = more
        self._made_by: dict[str, list[Target]] = {}

    def read(self) -> TreeModel:
        root, definitions = self._root, self._layout.definitions
        for name in ("global_build_options", "mission_build_custom", "targets"):
            self._include(definitions / f"{name}.cmake")
        cpu = choose_cpu(self._wanted_cpu, self._cpus(), definitions / TARGETS)
        self._set_cpu(cpu)
        for name in ("arch_build_custom", "arch_build_custom_native"):
            self._include(definitions / f"{name}.cmake")
        wanted = self._apps(cpu)
        self._folders = module_folders(self._layout, wanted)
        root.variables |= {f"{name}_MISSION_DIR": [str(folder)] for name, folder in self._folders.items()}
        self._include_platform_folders()
        folders = {name: self._folders[name] for name in wanted if name in self._folders}
        root.follows_subfolders = False
        for folder in folders.values():
            self._include(folder / "mission_build.cmake")
        root.variables["IS_CFS_ARCH_BUILD"] = ["TRUE"]
        for folder in folders.values():
            self._include(folder / "arch_build.cmake")
        root.follows_subfolders = True
        for name, folder in folders.items():
            self._add_folder(name, folder)
        for file in ("install_custom.cmake", f"{cpu}/install_custom.cmake"):
            self._include(definitions / file)
        made_by = {name: self._made_by.get(name, []) for name in wanted}
        return make_model(self._layout, cpu, self._project, made_by, root.variables)

    def _include(self, file: Path) -> None:
        if file.is_file():
            self._root.include(file)

    def _include_platform_folders(self) -> None:
        """Evaluate the include folders of all applications that targets.cmake lists, now that their places are known.

        A cFS build reads targets.cmake a second time for this, for each kind of processor.
        """
        root = self._root
        if PLATFORM_FOLDERS not in root.variables:
            return
        before = dict(root.variables)
        root.variables[PLATFORM_FOLDERS] = []
        self._include(self._layout.definitions / TARGETS)
        folders = map(os.path.normpath, root.variables[PLATFORM_FOLDERS])
        root.variables.clear()
        root.variables |= before
        root.settings.includes += [each for each in dict.fromkeys(folders) if Path(each).is_dir()]

    # -- processors ----------------------------------------------------------------------------------------------------

    def _cpus(self) -> list[str]:
        """Return the names of the processors, also in the form of cFS 6."""
        variables = self._root.variables
        cpus = list(variables.get("MISSION_CPUNAMES", []))
        number = 1
        while name := variables.get(f"TGT{number}_NAME"):
            cpus += name
            for part in PARTS:
                if f"TGT{number}_{part}" in variables:
                    variables[f"{name[0]}_{part}"] = variables[f"TGT{number}_{part}"]
            variables.setdefault(f"{name[0]}_PROCESSORID", [str(number)])
            number += 1
        if not cpus:  # they come from the environment of the build
            ends = [name.removesuffix(_APPLIST) for name in variables if name.endswith(_APPLIST)]
            cpus = [each for each in ends if not each.startswith(_NO_CPU) and not each.endswith("_STATIC")]
        variables["MISSION_CPUNAMES"] = list(dict.fromkeys(cpus))
        return variables["MISSION_CPUNAMES"]

    def _set_cpu(self, cpu: str) -> None:
        variables = self._root.variables
        platform = variables.get(f"{cpu}_PLATFORM") or ["default", cpu]
        apps = self._apps(cpu)
        variables |= {
            "TGTNAME": [cpu],
            "BUILD_CONFIG": list(platform),
            "SYSVAR": [re.sub(r"\W", "_", "_".join(("native", *platform)))],
            "APP_INSTALL_LIST": [cpu],
            "INSTALL_TARGET_LIST": [cpu],
            f"{cpu}_APPLIST": [*apps],
        }
        sysvar = variables["SYSVAR"][0]
        variables |= {f"TGTSYS_{sysvar}": [cpu], f"TGTSYS_{sysvar}_APPS": [*apps]}

    def _apps(self, cpu: str) -> list[str]:
        variables = self._root.variables
        lists = (f"{cpu}_APPLIST", f"{cpu}_STATIC_APPLIST", "MISSION_GLOBAL_APPLIST", "MISSION_GLOBAL_STATIC_APPLIST")
        named = [each for name in lists for each in variables.get(name, [])]
        return list(dict.fromkeys((*named, *self._more)))

    def _add_folder(self, name: str, folder: Path) -> None:
        before = set(self._project.targets.all)
        if (folder / FILE).is_file():
            self._project.add_folder(folder, self._root)
        elif (folder / "fsw").is_dir():  # built by a Makefile of the mission, as in cFS 6
            convention_target(name, folder, self._project)
        targets = self._project.targets.all
        made = [targets[each] for each in targets if each not in before]
        self._made_by[name] = [each for each in made if each.kind in (MODULE, SHARED) or each.is_application]
        if name in targets and targets[name] not in self._made_by[name] and targets[name].is_application:
            self._made_by[name].append(targets[name])  # another folder has needed it before


def build_variables(layout: TreeLayout) -> dict[str, list[str]]:
    """Return the variables that cFS's build has before it reads targets.cmake, on Linux."""
    tree = str(layout.tree)
    return {
        "MISSION_SOURCE_DIR": [tree],
        "MISSION_BINARY_DIR": [f"{tree}/.build"],
        "CMAKE_BINARY_DIR": [f"{tree}/.build"],
        "CMAKE_CURRENT_BINARY_DIR": [f"{tree}/.build"],
        "CMAKE_SOURCE_DIR": [f"{tree}/cfe"],
        "CFE_SOURCE_DIR": [f"{tree}/cfe"],
        "OSAL_SOURCE_DIR": [f"{tree}/osal"],
        "UT_ASSERT_SOURCE_DIR": [f"{tree}/osal/ut_assert"],
        "MISSION_DEFS": [str(layout.definitions)],
        "MISSIONCONFIG": [layout.config_name],
        "MISSION_MODULE_SEARCH_PATH": list(layout.searched),
        "SIMULATION": ["native"],
        "CFE_SYSTEM_PSPNAME": ["pc-linux"],
        "OSAL_SYSTEM_OSTYPE": ["posix"],
        "INSTALL_SUBDIR": ["cf"],
        "CFE_BUILD_TABLES": ["TRUE"],
        "UNIX": ["1"],
        "CMAKE_SYSTEM_NAME": ["Linux"],
        "CMAKE_C_COMPILER_ID": ["GNU"],
        "CMAKE_C_COMPILER_VERSION": ["12.0"],
        "CMAKE_COMPILER_IS_GNUCC": ["1"],
        "CMAKE_VERSION": ["3.25.1"],
    }
