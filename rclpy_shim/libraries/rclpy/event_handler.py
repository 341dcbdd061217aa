"""Events of publishers and subscriptions, and their callbacks (rclpy.event_handler)."""

from __future__ import annotations

from collections.abc import Callable
from enum import IntEnum
from types import SimpleNamespace
from typing import Any

from rclpy._rclpy_pybind11 import UnsupportedEventTypeError
from rclpy.qos import QoSPolicyKind, qos_policy_name_from_kind
from rclpy.waitable import Waitable

__all__ = [
    "EventHandler",
    "PublisherEventCallbacks",
    "QoSPublisherEventType",
    "QoSSubscriptionEventType",
    "SubscriptionEventCallbacks",
    "UnsupportedEventTypeError",
]
_NO_SENDING = (
    "New subscription discovered on topic '{}', requesting incompatible QoS. No messages will be sent to it."
    " Last incompatible policy: {}"
)
_NO_RECEIVING = (
    "New publisher discovered on topic '{}', offering incompatible QoS. No messages will be received from it."
    " Last incompatible policy: {}"
)


class QoSPublisherEventType(IntEnum):
    """Events of a publisher."""

    RCL_PUBLISHER_OFFERED_DEADLINE_MISSED = 0
    RCL_PUBLISHER_LIVELINESS_LOST = 1
    RCL_PUBLISHER_OFFERED_INCOMPATIBLE_QOS = 2
    RCL_PUBLISHER_INCOMPATIBLE_TYPE = 3
    RCL_PUBLISHER_MATCHED = 4


class QoSSubscriptionEventType(IntEnum):
    """Events of a subscription."""

    RCL_SUBSCRIPTION_REQUESTED_DEADLINE_MISSED = 0
    RCL_SUBSCRIPTION_LIVELINESS_CHANGED = 1
    RCL_SUBSCRIPTION_REQUESTED_INCOMPATIBLE_QOS = 2
    RCL_SUBSCRIPTION_MESSAGE_LOST = 3
    RCL_SUBSCRIPTION_INCOMPATIBLE_TYPE = 4
    RCL_SUBSCRIPTION_MATCHED = 5


class EventInfo(SimpleNamespace):
    """The numbers of an event, such as `total_count` and `total_count_change`."""


def _info(name: str) -> type[EventInfo]:
    """Return the class of one kind of event, with rmw's name of it."""
    return type(f"rclpy._rclpy_pybind11.rmw_{name}_status_t", (EventInfo,), {})


QoSRequestedDeadlineMissedInfo = _info("requested_deadline_missed")
QoSOfferedDeadlineMissedInfo = _info("offered_deadline_missed")
QoSLivelinessChangedInfo = _info("liveliness_changed")
QoSLivelinessLostInfo = _info("liveliness_lost")
QoSMessageLostInfo = _info("message_lost")
QoSRequestedIncompatibleQoSInfo = QoSOfferedIncompatibleQoSInfo = _info("requested_qos_incompatible_event")
IncompatibleTypeInfo = _info("incompatible_type")
QoSSubscriptionMatchedInfo = QoSPublisherMatchedInfo = _info("matched")
_INFOS: dict[Any, type[EventInfo]] = {
    QoSPublisherEventType.RCL_PUBLISHER_OFFERED_DEADLINE_MISSED.name: QoSOfferedDeadlineMissedInfo,
    QoSPublisherEventType.RCL_PUBLISHER_LIVELINESS_LOST.name: QoSLivelinessLostInfo,
    QoSPublisherEventType.RCL_PUBLISHER_OFFERED_INCOMPATIBLE_QOS.name: QoSOfferedIncompatibleQoSInfo,
    QoSPublisherEventType.RCL_PUBLISHER_MATCHED.name: QoSPublisherMatchedInfo,
    QoSSubscriptionEventType.RCL_SUBSCRIPTION_REQUESTED_DEADLINE_MISSED.name: QoSRequestedDeadlineMissedInfo,
    QoSSubscriptionEventType.RCL_SUBSCRIPTION_LIVELINESS_CHANGED.name: QoSLivelinessChangedInfo,
    QoSSubscriptionEventType.RCL_SUBSCRIPTION_REQUESTED_INCOMPATIBLE_QOS.name: QoSRequestedIncompatibleQoSInfo,
    QoSSubscriptionEventType.RCL_SUBSCRIPTION_MESSAGE_LOST.name: QoSMessageLostInfo,
    QoSSubscriptionEventType.RCL_SUBSCRIPTION_MATCHED.name: QoSSubscriptionMatchedInfo,
}


class EventHandler(Waitable):
    """Calls a function for one kind of event.

    Args:
        callback_group: its group.
        callback: called with an `EventInfo`.
        event_type: the kind.
        status: the numbers that the seam counts.
    """

    def __init__(self, *, callback_group: Any, callback: Callable[[Any], Any], event_type: Any, status: Any) -> None:
        super().__init__(callback_group)
        self.event_type = event_type
        self.callback = callback
        self._status = status
        self.ready = status.ready  # type: ignore[method-assign]  # without another call
        self.may_have_work = status.is_waiting  # type: ignore[method-assign]

    @property
    def due_ns(self) -> int:  # type: ignore[override]
        """The steady time in ns at which an event is due."""
        return int(self._status.due_ns)

    def take_work(self, executor: Any) -> Any:
        """Take the numbers; see `Entity.take_work`."""
        if not self._status.is_new:
            return None
        values = self._status.take()
        if "last_policy_kind" in values:
            values["last_policy_kind"] = QoSPolicyKind(values["last_policy_kind"])
        return self.callback, (_INFOS[self.event_type.name](**values),)

    def destroy(self) -> None:
        """Do nothing: the entity counts as long as it lives."""


class _Callbacks:
    """Base of the containers of callbacks.

    Args:
        use_default_callbacks: warn of unequal qualities of service unless another callback does.
        callbacks: functions by the name of the event; None for none.
    """

    _types: dict[str, Any]
    _warning = ""

    def __init__(self, use_default_callbacks: bool, callbacks: dict[str, Callable[[Any], Any] | None]) -> None:
        self.use_default_callbacks = use_default_callbacks
        self._names = tuple(callbacks)
        vars(self).update(callbacks)

    def create_event_handlers(
        self, callback_group: Any, side: Any, topic_name: str, warn: Callable[[str], object]
    ) -> list[EventHandler]:
        """Make the handlers of a publisher or a subscription.

        Args:
            callback_group: their group.
            side: the entity of the seam.
            topic_name: the topic as the program names it.
            warn: logs a warning in the name of the node.
        """
        chosen = {name: getattr(self, name) for name in self._names}
        if chosen["incompatible_qos"] is None and self.use_default_callbacks:
            text = self._warning
            chosen["incompatible_qos"] = lambda info: warn(
                text.format(topic_name, qos_policy_name_from_kind(info.last_policy_kind))
            )
        return [
            EventHandler(
                callback_group=callback_group,
                callback=callback,
                event_type=self._types[name],
                status=getattr(side, _STATUS[type(self._types[name])].get(name, name)),
            )
            for name, callback in chosen.items()
            if callback is not None and name != "incompatible_type"
        ]


_STATUS: dict[type, dict[str, str]] = {
    QoSPublisherEventType: {"incompatible_qos": "incompatible", "liveliness": "lost"},
    QoSSubscriptionEventType: {"incompatible_qos": "incompatible"},
}


class SubscriptionEventCallbacks(_Callbacks):
    """Callbacks for the events of a subscription.

    Args:
        deadline: a message did not come in time.
        incompatible_qos: a publisher has an unequal quality of service.
        liveliness: a publisher is alive, or no more.
        message_lost: accepted; the bus reports lost messages itself.
        incompatible_type: accepted; the graph reports unequal types itself.
        matched: a publisher is connected, or no more.
        use_default_callbacks: warn of unequal qualities of service unless `incompatible_qos` is given.
    """

    _warning = _NO_RECEIVING
    _types = {  # noqa: RUF012  # not changed
        "deadline": QoSSubscriptionEventType.RCL_SUBSCRIPTION_REQUESTED_DEADLINE_MISSED,
        "incompatible_qos": QoSSubscriptionEventType.RCL_SUBSCRIPTION_REQUESTED_INCOMPATIBLE_QOS,
        "liveliness": QoSSubscriptionEventType.RCL_SUBSCRIPTION_LIVELINESS_CHANGED,
        "message_lost": QoSSubscriptionEventType.RCL_SUBSCRIPTION_MESSAGE_LOST,
        "matched": QoSSubscriptionEventType.RCL_SUBSCRIPTION_MATCHED,
    }

    def __init__(
        self,
        *,
        deadline: Callable[[Any], Any] | None = None,
        incompatible_qos: Callable[[Any], Any] | None = None,
        liveliness: Callable[[Any], Any] | None = None,
        message_lost: Callable[[Any], Any] | None = None,
        incompatible_type: Callable[[Any], Any] | None = None,
        matched: Callable[[Any], Any] | None = None,
        use_default_callbacks: bool = True,
    ) -> None:
        callbacks = {
            "deadline": deadline,
            "incompatible_qos": incompatible_qos,
            "liveliness": liveliness,
            "message_lost": message_lost,
            "incompatible_type": incompatible_type,
            "matched": matched,
        }
        super().__init__(use_default_callbacks, callbacks)


class PublisherEventCallbacks(_Callbacks):
    """Callbacks for the events of a publisher.

    Args:
        deadline: the publisher did not publish in time.
        liveliness: the publisher did not say in time that it is alive.
        incompatible_qos: a subscription has an unequal quality of service.
        incompatible_type: accepted; the graph reports unequal types itself.
        matched: a subscription is connected, or no more.
        use_default_callbacks: warn of unequal qualities of service unless `incompatible_qos` is given.
    """

    _warning = _NO_SENDING
    _types = {  # noqa: RUF012  # not changed
        "deadline": QoSPublisherEventType.RCL_PUBLISHER_OFFERED_DEADLINE_MISSED,
        "liveliness": QoSPublisherEventType.RCL_PUBLISHER_LIVELINESS_LOST,
        "incompatible_qos": QoSPublisherEventType.RCL_PUBLISHER_OFFERED_INCOMPATIBLE_QOS,
        "matched": QoSPublisherEventType.RCL_PUBLISHER_MATCHED,
    }

    def __init__(
        self,
        *,
        deadline: Callable[[Any], Any] | None = None,
        liveliness: Callable[[Any], Any] | None = None,
        incompatible_qos: Callable[[Any], Any] | None = None,
        incompatible_type: Callable[[Any], Any] | None = None,
        matched: Callable[[Any], Any] | None = None,
        use_default_callbacks: bool = True,
    ) -> None:
        callbacks = {
            "deadline": deadline,
            "liveliness": liveliness,
            "incompatible_qos": incompatible_qos,
            "incompatible_type": incompatible_type,
            "matched": matched,
        }
        super().__init__(use_default_callbacks, callbacks)
