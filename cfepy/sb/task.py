"""The Software Bus application (cfe_sb_task.c, cfe_sb_dispatch.c): command pipe, telemetry, and files about the bus.

The files list routes, pipes and the map of MsgIds. The background task of Executive Services writes them record by
record, with the state of the bus at that moment. Only one file can be written at a time.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from cfepy.core_app import serve
from cfepy.fs import (
    SUBTYPE_SB_MAPDATA,
    SUBTYPE_SB_PIPEDATA,
    SUBTYPE_SB_ROUTEDATA,
    FileNameError,
    FileWriteEvent,
    FileWriteMetaData,
    dump_file_name,
)
from cfepy.msg import BAD_CODE, BAD_MSG_ID, DONE, CommandTable
from cfepy.sb import events as ev
from cfepy.sb import packets as pk
from cfepy.sb.bus import SoftwareBus, tell_all
from cfepy.sb.routing import Destination, Throttle
from cfepy.status import CFE_STATUS_REQUEST_ALREADY_PENDING, CfeError

PIPE_DEPTH = 32
PIPE_NAME = "SB_CMD_PIPE"
MAIN_PERF_ID = 4  # CFE_MISSION_SB_MAIN_PERF_ID
FILTERS = (
    (ev.SEND_NO_SUBS_EID, 0xFFFC),
    (ev.DUP_SUBSCRIP_EID, 0xFFFC),
    (ev.MSGID_LIM_ERR_EID, 0xFFF0),
    (ev.Q_FULL_ERR_EID, 0xFFF0),
)
ROUTING_FILE = "/ram/cfe_sb_route.dat"  # CFE_PLATFORM_SB_DEFAULT_*_FILENAME
PIPE_FILE = "/ram/cfe_sb_pipe.dat"
MAP_FILE = "/ram/cfe_sb_msgmap.dat"
Getter = Callable[[int], tuple[bytes, bool]]


class SbTask:
    """The core application CFE_SB."""

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
            (pk.ENABLE_SUB_REPORTING, self._enable_reports),
            (pk.DISABLE_SUB_REPORTING, self._disable_reports),
            (pk.SEND_PREV_SUBS, self._send_previous),
        )
        self.commands.handle(pk.SEND_HK, self._send_housekeeping, any_length=True)  # NASA's code does not check it

    def task_main(self) -> None:
        """Run the main task of CFE_SB (CFE_SB_TaskMain)."""
        ports = self.ports
        ports.es.perf_log_entry(MAIN_PERF_ID)
        self.bus.app_id = ports.es.get_app_id()
        ports.evs.register(FILTERS)
        ports.syslog.write_to_sys_log(f"CFE_SB_AppInit: Registered {len(FILTERS)} events for filtering")
        pipe = ports.sb.create_pipe(PIPE_DEPTH, PIPE_NAME)
        ports.sb.subscribe(pk.CMD_MID, pipe)
        ports.sb.subscribe(pk.SEND_HK_MID, pipe)
        ports.sb.subscribe(pk.SUB_RPT_CTRL_MID, pipe)
        ports.evs.send_event(
            ev.INIT_EID, ev.INFORMATION, f"cFE SB Initialized: {self.bus.config.release.text('CFE_SB')}"
        )
        serve(ports, self.bus.config, pipe, MAIN_PERF_ID, self.process)

    def process(self, packet: bytes) -> None:
        """Handle a packet of the command pipe (CFE_SB_ProcessCmdPipePkt)."""
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
        text = f"No-op Cmd Rcvd: {self.bus.config.release.text('CFE_SB')}"
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
        """Return the fields of the housekeeping packet; 8-bit counters wrap, as in NASA's code."""
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
        """Return the fields of the statistics packet."""
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


class _Kind(NamedTuple):
    """One of the three files: text and subtype of its header, its default name, and the source of its records."""

    description: str
    subtype: int
    default_name: str
    get_data: Getter


class BusFiles:
    """Handles the three commands that write files.

    Args:
        bus: the bus to write about.
    """

    def __init__(self, bus: SoftwareBus) -> None:
        self._bus = bus
        self._last: FileWriteMetaData | None = None
        self._routing = _Kind("SB Routing Information", SUBTYPE_SB_ROUTEDATA, ROUTING_FILE, self.routing_record)
        self._pipes = _Kind("SB Pipe Information", SUBTYPE_SB_PIPEDATA, PIPE_FILE, self.pipe_record)
        self._map = _Kind("SB Map Information", SUBTYPE_SB_MAPDATA, MAP_FILE, self.map_record)

    def write_routing_info(self, packet: bytes) -> None:
        """Handle CFE_SB_WRITE_ROUTING_INFO_CC."""
        self._write(pk.WRITE_ROUTING_INFO.read(packet)["Filename"], self._routing)

    def write_pipe_info(self, packet: bytes) -> None:
        """Handle CFE_SB_WRITE_PIPE_INFO_CC."""
        self._write(pk.WRITE_PIPE_INFO.read(packet)["Filename"], self._pipes)

    def write_map_info(self, packet: bytes) -> None:
        """Handle CFE_SB_WRITE_MAP_INFO_CC."""
        self._write(pk.WRITE_MAP_INFO.read(packet)["Filename"], self._map)

    def _write(self, name: str, kind: _Kind) -> None:
        counters = self._bus.counters
        try:
            self._request(name, kind)
        except CfeError as error:
            counters.command_error += 1
            last = self._last if error.status == CFE_STATUS_REQUEST_ALREADY_PENDING else None
            made = error.made if isinstance(error, FileNameError) else name
            self._report_failure(made if last is None else last.file_name, error.status)
        else:
            counters.command += 1

    def _request(self, name: str, kind: _Kind) -> None:
        if self._last is not None and self._last.is_pending:
            raise CfeError(CFE_STATUS_REQUEST_ALREADY_PENDING, f"{self._last.file_name} is being written")
        path = dump_file_name(name, kind.default_name)
        meta = FileWriteMetaData(
            path,
            kind.subtype,
            kind.description,
            kind.get_data,
            lambda event, status, record, size, position: self._ended(path, event, status, record, size, position),
        )
        self._bus.ports.fs.background_file_dump_request(meta)
        self._last = meta

    # -- records: the bytes, and whether it is the last record ---------------------------------------------------------

    def routing_record(self, number: int) -> tuple[bytes, bool]:
        """Return all destinations of a route, the newest first (CFE_SB_WriteRouteInfoDataGetter)."""
        routing = self._bus.routing
        entries: list[bytes] = []
        throttle = Throttle(number)
        routing.for_each_route_id(lambda route_id: entries.extend(self._destinations(route_id)), throttle)
        return b"".join(entries), throttle.following == 0

    def _destinations(self, route_id: int) -> list[bytes]:
        routing = self._bus.routing
        return [
            pk.ROUTING_FILE_ENTRY.pack(
                MsgId=routing.get_msg_id(route_id),
                PipeId=each.pipe.pipe_id,
                State=int(each.active),
                AppName=each.pipe.app_name,
                PipeName=each.pipe.name,
            )
            for each in routing.get_dest_list_head_ptr(route_id)
        ]

    def pipe_record(self, number: int) -> tuple[bytes, bool]:
        """Return the pipe in a slot of the pipe table, or no bytes for a free slot (CFE_SB_WritePipeInfoDataGetter)."""
        pipe = self._bus.pipes.at(number)
        is_last = number >= self._bus.pipes.capacity - 1
        if pipe is None:
            return b"", is_last
        entry = pk.PIPE_FILE_ENTRY.pack(
            PipeId=pipe.pipe_id,
            AppId=pipe.app_id,
            PipeName=pipe.name,
            AppName=pipe.app_name,
            MaxQueueDepth=pipe.depth,
            CurrentQueueDepth=len(pipe.items),
            PeakQueueDepth=pipe.peak,
            SendErrors=pipe.send_errors & 0xFFFF,
            Opts=pipe.opts,
        )
        return entry, is_last

    def map_record(self, number: int) -> tuple[bytes, bool]:
        """Return the MsgId of a route and its index in the routing table (CFE_SB_WriteMsgMapInfoDataGetter)."""
        routing = self._bus.routing
        entries: list[bytes] = []
        throttle = Throttle(number)
        routing.for_each_route_id(
            lambda route_id: entries.append(
                pk.MAP_FILE_ENTRY.pack(MsgId=routing.get_msg_id(route_id), Index=routing.route_id_to_value(route_id))
            ),
            throttle,
        )
        return b"".join(entries), throttle.following == 0

    # -- the result ----------------------------------------------------------------------------------------------------

    def _ended(self, path: str, event: FileWriteEvent, status: int, record: int, size: int, position: int) -> None:
        """Report the result in the name of SB; this runs in the background task (CFE_SB_BackgroundFileEventHandler)."""
        if event == FileWriteEvent.COMPLETE:
            self._bus.report(ev.SND_RTG_EID, ev.DEBUG, f"{path} written:Size={position},Entries={record}")
        elif event == FileWriteEvent.CREATE_ERROR:
            self._report_failure(path, status)
        else:
            text = f"File write,byte cnt err,file {path},request={size},actual={status}"
            self._bus.report(ev.FILEWRITE_ERR_EID, ev.ERROR, text)

    def _report_failure(self, name: str, status: int) -> None:
        text = f"Error creating file {name}, stat=0x{status & 0xFFFFFFFF:x}"
        self._bus.report(ev.SND_RTG_ERR1_EID, ev.ERROR, text)
