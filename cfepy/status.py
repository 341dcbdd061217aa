"""Status codes of cFE, OSAL and PSP under NASA's names, and the exceptions that carry them.

The numbers come from cfe_error.h, cfe_psp_error.h and osapi-error.h, as the signed 32-bit integers that NASA's code
prints. A call that returns an error code in C raises `CfeError` here. Event ids are not status codes: each service
keeps its own.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from cfepy.writing.escapes import visible, visible_line

MOST_TOLD = 20
"""The most errors of one file that a text for the user lists."""


def _signed(status: int) -> int:
    return status - (1 << 32) if status & 0x80000000 else status


# OSAL (osapi-error.h)
OS_SUCCESS = 0
OS_ERROR = -1
OS_INVALID_POINTER = -2
OS_ERROR_ADDRESS_MISALIGNED = -3
OS_ERROR_TIMEOUT = -4
OS_INVALID_INT_NUM = -5
OS_SEM_FAILURE = -6
OS_SEM_TIMEOUT = -7
OS_QUEUE_EMPTY = -8
OS_QUEUE_FULL = -9
OS_QUEUE_TIMEOUT = -10
OS_QUEUE_INVALID_SIZE = -11
OS_QUEUE_ID_ERROR = -12
OS_ERR_NAME_TOO_LONG = -13
OS_ERR_NO_FREE_IDS = -14
OS_ERR_NAME_TAKEN = -15
OS_ERR_INVALID_ID = -16
OS_ERR_NAME_NOT_FOUND = -17
OS_ERR_SEM_NOT_FULL = -18
OS_ERR_INVALID_PRIORITY = -19
OS_INVALID_SEM_VALUE = -20
OS_ERR_FILE = -27
OS_ERR_NOT_IMPLEMENTED = -28
OS_TIMER_ERR_INVALID_ARGS = -29
OS_TIMER_ERR_TIMER_ID = -30
OS_TIMER_ERR_UNAVAILABLE = -31
OS_TIMER_ERR_INTERNAL = -32
OS_ERR_OBJECT_IN_USE = -33
OS_ERR_BAD_ADDRESS = -34
OS_ERR_INCORRECT_OBJ_STATE = -35
OS_ERR_INCORRECT_OBJ_TYPE = -36
OS_ERR_STREAM_DISCONNECTED = -37
OS_ERR_OPERATION_NOT_SUPPORTED = -38
OS_ERR_INVALID_SIZE = -40
OS_ERR_OUTPUT_TOO_LARGE = -41
OS_ERR_INVALID_ARGUMENT = -42
OS_ERR_TRY_AGAIN = -43
OS_ERR_EMPTY_SET = -44
OS_FS_ERR_PATH_TOO_LONG = -103
OS_FS_ERR_NAME_TOO_LONG = -104
OS_FS_ERR_DRIVE_NOT_CREATED = -106
OS_FS_ERR_DEVICE_NOT_FREE = -107
OS_FS_ERR_PATH_INVALID = -108

# PSP (cfe_psp_error.h)
CFE_PSP_SUCCESS = 0
CFE_PSP_ERROR = -1
CFE_PSP_INVALID_POINTER = -2
CFE_PSP_ERROR_ADDRESS_MISALIGNED = -3
CFE_PSP_ERROR_TIMEOUT = -4
CFE_PSP_INVALID_INT_NUM = -5
CFE_PSP_INVALID_MEM_ADDR = -21
CFE_PSP_INVALID_MEM_TYPE = -22
CFE_PSP_INVALID_MEM_RANGE = -23
CFE_PSP_INVALID_MEM_WORDSIZE = -24
CFE_PSP_INVALID_MEM_SIZE = -25
CFE_PSP_INVALID_MEM_ATTR = -26
CFE_PSP_ERROR_NOT_IMPLEMENTED = -27
CFE_PSP_INVALID_MODULE_NAME = -28
CFE_PSP_INVALID_MODULE_ID = -29
CFE_PSP_NO_EXCEPTION_DATA = -30

# Generic cFE codes
CFE_SUCCESS = 0
CFE_STATUS_NO_COUNTER_INCREMENT = 0x48000001
CFE_STATUS_WRONG_MSG_LENGTH = _signed(0xC8000002)
CFE_STATUS_UNKNOWN_MSG_ID = _signed(0xC8000003)
CFE_STATUS_BAD_COMMAND_CODE = _signed(0xC8000004)
CFE_STATUS_EXTERNAL_RESOURCE_FAIL = _signed(0xC8000005)
CFE_STATUS_REQUEST_ALREADY_PENDING = _signed(0xC8000006)
CFE_STATUS_VALIDATION_FAILURE = _signed(0xC8000007)
CFE_STATUS_RANGE_ERROR = _signed(0xC8000008)
CFE_STATUS_INCORRECT_STATE = _signed(0xC8000009)
CFE_STATUS_NOT_IMPLEMENTED = _signed(0xC800FFFF)

# Executive Services
CFE_ES_ERR_RESOURCEID_NOT_VALID = _signed(0xC4000001)
CFE_ES_ERR_NAME_NOT_FOUND = _signed(0xC4000002)
CFE_ES_ERR_APP_CREATE = _signed(0xC4000004)
CFE_ES_ERR_CHILD_TASK_CREATE = _signed(0xC4000005)
CFE_ES_ERR_SYS_LOG_FULL = _signed(0xC4000006)
CFE_ES_ERR_MEM_BLOCK_SIZE = _signed(0xC4000008)
CFE_ES_ERR_LOAD_LIB = _signed(0xC4000009)
CFE_ES_BAD_ARGUMENT = _signed(0xC400000A)
CFE_ES_ERR_CHILD_TASK_REGISTER = _signed(0xC400000B)
CFE_ES_CDS_ALREADY_EXISTS = 0x4400000D
CFE_ES_CDS_INSUFFICIENT_MEMORY = _signed(0xC400000E)
CFE_ES_CDS_INVALID_NAME = _signed(0xC400000F)
CFE_ES_CDS_INVALID_SIZE = _signed(0xC4000010)
CFE_ES_CDS_INVALID = _signed(0xC4000012)
CFE_ES_CDS_ACCESS_ERROR = _signed(0xC4000013)
CFE_ES_FILE_IO_ERR = _signed(0xC4000014)
CFE_ES_RST_ACCESS_ERR = _signed(0xC4000015)
CFE_ES_ERR_APP_REGISTER = _signed(0xC4000017)
CFE_ES_ERR_CHILD_TASK_DELETE = _signed(0xC4000018)
CFE_ES_ERR_CHILD_TASK_DELETE_MAIN_TASK = _signed(0xC4000019)
CFE_ES_CDS_BLOCK_CRC_ERR = _signed(0xC400001A)
CFE_ES_MUT_SEM_DELETE_ERR = _signed(0xC400001B)
CFE_ES_BIN_SEM_DELETE_ERR = _signed(0xC400001C)
CFE_ES_COUNT_SEM_DELETE_ERR = _signed(0xC400001D)
CFE_ES_QUEUE_DELETE_ERR = _signed(0xC400001E)
CFE_ES_FILE_CLOSE_ERR = _signed(0xC400001F)
CFE_ES_CDS_WRONG_TYPE_ERR = _signed(0xC4000020)
CFE_ES_CDS_OWNER_ACTIVE_ERR = _signed(0xC4000022)
CFE_ES_APP_CLEANUP_ERR = _signed(0xC4000023)
CFE_ES_TIMER_DELETE_ERR = _signed(0xC4000024)
CFE_ES_BUFFER_NOT_IN_POOL = _signed(0xC4000025)
CFE_ES_TASK_DELETE_ERR = _signed(0xC4000026)
CFE_ES_OPERATION_TIMED_OUT = _signed(0xC4000027)
CFE_ES_LIB_ALREADY_LOADED = 0x44000028
CFE_ES_ERR_SYS_LOG_TRUNCATED = 0x44000029
CFE_ES_NO_RESOURCE_IDS_AVAILABLE = _signed(0xC400002B)
CFE_ES_POOL_BLOCK_INVALID = _signed(0xC400002C)
CFE_ES_ERR_DUPLICATE_NAME = _signed(0xC400002E)
CFE_ES_NOT_IMPLEMENTED = _signed(0xC400FFFF)

# Event Services
CFE_EVS_UNKNOWN_FILTER = _signed(0xC2000001)
CFE_EVS_APP_NOT_REGISTERED = _signed(0xC2000002)
CFE_EVS_APP_ILLEGAL_APP_ID = _signed(0xC2000003)
CFE_EVS_APP_FILTER_OVERLOAD = _signed(0xC2000004)
CFE_EVS_RESET_AREA_POINTER = _signed(0xC2000005)
CFE_EVS_EVT_NOT_REGISTERED = _signed(0xC2000006)
CFE_EVS_FILE_WRITE_ERROR = _signed(0xC2000007)
CFE_EVS_INVALID_PARAMETER = _signed(0xC2000008)
CFE_EVS_APP_SQUELCHED = _signed(0xC2000009)
CFE_EVS_NOT_IMPLEMENTED = _signed(0xC200FFFF)

# File Services
CFE_FS_BAD_ARGUMENT = _signed(0xC6000001)
CFE_FS_INVALID_PATH = _signed(0xC6000002)
CFE_FS_FNAME_TOO_LONG = _signed(0xC6000003)
CFE_FS_NOT_IMPLEMENTED = _signed(0xC600FFFF)

# Software Bus
CFE_SB_TIME_OUT = _signed(0xCA000001)
CFE_SB_NO_MESSAGE = _signed(0xCA000002)
CFE_SB_BAD_ARGUMENT = _signed(0xCA000003)
CFE_SB_MAX_PIPES_MET = _signed(0xCA000004)
CFE_SB_PIPE_CR_ERR = _signed(0xCA000005)
CFE_SB_PIPE_RD_ERR = _signed(0xCA000006)
CFE_SB_MSG_TOO_BIG = _signed(0xCA000007)
CFE_SB_BUF_ALOC_ERR = _signed(0xCA000008)
CFE_SB_MAX_MSGS_MET = _signed(0xCA000009)
CFE_SB_MAX_DESTS_MET = _signed(0xCA00000A)
CFE_SB_INTERNAL_ERR = _signed(0xCA00000C)
CFE_SB_WRONG_MSG_TYPE = _signed(0xCA00000D)
CFE_SB_BUFFER_INVALID = _signed(0xCA00000E)
CFE_SB_NOT_IMPLEMENTED = _signed(0xCA00FFFF)

# Message module (numbers shared with the Software Bus)
CFE_MSG_BAD_ARGUMENT = _signed(0xCA000003)
CFE_MSG_WRONG_MSG_TYPE = _signed(0xCA00000D)
CFE_MSG_NOT_IMPLEMENTED = _signed(0xCA00FFFF)

# Table Services
CFE_TBL_ERR_INVALID_HANDLE = _signed(0xCC000001)
CFE_TBL_ERR_INVALID_NAME = _signed(0xCC000002)
CFE_TBL_ERR_INVALID_SIZE = _signed(0xCC000003)
CFE_TBL_INFO_UPDATE_PENDING = 0x4C000004
CFE_TBL_ERR_NEVER_LOADED = _signed(0xCC000005)
CFE_TBL_ERR_REGISTRY_FULL = _signed(0xCC000006)
CFE_TBL_WARN_DUPLICATE = 0x4C000007
CFE_TBL_ERR_NO_ACCESS = _signed(0xCC000008)
CFE_TBL_ERR_UNREGISTERED = _signed(0xCC000009)
CFE_TBL_ERR_HANDLES_FULL = _signed(0xCC00000B)
CFE_TBL_ERR_DUPLICATE_DIFF_SIZE = _signed(0xCC00000C)
CFE_TBL_ERR_DUPLICATE_NOT_OWNED = _signed(0xCC00000D)
CFE_TBL_INFO_UPDATED = 0x4C00000E
CFE_TBL_ERR_NO_BUFFER_AVAIL = _signed(0xCC00000F)
CFE_TBL_ERR_DUMP_ONLY = _signed(0xCC000010)
CFE_TBL_ERR_ILLEGAL_SRC_TYPE = _signed(0xCC000011)
CFE_TBL_ERR_LOAD_IN_PROGRESS = _signed(0xCC000012)
CFE_TBL_ERR_FILE_TOO_LARGE = _signed(0xCC000014)
CFE_TBL_WARN_SHORT_FILE = 0x4C000015
CFE_TBL_ERR_BAD_CONTENT_ID = _signed(0xCC000016)
CFE_TBL_INFO_NO_UPDATE_PENDING = 0x4C000017
CFE_TBL_INFO_TABLE_LOCKED = 0x4C000018
CFE_TBL_INFO_VALIDATION_PENDING = 0x4C000019
CFE_TBL_INFO_NO_VALIDATION_PENDING = 0x4C00001A
CFE_TBL_ERR_BAD_SUBTYPE_ID = _signed(0xCC00001B)
CFE_TBL_ERR_FILE_SIZE_INCONSISTENT = _signed(0xCC00001C)
CFE_TBL_ERR_NO_STD_HEADER = _signed(0xCC00001D)
CFE_TBL_ERR_NO_TBL_HEADER = _signed(0xCC00001E)
CFE_TBL_ERR_FILENAME_TOO_LONG = _signed(0xCC00001F)
CFE_TBL_ERR_FILE_FOR_WRONG_TABLE = _signed(0xCC000020)
CFE_TBL_ERR_LOAD_INCOMPLETE = _signed(0xCC000021)
CFE_TBL_WARN_PARTIAL_LOAD = 0x4C000022
CFE_TBL_ERR_PARTIAL_LOAD = _signed(0xCC000023)
CFE_TBL_INFO_DUMP_PENDING = 0x4C000024
CFE_TBL_ERR_INVALID_OPTIONS = _signed(0xCC000025)
CFE_TBL_WARN_NOT_CRITICAL = 0x4C000026
CFE_TBL_INFO_RECOVERED_TBL = 0x4C000027
CFE_TBL_ERR_BAD_SPACECRAFT_ID = _signed(0xCC000028)
CFE_TBL_ERR_BAD_PROCESSOR_ID = _signed(0xCC000029)
CFE_TBL_MESSAGE_ERROR = _signed(0xCC00002A)
CFE_TBL_ERR_SHORT_FILE = _signed(0xCC00002B)
CFE_TBL_ERR_ACCESS = _signed(0xCC00002C)
CFE_TBL_BAD_ARGUMENT = _signed(0xCC00002D)
CFE_TBL_INFO_NO_DUMP_PENDING = 0x4C00002E
CFE_TBL_NOT_IMPLEMENTED = _signed(0xCC00FFFF)

# Time Services
CFE_TIME_INTERNAL_ONLY = _signed(0xCE000001)
CFE_TIME_OUT_OF_RANGE = _signed(0xCE000002)
CFE_TIME_TOO_MANY_SYNCH_CALLBACKS = _signed(0xCE000003)
CFE_TIME_CALLBACK_NOT_REGISTERED = _signed(0xCE000004)
CFE_TIME_BAD_ARGUMENT = _signed(0xCE000005)
CFE_TIME_NOT_IMPLEMENTED = _signed(0xCE00FFFF)
CFE_SEVERITY_BITMASK = 0xC0000000
CFE_SEVERITY_SUCCESS = 0x00000000
CFE_SEVERITY_INFO = 0x40000000
CFE_SEVERITY_ERROR = 0xC0000000
CFE_SERVICE_BITMASK = 0x0E000000

_LOWEST_SMALL_STATUS = -0x10000
_SERVICES = {1: "EVS", 2: "ES", 3: "FS", 4: "GENERIC", 5: "SB", 6: "TBL", 7: "TIME"}


def _names() -> dict[int, str]:
    """Return the name of each number. If PSP or MSG share a number with OSAL or SB, the name of OSAL or SB wins, as in
    NASA's logs.
    """
    found: dict[int, str] = {}
    for name, value in globals().items():
        if name.isupper() and name.startswith(("OS_", "CFE_")) and not name.startswith(("CFE_SEV", "CFE_SERVICE")):
            found.setdefault(value, name)
    found[CFE_SUCCESS] = "CFE_SUCCESS"
    return found


_NAMES = _names()


def to_signed(status: int) -> int:
    """Return a 32-bit number as a C int, from its signed or unsigned form (0xCA000003 and -905969661 are the same)."""
    return _signed(status & 0xFFFFFFFF)


def name_of(status: int) -> str:
    """Return NASA's name of a status, signed or unsigned; "UNKNOWN_STATUS" for an unknown one."""
    return _NAMES.get(to_signed(status), "UNKNOWN_STATUS")


def status_to_string(status: int) -> str:
    """Return a status as eight hexadecimal digits, e.g. "0xca000003" (CFE_ES_StatusToString)."""
    return f"0x{status & 0xFFFFFFFF:08x}"


def status_to_decimal(status: int) -> str:
    """Return a status as a signed decimal number, e.g. "-35" (OS_StatusToString, CFE_PSP_StatusToString)."""
    return str(to_signed(status))


def severity_of(status: int) -> int:
    """Return CFE_SEVERITY_SUCCESS, _INFO or _ERROR; small negative codes of OSAL and PSP are errors too."""
    return status & CFE_SEVERITY_BITMASK


def service_of(status: int) -> str:
    """Return the service that a status belongs to: "ES", "EVS", "FS", "GENERIC", "SB", "TBL", "TIME", or "OSAL"."""
    if _LOWEST_SMALL_STATUS < to_signed(status) <= 0:
        return "OSAL"
    return _SERVICES.get((status & CFE_SERVICE_BITMASK) >> 25, "UNKNOWN")


class CfeError(Exception):
    """Exception for a failed cFE call.

    Args:
        status: the code that NASA's function would return, signed or unsigned.
        text: a description of the error.
    """

    def __init__(self, status: int, text: str = "") -> None:
        super().__init__(status, text)
        self.status = to_signed(status)
        self.text = text

    @property
    def name(self) -> str:
        """NASA's name of the status."""
        return name_of(self.status)

    @property
    def hex(self) -> str:
        """The status as NASA's texts print it, such as "0xCA000003"."""
        return f"0x{self.status & 0xFFFFFFFF:08X}"

    @property
    def long_hex(self) -> str:
        """The status as a C unsigned long, as lab and sample apps print it, such as "0xFFFFFFFFCA000003"."""
        return f"0x{self.status & 0xFFFFFFFFFFFFFFFF:08X}"

    def __str__(self) -> str:
        small = _LOWEST_SMALL_STATUS < self.status <= 0
        number = str(self.status) if small else self.hex
        return f"{self.name} ({number}): {self.text}" if self.text else f"{self.name} ({number})"


class OsalError(CfeError):
    """Exception for a failed OSAL or PSP call; `status` is an OS_* (or CFE_PSP_*) code."""


class UsageError(ValueError):
    """Exception for an error in a mission, board, table or script file, or in an argument of the user.

    Args:
        text: what is wrong, and how to fix it.
        file: path of the file with the error.
        line: line number in that file, counted from 1.
        field: the field with the error, e.g. "limits.sb_max_pipes".
        others: further errors, found at the same time.

    `str()` gives the text for the user, with control characters escaped: a line for each error, at most `MOST_TOLD`.
    """

    def __init__(
        self,
        text: str,
        *,
        file: object | None = None,
        line: int | None = None,
        field: str | None = None,
        others: Iterable[UsageError] = (),
    ) -> None:
        super().__init__(text)
        self.text = text
        self.file = None if file is None else str(file)
        self.line = line
        self.field = field
        self.others = tuple(others)

    @property
    def each(self) -> tuple[UsageError, ...]:
        """This error, and the further ones."""
        return (self, *self.others)

    def __str__(self) -> str:
        lines = [each.alone for each in self.each]
        if len(lines) > MOST_TOLD:
            lines[MOST_TOLD:] = [f"and {len(lines) - MOST_TOLD} more"]
        return "\n".join(lines)

    @property
    def alone(self) -> str:
        """The text for the user, without further errors."""
        place = ":".join(visible_line(part) for part in (self.file, self.line) if part is not None)
        field = "" if self.field is None else visible_line(self.field)
        return ": ".join(part for part in (place, field, visible(self.text)) if part)


def together(errors: Sequence[UsageError]) -> UsageError:
    """Return one error for several mistakes: the first one with the others in it.

    Args:
        errors: the mistakes, at least one. In each file they are sorted by line.
    """
    apart = [each for error in errors for each in alone(error)]
    if len(apart) == 1:
        return apart[0]
    files = list(dict.fromkeys(each.file for each in apart))
    first, *others = sorted(apart, key=lambda each: (files.index(each.file), each.line or 0))
    return _with_others(first, tuple(others))


def alone(error: UsageError) -> tuple[UsageError, ...]:
    """Return an error and its further ones, each without the others."""
    if not error.others:
        return (error,)
    return (_with_others(error, ()), *error.others)


def _with_others(error: UsageError, others: tuple[UsageError, ...]) -> UsageError:
    """Return a copy of an error with other further ones.

    `copy.copy` is not used: libraries such as tblib, which Dask loads, change it for exceptions.
    """
    found = type(error).__new__(type(error), *error.args)
    found.__dict__.update(error.__dict__)
    found.others = others
    return found


def placed(error: UsageError, *, file: object | None = None, line: int | None = None) -> UsageError:
    """Return an error, and its further ones, with a place in a file.

    Args:
        error: the error; its own file and lines are replaced.
        file: the file.
        line: the line, from 1.
    """
    return together([UsageError(each.text, file=file, line=line, field=each.field) for each in error.each])


class StallError(RuntimeError):
    """Exception for a run that was ended because a task did not give up the CPU. Its text has the user's own lines.

    Args:
        summary: one line with the task, since when it has the CPU, and how long the watchdog waited.
        lines: where the task was; the innermost of the user's own lines comes first.
        app: the application of the task; empty if the task belongs to none.
        task: its name.
        place: where the task spins, such as "spin.py:4"; empty if unknown.
        at_ns: virtual time at which it got the CPU, in ns.
    """

    def __init__(
        self,
        summary: str,
        lines: tuple[str, ...] = (),
        *,
        app: str = "",
        task: str = "",
        place: str = "",
        at_ns: int = 0,
    ) -> None:
        super().__init__(summary)
        self.summary = summary
        self.lines = lines
        self.app = app
        self.task = task
        self.place = place
        self.at_ns = at_ns

    def __str__(self) -> str:
        return visible("\n".join([self.summary, *(f"  {line}" for line in self.lines)]))
