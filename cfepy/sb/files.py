"""The files that the Software Bus writes on command: routes, pipes, and the map of MsgIds (cfe_sb_task.c).

The background task of Executive Services writes them, record by record, with the bus as it is at that moment. One file
can be on its way at a time.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from cfepy.fs import dump_file_name
from cfepy.fs.background import FileWriteEvent, FileWriteMetaData
from cfepy.fs.header import SUBTYPE_SB_MAPDATA, SUBTYPE_SB_PIPEDATA, SUBTYPE_SB_ROUTEDATA
from cfepy.sb import events as ev
from cfepy.sb import packets as pk
from cfepy.sb.bus import SoftwareBus
from cfepy.sb.routing import Throttle
from cfepy.status import CFE_STATUS_REQUEST_ALREADY_PENDING, CfeError

ROUTING_FILE = "/ram/cfe_sb_route.dat"  # CFE_PLATFORM_SB_DEFAULT_ROUTING_FILENAME and its kin
PIPE_FILE = "/ram/cfe_sb_pipe.dat"
MAP_FILE = "/ram/cfe_sb_msgmap.dat"

Getter = Callable[[int], tuple[bytes, bool]]


class _Kind(NamedTuple):
    """One of the three: text and subtype of its header, name when the command gives none, where records come from."""

    description: str
    subtype: int
    default_name: str
    get_data: Getter


class BusFiles:
    """Handlers of the three commands.

    Args:
        bus: what is written.
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
            self._report_failure(name if last is None else last.file_name, error.status)
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

    # -- records: the bytes, and whether they are the last ---------------------------------------------------------

    def routing_record(self, number: int) -> tuple[bytes, bool]:
        """All destinations of a route, newest first (CFE_SB_WriteRouteInfoDataGetter)."""
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
        """The pipe in a slot of the pipe table, nothing for a free slot (CFE_SB_WritePipeInfoDataGetter)."""
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
        """The MsgId of a route and its index in the routing table (CFE_SB_WriteMsgMapInfoDataGetter)."""
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

    # -- how it ended ----------------------------------------------------------------------------------------------

    def _ended(self, path: str, event: FileWriteEvent, status: int, record: int, size: int, position: int) -> None:
        """Say so, in the name of SB: this runs in the background task (CFE_SB_BackgroundFileEventHandler)."""
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
