"""VX_PIPE, pipes with select() as VxWorks has them: a device's list of waiting tasks is guarded by one semaphore.

A writer takes it to see whether somebody waits in select(), a reader to put itself into that list. VxWorks makes such a
semaphore with priority inheritance when it is asked to; on Pathfinder it was not.

Taking and giving are those of an OSAL binary semaphore, which never inherits, or of an OSAL mutex, which always does:
which one is decided where the library is initialised, as the global option of VxWorks decided it on the lander.
"""

from __future__ import annotations

from cfepy.app import Cfe, CfeError

SEMAPHORE = "SELECT"
ENTERING_US = 1000  # to go through the list of waiting tasks, and to put one into it


def VX_PipeLibInit(cfe: Cfe) -> int:
    """Create the semaphore as it flew, without priority inheritance."""
    cfe.os.bin_sem_create(SEMAPHORE, 1)
    return 0


def VX_PipeLibInitSafe(cfe: Cfe) -> int:
    """Create the semaphore as it was mended (SEM_INVERSION_SAFE): its holder inherits the priority of its waiters."""
    cfe.os.mut_sem_create(SEMAPHORE)
    return 0


def VX_PipeWrite(cfe: Cfe, packet: bytes) -> None:
    """Send a packet through a pipe, to the task that waits for it in select().

    Args:
        cfe: the handle of the calling application.
        packet: a packet of the Software Bus.
    """
    _take(cfe)
    cfe.sb.transmit_msg(packet)
    _give(cfe)


def VX_Select(cfe: Cfe, pipe: int) -> bytes:
    """Wait for a packet in a pipe, and receive it.

    Args:
        cfe: the handle of the calling application.
        pipe: the id of its pipe.
    """
    _take(cfe)
    cfe.psp.compute(ENTERING_US)
    _give(cfe)
    return cfe.sb.receive_buffer(pipe)


def _take(cfe: Cfe) -> None:
    try:
        cfe.os.bin_sem_take(cfe.os.bin_sem_get_id_by_name(SEMAPHORE))
    except CfeError:
        cfe.os.mut_sem_take(cfe.os.mut_sem_get_id_by_name(SEMAPHORE))


def _give(cfe: Cfe) -> None:
    try:
        cfe.os.bin_sem_give(cfe.os.bin_sem_get_id_by_name(SEMAPHORE))
    except CfeError:
        cfe.os.mut_sem_give(cfe.os.mut_sem_get_id_by_name(SEMAPHORE))
