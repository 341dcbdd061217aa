"""<param> and <rosparam>: the parameters that are set before the nodes start.

The output of a program can be a parameter (`command`). cfepy starts no process, since a program may print different
text each time; it imitates two programs, `cat` and `xacro`.
"""

from __future__ import annotations

import importlib
import shlex
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from cfepy.reading.input_files import read_limited, text_limited
from cfepy.reading.input_limits import LAUNCH_FILE_BYTES, LAUNCH_NAME
from cfepy.reading.suggestions import expected, listed
from rospy_shim.parameters.values import marshalled
from rospy_shim.roslaunch.document import Attributes, Tag
from rospy_shim.roslaunch.model import Launch
from rospy_shim.roslaunch.scope import Scope, joined
from rospy_shim.roslaunch.values import converted, from_yaml
from rospy_shim.types.names import PRIV_NAME, SEP, canonicalize_name

STOOD_IN = {"xacro": Path("xacro")}
"""The result of $(find) for packages of the imitated programs, if they are not installed."""
PARAM = ("name", "value", "type", "textfile", "binfile", "command")
ROSPARAM = ("command", "ns", "file", "param", "subst_value")
_BYTES_KEPT, _YAML_BYTES = 200, 10  # bytes that count as one for the size of a launch
_COMMANDS = ("load", "dump", "delete")
_SOURCES = ("value", "textfile", "binfile", "command")


def output_of(command: str) -> str:
    """Return the output of a command.

    Args:
        command: the command line; relative paths in it start at the current folder.

    Raises:
        ValueError: it is neither cat nor xacro, or it fails.
    """
    program, *arguments = shlex.split(command) or [""]
    name = Path(program).name.removesuffix(".py")
    if name not in _PROGRAMS:
        raise ValueError(
            f"cannot start the program {program!r}; run it yourself, and name its output with textfile= instead"
        )
    try:
        return _PROGRAMS[name](arguments)
    except OSError as error:
        raise ValueError(f"{command}: {error.strerror}: {error.filename}") from None


def _cat(arguments: list[str]) -> str:
    found = ""
    for file in arguments:
        found += _read_text(file)
        if len(found) > LAUNCH_FILE_BYTES:
            raise ValueError(f"must print at most {LAUNCH_FILE_BYTES:,} characters")
    return found


def _read_text(file: str) -> str:
    return text_limited(file, LAUNCH_FILE_BYTES)


def _xacro(arguments: list[str]) -> str:
    """Run the library xacro, if it is installed where cfepy runs."""
    try:
        xacro: Any = importlib.import_module("xacro")
    except ImportError:
        raise ValueError(
            "requires the Python package xacro, which is not installed; run `pip install xacro`, or run "
            "xacro yourself and name its output with textfile="
        ) from None
    words = [word for word in arguments if not word.startswith("-")]
    mappings = dict(word.split(":=", 1) for word in words if ":=" in word)
    files = [word for word in words if ":=" not in word]
    if len(files) != 1:
        raise ValueError(f"must name one file for xacro, not {len(files)}")
    try:
        return str(xacro.process_file(files[0], mappings=mappings).toprettyxml(indent="  "))
    except OSError:
        raise
    except Exception as error:  # the macros of the file may raise any error
        raise ValueError(f"xacro {files[0]}: {error}") from None


_PROGRAMS = {"cat": _cat, "xacro": _xacro}


def add_param(launch: Launch, name: str, value: Any, attributes: Attributes) -> None:
    """Set the value of a parameter; the last one counts. A value that XML-RPC, and so ROS, cannot carry is an error.

    Args:
        launch: the launch of the parameter.
        name: resolved name.
        value: a value that is not a mapping.
        attributes: attributes of the tag.
    """
    name, tag = canonicalize_name(name), attributes.tag
    if len(name) > LAUNCH_NAME:
        attributes.wrong(f"makes a parameter name of more than {LAUNCH_NAME:,} characters; write a shorter one")
        return
    if name in ("", SEP):
        attributes.wrong("must not name all parameters; write the name of a parameter")
        return
    parents = [name[:index] for index, letter in enumerate(name) if letter == "/" and index]
    for parent in parents:
        if parent in launch.params:
            attributes.remark(f"parameter {name} replaces its parent {parent}")
    launch.places[name] = (tag.file, tag.line)
    try:
        launch.params[name] = None if value is None else marshalled(value)
    except (TypeError, OverflowError) as error:
        attributes.wrong(f"invalid value {value!r} of {name}: {error}; put text in quotes")


def read_param(launch: Launch, tag: Tag, scope: Scope, of_node: bool = False) -> None:
    """Read a <param> tag.

    Args:
        launch: receives the parameter.
        tag: the tag.
        scope: the scope of the tag.
        of_node: True inside a <node>.
    """
    attributes = Attributes(tag, scope)
    attributes.tell_unknown(PARAM)
    given = [source for source in _SOURCES if source in tag.attributes]
    name = attributes.required("name")
    if len(given) != 1:
        attributes.wrong(f"must have exactly one of {listed(_SOURCES)}, not {' and '.join(given) or 'none'}")
        return
    value = _value(attributes, given[0])
    if name is None or attributes.failed:
        return
    name = name.strip()
    if of_node or name.startswith(PRIV_NAME):
        scope.set_param(name, value)
    else:
        add_param(launch, joined(scope.namespace, name), value, attributes)


def _value(attributes: Attributes, source: str) -> Any:
    """Return the value of a <param>; None for an error, which `attributes` records."""
    text = attributes.optional(source)
    if text is None:
        return None
    try:
        if source == "binfile":
            data = read_limited(text, LAUNCH_FILE_BYTES)
            attributes.charge(len(data) // _BYTES_KEPT)
            return data
        found = text.strip()
        if source == "textfile":
            found = _read_text(text)
        elif source == "command":
            found = output_of(text)
        attributes.charge(len(found) // _BYTES_KEPT)
        return converted(found, (attributes.tag.attributes.get("type") or "auto").strip())
    except OSError as error:
        attributes.wrong(f"{text} cannot be read: {error.strerror}", source)
    except UnicodeDecodeError:
        attributes.wrong(f"{text} is not UTF-8 text; use binfile= for a binary file", source)
    except ValueError as error:
        attributes.wrong(str(error), source)
    return None


def read_rosparam(launch: Launch, tag: Tag, scope: Scope) -> None:
    """Read a <rosparam> tag."""
    attributes = Attributes(tag, scope)
    attributes.tell_unknown(ROSPARAM)
    command = attributes.optional("command") or "load"
    param = joined(attributes.optional("ns") or "", attributes.optional("param") or "")
    file, resolves = attributes.optional("file"), attributes.flag("subst_value")
    if command not in _COMMANDS:
        attributes.wrong(f"invalid value {command!r}; {expected(command, _COMMANDS)}", "command")
        return
    if command == "delete" and file is not None:
        attributes.wrong('is not used by command="delete"; remove it', "file")
    if command != "load":
        why = (
            "it runs before all parameters are set, so there is nothing to delete"
            if command == "delete"
            else "writes a file"
        )
        attributes.remark(f'<rosparam command="{command}"> is left out: {why}')
        return
    text = None if attributes.failed else _text_of(file, attributes)
    if text is not None and resolves:
        text = attributes.resolved(text)
    if text is not None:
        attributes.charge(len(text) // _YAML_BYTES)
    value = None if text is None else _loaded(text, file, attributes)
    if value is None:
        return
    name = joined(scope.namespace, param) if param else scope.namespace
    for each, leaf in _leaves(name, value, attributes, bool(param)):
        add_param(launch, each, leaf, attributes)


def _text_of(file: str | None, attributes: Attributes) -> str | None:
    """Return the YAML of a <rosparam>; None if it cannot be read."""
    if file is None:
        return attributes.tag.text
    try:
        return _read_text(file)
    except (OSError, UnicodeDecodeError) as error:
        why = error.strerror if isinstance(error, OSError) else "is not UTF-8 text"
        attributes.wrong(f"{file} cannot be read: {why}", "file")
    except ValueError as error:
        attributes.wrong(str(error), "file")
    return None


def _loaded(text: str, file: str | None, attributes: Attributes) -> Any:
    """Return the value of a YAML text; None if it is empty or wrong."""
    try:
        return from_yaml(text)
    except ValueError as error:
        attributes.wrong(f"{file or 'the text'} {error}", None if file is None else "file")
    return None


def _leaves(name: str, value: Any, attributes: Attributes, named: bool) -> Iterator[tuple[str, Any]]:
    """Yield the parameters in a YAML value; a mapping is a namespace."""
    if not isinstance(value, dict):
        if named:
            yield name, value
        else:
            text = f'requires a name for {value!r}; write param="NAME", or a mapping of names to values'
            attributes.wrong(text)
        return
    for key, inner in value.items():
        if isinstance(key, str) and len(key) > LAUNCH_NAME:
            attributes.wrong(f"has a name of more than {LAUNCH_NAME:,} characters; write a shorter one")
        elif isinstance(key, str):
            yield from _leaves(joined(name, key), inner, attributes, True)
        else:
            attributes.wrong(f"invalid name {key!r}; put it in quotes")
