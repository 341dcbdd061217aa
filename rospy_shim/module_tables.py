"""The names in each module of rospy, and what they stand for: functions and classes of one node.

Imports nothing of cfepy.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

from rospy_shim import (
    exceptions,
    link,
    logs,
    message,
    names,
    service,
    subscription,
    timer,
    topic_handle,
    topic_manager,
    validators,
)

if TYPE_CHECKING:
    from rospy_shim.node import Node

Names = dict[str, Any]

_LOG_FUNCTIONS = tuple(
    f"log{level}{suffix}"
    for level in ("debug", "info", "warn", "err", "fatal")
    for suffix in ("", "_once", "_throttle", "_throttle_identical")
)
_NAME_CONSTANTS = ("ANYTYPE", "GLOBALNS", "REMAP", "SEP", "SERVICE_ANYTYPE", "TOPIC_ANYTYPE")


class ModuleTables:
    """The tables of one node; each method is one.

    Args:
        node: the node.
        get_master: its `rospy.get_master`.
    """

    def __init__(self, node: Node, get_master: Callable[..., Any]) -> None:
        self._node = node
        self._get_master = get_master

    def exceptions(self) -> Names:
        """`rospy.exceptions`."""
        return pick(
            exceptions,
            (
                "ROSException",
                "ROSInitException",
                "ROSInternalException",
                "ROSInterruptException",
                "ROSSerializationException",
                "ROSTimeMovedBackwardsException",
                "TransportException",
                "TransportInitError",
                "TransportTerminated",
            ),
        )

    def client(self) -> Names:
        """`rospy.client`."""
        own = (
            "init_node",
            "get_published_topics",
            "load_command_line_node_params",
            "myargv",
            "wait_for_message",
        )
        life = self._node.life
        return {
            **pick(self._node.client, own),
            **self.params(),
            **pick(logs, ("DEBUG", "INFO", "WARN", "ERROR", "FATAL")),
            "TIMEOUT_READY": 15.0,
            "get_master": self._get_master,
            "on_shutdown": life.add_client_shutdown_hook,
            "spin": life.spin,
        }

    def params(self) -> Names:
        """The functions for parameters."""
        functions = (
            "delete_param",
            "get_param",
            "get_param_cached",
            "get_param_names",
            "has_param",
            "search_param",
            "set_param",
        )
        return pick(self._node.params, functions)

    def top_of_core(self) -> Names:
        """What `rospy` shows of `rospy.core`."""
        return {
            **pick(self._node.logs, _LOG_FUNCTIONS),
            "logerror": self._node.logs.logerr,
            "logout": self._node.logs.loginfo,
            "get_node_uri": self._node.client.get_node_uri,
            **pick(self._node.life, ("is_shutdown", "signal_shutdown")),
        }

    def core(self) -> Names:
        """`rospy.core`."""
        node = self._node
        hooks = (
            "add_client_shutdown_hook",
            "add_preshutdown_hook",
            "add_shutdown_hook",
            "is_shutdown_requested",
            "register_signals",
        )
        return {
            **self.names(),
            **self.top_of_core(),
            **pick(node.life, hooks),
            **pick(node.client, ("is_initialized", "set_initialized", "set_node_uri")),
            **pick(node.logs, ("LoggingThrottle", "configure_logging")),
            **pick(logs, ("LoggingIdentical", "LoggingOnce")),
            "MASTER_NAME": "master",
            "ROSRPC": "rosrpc://",
            "is_topic": validators.NameValidators(node.names.resolve_name).is_topic,
            "md5": hashlib.md5,
        }

    def validators(self) -> Names:
        """The checks of arguments."""
        resolving = validators.NameValidators(self._node.names.resolve_name)
        return {
            **pick(validators, ("ParameterInvalid", "global_name", "isstring", "valid_name_validator_unresolved")),
            **pick(resolving, ("valid_name", "valid_name_validator_resolved")),
        }

    def bridge(self) -> Names:
        """What code in INNER needs of the node itself; nodes have no use for it."""
        node = self._node
        return {
            "RosStreamHandler": node.logs.RosStreamHandler,
            "ServiceException": exceptions.ServiceException,
            "offered": lambda: topic_manager.offered(node),
            "topic_manager": topic_manager.TopicManager(node),
        }

    def names_at_top(self) -> Names:
        """What `rospy` shows of `rospy.names`."""
        return pick(self._node.names, ("get_caller_id", "get_name", "get_namespace", "remap_name", "resolve_name"))

    def names(self) -> Names:
        """`rospy.names`."""
        own = (
            "get_mappings",
            "get_resolved_mappings",
            "initialize_mappings",
            "reload_mappings",
            "resolve_name_without_node_name",
        )
        shared = ("canonicalize_name", "scoped_name", *_NAME_CONSTANTS)
        return {
            **self.names_at_top(),
            **pick(self._node.names, own),
            **pick(names, shared),
            **self.validators(),
            "_set_caller_id": self._node.names.set_caller_id,
        }

    def rostime(self) -> Names:
        """`rospy.rostime`."""
        functions = (
            "Duration",
            "Time",
            "_set_rostime",
            "get_rostime",
            "get_rostime_cond",
            "get_time",
            "is_rostime_initialized",
            "is_wallclock",
            "set_rostime_initialized",
            "switch_to_wallclock",
            "wallsleep",
        )
        return pick(self._node.clock, functions)

    def timer(self) -> Names:
        """`rospy.timer`."""
        return {"Rate": self._node.Rate, "TimerEvent": timer.TimerEvent, "sleep": self._node.clock.sleep}

    def topics(self) -> Names:
        """What `rospy` shows of `rospy.topics`."""
        return {
            "Publisher": self._node.Publisher,
            "Subscriber": self._node.Subscriber,
            "SubscribeListener": link.SubscribeListener,
        }

    def topics_module(self) -> Names:
        """`rospy.topics`."""
        return {
            **self.topics(),
            **pick(names, _NAME_CONSTANTS),
            "DEFAULT_BUFF_SIZE": subscription.DEFAULT_BUFF_SIZE,
            "MASTER_NAME": "master",
            "ROSRPC": "rosrpc://",
            "Topic": topic_handle.TopicHandle,
            "_PublisherImpl": link.Link,
            "_SubscriberImpl": subscription.Subscription,
            "_TopicImpl": topic_handle.TopicSide,
            "_TopicManager": topic_manager.TopicManager,
            "md5": hashlib.md5,
            "python3": 1,
        }

    def services(self) -> Names:
        """What `rospy` shows of services."""
        return pick(self._node, ("Service", "ServiceProxy", "wait_for_service"))

    def services_module(self) -> Names:
        """`rospy.impl.tcpros_service`."""
        return {
            **self.services(),
            "DEFAULT_BUFF_SIZE": subscription.DEFAULT_BUFF_SIZE,
            "ServiceImpl": self._node.Service,
            "convert_return_to_response": service.response_of,
            "isstring": validators.isstring,
        }

    def msg(self) -> Names:
        """`rospy.msg`."""
        return pick(message, ("AnyMsg", "args_kwds_to_message", "deserialize_messages", "serialize_message"))


def pick(source: object, wanted: Iterable[str]) -> Names:
    """Attributes of an object by name."""
    return {name: getattr(source, name) for name in wanted}
