"""Messages from plain values: each field or value that does not fit is named, with the remedy."""

from __future__ import annotations

from typing import Any

import pytest

from cfepy.ground.ros_side import filled
from cfepy.status import UsageError
from rospy_shim.types.msgs import shipped


@pytest.mark.parametrize(
    ("kind", "fields", "problem"),
    [
        (
            "trajectory_msgs/JointTrajectory",
            {"points": [{}, {"time_from_start": 2.5}]},
            "points[1].time_from_start: must be a time such as {secs: 2, nsecs: 500000000}, not 2.5",
        ),
        ("std_msgs/Time", {"data": "now"}, "data: must be a time such as {secs: 1}, not 'now'"),
        ("std_msgs/Time", {"data": {"sec": 1}}, "data.sec: unknown field of a time; did you mean secs?"),
        ("std_msgs/Time", {"data": float("inf")}, "data: must be a time such as {secs: 1}, not inf"),
        ("std_msgs/Empty", {"data": 1}, "data: std_msgs/Empty has no fields"),
        ("nav_msgs/Path", {"poses": 3}, "poses: must be a list, not 3"),
        ("nav_msgs/Path", {"poses": [{"pose": 3}]}, "poses[0].pose: must be a geometry_msgs/Pose such as"),
        (
            "geometry_msgs/Twist",
            {"linear": {"q": 1}},
            "linear.q: unknown field of geometry_msgs/Vector3; expected x, y",
        ),
        ("geometry_msgs/PoseWithCovariance", {"covariance": [1]}, "invalid geometry_msgs/PoseWithCovariance: Field"),
    ],
)
def test_value_that_does_not_fit_is_named(kind: str, fields: dict[str, Any], problem: str) -> None:
    with pytest.raises(UsageError) as caught:
        filled(shipped(), kind, fields)
    assert problem in str(caught.value)


@pytest.mark.parametrize(
    ("kind", "fields"),
    [
        ("trajectory_msgs/JointTrajectory", {"points": [{"positions": (1, 2), "time_from_start": {"secs": 2}}]}),
        ("std_msgs/Time", {"data": 1_500_000_000}),
        ("std_msgs/Time", {"data": [1, 2]}),
        ("geometry_msgs/Twist", {"linear": [1, 2, 3], "angular": {}}),
        ("sensor_msgs/Image", {"data": "text", "header": {"frame_id": "f"}}),
        ("std_msgs/String", {"data": None}),
    ],
)
def test_value_that_fits_is_accepted(kind: str, fields: dict[str, Any]) -> None:
    assert filled(shipped(), kind, fields)._type == kind
