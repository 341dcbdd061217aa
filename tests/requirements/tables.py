"""A table of the application PROBE in a running mission, for the tests of Table Services."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from cfepy.status import CfeError
from cfepy.tbl import TableHandle, TableImage, build
from cfepy.tbl import packets as pk
from tests.requirements.flight import Event, Flight

NAME = "PROBE.T"
SIZE = 8
OLD, NEW = b"old data", b"new data"
FILE_TIME = 1_000_500, 0x40000000
"""When the table files were made."""
BAD = 0xFF
"""A first byte that `validate` does not like."""


def validate(image: memoryview) -> int:
    """PROBE's validation function."""
    return -5 if image[0] == BAD else 0


class ProbeTable:
    """PROBE.T, registered in the name of PROBE."""

    def __init__(
        self, flight: Flight, options: int = 0, validator: Callable[[memoryview], int] | None = validate
    ) -> None:
        self.flight = flight
        self.handle: TableHandle = self.call("register", "T", SIZE, options, validator)

    def call(self, function: str, *args: Any) -> Any:
        """Return the result of a function of Table Services for PROBE."""
        return self.flight.call(lambda: getattr(self.flight.cfe.tbl, function)(*args))

    def mine(self, function: str, *args: Any) -> Any:
        """Return the same with PROBE's handle first."""
        return self.call(function, self.handle, *args)

    def status(self, function: str, *args: Any) -> int:
        """Return the status that a function of PROBE's handle fails with."""
        try:
            result = self.mine(function, *args)
        except CfeError as error:
            return error.status
        raise AssertionError(f"{function} gave {result!r}")

    def content(self) -> bytes:
        """Return the active image."""
        data = bytes(self.mine("get_address")[0])
        self.mine("release_address")
        return data

    def info(self) -> Any:
        """Return its CFE_TBL_GetInfo."""
        return self.call("get_info", NAME)

    def upload(self, data: bytes, offset: int = 0, path: str = "/ram/t.tbl") -> list[Event]:
        """Write a table file and LOAD it. Returns the events."""
        put(self.flight, data, offset, path)
        return self.flight.send(pk.LOAD, LoadFilename=path)

    def validate_inactive(self) -> None:
        """VALIDATE the inactive image, and let the owner do it."""
        self.flight.send(pk.VALIDATE, ActiveTableFlag=pk.INACTIVE_BUFFER, TableName=NAME)
        self.mine("manage")

    def activate(self) -> int:
        """ACTIVATE, and let the owner manage. Returns the result of the latter."""
        self.flight.send(pk.ACTIVATE, TableName=NAME)
        status: int = self.mine("manage")
        return status


def put(flight: Flight, data: bytes, offset: int = 0, path: str = "/ram/t.tbl", name: str = NAME) -> None:
    """A table file on the RAM disk."""
    flight.mission.files.write_file(path, build(TableImage(name, data, "a test", offset, time=FILE_TIME)))


def fields_of(time: tuple[int, int]) -> dict[str, int]:
    """Return a time as packets have it."""
    return {"Seconds": time[0], "Subseconds": time[1]}


def housekeeping(flight: Flight) -> dict[str, Any]:
    """Return the housekeeping packet of Table Services."""
    return flight.ask(pk.SEND_HK, pk.HK_TLM)


def free_bytes(flight: Flight) -> int:
    """Return the free bytes of the tables' memory pool."""
    pool = housekeeping(flight)["MemPoolHandle"]
    left: Any = flight.call(lambda: flight.cfe.es.get_mem_pool_stats(pool))["NumFreeBytes"]
    assert isinstance(left, int)
    return left


def registry(flight: Flight, name: str = NAME) -> dict[str, Any]:
    """Return a table's registry entry in telemetry."""
    flight.send(pk.SEND_REGISTRY, TableName=name)
    return flight.ask(pk.SEND_HK, pk.REG_TLM)
