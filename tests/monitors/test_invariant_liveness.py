"""Invariants about required events: repeatedly, and at least once."""

from __future__ import annotations

from pathlib import Path

import pytest

import cfepy
from tests.extra.exploration import missions

BEATS = """
    import rospy
    from std_msgs.msg import Int32

    rospy.init_node("heart")
    beats = rospy.Publisher("beat", Int32, queue_size=1)
    for number in range(8):
        rospy.sleep(0.1)
        beats.publish(number)
    rospy.spin()
"""


def violations(folder: Path, invariant: str, seconds: float = 2.0) -> list[str]:
    """Return the violations of an invariant in a run with beats from 0.65 s to 1.35 s."""
    path = missions.write(folder, {"HEART": BEATS})
    (path / "mission.yaml").write_text(
        f"nodes: {{HEART: {{name: heart}}}}\ninvariants:\n  it: {invariant}\n", encoding="utf-8"
    )
    run = cfepy.run(str(path), seconds=seconds)
    return [line.partition("at ")[2] for line in run.console if line.startswith("invariant 'it'")]


@pytest.mark.parametrize(
    ("invariant", "told"),
    [
        ("{topic: /beat, again: 0.2 s, after: 0.5 s}", ["1.550008 s: no further message within 0.2 s (/beat)"]),
        ("{topic: /beat, again: 1 s, after: 0.5 s}", []),
        ("{topic: /beat, again: 0.15 s, when: msg.data % 2, after: 0.7 s}", None),
        ("{topic: /beat, eventually: msg.data == 7}", []),
        ("{topic: /beat, eventually: msg.data == 8}", ["2.000000 s: msg.data == 8 did not hold of any message"]),
        ("{topic: /beat, eventually: msg.data == 8, after: 3 s}", []),
    ],
)
def test_missing_required_message_is_a_violation(tmp_path: Path, invariant: str, told: list[str] | None) -> None:
    found = violations(tmp_path, invariant)
    if told is None:
        assert found[0].endswith("no further message within 0.15 s (msg.data % 2)")
    else:
        assert len(found) == len(told)
        for line, begin in zip(found, told, strict=True):
            assert line.startswith(begin)


def test_required_message_must_come_from_the_beginning(tmp_path: Path) -> None:
    assert violations(tmp_path, "{topic: /beat, again: 0.3 s}")[0].startswith("0.300000 s: no further message within")


@pytest.mark.parametrize("wrong", ["{topic: /beat, again: 0}", "{topic: /beat, again: 1, eventually: msg.data}"])
def test_invalid_required_message_is_refused(tmp_path: Path, wrong: str) -> None:
    with pytest.raises(cfepy.UsageError):
        violations(tmp_path, wrong)
