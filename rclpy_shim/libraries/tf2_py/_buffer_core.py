"""`BufferCore`: the Python interface of tf2's C++ core in ROS 2, with its argument names, results and error texts."""

from __future__ import annotations

from typing import Any

from geometry_msgs.msg import TransformStamped
from rclpy.logging import get_logger
from rclpy.time import Time

from tf2_py import _reports
from tf2_py._cache import StaticCache, TimeCache, seconds
from tf2_py._checks import problems_of
from tf2_py._exceptions import InvalidArgumentException, LookupException, TransformException
from tf2_py._rotation import IDENTITY, Rigid, Sample, product
from tf2_py._tree import Tree

_CACHE_TIME_NS = 10_000_000_000
_SELF_TRANSFORM = 'with frame_id and  child_frame_id "{}" because they are the same'
_NS_PER_S = 1_000_000_000
_OLD_DATA = (
    "TF_OLD_DATA ignoring data from the past for frame {} at time {} according to authority {}\n"
    "Possible reasons are listed at http://wiki.ros.org/tf/Errors%20explained"
)


class _Samples(TimeCache):
    """Samples over time with ROS 2's error texts. Repeated data are dropped without a word."""

    __slots__ = ()

    def complaint(self, time: int) -> str:
        """Return the reason why there is no sample at a time."""
        if not self._stamps:
            return ""
        first, last, asked = self._stamps[0], self._stamps[-1], _shown(time)
        if first == last:
            only = f"but only time {_shown(last)} is in the buffer"
            return f"Lookup would require extrapolation at time {asked}, {only}"
        way, end, edge = ("future", "latest", last) if time > last else ("past", "earliest", first)
        text = f"Lookup would require extrapolation into the {way}.  Requested time {asked}"
        return f"{text} but the {end} data is at time {_shown(edge)}"

    def insert(self, stamp: int, sample: Sample) -> str:
        """Take in a sample. Returns a text if it is too old."""
        if stamp in self._stamps:
            return ""
        return super().insert(stamp, sample)


def _shown(time_ns: int) -> str:
    return f"{seconds(time_ns):.6f}"


def _ns(time: Any) -> int:
    """Return the ns of an rclpy.time.Time, or of builtin_interfaces/Time.

    Raises:
        TypeError: it is neither.
    """
    if hasattr(time, "sec") and hasattr(time, "nanosec"):
        return int(time.sec) * _NS_PER_S + int(time.nanosec)
    if hasattr(time, "nanoseconds"):
        return int(time.nanoseconds)
    raise TypeError("time must have sec and nanosec, or nanoseconds.")


class BufferCore:
    """A buffer of transforms, 10 s long by default.

    Args:
        cache_time: how long samples are kept, an rclpy.duration.Duration.
    """

    def __init__(self, cache_time: Any = None) -> None:
        self.__keep_ns = _CACHE_TIME_NS if cache_time is None else _ns(cache_time)
        self.__tree = Tree()
        self.__authorities: dict[str, str] = {}
        self.__log = get_logger("tf2")

    # -- filling -----------------------------------------------------------------------------------------------------

    def set_transform(self, transform: Any, authority: str) -> None:
        """Add a transform at its stamp. An invalid one is logged and left out.

        Args:
            transform: geometry_msgs/TransformStamped.
            authority: name of the sender.
        """
        self.__set(transform, authority, is_static=False)

    def set_transform_static(self, transform: Any, authority: str) -> None:
        """Add a transform that is valid at all times; see `set_transform`."""
        self.__set(transform, authority, is_static=True)

    def __set(self, message: Any, authority: str, *, is_static: bool) -> None:
        child = message.child_frame_id.removeprefix("/")
        parent = message.header.frame_id.removeprefix("/")
        t, r = message.transform.translation, message.transform.rotation
        rigid: Rigid = (t.x, t.y, t.z, r.x, r.y, r.z, r.w)
        problems = problems_of(child, parent, rigid, authority, _SELF_TRANSFORM)
        for text in problems:
            self.__log.error(text)
        if problems:
            return
        stamp, caches = _ns(message.header.stamp), self.__tree.caches
        cache = caches.get(child)
        if cache is None or isinstance(cache, StaticCache) != is_static:
            cache = caches[child] = StaticCache() if is_static else _Samples(self.__keep_ns)
        if cache.insert(stamp, (parent, *rigid)):
            self.__log.warning(_OLD_DATA.format(child, _shown(stamp), authority))
            return
        caches.setdefault(parent, None)
        self.__authorities[child] = authority

    def clear(self) -> None:
        """Remove all samples that are not static. The frames stay known."""
        for cache in self.__tree.caches.values():
            if cache is not None:
                cache.clear()

    # -- looking up --------------------------------------------------------------------------------------------------

    def lookup_transform_core(self, target_frame: str, source_frame: str, time: Any) -> Any:
        """Return the transform that takes coordinates in the source frame to the target frame.

        Args:
            target_frame: name of a frame.
            source_frame: name of a frame.
            time: the time; 0 for the latest common one.

        Returns:
            geometry_msgs/TransformStamped.

        Raises:
            LookupException, ConnectivityException, ExtrapolationException, InvalidArgumentException: it is not
                available.
        """
        at = _ns(time)
        self.__validate("lookupTransform argument target_frame", target_frame)
        self.__validate("lookupTransform argument source_frame", source_frame)
        return _message(target_frame, source_frame, *self.__lookup(target_frame, source_frame, at))

    def lookup_transform_full_core(
        self, target_frame: str, target_time: Any, source_frame: str, source_time: Any, fixed_frame: str
    ) -> Any:
        """Return the transform from the source frame at one time to the target frame at another.

        Args:
            target_frame: name of a frame.
            target_time: its time; 0 for the latest.
            source_frame: name of a frame.
            source_time: its time; 0 for the latest.
            fixed_frame: the frame that does not move in between.

        Returns:
            geometry_msgs/TransformStamped, with the target's time.

        Raises:
            LookupException, ConnectivityException, ExtrapolationException, InvalidArgumentException: as
                `lookup_transform_core`.
        """
        at_target, at_source = _ns(target_time), _ns(source_time)
        for role, name in (("target", target_frame), ("source", source_frame), ("fixed", fixed_frame)):
            self.__validate(f"lookupTransform argument {role}_frame", name)
        _, first = self.__lookup(fixed_frame, source_frame, at_source)
        when, second = self.__lookup(target_frame, fixed_frame, at_target)
        return _message(target_frame, source_frame, when, product(second, first))

    def __lookup(self, target: str, source: str, time: int) -> tuple[int, Rigid]:
        tree = self.__tree
        if target == source:
            cache = None if time else tree.caches.get(target)
            return (time if cache is None else cache.latest()[0]), IDENTITY
        return tree.transform(target, source, time)

    def __validate(self, role: str, name: str) -> None:
        if problem := _name_problem(name):
            raise InvalidArgumentException(f'Invalid argument "{name}" passed to {role} - {problem}')
        if name not in self.__tree.caches:
            raise LookupException(f'"{name}" passed to {role} does not exist. ')

    # -- asking ------------------------------------------------------------------------------------------------------

    def can_transform_core(self, target_frame: str, source_frame: str, time: Any) -> tuple[int, str]:
        """Return whether `lookup_transform_core` would succeed: 1 or 0, and why not."""
        at = _ns(time)
        problem = self.__unknown("canTransform", target=target_frame, source=source_frame)
        return (0, problem) if problem else self.__try(target_frame, source_frame, at)

    def can_transform_full_core(
        self, target_frame: str, target_time: Any, source_frame: str, source_time: Any, fixed_frame: str
    ) -> tuple[int, str]:
        """Return whether `lookup_transform_full_core` would succeed: 1 or 0, and why not."""
        at_target, at_source = _ns(target_time), _ns(source_time)
        problem = self.__unknown("canTransform", target=target_frame, source=source_frame, fixed=fixed_frame)
        if problem:
            return 0, problem
        is_possible, problem = self.__try(target_frame, fixed_frame, at_target)
        return self.__try(fixed_frame, source_frame, at_source) if is_possible else (0, problem)

    def __unknown(self, function: str, **frames: str) -> str:
        for role, name in frames.items():
            problem = _name_problem(name) or ("" if name in self.__tree.caches else "frame does not exist")
            if problem:
                return f'Invalid frame ID "{name}" passed to {function} argument {role}_frame - {problem}'
        return ""

    def __try(self, target: str, source: str, time: int) -> tuple[int, str]:
        try:
            self.__tree.path(target, source, time)
        except TransformException as problem:
            return 0, str(problem)
        return 1, ""

    def get_latest_common_time(self, target_frame: str, source_frame: str) -> Time:
        """Return the latest time that all frames between two have in common.

        Raises:
            InvalidArgumentException, LookupException: a frame is unknown.
            TransformException: the frames are not connected.
        """
        self.__validate("get_latest_common_time", target_frame)
        self.__validate("get_latest_common_time", source_frame)
        try:
            return Time(nanoseconds=self.__tree.latest_common_time(target_frame, source_frame))
        except TransformException as problem:
            raise TransformException(str(problem)) from None

    # -- reports -----------------------------------------------------------------------------------------------------

    def all_frames_as_string(self) -> str:
        """Return a line for each frame that has a parent."""
        return str(self.__tree.as_string())

    def all_frames_as_yaml(self) -> str:
        """Return the frames with parent, authority, rate and times, as YAML."""
        return str(_reports.as_yaml(self.__tree, self.__authorities))

    def _allFramesAsDot(self, time: Any = None) -> str:
        return str(_reports.as_dot(self.__tree, self.__authorities, 0 if time is None else _ns(time)))

    def _frameExists(self, frame_id: str) -> bool:
        return frame_id in self.__tree.caches

    def _getFrameStrings(self) -> list[str]:
        return list(self.__tree.caches)


def _name_problem(name: str) -> str:
    if not name:
        return "in tf2 frame_ids cannot be empty"
    return "in tf2 frame_ids cannot start with a '/'" if name.startswith("/") else ""


def _message(target: str, source: str, time: int, rigid: Rigid) -> Any:
    """Return the result of a lookup as geometry_msgs/TransformStamped."""
    found = TransformStamped()
    found.header.stamp = Time(nanoseconds=time).to_msg()
    found.header.frame_id, found.child_frame_id = target, source
    t, r = found.transform.translation, found.transform.rotation
    t.x, t.y, t.z, r.x, r.y, r.z, r.w = rigid
    return found
