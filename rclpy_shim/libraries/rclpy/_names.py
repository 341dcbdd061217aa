"""Names of nodes, topics and services: their rules, their expansion, and the rules of a command line."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

from rclpy.exceptions import (
    InvalidNamespaceException,
    InvalidNodeNameException,
    InvalidServiceNameException,
    InvalidTopicNameException,
    NameValidationException,
)

_NODE = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
_SUBSTITUTION = re.compile(r"\{([^{}]*)\}")
_WRONG = re.compile(r"[^A-Za-z0-9_/~{}]")
_PREFIXES = {"rostopic://": "topic", "rosservice://": "service"}
_LONGEST = 255


class Remap(NamedTuple):
    """One rule of a command line.

    Attributes:
        source: the name that is replaced; "__node" and "__ns" for the node's own names.
        target: its replacement.
        node: name of the node that the rule is for; empty for all.
        kind: "topic" or "service"; empty for both.
    """

    source: str
    target: str
    node: str = ""
    kind: str = ""


class Arguments(NamedTuple):
    """The arguments of ROS in a command line.

    Attributes:
        remaps: the rules, in order.
        parameters: (node or "", name, text in YAML).
        files: paths of files with parameters.
        log_levels: levels of loggers by name; "" is the default.
        refused: arguments that are not known.
        accepted: arguments without a value.
    """

    remaps: list[Remap]
    parameters: list[tuple[str, str, str]]
    files: list[str]
    log_levels: dict[str, str]
    refused: list[str]
    accepted: list[str]

    @property
    def disables_rosout(self) -> bool:
        """True if the command line has `--disable-rosout-logs`."""
        return "--disable-rosout-logs" in self.accepted


def parse_arguments(words: Sequence[str]) -> Arguments:
    """Return the arguments of ROS in a command line, those after `--ros-args`.

    Raises:
        RuntimeError: an argument lacks its value, or has the wrong form.
    """
    found = Arguments([], [], [], {}, [], [])
    pending = _ros_words(words)
    for word in pending:
        if word in ("-r", "--remap"):
            found.remaps.append(_remap(_value(word, pending)))
        elif word in ("-p", "--param"):
            found.parameters.append(_parameter(_value(word, pending)))
        elif word == "--params-file":
            found.files.append(_value(word, pending))
        elif word == "--log-level":
            name, has_name, level = _value(word, pending).rpartition(":=")
            found.log_levels[name if has_name else ""] = level
        elif word in _ACCEPTED:
            found.accepted.append(word)
        elif ":=" in word:
            found.remaps.append(_remap(word))
        else:
            found.refused.append(word)
    return found


_ACCEPTED = (
    "--disable-rosout-logs",
    "--enable-stdout-logs",
    "--enable-external-lib-logs",
    "--disable-external-lib-logs",
)


def _ros_words(words: Sequence[str]) -> Iterator[str]:
    is_ros = False
    for word in words:
        if word == "--ros-args":
            is_ros = True
        elif word == "--" and is_ros:
            is_ros = False
        elif is_ros:
            yield word


def _value(word: str, pending: Iterator[str]) -> str:
    value = next(pending, None)
    if value is None:
        raise RuntimeError(f"Couldn't parse trailing {word} flag. No argument value found")
    return value


def _remap(text: str) -> Remap:
    source, separator, target = text.partition(":=")
    if not separator or not source or not target:
        raise RuntimeError(f"Couldn't parse remap rule: '{text}'; write `from:=to`")
    kind = ""
    for prefix, its in _PREFIXES.items():
        if source.startswith(prefix):
            source, kind = source.removeprefix(prefix), its
    node, has_node, name = source.partition(":")
    source = name if has_node else source
    return Remap({"__name": "__node"}.get(source, source), target, node if has_node else "", kind)


def _parameter(text: str) -> tuple[str, str, str]:
    name, separator, value = text.partition(":=")
    if not separator or not name:
        raise RuntimeError(f"Couldn't parse parameter override rule: '{text}'; write `name:=value`")
    node, has_node, own = name.rpartition(":")
    return node if has_node else "", own, value


def validate_node_name(name: str) -> bool:
    """Check the name of a node.

    Raises:
        InvalidNodeNameException: it breaks a rule.
    """
    if not name:
        raise InvalidNodeNameException(name, "node name must not be empty", 0)
    if not _NODE.fullmatch(name):
        if name[0].isdigit():
            raise InvalidNodeNameException(name, "node name must not start with a number", 0)
        at = next(index for index, each in enumerate(name) if not (each.isascii() and (each.isalnum() or each == "_")))
        text = "node name must not contain characters other than alphanumerics or '_'"
        raise InvalidNodeNameException(name, text, at)
    if len(name) > _LONGEST:
        raise InvalidNodeNameException(name, f"node name length should not exceed '{_LONGEST}'", _LONGEST)
    return True


def validate_namespace(namespace: str) -> bool:
    """Check a namespace.

    Raises:
        InvalidNamespaceException: it breaks a rule.
    """
    if not namespace.startswith("/"):
        raise InvalidNamespaceException(namespace, "namespace must be absolute, it must lead with a '/'", 0)
    if namespace != "/":
        _check(namespace, InvalidNamespaceException, "namespace", "'_', or '/'")
    return True


def validate_topic_name(name: str, *, is_service: bool = False) -> bool:
    """Check the name of a topic or service before its expansion.

    Raises:
        InvalidTopicNameException, InvalidServiceNameException: it breaks a rule.
    """
    kind = InvalidServiceNameException if is_service else InvalidTopicNameException
    word = "service name" if is_service else "topic name"
    if not name:
        raise kind(name, f"{word} must not be empty string", 0)
    if "~" in name[1:]:
        raise kind(name, f"{word} must not have tilde '~' unless it is the first character", name.index("~", 1))
    _check(name, kind, word)
    return True


def validate_full_topic_name(name: str, *, is_service: bool = False) -> bool:
    """Check the full name of a topic or service.

    Raises:
        InvalidTopicNameException, InvalidServiceNameException: it breaks a rule.
    """
    kind = InvalidServiceNameException if is_service else InvalidTopicNameException
    if not name.startswith("/"):
        raise kind(name, "topic name must be absolute, it must lead with a '/'", 0)
    _check(name, kind, "topic name")
    return True


def _check(name: str, kind: Any, word: str, others: str = "'_', '~', '{', or '}'") -> None:
    wrong = _WRONG.search(name)
    if wrong is not None:
        text = f"{word} must not contain characters other than alphanumerics, {others}"
        raise kind(name, text, wrong.start())
    if len(name) > 1 and name.endswith("/"):
        raise kind(name, f"{word} must not end with a forward slash", len(name) - 1)
    if "//" in name:
        raise kind(name, f"{word} must not contain repeated '/'", name.index("//") + 1)
    if (number := re.search(r"(?:^|/)(\d)", name)) is not None:
        raise kind(name, f"{word} token must not start with a number", number.start(1))


def expand_topic_name(topic_name: str, node_name: str, node_namespace: str) -> str:
    """Return the full name of a topic or service.

    Args:
        topic_name: its name, which may be relative, private (`~/name`) or have `{node}` and `{ns}` in it.
        node_name: name of the node.
        node_namespace: its namespace.

    Raises:
        NameValidationException: an unknown substitution.
    """
    known = {"node": node_name, "ns": node_namespace, "namespace": node_namespace}

    def replaced(found: re.Match[str]) -> str:
        if found[1] not in known:
            raise NameValidationException("topic name", topic_name, "unknown substitution", found.start())
        return known[found[1]]

    name = _SUBSTITUTION.sub(replaced, topic_name)
    if name.startswith("~"):
        name = full_name_of(node_name, node_namespace) + name[1:]
    elif not name.startswith("/"):
        name = f"{node_namespace.rstrip('/')}/{name}"
    return name


def full_name_of(node_name: str, namespace: str) -> str:
    """Return the full name of a node."""
    return f"{namespace.rstrip('/')}/{node_name}"
