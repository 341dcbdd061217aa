/* What -fsanitize=thread makes of accesses to memory, for code that is not linked with libtsan.
 *
 * They do nothing but the access itself, unless the table has `Races`, as while schedules are explored. Then an access to
 * what several tasks use goes to Python first, where others may run, and is noted after that.
 */
#include "engine.h"

#define WRITES 0x100

/* Python has to answer first; the native is called again after that. */
static bool asks_first(Coroutine *call)
{
    if (call->is_again)
        return false;
    call->wants_python = call->wants_again = true;
    return true;
}

HIDDEN bool races_asks_first(Coroutine *call, uint64_t address, uint64_t size)
{
    return races_shared(call, address, size) && asks_first(call);
}

static uint64_t access_memory(Coroutine *call, uint64_t size, bool is_write)
{
    if (call->table->races == NULL)
        return 0;
    if (!races_asks_first(call, WORD(0), size))
        races_note(call, WORD(0), size, is_write, false);
    return 0;
}

NATIVE(access_sized)
{
    uint64_t what = (uint64_t)self->target;
    return access_memory(call, what & 0xFF, (what & WRITES) != 0);
}
NATIVE(read_range) { return access_memory(call, WORD(1), false); }
NATIVE(write_range) { return access_memory(call, WORD(1), true); }
NATIVE(nothing) { return 0; }
NATIVE(function_entry)
{
    races_call(call, WORD(0));
    return 0;
}
NATIVE(function_exit)
{
    races_return(call);
    return 0;
}
NATIVE(begin)
{
    races_begin(call->table->races);
    return 0;
}

#define ATOMIC(bits, name, is_write, code)                                  \
    NATIVE(name##_##bits)                                                   \
    {                                                                       \
        uint##bits##_t *at = (uint##bits##_t *)POINTER(0), before = 0;      \
        uint##bits##_t value = (uint##bits##_t)WORD(1);                     \
        if (call->table->races != NULL) {                                   \
            if (asks_first(call))                                           \
                return 0;                                                   \
            races_note(call, WORD(0), bits / 8, is_write, true);            \
        }                                                                   \
        (void)value;                                                        \
        code;                                                               \
        return before;                                                      \
    }
#define ATOMICS(bits)                                                                          \
    ATOMIC(bits, load, false, before = *at)                                                    \
    ATOMIC(bits, store, true, *at = value)                                                     \
    ATOMIC(bits, exchange, true, before = *at; *at = value)                                    \
    ATOMIC(bits, fetch_add, true, before = *at; *at = (uint##bits##_t)(before + value))        \
    ATOMIC(bits, fetch_sub, true, before = *at; *at = (uint##bits##_t)(before - value))        \
    ATOMIC(bits, fetch_and, true, before = *at; *at = before & value)                          \
    ATOMIC(bits, fetch_or, true, before = *at; *at = before | value)                           \
    ATOMIC(bits, fetch_xor, true, before = *at; *at = before ^ value)                          \
    ATOMIC(bits, fetch_nand, true, before = *at; *at = (uint##bits##_t)~(before & value))      \
    ATOMIC(bits, compare_value, true, before = *at; if (before == value) *at = (uint##bits##_t)WORD(2)) \
    NATIVE(compare_##bits)                                                                     \
    {                                                                                          \
        uint##bits##_t *at = (uint##bits##_t *)POINTER(0), *expected = (uint##bits##_t *)POINTER(1); \
        if (call->table->races != NULL) {                                                      \
            if (asks_first(call))                                                              \
                return 0;                                                                      \
            races_note(call, WORD(0), bits / 8, true, true);                                   \
        }                                                                                      \
        if (*at == *expected) {                                                                \
            *at = (uint##bits##_t)WORD(2);                                                     \
            return 1;                                                                          \
        }                                                                                      \
        *expected = *at;                                                                       \
        return 0;                                                                              \
    }

ATOMICS(8)
ATOMICS(16)
ATOMICS(32)
ATOMICS(64)

/* Of 16 bytes: a value is in two registers, which begin with an even one on aarch64. */
#if defined(__x86_64__)
enum { FIRST_VALUE = 1 };
#else
enum { FIRST_VALUE = 2 };
#endif
typedef unsigned __int128 uint128;
#define WIDE(number) ((uint128)WORD((number) + 1) << 64 | WORD(number))
#define ATOMIC_128(name, is_write, code)                        \
    NATIVE(name##_128)                                          \
    {                                                           \
        uint128 *at = (uint128 *)POINTER(0), before = 0;        \
        uint128 value = WIDE(FIRST_VALUE);                      \
        if (call->table->races != NULL) {                       \
            if (asks_first(call))                               \
                return 0;                                       \
            races_note(call, WORD(0), sizeof *at, is_write, true); \
        }                                                       \
        (void)value;                                            \
        code;                                                   \
        call->result_high = (uint64_t)(before >> 64);           \
        return (uint64_t)before;                                \
    }
ATOMIC_128(load, false, before = *at)
ATOMIC_128(store, true, *at = value)
ATOMIC_128(exchange, true, before = *at; *at = value)
ATOMIC_128(fetch_add, true, before = *at; *at = before + value)
ATOMIC_128(fetch_sub, true, before = *at; *at = before - value)
ATOMIC_128(fetch_and, true, before = *at; *at = before & value)
ATOMIC_128(fetch_or, true, before = *at; *at = before | value)
ATOMIC_128(fetch_xor, true, before = *at; *at = before ^ value)
ATOMIC_128(fetch_nand, true, before = *at; *at = ~(before & value))
ATOMIC_128(compare_value, true, before = *at; if (before == value) *at = WIDE(FIRST_VALUE + 2))
NATIVE(compare_128)
{
    uint128 *at = (uint128 *)POINTER(0), *expected = (uint128 *)POINTER(1);
    if (call->table->races != NULL) {
        if (asks_first(call))
            return 0;
        races_note(call, WORD(0), sizeof *at, true, true);
    }
    if (*at == *expected) {
        *at = WIDE(2);
        return 1;
    }
    *expected = *at;
    return 0;
}

#define SIZED(size)                                                                            \
    {"__tsan_read" #size, access_sized, (void *)size},                                         \
        {"__tsan_write" #size, access_sized, (void *)(size | WRITES)},                         \
        {"__tsan_unaligned_read" #size, access_sized, (void *)size},                           \
        {"__tsan_unaligned_write" #size, access_sized, (void *)(size | WRITES)},               \
        {"__tsan_volatile_read" #size, access_sized, (void *)size},                            \
        {"__tsan_volatile_write" #size, access_sized, (void *)(size | WRITES)},                \
        {"__tsan_unaligned_volatile_read" #size, access_sized, (void *)size},                  \
        {"__tsan_unaligned_volatile_write" #size, access_sized, (void *)(size | WRITES)}
#define OPERATION(bits, name) {"__tsan_atomic" #bits "_" #name, name##_##bits}
#define OPERATIONS(bits)                                                                       \
    OPERATION(bits, load), OPERATION(bits, store), OPERATION(bits, exchange), OPERATION(bits, fetch_add), \
        OPERATION(bits, fetch_sub), OPERATION(bits, fetch_and), OPERATION(bits, fetch_or),     \
        OPERATION(bits, fetch_xor), OPERATION(bits, fetch_nand),                               \
        {"__tsan_atomic" #bits "_compare_exchange_strong", compare_##bits},                    \
        {"__tsan_atomic" #bits "_compare_exchange_weak", compare_##bits},                      \
        {"__tsan_atomic" #bits "_compare_exchange_val", compare_value_##bits}

HIDDEN const NativeRow natives_of_races[] = {
    {"__tsan_init", begin},
    {"__tsan_func_entry", function_entry},
    {"__tsan_func_exit", function_exit},
    {"__tsan_atomic_thread_fence", nothing},
    {"__tsan_atomic_signal_fence", nothing},
    SIZED(1),
    SIZED(2),
    SIZED(4),
    SIZED(8),
    SIZED(16),
    {"__tsan_read_range", read_range},
    {"__tsan_write_range", write_range},
    {"__tsan_vptr_read", access_sized, (void *)8},
    {"__tsan_vptr_update", access_sized, (void *)(8 | WRITES)},
    OPERATIONS(8),
    OPERATIONS(16),
    OPERATIONS(32),
    OPERATIONS(64),
    OPERATIONS(128),
    {NULL},
};
