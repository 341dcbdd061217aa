"""`Buffer`: a buffer of transforms that can wait for them (tf2_ros.buffer)."""

from __future__ import annotations

import time as _time
from collections.abc import Callable
from typing import Any

from rclpy.clock import Clock
from rclpy.duration import Duration
from rclpy.task import Future
from tf2_py import BufferCore

from tf2_ros.buffer_interface import BufferInterface

_LOOK_S = 0.02  # period at which a wait looks
_JUMP = Duration(seconds=3.0)


class Buffer(BufferCore, BufferInterface):
    """A buffer of transforms.

    A wait sleeps, as in ROS 2: in a callback of a single-threaded executor, which also takes the transforms, it always
    lasts for the whole timeout.

    Args:
        cache_time: how long samples are kept; None for 10 s.
        node: offers the service `tf2_frames`; None for no service.
    """

    def __init__(self, cache_time: Duration | None = None, node: Any = None) -> None:
        BufferCore.__init__(self, cache_time)
        BufferInterface.__init__(self)
        self._new_data_callbacks: list[Callable[[], None]] = []
        self.clock = Clock() if node is None else node.get_clock()
        if node is not None:
            from tf2_msgs.srv import FrameGraph

            self.srv = node.create_service(FrameGraph, "tf2_frames", self._frames)

    def _frames(self, request: Any, response: Any) -> Any:
        response.frame_yaml = self.all_frames_as_yaml()
        return response

    def set_transform(self, transform: Any, authority: str) -> None:
        """Add a transform at its stamp; see `BufferCore.set_transform`."""
        super().set_transform(transform, authority)
        self._call_new_data_callbacks()

    def set_transform_static(self, transform: Any, authority: str) -> None:
        """Add a transform that is valid at all times; see `BufferCore.set_transform`."""
        super().set_transform_static(transform, authority)
        self._call_new_data_callbacks()

    def _call_new_data_callbacks(self) -> None:
        for callback in self._new_data_callbacks[:]:
            callback()

    # -- at once, or after a wait ------------------------------------------------------------------------------------

    def lookup_transform(self, target_frame: str, source_frame: str, time: Any, timeout: Duration | None = None) -> Any:
        """Return the transform from a source frame to a target frame.

        Args:
            target_frame: name of a frame.
            source_frame: name of a frame.
            time: the time; 0 for the latest common one.
            timeout: longest time to wait; None does not wait.

        Raises:
            tf2_py.TransformException: it is not available.
        """
        self.can_transform(target_frame, source_frame, time, timeout)
        return self.lookup_transform_core(target_frame, source_frame, time)

    def lookup_transform_full(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
        timeout: Duration | None = None,
    ) -> Any:
        """Return the transform from a source frame at one time to a target frame at another.

        Args:
            target_frame: name of a frame.
            target_time: its time; 0 for the latest.
            source_frame: name of a frame.
            source_time: its time; 0 for the latest.
            fixed_frame: the frame that does not move in between.
            timeout: longest time to wait; None does not wait.

        Raises:
            tf2_py.TransformException: it is not available.
        """
        frames = (target_frame, target_time, source_frame, source_time, fixed_frame)
        self.can_transform_full(*frames, timeout)
        return self.lookup_transform_full_core(*frames)

    def can_transform(
        self,
        target_frame: str,
        source_frame: str,
        time: Any,
        timeout: Duration | None = None,
        return_debug_tuple: bool = False,
    ) -> Any:
        """Return whether `lookup_transform` would succeed.

        Args:
            target_frame: name of a frame.
            source_frame: name of a frame.
            time: the time; 0 for the latest common one.
            timeout: longest time to wait; None does not wait.
            return_debug_tuple: return the reason, too.
        """
        found = self._waited(lambda: self.can_transform_core(target_frame, source_frame, time), timeout)
        return found if return_debug_tuple else found[0]

    def can_transform_full(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
        timeout: Duration | None = None,
        return_debug_tuple: bool = False,
    ) -> Any:
        """Return whether `lookup_transform_full` would succeed; see there and `can_transform`."""
        frames = (target_frame, target_time, source_frame, source_time, fixed_frame)
        found = self._waited(lambda: self.can_transform_full_core(*frames), timeout)
        return found if return_debug_tuple else found[0]

    @staticmethod
    def _waited(look: Callable[[], tuple[int, str]], timeout: Duration | None) -> tuple[int, str]:
        if timeout is not None and timeout != Duration():
            clock = Clock()
            start = clock.now()
            while clock.now() < start + timeout and not look()[0] and clock.now() + _JUMP >= start:
                _time.sleep(_LOOK_S)
        return look()

    # -- in coroutines -----------------------------------------------------------------------------------------------

    async def lookup_transform_async(self, target_frame: str, source_frame: str, time: Any) -> Any:
        """Return a transform as soon as it is available; see `lookup_transform`."""
        await self.wait_for_transform_async(target_frame, source_frame, time)
        return self.lookup_transform_core(target_frame, source_frame, time)

    async def lookup_transform_full_async(
        self, target_frame: str, target_time: Any, source_frame: str, source_time: Any, fixed_frame: str
    ) -> Any:
        """Return a transform as soon as it is available; see `lookup_transform_full`."""
        frames = (target_frame, target_time, source_frame, source_time, fixed_frame)
        await self.wait_for_transform_full_async(*frames)
        return self.lookup_transform_full_core(*frames)

    def wait_for_transform_async(self, target_frame: str, source_frame: str, time: Any) -> Future:
        """Return a future that has the transform once it is available."""
        return self._future(
            lambda: self.can_transform_core(target_frame, source_frame, time),
            lambda: self.lookup_transform_core(target_frame, source_frame, time),
        )

    def wait_for_transform_full_async(
        self, target_frame: str, target_time: Any, source_frame: str, source_time: Any, fixed_frame: str
    ) -> Future:
        """Return a future that has the transform once it is available."""
        frames = (target_frame, target_time, source_frame, source_time, fixed_frame)
        return self._future(
            lambda: self.can_transform_full_core(*frames), lambda: self.lookup_transform_full_core(*frames)
        )

    def _future(self, look: Callable[[], tuple[int, str]], lookup: Callable[[], Any]) -> Future:
        future = Future()
        if look()[0]:
            future.set_result(lookup())
            return future

        def on_new_data() -> None:
            try:
                if look()[0]:
                    future.set_result(lookup())
            except BaseException as error:
                future.set_exception(error)

        self._new_data_callbacks.append(on_new_data)
        future.add_done_callback(lambda done: self._new_data_callbacks.remove(on_new_data))
        return future
