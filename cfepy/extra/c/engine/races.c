/* `Races`: which accesses to memory are ordered, and which are not, for code that was compiled with -fsanitize=thread.
 *
 * Each task has a vector clock: what it knows of the others. What a task lets go of (a semaphore, a message) takes the
 * clock along, who takes that knows it from then on. Eight bytes of memory remember up to four accesses, with the task and
 * its clock at that time. A new one of another task, one of both a write, whose clock the task does not know, is a race:
 * nothing orders the two, so another schedule could swap them.
 *
 * An access remembers the calls that it was in, too, by one number: each call of a function from each place is there once,
 * with the number of the call that it is in.
 */
#include "engine.h"

#include <string.h>

enum { CELLS = 4, GRANULE = 8, FIRST_ROOM = 1 << 12, MOST_GRANULES = 1 << 16 };

typedef struct {
    uint32_t *at;
    int size;
    int group;                                 /* of a task: of those that have their code in one object */
    int alive;                                 /* of a group: its tasks; the thing of this number */
    uint32_t calls;                            /* of a task: the call that it is in */
} Clock;

struct Races {
    PyObject_HEAD
    Clock *tasks, *things;                     /* by number; task 0 is nobody */
    int task_count, thing_count;
    PyObject *report;
    bool has_begun;                            /* code that tells of its accesses is there */
};

typedef struct {
    uint64_t pc;
    uint32_t task, clock;                      /* clock 0: nothing here */
    uint32_t calls;
    uint8_t mask;                              /* of the bytes */
    bool is_write, is_atomic;
} Access;

typedef struct {
    uint64_t key;                              /* address / 8; 0: nothing here */
    Access accesses[CELLS];
    uint32_t first_task;
    uint8_t next;
} Granule;

/* One for all processors: their memory is apart. */
static Granule *granules;
static size_t room, count;

static size_t slot_of(uint64_t key)
{
    size_t slot = (key * 0x9E3779B97F4A7C15ull >> 20) & (room - 1);
    while (granules[slot].key != 0 && granules[slot].key != key)
        slot = (slot + 1) & (room - 1);
    return slot;
}

static Granule *find(uint64_t key)
{
    if (room == 0)
        return NULL;
    Granule *found = &granules[slot_of(key)];
    return found->key == 0 ? NULL : found;
}

static bool grow(void)
{
    size_t before = room, more = room ? 2 * room : FIRST_ROOM;
    Granule *old = granules, *made = PyMem_Calloc(more, sizeof *made);
    if (made == NULL)
        return false;
    granules = made;
    room = more;
    for (size_t i = 0; i < before; i++)
        if (old[i].key != 0)
            granules[slot_of(old[i].key)] = old[i];
    PyMem_Free(old);
    return true;
}

static Granule *find_or_add(uint64_t key)
{
    if (4 * count >= 3 * room && !grow())
        return NULL;
    Granule *found = &granules[slot_of(key)];
    if (found->key == 0) {
        found->key = key;
        count++;
    }
    return found;
}

static void forget(Granule *granule) { *granule = (Granule){.key = granule->key}; }

/* Memory is another one from now on: given back, or given out anew. */
HIDDEN void races_forget(uint64_t address, uint64_t size)
{
    if (count == 0 || size == 0)
        return;
    uint64_t first = address / GRANULE, last = (address + size - 1) / GRANULE;
    if (last - first > room) {
        for (size_t i = 0; i < room; i++)
            if (granules[i].key >= first && granules[i].key <= last)
                forget(&granules[i]);
        return;
    }
    for (uint64_t key = first; key <= last; key++) {
        Granule *granule = find(key);
        if (granule != NULL)
            forget(granule);
    }
}

/* Whether another task may use this: one has been there, or another one of the same object is alive, and it is no local
 * variable of the running one. */
HIDDEN bool races_shared(Coroutine *call, uint64_t address, uint64_t size)
{
    Races *races = call->table->races;
    if (!races->has_begun)
        return false;
    bool is_local = address >= (uint64_t)call->stack && address < (uint64_t)call->stack + call->size;
    if (!is_local && call->task < (uint32_t)races->task_count) {
        int group = races->tasks[call->task].group;
        if (group < races->thing_count && races->things[group].alive > 1)
            return true;
    }
    for (uint64_t key = address / GRANULE, left = MOST_GRANULES;
         size > 0 && left > 0 && key <= (address + size - 1) / GRANULE; key++, left--) {
        Granule *granule = find(key);
        if (granule != NULL && granule->first_task != 0 && granule->first_task != call->task)
            return true;
    }
    return false;
}

HIDDEN void races_begin(Races *races)
{
    if (races != NULL)
        races->has_begun = true;
}

/* ---- calls -------------------------------------------------------------------------------------------------------- */

typedef struct {
    uint64_t returns_to;
    uint32_t outer;
} Call;

static Call *calls;                            /* 0: none; as many at most as half of the slots */
static uint32_t *call_slots, call_count, call_room;

static uint32_t call_slot(uint32_t outer, uint64_t returns_to)
{
    uint64_t mixed = (returns_to ^ (uint64_t)outer << 40) * 0x9E3779B97F4A7C15ull;
    uint32_t slot = (uint32_t)(mixed >> 32) & (call_room - 1);
    while (call_slots[slot] != 0 &&
           (calls[call_slots[slot]].outer != outer || calls[call_slots[slot]].returns_to != returns_to))
        slot = (slot + 1) & (call_room - 1);
    return slot;
}

static bool grow_calls(void)
{
    uint32_t more = call_room ? 2 * call_room : FIRST_ROOM;
    Call *made = PyMem_Realloc(calls, (more / 2 + 1) * sizeof *made);
    if (made == NULL)
        return false;
    calls = made;
    uint32_t *slots = PyMem_Calloc(more, sizeof *slots);
    if (slots == NULL)
        return false;
    PyMem_Free(call_slots);
    call_slots = slots;
    call_room = more;
    for (uint32_t i = 1; i <= call_count; i++)
        call_slots[call_slot(calls[i].outer, calls[i].returns_to)] = i;
    return true;
}

static Clock *caller(const Coroutine *call)
{
    Races *races = call->table->races;
    return races == NULL || call->task == 0 || call->task >= (uint32_t)races->task_count ? NULL
                                                                                         : &races->tasks[call->task];
}

HIDDEN void races_call(Coroutine *call, uint64_t returns_to)
{
    Clock *task = caller(call);
    if (task == NULL || (2 * call_count >= call_room && !grow_calls()))
        return;
    uint32_t slot = call_slot(task->calls, returns_to);
    if (call_slots[slot] == 0) {
        calls[++call_count] = (Call){returns_to, task->calls};
        call_slots[slot] = call_count;
    }
    task->calls = call_slots[slot];
}

HIDDEN void races_return(Coroutine *call)
{
    Clock *task = caller(call);
    if (task != NULL && task->calls != 0)
        task->calls = calls[task->calls].outer;
}

HIDDEN uint32_t races_calls(const Coroutine *call)
{
    const Clock *task = caller(call);
    return task == NULL ? 0 : task->calls;
}

HIDDEN void races_set_calls(const Coroutine *call, uint32_t before)
{
    Clock *task = caller(call);
    if (task != NULL)
        task->calls = before;
}

/* ---- clocks ------------------------------------------------------------------------------------------------------- */

static uint32_t known(const Clock *clock, uint32_t task) { return task < (uint32_t)clock->size ? clock->at[task] : 0; }

static bool make_room(Clock *clock, int size)
{
    if (size <= clock->size)
        return true;
    uint32_t *at = PyMem_Realloc(clock->at, size * sizeof *at);
    if (at == NULL)
        return false;
    memset(at + clock->size, 0, (size - clock->size) * sizeof *at);
    clock->at = at;
    clock->size = size;
    return true;
}

static int learn(Clock *to, const Clock *from)
{
    if (!make_room(to, from->size)) {
        PyErr_NoMemory();
        return -1;
    }
    for (int i = 0; i < from->size; i++)
        if (from->at[i] > to->at[i])
            to->at[i] = from->at[i];
    return 0;
}

/* ---- accesses ----------------------------------------------------------------------------------------------------- */

static PyObject *told(const Access *access)
{
    PyObject *returns = PyList_New(0);
    for (uint32_t each = access->calls; returns != NULL && each != 0; each = calls[each].outer) {
        PyObject *returns_to = PyLong_FromUnsignedLongLong(calls[each].returns_to);
        if (returns_to == NULL || PyList_Append(returns, returns_to) < 0)
            Py_CLEAR(returns);
        Py_XDECREF(returns_to);
    }
    return returns == NULL ? NULL : Py_BuildValue("(KINN)", (unsigned long long)access->pc, access->task,
                                                  PyBool_FromLong(access->is_write), returns);
}

static void tell(Coroutine *call, uint64_t address, const Access *before, const Access *now)
{
    PyObject *first = told(before), *second = first == NULL ? NULL : told(now);
    PyObject *answer = second == NULL ? NULL
                                      : PyObject_CallFunction(call->table->races->report, "KOO",
                                                              (unsigned long long)address, first, second);
    Py_XDECREF(first);
    Py_XDECREF(second);
    Py_XDECREF(answer);
}

static void note_granule(Coroutine *call, uint64_t key, const Access *now)
{
    Granule *granule = find_or_add(key);
    if (granule == NULL)
        return;
    const Clock *mine = &call->table->races->tasks[now->task];
    Access *to = NULL;
    if (granule->first_task == 0)
        granule->first_task = now->task;
    for (int i = 0; i < CELLS; i++) {
        Access *cell = &granule->accesses[i];
        if (cell->clock == 0) {
            if (to == NULL)
                to = cell;
            continue;
        }
        bool is_known = cell->task == now->task || cell->clock <= known(mine, cell->task);
        bool is_covered = (cell->mask & ~now->mask) == 0 && (now->is_write || !cell->is_write) &&
                          cell->is_atomic == now->is_atomic;
        if (is_known && is_covered)
            to = cell;
        if (!is_known && (cell->mask & now->mask) != 0 && (cell->is_write || now->is_write) &&
            !(cell->is_atomic && now->is_atomic))
            tell(call, key * GRANULE + (uint64_t)__builtin_ctz(cell->mask & now->mask), cell, now);
    }
    if (to == NULL) {
        to = &granule->accesses[granule->next];
        granule->next = (granule->next + 1) % CELLS;
    }
    *to = *now;
}

/* An access of the running task; what it races with is reported, and what the report raises ends the code. */
HIDDEN void races_note(Coroutine *call, uint64_t address, uint64_t size, bool is_write, bool is_atomic)
{
    Races *races = call->table->races;
    if (!races->has_begun || call->task == 0 || call->task >= (uint32_t)races->task_count || address < GRANULE)
        return;
    const Clock *task = &races->tasks[call->task];
    Access now = {call->called_from - 1, call->task, known(task, call->task), task->calls, 0, is_write, is_atomic};
    uint64_t end = address + size;
    for (uint64_t key = address / GRANULE, left = MOST_GRANULES; key * GRANULE < end && left > 0; key++, left--) {
        uint64_t low = key * GRANULE < address ? address % GRANULE : 0;
        uint64_t high = end - key * GRANULE < GRANULE ? end - key * GRANULE : GRANULE;
        now.mask = (uint8_t)((1u << high) - (1u << low));
        note_granule(call, key, &now);
    }
}

/* ---- for Python --------------------------------------------------------------------------------------------------- */

static PyObject *races_new(PyTypeObject *type, PyObject *arguments, PyObject *options)
{
    PyObject *report;
    if (!PyArg_ParseTuple(arguments, "O", &report))
        return NULL;
    Races *races = (Races *)type->tp_alloc(type, 0);
    if (races != NULL)
        races->report = Py_NewRef(report);
    return (PyObject *)races;
}

static int races_traverse(Races *races, visitproc visit, void *arg)
{
    Py_VISIT(races->report);
    return 0;
}

static int races_clear(Races *races)
{
    Py_CLEAR(races->report);
    return 0;
}

static void races_dealloc(Races *races)
{
    PyObject_GC_UnTrack(races);
    races_clear(races);
    for (int i = 0; i < races->task_count; i++)
        PyMem_Free(races->tasks[i].at);
    for (int i = 0; i < races->thing_count; i++)
        PyMem_Free(races->things[i].at);
    PyMem_Free(races->tasks);
    PyMem_Free(races->things);
    Py_TYPE(races)->tp_free(races);
}

static int add_clock(Clock **clocks, int *number)
{
    Clock *more = PyMem_Realloc(*clocks, (*number + 1) * sizeof *more);
    if (more == NULL) {
        PyErr_NoMemory();
        return -1;
    }
    *clocks = more;
    more[*number] = (Clock){NULL};
    return (*number)++;
}

static PyObject *new_task(Races *races, PyObject *unused)
{
    if (races->task_count == 0 && add_clock(&races->tasks, &races->task_count) < 0)
        return NULL;
    int number = add_clock(&races->tasks, &races->task_count);
    if (number < 0)
        return NULL;
    if (!make_room(&races->tasks[number], number + 1))
        return PyErr_NoMemory();
    races->tasks[number].at[number] = 1;
    return PyLong_FromLong(number);
}

static PyObject *new_thing(Races *races, PyObject *unused)
{
    int number = add_clock(&races->things, &races->thing_count);
    return number < 0 ? NULL : PyLong_FromLong(number);
}

static int clocks_of(Races *races, PyObject *arguments, Clock **task, Clock **thing, int *number)
{
    int other;
    if (!PyArg_ParseTuple(arguments, "ii", number, &other))
        return -1;
    if (*number <= 0 || *number >= races->task_count || other < 0 || other >= races->thing_count) {
        PyErr_SetString(PyExc_IndexError, "no such task or thing");
        return -1;
    }
    *task = &races->tasks[*number];
    *thing = &races->things[other];
    return 0;
}

static PyObject *let_go(Races *races, PyObject *arguments)
{
    Clock *task, *thing;
    int number;
    if (clocks_of(races, arguments, &task, &thing, &number) < 0 || learn(thing, task) < 0)
        return NULL;
    task->at[number]++;
    Py_RETURN_NONE;
}

static PyObject *take(Races *races, PyObject *arguments)
{
    Clock *task, *thing;
    int number;
    if (clocks_of(races, arguments, &task, &thing, &number) < 0 || learn(task, thing) < 0)
        return NULL;
    Py_RETURN_NONE;
}

static PyObject *enter(Races *races, PyObject *arguments)
{
    Clock *task, *group;
    int number;
    if (clocks_of(races, arguments, &task, &group, &number) < 0)
        return NULL;
    task->group = (int)(group - races->things);
    group->alive++;
    Py_RETURN_NONE;
}

static PyObject *leave(Races *races, PyObject *arguments)
{
    Clock *task, *group;
    int number;
    if (clocks_of(races, arguments, &task, &group, &number) < 0)
        return NULL;
    group->alive--;
    Py_RETURN_NONE;
}

static PyMethodDef races_methods[] = {
    {"enter", (PyCFunction)enter, METH_VARARGS, "enter(task, thing): the task begins; its code is in this object"},
    {"leave", (PyCFunction)leave, METH_VARARGS, "leave(task, thing): it has ended"},
    {"task", (PyCFunction)new_task, METH_NOARGS, "task() -> the number of a new task"},
    {"thing", (PyCFunction)new_thing, METH_NOARGS, "thing() -> the number of a new thing that orders tasks"},
    {"let_go", (PyCFunction)let_go, METH_VARARGS, "let_go(task, thing): who takes the thing later comes after this"},
    {"take", (PyCFunction)take, METH_VARARGS, "take(task, thing): the task comes after all that let go of it so far"},
    {NULL, NULL, 0, NULL},
};
HIDDEN PyTypeObject races_type = {
    PyVarObject_HEAD_INIT(NULL, 0).tp_name = "cfepy.extra.c._engine.Races",
    .tp_basicsize = sizeof(Races),
    .tp_flags = Py_TPFLAGS_DEFAULT | Py_TPFLAGS_HAVE_GC,
    .tp_new = races_new,
    .tp_dealloc = (destructor)races_dealloc,
    .tp_traverse = (traverseproc)races_traverse,
    .tp_clear = (inquiry)races_clear,
    .tp_methods = races_methods,
    .tp_doc = "Races(report): finds accesses that nothing orders; report(address, before, now), each (pc, task, is write, "
              "where its calls return to, the innermost first)",
};
