"""The modules `rospy`, `rospy.core`, `rospy.rostime`, ... of one node: which name stands for what.

They are made by name when a node first imports them, out of the node's own functions and classes. Imports nothing of
cfepy.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import cache, partial
from types import ModuleType
from typing import TYPE_CHECKING, Any

from rospy_shim import exceptions, genpy, link, logs, message, names, subscriber, timer, topic_handle

if TYPE_CHECKING:
    from rospy_shim.node import Node

Names = dict[str, Any]

_LOG_FUNCTIONS = tuple(
    f"log{level}{suffix}"
    for level in ("debug", "info", "warn", "err", "fatal")
    for suffix in ("", "_once", "_throttle", "_throttle_identical")
)
_NAME_CONSTANTS = ("ANYTYPE", "GLOBALNS", "REMAP", "SEP")


class RosModule(ModuleType):
    """A module of rospy; some of its names are made at first use.

    Args:
        name: full name.
        ready: names and what they stand for.
        late: names and what makes them.
    """

    __all__: list[str]

    def __init__(self, name: str, ready: Names, late: dict[str, Callable[[], Any]] | None = None) -> None:
        super().__init__(name)
        self.__dict__.update(ready)
        self._late = late or {}
        self.__all__ = [each for each in (*ready, *self._late) if not each.startswith("_")]

    def __getattr__(self, name: str) -> Any:
        make = self.__dict__.get("_late", {}).get(name)
        if make is None:
            raise AttributeError(f"module {self.__name__!r} has no attribute {name!r}")
        made = self.__dict__[name] = make()
        return made


class RosModules:
    """Makes the modules of one node.

    Args:
        node: the node.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._tables: dict[str, Callable[[], Names]] = {
            "client": self._client,
            "core": self._core,
            "exceptions": self._exceptions,
            "impl": dict,
            "msg": self._msg,
            "names": self._names,
            "numpy_msg": lambda: {"numpy_msg": cache(message.numpy_msg)},
            "rostime": self._rostime,
            "service": lambda: {"ServiceException": exceptions.ServiceException},
            "impl.tcpros_service": self._services,
            "timer": self._timer,
            "topics": lambda: {
                **self._topics(),
                "Topic": topic_handle.TopicHandle,
                "DEFAULT_BUFF_SIZE": subscriber.DEFAULT_BUFF_SIZE,
            },
        }

    def find(self, name: str) -> Callable[[Any], ModuleType] | None:
        """What makes a module, by its full name ("rospy", "rospy.core", "rospy_shim.core"); None: it is not rospy's."""
        package, _, part = name.partition(".")
        if package == "rospy_shim":
            return self._alias(part)
        if package != "rospy":
            return None
        if not part:
            return lambda universe: self._package()
        table = self._tables.get(part)
        return None if table is None else lambda universe: self._part(part)

    def _alias(self, part: str) -> Callable[[Any], ModuleType] | None:
        """`rospy_shim` is another name of `rospy`; what has no counterpart there is not found here."""
        if part and part not in self._tables:
            return None
        name = f"rospy.{part}" if part else "rospy"
        return lambda universe: universe.importer.load(name)

    def _part(self, part: str) -> ModuleType:
        late = {"Timer": lambda: self._node.Timer} if part == "timer" else {}
        module = RosModule(f"rospy.{part}", self._tables[part](), late)
        if part == "impl":
            module.__path__ = []
        return module

    def _package(self) -> ModuleType:
        node = self._node
        ready: Names = {}
        for table in (self._exceptions, self._top_of_core, self._client, self._params, self._top_names):
            ready |= table()
        ready |= _pick(node.clock, ("Time", "Duration", "get_rostime", "get_time"))
        ready |= self._topics() | self._timer() | self._services()
        ready |= {
            "AnyMsg": message.AnyMsg,
            "Header": node.library.message_class("std_msgs/Header"),
            "Message": genpy.Message,
            "ServiceException": exceptions.ServiceException,
        }
        load = node.universe.importer.load
        late: dict[str, Callable[[], Any]] = {
            part: partial(load, f"rospy.{part}") for part in self._tables if "." not in part
        }
        module = RosModule("rospy", ready, {**late, "Timer": lambda: node.Timer})
        module.__path__ = []
        return module

    # -- tables ------------------------------------------------------------------------------------------------------

    def _exceptions(self) -> Names:
        return _pick(
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

    def _client(self) -> Names:
        own = (
            "init_node",
            "get_published_topics",
            "load_command_line_node_params",
            "myargv",
            "wait_for_message",
        )
        life = self._node.life
        return {
            **_pick(self._node.client, own),
            **self._params(),
            **_pick(logs, ("DEBUG", "INFO", "WARN", "ERROR", "FATAL")),
            "on_shutdown": life.add_client_shutdown_hook,
            "spin": life.spin,
        }

    def _params(self) -> Names:
        functions = (
            "delete_param",
            "get_param",
            "get_param_cached",
            "get_param_names",
            "has_param",
            "search_param",
            "set_param",
        )
        return _pick(self._node.params, functions)

    def _top_of_core(self) -> Names:
        return {
            **_pick(self._node.logs, _LOG_FUNCTIONS),
            "logerror": self._node.logs.logerr,
            "logout": self._node.logs.loginfo,
            "get_node_uri": self._node.client.get_node_uri,
            **_pick(self._node.life, ("is_shutdown", "signal_shutdown")),
        }

    def _core(self) -> Names:
        hooks = (
            "add_client_shutdown_hook",
            "add_preshutdown_hook",
            "add_shutdown_hook",
            "is_shutdown_requested",
            "register_signals",
        )
        return {
            **self._top_of_core(),
            **_pick(self._node.life, hooks),
            **_pick(self._node.client, ("is_initialized", "set_node_uri")),
            **_pick(self._node.names, ("get_name", "get_caller_id")),
            **_pick(names, _NAME_CONSTANTS),
        }

    def _top_names(self) -> Names:
        return _pick(self._node.names, ("get_caller_id", "get_name", "get_namespace", "remap_name", "resolve_name"))

    def _names(self) -> Names:
        own = (
            "get_mappings",
            "get_resolved_mappings",
            "initialize_mappings",
            "reload_mappings",
            "resolve_name_without_node_name",
        )
        shared = ("canonicalize_name", "global_name", "scoped_name", *_NAME_CONSTANTS)
        any_type = {"TOPIC_ANYTYPE": names.ANYTYPE, "SERVICE_ANYTYPE": names.ANYTYPE}
        return {**self._top_names(), **_pick(self._node.names, own), **_pick(names, shared), **any_type}

    def _rostime(self) -> Names:
        functions = (
            "Duration",
            "Time",
            "get_rostime",
            "get_time",
            "is_rostime_initialized",
            "is_wallclock",
            "set_rostime_initialized",
            "wallsleep",
        )
        return _pick(self._node.clock, functions)

    def _timer(self) -> Names:
        return {"Rate": self._node.Rate, "TimerEvent": timer.TimerEvent, "sleep": self._node.clock.sleep}

    def _topics(self) -> Names:
        return {
            "Publisher": self._node.Publisher,
            "Subscriber": self._node.Subscriber,
            "SubscribeListener": link.SubscribeListener,
        }

    def _services(self) -> Names:
        return _pick(self._node, ("Service", "ServiceProxy", "wait_for_service"))

    def _msg(self) -> Names:
        return _pick(message, ("AnyMsg", "args_kwds_to_message", "serialize_message"))


def _pick(source: object, wanted: Iterable[str]) -> Names:
    return {name: getattr(source, name) for name in wanted}
