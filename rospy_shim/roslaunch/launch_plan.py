"""From a launch file to applications: a cFE name, script, arguments and environment for each node that can run here.

The program of a node is a Python script in its package (roslib.packages.find_node). For a few C++ nodes that are common
in launch files, `rospy_shim/roslaunch/tools` has versions in Python; a package's own script of that name takes
precedence.
"""

from __future__ import annotations

import os
import re
import shlex
import zlib
from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import Any

from cfepy.nodes import ROSCORE_PARAMS, CppNode, NodeConfig
from cfepy.reading.input_files import beginning_of, text_limited
from cfepy.reading.input_limits import CMAKE_BYTES, XML_BYTES
from cfepy.reading.mistakes import FirstMistake, Mistakes
from cfepy.reading.suggestions import did_you_mean
from cfepy.status import UsageError
from cfepy.units import NS_PER_S
from rospy_shim.roslaunch.model import Launch, LaunchNode, LaunchRemark, LaunchTest
from rospy_shim.roslaunch.reader import read
from rospy_shim.types.msgs import Packages
from rospy_shim.types.names import SEP

_TOOLS = Path(__file__).parent / "tools"
LONGEST_NAME = 16  # an application's file has ".so" behind it, and names of files have 19 characters in OSAL
_LONGEST_FILE = 200  # characters of a file's name, which may have 255 bytes
ROS_ENVIRONMENT = {"ROS_DISTRO": "noetic", "ROS_PYTHON_VERSION": "3", "ROS_VERSION": "1"}  # as in ROS's setup.sh
_NOT_OURS = ("ROS_MASTER_URI", "ROS_HOSTNAME", "ROS_IP", "ROS_NAMESPACE")  # of the network that does not exist here


def app_name(name: str, taken: Container[str] = ()) -> str:
    """Return a unique name for a node's application, short enough for OSAL.

    Args:
        name: name of the node.
        taken: names of the other applications.
    """
    base = re.sub(r"\W", "_", name, flags=re.ASCII).upper()
    found, number = base[:LONGEST_NAME], 1
    while found in taken:
        number += 1
        found = f"{base[: LONGEST_NAME - len(str(number))]}{number}"
    return found


class ScriptError(Exception):
    """A node cannot run here; its text says why.

    Args:
        text: the reason.
        is_there: True if the node exists, but is not in Python.
    """

    def __init__(self, text: str, is_there: bool = False) -> None:
        super().__init__(text)
        self.is_there = is_there


def find_script(packages: Packages, package: str, node_type: str) -> Path:
    """Find the Python script of a node.

    Args:
        packages: the packages to search.
        package: the node's package.
        node_type: the file's name.

    Raises:
        ScriptError: there is no such script.
    """
    found = sorted(_candidates(packages.folders(package), node_type), key=_rank)
    script = next(filter(is_python, found), None) or _tool(package, node_type)
    if script is not None:
        return script
    if found:
        raise ScriptError(f"{found[0]} is not a Python script; cfepy runs only nodes written in Python", is_there=True)
    folders = packages.folders(package)
    if not folders:
        hint = did_you_mean(package, packages.names(), before="; ")
        raise ScriptError(f"unknown package {package!r}, neither near the file nor on ROS_PACKAGE_PATH{hint}")
    is_built = any(_is_built(folder, package, node_type) for folder in folders)
    why = "a C++ node" if is_built else "a C++ node, or a missing one"
    hint = "" if is_built else did_you_mean(node_type, _programs(folders), before="; ")
    text = f"package {package!r} has no file {node_type!r}{'' if node_type.endswith('.py') else f': {why}'}{hint}"
    raise ScriptError(text, is_there=is_built)


def compiled_folders(packages: Packages, package: str, node_type: str) -> tuple[Path, ...]:
    """Return the folders of a package whose CMakeLists.txt builds a node from C++; empty if there is none.

    Args:
        packages: the packages to search.
        package: the node's package.
        node_type: the program's name.
    """
    folders = (each for each in packages.folders(package) if os.path.isfile(each / "CMakeLists.txt"))
    return tuple(each for each in folders if _is_built(each, package, node_type))


def _is_built(folder: Path, package: str, node_type: str) -> bool:
    """Return True if the CMakeLists.txt of a package, or one further down in its folder, builds a node.

    It does if it contains the name, or makes names of programs from the names of files, one of which has this name.
    """
    word = re.compile(rf"(?<![\w.-]){re.escape(node_type)}(?![\w.-])")
    for file in folder.rglob("CMakeLists.txt") if not node_type.endswith(".py") else ():
        try:
            text = text_limited(file, CMAKE_BYTES, "replace")
        except OSError:
            continue
        if word.search(text.replace("${PROJECT_NAME}", package)):
            return True
        if _NAMED_BY_FILES.search(text) and any(each.suffix in CPP_SUFFIXES for each in folder.rglob(f"{node_type}.*")):
            return True
    return False


def _offers(folder: Path, nodelet: str) -> bool:
    """Return True if a plugin file that a package exports has a nodelet."""
    word = re.compile(rf'\b(?:name|type)\s*=\s*"{re.escape(nodelet)}"')
    try:
        files = _EXPORTED.findall(text_limited(folder / "package.xml", XML_BYTES, "replace"))
        texts = [text_limited(folder / each, XML_BYTES, "replace") for each in files]
    except (OSError, UsageError):
        return False
    return any(word.search(text) for text in texts)


CPP_SUFFIXES = (".cpp", ".cc", ".cxx", ".c++", ".C")
_NAMED_BY_FILES = re.compile(r"add_executable\s*\(\s*\$\{(?!PROJECT_NAME\})")
_EXPORTED = re.compile(r'<nodelet\s+plugin\s*=\s*"\$\{prefix\}/([^"]+)"')


def _programs(folders: list[Path]) -> list[str]:
    """Return the names of the Python scripts in a package's folders that may be nodes."""
    files = (Path(place) / name for folder in folders for place, _, names in os.walk(folder) for name in names)
    return sorted({file.name for file in files if file.name != "setup.py" and file.is_file() and is_python(file)})


def find_file(packages: Packages, package: str, name: str) -> Path | None:
    """Find a file of a package, such as a launch file, by its name alone; None if there is none."""
    return min(_candidates(packages.folders(package), name), key=lambda file: len(file.parts), default=None)


def is_python(file: Path) -> bool:
    """Return True if a file is a Python script: by its name, or by its first line."""
    if file.suffix == ".py":
        return True
    first = beginning_of(file, 200).partition(b"\n")[0]
    return first.startswith(b"#!") and b"python" in first


def _tool(package: str, node_type: str) -> Path | None:
    """Return cfepy's own version of a node; its file name has the package, too, so that it does not shadow a
    library.
    """
    tool = _TOOLS / f"{package}__{node_type}.py"
    return tool if os.path.isfile(tool) else None


def _candidates(folders: list[Path], name: str) -> Iterator[Path]:
    """Yield files of a name in a package's folders, at any depth, and in the program folder of an installed package."""
    for folder in folders:
        installed = folder.parent.parent / "lib" / folder.name / name
        if folder.parent.name == "share" and os.path.isfile(installed):
            yield installed
        for place, inner, files in os.walk(folder):
            inner[:] = sorted(each for each in inner if not each.startswith("."))
            if name in files:
                yield Path(place) / name


def _rank(file: Path) -> tuple[bool, int]:
    """Return the sort key of a file: executable ones first, as only they count for ROS; then those nearer to the
    top.
    """
    return not os.access(file, os.X_OK), len(file.parts)


def _results_file(name: str) -> str:
    """Return the name of a file for the results of a test, whose own name may have any characters."""
    plain = re.sub(r"[^\w.+-]", "_", name)[:_LONGEST_FILE]
    return f"{plain}.xml" if plain == name else f"{plain}-{zlib.crc32(name.encode('utf-8', 'replace')):08x}.xml"


@dataclass(frozen=True, slots=True)
class PlannedTest:
    """A test: its names, its node, and its virtual time limit in ns."""

    package: str
    test_name: str
    node: NodeConfig | None
    time_limit_ns: int
    retry: int
    results: Path  # file for the results of the test
    file: Path  # the launch file that it is in
    line: int  # its line there
    problem: str = ""  # why it has no node
    compiled: CppNode | None = None  # its node, if it is in C++
    displaces: LaunchRemark | None = None  # the node of the file that it shuts down, because both have one name


@dataclass(slots=True)
class LaunchPlan:
    """A plan: applications by name, tests, the tree of parameters, the files that were read, and remarks.

    `compiled` has the nodes in C++ whose sources are here, if the caller asks for them; otherwise they are left out.
    """

    nodes: dict[str, NodeConfig] = field(default_factory=dict)
    compiled: dict[str, CppNode] = field(default_factory=dict)
    tests: list[PlannedTest] = field(default_factory=list)
    params: dict[str, Any] = field(default_factory=dict)
    files: list[Path] = field(default_factory=list)
    remarks: list[LaunchRemark] = field(default_factory=list)

    @property
    def notes(self) -> list[str]:
        """Messages for the user before a run, a line each."""
        return [str(remark) for remark in self.remarks if remark.before_runs]


def plan_of(
    file: Path,
    args: Mapping[str, str],
    environ: Mapping[str, str],
    *,
    taken: Iterable[str] = (),
    cwd: Path | None = None,
    results: Path | None = None,
    mistakes: Mistakes | None = None,
    with_compiled: bool = False,
) -> LaunchPlan:
    """Plan the applications of a launch file.

    Args:
        file: the launch file.
        args: values of its arguments.
        environ: the environment: for substitutions, for ROS_PACKAGE_PATH, and for the nodes.
        taken: names of existing applications.
        cwd: folder in which the launch is started; the meaning of cwd="cwd".
        results: folder for the results of tests.
        mistakes: receives errors; None raises the first error, as roslaunch does.
        with_compiled: plan nodes in C++ whose sources are here, too.

    Returns:
        The plan.

    Raises:
        UsageError: the file is wrong, or a required node cannot run here.
    """
    environ = {**ROS_ENVIRONMENT, **environ}
    packages = Packages(file, environ)
    mistakes = FirstMistake() if mistakes is None else mistakes
    planner = Planner(packages, environ, taken, cwd or file.parent, results, with_compiled)
    return planner.plan(read(file, args, packages, environ, mistakes), mistakes)


def node_file(package: str, node_type: str, near: Path, environ: Mapping[str, str]) -> Path:
    """Find the script of a node, as rosrun does.

    Args:
        package: its package.
        node_type: the file's name.
        near: a file; packages near it take precedence.
        environ: environment with ROS_PACKAGE_PATH.

    Raises:
        UsageError: there is no such script.
    """
    try:
        return find_script(packages_near(near, environ, package), package, node_type)
    except ScriptError as error:
        raise UsageError(str(error), field=f"{package} {node_type}") from None


def node_in_cpp(
    package: str, node_type: str, near: Path, environ: Mapping[str, str], words: Sequence[str]
) -> CppNode | None:
    """Find a node in C++, as rosrun does; None if it is a script or its sources are missing.

    Args:
        package: its package.
        node_type: the program's name.
        near: a file; packages near it take precedence.
        environ: environment of the node.
        words: its arguments, including remaps and __name.
    """
    packages = packages_near(near, environ, package)
    try:
        find_script(packages, package, node_type)
    except ScriptError:
        folders = compiled_folders(packages, package, node_type)
        if not folders:
            return None
        said = dict(word.split(":=", 1) for word in words if ":=" in word)
        namespace = said.pop("__ns", environ.get("ROS_NAMESPACE", SEP))
        app = app_name(node_type)
        return CppNode(
            app,
            package,
            node_type,
            folders,
            folders[0] / "CMakeLists.txt",
            said.pop("__name", ""),
            SEP + namespace.strip(SEP),
            tuple(word for word in words if ":=" not in word or _is_private(word)),
            tuple((name, value) for name, value in said.items() if not name.startswith("_")),
            environ,
            required=True,
        )
    return None


def _is_private(word: str) -> bool:
    """Return True if a word of a command line sets a private parameter, which a node in C++ does itself (ros::init)."""
    return word.startswith("_") and not word.startswith("__")


def launch_file(package: str, name: str, near: Path, environ: Mapping[str, str]) -> Path:
    """Find a launch file by its package, as roslaunch does.

    Args:
        package: its package.
        name: name of the file.
        near: a file; packages near it take precedence.
        environ: environment with ROS_PACKAGE_PATH.

    Raises:
        UsageError: there is no such file.
    """
    packages = packages_near(near, environ, package)
    file = find_file(packages, package, name)
    if file is None and packages.folders(package):
        hint = did_you_mean(name, _launch_files(packages.folders(package)), before="; ")
        raise UsageError(f"package {package!r} has no file {name!r}{hint}", field=f"{package} {name}")
    if file is None:
        otherwise = "go into its workspace, or put it on ROS_PACKAGE_PATH"
        hint = did_you_mean(package, packages.names(), otherwise, before="; ")
        raise UsageError(f"unknown package {package!r}{hint}", field=f"{package} {name}")
    return file


def _launch_files(folders: list[Path]) -> list[str]:
    """Return the names of the launch files in a package's folders."""
    return sorted({file.name for folder in folders for file in folder.rglob("*.launch")})


def packages_near(near: Path, environ: Mapping[str, str], package: str | None = None) -> Packages:
    """Return the packages visible from a folder; if `package` is not near, the catkin workspace counts, too.

    Args:
        near: a file; packages near it take precedence.
        environ: environment with ROS_PACKAGE_PATH.
        package: the package to find; None is all.
    """
    packages = Packages(near, environ)
    if package is not None and packages.folders(package):
        return packages
    return Packages(near, {**environ, "ROS_PACKAGE_PATH": with_workspace(environ.get("ROS_PACKAGE_PATH", ""), near)})


def with_workspace(package_path: str, near: Path) -> str:
    """Return a ROS_PACKAGE_PATH with the sources of the catkin workspace that a file is in, or that is beside it."""
    sources = [near.parent / "src", *(folder for folder in near.parents if folder.name == "src")]
    return os.pathsep.join([package_path, *(str(source) for source in sources[:2] if os.path.isdir(source))])


def node_environment(environ: Mapping[str, str], namespace: str = SEP) -> dict[str, str]:
    """Return the environment of a node that a user starts: the user's, without the network of another ROS."""
    kept = {name: value for name, value in (ROS_ENVIRONMENT | dict(environ)).items() if name not in _NOT_OURS}
    return {**kept, "ROS_NAMESPACE": namespace.rstrip(SEP)} if namespace != SEP else kept


def _displaces(test: LaunchTest, former: LaunchNode) -> LaunchRemark:
    """Return a remark about a node that ROS's master shuts down when a test with its name starts."""
    name = former.full_name
    text = (
        f"test {test.test_name} runs as node {name}, so it shuts down the node {name} of line {former.line} "
        f'(type {former.type}); give the test another name: name="{name.rpartition(SEP)[2]}_test"'
    )
    return LaunchRemark(text, test.node.file, test.node.line, before_runs=False)


class Planner:
    """Makes applications of nodes.

    Args:
        packages: packages with their scripts.
        environ: the environment of nodes.
        taken: names of existing applications.
        cwd: the meaning of cwd="cwd".
        results: folder for the results of tests.
        with_compiled: plan nodes in C++ whose sources are here, too.
    """

    def __init__(
        self,
        packages: Packages,
        environ: Mapping[str, str],
        taken: Iterable[str],
        cwd: Path,
        results: Path | None = None,
        with_compiled: bool = False,
    ) -> None:
        self._with_compiled = with_compiled
        self._results = results or cwd
        self._packages = packages
        self._environ = environ
        self._taken = set(taken)
        self._cwd = cwd

    def plan(self, launch: Launch, mistakes: Mistakes) -> LaunchPlan:
        """Plan everything in a launch file; see `plan_of`.

        Args:
            launch: the contents of the file.
            mistakes: receives errors, such as a required node that cannot run here.
        """
        remarks = launch.remarks
        plan = LaunchPlan(params=_tree(launch), files=launch.files, remarks=remarks)
        for node in launch.nodes:
            config = mistakes.attempt(partial(self._config_or_remark, node, remarks))
            if isinstance(config, CppNode):
                plan.compiled[config.app] = config
            elif config is not None:
                plan.nodes[config.app] = config
        tests = [(test, mistakes.attempt(partial(self._test, test, remarks))) for test in launch.tests]
        nodes = {node.full_name: node for node in launch.nodes}
        for test, planned in tests:
            former = nodes.get(test.node.full_name)
            displaces = None if former is None else _displaces(test, former)
            remarks += [] if displaces is None else [displaces]
            plan.tests += [] if planned is None else [replace(planned, displaces=displaces)]
        return plan

    def _config_or_remark(self, node: LaunchNode, remarks: list[LaunchRemark]) -> NodeConfig | CppNode | None:
        try:
            return self.config(node)
        except ScriptError as error:
            nodelet = self._nodelet(node, remarks) if self._with_compiled else None
            if nodelet is not None:
                return nodelet[0]
            folders = compiled_folders(self._packages, node.package, node.type) if self._with_compiled else ()
            if folders:
                return self._compiled(node, folders)
            if node.required:
                raise _failure(node, f"{node.full_name} is required, but {error}") from None
            text = f"node {node.full_name} is left out: {error}"
            remarks.append(LaunchRemark(text, node.file, node.line, is_error=not error.is_there))
            return None

    def _test(self, test: LaunchTest, remarks: list[LaunchRemark]) -> PlannedTest:
        """Plan a test; it gets the file for its results, and its end ends its run."""
        node, name, limit = test.node, test.test_name, round(test.time_limit * NS_PER_S)
        results = self._results / _results_file(f"{node.package}-{name}")
        planned = PlannedTest(node.package, name, None, limit, test.retry, results, node.file, node.line)
        try:
            config = self.config(replace(node, required=True), (f"--gtest_output=xml:{results}",))
        except ScriptError as error:
            folders = compiled_folders(self._packages, node.package, node.type) if self._with_compiled else ()
            if folders:
                program = self._compiled(replace(node, required=True), folders)
                return replace(planned, compiled=program)
            why = str(error)
            text = f"test {name} cannot run here: {why}"
            remarks.append(LaunchRemark(text, node.file, node.line, not error.is_there, before_runs=False))
            return replace(planned, problem=why)
        return replace(planned, node=config)

    def config(self, node: LaunchNode, more_args: tuple[str, ...] = ()) -> NodeConfig:
        """Make the application of one node; `more_args` follow its own arguments.

        Raises:
            ScriptError: it cannot run here.
            UsageError: its arguments are not well quoted.
        """
        script = find_script(self._packages, node.package, node.type)
        return NodeConfig(
            self._app_name(node),
            name=node.full_name.lstrip(SEP),
            args=self._arguments(node, more_args),
            env={**node_environment(self._environ, node.namespace), **node.env},
            script=script,
            cwd=self._folder(node),
            respawn=node.respawn,
            respawn_delay_ns=round(node.respawn_delay * NS_PER_S),
            required=node.required,
            near=node.file if script.is_relative_to(_TOOLS) else None,  # a tool needs the types of the file's packages
        )

    def _nodelet(self, node: LaunchNode, remarks: list[LaunchRemark]) -> tuple[CppNode | None] | None:
        """Make the application of a nodelet, none for a manager, which is not needed; None if the node is not a
        nodelet.
        """
        if (node.package, node.type) != ("nodelet", "nodelet"):
            return None
        match _words(node):
            case ["manager", *_]:
                text = f"node {node.full_name} is left out: each nodelet is an application, which needs no manager"
                remarks.append(LaunchRemark(text, node.file, node.line, before_runs=False))
                return (None,)
            case ["standalone", name, *rest] | ["load", name, _, *rest]:
                package = self._package_of_nodelet(name)
                folders = (each for each in self._packages.folders(package) if os.path.isfile(each / "CMakeLists.txt"))
                found = tuple(folders)
                plain = replace(node, package=package, type=name, args=shlex.join(rest))
                return (self._compiled(plain, found),) if found else None
        return None

    def _package_of_nodelet(self, name: str) -> str:
        """Return the package that offers a nodelet; by convention, not by rule, its name precedes the slash."""
        package = name.partition(SEP)[0]
        if self._packages.folders(package):
            return package
        near = self._packages.names()
        return next((each for each in near if _offers(self._packages.folders(each)[0], name)), package)

    def _compiled(self, node: LaunchNode, folders: tuple[Path, ...]) -> CppNode:
        """Make the application of a node in C++; remaps among its arguments count as remaps."""
        words = _words(node)
        remaps = [tuple(word.split(":=", 1)) for word in words if ":=" in word and word[0] != "_"]
        return CppNode(
            self._app_name(node),
            node.package,
            node.type,
            folders,
            node.file,
            node.name,
            node.namespace.rstrip(SEP) or SEP,
            tuple(word for word in words if ":=" not in word or _is_private(word)),
            (*node.remaps, *((one, other) for one, other in remaps)),
            {**self._environ, **node.env},
            node.required,
            node.line,
            node.respawn,
            round(node.respawn_delay * NS_PER_S),
        )

    def _arguments(self, node: LaunchNode, more_args: tuple[str, ...]) -> tuple[str, ...]:
        """Return the command line in roslaunch's order."""
        words = _words(node)
        remaps = [f"{source}:={target}" for source, target in node.remaps]
        return (*words, *more_args, *remaps, f"__name:={node.name}")

    def _folder(self, node: LaunchNode) -> Path | None:
        if node.cwd == "ROS_HOME":
            return Path(self._environ.get("ROS_HOME") or os.path.join(self._environ.get("HOME", SEP), ".ros"))
        return self._cwd if node.cwd == "cwd" else None

    def _app_name(self, node: LaunchNode) -> str:
        """Return a unique name for the application."""
        name = app_name(node.full_name.strip(SEP), self._taken)
        self._taken.add(name)
        return name


def _words(node: LaunchNode) -> list[str]:
    """Return a node's own arguments."""
    try:
        return shlex.split(node.args)
    except ValueError as error:
        raise _failure(node, f"args={node.args!r}: {error}") from None


def _failure(node: LaunchNode, text: str) -> UsageError:
    return UsageError(text, file=node.file, line=node.line, field="<node>")


def _tree(launch: Launch) -> dict[str, Any]:
    """Return parameters by name as a tree; a later one replaces conflicting ones."""
    root: dict[str, Any] = {}
    for name, value in {**ROSCORE_PARAMS, **launch.params}.items():
        if value is None:
            text = f"parameter {name} is left out: it has no value (null)"
            launch.remarks.append(LaunchRemark(text, *launch.places[name]))
            continue
        *path, last = [part for part in name.split(SEP) if part]
        place = root
        for part in path:
            if not isinstance(place.get(part), dict):
                place[part] = {}
            place = place[part]
        place[last] = value
    return root
