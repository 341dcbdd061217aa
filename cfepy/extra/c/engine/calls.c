/* Calls of an application that are answered by Python: what their arguments mean, and how results go back.
 *
 * A signature has a letter for each parameter of the C function.
 *   in   i I int32 uint32   h H int16 uint16   B uint8   b bool   q int64   Q uint64, size_t
 *        p pointer as a number, 0 for NULL   P the same, not NULL   s S text, None for NULL / not NULL
 *        m message, as bytes, not NULL   t CFE_TIME_SysTime_t, as (seconds, subseconds)   f format and what follows   v format and va_list
 *        F V the same with the NULs that a %c of 0 writes, for files
 *        - is not handed over
 *   out  1 2 4 8 so many bytes at the pointer   w z like 4 and 8, where the pointer may be NULL
 * A NULL where there must not be one is answered with the status that the function was declared with; the others are not
 * looked at then. Before the letters may be
 *   = the Python function gives the status and then the outputs   ~ outputs become 0 when it raises a status
 *   & it gives the two words of a structure that is the result   $ the call takes virtual time
 *   @ it gives a packet of the pipe in parameter 1, or None; the output is where the packet's image is
 * Otherwise the outputs alone, one value or a tuple; None and True are the status 0 and 1.
 */
#include "natives.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

HIDDEN PyObject *status_error, *fault_error, *jump_error;

#define CFE_SB_TIME_OUT 0xCA000001u
#define CFE_SB_NO_MESSAGE 0xCA000002u

enum { MOST_TEXT = 64 << 10, FORMATTED = 2048 };

HIDDEN uint64_t argument(const Coroutine *coroutine, int number)
{
    if (number < REGISTER_ARGUMENTS)
        return coroutine->arguments[number];
    uint64_t value = 0;
    engine_copy(&value, coroutine->stack_pointer + STACK_ARGUMENTS + number - REGISTER_ARGUMENTS, sizeof value);
    return value;
}

/* ---- what pointers lead to ---------------------------------------------------------------------------------------- */

HIDDEN PyObject *text_at(uint64_t address)
{
    char small[1024], *text = small;
    size_t size = 0, room = sizeof small;
    PyObject *result = NULL;
    for (;;) { /* piece by piece: a text may end just before memory that is not there */
        size_t piece = 64 - (address + size) % 64;
        if (size + piece > room) {
            char *more = room < MOST_TEXT ? PyMem_Malloc(room *= 8) : NULL;
            if (more == NULL) {
                PyErr_Format(fault_error, "a text at %p has no end", (void *)address);
                break;
            }
            memcpy(more, text, size);
            if (text != small)
                PyMem_Free(text);
            text = more;
        }
        if (engine_copy(text + size, (void *)(address + size), piece)) {
            PyErr_Format(fault_error, "bad address %p of a text", (void *)address);
            break;
        }
        char *end = memchr(text + size, 0, piece);
        if (end != NULL) {
            result = PyUnicode_DecodeUTF8(text, end - text, "surrogateescape");
            break;
        }
        size += piece;
    }
    if (text != small)
        PyMem_Free(text);
    return result;
}

/* One that is larger than the bus takes is refused by it, so no more than its header is looked at. */
HIDDEN PyObject *message_at(uint64_t address, size_t largest)
{
    unsigned char header[6];
    if (engine_copy(header, (void *)address, sizeof header))
        return PyErr_Format(fault_error, "bad address %p of a message", (void *)address);
    size_t size = (header[4] << 8 | header[5]) + 7;
    PyObject *bytes = PyBytes_FromStringAndSize(NULL, (Py_ssize_t)size);
    size_t seen = size <= largest ? size : sizeof header;
    if (bytes != NULL && seen < size)
        memset(PyBytes_AS_STRING(bytes), 0, size);
    if (bytes != NULL && engine_copy(PyBytes_AS_STRING(bytes), (void *)address, seen)) {
        Py_DECREF(bytes);
        return PyErr_Format(fault_error, "a message of %zu bytes at %p reaches beyond its memory", size, (void *)address);
    }
    return bytes;
}

/* ---- formats ------------------------------------------------------------------------------------------------------ */

/* A format that says %Ld or %qd, with %lld instead: glibc takes them for int once a library of the process, such as
 * libquadmath below numpy, has brought conversions of its own. */
static const char *with_plain_sizes(const char *format, char *room, size_t size)
{
    if (strpbrk(format, "Lq") == NULL || 2 * strlen(format) + 2 > size)
        return format;
    char *to = room;
    for (const char *from = format; (*to++ = *from) != 0; from++) {
        if (*from != '%')
            continue;
        for (size_t flags = strspn(from + 1, "0123456789$-+ #'*.I"); flags > 0; flags--)
            *to++ = *++from;
        if ((from[1] == 'L' || from[1] == 'q') && from[2] != 0 && strchr("diouxX", from[2]) != NULL) {
            *to++ = 'l';
            *to++ = 'l';
            from++;
        } else if (from[1] == '%')
            *to++ = *++from;
    }
    return room;
}

/* A fault in here is the application's: a %s of a bad pointer, say. -1 with an exception then, and without one for what
 * cannot be formatted, such as a wide character that the locale "C" does not have. */
typedef struct {
    void *to;
    size_t room;
    const void *format;
    Arguments *arguments;
    bool is_wide;
    int *count;
} Printing;

static void print(Coroutine *coroutine, const void *what)
{
    const Printing *job = what;
    char plain[1024];
    libc_enter_to_print(coroutine);
    *job->count = job->is_wide ? vswprintf(job->to, job->room, job->format, job->arguments->list)
                               : vsnprintf(job->to, job->room, with_plain_sizes(job->format, plain, sizeof plain),
                                           job->arguments->list);
    libc_leave(coroutine);
}

static int format_guarded(Coroutine *coroutine, void *to, size_t room, const void *format, Arguments *arguments, bool is_wide)
{
    int count = -1;
    const Printing job = {to, room, format, arguments, is_wide, &count};
    Coroutine *before = running;
    bool was_native = coroutine->is_native;
    running = coroutine;
    coroutine->is_native = true;
    if (engine_try(coroutine, print, &job)) {
        modes_abandon(coroutine);
        PyErr_Format(fault_error, "bad address %p in a format or its arguments", (void *)coroutine->fault_address);
        count = -1;
    }
    coroutine->is_native = was_native;
    running = before;
    return count;
}

/* The arguments of a call that are in registers, in memory as a va_list has them. */
typedef struct {
    uint64_t general[REGISTER_ARGUMENTS];
    struct {
        double low;
        uint64_t high;
    } floats[FLOAT_ARGUMENTS];
} Saved;

#if defined(__x86_64__)
typedef struct {
    unsigned gp_offset, fp_offset;
    const void *overflow_arg_area, *reg_save_area;
} List;

static List behind(int in_registers, const uint64_t *on_stack, const Saved *saved)
{
    return (List){8u * in_registers, sizeof saved->general, on_stack, saved};
}

static List of_words(const uint64_t *words) { return (List){sizeof ((Saved *)0)->general, sizeof(Saved), words, NULL}; }
#else
typedef struct {
    const void *stack, *gr_top, *vr_top;
    int gr_offs, vr_offs;
} List;

static List behind(int in_registers, const uint64_t *on_stack, const Saved *saved)
{
    return (List){on_stack, saved->general + REGISTER_ARGUMENTS, saved->floats + FLOAT_ARGUMENTS,
                  -8 * (REGISTER_ARGUMENTS - in_registers), -16 * FLOAT_ARGUMENTS};
}

static List of_words(const uint64_t *words) { return (List){words, NULL, NULL, 0, 0}; }
#endif
_Static_assert(sizeof(List) == sizeof(va_list), "a List is what a va_list is");

HIDDEN void arguments_of_words(Arguments *to, const uint64_t *words)
{
    List made = of_words(words);
    memcpy(&to->list, &made, sizeof made);
}

HIDDEN int arguments_at(Arguments *to, uint64_t list)
{
    if (engine_copy(&to->list, (void *)list, sizeof(List)) == 0)
        return 0;
    PyErr_Format(fault_error, "bad address %p of a va_list", (void *)list);
    return -1;
}

/* Those of a call behind its fixed ones. */
static void arguments_of_call(Arguments *to, const Coroutine *coroutine, int fixed, Saved *saved)
{
    memcpy(saved->general, coroutine->arguments, sizeof saved->general);
    for (int i = 0; i < FLOAT_ARGUMENTS; i++) {
        saved->floats[i].low = coroutine->floats[i];
        saved->floats[i].high = coroutine->float_highs[i];
    }
    int in_registers = fixed < REGISTER_ARGUMENTS ? fixed : REGISTER_ARGUMENTS;
    List made = behind(in_registers, coroutine->stack_pointer + STACK_ARGUMENTS + fixed - in_registers, saved);
    memcpy(&to->list, &made, sizeof made);
}

HIDDEN int format_text(Coroutine *coroutine, char *to, size_t room, const char *format, int fixed)
{
    Arguments arguments;
    Saved saved;
    arguments_of_call(&arguments, coroutine, fixed, &saved);
    return format_guarded(coroutine, to, room, format, &arguments, false);
}

HIDDEN int format_list(Coroutine *coroutine, char *to, size_t room, const char *format, uint64_t list)
{
    Arguments arguments;
    return arguments_at(&arguments, list) < 0 ? -1 : format_guarded(coroutine, to, room, format, &arguments, false);
}

HIDDEN int format_wide(Coroutine *coroutine, wchar_t *to, size_t room, const wchar_t *format, int fixed)
{
    Arguments arguments;
    Saved saved;
    arguments_of_call(&arguments, coroutine, fixed, &saved);
    return format_guarded(coroutine, to, room, format, &arguments, true);
}

HIDDEN int format_wide_list(Coroutine *coroutine, wchar_t *to, size_t room, const wchar_t *format, uint64_t list)
{
    Arguments arguments;
    return arguments_at(&arguments, list) < 0 ? -1 : format_guarded(coroutine, to, room, format, &arguments, true);
}

static int format_argument(Coroutine *coroutine, char *to, size_t room, int fixed, bool has_list)
{
    const char *format = (const char *)argument(coroutine, fixed - 1);
    return has_list ? format_list(coroutine, to, room, format, argument(coroutine, fixed))
                    : format_text(coroutine, to, room, format, fixed);
}

static PyObject *formatted(Coroutine *coroutine, int fixed, bool has_list, bool has_nuls)
{
    char small[FORMATTED] = "", *text = small;
    int count = format_argument(coroutine, text, sizeof small, fixed, has_list);
    if (count >= FORMATTED && (text = PyMem_Malloc((size_t)count + 1)) == NULL)
        return PyErr_NoMemory();
    if (text != small)
        format_argument(coroutine, text, (size_t)count + 1, fixed, has_list);
    Py_ssize_t length = has_nuls && count >= 0 ? count : (Py_ssize_t)strlen(text);
    PyObject *result = PyErr_Occurred() ? NULL : PyUnicode_DecodeUTF8(text, length, "surrogateescape");
    if (text != small)
        PyMem_Free(text);
    return result;
}

/* ---- one call ----------------------------------------------------------------------------------------------------- */

typedef struct {
    uint64_t at[MOST_PARAMETERS];
    char kinds[MOST_PARAMETERS];
    int count;
} Outputs;

static int size_of_output(char kind) { return kind == 'w' ? 4 : kind == 'z' ? 8 : kind - '0'; }

static int write_output(const Outputs *outputs, int number, uint64_t value)
{
    uint64_t at = outputs->at[number];
    if (at != 0 && engine_copy((void *)at, &value, size_of_output(outputs->kinds[number]))) {
        PyErr_Format(fault_error, "bad address %p for a result", (void *)at);
        return -1;
    }
    return 0;
}

static int put_output(const Outputs *outputs, int number, PyObject *value)
{
    uint64_t bits = PyLong_AsUnsignedLongLongMask(value);
    return bits == (uint64_t)-1 && PyErr_Occurred() ? -1 : write_output(outputs, number, bits);
}

/* The Python form of a parameter; NULL with an exception, or without one for a NULL pointer that must not be. */
static PyObject *argument_object(Coroutine *coroutine, char kind, int number)
{
    uint64_t value = argument(coroutine, number);
    switch (kind) {
    case 'i': return PyLong_FromLong((int32_t)value);
    case 'I': return PyLong_FromUnsignedLong((uint32_t)value);
    case 'h': return PyLong_FromLong((int16_t)value);
    case 'H': return PyLong_FromLong((uint16_t)value);
    case 'B': return PyLong_FromLong((uint8_t)value);
    case 'b': return PyBool_FromLong((uint8_t)value);
    case 'q': return PyLong_FromLongLong((int64_t)value);
    case 'Q':
    case 'p': return PyLong_FromUnsignedLongLong(value);
    case 'P': return value ? PyLong_FromUnsignedLongLong(value) : NULL;
    case 's': return value ? text_at(value) : Py_NewRef(Py_None);
    case 'S': return value ? text_at(value) : NULL;
    case 'm': return value ? message_at(value, coroutine->table->largest_message) : NULL;
    case 't': return Py_BuildValue("(II)", (uint32_t)value, (uint32_t)(value >> 32));
    case 'f':
    case 'v': return value ? formatted(coroutine, number + 1, kind == 'v', false) : NULL;
    case 'F':
    case 'V': return value ? formatted(coroutine, number + 1, kind == 'V', true) : NULL;
    default: return PyErr_Format(PyExc_SystemError, "signature letter %c", kind);
    }
}

/* The status of an exception that carries one; -1 when it is another exception, which stays. */
static int take_status(Coroutine *coroutine, const Outputs *outputs, bool clears)
{
    if (!PyErr_ExceptionMatches(status_error))
        return -1;
    PyObject *type, *error, *trace;
    PyErr_Fetch(&type, &error, &trace);
    PyErr_NormalizeException(&type, &error, &trace);
    PyObject *status = PyObject_GetAttrString(error, "status");
    if (status != NULL)
        coroutine->result = PyLong_AsUnsignedLongLongMask(status);
    Py_XDECREF(status);
    Py_XDECREF(type);
    Py_XDECREF(error);
    Py_XDECREF(trace);
    for (int i = 0; clears && i < outputs->count; i++)
        if (write_output(outputs, i, 0) < 0)
            return -1;
    return PyErr_Occurred() ? -1 : 0;
}

static int give_answer(Coroutine *coroutine, PyObject *answer, const Outputs *outputs, bool gives_status)
{
    coroutine->result = 0;
    if (answer == Py_None)
        return 0;
    if (!PyTuple_Check(answer)) {
        if (outputs->count > 0 && !gives_status)
            return put_output(outputs, 0, answer);
        coroutine->result = PyLong_AsUnsignedLongLongMask(answer);
        return PyErr_Occurred() ? -1 : 0;
    }
    Py_ssize_t size = PyTuple_GET_SIZE(answer);
    if (gives_status && size > 0)
        coroutine->result = PyLong_AsUnsignedLongLongMask(PyTuple_GET_ITEM(answer, 0));
    for (int i = 0; i < outputs->count && i + gives_status < size; i++)
        if (put_output(outputs, i, PyTuple_GET_ITEM(answer, i + gives_status)) < 0)
            return -1;
    return PyErr_Occurred() ? -1 : 0;
}

/* A packet that came out of a pipe; without one, the status says whether the pipe was only looked at. */
static int give_packet(Coroutine *coroutine, PyObject *answer, const Outputs *outputs)
{
    uint64_t address = 0;
    coroutine->result = 0;
    if (answer == Py_None)
        coroutine->result = (uint32_t)argument(coroutine, 2) <= 1 ? CFE_SB_NO_MESSAGE : CFE_SB_TIME_OUT;
    else if (!PyBytes_CheckExact(answer)) {
        PyErr_SetString(PyExc_TypeError, "a packet is bytes");
        return -1;
    } else if ((address = images_receive(coroutine->table->images, (uint32_t)argument(coroutine, 1), answer)) == 0)
        return -1;
    return write_output(outputs, 0, address);
}

static int give_two_words(Coroutine *coroutine, PyObject *answer)
{
    unsigned long long low, high;
    if (!PyArg_ParseTuple(answer, "KK", &low, &high))
        return -1;
    coroutine->result = low;
    coroutine->result_high = high;
    return 0;
}

/* Call a function from a frame that is seen as the place of the call in C; arguments[0] is free. */
static PyObject *call_seen(Coroutine *coroutine, PyObject *callable, PyObject **arguments, int given)
{
    PyObject *at = PyLong_FromUnsignedLongLong(coroutine->called_from - 1);
    PyObject *frame = at == NULL ? NULL : PyObject_GetItem(coroutine->table->frames, at);
    Py_XDECREF(at);
    if (frame == NULL)
        return NULL;
    arguments[0] = callable;
    PyObject *answer = PyObject_Vectorcall(frame, arguments, given + 1, NULL);
    arguments[0] = NULL;
    Py_DECREF(frame);
    return answer;
}

/* Answer a call by its Python function; -1 with an exception that ends the coroutine. */
HIDDEN int calls_serve(Coroutine *coroutine, const Function *function)
{
    PyObject *arguments[1 + MOST_PARAMETERS] = {NULL};
    Outputs outputs = {.count = 0};
    int given = 0, result = -1;
    bool is_null = false;
    const char *kinds = function->kinds;
    for (int i = 0; kinds[i] && !is_null; i++) {
        char kind = kinds[i];
        if (kind == '-')
            continue;
        if ((kind >= '1' && kind <= '8') || kind == 'w' || kind == 'z') {
            uint64_t at = argument(coroutine, i);
            is_null = at == 0 && kind <= '8';
            outputs.kinds[outputs.count] = kind;
            outputs.at[outputs.count++] = at;
            continue;
        }
        PyObject *object = argument_object(coroutine, kind, i);
        if (object != NULL)
            arguments[1 + given++] = object;
        else if (PyErr_Occurred())
            goto done;
        else
            is_null = true;
    }
    if (is_null) {
        PyObject *told = function->on_null == NULL ? Py_NewRef(Py_None) : PyObject_CallFunction(
            function->on_null, "KKK", (unsigned long long)argument(coroutine, 0),
            (unsigned long long)argument(coroutine, 1), (unsigned long long)argument(coroutine, 2));
        coroutine->result = function->null_status;
        result = told == NULL ? -1 : 0;
        Py_XDECREF(told);
        goto done;
    }
    if (function->costs && coroutine->table->charge != NULL) {
        PyObject *charged = PyObject_CallOneArg(coroutine->table->charge, coroutine->table->cost);
        if (charged == NULL)
            goto done;
        Py_DECREF(charged);
    }
    PyObject *answer = coroutine->table->frames == NULL
        ? PyObject_Vectorcall(function->callable, arguments + 1, given | PY_VECTORCALL_ARGUMENTS_OFFSET, NULL)
        : call_seen(coroutine, function->callable, arguments, given);
    if (answer == NULL)
        result = take_status(coroutine, &outputs, function->clears_outputs);
    else {
        result = function->gives_two_words ? give_two_words(coroutine, answer)
                 : function->gives_packet  ? give_packet(coroutine, answer, &outputs)
                                           : give_answer(coroutine, answer, &outputs, function->gives_status);
        Py_DECREF(answer);
    }
done:
    for (int i = 0; i < given; i++)
        Py_DECREF(arguments[1 + i]);
    return result;
}
