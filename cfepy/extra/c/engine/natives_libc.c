/* What stands for libc in an application: memory, texts, numbers. Nothing here knows the host's clock, files or random
 * numbers; what an application wants beyond this is told when it is loaded.
 */
#define _GNU_SOURCE
#include "engine.h"

#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/types.h>

#define TEXT(number) ((char *)call->arguments[number])

/* ---- accesses, where somebody looks at them: see races.c ---------------------------------------------------------- */

typedef struct {
    const void *at;
    size_t size;
    bool is_write;
} Range;

/* Whether Python has to let others in before these accesses; they are noted otherwise. */
static bool waits_for_others(Coroutine *call, const Range *ranges, int count)
{
    for (int i = 0; i < count; i++)
        if (ranges[i].size > 0 && races_asks_first(call, (uint64_t)ranges[i].at, ranges[i].size))
            return true;
    for (int i = 0; i < count; i++)
        if (ranges[i].size > 0)
            races_note(call, (uint64_t)ranges[i].at, ranges[i].size, ranges[i].is_write, false);
    return false;
}

#define READS(where, size) {where, size, false}
#define WRITES(where, size) {where, size, true}
#define WITH_ACCESSES(result, ...)                                                                             \
    {                                                                                                          \
        if (call->table->races != NULL) {                                                                      \
            const Range ranges[] = {__VA_ARGS__};                                                              \
            if (waits_for_others(call, ranges, (int)(sizeof ranges / sizeof *ranges)))                         \
                return 0;                                                                                      \
        }                                                                                                      \
        return (uint64_t)(result);                                                                             \
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
        if (first == 0 || (any_case ? tolower(first) != tolower(second) : first != second))
            break;
    }
    return size;
}
static size_t of_number(const char *text, int base)
{
    char *end;
    strtol(text, &end, base);
    return (size_t)(end - text) + 1;
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
NATIVE(text_compare_any_case) COMPARES(strcasecmp(TEXT(0), TEXT(1)), SIZE_MAX, true)
NATIVE(text_compare_any_case_limited) COMPARES(strncasecmp(TEXT(0), TEXT(1), WORD(2)), WORD(2), true)

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
NATIVE(text_split) { return (uint64_t)strtok_r(TEXT(0), TEXT(1), (char **)POINTER(2)); }

NATIVE(number_of_text) WITH_ACCESSES((int64_t)atoi(TEXT(0)), READS(TEXT(0), of_number(TEXT(0), 10)))
NATIVE(long_of_text)
WITH_ACCESSES(strtol(TEXT(0), (char **)POINTER(1), (int)WORD(2)), READS(TEXT(0), of_number(TEXT(0), (int)WORD(2))),
              WRITES(POINTER(1), POINTER(1) == NULL ? 0 : sizeof(char *)))
NATIVE(unsigned_of_text)
WITH_ACCESSES(strtoul(TEXT(0), (char **)POINTER(1), (int)WORD(2)), READS(TEXT(0), of_number(TEXT(0), (int)WORD(2))),
              WRITES(POINTER(1), POINTER(1) == NULL ? 0 : sizeof(char *)))
NATIVE(absolute) { return (uint64_t)(int64_t)abs((int)WORD(0)); }
NATIVE(to_upper) { return (uint64_t)(int64_t)toupper((int)WORD(0)); }
NATIVE(to_lower) { return (uint64_t)(int64_t)tolower((int)WORD(0)); }

NATIVE(float_of_text)
{
    call->float_result = strtod(TEXT(0), self->target != NULL ? (char **)POINTER(1) : NULL);
    return 0;
}

/* ---- printf ------------------------------------------------------------------------------------------------------- */

/* Formats: what is written counts as an access, what a %s reads does not. */
static bool waits_to_format(Coroutine *call, size_t room)
{
    return call->table->races != NULL && room > 0 && races_asks_first(call, WORD(0), 1);
}
static uint64_t formatted(Coroutine *call, int count, size_t room)
{
    if (call->table->races != NULL && count >= 0 && room > 0)
        races_note(call, WORD(0), (size_t)count < room ? (size_t)count + 1 : room, true, false);
    return (uint64_t)(int64_t)count;
}
#define FORMATS(room, function, ...)                                                                 \
    {                                                                                                \
        size_t size = room;                                                                          \
        return waits_to_format(call, size) ? 0 : formatted(call, function(call, TEXT(0), size, __VA_ARGS__), size); \
    }

/* format_text answers -1 with an exception, which `run` sees after a native. */
NATIVE(format_limited) FORMATS(WORD(1), format_text, TEXT(2), 3)
NATIVE(format_unlimited) FORMATS(INT32_MAX, format_text, TEXT(1), 2)
NATIVE(format_list_limited) FORMATS(WORD(1), format_list, TEXT(2), WORD(3))
NATIVE(format_list_unlimited) FORMATS(INT32_MAX, format_list, TEXT(1), WORD(2))

/* ---- malloc ------------------------------------------------------------------------------------------------------- */

static uint64_t take_aligned(Coroutine *call, uint64_t size, uint64_t alignment)
{
    if (call->table->heap == NULL)
        return 0;
    heap_own(call->table->heap, call->owner);
    return heap_take_any(call->table->heap, size ? size : 1, alignment);
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
    uint64_t made = __builtin_mul_overflow(WORD(0), WORD(1), &size) ? 0 : take(call, size);
    return made == 0 ? 0 : (uint64_t)memset((void *)made, 0, size);
}

static bool is_power_of_two(uint64_t number) { return number != 0 && (number & (number - 1)) == 0; }

/* Also the operator new of libstdc++ for types that want more than 16 bytes calls it. */
NATIVE(allocate_aligned) { return is_power_of_two(WORD(0)) ? take_aligned(call, WORD(1), WORD(0)) : 0; }

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
static uint64_t format_limited_known(Coroutine *call) FORMATS(WORD(1), format_text, TEXT(4), 5)
static uint64_t format_list_known(Coroutine *call) FORMATS(WORD(1), format_list, TEXT(4), WORD(5))
NATIVE(format_limited_checked) { return WORD(1) > WORD(3) ? overflowed(call, self) : format_limited_known(call); }
NATIVE(format_list_checked) { return WORD(1) > WORD(3) ? overflowed(call, self) : format_list_known(call); }
NATIVE(format_checked)
{
    size_t room = WORD(2) < INT32_MAX ? WORD(2) : INT32_MAX;
    if (waits_to_format(call, room))
        return 0;
    int count = format_text(call, TEXT(0), room, TEXT(3), 4);
    return count >= 0 && (size_t)count >= room ? overflowed(call, self) : formatted(call, count, room);
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
    {"__snprintf_chk", format_limited_checked},
    {"__sprintf_chk", format_checked},
    {"__vsnprintf_chk", format_list_checked},
    {NULL},
};
