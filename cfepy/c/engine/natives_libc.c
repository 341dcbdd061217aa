/* What stands for libc in an application: memory, texts, numbers. Nothing here knows the host's clock, files or random
 * numbers; what an application wants beyond this is told when it is loaded.
 */
#define _GNU_SOURCE
#include "engine.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/types.h>

#define TEXT(number) ((char *)call->arguments[number])

/* Whether Python has to let others in before these accesses; they are noted otherwise, where somebody looks at them. */
static bool waits_for_others(Coroutine *call, uint64_t written, uint64_t read, uint64_t other, uint64_t size)
{
    if (call->table->races == NULL || size == 0)
        return false;
    if (races_asks_first(call, written ? written : other, size) || (read && races_asks_first(call, read, size)))
        return true;
    if (written)
        races_note(call, written, size, true, false);
    if (read)
        races_note(call, read, size, false, false);
    if (other)
        races_note(call, other, size, false, false);
    return false;
}

NATIVE(memory_copy)
{
    return waits_for_others(call, WORD(0), WORD(1), 0, WORD(2)) ? 0 : (uint64_t)memcpy(POINTER(0), POINTER(1), WORD(2));
}
NATIVE(memory_move)
{
    return waits_for_others(call, WORD(0), WORD(1), 0, WORD(2)) ? 0 : (uint64_t)memmove(POINTER(0), POINTER(1), WORD(2));
}
NATIVE(memory_set)
{
    return waits_for_others(call, WORD(0), 0, 0, WORD(2)) ? 0 : (uint64_t)memset(POINTER(0), (int)WORD(1), WORD(2));
}
NATIVE(memory_compare)
{
    return waits_for_others(call, 0, WORD(0), WORD(1), WORD(2))
               ? 0
               : (uint64_t)(int64_t)memcmp(POINTER(0), POINTER(1), WORD(2));
}
NATIVE(memory_find) { return (uint64_t)memchr(POINTER(0), (int)WORD(1), WORD(2)); }

NATIVE(text_length) { return strlen(TEXT(0)); }
NATIVE(text_length_limited) { return strnlen(TEXT(0), WORD(1)); }
NATIVE(text_compare) { return (uint64_t)(int64_t)strcmp(TEXT(0), TEXT(1)); }
NATIVE(text_compare_limited) { return (uint64_t)(int64_t)strncmp(TEXT(0), TEXT(1), WORD(2)); }
NATIVE(text_compare_any_case) { return (uint64_t)(int64_t)strcasecmp(TEXT(0), TEXT(1)); }
NATIVE(text_compare_any_case_limited) { return (uint64_t)(int64_t)strncasecmp(TEXT(0), TEXT(1), WORD(2)); }
NATIVE(text_copy) { return (uint64_t)strcpy(TEXT(0), TEXT(1)); }
NATIVE(text_copy_limited) { return (uint64_t)strncpy(TEXT(0), TEXT(1), WORD(2)); }
NATIVE(text_append) { return (uint64_t)strcat(TEXT(0), TEXT(1)); }
NATIVE(text_append_limited) { return (uint64_t)strncat(TEXT(0), TEXT(1), WORD(2)); }
NATIVE(text_find) { return (uint64_t)strchr(TEXT(0), (int)WORD(1)); }
NATIVE(text_find_last) { return (uint64_t)strrchr(TEXT(0), (int)WORD(1)); }
NATIVE(text_find_text) { return (uint64_t)strstr(TEXT(0), TEXT(1)); }
NATIVE(text_find_any) { return (uint64_t)strpbrk(TEXT(0), TEXT(1)); }
NATIVE(text_span) { return strspn(TEXT(0), TEXT(1)); }
NATIVE(text_span_without) { return strcspn(TEXT(0), TEXT(1)); }
NATIVE(text_split) { return (uint64_t)strtok_r(TEXT(0), TEXT(1), (char **)POINTER(2)); }
NATIVE(number_of_text) { return (uint64_t)(int64_t)atoi(TEXT(0)); }
NATIVE(long_of_text) { return (uint64_t)strtol(TEXT(0), (char **)POINTER(1), (int)WORD(2)); }
NATIVE(unsigned_of_text) { return (uint64_t)strtoul(TEXT(0), (char **)POINTER(1), (int)WORD(2)); }
NATIVE(absolute) { return (uint64_t)(int64_t)abs((int)WORD(0)); }
NATIVE(to_upper) { return (uint64_t)(int64_t)toupper((int)WORD(0)); }
NATIVE(to_lower) { return (uint64_t)(int64_t)tolower((int)WORD(0)); }

NATIVE(float_of_text)
{
    call->float_result = strtod(TEXT(0), self->target != NULL ? (char **)POINTER(1) : NULL);
    return 0;
}

/* ---- printf ------------------------------------------------------------------------------------------------------- */

/* format_text answers -1 with an exception, which `run` sees after a native. */
NATIVE(format_limited) { return (uint64_t)(int64_t)format_text(call, TEXT(0), WORD(1), TEXT(2), 3); }
NATIVE(format_unlimited) { return (uint64_t)(int64_t)format_text(call, TEXT(0), INT32_MAX, TEXT(1), 2); }
NATIVE(format_list_limited) { return (uint64_t)(int64_t)format_list(call, TEXT(0), WORD(1), TEXT(2), WORD(3)); }
NATIVE(format_list_unlimited) { return (uint64_t)(int64_t)format_list(call, TEXT(0), INT32_MAX, TEXT(1), WORD(2)); }

/* ---- malloc ------------------------------------------------------------------------------------------------------- */

static uint64_t take(Coroutine *call, uint64_t size)
{
    if (call->table->heap == NULL)
        return 0;
    heap_own(call->table->heap, call->owner);
    return heap_take_any(call->table->heap, size ? size : 1);
}

/* Give a block back; what is wrong with it is a fault of the caller's. */
static bool give(Coroutine *call, uint64_t address, const char *function)
{
    int given = heap_give(call->table->heap, address);
    if (given < 0)
        PyErr_Format(fault_error, "%s() of %p, a block that was written past its end", function, (void *)address);
    else if (given == 0)
        PyErr_Format(fault_error, "%s() of %p, which malloc did not give, or which was freed", function, (void *)address);
    return given > 0;
}

NATIVE(allocate) { return take(call, WORD(0)); }

NATIVE(allocate_many)
{
    uint64_t size;
    uint64_t made = __builtin_mul_overflow(WORD(0), WORD(1), &size) ? 0 : take(call, size);
    return made == 0 ? 0 : (uint64_t)memset((void *)made, 0, size);
}

NATIVE(let_go)
{
    if (WORD(0) != 0)
        give(call, WORD(0), "free");
    return 0;
}

NATIVE(allocate_again)
{
    size_t had = WORD(0) ? heap_size_of(call->table->heap, WORD(0)) : 0;
    if (WORD(0) != 0 && had == 0) {
        PyErr_Format(fault_error, "realloc() of %p, which malloc did not give, or which was freed", (void *)WORD(0));
        return 0;
    }
    uint64_t made = take(call, WORD(1));
    if (made != 0 && WORD(0) != 0) {
        memcpy((void *)made, POINTER(0), had < WORD(1) ? had : WORD(1));
        give(call, WORD(0), "realloc");
    }
    return made;
}

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
NATIVE(set_checked) { return WORD(2) > WORD(3) ? overflowed(call, self) : memory_set(call, self); }
NATIVE(text_copy_checked) { return strlen(TEXT(1)) >= WORD(2) ? overflowed(call, self) : text_copy(call, self); }
NATIVE(text_limited_checked) { return WORD(2) > WORD(3) ? overflowed(call, self) : text_copy_limited(call, self); }
NATIVE(text_append_checked)
{
    return strlen(TEXT(0)) + strlen(TEXT(1)) >= WORD(2) ? overflowed(call, self) : text_append(call, self);
}
NATIVE(append_limited_checked)
{
    return strlen(TEXT(0)) + strnlen(TEXT(1), WORD(2)) >= WORD(3) ? overflowed(call, self) : text_append_limited(call, self);
}
NATIVE(format_limited_checked)
{
    return WORD(1) > WORD(3) ? overflowed(call, self) : (uint64_t)(int64_t)format_text(call, TEXT(0), WORD(1), TEXT(4), 5);
}
NATIVE(format_checked)
{
    size_t room = WORD(2) < INT32_MAX ? WORD(2) : INT32_MAX;
    int count = format_text(call, TEXT(0), room, TEXT(3), 4);
    return count >= 0 && (size_t)count >= room ? overflowed(call, self) : (uint64_t)(int64_t)count;
}
NATIVE(format_list_checked)
{
    return WORD(1) > WORD(3) ? overflowed(call, self)
                             : (uint64_t)(int64_t)format_list(call, TEXT(0), WORD(1), TEXT(4), WORD(5));
}

static const char has_end; /* marks strtod: it tells where the number ends */

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
    {"strtok_r", text_split},
    {"__strtok_r", text_split},
    {"atoi", number_of_text},
    {"strtol", long_of_text},
    {"strtoll", long_of_text},
    {"strtoul", unsigned_of_text},
    {"strtoull", unsigned_of_text},
    {"atof", float_of_text},
    {"strtod", float_of_text, (void *)&has_end},
    {"abs", absolute},
    {"toupper", to_upper},
    {"tolower", to_lower},
    {"snprintf", format_limited},
    {"sprintf", format_unlimited},
    {"vsnprintf", format_list_limited},
    {"vsprintf", format_list_unlimited},
    {"malloc", allocate},
    {"calloc", allocate_many},
    {"realloc", allocate_again},
    {"free", let_go},
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
    {"__snprintf_chk", format_limited_checked},
    {"__sprintf_chk", format_checked},
    {"__vsnprintf_chk", format_list_checked},
    {NULL},
};
