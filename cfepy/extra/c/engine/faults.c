/* Faults of C code, and loops that do not end.
 *
 * A SIGSEGV or the like in an application lands in `run`, on the host's stack, and becomes an exception there. A fault
 * that is none of an application's goes to whoever had the signal before.
 *
 * While C code computes, this process can do nothing else, since it holds the GIL. So a thread looks on: when a
 * coroutine has had the CPU for a while without a call, a signal stops it, wherever it is in its own code, `run` lets
 * Python do what waits to be done (Ctrl-C, the stall watch), and then the coroutine goes on with all its registers. That
 * changes nothing in the simulation: nobody else runs, and the stack stays as it was.
 */
#define _GNU_SOURCE
#include "natives.h"

#include <errno.h>
#include <pthread.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <time.h>
#include <ucontext.h>
#include <unistd.h>

enum { ALTERNATE_STACK = 128 << 10, FLOAT_STATE = 32 << 10 };

HIDDEN Coroutine *running;
HIDDEN volatile uint64_t switches;
HIDDEN volatile int running_thread;

static struct sigaction former[NSIG];
static int watch_signal;
static volatile bool is_watching;

/* What a thread needs for its signals. */
typedef struct {
    int id;
    bool is_resuming;
    size_t float_size;
    mcontext_t registers;
    char *alternate_stack;
    char float_state[FLOAT_STATE];
} Thread;

static __thread Thread *mine __attribute__((tls_model("initial-exec")));
static pthread_key_t thread_end;

#if defined(__x86_64__)
#define PROGRAM_COUNTER(context) ((context)->uc_mcontext.gregs[REG_RIP])
#define STACK_POINTER(context) ((context)->uc_mcontext.gregs[REG_RSP])
#define FAULTS SIGSEGV, SIGBUS, SIGFPE, SIGILL
#elif defined(__aarch64__)
#define PROGRAM_COUNTER(context) ((context)->uc_mcontext.pc)
#define STACK_POINTER(context) ((context)->uc_mcontext.sp)
#define FAULTS SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGTRAP /* the last is that of __builtin_trap() */
#else
#error "cfepy runs compiled applications on x86-64 and aarch64"
#endif

#if defined(__x86_64__)
/* The kernel says in the state itself how long it is, AVX and all (struct _fpx_sw_bytes). */
static size_t float_size(const ucontext_t *context)
{
    const char *state = (const char *)context->uc_mcontext.fpregs;
    uint32_t magic, size;
    memcpy(&magic, state + 464, 4);
    memcpy(&size, state + 468, 4);
    return magic == 0x46505853 && size <= FLOAT_STATE ? size : 512;
}

static bool keep_registers(const ucontext_t *context)
{
    mine->registers = context->uc_mcontext;
    mine->float_size = float_size(context);
    memcpy(mine->float_state, context->uc_mcontext.fpregs, mine->float_size);
    return true;
}

static void give_registers(ucontext_t *context)
{
    memcpy(context->uc_mcontext.gregs, mine->registers.gregs, sizeof mine->registers.gregs);
    memcpy(context->uc_mcontext.fpregs, mine->float_state, mine->float_size);
}
#else
/* Vector registers are in records behind the others, each with its kind and size. What has no room there, such as vectors
 * of 2048 bits, is elsewhere in the signal's frame, which another frame cannot give: such code is not stopped. */
static bool keep_registers(const ucontext_t *context)
{
    enum { END = 0, ELSEWHERE = 0x45585401 }; /* EXTRA_MAGIC */
    const unsigned char *record = context->uc_mcontext.__reserved, *end = record + sizeof context->uc_mcontext.__reserved;
    uint32_t head[2];
    for (; record + sizeof head <= end; record += head[1]) {
        memcpy(head, record, sizeof head);
        if (head[0] == ELSEWHERE)
            return false;
        if (head[0] == END || head[1] < sizeof head)
            break;
    }
    mine->registers = context->uc_mcontext;
    return true;
}

static void give_registers(ucontext_t *context) { context->uc_mcontext = mine->registers; }
#endif

/* The registers by the numbers that DWARF gives them. */
static void tell_registers(uint64_t *to, const ucontext_t *context)
{
#if defined(__x86_64__)
    static const int numbers[REGISTERS] = {REG_RAX, REG_RDX, REG_RCX, REG_RBX, REG_RSI, REG_RDI, REG_RBP, REG_RSP, REG_R8,
                                           REG_R9,  REG_R10, REG_R11, REG_R12, REG_R13, REG_R14, REG_R15, REG_RIP};
    for (int i = 0; i < REGISTERS; i++)
        to[i] = (uint64_t)context->uc_mcontext.gregs[numbers[i]];
#else
    for (int i = 0; i < 31; i++)
        to[i] = context->uc_mcontext.regs[i];
    to[31] = context->uc_mcontext.sp;
    to[32] = context->uc_mcontext.pc;
#endif
}

static bool is_application(uint64_t address) { return address >= ARENA_LOW && address < ARENA_HIGH; }

static void land(Coroutine *coroutine, ucontext_t *context, int wanted)
{
    coroutine->wanted = wanted;
    PROGRAM_COUNTER(context) = (uint64_t)engine_land;
    STACK_POINTER(context) = (uint64_t)coroutine->host_stack_pointer;
}

static void on_watch(ucontext_t *context)
{
    Coroutine *coroutine = running;
    if (mine == NULL)
        return;
    if (mine->is_resuming) {
        mine->is_resuming = false;
        give_registers(context);
    } else if (coroutine != NULL && coroutine->thread == mine->id && !coroutine->is_native &&
               is_application(PROGRAM_COUNTER(context)) && keep_registers(context)) {
        coroutine->fault_pc = PROGRAM_COUNTER(context);
        tell_registers(coroutine->registers, context);
        land(coroutine, context, PREEMPTED);
    }
}

/* A fault of somebody else: the instruction runs again under the former handler, or under none the second time. */
static void pass_on(int signal)
{
    static bool is_passed[NSIG];
    struct sigaction none = {.sa_handler = SIG_DFL};
    sigaction(signal, is_passed[signal] ? &none : &former[signal], NULL);
    is_passed[signal] = true;
}

static void on_signal(int signal, siginfo_t *info, void *interrupted)
{
    ucontext_t *context = interrupted;
    int error = errno;
    if (signal == watch_signal) {
        on_watch(context);
        errno = error;
        return;
    }
    uint64_t pc = PROGRAM_COUNTER(context);
    Coroutine *coroutine = running;
    if (pc >= (uint64_t)engine_copy && pc < (uint64_t)engine_copy_end) {
        PROGRAM_COUNTER(context) = (uint64_t)engine_copy_failed;
    } else if (coroutine != NULL && mine != NULL && coroutine->thread == mine->id) {
        coroutine->signal = signal;
        coroutine->fault_address = (uint64_t)info->si_addr;
        coroutine->fault_pc = pc;
        coroutine->fault_stack_pointer = STACK_POINTER(context);
        tell_registers(coroutine->registers, context);
        if (coroutine->is_native) {
            PROGRAM_COUNTER(context) = (uint64_t)engine_try_failed;
            STACK_POINTER(context) = (uint64_t)coroutine->tried_stack_pointer;
        } else
            land(coroutine, context, FAULT);
    } else
        pass_on(signal);
    errno = error;
}

HIDDEN void faults_raise(void)
{
    mine->is_resuming = true;
    syscall(SYS_tgkill, getpid(), mine->id, watch_signal);
}

/* ---- the thread that looks on ------------------------------------------------------------------------------------- */

static void *look_on(void *unused)
{
    uint64_t seen = 0;
    for (;;) {
        struct timespec pause = {0, WATCH_MS * 1000000};
        nanosleep(&pause, NULL);
        int thread = running_thread;
        if (thread != 0 && switches == seen)
            syscall(SYS_tgkill, getpid(), thread, watch_signal);
        seen = switches;
    }
    return unused;
}

static void in_child(void)
{
    is_watching = false;
    if (mine != NULL)
        mine->id = (int)syscall(SYS_gettid);
}

static void watch(void)
{
    pthread_t thread;
    pthread_attr_t attributes;
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    pthread_attr_init(&attributes);
    pthread_attr_setstacksize(&attributes, 128 << 10);
    pthread_attr_setdetachstate(&attributes, PTHREAD_CREATE_DETACHED);
    int failed = pthread_create(&thread, &attributes, look_on, NULL);
    pthread_attr_destroy(&attributes);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    is_watching = !failed;
}

/* ---- threads ------------------------------------------------------------------------------------------------------ */

static void end_thread(void *ended)
{
    Thread *thread = ended;
    stack_t none = {.ss_flags = SS_DISABLE};
    sigaltstack(&none, NULL);
    munmap(thread->alternate_stack, ALTERNATE_STACK);
    munmap(thread, sizeof *thread);
}

static void *fresh(size_t size)
{
    void *memory = mmap(NULL, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    return memory == MAP_FAILED ? NULL : memory;
}

HIDDEN int faults_thread(void)
{
    if (mine != NULL)
        return 0;
    Thread *thread = fresh(sizeof *thread);
    char *stack = fresh(ALTERNATE_STACK);
    if (thread == NULL || stack == NULL) {
        PyErr_NoMemory();
        return -1;
    }
    thread->alternate_stack = stack;
    thread->id = (int)syscall(SYS_gettid);
    stack_t alternate = {.ss_sp = stack, .ss_size = ALTERNATE_STACK};
    sigaltstack(&alternate, NULL);
    pthread_setspecific(thread_end, thread);
    mine = thread;
    return 0;
}

HIDDEN void faults_resume(Coroutine *coroutine)
{
    if (!is_watching)
        watch();
    bool is_preempted = coroutine->wanted == PREEMPTED;
    coroutine->thread = mine->id;
    running = coroutine;
    running_thread = mine->id;
    switches++;
    give_flags(coroutine);
    if (is_preempted)
        engine_reenter(coroutine);
    else
        engine_resume(coroutine);
    keep_flags(coroutine);
    running_thread = 0;
}

HIDDEN int faults_begin(void)
{
    static const int faults[] = {FAULTS};
    struct sigaction action = {.sa_sigaction = on_signal, .sa_flags = SA_SIGINFO | SA_ONSTACK | SA_NODEFER | SA_RESTART};
    static bool has_begun;
    if (!has_begun) {
        has_begun = true;
        watch_signal = SIGRTMIN + 6;
        pthread_key_create(&thread_end, end_thread);
        pthread_atfork(NULL, NULL, in_child);
        sigaction(watch_signal, &action, &former[watch_signal]);
    }
    for (size_t i = 0; i < sizeof faults / sizeof *faults; i++) {
        struct sigaction now;
        sigaction(faults[i], NULL, &now);
        if (now.sa_sigaction == on_signal) /* somebody may have come in between, such as faulthandler */
            continue;
        if (sigaction(faults[i], &action, &former[faults[i]]) != 0) {
            PyErr_SetFromErrno(PyExc_OSError);
            return -1;
        }
    }
    return 0;
}
