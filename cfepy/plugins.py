"""Add-ons: how cfepy finds those in `cfepy.extra` and those of other packages.

An add-on is a `Plugin`: a table of the names that it offers. It is loaded only when it is used. Another package offers
an add-on in its pyproject.toml; docs/how_to/plugins.md explains how to write one:

    [project.entry-points."cfepy.plugins"]
    yamcs = "cfepy_yamcs:PLUGIN"
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator, Mapping
from functools import cache
from importlib import import_module
from importlib.util import find_spec
from types import MappingProxyType
from typing import Any, Generic, NamedTuple, TypeVar

from cfepy.status import UsageError

T = TypeVar("T")
GROUP = "cfepy.plugins"
"""The entry-point group for add-ons of other packages."""


class Plugin(NamedTuple):
    """An add-on and the names that it offers. A module name that begins with a dot is relative to the add-on's package.

    Attributes:
        name: name of the add-on.
        package: its Python package.
        commands: names of the subcommands that it adds to `cfepy`.
        title: the heading above these commands in `cfepy --help`.
        parser: the module whose function `add` adds the parsers of these commands; it imports little, to keep the help
            quick.
        hooks: for each hook name the object that fills it, as "MODULE:NAME".
        needs: names of add-ons without which it counts as not installed.
    """

    name: str
    package: str
    commands: tuple[str, ...] = ()
    title: str = "Add-ons"
    parser: str = ".commands"
    hooks: Mapping[str, str] = MappingProxyType({})
    needs: tuple[str, ...] = ()

    def load(self, hook: str) -> Any:
        """Import the object that fills a hook, which must be in `hooks`.

        Raises:
            UsageError: if the add-on is in another package and cannot be imported.
        """
        return self._imported(self.hooks[hook])

    def add_commands(self, commands: Any) -> None:
        """Add the parsers of its commands.

        Args:
            commands: the subparsers of the parser of `cfepy`.

        Raises:
            UsageError: if the add-on is in another package and cannot be imported.
        """
        self._imported(f"{self.parser}:add")(commands)

    def _imported(self, place: str) -> Any:
        module, _, name = place.partition(":")
        try:
            return getattr(import_module(module, self.package), name)
        except Exception as error:
            if self in OWN:
                raise
            raise UsageError(
                f"cannot be loaded: {type(error).__name__}: {error}", field=f"add-on {self.name}"
            ) from error


def _own(name: str, **offers: Any) -> Plugin:
    """Return an add-on of `cfepy.extra`."""
    return Plugin(name, f"cfepy.extra.{name}", **offers)


OWN = (
    _own(
        "c",
        commands=("build",),
        title="Files of cFE",
        hooks={
            "compiled_code": ".in_missions:compiled_loader",
            "check_compiled": ".object_check:check_compiled",
            "check_profiles": ".object_check:check_profiles",
            "check_tree": ".trees.tree_check:check_tree",
            "mission_from": ".trees.walk_through:mission_from",
        },
    ),
    _own(
        "convert",
        commands=("convert",),
        title="ROS nodes in C++",
        hooks={"build_node": ".flight_build:build_for_flight", "check_sections": ".capacities:check_cpp_nodes"},
        needs=("c",),
    ),
    _own(
        "exploration",
        commands=("explore", "sweep"),
        title="Find races and faults",
        hooks={
            "explore": ".python_results:explore",
            "explored_tests": ".in_tests:ExploredTests",
            "story_of_run": ".timeline:story_of_run",
        },
    ),
    _own(
        "reports",
        commands=("trace", "report", "plot"),
        title="Look at a run",
        hooks={
            "board_actions": ".commands:add_board_report",
            "picture": ".curves:picture_of_words",
            "perf_log": ".trace_events:write_perf_log",
        },
    ),
    _own(
        "debugger",
        hooks={"replay_options": ".stop_options:add_stops", "replay_stops": ".command:fly_with_debugger"},
    ),
    _own(
        "ros_host",
        hooks={
            "flight_options": ".ros_master_option:RosMaster",
            "telemetry_package": ".message_package:telemetry_package",
        },
    ),
    _own(
        "dictionaries",
        hooks={
            "declarations": ".mission_sources:declarations_of",
            "dictionary_formats": ".formats:FORMATS",
            "check_profiles": ".differences:check_dictionary",
        },
        needs=("c",),
    ),
    _own(
        "procedures",
        commands=("procedures",),
        title="Test procedures",
        parser=".procedure_options",
        hooks={
            "procedure_tests": ".procedure_items:ProcedureTests",
            "cosmos_plugin": ".cosmos_plugin:plugin_files",
        },
        needs=("exploration",),
    ),
    _own("profiler", hooks={"flight_options": ".profile_option:Profiler"}),
    _own("attach", hooks={"realtime_flights": ".attach_door:AttachDoor"}),
    _own("viewers", hooks={"flight_options": ".viewer_options:Viewers"}),
)
"""The add-ons in `cfepy.extra`, whether or not they are installed."""


class Hook(Generic[T]):
    """An extension point that add-ons can fill; `T` is the type of the objects that fill it.

    Args:
        name: the key in `Plugin.hooks`.
    """

    def __init__(self, name: str) -> None:
        self.name = name

    def all(self) -> Iterator[T]:
        """Load this hook's object from each installed add-on, cfepy's own add-ons first."""
        for plugin in installed():
            if self.name in plugin.hooks:
                yield plugin.load(self.name)

    def first(self) -> T | None:
        """Load the object of the first add-on that fills this hook; None if no add-on does."""
        return next(self.all(), None)

    def need(self, what: str) -> T:
        """Load the object of the first add-on that fills this hook.

        Args:
            what: the feature that needs it, as the subject of the error text, such as "`--gdb`".

        Raises:
            UsageError: if no add-on fills this hook.
        """
        found = self.first()
        if found is None:
            raise UsageError(missing(what, *(each.name for each in OWN if self.name in each.hooks)))
        return found


def missing(what: str, *names: str) -> str:
    """Return the error text for a missing add-on, with the remedy.

    Args:
        what: the feature that needs it, as the subject of the text.
        names: names of the add-ons, one of which is needed.
    """
    return (
        f"{what} requires the add-on {' or '.join(names)}, which is missing in this installation; install cfepy again"
    )


def owner_of(command: str) -> Plugin | None:
    """Return the add-on of `cfepy.extra` that has a command, installed or not, or None."""
    return next((each for each in OWN if command in each.commands), None)


@cache
def installed() -> tuple[Plugin, ...]:
    """Return the installed add-ons: cfepy's own first, then the others by name."""
    there = [each for each in OWN if find_spec(each.package) is not None]
    names = {each.name for each in there}
    return (*(each for each in there if names.issuperset(each.needs)), *_outside())


def _outside() -> Iterator[Plugin]:
    """Yield the add-ons of other packages; report an add-on that cannot be loaded on standard error and skip it."""
    if not any(map(_is_offered, sys.path)):
        return  # this check is quick, while importlib.metadata takes a tenth of the boot time
    from importlib.metadata import entry_points

    for entry in sorted(entry_points(group=GROUP), key=lambda entry: entry.name):
        try:
            plugin = entry.load()
        except Exception as error:
            print(f"cfepy: the add-on {entry.name} cannot be loaded: {type(error).__name__}: {error}", file=sys.stderr)
            continue
        if not isinstance(plugin, Plugin):
            print(f"cfepy: the add-on {entry.name} cannot be used: {entry.value} is not a Plugin", file=sys.stderr)
            continue
        yield plugin


def _is_offered(folder: str) -> bool:
    """Return whether any package installed in a folder offers an add-on."""
    try:
        names = [entry.name for entry in os.scandir(folder or os.curdir) if entry.name.endswith(("-info", ".egg"))]
    except OSError:
        return False
    mark = f"[{GROUP}]".encode()
    for name in names:
        try:
            with open(os.path.join(folder, name, "entry_points.txt"), "rb") as file:
                if mark in file.read():
                    return True
        except OSError:
            continue
    return False
