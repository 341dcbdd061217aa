// Waits of less than a millisecond.
#include "core/core.h"

namespace roscfe
{

namespace parts
{
extern const char exact_waits = 0;
}

namespace
{
// Timeouts of the Software Bus are whole milliseconds from now on. A loop at 1 kHz that ended each cycle with one would
// be late by its own work each time, and catch up by a cycle without a wait: two messages at once, for a subscriber that
// keeps one. OSAL waits for a condition variable until a time of the clock, in ticks of 100 ns; nobody signals it.
osal_id_t g_alarm     = OS_OBJECT_ID_UNDEFINED;
bool      g_no_alarms = false;

bool has_alarm()
{
    if (OS_ObjectIdDefined(g_alarm) || g_no_alarms)
    {
        return !g_no_alarms;
    }
    char name[OS_MAX_API_NAME];
    own_name(name, "_WAIT", "_W");
    // ES does not delete it with its application: one that was killed and started again finds it.
    g_no_alarms = OS_CondVarCreate(&g_alarm, name, 0) != OS_SUCCESS &&
                  OS_CondVarGetIdByName(&g_alarm, name) != OS_SUCCESS;
    return !g_no_alarms;
}
} // namespace

bool wait_exactly(std::int64_t until_ns)
{
    if (!has_alarm() || OS_CondVarLock(g_alarm) != OS_SUCCESS)
    {
        return false;
    }
    const OS_time_t until = OS_TimeFromTotalNanoseconds(until_ns + OS_TIME_TICK_RESOLUTION_NS - 1);
    OS_CondVarTimedWait(g_alarm, &until);
    OS_CondVarUnlock(g_alarm);
    return true;
}

void end_exact_waits()
{
    if (OS_ObjectIdDefined(g_alarm))
    {
        OS_CondVarDelete(g_alarm);
        g_alarm = OS_OBJECT_ID_UNDEFINED;
    }
}

} // namespace roscfe
