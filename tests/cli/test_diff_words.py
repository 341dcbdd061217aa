"""`cfepy diff` in words: the timer, the message and its values, or the step in which two versions of a node differ."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from cfepy.cli.journal.diff import TopicDifference, ranked
from cfepy.cli.main import main
from cfepy.cli.run.record_event import (
    MESSAGE,
    OTHER,
    OVER,
    TIMER,
    RecordEvent,
    difference_lines,
    line_difference,
    value_texts,
)
from tests.mission.flights import write_mission

STARTUP = """
    CFE_APP, talker.py, __main__, TALKER, 100, 16384, 0x0, 0;
    CFE_APP, hearer.py, __main__, HEARER, 100, 16384, 0x0, 0;
    !
"""
TALKER = """
    import rospy
    from std_msgs.msg import Float64

    rospy.init_node("talker")
    pub = rospy.Publisher("x", Float64, queue_size=1)
    rospy.sleep(0.2)
    for n in range(4):
        pub.publish(n * GAIN)
        rospy.sleep(PERIOD)
    rospy.spin()
"""
HEARER = """
    import rospy
    from std_msgs.msg import Float64

    rospy.init_node("hearer")
    rospy.Subscriber("x", Float64, lambda message: None)
    rospy.spin()
"""
RUNS = ("a", "b")


def recorded(folder: Path, name: str, gain: str = "1.0", period: str = "0.05") -> str:
    """Record a run of a version of the node; returns the journal."""
    folder.mkdir(exist_ok=True)
    write_mission(folder, STARTUP, talker=TALKER.replace("GAIN", gain).replace("PERIOD", period), hearer=HEARER)
    files = ["--record", f"{name}.cfepy", "--trace", f"{name}.trace"]
    assert main(["run", str(folder), "--for", "1", "--quiet", *files]) == 0
    return f"{name}.cfepy"


@pytest.fixture(autouse=True)
def _in_the_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def test_another_period_is_reported_as_a_timer(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    recorded(tmp_path / "m", "a")
    recorded(tmp_path / "m", "b", period="0.051")
    capsys.readouterr()
    assert main(["diff", "a.cfepy", "b.cfepy"]) == 1
    shown = capsys.readouterr().out
    assert re.search(
        r"^  the next timer, which TALKER waits for, is due at another time: "
        r"0\.8\d+ s in a\.cfepy, 0\.8\d+ s in b\.cfepy, 1 ms later\n"
        r"  talker\.py:10: rospy\.sleep\(0\.05\d?\)$|in a\.cfepy: talker\.py:10: rospy\.sleep\(0\.05\)$",
        shown,
        re.MULTILINE,
    )
    assert "topics and packets: the same values" in shown
    assert "record" not in shown.partition("records are alike")[2]
    assert main(["diff", "a.trace", "b.trace"]) == 1
    assert re.search(r"^  TALKER runs at another time: .*, 1 ms later$", capsys.readouterr().out, re.MULTILINE)


def test_another_value_is_reported_with_topic_field_and_change(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    recorded(tmp_path / "m", "a")
    recorded(tmp_path / "m", "b", gain="1.5")
    capsys.readouterr()
    assert main(["diff", "a.cfepy", "b.cfepy", "--lines", "1"]) == 1
    shown = capsys.readouterr().out
    values = "data 1 and 1.5 (+0.5)"
    assert f"  message 2 of /x from TALKER has other values in a.cfepy and b.cfepy: {values}\n" in shown
    assert f"  /x: 3 of 3 with other values, the first: {values}\n" in shown
    assert shown.index(values) < shown.index("before it, in both:") < shown.index("differ from byte 22 on")


def test_traces_name_all_tasks_and_pipes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    recorded(tmp_path / "m", "a")
    text = Path("a.trace").read_text(encoding="utf-8")
    assert "receive from HEARER.x.1" in text
    assert "CFE_ES_Main ended" in text
    assert not re.search(r"\b(task|pipe)-\d", text)


# -- sentences ---------------------------------------------------------------------------------------------------------


def said(one: RecordEvent, other: RecordEvent) -> list[str]:
    return list(difference_lines(one, other, RUNS))


def test_different_steps_are_both_reported() -> None:
    one = RecordEvent(OTHER, 1_000, "ARM", "dispatch, TALKER ended", "arm.py:3: wait()")
    assert said(one, RecordEvent(OVER, 2_000)) == [
        "the runs go on with different steps:",
        "in a: ARM runs, because TALKER has ended at 0.000001 s, arm.py:3: wait()",
        "in b: the run is over at 0.000002 s",
    ]


def test_timers_of_two_tasks_are_both_named() -> None:
    assert said(RecordEvent(TIMER, 5_000_000, "ARM", place="arm.py:3: x"), RecordEvent(TIMER, 4_000_000, "HAND")) == [
        "another timer is due next: 0.005000 s in a, 0.004000 s in b, 1 ms earlier",
        "in a, ARM waits for it, arm.py:3: x",
        "in b, HAND waits for it",
    ]


def test_message_without_known_fields_shows_its_bytes() -> None:
    one = RecordEvent(MESSAGE, 0, "ARM", "0x0890", data="0890c00000030000")
    assert said(one, RecordEvent(MESSAGE, 0, "ARM", "0x0890", data="0890c0000003a5a5")) == [
        "a message of 0x0890 from ARM has other values in a and b: from byte 6 on 00 00 and a5 a5"
    ]


def test_text_in_braces_is_not_a_template() -> None:
    one, other = (RecordEvent(OTHER, 0, "{ARM}", f"console {{task}} {each}") for each in "xy")
    assert [line.partition(" at ")[0] for line in said(one, other)[1:]] == [
        "in a: {ARM} prints: {task} x",
        "in b: {ARM} prints: {task} y",
    ]


def test_lines_that_are_no_records_have_no_sentence() -> None:
    assert list(line_difference([("a", "nonsense"), ("b", "0.000000001 ARM dispatch\n")])) == []


def test_values_show_the_change_of_numbers_only() -> None:
    one = {"sequence": "1", "data": "1", "frame": "map", "same": "4"}
    assert value_texts(one, {**one, "sequence": "2", "data": "0.25", "frame": "odom"}) == [
        "data 1 and 0.25 (-0.75)",
        "frame map and odom",
    ]


def test_messages_are_compared_one_by_one_without_headers() -> None:
    packet = bytes.fromhex("0890c0000003") + bytes(10)
    late = bytes.fromhex("0890c0010003") + bytes(9) + b"\x07"
    same, other, fewer = TopicDifference(), TopicDifference(), TopicDifference()
    for topic, pairs in ((same, ((packet + b"a", late + b"a"),)), (other, ((packet + b"a", late + b"b"),))):
        for one, two in pairs:
            topic.add(0, one)
            topic.add(1, two)
    fewer.add(1, packet)
    assert (same.is_same, other.other, fewer.counts) == (True, 1, [0, 1])
    assert other.pair == (packet + b"a", late + b"b")
    assert ranked([fewer, same, other]) == [other, fewer]
