"""Subscriptions told to other processors: one as it is made, or all there are (cfe_sb_task.c).

Imports only its neighbours in cfepy.sb.
"""

from __future__ import annotations

from cfepy.sb import events as ev
from cfepy.sb import packets as pk
from cfepy.sb.core import BusCore
from cfepy.sb.routing import GLOBAL
from cfepy.status import CFE_SUCCESS, CfeError


def tell_one(bus: BusCore, msg_id: int, pipe_id: int, qos: int) -> None:
    """Report a subscription, when reports are on (CFE_SB_SendSubscriptionReport).

    Args:
        bus: the bus.
        msg_id: what was subscribed to.
        pipe_id: by which pipe.
        qos: as `SubscriptionServices.subscribe_ex` takes it.
    """
    if not bus.reporting:
        return
    quality = {"Priority": qos & 0xFF, "Reliability": qos >> 8 & 0xFF}
    status = _send(bus, pk.ONESUB_TLM.packet(SubType=pk.SUBSCRIPTION, MsgId=msg_id, Qos=quality, Pipe=pipe_id))
    text = f"Sending Subscription Report Msg=0x{msg_id:x},Pipe={pipe_id},Stat=0x{status:x}"
    bus.report(ev.SUBSCRIPTION_RPT_EID, ev.DEBUG, text)


def tell_all(bus: BusCore) -> None:
    """Send every MsgId that somebody wants from other processors, 20 to a packet (CFE_SB_SendPrevSubsCmd).

    As NASA's, the entries tell no pipe and no quality, and TotalSegments stays 0.
    """
    wanted = [each.msg_id for each in bus.routes.values() if any(one.scope == GLOBAL for one in each.destinations)]
    most = pk.SUB_ENTRIES_PER_PKT
    for segment, start in enumerate(range(0, len(wanted), most), 1):
        entries = [{"MsgId": msg_id} for msg_id in wanted[start : start + most]]
        status = _send(bus, pk.ALLSUBS_TLM.packet(PktSegment=segment, Entries=len(entries), Entry=entries))
        is_full = len(entries) == most
        text = f"{'Full' if is_full else 'Partial'} Sub Pkt {segment} Sent,Entries={len(entries)},Stat=0x{status:x}"
        bus.report(ev.FULL_SUB_PKT_EID if is_full else ev.PART_SUB_PKT_EID, ev.DEBUG, text)


def _send(bus: BusCore, packet: bytes) -> int:
    """Transmit; the status as an unsigned number."""
    try:
        bus.ports.sb.transmit_msg(packet)
    except CfeError as error:
        return error.status & 0xFFFFFFFF
    return CFE_SUCCESS
