"""rostest: the main routine of tests that run as nodes, and queries about the publishers and subscribers of a topic.

Source: wiki.ros.org/rostest. The tool itself, which reads launch files, is `cfepy rostest`.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Any

import rosgraph
import rosunit
from ros_tools.suites import run_suite

XML_OUTPUT_FLAG = rosunit.XML_OUTPUT_FLAG
_CALLER_ID = "/script"
_PUBLISHERS, _SUBSCRIBERS = 0, 1  # of a master's state


def get_master() -> Any:
    """Return an XML-RPC handle of the master."""
    from xmlrpc.client import ServerProxy

    return ServerProxy(rosgraph.get_master_uri())


def is_subscriber(topic: str, subscriber_id: str) -> bool:
    """Return whether a node subscribes to a topic.

    Args:
        topic: its resolved name.
        subscriber_id: the node's resolved name.

    Raises:
        IOError: the master does not answer.
    """
    return _is_member(_SUBSCRIBERS, topic, subscriber_id)


def is_publisher(topic: str, publisher_id: str) -> bool:
    """Return whether a node publishes a topic; see `is_subscriber`."""
    return _is_member(_PUBLISHERS, topic, publisher_id)


def _is_member(side: int, topic: str, node: str) -> bool:
    code, message, state = get_master().getSystemState(_CALLER_ID)
    if code != 1:
        raise OSError(f"Unable to retrieve master state: {message}")
    return any(node in members for name, members in state[side] if name == topic)


def rosrun(package: str, test_name: str, test: Any, sysargs: Sequence[str] | None = None) -> None:
    """Run a test that is a node. Ends the program if one of its tests fails.

    Args:
        package: package of the test.
        test_name: its name.
        test: a TestCase class, or a dotted name.
        sysargs: command line instead of sys.argv: `--text`, `--gtest_output=xml:FILE`.

    Raises:
        SystemExit: a test failed.
    """
    import rospy

    result = run_suite(package, test_name, test, sys.argv if sysargs is None else sysargs)
    rospy.signal_shutdown("test complete")
    if not result.wasSuccessful():
        sys.exit(1)


run = rosrun
unitrun = rosunit.unitrun
