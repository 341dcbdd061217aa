"""SBN's ground commands (sbn_cmds.c)."""

from __future__ import annotations

from collections.abc import Callable

from cfepy.app import Cfe
from cfepy.msg import BAD_CODE, BAD_LENGTH, BAD_MSG_ID, CommandTable, Dispatch
from cfepy.osal import OsTime

from . import events as ev
from . import packets as pk
from .network import Net, Nets, Peer
from .subscriptions import Subscriptions

_U16 = 0xFFFF


class SbnCommands:
    """The commands, and their counters.

    Args:
        cfe: the app's handle.
        network: the nets and peers.
        subscriptions: subscriptions of this processor.
        reload: takes tables that were loaded.
    """

    def __init__(self, cfe: Cfe, network: Nets, subscriptions: Subscriptions, reload: Callable[[], object]) -> None:
        self._cfe = cfe
        self._network = network
        self._subscriptions = subscriptions
        self._done = self._errors = 0
        self._table = CommandTable(
            (pk.NOOP, self._noop),
            (pk.HK, self._send_hk),
            (pk.HK_NET, self._send_net),
            (pk.HK_PEER, self._send_peer),
            (pk.HK_PEERSUBS, self._send_peer_subs),
            (pk.HK_MYSUBS, self._send_my_subs),
            (pk.HK_RESET, self._reset),
            (pk.HK_RESET_PEER, self._reset_peer),
            (pk.TBL, lambda packet: reload()),
        )
        self._table.handle(pk.SCH_WAKEUP, lambda packet: None, any_length=True)

    def handle(self, packet: bytes) -> None:
        """Do a message of the command pipe (SBN_HandleCommand)."""
        done = self._table.dispatch(packet)
        if done.outcome == BAD_MSG_ID:
            self._refuse("invalid command pipe MsgId")
        elif done.outcome == BAD_CODE:
            self._refuse(f"invalid command code (ID=0x{done.fcn_code:04X}, CC={done.fcn_code})")
        elif done.outcome == BAD_LENGTH:
            self._bad_length(done)

    def _bad_length(self, done: Dispatch) -> None:
        what = f"ID=0x{done.fcn_code:04X} CC={done.fcn_code} Len={done.length} Expected={done.expected}"
        if done.fcn_code == pk.HK.code:  # no command of the ground, so it does not count
            self._cfe.evs.send_err(ev.CMD_EID, f"invalid hk message length ({what})")
        else:
            self._refuse(f"invalid message length ({what})")

    def _refuse(self, text: str) -> None:
        self._errors += 1
        self._cfe.evs.send_err(ev.CMD_EID, text)

    # -- counters ----------------------------------------------------------------------------------------------------

    def reset(self) -> None:
        """Set all counters to zero (SBN_InitializeCounters)."""
        self._done = self._errors = 0
        for peer in self._network.peers:
            peer.reset_counts()

    def _noop(self, packet: bytes) -> None:
        self._cfe.evs.send_dbg(ev.CMD_EID, "no-op command")
        self._done += 1

    def _reset(self, packet: bytes) -> None:
        self._cfe.evs.send_info(ev.CMD_EID, "reset command")
        self.reset()

    def _reset_peer(self, packet: bytes) -> None:
        peer = self._peer(packet, pk.HK_RESET_PEER.read(packet))
        if peer is not None:
            self._done += 1
            peer.reset_counts()

    # -- telemetry ---------------------------------------------------------------------------------------------------

    def _send_hk(self, packet: bytes) -> None:
        telemetry = pk.HK_TLM.packet(
            CC=pk.HK.code,
            CmdCnt=self._done & _U16,
            CmdErrCnt=self._errors & _U16,
            SubCnt=len(self._subscriptions.mine),
            NetCnt=len(self._network.nets),
        )
        self._cfe.sb.transmit_msg(telemetry)

    def _send_net(self, packet: bytes) -> None:
        net = self._net(pk.HK_NET.read(packet)["NetIdx"])
        if net is not None:
            telemetry = pk.HK_NET_TLM.packet(CC=pk.HK_NET.code, ProtocolIdx=net.protocol_idx, PeerCnt=len(net.peers))
            self._cfe.sb.transmit_msg(telemetry)

    def _send_peer(self, packet: bytes) -> None:
        peer = self._peer(packet, pk.HK_PEER.read(packet))
        if peer is None:
            return
        telemetry = pk.HK_PEER_TLM.packet(
            CC=pk.HK_PEER.code,
            ProcessorID=peer.processor_id,
            **self._time("LastSend", peer.last_send),
            **self._time("LastRecv", peer.last_recv),
            SendCnt=peer.send_cnt & _U16,
            RecvCnt=peer.recv_cnt & _U16,
            SendErrCnt=peer.send_err_cnt & _U16,
            RecvErrCnt=peer.recv_err_cnt & _U16,
            SubCnt=len(peer.subs),
        )
        self._cfe.sb.transmit_msg(telemetry)

    def _send_peer_subs(self, packet: bytes) -> None:
        which = pk.HK_PEERSUBS.read(packet)
        peer = self._peer(packet, which)
        if peer is not None:
            subs = list(peer.subs)
            telemetry = pk.HK_PEERSUBS_TLM.packet(which, CC=pk.HK_PEERSUBS.code, SubCnt=len(subs), Subs=subs)
            self._cfe.sb.transmit_msg(telemetry)

    def _send_my_subs(self, packet: bytes) -> None:
        subs = list(self._subscriptions.mine)
        telemetry = pk.HK_MYSUBS_TLM.packet(CC=pk.HK_MYSUBS.code, SubCnt=len(subs), Subs=subs)
        self._cfe.sb.transmit_msg(telemetry)

    # -- objects named by commands -----------------------------------------------------------------------------------

    def _net(self, index: int) -> Net | None:
        nets = self._network.nets
        if index < len(nets):
            return nets[index]
        self._cfe.evs.send_err(ev.CMD_EID, f"Invalid NetIdx ({index}, max is {len(nets) - 1})")
        return None

    def _peer(self, packet: bytes, which: dict[str, int]) -> Peer | None:
        net, index = self._net(which["NetIdx"]), which["PeerIdx"]
        if net is None or index < len(net.peers):
            return None if net is None else net.peers[index]
        text = f"Invalid PeerIdx (NetIdx={net.index} PeerIdx={index}, max is {len(net.peers) - 1})"
        self._cfe.evs.send_err(ev.CMD_EID, text)
        return None

    def _time(self, name: str, time: OsTime) -> dict[str, int]:
        """Return a local time as two fields."""
        os = self._cfe.os
        return {
            f"{name}Seconds": os.time_get_total_seconds(time),
            f"{name}Microseconds": os.time_get_microseconds_part(time),
        }
