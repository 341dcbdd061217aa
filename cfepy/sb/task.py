"""The Software Bus application: its command pipe, housekeeping and statistics (cfe_sb_task.c, cfe_sb_dispatch.c)."""

from __future__ import annotations

from cfepy.core_app import serve
from cfepy.msg import CommandTable
from cfepy.msg.dispatch import BAD_CODE, BAD_MSG_ID, DONE
from cfepy.sb import events as ev
from cfepy.sb import packets as pk
from cfepy.sb.bus import SoftwareBus
from cfepy.sb.files import BusFiles
from cfepy.sb.reports import tell_all
from cfepy.sb.routing import Destination
from cfepy.versions import version_string

PIPE_DEPTH = 32
PIPE_NAME = "SB_CMD_PIPE"
MAIN_PERF_ID = 4  # CFE_MISSION_SB_MAIN_PERF_ID
FILTERS = (
    (ev.SEND_NO_SUBS_EID, 0xFFFC),
    (ev.DUP_SUBSCRIP_EID, 0xFFFC),
    (ev.MSGID_LIM_ERR_EID, 0xFFF0),
    (ev.Q_FULL_ERR_EID, 0xFFF0),
)


class SbTask:
    """The core application CFE_SB on a bus."""

    def __init__(self, bus: SoftwareBus) -> None:
        self.bus = bus
        self.ports = bus.ports
        self.files = BusFiles(bus)
        self.commands = CommandTable(
            (pk.NOOP, self._noop),
            (pk.RESET_COUNTERS, self._reset_counters),
            (pk.SEND_SB_STATS, self._send_statistics),
            (pk.WRITE_ROUTING_INFO, self.files.write_routing_info),
            (pk.ENABLE_ROUTE, self._enable_route),
            (pk.DISABLE_ROUTE, self._disable_route),
            (pk.WRITE_PIPE_INFO, self.files.write_pipe_info),
            (pk.WRITE_MAP_INFO, self.files.write_map_info),
            (pk.SEND_HK, self._send_housekeeping),
            (pk.ENABLE_SUB_REPORTING, self._enable_reports),
            (pk.DISABLE_SUB_REPORTING, self._disable_reports),
            (pk.SEND_PREV_SUBS, self._send_previous),
        )

    def task_main(self) -> None:
        """The main task of CFE_SB (CFE_SB_TaskMain)."""
        ports = self.ports
        ports.es.perf_log_entry(MAIN_PERF_ID)
        self.bus.app_id = ports.es.get_app_id()
        ports.evs.register(FILTERS)
        ports.syslog.write_to_sys_log(f"CFE_SB_AppInit: Registered {len(FILTERS)} events for filtering")
        pipe = ports.sb.create_pipe(PIPE_DEPTH, PIPE_NAME)
        ports.sb.subscribe(pk.CMD_MID, pipe)
        ports.sb.subscribe(pk.SEND_HK_MID, pipe)
        ports.sb.subscribe(pk.SUB_RPT_CTRL_MID, pipe)
        ports.evs.send_event(ev.INIT_EID, ev.INFORMATION, f"cFE SB Initialized: {version_string('CFE_SB')}")
        serve(ports, self.bus.config, pipe, MAIN_PERF_ID, self.process)

    def process(self, packet: bytes) -> None:
        """Handle one packet of the command pipe (CFE_SB_ProcessCmdPipePkt)."""
        done = self.commands.dispatch(packet)
        if done.outcome == DONE:
            return
        if done.outcome == BAD_MSG_ID:
            event, text = ev.BAD_MSGID_EID, f"Invalid Cmd, Unexpected Msg Id: 0x{done.msg_id:x}"
        elif done.outcome == BAD_CODE:
            event, text = ev.BAD_CMD_CODE_EID, f"Invalid Cmd, Unexpected Command Code {done.fcn_code}"
        else:
            event, text = ev.LEN_ERR_EID, done.length_text()
        self.bus.counters.command_error += 1
        self.ports.evs.send_event(event, ev.ERROR, text)

    # -- commands --------------------------------------------------------------------------------------------------

    def _noop(self, packet: bytes) -> None:
        text = f"No-op Cmd Rcvd: {version_string('CFE_SB')}"
        self.ports.evs.send_event(ev.CMD0_RCVD_EID, ev.INFORMATION, text)
        self.bus.counters.command += 1

    def _reset_counters(self, packet: bytes) -> None:
        self.ports.evs.send_event(ev.CMD1_RCVD_EID, ev.DEBUG, "Reset Counters Cmd Rcvd")
        self.bus.counters.reset()

    def _send_housekeeping(self, packet: bytes) -> None:
        self.ports.sb.transmit_msg(pk.HK_TLM.packet(self.housekeeping()))

    def _send_statistics(self, packet: bytes) -> None:
        self.ports.sb.transmit_msg(pk.STATS_TLM.packet(self.statistics()))
        self.ports.evs.send_event(ev.SND_STATS_EID, ev.DEBUG, "Software Bus Statistics packet sent")
        self.bus.counters.command += 1

    def _enable_route(self, packet: bytes) -> None:
        self._switch_route(packet, True, ev.ENBL_RTE1_EID, ev.ENBL_RTE2_EID, ev.ENBL_RTE3_EID)

    def _disable_route(self, packet: bytes) -> None:
        self._switch_route(packet, False, ev.DSBL_RTE1_EID, ev.DSBL_RTE2_EID, ev.DSBL_RTE3_EID)

    def _switch_route(self, packet: bytes, active: bool, unknown: int, done: int, invalid: int) -> None:
        fields = pk.ENABLE_ROUTE.read(packet)
        msg_id, pipe_id = fields["MsgId"], fields["Pipe"]
        command = "Enbl" if active else "Disable"
        where = f"Msg 0x{msg_id:x},Pipe {pipe_id}"
        pipe = self.bus.find_pipe(pipe_id)
        route = self.bus.routes.get(msg_id)
        destination: Destination | None = route.find(pipe) if route is not None and pipe is not None else None
        if pipe is None or not self.bus.is_valid_msg_id(msg_id):
            self.ports.evs.send_event(invalid, ev.ERROR, f"{command} Route Cmd:Invalid Param.{where}")
            self.bus.counters.command_error += 1
        elif route is None or destination is None:
            mark = "." if active else ","
            text = f"{command} Route Cmd:Route does not exist{mark}{where}"
            self.ports.evs.send_event(unknown, ev.ERROR, text)
            self.bus.counters.command_error += 1
        else:
            destination.active = active
            route.refresh()
            text = f"Enabling Route,{where}" if active else f"Route Disabled,{where}"
            self.ports.evs.send_event(done, ev.DEBUG, text)
            self.bus.counters.command += 1

    # -- requests about subscriptions, which are not counted -------------------------------------------------------

    def _enable_reports(self, packet: bytes) -> None:
        self.bus.reporting = True

    def _disable_reports(self, packet: bytes) -> None:
        self.bus.reporting = False

    def _send_previous(self, packet: bytes) -> None:
        tell_all(self.bus)

    # -- telemetry -------------------------------------------------------------------------------------------------

    def housekeeping(self) -> dict[str, int]:
        """The fields of the housekeeping packet; 8-bit counters wrap as NASA's do."""
        counters = self.bus.counters
        used, _ = self.bus.note_peaks()
        names = {
            "CommandCounter": counters.command,
            "CommandErrorCounter": counters.command_error,
            "NoSubscribersCounter": counters.no_subscribers,
            "MsgSendErrorCounter": counters.msg_send_error,
            "MsgReceiveErrorCounter": counters.msg_receive_error,
            "InternalErrorCounter": counters.internal_error,
            "CreatePipeErrorCounter": counters.create_pipe_error,
            "SubscribeErrorCounter": counters.subscribe_error,
            "PipeOptsErrorCounter": counters.pipe_opts_error,
            "DuplicateSubscriptionsCounter": counters.duplicate_subscriptions,
            "GetPipeIdByNameErrorCounter": counters.get_pipe_id_by_name_error,
        }
        wide = {
            "PipeOverflowErrorCounter": counters.pipe_overflow_error & 0xFFFF,
            "MsgLimitErrorCounter": counters.msg_limit_error & 0xFFFF,
            "MemPoolHandle": self.bus.pool_handle,
            "MemInUse": used,
            "UnmarkedMem": max(0, self.bus.config.sb_buf_memory_bytes - self.bus.peaks.memory),
        }
        return {name: value & 0xFF for name, value in names.items()} | wide

    def statistics(self) -> dict[str, object]:
        """The fields of the statistics packet."""
        bus, config = self.bus, self.bus.config
        used, buffers = bus.note_peaks()
        return {
            "MsgIdsInUse": len(bus.routes),
            "PeakMsgIdsInUse": bus.peaks.msg_ids,
            "MaxMsgIdsAllowed": config.sb_max_msg_ids,
            "PipesInUse": len(bus.pipes),
            "PeakPipesInUse": bus.peaks.pipes,
            "MaxPipesAllowed": config.sb_max_pipes,
            "MemInUse": used,
            "PeakMemInUse": bus.peaks.memory,
            "MaxMemAllowed": config.sb_buf_memory_bytes,
            "SubscriptionsInUse": bus.subscriptions,
            "PeakSubscriptionsInUse": bus.peaks.subscriptions,
            "MaxSubscriptionsAllowed": config.sb_max_msg_ids * config.sb_max_dest_per_pkt,
            "SBBuffersInUse": buffers,
            "PeakSBBuffersInUse": bus.peaks.buffers,
            "MaxPipeDepthAllowed": config.os_queue_max_depth,
            "PipeDepthStats": [
                {
                    "PipeId": pipe.pipe_id,
                    "MaxQueueDepth": pipe.depth,
                    "CurrentQueueDepth": len(pipe.items),
                    "PeakQueueDepth": pipe.peak,
                }
                for pipe in list(bus.pipes)[: pk.PIPES_IN_STATS]
            ],
        }
