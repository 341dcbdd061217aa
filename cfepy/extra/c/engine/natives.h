/* What the natives share that stand for libc: arguments, accesses that `Races` looks at, and what a function of the host's
 * libc takes over from an application while it stands for one of the application's.
 */
#ifndef CFEPY_NATIVES_H
#define CFEPY_NATIVES_H

#include "engine.h"

#include <locale.h>
#include <time.h>

#define TEXT(number) ((char *)call->arguments[number])

/* ---- accesses, where somebody looks at them: see races.c ---------------------------------------------------------- */

typedef struct {
    const void *at;
    size_t size;
    bool is_write;
} Range;

HIDDEN bool waits_for_others(Coroutine *, const Range *, int count); /* Python answers first; called again after that */

#define READS(where, size) {where, size, false}
#define WRITES(where, size) {where, size, true}
#define WITH_ACCESSES(result, ...)                                                                             \
    {                                                                                                          \
        if (call->table->races != NULL) {                                                                      \
            const Range ranges[] = {__VA_ARGS__};                                                              \
            if (waits_for_others(call, ranges, (int)(sizeof ranges / sizeof *ranges)))                         \
                return 0;                                                                                      \
        }                                                                                                      \
        return (uint64_t)(result);                                                                             \
    }

/* ---- libc in the terms of an application -------------------------------------------------------------------------- */

/* Between these two, rounding and the flags of floating point are the application's. What the functions in between leave
 * in errno goes to the application's, unless it is what it was before. serve_native abandons it after a fault. */
HIDDEN void modes_enter(Coroutine *);
HIDDEN void modes_leave(Coroutine *);
HIDDEN void modes_leave_long(Coroutine *); /* of what computes with long double, or sets flags itself */
HIDDEN void modes_abandon(Coroutine *);
/* The same, in the locale "C", whatever the host's process has; and with the modes only for what computes. What prints
 * raises no flags, and wants the errno that there is (%m). */
HIDDEN void libc_enter(Coroutine *);
HIDDEN void libc_enter_to_compute(Coroutine *);
HIDDEN void libc_enter_to_print(Coroutine *);
HIDDEN void libc_leave(Coroutine *);
HIDDEN void scan_abandon(Coroutine *);
HIDDEN locale_t only_locale(void);

/* The flags of the x87, which computes long double: the switch does not know them. They hardly ever differ. */
#if defined(__x86_64__)
HIDDEN void x87_set_flags(uint16_t);
static inline uint16_t x87_flags(void)
{
    uint16_t status;
    __asm__ volatile("fnstsw %0" : "=m"(status));
    return status & 0x3F;
}
static inline void give_flags(const Coroutine *coroutine)
{
    if (x87_flags() != coroutine->x87_flags)
        x87_set_flags(coroutine->x87_flags);
}
static inline void keep_flags(Coroutine *coroutine) { coroutine->x87_flags = x87_flags(); }
#else
static inline void give_flags(const Coroutine *coroutine) {}
static inline void keep_flags(Coroutine *coroutine) {}
#endif

HIDDEN void set_application_errno(Coroutine *, int);

/* Variables of libc that pointers lead to: in the arena, at the same place in each run. calls.py has the offsets of
 * those that are variables of C. */
typedef struct {
    char *rest_of_strtok;                      /* 0: one for the whole processor, as for a whole process */
    int signgam;                               /* 8 */
    int daylight;                              /* 12 */
    long timezone;                             /* 16 */
    const char *tzname[2];                     /* 24 */
    char gmt[4], utc[4];                       /* 40, 44 */
    struct tm broken_down;                     /* 48 */
    char date[128];
    struct lconv conventions;
    char empty[1], point[2], name_of_locale[2];
} LibcState;
_Static_assert(offsetof(LibcState, tzname) == 24 && offsetof(LibcState, utc) == 44, "calls.py has these offsets");
HIDDEN void state_begin(LibcState *);
#define STATE ((LibcState *)call->table->state)

#endif
