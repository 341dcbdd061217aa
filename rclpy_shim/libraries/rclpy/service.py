"""`Service` (rclpy.service)."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any

from rclpy import _seam
from rclpy._entity import Call, Entity
from rclpy.qos import QoSProfile


class Service(Entity):
    """Answers requests; `Node.create_service` makes one.

    Args:
        srv_type: service class.
        srv_name: resolved name of the service.
        callback: called with a request and a response to fill; returns the response.
        callback_group: its group.
        qos_profile: its quality of service.
        is_quiet: True for a service that few clients call.
    """

    def __init__(
        self,
        srv_type: Any,
        srv_name: str,
        callback: Callable[[Any, Any], Any],
        callback_group: Any,
        qos_profile: QoSProfile,
        is_quiet: bool = False,
    ) -> None:
        self.srv_type = srv_type
        self.srv_name = srv_name
        self.callback = callback
        self.callback_group = callback_group
        self.qos_profile = qos_profile
        self._side = _seam.program.add_service(srv_name, srv_type, max(qos_profile.depth, 1), is_quiet)
        self.ready = self._side.ready  # type: ignore[method-assign]
        self.may_have_work = self._side.is_open  # type: ignore[method-assign]

    @property
    def service_name(self) -> str:
        """The resolved name."""
        return self.srv_name

    def take_work(self, executor: Any) -> Call | None:
        """Take the oldest request; see `Entity.take_work`."""
        taken = self._side.take()
        return None if taken is None else (self._answer, taken)

    async def _answer(self, number: int, request: Any) -> None:
        """Call the callback and send its response."""
        function = self.callback
        response = function(request, self.srv_type.Response())
        if inspect.iscoroutinefunction(function):
            response = await response
        self.send_response(response, number)

    def send_response(self, response: Any, header: int) -> None:
        """Answer a call.

        Args:
            response: the response.
            header: number of the call.

        Raises:
            TypeError: it is not a response of the service.
        """
        if not isinstance(response, self.srv_type.Response):
            raise TypeError(f"Expected {self.srv_type.Response}, got {type(response)}")
        self._side.answer(header, response)

    def configure_introspection(self, *args: Any, **options: Any) -> None:
        """Refuse: there is no introspection of services yet."""
        raise NotImplementedError("cfepy does not have introspection of services for nodes of ROS 2 yet")

    def destroy(self) -> None:
        """Stop offering the service."""
        _seam.program.close(self._side)

    def __enter__(self) -> Service:
        return self

    def __exit__(self, *error: object) -> None:
        self.destroy()
