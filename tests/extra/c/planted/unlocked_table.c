/* A table is read again after a call, in which another task may have loaded it. */
struct limits { int32_t low, high; };
static int16_t table;

static void load(void)
{
    for (int i = 1; i < 6; i++) {
        struct limits now = {i, i};
        CFE_TBL_Load(table, 1, &now);
        OS_TaskDelay(10);
    }
}

void BUG_Main(void)
{
    uint32_t id, run = RUN;
    struct limits *limits, zero = {0, 0};
    CFE_EVS_Register(NULL, 0, 0);
    CFE_TBL_Register(&table, "Limits", sizeof *limits, 0, NULL);
    CFE_TBL_Load(table, 1, &zero);
    CFE_ES_CreateChildTask(&id, "LOADER", load, NULL, 16384, 50, 0);
    CFE_ES_RunLoop(&run);
    OS_TaskDelay(50);
    for (int i = 0; i < 6; i++) {
        CFE_TBL_GetAddress((void **)&limits, table);
        int32_t low = limits->low;
#ifdef MENDED
        int32_t high = limits->high;
#endif
        CFE_ES_WriteToSysLog("low is %d", (int)low);
#ifndef MENDED
        int32_t high = limits->high;
#endif
        CFE_TBL_ReleaseAddress(table);
        if (low != high)
            CFE_EVS_SendEvent(1, 3, "low %d, high %d", (int)low, (int)high);
        OS_TaskDelay(10);
    }
    CFE_ES_ExitApp(EXIT);
}
