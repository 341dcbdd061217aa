"""Publishes by name: a publisher from the names of topic and type, messages from plain values (`rostopic pub`)."""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable, Iterable, Iterator
from typing import Any

import genpy
import genpy.message
import rosgraph.names
import roslib.message
import rospy

from rostopic._errors import ROSTopicException

_ONCE_DELAY = 3.0
SUBSCRIBER_TIMEOUT = 5.0


def create_publisher(topic_name: str, topic_type: str, latch: bool, disable_rostime: bool = True) -> tuple[Any, Any]:
    """Return a publisher and its message class. The program becomes a node, if it is none yet.

    Args:
        topic_name: the topic.
        topic_type: such as `std_msgs/String`.
        latch: keep the last message for subscribers to come.
        disable_rostime: do not follow /clock.

    Raises:
        ROSTopicException: no such type.
    """
    try:
        message_class = roslib.message.get_message_class(topic_type)
    except Exception:
        raise ROSTopicException(f"invalid topic type: {topic_type}") from None
    if message_class is None:
        package = topic_type.partition("/")[0]
        raise ROSTopicException(
            f"invalid message type: {topic_type}.\n"
            f"If this is a valid message type, perhaps you need to build '{package}'"
        )
    if not rospy.core.is_initialized():
        rospy.init_node("rostopic", anonymous=True, disable_rosout=True, disable_rostime=disable_rostime)
    name = rosgraph.names.script_resolve_name("rostopic", topic_name)
    return rospy.Publisher(name, message_class, latch=latch, queue_size=100), message_class


def _fillMessageArgs(msg: Any, pub_args: Any) -> None:
    """Fill a message from plain values. `now` and `auto` stand for the time and for a header with it."""
    from std_msgs.msg import Header

    now = rospy.get_rostime()
    try:
        genpy.message.fill_message_args(msg, pub_args, keys={"now": now, "auto": Header(stamp=now)})
    except genpy.MessageException as error:
        wanted = genpy.message.get_printable_message_args(msg)
        raise ROSTopicException(f"{error}\n\nArgs are: [{wanted}]") from None


def publish_message(
    pub: Any,
    msg_class: Any,
    pub_args: Any,
    rate: float | None = None,
    once: bool = False,
    verbose: bool = False,
    substitute_keywords: bool = False,
) -> None:
    """Make a message and publish it.

    Args:
        pub: the publisher.
        msg_class: its message class.
        pub_args: values of the fields, or one dictionary of them.
        rate: publish at this rate in Hz until the end; None for once.
        once: return; otherwise wait for the end.
        verbose: print the message.
        substitute_keywords: insert the time anew for each message.

    Raises:
        ROSTopicException: the values do not fit.
    """
    message = msg_class()
    _fillMessageArgs(message, pub_args)
    try:
        if rate is not None:
            _publish_at_rate(pub, message, rate, verbose, substitute_keywords, pub_args)
            return
        what = f"publishing and latching [{message}]" if verbose else "publishing and latching message"
        print(f"{what} for {_ONCE_DELAY} seconds" if once else f"{what}. Press ctrl-C to terminate")
        pub.publish(message)
        if not once:
            rospy.spin()
    except (TypeError, rospy.ROSSerializationException) as error:
        import rosmsg

        text = rosmsg.get_msg_text(msg_class._type)
        raise ROSTopicException(
            f"Unable to publish message. One of the fields has an incorrect type:\n  {error}\n\nmsg file:\n{text}"
        ) from None


def _publish_at_rate(
    pub: Any, msg: Any, rate: float, verbose: bool = False, substitute_keywords: bool = False, pub_args: Any = None
) -> None:
    try:
        pace = rospy.Rate(float(rate))
    except ValueError:
        raise ROSTopicException("Rate must be a number") from None
    while not rospy.is_shutdown():
        if substitute_keywords:
            _fillMessageArgs(msg, pub_args)
        if verbose:
            print(f"publishing {msg}")
        pub.publish(msg)
        pace.sleep()


def argv_publish(
    pub: Any,
    msg_class: Any,
    pub_args: Any,
    rate: float | None,
    once: bool,
    verbose: bool,
    substitute_keywords: bool = False,
) -> None:
    """Publish as `publish_message` does.

    With `once` it stays for three seconds, so that others can receive the message.
    """
    publish_message(pub, msg_class, pub_args, rate, once, verbose, substitute_keywords)
    end = time.time() + _ONCE_DELAY
    while once and not rospy.is_shutdown() and time.time() < end:
        rospy.sleep(0.2)


def wait_for_subscriber(pub: Any, timeout: float) -> None:
    """Wait until there is a subscriber, for some seconds at most."""
    end = time.time() + timeout
    while pub.get_num_connections() == 0 and time.time() < end:
        rospy.rostime.wallsleep(0.01)


# -- values from files, stdin and parameters -------------------------------------------------------------------------


def file_yaml_arg(filename: str) -> Callable[[], Iterator[Any]]:
    """Return a function that gives the documents of a YAML file, each in a list.

    Raises:
        ROSTopicException: no such file, or (the function) no YAML.
    """
    import yaml

    if not os.path.isfile(filename):
        raise ROSTopicException(f"file does not exist: {filename}")

    def documents() -> Iterator[Any]:
        try:
            with open(filename, encoding="utf-8") as file:
                yield from ([document] for document in yaml.safe_load_all(file))
        except yaml.YAMLError as error:
            raise ROSTopicException(f"invalid YAML in file: {error}") from None

    return documents


def stdin_yaml_arg() -> Iterator[Any]:
    """Yield the YAML documents of stdin, each ended by a line `---`."""
    import yaml

    lines: list[str] = []
    for line in iter(sys.stdin.readline, ""):
        if rospy.is_shutdown():
            return
        if line.strip() != "---":
            lines.append(line)
            continue
        try:
            document = yaml.safe_load("".join(lines))
        except yaml.YAMLError as error:
            sys.stderr.write(f"Invalid YAML: {error}\n")
        else:
            if document is not None:
                yield document
        lines.clear()


def stdin_publish(
    pub: Any, msg_class: Any, rate: float | None, once: bool, filename: str | None, verbose: bool
) -> None:
    """Publish a message for each document of a file or of stdin.

    Args:
        pub: the publisher.
        msg_class: its message class.
        rate: messages per second; the only message of a file is published repeatedly.
        once: end after the first.
        filename: the file; None for stdin.
        verbose: print the messages.
    """
    documents: Iterable[Any] = list(file_yaml_arg(filename)()) if filename else stdin_yaml_arg()
    pace = rospy.Rate(rate) if rate is not None else None
    wait_for_subscriber(pub, SUBSCRIBER_TIMEOUT)
    again = isinstance(documents, list) and len(documents) == 1 and rate is not None
    for document in documents:
        values = document if isinstance(document, list) else [document]
        if again:
            print("Got one message and a rate, publishing repeatedly")
        publish_message(pub, msg_class, values, rate if again else None, once or pace is not None, verbose)
        if pace is not None:
            pace.sleep()
        if once or rospy.is_shutdown():
            break


def param_publish_once(pub: Any, msg_class: Any, param_name: str, verbose: bool) -> None:
    """Publish a message whose values are a parameter.

    Raises:
        ROSTopicException: no such parameter.
    """
    argv_publish(pub, msg_class, _param_values(param_name), None, True, verbose)


def param_publish(pub: Any, msg_class: Any, param_name: str, rate: float | None, verbose: bool) -> None:
    """Publish a message whose values are a parameter, `rate` times a second or whenever it changes.

    Raises:
        ROSTopicException: no such parameter.
    """
    pace, last = rospy.Rate(rate or 10.0), None
    while not rospy.is_shutdown():
        values = _param_values(param_name)
        if rate is not None or values != last:
            publish_message(pub, msg_class, values, None, True, verbose)
        last = values
        pace.sleep()


def _param_values(param_name: str) -> list[Any]:
    if not rospy.has_param(param_name):
        raise ROSTopicException(f"parameter does not exist: {param_name}")
    values = rospy.get_param(param_name)
    if not isinstance(values, (dict, list)):
        raise ROSTopicException(f"Parameter [{param_name}] in not a valid type")
    return values if isinstance(values, list) else [values]
