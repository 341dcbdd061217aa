"""The files that Executive Services write at once: their headers, default names, and error events."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from cfepy.core_app import Replies
from cfepy.es import events as ev
from cfepy.es.tables import EsCore
from cfepy.fs import HEADER_SIZE, dump_file_name, init_header
from cfepy.fs import header as subtypes
from cfepy.osal import OS_FILE_FLAG_CREATE, OS_FILE_FLAG_TRUNCATE, OS_WRITE_ONLY
from cfepy.status import CfeError


class FileEvent(NamedTuple):
    """An event about a file.

    Its text may have the fields `path`, `size` and `entries` (of the whole file, or of the block that failed),
    `status`, and `code`, the status as a C unsigned int.
    """

    event_id: int
    text: str


class EsFile(NamedTuple):
    """A kind of file, with the events for success and for errors in the name, the file, the header or a record."""

    description: str
    subtype: int
    default_name: str
    written: FileEvent
    bad_name: FileEvent
    no_file: FileEvent
    no_header: FileEvent
    no_record: FileEvent


_APP_INFO = "Failed to write App Info file, "
_TASK_INFO = "Failed to write Task Info file, "
_COUNT_ERROR = FileEvent(ev.FILEWRITE_ERR_EID, "File write,byte cnt err,file {path},request={size},status=0x{code:08x}")

APP_INFO_FILE = EsFile(
    "ES Application Info file",
    subtypes.SUBTYPE_ES_QUERYALL,
    "/ram/cfe_es_app_info.log",
    FileEvent(ev.ALL_APPS_EID, "App Info file written to {path}, Entries={entries}, FileSize={size}"),
    FileEvent(ev.OSCREATE_ERR_EID, _APP_INFO + "CFE_FS_ParseInputFileNameEx RC = {code:08x}"),
    FileEvent(ev.OSCREATE_ERR_EID, _APP_INFO + "OS_OpenCreate RC = {status}"),
    FileEvent(ev.WRHDR_ERR_EID, _APP_INFO + "WriteHdr RC = 0x{code:08X}, exp {size}"),
    FileEvent(ev.TASKWR_ERR_EID, _APP_INFO + "Task write RC = {status}, exp {size}"),
)
TASK_INFO_FILE = EsFile(
    "ES Task Info file",
    subtypes.SUBTYPE_ES_QUERYALLTASKS,
    "/ram/cfe_es_taskinfo.log",
    FileEvent(ev.TASKINFO_EID, "Task Info file written to {path}, Entries={entries}, FileSize={size}"),
    FileEvent(ev.TASKINFO_OSCREATE_ERR_EID, _TASK_INFO + "CFE_FS_ParseInputFileNameEx RC = {code:08x}"),
    FileEvent(ev.TASKINFO_OSCREATE_ERR_EID, _TASK_INFO + "OS_OpenCreate RC = {status}"),
    FileEvent(ev.TASKINFO_WRHDR_ERR_EID, _TASK_INFO + "WriteHdr RC = 0x{code:08X}, exp {size}"),
    FileEvent(ev.TASKINFO_WR_ERR_EID, _TASK_INFO + "Task write RC = {status}, exp {size}"),
)
SYS_LOG_FILE = EsFile(
    "ES system log data file",
    subtypes.SUBTYPE_ES_SYSLOG,
    "/ram/cfe_es_syslog.log",
    FileEvent(ev.SYSLOG2_EID, "{path} written:Size={size},Entries={entries}"),
    FileEvent(ev.SYSLOG2_ERR_EID, "Error parsing file name RC = 0x{code:08X}"),
    FileEvent(ev.SYSLOG2_ERR_EID, "Error creating file {path}, RC = {status}"),
    _COUNT_ERROR,
    _COUNT_ERROR,
)
CDS_REGISTRY_FILE = EsFile(
    "CDS_Registry",
    subtypes.SUBTYPE_ES_CDS_REG,
    "/ram/cfe_cds_reg.log",
    FileEvent(ev.CDS_REG_DUMP_INF_EID, "Successfully dumped CDS Registry to '{path}':Size={size},Entries={entries}"),
    FileEvent(ev.CREATING_CDS_DUMP_ERR_EID, "Error parsing CDS dump filename, Status=0x{code:08X}"),
    FileEvent(ev.CREATING_CDS_DUMP_ERR_EID, "Error creating CDS dump file '{path}', Status={status}"),
    FileEvent(ev.WRITE_CFE_HDR_ERR_EID, "Error writing cFE File Header to '{path}', Status=0x{code:08X}"),
    FileEvent(ev.CDS_DUMP_ERR_EID, "Error writing CDS Registry to '{path}', Status={status}"),
)


def write_dump(es: EsCore, replies: Replies, kind: EsFile, name: str, records: Iterable[bytes]) -> None:
    """Write a file for a command, and reply to the command.

    Args:
        es: the services to use.
        replies: the replies to commands.
        kind: the kind of file.
        name: the name in the command; empty for the default.
        records: the records after the header.
    """
    dump = _Dump(es, kind)
    try:
        dump.write(name, records)
    except CfeError as error:
        failure = dump.trouble
        text = failure.text.format(path=dump.path, size=dump.block, status=error.status, code=error.status & 0xFFFFFFFF)
        replies.reject(failure.event_id, text)
        return
    text = kind.written.text.format(path=dump.path, size=dump.size, entries=dump.entries)
    replies.accept(kind.written.event_id, text, ev.DEBUG)


class _Dump:
    """The writing of a file; `trouble` is the event of a failure at the current step."""

    def __init__(self, es: EsCore, kind: EsFile) -> None:
        self._es = es
        self._kind = kind
        self.trouble = kind.bad_name
        self.path = ""
        self.block = self.size = HEADER_SIZE
        self.entries = 0

    def write(self, name: str, records: Iterable[bytes]) -> None:
        osal = self._es.osal
        self.path = dump_file_name(name, self._kind.default_name)
        self.trouble = self._kind.no_file
        filedes = osal.open_create(self.path, OS_FILE_FLAG_CREATE | OS_FILE_FLAG_TRUNCATE, OS_WRITE_ONLY)
        try:
            self._fill(filedes, records)
        finally:
            osal.close(filedes)

    def _fill(self, filedes: int, records: Iterable[bytes]) -> None:
        self.trouble = self._kind.no_header
        self._es.ports.fs.write_whole_header(filedes, init_header(self._kind.description, self._kind.subtype))
        self.trouble = self._kind.no_record
        for record in records:
            self.block = len(record)
            self.size += self._es.osal.write_whole(filedes, record)
            self.entries += 1
