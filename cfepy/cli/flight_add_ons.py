"""Add-ons of a flight that a person watches: their options, and the servers, guests and attachments they open."""

from __future__ import annotations

import argparse
import contextlib
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, ClassVar

from cfepy.plugins import Hook

if TYPE_CHECKING:
    from cfepy.attachment import Attachment
    from cfepy.cli.text_table import Table
    from cfepy.io import Guest
    from cfepy.mission import Mission
    from cfepy.pilot import Flown

Tell = Callable[[str], object]


class FlightAddOn:
    """Base class of an add-on: its options, and the objects it opens around a flight. By default it does nothing.

    Args:
        arguments: the command line, with the options that `add` has added.
        name: name of the mission.
        tell: receives the lines for the user before the run starts.

    Attributes:
        attachments: attachments that watch the flight, or change its course.
        guests: guests that deliver input between two steps of the flight, also while time stands still.
        OPTIONS: options by their names in the arguments. They are invalid if the run is not flown here.
    """

    OPTIONS: ClassVar[Mapping[str, str]] = {}

    def __init__(self, arguments: argparse.Namespace, name: str, tell: Tell) -> None:
        self.attachments: list[Attachment] = []
        self.guests: list[Guest] = []

    @classmethod
    def add(cls, parser: argparse.ArgumentParser) -> None:
        """Add the options to a command."""

    @classmethod
    def check(cls, arguments: argparse.Namespace) -> None:
        """Check the options.

        Raises:
            UsageError: they conflict with other options.
        """

    def __enter__(self) -> Any:
        return self

    def __exit__(self, *error: Any) -> None:
        self.close()

    def connect(self, mission: Mission, tell: Tell) -> Sequence[Guest]:
        """Open the services of a run in real time, whose network is open by now.

        Args:
            mission: the mission that flies.
            tell: receives lines for the user.

        Returns:
            Guests in addition to `guests`.
        """
        return ()

    def close(self) -> None:
        """Close everything at the end of the flight. You may call it twice."""

    def tables(self, flown: Flown) -> Iterable[Table]:
        """Return tables for the end of the report, after `close`.

        Raises:
            UsageError: a file of the add-on cannot be written.
        """
        return ()


FLIGHT_ADD_ONS: Hook[type[FlightAddOn]] = Hook("flight_options")
REALTIME_ADD_ONS: Hook[type[FlightAddOn]] = Hook("realtime_flights")
"""Add-ons without an option of their own, which each flight in real time has."""


class FlightAddOns(contextlib.ExitStack):
    """All add-ons of a flight; use as a context manager around it.

    Args:
        arguments: as for `FlightAddOn`.
        name: as for `FlightAddOn`.
        tell: as for `FlightAddOn`.
    """

    def __init__(self, arguments: argparse.Namespace, name: str, tell: Tell) -> None:
        super().__init__()
        kinds = [*FLIGHT_ADD_ONS.all(), *(REALTIME_ADD_ONS.all() if arguments.realtime is not None else ())]
        self._parts = [kind(arguments, name, tell) for kind in kinds]

    def __enter__(self) -> FlightAddOns:
        with contextlib.ExitStack() as undone:
            for part in self._parts:
                undone.enter_context(part)
            self.push(undone.pop_all())
        return self

    @property
    def attachments(self) -> list[Attachment]:
        """The attachments of all add-ons."""
        return [each for part in self._parts for each in part.attachments]

    @property
    def guests(self) -> list[Guest]:
        """The guests of all add-ons."""
        return [each for part in self._parts for each in part.guests]

    def connect(self, mission: Mission, tell: Tell) -> Iterator[Guest]:
        """Yield the guests of a run in real time: first those that `connect` opens, then the existing ones."""
        for part in self._parts:
            yield from part.connect(mission, tell)
        yield from self.guests

    def tables(self, flown: Flown) -> list[Table]:
        """Return the tables of all add-ons for the end of the report, after the flight."""
        return [table for part in self._parts for table in part.tables(flown)]


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of all add-ons to a command that flies."""
    for kind in FLIGHT_ADD_ONS.all():
        kind.add(parser)


def check_options(arguments: argparse.Namespace) -> None:
    """Check the options of all add-ons.

    Raises:
        UsageError: an option conflicts with another one.
    """
    for kind in FLIGHT_ADD_ONS.all():
        kind.check(arguments)


def options() -> Iterator[tuple[str, str]]:
    """Yield all options of add-ons: the name in the arguments, and the option."""
    for kind in FLIGHT_ADD_ONS.all():
        yield from kind.OPTIONS.items()
