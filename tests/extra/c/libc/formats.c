/* printf() and its kin. Not here: a 0 before a width that is negative, of which glibc makes two things: with libquadmath in
 * the process, as numpy loads it, all formats take the way of those with positions. */
#include "trial.h"

#include <wchar.h>

static const char *const flags[] = {"", "-", "+", " ", "#", "0", "-#", "+0", " 0", "'", "#0", "-+ #0"};
static const char *const sizes[] = {"", "1", "12", ".0", ".3", "20.10", ".", "*", ".*", "*.*"};
static const double reals[] = {0.0, -0.0, 1.0, -1.5, 0.1, 1e10, 1e-10, 123456.789, 9.9999995, 1e300, 5e-324, 1.0 / 0.0, -1.0 / 0.0, 2.5, 3.5, 1e15, 123456789.5};
static const long long integers[] = {0, 1, -1, 42, -42, 255, 65536, INT_MAX, INT_MIN, LLONG_MAX, LLONG_MIN, 1000000};

#define SHOW(type, value)                                                                            \
    do {                                                                                             \
        char text[800];                                                                              \
        memset(text, '?', sizeof text);                                                              \
        errno = 0;                                                                                   \
        int stars = (strchr(format, '*') != NULL) + (strrchr(format, '*') != strchr(format, '*'));   \
        int count = stars == 0 ? snprintf(text, 30, format, (type)(value))                           \
                    : stars == 1 ? snprintf(text, 30, format, 7, (type)(value))                      \
                                 : snprintf(text, 30, format, strchr(format, '0') ? 9 : -9, 4, (type)(value));                 \
        SAY("%s: %d %d %s", quoted(format), count, errno, quoted(text));                              \
    } while (0)

static int in_list(char *to, size_t room, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    int count = vsnprintf(to, room, format, list);
    va_end(list);
    return count;
}

static int allocated(char **to, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    int count = vasprintf(to, format, list);
    va_end(list);
    return count;
}

static void trial(void)
{
    char format[40], text[400];
    EACH(const char *const, flag, flags) {
        EACH(const char *const, size, sizes) {
            EACH(const long long, value, integers) {
                for (const char *kind = "diouxX"; *kind; kind++) {
                    sprintf(format, "%%%s%s%c", *flag, *size, *kind);
                    SHOW(int, *value);
                    sprintf(format, "%%%s%sll%c", *flag, *size, *kind);
                    SHOW(long long, *value);
                }
            }
            EACH(const double, value, reals) {
                for (const char *kind = "fFeEgGaA"; *kind; kind++) {
                    sprintf(format, "%%%s%s%c", *flag, *size, *kind);
                    SHOW(double, *value);
                }
                sprintf(format, "%%%s%sLg", *flag, *size);
                SHOW(long double, *value);
            }
            sprintf(format, "%%%s%ss|", *flag, *size);
            SHOW(const char *, "some text");
            SHOW(const char *, NULL);
            sprintf(format, "%%%s%sc", *flag, *size);
            SHOW(int, 'x');
            sprintf(format, "%%%s%sls", *flag, *size);
            SHOW(const wchar_t *, L"wide");
            SHOW(const wchar_t *, L"caf\xe9");
            sprintf(format, "%%%s%slc", *flag, *size);
            SHOW(int, 0xe9);
        }
    }
    static const char *const modifiers[] = {"hh", "h", "l", "ll", "j", "z", "t", "q", "L"};
    EACH(const char *const, modifier, modifiers)
        EACH(const long long, value, integers) {
            sprintf(format, "%%%sd %%%su", *modifier, *modifier);
            int count = in_list(text, sizeof text, format, *value, *value);
            SAY("%s: %d %s", quoted(format), count, text);
        }
    int written = -1;
    SAY("%s %d", text, in_list(text, 5, "%s%n", "abcdefgh", &written));
    SAY("%d", written);
    errno = ERANGE;
    SAY("%m, %d", errno);
    SAY("%3$s %1$d %2$g", 4, 2.5, "positions");
    SAY("%.3s|%-10.2s|%p|%%|%5%|%y", "abcdef", "xyz", (void *)0);
    SAY("%d %d %d %d %d %d %d %d %g %g %g %g %g %g %g %g %g %g %Lg %d", 1, 2, 3, 4, 5, 6, 7, 8, 1., 2., 3., 4., 5., 6., 7., 8., 9., 10., 11.L, 12);
    char *made = NULL;
    int count = asprintf(&made, "%s and %d, %500d", "text", 7, 1);
    SAY("%d %s", count, made);
    free(made);
    count = allocated(&made, "%Lf %s", 2.5L, "x");
    SAY("%d %s", count, made);
    free(made);
    printf("> %3000d\n", 5);
    wchar_t wide[20];
    for (size_t room = 0; room < 12; room++) {
        wmemset(wide, L'?', 20);
        count = swprintf(wide, room, L"%d %ls %s", 12, L"ab", "cd");
        SAY("%d %x %x", count, (unsigned)wide[0], (unsigned)wide[7]);
    }
    for (int i = 0; i < 1500; i++) {
        static const char *const pieces[] = {"%d", "%5u", "%-8x|", "%ld", "%g", "%.3f", "%s", "%10s", "%c", "%%", " ", "text", "%e", "%08d", "%+d", "%a"};
        char parts[5][10];
        for (int part = 0; part < 5; part++)
            strcpy(parts[part], pieces[any(COUNT(pieces))]);
        int length = 0;
        for (int part = 0; part < 5; part++) {
            char kind = parts[part][0] == '%' ? parts[part][1 + strcspn(parts[part] + 1, "duxgfscea%")] : 0;
            char *to = text + length;
            size_t room = sizeof text - (size_t)length;
            int number = (int)any(UINT_MAX);
            double real = number / (1.0 + any(100000));
            if (kind == 's')
                length += snprintf(to, room, parts[part], "text");
            else if (kind != 0 && strchr("gfea", kind))
                length += snprintf(to, room, parts[part], real);
            else if (kind == 'c')
                length += snprintf(to, room, parts[part], 'a' + number % 26);
            else if (strcmp(parts[part], "%ld") == 0)
                length += snprintf(to, room, "%ld", (long)number * number);
            else
                length += snprintf(to, room, parts[part], number);
        }
        SAY("%d %s", length, quoted(text));
    }
}
