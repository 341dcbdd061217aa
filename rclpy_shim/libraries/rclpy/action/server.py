"""`ActionServer` (rclpy.action.server)."""

from __future__ import annotations

import functools
import inspect
import traceback
from collections.abc import Callable
from enum import Enum, IntEnum
from typing import Any

from rclpy import _seam
from rclpy._entity import NEVER
from rclpy._rclpy_pybind11 import RCLError
from rclpy.action._ends import STATUS_QOS, ActionNames, ServerEnds, check_action_type
from rclpy.qos import QoSProfile, qos_profile_services_default
from rclpy.task import Future
from rclpy.waitable import Waitable

S_TO_NS = 1_000_000_000
UNKNOWN, ACCEPTED, EXECUTING, CANCELING, SUCCEEDED, CANCELED, ABORTED = range(7)
"""States of a goal (action_msgs/GoalStatus)."""


class GoalResponse(Enum):
    """Answers of the callback for goals."""

    REJECT = 1
    ACCEPT = 2


class CancelResponse(Enum):
    """Answers of the callback for cancelling."""

    REJECT = 1
    ACCEPT = 2


class GoalEvent(IntEnum):
    """Events in the life of a goal."""

    EXECUTE = 0
    CANCEL_GOAL = 1
    SUCCEED = 2
    ABORT = 3
    CANCELED = 4


_NEXT = {
    (ACCEPTED, GoalEvent.EXECUTE): EXECUTING,
    (ACCEPTED, GoalEvent.CANCEL_GOAL): CANCELING,
    (EXECUTING, GoalEvent.CANCEL_GOAL): CANCELING,
    (EXECUTING, GoalEvent.SUCCEED): SUCCEEDED,
    (EXECUTING, GoalEvent.ABORT): ABORTED,
    (CANCELING, GoalEvent.SUCCEED): SUCCEEDED,
    (CANCELING, GoalEvent.ABORT): ABORTED,
    (CANCELING, GoalEvent.CANCELED): CANCELED,
}
_STATES = ("UNKNOWN", "ACCEPTED", "EXECUTING", "CANCELING", "SUCCEEDED", "CANCELED", "ABORTED")


class ServerGoalHandle:
    """A goal of a server.

    Args:
        action_server: the server.
        goal_info: identity and time of acceptance, action_msgs/GoalInfo.
        goal_request: the goal.
    """

    def __init__(self, action_server: ActionServer, goal_info: Any, goal_request: Any) -> None:
        self._action_server = action_server
        self._goal_info = goal_info
        self._goal_request = goal_request
        self._state = ACCEPTED
        self._is_destroyed = False
        self.expires_ns = NEVER

    def __eq__(self, other: object) -> bool:
        return isinstance(other, ServerGoalHandle) and self.goal_id == other.goal_id

    __hash__ = None  # type: ignore[assignment]  # as in rclpy

    @property
    def request(self) -> Any:
        """The goal."""
        return self._goal_request

    @property
    def goal_id(self) -> Any:
        """Its identity, unique_identifier_msgs/UUID."""
        return self._goal_info.goal_id

    @property
    def is_active(self) -> bool:
        """True until it succeeds, is aborted or cancelled."""
        return not self._is_destroyed and self._state in (ACCEPTED, EXECUTING, CANCELING)

    @property
    def is_cancel_requested(self) -> bool:
        """True if the server accepted a request to cancel it."""
        return self.status == CANCELING

    @property
    def status(self) -> int:
        """Its state, as in action_msgs/GoalStatus."""
        return UNKNOWN if self._is_destroyed else self._state

    def _update_state(self, event: GoalEvent) -> None:
        if self._is_destroyed:
            return
        following = _NEXT.get((self._state, event))
        if following is None:
            text = f"goal_handle attempted invalid transition from state {_STATES[self._state]} with event {event.name}"
            raise RCLError(f"Failed to update goal state: {text}")
        self._state = following
        self._action_server.publish_status()
        if not self.is_active:
            self.expires_ns = _seam.steady_ns() + self._action_server._result_timeout_ns
            self._action_server.notify_goal_done()

    def execute(self, execute_callback: Callable[[ServerGoalHandle], Any] | None = None) -> None:
        """Execute the goal soon, in the executor of the node.

        Args:
            execute_callback: does the work and returns the result; None takes the server's.
        """
        if not self.is_cancel_requested:
            self._update_state(GoalEvent.EXECUTE)
        self._action_server.notify_execute(self, execute_callback)

    def publish_feedback(self, feedback: Any) -> None:
        """Publish feedback.

        Raises:
            TypeError: it is not feedback of the action.
        """
        server = self._action_server
        if not isinstance(feedback, server.action_type.Feedback):
            raise TypeError
        if not self._is_destroyed:
            message = server.action_type.Impl.FeedbackMessage(goal_id=self.goal_id, feedback=feedback)
            server._ends.feedback.send(message)

    def succeed(self) -> None:
        """End the goal with success. Raises RCLError if its state does not allow this."""
        self._update_state(GoalEvent.SUCCEED)

    def abort(self) -> None:
        """End the goal without success. Raises RCLError if its state does not allow this."""
        self._update_state(GoalEvent.ABORT)

    def canceled(self) -> None:
        """End the goal as cancelled. Raises RCLError if its state does not allow this."""
        self._update_state(GoalEvent.CANCELED)

    def destroy(self) -> None:
        """Forget the goal."""
        self._is_destroyed = True


def default_handle_accepted_callback(goal_handle: ServerGoalHandle) -> None:
    """Execute a goal at once."""
    goal_handle.execute()


def default_goal_callback(goal_request: Any) -> GoalResponse:
    """Accept all goals."""
    return GoalResponse.ACCEPT


def default_cancel_callback(cancel_request: Any) -> CancelResponse:
    """Cancel no goal."""
    return CancelResponse.REJECT


async def _called(function: Callable[..., Any], *arguments: Any) -> Any:
    result = function(*arguments)
    return await result if inspect.iscoroutinefunction(function) else result


class ActionServer(Waitable):
    """Executes goals.

    Args:
        node: its node.
        action_type: class of the action.
        action_name: name of the action.
        execute_callback: called with a goal handle; returns the result.
        callback_group: its group; None is the node's default one.
        goal_callback: called with a goal; returns `GoalResponse`.
        handle_accepted_callback: called with the handle of an accepted goal.
        cancel_callback: called with the handle of a goal to cancel; returns `CancelResponse`.
        goal_service_qos_profile: quality of service of requests for goals.
        result_service_qos_profile: quality of service of requests for results.
        cancel_service_qos_profile: quality of service of requests to cancel.
        feedback_pub_qos_profile: quality of service of the feedback.
        status_pub_qos_profile: quality of service of the states.
        result_timeout: time in s for which results are kept.

    Raises:
        AttributeError: it is not a class of an action.
        TypeError: the callback cannot be called.
    """

    def __init__(
        self,
        node: Any,
        action_type: Any,
        action_name: str,
        execute_callback: Callable[[ServerGoalHandle], Any],
        *,
        callback_group: Any = None,
        goal_callback: Callable[[Any], Any] = default_goal_callback,
        handle_accepted_callback: Callable[[ServerGoalHandle], Any] = default_handle_accepted_callback,
        cancel_callback: Callable[[Any], Any] = default_cancel_callback,
        goal_service_qos_profile: QoSProfile = qos_profile_services_default,
        result_service_qos_profile: QoSProfile = qos_profile_services_default,
        cancel_service_qos_profile: QoSProfile = qos_profile_services_default,
        feedback_pub_qos_profile: QoSProfile | None = None,
        status_pub_qos_profile: QoSProfile = STATUS_QOS,
        result_timeout: int = 10,
    ) -> None:
        super().__init__(node.default_callback_group if callback_group is None else callback_group)
        self.register_handle_accepted_callback(handle_accepted_callback)
        self.register_goal_callback(goal_callback)
        self.register_cancel_callback(cancel_callback)
        self.register_execute_callback(execute_callback)
        check_action_type(action_type)
        self._node = node
        self._action_type = action_type
        self._result_timeout_ns = int(result_timeout * S_TO_NS)
        profiles = (goal_service_qos_profile, cancel_service_qos_profile, result_service_qos_profile)
        depths = tuple(max(each.depth, 1) for each in profiles)
        feedback = feedback_pub_qos_profile or QoSProfile(depth=10)
        names = ActionNames(node, action_name)
        self._ends = ServerEnds(node, names, action_type, feedback, status_pub_qos_profile, depths)
        self._goal_handles: dict[bytes, ServerGoalHandle] = {}
        self._result_futures: dict[bytes, Future] = {}
        self._logger = node.get_logger().get_child("action_server")
        node.add_waitable(self)

    @property
    def action_type(self) -> Any:
        """Class of the action."""
        return self._action_type

    # -- work --------------------------------------------------------------------------------------------------------

    @property
    def due_ns(self) -> int:  # type: ignore[override]
        """The steady time in ns at which a result expires."""
        return min((each.expires_ns for each in self._goal_handles.values()), default=NEVER)

    def ready(self) -> bool:
        """Return True if a request waits, or a result has expired."""
        ends = self._ends
        return ends.goal.ready() or ends.cancel.ready() or ends.result.ready() or _seam.steady_ns() >= self.due_ns

    def take_data(self) -> dict[str, Any]:
        """Take one request of each kind, and the results that have expired."""
        ends = self._ends
        taken = {"goal": ends.goal.take(), "cancel": ends.cancel.take(), "result": ends.result.take()}
        data: dict[str, Any] = {kind: each for kind, each in taken.items() if each is not None}
        now = _seam.steady_ns()
        if expired := [key for key, each in self._goal_handles.items() if each.expires_ns <= now]:
            data["expired"] = expired
        return data

    async def execute(self, taken_data: dict[str, Any]) -> None:
        """Do the work that `take_data` returned."""
        if "goal" in taken_data:
            await self._execute_goal_request(*taken_data["goal"])
        if "cancel" in taken_data:
            await self._execute_cancel_request(*taken_data["cancel"])
        if "result" in taken_data:
            self._execute_get_result_request(*taken_data["result"])
        for key in taken_data.get("expired", ()):
            self._goal_handles.pop(key).destroy()
            self.remove_future(self._result_futures.pop(key))

    async def _execute_goal_request(self, number: int, request: Any) -> None:
        from action_msgs.msg import GoalInfo

        info = GoalInfo(goal_id=request.goal_id)
        key = bytes(request.goal_id.uuid)
        is_accepted = False
        if key not in self._goal_handles:
            response = await _called(self._goal_callback, request.goal)
            if not isinstance(response, GoalResponse):
                self._logger.warning("Goal request callback did not return a GoalResponse type. Rejecting goal.")
            else:
                is_accepted = response is GoalResponse.ACCEPT
        if is_accepted:
            info.stamp = self._node.get_clock().now().to_msg()
            handle = self._goal_handles[key] = ServerGoalHandle(self, info, request.goal)
            self._result_futures[key] = Future()
            self.add_future(self._result_futures[key])
        answer = self._action_type.Impl.SendGoalService.Response(accepted=is_accepted, stamp=info.stamp)
        self._ends.goal.answer(number, answer)
        if is_accepted:
            self.publish_status()
            await _called(self._handle_accepted_callback, handle)

    async def _execute_goal(self, execute_callback: Callable[[ServerGoalHandle], Any], goal: ServerGoalHandle) -> None:
        key = goal.goal_id.uuid
        try:
            result = await _called(execute_callback, goal)
        except Exception as error:
            result = self._action_type.Result()
            self._logger.error(f"Error raised in execute callback: {error}")
            traceback.print_exc()
        if goal.is_active:
            self._logger.warning(f"Goal state not set, assuming aborted. Goal ID: {key}")
            goal.abort()
        response = self._action_type.Impl.GetResultService.Response()
        response.status, response.result = goal.status, result
        self._result_futures[bytes(key)].set_result(response)

    async def _execute_cancel_request(self, number: int, request: Any) -> None:
        response = self._cancel_response(request)
        for info in response.goals_canceling:  # as in rclpy: the goal behind a removed one is not asked
            handle = self._goal_handles[bytes(info.goal_id.uuid)]
            answer = await _called(self._cancel_callback, handle)
            if answer is not CancelResponse.ACCEPT:
                response.goals_canceling.remove(info)
                continue
            try:
                handle._update_state(GoalEvent.CANCEL_GOAL)
            except RCLError as error:
                self._logger.debug(f"Failed to cancel goal in cancel callback: {error}")
                response.goals_canceling.remove(info)
        self._ends.cancel.answer(number, response)

    def _cancel_response(self, request: Any) -> Any:
        """Return action_msgs/CancelGoal's response with the goals that may be cancelled."""
        from action_msgs.srv import CancelGoal

        response = CancelGoal.Response()
        key, stamp = bytes(request.goal_info.goal_id.uuid), _ns(request.goal_info.stamp)
        handles = self._goal_handles
        if any(key) and not stamp:
            if key not in handles:
                response.return_code = CancelGoal.Response.ERROR_UNKNOWN_GOAL_ID
                return response
            chosen = [handles[key]]
        else:
            latest = stamp or NEVER
            chosen = [each for uuid, each in handles.items() if uuid == key or _ns(each._goal_info.stamp) <= latest]
        response.goals_canceling = [each._goal_info for each in chosen if each.status in (ACCEPTED, EXECUTING)]
        if any(key) and not stamp and not response.goals_canceling:
            response.return_code = CancelGoal.Response.ERROR_GOAL_TERMINATED
        return response

    def _execute_get_result_request(self, number: int, request: Any) -> None:
        key = request.goal_id.uuid
        if bytes(key) not in self._goal_handles:
            self._logger.warning(f"Sending result response for unknown or expired goal ID: {key}")
            self._ends.result.answer(number, self._action_type.Impl.GetResultService.Response(status=UNKNOWN))
            return
        send = functools.partial(self._send_result_response, number)
        self._result_futures[bytes(key)].add_done_callback(send)

    def _send_result_response(self, number: int, future: Future) -> None:
        self._ends.result.answer(number, future.result())

    def publish_status(self) -> None:
        """Publish the states of all goals."""
        from action_msgs.msg import GoalStatus

        goals = self._goal_handles.values()
        states = [GoalStatus(goal_info=each._goal_info, status=each.status) for each in goals]
        self._ends.status.send(self._action_type.Impl.GoalStatusMessage(status_list=states))

    def notify_execute(self, goal_handle: ServerGoalHandle, execute_callback: Callable[..., Any] | None) -> None:
        """Let the executor of the node execute a goal; without an executor nothing happens.

        Args:
            goal_handle: the goal.
            execute_callback: does the work; None takes the server's.
        """
        chosen = self._execute_callback if execute_callback is None else execute_callback
        if self._node.executor is not None:
            self._node.executor.create_task(self._execute_goal, chosen, goal_handle)

    def notify_goal_done(self) -> None:
        """Note that a goal has ended: the executor must look when its result expires."""
        self._node._wake()

    # -- callbacks ---------------------------------------------------------------------------------------------------

    def register_handle_accepted_callback(self, handle_accepted_callback: Callable[..., Any] | None) -> None:
        """Replace the callback for accepted goals; None executes them at once."""
        self._handle_accepted_callback = handle_accepted_callback or default_handle_accepted_callback

    def register_goal_callback(self, goal_callback: Callable[..., Any] | None) -> None:
        """Replace the callback that accepts goals; None accepts all."""
        self._goal_callback = goal_callback or default_goal_callback

    def register_cancel_callback(self, cancel_callback: Callable[..., Any] | None) -> None:
        """Replace the callback that accepts requests to cancel; None rejects all."""
        self._cancel_callback = cancel_callback or default_cancel_callback

    def register_execute_callback(self, execute_callback: Callable[[ServerGoalHandle], Any]) -> None:
        """Replace the callback that executes goals.

        Raises:
            TypeError: it cannot be called.
        """
        if not callable(execute_callback):
            raise TypeError("Failed to register goal execution callback: not callable")
        self._execute_callback = execute_callback

    def destroy(self) -> None:
        """End the server, and forget its goals."""
        for handle in self._goal_handles.values():
            handle.destroy()
        self._goal_handles.clear()
        self._ends.close()
        self._node.remove_waitable(self)


def _ns(stamp: Any) -> int:
    return int(stamp.sec) * S_TO_NS + int(stamp.nanosec)
