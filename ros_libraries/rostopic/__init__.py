"""rostopic: lists topics with their types and nodes, prints messages and publishes them (wiki.ros.org/rostopic).

Topics may be named down to a field: `/odom/pose/pose/position/x`, `/scan/ranges[0]`.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Any
from urllib.parse import urlparse

import rosgraph
import rosgraph.names
import roslib.message
import rospy
from ros_tools import command_of

from rostopic._echo import CallbackEcho, create_field_filter, create_value_transform
from rostopic._errors import ROSTopicException, ROSTopicIOException
from rostopic._fields import _str_plot, _str_plot_fields, msgevalgen
from rostopic._publishing import (
    SUBSCRIBER_TIMEOUT,
    argv_publish,
    create_publisher,
    file_yaml_arg,
    param_publish,
    param_publish_once,
    publish_message,
    stdin_publish,
    stdin_yaml_arg,
    wait_for_subscriber,
)
from rostopic._statistics import ROSTopicBandwidth, ROSTopicDelay, ROSTopicHz

__all__ = [
    "NAME",
    "SUBSCRIBER_TIMEOUT",
    "CallbackEcho",
    "ROSTopicBandwidth",
    "ROSTopicDelay",
    "ROSTopicException",
    "ROSTopicHz",
    "ROSTopicIOException",
    "_str_plot",
    "_str_plot_fields",
    "argv_publish",
    "create_field_filter",
    "create_publisher",
    "create_value_transform",
    "file_yaml_arg",
    "find_by_type",
    "get_api",
    "get_info_text",
    "get_topic_class",
    "get_topic_list",
    "get_topic_type",
    "msgevalgen",
    "param_publish",
    "param_publish_once",
    "publish_message",
    "rostopicmain",
    "stdin_publish",
    "stdin_yaml_arg",
    "wait_for_subscriber",
]

NAME = "rostopic"
_ID = "/rostopic"
UNKNOWN = "unknown type"

_caller_apis: dict[str, str] = {}

_Row = tuple[str, str, list[str]]
"""A topic, its type, the nodes on it."""


def _check_master() -> None:
    """Check that the master answers.

    Raises:
        ROSTopicIOException: it does not.
    """
    try:
        rosgraph.Master(_ID).getPid()
    except OSError:
        raise ROSTopicIOException("Unable to communicate with master!") from None


def _master_get_topic_types(master: rosgraph.Master) -> Any:
    return master.getTopicTypes()


def _topic_types(master: rosgraph.Master | None = None) -> list[list[str]]:
    try:
        found: list[list[str]] = _master_get_topic_types(master or rosgraph.Master(_ID))
    except OSError:
        raise ROSTopicIOException("Unable to communicate with master!") from None
    return found


# -- types -----------------------------------------------------------------------------------------------------------


def get_topic_type(topic: str, blocking: bool = False) -> tuple[str | None, str | None, Any]:
    """Return the type of a topic, or None three times if it has none.

    Args:
        topic: its name, or the name of a field of it.
        blocking: wait until the topic exists.

    Returns:
        its type, its name, and a function that returns the field of a message, or None without a field.

    Raises:
        ROSTopicIOException: the master does not answer.
    """
    found = _get_topic_type(topic)
    if found[0] or not blocking:
        return found
    sys.stderr.write(f"WARNING: topic [{topic}] does not appear to be published yet\n")
    while not found[0] and not rospy.is_shutdown():
        rospy.rostime.wallsleep(0.1)
        found = _get_topic_type(topic)
    return found


def _get_topic_type(topic: str) -> tuple[str | None, str | None, Any]:
    types = _topic_types()
    exact = [(name, kind) for name, kind in types if name == topic]
    longer = sorted(((name, kind) for name, kind in types if topic.startswith(name + "/")), reverse=True)
    for name, kind in exact or [each for each in longer if _has_field(each[1], topic[len(each[0]) + 1 :])]:
        if kind != rosgraph.names.ANYTYPE:
            return kind, name, msgevalgen(topic[len(name) :])
    return None, None, None


def _has_field(kind: str, path: str) -> bool:
    """Return whether messages of a type have the first fields of a path, up to one with an index.

    Unknown counts as true.
    """
    message_class = roslib.message.get_message_class(kind)
    value = message_class() if message_class else None
    for field in path.rstrip("/").partition("[")[0].split("/") if value is not None else ():
        if field and not hasattr(value, field):
            return False
        value = getattr(value, field) if field else value
    return True


def get_topic_class(topic: str, blocking: bool = False) -> tuple[Any, str | None, Any]:
    """Return the same as `get_topic_type`, with the message class in place of the type.

    Raises:
        ROSTopicException: the class cannot be found.
        ROSTopicIOException: the master does not answer.
    """
    kind, name, evaluate = get_topic_type(topic, blocking=blocking)
    if kind is None:
        return None, None, None
    message_class = roslib.message.get_message_class(kind)
    if not message_class:
        raise ROSTopicException(f"Cannot load message class for [{kind}]. Are your messages built?")
    return message_class, name, evaluate


def find_by_type(topic_type: str) -> list[str]:
    """Return the names of the topics of a type.

    Raises:
        ROSTopicIOException: the master does not answer.
    """
    return [name for name, kind in _topic_types() if kind == topic_type]


# -- nodes of a topic ------------------------------------------------------------------------------------------------


def get_api(master: rosgraph.Master, caller_id: str) -> str:
    """Return the URI of a node, or a text saying that it is unknown.

    Raises:
        ROSTopicIOException: the master does not answer.
    """
    if not _caller_apis.get(caller_id):
        try:
            _caller_apis[caller_id] = master.lookupNode(caller_id)
        except OSError:
            raise ROSTopicIOException("Unable to communicate with master!") from None
        except rosgraph.MasterError:
            return f"unknown address {caller_id}"
    return _caller_apis[caller_id]


def get_topic_list(master: rosgraph.Master | None = None) -> tuple[list[_Row], list[_Row]]:
    """Return published and subscribed topics: name, type and nodes of each.

    Args:
        master: the master to ask; by default from the environment.
    """
    master = master or rosgraph.Master(_ID)
    types = dict(_topic_types(master))
    publishers, subscribers = (
        [(name, types.get(name, UNKNOWN), nodes) for name, nodes in entries] for entries in master.getSystemState()[:2]
    )
    return publishers, subscribers


def get_info_text(topic: str) -> str:
    """Return a text with the type of a topic and its nodes.

    Raises:
        ROSTopicException: the topic has no nodes.
        ROSTopicIOException: the master does not answer.
    """
    master = rosgraph.Master(_ID)
    try:
        sides = get_topic_list(master)
    except OSError:
        raise ROSTopicIOException("Unable to communicate with master!") from None
    nodes = [[node for row in rows if row[0] == topic for node in row[2]] for rows in sides]
    if not any(nodes):
        raise ROSTopicException(f"Unknown topic {topic}")
    text = f"Type: {dict(_topic_types(master)).get(topic, UNKNOWN)}\n\n"
    for title, names in zip(("Publishers", "Subscribers"), nodes, strict=True):
        lines = "".join(f" * {name} ({get_api(master, name)})\n" for name in names)
        text += f"{title}: \n{lines}\n" if names else f"{title}: None\n\n"
    return text


def _rostopic_list_group_by_host(
    master: rosgraph.Master, pubs: Sequence[_Row], subs: Sequence[_Row]
) -> tuple[dict[str, list[_Row]], dict[str, list[_Row]]]:
    """Return rows by the machine that the nodes run on."""
    sides: tuple[dict[str, list[_Row]], dict[str, list[_Row]]] = ({}, {})
    for side, rows in zip(sides, (pubs, subs), strict=True):
        for topic, kind, nodes in rows:
            hosts: dict[str, list[str]] = {}
            for node in nodes:
                hosts.setdefault(urlparse(get_api(master, node)).hostname or "", []).append(node)
            for host, names in hosts.items():
                side.setdefault(host, []).append((topic, kind, names))
    return sides


def rostopicmain(argv: Sequence[str] | None = None) -> None:
    """Run the command `rostopic`.

    Args:
        argv: its command line; sys.argv by default.
    """
    from rostopic._command import run

    run(list(sys.argv if argv is None else argv))


def __getattr__(name: str) -> Any:
    """Return a command by the name that tests and tools use: `_rostopic_cmd_list(argv)`."""
    return command_of("rostopic", name)
