"""By which names a plan calls the messages on the bus, and which faults a name strikes. Imports nothing of cfepy."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fnmatch import fnmatchcase
from typing import Any, Protocol


class Names(Protocol):
    """What a mission knows of its messages; `cfepy.mission.fault_names.MissionNames` is one."""

    def begin(self, mission: Any) -> None:
        """The mission was made, and nothing of it has run."""

    def version(self) -> object:
        """Something that changes when names come up that were not known before."""

    def of(self, packet: bytes | bytearray) -> Sequence[str]:
        """All names of a packet, the one to show first; its MsgId as "0x0801" is one."""

    def app(self, name: str) -> str:
        """The cFE name of a node's application, by the node's name, such as "/arm_control"; any other name as it is."""

    def edit(self, packet: bytes, values: Mapping[str, Any]) -> bytes:
        """A packet with some fields set.

        Raises:
            UsageError: it has no such fields, or they cannot have such values.
        """


def matches(names: Sequence[str], targets: Sequence[str]) -> bool:
    """Whether one of the names is one of the targets, which may be patterns such as "/arm/*"."""
    return any(fnmatchcase(name, target) for target in targets for name in names)


def number_as_name(target: str) -> str:
    """A target as packets are called: "0x801" and "2049" are "0x0801"."""
    try:
        return f"0x{int(target, 0):04X}"
    except ValueError:
        return target
