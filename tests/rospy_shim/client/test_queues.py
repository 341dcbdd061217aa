"""Messages that wait for a slow subscriber: the newest ones, as many as its queue size."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.mission import Mission, read_mission
from cfepy.writing.console import Console
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

COUNTER = (
    SUBSCRIBER
    + """
def on_message(message):
    print(message.data[0], len(message.data))
rospy.Subscriber("big", String, on_message)
rospy.spin()
"""
)


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
def test_slow_callback_gets_the_newest_messages(tmp_path: Path, queue_size: int, seen: list[int]) -> None:
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


def test_bus_reports_lost_messages_when_no_queue_size_is_set(tmp_path: Path) -> None:
    result = both(
        tmp_path,
        'publisher = rospy.Publisher("q", UInt32, queue_size=10)\nfor n in range(60): publisher.publish(n)',
        'rospy.Subscriber("q", UInt32, lambda m: (seen.append(m.data), rospy.sleep(0.01)))\n'
        "rospy.sleep(3)\nprint(seen)",
        priority=120,
    )
    assert result.printed["sub"][-1] == str(list(range(51)))
    assert any("Pipe Overflow" in line for line in result.lines)


def test_last_queue_size_counts(tmp_path: Path) -> None:
    result = both(
        tmp_path,
        'publisher = rospy.Publisher("q", UInt32, queue_size=10)\nfor n in range(9): publisher.publish(n)',
        'rospy.Subscriber("q", UInt32, lambda m: (seen.append(m.data), rospy.sleep(0.01)))\n'
        'rospy.Subscriber("q", UInt32, lambda m: None, queue_size=3)\nrospy.sleep(3)\nprint(seen)',
        priority=120,
    )
    assert result.printed["sub"][-1] == "[0, 6, 7, 8]"


def test_later_queue_size_applies_to_any_number_of_messages(tmp_path: Path) -> None:
    result = both(
        tmp_path,
        'publisher = rospy.Publisher("q", UInt32, queue_size=10)\nfor n in range(200): publisher.publish(n)',
        'rospy.Subscriber("q", UInt32, lambda m: (seen.append(m.data), rospy.sleep(0.01)))\n'
        'rospy.sleep(0.5)\nrospy.Subscriber("q", UInt32, lambda m: None, queue_size=1)\nrospy.sleep(3)\nprint(seen)',
        priority=120,
    )
    assert result.printed["sub"][-1] == "[0, 199]"


def test_slow_callback_gets_the_newest_long_message_completely(tmp_path: Path) -> None:
    result = both(
        tmp_path,
        'publisher = rospy.Publisher("big", String, queue_size=1)\n'
        "for n in range(30):\n    publisher.publish(chr(65 + n) * 100_000)\n    rospy.sleep(0.05)",
        'rospy.Subscriber("big", String, lambda m: (seen.append(m.data), rospy.sleep(0.52)), queue_size=1,'
        " buff_size=2**24)\n"
        "rospy.sleep(4.0)\nprint([sorted(set(text)) for text in seen], {len(text) for text in seen})",
    )
    assert result.printed["sub"][-1] == "[['A'], ['K'], ['U'], ['^']] {100000}"


@pytest.mark.parametrize("megabytes", [1, 6])
def test_an_image_arrives_at_every_subscriber(tmp_path: Path, megabytes: int) -> None:
    scripts = {
        "PUB": PUBLISHER + 'publisher = rospy.Publisher("big", String, queue_size=1)\n'
        f"for n in range(3):\n    publisher.publish(chr(65 + n) * {megabytes << 20})\n    rospy.sleep(0.1)",
        "ONE": COUNTER,
        "TWO": COUNTER.replace('"sub"', '"other"'),
    }
    result = run_nodes(tmp_path, scripts, seconds=2)
    expected = [f"{letter} {megabytes << 20}" for letter in "ABC"]
    assert result.printed["sub"] == result.printed["other"] == expected


def test_message_longer_than_the_pool_waits_for_memory(tmp_path: Path) -> None:
    publisher = 'publisher = rospy.Publisher("big", String, queue_size=1)\npublisher.publish("A" * 300_000)'
    startup = {"sub.py": COUNTER, "pub.py": PUBLISHER + publisher}
    for name, source in startup.items():
        (tmp_path / name).write_text(source, encoding="utf-8")
    entry = "CFE_APP, {0}, __main__, {1}, 100, 4096, 0, 0;\n"
    lines = [entry.format(name, name[:3].upper()) for name in startup]
    (tmp_path / "startup.scr").write_text("".join(lines) + "!", encoding="utf-8")
    (tmp_path / "mission.yaml").write_text("limits: {sb_buf_memory_bytes: 150000}\n", encoding="utf-8")
    with Mission(read_mission(str(tmp_path)), console=Console(quiet=True)) as mission:
        mission.run_for(2)
        assert "[sub] A 300000" in mission.console.lines
