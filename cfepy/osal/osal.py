"""`Osal`: the operating system abstraction layer as one object, `cfe.os`, put together from its parts.

Names are NASA's in snake case: OS_QueueCreate is `os.queue_create`. A failed call raises OsalError with NASA's OS_*
code; a time-out or an empty queue is None or False. May import cfepy.rtos and what is left of it.
"""

from __future__ import annotations

from cfepy.config import PlatformConfig
from cfepy.console import Console
from cfepy.osal.application import ApplicationApi
from cfepy.osal.core import Ledger, ObjectSizes, Setup
from cfepy.osal.disks import DiskApi
from cfepy.osal.filesystem import FileSystem
from cfepy.osal.idmap import IdMapApi
from cfepy.osal.network import Network
from cfepy.osal.shell import ShellApi
from cfepy.rtos import Kernel


class Osal(ShellApi, ApplicationApi, DiskApi, IdMapApi):
    """The whole interface; see the modules beside this one for its parts.

    Args:
        kernel: the simulated real-time kernel.
        config: limits (cfepy.config).
        console: where `printf` writes.
        files: the virtual file system; None makes one with an empty /cf and /ram.
        network: what sockets are plugged into; None makes one of its own.
        memory: accounts for stacks and objects, None does not count.
        sizes: what the operating system takes for each object, in bytes.
        call_ns: virtual CPU time that a call takes.
        byte_ps: virtual CPU time to copy a byte through a queue or file, in picoseconds.
        epoch_ns: local time at virtual time 0, in ns.
    """

    def __init__(
        self,
        kernel: Kernel,
        config: PlatformConfig | None = None,
        console: Console | None = None,
        *,
        files: FileSystem | None = None,
        network: Network | None = None,
        memory: Ledger | None = None,
        sizes: ObjectSizes | None = None,
        call_ns: int = 0,
        byte_ps: int = 0,
        epoch_ns: int = 0,
    ) -> None:
        super().__init__(
            Setup(
                kernel,
                config or PlatformConfig(),
                console or Console(),
                files or FileSystem(),
                network or Network(),
                memory,
                sizes or ObjectSizes(),
                call_ns,
                byte_ps,
                epoch_ns,
            )
        )
