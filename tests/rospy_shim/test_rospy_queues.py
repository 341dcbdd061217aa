"""What waits for a slow subscriber: the newest messages, as many as its queue size says."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.rospy_shim.missions import Run, run_nodes

SUBSCRIBER = """
import rospy
from std_msgs.msg import String, UInt32

rospy.init_node("sub")
seen = []
"""
PUBLISHER = """
import rospy
from std_msgs.msg import String, UInt32

rospy.init_node("pub")
rospy.sleep(1.0)
"""


def both(tmp_path: Path, publisher: str, subscriber: str, priority: int = 100) -> Run:
    scripts = {"SUB": SUBSCRIBER + subscriber, "PUB": PUBLISHER + publisher}
    return run_nodes(tmp_path, scripts, seconds=6, priorities={"SUB": priority})


@pytest.mark.parametrize(
    ("queue_size", "seen"),
    [
        (1, [0, 499, 999]),
        (2, [0, 498, 499, 998, 999]),
        (5, [0, 495, 496, 497, 498, 499, 995, 996, 997, 998, 999]),
    ],
)
def test_a_slow_callback_gets_the_newest(tmp_path: Path, queue_size: int, seen: list[int]) -> None:
    """Half a thousand messages come during each of two callbacks: more than the platform lets wait."""
    result = both(
        tmp_path,
        'publisher = rospy.Publisher("q", UInt32, queue_size=10)\nrate = rospy.Rate(1000)\n'
        "for n in range(1000):\n    publisher.publish(n)\n    rate.sleep()",
        "def on_message(message):\n    seen.append(message.data)\n"
        "    if message.data in (0, 499):\n        rospy.sleep(0.4995 if message.data == 0 else 1.0)\n"
        f'rospy.Subscriber("q", UInt32, on_message, queue_size={queue_size})\nrospy.sleep(4.0)\nprint(seen)',
    )
    assert result.printed["sub"][-1] == str(seen)
    assert not any("Pipe Overflow" in line or "Msg Limit" in line for line in result.lines)


def test_without_queue_size_the_bus_reports_what_is_lost(tmp_path: Path) -> None:
    result = both(
        tmp_path,
        'publisher = rospy.Publisher("q", UInt32, queue_size=10)\nfor n in range(60): publisher.publish(n)',
        'rospy.Subscriber("q", UInt32, lambda m: (seen.append(m.data), rospy.sleep(0.01)))\n'
        "rospy.sleep(3)\nprint(seen)",
        priority=120,
    )
    assert result.printed["sub"][-1] == str(list(range(50)))
    assert any("Msg Limit Err" in line for line in result.lines)


def test_the_last_queue_size_counts(tmp_path: Path) -> None:
    result = both(
        tmp_path,
        'publisher = rospy.Publisher("q", UInt32, queue_size=10)\nfor n in range(9): publisher.publish(n)',
        'rospy.Subscriber("q", UInt32, lambda m: (seen.append(m.data), rospy.sleep(0.01)))\n'
        'rospy.Subscriber("q", UInt32, lambda m: None, queue_size=3)\nrospy.sleep(3)\nprint(seen)',
        priority=120,
    )
    assert result.printed["sub"][-1] == "[0, 6, 7, 8]"


def test_a_slow_callback_gets_the_newest_long_message_whole(tmp_path: Path) -> None:
    result = both(
        tmp_path,
        'publisher = rospy.Publisher("big", String, queue_size=1)\n'
        "for n in range(30):\n    publisher.publish(chr(65 + n) * 100_000)\n    rospy.sleep(0.05)",
        'rospy.Subscriber("big", String, lambda m: (seen.append(m.data), rospy.sleep(0.52)), queue_size=1)\n'
        "rospy.sleep(4.0)\nprint([sorted(set(text)) for text in seen], {len(text) for text in seen})",
    )
    assert result.printed["sub"][-1] == "[['A'], ['K'], ['U'], ['^']] {100000}"
