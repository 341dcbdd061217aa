/* OSAL: times and spans of time, in ticks of 100 ns. */
#ifndef CFEPY_OSAL_TIME_H
#define CFEPY_OSAL_TIME_H

#include "base.h"

CFEPY_C_BEGIN

typedef struct {
    int64 ticks;
} OS_time_t;

enum {
    OS_TIME_TICK_RESOLUTION_NS = 100,
    OS_TIME_TICKS_PER_SECOND = 1000000000 / OS_TIME_TICK_RESOLUTION_NS,
    OS_TIME_TICKS_PER_MSEC = 1000000 / OS_TIME_TICK_RESOLUTION_NS,
    OS_TIME_TICKS_PER_USEC = 1000 / OS_TIME_TICK_RESOLUTION_NS
};

#define OS_TIME_MAX  ((OS_time_t){INT64_MAX})
#define OS_TIME_MIN  ((OS_time_t){INT64_MIN})
#define OS_TIME_ZERO ((OS_time_t){0})

int32 OS_GetLocalTime(OS_time_t *time_struct);
int32 OS_GetMonotonicTime(OS_time_t *time_struct);
int32 OS_SetLocalTime(const OS_time_t *time_struct);
OS_time_t OS_TimeFromRelativeMilliseconds(int32 relative_msec);
int32 OS_TimeToRelativeMilliseconds(OS_time_t time);

/* Whole units, both ways. */
#define CFEPY_OS_UNITS(Unit, from_ticks, to_ticks)                   \
    static inline int64 OS_TimeGetTotal##Unit(OS_time_t time)        \
    {                                                                \
        return time.ticks from_ticks;                                \
    }                                                                \
    static inline OS_time_t OS_TimeFromTotal##Unit(int64 count)      \
    {                                                                \
        return (OS_time_t){count to_ticks};                          \
    }
CFEPY_OS_UNITS(Seconds, / OS_TIME_TICKS_PER_SECOND, *OS_TIME_TICKS_PER_SECOND)
CFEPY_OS_UNITS(Milliseconds, / OS_TIME_TICKS_PER_MSEC, *OS_TIME_TICKS_PER_MSEC)
CFEPY_OS_UNITS(Microseconds, / OS_TIME_TICKS_PER_USEC, *OS_TIME_TICKS_PER_USEC)
CFEPY_OS_UNITS(Nanoseconds, *OS_TIME_TICK_RESOLUTION_NS, / OS_TIME_TICK_RESOLUTION_NS)

/* What is left of a time beside its whole seconds. */
static inline int64 OS_TimeGetFractionalPart(OS_time_t time)
{
    return time.ticks % OS_TIME_TICKS_PER_SECOND;
}
static inline uint32 OS_TimeGetMillisecondsPart(OS_time_t time)
{
    return (uint32)OS_TimeGetFractionalPart(time) / OS_TIME_TICKS_PER_MSEC;
}
static inline uint32 OS_TimeGetMicrosecondsPart(OS_time_t time)
{
    return (uint32)OS_TimeGetFractionalPart(time) / OS_TIME_TICKS_PER_USEC;
}
static inline uint32 OS_TimeGetNanosecondsPart(OS_time_t time)
{
    return (uint32)OS_TimeGetFractionalPart(time) * OS_TIME_TICK_RESOLUTION_NS;
}
/* In units of 2**-32 s, rounded up, so that no tick is lost on the way back. A quarter of a second's ticks stands
 * below the line: the product fits 64 bits. */
static inline uint32 OS_TimeGetSubsecondsPart(OS_time_t time)
{
    const int64 quarter = OS_TIME_TICKS_PER_SECOND / 4;
    return (uint32)(((OS_TimeGetFractionalPart(time) << 30) + quarter - 1) / quarter);
}

/* A time of whole seconds and a part of one. */
static inline OS_time_t OS_TimeAssembleFromMilliseconds(int64 seconds, uint32 milliseconds)
{
    return (OS_time_t){seconds * OS_TIME_TICKS_PER_SECOND + (int64)milliseconds * OS_TIME_TICKS_PER_MSEC};
}
static inline OS_time_t OS_TimeAssembleFromMicroseconds(int64 seconds, uint32 microseconds)
{
    return (OS_time_t){seconds * OS_TIME_TICKS_PER_SECOND + (int64)microseconds * OS_TIME_TICKS_PER_USEC};
}
static inline OS_time_t OS_TimeAssembleFromNanoseconds(int64 seconds, uint32 nanoseconds)
{
    return (OS_time_t){seconds * OS_TIME_TICKS_PER_SECOND + nanoseconds / OS_TIME_TICK_RESOLUTION_NS};
}
static inline OS_time_t OS_TimeAssembleFromSubseconds(int64 seconds, uint32 subseconds)
{
    return (OS_time_t){seconds * OS_TIME_TICKS_PER_SECOND + (((int64)subseconds * (OS_TIME_TICKS_PER_SECOND / 4)) >> 30)};
}

/* Sums and comparisons. */
static inline OS_time_t OS_TimeAdd(OS_time_t one, OS_time_t other)
{
    return (OS_time_t){one.ticks + other.ticks};
}
static inline OS_time_t OS_TimeSubtract(OS_time_t from, OS_time_t what)
{
    return (OS_time_t){from.ticks - what.ticks};
}
static inline bool OS_TimeEqual(OS_time_t one, OS_time_t other)
{
    return one.ticks == other.ticks;
}
static inline int8_t OS_TimeGetSign(OS_time_t time)
{
    return time.ticks < 0 ? -1 : time.ticks > 0;
}
static inline int8_t OS_TimeCompare(OS_time_t one, OS_time_t other)
{
    return OS_TimeGetSign(OS_TimeSubtract(one, other));
}

CFEPY_C_END

#endif
