"""The functions of `openc3.script` about sent commands and received packets: values, times, counts and bytes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from cfepy.extra.procedures.packet_items import CONVERTED, PacketDefinition
from cfepy.extra.procedures.script_words import item_words, packet_words
from cfepy.extra.procedures.station import Station
from cfepy.extra.procedures.target_packets import TargetPackets
from cfepy.units import US_PER_S


class RecordFunctions:
    """Reads the newest commands and packets of a station.

    Args:
        station: the connection.
        targets: packets by name.
        epoch: wall time of the station's time 0 in s.
    """

    def __init__(self, station: Station, targets: TargetPackets, epoch: float) -> None:
        self._station = station
        self._targets = targets
        self._epoch = epoch

    def get_cmd_value(self, *given: Any, type: str = CONVERTED, **options: Any) -> Any:
        """Return the value of a parameter in the newest command.

        Raises:
            RuntimeError: if the command was not sent.
        """
        target, name, parameter = item_words(given)
        packet = self._targets.command(target, name)
        return packet.item(parameter).read(self._sent(packet), type.upper())

    def get_cmd_time(self, *given: Any, **options: Any) -> list[Any]:
        """Return target, command, and the time when it was last sent, in s and us; None for a command not sent."""
        packet = self._targets.command(*packet_words(given))
        last = self._station.last_sent.get(_key(packet))
        if last is None:
            return [packet.target, packet.name, None, None]
        seconds, rest = divmod(round((self._epoch + last[1]) * US_PER_S), US_PER_S)
        return [packet.target, packet.name, seconds, rest]

    def get_cmd_cnt(self, *given: Any) -> int:
        """Return how often a command was sent."""
        return self._station.sent.get(_key(self._targets.command(*packet_words(given))), 0)

    def get_cmd_cnts(self, commands: Sequence[Sequence[str]]) -> list[int]:
        """Return how often each of some commands was sent."""
        return [self._station.sent.get(_key(self._targets.command(*each)), 0) for each in commands]

    def get_tlm_cnt(self, *given: Any) -> int:
        """Return how many packets have arrived."""
        newest = self._station.newest(self._targets.telemetry(*packet_words(given)).msg_id)
        return 0 if newest is None else newest.number

    def get_tlm_cnts(self, packets: Sequence[Sequence[str]]) -> list[int]:
        """Return how many packets of each kind have arrived."""
        newest = [self._station.newest(self._targets.telemetry(*each).msg_id) for each in packets]
        return [0 if each is None else each.number for each in newest]

    def get_cmd_buffer(self, *given: Any, **options: Any) -> dict[str, Any]:
        """Return the bytes of the newest command.

        Raises:
            RuntimeError: if the command was not sent.
        """
        packet = self._targets.command(*packet_words(given))
        data = self._sent(packet)
        return {"target_name": packet.target, "packet_name": packet.name, "buffer": data}

    def get_tlm_buffer(self, *given: Any, **options: Any) -> dict[str, Any] | None:
        """Return the bytes of the newest packet; None before it has arrived."""
        packet = self._targets.telemetry(*packet_words(given))
        newest = self._station.newest(packet.msg_id)
        if newest is None:
            return None
        return {"target_name": packet.target, "packet_name": packet.name, "buffer": newest.data}

    def _sent(self, packet: PacketDefinition) -> bytes:
        last = self._station.last_sent.get(_key(packet))
        if last is None:
            raise RuntimeError(f"{packet.full_name} was not sent")
        return last[0]


def _key(packet: PacketDefinition) -> tuple[int, int]:
    return packet.msg_id, packet.code or 0
