"""The modules `rospy`, `rospy.core`, `rospy.rostime`, ... of one node, and the names in each.

They are made by name when a node first imports them, from the node's own functions and classes.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Container, Iterable
from functools import cache, partial
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

from cfepy.nodes import imported
from rospy_shim.client import link, logs, message, params, service, subscription, timer, topic_side, topics
from rospy_shim.library_parts import shown_names
from rospy_shim.master import make_get_master, make_master_proxy
from rospy_shim.types import exceptions, genpy, names

if TYPE_CHECKING:
    from cfepy.nodes import Factory
    from rospy_shim.client.node import Node

NameTable = dict[str, Any]
_LOG_FUNCTIONS = tuple(
    f"log{level}{suffix}"
    for level in ("debug", "info", "warn", "err", "fatal")
    for suffix in ("", "_once", "_throttle", "_throttle_identical")
)
_NAME_CONSTANTS = ("ANYTYPE", "GLOBALNS", "REMAP", "SEP", "SERVICE_ANYTYPE", "TOPIC_ANYTYPE")
Makers = dict[str, Callable[[], Any]]
Live = dict[str, tuple[object, str]]
INNER = Path(__file__).parents[1] / "rospy_modules"
"""Modules of rospy that are ordinary code of nodes, executed afresh in each universe."""
_SHOWN = (
    *("client", "core", "exceptions", "impl", "msg", "msproxy", "names", "rostime", "service", "timer"),
    "topics",
)
"""Modules that `import rospy` shows; a node has to import others itself."""
_IMPORTED = (
    "roscpp.msg",
    "roscpp.srv",
    "rosgraph_msgs.msg",
    "std_msgs.msg",
)  # by `import rospy`; some scripts rely on it
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
_GRAPH_NAMES = (
    "get_ros_namespace",
    "is_global",
    "is_private",
    "load_mappings",
    "make_global_ns",
    "namespace",
    "ns_join",
)


class ModuleTables:
    """The tables of names of one node; each method returns one.

    Args:
        node: the node.
        get_master: its `rospy.get_master`.
    """

    def __init__(self, node: Node, get_master: Callable[..., Any]) -> None:
        self._node = node
        self._get_master = get_master

    def exceptions(self) -> NameTable:
        """Return the names of `rospy.exceptions`."""
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

    def client(self) -> NameTable:
        """Return the names of `rospy.client` that are in `rospy`, too."""
        own = ("init_node", "get_published_topics", "myargv", "wait_for_message")
        life = self._node.life
        return {
            **pick(self._node.client, own),
            **self.params(),
            **pick(logs, ("DEBUG", "INFO", "WARN", "ERROR", "FATAL")),
            "get_master": self._get_master,
            "on_shutdown": life.add_client_shutdown_hook,
            "spin": life.spin,
        }

    def client_module(self) -> NameTable:
        """Return the names of `rospy.client`."""
        return {
            **self.client(),
            "TIMEOUT_READY": 15.0,
            "load_command_line_node_params": self._node.client.load_command_line_node_params,
            "_Unspecified": params.Unspecified,
            "_unspecified": params.UNSPECIFIED,
        }

    def params(self) -> NameTable:
        """Return the functions for parameters."""
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

    def top_of_core(self) -> NameTable:
        """Return the names of `rospy.core` that are in `rospy`, too."""
        return {
            **pick(self._node.logs, _LOG_FUNCTIONS),
            "logout": self._node.logs.loginfo,
            "get_node_uri": self._node.client.get_node_uri,
            **pick(self._node.life, ("is_shutdown", "signal_shutdown")),
        }

    def core(self) -> NameTable:
        """Return the names of `rospy.core`."""
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
            "logerror": node.logs.logerr,
            "is_topic": names.NameValidators(node.names.resolve_name).is_topic,
            "md5": hashlib.md5,
        }

    def validators(self) -> NameTable:
        """Return the checks of arguments."""
        resolving = names.NameValidators(self._node.names.resolve_name)
        return {
            **pick(names, ("ParameterInvalid", "global_name", "isstring", "valid_name_validator_unresolved")),
            **pick(resolving, ("valid_name", "valid_name_validator_resolved")),
        }

    def bridge(self) -> NameTable:
        """Return the names that code in INNER needs of the node itself; nodes have no use for them."""
        node = self._node
        return {
            "RosStreamHandler": node.logs.RosStreamHandler,
            "adopt_cache": partial(setattr, node.params, "cache"),
            "adopt_handler": partial(setattr, node, "handler"),
            "ServiceException": exceptions.ServiceException,
            "offered": lambda: topics.offered(node),
            "topic_manager": topics.TopicManager(node),
        }

    def names_at_top(self) -> NameTable:
        """Return the names of `rospy.names` that are in `rospy`, too."""
        return pick(self._node.names, ("get_caller_id", "get_name", "get_namespace", "remap_name", "resolve_name"))

    def names(self) -> NameTable:
        """Return the names of `rospy.names`."""
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

    def rostime(self) -> NameTable:
        """Return the names of `rospy.rostime`."""
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

    def timer(self) -> NameTable:
        """Return the names of `rospy.timer` that are in `rospy`, too."""
        return {"Rate": self._node.Rate, "sleep": self._node.clock.sleep}

    def timer_module(self) -> NameTable:
        """Return the names of `rospy.timer`."""
        return {**self.timer(), "TimerEvent": timer.TimerEvent}

    def topics(self) -> NameTable:
        """Return the names of `rospy.topics` that are in `rospy`, too."""
        return {
            "Publisher": self._node.Publisher,
            "Subscriber": self._node.Subscriber,
            "SubscribeListener": link.SubscribeListener,
        }

    def topics_module(self) -> NameTable:
        """Return the names of `rospy.topics`."""
        return {
            **self.topics(),
            **pick(names, _NAME_CONSTANTS),
            "DEFAULT_BUFF_SIZE": subscription.DEFAULT_BUFF_SIZE,
            "MASTER_NAME": "master",
            "ROSRPC": "rosrpc://",
            "Topic": topics.TopicHandle,
            "_PublisherImpl": link.Link,
            "_SubscriberImpl": subscription.Subscription,
            "_TopicImpl": topic_side.TopicSide,
            "_TopicManager": topics.TopicManager,
            "md5": hashlib.md5,
            "python3": 1,
        }

    def services(self) -> NameTable:
        """Return the names of services that are in `rospy`."""
        return pick(self._node, ("Service", "ServiceProxy", "wait_for_service"))

    def services_module(self) -> NameTable:
        """Return the names of `rospy.impl.tcpros_service`."""
        return {
            **self.services(),
            "DEFAULT_BUFF_SIZE": subscription.DEFAULT_BUFF_SIZE,
            "ServiceImpl": self._node.Service,
            "convert_return_to_response": service.response_of,
            "isstring": names.isstring,
        }

    def msg(self) -> NameTable:
        """Return the names of `rospy.msg`."""
        return pick(message, ("AnyMsg", "args_kwds_to_message", "deserialize_messages", "serialize_message"))


def pick(source: object, wanted: Iterable[str]) -> NameTable:
    """Return attributes of an object by name."""
    return {name: getattr(source, name) for name in wanted}


class RosModule(ModuleType):
    """A module of rospy. Some of its names are made at first use, others refer to an object's present attributes.

    Args:
        name: full name.
        ready: names and their values.
        late: names and functions that make their values.
        live: names, and the attributes of objects that they refer to.
    """

    __all__: list[str]

    def __init__(self, name: str, ready: NameTable, late: Makers | None = None, live: Live | None = None) -> None:
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
        master_proxy = make_master_proxy(node)
        self._of_node = tables = ModuleTables(node, make_get_master(node, master_proxy))
        self._tables: dict[str, Callable[[], NameTable]] = {
            "client": tables.client_module,
            "core": tables.core,
            "exceptions": tables.exceptions,
            "impl": dict,
            "msg": tables.msg,
            "msproxy": lambda: {"MasterProxy": master_proxy},
            "names": tables.names,
            "numpy_msg": lambda: {"numpy_msg": cache(message.numpy_msg)},
            "rostime": tables.rostime,
            "timer": tables.timer_module,
            "topics": tables.topics_module,
            "impl._node": tables.bridge,
            "impl.rosout": lambda: pick(node.logs, ("RosOutHandler", "init_rosout", "load_rosout_handlers")),
            "impl.simtime": lambda: {"init_simtime": node.clock.init_simtime},
            "impl.tcpros_service": tables.services_module,
            "impl.validators": lambda: pick(names, ("ParameterInvalid", "non_empty")),
        }

    def find(self, name: str) -> Factory | None:
        """Return the factory of a module by its full name ("rospy", "rospy.core", "rospy_shim.core"); None if not
        rospy's.
        """
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

    def _alias(self, part: str) -> Factory | None:
        """Return the factory of a `rospy_shim` module, which is an alias of a rospy module; None without a
        counterpart.
        """
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
            late |= {name: partial(self._graph_name, name) for name in _GRAPH_NAMES}
            live = self._live_names_of_core()
        elif part == "names":
            late = {name: partial(self._graph_name, name) for name in _GRAPH_NAMES}
            live = {"_mappings": (self._node.names, "_mappings"), "_resolved_mappings": (self._node.names, "_resolved")}
        ready = self._tables[part]()
        late = {**self._imports(f"rospy.{part}", {*ready, *live}), **late}
        module = RosModule(f"rospy.{part}", ready, late, live)
        if part == "impl":
            module.__path__ = []
            module._late.update(self._submodules_of_impl())
        return module

    def _imports(self, module: str, known: Container[str]) -> Makers:
        """Return the names that a module has because the original imports them, without those that are known."""
        load = self._node.universe.importer.load
        shown = (shown_names(module) or {}).items()
        return {name: partial(imported, home, load, module) for name, home in shown if home and name not in known}

    def _core_tool(self, name: str) -> Any:
        return getattr(self._node.universe.importer.load("rospy.impl._core"), name)

    def _graph_name(self, name: str) -> Any:
        return getattr(self._node.universe.importer.load("rosgraph.names"), name)

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
        node, tables = self._node, self._of_node
        ready: NameTable = {}
        for table in (tables.exceptions, tables.top_of_core, tables.client, tables.params, tables.names_at_top):
            ready |= table()
        ready |= pick(node.clock, ("Time", "Duration", "get_rostime", "get_time"))
        ready |= tables.topics() | tables.timer() | tables.services()
        ready |= {
            "AnyMsg": message.AnyMsg,
            "Header": node.library.message_class("std_msgs/Header"),
            "Message": genpy.Message,
            "ServiceException": exceptions.ServiceException,
        }
        ready |= pick(logs, ("DEBUG", "INFO", "WARN", "ERROR", "FATAL"))
        tools: Makers = {name: partial(self._core_tool, name) for name in ("get_ros_root", "parse_rosrpc_uri")}
        master: Makers = {"MasterProxy": lambda: node.universe.importer.load("rospy.msproxy").MasterProxy}
        submodules = self._submodules()
        module = RosModule("rospy", ready, {**tools, **master, "Timer": lambda: node.Timer, **submodules})
        module.__path__ = []
        module.__all__ = [name for name in module.__all__ if name not in submodules]
        for name in _IMPORTED:
            node.universe.importer.load(name)
        return module

    def _submodules(self) -> Makers:
        """Return the modules that `import rospy` shows; they are loaded at first use."""
        load = self._node.universe.importer.load
        return {part: partial(load, f"rospy.{part}") for part in _SHOWN}

    def _submodules_of_impl(self) -> Makers:
        """Return the modules that `rospy.impl` shows; they are loaded at first use."""
        load = self._node.universe.importer.load
        names = [part.removeprefix("impl.") for part in self._tables if part.startswith("impl.")]
        names += [file.stem for file in sorted(INNER.joinpath("impl").glob("*.py"))]
        return {name: partial(load, f"rospy.impl.{name}") for name in names if not name.startswith("_")}
