"""sensor_msgs.point_cloud2 and tf2_sensor_msgs: clouds read, made and transformed."""

from __future__ import annotations

import math
from typing import Any

import pytest

from tests.ros_libraries.world import universe

NAN = math.nan


@pytest.fixture
def world() -> Any:
    return universe().importer


@pytest.fixture
def pc2(world: Any) -> Any:
    return world.load("sensor_msgs.point_cloud2")


def mixed(pc2: Any) -> Any:
    """Return two points of a float, a gap, a pair of uint16 and a byte, with bytes as ROS's sensor_msgs writes them."""
    kind = pc2.PointField
    fields = [kind("d", 10, kind.UINT8, 1), kind("x", 0, kind.FLOAT32, 1), kind("n", 6, kind.UINT16, 2)]
    return pc2.create_cloud(None, fields, [(1.5, 7, 8, 9), (NAN, 1, 2, 3)])


def test_create(pc2: Any) -> None:
    cloud = mixed(pc2)
    assert (cloud.point_step, cloud.row_step, cloud.width, cloud.height) == (11, 22, 2, 1)
    assert cloud.data.hex() == "0000c03f000007000800090000c07f00000100020003"


def test_read(pc2: Any) -> None:
    cloud = mixed(pc2)
    first, second = pc2.read_points(cloud)
    assert first == (1.5, 7, 8, 9)
    assert second[1:] == (1, 2, 3)
    assert list(pc2.read_points(cloud, skip_nans=True)) == [first]
    assert list(pc2.read_points(cloud, ("d", "n"), skip_nans=True)) == [(7, 8, 9), (1, 2, 3)]
    assert list(pc2.read_points(cloud, ("d",), uvs=[(1, 0), (0, 0)])) == [(3,), (9,)]


def test_rows_may_be_padded(pc2: Any) -> None:
    cloud = pc2.create_cloud_xyz32(None, [(1, 2, 3), (4, 5, 6)])
    cloud.width, cloud.height, cloud.row_step = 1, 2, 16
    cloud.data = cloud.data[:12] + b"pads" + cloud.data[12:]
    assert list(pc2.read_points(cloud)) == [(1, 2, 3), (4, 5, 6)]


def test_big_endian(pc2: Any) -> None:
    cloud = pc2.create_cloud_xyz32(None, [(1, 2, 3)])
    cloud.is_bigendian = True
    cloud.data = bytes.fromhex("3f8000004000000040400000")
    assert pc2.read_points_list(cloud, ["x", "y", "z"])[0].z == 3


def test_unknown_datatype_is_skipped(pc2: Any) -> None:
    kind = pc2.PointField
    assert pc2._get_struct_fmt(False, [kind("a", 0, 99, 1), kind("b", 4, kind.INT8, 1)]) == "<4xb"


def test_only_clouds_are_accepted(pc2: Any) -> None:
    with pytest.raises(AssertionError, match=r"not a sensor_msgs\.msg\.PointCloud2"):
        list(pc2.read_points("cloud"))


def test_transform(world: Any, pc2: Any) -> None:
    library = world.load("tf2_sensor_msgs")
    geometry = world.load("geometry_msgs.msg")
    transform = geometry.TransformStamped()
    transform.transform.translation.x = 10.0
    transform.transform.rotation.z = transform.transform.rotation.w = math.sqrt(0.5)
    fields = [pc2.PointField(name, 4 * at, pc2.PointField.FLOAT32, 1) for at, name in enumerate("xyzi")]
    moved = library.do_transform_cloud(pc2.create_cloud(None, fields, [(1, 2, 3, 4)]), transform)
    assert next(pc2.read_points(moved)) == pytest.approx((8, 1, 3, 4))
    assert moved.header is transform.header
