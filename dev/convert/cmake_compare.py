"""How cfepy's reader reads public CMakeLists.txt beside CMake: `python -m dev.convert.cmake_compare SOURCES`.

Each catkin package below SOURCES is configured by CMake, without network, with `cmake_alone.cmake` in place of the
packages that it finds. CMake's File API lists its executables and libraries, each with its sources, folders of headers
and definitions. The reader's must be the same. A package that CMake refuses to configure is counted apart.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import tempfile
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from cfepy.extra.convert.catkin_reader import FILE, CatkinReader
from cfepy.extra.convert.cpp_package import CppPackage, CppTarget
from cfepy.extra.convert.packages import source_files
from cfepy.status import UsageError
from rospy_shim.types.msgs.packages import crawl, name_of

ALONE = Path(__file__).with_name("cmake_alone.cmake")
QUERY = ".cmake/api/v1/query/codemodel-v2"
REPLY = ".cmake/api/v1/reply"
SOURCES = (".cpp", ".cc", ".cxx", ".c++", ".C", ".c")
LONGEST_S = 60


class Made(NamedTuple):
    """A target.

    Attributes:
        sources: paths of its compiled sources, sorted.
        includes: folders of the package with headers, sorted.
        definitions: sorted.
    """

    sources: list[str]
    includes: list[str]
    definitions: list[str]


def by_cmake(package: Path, build: Path) -> dict[str, Made] | str:
    """Return the targets that CMake makes; the first line of its error if it refuses the package."""
    (build / QUERY).parent.mkdir(parents=True)
    (build / QUERY).touch()
    command = ["unshare", "-n", "cmake", "-S", str(package), "-B", str(build), "-Wno-dev"]
    command += [f"-DCMAKE_PROJECT_INCLUDE={ALONE}", f"-DCATKIN_DEVEL_PREFIX={build}"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=LONGEST_S)
    except subprocess.TimeoutExpired:
        return "takes too long"
    if done.returncode:
        lines = [line.strip() for line in done.stderr.splitlines() if line.strip()]
        return " ".join(lines[1:3])[:160]
    found = {}
    for file in (build / REPLY).glob("target-*.json"):
        target = json.loads(file.read_text(encoding="utf-8"))
        if target["type"] not in ("UTILITY", "INTERFACE_LIBRARY"):
            found[target["name"]] = _made(target, package)
    return found


def _made(target: dict[str, object], package: Path) -> Made:
    groups: list[dict[str, list[dict[str, str]]]] = target.get("compileGroups", [])  # type: ignore[assignment]
    sources: list[dict[str, str]] = target.get("sources", [])  # type: ignore[assignment]
    includes = {os.path.normpath(each["path"]) for group in groups for each in group.get("includes", [])}
    defined = {each["define"] for group in groups for each in group.get("defines", [])}
    flags = " ".join(each["fragment"] for group in groups for each in group.get("compileCommandFragments", []))
    defined |= {each.removeprefix("-D") for each in flags.split() if each.startswith("-D")}
    files = {os.path.normpath(package / each["path"]) for each in sources if each["path"].endswith(SOURCES)}
    return Made(sorted(files), _inside(includes, package), sorted(each for each in defined if "_EXPORTS" not in each))


def _inside(folders: set[str], package: Path) -> list[str]:
    return sorted(each for each in folders if Path(each).is_relative_to(package) and os.path.isdir(each))


def by_reader(package: CppPackage) -> dict[str, Made]:
    """Return the targets that cfepy's reader finds. A source that does not exist is kept as it is written."""
    found = {}
    for name, target in package.targets.items():
        if target.name == name and (target.sources or not target.is_library):
            includes = {os.path.normpath(each) for each in _all(package, target, "includes")}
            defined = sorted(set(_all(package, target, "definitions")))
            files = sorted({str(each) for each in source_files(target)})
            found[name] = Made(files, _inside(includes, package.folder), defined)
    return found


def _all(package: CppPackage, target: CppTarget, what: str) -> Iterator[str]:
    """Yield the values of a target and of the libraries that it links, whose public ones it gets."""
    waiting, known = [target], {target.name}
    while waiting:
        each = waiting.pop()
        if each is target or what == "includes":
            yield from map(str, getattr(each, what))
        inner = [package.targets[name] for name in each.links if name in package.targets]
        waiting += [one for one in inner if one.name not in known]
        known |= {one.name for one in inner}


def differences(cmake: dict[str, Made], reader: dict[str, Made]) -> Iterator[str]:
    """Yield how the targets differ."""
    for name in sorted(cmake.keys() ^ reader.keys()):
        yield f"{name}: only {'CMake' if name in cmake else 'the reader'} has it"
    for name in sorted(cmake.keys() & reader.keys()):
        for field in Made._fields:
            one, other = set(getattr(cmake[name], field)), set(getattr(reader[name], field))
            if one - other:
                yield f"{name}: {field} of CMake alone: {sorted(one - other)}"
            if other - one and field != "includes":
                yield f"{name}: {field} of the reader alone: {sorted(other - one)}"


def main() -> None:
    """Compare all packages."""
    parser = argparse.ArgumentParser(prog="python -m dev.convert.cmake_compare", description=__doc__)
    parser.add_argument("sources", type=Path, help="a folder with packages, at any depth")
    parser.add_argument("--only", default="", help="a part of a package's path")
    arguments = parser.parse_args()
    counts: Counter[str] = Counter()
    for folder in sorted(set(crawl(arguments.sources.resolve()))):
        if not (folder / FILE).is_file() or arguments.only not in str(folder):
            continue
        with tempfile.TemporaryDirectory() as build:
            cmake = by_cmake(folder, Path(build))
        if isinstance(cmake, str):
            counts["CMake refuses"] += 1
            print(f"refused    {folder}: {cmake}", flush=True)
            continue
        try:
            package = CppPackage(name_of(folder), folder)
            CatkinReader(package, folder).read(folder / FILE)
            found = list(differences(cmake, by_reader(package)))
        except UsageError as error:
            found = [str(error)]
        counts["differ" if found else "same"] += 1
        counts["targets"] += len(cmake)
        for line in found:
            print(f"differs    {folder}: {line}", flush=True)
    print(*(f"{count} {what}" for what, count in sorted(counts.items())), sep=", ")


if __name__ == "__main__":
    main()
