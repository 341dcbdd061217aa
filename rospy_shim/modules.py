"""The modules `rospy`, `rospy.core`, `rospy.rostime`, ... of one node: which name stands for what.

They are made by name when a node first imports them, out of the node's own functions and classes. Imports nothing of
cfepy.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterable
from functools import cache, partial
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

from rospy_shim import (
    exceptions,
    genpy,
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
from rospy_shim.master import make_get_master, make_master_proxy

if TYPE_CHECKING:
    from rospy_shim.node import Node

Names = dict[str, Any]
Makers = dict[str, Callable[[], Any]]
Live = dict[str, tuple[object, str]]

INNER = Path(__file__).parent / "inner"
"""Modules of rospy that are ordinary code of nodes, executed afresh in each universe."""

_LOG_FUNCTIONS = tuple(
    f"log{level}{suffix}"
    for level in ("debug", "info", "warn", "err", "fatal")
    for suffix in ("", "_once", "_throttle", "_throttle_identical")
)
_NAME_CONSTANTS = ("ANYTYPE", "GLOBALNS", "REMAP", "SEP", "SERVICE_ANYTYPE", "TOPIC_ANYTYPE")
_SUBMODULES = ("logger_level_service_caller", "rosconsole", "service")  # of those in INNER, what `import rospy` shows
_CORE_TOOLS = (
    "NullHandler",
    "deprecated",
    "get_ros_root",
    "parse_rosrpc_uri",
    "rospydebug",
    "rospyerr",
    "rospyinfo",
    "rospywarn",
    "xmlrpcapi",
)


class RosModule(ModuleType):
    """A module of rospy; some of its names are made at first use, others stand for what an object has right now.

    Args:
        name: full name.
        ready: names and what they stand for.
        late: names and what makes them.
        live: names, and the attributes of objects that they are.
    """

    __all__: list[str]

    def __init__(self, name: str, ready: Names, late: Makers | None = None, live: Live | None = None) -> None:
        super().__init__(name)
        self.__dict__.update(ready, _late=late or {}, _live=live or {})
        self.__dict__["__all__"] = [each for each in (*ready, *self._late) if not each.startswith("_")]

    def __getattr__(self, name: str) -> Any:
        known = self.__dict__
        if name in known.get("_live", ()):
            return getattr(*known["_live"][name])
        make = known.get("_late", {}).get(name)
        if make is None:
            raise AttributeError(f"module {self.__name__!r} has no attribute {name!r}")
        made = known[name] = make()
        return made

    def __setattr__(self, name: str, value: Any) -> None:
        if name in self.__dict__.get("_live", ()):
            owner, attribute = self.__dict__["_live"][name]
            setattr(owner, attribute, value)
        else:
            super().__setattr__(name, value)

    def __dir__(self) -> list[str]:
        return sorted({*self.__dict__, *self._late})


class RosModules:
    """Makes the modules of one node.

    Args:
        node: the node.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._master_proxy = make_master_proxy(node)
        self._get_master = make_get_master(node, self._master_proxy)
        self._tables: dict[str, Callable[[], Names]] = {
            "client": self._client,
            "core": self._core,
            "exceptions": self._exceptions,
            "impl": dict,
            "msg": self._msg,
            "msproxy": lambda: {"MasterProxy": self._master_proxy},
            "names": self._names,
            "numpy_msg": lambda: {"numpy_msg": cache(message.numpy_msg)},
            "rostime": self._rostime,
            "timer": self._timer,
            "topics": self._topics_module,
            "impl._node": self._bridge,
            "impl.rosout": lambda: _pick(node.logs, ("RosOutHandler", "init_rosout", "load_rosout_handlers")),
            "impl.simtime": lambda: {"init_simtime": node.clock.init_simtime},
            "impl.tcpros_service": self._services_module,
            "impl.validators": lambda: _pick(validators, ("ParameterInvalid", "non_empty")),
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
        if part in self._tables:
            return lambda universe: self._part(part)
        file = INNER.joinpath(*part.split(".")).with_suffix(".py")
        return (lambda universe: universe.importer.load_file(name, str(file))) if file.is_file() else None

    def _alias(self, part: str) -> Callable[[Any], ModuleType] | None:
        """`rospy_shim` is another name of `rospy`; what has no counterpart there is not found here."""
        name = f"rospy.{part}" if part else "rospy"
        return (lambda universe: universe.importer.load(name)) if self.find(name) is not None else None

    def _part(self, part: str) -> ModuleType:
        late: Makers = {}
        live: Live = {}
        if part == "timer":
            late = {"Timer": lambda: self._node.Timer}
        elif part in ("client", "msproxy"):
            late = {"Lock": lambda: self._node.universe.importer.load("threading").Lock}
        elif part == "impl.tcpros_service":
            late = {"logger": lambda: self._node.logs.logging.getLogger("rospy.service")}
        elif part == "core":
            late = {name: partial(self._core_tool, name) for name in _CORE_TOOLS}
            live = self._live_names_of_core()
        elif part == "names":
            live = {"_mappings": (self._node.names, "_mappings"), "_resolved_mappings": (self._node.names, "_resolved")}
        module = RosModule(f"rospy.{part}", self._tables[part](), late, live)
        if part == "impl":
            module.__path__ = []
        return module

    def _core_tool(self, name: str) -> Any:
        return getattr(self._node.universe.importer.load("rospy.impl._core"), name)

    def _live_names_of_core(self) -> Live:
        life = self._node.life
        return {
            "_client_shutdown_hooks": (life, "_client_hooks"),
            "_in_shutdown": (life, "_requested"),
            "_log_filename": (self._node.logs, "file"),
            "_preshutdown_hooks": (life, "_preshutdown_hooks"),
            "_shutdown_flag": (life, "_flag"),
            "_shutdown_hooks": (life, "_shutdown_hooks"),
        }

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
        ready["get_master"] = self._get_master
        ready |= _pick(logs, ("DEBUG", "INFO", "WARN", "ERROR", "FATAL"))
        tools: Makers = {name: partial(self._core_tool, name) for name in ("get_ros_root", "parse_rosrpc_uri")}
        master: Makers = {"MasterProxy": lambda: node.universe.importer.load("rospy.msproxy").MasterProxy}
        module = RosModule("rospy", ready, {**tools, **master, "Timer": lambda: node.Timer, **self._submodules()})
        module.__path__ = []
        module.__all__ = [name for name in module.__all__ if name not in self._submodules()]
        return module

    def _submodules(self) -> Makers:
        """The modules that `import rospy` shows, loaded when they are first looked at."""
        load = self._node.universe.importer.load
        names = [*(part for part in self._tables if "." not in part), *_SUBMODULES]
        return {part: partial(load, f"rospy.{part}") for part in names}

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
            "TIMEOUT_READY": 15.0,
            "get_master": self._get_master,
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
        node = self._node
        hooks = (
            "add_client_shutdown_hook",
            "add_preshutdown_hook",
            "add_shutdown_hook",
            "is_shutdown_requested",
            "register_signals",
        )
        return {
            **self._top_of_core(),
            **_pick(node.life, hooks),
            **_pick(node.client, ("is_initialized", "set_initialized", "set_node_uri")),
            **_pick(node.names, ("get_name", "get_caller_id", "get_mappings", "resolve_name")),
            **_pick(node.logs, ("LoggingThrottle", "configure_logging")),
            **_pick(logs, ("LoggingIdentical", "LoggingOnce")),
            **_pick(names, _NAME_CONSTANTS),
            **self._validators(),
            "MASTER_NAME": "master",
            "ROSRPC": "rosrpc://",
            "is_topic": validators.NameValidators(node.names.resolve_name).is_topic,
            "md5": hashlib.md5,
        }

    def _validators(self) -> Names:
        resolving = validators.NameValidators(self._node.names.resolve_name)
        return {
            **_pick(validators, ("ParameterInvalid", "global_name", "isstring", "valid_name_validator_unresolved")),
            **_pick(resolving, ("valid_name", "valid_name_validator_resolved")),
        }

    def _bridge(self) -> Names:
        """What code in INNER needs of the node itself; nodes have no use for it."""
        node = self._node
        return {
            "RosStreamHandler": node.logs.RosStreamHandler,
            "ServiceException": exceptions.ServiceException,
            "offered": lambda: topic_manager.offered(node),
            "topic_manager": topic_manager.TopicManager(node),
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
        shared = ("canonicalize_name", "scoped_name", *_NAME_CONSTANTS)
        return {
            **self._top_names(),
            **_pick(self._node.names, own),
            **_pick(names, shared),
            **self._validators(),
            "_set_caller_id": self._node.names.set_caller_id,
        }

    def _rostime(self) -> Names:
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
        return _pick(self._node.clock, functions)

    def _timer(self) -> Names:
        return {"Rate": self._node.Rate, "TimerEvent": timer.TimerEvent, "sleep": self._node.clock.sleep}

    def _topics(self) -> Names:
        return {
            "Publisher": self._node.Publisher,
            "Subscriber": self._node.Subscriber,
            "SubscribeListener": link.SubscribeListener,
        }

    def _topics_module(self) -> Names:
        return {
            **self._topics(),
            **_pick(names, _NAME_CONSTANTS),
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

    def _services(self) -> Names:
        return _pick(self._node, ("Service", "ServiceProxy", "wait_for_service"))

    def _services_module(self) -> Names:
        return {
            **self._services(),
            "DEFAULT_BUFF_SIZE": subscription.DEFAULT_BUFF_SIZE,
            "ServiceImpl": self._node.Service,
            "convert_return_to_response": service.response_of,
            "isstring": validators.isstring,
        }

    def _msg(self) -> Names:
        return _pick(message, ("AnyMsg", "args_kwds_to_message", "deserialize_messages", "serialize_message"))


def _pick(source: object, wanted: Iterable[str]) -> Names:
    return {name: getattr(source, name) for name in wanted}
