"""Commands for the system log and for the exception and reset log (CFE_ES_*SysLogCmd, CFE_ES_*ERLogCmd)."""

from __future__ import annotations

from cfepy.core_app import Replies
from cfepy.es import events as ev
from cfepy.es import packets as pk
from cfepy.es.command_group import CommandGroup, Handlers
from cfepy.es.dump_files import SYS_LOG_FILE, write_dump
from cfepy.es.service import ExecutiveServices
from cfepy.fs import dump_file_name
from cfepy.fs.background import FileWriteEvent, FileWriteMetaData
from cfepy.fs.header import SUBTYPE_ES_ERLOG
from cfepy.status import CFE_STATUS_REQUEST_ALREADY_PENDING, CfeError

ER_LOG_FILE = "/ram/cfe_erlog.log"
ER_LOG_DESCRIPTION = "ES ERlog data file"


class LogCommands(CommandGroup):
    """The two logs."""

    def __init__(self, es: ExecutiveServices, replies: Replies) -> None:
        super().__init__(es, replies)
        self._er_log_file = FileWriteMetaData(
            "", SUBTYPE_ES_ERLOG, ER_LOG_DESCRIPTION, self._er_log_record, self._er_log_written
        )

    def handlers(self) -> Handlers:
        return (
            (pk.CLEAR_SYS_LOG, self._clear_sys_log),
            (pk.WRITE_SYS_LOG, self._write_sys_log),
            (pk.OVER_WRITE_SYS_LOG, self._set_sys_log_mode),
            (pk.CLEAR_ER_LOG, self._clear_er_log),
            (pk.WRITE_ER_LOG, self._write_er_log),
        )

    # -- the system log --------------------------------------------------------------------------------------------

    def _clear_sys_log(self, packet: bytes) -> None:
        self._es.syslog.clear()
        self._replies.accept(ev.SYSLOG1_INF_EID, "Cleared Executive Services log data")

    def _write_sys_log(self, packet: bytes) -> None:
        name = pk.WRITE_SYS_LOG.read(packet)["FileName"]
        lines = self._es.syslog.read().splitlines(keepends=True)
        write_dump(self._es, self._replies, SYS_LOG_FILE, name, lines)

    def _set_sys_log_mode(self, packet: bytes) -> None:
        mode = pk.OVER_WRITE_SYS_LOG.read(packet)["Mode"]
        try:
            self._es.syslog.set_mode(mode)
        except CfeError:
            text = f"Set OverWriteSysLog Command: Invalid Mode setting = {mode}"
            self._replies.reject(ev.ERR_SYSLOGMODE_EID, text)
            return
        text = f"Set OverWriteSysLog Command Received with Mode setting = {mode}"
        self._replies.accept(ev.SYSLOGMODE_EID, text, ev.DEBUG)

    # -- the exception and reset log -------------------------------------------------------------------------------

    def _clear_er_log(self, packet: bytes) -> None:
        self._es.er_log.clear()
        self._replies.accept(ev.ERLOG1_INF_EID, "Cleared ES Exception and Reset Log data")

    def _write_er_log(self, packet: bytes) -> None:
        """Have it written by the background task; its event comes when that is done."""
        file = self._er_log_file
        try:
            if file.is_pending:
                raise CfeError(CFE_STATUS_REQUEST_ALREADY_PENDING, "the log is being written")
            file.file_name = dump_file_name(pk.WRITE_ER_LOG.read(packet)["FileName"], ER_LOG_FILE)
            self._es.ports.fs.background_file_dump_request(file)
        except CfeError as error:
            if error.status == CFE_STATUS_REQUEST_ALREADY_PENDING:
                self._replies.reject(ev.ERLOG_PENDING_ERR_EID, "Error log write already in progress")
            else:
                self._replies.reject(ev.ERLOG2_ERR_EID, f"Error creating file, RC = {error.status}")
            return
        self._replies.command_counter += 1

    def _er_log_record(self, number: int) -> tuple[bytes, bool]:
        last = len(self._es.reset.er_log.slots) - 1
        return self._es.er_log.file_record(number), number >= last

    def _er_log_written(self, event: FileWriteEvent, status: int, record: int, block: int, position: int) -> None:
        path, send = self._er_log_file.file_name, self._replies.send
        if event == FileWriteEvent.COMPLETE:
            send(ev.ERLOG2_EID, f"{path} written:Size={position}", ev.DEBUG)
        elif event == FileWriteEvent.CREATE_ERROR:
            send(ev.ERLOG2_ERR_EID, f"Error creating file {path}, RC = {status}", ev.ERROR)
        else:
            text = f"File write,byte cnt err,file {path},request={block},actual={status & 0xFFFFFFFF}"
            send(ev.FILEWRITE_ERR_EID, text, ev.ERROR)
