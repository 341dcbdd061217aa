"""The services and topics of an action, with their hidden names (rcl_action_client_t and rcl_action_server_t)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from rclpy import _seam
from rclpy.qos import DurabilityPolicy, QoSProfile

STATUS_QOS = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
"""Quality of service of the topic with the states of goals."""


def check_action_type(action_type: Any) -> None:
    """Check that a class is an action.

    Raises:
        AttributeError: it is not.
    """
    if not hasattr(action_type, "Impl"):
        name = getattr(action_type, "__name__", action_type)
        raise AttributeError(
            f"type object '{name}' has no attribute '_TYPE_SUPPORT' This might be a ROS 1 message type but it should be"
            " a ROS 2 message type. Make sure to source your ROS 2 workspace after your ROS 1 workspace."
        )


class ActionNames:
    """The names of one action.

    Args:
        node: its node.
        action_name: the name of the action.
    """

    def __init__(self, node: Any, action_name: str) -> None:
        self._node = node
        self._action = action_name

    def service(self, kind: str) -> str:
        """Return the name of a service: send_goal, cancel_goal or get_result."""
        return str(self._node.resolve_service_name(f"{self._action}/_action/{kind}"))

    def topic(self, kind: str) -> str:
        """Return the name of a topic: feedback or status."""
        return str(self._node.resolve_topic_name(f"{self._action}/_action/{kind}"))


class _Ends:
    """The entities of a server or of a client: three services and two topics.

    Args:
        add_service: makes the end of a service.
        add_topic: makes the end of a topic.
        node: the node of the server or client.
        names: their names.
        action_type: class of the action.
        feedback_qos: quality of service of the feedback.
        status_qos: quality of service of the states.
        depths: depths of the services goal, cancel and result.
    """

    def __init__(
        self,
        add_service: Callable[..., Any],
        add_topic: Callable[..., Any],
        node: Any,
        names: ActionNames,
        action_type: Any,
        feedback_qos: QoSProfile,
        status_qos: QoSProfile,
        depths: Sequence[int],
    ) -> None:
        impl, warn = action_type.Impl, node.get_logger().warning
        self.goal = add_service(names.service("send_goal"), impl.SendGoalService, depths[0])
        self.cancel = add_service(names.service("cancel_goal"), impl.CancelGoalService, depths[1])
        self.result = add_service(names.service("get_result"), impl.GetResultService, depths[2])
        self.feedback = add_topic(names.topic("feedback"), impl.FeedbackMessage, feedback_qos.quality(), warn)
        self.status = add_topic(names.topic("status"), impl.GoalStatusMessage, status_qos.quality(), warn)
        self.all = (self.goal, self.cancel, self.result, self.feedback, self.status)

    def close(self) -> None:
        """Close all of them."""
        for each in self.all:
            _seam.program.close(each)


class ServerEnds(_Ends):
    """The entities of a server; see `_Ends`."""

    def __init__(self, *args: Any) -> None:
        program = _seam.program
        super().__init__(program.add_service, program.add_publisher, *args)


class ClientEnds(_Ends):
    """The entities of a client; see `_Ends`."""

    def __init__(self, *args: Any) -> None:
        program = _seam.program
        super().__init__(program.add_client, program.add_subscription, *args)

    def is_server_available(self) -> bool:
        """Return True if a server offers the three services, and publishes."""
        services = (self.goal, self.cancel, self.result)
        return all(each.is_available() for each in services) and bool(self.feedback.count() and self.status.count())
