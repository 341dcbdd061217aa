"""CFE_ES_*CDS*: the Critical Data Store for C. The functions for names and ids of blocks are in `es`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.es import DamagedData
from cfepy.extra.c.api.es import refuse
from cfepy.extra.c.api.pointers import need
from cfepy.status import CFE_ES_BAD_ARGUMENT

if TYPE_CHECKING:
    from cfepy.extra.c.calls import Declarations
    from cfepy.extra.c.runtime import CRuntime

BAD = CFE_ES_BAD_ARGUMENT


def declare(api: Declarations, c: CRuntime) -> None:
    """Add the functions. CFE_ES_DeleteCDS is not in cfe_es.h: it is an internal function of the core."""
    es, memory = c.handle.es, c.memory

    def register(out: int, size: int, name: str | None) -> int:
        if not out or name is None:
            refuse(c, "CFE_ES_RegisterCDS: Failed invalid arguments")
        memory.put_u32(out, 0)
        handle = es.register_cds(size, name)
        memory.put_u32(out, handle)
        return handle.status

    def copy(handle: int, data: int) -> None:
        need(BAD, data)
        block = next((each for each in c.cfe.es.cds_blocks() if each.handle == handle), None)
        es.copy_to_cds(handle, b"" if block is None else memory.peek(data, block.user_size))

    def restore(to: int, handle: int) -> None:
        need(BAD, to)
        try:
            memory.poke(to, es.restore_from_cds(handle))
        except DamagedData as error:
            memory.poke(to, error.data)
            raise

    api.add("CFE_ES_RegisterCDS", "pQs", register)
    api.add("CFE_ES_CopyToCDS", "Ip", copy)
    api.add("CFE_ES_RestoreFromCDS", "pI", restore)
    api.add("CFE_ES_DeleteCDS", "Sb", es.delete_cds, BAD)
