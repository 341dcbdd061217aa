/* <wchar.h>, <wctype.h> and the multibyte characters of <stdlib.h>, in the locale "C". Most rows name the host's function:
 * it gets the arguments as they are. Texts of wide characters in streams are not here.
 */
#define _GNU_SOURCE
#include "natives.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <wchar.h>
#include <wctype.h>

#define WIDE(number) ((wchar_t *)call->arguments[number])

typedef uint64_t (*OfWords)(uint64_t, uint64_t, uint64_t, uint64_t);
typedef int (*IntOfWords)(uint64_t, uint64_t, uint64_t, uint64_t);

/* A function of numbers and pointers, whose result is a word, or else an int. */
NATIVE(word)
{
    libc_enter(call);
    uint64_t result = ((OfWords)self->target)(WORD(0), WORD(1), WORD(2), WORD(3));
    libc_leave(call);
    return result;
}

NATIVE(integer)
{
    libc_enter(call);
    int result = ((IntOfWords)self->target)(WORD(0), WORD(1), WORD(2), WORD(3));
    libc_leave(call);
    return (uint64_t)(int64_t)result;
}

/* Those whose names are those of other functions here, or that are only macros on some computers. */
NATIVE(wide_of_byte) { return (int)WORD(0) >= 0 && (int)WORD(0) < 128 ? WORD(0) : WEOF; }
NATIVE(byte_of_wide) { return (int)WORD(0) >= 0 && (int)WORD(0) < 128 ? WORD(0) : (uint64_t)(int64_t)EOF; }
NATIVE(is_first) { return POINTER(0) == NULL || mbsinit((const mbstate_t *)POINTER(0)); }

/* A character is a byte, and there is no state: so none of the host's is used where an application has none of its own. */
static mbstate_t no_state;
static mbstate_t *state_of(Coroutine *call, int number)
{
    memset(&no_state, 0, sizeof no_state);
    return POINTER(number) != NULL ? (mbstate_t *)POINTER(number) : &no_state;
}

NATIVE(length_of_character)
{
    libc_enter(call);
    size_t size = mbrlen(TEXT(0), WORD(1), state_of(call, 2));
    libc_leave(call);
    return size;
}

NATIVE(character)
{
    libc_enter(call);
    size_t size = mbrtowc(WIDE(0), TEXT(1), WORD(2), state_of(call, 3));
    libc_leave(call);
    return size;
}

NATIVE(bytes)
{
    libc_enter(call);
    size_t size = wcrtomb(TEXT(0), (wchar_t)WORD(1), state_of(call, 2));
    libc_leave(call);
    return size;
}

NATIVE(characters)
{
    libc_enter(call);
    size_t count = mbsrtowcs(WIDE(0), (const char **)POINTER(1), WORD(2), state_of(call, 3));
    libc_leave(call);
    return count;
}

NATIVE(all_bytes)
{
    libc_enter(call);
    size_t count = wcsrtombs(TEXT(0), (const wchar_t **)POINTER(1), WORD(2), state_of(call, 3));
    libc_leave(call);
    return count;
}

NATIVE(double_of_wide)
{
    libc_enter_to_compute(call);
    call->float_result = wcstod(WIDE(0), (wchar_t **)POINTER(1));
    libc_leave(call);
    return 0;
}

NATIVE(float_of_wide)
{
    libc_enter_to_compute(call);
    float value = wcstof(WIDE(0), (wchar_t **)POINTER(1));
    libc_leave(call);
    memcpy(&call->float_result, &value, sizeof value);
    return 0;
}

NATIVE(long_double_of_wide)
{
    libc_enter_to_compute(call);
    long double value = wcstold(WIDE(0), (wchar_t **)POINTER(1));
    libc_leave(call);
    memcpy(call->long_result, &value, sizeof value);
    call->gives_long = 1;
    return 0;
}

/* What -D_FORTIFY_SOURCE makes of these functions: the last argument is the room that the compiler knows, in characters. */
static uint64_t checked(Coroutine *call, const Function *self, bool has_room)
{
    if (has_room)
        return word(call, self);
    PyErr_SetString(fault_error, "buffer overflow detected");
    return 0;
}
NATIVE(word_in_third) { return checked(call, self, wcslen(WIDE(1)) < WORD(2)); }
NATIVE(word_in_fourth) { return checked(call, self, WORD(2) <= WORD(3)); }
NATIVE(appended_in_third) { return checked(call, self, wcslen(WIDE(0)) + wcslen(WIDE(1)) < WORD(2)); }
NATIVE(characters_in_fifth) { return WORD(2) <= WORD(4) ? characters(call, self) : checked(call, self, false); }
NATIVE(all_bytes_in_fifth) { return WORD(2) <= WORD(4) ? all_bytes(call, self) : checked(call, self, false); }
NATIVE(appended_in_fourth) { return checked(call, self, wcslen(WIDE(0)) + wcsnlen(WIDE(1), WORD(2)) < WORD(3)); }

#define WORD_OF(name) {#name, word, (void *)name}
#define INT_OF(name) {#name, integer, (void *)(name)}

HIDDEN const NativeRow natives_of_wide[] = {
    {"btowc", wide_of_byte},
    {"wctob", byte_of_wide},
    {"mbsinit", is_first},
    {"mbrlen", length_of_character},
    {"__mbrlen", length_of_character},
    {"mbrtowc", character},
    {"wcrtomb", bytes},
    {"mbsrtowcs", characters},
    {"wcsrtombs", all_bytes},
    {"wcstod", double_of_wide},
    {"wcstof", float_of_wide},
    {"wcstold", long_double_of_wide},
    {"wcscoll", integer, (void *)wcscmp},
    INT_OF(mblen), INT_OF(mbtowc), INT_OF(wctomb), WORD_OF(mbstowcs), WORD_OF(wcstombs),
    WORD_OF(wmemcpy), WORD_OF(wmemmove), WORD_OF(wmemset), INT_OF(wmemcmp), {"wmemchr", word, (void *)(wchar_t *(*)(const wchar_t *, wchar_t, size_t))wmemchr},
    WORD_OF(wcslen), WORD_OF(wcsnlen), INT_OF(wcscmp), INT_OF(wcsncmp), INT_OF(wcscasecmp), INT_OF(wcsncasecmp),
    WORD_OF(wcscpy), WORD_OF(wcsncpy), WORD_OF(wcscat), WORD_OF(wcsncat), WORD_OF(wcsxfrm), WORD_OF(wcschr),
    WORD_OF(wcsrchr), WORD_OF(wcsspn), WORD_OF(wcscspn), WORD_OF(wcspbrk), WORD_OF(wcsstr), WORD_OF(wcstok),
    WORD_OF(wcpcpy), WORD_OF(wcpncpy),
    WORD_OF(wcstol), WORD_OF(wcstoll), WORD_OF(wcstoul), WORD_OF(wcstoull), WORD_OF(wcstoimax), WORD_OF(wcstoumax),
    INT_OF(iswalnum), INT_OF(iswalpha), INT_OF(iswblank), INT_OF(iswcntrl), INT_OF(iswdigit), INT_OF(iswgraph),
    INT_OF(iswlower), INT_OF(iswprint), INT_OF(iswpunct), INT_OF(iswspace), INT_OF(iswupper), INT_OF(iswxdigit),
    INT_OF(iswctype), WORD_OF(wctype), INT_OF(towlower), INT_OF(towupper), INT_OF(towctrans), WORD_OF(wctrans),
    {"__wcscpy_chk", word_in_third, (void *)wcscpy},
    {"__wcpcpy_chk", word_in_third, (void *)wcpcpy},
    {"__wcsncpy_chk", word_in_fourth, (void *)wcsncpy},
    {"__wcpncpy_chk", word_in_fourth, (void *)wcpncpy},
    {"__wmemcpy_chk", word_in_fourth, (void *)wmemcpy},
    {"__wmemmove_chk", word_in_fourth, (void *)wmemmove},
    {"__wmemset_chk", word_in_fourth, (void *)wmemset},
    {"__wcscat_chk", appended_in_third, (void *)wcscat},
    {"__wcsncat_chk", appended_in_fourth, (void *)wcsncat},
    {"__mbsrtowcs_chk", characters_in_fifth},
    {"__wcsrtombs_chk", all_bytes_in_fifth},
    {"__wctomb_chk", integer, (void *)wctomb},
    {"__wcrtomb_chk", bytes},
    {"__mbstowcs_chk", word_in_fourth, (void *)mbstowcs},
    {"__wcstombs_chk", word_in_fourth, (void *)wcstombs},
    {NULL},
};
