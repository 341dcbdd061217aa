#include "cfe.h"
#include "beacon_tbl.h"

void BEACON_Main(void)
{
    CFE_TBL_Handle_t Handle;
    void *Address;

    CFE_EVS_Register(NULL, 0, CFE_EVS_EventFilter_BINARY);
    CFE_TBL_Register(&Handle, "Settings", sizeof(BEACON_Table_t), CFE_TBL_OPT_DEFAULT, NULL);
    CFE_TBL_Load(Handle, CFE_TBL_SRC_FILE, "/cf/beacon_tbl.tbl");
    CFE_TBL_GetAddress(&Address, Handle);
    CFE_EVS_SendEvent(1, CFE_EVS_EventType_INFORMATION, "beacon every %lu ms",
                      (unsigned long)((BEACON_Table_t *)Address)->PeriodMs);
    CFE_TBL_ReleaseAddress(Handle);
    while (CFE_ES_RunLoop(NULL)) OS_TaskDelay(500);
}
