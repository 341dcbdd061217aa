"""`Cfe`: the one argument of an app's main function, through which it reaches every service.

    def HK_AppMain(cfe: Cfe) -> None: ...

Names are NASA's in snake case without the prefix: CFE_SB_CreatePipe is `cfe.sb.create_pipe`, OS_TaskDelay is
`cfe.os.task_delay`. A failed call raises CfeError with NASA's status; "no message" and "timed out" are None. Which app
calls is found from the running task, so all apps of a mission share one handle.
"""

from __future__ import annotations

from dataclasses import dataclass
from types import ModuleType

from cfepy import msg
from cfepy.config.config_api import ConfigServices
from cfepy.es import ExecutiveServices
from cfepy.evs import EventServices
from cfepy.fs import FileServices
from cfepy.osal import Osal
from cfepy.psp import Psp
from cfepy.sb import SoftwareBus
from cfepy.status import CfeError
from cfepy.tbl import TableServices
from cfepy.time import TimeServices


@dataclass(frozen=True, slots=True, eq=False)
class Cfe:
    """The services of one mission: `es`, `sb`, `evs`, `time`, `tbl`, `fs`, `config`; below them `os` and `psp`.

    `msg` is the module `cfepy.msg` (packet headers).
    """

    es: ExecutiveServices
    sb: SoftwareBus
    evs: EventServices
    time: TimeServices
    tbl: TableServices
    os: Osal
    psp: Psp
    fs: FileServices
    config: ConfigServices
    msg: ModuleType = msg


__all__ = ["Cfe", "CfeError"]
