/* sscanf(), fscanf() and their kin. All arguments behind the format are pointers, so they are words, wherever they come from.
 *
 * The host's function does the work. What it would allocate (%ms) comes from the host's malloc: it gets places of its own
 * for that, and the texts move into the application's memory afterwards.
 */
#define _GNU_SOURCE
#include "natives.h"

#include <malloc.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <wchar.h>

#define PUBLIC __attribute__((visibility("default")))
/* The names of C89, in which an `a` before s, S or [ allocates; stdio.h leads to those of C99. */
extern PUBLIC int vsscanf_of_c89(const char *, const char *, va_list) __asm__("vsscanf");
extern PUBLIC int vswscanf_of_c89(const wchar_t *, const wchar_t *, va_list) __asm__("vswscanf");
/* Those of C23, in which %i knows binary numbers; glibc has them from 2.38 on. */
extern PUBLIC int vsscanf_of_c23(const char *, const char *, va_list) __asm__("__isoc23_vsscanf") __attribute__((weak));
extern PUBLIC int vswscanf_of_c23(const wchar_t *, const wchar_t *, va_list) __asm__("__isoc23_vswscanf")
    __attribute__((weak));

/* The same for streams. */
extern PUBLIC int vfscanf_of_c89(FILE *, const char *, va_list) __asm__("vfscanf");
extern PUBLIC int vfscanf_of_c23(FILE *, const char *, va_list) __asm__("__isoc23_vfscanf") __attribute__((weak));

typedef int (*Scanner)(const void *, const void *, va_list);
enum { MOST = 64 };

/* A conversion that allocates. */
typedef struct {
    int argument;
    size_t width;
    bool is_wide, has_end;
} Allocation;

typedef struct {
    int arguments, count;
    Allocation allocations[MOST];
} Format;

/* A format as single bytes; the rest of the wide characters matters to nobody here. */
typedef struct {
    const void *at;
    bool is_wide;
} Characters;

static char character(const Characters *from, size_t at)
{
    if (!from->is_wide)
        return ((const char *)from->at)[at];
    wchar_t wide = ((const wchar_t *)from->at)[at];
    return wide >= 0 && wide < 128 ? (char)wide : '?';
}

static size_t number(const Characters *from, size_t *at)
{
    size_t value = 0;
    for (; character(from, *at) >= '0' && character(from, *at) <= '9'; (*at)++)
        value = value < INT32_MAX ? value * 10 + (size_t)(character(from, *at) - '0') : value;
    return value;
}

static bool is_one_of(char what, const char *of) { return what != 0 && strchr(of, what) != NULL; }

/* To behind a set that begins with [. */
static size_t behind_set(const Characters *from, size_t at)
{
    at += character(from, at) == '^';
    at += character(from, at) == ']';
    while (character(from, at) != 0 && character(from, at) != ']')
        at++;
    return at + (character(from, at) == ']');
}

/* One conversion, from behind its %; returns where it ends. */
static size_t read_conversion(Format *to, const Characters *from, size_t at, bool is_c89)
{
    size_t first = at, width = number(from, &at);
    int argument = -1;
    if (width > 0 && character(from, at) == '$') {
        argument = (int)(width < MOST ? width - 1 : MOST);
        at++;
        width = 0;
    } else
        at = first;
    bool is_skipped = false, allocates = false, is_wide = false;
    for (; is_one_of(character(from, at), "*'I"); at++)
        is_skipped |= character(from, at) == '*';
    width = number(from, &at);
    for (; is_one_of(character(from, at), "hlLqjztma"); at++) {
        char modifier = character(from, at);
        if (modifier == 'a' && !(is_c89 && is_one_of(character(from, at + 1), "sS[")))
            break;
        allocates |= modifier == 'm' || modifier == 'a';
        is_wide |= modifier == 'l';
    }
    char kind = character(from, at);
    if (kind == 0 || kind == '%')
        return at + (kind != 0);
    at = kind == '[' ? behind_set(from, at + 1) : at + 1;
    if (is_skipped)
        return at;
    if (argument < 0)
        argument = to->arguments;
    if (argument + 1 > to->arguments)
        to->arguments = argument + 1;
    if (allocates && to->count < MOST) {
        bool is_character = kind == 'c' || kind == 'C';
        to->allocations[to->count++] = (Allocation){argument, width ? width : 1, is_wide || kind == 'S' || kind == 'C', !is_character};
    }
    return at;
}

static void read_format(Format *to, const Characters *from, bool is_c89)
{
    to->arguments = to->count = 0;
    for (size_t at = 0; character(from, at) != 0;)
        at = character(from, at) == '%' ? read_conversion(to, from, at + 1, is_c89) : at + 1;
}

static size_t size_of_allocation(const Allocation *one, char *cell)
{
    size_t room = malloc_usable_size(cell), unit = one->is_wide ? sizeof(wchar_t) : 1, size = one->width * unit;
    if (one->has_end)
        size = (one->is_wide ? wcslen((wchar_t *)cell) + 1 : strlen(cell) + 1) * unit;
    return size < room ? size : room;
}

/* A text of the host's memory, moved into the application's, and told where the application wants it. */
static void hand_over(Coroutine *call, const Allocation *one, char *cell, uint64_t to)
{
    size_t size = size_of_allocation(one, cell);
    heap_own(call->table->heap, call->owner);
    uint64_t made = heap_take_any(call->table->heap, size, 1);
    if (made != 0)
        memcpy((void *)made, cell, size);
    free(cell);
    if (engine_copy((void *)to, &made, sizeof made))
        PyErr_Format(fault_error, "bad address %p for the text of a %%m", (void *)to);
}

/* glibc's scanf() notes for its thread how to let go of a lock, and takes the note back at its end, which a fault skips:
 * the note would lead to a stack that is gone. One of our own before it brings back what was before both. */
extern PUBLIC void note(void *room, void (*function)(void *), void *) __asm__("_pthread_cleanup_push") __attribute__((weak));
extern PUBLIC void take_back(void *room, int calls_it) __asm__("_pthread_cleanup_pop") __attribute__((weak));

static void nothing(void *unused) {}

static void scan_begin(Coroutine *call)
{
    call->has_note = note != NULL && take_back != NULL;
    if (call->has_note)
        note(call->note, nothing, NULL);
}

HIDDEN void scan_abandon(Coroutine *call)
{
    if (call->has_note)
        take_back(call->note, 0);
    call->has_note = false;
}

/* `list`: where a va_list is; or 0, and the pointers are arguments of the call. `from`: a text, or a FILE of the host. */
static uint64_t scan(Coroutine *call, Scanner scanner, const void *from, bool is_wide, uint64_t list)
{
    bool is_c89 = scanner == (Scanner)vsscanf_of_c89 || scanner == (Scanner)vswscanf_of_c89 ||
                  scanner == (Scanner)vfscanf_of_c89;
    Format format;
    Arguments given;
    uint64_t words[MOST] = {0}, wanted[MOST];
    char *cells[MOST] = {NULL};
    read_format(&format, &(Characters){POINTER(1), is_wide}, is_c89);
    if (format.arguments > MOST)
        PyErr_Format(fault_error, "sscanf() with %d results; cfepy gives %d at most", format.arguments, MOST);
    if (PyErr_Occurred() || (list != 0 && arguments_at(&given, list) < 0))
        return 0;
    for (int i = 0; i < format.arguments; i++)
        words[i] = list != 0 ? va_arg(given.list, uint64_t) : argument(call, 2 + i);
    for (int i = 0; i < format.count; i++) {
        uint64_t *word = &words[format.allocations[i].argument];
        wanted[i] = *word;
        *word = (uint64_t)&cells[i];
    }
    arguments_of_words(&given, words);
    scan_begin(call);
    libc_enter_to_compute(call);
    int count = scanner(from, POINTER(1), given.list);
    libc_leave(call);
    scan_abandon(call);
    for (int i = 0; i < format.count; i++)
        if (cells[i] != NULL)
            hand_over(call, &format.allocations[i], cells[i], wanted[i]);
    return (uint64_t)(int64_t)count;
}

static uint64_t scan_memory(Coroutine *call, const Function *self, bool is_wide, uint64_t list)
{
    Scanner scanner = self->target != NULL ? (Scanner)self->target : is_wide ? (Scanner)vswscanf : (Scanner)vsscanf;
    return scan(call, scanner, POINTER(0), is_wide, list);
}

NATIVE(scan_text) { return scan_memory(call, self, false, 0); }
NATIVE(scan_text_to_list) { return scan_memory(call, self, false, WORD(2)); }
NATIVE(scan_wide) { return scan_memory(call, self, true, 0); }
NATIVE(scan_wide_to_list) { return scan_memory(call, self, true, WORD(2)); }

/* What api/stdio.py gives of a stream: its next bytes. It reads afterwards how many of them were used. */
typedef struct {
    uint64_t text, size, used, is_ended;
} Scan;

static uint64_t scan_stream(Coroutine *call, const Function *self, uint64_t list)
{
    if (!call->is_again) {
        call->wants_python = call->wants_again = true;
        return 0;
    }
    uint64_t at = call->result; /* 0: the stream cannot be read */
    Scan job = {0};
    if (at == 0 || engine_copy(&job, (void *)at, sizeof job))
        return (uint64_t)EOF;
    char nothing[1]; /* fmemopen() takes no NULL */
    FILE *from = fmemopen(job.size ? (void *)job.text : nothing, job.size ? job.size : 1, "r");
    if (from == NULL) {
        PyErr_NoMemory();
        return (uint64_t)EOF;
    }
    if (job.size == 0)
        getc(from);
    uint64_t count = scan(call, self->target != NULL ? (Scanner)self->target : (Scanner)vfscanf, from, false, list);
    job.used = job.size ? (uint64_t)ftell(from) : 0;
    job.is_ended = feof(from) != 0;
    fclose(from);
    engine_copy((void *)at, &job, sizeof job);
    return count;
}

NATIVE(scan_file) { return scan_stream(call, self, 0); }
NATIVE(scan_file_to_list) { return scan_stream(call, self, WORD(2)); }

HIDDEN const NativeRow natives_of_scanning[] = {
    {"sscanf", scan_text, (void *)vsscanf_of_c89},
    {"__isoc99_sscanf", scan_text, (void *)vsscanf},
    {"__isoc23_sscanf", scan_text, (void *)vsscanf_of_c23},
    {"vsscanf", scan_text_to_list, (void *)vsscanf_of_c89},
    {"__isoc99_vsscanf", scan_text_to_list, (void *)vsscanf},
    {"__isoc23_vsscanf", scan_text_to_list, (void *)vsscanf_of_c23},
    {"swscanf", scan_wide, (void *)vswscanf_of_c89},
    {"__isoc99_swscanf", scan_wide, (void *)vswscanf},
    {"__isoc23_swscanf", scan_wide, (void *)vswscanf_of_c23},
    {"vswscanf", scan_wide_to_list, (void *)vswscanf_of_c89},
    {"__isoc99_vswscanf", scan_wide_to_list, (void *)vswscanf},
    {"__isoc23_vswscanf", scan_wide_to_list, (void *)vswscanf_of_c23},
    {"fscanf", scan_file, (void *)vfscanf_of_c89},
    {"__isoc99_fscanf", scan_file, (void *)vfscanf},
    {"__isoc23_fscanf", scan_file, (void *)vfscanf_of_c23},
    {"vfscanf", scan_file_to_list, (void *)vfscanf_of_c89},
    {"__isoc99_vfscanf", scan_file_to_list, (void *)vfscanf},
    {"__isoc23_vfscanf", scan_file_to_list, (void *)vfscanf_of_c23},
    {NULL},
};
