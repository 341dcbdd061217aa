"""Check of the packages that nodes and applications import: each one that no run could load is a problem.

Imports are read, not executed. They are followed into modules beside the script and on its ROS_PACKAGE_PATH. A package
that a run replaces, such as rospy, counts as installed. An import that the code itself expects to fail, in a `try` with
a handler for it, is not a problem, and one within a function is a warning, because a run may never call the function.
"""

from __future__ import annotations

import ast
import importlib.util
import os
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import cached_property
from importlib.machinery import PathFinder
from pathlib import Path
from typing import NamedTuple

from cfepy.mission import app_sources as sources
from cfepy.pilot.mission_check.problem import MissionProblem
from cfepy.pilot.mission_check.ros_files import NodeScript
from cfepy.reading.marked_yaml import Mistakes

MOST_FILES = 500  # of one node
DISTRIBUTIONS = {
    "Crypto": "pycryptodome",
    "OpenGL": "PyOpenGL",
    "PIL": "Pillow",
    "bs4": "beautifulsoup4",
    "cv2": "opencv-python-headless",
    "dateutil": "python-dateutil",
    "fitz": "PyMuPDF",
    "gi": "PyGObject",
    "google": "protobuf",
    "jwt": "PyJWT",
    "mpl_toolkits": "matplotlib",
    "pylab": "matplotlib",
    "serial": "pyserial",
    "skimage": "scikit-image",
    "sklearn": "scikit-learn",
    "usb": "pyusb",
    "yaml": "PyYAML",
    "zmq": "pyzmq",
}
"""Packages whose name for pip is not their name in Python."""
OF_PYTHON_2 = {
    "ConfigParser": "configparser",
    "HTMLParser": "html.parser",
    "Queue": "queue",
    "SocketServer": "socketserver",
    "StringIO": "io",
    "Tkinter": "tkinter",
    "__builtin__": "builtins",
    "cPickle": "pickle",
    "commands": "subprocess",
    "httplib": "http.client",
    "thread": "_thread",
    "urllib2": "urllib.request",
    "urlparse": "urllib.parse",
    "xmlrpclib": "xmlrpc.client",
}
"""Modules of Python 2, and those that replace them."""
# fmt: off
OF_ROS = frozenset({
    "camera_calibration", "controller_manager", "gazebo_ros", "image_geometry", "interactive_markers",
    "joint_state_publisher", "laser_geometry", "moveit_commander", "python_qt_binding", "qt_gui", "rqt_gui",
    "rqt_gui_py", "rqt_plot", "rviz", "smach", "smach_ros", "urdf_parser_py", "xacro",
})
# fmt: on
"""ROS packages with Python code that pip does not offer."""
CATCHING = ("ImportError", "ModuleNotFoundError", "Exception", "BaseException")
KINDS = ("msg", "srv")


class Import(NamedTuple):
    """A module that a file imports.

    Attributes:
        file: the file.
        line: the line of the import.
        name: full name of the module.
        is_late: whether a function imports it.
    """

    file: Path
    line: int
    name: str
    is_late: bool


class _GivenToNode:
    """Tells which modules a run makes for a node: rospy, ROS libraries, messages and configurations of packages.

    Args:
        script: the node.
    """

    def __init__(self, script: NodeScript) -> None:
        from rospy_shim.library_parts import STAND_INS, library_names
        from rospy_shim.types.msgs import Packages

        self._packages = Packages(script.file, script.environ)
        self._names = {"rospy", "rospy_shim", *library_names(), *(path.stem for path in STAND_INS.iterdir())}
        on_path = [folder for folder in script.environ.get("PYTHONPATH", "").split(os.pathsep) if folder]
        self.folders = [str(script.file.parent), *on_path, *map(str, self._packages.code_folders())]

    def __call__(self, top: str) -> bool:
        return top in self._names or top in self._message_packages or self._has_settings(top)

    @cached_property
    def _message_packages(self) -> frozenset[str]:
        from rospy_shim.types.msgs import Library, OnDisk, shipped

        return frozenset(Library([OnDisk(self._packages, Mistakes(keep=True))], base=shipped()).packages())

    def _has_settings(self, package: str) -> bool:
        return any(os.path.isdir(folder / "cfg") for folder in self._packages.folders(package))


def check_imports_of_nodes(scripts: Iterable[NodeScript]) -> Iterator[MissionProblem]:
    """Check the imports of nodes.

    Args:
        scripts: the nodes.

    Yields:
        A problem for each line that imports a package which is not installed.
    """
    for script in scripts:
        given = _GivenToNode(script)
        yield from _missing(script.file, given.folders, given)


def check_imports_of_app(source: Path, folder: Path) -> Iterator[MissionProblem]:
    """Check the imports of an application or library in Python.

    Args:
        source: file of its module, or the `__init__.py` of its package.
        folder: the mission's folder.

    Yields:
        A problem for each line that imports a package which is not installed.
    """
    yield from _missing(source, [str(folder)], lambda top: False)


def _missing(file: Path, folders: Sequence[str], is_given: Callable[[str], bool]) -> Iterator[MissionProblem]:
    for each in imports_of(file, folders):
        top = each.name.partition(".")[0]
        if not (is_installed(top) or _finds(top, folders) or is_given(top)):
            yield _problem(each, top)


def _problem(found: Import, top: str) -> MissionProblem:
    late = "; a run fails when it calls this function" if found.is_late else ""
    if top in OF_PYTHON_2:
        text = f"{top} is a module of Python 2; import {OF_PYTHON_2[top]}{late}"
        return MissionProblem(found.file, found.line, text, found.is_late)
    if top in OF_ROS:
        text = f"the ROS package {top} is not installed; put its source on ROS_PACKAGE_PATH{late}"
        return MissionProblem(found.file, found.line, text, found.is_late)
    package = DISTRIBUTIONS.get(top, top)
    text = f"the package {top} is not installed; pip install {package}{late}"
    return MissionProblem(found.file, found.line, text, found.is_late, package)


def is_installed(top: str) -> bool:
    """Return whether the Python that runs cfepy has a module of this name, without importing it."""
    if top in sys.stdlib_module_names or top in sys.modules:
        return True
    try:
        return importlib.util.find_spec(top) is not None
    except (ImportError, ValueError):
        return False


def _finds(name: str, folders: Sequence[str]) -> Path | None:
    """Return the source of a module in some folders, or the folder of a package without code; None without one."""
    places = list(folders)
    found: Path | None = None
    for number, part in enumerate(name.split("."), 1):
        spec = PathFinder.find_spec(part, places)
        if spec is None:
            return None if number == 1 else found
        places = [] if spec.submodule_search_locations is None else list(spec.submodule_search_locations)
        found = Path(spec.origin if spec.origin is not None else places[0])
    return found


def imports_of(file: Path, folders: Sequence[str]) -> list[Import]:
    """Return the modules that a file imports, and those that modules import which it finds in some folders.

    Args:
        file: a source in Python.
        folders: folders of modules that belong to it.
    """
    found: dict[tuple[Path, int, str], Import] = {}
    waiting, seen = [file], {file}
    while waiting and len(seen) <= MOST_FILES:
        here = waiting.pop()
        for node, is_late in _import_statements(sources.tree_of(here)):
            for name in _names_of(node):
                found[here, node.lineno, name] = Import(here, node.lineno, name, is_late)
            for source in _sources_of(node, here, folders):
                if source.suffix == ".py" and source not in seen:
                    seen.add(source)
                    waiting.append(source)
    return sorted(found.values(), key=lambda each: (str(each.file), each.line))


def _import_statements(tree: ast.Module) -> Iterator[tuple[ast.Import | ast.ImportFrom, bool]]:
    """Yield the imports that nothing guards, and whether a function makes them."""
    waiting: list[tuple[ast.AST, bool]] = [(node, False) for node in tree.body]
    while waiting:
        node, is_late = waiting.pop()
        if isinstance(node, ast.Import | ast.ImportFrom):
            yield node, is_late
        elif isinstance(node, ast.Try) and _catches_missing(node):
            waiting += [(each, is_late) for each in (*node.orelse, *node.finalbody)]
        elif not _is_for_type_checkers(node):
            is_function = isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef)
            waiting += [(each, is_late or is_function) for each in ast.iter_child_nodes(node)]


def _names_of(node: ast.Import | ast.ImportFrom) -> list[str]:
    """Return the full names of the modules of other packages, without messages, which another check covers."""
    if isinstance(node, ast.Import):
        names = [alias.name for alias in node.names]
    else:
        names = [] if node.level or node.module is None else [node.module]
    return [name for name in names if name.partition(".")[2] not in KINDS]


def _sources_of(node: ast.Import | ast.ImportFrom, file: Path, folders: Sequence[str]) -> Iterator[Path]:
    """Yield the files in some folders, or beside a file of a package, that an import may execute."""
    if isinstance(node, ast.Import):
        names = [alias.name for alias in node.names]
    else:
        module = [] if node.module is None else [node.module]
        names = [*module, *(".".join((*module, alias.name)) for alias in node.names)]
        if node.level:
            folders = [str(file.parents[node.level - 1])]
    for name in names:
        source = _finds(name, folders)
        if source is not None:
            yield source


def _catches_missing(node: ast.Try) -> bool:
    """Return whether a `try` handles a missing module."""
    for handler in node.handlers:
        kinds = handler.type.elts if isinstance(handler.type, ast.Tuple) else [handler.type]
        if any(kind is None or (isinstance(kind, ast.Name) and kind.id in CATCHING) for kind in kinds):
            return True
    return False


def _is_for_type_checkers(node: ast.AST) -> bool:
    return isinstance(node, ast.If) and "TYPE_CHECKING" in ast.dump(node.test)
