"""<node> and <test>, and what stands inside them: <remap>, <env>, <param>, <rosparam>.

May import nothing of cfepy.
"""

from __future__ import annotations

from rospy_shim.names import PRIV_NAME, is_legal_name
from rospy_shim.roslaunch.attributes import Attributes
from rospy_shim.roslaunch.document import Tag
from rospy_shim.roslaunch.model import DEFAULT_TIME_LIMIT_S, Launch, LaunchNode, LaunchTest
from rospy_shim.roslaunch.names import as_namespace, joined
from rospy_shim.roslaunch.param_tags import PARAM, ROSPARAM, add_param, read_param, read_rosparam
from rospy_shim.roslaunch.scope import Scope

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
_IGNORED = {
    "machine": "everything runs on the one simulated computer",
    "launch-prefix": "no process is started that a debugger or a terminal could be put around",
}


def tell_unknown(launch: Launch, attributes: Attributes, known: tuple[str, ...]) -> None:
    """Note the attributes that a tag should not have; they are ignored, as roslaunch does."""
    tag = attributes.tag
    for name in attributes.unknown(known):
        launch.notes.append(f"{tag.file}:{tag.line}: <{tag.name}> has no attribute {name!r}; it is ignored")


def namespace_of(attributes: Attributes) -> str | None:
    """The attribute `ns` of a tag.

    Raises:
        UsageError: it is empty or private.
    """
    namespace = attributes.optional("ns")
    if namespace is not None and (not namespace or namespace.startswith(PRIV_NAME)):
        raise attributes.tag.fail(f"is {namespace!r}; write a namespace such as arm", "ns")
    return namespace


def read_remap(launch: Launch, tag: Tag, scope: Scope) -> None:
    """A <remap> tag.

    Raises:
        UsageError: it is wrong.
    """
    attributes = Attributes(tag, scope)
    tell_unknown(launch, attributes, REMAP)
    source, target = attributes.required("from"), attributes.required("to")
    try:
        scope.add_remap(source, target)
    except ValueError as error:
        raise tag.fail(str(error)) from None


def read_env(launch: Launch, tag: Tag, scope: Scope) -> None:
    """An <env> tag.

    Raises:
        UsageError: it is wrong.
    """
    attributes = Attributes(tag, scope)
    tell_unknown(launch, attributes, ENV)
    name, value = attributes.required("name"), attributes.required("value")
    if not name:
        raise tag.fail("is empty; write a variable's name", "name")
    scope.env[name] = value


def read_test(launch: Launch, tag: Tag, scope: Scope) -> None:
    """A <test> tag.

    Raises:
        UsageError: it is wrong.
    """
    attributes = Attributes(tag, scope)
    tell_unknown(launch, attributes, TEST)
    for name in _NOT_FOR_TESTS:
        if name in tag.attributes:
            raise tag.fail("is nothing that a <test> has; remove it", name)
    test_name = attributes.required("test-name")
    limit = attributes.number("time-limit", 0.0) if tag.attributes.get("time-limit") else DEFAULT_TIME_LIMIT_S
    if not limit:
        raise tag.fail("is 0; write a number of seconds", "time-limit")
    retry = attributes.number("retry", 0) if tag.attributes.get("retry") else 0
    node = _node(launch, attributes, scope, attributes.optional("name") or test_name)
    launch.tests.append(LaunchTest(test_name, node, limit, int(retry or 0)))


def read_node(launch: Launch, tag: Tag, scope: Scope) -> None:
    """A <node> tag.

    Raises:
        UsageError: it is wrong.
    """
    attributes = Attributes(tag, scope)
    tell_unknown(launch, attributes, NODE)
    launch.nodes.append(_node(launch, attributes, scope, attributes.required("name")))


def _node(launch: Launch, attributes: Attributes, scope: Scope, name: str) -> LaunchNode:
    tag = attributes.tag
    if not name.strip() or "/" in name:
        raise tag.fail(f"is {name!r}; write a name without a namespace, and ns= for the namespace", "name")
    if not is_legal_name(name):
        launch.notes.append(f"{tag.file}:{tag.line}: {name!r} is not a legal name of a node")
    namespace = as_namespace(joined(scope.namespace, namespace_of(attributes) or ""))
    _take_clear_params(attributes)
    inner = scope.inside()
    _read_children(launch, tag, inner, scope.inside(namespace + name))
    _tell_ignored(launch, attributes)
    for param, value in inner.params.items():
        add_param(launch, f"{namespace}{name}/{param.removeprefix(PRIV_NAME)}", value, tag)
    return _record(attributes, inner, name, namespace)


def _read_children(launch: Launch, tag: Tag, inner: Scope, params: Scope) -> None:
    """The tags inside a node; remappings and variables go to `inner`, and so do parameters that `params` collects."""
    params.params.clear()
    for child in tag.children:
        attributes = Attributes(child, params)
        kind = child.name.lower()
        if kind not in ("remap", "env", "param", "rosparam"):
            launch.notes.append(
                f"{child.file}:{child.line}: <{child.name}> means nothing in <{tag.name}>; it is ignored"
            )
        elif not attributes.counts():
            continue
        elif kind == "remap":
            read_remap(launch, child, inner)
        elif kind == "env":
            read_env(launch, child, inner)
        elif kind == "param":
            tell_unknown(launch, attributes, PARAM)
            read_param(launch, child, params, of_node=True)
        else:
            tell_unknown(launch, attributes, ROSPARAM)
            read_rosparam(launch, child, params)
    for name, value in params.params.items():
        inner.set_param(name, value)


def _take_clear_params(attributes: Attributes) -> None:
    """`clear_params` must be well written; a launch begins without parameters, so there is nothing to clear."""
    if attributes.tag.attributes.get("clear_params"):
        attributes.flag("clear_params")


def _tell_ignored(launch: Launch, attributes: Attributes) -> None:
    tag = attributes.tag
    for name, why in _IGNORED.items():
        if attributes.optional(name):
            launch.notes.append(f"{tag.file}:{tag.line}: {name}={tag.attributes[name]!r} is ignored: {why}")


def _record(attributes: Attributes, inner: Scope, name: str, namespace: str) -> LaunchNode:
    tag = attributes.tag
    package, node_type = attributes.required("pkg"), attributes.required("type")
    for field, value in (("pkg", package), ("type", node_type)):
        if not value.strip():
            raise tag.fail("is empty; write the node's package and type", field)
    respawn, required = attributes.flag("respawn"), attributes.flag("required")
    if respawn and required:
        raise tag.fail("has both respawn and required; a required node ends the run, so it cannot come back")
    words = {field: _word(attributes, field) for field in _WORDS}
    return LaunchNode(
        package=package,
        type=node_type,
        name=name,
        namespace=namespace,
        args=attributes.optional("args") or "",
        remaps=tuple(inner.remaps().items()),
        env=dict(inner.env),
        output=words["output"],
        cwd=words["cwd"],
        respawn=respawn,
        respawn_delay=attributes.number("respawn_delay", 0.0) or 0.0,
        required=required,
        file=tag.file,
        line=tag.line,
    )


def _word(attributes: Attributes, name: str) -> str | None:
    value = attributes.optional(name)
    if value and value not in _WORDS[name]:
        raise attributes.tag.fail(f"is {value!r}; write one of {', '.join(_WORDS[name])}", name)
    return value or None
