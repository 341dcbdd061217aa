"""`ActionClient` (rclpy.action.client)."""

from __future__ import annotations

import inspect
import threading
import time
import uuid
import weakref
from collections.abc import Callable
from typing import Any

from rclpy.action._ends import STATUS_QOS, ActionNames, ClientEnds, check_action_type
from rclpy.qos import QoSProfile, qos_profile_services_default
from rclpy.task import Future
from rclpy.waitable import Waitable

_LOOK_S = 0.25  # period at which `wait_for_server` looks
_UNKNOWN, _ENDED = 0, (4, 5, 6)  # states of action_msgs/GoalStatus: unknown; succeeded, cancelled, aborted


class ClientGoalHandle:
    """A goal that a client has sent.

    Args:
        action_client: the client.
        goal_id: its identity.
        goal_response: the server's answer.
    """

    def __init__(self, action_client: ActionClient, goal_id: Any, goal_response: Any) -> None:
        self._action_client = action_client
        self._goal_id = goal_id
        self._goal_response = goal_response
        self._status = _UNKNOWN

    def __eq__(self, other: object) -> bool:
        return isinstance(other, ClientGoalHandle) and self._goal_id == other._goal_id

    __hash__ = None  # type: ignore[assignment]  # as in rclpy

    def __repr__(self) -> str:
        return f"ClientGoalHandle <id={self.goal_id.uuid}, accepted={self.accepted}, status={self.status}>"

    @property
    def goal_id(self) -> Any:
        """Its identity, unique_identifier_msgs/UUID."""
        return self._goal_id

    @property
    def stamp(self) -> Any:
        """The time of acceptance, builtin_interfaces/Time."""
        return self._goal_response.stamp

    @property
    def accepted(self) -> bool:
        """True if the server accepted it."""
        return bool(self._goal_response.accepted)

    @property
    def status(self) -> int:
        """Its state as last published, as in action_msgs/GoalStatus."""
        return self._status

    def cancel_goal(self) -> Any:
        """Ask to cancel it, and wait for the answer, which an executor in another thread must take."""
        return _waited(self.cancel_goal_async())

    def cancel_goal_async(self) -> Future:
        """Ask to cancel it. Returns a future of action_msgs/CancelGoal's response."""
        return self._action_client._cancel_goal_async(self)

    def get_result(self) -> Any:
        """Wait for the result, which an executor in another thread must take."""
        return _waited(self.get_result_async())

    def get_result_async(self) -> Future:
        """Ask for the result. Returns a future with `status` and `result`."""
        return self._action_client._get_result_async(self)


def _waited(future: Future) -> Any:
    """Return the result of a future that another thread completes."""
    is_done = threading.Event()
    future.add_done_callback(lambda done: is_done.set())
    is_done.wait()
    return future.result()


class ActionClient(Waitable):
    """Sends goals to a server.

    Args:
        node: its node.
        action_type: class of the action.
        action_name: name of the action.
        callback_group: its group; None is the node's default one.
        goal_service_qos_profile: quality of service of requests for goals.
        result_service_qos_profile: quality of service of requests for results.
        cancel_service_qos_profile: quality of service of requests to cancel.
        feedback_sub_qos_profile: quality of service of the feedback.
        status_sub_qos_profile: quality of service of the states.

    Raises:
        AttributeError: it is not a class of an action.
    """

    def __init__(
        self,
        node: Any,
        action_type: Any,
        action_name: str,
        *,
        callback_group: Any = None,
        goal_service_qos_profile: QoSProfile = qos_profile_services_default,
        result_service_qos_profile: QoSProfile = qos_profile_services_default,
        cancel_service_qos_profile: QoSProfile = qos_profile_services_default,
        feedback_sub_qos_profile: QoSProfile | None = None,
        status_sub_qos_profile: QoSProfile = STATUS_QOS,
    ) -> None:
        super().__init__(node.default_callback_group if callback_group is None else callback_group)
        check_action_type(action_type)
        self._node = node
        self._action_type = action_type
        self._action_name = action_name
        profiles = (goal_service_qos_profile, cancel_service_qos_profile, result_service_qos_profile)
        depths = tuple(max(each.depth, 1) for each in profiles)
        feedback = feedback_sub_qos_profile or QoSProfile(depth=10)
        names = ActionNames(node, action_name)
        self._ends = ClientEnds(node, names, action_type, feedback, status_sub_qos_profile, depths)
        self._goal_handles: dict[bytes, weakref.ref[ClientGoalHandle]] = {}
        self._pending: dict[str, dict[int, tuple[Future, Any]]] = {"goal": {}, "cancel": {}, "result": {}}
        self._feedback_callbacks: dict[bytes, Callable[[Any], Any]] = {}
        self._logger = node.get_logger().get_child("action_client")
        node.add_waitable(self)

    # -- work --------------------------------------------------------------------------------------------------------

    def ready(self) -> bool:
        """Return True if an answer, feedback or a state waits."""
        return any(each.ready() for each in self._ends.all)

    def take_data(self) -> dict[str, Any]:
        """Take one message of each kind."""
        ends = self._ends
        sides = {
            "goal": ends.goal,
            "cancel": ends.cancel,
            "result": ends.result,
            "feedback": ends.feedback,
            "status": ends.status,
        }
        taken = {kind: side.take() for kind, side in sides.items()}
        return {kind: each for kind, each in taken.items() if each is not None}

    async def execute(self, taken_data: dict[str, Any]) -> None:
        """Do the work that `take_data` returned."""
        for kind, pending in self._pending.items():
            if kind not in taken_data:
                continue
            number, response, _ = taken_data[kind]
            if number not in pending:
                self._logger.warning(
                    f"Ignoring unexpected {kind} response. There may be more than one action server for the action"
                    f" '{self._action_name}'"
                )
                continue
            future, goal_id = pending[number]
            future.set_result(self._accepted(goal_id, response) if kind == "goal" else response)
        if "feedback" in taken_data:
            message = taken_data["feedback"][0]
            callback = self._feedback_callbacks.get(bytes(message.goal_id.uuid))
            if callback is not None:
                result = callback(message)
                if inspect.iscoroutinefunction(callback):
                    await result
        if "status" in taken_data:
            self._note_states(taken_data["status"][0])

    def _accepted(self, goal_id: Any, response: Any) -> ClientGoalHandle:
        handle = ClientGoalHandle(self, goal_id, response)
        if handle.accepted:
            key = bytes(goal_id.uuid)
            if key in self._goal_handles:
                raise RuntimeError(f"Two goals were accepted with the same ID ({handle})")
            self._goal_handles[key] = weakref.ref(handle)
        return handle

    def _note_states(self, message: Any) -> None:
        for each in message.status_list:
            key = bytes(each.goal_info.goal_id.uuid)
            if key not in self._goal_handles:
                continue
            handle = self._goal_handles[key]()
            if handle is not None:
                handle._status = each.status
            if handle is None or each.status in _ENDED:
                del self._goal_handles[key]

    # -- requests ----------------------------------------------------------------------------------------------------

    def _send(self, kind: str, request: Any, goal_id: Any) -> Future:
        future = Future()
        pending = self._pending[kind]

        def forget(done: Future) -> None:
            for number in [number for number, (each, _) in pending.items() if each is future]:
                del pending[number]
                self.remove_future(future)
                if kind == "result":
                    self._feedback_callbacks.pop(bytes(goal_id.uuid), None)

        self.add_future(future)
        future.add_done_callback(forget)
        getattr(self._ends, kind).send(request, lambda number: pending.update({number: (future, goal_id)}))
        return future

    def send_goal(self, goal: Any, **kwargs: Any) -> Any:
        """Send a goal and wait for the result, which an executor in another thread must take.

        Args:
            goal: the goal.
            kwargs: as for `send_goal_async`.

        Returns:
            The result, with its `status`.

        Raises:
            TypeError: it is not a goal of the action.
        """
        handle = _waited(self.send_goal_async(goal, **kwargs))
        return handle.get_result()

    def send_goal_async(
        self, goal: Any, feedback_callback: Callable[[Any], Any] | None = None, goal_uuid: Any = None
    ) -> Future:
        """Send a goal.

        Args:
            goal: the goal.
            feedback_callback: called with each message of feedback.
            goal_uuid: identity of the goal; None makes a random one.

        Returns:
            A future of a `ClientGoalHandle`. Without a server it is never done.

        Raises:
            TypeError: it is not a goal of the action.
        """
        from unique_identifier_msgs.msg import UUID

        if not isinstance(goal, self._action_type.Goal):
            raise TypeError(f"Expected goal type ({type(self._action_type.Goal)}) but received ({type(goal)})")
        request = self._action_type.Impl.SendGoalService.Request()
        request.goal_id = UUID(uuid=list(uuid.uuid4().bytes)) if goal_uuid is None else goal_uuid
        request.goal = goal
        future = self._send("goal", request, request.goal_id)
        if feedback_callback is not None:
            self._feedback_callbacks[bytes(request.goal_id.uuid)] = feedback_callback
        return future

    def _cancel_goal_async(self, goal_handle: ClientGoalHandle) -> Future:
        from action_msgs.srv import CancelGoal

        _check_handle(goal_handle)
        request = CancelGoal.Request()
        request.goal_info.goal_id = goal_handle.goal_id
        return self._send("cancel", request, goal_handle.goal_id)

    def _get_result_async(self, goal_handle: ClientGoalHandle) -> Future:
        _check_handle(goal_handle)
        request = self._action_type.Impl.GetResultService.Request(goal_id=goal_handle.goal_id)
        return self._send("result", request, goal_handle.goal_id)

    def server_is_ready(self) -> bool:
        """Return True if a node serves the action."""
        return self._ends.is_server_available()

    def wait_for_server(self, timeout_sec: float | None = None) -> bool:
        """Wait until a node serves the action.

        Args:
            timeout_sec: longest time in s; None waits without limit.

        Returns:
            True if a node serves it.
        """
        left = float("inf") if timeout_sec is None else timeout_sec
        while self._node.context.ok() and not self.server_is_ready() and left > 0:
            time.sleep(_LOOK_S)
            left -= _LOOK_S
        return self.server_is_ready()

    def destroy(self) -> None:
        """End the client."""
        self._ends.close()
        self._node.remove_waitable(self)


def _check_handle(goal_handle: Any) -> None:
    if not isinstance(goal_handle, ClientGoalHandle):
        raise TypeError(f"Expected type ClientGoalHandle but received {type(goal_handle)}")
