/* sscanf() and its kin. */
#include "trial.h"

#include <wchar.h>

static const char *const inputs[] = {
    "", " ", "12 3.5 word", "12", "  -7", "+5x", "0x1F", "077", "abc", "a,b,c", "$GPGGA,123519,4807.038,N,01131.000,E,1,08,0.9", "1e5 2e", "1e+", "nan inf", "0x", "0xg", "-",
    "99999999999999999999", "-99999999999999999999", "2147483648", "300", "key=value; other", "12:34:56", "%", "100%", "]x]", "a-z", "\n\t x", "word", "0b101", "3.14159265358979",
    "\xc3\xa9t", "1.5e400", "NULL", "(nil)", "0xdeadbeef",
};
static const char *const formats[] = {
    "%d", "%i", "%u", "%o", "%x", "%X", "%ld", "%lld", "%hd", "%hhd", "%zd", "%jd", "%td", "%f", "%lf", "%Lf", "%e", "%g", "%a", "%lA", "%c", "%3c", "%s", "%3s", "%[a-z]", "%[^,]",
    "%[]x]", "%[^]]", "%2[0-9]", "%p", "%n", "%d%n", "%%%d", "%*d%d", "%*s%s", " %d", "x%d", "%d:%d", "%2d%3d", "%ls", "%lc", "%S", "%l[a-z]", "%i%i", "%'d", "%5lf%s", "%1$d", "%2$s%1$d",
    "%q", "%hhx%hx", "$GPGGA,%d", "%*[^=]=%[^;]; %s", "%d %lf %15s", "%m", "%lu", "%Ld", "%C",
};
static const char *const allocating[] = {"%ms", "%mc", "%3mc", "%m[a-z]", "%mls", "%mS", "%*d%ms", "%m[^,],%m[^,]", "%d %ms", "%2$ms%1$ms", "%mlc"};

/* Room for what a conversion may write, filled with what it then has not written. */
static union {
    char bytes[400];
    long double aligned;
} room[4];

static void clear(void) { memset(room, 0x5A, sizeof room); }

static uint32_t sum_of_room(void)
{
    uint32_t sum = 0;
    for (size_t i = 0; i < sizeof room; i++)
        sum = sum * 31 + (unsigned char)((char *)room)[i];
    return sum;
}

/* The bytes of a long double that are no part of it are of nobody. */
static void tell(const char *input, const char *format, int count, int error)
{
    int32_t value;
    memcpy(&value, room[0].bytes, sizeof value);
    SAY("%s of %s: %d %d, %08x %d", quoted(format), quoted(input), count, error, (unsigned)sum_of_room(), (int)value);
}

static int to_list(const char *input, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    int count = vsscanf(input, format, list);
    va_end(list);
    return count;
}

static void widen(const char *text, wchar_t *to)
{
    do
        *to++ = (unsigned char)*text;
    while (*text++);
}

extern int scan_as_c89(const char *, const char *, ...) __asm__("sscanf");

static void try(const char *input, const char *format)
{
    errno = 0;
    clear();
    int count = sscanf(input, format, &room[0], &room[1], &room[2], &room[3]);
    tell(input, format, count, errno);
    errno = 0;
    clear();
    count = to_list(input, format, &room[0], &room[1], &room[2], &room[3]);
    tell(input, format, count, errno);
    wchar_t wide_input[400], wide_format[400];
    widen(input, wide_input);
    widen(format, wide_format);
    errno = 0;
    clear();
    count = swscanf(wide_input, wide_format, &room[0], &room[1], &room[2], &room[3]);
    tell(input, format, count, errno);
}

static void try_allocating(const char *input, const char *format, bool is_wide, bool has_end)
{
    char *texts[2] = {NULL, NULL};
    int number = -1;
    int count = strstr(format, "%d ") == format ? sscanf(input, format, &number, &texts[0]) : sscanf(input, format, &texts[0], &texts[1]);
    SAY("%s of %s: %d %d", quoted(format), quoted(input), count, number);
    for (int i = 0; i < 2; i++)
        if (texts[i] != NULL && is_wide)
            SAY("  wide %x", (unsigned)*(wchar_t *)texts[i]);
        else if (texts[i] != NULL)
            SAY("  %s", has_end ? quoted(texts[i]) : (texts[i][0] == input[0] ? "first" : "other"));
    free(texts[0]);
    free(texts[1]);
}

static const char *const words[] = {"1", "12", "-3", "0x1f", "2.5", "1e3", "abc", " ", ",", ":", "\t", "nan", "x", "9999999999", "%"};
static const char *const conversions[] = {"%d", "%i", "%x", "%s", "%4s", "%c", "%[0-9]", "%f", "%lf", " ", ",", "%*d", "%*s", "%n", "x", "%hd", "%ld", "%2d"};

static void trial(void)
{
    EACH(const char *const, format, formats)
        EACH(const char *const, input, inputs)
            if (strcmp(*format, "%Lf") != 0)
                try(*input, *format);
    EACH(const char *const, input, inputs) {
        long double value = 0;
        int count = sscanf(*input, "%Lf", &value);
        SAY("%%Lf of %s: %d %La", quoted(*input), count, value);
        EACH(const char *const, format, allocating) {
            bool is_wide = strchr(*format, 'l') != NULL || strchr(*format, 'S') != NULL;
            try_allocating(*input, *format, is_wide, strchr(*format, 'c') == NULL);
        }
        char *old = NULL;
        count = scan_as_c89(*input, "%as", &old);
        SAY("as C89: %d %s", count, quoted(old));
        free(old);
    }
    for (int i = 0; i < 1500; i++) {
        char format[400];
        int count = 0;
        strcpy(format, any_text(conversions, COUNT(conversions), 5));
        for (const char *at = format; *at; at++)
            count += at[0] == '%' && at[1] != '*';
        if (count <= 4)
            try(any_text(words, COUNT(words), 8), format);
    }
}
