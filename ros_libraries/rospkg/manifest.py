"""rospkg.manifest: the content of a package's package.xml, or of rosbuild's manifest.xml (wiki.ros.org/Manifest)."""

from __future__ import annotations

import os
from typing import Any
from xml.etree import ElementTree

from rospkg.common import PACKAGE_FILE, STACK_FILE

_DEPENDENCIES = (
    "depend",
    "buildtool_depend",
    "build_depend",
    "build_export_depend",
    "run_depend",
    "exec_depend",
    "test_depend",
)


class InvalidManifest(Exception):
    """A manifest that cannot be read."""


class Depend:
    """A dependency of a package.

    Args:
        name: name of the needed package.
        type_: "package" or "stack".
    """

    __slots__ = ["name", "type"]

    def __init__(self, name: str, type_: str) -> None:
        self.name = name
        self.type = type_

    def __str__(self) -> str:
        return self.name

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Depend) and (self.name, self.type) == (other.name, other.type)

    def __hash__(self) -> int:
        return hash((self.name, self.type))


class RosDep:
    """A dependency on the system.

    Args:
        name: its rosdep key.
    """

    __slots__ = ["name"]

    def __init__(self, name: str) -> None:
        self.name = name


class Export:
    """An export of a package for tools.

    Args:
        tag: name of the element.
        attrs: its attributes.
        str: its text.
    """

    def __init__(self, tag: str, attrs: dict[str, str], str: str) -> None:
        self.tag = tag
        self.attrs = attrs
        self.str = str

    def get(self, attr: str) -> str | None:
        """Return an attribute, or None."""
        return self.attrs.get(attr)


class Platform:
    """A system on which a package is known to work.

    Args:
        os_: its name.
        version: its version.
        notes: remarks.
    """

    __slots__ = ["notes", "os", "version"]

    def __init__(self, os_: str, version: str, notes: str | None = None) -> None:
        self.os = os_
        self.version = version
        self.notes = notes


class Manifest:
    """A manifest.

    Args:
        type_: "package" or "stack".
        filename: of the manifest.
        is_catkin: of a package.xml.
    """

    def __init__(self, type_: str = "package", filename: str | None = None, is_catkin: bool = False) -> None:
        self.type = type_
        self.filename = filename
        self.is_catkin = is_catkin
        self.description = self.brief = self.author = self.license = self.license_url = ""
        self.url = self.status = self.version = self.notes = ""
        self.licenses: list[str] = []
        self.depends: list[Depend] = []
        self.rosdeps: list[RosDep] = []
        self.exports: list[Export] = []
        self.platforms: list[Platform] = []
        self.unknown_tags: list[Any] = []

    def get_export(self, tag: str, attr: str, convert: bool = True) -> list[str]:
        """Return values of an attribute in exports.

        Args:
            tag: name of the export's element.
            attr: name of the attribute.
            convert: put the manifest's folder in place of `${prefix}`.

        Raises:
            ValueError: `convert`, and the manifest is of no file.
        """
        found = [each.attrs[attr] for each in self.exports if each.tag == tag and attr in each.attrs]
        if not convert:
            return found
        if not self.filename:
            raise ValueError("cannot convert export values when filename for Manifest is not set")
        return [value.replace("${prefix}", os.path.dirname(self.filename)) for value in found]


def parse_manifest_file(dirpath: str, manifest_name: str, rospack: Any = None) -> Manifest:
    """Read the manifest of a package.

    Args:
        dirpath: the package's folder.
        manifest_name: manifest.xml or stack.xml; without such a file, package.xml counts.
        rospack: knows which dependencies are packages; the others are the system's.

    Raises:
        InvalidManifest: it is not a manifest.
        IOError: the file does not exist.
    """
    for name in (manifest_name, PACKAGE_FILE):
        filename = os.path.join(dirpath, name)
        if os.path.isfile(filename):
            with open(filename, encoding="utf-8") as file:
                text = file.read()
            return _package(text, filename, rospack) if name == PACKAGE_FILE else parse_manifest(name, text, filename)
    raise OSError(f"Invalid/non-existent manifest file: {os.path.join(dirpath, manifest_name)}")


def parse_manifest(manifest_name: str, string: str, filename: str = "string") -> Manifest:
    """Read a manifest.xml or stack.xml.

    Raises:
        InvalidManifest: it is not a manifest.
    """
    kind = "stack" if manifest_name == STACK_FILE else "package"
    root = _root(string, filename, kind)
    found = Manifest(kind, filename)
    found.is_catkin = root.find("catkin") is not None or root.find("name") is not None
    description, license_, review = root.find("description"), root.find("license"), root.find("review")
    found.description, found.license = _text(root, "description"), _text(root, "license")
    found.brief = "" if description is None else description.get("brief", "")
    found.license_url = "" if license_ is None else license_.get("url", "")
    found.status = "unreviewed" if review is None else review.get("status", "")
    found.notes = "" if review is None else review.get("notes", "")
    found.author = ", ".join(_all(root, "author"))
    found.url, found.version = _text(root, "url"), _text(root, "version")
    attribute = "stack" if kind == "stack" else "package"
    found.depends = [Depend(each.get(attribute, ""), kind) for each in root.findall("depend")]
    found.rosdeps = [RosDep(each.get("name", "")) for each in root.findall("rosdep")]
    found.platforms = [Platform(each.get("os", ""), each.get("version", "")) for each in root.findall("platform")]
    found.exports = _exports(root)
    return found


def _package(text: str, filename: str, rospack: Any) -> Manifest:
    root = _root(text, filename, "package")
    found = Manifest("package", filename, is_catkin=True)
    found.description, found.version, found.url = (_text(root, name) for name in ("description", "version", "url"))
    found.author = ", ".join([f"Maintainer: {each}" for each in _people(root, "maintainer")] + _people(root, "author"))
    found.licenses = _all(root, "license")
    found.license = ", ".join(found.licenses)
    found.exports = _exports(root)
    known = rospack.list() if rospack is not None else []
    for name in dict.fromkeys(name for kind in _DEPENDENCIES for name in _all(root, kind)):
        if name in known:
            found.depends.append(Depend(name, "package"))
        else:
            found.rosdeps.append(RosDep(name))
    return found


def _root(text: str, filename: str, kind: str) -> Any:
    try:
        root = ElementTree.fromstring(text)
    except ElementTree.ParseError as error:
        raise InvalidManifest(f"[{filename}] invalid XML: {error}") from None
    if root.tag != kind:
        raise InvalidManifest(f"manifest [{filename}] must have a single '{kind}' element")
    return root


def _text(root: Any, name: str) -> str:
    return (_all(root, name) or [""])[0]


def _all(root: Any, name: str) -> list[str]:
    return ["".join(each.itertext()).strip() for each in root.findall(name)]


def _people(root: Any, name: str) -> list[str]:
    found = ((each.text or "", each.get("email")) for each in root.findall(name))
    return [f"{person.strip()} <{mail}>" if mail else person.strip() for person, mail in found]


def _exports(root: Any) -> list[Export]:
    return [Export(each.tag, dict(each.attrib), (each.text or "").strip()) for each in root.findall("export/*")]
