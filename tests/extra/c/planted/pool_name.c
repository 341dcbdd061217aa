/* A name is copied with its NUL into a block of a memory pool that has no room for it. */
int32_t CFE_ES_PoolCreate(uint32_t *, void *, size_t);
int32_t CFE_ES_GetPoolBuf(void *, uint32_t, size_t);
int32_t CFE_ES_PutPoolBuf(uint32_t, void *);
static union { long double alignment; char bytes[1024]; } memory;

void BUG_Main(void)
{
    static const char name[] = "a name of 23 characters";
    uint32_t pool, run = RUN;
    char *copy;
    CFE_ES_PoolCreate(&pool, memory.bytes, sizeof memory);
    CFE_ES_RunLoop(&run);
#ifdef MENDED
    CFE_ES_GetPoolBuf(&copy, pool, strlen(name) + 1);
#else
    CFE_ES_GetPoolBuf(&copy, pool, strlen(name));
#endif
    strcpy(copy, name);
    SAY("%s", copy);
    CFE_ES_PutPoolBuf(pool, copy);
    CFE_ES_ExitApp(EXIT);
}
