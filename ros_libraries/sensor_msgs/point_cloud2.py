"""Reads and makes sensor_msgs/PointCloud2 messages.

Names, arguments and results match sensor_msgs 1.13; the code is cfepy's own.
"""

from __future__ import annotations

import math
import struct
import sys
from collections import namedtuple
from collections.abc import Collection, Iterable, Iterator, Sequence
from typing import Any

from genpy import Message

from sensor_msgs.msg import PointCloud2, PointField

_NONE: Iterable[tuple[int, int]] = []

# By datatype: code of `struct` and size in bytes.
_DATATYPES = {
    PointField.INT8: ("b", 1),
    PointField.UINT8: ("B", 1),
    PointField.INT16: ("h", 2),
    PointField.UINT16: ("H", 2),
    PointField.INT32: ("i", 4),
    PointField.UINT32: ("I", 4),
    PointField.FLOAT32: ("f", 4),
    PointField.FLOAT64: ("d", 8),
}


def read_points(
    cloud: Any,
    field_names: Collection[str] | None = None,
    skip_nans: bool = False,
    uvs: Iterable[tuple[int, int]] = _NONE,
) -> Iterator[tuple[Any, ...]]:
    """Yield the points of a cloud, row by row.

    Args:
        cloud: the PointCloud2.
        field_names: fields to read; all by default. They are returned in their order in the cloud.
        skip_nans: leave out points with a NaN in a field that is read.
        uvs: (column, row) of the points to read; all by default.

    Yields:
        a tuple of values for each point.

    Raises:
        AssertionError: `cloud` is something else.
        struct.error: its data are shorter than its header claims.
    """
    _check(cloud)
    unpack = struct.Struct(_get_struct_fmt(cloud.is_bigendian, cloud.fields, field_names)).unpack_from
    data, step, row = cloud.data, cloud.point_step, cloud.row_step
    chosen = list(uvs)
    if chosen:
        offsets: Iterable[int] = (row * v + step * u for u, v in chosen)
    else:
        offsets = (at for v in range(cloud.height) for at in range(row * v, row * v + step * cloud.width, step or 1))
    for at in offsets:
        point = unpack(data, at)
        if not (skip_nans and any(map(math.isnan, point))):
            yield point


def read_points_list(
    cloud: Any,
    field_names: Sequence[str] | None = None,
    skip_nans: bool = False,
    uvs: Iterable[tuple[int, int]] = _NONE,
) -> list[Any]:
    """Return the points as `read_points`, as a list of named tuples.

    Their names are the field names in the order given.
    """
    _check(cloud)
    names = [field.name for field in cloud.fields] if field_names is None else field_names
    kind: Any = namedtuple("Point", names)  # type: ignore[misc]  # the names are known at run time only
    return [kind._make(point) for point in read_points(cloud, names, skip_nans, uvs)]


def create_cloud(header: Any, fields: Sequence[Any], points: Sequence[Iterable[Any]]) -> Any:
    """Return a cloud of one row.

    Args:
        header: a std_msgs/Header.
        fields: PointFields.
        points: for each point the values of its fields, in the order of their offsets.

    Raises:
        struct.error: a point has too few or too many values, or one that does not fit.
    """
    layout = struct.Struct(_get_struct_fmt(False, fields))
    return PointCloud2(
        header=header,
        height=1,
        width=len(points),
        is_dense=False,
        is_bigendian=False,
        fields=fields,
        point_step=layout.size,
        row_step=layout.size * len(points),
        data=b"".join(layout.pack(*point) for point in points),
    )


def create_cloud_xyz32(header: Any, points: Sequence[Iterable[float]]) -> Any:
    """Return a cloud of one row with the fields x, y and z as float32; see `create_cloud`."""
    fields = [PointField(name, 4 * at, PointField.FLOAT32, 1) for at, name in enumerate("xyz")]
    return create_cloud(header, fields, points)


def _check(cloud: Any) -> None:
    is_cloud = isinstance(cloud, Message) and cloud._type == "sensor_msgs/PointCloud2"
    assert is_cloud, "cloud is not a sensor_msgs.msg.PointCloud2"


def _get_struct_fmt(is_bigendian: bool, fields: Iterable[Any], field_names: Collection[str] | None = None) -> str:
    """Return the format of a point up to the end of its last field that is read."""
    parts = [">" if is_bigendian else "<"]
    offset = 0
    for field in sorted(fields, key=lambda each: int(each.offset)):
        if field_names is not None and field.name not in field_names:
            continue
        if field.offset > offset:
            parts.append(f"{field.offset - offset}x")
            offset = field.offset
        if field.datatype not in _DATATYPES:
            print(f"Skipping unknown PointField datatype [{field.datatype}]", file=sys.stderr)
            continue
        code, size = _DATATYPES[field.datatype]
        parts.append(code * field.count)
        offset += size * field.count
    return "".join(parts)
