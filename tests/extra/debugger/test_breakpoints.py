"""Breakpoints of a run: events, MsgIds, names, predicates; and invalid ones."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.extra.debugger.breakpoints import breakpoints
from cfepy.mission import MissionSpec, read_mission
from cfepy.pilot.pilot import fly
from cfepy.pilot.plan import RunPlan
from cfepy.status import UsageError

TALKER = """
import rospy
from std_msgs.msg import Int32, String
rospy.init_node("talker")
numbers = rospy.Publisher("/numbers", Int32, queue_size=10)
words = rospy.Publisher("/words", String, queue_size=10)
for number in range(5):
    rospy.sleep(0.1)
    numbers.publish(number)
    words.publish("word " * number)
rospy.logerr("that is all")
"""


@pytest.fixture
def plan(tmp_path: Path) -> RunPlan:
    """A run of a node that publishes numbers and words."""
    script = tmp_path / "talker.py"
    script.write_text(TALKER, encoding="utf-8")
    return RunPlan((str(script),), command="node", seconds=3)


def hits(plan: RunPlan, *texts: str) -> list[str]:
    """Return the hits of breakpoints in a run."""
    found: list[str] = []
    spec = plan.spec()
    fly(plan, attachments=breakpoints(texts, spec, found.append), spec=spec)
    return found


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("/nombers", "--break '/nombers' never matched"),
        ("CFE_TIME:99", "--break 'CFE_TIME:99' never matched"),
        ("msg.data == 77", "--break 'msg.data == 77' never matched"),
        ("/words", None),
    ],
)
def test_breakpoint_that_never_matched_is_reported(plan: RunPlan, text: str, why: str | None) -> None:
    spec = plan.spec()
    (point,) = breakpoints([text], spec, lambda what: None)
    fly(plan, attachments=[point], spec=spec)
    assert point.missed == why


def test_unknown_field_of_a_predicate_is_reported(plan: RunPlan) -> None:
    spec = plan.spec()
    (point,) = breakpoints(["msg.dat > 2"], spec, lambda what: None)
    fly(plan, attachments=[point], spec=spec)
    assert "does not apply to any message: /" in str(point.missed)
    assert "'dat'" in str(point.missed)


def test_a_topic(plan: RunPlan) -> None:
    assert hits(plan, "/numbers") == [f"/numbers of /talker: data: {number}" for number in range(5)]


def test_a_pattern_of_topics(plan: RunPlan) -> None:
    assert len(hits(plan, "/[nw]*s")) == 10


def test_a_predicate(plan: RunPlan) -> None:
    (found,) = hits(plan, "msg.data == 3 and sender == '/talker'")
    assert found.endswith("/numbers of /talker: data: 3")


def test_predicate_is_false_for_messages_without_its_fields(plan: RunPlan) -> None:
    assert len(hits(plan, "msg.data > 2")) == 2  # words are not numbers


def test_a_predicate_about_time_and_topic(plan: RunPlan) -> None:
    assert len(hits(plan, "topic == '/words' and t > 0.9")) == 2


def test_an_event_by_number_and_by_type(plan: RunPlan) -> None:
    (found,) = hits(plan, "CFE_TIME:1")
    assert found.startswith("event CFE_TIME 1 INFORMATION")
    assert {text.split()[1] for text in hits(plan, "*:INFORMATION")} > {"CFE_TIME", "CFE_TBL"}


@pytest.mark.parametrize("text", ["0x0808", "CFE_EVS_LONG_EVENT_MSG"])
def test_a_packet_by_msg_id_and_by_name(plan: RunPlan, text: str) -> None:
    found = hits(plan, text)
    assert found[0].startswith("CFE_EVS_LONG_EVENT_MSG (0x0808) of CFE_ES, 172 bytes: {'PacketID'")


def test_command_is_distinguished_from_others_with_its_msg_id() -> None:
    plan = RunPlan(("capture",), seconds=1.2)
    assert len(hits(plan, "CFE_TIME_ONEHZ_CMD")) == len(hits(plan, "0x1811")) == 1


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("CFE_EVS_LONG_EVENT_MSGG", "did you mean CFE_EVS_LONG_EVENT_MSG?"),
        ("nonsense", "; expected APP:ID"),
        ("HK:FOO", "invalid event type FOO; expected DEBUG, INFORMATION, ERROR or CRITICAL"),
        ("msg.x >", "invalid Python expression 'msg.x >'"),
        ("message.x > 3", "unknown name 'message'"),
    ],
)
def test_invalid_breakpoint_is_reported(text: str, why: str) -> None:
    spec: MissionSpec = read_mission("capture")
    with pytest.raises(UsageError, match="--break") as caught:
        breakpoints([text], spec, print)
    assert why in str(caught.value)
