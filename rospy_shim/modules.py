"""The modules `rospy`, `rospy.core`, `rospy.rostime`, ... of one node.

They are made by name when a node first imports them, out of the node's own functions and classes
(`rospy_shim.module_tables`). Imports nothing of cfepy.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, partial
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

from rospy_shim import exceptions, genpy, logs, message, validators
from rospy_shim.master import make_get_master, make_master_proxy
from rospy_shim.module_tables import ModuleTables, Names, pick

if TYPE_CHECKING:
    from rospy_shim.node import Node

Makers = dict[str, Callable[[], Any]]
Live = dict[str, tuple[object, str]]

INNER = Path(__file__).parent / "inner"
"""Modules of rospy that are ordinary code of nodes, executed afresh in each universe."""

_SUBMODULES = ("logger_level_service_caller", "rosconsole", "service")  # of those in INNER, what `import rospy` shows
_IMPORTED = (
    "roscpp.msg",
    "roscpp.srv",
    "rosgraph_msgs.msg",
    "std_msgs.msg",
)  # by `import rospy`, as some scripts rely on
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
        master_proxy = make_master_proxy(node)
        self._of_node = tables = ModuleTables(node, make_get_master(node, master_proxy))
        self._tables: dict[str, Callable[[], Names]] = {
            "client": tables.client,
            "core": tables.core,
            "exceptions": tables.exceptions,
            "impl": dict,
            "msg": tables.msg,
            "msproxy": lambda: {"MasterProxy": master_proxy},
            "names": tables.names,
            "numpy_msg": lambda: {"numpy_msg": cache(message.numpy_msg)},
            "rostime": tables.rostime,
            "timer": tables.timer,
            "topics": tables.topics_module,
            "impl._node": tables.bridge,
            "impl.rosout": lambda: pick(node.logs, ("RosOutHandler", "init_rosout", "load_rosout_handlers")),
            "impl.simtime": lambda: {"init_simtime": node.clock.init_simtime},
            "impl.tcpros_service": tables.services_module,
            "impl.validators": lambda: pick(validators, ("ParameterInvalid", "non_empty")),
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
            late |= {name: partial(self._graph_name, name) for name in _GRAPH_NAMES}
            live = self._live_names_of_core()
        elif part == "names":
            late = {name: partial(self._graph_name, name) for name in _GRAPH_NAMES}
            live = {"_mappings": (self._node.names, "_mappings"), "_resolved_mappings": (self._node.names, "_resolved")}
        module = RosModule(f"rospy.{part}", self._tables[part](), late, live)
        if part == "impl":
            module.__path__ = []
            module._late.update(self._submodules_of_impl())
        return module

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
        ready: Names = {}
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
        """The modules that `import rospy` shows, loaded when they are first looked at."""
        load = self._node.universe.importer.load
        names = [*(part for part in self._tables if "." not in part), *_SUBMODULES]
        return {part: partial(load, f"rospy.{part}") for part in names}

    def _submodules_of_impl(self) -> Makers:
        """What `rospy.impl` shows, loaded when it is first looked at."""
        load = self._node.universe.importer.load
        names = [part.removeprefix("impl.") for part in self._tables if part.startswith("impl.")]
        names += [file.stem for file in sorted(INNER.joinpath("impl").glob("*.py"))]
        return {name: partial(load, f"rospy.impl.{name}") for name in names if not name.startswith("_")}
