"""Results that must not depend on the schedule: their selection, comparison, and exclusions."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.extra.exploration.result_watch import Result, differences, digest_of
from cfepy.extra.exploration.trial import Trial
from cfepy.mission import read_mission
from cfepy.monitors.run_rules import demands_of
from cfepy.pilot.plan import RunPlan
from cfepy.schedules import Schedule
from cfepy.status import UsageError
from tests.extra.exploration import missions

NODE = """
    import rospy
    from geometry_msgs.msg import PointStamped

    rospy.init_node("pointer")
    points = rospy.Publisher("point", PointStamped, queue_size=10)
    for x in (1.0, 2.0):
        point = PointStamped()
        point.header.stamp = rospy.Time.now()
        point.point.x = x
        points.publish(point)
        print("sent", x)
    rospy.spin()
"""


def results(folder: Path, yaml: str) -> list[Result]:
    missions.write(folder, {"POINTER": NODE}, f"results:\n  {yaml}\n")
    verdict, found, *_ = Trial(RunPlan((str(folder),), seconds=0.7)).fly(Schedule())
    assert verdict.results == digest_of(found)
    return list(found)


def test_each_comparison_has_its_result(tmp_path: Path) -> None:
    found = results(tmp_path, "{/point: last, /nothing: last, /ram/none.txt: file, POINTER: output}")
    assert [each.name for each in found] == [
        "/point (last)",
        "/nothing (last)",
        "/ram/none.txt (file)",
        "POINTER (output)",
    ]
    assert found[0].text == "header: {frame_id: ''}, point: {x: 2.0, y: 0.0, z: 0.0}"
    assert [each.text for each in found[1:3]] == ["none", "none"]


def test_output_of_a_node_is_a_result(tmp_path: Path) -> None:
    yaml = "{POINTER: output}\nnodes: {POINTER: {name: pointer}}"
    assert [each.text for each in results(tmp_path, yaml)] == ["sent 1.0; sent 2.0"]


@pytest.mark.parametrize(
    ("compare", "text"),
    [("count", "2 messages"), ("sequence", "2 messages, the last is"), ("any order", "2 messages (")],
)
def test_all_messages(tmp_path: Path, compare: str, text: str) -> None:
    (found,) = results(tmp_path, f"/point: {compare}")
    assert found.text.startswith(text)


def test_patterns_give_a_result_for_each_topic(tmp_path: Path) -> None:
    assert [each.name for each in results(tmp_path, '"/p*": count')] == ["/point (count)"]


def test_times_are_ignored_by_default(tmp_path: Path) -> None:
    (with_times,) = results(tmp_path, "/point: {compare: last, ignore: [point.x]}")
    assert "stamp" in with_times.text
    assert "x:" not in with_times.text


def varied(folder: Path, compare: str, *changes: tuple[str, str]) -> tuple[Result, Result]:
    """Return a result, and the result after changes of the node's source."""
    source = NODE
    for old, new in changes:
        assert source.count(old) == 1
        source = source.replace(old, new)
    found: list[Result] = []
    for name, each in (("one", NODE), ("other", source)):
        missions.write(folder / name, {"POINTER": each}, f"results:\n  /point: {compare}\n")
        found += Trial(RunPlan((str(folder / name),), seconds=0.7)).fly(Schedule()).results
    return found[0], found[1]


@pytest.mark.parametrize(
    ("compare", "differs"),
    [("last", True), ("sequence", True), ("any order", False), ("count", False)],
)
def test_another_order_is_a_difference_of_a_sequence(tmp_path: Path, compare: str, differs: bool) -> None:
    one, other = varied(tmp_path, compare, ("(1.0, 2.0)", "(2.0, 1.0)"))
    assert (one.digest != other.digest) == differs


@pytest.mark.parametrize(
    ("compare", "differs"),
    [("last", False), ("sequence", True), ("any order", True), ("count", False)],
)
def test_another_message_is_a_difference_of_all(tmp_path: Path, compare: str, differs: bool) -> None:
    one, other = varied(tmp_path, compare, ("(1.0, 2.0)", "(1.5, 2.0)"))
    assert (one.digest != other.digest) == differs


@pytest.mark.parametrize("ignored", ["point", "point.x", "x"])
def test_field_is_ignored_by_its_path_or_the_end_of_its_path(tmp_path: Path, ignored: str) -> None:
    one, other = varied(tmp_path, f"{{compare: last, ignore: [header.stamp, {ignored}]}}", ("2.0", "3.0"))
    assert one.digest == other.digest
    one, other = varied(tmp_path, "{compare: last, ignore: [header.stamp, oint.x]}", ("2.0", "3.0"))
    assert one.digest != other.digest


def test_difference_has_both_values() -> None:
    one, other = Result("/a (last)", "1", "data: 1"), Result("/a (last)", "2", "data: 2")
    assert list(differences([one], [one])) == []
    assert list(differences([one], [other])) == [("/a (last)", "data: 2; under fifo data: 1")]
    assert list(differences([one], [])) == [("/a (last)", "none; under fifo data: 1")]
    assert list(differences([], [one])) == [("/a (last)", "data: 1; under fifo none")]
    assert digest_of([]) == ""
    assert digest_of([one]) != digest_of([other])


@pytest.mark.parametrize(
    ("text", "error"),
    [
        ("/a: lst", "results./a: unknown comparison 'lst'; did you mean last? (expected last, "),
        ("/a: {ignore: [x]}", "missing compare"),
        ("log.txt: file", "expected a path in the mission's file system, such as"),
        ("/a: output", "name the node's application"),
        ("/a: {compare: file, ignore: [x]}", "is only valid for messages, and /a has no fields"),
        ("/a: {compare: last, ignore: [x-y]}", "must be the path of a field"),
    ],
)
def test_mistakes_are_reported_with_their_line(tmp_path: Path, text: str, error: str) -> None:
    missions.write(tmp_path, {"POINTER": NODE}, f"results:\n  {text}\n")
    with pytest.raises(UsageError) as caught:
        demands_of(read_mission(str(tmp_path)))
    assert error in str(caught.value)
    assert caught.value.line == 2
