"""Reading launch files: <launch>, <group>, <include>, <arg>, and the order in which everything counts.

May import cfepy.status.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from pathlib import Path

from cfepy.status import UsageError
from rospy_shim.msgs import Packages
from rospy_shim.roslaunch import node_tags, param_tags
from rospy_shim.roslaunch.attributes import Attributes
from rospy_shim.roslaunch.commands import STOOD_IN
from rospy_shim.roslaunch.document import Tag, read_launch_tag
from rospy_shim.roslaunch.model import Launch, LaunchNode
from rospy_shim.roslaunch.names import as_namespace
from rospy_shim.roslaunch.scope import Scope
from rospy_shim.roslaunch.substitution import World

ARG = ("name", "value", "default", "doc")
GROUP = ("ns", "clear_params")
INCLUDE = ("file", "ns", "clear_params", "pass_all_args")
DEEPEST = 64  # includes in each other; a file that includes itself would go on for ever


def read(file: Path, args: Mapping[str, str], packages: Packages, environ: Mapping[str, str]) -> Launch:
    """Read a launch file with everything that it includes.

    Args:
        file: the launch file.
        args: values of its arguments, `name:=value` on roslaunch's command line.
        packages: where $(find) looks.
        environ: what $(env) and $(optenv) look at; ROS_NAMESPACE is the namespace of all.

    Raises:
        UsageError: it cannot be read, or something in it is wrong.
    """
    return _Reader(packages, environ).read(file, args)


class _Reader:
    """Reads one launch file; see `read`."""

    def __init__(self, packages: Packages, environ: Mapping[str, str]) -> None:
        self._environ = environ
        self._world = World(environ, lambda name: packages.path(name) or STOOD_IN.get(name), self._anonymous)
        self._names_made = 0
        self._depth = 0
        self._launch = Launch()
        self._tags: dict[str, Callable[[Tag, Scope], None]] = {
            "arg": self._arg,
            "env": lambda tag, scope: node_tags.read_env(self._launch, tag, scope),
            "group": self._group,
            "include": self._include,
            "machine": self._ignored,
            "master": self._ignored,
            "node": lambda tag, scope: node_tags.read_node(self._launch, tag, scope),
            "param": self._param,
            "remap": lambda tag, scope: node_tags.read_remap(self._launch, tag, scope),
            "rosparam": self._rosparam,
            "test": lambda tag, scope: node_tags.read_test(self._launch, tag, scope),
        }

    def read(self, file: Path, args: Mapping[str, str]) -> Launch:
        """See the function `read`."""
        namespace = as_namespace(self._environ.get("ROS_NAMESPACE", "/"))
        scope = Scope(self._world, file, namespace, dict(args))
        self._read_file(file, scope)
        for name in args:
            if name not in scope.declared:
                self._launch.notes.append(f"{file}: has no argument {name!r}; {name}:={args[name]} is ignored")
        _check_names(self._launch.nodes)
        return self._launch

    def _anonymous(self, name: str) -> str:
        """A name that no other $(anon) of this launch makes, the same in every run."""
        self._names_made += 1
        return f"{name}_cfepy_{self._names_made}"

    def _read_file(self, file: Path, scope: Scope) -> None:
        tag = read_launch_tag(file)
        self._launch.files.append(file)
        if Attributes(tag, scope).counts() and tag.attributes.get("deprecated"):
            self._launch.notes.append(f"{file}: deprecated: {tag.attributes['deprecated']}")
        self._read_all(tag.children, scope)

    def _read_all(self, tags: Iterable[Tag], scope: Scope) -> None:
        for tag in tags:
            read_tag = self._tags.get(tag.name)
            if read_tag is None:
                self._launch.notes.append(f"{tag.file}:{tag.line}: <{tag.name}> is not known; it is ignored")
            elif Attributes(tag, scope).counts():
                read_tag(tag, scope)

    # -- tags --------------------------------------------------------------------------------------------------------

    def _ignored(self, tag: Tag, scope: Scope) -> None:
        text = "everything runs on the one simulated computer"
        self._launch.notes.append(f"{tag.file}:{tag.line}: <{tag.name}> is ignored: {text}")

    def _param(self, tag: Tag, scope: Scope) -> None:
        node_tags.tell_unknown(self._launch, Attributes(tag, scope), param_tags.PARAM)
        param_tags.read_param(self._launch, tag, scope)

    def _rosparam(self, tag: Tag, scope: Scope) -> None:
        node_tags.tell_unknown(self._launch, Attributes(tag, scope), param_tags.ROSPARAM)
        param_tags.read_rosparam(self._launch, tag, scope)

    def _arg(self, tag: Tag, scope: Scope, seen_from: Scope | None = None) -> None:
        """An <arg> tag; inside an <include> its values are seen from the file that includes."""
        attributes = Attributes(tag, seen_from or scope)
        node_tags.tell_unknown(self._launch, attributes, ARG)
        name, value, default = (
            attributes.required("name"),
            attributes.optional("value"),
            attributes.optional("default"),
        )
        if value is not None and default is not None:
            raise tag.fail(f"{name} has both a value and a default; leave one of them out")
        try:
            scope.declare_arg(name, value, default)
        except ValueError as error:
            raise tag.fail(str(error)) from None

    def _group(self, tag: Tag, scope: Scope) -> None:
        attributes = Attributes(tag, scope)
        node_tags.tell_unknown(self._launch, attributes, GROUP)
        namespace = node_tags.namespace_of(attributes)
        self._check_clear_params(attributes, namespace)
        self._read_all(tag.children, scope.inside(namespace))

    def _check_clear_params(self, attributes: Attributes, namespace: str | None) -> None:
        """There is nothing to clear at the start of a run, but what is written must make sense."""
        wanted = bool(attributes.tag.attributes.get("clear_params")) and attributes.flag("clear_params")
        if wanted and namespace is None:
            raise attributes.tag.fail("needs a namespace to clear; write ns= too", "clear_params")

    def _include(self, tag: Tag, scope: Scope) -> None:
        attributes = Attributes(tag, scope)
        node_tags.tell_unknown(self._launch, attributes, INCLUDE)
        file = Path(attributes.required("file"))
        passes_all, namespace = attributes.flag("pass_all_args"), node_tags.namespace_of(attributes)
        self._check_clear_params(attributes, namespace)
        if self._depth == DEEPEST:
            raise tag.fail(f"is the {DEEPEST}th include inside another; does a file include itself?", "file")
        inner = scope.of_included(file, namespace, dict(scope.args) if passes_all else {})
        inner.takes_all_args = passes_all
        inner.declared = list(inner.args)
        self._pass_args(tag, scope, inner)
        passed, inner.declared = list(inner.args), []
        self._read_included(tag, file, inner)
        unused = [name for name in passed if name not in inner.declared]
        if unused and not passes_all:
            raise tag.fail(f"passes {', '.join(unused)}, which {file} does not declare; remove it", "file")

    def _pass_args(self, tag: Tag, scope: Scope, inner: Scope) -> None:
        """The tags inside an <include>."""
        for child in tag.children:
            kind = child.name.lower()
            if kind not in ("arg", "env"):
                where = f"{child.file}:{child.line}"
                self._launch.notes.append(f"{where}: <{child.name}> means nothing in <include>; it is ignored")
            elif not Attributes(child, scope).counts():
                continue
            elif kind == "env":
                outer = scope.inside()
                node_tags.read_env(self._launch, child, outer)
                inner.env.update(outer.env)
            else:
                self._arg(child, inner, scope)
                if Attributes(child, scope).required("name") not in inner.args:
                    raise child.fail("needs a value to pass; write value=")

    def _read_included(self, tag: Tag, file: Path, inner: Scope) -> None:
        self._depth += 1
        try:
            self._read_file(file, inner)
        except UsageError as error:
            if error.file == str(file) and error.line is None:  # the file itself cannot be read: say who wants it
                raise tag.fail(f"{file} {error.text}", "file") from None
            raise
        self._depth -= 1


def _check_names(nodes: list[LaunchNode]) -> None:
    """No two nodes may have one name.

    Raises:
        UsageError: two have.
    """
    seen: dict[str, LaunchNode] = {}
    for node in nodes:
        other = seen.setdefault(node.full_name, node)
        if other is not node:
            text = f"{node.full_name} is also the name of the node at {other.file}:{other.line}; change one of them"
            raise UsageError(text, file=node.file, line=node.line, field="<node name>")
