/* CFE_ES_*CDS*. */
#include "api_test.h"

static uint8 data[24], back[24];

void APITEST_Main(void)
{
    CFE_ES_CDSHandle_t block = CFE_ES_CDSHANDLE_C(77), found = CFE_ES_CDSHANDLE_C(77), big;
    char name[64];
    CFE_EVS_Register(NULL, 0, CFE_EVS_EventFilter_BINARY);
    TELL(CFE_ES_RegisterCDS(NULL, 24, "Data"));
    TELL(CFE_ES_RegisterCDS(&block, 24, NULL));
    SAY("untouched %lX", CFE_RESOURCEID_TO_ULONG(block));
    TELL(CFE_ES_RegisterCDS(&block, 24, ""));
    SAY("none %lX", CFE_RESOURCEID_TO_ULONG(block));
    TELL(CFE_ES_RegisterCDS(&block, 24, "SeventeenLettersX"));
    TELL(CFE_ES_RegisterCDS(&block, 0, "Data"));
    TELL(CFE_ES_RegisterCDS(&big, 200000, "Big"));
    TELL(CFE_ES_RegisterCDS(&block, sizeof data, "Data"));
    TELL(CFE_ES_RestoreFromCDS(back, block));
    SAY("new: %02X %02X", back[0], back[23]);
    for (unsigned i = 0; i < sizeof data; i++)
        data[i] = (uint8)(3 * i);
    TELL(CFE_ES_CopyToCDS(block, NULL));
    TELL(CFE_ES_CopyToCDS(CFE_ES_CDS_BAD_HANDLE, data));
    TELL(CFE_ES_CopyToCDS(block, data));
    TELL(CFE_ES_RestoreFromCDS(NULL, block));
    TELL(CFE_ES_RestoreFromCDS(back, CFE_ES_CDS_BAD_HANDLE));
    TELL(CFE_ES_RestoreFromCDS(back, block));
    SAY("equal %d", memcmp(data, back, sizeof data) == 0);
    TELL(CFE_ES_RegisterCDS(&found, sizeof data, "Data"));
    SAY("the same %d", CFE_RESOURCEID_TEST_EQUAL(found, block));
    TELL(CFE_ES_RegisterCDS(&found, 12, "Data"));
    memset(back, 0xEE, sizeof back);
    TELL(CFE_ES_RestoreFromCDS(back, found));
    SAY("smaller and new: %02X %02X %02X", back[0], back[11], back[12]);
    TELL(CFE_ES_GetCDSBlockIDByName(NULL, "APITEST.Data"));
    TELL(CFE_ES_GetCDSBlockIDByName(&found, NULL));
    TELL(CFE_ES_GetCDSBlockIDByName(&found, "Data"));
    SAY("none %lX", CFE_RESOURCEID_TO_ULONG(found));
    TELL(CFE_ES_GetCDSBlockIDByName(&found, "APITEST.Data"));
    SAY("found %d", CFE_RESOURCEID_TEST_EQUAL(found, block));
    TELL(CFE_ES_GetCDSBlockName(NULL, block, sizeof name));
    TELL(CFE_ES_GetCDSBlockName(name, block, 0));
    TELL(CFE_ES_GetCDSBlockName(name, CFE_ES_CDS_BAD_HANDLE, sizeof name));
    SAY("empty [%s]", name);
    TELL(CFE_ES_GetCDSBlockName(name, block, sizeof name));
    SAY("name [%s]", name);
    TELL(CFE_ES_GetCDSBlockName(name, block, 8));
    SAY("cut [%s]", name);
    CFE_ES_ExitApp(CFE_ES_RunStatus_APP_EXIT);
}
