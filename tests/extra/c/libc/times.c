/* <time.h> without its clocks. */
#include "trial.h"

#include <time.h>

static const long long moments[] = {0, 1, -1, 86399, 86400, 951782400, 951868800, 1709164800, 2147483647, 2147483648, -2147483648, 4102444800, 253402300799, 253402300800, -62135596800, -62167219201,
                                    67767976233532799, 67768036191676799, 67768036191676800, LLONG_MAX, LLONG_MIN};
static const char *const formats[] = {
    "%a %A %b %B %c", "%C %d %D %e %F", "%g %G %h %H %I %j", "%m %M %n %p %P %r %R", "%S %t %T %u %U %V", "%w %W %x %X %y %Y", "%z %Z %%", "%s", "%10s|%_12s|%-5s|%012s", "%Ey %Od %EY", "%_d %-d %05d %^a %#Z %+4Y", "%5Y %q", "",
    "%k %l %N", "%",
};

static void tell(const struct tm *tm)
{
    SAY("%d-%d-%d %d:%d:%d %d %d %d %s %ld", tm->tm_year, tm->tm_mon, tm->tm_mday, tm->tm_hour, tm->tm_min, tm->tm_sec, tm->tm_wday, tm->tm_yday, tm->tm_isdst, tm->tm_zone ? tm->tm_zone : "NULL", tm->tm_gmtoff);
}

static void one(time_t moment)
{
    struct tm made = {0}, *found;
    errno = 0;
    found = gmtime(&moment);
    int error = errno;
    SAY("%lld: %d %d", (long long)moment, found != NULL, error);
    if (found == NULL) {
        errno = 0;
        SAY("%d %d %d", ctime(&moment) == NULL, localtime_r(&moment, &made) == NULL, errno);
        return;
    }
    tell(found);
    tell(localtime(&moment));
    tell(gmtime_r(&moment, &made));
    tell(localtime_r(&moment, &made));
    char room[200] = "", *text;
    errno = 0;
    text = asctime_r(&made, room);
    SAY("%s %d", quoted(text), errno);
    SAY("%s", quoted(asctime(&made)));
    SAY("%s", quoted(ctime(&moment)));
    EACH(const char *const, format, formats) {
        memset(room, '?', sizeof room);
        size_t count = strftime(room, sizeof room, *format, &made);
        SAY("%s: %zu %s", quoted(*format), count, count ? quoted(room) : "");
        SAY("%zu", strftime(room, 5, *format, &made));
    }
}

static void back(struct tm from)
{
    struct tm made = from;
    errno = 0;
    long long moment = mktime(&made);
    SAY("mktime %lld %d", moment, errno);
    tell(&made);
    made = from;
    errno = 0;
    moment = timegm(&made);
    SAY("timegm %lld %d", moment, errno);
    tell(&made);
}

static void trial(void)
{
    tzset();
    SAY("%s %s %ld %d", tzname[0], tzname[1], timezone, daylight);
    EACH(const long long, moment, moments)
        one(*moment);
    for (int i = 0; i < 100; i++)
        one((long long)any(UINT_MAX) * 40 - 60000000000);
    static const struct tm some[] = {
        {0}, {.tm_year = 70, .tm_mday = 1}, {.tm_year = 100, .tm_mon = 14, .tm_mday = 35, .tm_hour = -5}, {.tm_year = 100, .tm_mon = -14, .tm_mday = -35, .tm_sec = 100000}, {.tm_year = 124, .tm_mon = 1, .tm_mday = 29, .tm_isdst = 1},
        {.tm_year = 124, .tm_mday = 1, .tm_isdst = -1}, {.tm_year = 124, .tm_mday = 1, .tm_isdst = 7}, {.tm_year = INT_MAX, .tm_mon = 11, .tm_mday = 31}, {.tm_year = INT_MAX, .tm_mon = 12, .tm_mday = 1}, {.tm_year = INT_MIN},
        {.tm_year = 69, .tm_mon = 11, .tm_mday = 31, .tm_hour = 23, .tm_min = 59, .tm_sec = 59}, {.tm_mon = INT_MAX, .tm_mday = INT_MAX}, {.tm_year = 105, .tm_mday = 1, .tm_wday = 9, .tm_yday = 99},
    };
    EACH(const struct tm, each, some)
        back(*each);
    for (int i = 0; i < 300; i++)
        back((struct tm){.tm_year = (int)any(400) - 100, .tm_mon = (int)any(40) - 20, .tm_mday = (int)any(100) - 50, .tm_hour = (int)any(100) - 50, .tm_min = (int)any(200) - 100, .tm_sec = (int)any(200) - 100, .tm_isdst = (int)any(3) - 1});
    SAY("%g %g", difftime(5, 3), difftime(-1000000000000, 1));
    struct tm strange = {.tm_year = 9000, .tm_wday = 8, .tm_mon = 13};
    SAY("%s", quoted(asctime(&strange)));
}
