"""Trial of a command: a mission is flown until it is OPERATIONAL, receives the command, and the effects are
recorded.
"""

from __future__ import annotations

from collections.abc import Callable

from cfepy.evs import ERROR
from cfepy.ground.dictionary import Dictionary
from cfepy.ground.events import EVENT_IDS, DecodedEvent
from cfepy.mission import Mission, PacketWatch, Seen, receivers
from cfepy.msg import MsgType, get_msg_id, get_type
from cfepy.status import CFE_ES_OPERATION_TIMED_OUT, CfeError
from cfepy.units import NS_PER_MS, NS_PER_S

LONGEST_BOOT_NS = 60 * NS_PER_S
PIECE_NS = 10 * NS_PER_MS
ANSWER_NS = 100 * NS_PER_MS  # time within which a request for housekeeping is answered
REQUEST = "_SEND_HK"


class CommandTrial(PacketWatch):
    """Sends a command to the mission that it is attached to, and records the effects.

    Args:
        dictionary: gives the requests for housekeeping.
        packet: the command.

    Attributes:
        sent_ns: virtual time at which it was sent; set by `run`, like the others.
        receivers: applications that subscribe to it.
        events: all events after it.
        telemetry: the last packet of each kind from the receivers, including housekeeping, which is requested.
    """

    sent_ns: int
    receivers: list[str]
    events: list[DecodedEvent]
    telemetry: list[Seen]

    def __init__(self, dictionary: Dictionary, packet: bytes) -> None:
        self._seen: list[Seen] = []
        super().__init__(self._seen.append)
        self._dictionary = dictionary
        self._packet = packet
        self._mission: Mission

    @property
    def errors(self) -> list[DecodedEvent]:
        """The ERROR and CRITICAL events."""
        return [event for event in self.events if event.event_type >= ERROR]

    def begin(self, mission: Mission) -> None:
        self._mission = mission

    def run(self, run_until: Callable[[int], object], seconds: float, patience: float = 0) -> None:
        """Wait until the mission is OPERATIONAL, send the command, and record its effects.

        Args:
            run_until: runs the mission to a virtual time in ns.
            seconds: virtual time to wait for effects.
            patience: virtual time in s to wait for a receiver of the command, once the mission is OPERATIONAL.

        Raises:
            CfeError: if the mission does not become OPERATIONAL.
        """
        mission, bus = self._mission, self._mission.cfe.sb
        self._boot(run_until)
        self._wait_for_receivers(run_until, mission.kernel.now + round(patience * NS_PER_S))
        self._seen.clear()
        self.receivers, self.sent_ns = self._receivers(), mission.kernel.now
        bus.transmit_msg(self._packet, is_origination=False)
        run_until(mission.kernel.now + round(seconds * NS_PER_S))
        bus = mission.cfe.sb  # a reset has created another one
        for request in self._dictionary.commands.values():
            if request.name.endswith(REQUEST) and set(receivers(bus, request.msg_id)) & set(self.receivers):
                bus.transmit_msg(request.packet(), is_origination=False)
        run_until(mission.kernel.now + ANSWER_NS)
        self.events = [DecodedEvent.of(each) for each in self._seen if _is_event(each)]
        self.telemetry = _last(self._seen, self.receivers)

    def _boot(self, run_until: Callable[[int], object]) -> None:
        mission = self._mission
        while mission.booted is None:
            if mission.kernel.now >= LONGEST_BOOT_NS:
                text = f"the mission is not OPERATIONAL after {LONGEST_BOOT_NS // NS_PER_S} virtual seconds"
                raise CfeError(CFE_ES_OPERATION_TIMED_OUT, text)
            run_until(mission.kernel.now + PIECE_NS)

    def _wait_for_receivers(self, run_until: Callable[[int], object], until_ns: int) -> None:
        while not self._receivers() and self._mission.kernel.now < until_ns:
            run_until(self._mission.kernel.now + PIECE_NS)

    def _receivers(self) -> list[str]:
        return receivers(self._mission.cfe.sb, get_msg_id(self._packet))


def _is_event(seen: Seen) -> bool:
    return seen.msg_id in EVENT_IDS


def _last(seen: list[Seen], senders: list[str]) -> list[Seen]:
    """Return the last telemetry packet of each MsgId that came from these applications."""
    own = [each for each in seen if each.sender in senders and not _is_event(each)]
    return list({each.msg_id: each for each in own if get_type(each.packet) == MsgType.TLM}.values())
