"""CMake's own list of a package's targets, by its File API, for `cfepy convert --cmake`.

CMake executes a CMakeLists.txt, so a check never starts it, and a conversion only if it is asked to.
"""

from __future__ import annotations

import json
import os
import subprocess
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from cfepy.extra.convert.catkin_reader import FILE
from cfepy.extra.convert.cpp_package import CppPackage, CppTarget
from cfepy.status import UsageError

_QUERY = Path(".cmake/api/v1/query/codemodel-v2")
_REPLY = Path(".cmake/api/v1/reply")
_NOT_OURS = ("/usr/include", "/usr/local/include", "/opt/ros")
_LONGEST_S = 300
_SHOWN = 300  # characters of CMake's error


class CMakeAnswers:
    """Asks CMake about packages, each once.

    Attributes:
        version: of CMake, such as "3.25.1".

    Raises:
        UsageError: CMake is not installed.
    """

    def __init__(self) -> None:
        try:
            said = subprocess.run(["cmake", "--version"], capture_output=True, text=True, check=False).stdout
        except OSError:
            raise UsageError(
                "CMake is not installed; leave the option out to use cfepy's reader", field="--cmake"
            ) from None
        self.version = said.split()[2] if len(said.split()) > 2 else ""
        self._found: dict[Path, list[CppTarget]] = {}

    def adjust(self, package: CppPackage) -> None:
        """Give the targets of a package the sources, folders and definitions that CMake lists.

        Raises:
            UsageError: CMake cannot configure the package.
        """
        if package.folder not in self._found:
            self._found[package.folder] = _targets(package.folder)
        for target in self._found[package.folder]:
            known = package.targets.setdefault(target.name, target)
            target.links = list(dict.fromkeys([*known.links, *target.links]))
            target.file_name = known.file_name or target.file_name
            package.targets[target.name] = target


def _targets(folder: Path) -> list[CppTarget]:
    with tempfile.TemporaryDirectory(prefix="cfepy-cmake-") as made:
        build = Path(made)
        (build / _QUERY).parent.mkdir(parents=True)
        (build / _QUERY).touch()
        command = ["cmake", "-S", str(folder), "-B", made, "-Wno-dev"]
        try:
            done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=_LONGEST_S)
        except subprocess.TimeoutExpired:
            raise UsageError(f"CMake takes more than {_LONGEST_S} s", file=folder / FILE) from None
        if done.returncode:
            why = " ".join(done.stderr.split())[:_SHOWN]
            raise UsageError(f"CMake cannot configure it: {why}", file=folder / FILE)
        answers = [json.loads(each.read_text(encoding="utf-8")) for each in (build / _REPLY).glob("target-*.json")]
        names = {each["id"]: each["name"] for each in answers}
        return [_target(each, folder, build, names) for each in answers if each["type"] != "UTILITY"]


def _target(answer: Mapping[str, Any], folder: Path, build: Path, names: Mapping[str, str]) -> CppTarget:
    groups = answer.get("compileGroups", [])
    target = CppTarget(answer["name"], folder, answer["type"] != "EXECUTABLE", needs_suffixes=True)
    target.sources = [each["path"] for each in answer.get("sources", []) if "compileGroupIndex" in each]
    target.includes = list(dict.fromkeys(_folders(groups, build)))
    target.definitions = list(dict.fromkeys(each["define"] for group in groups for each in group.get("defines", [])))
    target.links = [names[each["id"]] for each in answer.get("dependencies", []) if each["id"] in names]
    name = answer.get("nameOnDisk", "")
    target.file_name = "" if target.is_library or name == target.name else name
    return target


def _folders(groups: Any, build: Path) -> Iterator[Path]:
    """Yield the folders of headers, without the installed ones: the interface library stands for ROS."""
    for group in groups:
        for each in group.get("includes", []):
            folder = Path(os.path.normpath(each["path"]))
            is_installed = any(folder.is_relative_to(other) for other in _NOT_OURS) and "eigen3" not in folder.parts
            if not is_installed and not folder.is_relative_to(build):
                yield folder
