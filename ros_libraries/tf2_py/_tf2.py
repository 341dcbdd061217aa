"""`BufferCore`: the Python interface of tf2's C++ core, with its argument names, results and error texts.

Nothing here waits, so no lock is needed. Imports tf2_py only.
"""

from __future__ import annotations

import sys
from typing import Any

from tf2_py import _reports
from tf2_py._cache import StaticCache, TimeCache, seconds
from tf2_py._checks import does_not_exist, name_problem, problems_of
from tf2_py._exceptions import (
    ConnectivityException,
    ExtrapolationException,
    InvalidArgumentException,
    LookupException,
    TimeoutException,
    TransformException,
)
from tf2_py._messages import duration_to_ns, message_of, rigid_of, time_of, to_ns
from tf2_py._process_end import part_of, text_of
from tf2_py._rotation import IDENTITY, Rigid, product
from tf2_py._tree import Tree

__all__ = [
    "BufferCore",
    "ConnectivityException",
    "ExtrapolationException",
    "InvalidArgumentException",
    "LookupException",
    "TimeoutException",
    "TransformException",
]

_CACHE_TIME_NS = 10_000_000_000


class BufferCore:
    """A buffer of transforms, 10 s long by default.

    Args:
        cache_time: how long samples are kept, a rospy.Duration.
    """

    def __init__(self, cache_time: Any = None) -> None:
        self.__keep_ns = _CACHE_TIME_NS if cache_time is None else duration_to_ns(cache_time)
        self.__tree = Tree()
        self.__authorities: dict[str, str] = {}

    # -- filling -----------------------------------------------------------------------------------------------------

    def set_transform(self, transform: Any, authority: str) -> None:
        """Add a transform at its stamp. An invalid one is reported and left out, and something else ends the process.

        Args:
            transform: a geometry_msgs/TransformStamped.
            authority: name of the sender.

        Raises:
            TypeError: the stamp, the translation or the rotation lacks a part.
            SystemError: a part of the rotation is no number; -1 stands for it.
        """
        self.__set("set_transform", transform, authority, TimeCache(self.__keep_ns))

    def set_transform_static(self, transform: Any, authority: str) -> None:
        """Add a transform that is valid at all times. Arguments: see `set_transform`."""
        self.__set("set_transform_static", transform, authority, StaticCache())

    def __set(self, method: str, message: Any, authority: str, cache: TimeCache | StaticCache) -> None:
        _check_texts((2, authority))
        header, child = part_of(message, "header"), text_of(part_of(message, "child_frame_id")).removeprefix("/")
        parent = text_of(part_of(header, "frame_id")).removeprefix("/")
        stamp = to_ns(getattr(header, "stamp", None))
        rigid, is_spoilt = rigid_of(part_of(message, "transform"))
        problems = problems_of(child, parent, rigid, authority)
        for text in problems:
            _report("Error:  ", text)
        if not problems:
            self.__insert(child, parent, stamp, rigid, cache, authority)
        if is_spoilt:
            raise SystemError(
                f"<method '{method}' of '_tf2.BufferCore' objects> returned a result with an exception set"
            )

    def __insert(
        self, child: str, parent: str, stamp: int, rigid: Rigid, cache: TimeCache | StaticCache, authority: str
    ) -> None:
        """Add a sample, to the known cache of its frame or to a new one."""
        caches = self.__tree.caches
        known = caches.get(child)
        if known is None:
            known = caches[child] = cache
        caches.setdefault(parent, None)
        refused = known.insert(stamp, (parent, *rigid))
        if refused:
            at = f"for frame {child} (parent {parent}) at time {seconds(stamp):f} according to authority {authority}"
            _report("Warning:", f"{refused} {at}")
        else:
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
            time: a rospy.Time; 0 for the latest common one.

        Returns:
            a geometry_msgs/TransformStamped.

        Raises:
            LookupException, ConnectivityException, ExtrapolationException, InvalidArgumentException: it is not
                available.
        """
        _check_texts((1, target_frame), (2, source_frame))
        return message_of(target_frame, source_frame, *self.__lookup(target_frame, source_frame, to_ns(time)))

    def lookup_transform_full_core(
        self, target_frame: str, target_time: Any, source_frame: str, source_time: Any, fixed_frame: str
    ) -> Any:
        """Return the transform from the source frame at one time to the target frame at another.

        Args:
            target_frame: name of a frame.
            target_time: a rospy.Time; 0 for the latest.
            source_frame: name of a frame.
            source_time: a rospy.Time; 0 for the latest.
            fixed_frame: the frame that does not move in between.

        Returns:
            a geometry_msgs/TransformStamped, with the target's time.

        Raises:
            LookupException, ConnectivityException, ExtrapolationException, InvalidArgumentException: as
                `lookup_transform_core`.
        """
        _check_texts((1, target_frame))
        at_target = to_ns(target_time)
        _check_texts((3, source_frame))
        at_source = to_ns(source_time)
        _check_texts((5, fixed_frame))
        for role, name in (("target", target_frame), ("source", source_frame), ("fixed", fixed_frame)):
            self.__validate(f"lookupTransform argument {role}_frame", name)
        _, first = self.__lookup(fixed_frame, source_frame, at_source)
        when, second = self.__lookup(target_frame, fixed_frame, at_target)
        return message_of(target_frame, source_frame, when, product(second, first))

    def __lookup(self, target: str, source: str, time: int) -> tuple[int, Rigid]:
        """Return the time and transform of a way through the tree."""
        tree = self.__tree
        if target == source:
            cache = None if time else tree.caches.get(target)
            return (time if cache is None else cache.latest()[0]), IDENTITY
        if target not in tree.caches or source not in tree.caches:
            self.__validate("lookupTransform argument target_frame", target)
            self.__validate("lookupTransform argument source_frame", source)
        return tree.transform(target, source, time)

    def __validate(self, role: str, name: str) -> None:
        problem = name_problem(role, name)
        if problem:
            raise InvalidArgumentException(problem)
        if name not in self.__tree.caches:
            raise LookupException(f'"{name}" passed to {role} does not exist. ')

    # -- asking ------------------------------------------------------------------------------------------------------

    def can_transform_core(self, target_frame: str, source_frame: str, time: Any) -> tuple[int, str]:
        """Return whether `lookup_transform_core` would succeed: 1 or 0, and why not."""
        _check_texts((1, target_frame), (2, source_frame))
        at = to_ns(time)
        if target_frame == source_frame:
            return 1, ""
        frames = {"target_frame": target_frame, "source_frame": source_frame}
        problem = self.__unknown(frames)
        return (0, problem) if problem is not None else self.__try(target_frame, source_frame, at)

    def can_transform_full_core(
        self, target_frame: str, target_time: Any, source_frame: str, source_time: Any, fixed_frame: str
    ) -> tuple[int, str]:
        """Return whether `lookup_transform_full_core` would succeed: 1 or 0, and why not."""
        _check_texts((1, target_frame))
        at_target = to_ns(target_time)
        _check_texts((3, source_frame))
        at_source = to_ns(source_time)
        _check_texts((5, fixed_frame))
        frames = {"target_frame": target_frame, "source_frame": source_frame, "fixed_frame": fixed_frame}
        problem = self.__unknown(frames)
        if problem is not None:
            return 0, problem
        possible, problem = self.__try(target_frame, fixed_frame, at_target)
        return self.__try(fixed_frame, source_frame, at_source) if possible else (0, problem)

    def __unknown(self, frames: dict[str, str]) -> str | None:
        """Return the error in the names of frames. An ill-formed name is reported on the console and has no text."""
        for role, name in frames.items():
            problem = name_problem(f"canTransform argument {role}", name)
            if problem:
                _report("Warning:", problem)
                return ""
        unknown = [(role, name) for role, name in frames.items() if name not in self.__tree.caches]
        return " ".join(does_not_exist(role, name) for role, name in unknown) or None

    def __try(self, target: str, source: str, time: int) -> tuple[int, str]:
        try:
            self.__tree.path(target, source, time)
        except TransformException as problem:
            return 0, str(problem)
        return 1, ""

    def get_latest_common_time(self, target_frame: str, source_frame: str) -> Any:
        """Return the latest time that all frames between two have in common, a rospy.Time.

        Raises:
            InvalidArgumentException, LookupException: a frame is unknown.
            TransformException: the frames are not connected.
        """
        _check_texts((1, target_frame), (2, source_frame))
        self.__validate("get_latest_common_time", target_frame)
        self.__validate("get_latest_common_time", source_frame)
        try:
            latest = self.__tree.latest_common_time(target_frame, source_frame)
        except TransformException as problem:
            raise TransformException(str(problem)) from None
        return time_of(latest)

    # -- reports -----------------------------------------------------------------------------------------------------

    def all_frames_as_string(self) -> str:
        """Return a line for each frame that has a parent."""
        return self.__tree.as_string()

    def all_frames_as_yaml(self) -> str:
        """Return the frames with parent, authority, rate and times, as YAML."""
        return _reports.as_yaml(self.__tree, self.__authorities)

    def _allFramesAsDot(self, time: Any = None) -> str:
        return _reports.as_dot(self.__tree, self.__authorities, 0 if time is None else to_ns(time))

    def _chain(
        self, target_frame: str, target_time: Any, source_frame: str, source_time: Any, fixed_frame: str
    ) -> list[str]:
        _check_texts((1, target_frame))
        at_target = to_ns(target_time)
        _check_texts((3, source_frame))
        at_source = to_ns(source_time)
        _check_texts((5, fixed_frame))
        first = self.__tree.chain(fixed_frame, source_frame, at_source)
        second = self.__tree.chain(target_frame, fixed_frame, at_target)
        return (first[:-1] if second else first) + second

    def _frameExists(self, frame_id: str) -> bool:
        _check_texts((1, frame_id))
        return frame_id in self.__tree.caches

    def _getFrameStrings(self) -> list[str]:
        return list(self.__tree.caches)


def _check_texts(*arguments: tuple[int, Any]) -> None:
    """Refuse arguments that are not text for C, as the extension module does.

    Args:
        arguments: position and value of each.

    Raises:
        TypeError: one is not a text.
        ValueError: one has a NUL.
    """
    for position, value in arguments:
        if not isinstance(value, str):
            kind = "None" if value is None else type(value).__name__
            raise TypeError(f"argument {position} must be str, not {kind}")
        if "\0" in value:
            raise ValueError("embedded null character")


def _report(level: str, text: str) -> None:
    """A line of tf2's own log."""
    print(level, text, file=sys.stderr)
