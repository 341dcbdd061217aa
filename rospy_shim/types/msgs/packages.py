"""ROS packages on disk: their names and folders, by the rules of rospkg and catkin.

A package is a folder with a package.xml (or rosbuild's manifest.xml), which also names it. Near a node and in `share`
folders, a folder with definitions in `msg`, `srv` or `action` also counts; its own name is the package's then. Only
this module knows the rules; code that reads definitions or looks packages up by name calls it.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterator, Mapping
from functools import cache
from pathlib import Path

from cfepy.interpreter.cached import CachedProperty
from cfepy.reading.input_files import text_limited
from cfepy.reading.input_limits import CMAKE_BYTES, PYTHON_BYTES, XML_BYTES
from cfepy.reading.resources import shipped
from cfepy.status import UsageError

_MANIFESTS = ("package.xml", "manifest.xml")
_FENCES = ("CATKIN_IGNORE", "AMENT_IGNORE", "rospack_nosubdirs")
_DEFINITIONS = ("msg", "srv", "action")
_PACKAGE_DIR = re.compile(r"""package_dir['"]?\s*[=:]\s*\{\s*['"]{2}\s*:\s*['"]([^'"]+)['"]""")
_NAME = re.compile(r"<name>([^<]*)</name>")
_LEGAL = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]{0,254}")
_ADD = {"msg": "message", "srv": "service", "action": "action"}
_ADDED = re.compile(r"\badd_(message|service|action)_files\s*+\(([^()]*+)\)", re.IGNORECASE)
_DIRECTORY = re.compile(r"\bDIRECTORY\s++\"?([^\s\"]++)")
_COMMENT = re.compile(r"#[^\n]*+")
_SHOWN = 100  # characters of a name that is wrong


class Packages:
    """The packages that a program can see, each by its first place.

    They are searched at first use: near the program, then along ROS_PACKAGE_PATH, then in the share folders of
    CMAKE_PREFIX_PATH. A package that is in none of them may be included in cfepy.

    Args:
        script: the program's file; None leaves out packages near it.
        environ: its environment, read at first use.
        resolve: makes a path from the environment absolute.
    """

    def __init__(
        self,
        script: Path | None,
        environ: Mapping[str, str],
        resolve: Callable[[str], str | os.PathLike[str]] = os.path.abspath,
    ) -> None:
        self._script = script
        self._environ = environ
        self._resolve = resolve

    def names(self) -> list[str]:
        """Return the names of all packages, sorted, without those included in cfepy."""
        return sorted(self._found)

    def path(self, name: str) -> Path | None:
        """Return the folder of a package (rospkg.RosPack.get_path), or None if there is none."""
        folders = self.folders(name)
        return folders[0] if folders else None

    def folders(self, name: str) -> list[Path]:
        """Return all folders of a package by precedence; a built package may have a `share` folder as well."""
        return self._found.get(name) or included().get(name, [])

    def package_of(self, file: Path) -> str | None:
        """Return the name of the package that a file belongs to (rospkg.get_package_name)."""
        return next((name_of(folder) for folder in file.absolute().parents if has_manifest(folder)), None)

    def code_folders(self) -> list[Path]:
        """Return the folders with Python code that packages offer under their own names, as with
        catkin_python_setup.
        """
        found = [folders[0] / inner for folders in self._found.values() for inner in _code_roots(folders[0])]
        return [folder for folder in found if any(folder.glob("*/__init__.py"))]

    @CachedProperty
    def _found(self) -> dict[str, list[Path]]:
        found: dict[str, list[Path]] = {}
        for folder in dict.fromkeys(self._search()):
            found.setdefault(name_of(folder), []).append(folder)
        return found

    def _search(self) -> Iterator[Path]:
        if self._script is not None:
            yield from near(self._script)
        for root in self._listed("ROS_PACKAGE_PATH"):
            yield from crawl(root)
        for prefix in self._listed("CMAKE_PREFIX_PATH"):
            yield from filter(is_package, _subfolders(prefix / "share"))

    def _listed(self, variable: str) -> list[Path]:
        return [Path(self._resolve(each)) for each in self._environ.get(variable, "").split(os.pathsep) if each]


@cache
def included() -> dict[str, list[Path]]:
    """Return the packages included in cfepy, by name, each with its folder."""
    return {name_of(folder): [folder] for folder in crawl(shipped("ros_packages"))}


def _code_roots(package: Path) -> list[str]:
    """Return the folders of the code that a package installs: `src`, or the one in its setup.py."""
    try:
        match = _PACKAGE_DIR.search(text_limited(package / "setup.py", PYTHON_BYTES, "replace"))
    except (OSError, UsageError):
        match = None
    return list(dict.fromkeys(["src", *([match[1]] if match else [])]))


def near(script: Path) -> Iterator[Path]:
    """Yield packages near a program: those it lies in and their neighbours, then the folders next to the program
    itself.

    Last come the packages of the catkin workspace, if the program's package lies in the `src` of one.
    """
    homes = [folder for folder in script.absolute().parents if has_manifest(folder)]
    for folder in homes:
        yield folder
        yield from filter(is_package, _subfolders(folder.parent))
    here = script.absolute().parent
    if has_definitions(here):
        yield here
    yield from filter(is_package, _subfolders(here))
    for source in [folder for home in homes[-1:] for folder in home.parents if folder.name == "src"][:1]:
        yield from crawl(source)


def crawl(root: Path) -> Iterator[Path]:
    """Yield packages in a folder of ROS_PACKAGE_PATH, at any depth; none inside another."""
    if has_manifest(root):
        yield root
    elif not any(os.path.exists(root / fence) for fence in _FENCES):
        for folder in _subfolders(root):
            yield from crawl(folder)


def name_of(folder: Path) -> str:
    """Return the name in a package's manifest; without one, with rosbuild's, or with an illegal name, the folder's
    name.
    """
    name = _name_in(folder / _MANIFESTS[0])
    return name if name is not None and is_package_name(name) else folder.name


def is_package_name(name: str) -> bool:
    """Return True if a name is legal for a package, by catkin's rule (REP 144 also asks for small letters)."""
    return _LEGAL.fullmatch(name) is not None


def check_package_name(folder: Path) -> None:
    """Check the name in a package's manifest.

    Args:
        folder: folder of the package.

    Raises:
        UsageError: the name is not legal for a package.
    """
    file = folder / _MANIFESTS[0]
    name = _name_in(file)
    if name is not None and not is_package_name(name):
        text = f"invalid package name {name[:_SHOWN]!r}; expected letters, digits, '_' and '-'"
        raise UsageError(text, file=file, field="<name>")


def _name_in(manifest: Path) -> str | None:
    """Return the name in a manifest; None if it cannot be read, or has none."""
    try:
        match = _NAME.search(text_limited(manifest, XML_BYTES, "replace"))
    except (OSError, UsageError):
        return None
    return match[1].strip() if match else None


def has_manifest(folder: Path) -> bool:
    """Return True if a folder has a manifest."""
    return any(os.path.isfile(folder / manifest) for manifest in _MANIFESTS)


def has_definitions(folder: Path) -> bool:
    """Return True if a folder has .msg files in `msg`, or .srv or .action files in their folders."""
    return any(True for kind in _DEFINITIONS for _ in (folder / kind).glob(f"*.{kind}"))


def folders_of_definitions(folder: Path, kind: str) -> list[Path]:
    """Return the folders that genmsg takes definitions from; `add_message_files(DIRECTORY ...)` and its kin name them.

    Args:
        folder: of the package.
        kind: "msg", "srv" or "action".

    Returns:
        Folders in the package, without the one that has the name of the kind.
    """
    try:
        text = text_limited(folder / "CMakeLists.txt", CMAKE_BYTES, "replace")
    except (OSError, UsageError):
        return []
    if "DIRECTORY" not in text:
        return []
    found: dict[Path, None] = {}
    for command, words in _ADDED.findall(_COMMENT.sub("", text)):
        named = _DIRECTORY.search(words) if command.lower() == _ADD[kind] else None
        name = os.path.normpath(named[1].replace("${CMAKE_CURRENT_SOURCE_DIR}/", "")) if named else kind
        if name != kind and not name.startswith(("..", "/")) and "$" not in name:
            found[folder / name] = None
    return [each for each in found if os.path.isdir(each)]


def is_package(folder: Path) -> bool:
    """Return True if a folder is a package, where a manifest is not required."""
    return has_manifest(folder) or has_definitions(folder)


def _subfolders(folder: Path) -> list[Path]:
    """Return the folders in a folder that are not hidden, sorted; empty if it cannot be read."""
    try:
        with os.scandir(folder) as found:  # distinguishes folders from files without a stat of each
            return [folder / name for name in sorted(each.name for each in found if _is_subfolder(each))]
    except OSError:
        return []


def _is_subfolder(entry: os.DirEntry[str]) -> bool:
    try:
        return not entry.name.startswith(".") and entry.is_dir()
    except OSError:
        return False  # a circular link
