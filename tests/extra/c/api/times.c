/* CFE_TIME_*: arithmetic, texts, relations between clocks, callbacks. */
#include "api_test.h"

static int synched, others;

static int32 on_tone(void) { return synched++; }
static int32 never(void) { return others++; }

static void show(const char *what, CFE_TIME_SysTime_t time)
{
    SAY("%s %08X.%08X", what, (unsigned)time.Seconds, (unsigned)time.Subseconds);
}

static CFE_TIME_SysTime_t at(uint32 seconds, uint32 subseconds)
{
    CFE_TIME_SysTime_t time = {seconds, subseconds};
    return time;
}

static void arithmetic(void)
{
    char text[CFE_TIME_PRINTED_STRING_SIZE + 8];
    memset(text, 0x55, sizeof text);
    show("carry", CFE_TIME_Add(at(1, 0xC0000000), at(2, 0x80000000)));
    show("over", CFE_TIME_Add(at(0xFFFFFFFF, 0x80000000), at(0, 0x80000000)));
    show("less", CFE_TIME_Subtract(at(5, 0), at(2, 1)));
    show("below", CFE_TIME_Subtract(at(1, 0), at(2, 0)));
    SAY("compare %d %d %d %d", CFE_TIME_Compare(at(1, 0), at(2, 0)), CFE_TIME_Compare(at(2, 1), at(2, 0)),
        CFE_TIME_Compare(at(9, 9), at(9, 9)), CFE_TIME_Compare(at(0xFFFFFFFF, 0), at(1, 0)));
    SAY("micros %u %u %u", (unsigned)CFE_TIME_Sub2MicroSecs(0), (unsigned)CFE_TIME_Sub2MicroSecs(0x80000000),
        (unsigned)CFE_TIME_Sub2MicroSecs(0xFFFFFFFF));
    SAY("subs %08X %08X %08X", (unsigned)CFE_TIME_Micro2SubSecs(500000), (unsigned)CFE_TIME_Micro2SubSecs(999999),
        (unsigned)CFE_TIME_Micro2SubSecs(1000000));
    TELL(CFE_TIME_Print(NULL, at(0, 0)));
    TELL(CFE_TIME_Print(text, at(1000000, 0x80000000)));
    SAY("text [%s], behind it %02X", text, (unsigned)text[CFE_TIME_PRINTED_STRING_SIZE]);
}

static void clocks(void)
{
    CFE_TIME_SysTime_t met = CFE_TIME_GetMET(), stcf = CFE_TIME_GetSTCF();
    int16 leaps = CFE_TIME_GetLeapSeconds();
    show("stcf", stcf);
    SAY("leap seconds %d, state %d, info %04X", leaps, CFE_TIME_GetClockState(), (unsigned)CFE_TIME_GetClockInfo());
    CFE_TIME_SysTime_t tai = CFE_TIME_Subtract(CFE_TIME_GetTAI(), CFE_TIME_Add(met, stcf));
    CFE_TIME_SysTime_t utc = CFE_TIME_Subtract(CFE_TIME_GetTAI(), CFE_TIME_GetUTC());
    SAY("tai is met and stcf %d, utc is leap seconds behind %d", tai.Seconds == 0,
        utc.Seconds == (uint32)leaps || utc.Seconds == (uint32)leaps - 1);
    SAY("seconds go on %d", CFE_TIME_GetMETseconds() >= met.Seconds);
    (void)CFE_TIME_GetMETsubsecs();
    show("of met", CFE_TIME_Subtract(CFE_TIME_MET2SCTime(at(100, 0)), at(100, 0)));
    CFE_TIME_SysTime_t now = CFE_TIME_GetTime();
    SAY("later %d", CFE_TIME_Compare(CFE_TIME_GetTime(), now) != CFE_TIME_A_LT_B);
}

static void callbacks(void)
{
    TELL(CFE_TIME_RegisterSynchCallback(NULL));
    TELL(CFE_TIME_UnregisterSynchCallback(NULL));
    TELL(CFE_TIME_UnregisterSynchCallback(on_tone));
    TELL(CFE_TIME_RegisterSynchCallback(on_tone));
    TELL(CFE_TIME_RegisterSynchCallback(never));
    TELL(CFE_TIME_UnregisterSynchCallback(never));
    OS_TaskDelay(3200);
    SAY("called once a second %d, never %d", synched >= 2 && synched <= 4, others);
    TELL(CFE_TIME_UnregisterSynchCallback(on_tone));
    int before = synched;
    OS_TaskDelay(1500);
    SAY("no more %d", synched == before);
}

void APITEST_Main(void)
{
    arithmetic();
    clocks();
    CFE_ES_WaitForSystemState(CFE_ES_SystemState_OPERATIONAL, 10000);
    callbacks();
    CFE_ES_ExitApp(CFE_ES_RunStatus_APP_EXIT);
}
