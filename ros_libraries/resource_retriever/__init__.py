"""resource_retriever for nodes: files by URL, including files of ROS packages as `package://name/path`.

Names and results match ROS's resource_retriever 1.12; the code is cfepy's own. Files are read as the node sees
them. Other schemes use urllib, which refuses the network in a simulation.
"""

from __future__ import annotations

from typing import Any

import rospkg

PACKAGE_PREFIX = "package://"
_FILE_PREFIX = "file://"

_rospack: Any = None


def get_rospack() -> Any:
    """Return the node's rospkg.RosPack."""
    global _rospack
    if _rospack is None:
        _rospack = rospkg.RosPack()
    return _rospack


def get_filename(url: str, use_protocol: bool = True) -> str:
    """Return the path of a package's file. Other URLs stay unchanged.

    Args:
        url: e.g. "package://my_robot/meshes/base.stl".
        use_protocol: put "file://" in front.

    Raises:
        ResourceNotFound: there is no such package.
        Exception: the path after the package's name is missing.
    """
    if not url.startswith(PACKAGE_PREFIX):
        return url
    package, slash, path = url.removeprefix(PACKAGE_PREFIX).partition("/")
    if not slash:
        raise Exception(f"Could not parse package:// format into file:// format for {url}")
    return f"{_FILE_PREFIX if use_protocol else ''}{get_rospack().get_path(package)}/{path}"


def get(url: str) -> bytes:
    """Return the contents of a file.

    Raises:
        Exception: there is no such file.
    """
    filename = get_filename(url)
    try:
        if filename.startswith(_FILE_PREFIX):
            with open(filename.removeprefix(_FILE_PREFIX), "rb") as file:
                return file.read()
        from urllib.request import urlopen

        contents: bytes = urlopen(filename).read()
        return contents
    except OSError as error:
        raise Exception(f"Invalid URL: {filename}") from error
