"""Fields of decoded messages by path, of one message or of many as numpy arrays, and their units.

A message is either as for a node, or a cFE packet as a mapping of its fields. A path is written as in Python, or as for
rostopic: `pose.position.x`, `pose/position/x`, `position[2]`, `position.2`, `position[1:3]`.
"""

from __future__ import annotations

import importlib
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from cfepy.mission import TopicMessage
from cfepy.status import UsageError
from cfepy.units import NS_PER_S

if TYPE_CHECKING:
    from numpy.typing import NDArray

_PART = re.compile(r"(\w+)((?:\[-?\d*(?::-?\d*)?\])*)")  # unambiguous, so that a long path is matched fast
_INDEX = re.compile(r"\[(-?\d*)(:?)(-?\d*)\]")


class MessageDecoder:
    """Creates messages from bytes, by the definition that came with them; each class is created once."""

    def __init__(self) -> None:
        self._classes: dict[str, Any] = {}

    def decode(self, message: TopicMessage) -> Any:
        """Return the message.

        Raises:
            UsageError: if its definition or its bytes are invalid.
        """
        header = message.header
        kind = self._classes.get(header["md5sum"])
        try:
            if kind is None:
                library = importlib.import_module("rospy_shim.types.msgs").library_of(
                    header["type"], header.get("message_definition", "")
                )
                kind = self._classes[header["md5sum"]] = library.message_class(header["type"])
            return kind().deserialize(message.data)
        except UsageError:
            raise
        except Exception as error:  # any exception of the generated code for bytes that are not such a message
            raise UsageError(f"invalid {header['type']}: {error}", file=message.topic) from None


# -- one message -------------------------------------------------------------------------------------------------------

Step = str | int | slice
"""One step into a value: the name of a field, an index, or a slice of an array."""


def steps_of(path: str) -> tuple[Step, ...]:
    """Return the steps to a field.

    Raises:
        LookupError: if it is not a path.
    """
    steps: list[Step] = []
    for part in filter(None, re.split(r"[./]", path)):
        match = _PART.fullmatch(part)
        if match is None:
            raise LookupError(path)
        try:
            steps.append(int(match[1]) if match[1].isdecimal() else match[1])
            steps += [_index(*found) for found in _INDEX.findall(match[2])]
        except ValueError:
            raise LookupError(path) from None
    return tuple(steps)


def _index(first: str, colon: str, last: str) -> Step:
    if colon:
        return slice(int(first) if first else None, int(last) if last else None)
    if not first:
        raise LookupError("[]")
    return int(first)


def path_of(steps: Iterable[Step]) -> str:
    """Return the path of steps in display form: `poses[2].position.x`."""
    text = ""
    for step in steps:
        if isinstance(step, str):
            text += f".{step}" if text else step
        elif isinstance(step, slice):
            text += f"[{'' if step.start is None else step.start}:{'' if step.stop is None else step.stop}]"
        else:
            text += f"[{step}]"
    return text


def value_at(message: Any, steps: Iterable[Step]) -> Any:
    """Return the value at the end of the steps.

    Raises:
        LookupError: if it does not exist.
    """
    value = message
    for step in steps:
        if not isinstance(step, str):
            if not isinstance(value, Sequence) or isinstance(value, str):
                raise LookupError(step)
            value = value[step]
        elif isinstance(value, Mapping):
            value = value[step]
        elif step in getattr(value, "__slots__", ()):
            value = getattr(value, step)
        else:
            raise LookupError(step)
    return value


def names_in(value: Any) -> tuple[str, ...]:
    """Return the names of the fields of a message or struct; empty for anything else, including times."""
    if isinstance(value, Mapping):
        return tuple(value)
    if hasattr(value, "to_nsec") or not hasattr(value, "_slot_types"):
        return ()
    return tuple(value.__slots__)


# -- many messages -----------------------------------------------------------------------------------------------------


def values_at(messages: Sequence[Any], steps: Sequence[Step]) -> list[Any]:
    """Return a field of each message; None for a message without it, such as the third item of a shorter array.

    Raises:
        LookupError: if no message has it.
    """
    found, is_there = [], False
    for message in messages:
        try:
            found.append(value_at(message, steps))
            is_there = True
        except LookupError:
            found.append(None)
    if not is_there:
        raise LookupError(path_of(steps))
    return found


def array_of(values: Sequence[Any]) -> NDArray[Any]:
    """Return values as an array, with the first axis counting them.

    Arrays of equal length become rows. Times and durations become float64 in s, and a missing number becomes NaN.
    Texts, structs and arrays of different lengths become objects.
    """
    import numpy

    if _are_rows(values):
        return numpy.array(values) if len(values[0]) else numpy.empty((len(values), 0))
    if values and all(isinstance(value, bytes) for value in values) and len({*map(len, values)}) == 1:
        return numpy.frombuffer(b"".join(values), numpy.uint8).reshape(len(values), -1)
    return column_of(values)


def column_of(values: Sequence[Any]) -> NDArray[Any]:
    """Return values as an array of one dimension; see `array_of`."""
    import numpy

    present = [value for value in values if value is not None]
    if present and all(hasattr(value, "to_nsec") for value in present):
        return numpy.array([numpy.nan if value is None else value.to_nsec() / NS_PER_S for value in values])
    if present and all(isinstance(value, int | float) for value in present):
        return numpy.array(values if len(present) == len(values) else [numpy.nan if v is None else v for v in values])
    column = numpy.empty(len(values), object)
    for number, value in enumerate(values):  # assigning them all at once would unpack lists
        column[number] = value
    return column


def columns_of(values: Sequence[Any], path: str = "") -> Iterator[tuple[str, NDArray[Any]]]:
    """Yield every number, time and text in values, by its path, each as a column; bytes are one value.

    Args:
        values: messages, or values of a field; None for a missing one.
        path: path of the field.
    """
    sample = next((value for value in values if value is not None), None)
    names = names_in(sample)
    for name in names:
        inner = [None if value is None else value_at(value, (name,)) for value in values]
        yield from columns_of(inner, f"{path}.{name}" if path else name)
    if isinstance(sample, list | tuple):
        yield from _columns_of_arrays(values, path)
    elif not names:
        yield path, column_of(values)


def _columns_of_arrays(values: Sequence[Any], path: str) -> Iterator[tuple[str, NDArray[Any]]]:
    import numpy

    if _are_rows(values) and not isinstance(values[0][0] if len(values[0]) else 0, list | tuple):
        rows = numpy.array(values)
        yield from ((f"{path}[{number}]", rows[:, number]) for number in range(len(values[0])))
        return
    for number in range(max(len(value) for value in values if value is not None)):
        items = [None if value is None or len(value) <= number else value[number] for value in values]
        yield from columns_of(items, f"{path}[{number}]")


def _are_rows(values: Sequence[Any]) -> bool:
    """Return whether all are arrays of numbers with the same lengths."""
    if not values or not all(isinstance(value, list | tuple) for value in values):
        return False
    if len({*map(len, values)}) != 1:
        return False
    return all(isinstance(item, int | float) for value in values for item in value) or (
        len(values[0]) > 0 and all(_are_rows([value[number] for value in values]) for number in range(len(values[0])))
    )


# -- units -------------------------------------------------------------------------------------------------------------

UNITS: Mapping[str, Mapping[str, str]] = {
    "geometry_msgs/Accel": {"linear": "m/s²", "angular": "rad/s²"},
    "geometry_msgs/Inertia": {"m": "kg", "com": "m"},
    "geometry_msgs/Point": {"x": "m", "y": "m", "z": "m"},
    "geometry_msgs/Point32": {"x": "m", "y": "m", "z": "m"},
    "geometry_msgs/Pose2D": {"x": "m", "y": "m", "theta": "rad"},
    "geometry_msgs/Transform": {"translation": "m"},
    "geometry_msgs/Twist": {"linear": "m/s", "angular": "rad/s"},
    "geometry_msgs/Wrench": {"force": "N", "torque": "N·m"},
    "nav_msgs/MapMetaData": {"resolution": "m"},
    "sensor_msgs/BatteryState": {
        "voltage": "V",
        "temperature": "°C",
        "current": "A",
        "charge": "Ah",
        "capacity": "Ah",
        "design_capacity": "Ah",
        "cell_voltage": "V",
        "cell_temperature": "°C",
    },
    "sensor_msgs/FluidPressure": {"fluid_pressure": "Pa"},
    "sensor_msgs/Illuminance": {"illuminance": "lx"},
    "sensor_msgs/Imu": {"angular_velocity": "rad/s", "linear_acceleration": "m/s²"},
    "sensor_msgs/JointState": {"position": "rad or m", "velocity": "rad/s or m/s", "effort": "N·m or N"},
    "sensor_msgs/LaserScan": {
        "angle_min": "rad",
        "angle_max": "rad",
        "angle_increment": "rad",
        "time_increment": "s",
        "scan_time": "s",
        "range_min": "m",
        "range_max": "m",
        "ranges": "m",
    },
    "sensor_msgs/MagneticField": {"magnetic_field": "T"},
    "sensor_msgs/NavSatFix": {"latitude": "°", "longitude": "°", "altitude": "m"},
    "sensor_msgs/Range": {"field_of_view": "rad", "min_range": "m", "max_range": "m", "range": "m"},
    "sensor_msgs/Temperature": {"temperature": "°C"},
    "trajectory_msgs/JointTrajectoryPoint": {
        "positions": "rad or m",
        "velocities": "rad/s or m/s",
        "accelerations": "rad/s² or m/s²",
        "effort": "N·m or N",
    },
}
"""Units by message type and field, from the definitions and REP 103. The unit of a field applies to everything in it
that has no unit of its own.
"""


def unit_at(message: Any, steps: Iterable[Step]) -> str:
    """Return the unit of a field of a message; "" if it is not known.

    Args:
        message: a message with the field.
        steps: steps to the field, see `cfepy.ground.fields.steps_of`.
    """
    value, unit = message, ""
    for step in steps:
        unit = UNITS.get(getattr(value, "_type", ""), {}).get(step, unit) if isinstance(step, str) else unit
        try:
            value = value_at(value, (step,))
        except LookupError:
            break  # this message's array is too short
    return "s" if hasattr(value, "to_nsec") else unit
