/* CFE_EVS_*: filters, types, texts, and who sends. */
#include "api_test.h"

static CFE_EVS_BinFilter_t filters[3] = {
    {1, CFE_EVS_FIRST_ONE_STOP}, {2, CFE_EVS_NO_FILTER}, {3, CFE_EVS_EVERY_OTHER_ONE}};
static CFE_EVS_BinFilter_t many[20];

void APITEST_Main(void)
{
    CFE_ES_AppId_t app;
    CFE_ES_GetAppID(&app);
    TELL(CFE_EVS_SendEvent(1, CFE_EVS_EventType_INFORMATION, "not registered"));
    TELL(CFE_EVS_ResetFilter(1));
    TELL(CFE_EVS_ResetAllFilters());
    TELL(CFE_EVS_Register(NULL, 3, CFE_EVS_EventFilter_BINARY));
    TELL(CFE_EVS_Register(filters, 3, 77));
    TELL(CFE_EVS_Register(many, 20, CFE_EVS_EventFilter_BINARY));
    TELL(CFE_EVS_Register(filters, 3, CFE_EVS_EventFilter_BINARY));
    TELL(CFE_EVS_SendEvent(1, CFE_EVS_EventType_INFORMATION, "one %d %s", 5, "five"));
    TELL(CFE_EVS_SendEvent(1, CFE_EVS_EventType_INFORMATION, "one again"));
    TELL(CFE_EVS_ResetFilter(1));
    TELL(CFE_EVS_ResetFilter(9));
    TELL(CFE_EVS_SendEvent(1, CFE_EVS_EventType_ERROR, "one after a reset"));
    for (int i = 0; i < 4; i++)
        TELL(CFE_EVS_SendEvent(3, CFE_EVS_EventType_CRITICAL, "three, %d", i));
    TELL(CFE_EVS_ResetAllFilters());
    TELL(CFE_EVS_SendEvent(4, CFE_EVS_EventType_DEBUG, "hidden"));
    TELL(CFE_EVS_SendEvent(4, 77, "of no type"));
    TELL(CFE_EVS_SendEvent(4, CFE_EVS_EventType_INFORMATION, NULL));
    TELL(CFE_EVS_SendEventWithAppID(5, CFE_EVS_EventType_INFORMATION, app, "mine %u", 7u));
    TELL(CFE_EVS_SendEventWithAppID(5, CFE_EVS_EventType_INFORMATION, CFE_ES_APPID_UNDEFINED, "of nobody"));
    TELL(CFE_EVS_SendEventWithAppID(5, CFE_EVS_EventType_INFORMATION, app, NULL));
    TELL(CFE_EVS_SendTimedEvent((CFE_TIME_SysTime_t){1000, 0}, 6, CFE_EVS_EventType_INFORMATION, "at %d", 1000));
    TELL(CFE_EVS_SendTimedEvent((CFE_TIME_SysTime_t){1000, 0}, 6, CFE_EVS_EventType_INFORMATION, NULL));
    CFE_ES_ExitApp(CFE_ES_RunStatus_APP_EXIT);
}
