"""SBN's main task: start, configuration, and the work of every wakeup (sbn_app.c).

It wakes up when a scheduler says so, and after 200 ms in any case. The configuration table can add tasks that wait for
messages from a net and for messages to a peer, so that no message waits for a wakeup.
"""

from __future__ import annotations

from typing import Any

from cfepy.app import Cfe
from cfepy.es import APP_ERROR, APP_EXIT, APP_RUN, SYSTEM_OPERATIONAL
from cfepy.sb import PEND_FOREVER, POLL
from cfepy.status import CFE_TBL_INFO_UPDATED, CfeError, OsalError

from . import events as ev
from . import packets as pk
from .commands import SbnCommands
from .network import Net, Nets, Peer
from .protocol import IDENT, Malformed
from .remap import Remap
from .subscriptions import Subscriptions
from .udp import Udp

PIPE_NAME = "SBNCmdPipe"
PIPE_DEPTH = 20
STARTUP_SYNC_MS = 10_000
MAIN_LOOP_DELAY_MS = 200
MAX_MSG_PER_WAKEUP = 32  # that are sent to a peer
MAX_RECV_PER_WAKEUP = 100  # that are taken from a net
CHILD_STACK = 8192 + 65_536
RECV_PERF_ID = 2
UDP_OPS, REMAP_FILTER = "SBN_UDP_Ops", "SBN_F_Remap"
"""Symbols of the modules that there are."""


def SBN_AppMain(cfe: Cfe) -> None:
    """Run the app; the startup script names this entry point."""
    run(cfe)


def run(cfe: Cfe, ident: str = IDENT) -> None:
    """Run SBN to its end.

    Args:
        cfe: the app's handle.
        ident: the source that peers were built from (SBN_IDENT). A peer with another ident gets no subscribed messages.
    """
    app = Sbn(cfe, ident)
    run_status = APP_RUN
    try:
        app.start()
    except (CfeError, OsalError):  # it was reported where it happened
        run_status = APP_ERROR
    while cfe.es.run_loop(run_status):
        app.wait()
    app.clean_up()
    cfe.es.exit_app(APP_EXIT if run_status == APP_RUN else run_status)


class ConfError(CfeError):
    """The configuration table names something that there is not."""

    def __init__(self, text: str) -> None:
        super().__init__(-1, text)


class Sbn:
    """SBN's pipe, tables, nets and tasks. The arguments are those of `run`."""

    def __init__(self, cfe: Cfe, ident: str) -> None:
        self._cfe = cfe
        self._subscriptions = Subscriptions(cfe, ident)
        self._network = Nets(cfe, self._subscriptions)
        self._subscriptions.tell = self._tell_peers
        self._commands = SbnCommands(cfe, self._network, self._subscriptions, self._reload)
        self._filters: dict[str, Remap] = {}
        self._is_set_up = False

    # -- start and end -----------------------------------------------------------------------------------------------

    def start(self) -> None:
        """Prepare everything before the first wakeup.

        Raises:
            CfeError, OsalError: a service refused, or the configuration is invalid; an event reports it.
        """
        cfe = self._cfe
        cfe.evs.register()
        try:
            self._pipe = cfe.sb.create_pipe(PIPE_DEPTH, PIPE_NAME)
            cfe.sb.subscribe(pk.CMD_MID, self._pipe)
        except CfeError as error:
            text = f"failed to create command pipe ({error.status})"
            cfe.evs.send_err(ev.INIT_EID, f"ERROR: could not start SBN: {text}")
            raise
        cfe.evs.send_info(ev.INIT_EID, f"SBN subscribed to command pipe SBN_CMD_MID 0x{pk.CMD_MID:04X}")
        cfe.es.wait_for_startup_sync(STARTUP_SYNC_MS)
        self._load_table()
        self._set_up()

    def _load_table(self) -> None:
        tbl, table = self._cfe.tbl, pk.CONF_TABLE
        try:
            self._conf = tbl.register(table.own_name, table.size)
            tbl.load(self._conf, table.file)
            tbl.manage(self._conf)
            tbl.notify_by_message(self._conf, pk.CMD_MID, pk.TBL.code or 0, 0)
        except CfeError:
            self._cfe.evs.send_err(ev.TBL_EID, f"unable to load conf tbl {table.file}")
            self._cfe.evs.send_err(ev.INIT_EID, "ERROR: could not start SBN: failed to load configuration table")
            raise

    def _set_up(self) -> None:
        """Take the configuration, and join the network (Init)."""
        cfe = self._cfe
        self._configure()
        for net in self._network.nets:
            self._init_net(net)
        cfe.evs.send_info(ev.INIT_EID, f"configured, {len(self._network.nets)} nets")
        self._subscriptions.open()
        self._is_set_up = True
        ids = f"ProcessorID={cfe.psp.get_processor_id()} SpacecraftId={cfe.psp.get_spacecraft_id()}"
        cfe.evs.send_info(ev.INIT_EID, f"initialized ({ids} little-endian SBN.AppID={cfe.es.get_app_id()}...")
        self._commands.reset()
        self._wait_for_others()
        self._subscriptions.ask()
        cfe.evs.send_info(ev.INIT_EID, "SBN initialized.")

    def _wait_for_others(self) -> None:
        while True:
            try:
                self._cfe.es.wait_for_system_state(SYSTEM_OPERATIONAL, 1000)
            except CfeError:
                continue
            return

    def _init_net(self, net: Net) -> None:
        if net.module is None:
            self._cfe.evs.send_err(ev.PEER_EID, f"network #{net.index} not configured")
            raise ConfError(f"net {net.index} is not configured")
        net.module.init_net(net)
        self._cfe.evs.send_info(ev.PEER_EID, f"Net {net.index} has {len(net.peers)} peers")

    def clean_up(self) -> None:
        """Leave the network (Cleanup)."""
        cfe = self._cfe
        if self._is_set_up:
            self._subscriptions.close()
        self._is_set_up = False
        for net in self._network.nets:
            for task in (net.recv_task, *(peer.send_task for peer in net.peers)):
                if task:
                    cfe.es.delete_child_task(task)
            if net.module is not None:
                net.module.unload_net(net)
            cfe.evs.send_info(ev.TBL_EID, f"Terminated net: {net.index}")
        self._network.nets.clear()
        for each in self._filters.values():
            each.unload()
        self._filters.clear()

    # -- configuration -----------------------------------------------------------------------------------------------

    def _reload(self) -> None:
        """Take tables that the ground has loaded (SBN_ReloadConfTbl)."""
        for each in self._filters.values():
            each.manage()
        if self._cfe.tbl.manage(self._conf) != CFE_TBL_INFO_UPDATED:
            return
        self._cfe.evs.send_info(ev.TBL_EID, "re-initializing SBN with new configuration...")
        self.clean_up()
        try:
            self._set_up()
        except (CfeError, OsalError):  # already reported; SBN waits for a better one
            return
        self._cfe.evs.send_info(ev.TBL_EID, "SBN re-initialized.")

    def _configure(self) -> None:
        """Make nets and peers of the table (LoadConf)."""
        image, _ = self._cfe.tbl.get_address(self._conf)
        table: dict[str, Any] = pk.CONF.unpack(image)
        self._cfe.tbl.release_address(self._conf)
        protocols = table["ProtocolModules"][: table["ProtocolCnt"]]
        for each in protocols:
            self._check_module(each, UDP_OPS)
        modules = [Udp(self._cfe, self._network, each["BaseEID"]) for each in protocols]
        for each in table["FilterModules"][: table["FilterCnt"]]:
            self._check_module(each, REMAP_FILTER)
            self._filters[each["Name"]] = remap = Remap(self._cfe, each["BaseEID"])
            remap.load()
        for entry in table["Peers"][: table["PeerCnt"]]:
            names = [each["Name"] for each in protocols]
            if entry["ProtocolName"] not in names:
                raise self._invalid(f"invalid module name {entry['ProtocolName']}")
            index = names.index(entry["ProtocolName"])
            self._add_peer(entry, modules[index], index)
        if not self._network.nets:
            raise self._invalid("no networks configured")

    def _check_module(self, entry: dict[str, Any], symbol: str) -> None:
        """The modules of cfepy's SBN are built in, and known by their symbols."""
        if entry["LibSymbol"] != symbol:
            text = f"Name={entry['Name']} LibSymbol={entry['LibSymbol']}"
            raise self._invalid(f"invalid symbol ({text})")

    def _add_peer(self, entry: dict[str, Any], module: Udp, index: int) -> None:
        nets, psp = self._network.nets, self._cfe.psp
        number, ids = entry["NetNum"], (entry["ProcessorID"], entry["SpacecraftID"])
        if number >= pk.MAX_NETS:
            raise self._invalid(f"network index too large ({number}>{pk.MAX_NETS})")
        nets += [Net(each) for each in range(len(nets), number + 1)]
        net = nets[number]
        if ids == (psp.get_processor_id(), psp.get_spacecraft_id()):
            net.module, net.protocol_idx = module, index
            net.address, net.task_flags = entry["Address"], entry["TaskFlags"]
            return
        net.peers.append(Peer(*ids, entry["Address"], entry["TaskFlags"], net, self._filters_of(entry)))

    def _filters_of(self, entry: dict[str, Any]) -> list[Remap]:
        names = [name for name in entry["Filters"] if name]
        for name in names:
            if name not in self._filters:
                self._cfe.evs.send_err(ev.TBL_EID, f"Invalid filter name: {name}")
        return [self._filters[name] for name in names if name in self._filters]

    def _invalid(self, text: str) -> ConfError:
        self._cfe.evs.send_crit(ev.TBL_EID, text)
        self._cfe.evs.send_err(ev.INIT_EID, "ERROR: could not initialize SBN: unable to initialize interfaces")
        return ConfError(text)

    # -- wakeups -----------------------------------------------------------------------------------------------------

    def wait(self) -> None:
        """Wait for a message or 200 ms, and look after everything (WaitForWakeup)."""
        cfe = self._cfe
        packet = cfe.sb.receive_buffer(self._pipe, MAIN_LOOP_DELAY_MS)
        if packet is not None:
            self._commands.handle(packet)
        if not self._is_set_up:
            return
        cfe.es.perf_log_entry(RECV_PERF_ID)
        for net in self._network.nets:
            if not net.task_flags & pk.TASK_RECV:
                self._receive_from(net)
        self._subscriptions.check_pipe()
        self._look_after_peers()
        cfe.es.perf_log_exit(RECV_PERF_ID)

    def _receive_from(self, net: Net) -> None:
        for _ in range(MAX_RECV_PER_WAKEUP):
            if not self._take_from(net, pend=False):
                return

    def _take_from(self, net: Net, pend: bool) -> bool:
        """Take a message from a net. Returns whether there was one, even an unusable one."""
        assert net.module is not None
        try:
            message = net.module.recv(net, pend)
        except Malformed:
            return True
        if message is not None:
            self._network.process(net, message)
        return message is not None

    def _look_after_peers(self) -> None:
        """Detect lost peers, send subscribed messages, and start missing tasks (CheckPeerPipes, PeerPoll)."""
        for net in self._network.nets:
            if net.task_flags & pk.TASK_RECV and not net.recv_task:
                self._start_receiver(net)
            for peer in net.peers:
                if net.module is not None:
                    net.module.poll_peer(peer)
                if peer.connected and peer.task_flags & pk.TASK_SEND and not peer.send_task:
                    self._start_sender(peer)
        for _ in range(MAX_MSG_PER_WAKEUP):
            sent = [self._send_one(peer) for peer in self._network.peers]
            if not any(sent):
                return

    def _send_one(self, peer: Peer) -> bool:
        """Send a peer one waiting message. Returns whether there was one."""
        if not peer.connected or peer.send_task:
            return False
        packet = self._cfe.sb.receive_buffer(peer.pipe, POLL)
        if packet is not None:
            self._network.send_packet(peer, packet)
        return packet is not None

    def _tell_peers(self, kind: int, payload: bytes) -> None:
        for peer in self._network.peers:
            self._network.send(peer, kind, payload)

    # -- tasks -------------------------------------------------------------------------------------------------------

    def _start_receiver(self, net: Net) -> None:
        self._cfe.evs.send_info(ev.PEER_EID, f"Creating recv task for net {net.index}")
        try:
            net.recv_task = self._child(f"sbn_rs_{net.index}", lambda: self._receiver(net))
        except CfeError:
            self._cfe.evs.send_err(ev.PEER_EID, f"error creating task for net {net.index}")

    def _start_sender(self, peer: Peer) -> None:
        name = f"sendT_{peer.net.index}_{peer.processor_id}_{peer.spacecraft_id}"
        try:
            peer.send_task = self._child(name, lambda: self._sender(peer))
        except CfeError:
            self._cfe.evs.send_err(ev.PEER_EID, f"error creating send task for peer {peer.name}")

    def _child(self, name: str, main: Any) -> int:
        return self._cfe.es.create_child_task(name, main, CHILD_STACK, 0)

    def _receiver(self, net: Net) -> None:
        """Take everything that comes from a net, as it comes (SBN_RecvNetTask)."""
        while True:
            self._take_from(net, pend=True)

    def _sender(self, peer: Peer) -> None:
        """Send a peer everything, as it comes (SBN_SendTask)."""
        cfe = self._cfe
        while True:
            if not peer.connected:
                cfe.os.task_delay(MAIN_LOOP_DELAY_MS)
                continue
            try:
                packet = cfe.sb.receive_buffer(peer.pipe, PEND_FOREVER)
            except CfeError:  # the pipe went with the connection
                continue
            if packet is not None:
                self._network.send_packet(peer, packet)
