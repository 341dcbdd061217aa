"""`Client` (rclpy.client)."""

from __future__ import annotations

import threading
import time
from typing import Any

from rclpy import _seam
from rclpy._entity import Call, Entity
from rclpy.qos import QoSProfile
from rclpy.task import Future

_LOOK_S = 0.25  # period at which `wait_for_service` looks


class Client(Entity):
    """Calls a service; `Node.create_client` makes one.

    Args:
        context: its context.
        srv_type: service class.
        srv_name: resolved name of the service.
        qos_profile: its quality of service.
        callback_group: its group.
    """

    def __init__(
        self, context: Any, srv_type: Any, srv_name: str, qos_profile: QoSProfile, callback_group: Any
    ) -> None:
        self.context = context
        self.srv_type = srv_type
        self.srv_name = srv_name
        self.qos_profile = qos_profile
        self.callback_group = callback_group
        self._pending: dict[int, Future] = {}
        self._side = _seam.program.add_client(srv_name, srv_type, max(qos_profile.depth, 1))
        self.ready = self._side.ready  # type: ignore[method-assign]
        self.may_have_work = self._side.is_open  # type: ignore[method-assign]

    @property
    def service_name(self) -> str:
        """The resolved name."""
        return self.srv_name

    def call(self, request: Any, timeout_sec: float | None = None) -> Any:
        """Call the service and wait for the response, which an executor in another thread must take.

        Args:
            request: the request.
            timeout_sec: longest time in s; None waits without limit.

        Returns:
            The response.

        Raises:
            TypeError: it is not a request of the service.
            TimeoutError: there was no response in time.
        """
        is_done = threading.Event()
        future = self.call_async(request)
        future.add_done_callback(lambda done: is_done.set())
        if future.exception() is None and not is_done.wait(timeout_sec) and not future.done():
            self.remove_pending_request(future)
            raise TimeoutError
        return future.result()

    def call_async(self, request: Any) -> Future:
        """Call the service.

        Returns:
            A future of the response. Without a server it is never done.

        Raises:
            TypeError: it is not a request of the service.
        """
        if not isinstance(request, self.srv_type.Request):
            raise TypeError(f"Expected {self.srv_type.Request}, got {type(request)}")
        future = Future(executor=None)
        future.add_done_callback(self.remove_pending_request)
        self._side.send(request, lambda number: self._pending.update({number: future}))
        return future

    def take_work(self, executor: Any) -> Call | None:
        """Take the oldest response; see `Entity.take_work`."""
        taken = self._side.take()
        return None if taken is None else (self._finish, (executor, *taken))

    def _finish(self, executor: Any, number: int, response: Any, error: str) -> None:
        """Finish the future of a call, unless the call was removed."""
        future = self._pending.get(number)
        if future is None:
            return
        future._set_executor(executor)
        if error:
            future.set_exception(RuntimeError(error))
        else:
            future.set_result(response)

    def get_pending_request(self, sequence_number: int) -> Future:
        """Return the future of a call by its number. Raises KeyError if it is not pending."""
        return self._pending[sequence_number]

    def remove_pending_request(self, future: Future) -> None:
        """Ignore the response of a call."""
        for number in [number for number, each in self._pending.items() if each is future]:
            del self._pending[number]
            self._side.forget(number)

    def service_is_ready(self) -> bool:
        """Return True if a node offers the service with the same type."""
        return bool(self._side.is_available())

    def wait_for_service(self, timeout_sec: float | None = None) -> bool:
        """Wait until a node offers the service.

        Args:
            timeout_sec: longest time in s; None waits without limit.

        Returns:
            True if a node offers it.
        """
        left = float("inf") if timeout_sec is None else timeout_sec
        while self.context.ok() and not self.service_is_ready() and left > 0:
            pause = min(_LOOK_S, left)
            time.sleep(pause)
            left -= pause
        return self.service_is_ready()

    def configure_introspection(self, *args: Any, **options: Any) -> None:
        """Refuse: there is no introspection of services yet."""
        raise NotImplementedError("cfepy does not have introspection of services for nodes of ROS 2 yet")

    def destroy(self) -> None:
        """Forget all calls."""
        _seam.program.close(self._side)

    def __enter__(self) -> Client:
        return self

    def __exit__(self, *error: object) -> None:
        self.destroy()
