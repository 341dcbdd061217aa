"""Invariants of a mission file: read, judged with every message, and reported."""

from __future__ import annotations

import textwrap
from pathlib import Path

import pytest

from cfepy.mission import Mission, read_mission
from cfepy.monitors.record import InvariantRecord, InvariantRecords
from cfepy.monitors.run_rules import demands_of, judges_of
from cfepy.pilot.mission_check import check_mission
from cfepy.status import UsageError
from cfepy.writing.console import Console

COUNTER = """
import rospy
from std_msgs.msg import Int32

rospy.init_node("counter")
count = rospy.Publisher("count", Int32, queue_size=10)
answer = rospy.Publisher("answer", Int32, queue_size=10)
rate = rospy.Rate(10)
for i in (1, 2, 3, 5, 6):
    count.publish(i)
    rate.sleep()
    if i != 3:
        answer.publish(-i)
rospy.spin()
"""

CHECKS = """
class Twice:
    def __init__(self):
        self.total = 0

    def __call__(self, message):
        self.total += message.msg.data
        return self.total < 10 or "too much: %d at %.2f s on %s" % (self.total, message.t, message.topic)

    def end(self):
        assert self.total == 16, "the total is %d" % self.total


def fine(message):
    return True


def broken(message):
    return message.msg.no_such_field


def asserts(message):
    assert message.msg.data < 3, "%d is too much" % message.msg.data


def bare(message):
    assert message.msg.data < 3


def denies(message):
    return message.msg.data < 3
"""


def watched(folder: Path) -> Mission:
    """Return the mission in a folder, with the invariants of its mission file."""
    spec = read_mission(str(folder))
    return Mission(spec, console=Console(quiet=True), attachments=judges_of(spec))


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "counter.py").write_text(COUNTER, encoding="utf-8")
    (tmp_path / "checks.py").write_text(CHECKS, encoding="utf-8")
    (tmp_path / "startup.scr").write_text(
        "CFE_APP, counter.py, __main__, COUNTER, 100, 16384, 0x0, 0;\n!\n", encoding="utf-8"
    )
    return tmp_path


def held(folder: Path, invariants: str, seconds: float = 1.5) -> dict[str, InvariantRecord]:
    """Return the results of the invariants, by name."""
    text = textwrap.indent(textwrap.dedent(invariants).strip(), "  ")
    (folder / "mission.yaml").write_text(f"invariants:\n{text}\n", encoding="utf-8")
    with watched(folder) as mission:
        mission.run_for(seconds)
        mission.conclude()
    return mission.record.part(InvariantRecords)


def first(record: InvariantRecord) -> str:
    assert record.first is not None
    return record.first.text


def test_expression_is_judged_with_every_message(folder: Path) -> None:
    found = held(
        folder, '{small: {topic: /count, holds: "msg.data < 6"}, positive: {topic: /count, holds: "msg.data > 0"}}'
    )
    assert (found["small"].judged, found["small"].violated) == (5, 1)
    assert first(found["small"]) == "msg.data < 6 does not hold; msg.data is 6"
    assert found["small"].place == "mission.yaml:2"
    assert (found["positive"].judged, found["positive"].violated, found["positive"].first) == (5, 0, None)


def test_expression_can_use_the_previous_message(folder: Path) -> None:
    found = held(folder, 'no gap: {topic: /count, holds: "last is None or msg.data == last.data + 1"}')
    assert found["no gap"].violated == 1
    assert first(found["no gap"]).endswith("does not hold; last is data: 3, msg.data is 5, last.data is 3")


def test_expression_can_use_the_latest_message_of_another_topic(folder: Path) -> None:
    found = held(folder, """same: {topic: /answer, holds: "latest['/count'].data + msg.data == 0"}""")
    assert (found["same"].judged, found["same"].violated) == (4, 0)
    none = held(folder, """same: {topic: /count, when: "latest['/answer'] is not None", holds: "t > 0"}""")
    assert none["same"].judged == 4


def test_when_and_after_select_the_judged_messages(folder: Path) -> None:
    found = held(
        folder, 'late: {topic: /count, when: "msg.data != 5", after: 700 ms, holds: "msg.data > 2 and count > 2"}'
    )
    assert (found["late"].judged, found["late"].violated) == (2, 0)


def test_missing_answer_in_time_is_a_violation(folder: Path) -> None:
    text = """
        answered:
          topic: /count
          within: 150 ms
          then: {topic: /answer, holds: "msg.data == -cause.data"}
    """
    found = held(folder, text)
    assert (found["answered"].judged, found["answered"].violated) == (5, 1)
    assert first(found["answered"]) == "no answer within 0.15 s (msg.data == -cause.data) to /count"
    assert found["answered"].first is not None
    assert found["answered"].first.detail == "/count: data: 3"


def test_answer_still_in_time_at_the_end_is_not_judged(folder: Path) -> None:
    text = "answered: {topic: /count, within: 10 s, then: {topic: /answer}}"
    assert held(folder, text)["answered"].violated == 0


def test_class_judges_with_a_memory_and_a_final_verdict(folder: Path) -> None:
    found = held(folder, "total: {topic: /count, file: checks.py, function: Twice}")
    assert found["total"].violated == 3
    assert first(found["total"]).startswith("too much: 11 at 0.8")


@pytest.mark.parametrize(
    ("function", "text"),
    [("asserts", "3 is too much"), ("bare", "an assertion failed"), ("denies", "denies returned False")],
)
def test_function_rejects_by_assertion_or_false(folder: Path, function: str, text: str) -> None:
    found = held(folder, f"small: {{topic: /count, file: checks.py, function: {function}}}")["small"]
    assert found.violated == 3
    assert found.judged == 5
    assert first(found) == text
    assert found.first is not None
    assert found.first.detail.startswith("/count: data: 3")
    assert ("Traceback" in found.first.detail) == (function != "denies")


def test_failed_function_is_reported_once_and_not_called_again(folder: Path) -> None:
    found = held(
        folder, "{bad: {topic: /count, file: checks.py, function: broken}, good: {file: checks.py, function: fine}}"
    )
    assert found["bad"].violated == 1
    assert first(found["bad"]).startswith("could not be judged: AttributeError")
    assert found["good"].violated == 0
    assert found["good"].judged > 5


def test_failed_expression_is_reported_with_its_error(folder: Path) -> None:
    found = held(folder, 'typo: {topic: /count, holds: "msg.daat > 0"}')
    assert first(found["typo"]).startswith("could not be judged: AttributeError")
    assert "daat" in first(found["typo"])


def test_packets_are_named_as_in_the_dictionary(folder: Path) -> None:
    text = 'alive: {packet: CFE_ES_HK_TML, holds: "msg.CommandCounter == 0"}'
    with pytest.raises(
        UsageError,
        match=r"mission.yaml:\d+: invariants.alive: unknown telemetry packet CFE_ES_HK_TML; did you mean CFE_ES_HK_TLM",
    ):
        held(folder, text)
    found = held(folder, 'events: {packet: CFE_EVS_LONG_EVENT_MSG, holds: "msg.PacketID.EventType < 3"}')
    assert found["events"].judged > 5
    assert found["events"].violated == 0


def test_invariants_that_hold_do_not_change_the_trace(folder: Path) -> None:
    def digest() -> str:
        with watched(folder) as mission:
            mission.run_for(1.0)
            return mission.trace.digest()

    without = digest()
    (folder / "mission.yaml").write_text(
        'invariants: {small: {topic: /count, holds: "msg.data < 100"}}\n', encoding="utf-8"
    )
    assert digest() == without


@pytest.mark.parametrize(
    ("text", "error"),
    [
        ('{x: {topic: /count, holds: "msg.data <"}}', "invariants.x.holds: invalid Python expression 'msg.data <'"),
        ('{x: {topic: /count, holds: "mgs.data < 1"}}', "unknown name 'mgs'; did you mean msg?"),
        ("{x: {topic: /count}}", "invariants.x: missing condition; give"),
        ('{x: {holds: "True"}}', "missing message"),
        ('{x: {topic: count, holds: "True"}}', "invalid topic name 'count'; expected a full name"),
        ("{x: {topic: /count, within: 1}}", "`within` requires `then`"),
        ("{x: {topic: /count, within: soon, then: {topic: /a}}}", "must be a time such as"),
        ('{x: {topic: /count, holds: "True", then: {topic: /a}}}', "requires `within`"),
        ("{x: {file: no.py, function: f}}", "file not found"),
        (
            "{x: {file: checks.py, function: nobody}}",
            "unknown function or class",
        ),
        ("{x: {function: fine}}", "`function` requires `file`"),
        ('{x: {topic: /count, holds: "True", whne: "True"}}', "unknown field; did you mean when?"),
    ],
)
def test_mistakes_are_reported_with_their_line(folder: Path, text: str, error: str) -> None:
    (folder / "mission.yaml").write_text(f"invariants:\n  {text}\n", encoding="utf-8")
    with pytest.raises(UsageError) as caught:
        demands_of(read_mission(str(folder)))
    assert error in str(caught.value)
    assert caught.value.line == 2
    assert [finding for finding in check_mission(str(folder)) if error.split(": ")[-1] in finding.text]


def test_invariants_start_again_after_a_processor_reset(tmp_path: Path) -> None:
    (tmp_path / "apps.py").write_text(
        textwrap.dedent("""
        def Resets(cfe):
            for count in range(3):
                cfe.sb.transmit_msg(cfe.msg.telemetry(0x0890, bytes([count])))
                cfe.os.task_delay(100)
            cfe.es.reset_cfe(1)
    """),
        encoding="utf-8",
    )
    (tmp_path / "checks.py").write_text(
        textwrap.dedent("""
        class Grows:
            def __init__(self):
                self.seen = 0

            def __call__(self, message):
                self.seen += 1
                return self.seen < 4 and message.msg.data == bytes([self.seen - 1])
    """),
        encoding="utf-8",
    )
    (tmp_path / "startup.scr").write_text("CFE_APP, apps, Resets, RESETS, 50, 8192, 0, 0;\n!\n", encoding="utf-8")
    (tmp_path / "mission.yaml").write_text(
        textwrap.dedent("""
        invariants:
          few: {packet: 0x0890, file: checks.py, function: Grows}
          fresh: {packet: 0x0890, when: "msg.data == bytes(1)", holds: "latest['0x0890'] is None"}
    """),
        encoding="utf-8",
    )
    with watched(tmp_path) as mission:
        mission.run_for(2.0)
    assert mission.record.resets
    assert mission.record.part(InvariantRecords)["few"].judged >= 6
    assert mission.record.part(InvariantRecords)["few"].violated == 0
    assert mission.record.part(InvariantRecords)["fresh"].judged >= 2
    assert mission.record.part(InvariantRecords)["fresh"].violated == 0


ASKS = """
def Asks(cfe):
    for _ in range(2):
        cfe.sb.transmit_msg(cfe.msg.telemetry(0x0890, bytes(4)))
        cfe.os.task_delay(100)
        cfe.sb.transmit_msg(cfe.msg.telemetry(0x0891, bytes(4)))
        cfe.os.task_delay(400)
"""


def test_times_are_exact_to_the_nanosecond(tmp_path: Path) -> None:
    (tmp_path / "asks.py").write_text(ASKS, encoding="utf-8")
    (tmp_path / "startup.scr").write_text("CFE_APP, asks, Asks, ASKS, 50, 8192, 0, 0;\n!\n", encoding="utf-8")
    text = "never: {packet: 0x0890, holds: 'False'}"
    asked = held(tmp_path, text)["never"].first
    answered = held(tmp_path, text.replace("0x0890", "0x0891"))["never"].first
    assert asked is not None
    assert answered is not None
    after_ns, within_ns = asked.at_ns, answered.at_ns - asked.at_ns
    holds, then = "holds: 'False'", "then: {packet: 0x0891}"
    text = f"""
        both: {{packet: 0x0890, after: {after_ns} ns, {holds}}}
        one: {{packet: 0x0890, after: {after_ns + 1} ns, {holds}}}
        in time: {{packet: 0x0890, after: {after_ns} ns, within: {within_ns} ns, {then}}}
        too late: {{packet: 0x0890, after: {after_ns + 1} ns, within: {within_ns - 1} ns, {then}}}
    """
    found = {name: (each.judged, each.violated) for name, each in held(tmp_path, text, 2.0).items()}
    assert found == {"both": (2, 2), "one": (1, 1), "in time": (2, 0), "too late": (1, 1)}
