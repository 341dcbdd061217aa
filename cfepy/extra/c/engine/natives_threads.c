/* Thread-local variables, errno among them: where they are for the current task.
 *
 * Python makes the block of a task and an object. A coroutine keeps where the blocks are that it has asked for; it runs
 * in one task, and a block stays until the outermost coroutine of its task has ended.
 */
#include "natives.h"

enum { OF_ERRNO = 0 }; /* the module that stands for libc: see lives.py */

/* The first time, Python answers, and the engine is asked again with that as the result. */
static uint64_t variable(Coroutine *call, uint64_t module, uint64_t offset)
{
    uint64_t *kept = &call->thread_locals[module % KEPT_BLOCKS].module, *block = kept + 1;
    if (call->is_again) {
        *kept = module;
        *block = call->result - offset;
    } else if (*block == 0 || *kept != module) {
        call->wants_python = call->wants_again = true;
        return 0;
    }
    return *block + offset;
}

NATIVE(of_index)
{
    const uint64_t *index = (const uint64_t *)WORD(0);
    return variable(call, index[0], index[1]);
}

NATIVE(of_descriptor) { return variable(call, WORD(0) >> 32, (uint32_t)WORD(0)); }

NATIVE(of_errno) { return variable(call, OF_ERRNO, 0); }

/* What errno is for an application; 0 if it has not asked for it. */
HIDDEN int application_errno(const Coroutine *call)
{
    int value = 0;
    uint64_t block = call->thread_locals[OF_ERRNO].module == OF_ERRNO ? call->thread_locals[OF_ERRNO].block : 0;
    if (block != 0)
        engine_copy(&value, (const void *)block, sizeof value);
    return value;
}

/* Where errno is, made if need be; NULL with an exception. */
static void *errno_block(Coroutine *call)
{
    uint64_t *module = &call->thread_locals[OF_ERRNO].module, *block = module + 1;
    if (*block == 0 || *module != OF_ERRNO) {
        bool is_native = call->is_native; /* what fails in Python is none of the application's */
        call->is_native = false;
        running = NULL;
        PyObject *at = PyObject_CallNoArgs(call->table->errno_at);
        running = call;
        call->is_native = is_native;
        if (at == NULL)
            return NULL;
        *module = OF_ERRNO;
        *block = PyLong_AsUnsignedLongLongMask(at);
        Py_DECREF(at);
    }
    return (void *)*block;
}

HIDDEN void set_application_errno(Coroutine *call, int value)
{
    void *block = errno_block(call);
    if (block != NULL)
        engine_copy(block, &value, sizeof value);
}

HIDDEN const NativeRow natives_of_threads[] = {
    {"__tls_get_addr", of_index},
    {"(thread-local)", of_descriptor},
    {"__errno_location", of_errno},
    {NULL},
};
