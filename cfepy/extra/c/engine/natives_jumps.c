/* setjmp() and longjmp(): what the switch saved of a call of setjmp goes into the caller's buffer, and comes back.
 *
 * A jmp_buf of glibc has room for as many words as the switch saves, and the stack pointer; then follow a word and 128
 * bytes for signals, which applications do not have. There goes the call that `Races` knows the task to be in.
 */
#include "natives.h"

#include <string.h>

enum { SAVED = STACK_ARGUMENTS, AT = SAVED, CALLS = SAVED + 4, WORDS = CALLS + 1 };
_Static_assert(WORDS * sizeof(uint64_t) <= sizeof(jmp_buf), "a jmp_buf has room for it");

NATIVE(save)
{
    uint64_t *to = (uint64_t *)POINTER(0);
    memcpy(to, call->stack_pointer, SAVED * sizeof *to);
    to[AT] = (uint64_t)call->stack_pointer;
    to[CALLS] = races_calls(call);
    return 0;
}

static bool is_on_stack(const Coroutine *call, uint64_t at)
{
    uint64_t low = (uint64_t)call->stack;
    return at >= low && at <= low + call->size - SAVED * sizeof(uint64_t) && at % sizeof(uint64_t) == 0;
}

static void land(Coroutine *call, const uint64_t *from, int value)
{
    call->stack_pointer = (uint64_t *)from[AT];
    memcpy(call->stack_pointer, from, SAVED * sizeof *from);
    races_set_calls(call, (uint32_t)from[CALLS]);
    call->result = value == 0 ? 1 : (uint64_t)(int64_t)value;
}

/* To code that called this one through Python, such as by qsort(): an exception goes there, and ends what is in between. */
static void jump_out(const uint64_t *from, int value)
{
    PyObject *error = Py_BuildValue("(Ny#i)", PyUnicode_FromFormat("longjmp() to %p, where no setjmp() was called in this task",
                                                                   (void *)from[AT]),
                                    (const char *)from, (Py_ssize_t)(WORDS * sizeof *from), value);
    if (error != NULL)
        PyErr_SetObject(jump_error, error);
    Py_XDECREF(error);
}

static uint64_t jump(Coroutine *call, bool only_up)
{
    uint64_t from[WORDS];
    memcpy(from, POINTER(0), sizeof from);
    if (from[AT] == 0)
        PyErr_SetString(fault_error, "longjmp() with a buffer that no setjmp() has filled");
    else if (!is_on_stack(call, from[AT]))
        jump_out(from, (int)WORD(1));
    else if (only_up && from[AT] < (uint64_t)call->stack_pointer)
        PyErr_SetString(fault_error, "longjmp causes uninitialized stack frame");
    else
        land(call, from, (int)WORD(1));
    return call->result;
}

HIDDEN bool jump_lands(Coroutine *call)
{
    if (!PyErr_ExceptionMatches(jump_error))
        return false;
    PyObject *type, *error, *trace, *arguments;
    PyErr_Fetch(&type, &error, &trace);
    PyErr_NormalizeException(&type, &error, &trace);
    arguments = PyObject_GetAttrString(error, "args");
    const char *text, *bytes;
    Py_ssize_t size;
    int value;
    uint64_t from[WORDS];
    bool is_here = arguments != NULL && PyArg_ParseTuple(arguments, "sy#i", &text, &bytes, &size, &value) &&
                   size == sizeof from;
    if (is_here) {
        memcpy(from, bytes, sizeof from);
        is_here = is_on_stack(call, from[AT]);
    }
    Py_XDECREF(arguments);
    if (!is_here) {
        PyErr_Restore(type, error, trace);
        return false;
    }
    Py_XDECREF(type);
    Py_XDECREF(error);
    Py_XDECREF(trace);
    land(call, from, value);
    return true;
}

NATIVE(go_back) { return jump(call, false); }
NATIVE(go_back_up) { return jump(call, true); } /* with -D_FORTIFY_SOURCE */

HIDDEN const NativeRow natives_of_jumps[] = {
    {"setjmp", save},      {"_setjmp", save},       {"__sigsetjmp", save},        {"sigsetjmp", save},
    {"longjmp", go_back},  {"_longjmp", go_back},   {"siglongjmp", go_back},      {"__longjmp_chk", go_back_up},
    {NULL},
};
