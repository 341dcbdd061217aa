/* `Images`: packets of the Software Bus in memory of C, one image of a packet for all applications that get it.
 *
 * There are few at a time, some for each pipe, so lists are searched from end to end.
 */
#include "engine.h"

#include <string.h>

typedef struct {
    PyObject *packet;                           /* held, so that no other object gets its address */
    uint64_t address;
    int holders;                                /* pipes whose application has it */
} Image;

typedef struct {
    uint32_t pipe;
    Image *image;
} Hold;

struct Images {
    PyObject_HEAD
    Heap *heap;
    PyObject *routes;                           /* of the Software Bus, by MsgId */
    PyObject *waits;                            /* whether a packet still waits in a pipe */
    Image **images;
    Hold *holds;
    int count, room, hold_count, hold_room;
};

static Image *find(const Images *images, const PyObject *packet)
{
    for (int i = images->count - 1; i >= 0; i--)
        if (images->images[i]->packet == packet)
            return images->images[i];
    return NULL;
}

static void drop(Images *images, Image *image)
{
    for (int i = 0; i < images->count; i++)
        if (images->images[i] == image) {
            images->images[i] = images->images[--images->count];
            break;
        }
    heap_drop(images->heap, image->address);
    PyObject *packet = image->packet;
    PyMem_Free(image);
    Py_DECREF(packet);
}

static int grow(void **list, int *room, int count, size_t size)
{
    if (count < *room)
        return 0;
    void *more = PyMem_Realloc(*list, (size_t)(*room ? 2 * *room : 32) * size);
    if (more == NULL) {
        PyErr_NoMemory();
        return -1;
    }
    *list = more;
    *room = *room ? 2 * *room : 32;
    return 0;
}

static Image *add(Images *images, PyObject *packet, uint64_t address)
{
    Image *image = PyMem_Calloc(1, sizeof *image);
    if (image == NULL || grow((void **)&images->images, &images->room, images->count, sizeof(Image *)) < 0) {
        PyMem_Free(image);
        return NULL;
    }
    *image = (Image){Py_NewRef(packet), address, 0};
    images->images[images->count++] = image;
    return image;
}

/* Whether a packet may have gone to more than one pipe. */
static bool has_others(const Images *images, PyObject *packet)
{
    const unsigned char *header = (const unsigned char *)PyBytes_AS_STRING(packet);
    PyObject *msg_id = PyLong_FromLong(header[0] << 8 | header[1]);
    PyObject *route = msg_id == NULL ? NULL : PyDict_GetItemWithError(images->routes, msg_id);
    PyObject *destinations = route == NULL ? NULL : PyObject_GetAttrString(route, "destinations");
    Py_ssize_t count = destinations == NULL ? 2 : PyObject_Size(destinations);
    Py_XDECREF(destinations);
    Py_XDECREF(msg_id);
    PyErr_Clear();
    return count > 1;
}

/* A pipe lets go of an image; it stays while others have it, or may still get its packet. */
static int let_go(Images *images, Image *image)
{
    if (--image->holders > 0)
        return 0;
    if (Py_REFCNT(image->packet) > 1 && has_others(images, image->packet)) {
        PyObject *answer = PyObject_CallOneArg(images->waits, image->packet);
        int waits = answer == NULL ? -1 : PyObject_IsTrue(answer);
        Py_XDECREF(answer);
        if (waits != 0 || image->holders > 0)
            return waits < 0 ? -1 : 0;
    }
    drop(images, image);
    return 0;
}

HIDDEN uint64_t images_receive(Images *images, uint32_t pipe, PyObject *packet)
{
    Image *image = find(images, packet);
    if (image == NULL) {
        Py_ssize_t size = PyBytes_GET_SIZE(packet);
        uint64_t address = heap_take(images->heap, (size_t)size);
        if (address == 0) {
            PyErr_SetString(PyExc_MemoryError, "no memory is left for messages of compiled applications");
            return 0;
        }
        memcpy((void *)address, PyBytes_AS_STRING(packet), (size_t)size);
        image = add(images, packet, address);
        if (image == NULL)
            return 0;
    }
    image->holders++;
    uint64_t address = image->address;
    for (int i = 0; i < images->hold_count; i++)
        if (images->holds[i].pipe == pipe) {
            Image *before = images->holds[i].image;
            images->holds[i].image = image;
            return let_go(images, before) < 0 ? 0 : address;
        }
    if (grow((void **)&images->holds, &images->hold_room, images->hold_count, sizeof(Hold)) < 0)
        return 0;
    images->holds[images->hold_count++] = (Hold){pipe, image};
    return address;
}

static PyObject *receive(Images *images, PyObject *arguments)
{
    unsigned pipe;
    PyObject *packet;
    if (!PyArg_ParseTuple(arguments, "IS", &pipe, &packet))
        return NULL;
    uint64_t address = images_receive(images, pipe, packet);
    return address == 0 ? NULL : PyLong_FromUnsignedLongLong(address);
}

static PyObject *keep(Images *images, PyObject *arguments)
{
    PyObject *packet;
    unsigned long long address;
    if (!PyArg_ParseTuple(arguments, "SK", &packet, &address))
        return NULL;
    memcpy((void *)address, PyBytes_AS_STRING(packet), (size_t)PyBytes_GET_SIZE(packet));
    if (add(images, packet, address) == NULL)
        return NULL;
    Py_RETURN_NONE;
}

static PyObject *forget_pipe(Images *images, PyObject *number)
{
    uint32_t pipe = (uint32_t)PyLong_AsUnsignedLongMask(number);
    for (int i = 0; i < images->hold_count; i++)
        if (images->holds[i].pipe == pipe) {
            Image *image = images->holds[i].image;
            images->holds[i] = images->holds[--images->hold_count];
            if (let_go(images, image) < 0)
                return NULL;
            break;
        }
    Py_RETURN_NONE;
}

static PyObject *pipes(Images *images, PyObject *unused)
{
    PyObject *found = PyList_New(images->hold_count);
    for (int i = 0; found != NULL && i < images->hold_count; i++)
        PyList_SET_ITEM(found, i, PyLong_FromUnsignedLong(images->holds[i].pipe));
    return found;
}

/* Give back images of packets that nobody got, or that waited for somebody who is no more. */
static PyObject *sweep(Images *images, PyObject *unused)
{
    for (int i = images->count - 1; i >= 0; i--)
        if (images->images[i]->holders == 0) {
            images->images[i]->holders = 1;
            if (let_go(images, images->images[i]) < 0)
                return NULL;
        }
    Py_RETURN_NONE;
}

static PyObject *images_new(PyTypeObject *type, PyObject *arguments, PyObject *options)
{
    PyObject *heap, *routes, *waits;
    if (!PyArg_ParseTuple(arguments, "O!O!O", &heap_type, &heap, &PyDict_Type, &routes, &waits))
        return NULL;
    Images *images = (Images *)type->tp_alloc(type, 0);
    if (images != NULL) {
        images->heap = (Heap *)Py_NewRef(heap);
        images->routes = Py_NewRef(routes);
        images->waits = Py_NewRef(waits);
    }
    return (PyObject *)images;
}

static int images_traverse(Images *images, visitproc visit, void *arg)
{
    Py_VISIT(images->routes);
    Py_VISIT(images->waits);
    Py_VISIT((PyObject *)images->heap);
    return 0;
}

static int images_clear(Images *images)
{
    Py_CLEAR(images->routes);
    Py_CLEAR(images->waits);
    return 0;
}

static void images_dealloc(Images *images)
{
    PyObject_GC_UnTrack(images);
    images_clear(images);
    for (int i = 0; i < images->count; i++) {
        Py_DECREF(images->images[i]->packet);
        PyMem_Free(images->images[i]);
    }
    PyMem_Free(images->images);
    PyMem_Free(images->holds);
    Py_XDECREF((PyObject *)images->heap);
    Py_TYPE(images)->tp_free(images);
}

static PyObject *get_count(Images *images, void *unused) { return PyLong_FromLong(images->count); }

static PyMethodDef images_methods[] = {
    {"receive", (PyCFunction)receive, METH_VARARGS, "receive(pipe, packet) -> address of its image"},
    {"keep", (PyCFunction)keep, METH_VARARGS, "keep(packet, address): a block becomes the image of a packet"},
    {"forget_pipe", (PyCFunction)forget_pipe, METH_O, "forget_pipe(pipe): what it has is given back"},
    {"pipes", (PyCFunction)pipes, METH_NOARGS, "pipes() -> those that have an image"},
    {"sweep", (PyCFunction)sweep, METH_NOARGS, "sweep(): give back what nobody has, and nobody will get"},
    {NULL, NULL, 0, NULL},
};
static PyGetSetDef images_attributes[] = {
    {"count", (getter)get_count, NULL, "how many there are", NULL},
    {NULL, NULL, NULL, NULL, NULL},
};
HIDDEN PyTypeObject images_type = {
    PyVarObject_HEAD_INIT(NULL, 0).tp_name = "cfepy.extra.c._engine.Images",
    .tp_basicsize = sizeof(Images),
    .tp_flags = Py_TPFLAGS_DEFAULT | Py_TPFLAGS_HAVE_GC,
    .tp_new = images_new,
    .tp_dealloc = (destructor)images_dealloc,
    .tp_traverse = (traverseproc)images_traverse,
    .tp_clear = (inquiry)images_clear,
    .tp_methods = images_methods,
    .tp_getset = images_attributes,
    .tp_doc = "Images(heap, routes, waits): packets in memory of C",
};
