/* Operators new and delete, and the guards of static variables, for C++ that is not linked with libstdc++.
 *
 * An object that has them of libstdc++ itself uses those, which call malloc.
 */
#include "engine.h"

#define DONE 1 /* in the first byte of a guard */
#define BEGUN 1 /* in its second */

static uint64_t take(Coroutine *call)
{
    heap_own(call->table->heap, call->owner);
    return heap_take(call->table->heap, WORD(0) ? WORD(0) : 1);
}

NATIVE(new_object)
{
    uint64_t made = take(call);
    if (made == 0)
        PyErr_Format(fault_error, "operator new: no memory for %zu bytes", (size_t)WORD(0));
    return made;
}

NATIVE(new_object_or_null) { return take(call); }

NATIVE(delete_object)
{
    if (WORD(0) == 0)
        return 0;
    size_t size = heap_size_of(call->table->heap, WORD(0));
    int given = heap_give(call->table->heap, WORD(0));
    if (given < 0)
        PyErr_Format(fault_error, "delete of %p, a block of %zu bytes that was written %s", (void *)WORD(0), size,
                     heap_damage(given));
    else if (given == 0)
        PyErr_Format(fault_error, "delete of %p, which new did not give, or which was deleted", (void *)WORD(0));
    return 0;
}

/* 1: the caller initialises the variable; another task that comes meanwhile is sent to Python, which waits. */
NATIVE(guard_acquire)
{
    unsigned char *guard = POINTER(0);
    if (guard[0] == DONE)
        return 0;
    if (guard[1] == BEGUN) {
        call->wants_python = true;
        return 0;
    }
    guard[1] = BEGUN;
    return 1;
}

/* While accesses are looked at, Python notes first that who sees the variable later comes after this. */
NATIVE(guard_release)
{
    if (call->table->races != NULL && !call->is_again) {
        call->wants_python = call->wants_again = true;
        return 0;
    }
    POINTER(0)[1] = 0;
    POINTER(0)[0] = DONE;
    return 0;
}

NATIVE(guard_abort)
{
    POINTER(0)[1] = 0;
    return 0;
}

HIDDEN const NativeRow natives_of_cpp[] = {
    {"_Znwm", new_object},
    {"_Znam", new_object},
    {"_ZnwmRKSt9nothrow_t", new_object_or_null},
    {"_ZnamRKSt9nothrow_t", new_object_or_null},
    {"_ZdlPv", delete_object},
    {"_ZdaPv", delete_object},
    {"_ZdlPvm", delete_object},
    {"_ZdaPvm", delete_object},
    {"_ZdlPvRKSt9nothrow_t", delete_object},
    {"_ZdaPvRKSt9nothrow_t", delete_object},
    {"__cxa_guard_acquire", guard_acquire},
    {"__cxa_guard_release", guard_release},
    {"__cxa_guard_abort", guard_abort},
    {NULL},
};
