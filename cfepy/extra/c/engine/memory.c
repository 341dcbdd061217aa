/* Memory at fixed addresses, and the stubs through which an application calls. */
#define _GNU_SOURCE
#include "natives.h"

#include <ctype.h>
#include <errno.h>
#include <string.h>
#include <sys/mman.h>

enum { CHARACTERS = 384, LOWEST = -128 };

static bool is_in_arena(unsigned long long at, unsigned long long size)
{
    if (at >= ARENA_LOW && at < ARENA_HIGH && size <= ARENA_HIGH - at)
        return true;
    PyErr_Format(PyExc_ValueError, "%llu bytes at %p are not in the arena", size, (void *)at);
    return false;
}

HIDDEN PyObject *memory_map(PyObject *module, PyObject *arguments)
{
    unsigned long long at, size;
    if (!PyArg_ParseTuple(arguments, "KK", &at, &size) || !is_in_arena(at, size))
        return NULL;
    int flags = MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE | MAP_FIXED_NOREPLACE;
    void *memory = mmap((void *)at, size, PROT_READ | PROT_WRITE, flags, -1, 0);
    if (memory == MAP_FAILED)
        return PyErr_SetFromErrno(PyExc_OSError);
    if (memory != (void *)at) { /* a kernel that does not know the flag takes the address as a wish */
        munmap(memory, size);
        errno = EEXIST;
        return PyErr_SetFromErrno(PyExc_OSError);
    }
    Py_RETURN_NONE;
}

HIDDEN PyObject *memory_unmap(PyObject *module, PyObject *arguments)
{
    unsigned long long at, size;
    if (!PyArg_ParseTuple(arguments, "KK", &at, &size) || !is_in_arena(at, size))
        return NULL;
    races_forget(at, size);
    munmap((void *)at, size);
    Py_RETURN_NONE;
}

HIDDEN PyObject *memory_protect(PyObject *module, PyObject *arguments)
{
    unsigned long long at, size;
    int rights;
    if (!PyArg_ParseTuple(arguments, "KKi", &at, &size, &rights) || !is_in_arena(at, size))
        return NULL;
    int protection = (rights & 4 ? PROT_READ : 0) | (rights & 2 ? PROT_WRITE : 0) | (rights & 1 ? PROT_EXEC : 0);
    if (rights & 1)
        __builtin___clear_cache((char *)at, (char *)at + size);
    if (mprotect((void *)at, size, protection) != 0)
        return PyErr_SetFromErrno(PyExc_OSError);
    Py_RETURN_NONE;
}

/* A debugger stops here to read the file of a loaded object and to learn its address; see symbols.gdb. */
__attribute__((visibility("default"), noinline)) void cfepy_image_loaded(const char *name, const void *file,
                                                                          size_t size, unsigned long base)
{
    __asm__ volatile("" : : "r"(name), "r"(file), "r"(size), "r"(base) : "memory");
}

HIDDEN PyObject *memory_loaded(PyObject *module, PyObject *arguments)
{
    const char *name, *file;
    Py_ssize_t size;
    unsigned long long base;
    if (!PyArg_ParseTuple(arguments, "sy#K", &name, &file, &size, &base))
        return NULL;
    cfepy_image_loaded(name, file, (size_t)size, (unsigned long)base);
    Py_RETURN_NONE;
}

HIDDEN PyObject *memory_clear(PyObject *module, PyObject *arguments)
{
    unsigned long long at, size;
    if (!PyArg_ParseTuple(arguments, "KK", &at, &size) || !is_in_arena(at, size))
        return NULL;
    races_forget(at, size);
    if (madvise((void *)at, size, MADV_DONTNEED) != 0)
        return PyErr_SetFromErrno(PyExc_OSError);
    Py_RETURN_NONE;
}

HIDDEN PyObject *memory_ctype(PyObject *module, PyObject *unused)
{
    locale_t before = uselocale(only_locale());
    PyObject *tables = Py_BuildValue("(y#y#y#)", (const char *)(*__ctype_b_loc() + LOWEST), (Py_ssize_t)(CHARACTERS * 2),
                         (const char *)(*__ctype_toupper_loc() + LOWEST), (Py_ssize_t)(CHARACTERS * 4),
                         (const char *)(*__ctype_tolower_loc() + LOWEST), (Py_ssize_t)(CHARACTERS * 4));
    uselocale(before);
    return tables;
}

/* The code of a stub: the number of its function, and a jump to engine_call; or, on aarch64, to engine_thread_local. */
HIDDEN PyObject *memory_make_stub(PyObject *module, PyObject *arguments)
{
    unsigned long long at;
    unsigned number;
    int is_thread_local = 0;
    if (!PyArg_ParseTuple(arguments, "KI|p", &at, &number, &is_thread_local) || !is_in_arena(at, 32))
        return NULL;
#if defined(__x86_64__)
    uint64_t target = (uint64_t)engine_call;
    unsigned char code[] = {0x41, 0xBB, 0, 0, 0, 0,             /* mov r11d, number */
                            0x49, 0xBA, 0, 0, 0, 0, 0, 0, 0, 0, /* mov r10, engine_call */
                            0x41, 0xFF, 0xE2};                  /* jmp r10 */
    memcpy(code + 2, &number, 4);
    memcpy(code + 8, &target, 8);
#else
    uint64_t target = (uint64_t)(is_thread_local ? engine_thread_local : engine_call);
    uint32_t code[] = {is_thread_local ? 0xA9BF47F0u            /* stp x16, x17, [sp, -16]! */
                                       : 0xD503201Fu,           /* nop */
                       0xD2800010u | (number & 0xFFFF) << 5,    /* movz x16, number */
                       0xF2A00010u | (number >> 16) << 5,       /* movk x16, number >> 16, lsl 16 */
                       0x58000071u,                             /* ldr x17, 12 bytes on */
                       0xD61F0220u,                             /* br x17 */
                       0, (uint32_t)target, (uint32_t)(target >> 32)};
#endif
    memcpy((void *)at, code, sizeof code);
    __builtin___clear_cache((char *)at, (char *)at + sizeof code);
    return PyLong_FromSize_t(sizeof code);
}

/* Where a function returns to that Python called: in the arena, since an address of the host would be on its stack. */
HIDDEN PyObject *memory_make_end(PyObject *module, PyObject *address)
{
    uint64_t at = PyLong_AsUnsignedLongLongMask(address), target = (uint64_t)engine_call;
    if (PyErr_Occurred() || !is_in_arena(at, 32))
        return NULL;
#if defined(__x86_64__)
    unsigned char code[] = {0x48, 0x89, 0xC7,                   /* mov rdi, rax */
                            0x49, 0xC7, 0xC3, 255, 255, 255, 255, /* mov r11, FINISHED */
                            0x49, 0xBA, 0, 0, 0, 0, 0, 0, 0, 0, /* mov r10, engine_call */
                            0x41, 0xFF, 0xD2};                  /* call r10 */
    memcpy(code + 12, &target, 8);
#else
    uint32_t code[] = {0x92800010u,                             /* mov x16, FINISHED */
                       0x58000071u,                             /* ldr x17, 12 bytes on */
                       0xD61F0220u,                             /* br x17 */
                       0, (uint32_t)target, (uint32_t)(target >> 32)};
#endif
    memcpy((void *)at, code, sizeof code);
    __builtin___clear_cache((char *)at, (char *)at + sizeof code);
    Py_RETURN_NONE;
}
