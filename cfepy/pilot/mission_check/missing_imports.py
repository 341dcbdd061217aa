"""Check of the packages that nodes and applications import: each one that no run could load is a problem.

Imports are read, not executed. They are followed into modules beside the script and on its ROS_PACKAGE_PATH. A package
that a run replaces, such as rospy, counts as installed. An import that the code itself expects to fail, in a `try` with
a handler for it, is not a problem, nor is one for another version of Python. One within a function is a warning,
because a run may never call the function.
"""

from __future__ import annotations

import ast
import importlib.util
import os
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from importlib.machinery import PathFinder
from pathlib import Path
from typing import Any, NamedTuple

from cfepy.interpreter.cached import CachedProperty
from cfepy.mission import tree_of
from cfepy.pilot.mission_check.problem import MissionProblem
from cfepy.pilot.mission_check.ros_files import NodeScript
from cfepy.reading.mistakes import Mistakes

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
_OF_VERSION: dict[str, Any] = {
    "version_info": tuple(sys.version_info),
    "version": sys.version,
    "hexversion": sys.hexversion,
    "PY2": False,  # of six and similar modules
    "PY3": True,
}
_PARTS = ("major", "minor", "micro")  # of `version_info`
_SYS = ("sys", "_sys")


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
        self._ros2 = script.ros2()
        self._environ = script.environ
        names = {"rospy", "rospy_shim", *library_names()} if self._ros2 is None else self._ros2.library_names()
        self._names = {*names, *(path.stem for path in STAND_INS.iterdir())}
        on_path = [folder for folder in script.environ.get("PYTHONPATH", "").split(os.pathsep) if folder]
        self.folders = [str(script.file.parent), *on_path, *map(str, self._packages.code_folders())]

    def refusal(self, name: str) -> str:
        """Return why a run does not make a module of ROS for this node; empty if nothing refuses it."""
        if self._ros2 is not None:
            return self._ros2.refusal(name)
        if name.partition(".")[0] == "rclpy" and not is_installed("rclpy"):
            return "a program of ROS 1 cannot import rclpy; use two nodes, or write `ros: 2` for it in mission.yaml"
        return ""

    def __call__(self, top: str) -> bool:
        return top in self._names or top in self._message_packages or self._has_settings(top)

    @CachedProperty
    def _message_packages(self) -> frozenset[str]:
        from rospy_shim.types.msgs import Library, OnDisk, shipped

        if self._ros2 is not None:
            return frozenset(self._ros2.types_near(self._packages, self._environ).packages())
        return frozenset(Library([OnDisk(self._packages, Mistakes())], base=shipped()).packages())

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
        yield from _missing(script.file, given.folders, given, given.refusal)


def check_imports_of_app(source: Path, folder: Path) -> Iterator[MissionProblem]:
    """Check the imports of an application or library in Python.

    Args:
        source: file of its module, or the `__init__.py` of its package.
        folder: the mission's folder.

    Yields:
        A problem for each line that imports a package which is not installed.
    """
    yield from _missing(source, [str(folder)], lambda top: False)


def _missing(
    file: Path,
    folders: Sequence[str],
    is_given: Callable[[str], bool],
    refusal: Callable[[str], str] = lambda name: "",
) -> Iterator[MissionProblem]:
    for each in imports_of(file, folders):
        top = each.name.partition(".")[0]
        if why := "" if _finds(top, folders) else refusal(each.name):
            yield MissionProblem(each.file, each.line, why, each.is_late)
        elif not (is_installed(top) or _finds(top, folders) or is_given(top)):
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
        for node, is_late in _import_statements(tree_of(here)):
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
    versions = _PythonVersions(tree)
    while waiting:
        node, is_late = waiting.pop()
        if isinstance(node, ast.Import | ast.ImportFrom):
            yield node, is_late
        elif isinstance(node, ast.Try) and _catches_missing(node):
            waiting += [(each, is_late) for each in (*node.orelse, *node.finalbody)]
        elif isinstance(node, ast.If):
            waiting += [(each, is_late) for each in versions.branches(node) if not _is_for_type_checkers(node)]
        else:
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


def _is_for_type_checkers(node: ast.If) -> bool:
    return "TYPE_CHECKING" in ast.dump(node.test)


class _PythonVersions:
    """The conditions of a file on the version of Python: which branch of an `if` runs.

    `sys.version_info.major == 2`, `sys.version[0] >= "3"`, `six.PY2`, and names with such values are computed for the
    Python that runs cfepy. The code itself is not executed.

    Args:
        tree: the file.
    """

    def __init__(self, tree: ast.Module) -> None:
        self._names: dict[str, Any] = {"PY2": False, "PY3": True}
        for node in tree.body:
            if isinstance(node, ast.ImportFrom) and node.module == "sys":
                given = [(each.asname or each.name, each.name) for each in node.names]
                self._names |= {name: _OF_VERSION[own] for name, own in given if own in _OF_VERSION}
            elif isinstance(node, ast.Assign) and len(node.targets) == 1 and isinstance(node.targets[0], ast.Name):
                self._assign(node.targets[0].id, node.value)

    def branches(self, node: ast.If) -> list[ast.stmt]:
        """Return the statements of an `if` that may run: the ones of both branches if the version does not decide."""
        decided = self._decide(node.test)
        if decided is None:
            return [*node.body, *node.orelse]
        return node.body if decided else node.orelse

    def _assign(self, name: str, value: ast.expr) -> None:
        self._names.pop(name, None)
        found = _value(value, self._names)
        if found:
            self._names[name] = found[0]

    def _decide(self, test: ast.expr) -> bool | None:
        """Return the truth of a condition; None if the version alone does not decide it."""
        if isinstance(test, ast.BoolOp):
            parts = [self._decide(each) for each in test.values]
            ends_it = isinstance(test.op, ast.Or)  # the value of one part that decides the whole
            return ends_it if ends_it in parts else None if None in parts else not ends_it
        if isinstance(test, ast.UnaryOp) and isinstance(test.op, ast.Not):
            decided = self._decide(test.operand)
            return None if decided is None else not decided
        found = _value(test, self._names)
        return bool(found[0]) if found else None


def _value(node: ast.expr, names: Mapping[str, Any]) -> tuple[Any, ...]:
    """Return the value of an expression that depends on the version, in a tuple; an empty one for any other."""
    from rospy_shim.types.expression import value_of

    tree = _Versions(names)
    try:
        text = ast.unparse(tree.visit(ast.parse(ast.unparse(node), mode="eval")))
        return (value_of(text, tree.values),) if tree.values else ()
    except Exception:  # another name, a function, or an error of the expression itself: the version does not decide it
        return ()


class _Versions(ast.NodeTransformer):
    """Replaces expressions with the version by plain names.

    Args:
        names: names of the file with values that depend on the version.

    Attributes:
        values: by name, the values of the names that the expression has then.
    """

    def __init__(self, names: Mapping[str, Any]) -> None:
        self.values: dict[str, Any] = {}
        self._names = names

    def visit_Attribute(self, node: ast.Attribute) -> ast.AST:
        """Replace `sys.version_info`, its parts, and flags of other modules."""
        self.generic_visit(node)
        value, name = node.value, node.attr
        if not isinstance(value, ast.Name):
            return node
        if value.id in self.values and name in _PARTS:
            return self._named(f"{value.id}_{name}", self.values[value.id][_PARTS.index(name)])
        if name in _OF_VERSION and (value.id in _SYS or name.startswith("PY")):
            return self._named(f"{value.id}_{name}", _OF_VERSION[name])
        return node

    def visit_Name(self, node: ast.Name) -> ast.AST:
        """Note the value of a name."""
        return self._named(node.id, self._names[node.id]) if node.id in self._names else node

    def _named(self, name: str, value: Any) -> ast.Name:
        self.values[name] = value
        return ast.Name(name, ast.Load())
