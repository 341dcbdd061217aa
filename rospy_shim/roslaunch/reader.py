"""Reading launch files: the tags, and the order in which everything counts.

Here are <launch>, <group>, <include>, <arg>, <node> and <test>, and the tags inside these two: <remap>, <env>, <param>,
<rosparam>. `rospy_shim.roslaunch.param_tags` reads parameters. The first error is raised, or all are kept, with the
same code. An error that follows from another one is not reported.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import partial
from pathlib import Path

from cfepy.reading.input_files import open_input
from cfepy.reading.input_limits import LAUNCH_INCLUDES_DEEP, LAUNCH_NAME, LAUNCH_WORK
from cfepy.reading.mistakes import FirstMistake, Mistakes
from cfepy.reading.suggestions import did_you_mean, expected
from cfepy.status import UsageError
from rospy_shim.roslaunch.document import Attributes, Tag, read_launch_tag, unused_arguments
from rospy_shim.roslaunch.model import (
    DEFAULT_TIME_LIMIT_S,
    Launch,
    LaunchFindings,
    LaunchNode,
    LaunchRemark,
    LaunchTest,
)
from rospy_shim.roslaunch.param_tags import STOOD_IN, add_param, read_param, read_rosparam
from rospy_shim.roslaunch.scope import Scope, as_namespace, joined
from rospy_shim.roslaunch.substitution import UNKNOWN, World
from rospy_shim.types.msgs import Packages
from rospy_shim.types.names import PRIV_NAME, is_legal_name

# fmt: off
NODE = (
    "pkg", "type", "machine", "name", "args", "output", "respawn", "respawn_delay", "cwd", "ns", "clear_params",
    "launch-prefix", "required",
)
# fmt: on
TEST = (*NODE, "test-name", "time-limit", "retry")
REMAP = ("from", "to")
ENV = ("name", "value")
_NOT_FOR_TESTS = ("respawn", "respawn_delay", "output")
_WORDS = {"output": ("screen", "log"), "cwd": ("node", "cwd", "ROS_HOME", "ros-root")}
_IN_NODES = ("remap", "env", "param", "rosparam")
_IGNORED = {
    "machine": "everything runs on the one simulated computer",
    "launch-prefix": "no process is started that a debugger or a terminal could be put around",
}
ARG = ("name", "value", "default", "doc")
GROUP = ("ns", "clear_params")
INCLUDE = ("file", "ns", "clear_params", "pass_all_args")
_TAG, _FILE = 5, 500  # size of a tag and of a file without its contents: about their shares of the time
_TOO_MUCH = (
    "is where the launch becomes too large: the tags that were read until here, each counted with the arguments,"
    f" variables and remappings that hold there, are more than {LAUNCH_WORK:,}; include fewer files, or fewer times"
)
_TOO_LONG = f"makes a name of more than {LAUNCH_NAME:,} characters; write a shorter one"


def namespace_of(attributes: Attributes, scope: Scope) -> str | None:
    """Return the attribute `ns` of a tag; None if it is missing, or invalid: empty, private or too long."""
    namespace = attributes.optional("ns")
    if namespace is not None and len(scope.namespace) + len(namespace) > LAUNCH_NAME:
        attributes.wrong(_TOO_LONG, "ns")
        return None
    if namespace is None or (namespace and not namespace.startswith(PRIV_NAME)):
        return namespace
    attributes.wrong(f"invalid namespace {namespace!r}; expected a name such as arm", "ns")
    return None


def read_remap(tag: Tag, scope: Scope) -> None:
    """Read a <remap> tag."""
    attributes = Attributes(tag, scope)
    attributes.tell_unknown(REMAP)
    source, target = attributes.required("from"), attributes.required("to")
    if source is None or target is None:
        return
    try:
        scope.add_remap(source, target)
    except ValueError as error:
        attributes.wrong(str(error))


def read_env(tag: Tag, scope: Scope) -> None:
    """Read an <env> tag."""
    attributes = Attributes(tag, scope)
    attributes.tell_unknown(ENV)
    name, value = attributes.required("name"), attributes.required("value")
    if name == "":
        attributes.wrong("must not be empty; write the name of a variable", "name")
    if name and value is not None:
        scope.env[name] = value


def read_test(launch: Launch, tag: Tag, scope: Scope) -> None:
    """Read a <test> tag."""
    attributes = Attributes(tag, scope)
    attributes.tell_unknown(TEST)
    for name in _NOT_FOR_TESTS:
        if name in tag.attributes:
            attributes.wrong("unknown attribute of <test>; remove it", name)
    test_name = attributes.required("test-name")
    limit = attributes.number("time-limit", 0.0) if tag.attributes.get("time-limit") else DEFAULT_TIME_LIMIT_S
    if limit == 0:
        attributes.wrong("must be greater than 0 s", "time-limit")
    retry = attributes.number("retry", 0) if tag.attributes.get("retry") else 0
    node = _node(launch, attributes, scope, attributes.optional("name") or test_name)
    if node is not None and test_name is not None:
        launch.tests.append(LaunchTest(test_name, node, limit or DEFAULT_TIME_LIMIT_S, int(retry or 0)))


def read_node(launch: Launch, tag: Tag, scope: Scope) -> None:
    """Read a <node> tag."""
    attributes = Attributes(tag, scope)
    attributes.tell_unknown(NODE)
    node = _node(launch, attributes, scope, attributes.required("name"))
    if node is not None:
        launch.nodes.append(node)


def _node(launch: Launch, attributes: Attributes, scope: Scope, name: str | None) -> LaunchNode | None:
    """Read a node and its contents; None if its type or its name is not known."""
    tag = attributes.tag
    if name is not None and (not name.strip() or "/" in name):
        attributes.wrong(
            f"invalid node name {name!r}; write a name without a namespace, and ns= for the namespace", "name"
        )
        name = None
    elif name is not None and not is_legal_name(name):
        attributes.remark(f"{name!r} is not a legal name of a node")
    if name is not None and len(scope.namespace) + len(name) > LAUNCH_NAME:
        attributes.wrong(_TOO_LONG, "name")
        name = None
    before = attributes.failed
    namespace = as_namespace(joined(scope.namespace, namespace_of(attributes, scope) or ""))
    place = None if name is None or (attributes.failed and not before) else namespace + name
    _take_clear_params(attributes)
    inner = scope.inside()
    _read_children(launch, tag, inner, scope.inside(place or namespace))
    _tell_ignored(attributes)
    for param, value in inner.params.items():
        add_param(launch, f"{place or namespace}/{param.removeprefix(PRIV_NAME)}", value, attributes)
    node = _record(attributes, inner, name or "", namespace)
    return None if place is None else node


def _read_children(launch: Launch, tag: Tag, inner: Scope, params: Scope) -> None:
    """Read the tags inside a node; remappings and variables go to `inner`, and so do parameters that `params`
    collects.
    """
    params.params.clear()
    for child in tag.children:
        attributes = Attributes(child, params)
        kind = child.name.lower()
        if kind not in _IN_NODES:
            hint = did_you_mean(kind, _IN_NODES, before=", ", form="<{}>")
            attributes.remark(f"<{child.name}> is not valid in <{tag.name}>; it is ignored{hint}", is_error=True)
        elif not attributes.counts():
            continue
        elif kind == "remap":
            read_remap(child, inner)
        elif kind == "env":
            read_env(child, inner)
        elif kind == "param":
            read_param(launch, child, params, of_node=True)
        else:
            read_rosparam(launch, child, params)
    for name, value in params.params.items():
        inner.set_param(name, value)


def _take_clear_params(attributes: Attributes) -> None:
    """Check `clear_params`; a launch begins without parameters, so there is nothing to clear."""
    if attributes.tag.attributes.get("clear_params"):
        attributes.flag("clear_params")


def _tell_ignored(attributes: Attributes) -> None:
    for name, why in _IGNORED.items():
        if attributes.optional(name):
            attributes.remark(f"{name}={attributes.tag.attributes[name]!r} is ignored: {why}")


def _record(attributes: Attributes, inner: Scope, name: str, namespace: str) -> LaunchNode | None:
    tag = attributes.tag
    package, node_type = attributes.required("pkg"), attributes.required("type")
    for field, value in (("pkg", package), ("type", node_type)):
        if value is not None and not value.strip():
            attributes.wrong("must not be empty; write the package and the type of the node", field)
    respawn, required = attributes.flag("respawn"), attributes.flag("required")
    if respawn and required:
        attributes.wrong("respawn cannot be combined with required, because the end of a required node ends the run")
    words = {field: _word(attributes, field) for field in _WORDS}
    args, delay = attributes.optional("args"), attributes.number("respawn_delay", 0.0)
    if not (package or "").strip() or not (node_type or "").strip():
        return None
    return LaunchNode(
        package=package or "",
        type=node_type or "",
        name=name,
        namespace=namespace,
        args=args or "",
        remaps=tuple(inner.remaps().items()),
        env=dict(inner.env),
        output=words["output"],
        cwd=words["cwd"],
        respawn=respawn,
        respawn_delay=delay or 0.0,
        required=required,
        file=tag.file,
        line=tag.line,
    )


def _word(attributes: Attributes, name: str) -> str | None:
    value = attributes.optional(name)
    if value and value not in _WORDS[name]:
        attributes.wrong(f"invalid value {value!r}; {expected(value, _WORDS[name])}", name)
    return value or None


def read(
    file: Path,
    args: Mapping[str, str],
    packages: Packages,
    environ: Mapping[str, str],
    mistakes: Mistakes | None = None,
) -> Launch:
    """Read a launch file with everything that it includes.

    Args:
        file: the launch file.
        args: values of its arguments, `name:=value` on roslaunch's command line.
        packages: the packages for $(find).
        environ: the environment for $(env) and $(optenv); ROS_NAMESPACE is the namespace of all.
        mistakes: receives errors; None raises the first error, as roslaunch does.

    Returns:
        The contents.

    Raises:
        UsageError: it cannot be read, or has an error.
    """
    return _Reader(packages, environ, LaunchFindings(FirstMistake() if mistakes is None else mistakes)).read(file, args)


class _Reader:
    """Reads one launch file; see `read`."""

    def __init__(self, packages: Packages, environ: Mapping[str, str], findings: LaunchFindings) -> None:
        self._environ = environ
        self._world = World(
            environ, lambda name: packages.path(name) or STOOD_IN.get(name), self._anonymous, [0], packages.names
        )
        self._names_made = 0
        self._depth = 0
        self._too_deep = self._too_much = False
        self._findings = findings
        self._launch = Launch(remarks=findings.remarks)
        self._tags: dict[str, Callable[[Tag, Scope], None]] = {
            "arg": self._arg,
            "env": read_env,
            "group": self._group,
            "include": self._include,
            "machine": self._ignored,
            "master": self._ignored,
            "node": partial(read_node, self._launch),
            "param": partial(read_param, self._launch),
            "remap": read_remap,
            "rosparam": partial(read_rosparam, self._launch),
            "test": partial(read_test, self._launch),
        }

    def read(self, file: Path, args: Mapping[str, str]) -> Launch:
        """Read the file; see the function `read`."""
        namespace = as_namespace(self._environ.get("ROS_NAMESPACE", "/"))
        scope = Scope(self._world, file, namespace, dict(args), self._findings)
        is_read = self._read_file(file, scope)
        for name in args if is_read else ():
            if name not in scope.declared:
                hint = did_you_mean(name, scope.declared, before=", ")
                text = f"unknown argument {name!r}; {name}:={args[name]} is ignored{hint}"
                self._launch.remarks.append(LaunchRemark(text, file, 0))
        for error in _names_twice(self._launch.nodes):
            self._findings.mistakes.add(error)
        return self._launch

    def _anonymous(self, name: str) -> str:
        """Return a name that is unique among the $(anon) names of this launch, the same in every run."""
        self._names_made += 1
        return f"{name}_cfepy_{self._names_made}"

    def _read_file(self, file: Path, scope: Scope) -> bool:
        """Read a file. Returns False if it cannot be read."""
        self._findings.work += _FILE
        tag = self._findings.mistakes.attempt(partial(read_launch_tag, file))
        if tag is None:
            return False
        if file not in self._launch.files:
            for arg in unused_arguments(tag):
                text = f"unused argument {arg.attributes['name']!r}; remove it, or use $(arg ...)"
                self._launch.remarks.append(arg.remark(text, before_runs=False))
        self._launch.files.append(file)
        if Attributes(tag, scope).counts() and tag.attributes.get("deprecated"):
            self._launch.remarks.append(LaunchRemark(f"deprecated: {tag.attributes['deprecated']}", file, 0))
        self._read_all(tag.children, scope)
        return True

    def _read_all(self, tags: Iterable[Tag], scope: Scope) -> None:
        for tag in tags:
            self._findings.work += _TAG + scope.size
            if self._findings.work > LAUNCH_WORK:
                if not self._too_much:
                    self._too_much = True
                    self._findings.mistakes.add(tag.fail(_TOO_MUCH))
                return
            read_tag, attributes = self._tags.get(tag.name), Attributes(tag, scope)
            if read_tag is None:
                hint = did_you_mean(tag.name, self._tags, before=", ", form="<{}>")
                attributes.remark(f"unknown tag <{tag.name}>; it is ignored{hint}", is_error=True)
            elif attributes.counts():
                read_tag(tag, scope)
            elif attributes.failed and tag.name == "arg":
                scope.args.setdefault(tag.attributes.get("name", ""), UNKNOWN)

    # -- tags --------------------------------------------------------------------------------------------------------

    def _ignored(self, tag: Tag, scope: Scope) -> None:
        text = "everything runs on the one simulated computer"
        Attributes(tag, scope).remark(f"<{tag.name}> is ignored: {text}")

    def _arg(self, tag: Tag, scope: Scope, seen_from: Scope | None = None) -> None:
        """Read an <arg> tag; inside an <include> its values are resolved in the including file."""
        attributes = Attributes(tag, seen_from or scope)
        attributes.tell_unknown(ARG)
        name = attributes.required("name")
        value, default = (
            UNKNOWN if each in tag.attributes and text is None else text
            for each in ("value", "default")
            for text in [attributes.optional(each)]
        )
        if name is None:
            return
        if value is not None and default is not None:
            attributes.wrong(f"value cannot be combined with default in {name}; leave one of them out")
            default = None
        try:
            scope.declare_arg(name, value, default)
        except ValueError as error:
            attributes.wrong(str(error))

    def _group(self, tag: Tag, scope: Scope) -> None:
        attributes = Attributes(tag, scope)
        attributes.tell_unknown(GROUP)
        namespace = namespace_of(attributes, scope)
        self._check_clear_params(attributes, namespace)
        self._read_all(tag.children, scope.inside(namespace))

    def _check_clear_params(self, attributes: Attributes, namespace: str | None) -> None:
        """Check that `clear_params` is valid. It has no effect: there is nothing to clear at the start of a run."""
        wanted = bool(attributes.tag.attributes.get("clear_params")) and attributes.flag("clear_params")
        if wanted and namespace is None and not attributes.failed:
            attributes.wrong("requires ns=, the namespace to clear", "clear_params")

    def _include(self, tag: Tag, scope: Scope) -> None:
        attributes = Attributes(tag, scope)
        attributes.tell_unknown(INCLUDE)
        name = attributes.required("file")
        passes_all, namespace = attributes.flag("pass_all_args"), namespace_of(attributes, scope)
        self._check_clear_params(attributes, namespace)
        if self._too_deep:  # a file that includes itself twice would not come to an end
            return
        if self._depth == LAUNCH_INCLUDES_DEEP:
            self._too_deep = True
            attributes.wrong(
                f"is nested {LAUNCH_INCLUDES_DEEP} includes deep; check for a file that includes itself", "file"
            )
            return
        file = Path(name or "")
        inner = scope.of_included(file, namespace, dict(scope.args) if passes_all else {})
        inner.included_at = f"{tag.file}:{tag.line}"
        inner.takes_all_args = passes_all
        inner.declared = list(inner.args)
        self._pass_args(tag, scope, inner)
        passed, inner.declared = list(inner.args), []
        if name is None or not self._read_included(attributes, file, inner) or passes_all:
            return
        unused = [name for name in passed if name not in inner.declared]
        if unused:
            hint = "".join(did_you_mean(name, inner.declared, before=", ") for name in unused)
            attributes.wrong(f"passes {', '.join(unused)}, which {file} does not declare; remove it{hint}", "file")

    def _pass_args(self, tag: Tag, scope: Scope, inner: Scope) -> None:
        """Read the tags inside an <include>."""
        for child in tag.children:
            attributes, kind = Attributes(child, scope), child.name.lower()
            if kind not in ("arg", "env"):
                attributes.remark(f"<{child.name}> is not valid in <include>; it is ignored", is_error=True)
            elif not attributes.counts():
                continue
            elif kind == "env":
                outer = scope.inside()
                read_env(child, outer)
                inner.env.update(outer.env)
            else:
                self._arg(child, inner, scope)
                name = child.attributes.get("name")
                if name is not None and attributes.resolved(name) not in (None, *inner.args):
                    attributes.wrong("missing value to pass; write value=")

    def _read_included(self, attributes: Attributes, file: Path, inner: Scope) -> bool:
        """Read an included file. Returns False if it cannot be read."""
        try:
            open_input(file).close()
        except OSError as error:
            attributes.wrong(f"{file} cannot be read: {error.strerror}", "file")
            return False
        except UsageError as error:
            attributes.wrong(f"{file} {error.text}", "file")
            return False
        self._depth += 1
        is_read = self._read_file(file, inner)
        self._depth -= 1
        return is_read


def _names_twice(nodes: list[LaunchNode]) -> Iterable[UsageError]:
    """Yield an error for each node whose name is taken."""
    seen: dict[str, LaunchNode] = {}
    for node in nodes:
        other = seen.setdefault(node.full_name, node)
        if other is not node:
            text = f"{node.full_name} is also the name of the node at {other.file}:{other.line}; change one of them"
            yield UsageError(text, file=node.file, line=node.line, field="<node name>")
