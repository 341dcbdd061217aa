"""Faults on datagrams: commands from the ground, telemetry to it, and whatever else goes over UDP.

Imports its neighbours.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from cfepy.faults.messages import WHOLE, MessageFault, pass_through
from cfepy.faults.names import matches


def strike_datagrams(network: Any, faults: Sequence[MessageFault]) -> None:
    """Let every datagram of a mission's network meet faults; a target "udp:1234" is those to that port."""
    original = network.send

    def send(datagram: Any) -> bool:
        name = f"udp:{datagram.target.port}"
        about = [fault for fault in faults if matches((name,), fault.fault.target)]
        if not about:
            return bool(original(datagram))
        taken: list[bool] = []
        where = f"a datagram of {len(datagram.data)} bytes to {name}"
        pass_through(
            about, datagram.data, WHOLE, name, where, lambda data: taken.append(original(datagram._replace(data=data)))
        )
        return all(taken)

    network.send = send
