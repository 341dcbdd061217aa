/* The locale "C", which is the only one here; most of this is what the streams of C++ call. */
#define _GNU_SOURCE
#include "natives.h"

#include <langinfo.h>
#include <limits.h>
#include <locale.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <wchar.h>
#include <wctype.h>

extern double __strtod_l(const char *, char **, locale_t);
extern float __strtof_l(const char *, char **, locale_t);

HIDDEN locale_t only_locale(void)
{
    static locale_t made;
    if (made == NULL)
        made = newlocale(LC_ALL_MASK, "C", NULL);
    return made;
}

NATIVE(the_locale) { return (uint64_t)only_locale(); }
NATIVE(nothing) { return 0; }
NATIVE(one_byte) { return 1; }
NATIVE(name_of_locale)
{
    return TEXT(1) == NULL || strcmp(TEXT(1), "C") == 0 || strcmp(TEXT(1), "POSIX") == 0 || *TEXT(1) == 0
               ? (uint64_t)STATE->name_of_locale
               : 0;
}

NATIVE(new_locale)
{
    const char *name = TEXT(1);
    return name == NULL || strcmp(name, "C") == 0 || strcmp(name, "POSIX") == 0 || *name == 0 ? (uint64_t)only_locale() : 0;
}

NATIVE(double_of_text)
{
    call->float_result = __strtod_l(TEXT(0), (char **)POINTER(1), only_locale());
    return 0;
}

NATIVE(float_of_text)
{
    float value = __strtof_l(TEXT(0), (char **)POINTER(1), only_locale());
    call->float_result = 0;
    memcpy(&call->float_result, &value, sizeof value);
    return 0;
}

NATIVE(collate) { return (uint64_t)(int64_t)strcmp(TEXT(0), TEXT(1)); }
NATIVE(transform)
{
    size_t size = strlen(TEXT(1));
    memcpy(TEXT(0), TEXT(1), size < WORD(2) ? size + 1 : WORD(2));
    return size;
}
NATIVE(fact) { return (uint64_t)nl_langinfo_l((nl_item)WORD(0), only_locale()); }
NATIVE(class_of_name) { return wctype_l(TEXT(0), only_locale()); }
NATIVE(is_of_class) { return (uint64_t)(int64_t)iswctype_l((wint_t)WORD(0), (wctype_t)WORD(1), only_locale()); }
NATIVE(wide_upper) { return towupper_l((wint_t)WORD(0), only_locale()); }
NATIVE(wide_lower) { return towlower_l((wint_t)WORD(0), only_locale()); }
NATIVE(long_double_of_text)
{
    long double value = strtold_l(TEXT(0), (char **)POINTER(1), only_locale());
    memcpy(call->long_result, &value, sizeof value);
    call->gives_long = 1;
    return 0;
}

NATIVE(conventions) { return (uint64_t)&STATE->conventions; }

/* What libc has from its start on. Numbers that a locale does not say are CHAR_MAX, texts are empty. */
HIDDEN void state_begin(LibcState *state)
{
    memcpy(state->gmt, "GMT", 4);
    memcpy(state->utc, "UTC", 4);
    memcpy(state->point, ".", 2);
    memcpy(state->name_of_locale, "C", 2);
    state->tzname[0] = state->tzname[1] = state->utc;
    struct lconv *to = &state->conventions;
    memset(to, CHAR_MAX, sizeof *to);
    char **texts[] = {&to->thousands_sep,  &to->grouping,          &to->int_curr_symbol, &to->currency_symbol,
                      &to->mon_decimal_point, &to->mon_thousands_sep, &to->mon_grouping, &to->positive_sign,
                      &to->negative_sign};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
        *texts[i] = state->empty;
    to->decimal_point = state->point;
}

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
    {"localeconv", conventions},
    {"__strtold_l", long_double_of_text},
    {"strtold_l", long_double_of_text},
    {"strcoll", collate},
    {"strcoll_l", collate},
    {"strxfrm", transform},
    {"strxfrm_l", transform},
    {NULL},
};
