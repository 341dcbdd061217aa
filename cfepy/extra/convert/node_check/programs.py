"""The programs of a check: of a package, of a source file, or of the nodes in a launch file."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path

from cfepy.extra.convert.build import provided_packages
from cfepy.extra.convert.configured_headers import include_folders
from cfepy.extra.convert.conversion import task_of
from cfepy.extra.convert.cpp_package import CppPackage, Program
from cfepy.extra.convert.packages import MANIFEST, SUFFIXES, program_of, read_package
from cfepy.status import UsageError
from rospy_shim.types.msgs import Packages


def programs_of(words: Sequence[str], environ: Mapping[str, str]) -> list[Program]:
    """Return the programs for words of the command line.

    Args:
        words: a source file, a package's name or folder, or a launch file with its arguments.
        environ: has the paths of packages.

    Returns:
        The programs, each once; for a package the executables, then the libraries of its nodelets.

    Raises:
        UsageError: nothing has that name, or it has no C++ node.
    """
    path = Path(os.path.abspath(words[0]))
    if len(words) == 1 and path.suffix in SUFFIXES:
        return [_of_file(path, environ)]
    if len(words) == 1 and os.path.isfile(path / MANIFEST):
        return _of_package(path, environ)
    task = task_of(words, environ)
    folders = dict.fromkeys((node.folders[0], node.package, node.type) for node in task.nodes)
    if task.launch is None:
        return _of_package(task.nodes[0].folders[0], environ)
    return [_program(read_package(folder, name), kind, environ) for folder, name, kind in folders]


def _program(package: CppPackage, kind: str, environ: Mapping[str, str]) -> Program:
    packages = Packages(package.folder / MANIFEST, environ)
    return program_of(package, kind, packages, provided_packages())


def _of_file(path: Path, environ: Mapping[str, str]) -> Program:
    packages = Packages(path, environ)
    name = packages.package_of(path)
    folder = packages.path(name) if name is not None else None
    if name is None or folder is None:
        return Program(CppPackage("", path.parent), path.stem, [path])
    package = read_package(folder, name)
    include = folder / "include"
    includes = [*include_folders(package, package.includes), *([include] if os.path.isdir(include) else [])]
    nodelets = {each.library: name for name, each in package.nodelets().items()}
    for target in package.targets.values():
        if any(os.path.abspath(target.folder / each) == str(path) for each in target.sources):
            kind = nodelets.get(target.name) if target.is_library else target.file_name or target.name
            if kind is not None:
                return _program(package, kind, environ)
            own = include_folders(package, target.includes)
            return Program(package, path.stem, [path], [*own, *includes], target.definitions)
    return Program(package, path.stem, [path], includes)


def _of_package(folder: Path, environ: Mapping[str, str]) -> list[Program]:
    name = Packages(folder / MANIFEST, environ).package_of(folder / MANIFEST) or folder.name
    package = read_package(folder, name)
    nodelets = {each.library: name for name, each in package.nodelets().items() if each.library in package.targets}
    types = [*package.executables(), *sorted(nodelets.values())]
    if not types:
        raise UsageError(f"package {name!r} has no C++ node", file=folder)
    return [_program(package, each, environ) for each in types]
