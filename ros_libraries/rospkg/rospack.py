"""rospkg.rospack: finds packages and stacks by name, and their dependencies (`rospack find`, `rospack depends`)."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from typing import Any
from xml.etree import ElementTree as _ElementTree

from rospkg import _places  # type: ignore[attr-defined]  # made for the node, which knows where its packages lie
from rospkg.common import MANIFEST_FILE, PACKAGE_FILE, STACK_FILE, ResourceNotFound
from rospkg.environment import get_ros_paths
from rospkg.manifest import InvalidManifest, Manifest, parse_manifest, parse_manifest_file

_IGNORED = ("CATKIN_IGNORE", "rospack_nosubdirs")


class ManifestManager:
    """Packages or stacks by name. Results are cached.

    Args:
        manifest_name: manifest.xml for packages, stack.xml for stacks.
        ros_paths: folders to look in; None for all that the program can see.
    """

    def __init__(self, manifest_name: str, ros_paths: Sequence[str] | None = None) -> None:
        self._manifest_name = manifest_name
        self._given = ros_paths
        self._ros_paths = get_ros_paths() if ros_paths is None else list(ros_paths)
        self._places: dict[str, str] | None = None
        self._manifests: dict[str, Manifest] = {}
        self._custom_cache: dict[str, Any] = {}

    @classmethod
    def get_instance(cls, ros_paths: Sequence[str] | None = None) -> Any:
        """Return the instance for some folders, made when first asked for."""
        instances: dict[str, Any] = vars(cls).get("_instances") or {}
        if not instances:
            cls._instances = instances  # type: ignore[attr-defined]
        key = str(tuple(get_ros_paths() if ros_paths is None else ros_paths))
        if key not in instances:
            instances[key] = cls(ros_paths)  # type: ignore[arg-type]
        return instances[key]

    def get_ros_paths(self) -> list[str]:
        """Return the folders in which packages are searched."""
        return self._ros_paths[:]

    ros_paths = property(get_ros_paths)

    def _find(self) -> dict[str, str]:
        found: dict[str, str] = _places.folders(self._given)
        return found

    def _folders(self) -> dict[str, str]:
        if self._places is None:
            self._places = self._find()
        return self._places

    def list(self) -> list[str]:
        """Return the names of all."""
        return [*self._folders()]

    def get_path(self, name: str) -> str:
        """Return the folder of a package.

        Raises:
            ResourceNotFound: there is no such package.
        """
        if name not in self._folders():
            raise ResourceNotFound(name, ros_paths=self._ros_paths)
        return self._folders()[name]

    def get_manifest(self, name: str) -> Manifest:
        """Return the manifest of a package.

        Raises:
            ResourceNotFound: there is no such package.
            InvalidManifest: its manifest cannot be read.
        """
        if name not in self._manifests:
            self._manifests[name] = parse_manifest_file(self.get_path(name), self._manifest_name, rospack=self)
        return self._manifests[name]

    _load_manifest = get_manifest  # rospkg's name for it; FlexBE looks for its behaviors with it

    def get_depends(self, name: str, implicit: bool = True) -> Sequence[str]:
        """Return the names of a package's dependencies.

        Args:
            name: name of the package.
            implicit: include indirect dependencies.

        Raises:
            ResourceNotFound: the package or a dependency is missing.
            InvalidManifest: a manifest cannot be read.
        """
        found: dict[str, None] = {}
        waiting = [name]
        while waiting:
            for each in self.get_manifest(waiting.pop(0)).depends:
                if each.name not in found:
                    found[each.name] = None
                    waiting.extend([each.name] if implicit else [])
        return [*found]

    def get_depends_on(self, name: str, implicit: bool = True) -> Sequence[str]:
        """Return the names of packages that depend on a package.

        Args:
            name: name of the package.
            implicit: include indirect dependencies.
        """
        return [each for each in self.list() if each != name and name in self._known_depends(each, implicit)]

    def _known_depends(self, name: str, implicit: bool) -> Sequence[str]:
        try:
            return self.get_depends(name, implicit)
        except (InvalidManifest, ResourceNotFound):
            return []

    def get_custom_cache(self, key: str, default: Any = None) -> Any:
        """Return a value that a tool has stored here."""
        return self._custom_cache.get(key, default)

    def set_custom_cache(self, key: str, value: Any) -> None:
        """Keep something for a tool."""
        self._custom_cache[key] = value


class RosPack(ManifestManager):
    """Packages by name.

    Args:
        ros_paths: folders to look in; None for all that the program can see.
    """

    def __init__(self, ros_paths: Sequence[str] | None = None) -> None:
        super().__init__(MANIFEST_FILE, ros_paths)

    def get_rosdeps(self, package: str, implicit: bool = True) -> Sequence[str]:
        """Return the names of a package's system dependencies.

        Args:
            package: its name.
            implicit: include those of the packages that it depends on.

        Raises:
            ResourceNotFound: the package or a dependency is missing.
        """
        packages = [package, *(self.get_depends(package) if implicit else [])]
        return [*dict.fromkeys(each.name for name in packages for each in self.get_manifest(name).rosdeps)]

    def stack_of(self, package: str) -> str | None:
        """Return the name of the stack that contains a package, or None.

        Raises:
            ResourceNotFound: there is no such package.
        """
        return next(
            (os.path.basename(each) for each in _upwards(self.get_path(package)) if _has(each, STACK_FILE)), None
        )


class RosStack(ManifestManager):
    """Stacks and metapackages by name.

    Args:
        ros_paths: folders to look in; None for those of the environment.
    """

    def __init__(self, ros_paths: Sequence[str] | None = None) -> None:
        super().__init__(STACK_FILE, ros_paths)

    def _find(self) -> dict[str, str]:
        found: dict[str, str] = {}
        for path in reversed(self._ros_paths):
            list_by_path(STACK_FILE, path, found)
        return found

    def packages_of(self, stack: str) -> Sequence[str]:
        """Return the names of the packages in a stack.

        Raises:
            ResourceNotFound: there is no such stack.
        """
        return list_by_path(MANIFEST_FILE, self.get_path(stack), {})

    def get_stack_version(self, stack: str) -> str | None:
        """Return the version of a stack, or None.

        Raises:
            ResourceNotFound: there is no such stack.
        """
        return get_stack_version_by_dir(self.get_path(stack))


def list_by_path(manifest_name: str, path: str, cache: dict[str, str] | None) -> list[str]:
    """Return the names of the packages, or stacks, in a folder at any depth, but not those inside another.

    Args:
        manifest_name: file name that identifies them.
        path: the folder.
        cache: gets the folder of each.
    """
    found: dict[str, str] = {}
    for folder, below, files in os.walk(os.path.abspath(path), followlinks=True):
        name = _resource(folder, files, manifest_name)
        if name is not None:
            found.setdefault(name, folder)
        if name is not None or {MANIFEST_FILE, PACKAGE_FILE, *_IGNORED} & set(files):
            below.clear()
        below[:] = sorted(each for each in below if not each.startswith("."))
    if cache is not None:
        cache.update(found)
    return [*found]


def _resource(folder: str, files: Iterable[str], manifest_name: str) -> str | None:
    """Return the name of a folder's package or stack, or None if the folder is neither."""
    if "CATKIN_IGNORE" in files:
        return None
    if PACKAGE_FILE in files:
        root = _ElementTree.parse(os.path.join(folder, PACKAGE_FILE)).getroot()
        is_stack = root.find("export/metapackage") is not None
        wanted = manifest_name == PACKAGE_FILE or (manifest_name == STACK_FILE) == is_stack
        return (root.findtext("name") or "").strip() if wanted else None
    return os.path.basename(folder) if manifest_name in files else None


def expand_to_packages(names: Sequence[str], rospack: RosPack, rosstack: RosStack) -> tuple[list[str], list[str]]:
    """Return packages of a list of packages and stacks, and the names that are neither.

    Raises:
        ValueError: no list.
    """
    if not isinstance(names, (list, tuple)):
        raise ValueError("names must be a list of strings")
    packages = rospack.list()
    valid: list[str] = []
    invalid: list[str] = []
    for name in names:
        try:
            valid.extend([name] if name in packages else rosstack.packages_of(name))
        except ResourceNotFound:
            invalid.append(name)
    return valid, invalid


def get_stack_version_by_dir(stack_dir: str) -> str | None:
    """Return the version of the stack in a folder, or None."""
    file = os.path.join(stack_dir, STACK_FILE)
    if not os.path.isfile(file):
        return None
    with open(file, encoding="utf-8") as stream:
        return parse_manifest(STACK_FILE, stream.read(), file).version or None


def get_package_name(path: str) -> str | None:
    """Return the name of the package that a file or folder lies in, or None."""
    for folder in _upwards(os.path.realpath(path)):
        if _has(folder, MANIFEST_FILE):
            return os.path.basename(folder)
        if _has(folder, PACKAGE_FILE):
            return _ElementTree.parse(os.path.join(folder, PACKAGE_FILE)).getroot().findtext("name")
    return None


def _upwards(folder: str) -> Iterable[str]:
    """Return a folder and those above it."""
    while folder and os.path.dirname(folder) != folder:
        yield folder
        folder = os.path.dirname(folder)


def _has(folder: str, file: str) -> bool:
    return os.path.isfile(os.path.join(folder, file))
