/* What stands for libc in an application: memory, texts and malloc. Nothing here knows the host's clock, files or random
 * numbers; what an application wants beyond this is told when it is loaded.
 */
#define _GNU_SOURCE
#include "natives.h"

#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/types.h>

/* ---- accesses ----------------------------------------------------------------------------------------------------- */

/* Whether Python has to let others in before these accesses; they are noted otherwise. */
HIDDEN bool waits_for_others(Coroutine *call, const Range *ranges, int count)
{
    for (int i = 0; i < count; i++)
        if (ranges[i].size > 0 && races_asks_first(call, (uint64_t)ranges[i].at, ranges[i].size))
            return true;
    for (int i = 0; i < count; i++)
        if (ranges[i].size > 0)
            races_note(call, (uint64_t)ranges[i].at, ranges[i].size, ranges[i].is_write, false);
    return false;
}

/* How far a function looks: to the end of a text, and where it may look at so many characters only. */
static size_t whole(const char *text) { return strlen(text) + 1; }
static size_t at_most(const char *text, size_t most)
{
    size_t size = strnlen(text, most);
    return size < most ? size + 1 : most;
}
/* To a place that it has found, or else to the end. */
static size_t up_to(const char *text, const char *found) { return found == NULL ? whole(text) : (size_t)(found - text) + 1; }
static size_t compared(const char *one, const char *other, size_t most, bool any_case)
{
    size_t size = 0;
    while (size < most) {
        unsigned char first = (unsigned char)one[size], second = (unsigned char)other[size];
        size++;
        if (first == 0 || (any_case ? tolower_l(first, only_locale()) != tolower_l(second, only_locale()) : first != second))
            break;
    }
    return size;
}

/* ---- memory and texts --------------------------------------------------------------------------------------------- */

NATIVE(memory_copy) WITH_ACCESSES(memcpy(POINTER(0), POINTER(1), WORD(2)), WRITES(POINTER(0), WORD(2)), READS(POINTER(1), WORD(2)))
NATIVE(memory_move) WITH_ACCESSES(memmove(POINTER(0), POINTER(1), WORD(2)), WRITES(POINTER(0), WORD(2)), READS(POINTER(1), WORD(2)))
NATIVE(memory_set) WITH_ACCESSES(memset(POINTER(0), (int)WORD(1), WORD(2)), WRITES(POINTER(0), WORD(2)))
NATIVE(memory_compare)
WITH_ACCESSES((int64_t)memcmp(POINTER(0), POINTER(1), WORD(2)), READS(POINTER(0), WORD(2)), READS(POINTER(1), WORD(2)))
NATIVE(memory_find)
{
    char *found = memchr(POINTER(0), (int)WORD(1), WORD(2));
    WITH_ACCESSES(found, READS(POINTER(0), found == NULL ? WORD(2) : (size_t)(found - TEXT(0)) + 1))
}

NATIVE(text_length) WITH_ACCESSES(strlen(TEXT(0)), READS(TEXT(0), whole(TEXT(0))))
NATIVE(text_length_limited) WITH_ACCESSES(strnlen(TEXT(0), WORD(1)), READS(TEXT(0), at_most(TEXT(0), WORD(1))))

#define COMPARES(result, most, any_case)                                           \
    WITH_ACCESSES((int64_t)(result), READS(TEXT(0), compared(TEXT(0), TEXT(1), most, any_case)), \
                  READS(TEXT(1), compared(TEXT(0), TEXT(1), most, any_case)))
NATIVE(text_compare) COMPARES(strcmp(TEXT(0), TEXT(1)), SIZE_MAX, false)
NATIVE(text_compare_limited) COMPARES(strncmp(TEXT(0), TEXT(1), WORD(2)), WORD(2), false)
NATIVE(text_compare_any_case) COMPARES(strcasecmp_l(TEXT(0), TEXT(1), only_locale()), SIZE_MAX, true)
NATIVE(text_compare_any_case_limited) COMPARES(strncasecmp_l(TEXT(0), TEXT(1), WORD(2), only_locale()), WORD(2), true)

NATIVE(text_copy)
WITH_ACCESSES(strcpy(TEXT(0), TEXT(1)), WRITES(TEXT(0), whole(TEXT(1))), READS(TEXT(1), whole(TEXT(1))))
NATIVE(text_copy_limited)
WITH_ACCESSES(strncpy(TEXT(0), TEXT(1), WORD(2)), WRITES(TEXT(0), WORD(2)), READS(TEXT(1), at_most(TEXT(1), WORD(2))))
NATIVE(text_append)
WITH_ACCESSES(strcat(TEXT(0), TEXT(1)), READS(TEXT(0), whole(TEXT(0))), READS(TEXT(1), whole(TEXT(1))),
              WRITES(TEXT(0) + strlen(TEXT(0)), whole(TEXT(1))))
NATIVE(text_append_limited)
WITH_ACCESSES(strncat(TEXT(0), TEXT(1), WORD(2)), READS(TEXT(0), whole(TEXT(0))), READS(TEXT(1), at_most(TEXT(1), WORD(2))),
              WRITES(TEXT(0) + strlen(TEXT(0)), strnlen(TEXT(1), WORD(2)) + 1))

#define FINDS(function)                                        \
    {                                                          \
        char *found = function(TEXT(0), (int)WORD(1));         \
        WITH_ACCESSES(found, READS(TEXT(0), up_to(TEXT(0), found))) \
    }
NATIVE(text_find) FINDS(strchr)
NATIVE(text_find_last) WITH_ACCESSES(strrchr(TEXT(0), (int)WORD(1)), READS(TEXT(0), whole(TEXT(0))))
NATIVE(text_find_text)
{
    char *found = strstr(TEXT(0), TEXT(1));
    WITH_ACCESSES(found, READS(TEXT(0), found == NULL ? whole(TEXT(0)) : (size_t)(found - TEXT(0)) + strlen(TEXT(1))),
                  READS(TEXT(1), whole(TEXT(1))))
}
NATIVE(text_find_any)
{
    char *found = strpbrk(TEXT(0), TEXT(1));
    WITH_ACCESSES(found, READS(TEXT(0), up_to(TEXT(0), found)), READS(TEXT(1), whole(TEXT(1))))
}
NATIVE(text_span)
WITH_ACCESSES(strspn(TEXT(0), TEXT(1)), READS(TEXT(0), strspn(TEXT(0), TEXT(1)) + 1), READS(TEXT(1), whole(TEXT(1))))
NATIVE(text_span_without)
WITH_ACCESSES(strcspn(TEXT(0), TEXT(1)), READS(TEXT(0), strcspn(TEXT(0), TEXT(1)) + 1), READS(TEXT(1), whole(TEXT(1))))

NATIVE(split_with_place) { return (uint64_t)strtok_r(TEXT(0), TEXT(1), (char **)POINTER(2)); }
/* The rest is kept for the whole processor, as libc keeps it for a process: tasks that split at a time have a race. */
NATIVE(split)
WITH_ACCESSES(strtok_r(TEXT(0), TEXT(1), &STATE->rest_of_strtok), WRITES(&STATE->rest_of_strtok, sizeof(char *)))
NATIVE(split_off) { return (uint64_t)strsep((char **)POINTER(0), TEXT(1)); }

NATIVE(memory_copy_to_end)
WITH_ACCESSES(mempcpy(POINTER(0), POINTER(1), WORD(2)), WRITES(POINTER(0), WORD(2)), READS(POINTER(1), WORD(2)))
NATIVE(text_copy_to_end)
WITH_ACCESSES(stpcpy(TEXT(0), TEXT(1)), WRITES(TEXT(0), whole(TEXT(1))), READS(TEXT(1), whole(TEXT(1))))
NATIVE(text_copy_limited_to_end)
WITH_ACCESSES(stpncpy(TEXT(0), TEXT(1), WORD(2)), WRITES(TEXT(0), WORD(2)), READS(TEXT(1), at_most(TEXT(1), WORD(2))))
NATIVE(memory_copy_until) { return (uint64_t)memccpy(POINTER(0), POINTER(1), (int)WORD(2), WORD(3)); }
NATIVE(memory_find_last) { return (uint64_t)memrchr(POINTER(0), (int)WORD(1), WORD(2)); }
NATIVE(memory_find_raw) { return (uint64_t)rawmemchr(POINTER(0), (int)WORD(1)); }
NATIVE(memory_find_memory) { return (uint64_t)memmem(POINTER(0), WORD(1), POINTER(2), WORD(3)); }
NATIVE(text_find_or_end) { return (uint64_t)strchrnul(TEXT(0), (int)WORD(1)); }
NATIVE(text_find_text_any_case) { return (uint64_t)strcasestr(TEXT(0), TEXT(1)); }
NATIVE(memory_clear_all)
{
    memset(POINTER(0), 0, WORD(1));
    return 0;
}
NATIVE(memory_copy_back)
{
    memmove(POINTER(1), POINTER(0), WORD(2));
    return 0;
}
NATIVE(first_bit) { return (uint64_t)__builtin_ffs((int)WORD(0)); }
NATIVE(first_bit_long) { return (uint64_t)__builtin_ffsl((long)WORD(0)); }
NATIVE(copy_and_tell_size)
{
    size_t size = strlen(TEXT(1)), kept = size < WORD(2) ? size : WORD(2) - 1;
    if (WORD(2) > 0) {
        memcpy(TEXT(0), TEXT(1), kept);
        TEXT(0)[kept] = 0;
    }
    return size;
}
NATIVE(append_and_tell_size)
{
    size_t had = strnlen(TEXT(0), WORD(2)), size = strlen(TEXT(1)), room = WORD(2) - had;
    if (room > 0) {
        size_t kept = size < room ? size : room - 1;
        memcpy(TEXT(0) + had, TEXT(1), kept);
        TEXT(0)[had + kept] = 0;
    }
    return had + size;
}

NATIVE(of_character)
{
    int character = (int)WORD(0);
    return character < -128 || character > 255 ? 0 : (uint64_t)(int64_t)((int (*)(int, locale_t))self->target)(character, only_locale());
}
NATIVE(to_upper) { return (uint64_t)(int64_t)toupper_l((int)WORD(0), only_locale()); }
NATIVE(to_lower) { return (uint64_t)(int64_t)tolower_l((int)WORD(0), only_locale()); }
NATIVE(to_ascii) { return WORD(0) & 0x7F; }
NATIVE(is_ascii) { return ((int)WORD(0) & ~0x7F) == 0; }

/* ---- errors ------------------------------------------------------------------------------------------------------- */

extern int __xpg_strerror_r(int, char *, size_t);

/* Python has the texts that code may keep (api/text.py); these go into the caller's own array. */
NATIVE(error_text_to)
{
    char text[64];
    libc_enter(call);
    int status = __xpg_strerror_r((int)WORD(0), text, sizeof text);
    libc_leave(call);
    size_t size = strlen(text), kept = size < WORD(2) ? size : WORD(2) - 1;
    if (WORD(2) > 0) {
        memcpy(TEXT(1), text, kept);
        TEXT(1)[kept] = 0;
    }
    return (uint64_t)(status != 0 ? status : size < WORD(2) ? 0 : ERANGE);
}

HIDDEN PyObject *error_text(PyObject *module, PyObject *number)
{
    long value = PyLong_AsLong(number);
    if (value == -1 && PyErr_Occurred())
        return NULL;
    char text[64];
    locale_t before = uselocale(only_locale());
    int status = __xpg_strerror_r((int)value, text, sizeof text);
    uselocale(before);
    return Py_BuildValue("(sO)", text, status == 0 ? Py_True : Py_False);
}

/* ---- malloc ------------------------------------------------------------------------------------------------------- */

static uint64_t take_aligned(Coroutine *call, uint64_t size, uint64_t alignment)
{
    if (call->table->heap == NULL)
        return 0;
    heap_own(call->table->heap, call->owner);
    uint64_t made = heap_take_any(call->table->heap, size ? size : 1, alignment);
    if (made == 0)
        set_application_errno(call, ENOMEM);
    return made;
}

static uint64_t take(Coroutine *call, uint64_t size) { return take_aligned(call, size, 1); }

/* Give a block back; what is wrong with it is a fault of the caller's. */
static bool give(Coroutine *call, uint64_t address, const char *function)
{
    size_t size = heap_size_of(call->table->heap, address);
    int given = heap_give(call->table->heap, address);
    if (given < 0)
        PyErr_Format(fault_error, "%s() of %p, a block of %zu bytes that was written %s", function, (void *)address, size,
                     heap_damage(given));
    else if (given == 0)
        PyErr_Format(fault_error, "%s() of %p, which malloc did not give, or which was freed", function, (void *)address);
    return given > 0;
}

NATIVE(allocate) { return take(call, WORD(0)); }

NATIVE(allocate_many)
{
    uint64_t size;
    bool is_too_large = __builtin_mul_overflow(WORD(0), WORD(1), &size);
    uint64_t made = take(call, is_too_large ? UINT64_MAX : size);
    return made == 0 ? 0 : (uint64_t)memset((void *)made, 0, size);
}

static bool is_power_of_two(uint64_t number) { return number != 0 && (number & (number - 1)) == 0; }

/* Also the operator new of libstdc++ for types that want more than 16 bytes calls it. */
NATIVE(allocate_aligned)
{
    if (is_power_of_two(WORD(0)))
        return take_aligned(call, WORD(1), WORD(0));
    set_application_errno(call, EINVAL);
    return 0;
}

NATIVE(allocate_aligned_to)
{
    if (!is_power_of_two(WORD(1)) || WORD(1) % sizeof(void *) != 0)
        return EINVAL;
    uint64_t made = take_aligned(call, WORD(2), WORD(1));
    if (made == 0)
        return ENOMEM;
    if (engine_copy(POINTER(0), &made, sizeof made))
        PyErr_Format(fault_error, "posix_memalign(): bad address %p", (void *)WORD(0));
    return 0;
}

NATIVE(let_go)
{
    if (WORD(0) != 0)
        give(call, WORD(0), "free");
    return 0;
}

static uint64_t take_again(Coroutine *call, uint64_t size)
{
    size_t had = WORD(0) ? heap_size_of(call->table->heap, WORD(0)) : 0;
    if (WORD(0) != 0 && had == 0) {
        PyErr_Format(fault_error, "realloc() of %p, which malloc did not give, or which was freed", (void *)WORD(0));
        return 0;
    }
    if (WORD(0) != 0 && size == 0) { /* as glibc, where it is free() then */
        give(call, WORD(0), "realloc");
        return 0;
    }
    uint64_t made = take(call, size);
    if (made != 0 && WORD(0) != 0) {
        memcpy((void *)made, POINTER(0), had < size ? had : size);
        give(call, WORD(0), "realloc");
    }
    return made;
}

NATIVE(allocate_again) { return take_again(call, WORD(1)); }

NATIVE(allocate_again_many)
{
    uint64_t size;
    if (!__builtin_mul_overflow(WORD(1), WORD(2), &size))
        return take_again(call, size);
    set_application_errno(call, ENOMEM);
    return 0;
}

static uint64_t copy_of(Coroutine *call, uint64_t most)
{
    size_t size = strnlen(TEXT(0), most);
    uint64_t made = take(call, size + 1);
    if (made != 0) {
        memcpy((void *)made, TEXT(0), size);
        ((char *)made)[size] = 0;
    }
    return made;
}

NATIVE(copy_text) { return copy_of(call, INT64_MAX); }
NATIVE(copy_text_limited) { return copy_of(call, WORD(1)); }

/* The tables of isalpha() and its kin: copies in the arena, since an address of the host is another in each run. */
NATIVE(ctype_table) { return call->table->ctype[0]; }
NATIVE(upper_table) { return call->table->ctype[1]; }
NATIVE(lower_table) { return call->table->ctype[2]; }

/* Code of the compiler asks so whether the processor has more instructions than all of its kind: it does without. */
NATIVE(no_more_than_all_have) { return 0; }

NATIVE(smashed)
{
    PyErr_SetString(fault_error, "stack smashing detected: a local array was written past its end");
    return 0;
}

NATIVE(overflowed)
{
    PyErr_SetString(fault_error, "buffer overflow detected");
    return 0;
}

NATIVE(asserted)
{
    PyObject *what = text_at(WORD(0)), *file = text_at(WORD(1));
    if (what != NULL && file != NULL)
        PyErr_Format(fault_error, "assertion failed: %U (%U:%u)", what, file, (unsigned)WORD(2));
    Py_XDECREF(what);
    Py_XDECREF(file);
    return 0;
}

/* What -D_FORTIFY_SOURCE makes of these functions: the room that the compiler knows is held to. */
NATIVE(copy_checked) { return WORD(2) > WORD(3) ? overflowed(call, self) : memory_copy(call, self); }
NATIVE(move_checked) { return WORD(2) > WORD(3) ? overflowed(call, self) : memory_move(call, self); }
NATIVE(copy_to_end_checked) { return WORD(2) > WORD(3) ? overflowed(call, self) : memory_copy_to_end(call, self); }
NATIVE(clear_checked) { return WORD(1) > WORD(2) ? overflowed(call, self) : memory_clear_all(call, self); }
NATIVE(set_checked) { return WORD(2) > WORD(3) ? overflowed(call, self) : memory_set(call, self); }
NATIVE(text_copy_checked) { return strlen(TEXT(1)) >= WORD(2) ? overflowed(call, self) : text_copy(call, self); }
NATIVE(text_copy_to_end_checked) { return strlen(TEXT(1)) >= WORD(2) ? overflowed(call, self) : text_copy_to_end(call, self); }
NATIVE(text_limited_to_end_checked) { return WORD(2) > WORD(3) ? overflowed(call, self) : text_copy_limited_to_end(call, self); }
NATIVE(copy_told_checked) { return WORD(2) > WORD(3) ? overflowed(call, self) : copy_and_tell_size(call, self); }
NATIVE(append_told_checked) { return WORD(2) > WORD(3) ? overflowed(call, self) : append_and_tell_size(call, self); }
NATIVE(text_limited_checked) { return WORD(2) > WORD(3) ? overflowed(call, self) : text_copy_limited(call, self); }
NATIVE(text_append_checked)
{
    return strlen(TEXT(0)) + strlen(TEXT(1)) >= WORD(2) ? overflowed(call, self) : text_append(call, self);
}
NATIVE(append_limited_checked)
{
    return strlen(TEXT(0)) + strnlen(TEXT(1), WORD(2)) >= WORD(3) ? overflowed(call, self) : text_append_limited(call, self);
}
HIDDEN const NativeRow natives_of_libc[] = {
    {"memcpy", memory_copy},
    {"memmove", memory_move},
    {"memset", memory_set},
    {"memcmp", memory_compare},
    {"memchr", memory_find},
    {"strlen", text_length},
    {"strnlen", text_length_limited},
    {"OS_strnlen", text_length_limited},
    {"strcmp", text_compare},
    {"strncmp", text_compare_limited},
    {"strcasecmp", text_compare_any_case},
    {"strncasecmp", text_compare_any_case_limited},
    {"strcpy", text_copy},
    {"strncpy", text_copy_limited},
    {"strcat", text_append},
    {"strncat", text_append_limited},
    {"strchr", text_find},
    {"strrchr", text_find_last},
    {"strstr", text_find_text},
    {"strpbrk", text_find_any},
    {"strspn", text_span},
    {"strcspn", text_span_without},
    {"strtok", split},
    {"strtok_r", split_with_place},
    {"__strtok_r", split_with_place},
    {"strsep", split_off},
    {"__strsep", split_off},
    {"mempcpy", memory_copy_to_end},
    {"__mempcpy", memory_copy_to_end},
    {"stpcpy", text_copy_to_end},
    {"__stpcpy", text_copy_to_end},
    {"stpncpy", text_copy_limited_to_end},
    {"memccpy", memory_copy_until},
    {"memrchr", memory_find_last},
    {"rawmemchr", memory_find_raw},
    {"__rawmemchr", memory_find_raw},
    {"memmem", memory_find_memory},
    {"strchrnul", text_find_or_end},
    {"strcasestr", text_find_text_any_case},
    {"strlcpy", copy_and_tell_size},
    {"strlcat", append_and_tell_size},
    {"index", text_find},
    {"rindex", text_find_last},
    {"bzero", memory_clear_all},
    {"explicit_bzero", memory_clear_all},
    {"bcopy", memory_copy_back},
    {"bcmp", memory_compare},
    {"ffs", first_bit},
    {"ffsl", first_bit_long},
    {"ffsll", first_bit_long},
    {"__xpg_strerror_r", error_text_to},
    {"isalnum", of_character, (void *)isalnum_l},
    {"isalpha", of_character, (void *)isalpha_l},
    {"isblank", of_character, (void *)isblank_l},
    {"iscntrl", of_character, (void *)iscntrl_l},
    {"isdigit", of_character, (void *)isdigit_l},
    {"isgraph", of_character, (void *)isgraph_l},
    {"islower", of_character, (void *)islower_l},
    {"isprint", of_character, (void *)isprint_l},
    {"ispunct", of_character, (void *)ispunct_l},
    {"isspace", of_character, (void *)isspace_l},
    {"isupper", of_character, (void *)isupper_l},
    {"isxdigit", of_character, (void *)isxdigit_l},
    {"isascii", is_ascii},
    {"toascii", to_ascii},
    {"toupper", to_upper},
    {"tolower", to_lower},
    {"malloc", allocate},
    {"calloc", allocate_many},
    {"realloc", allocate_again},
    {"reallocarray", allocate_again_many},
    {"aligned_alloc", allocate_aligned},
    {"memalign", allocate_aligned},
    {"posix_memalign", allocate_aligned_to},
    {"free", let_go},
    {"strdup", copy_text},
    {"strndup", copy_text_limited},
    {"__getauxval", no_more_than_all_have},
    {"__assert_fail", asserted},
    {"__stack_chk_fail", smashed},
    {"__ctype_b_loc", ctype_table},
    {"__ctype_toupper_loc", upper_table},
    {"__ctype_tolower_loc", lower_table},
    {"__memcpy_chk", copy_checked},
    {"__memmove_chk", move_checked},
    {"__memset_chk", set_checked},
    {"__strcpy_chk", text_copy_checked},
    {"__strncpy_chk", text_limited_checked},
    {"__strcat_chk", text_append_checked},
    {"__strncat_chk", append_limited_checked},
    {"__strlcpy_chk", copy_told_checked},
    {"__strlcat_chk", append_told_checked},
    {"__mempcpy_chk", copy_to_end_checked},
    {"__stpcpy_chk", text_copy_to_end_checked},
    {"__stpncpy_chk", text_limited_to_end_checked},
    {"__explicit_bzero_chk", clear_checked},
    {NULL},
};
