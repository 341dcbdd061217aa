/* printf() and its kin that write into memory; those that write to a stream are Python's (api/text.py, api/streams.py). */
#define _GNU_SOURCE
#include "natives.h"

#include <errno.h>

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

/* Into memory of malloc. What is formatted twice must not write by a %n what it then reads, as on any libc. */
static uint64_t allocated(Coroutine *call, int count, uint64_t *made)
{
    if (count < 0 || PyErr_Occurred())
        return (uint64_t)-1;
    heap_own(call->table->heap, call->owner);
    *made = heap_take_any(call->table->heap, (size_t)count + 1, 1);
    if (*made == 0)
        set_application_errno(call, ENOMEM);
    if (engine_copy(POINTER(0), made, sizeof *made))
        PyErr_Format(fault_error, "bad address %p for the text of asprintf()", (void *)WORD(0));
    return *made == 0 || PyErr_Occurred() ? (uint64_t)-1 : (uint64_t)count;
}
#define ALLOCATES(function, ...)                                                                       \
    {                                                                                                  \
        uint64_t made = 0, count = allocated(call, function(call, NULL, 0, __VA_ARGS__), &made);       \
        if (count != (uint64_t)-1)                                                                     \
            function(call, (char *)made, count + 1, __VA_ARGS__);                                      \
        return count;                                                                                  \
    }
NATIVE(format_allocated) ALLOCATES(format_text, TEXT(1), 2)
NATIVE(format_allocated_checked) ALLOCATES(format_text, TEXT(2), 3)
NATIVE(format_list_allocated) ALLOCATES(format_list, TEXT(1), WORD(2))
NATIVE(format_list_allocated_checked) ALLOCATES(format_list, TEXT(2), WORD(3))

#define WIDE(number) ((wchar_t *)call->arguments[number])
NATIVE(format_wide_limited) { return (uint64_t)(int64_t)format_wide(call, WIDE(0), WORD(1), WIDE(2), 3); }
NATIVE(format_wide_list_limited) { return (uint64_t)(int64_t)format_wide_list(call, WIDE(0), WORD(1), WIDE(2), WORD(3)); }

/* What -D_FORTIFY_SOURCE makes of these functions: the room that the compiler knows is held to. */
static uint64_t overflowed(void)
{
    PyErr_SetString(fault_error, "buffer overflow detected");
    return 0;
}
static uint64_t format_limited_known(Coroutine *call) FORMATS(WORD(1), format_text, TEXT(4), 5)
static uint64_t format_list_known(Coroutine *call) FORMATS(WORD(1), format_list, TEXT(4), WORD(5))
NATIVE(format_limited_checked) { return WORD(1) > WORD(3) ? overflowed() : format_limited_known(call); }
NATIVE(format_list_checked) { return WORD(1) > WORD(3) ? overflowed() : format_list_known(call); }
NATIVE(format_checked)
{
    size_t room = WORD(2) < INT32_MAX ? WORD(2) : INT32_MAX;
    if (waits_to_format(call, room))
        return 0;
    int count = format_text(call, TEXT(0), room, TEXT(3), 4);
    return count >= 0 && (size_t)count >= room ? overflowed() : formatted(call, count, room);
}
NATIVE(format_list_unlimited_checked)
{
    size_t room = WORD(2) < INT32_MAX ? WORD(2) : INT32_MAX;
    if (waits_to_format(call, room))
        return 0;
    int count = format_list(call, TEXT(0), room, TEXT(3), WORD(4));
    return count >= 0 && (size_t)count >= room ? overflowed() : formatted(call, count, room);
}

NATIVE(format_wide_checked)
{
    return WORD(1) > WORD(3) ? overflowed() : (uint64_t)(int64_t)format_wide(call, WIDE(0), WORD(1), WIDE(4), 5);
}
NATIVE(format_wide_list_checked)
{
    return WORD(1) > WORD(3) ? overflowed() : (uint64_t)(int64_t)format_wide_list(call, WIDE(0), WORD(1), WIDE(4), WORD(5));
}

HIDDEN const NativeRow natives_of_formats[] = {
    {"snprintf", format_limited},
    {"sprintf", format_unlimited},
    {"vsnprintf", format_list_limited},
    {"vsprintf", format_list_unlimited},
    {"asprintf", format_allocated},
    {"vasprintf", format_list_allocated},
    {"swprintf", format_wide_limited},
    {"vswprintf", format_wide_list_limited},
    {"__snprintf_chk", format_limited_checked},
    {"__sprintf_chk", format_checked},
    {"__vsnprintf_chk", format_list_checked},
    {"__vsprintf_chk", format_list_unlimited_checked},
    {"__swprintf_chk", format_wide_checked},
    {"__vswprintf_chk", format_wide_list_checked},
    {"__asprintf_chk", format_allocated_checked},
    {"__vasprintf_chk", format_list_allocated_checked},
    {NULL},
};
