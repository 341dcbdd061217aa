/* `Heap`: memory in blocks, for malloc and for the messages that applications see.
 *
 * A heap fills its stretch of the arena from below; blocks given back are kept by their size and taken again, last in,
 * first out. So the addresses that an application gets are the same in each run. A block's size and owner are kept beside
 * the memory, not in it: what an application writes past a block does not harm the heap.
 */
#include "engine.h"

#include <string.h>
#include <sys/mman.h>

enum { GRAIN = 16, CLASSES = 64, POISON = 0xA5 };

typedef struct {
    uint64_t address;
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

static Block *new_block(Heap *heap, size_t size)
{
    size_t room = 0;
    int class = class_of(size + heap->slack, &room);
    uint64_t address = heap->top, next = address + room;
    if (heap->is_guarded) {
        size_t pages = (size + heap->page - 1) / heap->page * heap->page + (size == 0) * heap->page;
        address = heap->top + pages - (size + heap->grain - 1) / heap->grain * heap->grain;
        next = heap->top + pages + heap->page;
        room = size;
        if (next <= heap->end)
            mprotect((void *)(heap->top + pages), heap->page, PROT_NONE);
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
    *block = (Block){.address = address, .room = room, .class = class};
    return block;
}

/* The bytes between the end of a guarded block and that of its page; NULL for none. */
static unsigned char *margin(const Heap *heap, const Block *block, size_t *size)
{
    *size = heap->is_guarded ? (block->size + heap->grain - 1) / heap->grain * heap->grain - block->size : 0;
    return (unsigned char *)block->address + block->size;
}

/* A block of zeros, aligned to 16 bytes; 0 when there is no memory left. */
HIDDEN uint64_t heap_take(Heap *heap, size_t size)
{
    size_t room;
    if (size > heap->end - heap->base)
        return 0;
    int class = class_of(size + heap->slack, &room);
    Block *block = NULL;
    if (class >= 0 && !heap->is_guarded && heap->free_count[class] > 0) {
        block = &heap->blocks[heap->free_of[class][--heap->free_count[class]]];
        memset((void *)block->address, 0, block->room);
    } else
        block = new_block(heap, size);
    if (block == NULL)
        return 0;
    block->size = size;
    block->owner = heap->owner;
    block->is_used = true;
    heap->used += size;
    heap->takes++;
    races_forget(block->address, size);
    size_t rest;
    unsigned char *bytes = margin(heap, block, &rest);
    memset(bytes, POISON, rest);
    return block->address;
}

/* As heap_take, for malloc, which promises nothing of what is in the block: a guarded heap shows that. */
HIDDEN uint64_t heap_take_any(Heap *heap, size_t size)
{
    uint64_t address = heap_take(heap, size);
    if (address != 0 && heap->is_guarded)
        memset((void *)address, POISON, size);
    return address;
}

HIDDEN void heap_own(Heap *heap, uint32_t owner) { heap->owner = owner; }

static bool give(Heap *heap, Block *block)
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
    if (heap->is_guarded) /* never given out again: who still uses it is found out */
        mprotect((void *)(block->address & -(uint64_t)heap->page),
                 (block->size + heap->page - 1) / heap->page * heap->page, PROT_NONE);
    else
        heap->free_of[class][heap->free_count[class]++] = (int)(block - heap->blocks);
    return true;
}

static bool is_whole(const Heap *heap, const Block *block)
{
    size_t size;
    const unsigned char *bytes = margin(heap, block, &size);
    for (size_t i = 0; i < size; i++)
        if (bytes[i] != POISON)
            return false;
    return true;
}

HIDDEN int heap_give(Heap *heap, uint64_t address)
{
    Block *block = find(heap, address);
    if (block == NULL || !block->is_used)
        return 0;
    bool was_whole = is_whole(heap, block);
    give(heap, block);
    return was_whole ? 1 : -1;
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
    }
    return (PyObject *)heap;
}

static void heap_dealloc(Heap *heap)
{
    PyMem_Free(heap->blocks);
    for (int i = 0; i < CLASSES; i++)
        PyMem_Free(heap->free_of[i]);
    Py_TYPE(heap)->tp_free(heap);
}

static PyObject *take(Heap *heap, PyObject *size)
{
    size_t bytes = PyLong_AsSize_t(size);
    return bytes == (size_t)-1 && PyErr_Occurred() ? NULL : PyLong_FromUnsignedLongLong(heap_take(heap, bytes));
}

static PyObject *give_back(Heap *heap, PyObject *address)
{
    return PyLong_FromLong(heap_give(heap, PyLong_AsUnsignedLongLongMask(address)));
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
        if (heap->blocks[i].is_used && heap->blocks[i].owner == whose)
            give(heap, &heap->blocks[i]);
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
    {"take", (PyCFunction)take, METH_O, "take(size) -> address of a block of zeros, 0 when there is no memory left"},
    {"give", (PyCFunction)give_back, METH_O, "give(address) -> 1; 0 for no block in use, -1 for one that was written past its end"},
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
    PyVarObject_HEAD_INIT(NULL, 0).tp_name = "cfepy.c._engine.Heap",
    .tp_basicsize = sizeof(Heap),
    .tp_flags = Py_TPFLAGS_DEFAULT,
    .tp_new = heap_new,
    .tp_dealloc = (destructor)heap_dealloc,
    .tp_methods = heap_methods,
    .tp_getset = heap_attributes,
    .tp_doc = "Heap(base, size, slack=0, guarded=False, grain=16, page=4096): blocks in a stretch of mapped memory",
};
