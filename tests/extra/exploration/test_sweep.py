"""Findings of a sweep: received rates, losses, and the knee."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from cfepy.cli.text_table import show_tables
from cfepy.extra.exploration.batch import answers
from cfepy.extra.exploration.commands.sweep import table_of
from cfepy.extra.exploration.sweep import Point, PointNumbers, Sweep, SweepRow, TopicNumbers, knees, sweep_table
from cfepy.extra.exploration.sweep_points import points_of
from cfepy.extra.exploration.worker_pools import make_crew
from cfepy.mission import read_mission
from cfepy.pilot.plan import RunPlan
from tests.mission.flights import write_mission

TOPICS = ("/left_to_right", "/right_to_left")


def numbers(came_hz: float, lost: int = 0, problem: str = "") -> PointNumbers:
    topic = TopicNumbers("/a", 10, 10, lost, 0, came_hz, 1.0, 2.0)
    return PointNumbers("small", topics=(topic,), problem=problem)


def row(rate_hz: float, came_hz: float, seed: int = 0, lost: int = 0) -> SweepRow:
    return SweepRow(Point(rate_hz=rate_hz, seed=seed), numbers(came_hz, lost), ())


def test_knee_is_the_first_rate_with_losses() -> None:
    (knee,) = knees([row(10, 10), row(100, 99.5), row(200, 150), row(400, 400)])
    assert (knee.clean_hz, knee.broken_hz) == (100, 200)
    assert knee.text == "small: clean up to 100 Hz; at 200 Hz /a came at 150.0 Hz"


def test_rate_is_clean_only_if_it_is_clean_for_all_seeds() -> None:
    (knee,) = knees([row(10, 10), row(10, 10, seed=1), row(20, 20), row(20, 20, seed=1, lost=1)])
    assert (knee.clean_hz, knee.broken_hz, knee.why) == (10, 20, "/a lost 1 of 10")


def test_no_knee() -> None:
    assert knees([row(10, 10)])[0].text == "small: clean up to 10 Hz, the highest rate that was flown"
    assert knees([row(10, 5)])[0].text == "small: not clean at any rate; at 10 Hz /a came at 5.0 Hz"
    assert knees([SweepRow(Point(), numbers(5), ())]) == []


def test_failed_run_is_not_clean() -> None:
    assert numbers(10, problem="ARM died").why_not_clean(10) == "ARM died"
    assert PointNumbers().why_not_clean(None) == "no message came"
    assert numbers(5).why_not_clean(None) == ""


def test_topic_without_messages_is_not_the_slowest(capsys: pytest.CaptureFixture[str]) -> None:
    spoken = TopicNumbers("/a", 10, 10, 0, 0, 50.0, 1.0, 2.0)
    silent = TopicNumbers("/b", 0, 0, 0, 0, 0.0, 0.0, 0.0)
    found = SweepRow(Point(rate_hz=50), PointNumbers("small", topics=(silent, spoken)), ())
    show_tables([table_of([found])], sys.stdout)
    assert "50.0" in capsys.readouterr().out
    assert found.why_not_clean == "no message of /b was measured"


TALKER = """
    import rospy
    from std_msgs.msg import Int8

    rospy.init_node("talker")
    talk = rospy.Publisher("talk", Int8, queue_size=9)
    while not rospy.is_shutdown():
        talk.publish()
        rospy.sleep(0.1)
"""
TALKERS = "CFE_APP, talker, __main__, TALKER, 100, 16384, 0, 0;\n"
LISTENER = """
    import rospy
    from std_msgs.msg import {kind}

    rospy.init_node("listener")
    rospy.Subscriber("{topic}", {kind}, print)
    rospy.spin()
"""


@pytest.mark.parametrize("topics", [(), ("/talk",)])
@pytest.mark.parametrize(
    ("listens", "loose_end"),
    [
        ("", "published without a subscriber: /talk of /talker"),
        ("/talks", "/talks: /listener subscribed, but no node publishes; did you mean /talk?"),
        (
            "/talk",
            "/talk: /listener has the type std_msgs/Empty, but the topic has std_msgs/Int8, so it is not connected",
        ),
    ],
)
def test_topic_without_subscriber_is_the_reason_why_no_message_came(
    tmp_path: Path, listens: str, loose_end: str, topics: tuple[str, ...], capsys: pytest.CaptureFixture[str]
) -> None:
    nodes = {"talker": TALKER}
    if listens:
        nodes["listener"] = LISTENER.format(topic=listens, kind="Empty" if listens == "/talk" else "Int8")
    startup = TALKERS + (TALKERS.replace("talker", "listener").replace("TALKER", "LISTENER") if listens else "")
    found = Sweep(RunPlan((write_mission(tmp_path, startup + "!", **nodes),), seconds=1.5), topics).judge(Point())
    said = "no message of /talk was measured" if topics else "no message came"
    assert found.why_not_clean(10) == f"{said}; {loose_end}"
    show_tables([table_of([SweepRow(Point(), found, ())])], sys.stdout)
    assert " us" not in capsys.readouterr().out, "no latency was measured"


def test_a_point_of_the_board_mission() -> None:
    (point, varied), *_ = points_of(read_mission("rx64m_pubsub"), [None], [160], [], [0])
    found = Sweep(RunPlan(("rx64m_pubsub",), seconds=2), TOPICS).judge(point)
    assert found.board == "rx64m"
    assert [topic.name for topic in found.topics] == list(TOPICS)
    assert [topic.delivered_hz for topic in found.topics] == pytest.approx([100, 100], rel=0.01)
    assert found.why_not_clean(160).startswith("/left_to_right came at 100.0 Hz, ")
    heads, cells = sweep_table([SweepRow(point, found, varied)])
    assert [dict(zip(heads, each, strict=True))["topic"] for each in cells] == list(TOPICS)


def test_invalid_sweep_point_is_a_problem(tmp_path: Path) -> None:
    found = Sweep(RunPlan((str(tmp_path),))).judge(Point())
    assert found.problem
    assert not found.trouble


@pytest.mark.slow
def test_the_knee_of_two_boards_from_any_number_of_processes() -> None:
    points = points_of(read_mission("rx64m_pubsub"), ["rx64m", "linux"], [100, 125, 1000], [], [0])
    lot = Sweep(RunPlan(("rx64m_pubsub",), seconds=3), TOPICS)
    here = [lot.judge(point) for point, _ in points]
    for jobs in (1, 2):
        assert [each for _, each in sorted(answers(lot, [each for each, _ in points], make_crew(6, jobs)))] == here
    small, large = knees([SweepRow(point, each, varied) for (point, varied), each in zip(points, here, strict=True)])
    assert (small.clean_hz, small.broken_hz) == (100, 125)
    assert (large.clean_hz, large.broken_hz) == (1000, None)
