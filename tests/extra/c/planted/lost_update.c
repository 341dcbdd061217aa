/* Two tasks count up one variable, with a call between reading and writing it. */
static volatile int counter, done;
static uint32_t lock;

static void add(const char *who)
{
    for (int i = 0; i < 3; i++) {
#ifdef MENDED
        OS_MutSemTake(lock);
#endif
        int seen = counter;
        CFE_ES_WriteToSysLog("%s has seen %d", who, seen);
        counter = seen + 1;
#ifdef MENDED
        OS_MutSemGive(lock);
#endif
        OS_TaskDelay(10);
    }
    done++;
}

static void other(void) { add("child"); }

void BUG_Main(void)
{
    uint32_t id, run = RUN;
    CFE_EVS_Register(NULL, 0, 0);
    OS_MutSemCreate(&lock, "COUNTER", 0);
    CFE_ES_CreateChildTask(&id, "ADDER", other, NULL, 16384, 50, 0);
    CFE_ES_RunLoop(&run);
    OS_TaskDelay(50);
    add("main");
    while (done < 2)
        OS_TaskDelay(10);
    if (counter != 6)
        CFE_EVS_SendEvent(1, 3, "counted to %d, not to 6", counter);
    CFE_ES_ExitApp(EXIT);
}
