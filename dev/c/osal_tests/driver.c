/* Flies a test of OSAL's as a library of a mission: stands for the main program and the board that NASA's build links.
 *
 * The init function of a library runs where NASA's main function runs: in the main task, which is no task of OSAL's.
 * cFE's own tasks are in the way of tests that count objects: OSAL is emptied first, and ready when a test says so.
 */
#include <stdio.h>

#include "osapi.h"
#include "utassert.h"
#include "utbsp.h"
#include "uttest.h"

int32 CFE_OsalTest_Init(uint32 lib_id)
{
    (void)lib_id;
    OS_API_Teardown();
    UtTest_EarlyInit();
    UtAssert_BeginTest("SETUP");
    UtTest_Setup();
    UtAssert_EndTest();
    UtTest_Run();
    return 0;
}

/* Tasks change only when they call a function, and none of ut_assert's does while it holds this lock. */
void UT_BSP_Lock(void) {}
void UT_BSP_Unlock(void) {}
void UT_BSP_Setup(void) {}

void UT_BSP_DoText(uint8 kind, const char *text)
{
    printf("[%5s] %s\n", UtAssert_GetCaseTypeAbbrev(kind), text);
    if (kind == UTASSERT_CASETYPE_ABORT)
        OS_ApplicationExit(OS_ERROR);
}

void UT_BSP_StartTestSegment(uint32 number, const char *name)
{
    char text[128];
    snprintf(text, sizeof text, "%02u %s", (unsigned)number, name);
    UT_BSP_DoText(UTASSERT_CASETYPE_BEGIN, text);
}

void UT_BSP_EndTest(const UtAssert_TestCounter_t *counters)
{
    UtAssert_DoTestSegmentReport("SUMMARY", counters);
    printf("COMPLETE: %u test segments\n", (unsigned)counters->TestSegmentCount);
}
