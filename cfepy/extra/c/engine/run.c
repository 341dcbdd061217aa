/* `Table` and `run`: the functions that an application may call, and its code on a stack of its own. */
#include "natives.h"

#include <string.h>
#include <structmember.h>
#include <time.h>

/* ---- Table -------------------------------------------------------------------------------------------------------- */

static const NativeRow *const lists[] = {
    natives_of_msg,   natives_of_libc,  natives_of_numbers, natives_of_formats, natives_of_scanning,
    natives_of_time,  natives_of_jumps, natives_of_modes,   natives_of_math,    natives_of_cpp,
    natives_of_locale, natives_of_wide, natives_of_races,   natives_of_threads,
};

static const NativeRow *find_native(const char *name)
{
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++)
        for (const NativeRow *row = lists[i]; row->name != NULL; row++)
            if (strcmp(row->name, name) == 0)
                return row;
    return NULL;
}

static PyObject *table_add(Table *table, PyObject *arguments)
{
    PyObject *callable, *on_null = Py_None;
    const char *name, *signature;
    long long null_status;
    if (!PyArg_ParseTuple(arguments, "sOsL|O", &name, &callable, &signature, &null_status, &on_null))
        return NULL;
    if (table->count == table->room) {
        int more = table->room ? 2 * table->room : 512;
        Function *functions = PyMem_Realloc(table->functions, more * sizeof *functions);
        if (functions == NULL)
            return PyErr_NoMemory();
        table->functions = functions;
        table->room = more;
    }
    Function made = {.null_status = (uint64_t)null_status};
    for (; *signature && strchr("=&~$@", *signature); signature++) {
        made.gives_status |= *signature == '=';
        made.gives_two_words |= *signature == '&';
        made.gives_packet |= *signature == '@';
        made.clears_outputs |= *signature == '~';
        made.costs |= *signature == '$';
    }
    if (strlen(signature) > MOST_PARAMETERS || strspn(signature, "iIhHBbqQpPsSmtfvFV-1248wz") != strlen(signature))
        return PyErr_Format(PyExc_ValueError, "bad signature %s of %s", signature, name);
    strcpy(made.kinds, signature);
    const NativeRow *row = find_native(name);
    if (row != NULL) {
        made.native = row->native;
        made.target = row->target;
    }
    if (callable != Py_None)
        made.callable = Py_NewRef(callable);
    else if (row == NULL)
        return PyErr_Format(PyExc_ValueError, "nobody answers %s", name);
    made.on_null = on_null == Py_None ? NULL : Py_NewRef(on_null);
    table->functions[table->count] = made;
    return PyLong_FromLong(table->count++);
}

static int table_traverse(Table *table, visitproc visit, void *arg)
{
    for (int i = 0; i < table->count; i++) {
        Py_VISIT(table->functions[i].callable);
        Py_VISIT(table->functions[i].on_null);
    }
    Py_VISIT(table->charge);
    Py_VISIT(table->cost);
    Py_VISIT(table->preempted);
    Py_VISIT(table->errno_at);
    Py_VISIT(table->frames);
    Py_VISIT((PyObject *)table->heap);
    Py_VISIT((PyObject *)table->images);
    Py_VISIT((PyObject *)table->races);
    return 0;
}

static int table_clear(Table *table)
{
    for (int i = 0; i < table->count; i++) {
        Py_CLEAR(table->functions[i].callable);
        Py_CLEAR(table->functions[i].on_null);
    }
    Py_CLEAR(table->charge);
    Py_CLEAR(table->cost);
    Py_CLEAR(table->preempted);
    Py_CLEAR(table->errno_at);
    Py_CLEAR(table->frames);
    PyObject *heap = (PyObject *)table->heap;
    table->heap = NULL;
    Py_XDECREF(heap);
    PyObject *images = (PyObject *)table->images;
    table->images = NULL;
    Py_XDECREF(images);
    PyObject *races = (PyObject *)table->races;
    table->races = NULL;
    Py_XDECREF(races);
    return 0;
}

static void table_dealloc(Table *table)
{
    PyObject_GC_UnTrack(table);
    table_clear(table);
    PyMem_Free(table->functions);
    Py_TYPE(table)->tp_free(table);
}

static PyObject *table_new(PyTypeObject *type, PyObject *arguments, PyObject *options)
{
    static char *names[] = {"heap", "images", "charge", "cost", "preempted", "highest_msg_id", "largest_message", "ctype",
                            "state", "errno_at", NULL};
    PyObject *heap, *images, *charge, *cost, *preempted, *errno_at;
    unsigned highest, largest;
    unsigned long long ctype[3], state;
    if (!PyArg_ParseTupleAndKeywords(arguments, options, "O!O!OOOII(KKK)KO", names, &heap_type, &heap, &images_type, &images, &charge, &cost, &preempted, &highest,
                                     &largest, &ctype[0], &ctype[1], &ctype[2], &state, &errno_at))
        return NULL;
    Table *table = (Table *)type->tp_alloc(type, 0);
    if (table != NULL) {
        table->heap = (Heap *)Py_NewRef(heap);
        table->images = (Images *)Py_NewRef(images);
        table->charge = charge == Py_None ? NULL : Py_NewRef(charge);
        table->cost = Py_NewRef(cost);
        table->preempted = Py_NewRef(preempted);
        table->errno_at = Py_NewRef(errno_at);
        table->state = state;
        random_begin(table, 1);
        state_begin((LibcState *)state);
        table->highest_msg_id = highest;
        table->largest_message = largest;
        for (int i = 0; i < 3; i++)
            table->ctype[i] = ctype[i];
    }
    return (PyObject *)table;
}

static PyObject *table_get_frames(Table *table, void *unused) { return Py_NewRef(table->frames ? table->frames : Py_None); }
static int table_set_frames(Table *table, PyObject *frames, void *unused)
{
    Py_XSETREF(table->frames, frames == NULL || frames == Py_None ? NULL : Py_NewRef(frames));
    return 0;
}

static PyObject *table_get_races(Table *table, void *unused)
{
    return Py_NewRef(table->races ? (PyObject *)table->races : Py_None);
}
static int table_set_races(Table *table, PyObject *races, void *unused)
{
    if (races == NULL || !Py_IS_TYPE(races, &races_type)) {
        PyErr_SetString(PyExc_TypeError, "Races");
        return -1;
    }
    PyObject *before = (PyObject *)table->races;
    table->races = (Races *)Py_NewRef(races);
    Py_XDECREF(before);
    return 0;
}

static PyMemberDef table_members[] = {
    {"end", T_ULONGLONG, offsetof(Table, end), 0, "where the functions return to that Python calls: what make_end made"},
    {NULL, 0, 0, 0, NULL},
};
static PyGetSetDef table_attributes[] = {
    {"races", (getter)table_get_races, (setter)table_set_races, "what looks at accesses to memory, or None", NULL},
    {"frames", (getter)table_get_frames, (setter)table_set_frames,
     "by address, functions that call another one and are seen as the place in C; or None", NULL},
    {NULL, NULL, NULL, NULL, NULL},
};
static PyMethodDef table_methods[] = {
    {"add", (PyCFunction)table_add, METH_VARARGS,
     "add(name, callable, signature, null_status, on_null=None) -> number; callable may be None for what the engine does itself"},
    {NULL, NULL, 0, NULL},
};
HIDDEN PyTypeObject table_type = {
    PyVarObject_HEAD_INIT(NULL, 0).tp_name = "cfepy.extra.c._engine.Table",
    .tp_basicsize = sizeof(Table),
    .tp_flags = Py_TPFLAGS_DEFAULT | Py_TPFLAGS_HAVE_GC,
    .tp_new = table_new,
    .tp_dealloc = (destructor)table_dealloc,
    .tp_traverse = (traverseproc)table_traverse,
    .tp_clear = (inquiry)table_clear,
    .tp_methods = table_methods,
    .tp_members = table_members,
    .tp_getset = table_attributes,
    .tp_doc = "Table(heap, images, charge, cost, preempted, highest_msg_id, largest_message, ctype, state, errno_at): the functions that C code can call",
};

/* ---- run ---------------------------------------------------------------------------------------------------------- */

enum { ENTRY_ARGUMENTS = 6 };

/* Where a function was called that faulted, or that is not there; 0 for a fault of the application's own code. */
static uint64_t caller_of_fault(const Coroutine *coroutine)
{
    if (!coroutine->is_native && coroutine->fault_pc >= ARENA_LOW && coroutine->fault_pc < ARENA_HIGH)
        return 0;
#if !defined(__x86_64__)
    if (!coroutine->is_native)
        return coroutine->registers[30];
#endif
    const uint64_t *at = coroutine->is_native ? coroutine->stack_pointer + RETURN_ADDRESS
                                              : (const uint64_t *)coroutine->fault_stack_pointer;
    uint64_t caller;
    return engine_copy(&caller, at, sizeof caller) ? 0 : caller;
}

/* The address that was used. A function of libc reads whole vectors, from before the pointer that it was given, and how
 * long they are is another on each computer: its pointer is what was wrong. */
static uint64_t used_address(const Coroutine *coroutine)
{
    enum { POINTERS = 3, LONGEST_VECTOR = 64 };
    for (int i = 0; coroutine->is_native && i < POINTERS; i++)
        if (coroutine->arguments[i] - coroutine->fault_address < LONGEST_VECTOR)
            return coroutine->arguments[i];
    return coroutine->fault_address;
}

static int fault_found(Coroutine *coroutine)
{
    uint64_t address = used_address(coroutine);
    uint64_t caller = caller_of_fault(coroutine);
    coroutine->is_native = false;
    PyObject *what = Py_BuildValue(
        "(iKKKL)", coroutine->signal, (unsigned long long)coroutine->fault_pc, (unsigned long long)caller,
        (unsigned long long)address,
        (long long)(coroutine->fault_stack_pointer - (uint64_t)coroutine->stack));
    PyErr_SetObject(fault_error, what);
    Py_XDECREF(what);
    return -1;
}

static void call_native(Coroutine *coroutine, const void *function)
{
    coroutine->result = ((const Function *)function)->native(coroutine, function);
}

static int serve_native(Coroutine *coroutine, const Function *function)
{
    coroutine->wants_python = coroutine->wants_again = false;
    coroutine->is_native = true;
    if (engine_try(coroutine, call_native, function)) {
        modes_abandon(coroutine);
        return fault_found(coroutine);
    }
    coroutine->is_native = false;
    return PyErr_Occurred() ? -1 : 0;
}

static double cpu_s(void)
{
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return now.tv_sec + now.tv_nsec / 1e9;
}

/* It computes without a call: Python does what waits to be done, and may have it end. Time in which other programs had
 * the CPU does not count. */
static int let_others_in(Coroutine *coroutine)
{
    running = NULL;
    double now = cpu_s();
    coroutine->computed_s += coroutine->computes_since ? now - coroutine->computes_since : 0;
    coroutine->computes_since = now;
    PyObject *pc = PyLong_FromUnsignedLongLong(coroutine->fault_pc);
    PyObject *function = pc ? PyObject_GetItem(coroutine->table->preempted, pc) : NULL;
    PyObject *answer = function ? PyObject_CallFunction(function, "dK", coroutine->computed_s,
                                                        (unsigned long long)coroutine->called_from)
                                : NULL;
    Py_XDECREF(pc);
    Py_XDECREF(function);
    Py_XDECREF(answer);
    return answer == NULL ? -1 : 0;
}

static int serve(Coroutine *coroutine)
{
    if (coroutine->wanted == PREEMPTED)
        return let_others_in(coroutine);
    if (coroutine->wanted == FAULT)
        return fault_found(coroutine);
    coroutine->result_high = 0;
    coroutine->computes_since = coroutine->computed_s = 0;
    coroutine->called_from = coroutine->stack_pointer[RETURN_ADDRESS];
    const Function *function = &coroutine->table->functions[coroutine->wanted];
    if (function->native != NULL) {
        if (serve_native(coroutine, function) < 0)
            return -1;
        if (!coroutine->wants_python || function->callable == NULL)
            return 0;
    }
    Function copy = *function; /* the table may grow meanwhile */
    running = NULL;
    Py_INCREF(copy.callable);
    uint32_t calls = races_calls(coroutine);
    if (copy.native == NULL) /* Python may call this code back */
        races_call(coroutine, coroutine->called_from);
    int result = calls_serve(coroutine, &copy);
    races_set_calls(coroutine, calls);
    Py_DECREF(copy.callable);
    if (result == 0 && coroutine->wants_again) {
        running = coroutine;
        coroutine->is_again = true;
        result = serve_native(coroutine, &copy);
        coroutine->is_again = false;
    }
    return result;
}

static void prepare(Coroutine *coroutine, uint64_t function, const uint64_t *values)
{
    uint64_t *top = (uint64_t *)((uint64_t)(coroutine->stack + coroutine->size) & ~15ull);
#if defined(__x86_64__)
    top -= 9; /* six registers, the address to begin at, the sixth argument, where to return to; aligned to 16 at that */
    top[0] = values[2]; /* r15 */
    top[1] = values[1]; /* r14 */
    top[2] = values[0]; /* r13 */
    top[3] = function;  /* r12 */
    top[4] = values[3]; /* rbx */
    top[5] = values[4]; /* rbp */
    top[6] = (uint64_t)engine_begin;
    top[7] = values[5];
    top[8] = coroutine->table->end;
    coroutine->float_modes = 0x1F80ull | 0x37Full << 32;
    coroutine->guard = STACK_GUARD;
#else
    top -= STACK_ARGUMENTS;
    top[0] = function; /* x19 */
    for (int i = 0; i < ENTRY_ARGUMENTS; i++)
        top[1 + i] = values[i]; /* x20 and on */
    top[1 + ENTRY_ARGUMENTS] = coroutine->table->end;
    top[RETURN_ADDRESS] = (uint64_t)engine_begin;
    coroutine->float_modes = 0;
#endif
    coroutine->stack_pointer = top;
}

/* The registers of code that stopped in a call, as far as a called function keeps them: as in `Coroutine.registers`. */
static void registers_of_call(const Coroutine *coroutine, uint64_t *to)
{
    const uint64_t *at = coroutine->stack_pointer;
    memset(to, 0, REGISTERS * sizeof *to);
#if defined(__x86_64__)
    static const int kept[] = {15, 14, 13, 12, 3, 6, 16}; /* as the switch has them: r15 to r12, rbx, rbp, the return address */
    for (int i = 0; i <= RETURN_ADDRESS; i++)
        to[kept[i]] = at[i];
    to[7] = (uint64_t)(at + STACK_ARGUMENTS);
#else
    for (int i = 0; i <= RETURN_ADDRESS; i++)
        to[19 + i] = at[i];
    to[31] = (uint64_t)(at + STACK_ARGUMENTS);
    to[32] = at[RETURN_ADDRESS];
#endif
}

/* A fault knows where the application's last call was: one in an argument is the fault of that. And it knows the
 * registers of the code, by which its callers are found. */
static void tell_caller(const Coroutine *coroutine)
{
    bool is_call = coroutine->wanted != FAULT && coroutine->wanted != PREEMPTED;
    uint64_t of_call[REGISTERS];
    if (is_call)
        registers_of_call(coroutine, of_call);
    PyObject *type, *error, *trace;
    PyErr_Fetch(&type, &error, &trace);
    PyErr_NormalizeException(&type, &error, &trace);
    PyObject *from = PyLong_FromUnsignedLongLong(coroutine->called_from);
    if (from == NULL || PyObject_SetAttrString(error, "called_from", from) < 0)
        PyErr_Clear();
    Py_XDECREF(from);
    PyObject *registers =
        Py_BuildValue("(y#N)", (const char *)(is_call ? of_call : coroutine->registers),
                      (Py_ssize_t)sizeof of_call, PyBool_FromLong(is_call));
    if (registers == NULL || PyObject_SetAttrString(error, "registers", registers) < 0)
        PyErr_Clear();
    Py_XDECREF(registers);
    PyErr_Restore(type, error, trace);
}

static Coroutine *all; /* the latest first */

/* Code that is called by code of its own task goes on with what belongs to a thread: the modes of floating point, and
 * where its thread-local variables are. */
static void inherit(Coroutine *to, const Coroutine *from)
{
    to->float_modes = from->float_modes;
    to->x87_flags = from->x87_flags;
    memcpy(to->thread_locals, from->thread_locals, sizeof to->thread_locals);
}

static void enter(Coroutine *coroutine, bool is_nested)
{
    for (Coroutine *each = all; is_nested && each != NULL && coroutine->outer == NULL; each = each->next)
        if (each->key == coroutine->key)
            coroutine->outer = each;
    coroutine->next = all;
    all = coroutine;
    if (coroutine->outer != NULL)
        inherit(coroutine, coroutine->outer);
}

static void leave(Coroutine *coroutine)
{
    Coroutine **place = &all;
    while (*place != coroutine)
        place = &(*place)->next;
    *place = coroutine->next;
    if (coroutine->outer != NULL)
        inherit(coroutine->outer, coroutine);
}

static PyObject *run(PyObject *module, PyObject *const *arguments, Py_ssize_t count)
{
    uint64_t values[ENTRY_ARGUMENTS] = {0};
    if (count != 9 || !Py_IS_TYPE(arguments[0], &table_type) || !PyTuple_Check(arguments[2]) ||
        PyTuple_GET_SIZE(arguments[2]) > ENTRY_ARGUMENTS) {
        PyErr_SetString(PyExc_TypeError, "run(table, function, arguments, stack, size, owner, task, key, is_nested)");
        return NULL;
    }
    for (Py_ssize_t i = 0; i < PyTuple_GET_SIZE(arguments[2]); i++)
        values[i] = PyLong_AsUnsignedLongLongMask(PyTuple_GET_ITEM(arguments[2], i));
    uint64_t function = PyLong_AsUnsignedLongLongMask(arguments[1]);
    Coroutine *coroutine = PyMem_Calloc(1, sizeof *coroutine); /* not on this stack, which greenlets move away */
    if (coroutine == NULL)
        return PyErr_NoMemory();
    coroutine->table = (Table *)Py_NewRef(arguments[0]);
    coroutine->stack = (char *)PyLong_AsUnsignedLongLongMask(arguments[3]);
    coroutine->size = PyLong_AsSize_t(arguments[4]);
    coroutine->owner = (uint32_t)PyLong_AsUnsignedLongMask(arguments[5]);
    coroutine->task = (uint32_t)PyLong_AsUnsignedLongMask(arguments[6]);
    coroutine->key = PyLong_AsUnsignedLongLongMask(arguments[7]);
    PyObject *result = NULL;
    if (!PyErr_Occurred() && faults_thread() == 0) {
        uint32_t calls = races_calls(coroutine); /* Python may have been called by code of this task, which goes on later */
        prepare(coroutine, function, values);
        enter(coroutine, arguments[8] == Py_True);
        do
            faults_resume(coroutine);
        while (coroutine->wanted != FINISHED && (serve(coroutine) == 0 || jump_lands(coroutine)));
        running = NULL;
        leave(coroutine);
        races_set_calls(coroutine, calls);
        if (PyErr_Occurred() && PyErr_ExceptionMatches(fault_error))
            tell_caller(coroutine);
        if (coroutine->wanted == FINISHED && !PyErr_Occurred())
            result = PyLong_FromUnsignedLongLong(coroutine->arguments[0]);
    }
    Py_DECREF(coroutine->table);
    PyMem_Free(coroutine);
    return result;
}

/* ---- memory ------------------------------------------------------------------------------------------------------- */

static PyObject *bad_address(uint64_t at) { return PyErr_Format(fault_error, "bad address %p", (void *)at); }

static PyObject *peek(PyObject *module, PyObject *const *arguments, Py_ssize_t count)
{
    uint64_t at = PyLong_AsUnsignedLongLongMask(arguments[0]);
    Py_ssize_t size = count == 2 ? PyLong_AsSsize_t(arguments[1]) : -1;
    if (PyErr_Occurred())
        return NULL;
    if (size < 0 || (uint64_t)size > ARENA_HIGH)
        return PyErr_Format(fault_error, "%zd bytes at %p", size, (void *)at);
    unsigned char probe; /* of a huge size, the last byte shows whether it is worth while */
    if (size > 0 && engine_copy(&probe, (void *)(at + size - 1), 1))
        return bad_address(at + size - 1);
    PyObject *bytes = PyBytes_FromStringAndSize(NULL, size);
    if (bytes != NULL && engine_copy(PyBytes_AS_STRING(bytes), (void *)at, (size_t)size)) {
        Py_DECREF(bytes);
        return bad_address(at);
    }
    return bytes;
}

static PyObject *poke(PyObject *module, PyObject *const *arguments, Py_ssize_t count)
{
    Py_buffer view;
    if (count != 2 || PyObject_GetBuffer(arguments[1], &view, PyBUF_SIMPLE) < 0)
        return NULL;
    uint64_t at = PyLong_AsUnsignedLongLongMask(arguments[0]);
    int is_bad = engine_copy((void *)at, view.buf, (size_t)view.len);
    PyBuffer_Release(&view);
    if (is_bad)
        return bad_address(at);
    Py_RETURN_NONE;
}

static PyObject *text(PyObject *module, PyObject *address) { return text_at(PyLong_AsUnsignedLongLongMask(address)); }

static PyObject *view(PyObject *module, PyObject *const *arguments, Py_ssize_t count)
{
    return PyMemoryView_FromMemory((char *)PyLong_AsUnsignedLongLongMask(arguments[0]), PyLong_AsSsize_t(arguments[1]),
                                   PyBUF_WRITE);
}

static PyObject *address_of(PyObject *module, PyObject *object)
{
    Py_buffer buffer;
    if (PyObject_GetBuffer(object, &buffer, PyBUF_SIMPLE) < 0)
        return NULL;
    PyObject *address = PyLong_FromVoidPtr(buffer.buf);
    PyBuffer_Release(&buffer);
    return address;
}

/* memory.c */
HIDDEN PyObject *memory_map(PyObject *, PyObject *), *memory_unmap(PyObject *, PyObject *);
HIDDEN PyObject *memory_protect(PyObject *, PyObject *), *memory_clear(PyObject *, PyObject *);
HIDDEN PyObject *memory_ctype(PyObject *, PyObject *), *memory_make_stub(PyObject *, PyObject *);
HIDDEN PyObject *memory_make_end(PyObject *, PyObject *), *memory_loaded(PyObject *, PyObject *);

/* natives_libc.c */
HIDDEN PyObject *error_text(PyObject *, PyObject *);

static PyObject *has_native(PyObject *module, PyObject *name)
{
    const char *text = PyUnicode_AsUTF8(name);
    return text == NULL ? NULL : PyBool_FromLong(find_native(text) != NULL);
}

static PyObject *natives(PyObject *module, PyObject *unused)
{
    PyObject *names = PyList_New(0);
    for (size_t i = 0; names != NULL && i < sizeof lists / sizeof *lists; i++)
        for (const NativeRow *row = lists[i]; row->name != NULL; row++) {
            PyObject *name = PyUnicode_FromString(row->name);
            if (name == NULL || PyList_Append(names, name) < 0)
                Py_CLEAR(names);
            Py_XDECREF(name);
        }
    return names;
}

static PyObject *begin(PyObject *module, PyObject *arguments)
{
    PyObject *status, *fault, *jump;
    if (!PyArg_ParseTuple(arguments, "OOO", &status, &fault, &jump))
        return NULL;
    Py_XSETREF(status_error, Py_NewRef(status));
    Py_XSETREF(fault_error, Py_NewRef(fault));
    Py_XSETREF(jump_error, Py_NewRef(jump));
    if (faults_begin() < 0)
        return NULL;
    Py_RETURN_NONE;
}

static PyMethodDef methods[] = {
    {"begin", begin, METH_VARARGS, "begin(status error, fault error, jump error)"},
    {"run", (PyCFunction)(void *)run, METH_FASTCALL, "run(table, function, arguments, stack, size, owner, task, key, is_nested) -> result"},
    {"peek", (PyCFunction)(void *)peek, METH_FASTCALL, "peek(address, size) -> bytes"},
    {"poke", (PyCFunction)(void *)poke, METH_FASTCALL, "poke(address, bytes)"},
    {"text", text, METH_O, "text(address) -> str"},
    {"view", (PyCFunction)(void *)view, METH_FASTCALL, "view(address, size) -> memoryview"},
    {"address_of", address_of, METH_O, "address_of(buffer) -> address"},
    {"map", memory_map, METH_VARARGS, "map(address, size): zeros, readable and writable, exactly there"},
    {"unmap", memory_unmap, METH_VARARGS, "unmap(address, size)"},
    {"protect", memory_protect, METH_VARARGS, "protect(address, size, rights): 4 read, 2 write, 1 execute"},
    {"loaded", memory_loaded, METH_VARARGS, "loaded(name, file, base): let a debugger see the object that is loaded there"},
    {"clear", memory_clear, METH_VARARGS, "clear(address, size): zeros again"},
    {"ctype", memory_ctype, METH_NOARGS, "ctype() -> the tables of <ctype.h>, as bytes from index -128 on"},
    {"make_stub", memory_make_stub, METH_VARARGS, "make_stub(address, number, thread_local=False) -> size: code there that calls a function"},
    {"make_end", memory_make_end, METH_O, "make_end(address): code there that ends the function that returns to it"},
    {"error_text", error_text, METH_O, "error_text(errno) -> (its text in the locale C, whether libc knows it)"},
    {"has_native", has_native, METH_O, "has_native(name) -> whether the engine has such a function"},
    {"natives", natives, METH_NOARGS, "natives() -> names of the functions that the engine answers"},
    {NULL, NULL, 0, NULL},
};
static struct PyModuleDef definition = {PyModuleDef_HEAD_INIT, "_engine", "Compiled C code as coroutines of Python.", -1, methods};

PyMODINIT_FUNC PyInit__engine(void)
{
    PyObject *module = PyModule_Create(&definition);
    if (module == NULL || PyType_Ready(&heap_type) < 0 || PyType_Ready(&images_type) < 0 || PyType_Ready(&table_type) < 0 || PyType_Ready(&races_type) < 0 ||
        PyModule_AddObjectRef(module, "Heap", (PyObject *)&heap_type) < 0 ||
        PyModule_AddObjectRef(module, "Images", (PyObject *)&images_type) < 0 ||
        PyModule_AddObjectRef(module, "Races", (PyObject *)&races_type) < 0 ||
        PyModule_AddObjectRef(module, "Table", (PyObject *)&table_type) < 0 ||
        PyModule_AddIntConstant(module, "STACK_GUARD", STACK_GUARD) < 0 ||
        PyModule_AddIntConstant(module, "ARENA_LOW", ARENA_LOW) < 0 ||
        PyModule_AddIntConstant(module, "ARENA_HIGH", ARENA_HIGH) < 0)
        return NULL;
    return module;
}
