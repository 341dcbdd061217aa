"""The door through which add-ons come in: those of `cfepy.extra`, and those of other packages.

An add-on is a `Plugin`: a table of names of what it offers. Nothing of it is imported before it is used. A package
elsewhere offers one in its pyproject.toml; docs/how_to/plugins.md explains how to write it:

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
"""The group of entry points in which other packages offer their add-ons."""


class Plugin(NamedTuple):
    """An add-on: what it offers, by name. A name that begins with a dot is one of its own package.

    Attributes:
        name: of the add-on.
        package: the Python package that it is in.
        commands: names of the subcommands of `cfepy` that it adds.
        title: the heading above them in `cfepy --help`.
        parser: the module whose function `add` gives these commands their parsers; it imports little, for a quick help.
        hooks: by the name of a hook, where to find what fills it, as "MODULE:NAME".
    """

    name: str
    package: str
    commands: tuple[str, ...] = ()
    title: str = "Add-ons"
    parser: str = ".commands"
    hooks: Mapping[str, str] = MappingProxyType({})

    def load(self, hook: str) -> Any:
        """Import what fills a hook, which must be one of `hooks`.

        Raises:
            UsageError: the add-on is of another package, and cannot be imported.
        """
        return self._imported(self.hooks[hook])

    def add_commands(self, commands: Any) -> None:
        """Give its commands their parsers.

        Args:
            commands: the subparsers of the parser of `cfepy`.

        Raises:
            UsageError: as of `load`.
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
    """An add-on of `cfepy.extra`."""
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
        },
    ),
    _own(
        "convert",
        commands=("convert",),
        title="ROS nodes in C++",
        hooks={"build_node": ".flight_build:build_for_flight", "check_sections": ".capacities:check_cpp_nodes"},
    ),
    _own(
        "exploration",
        commands=("explore", "faults", "sweep"),
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
    _own("viewers", hooks={"flight_options": ".viewer_options:Viewers"}),
)
"""The add-ons in `cfepy.extra`, whether or not they are installed."""


class Hook(Generic[T]):
    """A place for something that add-ons offer; the type is what fills it.

    Args:
        name: as in `Plugin.hooks`.
    """

    def __init__(self, name: str) -> None:
        self.name = name

    def all(self) -> Iterator[T]:
        """Load what installed add-ons offer here, those of cfepy first."""
        for plugin in installed():
            if self.name in plugin.hooks:
                yield plugin.load(self.name)

    def first(self) -> T | None:
        """Load what the first of them offers; None if no add-on offers it."""
        return next(self.all(), None)

    def need(self, what: str) -> T:
        """Load what the first of them offers.

        Args:
            what: for which it is needed, as a subject: "`--gdb`".

        Raises:
            UsageError: no add-on offers it.
        """
        found = self.first()
        if found is None:
            raise UsageError(missing(what, *(each.name for each in OWN if self.name in each.hooks)))
        return found


def missing(what: str, *names: str) -> str:
    """Say which add-on is missing, and what to do.

    Args:
        what: what needs it, as a subject.
        names: of the add-on.
    """
    return f"{what} needs the add-on {' or '.join(names)}, which this installation lacks; install cfepy again"


def owner_of(command: str) -> Plugin | None:
    """The add-on of `cfepy.extra` that has a command, installed or not; None if it is none of theirs."""
    return next((each for each in OWN if command in each.commands), None)


@cache
def installed() -> tuple[Plugin, ...]:
    """The add-ons that are installed, those of cfepy first, then those of other packages by name."""
    return (*(each for each in OWN if find_spec(each.package) is not None), *_outside())


def _outside() -> Iterator[Plugin]:
    """Those of other packages; one that cannot be loaded is left out, and standard error says why."""
    if not any(map(_is_offered, sys.path)):
        return  # which is quickly known: to ask importlib.metadata takes as long as a tenth of a boot
    from importlib.metadata import entry_points

    for entry in sorted(entry_points(group=GROUP), key=lambda entry: entry.name):
        try:
            plugin = entry.load()
        except Exception as error:
            print(f"cfepy: the add-on {entry.name} cannot be loaded: {type(error).__name__}: {error}", file=sys.stderr)
            continue
        if not isinstance(plugin, Plugin):
            print(f"cfepy: the add-on {entry.name} cannot be used: {entry.value} is no Plugin", file=sys.stderr)
            continue
        yield plugin


def _is_offered(folder: str) -> bool:
    """Whether a package that is installed in a folder offers an add-on."""
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
