"""How telemetry is shown: a line each, JSON lines, or on a terminal a table of the newest packet of each kind."""

from __future__ import annotations

import json
from typing import Any, Protocol, TextIO

from cfepy.mission.dictionary import Decoded, Dictionary
from cfepy.mission.values import line_of
from cfepy.rtos.units import NS_PER_S


class Output(Protocol):
    """Shows packets."""

    def show(self, packet: bytes, at_ns: int) -> None:
        """A packet, and when it was sent in virtual ns, or arrived in ns since the start."""

    def refresh(self) -> None:
        """Some time has gone by: what was shown may be drawn."""

    def close(self) -> None:
        """Nothing more comes."""


def make_output(dictionary: Dictionary, as_json: bool, stream: TextIO, is_live: bool) -> Output:
    """The output that fits.

    Args:
        dictionary: names the packets and their fields.
        as_json: a JSON object for each packet.
        stream: where to.
        is_live: packets come as time goes by, so on a terminal a table is worth while.
    """
    if as_json:
        return JsonLines(dictionary, stream)
    return LiveTable(dictionary, stream) if is_live and stream.isatty() else TextLines(dictionary, stream)


class TextLines:
    """`2.450 CFE_ES_HK_TLM CommandCounter=0 ...`"""

    def __init__(self, dictionary: Dictionary, stream: TextIO) -> None:
        self._dictionary = dictionary
        self._stream = stream

    def show(self, packet: bytes, at_ns: int) -> None:
        """See `Output.show`."""
        decoded = self._dictionary.decode(packet)
        self._stream.write(f"{at_ns / NS_PER_S:.3f} {decoded.name} {content(decoded, packet)}\n")

    def refresh(self) -> None:
        """See `Output.refresh`."""
        self._stream.flush()

    def close(self) -> None:
        """See `Output.close`."""


class JsonLines(TextLines):
    """An object with name, msg_id, sequence, time (spacecraft time, s), at (s) and values."""

    def show(self, packet: bytes, at_ns: int) -> None:
        """See `Output.show`."""
        decoded = self._dictionary.decode(packet)
        record: dict[str, Any] = {
            "name": decoded.name,
            "msg_id": decoded.msg_id,
            "sequence": decoded.sequence,
            "time": decoded.time_s,
            "at": at_ns / NS_PER_S,
            "values": decoded.values,
        }
        if decoded.problem:
            record |= {"problem": decoded.problem, "packet": packet.hex()}
        self._stream.write(json.dumps(record, default=bytes.hex) + "\n")


class LiveTable:
    """A row for each kind of packet: how many came, when the newest came, what is in it."""

    def __init__(self, dictionary: Dictionary, stream: TextIO) -> None:
        from rich.console import Console
        from rich.live import Live

        self._dictionary = dictionary
        self._rows: dict[int, tuple[int, int, bytes]] = {}
        self._is_new = True
        self._live = Live(console=Console(file=stream), auto_refresh=False)
        self._live.start()

    def show(self, packet: bytes, at_ns: int) -> None:
        """See `Output.show`."""
        msg_id = packet[0] << 8 | packet[1]
        count = self._rows[msg_id][0] if msg_id in self._rows else 0
        self._rows[msg_id] = (count + 1, at_ns, packet)
        self._is_new = True

    def refresh(self) -> None:
        """See `Output.refresh`."""
        if self._is_new:
            self._is_new = False
            self._live.update(self._table(), refresh=True)

    def close(self) -> None:
        """See `Output.close`."""
        self.refresh()
        self._live.stop()

    def _table(self) -> Any:
        from rich import box
        from rich.table import Table
        from rich.text import Text

        table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
        for column in ("packet", "count", "at"):
            table.add_column(column, justify="left" if column == "packet" else "right", no_wrap=True)
        table.add_column("content")
        for _, (count, at_ns, packet) in sorted(self._rows.items()):
            decoded = self._dictionary.decode(packet)
            cells = (decoded.name, f"{count:,}", f"{at_ns / NS_PER_S:.1f}", content(decoded, packet))
            table.add_row(*(Text(cell) for cell in cells))
        return table


def content(decoded: Decoded, packet: bytes) -> str:
    """The fields of a packet, or its bytes when they are not known."""
    return f"{packet.hex()} ({decoded.problem})" if decoded.problem else line_of(decoded.values)
