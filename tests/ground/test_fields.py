"""Fields by their paths, of messages and of cFE packets, one at a time and as columns."""

from __future__ import annotations

from typing import Any

import numpy
import pytest

from cfepy.ground.fields import array_of, columns_of, path_of, steps_of, value_at, values_at
from rospy_shim.types.msgs import message_class


def a_pose(x: float = 1.5) -> Any:
    pose = message_class("geometry_msgs/PoseStamped")()
    pose.header.stamp.secs, pose.header.stamp.nsecs = 3, 250_000_000
    pose.pose.position.x = x
    return pose


@pytest.mark.parametrize("path", ["pose.position.x", "pose/position/x", "/pose/position/x", "pose.position/x"])
def test_a_path_is_written_as_in_python_or_as_for_rostopic(path: str) -> None:
    assert value_at(a_pose(), steps_of(path)) == 1.5
    assert path_of(steps_of(path)) == "pose.position.x"


@pytest.mark.parametrize(
    ("path", "value"),
    [
        ("Rows[1].Count", 7),
        ("Rows.1.Count", 7),
        ("Grid[1][0]", 3),
        ("Grid[0][-1]", 2),
        ("Grid[0][0:1]", [1]),
        ("Grid[1][:]", [3, 4]),
        ("Name", "HK"),
    ],
)
def test_fields_of_packets_and_items_of_arrays(path: str, value: object) -> None:
    packet = {"Rows": [{"Count": 1}, {"Count": 7}], "Grid": [[1, 2], [3, 4]], "Name": "HK"}
    assert value_at(packet, steps_of(path)) == value


@pytest.mark.parametrize("path", ["nose", "pose.position.x.y", "pose[0]", "header.frame_id[0]", "pose position", "a[]"])
def test_missing_field_is_an_error(path: str) -> None:
    with pytest.raises(LookupError):
        value_at(a_pose(), steps_of(path))
    with pytest.raises(LookupError):
        values_at([a_pose(), a_pose()], steps_of(path))


def test_a_value_that_some_messages_lack() -> None:
    messages = [{"ranges": [1.0, 2.0]}, {"ranges": [3.0]}]
    assert values_at(messages, steps_of("ranges[1]")) == [2.0, None]
    column = dict(columns_of(messages))["ranges[1]"]
    assert column[0] == 2.0
    assert numpy.isnan(column[1])


@pytest.mark.parametrize(
    ("values", "kind", "shape"),
    [
        ([1, 2, 3], "i", (3,)),
        ([1.0, None], "f", (2,)),
        ([True, False], "b", (2,)),
        ([(1.0, 2.0), (3.0, 4.0)], "f", (2, 2)),
        ([[[1, 2]], [[3, 4]]], "i", (2, 1, 2)),
        ([(), ()], "f", (2, 0)),
        ([(1.0,), (1.0, 2.0)], "O", (2,)),
        ([b"ab", b"cd"], "u", (2, 2)),
        ([b"ab", b"c"], "O", (2,)),
        (["a", "b"], "O", (2,)),
        ([["a", "b"]], "O", (1,)),
        ([], "O", (0,)),
    ],
)
def test_arrays(values: list[Any], kind: str, shape: tuple[int, ...]) -> None:
    array = array_of(values)
    assert (array.dtype.kind, array.shape) == (kind, shape)


def test_a_time_is_in_seconds() -> None:
    assert array_of(values_at([a_pose()], steps_of("header.stamp"))).tolist() == [3.25]


def test_columns_of_a_message() -> None:
    columns = dict(columns_of([a_pose(1.0), a_pose(2.0)]))
    assert list(columns)[:4] == ["header.seq", "header.stamp", "header.frame_id", "pose.position.x"]
    assert columns["pose.position.x"].tolist() == [1.0, 2.0]


def test_columns_of_arrays_of_structs_and_of_bytes() -> None:
    packets = [{"Rows": [{"Count": 1}, {"Count": 2}], "Blob": b"\0\1"}, {"Rows": [{"Count": 3}], "Blob": b""}]
    columns = dict(columns_of(packets))
    assert list(columns) == ["Rows[0].Count", "Rows[1].Count", "Blob"]
    assert columns["Rows[0].Count"].tolist() == [1, 3]
    assert columns["Blob"].tolist() == [b"\0\1", b""]
