"""<param> and <rosparam>: what goes to the parameter server before the nodes start.

May import nothing of cfepy.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from rospy_shim.names import PRIV_NAME, canonicalize_name
from rospy_shim.parameter_values import marshalled
from rospy_shim.roslaunch.attributes import Attributes
from rospy_shim.roslaunch.commands import output_of
from rospy_shim.roslaunch.document import Tag
from rospy_shim.roslaunch.model import Launch
from rospy_shim.roslaunch.names import joined
from rospy_shim.roslaunch.scope import Scope
from rospy_shim.roslaunch.values import converted, from_yaml

PARAM = ("name", "value", "type", "textfile", "binfile", "command")
ROSPARAM = ("command", "ns", "file", "param", "subst_value")
_SOURCES = ("value", "textfile", "binfile", "command")


def add_param(launch: Launch, name: str, value: Any, tag: Tag) -> None:
    """Give a parameter its value; the last one counts.

    Args:
        launch: what it is a parameter of.
        name: resolved.
        value: no mapping.
        tag: that says so.

    Raises:
        UsageError: XML-RPC, and so ROS, cannot carry the value.
    """
    name = canonicalize_name(name)
    parents = [name[:index] for index, letter in enumerate(name) if letter == "/" and index]
    for parent in parents:
        if parent in launch.params:
            launch.notes.append(f"{tag.file}:{tag.line}: parameter {name} replaces {parent}, which it lies below")
    try:
        launch.params[name] = None if value is None else marshalled(value)
    except (TypeError, OverflowError) as error:
        raise tag.fail(f"{name} is {value!r}, which no parameter can be: {error}; put text in quotes") from None


def read_param(launch: Launch, tag: Tag, scope: Scope, of_node: bool = False) -> None:
    """A <param> tag.

    Args:
        launch: what it is read into.
        tag: the tag.
        scope: where it stands.
        of_node: it stands inside a <node>.

    Raises:
        UsageError: it is wrong.
    """
    attributes = Attributes(tag, scope)
    given = [source for source in _SOURCES if source in tag.attributes]
    if len(given) != 1:
        raise tag.fail(f"has {' and '.join(given) or 'no value'}; give one of {', '.join(_SOURCES)}")
    name = attributes.required("name").strip()
    value = _value(attributes, given[0])
    if of_node or name.startswith(PRIV_NAME):
        scope.set_param(name, value)
    else:
        add_param(launch, joined(scope.namespace, name), value, tag)


def _value(attributes: Attributes, source: str) -> Any:
    tag = attributes.tag
    text = attributes.required(source)
    try:
        if source == "binfile":
            return Path(text).read_bytes()
        found = text.strip()
        if source == "textfile":
            found = Path(text).read_text(encoding="utf-8")
        elif source == "command":
            found = output_of(text)
        return converted(found, (tag.attributes.get("type") or "auto").strip())
    except OSError as error:
        raise tag.fail(f"{text} cannot be read: {error.strerror}", source) from None
    except UnicodeDecodeError:
        raise tag.fail(
            f"{text} is no text in UTF-8; name it with binfile= if it is meant to be bytes", source
        ) from None
    except ValueError as error:
        raise tag.fail(str(error), source) from None


def read_rosparam(launch: Launch, tag: Tag, scope: Scope) -> None:
    """A <rosparam> tag.

    Raises:
        UsageError: it is wrong.
    """
    attributes = Attributes(tag, scope)
    command = attributes.optional("command") or "load"
    param = joined(attributes.optional("ns") or "", attributes.optional("param") or "")
    file, resolves = attributes.optional("file"), attributes.flag("subst_value")
    if command not in ("load", "dump", "delete"):
        raise tag.fail(f"is {command!r}; write load, dump or delete", "command")
    if command == "delete" and file is not None:
        raise tag.fail('is of no use to command="delete"; remove it', "file")
    if command != "load":
        why = "it stands before all parameters are set, so nothing is there" if command == "delete" else "writes a file"
        launch.notes.append(f'{tag.file}:{tag.line}: <rosparam command="{command}"> is left out: {why}')
        return
    text = tag.text if file is None else _text_of(file, tag)
    if resolves:
        text = attributes.resolved(text)
    name = joined(scope.namespace, param) if param else scope.namespace
    for each, value in _leaves(name, _loaded(text, file, tag), tag, bool(param)):
        add_param(launch, each, value, tag)


def _text_of(file: str, tag: Tag) -> str:
    try:
        return Path(file).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        why = error.strerror if isinstance(error, OSError) else "is no text in UTF-8"
        raise tag.fail(f"{file} cannot be read: {why}", "file") from None


def _loaded(text: str, file: str | None, tag: Tag) -> Any:
    try:
        value = from_yaml(text)
    except ValueError as error:
        raise tag.fail(f"{file or 'the text'} {error}", None if file is None else "file") from None
    return {} if value is None else value


def _leaves(name: str, value: Any, tag: Tag, named: bool) -> Iterator[tuple[str, Any]]:
    """The parameters in a YAML value; a mapping is a namespace."""
    if not isinstance(value, dict):
        if not named:
            raise tag.fail(f'is {value!r}, which needs a name; write param="NAME", or a mapping of names to values')
        yield name, value
        return
    for key, inner in value.items():
        if not isinstance(key, str):
            raise tag.fail(f"has the name {key!r}, which is no text; put it in quotes")
        yield from _leaves(joined(name, key), inner, tag, True)
