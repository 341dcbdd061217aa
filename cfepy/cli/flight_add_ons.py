"""What add-ons open around a flight that a person watches: their options, and servers, guests and attachments."""

from __future__ import annotations

import argparse
import contextlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, ClassVar

from cfepy.plugins import Hook

if TYPE_CHECKING:
    from cfepy.attachment import Attachment
    from cfepy.io import Guest
    from cfepy.mission import Mission

Tell = Callable[[str], object]


class FlightAddOn:
    """Options of an add-on, and what they open around a flight; does nothing, and derived classes do what they need.

    Args:
        arguments: of the command line, with the options that `add` has added.
        name: of the mission.
        tell: gets the lines for the user before anything runs.

    Attributes:
        attachments: what watches the flight, or changes its course.
        guests: what brings something in between two pieces of the flight, also while time stands still.
        OPTIONS: options by their names in the arguments. None of them can be said when the run is not flown here.
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
            UsageError: they do not go with the others.
        """

    def __enter__(self) -> Any:
        return self

    def __exit__(self, *error: Any) -> None:
        self.close()

    def connect(self, mission: Mission, tell: Tell) -> Sequence[Guest]:
        """Open what a run in real time joins, whose network is open by now.

        Args:
            mission: that flies.
            tell: gets lines for the user.

        Returns:
            What else brings something in, beside `guests`.
        """
        return ()

    def close(self) -> None:
        """Close everything: the flight is over. May be called twice."""


FLIGHT_ADD_ONS: Hook[type[FlightAddOn]] = Hook("flight_options")


class FlightAddOns(contextlib.ExitStack):
    """All add-ons of a flight; use as a context manager around it.

    Args:
        arguments, name, tell: as of `FlightAddOn`.
    """

    def __init__(self, arguments: argparse.Namespace, name: str, tell: Tell) -> None:
        super().__init__()
        self._parts = [kind(arguments, name, tell) for kind in FLIGHT_ADD_ONS.all()]

    def __enter__(self) -> FlightAddOns:
        with contextlib.ExitStack() as undone:
            for part in self._parts:
                undone.enter_context(part)
            self.push(undone.pop_all())
        return self

    @property
    def attachments(self) -> list[Attachment]:
        """What all of them attach."""
        return [each for part in self._parts for each in part.attachments]

    @property
    def guests(self) -> list[Guest]:
        """All guests."""
        return [each for part in self._parts for each in part.guests]

    def connect(self, mission: Mission, tell: Tell) -> Iterator[Guest]:
        """Open what joins a run in real time; first what opens for it, then the guests that are there already."""
        for part in self._parts:
            yield from part.connect(mission, tell)
        yield from self.guests


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of all add-ons to a command that flies."""
    for kind in FLIGHT_ADD_ONS.all():
        kind.add(parser)


def check_options(arguments: argparse.Namespace) -> None:
    """Check the options of all add-ons.

    Raises:
        UsageError: one does not go with the others.
    """
    for kind in FLIGHT_ADD_ONS.all():
        kind.check(arguments)


def options() -> Iterator[tuple[str, str]]:
    """All options of add-ons: the name in the arguments, and the option."""
    for kind in FLIGHT_ADD_ONS.all():
        yield from kind.OPTIONS.items()
