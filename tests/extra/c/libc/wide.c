/* Wide characters, and multibyte ones, in the locale C. */
#include "trial.h"

#include <wchar.h>
#include <wctype.h>

static const wchar_t *const texts[] = {L"", L"a", L"b", L"ab", L"abc", L"abcabc", L"ABC", L"a,b,,c", L"caf\xe9", L"\x20ac", L"12", L"-0x1f", L"1.5e3x", L"99999999999999999999", L"  7"};
static const char *const bytes[] = {"", "a", "abc", "\xe9", "\xc3\xa9", "ab\x80" "c", "\x7f"};

#define OFFSET(found, in) ((found) == NULL ? -1L : (long)((const wchar_t *)(found) - (const wchar_t *)(in)))
#define SIGN(value) (((value) > 0) - ((value) < 0))

static void pair(const wchar_t *a, const wchar_t *b)
{
    wchar_t room[60], *place = NULL;
    SAY("%d %d %d %d %d %zu %zu %ld %ld", SIGN(wcscmp(a, b)), SIGN(wcscoll(a, b)), SIGN(wcsncmp(a, b, 2)), SIGN(wcscasecmp(a, b)), SIGN(wcsncasecmp(a, b, 1)), wcsspn(a, b), wcscspn(a, b), OFFSET(wcsstr(a, b), a), OFFSET(wcspbrk(a, b), a));
    wcscpy(room, a);
    wcscat(room, b);
    SAY("%zu %zu %ld", wcslen(room), wcsnlen(room, 3), OFFSET(wcsncat(room, b, 1), room));
    wmemset(room, L'#', 60);
    wcsncpy(room, a, 4);
    SAY("%x %x %x %zu", (unsigned)room[0], (unsigned)room[3], (unsigned)room[4], wcsxfrm(NULL, a, 0));
    wcscpy(room, a);
    for (wchar_t *part = wcstok(room, b, &place); part != NULL; part = wcstok(NULL, b, &place))
        SAY("part %ld %zu", OFFSET(part, room), wcslen(part));
}

static void one(const wchar_t *text)
{
    wchar_t *end, room[60];
    char narrow[60] = "????????";
    errno = 0;
    SAY("%ld %ld", OFFSET(wcschr(text, L'b'), text), OFFSET(wcsrchr(text, L'b'), text));
    long value = wcstol(text, &end, 0);
    SAY("%ld %ld %lu %lld %llu", value, OFFSET(end, text), wcstoul(text, NULL, 10), wcstoll(text, NULL, 16), wcstoull(text, NULL, 8));
    SAY("%d %jd %ju", errno, wcstoimax(text, NULL, 10), wcstoumax(text, NULL, 10));
    SAY("%a %a %La", wcstod(text, &end), wcstof(text, NULL), wcstold(text, NULL));
    errno = 0;
    long count = (long)wcstombs(narrow, text, 5);
    SAY("%ld %d %s", count, errno, quoted(narrow));
    const wchar_t *from = text;
    mbstate_t state = {0};
    errno = 0;
    count = (long)wcsrtombs(narrow, &from, sizeof narrow, &state);
    SAY("%ld %d %ld %d", count, errno, OFFSET(from, text), mbsinit(&state));
    wmemcpy(room, text, wcslen(text) + 1);
    wmemmove(room + 1, room, wcslen(text) + 1);
    SAY("%d %ld", SIGN(wmemcmp(room, text, wcslen(text))), OFFSET(wmemchr(text, L'c', wcslen(text)), text));
}

static void multibyte(const char *text)
{
    wchar_t wide[20] = L"????????", single = 0x77;
    errno = 0;
    int size = mblen(text, 5), other = mbtowc(&single, text, 5);
    SAY("%s: %d %d %d %x", quoted(text), size, other, errno, (unsigned)single);
    errno = 0;
    long count = (long)mbstowcs(wide, text, 10);
    SAY("%ld %d %x", count, errno, (unsigned)wide[0]);
    mbstate_t state = {0};
    errno = 0;
    long length = (long)mbrlen(text, 5, &state), read = (long)mbrtowc(&single, text, 5, NULL);
    const char *from = text;
    errno = 0;
    count = (long)mbsrtowcs(wide, &from, 10, NULL);
    SAY("%ld %ld %ld %d", length, read, count, errno);
}

static void trial(void)
{
    EACH(const wchar_t *const, a, texts) {
        one(*a);
        EACH(const wchar_t *const, b, texts)
            if (**b != 0)
                pair(*a, *b);
    }
    EACH(const char *const, text, bytes)
        multibyte(*text);
    SAY("%d %d %d %zu", mblen(NULL, 0), mbtowc(NULL, NULL, 0), wctomb(NULL, 0), MB_CUR_MAX);
    for (int c = 0; c < 300; c++) {
        char room[20] = "";
        errno = 0;
        int size = wctomb(room, c), back = wctob((wint_t)c);
        wint_t wide = btowc(c);
        long more = (long)wcrtomb(room, (wchar_t)c, NULL);
        SAY("%d: %d %d %d %d %ld %d%d%d%d%d%d%d%d%d%d%d%d %d %d", c, size, errno, back, (int)wide, more, !!iswalnum((wint_t)c), !!iswalpha((wint_t)c), !!iswblank((wint_t)c), !!iswcntrl((wint_t)c), !!iswdigit((wint_t)c), !!iswgraph((wint_t)c),
            !!iswlower((wint_t)c), !!iswprint((wint_t)c), !!iswpunct((wint_t)c), !!iswspace((wint_t)c), !!iswupper((wint_t)c), !!iswxdigit((wint_t)c), (int)towupper((wint_t)c), (int)towlower((wint_t)c));
        SAY("%d %d", !!iswctype((wint_t)c, wctype("alpha")), (int)towctrans((wint_t)c, wctrans("toupper")));
    }
}
