/* `Heap`: memory in blocks, for malloc and for the messages that applications see.
 *
 * A heap fills its stretch of the arena from below; blocks given back are kept by their size and taken again, last in,
 * first out. So the addresses that an application gets are the same in each run. A block's size and owner are kept beside
 * the memory, not in it: what an application writes past a block does not harm the heap.
 */
#include "engine.h"

#include <string.h>
#include <sys/mman.h>

enum { GRAIN = 16, CLASSES = 100, POISON = 0xA5, PAST_END = -1, BEFORE_START = -2 };

typedef struct {
    uint64_t address, end, next;                /* of a guarded one: where its pages end, and the guard behind them */
    size_t size, room;
    uint32_t owner;
    int class;
    bool is_used;
} Block;

struct Heap {
    PyObject_HEAD
    uint64_t base, top, end;
    bool is_guarded;                            /* each block ends where a page does that nobody may touch */
    size_t slack, grain, page;
    Block *blocks;                              /* in the order of their addresses */
    int count, room;
    int *free_of[CLASSES];                      /* numbers of free blocks, by class */
    int free_count[CLASSES], free_room[CLASSES];
    uint32_t owner;                             /* who gets what is taken now */
    size_t used;
    uint64_t takes;                             /* blocks that were taken so far, given back or not */
    PyObject *noted;                            /* what was found of blocks that nobody gave back by a call */
};

/* Sizes of four steps between powers of two: at most a fifth of a block is lost. */
static int class_of(size_t size, size_t *room)
{
    size_t limit = 64;
    for (int class = 0; class < CLASSES; limit *= 2)
        for (size_t step = 0; step < 4 && class < CLASSES; step++, class++)
            if (size <= limit + step * limit / 4) {
                *room = limit + step * limit / 4;
                return class;
            }
    return -1;
}

static Block *find(const Heap *heap, uint64_t address)
{
    int low = 0, high = heap->count - 1;
    while (low <= high) {
        int middle = (low + high) / 2;
        Block *block = &heap->blocks[middle];
        if (block->address == address)
            return block;
        if (block->address < address)
            low = middle + 1;
        else
            high = middle - 1;
    }
    return NULL;
}

static uint64_t up(uint64_t address, uint64_t to) { return (address + to - 1) & -to; }

/* Where a guarded block goes, so that it ends as close to the end of a page as its alignment lets it. */
static uint64_t place(const Heap *heap, size_t size, size_t grain, uint64_t *end)
{
    *end = up(heap->top + (size ? size : 1), heap->page);
    uint64_t address = (*end - size) & -(uint64_t)grain;
    if (address < heap->top) { /* of more than a page */
        address = up(heap->top, grain);
        *end = up(address + size, heap->page);
    }
    return address;
}

static Block *new_block(Heap *heap, size_t size, size_t grain)
{
    size_t room = 0;
    int class = class_of(size + heap->slack, &room);
    uint64_t address = grain > GRAIN ? up(heap->top, grain) : heap->top, next = address + room, end = next;
    if (heap->is_guarded) {
        address = place(heap, size, grain, &end);
        next = end + heap->page;
        room = size;
        if (next <= heap->end && mprotect((void *)end, heap->page, PROT_NONE) != 0)
            end = next; /* Linux has a limit (vm.max_map_count): what is written there is found later */
    }
    if (class < 0 || next > heap->end || next < heap->top)
        return NULL;
    if (heap->count == heap->room) {
        int more = heap->room ? 2 * heap->room : 64;
        Block *blocks = PyMem_Realloc(heap->blocks, more * sizeof *blocks);
        if (blocks == NULL)
            return NULL;
        heap->blocks = blocks;
        heap->room = more;
    }
    heap->top = next;
    Block *block = &heap->blocks[heap->count++];
    *block = (Block){.address = address, .end = end, .next = next, .room = room, .class = class};
    return block;
}

/* The bytes of a guarded block's pages that are not its own: those before it. */
static unsigned char *before(const Heap *heap, const Block *block, size_t *size)
{
    uint64_t first = block->address & -(uint64_t)heap->page;
    *size = heap->is_guarded ? block->address - first : 0;
    return (unsigned char *)first;
}

/* Those behind it. */
static unsigned char *behind(const Heap *heap, const Block *block, size_t *size)
{
    *size = heap->is_guarded ? block->end - block->address - block->size : 0;
    return (unsigned char *)block->address + block->size;
}

static void poison(const Heap *heap, const Block *block)
{
    size_t size;
    unsigned char *bytes = before(heap, block, &size);
    memset(bytes, POISON, size);
    bytes = behind(heap, block, &size);
    memset(bytes, POISON, size);
}

static bool is_poisoned(const unsigned char *bytes, size_t size)
{
    return size == 0 || (bytes[0] == POISON && memcmp(bytes, bytes + 1, size - 1) == 0);
}

/* 0, or PAST_END or BEFORE_START for what was written there. */
static int damage_of(const Heap *heap, const Block *block)
{
    size_t size;
    const unsigned char *bytes = behind(heap, block, &size);
    if (!is_poisoned(bytes, size))
        return PAST_END;
    bytes = before(heap, block, &size);
    return is_poisoned(bytes, size) ? 0 : BEFORE_START;
}

HIDDEN const char *heap_damage(int found) { return found == PAST_END ? "past its end" : "before its start"; }

/* Keep what was written around a block until somebody tells it; it is told once. */
static void note(Heap *heap, const Block *block)
{
    int found = block->is_used ? damage_of(heap, block) : 0;
    if (found == 0)
        return;
    poison(heap, block);
    PyObject *told = Py_BuildValue("(KKIs)", (unsigned long long)block->address, (unsigned long long)block->size,
                                   (unsigned)block->owner, heap_damage(found));
    if (told == NULL || PyList_Append(heap->noted, told) < 0)
        PyErr_Clear();
    Py_XDECREF(told);
}

/* The block that was given back last, of those of a class that have an alignment; NULL when there is none. */
static Block *freed_block(Heap *heap, int class, size_t grain)
{
    int *numbers = heap->free_of[class];
    for (int at = heap->free_count[class] - 1; at >= 0; at--) {
        Block *block = &heap->blocks[numbers[at]];
        if (grain <= GRAIN || block->address % grain == 0) {
            memmove(&numbers[at], &numbers[at + 1], (--heap->free_count[class] - at) * sizeof *numbers);
            memset((void *)block->address, 0, block->room);
            return block;
        }
    }
    return NULL;
}

static uint64_t take_aligned(Heap *heap, size_t size, size_t grain)
{
    size_t room;
    if (size > heap->end - heap->base || grain > heap->end - heap->base)
        return 0;
    int class = class_of(size + heap->slack, &room);
    Block *block = class >= 0 && !heap->is_guarded ? freed_block(heap, class, grain) : NULL;
    if (block == NULL)
        block = new_block(heap, size, grain);
    if (block == NULL)
        return 0;
    block->size = size;
    block->owner = heap->owner;
    block->is_used = true;
    heap->used += size;
    heap->takes++;
    races_forget(block->address, size);
    poison(heap, block);
    return block->address;
}

/* A block of zeros, aligned to 16 bytes; 0 when there is no memory left. */
HIDDEN uint64_t heap_take(Heap *heap, size_t size) { return take_aligned(heap, size, heap->grain); }

/* As heap_take, for malloc, which promises nothing of what is in the block: a guarded heap shows that. */
HIDDEN uint64_t heap_take_any(Heap *heap, size_t size, size_t alignment)
{
    uint64_t address = take_aligned(heap, size, alignment > heap->grain ? alignment : heap->grain);
    if (address != 0 && heap->is_guarded)
        memset((void *)address, POISON, size);
    return address;
}

HIDDEN void heap_own(Heap *heap, uint32_t owner) { heap->owner = owner; }

/* `is_kept`: it stays readable and writable, for whoever still looks at it. */
static bool give(Heap *heap, Block *block, bool is_kept)
{
    int class = block->class;
    if (heap->free_count[class] == heap->free_room[class]) {
        int more = heap->free_room[class] ? 2 * heap->free_room[class] : 16;
        int *numbers = PyMem_Realloc(heap->free_of[class], more * sizeof *numbers);
        if (numbers == NULL)
            return false;
        heap->free_of[class] = numbers;
        heap->free_room[class] = more;
    }
    block->is_used = false;
    heap->used -= block->size;
    if (!heap->is_guarded)
        heap->free_of[class][heap->free_count[class]++] = (int)(block - heap->blocks);
    else if (!is_kept) { /* never given out again: who still uses it is found out */
        uint64_t first = block->address & -(uint64_t)heap->page;
        madvise((void *)first, block->end - first, MADV_DONTNEED);
        mprotect((void *)first, block->end - first, PROT_NONE);
    }
    return true;
}

HIDDEN int heap_give(Heap *heap, uint64_t address)
{
    Block *block = find(heap, address);
    if (block == NULL || !block->is_used)
        return 0;
    int found = damage_of(heap, block);
    give(heap, block, false);
    return found ? found : 1;
}

HIDDEN void heap_drop(Heap *heap, uint64_t address)
{
    Block *block = find(heap, address);
    if (block != NULL && block->is_used) {
        note(heap, block);
        give(heap, block, false);
    }
}

HIDDEN size_t heap_size_of(Heap *heap, uint64_t address)
{
    Block *block = find(heap, address);
    return block != NULL && block->is_used ? block->size : 0;
}

/* ---- for Python --------------------------------------------------------------------------------------------------- */

static PyObject *heap_new(PyTypeObject *type, PyObject *arguments, PyObject *options)
{
    static char *names[] = {"base", "size", "slack", "guarded", "grain", "page", NULL};
    unsigned long long base, size, slack = 0, grain = GRAIN, page = 4096;
    int is_guarded = 0;
    if (!PyArg_ParseTupleAndKeywords(arguments, options, "KK|KpKK", names, &base, &size, &slack, &is_guarded, &grain, &page))
        return NULL;
    Heap *heap = (Heap *)type->tp_alloc(type, 0);
    if (heap != NULL) {
        heap->base = heap->top = base;
        heap->end = base + size;
        heap->slack = is_guarded ? 0 : slack;
        heap->is_guarded = is_guarded;
        heap->grain = grain ? grain : GRAIN;
        heap->page = page;
        heap->noted = PyList_New(0);
        if (heap->noted == NULL)
            Py_CLEAR(heap);
    }
    return (PyObject *)heap;
}

static void heap_dealloc(Heap *heap)
{
    Py_XDECREF(heap->noted);
    PyMem_Free(heap->blocks);
    for (int i = 0; i < CLASSES; i++)
        PyMem_Free(heap->free_of[i]);
    Py_TYPE(heap)->tp_free(heap);
}

static PyObject *take(Heap *heap, PyObject *arguments)
{
    unsigned long long size, grain = heap->grain;
    if (!PyArg_ParseTuple(arguments, "K|K", &size, &grain))
        return NULL;
    return PyLong_FromUnsignedLongLong(take_aligned(heap, size, grain));
}

static PyObject *give_back(Heap *heap, PyObject *arguments)
{
    unsigned long long address;
    int is_kept = 0;
    if (!PyArg_ParseTuple(arguments, "K|p", &address, &is_kept))
        return NULL;
    Block *block = find(heap, address);
    if (block == NULL || !block->is_used)
        Py_RETURN_FALSE;
    note(heap, block);
    give(heap, block, is_kept);
    Py_RETURN_TRUE;
}

static PyObject *damage(Heap *heap, PyObject *address)
{
    Block *block = find(heap, PyLong_AsUnsignedLongLongMask(address));
    int found = block != NULL && block->is_used ? damage_of(heap, block) : 0;
    if (found == 0)
        Py_RETURN_NONE;
    poison(heap, block);
    return PyUnicode_FromString(heap_damage(found));
}

static PyObject *check(Heap *heap, PyObject *unused)
{
    for (int i = 0; i < heap->count; i++)
        note(heap, &heap->blocks[i]);
    Py_RETURN_NONE;
}

static PyObject *take_noted(Heap *heap, PyObject *unused)
{
    PyObject *fresh = PyList_New(0);
    if (fresh == NULL)
        return NULL;
    PyObject *noted = heap->noted;
    heap->noted = fresh;
    return noted;
}

static PyObject *near(Heap *heap, PyObject *number)
{
    uint64_t address = PyLong_AsUnsignedLongLongMask(number);
    if (!heap->is_guarded || address < heap->base || address >= heap->top)
        Py_RETURN_NONE;
    int low = 0, high = heap->count - 1; /* the first block whose guard ends behind the address */
    while (low < high) {
        int middle = (low + high) / 2;
        if (heap->blocks[middle].next > address)
            high = middle;
        else
            low = middle + 1;
    }
    Block *block = &heap->blocks[low];
    bool has_next = low + 1 < heap->count && address >= block->end;
    if (has_next && block[1].address - address < address - (block->address + block->size))
        block++; /* it is in the guard between two, and closer to the second */
    return Py_BuildValue("(KKN)", (unsigned long long)block->address, (unsigned long long)block->size,
                         PyBool_FromLong(block->is_used));
}

static PyObject *size_of(Heap *heap, PyObject *address)
{
    Block *block = find(heap, PyLong_AsUnsignedLongLongMask(address));
    if (block == NULL || !block->is_used)
        Py_RETURN_NONE;
    return PyLong_FromSize_t(block->size);
}

static PyObject *give_all(Heap *heap, PyObject *owner)
{
    uint32_t whose = (uint32_t)PyLong_AsUnsignedLongMask(owner);
    for (int i = 0; i < heap->count; i++)
        if (heap->blocks[i].is_used && heap->blocks[i].owner == whose) {
            note(heap, &heap->blocks[i]);
            give(heap, &heap->blocks[i], false);
        }
    Py_RETURN_NONE;
}

static PyObject *get_owner(Heap *heap, void *unused) { return PyLong_FromUnsignedLong(heap->owner); }
static int set_owner(Heap *heap, PyObject *owner, void *unused)
{
    heap->owner = (uint32_t)PyLong_AsUnsignedLongMask(owner);
    return 0;
}
static PyObject *get_used(Heap *heap, void *unused) { return PyLong_FromSize_t(heap->used); }
static PyObject *get_takes(Heap *heap, void *unused) { return PyLong_FromUnsignedLongLong(heap->takes); }

static PyMethodDef heap_methods[] = {
    {"take", (PyCFunction)take, METH_VARARGS,
     "take(size, grain=the heap's) -> address of a block of zeros, 0 when there is no memory left; the alignment is of a "
     "guarded heap's blocks"},
    {"give", (PyCFunction)give_back, METH_VARARGS,
     "give(address, is_kept=False) -> whether it was a block in use; one that is kept stays readable and writable"},
    {"damage", (PyCFunction)damage, METH_O,
     "damage(address) -> 'past its end' or 'before its start' for a block in use that was written past, once; or None"},
    {"check", (PyCFunction)check, METH_NOARGS, "check(): note all blocks in use that were written past"},
    {"noted", (PyCFunction)take_noted, METH_NOARGS,
     "noted() -> (address, size, owner, damage) of blocks that were found by `check`, or when they were given back"},
    {"near", (PyCFunction)near, METH_O,
     "near(address) -> (address, size, whether it is in use) of the guarded block whose pages or guard it is in, or None"},
    {"size_of", (PyCFunction)size_of, METH_O, "size_of(address) -> bytes of a block in use, or None"},
    {"give_all", (PyCFunction)give_all, METH_O, "give_all(owner): give back all blocks of an owner"},
    {NULL, NULL, 0, NULL},
};
static PyGetSetDef heap_attributes[] = {
    {"owner", (getter)get_owner, (setter)set_owner, "whose the blocks are that are taken from now on", NULL},
    {"used", (getter)get_used, NULL, "bytes in use", NULL},
    {"takes", (getter)get_takes, NULL, "blocks that were taken so far, given back or not", NULL},
    {NULL, NULL, NULL, NULL, NULL},
};
HIDDEN PyTypeObject heap_type = {
    PyVarObject_HEAD_INIT(NULL, 0).tp_name = "cfepy.extra.c._engine.Heap",
    .tp_basicsize = sizeof(Heap),
    .tp_flags = Py_TPFLAGS_DEFAULT,
    .tp_new = heap_new,
    .tp_dealloc = (destructor)heap_dealloc,
    .tp_methods = heap_methods,
    .tp_getset = heap_attributes,
    .tp_doc = "Heap(base, size, slack=0, guarded=False, grain=16, page=4096): blocks in a stretch of mapped memory",
};
