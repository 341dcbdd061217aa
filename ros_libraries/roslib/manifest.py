"""roslib.manifest: older names of rospkg.manifest."""

from __future__ import annotations

import os
from collections.abc import Mapping

from rospkg.common import MANIFEST_FILE, PACKAGE_FILE
from rospkg.manifest import Depend, Export, InvalidManifest, Manifest, parse_manifest, parse_manifest_file
from rospkg.manifest import RosDep as ROSDep

from roslib.packages import get_pkg_dir

__all__ = [
    "MANIFEST_FILE",
    "Depend",
    "Export",
    "Manifest",
    "ManifestException",
    "ROSDep",
    "load_manifest",
    "manifest_file",
    "parse",
    "parse_file",
]

ManifestException = InvalidManifest


def manifest_file(package: str, required: bool = True, env: Mapping[str, str] | None = None) -> str | None:
    """Return the path of a package's manifest.

    Args:
        package: its name.
        required: raise if there is none; otherwise return None.
        env: accepted.

    Raises:
        InvalidROSPkgException: there is no such package.
        InvalidManifest: it has no manifest.
    """
    folder = get_pkg_dir(package, required)
    paths = [os.path.join(folder, name) for name in (MANIFEST_FILE, PACKAGE_FILE)] if folder else []
    found = next(filter(os.path.isfile, paths), None)
    if found is None and required:
        raise InvalidManifest(f"Package '{package}' is improperly configured: no {MANIFEST_FILE} is present")
    return found


def load_manifest(package: str) -> Manifest:
    """Return the manifest of a package.

    Raises:
        InvalidROSPkgException: there is no such package.
        InvalidManifest: it has no manifest.
    """
    return parse_file(manifest_file(package) or "")


def parse_file(file: str) -> Manifest:
    """Read a manifest.

    Raises:
        InvalidManifest: it is not a manifest.
        IOError: the file does not exist.
    """
    return parse_manifest_file(os.path.dirname(file), os.path.basename(file))


def parse(string: str, filename: str = "string") -> Manifest:
    """Read the text of a manifest.xml.

    Raises:
        InvalidManifest: it is not a manifest.
    """
    return parse_manifest(MANIFEST_FILE, string, filename)
