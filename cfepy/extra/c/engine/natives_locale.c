/* The locale "C", which is the only one here, and wide characters in it: what the streams of C++ call. */
#define _GNU_SOURCE
#include "engine.h"

#include <langinfo.h>
#include <locale.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <wchar.h>
#include <wctype.h>

extern double __strtod_l(const char *, char **, locale_t);
extern float __strtof_l(const char *, char **, locale_t);

#define TEXT(number) ((char *)call->arguments[number])
#define WIDE(number) ((wchar_t *)call->arguments[number])

static locale_t only(void)
{
    static locale_t made;
    if (made == NULL)
        made = newlocale(LC_ALL_MASK, "C", NULL);
    return made;
}

NATIVE(the_locale) { return (uint64_t)only(); }
NATIVE(nothing) { return 0; }
NATIVE(one_byte) { return 1; }
NATIVE(name_of_locale)
{
    return TEXT(1) == NULL || strcmp(TEXT(1), "C") == 0 || strcmp(TEXT(1), "POSIX") == 0 || *TEXT(1) == 0
               ? (uint64_t)nl_langinfo_l(_NL_LOCALE_NAME(LC_ALL), only())
               : 0;
}

NATIVE(new_locale)
{
    const char *name = TEXT(1);
    return name == NULL || strcmp(name, "C") == 0 || strcmp(name, "POSIX") == 0 || *name == 0 ? (uint64_t)only() : 0;
}

NATIVE(double_of_text)
{
    call->float_result = __strtod_l(TEXT(0), (char **)POINTER(1), only());
    return 0;
}

NATIVE(float_of_text)
{
    float value = __strtof_l(TEXT(0), (char **)POINTER(1), only());
    call->float_result = 0;
    memcpy(&call->float_result, &value, sizeof value);
    return 0;
}

NATIVE(collate) { return (uint64_t)(int64_t)strcmp(TEXT(0), TEXT(1)); }
NATIVE(transform)
{
    size_t size = strlen(TEXT(1));
    if (WORD(2) > 0) {
        strncpy(TEXT(0), TEXT(1), WORD(2) - 1);
        TEXT(0)[WORD(2) - 1] = 0;
    }
    return size;
}
NATIVE(fact) { return (uint64_t)nl_langinfo_l((nl_item)WORD(0), only()); }
NATIVE(class_of_name) { return wctype_l(TEXT(0), only()); }
NATIVE(is_of_class) { return (uint64_t)(int64_t)iswctype_l((wint_t)WORD(0), (wctype_t)WORD(1), only()); }
NATIVE(wide_upper) { return towupper_l((wint_t)WORD(0), only()); }
NATIVE(wide_lower) { return towlower_l((wint_t)WORD(0), only()); }
NATIVE(wide_of_byte) { return (int)WORD(0) >= 0 && (int)WORD(0) < 128 ? WORD(0) : WEOF; }
NATIVE(byte_of_wide) { return (int)WORD(0) >= 0 && (int)WORD(0) < 128 ? WORD(0) : (uint64_t)(int64_t)EOF; }
NATIVE(wide_copy) { return (uint64_t)wmemcpy(WIDE(0), WIDE(1), WORD(2)); }
NATIVE(wide_move) { return (uint64_t)wmemmove(WIDE(0), WIDE(1), WORD(2)); }
NATIVE(wide_set) { return (uint64_t)wmemset(WIDE(0), (wchar_t)WORD(1), WORD(2)); }
NATIVE(wide_compare) { return (uint64_t)(int64_t)wmemcmp(WIDE(0), WIDE(1), WORD(2)); }
NATIVE(wide_find) { return (uint64_t)wmemchr(WIDE(0), (wchar_t)WORD(1), WORD(2)); }
NATIVE(wide_length) { return wcslen(WIDE(0)); }
NATIVE(wide_compare_texts) { return (uint64_t)(int64_t)wcscmp(WIDE(0), WIDE(1)); }

HIDDEN const NativeRow natives_of_locale[] = {
    {"newlocale", new_locale},
    {"__newlocale", new_locale},
    {"uselocale", the_locale},
    {"__uselocale", the_locale},
    {"__duplocale", the_locale},
    {"freelocale", nothing},
    {"__freelocale", nothing},
    {"setlocale", name_of_locale},
    {"__ctype_get_mb_cur_max", one_byte},
    {"__strtod_l", double_of_text},
    {"__strtof_l", float_of_text},
    {"__strcoll_l", collate},
    {"__strxfrm_l", transform},
    {"__nl_langinfo_l", fact},
    {"__wctype_l", class_of_name},
    {"__iswctype_l", is_of_class},
    {"__towupper_l", wide_upper},
    {"__towlower_l", wide_lower},
    {"btowc", wide_of_byte},
    {"wctob", byte_of_wide},
    {"wmemcpy", wide_copy},
    {"wmemmove", wide_move},
    {"wmemset", wide_set},
    {"wmemcmp", wide_compare},
    {"wmemchr", wide_find},
    {"wcslen", wide_length},
    {"wcscmp", wide_compare_texts},
    {NULL},
};
