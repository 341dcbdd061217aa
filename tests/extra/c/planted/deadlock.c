/* Two mutexes, taken in opposite orders. */
static uint32_t first, second;

static void use(uint32_t one, uint32_t other)
{
    for (int i = 0; i < 3; i++) {
        OS_MutSemTake(one);
        OS_MutSemTake(other);
        OS_MutSemGive(other);
        OS_MutSemGive(one);
        OS_TaskDelay(10);
    }
}

static void child(void)
{
#ifdef MENDED
    use(first, second);
#else
    use(second, first);
#endif
}

void BUG_Main(void)
{
    uint32_t id, run = RUN;
    OS_MutSemCreate(&first, "FIRST", 0);
    OS_MutSemCreate(&second, "SECOND", 0);
    CFE_ES_CreateChildTask(&id, "CHILD", child, NULL, 16384, 50, 0);
    CFE_ES_RunLoop(&run);
    OS_TaskDelay(50);
    use(first, second);
    while (CFE_ES_RunLoop(&run))
        OS_TaskDelay(100);
    CFE_ES_ExitApp(run);
}
