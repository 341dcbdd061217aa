"""A command tried out: a mission is flown until it is OPERATIONAL, gets the command, and what follows is taken down."""

from __future__ import annotations

from dataclasses import dataclass

from cfepy.console import Console
from cfepy.evs.events import ERROR
from cfepy.mission.dictionary import Dictionary
from cfepy.mission.mission import Mission
from cfepy.mission.results import deaths
from cfepy.mission.script_packets import EVENT_IDS, Event
from cfepy.mission.spec import MissionSpec
from cfepy.mission.watch import PacketWatch, Seen, receivers
from cfepy.msg import MsgType, get_msg_id, get_type
from cfepy.rtos.units import NS_PER_MS, NS_PER_S
from cfepy.status import CFE_ES_OPERATION_TIMED_OUT, CfeError

LONGEST_BOOT_NS = 60 * NS_PER_S
PIECE_NS = 10 * NS_PER_MS
ANSWER_NS = 100 * NS_PER_MS  # in which a request for housekeeping is answered
REQUEST = "_SEND_HK"


@dataclass(frozen=True, slots=True)
class Trial:
    """What a command led to.

    `receivers` are the applications that subscribe to it; `telemetry` has the last packet of each kind that they sent,
    housekeeping included: they are asked for it. `problems` has a line for each application that died.
    """

    sent_ns: int
    receivers: list[str]
    events: list[Event]
    telemetry: list[Seen]
    problems: list[str]

    @property
    def errors(self) -> list[Event]:
        """The ERROR and CRITICAL events."""
        return [event for event in self.events if event.event_type >= ERROR]


def try_command(spec: MissionSpec, dictionary: Dictionary, packet: bytes, seconds: float) -> Trial:
    """Fly a mission, and send it a command.

    Args:
        spec: the mission.
        dictionary: tells how to ask for housekeeping.
        packet: the command.
        seconds: virtual time to wait for what it causes.

    Raises:
        CfeError: the mission cannot boot.
        UsageError: no such board.
    """
    seen: list[Seen] = []
    with Mission(spec, console=Console(quiet=True), attachments=[PacketWatch(seen.append)]) as mission:
        _boot(mission)
        seen.clear()
        takers, sent_ns = receivers(mission.cfe.sb, get_msg_id(packet)), mission.kernel.now
        mission.cfe.sb.transmit_msg(packet, is_origination=False)
        mission.run(seconds)
        for request in dictionary.commands.values():
            if request.name.endswith(REQUEST) and set(receivers(mission.cfe.sb, request.msg_id)) & set(takers):
                mission.cfe.sb.transmit_msg(request.packet(), is_origination=False)
        mission.run_until(mission.kernel.now + ANSWER_NS)
    events = [Event.of(each) for each in seen if _is_event(each)]
    return Trial(sent_ns, takers, events, _last(seen, takers), deaths(mission))


def _boot(mission: Mission) -> None:
    while mission.booted is None:
        if mission.kernel.now >= LONGEST_BOOT_NS:
            text = f"the mission is not OPERATIONAL after {LONGEST_BOOT_NS // NS_PER_S} virtual seconds"
            raise CfeError(CFE_ES_OPERATION_TIMED_OUT, text)
        mission.run_until(mission.kernel.now + PIECE_NS)


def _is_event(seen: Seen) -> bool:
    return seen.msg_id in EVENT_IDS


def _last(seen: list[Seen], senders: list[str]) -> list[Seen]:
    """The last telemetry packet of each MsgId that came from these applications."""
    own = [each for each in seen if each.sender in senders and not _is_event(each)]
    return list({each.msg_id: each for each in own if get_type(each.packet) == MsgType.TLM}.values())
