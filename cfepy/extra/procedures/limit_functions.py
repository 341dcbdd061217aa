"""The functions of `openc3.script` for limits of telemetry."""

from __future__ import annotations

from typing import Any

from cfepy.extra.procedures.packet_items import PacketDefinition
from cfepy.extra.procedures.script_words import item_words
from cfepy.extra.procedures.station import Station
from cfepy.extra.procedures.target_packets import TargetPackets
from cfepy.status import UsageError


def functions_of(*objects: Any) -> dict[str, Any]:
    """Return the methods of objects that are functions of procedures, by name."""
    return {name: getattr(each, name) for each in objects for name in dir(each) if not name.startswith("_")}


class LimitFunctions:
    """The limits of items, and which of them a procedure has changed.

    Args:
        station: has the newest telemetry.
        targets: packets by name.
    """

    def __init__(self, station: Station, targets: TargetPackets) -> None:
        self._station = station
        self._targets = targets
        self._limits_set = "DEFAULT"
        self._limits_sets = ["DEFAULT"]
        self._disabled_limits: set[tuple[str, str, str]] = set()
        self._set_limits: dict[tuple[str, str, str], tuple[float, ...]] = {}

    def limits_enabled(self, *given: Any) -> bool:
        """Return whether the limits of an item are checked."""
        return self._limits_key(given) not in self._disabled_limits

    def enable_limits(self, *given: Any) -> None:
        """Check the limits of an item."""
        self._disabled_limits.discard(self._limits_key(given))

    def disable_limits(self, *given: Any) -> None:
        """Do not check the limits of an item."""
        self._disabled_limits.add(self._limits_key(given))

    def get_limits(self, *given: Any) -> dict[str, list[float]]:
        """Return red low, yellow low, yellow high and red high of an item, by limits set."""
        target, name, item_name = item_words(given)
        packet = self._targets.telemetry(target, name)
        found = {} if packet.read_all is not None else dict(packet.item(item_name).limits)
        key = self._limits_key(given)
        if key in self._set_limits:
            found["CUSTOM"] = self._set_limits[key]
        return {each: list(values) for each, values in found.items()}

    def set_limits(self, target: str, name: str, item: str, *limits: float, **options: Any) -> None:
        """Set red low, yellow low, yellow high and red high of an item in the limits set CUSTOM."""
        if len(limits) < 4:
            raise UsageError("expected red low, yellow low, yellow high and red high")
        self._set_limits[self._limits_key((target, name, item))] = tuple(float(each) for each in limits[:4])

    def get_limits_set(self) -> str:
        """Return the name of the limits set."""
        return self._limits_set

    def set_limits_set(self, name: str) -> None:
        """Use another limits set."""
        self._limits_set = name.upper()
        if self._limits_set not in self._limits_sets:
            self._limits_sets.append(self._limits_set)

    def get_limits_sets(self, **options: Any) -> list[str]:
        """Return the names of the limits sets that the definitions name, and that the procedure has used."""
        packets = (each for target in self._targets.names() for each in self._targets.packets(target, False))
        defined = (name for packet in packets for item in packet.items.values() for name in item.limits)
        return list(dict.fromkeys([*self._limits_sets, *defined]))

    def get_out_of_limits(self) -> list[list[str]]:
        """Return the items that violate their limits, with the state, such as RED_LOW."""
        found = []
        for target in self._targets.names():
            for packet in self._targets.packets(target, False):
                for name, item in packet.items.items():
                    has_limits = item.limits or (packet.target, packet.name, name) in self._set_limits
                    state = self._limits_state(packet, name) if has_limits else None
                    if state is not None and not state.startswith("GREEN"):
                        found.append([packet.target, packet.name, name, state])
        return found

    def get_overall_limits_state(self, ignored: Any = None) -> str:
        """Return GREEN, YELLOW or RED, the worst state of all items."""
        states = [each[3].split("_")[0] for each in self.get_out_of_limits()]
        return "RED" if "RED" in states else "YELLOW" if "YELLOW" in states else "GREEN"

    def _limits_key(self, given: tuple[Any, ...]) -> tuple[str, str, str]:
        target, name, item = item_words(given)
        packet = self._targets.telemetry(target, name)
        return packet.target, packet.name, item.upper() if packet.read_all is not None else packet.item(item).name

    def _limits_state(self, packet: PacketDefinition, name: str) -> str | None:
        key = packet.target, packet.name, name.upper()
        newest = self._station.newest(packet.msg_id)
        if packet.read_all is not None or newest is None or key in self._disabled_limits:
            return None
        item = packet.item(name)
        limits = self._set_limits.get(key) or item.limits.get(self._limits_set) or item.limits.get("DEFAULT")
        value = item.read(newest.data) if limits else None
        if not limits or not isinstance(value, int | float):
            return None
        red_low, yellow_low, yellow_high, red_high = limits
        if value <= red_low:
            return "RED_LOW"
        if value >= red_high:
            return "RED_HIGH"
        return "YELLOW_LOW" if value <= yellow_low else "YELLOW_HIGH" if value >= yellow_high else "GREEN"
