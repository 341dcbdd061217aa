/* What the parts of the engine share: compiled C code as coroutines of a Python program.
 *
 * The code of an application runs on a stack of its own. A call of a cFE, OSAL, PSP or libc function stores its
 * arguments in the `Coroutine`, switches back to the host's stack, and is answered there: by C (`Native`), or by a
 * Python function. Its result is handed over when the coroutine is resumed. So an application's stack holds nothing but
 * what the application itself does: an exception leaves `run` and the stack is dropped, greenlets switch without
 * copying frames of C, a fault lands in `run`, and what is left on the stack is the same in each run.
 *
 * All of this runs with the GIL held, so there is one coroutine at most that has the CPU: `running`.
 */
#ifndef CFEPY_ENGINE_H
#define CFEPY_ENGINE_H

#define PY_SSIZE_T_CLEAN
#include <Python.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <wchar.h>

#define HIDDEN __attribute__((visibility("hidden")))

/* What a coroutine wants when it gives up the CPU, in place of the number of a function. */
enum { FINISHED = -1, FAULT = -2, PREEMPTED = -3 };

#if defined(__x86_64__)
/* Words from a stopped stack pointer: to where the call returns to, and to the arguments that are on the stack. */
enum { RETURN_ADDRESS = 6, STACK_ARGUMENTS = 7, REGISTER_ARGUMENTS = 6, REGISTERS = 17 };
#else
enum { RETURN_ADDRESS = 11, STACK_ARGUMENTS = 20, REGISTER_ARGUMENTS = 8, REGISTERS = 33 };
#endif
/* What -fstack-protector puts on stacks, the same in each run; as libc's, its first byte ends texts. */
#define STACK_GUARD 0x5AFE57AC4B0A2D00ll
enum { FLOAT_ARGUMENTS = 8, KEPT_BLOCKS = 8 };

/* The assembly knows the members down to `guard` by their offsets. */
typedef struct Coroutine {
    uint64_t arguments[8];                     /* 0: as many as the processor passes in registers */
    uint64_t *stack_pointer;                   /* 64: of the application, behind what the switch saved */
    uint64_t *host_stack_pointer;              /* 72 */
    uint64_t result;                           /* 80 */
    int64_t wanted;                            /* 88: the function that is called, or one of the above */
    double floats[FLOAT_ARGUMENTS];            /* 96 */
    double float_result;                       /* 160 */
    uint64_t host_float_modes, float_modes;    /* 168, 176 */
    uint64_t result_high;                      /* 184: the second word of a result of two */
    uint64_t float_highs[FLOAT_ARGUMENTS];     /* 192: of `floats` as long double, where registers are that wide */
    uint64_t guard;                            /* 256: of stacks, x86-64: the other side's while one runs */
    uint64_t gives_long;                       /* 264: whether the result is the long double that follows */
    unsigned char long_result[16];             /* 272 */
    uint64_t *tried_stack_pointer;             /* 288: of the host, in engine_try */
    /* not known to the assembly */
    char *stack;                               /* lowest byte */
    size_t size;
    int thread;
    volatile bool is_native;                   /* a function of the engine runs on its behalf, in engine_try */
    bool wants_python;                         /* said by a native: the Python function has to answer after all */
    bool wants_again, is_again;                /* said by it too: it is called again after that; and that it is */
    uint32_t task;                             /* of `Races`; 0 for none */
    uint32_t owner;                            /* of what it allocates: an application */
    bool has_modes;                            /* the host computes with its modes: see natives.h */
    void *host_locale;                         /* what the host's was meanwhile; or NULL */
    int errno_before;
    bool has_note;                             /* of the thread, by natives_scanning.c */
    uint64_t note[4];
    uint16_t x87_flags;                        /* x86-64: those of long double */
    int signal;
    double computes_since, computed_s;         /* when it was last seen to compute without a call; for how long */
    uint64_t called_from;                      /* where its last call returns to */
    uint64_t fault_address, fault_pc, fault_stack_pointer;
    struct {
        uint64_t module, block;
    } thread_locals[KEPT_BLOCKS];              /* where blocks of thread-local variables are that it has asked for */
    uint64_t registers[REGISTERS];             /* where a signal stopped it: by DWARF's numbers, the program counter last */
    struct Table *table;
    uint64_t key;                              /* the same for all code of a task */
    struct Coroutine *outer, *next;            /* what called it through Python; of all */
} Coroutine;
_Static_assert(offsetof(Coroutine, guard) == 256 && offsetof(Coroutine, long_result) == 272 &&
                   offsetof(Coroutine, tried_stack_pointer) == 288,
               "the assembly has these offsets");

struct Function;
/* A call that is answered without Python; what it returns goes to the application. */
typedef uint64_t (*Native)(Coroutine *, const struct Function *);

enum { MOST_PARAMETERS = 12 };

typedef struct Function {
    PyObject *callable;                        /* or NULL */
    Native native;                             /* or NULL; asked first */
    void *target;                              /* what a native stands for, such as a function of libm */
    uint64_t null_status;                      /* what a NULL is answered with, where one must not be */
    PyObject *on_null;                         /* called before that with three arguments; or NULL */
    char kinds[MOST_PARAMETERS + 1];
    bool gives_status, gives_two_words, gives_packet, clears_outputs, costs;
} Function;

/* The functions that the code of one processor can call, by number. */
typedef struct Table {
    PyObject_HEAD
    Function *functions;
    int count, room;
    PyObject *charge, *cost;                   /* called before each function that costs virtual time; or NULL */
    PyObject *errno_at;                        /* called for where errno of the current task is */
    PyObject *frames;                          /* by address, what calls a function and is seen as C; or NULL */
    PyObject *preempted;                       /* by pc, what is called when code has computed for long */
    struct Heap *heap;                         /* malloc's */
    struct Images *images;                     /* of the Software Bus */
    struct Races *races;                       /* looks at accesses to memory; or NULL */
    uint32_t highest_msg_id, largest_message;
    unsigned long long end;                    /* where the functions return to that Python calls */
    uint64_t ctype[3];                         /* of __ctype_b_loc, __ctype_toupper_loc, __ctype_tolower_loc */
    unsigned long long state;                  /* LibcState of natives.h, in the arena */
    uint32_t random[31], random_at;            /* of rand(), for the whole processor */
} Table;

/* switch_*.S */
extern HIDDEN Coroutine *running;
HIDDEN void engine_resume(Coroutine *);
HIDDEN void engine_reenter(Coroutine *);
HIDDEN void engine_call(void);
HIDDEN void engine_begin(void);
HIDDEN void engine_land(void);
HIDDEN void engine_thread_local(void);         /* aarch64: for descriptors of thread-local variables */
HIDDEN int engine_try(Coroutine *, void (*function)(Coroutine *, const void *), const void *with); /* 1 after a fault */
extern HIDDEN char engine_try_failed[];
HIDDEN int engine_copy(void *to, const void *from, size_t size);
extern HIDDEN char engine_copy_end[], engine_copy_failed[];

/* faults.c */
enum { WATCH_MS = 50 };
#define ARENA_LOW 0x1000000000ull              /* where all memory of C code is: arena.py divides it */
#define ARENA_HIGH 0x5000000000ull
HIDDEN int faults_begin(void);                 /* 0, or -1 with an exception */
HIDDEN int faults_thread(void);                /* the calling thread is about to run C code; 0, or -1 */
HIDDEN void faults_resume(Coroutine *);        /* let it run until it wants something; `running` stays set */
HIDDEN void faults_raise(void);                /* the signal with which `engine_reenter` goes on */
extern HIDDEN volatile uint64_t switches;
extern HIDDEN volatile int running_thread;

/* calls.c */
extern HIDDEN PyObject *status_error, *fault_error, *jump_error;
HIDDEN int calls_serve(Coroutine *, const Function *);
HIDDEN uint64_t argument(const Coroutine *, int number);
HIDDEN int format_text(Coroutine *, char *to, size_t room, const char *format, int fixed);
HIDDEN int format_list(Coroutine *, char *to, size_t room, const char *format, uint64_t list);
HIDDEN int format_wide(Coroutine *, wchar_t *to, size_t room, const wchar_t *format, int fixed);
HIDDEN int format_wide_list(Coroutine *, wchar_t *to, size_t room, const wchar_t *format, uint64_t list);
typedef struct {
    va_list list;
} Arguments;
HIDDEN void arguments_of_words(Arguments *, const uint64_t *words); /* as many as somebody takes out */
HIDDEN int arguments_at(Arguments *, uint64_t list); /* 0, or -1 with an exception */
HIDDEN PyObject *text_at(uint64_t address);
HIDDEN PyObject *message_at(uint64_t address, size_t largest);
extern HIDDEN PyTypeObject table_type;

/* heap.c */
typedef struct Heap Heap;
extern HIDDEN PyTypeObject heap_type;
HIDDEN uint64_t heap_take(Heap *, size_t);
HIDDEN uint64_t heap_take_any(Heap *, size_t, size_t);
HIDDEN void heap_own(Heap *, uint32_t owner);    /* whose the blocks are that are taken from now on */
HIDDEN int heap_give(Heap *, uint64_t);           /* 1; 0 for no block in use, less for one that was written past */
HIDDEN const char *heap_damage(int);              /* that number in words: "past its end" */
HIDDEN void heap_drop(Heap *, uint64_t);          /* gives it back, where no call can be told what is wrong with it */
HIDDEN size_t heap_size_of(Heap *, uint64_t);

/* images.c */
typedef struct Images Images;
extern HIDDEN PyTypeObject images_type;
HIDDEN uint64_t images_receive(Images *, uint32_t pipe, PyObject *packet); /* its address; 0 with an exception */

/* races.c */
typedef struct Races Races;
extern HIDDEN PyTypeObject races_type;
HIDDEN void races_forget(uint64_t address, uint64_t size);
HIDDEN void races_begin(Races *);              /* code that tells of its accesses was loaded */
HIDDEN bool races_asks_first(Coroutine *, uint64_t address, uint64_t size); /* a native returns; it is called again */
HIDDEN bool races_shared(Coroutine *, uint64_t address, uint64_t size);
HIDDEN void races_call(Coroutine *, uint64_t returns_to);
HIDDEN void races_return(Coroutine *);
HIDDEN uint32_t races_calls(const Coroutine *); /* the call that its task is in; 0 for none */
HIDDEN void races_set_calls(const Coroutine *, uint32_t);
HIDDEN void races_note(Coroutine *, uint64_t address, uint64_t size, bool is_write, bool is_atomic);

/* natives_numbers.c */
HIDDEN void random_begin(Table *, uint32_t seed);

/* natives_jumps.c */
HIDDEN bool jump_lands(Coroutine *); /* takes the exception of a longjmp() to a place on its stack, which goes on there */

/* natives_threads.c */
HIDDEN int application_errno(const Coroutine *);

/* natives_*.c: their tables end with a row without a name */
typedef struct {
    const char *name;
    Native native;
    void *target;
} NativeRow;
extern HIDDEN const NativeRow natives_of_msg[], natives_of_libc[], natives_of_numbers[], natives_of_formats[],
    natives_of_scanning[], natives_of_time[], natives_of_jumps[], natives_of_modes[], natives_of_math[], natives_of_cpp[],
    natives_of_locale[], natives_of_wide[], natives_of_races[], natives_of_threads[];
#define NATIVE(function) static uint64_t function(Coroutine *call, const Function *self)
#define POINTER(number) ((unsigned char *)call->arguments[number])
#define WORD(number) (call->arguments[number])

#endif
