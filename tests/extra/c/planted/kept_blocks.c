/* An application ends before it gives back what it took: a path that leaves early. */
int32_t CFE_ES_PoolCreate(uint32_t *, void *, size_t);
int32_t CFE_ES_GetPoolBuf(void *, uint32_t, size_t);
int32_t CFE_ES_PutPoolBuf(uint32_t, void *);
static union { long double alignment; unsigned char bytes[4096]; } memory;

static void work(uint32_t pool)
{
    void *block = NULL;
    uint8_t *message = CFE_SB_AllocateMessageBuffer(100);
    CFE_ES_GetPoolBuf(&block, pool, 64);
    if (block != NULL && message != NULL) {
#ifndef MENDED
        return;
#endif
    }
    CFE_ES_PutPoolBuf(pool, block);
    CFE_SB_ReleaseMessageBuffer(message);
}

void BUG_Main(void)
{
    uint32_t run = RUN, pool = 0;
    CFE_EVS_Register(NULL, 0, 0);
    CFE_ES_PoolCreate(&pool, memory.bytes, sizeof memory);
    for (int i = 0; i < 3 && CFE_ES_RunLoop(&run); i++) {
        work(pool);
        OS_TaskDelay(100);
    }
    CFE_ES_ExitApp(run);
}
