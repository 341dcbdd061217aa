/* <time.h> without its clocks, and in UTC: no time zone of the host gets into an application. */
#define _GNU_SOURCE
#include "natives.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

#define BROKEN_DOWN(number) ((struct tm *)call->arguments[number])

static const char *zone_of(Coroutine *call, bool is_local) { return is_local ? STATE->utc : STATE->gmt; }

static uint64_t broken_down(Coroutine *call, time_t moment, struct tm *to, bool is_local)
{
    struct tm made;
    libc_enter(call);
    struct tm *found = gmtime_r(&moment, &made);
    libc_leave(call);
    if (found == NULL)
        return 0;
    made.tm_zone = zone_of(call, is_local);
    *to = made;
    return (uint64_t)to;
}

#define TO_STATE(is_local, member, result)                                                                  \
    {                                                                                                       \
        time_t moment = *(const time_t *)POINTER(0);                                                        \
        WITH_ACCESSES(result, READS(POINTER(0), sizeof moment), WRITES(&STATE->member, sizeof STATE->member)) \
    }
NATIVE(universal) TO_STATE(false, broken_down, broken_down(call, moment, &STATE->broken_down, false))
NATIVE(local) TO_STATE(true, broken_down, broken_down(call, moment, &STATE->broken_down, true))
NATIVE(universal_to) { return broken_down(call, *(const time_t *)POINTER(0), BROKEN_DOWN(1), false); }
NATIVE(local_to) { return broken_down(call, *(const time_t *)POINTER(0), BROKEN_DOWN(1), true); }

/* asctime() has room for longer years than asctime_r(), which knows that 26 characters are enough. */
static uint64_t date_text(Coroutine *call, const struct tm *from, char *to)
{
    bool is_static = to == STATE->date;
    libc_enter(call);
    char *made = from == NULL ? (errno = EINVAL, NULL) : is_static ? asctime(from) : asctime_r(from, to);
    libc_leave(call);
    if (made != NULL && is_static)
        snprintf(to, sizeof STATE->date, "%s", made);
    return made == NULL ? 0 : (uint64_t)to;
}

/* What no date is made of has set errno already. */
static uint64_t moment_text(Coroutine *call, const struct tm *from, char *to)
{
    return from == NULL ? 0 : date_text(call, from, to);
}

NATIVE(text_of_date) WITH_ACCESSES(date_text(call, BROKEN_DOWN(0), STATE->date), WRITES(STATE->date, sizeof STATE->date))
NATIVE(text_of_date_to) { return date_text(call, BROKEN_DOWN(0), TEXT(1)); }
NATIVE(text_of_moment)
TO_STATE(true, date, moment_text(call, (struct tm *)broken_down(call, moment, &STATE->broken_down, true), STATE->date))
NATIVE(text_of_moment_to)
{
    struct tm made;
    return moment_text(call, (struct tm *)broken_down(call, *(const time_t *)POINTER(0), &made, true), TEXT(1));
}

/* A summer time, which UTC does not have, is an hour before, as glibc takes it. */
NATIVE(moment_of_local)
{
    enum { HOUR_S = 3600 };
    struct tm made = *BROKEN_DOWN(0);
    bool is_summer = made.tm_isdst > 0;
    libc_enter(call);
    time_t moment = timegm(&made);
    if (is_summer && errno == 0) {
        moment -= HOUR_S;
        gmtime_r(&moment, &made);
    }
    bool is_out_of_range = errno != 0;
    libc_leave(call);
    if (is_out_of_range)
        return (uint64_t)-1;
    made.tm_zone = zone_of(call, true);
    *BROKEN_DOWN(0) = made;
    return (uint64_t)moment;
}

NATIVE(moment_of_universal)
{
    struct tm made = *BROKEN_DOWN(0);
    libc_enter(call);
    time_t moment = timegm(&made);
    bool is_out_of_range = errno != 0;
    libc_leave(call);
    if (is_out_of_range)
        return (uint64_t)-1;
    made.tm_zone = zone_of(call, false);
    *BROKEN_DOWN(0) = made;
    return (uint64_t)moment;
}

NATIVE(difference)
{
    call->float_result = difftime((time_t)WORD(0), (time_t)WORD(1));
    return 0;
}

/* A %s is the only conversion that asks for the host's time zone: it becomes a number before. */
static bool with_moments(char *to, size_t room, const char *format, const struct tm *from)
{
    size_t used = 0;
    while (*format != 0 && used + 32 < room) {
        size_t size = format[0] == '%' ? 1 + strspn(format + 1, "_-0^#+") : 1;
        char flag = size > 1 ? format[size - 1] : 0;
        size_t width = 0, digits = format[0] == '%' ? strspn(format + size, "0123456789") : 0;
        for (size_t i = 0; i < digits && width < 1000; i++)
            width = width * 10 + (size_t)(format[size + i] - '0');
        if (format[0] == '%' && format[size + digits] == 's') {
            struct tm copy = *from;
            long long moment = timegm(&copy) - (from->tm_isdst > 0 ? 3600 : 0);
            char digits_of_it[32];
            size_t count = (size_t)snprintf(digits_of_it, sizeof digits_of_it, "%lld", moment);
            size_t fill = width > count && width + used < room ? width - count : 0;
            memset(to + used, flag == '0' || flag == '+' ? '0' : ' ', fill);
            memcpy(to + used + fill, digits_of_it, count);
            used += fill + count;
            format += size + digits + 1;
        } else {
            size_t whole = format[0] == '%' && format[1] == '%' ? 2 : 1;
            memcpy(to + used, format, whole);
            used += whole;
            format += whole;
        }
    }
    if (used < room)
        to[used] = 0;
    return *format == 0 && used < room;
}

enum { LONGEST_FORMAT = 4096 };

NATIVE(text_by_format)
{
    char format[LONGEST_FORMAT];
    libc_enter(call);
    bool is_whole = with_moments(format, sizeof format, TEXT(2), BROKEN_DOWN(3));
    errno = 0;
    size_t count = is_whole ? strftime(TEXT(0), WORD(1), format, BROKEN_DOWN(3)) : 0;
    libc_leave(call);
    if (!is_whole)
        PyErr_Format(fault_error, "strftime() with a format of more than %d characters", LONGEST_FORMAT);
    return count;
}

NATIVE(nothing) { return 0; }

HIDDEN const NativeRow natives_of_time[] = {
    {"gmtime", universal},
    {"gmtime_r", universal_to},
    {"localtime", local},
    {"localtime_r", local_to},
    {"asctime", text_of_date},
    {"asctime_r", text_of_date_to},
    {"ctime", text_of_moment},
    {"ctime_r", text_of_moment_to},
    {"mktime", moment_of_local},
    {"timelocal", moment_of_local},
    {"timegm", moment_of_universal},
    {"difftime", difference},
    {"strftime", text_by_format},
    {"tzset", nothing},
    {NULL},
};
