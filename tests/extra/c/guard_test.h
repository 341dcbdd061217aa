/* What applications of test_guard_blocks.py do again and again: take a block of a pool, an image of a table, an area. */
#include "psp.h"

int32_t CFE_ES_PoolCreate(uint32_t *, void *, size_t);
int32_t CFE_ES_PoolCreateEx_WithAlignment(uint32_t *, void *, size_t, uint16_t, const size_t *, bool, size_t);
int32_t CFE_ES_PoolDelete(uint32_t);
int32_t CFE_ES_GetPoolBuf(void *, uint32_t, size_t);
int32_t CFE_ES_GetPoolBufInfo(uint32_t, void *);
int32_t CFE_ES_PutPoolBuf(uint32_t, void *);
int32_t CFE_ES_RegisterCDS(uint32_t *, size_t, const char *);
int32_t CFE_ES_RestoreFromCDS(void *, uint32_t);
int32_t CFE_ES_CopyToCDS(uint32_t, const void *);
int32_t CFE_TBL_Unregister(int16_t);

enum { SINGLE = 0, DOUBLE = 1, DUMP_ONLY = 2, CRITICAL = 8, ADDRESS = 1 };

typedef unsigned char Bytes;
static union { long double alignment; Bytes bytes[4096]; } memory;
static Bytes zeros[4096];
static uint32_t pool;
static int16_t table;

static inline volatile Bytes *take(size_t size)
{
    void *block = NULL;
    if (pool == 0)
        CFE_ES_PoolCreate(&pool, memory.bytes, sizeof memory);
    CFE_ES_GetPoolBuf(&block, pool, size);
    return block;
}

static inline void put(volatile Bytes *block) { CFE_ES_PutPoolBuf(pool, (void *)block); }

static inline volatile Bytes *image(size_t size, unsigned options, int32_t (*validate)(void *))
{
    void *at = NULL;
    CFE_TBL_Register(&table, "T", size, options, validate);
    CFE_TBL_Load(table, ADDRESS, zeros);
    CFE_TBL_GetAddress(&at, table);
    return at;
}

static inline volatile Bytes *user_area(void)
{
    uint64_t at;
    uint32_t size;
    CFE_PSP_GetUserReservedArea(&at, &size);
    return (volatile Bytes *)at;
}
