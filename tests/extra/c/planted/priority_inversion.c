/* A lock that lends no priority: a task in the middle keeps the one that has it from giving it back. */
#ifdef MENDED
#define MAKE(lock) OS_MutSemCreate(&lock, "LOCK", 0)
#define TAKE OS_MutSemTake
#define GIVE OS_MutSemGive
#else
#define MAKE(lock) OS_BinSemCreate(&lock, "LOCK", 1, 0)
#define TAKE OS_BinSemTake
#define GIVE OS_BinSemGive
#endif
static uint32_t lock;

static void compute(int ms)
{
    int64_t begin[1], now[1];
    OS_GetLocalTime(begin);
    do
        OS_GetLocalTime(now);
    while (*now - *begin < ms * 10000);
}

static void low(void)
{
    for (;;) {
        TAKE(lock);
        compute(3);
        GIVE(lock);
        OS_TaskDelay(40);
    }
}

static void middle(void)
{
    for (;;) {
        compute(20);
        OS_TaskDelay(21);
    }
}

void BUG_Main(void)
{
    uint32_t id, run = RUN;
    int64_t begin[1], end[1];
    CFE_EVS_Register(NULL, 0, 0);
    MAKE(lock);
    CFE_ES_CreateChildTask(&id, "LOW", low, NULL, 16384, 120, 0);
    CFE_ES_CreateChildTask(&id, "MIDDLE", middle, NULL, 16384, 100, 0);
    while (CFE_ES_RunLoop(&run)) {
        OS_GetLocalTime(begin);
        TAKE(lock);
        GIVE(lock);
        OS_GetLocalTime(end);
        if (*end - *begin > 100000)
            CFE_EVS_SendEvent(1, 3, "late by %d ms", (int)((*end - *begin) / 10000));
        OS_TaskDelay(7);
    }
    CFE_ES_ExitApp(run);
}
