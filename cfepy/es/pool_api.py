"""Memory pools for applications (cfe_es_mempool.c, CFE_ES_Pool*).

A pool allocates its bytes, which count in the board's memory, or uses a buffer of the caller, as in C.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeVar

from cfepy.es.pools import (
    ALIGNMENT,
    BUCKETS,
    MAX_BUCKETS,
    MemPool,
    PoolBlock,
    PoolMemory,
    fresh_memory,
    min_size,
)
from cfepy.es.tables import EsCore
from cfepy.status import (
    CFE_ES_BAD_ARGUMENT,
    CFE_ES_ERR_RESOURCEID_NOT_VALID,
    CFE_ES_NO_RESOURCE_IDS_AVAILABLE,
    CFE_ES_POOL_BLOCK_INVALID,
    CFE_STATUS_EXTERNAL_RESOURCE_FAIL,
    CfeError,
    OsalError,
)

_ULONG_MAX = (1 << 64) - 1
NO_CLAIM = 0
"""The token for no claim; the memory budget never returns this number."""

_Result = TypeVar("_Result")


class PoolApi(EsCore):
    """The CFE_ES_Pool* part of Executive Services.

    Attributes:
        core_memory: allocates the bytes of pools of the core; with compiled applications, where these can reach them.
    """

    core_memory: Callable[[int], memoryview] = staticmethod(fresh_memory)

    def pool_create(self, size: int, owner: str = "", memory: PoolMemory | None = None) -> int:
        """Make a memory pool of the usual block sizes, protected by a mutex (CFE_ES_PoolCreate).

        Args:
            size: bytes.
            owner: owner in the memory accounting, if no application calls.
            memory: as in `pool_create_ex_with_alignment`.

        Returns:
            The pool's handle.

        Raises:
            CfeError: see `pool_create_ex_with_alignment`.
        """
        return self.pool_create_ex_with_alignment(size, owner=owner, memory=memory)

    def pool_create_no_sem(self, size: int, memory: PoolMemory | None = None) -> int:
        """Make a memory pool without a mutex; see `pool_create` (CFE_ES_PoolCreateNoSem)."""
        return self.pool_create_ex_with_alignment(size, use_mutex=False, memory=memory)

    def pool_create_ex(
        self,
        size: int,
        block_sizes: Sequence[int] | None = None,
        use_mutex: bool = True,
        memory: PoolMemory | None = None,
    ) -> int:
        """Make a memory pool with given block sizes (CFE_ES_PoolCreateEx); see `pool_create_ex_with_alignment`."""
        return self.pool_create_ex_with_alignment(size, block_sizes, use_mutex, memory=memory)

    def pool_create_ex_with_alignment(
        self,
        size: int,
        block_sizes: Sequence[int] | None = None,
        use_mutex: bool = True,
        alignment: int = ALIGNMENT,
        owner: str = "",
        memory: PoolMemory | None = None,
    ) -> int:
        """Make a memory pool for the calling application (CFE_ES_PoolCreateEx_WithAlignment).

        Args:
            size: bytes.
            block_sizes: 1 to 17 block sizes in bytes; None for cFE's own.
            use_mutex: whether a mutex protects the pool.
            alignment: alignment of blocks in bytes, a power of 2 and at least 4.
            owner: owner in the memory accounting, if no application calls.
            memory: a writable buffer of the caller, as in C, whose first `size` bytes become the pool. It is not
                accounted for again, because its owner already is. None allocates new bytes and accounts for them.

        Returns:
            The pool's handle.

        Raises:
            CfeError: CFE_ES_BAD_ARGUMENT (size, number of block sizes, alignment, memory), CFE_ES_ERR_MEM_BLOCK_SIZE (a
                block size of 0), CFE_ES_NO_RESOURCE_IDS_AVAILABLE, CFE_STATUS_EXTERNAL_RESOURCE_FAIL (no room on the
                board, no mutex).
        """
        sizes = BUCKETS if block_sizes is None else block_sizes
        self._check_sizes(size, sizes)
        app = self.app_of_caller()
        name = app.name if app is not None else owner or self.kernel.current.name
        if len(self.pools) >= self.pools.capacity:
            self.write_to_sys_log("CFE_ES_PoolCreateEx_WithAlignment: No free MemPool slots available")
            raise CfeError(
                CFE_ES_NO_RESOURCE_IDS_AVAILABLE, f"the limit of {self.pools.capacity} memory pools is reached"
            )
        claim = self.ports.memory.claim(name, "memory pool", size) if memory is None else NO_CLAIM
        if memory is None and owner:
            memory = self.core_memory(size)
        try:
            pool = self._make(name, size, sizes, alignment, memory)
            pool_id = self.pools.create(pool)
            self._add_mutex(pool_id, pool, use_mutex)
        except CfeError:
            self.ports.memory.release(claim)
            raise
        self.pool_owners[pool_id] = (app, claim)
        return pool_id

    def _make(self, name: str, size: int, sizes: Sequence[int], alignment: int, memory: PoolMemory | None) -> MemPool:
        try:
            return MemPool(name, size, sizes, alignment, self.write_to_sys_log, memory)
        except CfeError:
            self.pools.skip()  # NASA's code has used the id by then
            raise

    def _check_sizes(self, size: int, sizes: Sequence[int]) -> None:
        log = "CFE_ES_PoolCreateEx_WithAlignment: "
        if len(sizes) > MAX_BUCKETS:
            text = f"Num Block Sizes ({len(sizes)}) greater than max ({MAX_BUCKETS})"
        elif size < min_size(sizes, 1):
            text = f"Pool size({size}) too small, need >={min_size(sizes, 1)} bytes"
        else:
            return
        self.write_to_sys_log(log + text)
        raise CfeError(CFE_ES_BAD_ARGUMENT, text)

    def _add_mutex(self, pool_id: int, pool: MemPool, use_mutex: bool) -> None:
        if not use_mutex:
            return
        try:
            pool.mutex_id = self.osal.mut_sem_create(f"Pool{pool_id:08X}")
        except OsalError as error:
            self.pools.delete(pool_id)
            self.write_to_sys_log(f"CFE_ES_PoolCreateEx_WithAlignment: OSAL error {error.status} while creating mutex")
            raise CfeError(CFE_STATUS_EXTERNAL_RESOURCE_FAIL, str(error)) from error

    def pool_delete(self, pool_id: int) -> None:
        """Delete a pool, even if its blocks are in use (CFE_ES_PoolDelete).

        Raises:
            CfeError: CFE_ES_ERR_RESOURCEID_NOT_VALID.
        """
        pool = self.pools.get(pool_id)
        self.pools.delete(pool_id)
        self.ports.memory.release(self.pool_owners.pop(pool_id)[1])
        if pool.mutex_id:
            try:
                self.osal.mut_sem_delete(pool.mutex_id)
            except OsalError as error:
                self.write_to_sys_log(f"CFE_ES_PoolDelete: Error {error.status} deleting mutex")

    def get_pool_buf(self, pool_id: int, size: int) -> PoolBlock:
        """Take a block from a pool (CFE_ES_GetPoolBuf).

        Args:
            pool_id: the pool's handle.
            size: bytes.

        Raises:
            CfeError: CFE_ES_ERR_RESOURCEID_NOT_VALID, CFE_ES_ERR_MEM_BLOCK_SIZE (too large, or no room left).
        """
        pool = self._pool_for(pool_id, "GetPoolBuf")
        return self._alone(pool, lambda: pool.get(size))

    def get_pool_buf_info(self, pool_id: int, block: PoolBlock) -> int:
        """Return the requested size of a block in bytes (CFE_ES_GetPoolBufInfo).

        Raises:
            CfeError: CFE_ES_ERR_RESOURCEID_NOT_VALID, CFE_ES_BUFFER_NOT_IN_POOL, CFE_ES_POOL_BLOCK_INVALID.
        """
        pool = self.pools.get(pool_id)
        return self._alone(pool, lambda: pool.size_of(block))

    def put_pool_buf(self, pool_id: int, block: PoolBlock) -> int:
        """Return a block to its pool (CFE_ES_PutPoolBuf).

        Returns:
            The block's size in bytes.

        Raises:
            CfeError: CFE_ES_ERR_RESOURCEID_NOT_VALID, CFE_ES_BUFFER_NOT_IN_POOL, CFE_ES_POOL_BLOCK_INVALID.
        """
        pool = self.pools.find(pool_id)
        if pool is None:
            self.write_to_sys_log(f"CFE_ES_PutPoolBuf: Err:Invalid Memory Handle (0x{pool_id:08X}).")
            raise CfeError(CFE_ES_ERR_RESOURCEID_NOT_VALID, f"invalid memory pool handle 0x{pool_id:x}")
        try:
            return self._alone(pool, lambda: pool.put(block))
        except CfeError as error:
            if error.status == CFE_ES_POOL_BLOCK_INVALID:
                text = f"Deallocating invalid or corrupt memory block @ 0x{block.address:08X}"
            else:
                text = f"Bad offset({block.offset & _ULONG_MAX}) outside pool boundary"
            self.write_to_sys_log(f"CFE_ES_PutPoolBuf: Err:{text}")
            raise

    def get_mem_pool_stats(self, pool_id: int) -> dict[str, object]:
        """Return the fields of CFE_ES_MemPoolStats_t (CFE_ES_GetMemPoolStats).

        Raises:
            CfeError: CFE_ES_ERR_RESOURCEID_NOT_VALID.
        """
        pool = self._pool_for(pool_id, "GetMemPoolStats")
        return self._alone(pool, pool.statistics)

    def _pool_for(self, pool_id: int, function: str) -> MemPool:
        pool = self.pools.find(pool_id)
        if pool is None:
            app = self.app_of_caller()
            who = app.app_id if app is not None else 0
            self.write_to_sys_log(f"CFE_ES_{function}: Err:Bad handle(0x{pool_id:08X}) AppId={who}")
            raise CfeError(CFE_ES_ERR_RESOURCEID_NOT_VALID, f"invalid memory pool handle 0x{pool_id:x}")
        return pool

    def _alone(self, pool: MemPool, call: Callable[[], _Result]) -> _Result:
        """Make a call while holding the mutex of the pool, if it has one."""
        if not pool.mutex_id:
            return call()
        self.osal.mut_sem_take(pool.mutex_id)
        try:
            return call()
        finally:
            self.osal.mut_sem_give(pool.mutex_id)
