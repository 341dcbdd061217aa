/* An entry of a queue is given back to its memory pool before the next one is read from it. */
int32_t CFE_ES_PoolCreate(uint32_t *, void *, size_t);
int32_t CFE_ES_GetPoolBuf(void *, uint32_t, size_t);
int32_t CFE_ES_PutPoolBuf(uint32_t, void *);
static union { long double alignment; char bytes[1024]; } memory;
struct entry { struct entry *next; uint32_t command; };

void BUG_Main(void)
{
    uint32_t pool, run = RUN;
    struct entry *first = NULL;
    CFE_ES_PoolCreate(&pool, memory.bytes, sizeof memory);
    CFE_ES_RunLoop(&run);
    for (uint32_t command = 3; command > 0; command--) {
        struct entry *entry;
        CFE_ES_GetPoolBuf(&entry, pool, sizeof *entry);
        *entry = (struct entry){first, command};
        first = entry;
    }
    while (first != NULL) {
        SAY("command %u", (unsigned)first->command);
#ifdef MENDED
        struct entry *next = first->next;
        CFE_ES_PutPoolBuf(pool, first);
        first = next;
#else
        CFE_ES_PutPoolBuf(pool, first);
        first = first->next;
#endif
    }
    CFE_ES_ExitApp(EXIT);
}
