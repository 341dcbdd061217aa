"""Software Bus: messages between applications by MsgId (cFE SB).

Code that moves packets belongs here: pipes, subscriptions, routes, buffers, and the application CFE_SB. The meaning of
a packet belongs to `cfepy.msg`. Code that observes or disturbs the bus is in packages above, as a class derived from
`SoftwareBus`. The five services are independent of one another; SB reaches the others through its `Ports`. The central
file is `cfepy/sb/bus.py`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.interpreter.faces import face
from cfepy.ports import PEND_FOREVER

if TYPE_CHECKING:
    from cfepy.sb.buffers import BUFFER_BYTES
    from cfepy.sb.bus import POLL, SoftwareBus, Waiting
    from cfepy.sb.direct_subscriber import Outlet
    from cfepy.sb.message_buffer import MessageBuffer
    from cfepy.sb.packet_listener import listened
    from cfepy.sb.packets import COMMANDS, ONESUB_TLM, SUBSCRIPTION, TELEMETRY, UNSUBSCRIPTION
    from cfepy.sb.pipe import NOBODY_HEARD, Pipe
    from cfepy.sb.pipes import PIPEOPTS_IGNOREMINE
    from cfepy.sb.routing import Destination, PutHook, Route
    from cfepy.sb.task import SbTask

__all__ = [
    "BUFFER_BYTES",
    "COMMANDS",
    "NOBODY_HEARD",
    "ONESUB_TLM",
    "PEND_FOREVER",
    "PIPEOPTS_IGNOREMINE",
    "POLL",
    "SUBSCRIPTION",
    "TELEMETRY",
    "UNSUBSCRIPTION",
    "Destination",
    "MessageBuffer",
    "Outlet",
    "Pipe",
    "PutHook",
    "Route",
    "SbTask",
    "SoftwareBus",
    "Waiting",
    "listened",
]

if not TYPE_CHECKING:  # type checkers see only the names above
    __getattr__, __dir__ = face(
        __name__,
        {
            ".buffers": ("BUFFER_BYTES",),
            ".bus": (
                "POLL",
                "SoftwareBus",
                "Waiting",
            ),
            ".message_buffer": ("MessageBuffer",),
            ".direct_subscriber": ("Outlet",),
            ".packet_listener": ("listened",),
            ".packets": (
                "COMMANDS",
                "ONESUB_TLM",
                "SUBSCRIPTION",
                "TELEMETRY",
                "UNSUBSCRIPTION",
            ),
            ".pipe": (
                "NOBODY_HEARD",
                "Pipe",
            ),
            ".pipes": ("PIPEOPTS_IGNOREMINE",),
            ".routing": (
                "Destination",
                "PutHook",
                "Route",
            ),
            ".task": ("SbTask",),
        },
    )
