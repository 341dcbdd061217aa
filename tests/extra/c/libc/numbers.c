/* Numbers out of texts, quotients, rand(). */
#include "trial.h"

#include <arpa/inet.h>

static const char *const texts[] = {
    "", " ", "0", "-0", "+0", "7", "-7", "+7", " \t\n\v\f\r12", "12abc", "abc", "-", "+", "+-5", "0x", "0x1F", "0XfFg", "-0x10", "0xg", "077", "08",
    "0b101", "0B11", "-0b1", "0b", "0b2", "zz", "Zz9", "1e5", "2147483647", "2147483648", "-2147483648", "-2147483649", "4294967295", "4294967296",
    "-4294967296", "9223372036854775807", "9223372036854775808", "-9223372036854775808", "-9223372036854775809", "18446744073709551615",
    "18446744073709551616", "-18446744073709551615", "-18446744073709551616", "99999999999999999999", "-99999999999999999999", "1.5", "\xc3\xa9" "1", "1\xa0" "2",
    ".", ".5", "5.", "-.5e1", "1e", "1e+", "1e-3", "1e999", "-1e999", "1e-999", "-1e-999", "4.9e-324", "2e-324", "2.2250738585072011e-308", "2.2250738585072014e-308",
    "1.7976931348623157e308", "1.7976931348623159e308", "3.4028235e38", "3.4028236e38", "1e-46", "1.4e-45", "1e5000", "1e-5000", "0x1p3", "0x1.8p-1", "0x.p1", "0x1p", "0x1p99999",
    "0x1.fffffffffffffp1023", "0x1.fffffffffffff8p1023", "inf", "-INF", "infinity", "infinit", "nan", "-nan", "nan(123)", "nan(", "NAN(x_1)y", "1,5", "1'000",
    "123456789012345678901234567890123456789012345678901234567890", "0.1", "0.30000000000000004", "9007199254740993", "1_000",
};
static const char *const pieces[] = {"0", "1", "7", "9", "8", "f", "x", "0x", "b", "e", "E", "p", ".", "-", "+", " ", "\t", "inf", "nan", "(", ")", "_", "999999", "000000", "e30", "e-30", "g", "z"};
static const int bases[] = {0, 2, 8, 10, 16, 36, 3, 1, 37, -1};

extern long isoc23_strtol(const char *, char **, int) __asm__("__isoc23_strtol");

#define INTEGER(function, text, base)                                                                \
    do {                                                                                             \
        char *end = NULL;                                                                            \
        errno = 0;                                                                                   \
        long long value = (long long)function(text, &end, base);                                     \
        SAY(#function " %s %d: %lld %ld %d", quoted(text), base, value, end == NULL ? -1L : (long)(end - (text)), errno); \
    } while (0)
#define REAL(function, type, form, text)                                                             \
    do {                                                                                             \
        char *end = NULL;                                                                            \
        errno = 0;                                                                                   \
        type value = function(text, &end);                                                           \
        SAY(#function " %s: " form " %ld %d", quoted(text), value, (long)(end - (text)), errno);      \
    } while (0)

static void tell(const char *text, int base)
{
    INTEGER(strtol, text, base);
    INTEGER(strtoul, text, base);
    INTEGER(strtoll, text, base);
    INTEGER(strtoull, text, base);
    INTEGER(strtoimax, text, base);
    INTEGER(strtoumax, text, base);
}

static void tell_real(const char *text)
{
    REAL(strtod, double, "%a", text);
    REAL(strtof, float, "%a", text);
    REAL(strtold, long double, "%La", text);
    errno = 0;
    SAY("ato %s: %d %ld %lld %a", quoted(text), atoi(text), atol(text), atoll(text), atof(text));
}

static void trial(void)
{
    EACH(const char *const, text, texts) {
        EACH(const int, base, bases)
            tell(*text, *base);
        tell_real(*text);
        strtol(*text, NULL, 10);
        strtod(*text, NULL);
    }
    for (int i = 0; i < 600; i++) {
        const char *text = any_text(pieces, COUNT(pieces), 6);
        tell(text, bases[any(6)]);
        tell_real(text);
    }
#ifdef BINARY
    for (const char *const *text = texts; text < texts + COUNT(texts); text++)
        for (const int *base = bases; base < bases + 2; base++)
            INTEGER(isoc23_strtol, *text, *base);
#endif
    static const long numbers[] = {0, 1, -1, 2, -2, 7, -7, 1000000007, INT_MAX, INT_MIN + 1};
    EACH(const long, a, numbers) {
        SAY("abs %ld: %d %ld %lld %jd", *a, abs((int)*a), labs(*a), llabs(*a * 1000000007), imaxabs(*a));
        EACH(const long, b, numbers) {
            if (*b == 0)
                continue;
            div_t small = div((int)*a, (int)*b);
            ldiv_t large = ldiv(*a * 1000003, *b);
            lldiv_t larger = lldiv(*a, *b);
            imaxdiv_t most = imaxdiv(*a * 99, *b);
            SAY("div %ld %ld: %d %d, %ld %ld, %lld %lld, %jd %jd", *a, *b, small.quot, small.rem, large.quot, large.rem, larger.quot, larger.rem, most.quot, most.rem);
        }
    }
    for (int i = 0; i < 100; i++)
        SAY("rand %d", rand());
    static const unsigned seeds[] = {0, 1, 2, 3, 42, 123456789, 2147483647, 2147483648u, UINT_MAX};
    EACH(const unsigned, seed, seeds) {
        srand(*seed);
        unsigned state = *seed;
        for (int i = 0; i < 40; i++)
            SAY("seed %u: %d %ld %d %u", *seed, rand(), random(), rand_r(&state), state);
    }
    EACH(const unsigned, seed, seeds)
        SAY("%08x %04x %08x %04x", htonl(*seed), htons((uint16_t)*seed), ntohl(*seed + 77), ntohs((uint16_t)(*seed * 3)));
    srandom(5);
    SAY("%d", rand());
}
