/* CFE_ES_Pool*, CFE_ES_*PoolBuf*: on memory of the application's own. */
#include "api_test.h"

static union {
    long double alignment;
    uint8 bytes[4096];
} memory, other;

static long place(void *block) { return (long)((uint8 *)block - memory.bytes); }

static void create(void)
{
    CFE_ES_MemHandle_t pool = CFE_ES_MEMHANDLE_C(77);
    size_t sizes[18] = {64, 16, 32};
    size_t zeros[2] = {16, 0};
    TELL(CFE_ES_PoolCreate(NULL, memory.bytes, 1024));
    TELL(CFE_ES_PoolCreate(&pool, NULL, 1024));
    TELL(CFE_ES_PoolCreateNoSem(NULL, memory.bytes, 1024));
    TELL(CFE_ES_PoolCreateNoSem(&pool, memory.bytes, 3));
    SAY("untouched %lX", CFE_RESOURCEID_TO_ULONG(pool));
    TELL(CFE_ES_PoolCreateEx(&pool, memory.bytes, 1024, 18, sizes, true));
    TELL(CFE_ES_PoolCreateEx(&pool, memory.bytes, 1024, 18, NULL, true));
    SAY("untouched %lX", CFE_RESOURCEID_TO_ULONG(pool));
    TELL(CFE_ES_PoolCreateEx(&pool, memory.bytes, 1024, 0, sizes, false));
    SAY("none %lX", CFE_RESOURCEID_TO_ULONG(pool));
    pool = CFE_ES_MEMHANDLE_C(77);
    TELL(CFE_ES_PoolCreateEx(&pool, memory.bytes, 1024, 2, zeros, false));
    SAY("none %lX", CFE_RESOURCEID_TO_ULONG(pool));
    pool = CFE_ES_MEMHANDLE_C(77);
    TELL(CFE_ES_PoolCreateEx_WithAlignment(&pool, memory.bytes, 1024, 3, sizes, false, 12));
    SAY("none %lX", CFE_RESOURCEID_TO_ULONG(pool));
}

static void take(void)
{
    CFE_ES_MemHandle_t pool;
    CFE_ES_MemPoolBuf_t one = NULL, two = NULL, three = NULL;
    size_t sizes[3] = {64, 16, 32};
    memset(&memory, 0xEE, sizeof memory);
    TELL(CFE_ES_PoolCreateEx(&pool, memory.bytes, 512, 3, sizes, true));
    TELL(CFE_ES_GetPoolBuf(NULL, pool, 10));
    TELL(CFE_ES_GetPoolBuf(&one, CFE_ES_MEMHANDLE_UNDEFINED, 10));
    TELL(CFE_ES_GetPoolBuf(&one, pool, 65));
    SAY("nothing %d", one == NULL);
    TELL(CFE_ES_GetPoolBuf(&one, pool, 10));
    TELL(CFE_ES_GetPoolBuf(&two, pool, 33));
    SAY("at %ld and %ld, filled with %02X", place(one), place(two), ((uint8 *)two)[5]);
    TELL(CFE_ES_GetPoolBufInfo(pool, NULL));
    TELL(CFE_ES_GetPoolBufInfo(CFE_ES_MEMHANDLE_UNDEFINED, one));
    TELL(CFE_ES_GetPoolBufInfo(pool, one));
    TELL(CFE_ES_GetPoolBufInfo(pool, two));
    TELL(CFE_ES_GetPoolBufInfo(pool, (uint8 *)two + 4));
    TELL(CFE_ES_GetPoolBufInfo(pool, other.bytes));
    TELL(CFE_ES_PutPoolBuf(pool, NULL));
    TELL(CFE_ES_PutPoolBuf(CFE_ES_MEMHANDLE_UNDEFINED, one));
    TELL(CFE_ES_PutPoolBuf(pool, memory.bytes + 400));
    TELL(CFE_ES_PutPoolBuf(pool, one));
    TELL(CFE_ES_PutPoolBuf(pool, one) == CFE_ES_POOL_BLOCK_INVALID);
    TELL(CFE_ES_GetPoolBuf(&three, pool, 12));
    SAY("again %ld", place(three));
    for (int i = 0; i < 10; i++)
        TELL(CFE_ES_GetPoolBuf(&three, pool, 64));
    TELL(CFE_ES_PoolDelete(pool));
    TELL(CFE_ES_PoolDelete(pool));
    SAY("the memory stays: %02X %02X", memory.bytes[0], memory.bytes[500]);
}

static void count(void)
{
    CFE_ES_MemHandle_t pool;
    CFE_ES_MemPoolBuf_t block;
    CFE_ES_MemPoolStats_t stats;
    TELL(CFE_ES_PoolCreate(&pool, memory.bytes, sizeof memory));
    TELL(CFE_ES_GetPoolBuf(&block, pool, 100));
    TELL(CFE_ES_GetPoolBuf(&block, pool, 9));
    TELL(CFE_ES_PutPoolBuf(pool, block));
    memset((uint8 *)block - 24, 0, 24);
    TELL(CFE_ES_PutPoolBuf(pool, block) == CFE_ES_POOL_BLOCK_INVALID);
    TELL(CFE_ES_GetMemPoolStats(NULL, pool));
    TELL(CFE_ES_GetMemPoolStats(&stats, CFE_ES_MEMHANDLE_UNDEFINED));
    TELL(CFE_ES_GetMemPoolStats(&stats, pool));
    SAY("%lu bytes, %u blocks, %u errors, %lu free", (unsigned long)stats.PoolSize, (unsigned)stats.NumBlocksRequested,
        (unsigned)stats.CheckErrCtr, (unsigned long)stats.NumFreeBytes);
    for (int i = 0; i < 17; i++)
        SAY("size %lu: %u made, %u free", (unsigned long)stats.BlockStats[i].BlockSize,
            (unsigned)stats.BlockStats[i].NumCreated, (unsigned)stats.BlockStats[i].NumFree);
    TELL(CFE_ES_PoolDelete(pool));
}

void APITEST_Main(void)
{
    create();
    take();
    count();
    CFE_ES_ExitApp(CFE_ES_RunStatus_APP_EXIT);
}
