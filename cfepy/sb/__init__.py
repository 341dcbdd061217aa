"""Software Bus: messages between applications by MsgId (cFE SB).

The five services do not import each other; what SB needs of them it finds in its `Ports`.
"""

from __future__ import annotations

from cfepy.ports import PEND_FOREVER
from cfepy.sb.buffers import MessageBuffer
from cfepy.sb.bus import POLL, SoftwareBus
from cfepy.sb.core import BusCosts
from cfepy.sb.packets import COMMANDS, TELEMETRY
from cfepy.sb.pipes import PIPEOPTS_IGNOREMINE
from cfepy.sb.task import SbTask

__all__ = [
    "COMMANDS",
    "PEND_FOREVER",
    "PIPEOPTS_IGNOREMINE",
    "POLL",
    "TELEMETRY",
    "BusCosts",
    "MessageBuffer",
    "SbTask",
    "SoftwareBus",
]
