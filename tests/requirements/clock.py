"""The clock of a running mission, observed and controlled by the tests of Time Services."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from cfepy.evs import INFORMATION
from cfepy.time import packets as pk
from tests.requirements.flight import Event, Flight

Fly = Callable[..., Flight]
HALF = 0x80000000
ON_ITS_OWN = {"time_cfg_fake_tone": False}
"""A server whose tones come from outside: from the test."""


def housekeeping(flight: Flight) -> dict[str, Any]:
    """Return the housekeeping packet."""
    return flight.ask(pk.SEND_HK, pk.HK_TLM)


def diagnostic(flight: Flight) -> dict[str, Any]:
    """Return the diagnostic packet."""
    return flight.ask(pk.SEND_DIAGNOSTIC, pk.DIAG_TLM)


def told(event_id: int, text: str, event_type: int = INFORMATION) -> list[Event]:
    """One event of Time Services, as a command brings it about."""
    return [Event("CFE_TIME", event_id, event_type, text)]


def tone(flight: Flight) -> None:
    """A tone from outside, and the request for the time at it, as a scheduler sends it."""
    flight.call(flight.cfe.time.external_tone)
    flight.transmit(pk.SEND_CMD.packet())


def to_next_second(flight: Flight) -> None:
    """Go on to the tenth of a second after the next tone."""
    subseconds = flight.cfe.time.get_met_subsecs()
    flight.run_for(1.1 - subseconds / 2**32)
